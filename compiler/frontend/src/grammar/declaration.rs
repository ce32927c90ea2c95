//! VAR blocks and the declarations in them and in structures.

use crate::{
    ast::{Edge, Name, VarBlock, VarDecl, VarKind},
    lex::Kind,
    source::Span,
};

use super::{
    doc, mistake,
    moves::{Expected, In, Moves, Parsed},
    recover,
    types::{optional_initial, type_spec},
};

fn section_kind(kind: Kind) -> Option<VarKind> {
    Some(match kind {
        Kind::Var => VarKind::Var,
        Kind::VarInput => VarKind::Input,
        Kind::VarOutput => VarKind::Output,
        Kind::VarInOut => VarKind::InOut,
        Kind::VarTemp => VarKind::Temp,
        Kind::VarStat => VarKind::Stat,
        Kind::VarGlobal => VarKind::Global,
        Kind::VarExternal => VarKind::External,
        _ => return None,
    })
}

/// From VAR to END_VAR. None for a section that is refused.
pub fn section<'s>(input: &mut In<'_, '_, 's>) -> Option<VarBlock<'s>> {
    let kind = input.kind();
    let span = input.take();
    let Some(kind) = section_kind(kind) else {
        let word = kind.keyword().unwrap_or_default();
        input.report(mistake::unsupported(span, word));
        recover::skip_section(input);
        return None;
    };
    let mut block =
        VarBlock { kind, constant: None, retain: None, non_retain: None, persistent: None, vars: Vec::new(), span };
    while qualifier(input, &mut block) {}
    input.state().open.push((Kind::EndVar, span));
    block.vars = list(input, Kind::EndVar, span);
    input.state().open.pop();
    if input.eat(Kind::EndVar).is_none() {
        mistake::missing_end(input, Kind::EndVar, span);
    }
    input.eat(Kind::Semicolon);
    Some(block)
}

fn qualifier(input: &mut In<'_, '_, '_>, block: &mut VarBlock<'_>) -> bool {
    let place = match input.kind() {
        Kind::Constant => &mut block.constant,
        Kind::Retain => &mut block.retain,
        Kind::NonRetain => &mut block.non_retain,
        Kind::Persistent => &mut block.persistent,
        Kind::Name => return access(input),
        _ => return false,
    };
    *place = Some(input.take());
    true
}

/// `VAR PUBLIC x : INT;`
fn access(input: &mut In<'_, '_, '_>) -> bool {
    let words = ["PUBLIC", "PRIVATE", "PROTECTED", "INTERNAL"];
    let Some(word) = words.into_iter().find(|it| input.is_word(it)) else {
        return false;
    };
    if input.kind_ahead(1) != Kind::Name {
        return false;
    }
    let span = input.take();
    input.report(mistake::unsupported(span, word));
    true
}

/// Declarations up to `end`, which is left for the caller.
pub fn list<'s>(input: &mut In<'_, '_, 's>, end: Kind, opened: Span) -> Vec<VarDecl<'s>> {
    let mut vars = Vec::new();
    input.state().open.push((end, opened));
    let depth = input.state().depth;
    loop {
        input.state().depth = depth;
        let start = input.save();
        match input.kind() {
            Kind::Semicolon => {
                input.take();
            }
            kind if recover::ends_declarations(kind) => {
                if kind == end || !recover::stray(input) {
                    break;
                }
            }
            Kind::Name if recover::is_statement_in_section(input) => break,
            _ => match declaration(input) {
                Ok(it) => vars.push(it),
                Err(problem) => recover::declaration(input, problem, start),
            },
        }
    }
    input.state().open.pop();
    vars.shrink_to_fit();
    vars
}

fn declaration<'s>(input: &mut In<'_, '_, 's>) -> Parsed<VarDecl<'s>> {
    let (first, start) = (input.number(), input.here());
    let mut names = vec![input.name()?];
    while input.eat(Kind::Comma).is_some() {
        names.push(input.name()?);
    }
    let address = address(input)?;
    if input.kind() == Kind::Assign {
        let sign = input.here();
        input.report(mistake::assign_for_colon(sign));
        return Err(super::moves::Problem::REPORTED);
    }
    input.expect(Kind::Colon)?;
    let ty = type_spec(input)?;
    let edge = edge(input);
    let initial = optional_initial(input)?;
    end(input)?;
    let span = start.to(input.last());
    Ok(VarDecl { names, address, ty, edge, initial, doc: doc::comment(input, first), span })
}

/// `AT %IX0.0`
fn address<'s>(input: &mut In<'_, '_, 's>) -> Parsed<Option<Name<'s>>> {
    if input.eat(Kind::At).is_none() {
        return Ok(None);
    }
    let span = input.expect(Kind::Address)?;
    Ok(Some(Name { text: input.text(span), span }))
}

/// These two are names everywhere else.
fn edge(input: &mut In<'_, '_, '_>) -> Option<(Edge, Span)> {
    let edge = if input.is_word("R_EDGE") {
        Edge::Rising
    } else if input.is_word("F_EDGE") {
        Edge::Falling
    } else {
        return None;
    };
    Some((edge, input.take()))
}

/// The `;` of a declaration.
pub fn end(input: &mut In<'_, '_, '_>) -> Parsed<()> {
    if input.eat(Kind::Semicolon).is_some() {
        return Ok(());
    }
    let kind = input.kind();
    let next = recover::ends_declarations(kind) || recover::starts_declaration(input);
    if next || (input.on_new_line() && kind == Kind::Name) {
        mistake::missing_semicolon(input);
        return Ok(());
    }
    Err(input.problem(Expected::Token(Kind::Semicolon)))
}
