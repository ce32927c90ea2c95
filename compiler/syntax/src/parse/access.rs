//! VAR_ACCESS: names under which others, outside of the program, reach its variables. It is read, and has no effect on
//! what a program does.

use chumsky::prelude::*;

use crate::lex::Kind;

use super::{
    block_ends,
    combinator::{Rule, name, rule, token, word},
    diagnostics,
    parser::{Expected, In, Parsed, TokenReader},
    recovery,
    token_class::{ends_statements, opens_section},
};

/// VAR_ACCESS … END_VAR
pub fn access_paths(input: &mut In<'_, '_, '_>) {
    let opened = input.take();
    loop {
        let start = input.here();
        match input.kind() {
            Kind::Semicolon => drop(input.take()),
            kind if kind == Kind::EndVar || opens_section(kind) || ends_statements(kind) => break,
            _ => {
                if let Err(problem) = input.parse(access_path()) {
                    input.state().depth = 0;
                    diagnostics::report(input, problem);
                    recovery::go_to(input, problem);
                    recovery::skip_statement(input, start);
                }
            }
        }
    }
    block_ends::close_block(input, Kind::EndVar, opened);
    input.eat(Kind::Semicolon);
}

/// `able : station.run.level : INT READ_ONLY;`
fn access_path<'t, 's: 't>() -> impl Rule<'t, 's, ()> {
    let direction = word("READ_ONLY").or(word("READ_WRITE")).or_not();
    let named = name().then(token(Kind::Colon)).then(rule(path)).then(token(Kind::Colon));
    named.then(rule(path)).then(direction).then(token(Kind::Semicolon)).ignored()
}

/// `station.%IX1.1`, `station.run.valves[2].open`; a type's name, `STRING[10]`.
fn path(input: &mut In<'_, '_, '_>) -> Parsed<()> {
    loop {
        if !matches!(input.kind(), Kind::Name | Kind::Address) {
            return Err(input.problem(Expected::Name));
        }
        input.take();
        while input.eat(Kind::OpenBracket).is_some() {
            while matches!(input.kind(), Kind::Integer | Kind::Minus | Kind::Comma | Kind::Name | Kind::Dot) {
                input.take();
            }
            input.expect(Kind::CloseBracket)?;
        }
        if input.eat(Kind::Dot).is_none() {
            return Ok(());
        }
    }
}
