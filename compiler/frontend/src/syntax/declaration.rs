//! VAR blocks and the declarations in them and in structures.

use crate::{
    ast::{Edge, Name, TypeKind, TypeSpec, VarBlock, VarDecl, VarKind},
    lex::Kind,
    source::Span,
};

use super::{
    block_ends, diagnostics, doc, foreign_syntax,
    parser::{Expected, In, Moves, Parsed, Start},
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
    let mut kind = input.kind();
    let mut span = input.take();
    if kind == Kind::Var
        && let Some(meant) = second_word(input)
    {
        kind = meant;
        span = span.to(input.take());
        diagnostics::misspelt_keyword(input, kind, span);
    }
    let Some(kind) = section_kind(kind) else {
        let word = kind.keyword().unwrap_or_default();
        input.report(diagnostics::unsupported(span, word));
        recover::skip_section(input);
        return None;
    };
    let mut block =
        VarBlock { kind, constant: None, retain: None, non_retain: None, persistent: None, vars: Vec::new(), span };
    while qualifier(input, &mut block) {}
    block.vars = list(input, Kind::EndVar, span);
    block_ends::close_block(input, Kind::EndVar, span);
    input.eat(Kind::Semicolon);
    Some(block)
}

/// `VAR INPUT`
fn second_word(input: &mut In<'_, '_, '_>) -> Option<Kind> {
    if input.kind() != Kind::Name || input.kind_ahead(1) != Kind::Name {
        return None;
    }
    let kinds = [Kind::VarInput, Kind::VarOutput, Kind::VarInOut, Kind::VarTemp, Kind::VarGlobal, Kind::VarExternal];
    kinds.into_iter().find(|it| it.keyword().is_some_and(|word| input.is_word(&word[4..])))
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
    input.report(diagnostics::unsupported(span, word));
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
            _ => vars.extend(declaration_or_names(input, start)),
        }
    }
    input.state().open.pop();
    vars.shrink_to_fit();
    vars
}

/// A declaration, or the names of one that does not parse: their uses are no further mistakes.
fn declaration_or_names<'t, 'p, 's>(input: &mut In<'t, 'p, 's>, start: Start<'t, 'p>) -> Option<VarDecl<'s>> {
    let from = input.here();
    let mut names = Vec::new();
    match declaration(input, &mut names) {
        Ok(it) => return Some(it),
        Err(problem) => {
            if !recover::declaration(input, problem, start) || names.is_empty() {
                return None;
            }
        }
    }
    let span = from.to(input.last());
    let ty = TypeSpec { kind: TypeKind::Error, span };
    Some(VarDecl { names, address: None, ty, edge: None, initial: None, doc: None, span })
}

/// `names` holds what was read of the names, also if the rest does not parse.
pub fn declaration<'s>(input: &mut In<'_, '_, 's>, names: &mut Vec<Name<'s>>) -> Parsed<VarDecl<'s>> {
    let (first, start) = (input.number(), input.here());
    // What lies at an address needs no other name.
    let mut address = address(input)?;
    match address {
        Some(address) => names.push(address),
        None => {
            names.push(first_name(input)?);
            while input.eat(Kind::Comma).is_some() {
                names.push(input.name()?);
            }
            address = self::address(input)?;
        }
    }
    if input.kind() == Kind::Assign {
        let sign = input.here();
        input.report(diagnostics::assign_for_colon(sign));
        return Err(super::parser::Problem::REPORTED);
    }
    if let Some(ty) = type_before_name(input, names) {
        let initial = optional_initial(input)?;
        end(input)?;
        let span = start.to(input.last());
        let names = std::mem::take(names);
        return Ok(VarDecl { names, address, ty, edge: None, initial, doc: doc::comment(input, first), span });
    }
    if input.eat(Kind::Colon).is_none() {
        if !lacks_colon(input) {
            return Err(input.problem(Expected::Token(Kind::Colon)));
        }
        diagnostics::missing_type_colon(input);
    }
    let ty = type_spec(input)?;
    let edge = edge(input);
    if input.kind() == Kind::At && input.kind_ahead(1) == Kind::Address {
        let span = input.take();
        let span = span.to(input.take());
        input.report(diagnostics::address_behind_type(span));
    }
    let initial = optional_initial(input)?;
    end(input)?;
    let span = start.to(input.last());
    let names = std::mem::take(names);
    Ok(VarDecl { names, address, ty, edge, initial, doc: doc::comment(input, first), span })
}

/// A name, also one of two words: `my var : INT`.
fn first_name<'s>(input: &mut In<'_, '_, 's>) -> Parsed<Name<'s>> {
    let name = input.name()?;
    let second = input.kind() == Kind::Name && matches!(input.kind_ahead(1), Kind::Colon) && !input.on_new_line();
    if !second || input.kind_ahead(2) == Kind::Assign {
        return Ok(name);
    }
    let word = input.take();
    diagnostics::name_of_two_words(input, name.span, word);
    let span = name.span.to(word);
    Ok(Name { text: input.text(span), span })
}

/// Whether only the `:` between name and type is missing.
fn lacks_colon(input: &mut In<'_, '_, '_>) -> bool {
    let next = input.kind_ahead(1);
    match input.kind() {
        Kind::Name => {
            !input.on_new_line() && matches!(next, Kind::Semicolon | Kind::Assign | Kind::OpenParen | Kind::OpenBracket)
        }
        Kind::Array | Kind::Struct => true,
        Kind::Equal => matches!(next, Kind::Name | Kind::Array | Kind::Struct),
        Kind::Semicolon => next == Kind::Name && matches!(input.kind_ahead(2), Kind::Semicolon | Kind::Assign),
        _ => false,
    }
}

/// `INT x;`, as other languages write it: the first of `names` is the type.
fn type_before_name<'s>(input: &mut In<'_, '_, 's>, names: &mut Vec<Name<'s>>) -> Option<TypeSpec<'s>> {
    let [ty] = names.as_slice() else { return None };
    let ty = *ty;
    let next = input.kind_ahead(1);
    let follows = matches!(next, Kind::Semicolon | Kind::Assign | Kind::Equal | Kind::Comma);
    if input.kind() != Kind::Name || !follows || staunch_ir::Elementary::named(ty.text).is_none() {
        return None;
    }
    names.clear();
    names.push(input.name().ok()?);
    diagnostics::type_first(input, ty.span, names[0].span);
    while input.eat(Kind::Comma).is_some() {
        names.push(input.name().ok()?);
    }
    Some(TypeSpec { kind: TypeKind::Named(vec![ty]), span: ty.span })
}

/// `AT %IX0.0`
fn address<'s>(input: &mut In<'_, '_, 's>) -> Parsed<Option<Name<'s>>> {
    if input.eat(Kind::At).is_none() {
        return Ok(None);
    }
    if input.kind() == Kind::Name {
        let mut span = input.take();
        while input.eat(Kind::Dot).is_some() || matches!(input.kind(), Kind::Integer | Kind::Real) {
            let last =
                if input.kind() == Kind::Integer || input.kind() == Kind::Real { input.take() } else { input.last() };
            span = span.to(last);
        }
        let it = diagnostics::address_without_sign(span, input.text(span));
        input.report(it);
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
    if input.eat(Kind::Semicolon).is_some() || foreign_syntax::wrong_terminator(input) {
        return Ok(());
    }
    let kind = input.kind();
    let next = recover::ends_declarations(kind) || recover::starts_declaration(input);
    if next || (input.on_new_line() && kind == Kind::Name) {
        diagnostics::missing_semicolon(input);
        return Ok(());
    }
    Err(input.problem(Expected::Token(Kind::Semicolon)))
}
