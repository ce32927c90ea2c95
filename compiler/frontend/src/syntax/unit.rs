//! What a file holds: POUs, TYPE blocks, global variables.

use crate::{
    ast::{
        Item, Name, Pou, PouKind, Statement, StatementKind, TypeDecl, TypeKind, TypeSpec, VarBlock, VarDecl, VarKind,
    },
    lex::Kind,
};

use super::{
    configuration::configuration,
    declaration::section,
    diagnostics, doc,
    parser::{Expected, In, Moves, Parsed, Problem},
    recover,
    statement::statements,
    types::{structure_behind, type_spec, types},
    unsupported,
};

pub fn items<'s>(input: &mut In<'_, '_, 's>) -> Vec<Item<'s>> {
    let mut items = Vec::new();
    loop {
        items.append(&mut input.state().nested);
        match input.kind() {
            Kind::End => return items,
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
            Kind::VarGlobal => items.extend(section(input).map(Item::Globals)),
            kind if recover::opens_section(kind) => bare_unit(input, &mut items),
            Kind::Name if unsupported::skip(input) => {}
            Kind::Name if misspelt_item(input) => {}
            kind if is_statement(input, kind) => bare_unit(input, &mut items),
            kind if recover::closes(kind) => {
                let span = input.take();
                let it = diagnostics::stray(span, kind);
                input.report(it);
            }
            _ => outside(input),
        }
    }
}

/// Something that stands between the items of a file.
fn outside(input: &mut In<'_, '_, '_>) {
    let problem = input.problem(Expected::Block);
    diagnostics::report(input, problem);
    input.take();
    recover::skip_to_item(input);
}

/// `PROGRM Main`: is read as the keyword that was meant.
fn misspelt_item(input: &mut In<'_, '_, '_>) -> bool {
    let Some(kind) = diagnostics::misspelt_item(input) else { return false };
    let span = input.take();
    diagnostics::misspelt_keyword(input, kind, span);
    input.state().instead = Some(kind);
    true
}

fn is_statement(input: &mut In<'_, '_, '_>, kind: Kind) -> bool {
    let next = input.kind_ahead(1);
    let used = matches!(next, Kind::Assign | Kind::OpenParen | Kind::Dot | Kind::OpenBracket | Kind::Colon);
    recover::opens_statement(kind) || (kind == Kind::Name && used)
}

/// VAR blocks and statements without the PROGRAM around them: they are read as a unit without a
/// name, or as global variables.
fn bare_unit<'s>(input: &mut In<'_, '_, 's>, items: &mut Vec<Item<'s>>) {
    let opened = input.here();
    let name = Name { text: "", span: opened };
    let mut pou = Pou {
        kind: PouKind::Program,
        name,
        result: None,
        blocks: Vec::new(),
        body: Vec::new(),
        doc: None,
        span: opened,
    };
    input.state().open.push((Kind::EndProgram, opened));
    contents(input, &mut pou);
    input.state().open.pop();
    let closed = recover::is_pou_end(input.kind());
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
    let ty = structure_behind(input, word);
    input.eat(Kind::Semicolon);
    Item::Types(vec![TypeDecl { name, ty, initial: None, doc: None, unread: Vec::new() }])
}

/// Takes a unit that stands inside another one, if the other one goes on behind it.
fn nested_unit(input: &mut In<'_, '_, '_>) -> bool {
    let Some((end, opened)) = input.state().open.last().copied() else { return false };
    if !recover::opens_item(input.kind()) || !goes_on(input, end) {
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
            kind if recover::is_pou_end(kind) => match open.pop() {
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
        if nested_unit(input) {
            continue;
        }
        if !recover::opens_section(input.kind()) {
            break;
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
        pou.blocks.push(VarBlock {
            kind: VarKind::Var,
            constant: None,
            retain: None,
            non_retain: None,
            persistent: None,
            vars,
            span,
        });
    }
    input.state().begins.clear();
}

fn pou<'s>(input: &mut In<'_, '_, 's>, kind: PouKind, end: Kind) -> Item<'s> {
    let first = input.number();
    let doc = doc::before(input.state(), first);
    let opened = input.take();
    let (mut kind, mut end) = (kind, end);
    if kind == PouKind::Function && input.is_word("BLOCK") && input.kind_ahead(1) == Kind::Name {
        let span = opened.to(input.take());
        diagnostics::misspelt_keyword(input, Kind::FunctionBlock, span);
        (kind, end) = (PouKind::FunctionBlock, Kind::EndFunctionBlock);
    }
    let mut parameters = None;
    let (name, result) = head(input, kind, &mut parameters).unwrap_or_else(|problem| {
        diagnostics::report(input, problem);
        recover::skip_head(input);
        (Name { text: "", span: opened }, None)
    });
    let span = opened.to(name.span);
    if kind != PouKind::Function && input.kind() == Kind::Colon {
        let from = input.take();
        let _ = type_spec(input);
        let whole = from.to(input.last());
        let it = diagnostics::no_result_type(whole, input.text(opened));
        input.report(it);
    }
    input.eat(Kind::Semicolon);
    input.state().open.push((end, opened));
    let mut pou = Pou { kind, name, result, blocks: Vec::new(), body: Vec::new(), doc, span };
    pou.blocks.extend(parameters);
    contents(input, &mut pou);
    input.state().open.pop();
    if input.eat(end).is_none() {
        if recover::is_pou_end(input.kind()) {
            diagnostics::wrong_end(input, end, opened);
            input.take();
        } else {
            diagnostics::missing_end(input, end, opened);
        }
    }
    Item::Pou(pou)
}

