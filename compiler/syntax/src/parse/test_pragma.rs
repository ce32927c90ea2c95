//! `{Test}` and `{Test(value := 1, limit := 2.5)}`: pragmas with the arguments of a call.

use super::parser::{Extra, State, TokenReader};
use super::{expression, namespace};
use crate::ast::{Argument, Name, TestPragma};
use crate::diagnostic::{Code, Diagnostic};
use crate::lex::{Kind, lex};
use chumsky::{Parser, input::InputRef, primitive::custom};

/// The pragmas that are tests.
pub(super) fn read<'s>(
    file: u16,
    text: &'s str,
    pragmas: &[Name<'s>],
    diagnostics: &mut Vec<Diagnostic>,
) -> Vec<TestPragma<'s>> {
    let test = |pragma: &Name<'s>| {
        let rest = rest(pragma.text)?;
        let from = pragma.span.start + u32::try_from(pragma.text.len() - rest.len()).ok()?;
        let arguments = if rest.is_empty() { Vec::new() } else { arguments(file, text, rest, from, diagnostics) };
        Some(TestPragma { span: pragma.span, arguments })
    };
    pragmas.iter().filter_map(test).collect()
}

/// What is after the word `Test`: nothing, or the parentheses.
fn rest(pragma: &str) -> Option<&str> {
    let (word, rest) = pragma.trim().split_at_checked("Test".len())?;
    let rest = rest.trim_start();
    (word.eq_ignore_ascii_case("Test") && (rest.is_empty() || rest.starts_with('('))).then_some(rest)
}

/// The arguments in a part of a text that starts at `from`.
fn arguments<'s>(
    file: u16,
    text: &'s str,
    part: &'s str,
    from: u32,
    diagnostics: &mut Vec<Diagnostic>,
) -> Vec<Argument<'s>> {
    let mut tokens = lex(file, part);
    for place in &mut tokens.places {
        *place = (place.0 + from, place.1 + from);
    }
    // What cannot be a token is said here alone: places in it are those of the part.
    let is_lexed = tokens.diagnostics.is_empty();
    let mut state = State::new(file, text, &tokens, namespace::file(file, text));
    let kinds: &[Kind] = &tokens.kinds;
    let whole = custom(|input: &mut InputRef<'_, '_, &[Kind], Extra<'_, 's>>| {
        let arguments = expression::arguments(input).ok().filter(|_| input.kind() == Kind::End);
        while input.next().is_some() {}
        Ok(arguments)
    });
    let read = whole.parse_with_state(kinds, &mut state).into_output().flatten();
    let start = crate::Span { file, start: from, end: from + 1 };
    if state.diagnostics.is_empty() && (read.is_none() || !is_lexed) {
        let error = Diagnostic::new(Code::E0001, start, "these are not arguments of a test");
        state.diagnostics.push(error.help("write them as in a call: `{Test(value := 1, limit := 2.5)}`"));
    }
    diagnostics.append(&mut state.diagnostics);
    read.unwrap_or_default()
}
