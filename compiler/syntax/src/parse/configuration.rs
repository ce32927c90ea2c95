//! CONFIGURATION, RESOURCE, TASK and the programs in them.

use chumsky::prelude::*;

use crate::{
    ast::{Binding, Configuration, Name, ProgramInstance, Resource, Task, VarDecl},
    lex::Kind,
    source::Span,
};

use super::{
    block_ends,
    combinator::{Rule, list, name, rule, token, word},
    declaration::{section, type_spec},
    diagnostics,
    expression::{arguments, expr},
    initial::{assign, optional_initial},
    parser::{Expected, In, Problem, TokenReader},
    recovery,
    token_class::{ends_statements, opens_section},
};

/// `TASK t (INTERVAL := T#20ms, PRIORITY := 1);`
fn task<'t, 's: 't>() -> impl Rule<'t, 's, Task<'s>> {
    let property = name().then_ignore(assign()).then(expr());
    let properties = list(property).delimited_by(token(Kind::OpenParen), token(Kind::CloseParen));
    let task = word("TASK").ignore_then(name()).then(properties.or_not()).then_ignore(end());
    task.map(|(name, properties)| Task { name, properties: properties.unwrap_or_default() })
}

/// `PROGRAM main WITH t : Main(x := g);`
fn program<'t, 's: 't>() -> impl Rule<'t, 's, ProgramInstance<'s>> {
    let task = word("WITH").ignore_then(name()).or_not();
    let connections = rule(|input| match input.kind() {
        Kind::OpenParen if !refuse_tasks_of_blocks(input) => arguments(input),
        _ => Ok(Vec::new()),
    });
    let program = token(Kind::Program).ignore_then(name()).then(task).then_ignore(token(Kind::Colon));
    let path = name().separated_by(token(Kind::Dot)).at_least(1).collect::<Vec<_>>();
    let program = program.then(path).then(connections).then_ignore(end());
    program.map(|(((name, task), mut path), connections)| {
        let program = path.pop().unwrap_or(name);
        ProgramInstance { name, task, namespace: path, program, connections }
    })
}

/// Refuses and skips `(valve WITH t)`, a FUNCTION_BLOCK of the PROGRAM that another TASK runs.
fn refuse_tasks_of_blocks(input: &mut In<'_, '_, '_>) -> bool {
    let mut ahead = 1;
    while !matches!(input.kind_ahead(ahead), Kind::End | Kind::Semicolon | Kind::Assign | Kind::Arrow) {
        if (input.kind_ahead(ahead), input.kind_ahead(ahead + 1)) == (Kind::Name, Kind::Name) {
            let span = input.here();
            input.report(
                diagnostics::unsupported(span, "a FUNCTION_BLOCK of a PROGRAM that has a TASK of its own")
                    .help("declare the block in a PROGRAM of its own, and run that with the other TASK"),
            );
            while !matches!(input.kind(), Kind::End | Kind::Semicolon) {
                input.take();
            }
            return true;
        }
        ahead += 1;
    }
    false
}

/// `RESOURCE name ON machine`
fn resource_head<'t, 's: 't>() -> impl Rule<'t, 's, Name<'s>> {
    word("RESOURCE").ignore_then(name()).then_ignore(word("ON").ignore_then(name()).or_not())
}

fn end<'t, 's: 't>() -> impl Rule<'t, 's, ()> {
    let missing = rule(|input| {
        if !input.on_new_line() && !ends_statements(input.kind()) {
            return Err(input.problem(Expected::Token(Kind::Semicolon)));
        }
        diagnostics::missing_semicolon(input);
        Ok(())
    });
    token(Kind::Semicolon).ignored().or(missing)
}

