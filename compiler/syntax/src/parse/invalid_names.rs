//! Names that cannot be names: reserved words, `my-name`, `2nd`. Each is reported where it is
//! declared, and read as a name from there on, so that its uses are not reported again.

use std::collections::HashSet;

use crate::{
    diagnostic::{Code, Diagnostic},
    lex::{Kind, Tokens, index},
    source::Span,
};

use super::{
    diagnostics::reserved,
    token_class::{is_end, opens_item, opens_section},
};

/// What was declared under a name that cannot be one.
#[derive(Default)]
struct Found<'s> {
    words: HashSet<Kind>,
    /// In lower case.
    pieces: HashSet<String>,
    /// First token and number of tokens of each declaration.
    declared: Vec<(usize, usize)>,
    reports: Vec<Diagnostic>,
    /// Words that are names in this file.
    free: &'static [Kind],
    text: &'s str,
    file: u16,
}

/// Words of the standard's that are names in Automation Studio: its own libraries declare such variables and members.
const OF_STUDIO: &[Kind] = &[
    Kind::Type,
    Kind::Program,
    Kind::Continue,
    Kind::Configuration,
    Kind::Retain,
    Kind::Persistent,
    Kind::Until,
    Kind::Exit,
    Kind::By,
    Kind::VarAccess,
    Kind::VarGlobal,
    Kind::Constant,
];

/// Reports such declarations, and makes one name of the tokens of each of them and of their uses. Some words are names
/// in a file of Automation Studio, which may use what another declares.
pub fn mend(tokens: &mut Tokens<'_>, text: &str, file: u16, is_of_studio: bool) {
    let free = if is_of_studio { OF_STUDIO } else { &[] };
    members(tokens);
    if !free.contains(&Kind::Configuration) {
        configurations(tokens, text, file);
    }
    let words = free.iter().copied().collect();
    let mut found = Found { text, file, free, words, ..Found::default() };
    declarations(tokens, &mut found);
    if found.declared.is_empty() && free.is_empty() {
        return;
    }
    rewrite(tokens, &found);
    tokens.diagnostics.append(&mut found.reports);
}

/// A reserved word directly after `a.` is a member: `machine.Configuration`.
fn members(tokens: &mut Tokens<'_>) {
    for at in 2..tokens.kinds.len() {
        // Few tokens are points.
        if tokens.kinds[at - 1] != Kind::Dot || tokens.kinds[at].keyword().is_none() {
            continue;
        }
        let is_owner = matches!(tokens.kinds[at - 2], Kind::Name | Kind::CloseBracket | Kind::CloseParen | Kind::Caret);
        let is_joined = |it: usize| tokens.places[it].1 == tokens.places[it + 1].0;
        if is_owner && is_joined(at - 2) && is_joined(at - 1) {
            tokens.kinds[at] = Kind::Name;
        }
    }
}

/// Words before a name, which are names themselves.
const BEFORE_NAMES: [&str; 9] =
    ["METHOD", "PROPERTY", "ACTION", "PUBLIC", "PRIVATE", "PROTECTED", "INTERNAL", "FINAL", "OVERRIDE"];

/// CONFIGURATION is a name where it opens none: no word of TwinCAT. Dialects that reserve it say so later.
fn configurations(tokens: &mut Tokens<'_>, text: &str, file: u16) {
    for at in 0..tokens.kinds.len() {
        if tokens.kinds[at] != Kind::Configuration {
            continue;
        }
        let before = at.checked_sub(1).map(|it| tokens.kinds[it]);
        let is_declared = at.checked_sub(1).is_some_and(|it| is_before_name(tokens, it, text));
        let next = tokens.kinds.get(at + 1).copied().unwrap_or(Kind::End);
        // `Configuration REF= x`
        let is_latched = next == Kind::Name && tokens.kinds.get(at + 2) == Some(&Kind::Equal);
        if is_declared || is_latched || next.is_sign() || before.is_some_and(wants_operand) {
            let (start, end) = tokens.places[at];
            tokens.kinds[at] = Kind::Name;
            tokens.reserved.get_or_insert(Span { file, start, end });
        }
    }
}

fn is_before_name(tokens: &Tokens<'_>, at: usize, text: &str) -> bool {
    let (start, end) = tokens.places[at];
    let word = &text[index(start)..index(end)];
    tokens.kinds[at] == Kind::Name && BEFORE_NAMES.iter().any(|it| it.eq_ignore_ascii_case(word))
}

