//! CONFIGURATION, RESOURCE, TASK and the programs in them.

use chumsky::{input::InputRef, prelude::*};

use crate::{
    ast::{Configuration, Expr, Name, ProgramInstance, Resource, Task},
    lex::Kind,
};

use super::{
    declaration::section,
    diagnostics,
    expression::{self, arguments},
    parser::{Extra, In, Moves, Parsed, Problem},
    recover,
};

/// The parts of a configuration have no statements to recover between, so they are combinators.
trait Part<'t, 's: 't, T>: Parser<'t, &'t [Kind], T, Extra<'t, 's>> + Clone {}
impl<'t, 's: 't, T, P: Parser<'t, &'t [Kind], T, Extra<'t, 's>> + Clone> Part<'t, 's, T> for P {}

fn name<'t, 's: 't>() -> impl Part<'t, 's, Name<'s>> {
    custom(|input: &mut InputRef<'t, '_, &'t [Kind], Extra<'t, 's>>| input.name())
}

/// `t (INTERVAL := T#20ms, PRIORITY := 1)`
fn task<'t, 's: 't>() -> impl Part<'t, 's, Task<'s>> {
    let value = custom(|input: &mut InputRef<'t, '_, &'t [Kind], Extra<'t, 's>>| expression::expression(input));
    let property = name().then_ignore(just(Kind::Assign)).then(value);
    let properties = property
        .separated_by(just(Kind::Comma))
        .collect::<Vec<(Name<'s>, Expr<'s>)>>()
        .delimited_by(just(Kind::OpenParen), just(Kind::CloseParen));
    name().then(properties.or_not()).map(|(name, properties)| Task { name, properties: properties.unwrap_or_default() })
}

/// `main WITH t : Main`; WITH is a name elsewhere.
fn program<'t, 's: 't>() -> impl Part<'t, 's, ProgramInstance<'s>> {
    let with = custom(|input: &mut InputRef<'t, '_, &'t [Kind], Extra<'t, 's>>| {
        if input.is_word("WITH") {
            input.take();
            input.name().map(Some)
        } else {
            Ok(None)
        }
    });
    name().then(with).then_ignore(just(Kind::Colon)).then(name()).map(|((name, task), program)| ProgramInstance {
        name,
        task,
        program,
    })
}

pub fn configuration<'s>(input: &mut In<'_, '_, 's>) -> Configuration<'s> {
    let span = input.take();
    input.state().open.push((Kind::EndConfiguration, span));
    let name = input.name().unwrap_or_else(|problem| {
        diagnostics::report(input, problem);
        Name { text: "", span }
    });
    let mut configuration =
        Configuration { name, globals: Vec::new(), resources: Vec::new(), span: span.to(name.span) };
    let mut direct = Resource::default();
    loop {
        if input.is_word("RESOURCE") && input.kind_ahead(1) == Kind::Name {
            configuration.resources.push(resource(input));
        } else if !element(input, &mut direct, Kind::EndConfiguration) {
            break;
        }
    }
    configuration.globals = core::mem::take(&mut direct.globals);
    if !direct.tasks.is_empty() || !direct.programs.is_empty() {
        configuration.resources.push(direct);
    }
    input.state().open.pop();
    if input.eat(Kind::EndConfiguration).is_none() {
        diagnostics::missing_end(input, Kind::EndConfiguration, span);
    }
    configuration
}

/// `RESOURCE name ON machine … END_RESOURCE`
fn resource<'s>(input: &mut In<'_, '_, 's>) -> Resource<'s> {
    let opened = input.take();
    input.state().open.push((Kind::EndResource, opened));
    let mut resource = Resource { name: input.name().ok(), ..Resource::default() };
    if input.is_word("ON") {
        input.take();
        if let Err(problem) = input.name() {
            diagnostics::report(input, problem);
        }
    }
    while element(input, &mut resource, Kind::EndResource) {}
    input.state().open.pop();
    if input.eat(Kind::EndResource).is_none() {
        diagnostics::missing_end(input, Kind::EndResource, opened);
    }
    input.eat(Kind::Semicolon);
    resource
}

/// One thing of a resource; false at its end.
fn element<'s>(input: &mut In<'_, '_, 's>, into: &mut Resource<'s>, end: Kind) -> bool {
    let start = input.here();
    let result = match input.kind() {
        Kind::Semicolon => {
            input.take();
            return true;
        }
        Kind::Program => program_instance(input).map(|it| into.programs.push(it)),
        kind if recover::opens_section(kind) => {
            into.globals.extend(section(input));
            return true;
        }
        kind if kind == end || recover::ends_statements(kind) => {
            return kind != end && recover::stray(input);
        }
        _ if input.is_word("TASK") => {
            input.take();
            input.parse(task()).and_then(|it| finish(input, it)).map(|it| into.tasks.push(it))
        }
        _ => Err(input.problem(super::parser::Expected::Token(end))),
    };
    if let Err(problem) = result {
        input.state().depth = 0;
        diagnostics::report(input, problem);
        if input.here().start == start.start {
            input.take();
        }
        recover::skip_statement(input, start);
    }
    true
}

fn program_instance<'s>(input: &mut In<'_, '_, 's>) -> Parsed<ProgramInstance<'s>> {
    input.take();
    let instance = input.parse(program())?;
    if input.kind() == Kind::OpenParen {
        let span = input.here();
        arguments(input)?;
        input.report(diagnostics::unsupported(span, "connecting a program's variables here"));
    }
    finish(input, instance)
}

fn finish<T>(input: &mut In<'_, '_, '_>, value: T) -> Result<T, Problem> {
    if input.eat(Kind::Semicolon).is_none() {
        if !input.on_new_line() && !recover::ends_statements(input.kind()) {
            return Err(input.problem(super::parser::Expected::Token(Kind::Semicolon)));
        }
        diagnostics::missing_semicolon(input);
    }
    Ok(value)
}
