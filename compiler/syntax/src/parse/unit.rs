//! What a file holds: POUs, TYPE blocks, global variables.

use chumsky::prelude::*;

use crate::{
    Code, Diagnostic,
    ast::{
        Item, Modifiers, Name, Path, Pou, PouKind, Statement, StatementKind, TestPart, TestUnit, TypeDecl, TypeSpec,
        VarBlock, VarDecl, VarKind,
    },
    lex::Kind,
};

use super::{
    chart,
    combinator::{Rule, ahead, name, reported, token, word},
    configuration::{bindings, configuration},
    declaration::{section, structure_members, type_spec},
    diagnostics, doc, foreign_types, misspelt, namespace,
    parser::{Expected, In, State, TokenReader},
    pragma::{attributes_here, external_here, pool_here},
    recovery,
    routine::{self, modifiers},
    statement::statements,
    token_class::{closes, is_end, is_pou_end, opens_item, opens_section, opens_statement},
    type_block::types,
    unsupported,
};

pub fn items<'s>(input: &mut In<'_, '_, 's>) -> Vec<Item<'s>> {
    let mut items = Vec::new();
    loop {
        items.append(&mut input.state().nested);
        match input.kind() {
            Kind::End => {
                namespace::report_open(input);
                return items;
            }
            Kind::Semicolon => {
                input.take();
            }
            Kind::Program => items.push(pou(input, PouKind::Program, Kind::EndProgram)),
            Kind::Function => items.push(pou(input, PouKind::Function, Kind::EndFunction)),
            Kind::FunctionBlock => {
                items.push(pou(input, PouKind::FunctionBlock, Kind::EndFunctionBlock));
            }
            Kind::Type => items.push(Item::Types(types(input))),
            Kind::Struct if input.kind_ahead(1) == Kind::Name => items.push(bare_structure(input)),
            Kind::Configuration => items.push(Item::Configuration(configuration(input))),
            Kind::VarConfig => {
                let mut found = Vec::new();
                bindings(input, &mut found);
                input.state().bindings.append(&mut found);
            }
            Kind::VarGlobal => items.extend(section(input).map(Item::Globals)),
            kind if opens_section(kind) => bare_unit(input, &mut items),
            Kind::Name if namespace::directive(input) => {}
            Kind::EndNamespace if namespace::end(input) => {}
            Kind::Name if input.is_word("CLASS") && input.kind_ahead(1) == Kind::Name => {
                items.push(pou(input, PouKind::Class, Kind::EndClass));
            }
            Kind::Name if input.is_word("INTERFACE") && input.kind_ahead(1) == Kind::Name => {
                items.push(pou(input, PouKind::Interface, Kind::EndInterface));
            }
            Kind::Name if routine::following(input, &mut items, contents) => {}
            Kind::Name if routine::actions(input, &mut items, contents) => {}
            Kind::Name if unsupported::skip(input) => {}
            Kind::Name if begins_test(input) => items.push(test_unit(input)),
            Kind::Name if misspelt_item(input) => {}
            kind if is_statement(input, kind) => bare_unit(input, &mut items),
            kind if closes(kind) => {
                let span = input.take();
                let it = diagnostics::stray(span, kind);
                input.report(it);
            }
            _ => outside(input),
        }
    }
}

/// Something that is between the items of a file.
fn outside(input: &mut In<'_, '_, '_>) {
    let problem = input.problem(Expected::Block);
    diagnostics::report(input, problem);
    input.take();
    recovery::skip_to_item(input);
}

/// `PROGRM Main`: is read as the keyword that was meant.
fn misspelt_item(input: &mut In<'_, '_, '_>) -> bool {
    let Some(kind) = misspelt::misspelt_item(input) else { return false };
    let span = input.take();
    diagnostics::misspelt_keyword(input, kind, span);
    input.state().instead = Some(kind);
    true
}

fn is_statement(input: &mut In<'_, '_, '_>, kind: Kind) -> bool {
    let next = input.kind_ahead(1);
    let used = matches!(next, Kind::Assign | Kind::OpenParen | Kind::Dot | Kind::OpenBracket | Kind::Colon);
    opens_statement(kind) || (kind == Kind::Name && used)
}