/// Walks over the places where a name is declared.
fn declarations(tokens: &Tokens<'_>, found: &mut Found<'_>) {
    let mut open: Vec<Kind> = Vec::new();
    // At the first name of a declaration, or after the `,` of its names.
    let mut fresh = false;
    // Since the declaration began, only names and `,` were seen.
    let mut names = false;
    let mut at = 0;
    while at < tokens.kinds.len() {
        let kind = tokens.kinds[at];
        names = fresh || (names && matches!(kind, Kind::Name | Kind::Comma));
        if fresh && let Some(count) = declared(tokens, at, found) {
            at += count;
            fresh = false;
            continue;
        }
        match kind {
            Kind::Program | Kind::Function | Kind::FunctionBlock => {
                head(tokens, at + 1, found);
                open.clear();
                fresh = false;
            }
            Kind::Struct => {
                open.push(Kind::EndStruct);
                fresh = true;
            }
            Kind::Type => {
                open = vec![Kind::EndType];
                fresh = true;
            }
            kind if opens_section(kind) => {
                open = vec![Kind::EndVar];
                fresh = true;
            }
            Kind::EndVar | Kind::EndType => {
                open.clear();
                fresh = false;
            }
            Kind::EndStruct => {
                open.pop();
                fresh = !open.is_empty();
            }
            Kind::Semicolon => fresh = !open.is_empty(),
            Kind::Constant | Kind::Retain | Kind::NonRetain | Kind::Persistent => {}
            Kind::Comma => fresh = names,
            // `PROPERTY Program : INT`: few names have a wrong one after them.
            Kind::Name if pieces(tokens, at + 1).is_some() && is_before_name(tokens, at, found.text) => {
                at += declared(tokens, at + 1, found).unwrap_or_default();
                fresh = false;
            }
            _ => fresh = false,
        }
        at += 1;
    }
}

/// The number of tokens of a wrong name that is declared at `at`.
fn declared(tokens: &Tokens<'_>, at: usize, found: &mut Found<'_>) -> Option<usize> {
    let count = pieces(tokens, at)?;
    let next = tokens.kinds[at + count];
    // `VAR RETAIN AT %QW5 : WORD;` declares no name.
    let qualifies = matches!(tokens.kinds[at], Kind::Constant | Kind::Retain | Kind::NonRetain | Kind::Persistent);
    if !matches!(next, Kind::Colon | Kind::Comma | Kind::At) || (qualifies && next == Kind::At) {
        return None;
    }
    found.report(tokens, at, count);
    Some(count)
}

/// A reserved word after PROGRAM, FUNCTION or FUNCTION_BLOCK.
fn head(tokens: &Tokens<'_>, at: usize, found: &mut Found<'_>) {
    let kind = tokens.kinds[at];
    let word = kind.keyword().is_some_and(|it| !it.starts_with("END_"));
    if !word || opens_section(kind) || opens_item(kind) {
        return;
    }
    // Where words are free, operators are declared as functions, too: no use of them is a name.
    let is_operator = matches!(kind, Kind::And | Kind::Or | Kind::Xor | Kind::Mod | Kind::Not);
    if is_operator && !found.free.is_empty() {
        found.declared.push((at, 1));
    } else {
        found.report(tokens, at, 1);
    }
}

/// How many tokens without space between them make a wrong name at `at`.
fn pieces(tokens: &Tokens<'_>, at: usize) -> Option<usize> {
    let is_piece = |kind: Kind| matches!(kind, Kind::Name | Kind::Integer | Kind::Minus) || kind.keyword().is_some();
    let first = tokens.kinds[at];
    if !is_piece(first) || first == Kind::Minus || is_end(first) {
        return None;
    }
    let mut count = 1;
    while is_piece(tokens.kinds[at + count]) && tokens.places[at + count - 1].1 == tokens.places[at + count].0 {
        count += 1;
    }
    let wrong = count > 1 || first.keyword().is_some();
    let whole = tokens.kinds[at + count - 1] != Kind::Minus;
    (wrong && whole && first != Kind::Not).then_some(count)
}

impl Found<'_> {
    fn spelled(&self, tokens: &Tokens<'_>, at: usize, count: usize) -> String {
        let (start, end) = (tokens.places[at].0, tokens.places[at + count - 1].1);
        self.text[index(start)..index(end)].to_ascii_lowercase()
    }

    fn report(&mut self, tokens: &Tokens<'_>, at: usize, count: usize) {
        let spelled = self.spelled(tokens, at, count);
        let (start, end) = (tokens.places[at].0, tokens.places[at + count - 1].1);
        let span = Span { file: self.file, start, end };
        let own = &self.text[index(start)..index(end)];
        self.declared.push((at, count));
        if count == 1 && self.free.contains(&tokens.kinds[at]) {
            return;
        }
        let known = match tokens.kinds[at].keyword() {
            Some(_) if count == 1 => !self.words.insert(tokens.kinds[at]),
            _ => !self.pieces.insert(spelled),
        };
        if known {
            return;
        }
        self.reports.push(match tokens.kinds[at].keyword() {
            Some(word) if count == 1 => reserved(span, word, own),
            _ if tokens.kinds[at] == Kind::Integer => digits_first(span, own),
            _ => hyphen(span, own),
        });
    }
}

