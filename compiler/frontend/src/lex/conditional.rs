//! Conditional compilation: `{IF defined(X)}`, `{ELSIF …}`, `{ELSE}` and `{END_IF}` take parts of a file out before it is
//! parsed, by what the project defines, and `{define X}` above in the file.

use super::Tokens;
use crate::ast::Name;
use crate::diagnostic::{Code, Diagnostic};
use crate::source::Span;

/// An IF that is open.
struct Branch {
    opened: Span,
    /// What is around it is compiled.
    around: bool,
    /// One of its parts was chosen.
    chosen: bool,
    active: bool,
    otherwise: bool,
}

/// What a pragma says of compilation.
enum Word<'s> {
    Define(&'s str),
    Undefine(&'s str),
    If(Option<Condition<'s>>),
    Elsif(Option<Condition<'s>>),
    Else,
    EndIf,
}

enum Condition<'s> {
    Defined(&'s str),
    Not(Box<Condition<'s>>),
    And(Box<Condition<'s>>, Box<Condition<'s>>),
    Or(Box<Condition<'s>>, Box<Condition<'s>>),
}

/// Takes out what is not compiled, where the project has defined some names already.
pub fn choose<'s>(tokens: &mut Tokens<'s>, by_project: &'s [String]) {
    if !tokens.pragmas.iter().any(|it| matches!(word(it.text), Some(Word::If(_) | Word::EndIf))) {
        // What is defined is asked for nowhere.
        tokens.pragmas.retain(|it| !matches!(word(it.text), Some(Word::Define(_) | Word::Undefine(_))));
        return;
    }
    let mut open: Vec<Branch> = Vec::new();
    let mut defined: Vec<&str> = by_project.iter().map(String::as_str).collect();
    let mut left_out: Vec<(u32, u32)> = Vec::new();
    let mut since = None;
    let mut reports = Vec::new();
    tokens.pragmas.retain(|pragma| {
        let Some(word) = word(pragma.text) else { return true };
        let active = open.last().is_none_or(|it| it.active);
        // A condition that is not understood is refused with the other pragmas, where it would decide.
        let mut refused = false;
        match word {
            Word::Define(name) if active => defined.push(name),
            Word::Undefine(name) if active => defined.retain(|it| !it.eq_ignore_ascii_case(name)),
            Word::Define(_) | Word::Undefine(_) => {}
            Word::If(None) if active => {
                let opened = pragma.span;
                open.push(Branch { opened, around: true, chosen: true, active: true, otherwise: false });
                return true;
            }
            Word::If(condition) => {
                let holds = active && condition.is_some_and(|it| it.holds(&defined));
                let opened = pragma.span;
                open.push(Branch { opened, around: active, chosen: holds, active: holds, otherwise: false });
            }
            Word::Elsif(_) | Word::Else | Word::EndIf if open.is_empty() => {
                reports.push(without_if(pragma));
            }
            Word::Elsif(condition) => {
                if let Some(branch) = open.last_mut() {
                    if branch.otherwise {
                        reports.push(without_if(pragma));
                    }
                    let decides = branch.around && !branch.chosen;
                    refused = decides && condition.is_none();
                    branch.active = decides && condition.is_none_or(|it| it.holds(&defined));
                    branch.chosen |= branch.active;
                }
            }
            Word::Else => {
                if let Some(branch) = open.last_mut() {
                    if branch.otherwise {
                        reports.push(without_if(pragma));
                    }
                    branch.active = branch.around && !branch.chosen;
                    (branch.chosen, branch.otherwise) = (true, true);
                }
            }
            Word::EndIf => {
                open.pop();
            }
        }
        let now_active = open.last().is_none_or(|it| it.active);
        match since {
            None if !now_active => since = Some(pragma.span.end),
            Some(start) if now_active => {
                left_out.push((start, pragma.span.start));
                since = None;
            }
            None | Some(_) => {}
        }
        refused
    });
    if let Some(branch) = open.first() {
        reports.push(
            Diagnostic::new(Code::E0014, branch.opened, "this `{IF}` is not closed")
                .label("it has no `{END_IF}`")
                .help("write `{END_IF}` where it ends"),
        );
        left_out.extend(since.map(|start| (start, u32::MAX)));
    }
    leave_out(tokens, &left_out);
    tokens.diagnostics.extend(reports);
}

fn without_if(pragma: &Name<'_>) -> Diagnostic {
    let message = format!("`{{{}}}` belongs to nothing: there is no open `{{IF}}` here", pragma.text.trim());
    Diagnostic::new(Code::E0015, pragma.span, message).label("nothing to close or continue")
}

/// Drops what lies in the ranges, which are in order.
fn leave_out(tokens: &mut Tokens<'_>, ranges: &[(u32, u32)]) {
    let is_out = |at: u32| {
        let before = ranges.partition_point(|it| it.0 <= at);
        before > 0 && at < ranges[before - 1].1
    };
    // The end of the file is one of what is left.
    let last = tokens.kinds.len().saturating_sub(1);
    let keeps: Vec<bool> = tokens.places.iter().enumerate().map(|(at, it)| at == last || !is_out(it.0)).collect();
    let mut keep = keeps.iter();
    tokens.kinds.retain(|_| keep.next().copied().unwrap_or(true));
    let mut keep = keeps.iter();
    tokens.places.retain(|_| keep.next().copied().unwrap_or(true));
    tokens.comments.retain(|it| !is_out(it.0));
    tokens.pragmas.retain(|it| !is_out(it.span.start));
    tokens.diagnostics.retain(|it| !is_out(it.span.start));
}

fn word(pragma: &str) -> Option<Word<'_>> {
    let pragma = pragma.trim();
    let end = pragma.find(|it: char| !it.is_ascii_alphanumeric() && it != '_').unwrap_or(pragma.len());
    let (word, rest) = (&pragma[..end], pragma[end..].trim());
    let name = || rest.split_whitespace().next().unwrap_or_default();
    let is = |it: &str| word.eq_ignore_ascii_case(it);
    match () {
        () if is("define") => Some(Word::Define(name())),
        () if is("undefine") => Some(Word::Undefine(name())),
        () if is("if") => Some(Word::If(condition(rest))),
        () if is("elsif") => Some(Word::Elsif(condition(rest))),
        () if is("else") => Some(Word::Else),
        () if is("end_if") => Some(Word::EndIf),
        () => None,
    }
}

impl Condition<'_> {
    fn holds(&self, defined: &[&str]) -> bool {
        match self {
            Self::Defined(name) => defined.iter().any(|it| it.eq_ignore_ascii_case(name)),
            Self::Not(it) => !it.holds(defined),
            Self::And(a, b) => a.holds(defined) && b.holds(defined),
            Self::Or(a, b) => a.holds(defined) || b.holds(defined),
        }
    }
}

/// `defined(A) AND NOT defined(B)`; `None` for what asks for anything else.
fn condition(text: &str) -> Option<Condition<'_>> {
    if text.len() > LONGEST {
        return None;
    }
    let (condition, rest) = disjunction(text, 0)?;
    rest.trim().is_empty().then_some(condition)
}