/// VAR blocks and statements without the PROGRAM around them: they are read as a unit without a
/// name, or as global variables.
fn bare_unit<'s>(input: &mut In<'_, '_, 's>, items: &mut Vec<Item<'s>>) {
    let opened = input.here();
    let name = Name { text: "", span: opened };
    let mut pou = Pou::new(PouKind::Program, name, opened);
    input.state().open.push((Kind::EndProgram, opened));
    contents(input, &mut pou);
    input.state().open.pop();
    let closed = is_pou_end(input.kind());
    if closed {
        input.take();
    }
    let statements = closed || !pou.body.is_empty();
    input.report(diagnostics::outside_of_units(opened, statements));
    if statements {
        items.push(Item::Pou(pou));
    } else {
        items.extend(pou.blocks.into_iter().map(Item::Globals));
    }
}

/// `STRUCT Name … END_STRUCT` outside of TYPE.
fn bare_structure<'s>(input: &mut In<'_, '_, 's>) -> Item<'s> {
    let word = input.take();
    let span = input.here();
    let name = Name { text: input.text(span), span };
    input.take();
    input.report(diagnostics::bare_structure(word.to(span), name.text));
    let kind = structure_members(input);
    let ty = TypeSpec { kind, span: word.to(input.last()) };
    input.eat(Kind::Semicolon);
    Item::Types(vec![TypeDecl::new(name, ty)])
}

/// Takes a unit that is inside another one, if the other one continues after it.
fn nested_unit(input: &mut In<'_, '_, '_>) -> bool {
    let Some((end, opened)) = input.state().open.last().copied() else { return false };
    if !opens_item(input.kind()) || !goes_on(input, end) {
        return false;
    }
    let (kind, span) = (input.kind(), input.here());
    let outer = input.text(opened).to_ascii_uppercase();
    input.report(diagnostics::nested_unit(span, kind, &outer));
    let item = match kind {
        Kind::Type => Item::Types(types(input)),
        Kind::Function => pou(input, PouKind::Function, Kind::EndFunction),
        Kind::FunctionBlock => pou(input, PouKind::FunctionBlock, Kind::EndFunctionBlock),
        Kind::Program => pou(input, PouKind::Program, Kind::EndProgram),
        _ => Item::Configuration(configuration(input)),
    };
    input.state().nested.push(item);
    true
}

/// Whether `end` comes once more than units that it ends are opened from here on, with all units
/// from here on closed.
fn goes_on(input: &mut In<'_, '_, '_>, end: Kind) -> bool {
    let (mut open, mut ahead) = (Vec::new(), 0);
    loop {
        match input.kind_ahead(ahead) {
            Kind::End => return false,
            Kind::Program => open.push(Kind::EndProgram),
            Kind::Function => open.push(Kind::EndFunction),
            Kind::FunctionBlock => open.push(Kind::EndFunctionBlock),
            kind if is_pou_end(kind) => match open.pop() {
                Some(wanted) if wanted == kind => {}
                None => return kind == end,
                Some(_) => return false,
            },
            _ => {}
        }
        ahead += 1;
    }
}

/// VAR blocks, then statements.
fn contents<'s>(input: &mut In<'_, '_, 's>, pou: &mut Pou<'s>) {
    let outer = std::mem::take(&mut input.state().strays);
    input.state().misaligned = None;
    loop {
        let mut more = statements(input);
        if pou.body.is_empty() {
            pou.body = more;
        } else {
            pou.body.append(&mut more);
        }
        if nested_unit(input) || routine::member(input, pou, contents) || chart::element(input, pou) {
            continue;
        }
        if !opens_section(input.kind()) {
            break;
        }
        if input.kind() == Kind::VarConfig {
            let span = input.here();
            input.report(diagnostics::bindings_in_a_unit(span));
            let mut found = Vec::new();
            bindings(input, &mut found);
            input.state().bindings.append(&mut found);
            continue;
        }
        let read = |it: &Statement<'_>| !matches!(it.kind, StatementKind::Empty | StatementKind::Error);
        if pou.body.iter().any(read) {
            let span = input.here();
            input.report(diagnostics::declaration_behind_statements(span));
        }
        pou.blocks.extend(section(input));
    }
    let vars = std::mem::replace(&mut input.state().strays, outer);
    if !vars.is_empty() {
        let span = vars[0].span;
        pou.blocks.push(VarBlock { vars, ..VarBlock::new(VarKind::Var, span) });
    }
    input.state().begins.clear();
}