fn digits_first(span: Span, own: &str) -> Diagnostic {
    Diagnostic::new(Code::E0001, span, format!("`{own}` is not a name: a name cannot start with a digit"))
        .label("expected a letter or `_` first")
        .help(format!("write `_{own}`"))
}

fn hyphen(span: Span, own: &str) -> Diagnostic {
    Diagnostic::new(Code::E0001, span, format!("`{own}` is not a name: `-` subtracts"))
        .label("expected only letters, digits and `_`")
        .help(format!("write `{}`", own.replace('-', "_")))
}

fn rewrite(tokens: &mut Tokens<'_>, found: &Found<'_>) {
    let (mut kinds, mut places) = (Vec::new(), Vec::new());
    let mut declared = found.declared.iter().peekable();
    let mut at = 0;
    while at < tokens.kinds.len() {
        let count = match declared.next_if(|it| it.0 == at) {
            Some((_, count)) => Some(*count),
            None => used(tokens, at, kinds.last().copied(), found),
        };
        kinds.push(if count.is_some() { Kind::Name } else { tokens.kinds[at] });
        let count = count.unwrap_or(1);
        places.push((tokens.places[at].0, tokens.places[at + count - 1].1));
        at += count;
    }
    tokens.kinds = kinds;
    tokens.places = places;
}

/// The number of tokens, where one of the wrong names is used at `at`.
fn used(tokens: &Tokens<'_>, at: usize, before: Option<Kind>, found: &Found<'_>) -> Option<usize> {
    if !found.pieces.is_empty()
        && let Some(count) = pieces(tokens, at)
        && found.pieces.contains(&found.spelled(tokens, at, count))
    {
        return Some(count);
    }
    let next = tokens.kinds.get(at + 1).copied().unwrap_or(Kind::End);
    let word = tokens.kinds[at];
    if before == Some(Kind::Colon) && found.free.contains(&word) {
        // `1: EXIT;` of a CASE.
        return None;
    }
    (found.words.contains(&word) && stands_for_name(before, word, next)).then_some(1)
}

/// Whether a reserved word is where only a name can.
fn stands_for_name(before: Option<Kind>, word: Kind, next: Kind) -> bool {
    let operator = matches!(word, Kind::And | Kind::Or | Kind::Xor | Kind::Mod | Kind::Not);
    if matches!(word, Kind::True | Kind::False) || (operator && next == Kind::OpenParen) {
        return false;
    }
    let assigned = matches!(next, Kind::Assign | Kind::Dot | Kind::OpenBracket | Kind::Arrow | Kind::Caret);
    let is_type = before == Some(Kind::Colon) && matches!(next, Kind::Semicolon | Kind::Assign);
    let called = next == Kind::OpenParen && !may_precede_parenthesis(word);
    assigned || is_type || called || before.is_some_and(wants_operand)
}

fn may_precede_parenthesis(word: Kind) -> bool {
    matches!(
        word,
        Kind::If
            | Kind::Elsif
            | Kind::While
            | Kind::Until
            | Kind::Case
            | Kind::For
            | Kind::To
            | Kind::By
            | Kind::Return
            | Kind::Of
            | Kind::AndThen
            | Kind::OrElse
    )
}

/// Kinds after which an operand is.
fn wants_operand(kind: Kind) -> bool {
    matches!(
        kind,
        Kind::Assign
            | Kind::Arrow
            | Kind::Dot
            | Kind::DotDot
            | Kind::OpenParen
            | Kind::OpenBracket
            | Kind::Comma
            | Kind::Plus
            | Kind::Minus
            | Kind::Star
            | Kind::Slash
            | Kind::Power
            | Kind::Equal
            | Kind::Unequal
            | Kind::Less
            | Kind::Greater
            | Kind::LessEqual
            | Kind::GreaterEqual
            | Kind::Ampersand
            | Kind::And
            | Kind::AndThen
            | Kind::Or
            | Kind::OrElse
            | Kind::Xor
            | Kind::Mod
            | Kind::Not
            | Kind::If
            | Kind::Elsif
            | Kind::While
            | Kind::Until
            | Kind::Case
            | Kind::For
            | Kind::To
            | Kind::By
    )
}