/// `run.valve.open AT %QX0.1 : BOOL := FALSE;`, `run.valve.moves : INT := 5;`
fn binding<'t, 's: 't>() -> impl Rule<'t, 's, Binding<'s>> {
    let address = token(Kind::At)
        .ignore_then(token(Kind::Address).map_with(|span, extra| Name { text: extra.state().slice(span), span }));
    let typed = token(Kind::Colon).ignore_then(type_spec()).then(optional_initial());
    let binding = expr().then(address.or_not()).then(typed).then_ignore(end());
    binding.map(|((target, address), (ty, initial))| {
        let span = target.span;
        let names = address.into_iter().collect();
        let located = VarDecl { address, initial, ..VarDecl::new(names, ty, span) };
        Binding { target, located }
    })
}

/// VAR_CONFIG … END_VAR
pub fn bindings<'s>(input: &mut In<'_, '_, 's>, into: &mut Vec<Binding<'s>>) {
    let opened = input.take();
    loop {
        let start = input.here();
        match input.kind() {
            Kind::Semicolon => drop(input.take()),
            kind if kind == Kind::EndVar || opens_section(kind) || ends_statements(kind) => break,
            _ => match input.parse(binding()) {
                Ok(it) => into.push(it),
                Err(problem) => recover(input, problem, start),
            },
        }
    }
    block_ends::close_block(input, Kind::EndVar, opened);
    input.eat(Kind::Semicolon);
}

pub fn configuration<'s>(input: &mut In<'_, '_, 's>) -> Configuration<'s> {
    let span = input.take();
    input.state().open.push((Kind::EndConfiguration, span));
    let name = input.name().unwrap_or_else(|problem| {
        diagnostics::report(input, problem);
        Name { text: "", span }
    });
    let mut configuration = Configuration {
        name,
        globals: Vec::new(),
        resources: Vec::new(),
        bindings: Vec::new(),
        span: span.to(name.span),
    };
    let mut direct = Resource::default();
    loop {
        if input.is_word("RESOURCE") && input.kind_ahead(1) == Kind::Name {
            configuration.resources.push(resource(input));
        } else if !element(input, &mut direct, Kind::EndConfiguration) {
            break;
        }
    }
    configuration.globals = core::mem::take(&mut direct.globals);
    configuration.bindings = core::mem::take(&mut direct.bindings);
    for resource in &mut configuration.resources {
        configuration.bindings.append(&mut resource.bindings);
    }
    if !direct.tasks.is_empty() || !direct.programs.is_empty() {
        configuration.resources.push(direct);
    }
    input.state().open.pop();
    if input.eat(Kind::EndConfiguration).is_none() {
        diagnostics::missing_end(input, Kind::EndConfiguration, span);
    }
    configuration
}

/// RESOURCE … END_RESOURCE
fn resource<'s>(input: &mut In<'_, '_, 's>) -> Resource<'s> {
    let opened = input.here();
    input.state().open.push((Kind::EndResource, opened));
    let mut resource = Resource::default();
    match input.parse(resource_head()) {
        Ok(name) => resource.name = Some(name),
        Err(problem) => {
            diagnostics::report(input, problem);
            recovery::go_to(input, problem);
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
        Kind::Program => input.parse(program()).map(|it| into.programs.push(it)),
        Kind::VarConfig => {
            bindings(input, &mut into.bindings);
            return true;
        }
        kind if opens_section(kind) => {
            into.globals.extend(section(input));
            return true;
        }
        kind if kind == end || ends_statements(kind) => {
            return kind != end && recovery::stray(input);
        }
        _ if input.is_word("TASK") => input.parse(task()).map(|it| into.tasks.push(it)),
        _ => Err(input.problem(Expected::Token(end))),
    };
    if let Err(problem) = result {
        recover(input, problem, start);
    }
    true
}

/// Reports what does not parse, and continues after it.
fn recover(input: &mut In<'_, '_, '_>, problem: Problem, start: Span) {
    input.state().depth = 0;
    diagnostics::report(input, problem);
    recovery::go_to(input, problem);
    if input.here().start == start.start {
        input.take();
    }
    recovery::skip_statement(input, start);
}