fn pou<'s>(input: &mut In<'_, '_, 's>, kind: PouKind, end: Kind) -> Item<'s> {
    let first = input.number();
    let doc = doc::before(input.state(), first);
    let (attributes, external, pool) = (attributes_here(input), external_here(input), pool_here(input));
    let opened = input.take();
    let (mut kind, mut end) = (kind, end);
    if kind == PouKind::Function && input.is_word("BLOCK") && input.kind_ahead(1) == Kind::Name {
        let span = opened.to(input.take());
        diagnostics::misspelt_keyword(input, Kind::FunctionBlock, span);
        (kind, end) = (PouKind::FunctionBlock, Kind::EndFunctionBlock);
    }
    let (modifiers, name, (extends, implements), parameters, result) =
        input.parse(head(kind)).unwrap_or_else(|problem| {
            diagnostics::report(input, problem);
            recovery::go_to(input, problem);
            recovery::skip_head(input);
            (Modifiers::default(), Name { text: "", span: opened }, (Vec::new(), Vec::new()), None, None)
        });
    let span = opened.to(name.span);
    second_word_of_name(input, name);
    if kind != PouKind::Function && input.kind() == Kind::Colon {
        let from = input.take();
        let _ = input.parse(type_spec());
        let whole = from.to(input.last());
        let it = diagnostics::no_result_type(whole, input.text(opened));
        input.report(it);
    }
    input.eat(Kind::Semicolon);
    input.state().open.push((end, opened));
    let mut pou = Pou { modifiers, result, attributes, external, pool, doc, ..Pou::new(kind, name, span) };
    let (mut extends, mut implements) = (extends, implements);
    if unsupported::begins_generic(input) {
        // They are read as variables of types that are not known, so that what uses them is not refused, too.
        unsupported::generic_constants(input);
        input.state().instead = Some(Kind::Var);
        pou.blocks.extend(section(input).map(unsupported::unknown));
        let later = input.parse(names_after("EXTENDS").then(names_after("IMPLEMENTS"))).unwrap_or_default();
        extends.extend(later.0);
        implements.extend(later.1);
    }
    if !implements.is_empty() {
        extends.extend(late_bases(input, name));
    }
    bases(input, &mut pou, extends, implements);
    pou.blocks.extend(parameters);
    let region = namespace::of_pou(input, opened);
    contents(input, &mut pou);
    namespace::close(input, region);
    input.state().open.pop();
    if input.eat(end).is_none() {
        if is_pou_end(input.kind()) {
            diagnostics::wrong_end(input, end, opened);
            input.take();
        } else {
            diagnostics::missing_end(input, end, opened);
        }
    }
    pou.extent = opened.to(input.last());
    name_after_end(input, name);
    if kind == PouKind::Class {
        report_parts_of_class(input, &mut pou);
    }
    Item::Pou(pou)
}

/// `PROGRAM My Program`: takes a word that is between the name and the end of the line.
fn second_word_of_name(input: &mut In<'_, '_, '_>, name: Name<'_>) {
    let is_word = input.kind() == Kind::Name || opens_item(input.kind());
    if name.text.is_empty() || !is_word || input.on_new_line() || routine::begins(input).is_some() {
        return;
    }
    let at = input.number();
    let (word, next) = (input.here(), input.state().place(at + 1));
    if !input.state().breaks(word.end, next.start) {
        return;
    }
    input.take();
    let whole = name.span.to(word);
    let meant = format!("{}_{}", name.text, input.text(word));
    input.report(
        Diagnostic::new(Code::E0001, whole, "a name has no spaces")
            .label("these are two words")
            .help(format!("write `{meant}`"))
            .fix(whole, meant),
    );
}

/// `END_PROGRAM Main`: takes the name.
fn name_after_end(input: &mut In<'_, '_, '_>, name: Name<'_>) {
    if !input.is_word(name.text) || input.on_new_line() {
        return;
    }
    let span = input.take();
    let it = diagnostics::name_after_end(span);
    input.report(it);
}

