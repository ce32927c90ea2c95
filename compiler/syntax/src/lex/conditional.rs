//! Conditional compilation: `{IF defined(X)}`, `{ELSIF …}`, `{ELSE}` and `{END_IF}` take parts of a file out before it is
//! parsed, by what the project defines, and `{define X}` above in the file.

use super::Tokens;
use super::condition::{Condition, Facts, condition};
use super::declared::Known;
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
    Define(&'s str, Option<&'s str>),
    Undefine(&'s str),
    If(Option<Condition<'s>>),
    Elsif(Option<Condition<'s>>),
    Else,
    EndIf,
}

/// Takes out what is not compiled, where the project has defined some names already.
pub fn choose<'s>(tokens: &mut Tokens<'s>, by_project: &'s [String], known: Known<'_, 's>) {
    if !tokens.pragmas.iter().any(|it| matches!(word(it.text), Some(Word::If(_) | Word::EndIf))) {
        // What is defined is asked for nowhere.
        tokens.pragmas.retain(|it| !matches!(word(it.text), Some(Word::Define(..) | Word::Undefine(_))));
        return;
    }
    let mut open: Vec<Branch> = Vec::new();
    let mut facts = Facts::new(by_project);
    let mut undecided = Vec::new();
    let mut left_out: Vec<(u32, u32)> = Vec::new();
    let mut since = None;
    let mut reports = Vec::new();
    tokens.pragmas.retain(|pragma| {
        let Some(word) = word(pragma.text) else { return true };
        let active = open.last().is_none_or(|it| it.active);
        // A condition that is not understood is refused with the other pragmas, where it would decide.
        let mut refused = false;
        facts.declared = known.at(pragma.span);
        match word {
            Word::Define(name, value) if active => facts.define(name, value),
            Word::Undefine(name) if active => facts.undefine(name),
            Word::Define(..) | Word::Undefine(_) => {}
            Word::If(condition) => {
                let answer = if active { decide(condition.as_ref(), &facts, pragma, known) } else { Answer::No };
                refused = answer == Answer::Unknown;
                undecided.extend((answer == Answer::Later).then_some(pragma.span));
                open.push(Branch {
                    opened: pragma.span,
                    around: active,
                    chosen: answer.is_last(),
                    active: answer.is_in(),
                    otherwise: false,
                });
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
                    let answer = if decides { decide(condition.as_ref(), &facts, pragma, known) } else { Answer::No };
                    refused = answer == Answer::Unknown;
                    undecided.extend((answer == Answer::Later).then_some(pragma.span));
                    branch.active = answer.is_in();
                    branch.chosen |= answer.is_last();
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
        tokens.cut |= since.is_some();
    }
    leave_out(tokens, &left_out);
    tokens.undecided = undecided;
    tokens.diagnostics.extend(reports);
}

fn without_if(pragma: &Name<'_>) -> Diagnostic {
    let message = format!("`{{{}}}` has no open `{{IF}}` before it", pragma.text.trim());
    Diagnostic::new(Code::E0015, pragma.span, message).label("nothing to close or continue")
}

/// Drops the tokens in the ranges, which are in order.
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
    let value = || rest.split_once(|it: char| it.is_whitespace())?.1.trim().strip_prefix('\'')?.strip_suffix('\'');
    let is = |it: &str| word.eq_ignore_ascii_case(it);
    match () {
        () if is("define") => Some(Word::Define(name(), value())),
        () if is("undefine") => Some(Word::Undefine(name())),
        () if is("if") => Some(Word::If(condition(rest))),
        () if is("elsif") => Some(Word::Elsif(condition(rest))),
        () if is("else") => Some(Word::Else),
        () if is("end_if") => Some(Word::EndIf),
        () => None,
    }
}

/// What a condition says of the part after it.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Answer {
    Yes,
    No,
    /// It may be, and nobody asks.
    Kept,
    /// It is known when all is declared.
    Later,
    /// It asks for what is not understood.
    Unknown,
}

impl Answer {
    /// Whether the part is read. One that is refused is, so that one run finds all mistakes in it.
    fn is_in(self) -> bool {
        matches!(self, Self::Yes | Self::Kept | Self::Unknown)
    }

    /// Whether no later part of the IF is read.
    fn is_last(self) -> bool {
        matches!(self, Self::Yes | Self::Later | Self::Unknown)
    }
}

fn decide<'s>(
    condition: Option<&Condition<'s>>,
    facts: &Facts<'_, 's>,
    pragma: &Name<'_>,
    known: Known<'_, 's>,
) -> Answer {
    match (condition.and_then(|it| it.holds(facts, pragma.span)), condition, known) {
        (Some(true), ..) => Answer::Yes,
        (Some(false), ..) => Answer::No,
        (None, Some(condition), Known::Later | Known::One(..)) if condition.asks() => Answer::Later,
        (None, Some(condition), Known::Never) if condition.asks() => Answer::Kept,
        (None, ..) => Answer::Unknown,
    }
}
