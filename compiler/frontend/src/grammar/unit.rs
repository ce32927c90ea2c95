//! What a file holds: POUs, TYPE blocks, global variables.

use crate::{
    ast::{Item, Name, Pou, PouKind, TypeSpec},
    lex::Kind,
};

use super::{
    configuration::configuration,
    declaration::section,
    doc, member, mistake,
    moves::{Expected, In, Moves, Parsed, Problem},
    recover,
    statement::statements,
    types::{type_spec, types},
};

pub fn items<'s>(input: &mut In<'_, '_, 's>) -> Vec<Item<'s>> {
    let mut items = Vec::new();
    loop {
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
            Kind::Configuration => items.push(Item::Configuration(configuration(input))),
            kind if recover::opens_section(kind) => {
                if kind != Kind::VarGlobal {
                    outside(input);
                }
                items.extend(section(input).filter(|_| kind == Kind::VarGlobal).map(Item::Globals));
            }
            Kind::Name if member::skip(input) => {}
            kind if recover::closes(kind) => {
                let span = input.take();
                let it = mistake::stray(span, kind);
                input.report(it);
            }
            _ => outside(input),
        }
    }
}

/// Something that stands between the items of a file.
fn outside(input: &mut In<'_, '_, '_>) {
    let problem = input.problem(Expected::Block);
    mistake::report(input, problem);
    if !recover::opens_section(input.kind()) {
        input.take();
        recover::skip_to_item(input);
    }
}

fn pou<'s>(input: &mut In<'_, '_, 's>, kind: PouKind, end: Kind) -> Item<'s> {
    let first = input.number();
    let doc = doc::before(input.state(), first);
    let opened = input.take();
    let (name, result) = head(input, kind).unwrap_or_else(|problem| {
        mistake::report(input, problem);
        recover::skip_head(input);
        (Name { text: "", span: opened }, None)
    });
    let span = opened.to(name.span);
    input.eat(Kind::Semicolon);
    input.state().open.push((end, opened));
    let mut pou = Pou { kind, name, result, blocks: Vec::new(), body: Vec::new(), doc, span };
    loop {
        let mut more = statements(input);
        if pou.body.is_empty() {
            pou.body = more;
        } else {
            pou.body.append(&mut more);
        }
        if !recover::opens_section(input.kind()) {
            break;
        }
        if !pou.body.is_empty() {
            let span = input.here();
            input.report(mistake::declaration_behind_statements(span));
        }
        pou.blocks.extend(section(input));
    }
    input.state().open.pop();
    if input.eat(end).is_none() {
        if recover::is_pou_end(input.kind()) {
            mistake::wrong_pou_end(input, end, opened);
            input.take();
        } else {
            mistake::missing_end(input, end, opened);
        }
    }
    Item::Pou(pou)
}

/// The name, and a function's result type.
fn head<'s>(input: &mut In<'_, '_, 's>, kind: PouKind) -> Parsed<(Name<'s>, Option<TypeSpec<'s>>)> {
    modifiers(input);
    let name = input.name()?;
    for word in ["EXTENDS", "IMPLEMENTS"] {
        bases(input, word)?;
    }
    let typed = kind == PouKind::Function && input.eat(Kind::Colon).is_some();
    let result = if typed { Some(type_spec(input)?) } else { None };
    Ok((name, result))
}

fn modifiers(input: &mut In<'_, '_, '_>) {
    let words = ["ABSTRACT", "FINAL", "PUBLIC", "PRIVATE", "PROTECTED", "INTERNAL"];
    while input.kind_ahead(1) == Kind::Name
        && let Some(word) = words.into_iter().find(|it| input.is_word(it))
    {
        let span = input.take();
        input.report(mistake::unsupported(span, word));
    }
}

/// `EXTENDS a, b`
fn bases(input: &mut In<'_, '_, '_>, word: &str) -> Result<(), Problem> {
    if !input.is_word(word) {
        return Ok(());
    }
    let span = input.take();
    input.report(mistake::unsupported(span, word));
    input.name()?;
    while input.kind() == Kind::Comma || input.kind() == Kind::Dot {
        input.take();
        input.name()?;
    }
    Ok(())
}