/// The name, and a function's result type.
fn head<'s>(
    input: &mut In<'_, '_, 's>,
    kind: PouKind,
    parameters: &mut Option<VarBlock<'s>>,
) -> Parsed<(Name<'s>, Option<TypeSpec<'s>>)> {
    modifiers(input);
    let mut name = input.name()?;
    if kind == PouKind::Function
        && input.kind() == Kind::Name
        && !input.on_new_line()
        && staunch_ir::Elementary::named(name.text).is_some()
    {
        let ty = name;
        name = input.name()?;
        diagnostics::type_first(input, ty.span, name.span);
        return Ok((name, Some(TypeSpec { kind: TypeKind::Named(vec![ty]), span: ty.span })));
    }
    for word in ["EXTENDS", "IMPLEMENTS"] {
        bases(input, word)?;
    }
    if input.kind() == Kind::OpenParen {
        *parameters = Some(in_parentheses(input)?);
    }
    let lacks_colon = matches!(input.kind(), Kind::Name | Kind::Array) && !input.on_new_line();
    if kind == PouKind::Function && lacks_colon {
        diagnostics::missing_type_colon(input);
        return Ok((name, Some(type_spec(input)?)));
    }
    let typed = kind == PouKind::Function && input.eat(Kind::Colon).is_some();
    let result = if typed { Some(type_spec(input)?) } else { None };
    Ok((name, result))
}

/// `(x : INT; y : REAL)` behind a function's name, as other languages have it.
fn in_parentheses<'s>(input: &mut In<'_, '_, 's>) -> Parsed<VarBlock<'s>> {
    let span = input.take();
    let mut vars = Vec::new();
    while input.kind() == Kind::Name {
        let from = input.here();
        let mut names = vec![input.name()?];
        while input.eat(Kind::Comma).is_some() {
            names.push(input.name()?);
        }
        input.expect(Kind::Colon)?;
        let ty = type_spec(input)?;
        let (address, edge, initial, doc) = (None, None, None, None);
        vars.push(VarDecl { names, address, ty, edge, initial, doc, span: from.to(input.last()) });
        let _ = input.eat(Kind::Semicolon).or_else(|| input.eat(Kind::Comma));
    }
    let whole = span.to(input.expect(Kind::CloseParen)?);
    input.report(diagnostics::parameters_in_head(whole, vars.is_empty()));
    let kind = VarKind::Input;
    Ok(VarBlock { kind, constant: None, retain: None, non_retain: None, persistent: None, vars, span })
}

fn modifiers(input: &mut In<'_, '_, '_>) {
    let words = ["ABSTRACT", "FINAL", "PUBLIC", "PRIVATE", "PROTECTED", "INTERNAL"];
    while input.kind_ahead(1) == Kind::Name
        && let Some(word) = words.into_iter().find(|it| input.is_word(it))
    {
        let span = input.take();
        input.report(diagnostics::unsupported(span, word));
    }
}

/// `EXTENDS a, b`
fn bases(input: &mut In<'_, '_, '_>, word: &str) -> Result<(), Problem> {
    if !input.is_word(word) {
        return Ok(());
    }
    let span = input.take();
    input.report(diagnostics::unsupported(span, word));
    input.name()?;
    while input.kind() == Kind::Comma || input.kind() == Kind::Dot {
        input.take();
        input.name()?;
    }
    Ok(())
}