/// Reports what a CLASS cannot have, and takes it out.
fn report_parts_of_class(input: &mut In<'_, '_, '_>, pou: &mut Pou<'_>) {
    let statement = pou.body.iter().find(|it| !matches!(it.kind, StatementKind::Empty));
    if let Some(it) = statement {
        input.report(diagnostics::not_in_a_class(it.span, "body"));
    }
    pou.body.clear();
    let of_class = |it: &VarBlock<'_>| matches!(it.kind, VarKind::Var | VarKind::Stat | VarKind::External);
    for block in pou.blocks.iter().filter(|it| !of_class(it)) {
        let word = input.text(block.span).to_ascii_uppercase();
        input.report(diagnostics::not_in_a_class(block.span, &word));
    }
    pou.blocks.retain(of_class);
}

/// The parts of a unit test. Their words are names everywhere else.
const TEST_PARTS: [(&str, TestPart, Kind); 3] = [
    ("SETUP", TestPart::Setup, Kind::EndSetup),
    ("TEARDOWN", TestPart::Teardown, Kind::EndTeardown),
    ("TEST", TestPart::Test, Kind::EndTest),
];

fn test_part(input: &mut In<'_, '_, '_>) -> Option<(TestPart, Kind)> {
    let word = input.here();
    let word = input.text(word);
    TEST_PARTS.iter().find(|it| word.eq_ignore_ascii_case(it.0)).map(|it| (it.1, it.2))
}

/// Whether a part of a test begins here: its word, and for a TEST its title.
fn begins_test(input: &mut In<'_, '_, '_>) -> bool {
    let next = input.kind_ahead(1);
    let is_used = matches!(next, Kind::Assign | Kind::OpenParen | Kind::Dot | Kind::OpenBracket | Kind::Colon);
    match test_part(input) {
        Some((TestPart::Test, _)) => matches!(next, Kind::Text | Kind::WideText),
        Some((TestPart::Setup | TestPart::Teardown, _)) => !is_used,
        None => false,
    }
}

/// SETUP, TEARDOWN or TEST, up to its end.
fn test_unit<'s>(input: &mut In<'_, '_, 's>) -> Item<'s> {
    let (part, end) = test_part(input).unwrap_or((TestPart::Test, Kind::EndTest));
    let opened = input.take();
    let span = if part == TestPart::Test { input.take() } else { opened };
    let name = Name { text: input.text(span), span };
    let span = opened.to(span);
    let mut pou = Pou::new(PouKind::Test, name, span);
    input.state().open.push((end, opened));
    let region = namespace::of_pou(input, opened);
    contents(input, &mut pou);
    namespace::close(input, region);
    input.state().open.pop();
    if input.eat(end).is_none() {
        if is_end(input.kind()) {
            diagnostics::wrong_end(input, end, opened);
            input.take();
        } else {
            diagnostics::missing_end(input, end, opened);
        }
    }
    // Not only its head: its declarations are distinguished from those of SETUP.
    pou.span = pou.span.to(input.last());
    input.eat(Kind::Semicolon);
    Item::Test(TestUnit { part, pou })
}

/// The words before a unit's name, the name, what follows it in parentheses, and a function's result type.
type Head<'s> = (Modifiers, Name<'s>, (Vec<Path<'s>>, Vec<Path<'s>>), Option<VarBlock<'s>>, Option<TypeSpec<'s>>);

fn head<'t, 's: 't>(kind: PouKind) -> impl Rule<'t, 's, Head<'s>> {
    let function = ahead(move |_| kind == PouKind::Function);
    let bases = names_after("EXTENDS").then(names_after("IMPLEMENTS"));
    let colon = token(Kind::Colon).ignored().or(foreign_types::no_colon_in_head());
    let result = function.clone().ignore_then(colon).ignore_then(type_spec());
    let no_result = ahead(move |input| kind != PouKind::Function || input.kind() != Kind::Colon).to(None);
    let usual = name().then(bases).then(parameters().or_not()).then(result.map(Some).or(no_result));
    let swapped = function.ignore_then(foreign_types::result_before_name());
    let no_bases = || (Vec::new(), Vec::new());
    let swapped = swapped.map(move |(name, ty)| (name, no_bases(), None, Some(ty)));
    let head = swapped.or(usual.map(|(((name, bases), vars), ty)| (name, bases, vars, ty)));
    modifiers().then(head).map(|(modifiers, (name, bases, vars, ty))| (modifiers, name, bases, vars, ty))
}

