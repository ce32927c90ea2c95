//! Tokens to the syntax tree: one function a production, over chumsky's input.
//!
//! Productions decide by the tokens ahead and never go back, so that each mistake is reported once,
//! where it is, and reading continues in the list it belongs to (`recover`).

mod token_class;

mod combinator;
mod doc;
mod parser;
mod pragma;

mod diagnostics;
mod misspelt;

mod block_ends;
mod foreign_block;
mod foreign_declaration;
mod foreign_expression;
mod foreign_reader;
mod foreign_statement;
mod foreign_syntax;
mod invalid_names;
mod recovery;
mod unsupported;

mod expression;
mod literal;

mod foreign_types;
mod initial;
mod types;

mod access;
mod declaration;
mod type_block;

mod mock;
mod statement;

mod chart;

mod configuration;
mod namespace;
mod routine;
mod test_pragma;
mod unit;

#[cfg(test)]
mod tests;

use chumsky::{Parser, input::InputRef, primitive::custom};

use crate::{
    ast::{Expr, File},
    diagnostic::{Code, Diagnostic, Severity},
    lex::{Kind, Known, lex_with},
    source::{Habits, Sources, Span},
};

pub use diagnostics::{address_without_sign, controller_service, reserved};
use parser::{Extra, State, TokenReader};
pub use pragma::attribute;

/// The tree of a file. What does not parse is reported, and left out of the tree.
pub fn parse<'s>(file: u16, text: &'s str, diagnostics: &mut Vec<Diagnostic>) -> File<'s> {
    parse_with(file, text, Habits::default(), Known::Never, diagnostics)
}

/// The tree of one of these files, with what its project defines. What does not parse is left out.
pub fn parse_file(sources: &Sources, number: u16) -> File<'_> {
    let source = sources.get(number);
    parse_with(number, &source.text, sources.habits(source), Known::Never, &mut Vec::new())
}

/// The same, where something is known of the file, and of what is declared.
pub fn parse_with<'s>(
    file: u16,
    text: &'s str,
    habits: Habits<'s>,
    known: Known<'_, 's>,
    diagnostics: &mut Vec<Diagnostic>,
) -> File<'s> {
    if u32::try_from(text.len()).is_err() {
        let span = Span { file, start: 0, end: 0 };
        diagnostics.push(Diagnostic::new(Code::E0031, span, "the file is larger than 4 GiB"));
        return File::default();
    }
    let mut tokens = lex_with(file, text, habits, known);
    invalid_names::mend(&mut tokens, text, file, habits.is_of_studio);
    let has_access = habits.is_of_studio;
    let mut state = State { has_access, ..State::new(file, text, &tokens, namespace::file(file, text)) };
    let items = parse_items(&mut state);
    let (mut found, braces, regions, bindings) = (state.diagnostics, state.braces, state.regions, state.bindings);
    let (combined, nonretentive, late_addresses) = (state.combined, state.nonretentive, state.late_addresses);
    let (unclosed, apart) = (state.unclosed, state.apart);
    found.append(&mut tokens.diagnostics);
    tokens.pragmas.retain(|it| !braces.contains(&it.span));
    let test_pragmas = test_pragma::read(file, text, &tokens.pragmas, &mut found);
    found.sort_by_key(|it| (it.span.start, it.span.end));
    diagnostics.append(&mut found);
    let (undecided, reserved, c_code) = (tokens.undecided, tokens.reserved, tokens.c_code);
    File {
        items,
        bindings,
        pragmas: tokens.pragmas,
        test_pragmas,
        regions,
        undecided,
        reserved,
        combined,
        unclosed,
        late_addresses,
        nonretentive,
        c_code,
        apart,
    }
}

/// The expression that is all of a text. `None` where it does not parse, which is reported.
pub fn parse_expression<'s>(file: u16, text: &'s str, diagnostics: &mut Vec<Diagnostic>) -> Option<Expr<'s>> {
    let mut tokens = lex_with(file, text, Habits::default(), Known::Never);
    let mut state = State { is_expression: true, ..State::new(file, text, &tokens, namespace::file(file, text)) };
    let kinds: &[Kind] = &state.tokens.kinds;
    let expr = whole_expression(kinds, &mut state);
    let mut found = state.diagnostics;
    found.append(&mut tokens.diagnostics);
    let is_wrong = found.iter().any(|it| it.severity == Severity::Error);
    diagnostics.append(&mut found);
    expr.filter(|_| !is_wrong)
}

fn whole_expression<'t, 's>(kinds: &'t [Kind], state: &mut State<'t, 's>) -> Option<Expr<'s>> {
    let whole = custom(|input: &mut InputRef<'t, '_, &'t [Kind], Extra<'t, 's>>| {
        let read = expression::expression(input).map_err(|it| diagnostics::report(input, it)).ok();
        let (kind, span) = (input.kind(), input.here());
        if read.is_some() && kind != Kind::End {
            let message =
                format!("expected the end of the expression, found {}", diagnostics::shown(input, kind, span));
            input.report(Diagnostic::new(Code::E0001, span, message).label("the expression is complete before this"));
        }
        while input.next().is_some() {}
        Ok(read)
    });
    whole.parse_with_state(kinds, state).into_output().flatten()
}

fn parse_items<'t, 's>(state: &mut State<'t, 's>) -> Vec<crate::ast::Item<'s>> {
    let kinds: &'t [Kind] = &state.tokens.kinds;
    let file = custom(|input: &mut InputRef<'t, '_, &'t [Kind], Extra<'t, 's>>| {
        let items = unit::items(input);
        while input.next().is_some() {}
        Ok(items)
    });
    file.parse_with_state(kinds, state).into_output().unwrap_or_default()
}
