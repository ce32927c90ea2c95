//! Pragmas that say something of what follows them.

use crate::{
    Code, Diagnostic, Span,
    ast::{AT_CALLS, External, Name, Pool},
};

use super::parser::{In, TokenReader};

/// The names in `{attribute 'strict'}` and its like between the last token and the next.
pub fn attributes_here<'s>(input: &mut In<'_, '_, 's>) -> Vec<&'s str> {
    pragmas_here(input).into_iter().filter_map(|it| attribute(it.text)).collect()
}

/// `{external}` between the last token and the next.
pub fn external_here<'s>(input: &mut In<'_, '_, 's>) -> Option<External<'s>> {
    pragmas_here(input).into_iter().find_map(external)
}

/// `{pool 16}` between the last token and the next.
pub fn pool_here(input: &mut In<'_, '_, '_>) -> Option<Pool> {
    let text = |it: &Name<'_>| Pool::count_in(it.text);
    pragmas_here(input).iter().find_map(|it| Some(Pool { count: text(it)?, span: it.span }))
}

/// `{attribute 'pack_mode' := '1'}` between the last token and the next. CODESYS takes 0 and 1 for one another.
pub fn pack_here(input: &mut In<'_, '_, '_>) -> Option<(u64, Span)> {
    let is_it = |it: &&Name<'_>| attribute(it.text).is_some_and(|it| it.eq_ignore_ascii_case("pack_mode"));
    let pragma = pragmas_here(input).iter().find(is_it).copied()?;
    let value = pragma.text.rsplit_once(":=").map_or("", |it| it.1.trim());
    let number = value.strip_prefix('\'').and_then(|it| it.strip_suffix('\''));
    let mode = number.and_then(|it| it.trim().parse().ok()).filter(|it| [0, 1, 2, 4, 8].contains(it));
    if mode.is_none() {
        input.report(
            Diagnostic::new(Code::W0514, pragma.span, "the attribute `pack_mode` is ignored")
                .label("expected 0, 1, 2, 4 or 8")
                .help("write `{attribute 'pack_mode' := '1'}` for no padding between members"),
        );
    }
    mode.map(|it: u64| (it.max(1), pragma.span))
}

/// `{attribute 'instance-path'}` between the last token and the next.
pub fn instance_path_here(input: &mut In<'_, '_, '_>) -> Option<Span> {
    let is_it = |it: &Name<'_>| attribute(it.text).is_some_and(|it| it.eq_ignore_ascii_case("instance-path"));
    pragmas_here(input).into_iter().find(is_it).map(|it| it.span)
}

/// Whether `{attribute 'initialize_on_call'}` is between the last token and the next.
pub fn starts_at_calls_here(input: &mut In<'_, '_, '_>) -> bool {
    attributes_here(input).iter().any(|it| it.eq_ignore_ascii_case(AT_CALLS))
}

/// The pragmas between the last token and the next.
fn pragmas_here<'s>(input: &mut In<'_, '_, 's>) -> Vec<Name<'s>> {
    let (from, to) = (input.last(), input.here());
    let pragmas = &input.state().tokens.pragmas;
    let after = |it: &&Name<'s>| it.span.start >= from.end || from.start >= to.start;
    // They are in the order of the text.
    let before = &pragmas[..pragmas.partition_point(|it| it.span.end <= to.start)];
    let first = before.len() - before.iter().rev().take_while(after).count();
    before[first..].to_vec()
}

/// The name in `attribute 'strict'`.
pub fn attribute(text: &str) -> Option<&str> {
    let (word, rest) = text.trim().split_once(|it: char| it.is_whitespace())?;
    let name = rest.trim_start().strip_prefix('\'')?.split('\'').next()?;
    word.eq_ignore_ascii_case("attribute").then_some(name)
}

/// `external`, with or without a symbol in quotes.
fn external(pragma: Name<'_>) -> Option<External<'_>> {
    let text = pragma.text.trim();
    let (word, rest) = text.split_at_checked("external".len())?;
    let rest = rest.trim();
    let symbol = rest.strip_prefix('\'').and_then(|it| it.strip_suffix('\''));
    let fits = word.eq_ignore_ascii_case("external") && (rest.is_empty() || symbol.is_some());
    fits.then_some(External { symbol, span: pragma.span })
}