/// `EXTENDS a, b.c`, if present.
fn names_after<'t, 's: 't>(keyword: &'static str) -> impl Rule<'t, 's, Vec<Path<'s>>> {
    let path = name().separated_by(token(Kind::Dot)).at_least(1).collect::<Vec<_>>();
    let path = ahead(|input| routine::begins(input).is_none()).ignore_then(path);
    let path = path.then_ignore(unsupported::generic_values());
    // TwinCAT writes a comma after the last of an INTERFACE's, and reads it.
    let paths = path.separated_by(token(Kind::Comma)).at_least(1).allow_trailing();
    let names = word(keyword).ignore_then(paths.collect());
    names.or(ahead(move |input| !input.is_word(keyword)).map(|()| Vec::new()))
}

/// `EXTENDS b` after IMPLEMENTS.
fn late_bases<'s>(input: &mut In<'_, '_, 's>, name: Name<'s>) -> Vec<Path<'s>> {
    if !input.is_word("EXTENDS") {
        return Vec::new();
    }
    let from = input.here();
    let paths = input.parse(names_after("EXTENDS")).unwrap_or_default();
    let span = from.to(input.last());
    let text = input.text(span);
    input.report(
        Diagnostic::new(Code::E0001, span, "EXTENDS comes before IMPLEMENTS")
            .label("expected before IMPLEMENTS")
            .help(format!("write `{} {text} IMPLEMENTS …`", name.text)),
    );
    paths
}

/// Gives a unit what it EXTENDS.
fn bases<'s>(input: &mut In<'_, '_, 's>, pou: &mut Pou<'s>, extends: Vec<Path<'s>>, implements: Vec<Path<'s>>) {
    pou.bases = [extends.as_slice(), implements.as_slice()].concat();
    let last = |paths: Vec<Path<'s>>| -> Vec<Name<'s>> { paths.iter().filter_map(|it| it.last().copied()).collect() };
    let extends = last(extends);
    pou.implements = last(implements);
    if pou.kind == PouKind::Interface {
        if let Some(first) = pou.implements.first() {
            let it = diagnostics::interface_implements(first.span, pou.name.text, first.text);
            input.report(it);
        }
        pou.implements.splice(0..0, extends);
        return;
    }
    let misplaced = if pou.kind.is_block() { extends.get(1) } else { extends.first().or(pou.implements.first()) };
    if let Some(name) = misplaced {
        let it = diagnostics::too_many_bases(name.span, pou.kind);
        input.report(it);
    }
    pou.extends = extends.first().copied().filter(|_| pou.kind.is_block());
}

/// A parameter as VAR_INPUT has it.
fn declared(state: &State<'_, '_>, parameter: &VarDecl<'_>) -> String {
    let names: Vec<_> = parameter.names.iter().map(|it| it.text).collect();
    format!("{} : {};", names.join(", "), state.slice(parameter.ty.span))
}

/// `(x : INT; y : REAL)` after a function's name, as other languages have it.
fn parameters<'t, 's: 't>() -> impl Rule<'t, 's, VarBlock<'s>> {
    let names = name().separated_by(token(Kind::Comma)).at_least(1).collect::<Vec<_>>();
    let vars = names.then_ignore(token(Kind::Colon)).then(type_spec()).map_with(|(names, ty), extra| {
        let tokens = extra.span();
        let span = extra.state().span(tokens);
        VarDecl::new(names, ty, span)
    });
    let separator = token(Kind::Semicolon).or(token(Kind::Comma)).or_not();
    let vars = vars.then_ignore(separator).repeated().collect::<Vec<_>>();
    let vars = vars.delimited_by(token(Kind::OpenParen), token(Kind::CloseParen));
    reported(vars, |vars: Vec<VarDecl<'s>>, state, tokens| {
        let (opened, whole) = (state.place(tokens.start), state.span(tokens));
        let declared: Vec<_> = vars.iter().map(|it| declared(state, it)).collect();
        state.report(diagnostics::parameters_in_head(whole, &declared.join(" ")));
        VarBlock { vars, ..VarBlock::new(VarKind::Input, opened) }
    })
}