/// No condition of a program has more bytes.
const LONGEST: usize = 4096;
/// Parentheses that are nested deeper are no condition of a program.
const DEEPEST: usize = 50;

fn disjunction(text: &str, depth: usize) -> Option<(Condition<'_>, &str)> {
    let (mut left, mut rest) = conjunction(text, depth)?;
    while let Some(after) = after_word(rest, "or") {
        let (right, then) = conjunction(after, depth)?;
        (left, rest) = (Condition::Or(Box::new(left), Box::new(right)), then);
    }
    Some((left, rest))
}

fn conjunction(text: &str, depth: usize) -> Option<(Condition<'_>, &str)> {
    let (mut left, mut rest) = operand(text, depth)?;
    while let Some(after) = after_word(rest, "and") {
        let (right, then) = operand(after, depth)?;
        (left, rest) = (Condition::And(Box::new(left), Box::new(right)), then);
    }
    Some((left, rest))
}

fn operand(text: &str, depth: usize) -> Option<(Condition<'_>, &str)> {
    if depth > DEEPEST {
        return None;
    }
    if let Some(after) = after_word(text, "not") {
        let (inner, rest) = operand(after, depth + 1)?;
        return Some((Condition::Not(Box::new(inner)), rest));
    }
    if let Some(after) = after_word(text, "defined") {
        let (name, rest) = after.trim_start().strip_prefix('(')?.split_once(')')?;
        let name = name.trim();
        // `variable: x` and the like ask for what is declared.
        let is_name = !name.is_empty() && name.bytes().all(|it| it.is_ascii_alphanumeric() || it == b'_');
        return is_name.then_some((Condition::Defined(name), rest));
    }
    let (inner, rest) = disjunction(text.trim_start().strip_prefix('(')?, depth + 1)?;
    Some((inner, rest.trim_start().strip_prefix(')')?))
}

/// What follows a word that the text begins with.
fn after_word<'s>(text: &'s str, word: &str) -> Option<&'s str> {
    let text = text.trim_start();
    let (start, rest) = text.split_at_checked(word.len())?;
    let ends = !rest.starts_with(|it: char| it.is_ascii_alphanumeric() || it == '_');
    (start.eq_ignore_ascii_case(word) && ends).then_some(rest)
}
