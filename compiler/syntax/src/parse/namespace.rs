//! NAMESPACE … END_NAMESPACE and USING. A namespace makes a region of the file; what is in it is read as
//! what is outside.

use chumsky::prelude::*;

use crate::{
    ast::{Path, Region},
    lex::Kind,
    source::Span,
};

use super::{
    combinator::{Rule, list, name, token, word},
    diagnostics,
    parser::{In, TokenReader},
    recovery,
};

/// Namespaces in one another.
const MAX_NESTED: usize = 64;

/// The region that a whole file is.
pub fn file<'s>(file: u16, text: &str) -> Region<'s> {
    let end = u32::try_from(text.len()).unwrap_or(u32::MAX);
    Region { path: Vec::new(), internal: false, uses: Vec::new(), span: Span { file, start: 0, end } }
}

/// Takes what opens a namespace, or a USING, if that is here.
pub fn directive(input: &mut In<'_, '_, '_>) -> bool {
    if input.kind_ahead(1) != Kind::Name {
        return false;
    }
    if input.is_word("USING") {
        using(input);
        return true;
    }
    let opens = input.is_word("NAMESPACE");
    if opens {
        open(input);
    }
    opens
}

fn open(input: &mut In<'_, '_, '_>) {
    let opened = input.here();
    let head = word("NAMESPACE").ignore_then(word("INTERNAL").or_not()).then(path());
    let (internal, path) = input.parse(head).unwrap_or_else(|problem| {
        diagnostics::report(input, problem);
        recovery::go_to(input, problem);
        (None, Vec::new())
    });
    input.eat(Kind::Semicolon);
    if input.state().around.len() > MAX_NESTED {
        let span = opened.to(input.last());
        input.state().stop(span, format!("namespaces are nested more than {MAX_NESTED} deep"));
        return;
    }
    push(input, Region { path, internal: internal.is_some(), uses: Vec::new(), span: opened });
    input.state().open.push((Kind::EndNamespace, opened));
}

fn push<'s>(input: &mut In<'_, '_, 's>, region: Region<'s>) {
    let state = input.state();
    state.around.push(state.regions.len());
    state.regions.push(region);
}

/// END_NAMESPACE of one that is open.
pub fn end(input: &mut In<'_, '_, '_>) -> bool {
    if input.state().around.len() == 1 {
        return false;
    }
    let last = input.take();
    input.eat(Kind::Semicolon);
    input.state().open.pop();
    leave(input, last);
    true
}

fn leave(input: &mut In<'_, '_, '_>, last: Span) {
    let state = input.state();
    if let Some(region) = state.around.pop() {
        let region = &mut state.regions[region];
        region.span = region.span.to(last);
    }
}

/// The namespaces that the file does not end.
pub fn report_open(input: &mut In<'_, '_, '_>) {
    while input.state().around.len() > 1 {
        if let Some((end, opened)) = input.state().open.pop() {
            diagnostics::missing_end(input, end, opened);
        }
        let last = input.here();
        leave(input, last);
    }
}

/// The USING directives of a POU, which are between its head and its variables: whether they make a region.
pub fn of_pou<'s>(input: &mut In<'_, '_, 's>, opened: Span) -> bool {
    let begins = |input: &mut In<'_, '_, 's>| input.is_word("USING") && input.kind_ahead(1) == Kind::Name;
    if !begins(input) {
        return false;
    }
    push(input, Region { path: Vec::new(), internal: false, uses: Vec::new(), span: opened });
    while begins(input) {
        using(input);
    }
    true
}

/// After a POU's last statement.
pub fn close(input: &mut In<'_, '_, '_>, region: bool) {
    if region {
        let last = input.last();
        leave(input, last);
    }
}

/// `USING A, B.C;`
fn using(input: &mut In<'_, '_, '_>) {
    let start = input.here();
    match input.parse(word("USING").ignore_then(list(path())).then_ignore(token(Kind::Semicolon).or_not())) {
        Ok(paths) => {
            let state = input.state();
            let around = state.around.last().copied().unwrap_or(0);
            state.regions[around].uses.extend(paths);
        }
        Err(problem) => {
            diagnostics::report(input, problem);
            recovery::go_to(input, problem);
            recovery::skip_statement(input, start);
        }
    }
}

fn path<'t, 's: 't>() -> impl Rule<'t, 's, Path<'s>> {
    name().separated_by(token(Kind::Dot)).at_least(1).collect()
}

/// `PUBLIC` or `INTERNAL` before the name of what a namespace holds: whether it is INTERNAL.
pub fn access(input: &mut In<'_, '_, '_>) -> bool {
    let mut internal = false;
    while input.kind_ahead(1) == Kind::Name && (input.is_word("PUBLIC") || input.is_word("INTERNAL")) {
        internal |= input.is_word("INTERNAL");
        input.take();
    }
    internal
}
