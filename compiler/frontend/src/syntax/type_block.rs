//! TYPE … END_TYPE.

use chumsky::prelude::*;

use crate::{
    ast::{External, Name, Pool, TypeDecl, TypeKind, TypeSpec},
    lex::Kind,
};

use super::{
    block_ends,
    combinator::{name, token, word},
    declaration::{end, type_spec},
    foreign_types,
    initial::optional_initial,
    namespace,
    parser::{In, Parsed, Start, TokenReader},
    recovery,
    token_class::ends_declarations,
};

pub fn types<'s>(input: &mut In<'_, '_, 's>) -> Vec<TypeDecl<'s>> {
    let (attributes, pool, pack) = (attributes_here(input), pool_here(input), pack_here(input));
    let opened = input.take();
    let internal = namespace::access(input);
    input.state().open.push((Kind::EndType, opened));
    let mut types: Vec<TypeDecl<'s>> = Vec::new();
    let depth = input.state().depth;
    loop {
        input.state().depth = depth;
        let start = input.save();
        match input.kind() {
            Kind::EndType => break,
            Kind::Semicolon => {
                input.take();
            }
            kind if ends_declarations(kind) => {
                if !recovery::stray(input) {
                    break;
                }
            }
            _ => types.extend(type_decl_or_name(input, start)),
        }
    }
    input.state().open.pop();
    block_ends::close_block(input, Kind::EndType, opened);
    input.eat(Kind::Semicolon);
    for declared in &mut types {
        declared.internal = internal;
        declared.attributes.extend(&attributes);
        declared.pool = declared.pool.or(pool);
        declared.pack = declared.pack.or(pack);
    }
    types
}

/// The names in `{attribute 'strict'}` and its like between the last token and the next.
pub fn attributes_here<'s>(input: &mut In<'_, '_, 's>) -> Vec<&'s str> {
    pragmas_here(input).into_iter().filter_map(|it| attribute(it.text)).collect()
}

/// `{external}` between the last token and the next.
pub fn external_here<'s>(input: &mut In<'_, '_, 's>) -> Option<External<'s>> {
    pragmas_here(input).into_iter().find_map(external)
}

/// `{pool 16}` between the last token and the next.
pub fn pool_here(input: &mut In<'_, '_, '_>) -> Option<Pool> {
    let text = |it: &Name<'_>| Pool::count_in(it.text);
    pragmas_here(input).iter().find_map(|it| Some(Pool { count: text(it)?, span: it.span }))
}

/// `{attribute 'pack_mode' := '1'}` between the last token and the next. CODESYS takes 0 and 1 for one another.
fn pack_here(input: &mut In<'_, '_, '_>) -> Option<(u64, crate::Span)> {
    let mode = |it: &Name<'_>| {
        let is_it = attribute(it.text)?.eq_ignore_ascii_case("pack_mode");
        let value = it.text.rsplit_once(":=")?.1.trim().trim_matches('\'').trim();
        is_it.then_some(value.parse::<u64>().ok()?.max(1))
    };
    pragmas_here(input).iter().find_map(|it| Some((mode(it)?, it.span)))
}

/// `{attribute 'instance-path'}` between the last token and the next.
pub fn instance_path_here(input: &mut In<'_, '_, '_>) -> Option<crate::Span> {
    let is_it = |it: &Name<'_>| attribute(it.text).is_some_and(|it| it.eq_ignore_ascii_case("instance-path"));
    pragmas_here(input).into_iter().find(is_it).map(|it| it.span)
}

/// The pragmas between the last token and the next.
fn pragmas_here<'s>(input: &mut In<'_, '_, 's>) -> Vec<Name<'s>> {
    let (from, to) = (input.last(), input.here());
    let pragmas = &input.state().tokens.pragmas;
    let after = |it: &&Name<'s>| it.span.start >= from.end || from.start >= to.start;
    // They are in the order of the text.
    let before = &pragmas[..pragmas.partition_point(|it| it.span.end <= to.start)];
    let first = before.len() - before.iter().rev().take_while(after).count();
    before[first..].to_vec()
}

/// The name in `attribute 'strict'`.
fn attribute(text: &str) -> Option<&str> {
    let (word, rest) = text.trim().split_once(|it: char| it.is_whitespace())?;
    let name = rest.trim_start().strip_prefix('\'')?.split('\'').next()?;
    word.eq_ignore_ascii_case("attribute").then_some(name)
}

/// `external`, with or without a symbol in quotes.
fn external(pragma: Name<'_>) -> Option<External<'_>> {
    let text = pragma.text.trim();
    let (word, rest) = text.split_at_checked("external".len())?;
    let rest = rest.trim();
    let symbol = rest.strip_prefix('\'').and_then(|it| it.strip_suffix('\''));
    let fits = word.eq_ignore_ascii_case("external") && (rest.is_empty() || symbol.is_some());
    fits.then_some(External { symbol, span: pragma.span })
}

/// A type, or the name of one that does not parse, with all names in it: they may be enumerators.
fn type_decl_or_name<'t, 'p, 's>(input: &mut In<'t, 'p, 's>, start: Start<'t, 'p>) -> Option<TypeDecl<'s>> {
    let (first, from) = (input.number(), input.here());
    let named = input.kind() == Kind::Name;
    let name = Name { text: input.text(from), span: from };
    let problem = match type_decl(input) {
        Ok(it) => return Some(it),
        Err(problem) => problem,
    };
    if !recovery::declaration(input, problem, start) || !named {
        return None;
    }
    let ty = TypeSpec { kind: TypeKind::Error, span: from.to(input.last()) };
    let last = input.number();
    let state = input.state();
    let names = (first + 1..last).filter(|at| state.tokens.kinds[*at] == Kind::Name).map(|at| state.place(at));
    let unread = names.map(|span| Name { text: state.slice(span), span }).collect();
    Some(TypeDecl { unread, ..TypeDecl::new(name, ty) })
}

/// `Name : type := value;`, where a structure may do without the `;`.
fn type_decl<'s>(input: &mut In<'_, '_, 's>) -> Parsed<TypeDecl<'s>> {
    let (first, attributes, pool) = (input.number(), attributes_here(input), pool_here(input));
    let pack = pack_here(input);
    let colon = token(Kind::Colon).ignored().or(foreign_types::no_colon_in_type());
    let path = name().separated_by(token(Kind::Dot)).at_least(1).collect();
    let base = word("EXTENDS").ignore_then(path).or_not();
    // `ABSTRACT` may be a name, too.
    let modified = word("ABSTRACT").then(name()).map(|(word, name)| (Some(word), name));
    let named = modified.or(name().map(|it| (None, it)));
    let head = named.then(base).then_ignore(colon);
    let (((is_abstract, name), base), (ty, initial)) = input.parse(head.then(type_spec().then(optional_initial())))?;
    let closed = matches!(ty.kind, TypeKind::Struct(_) | TypeKind::Union(_));
    if !closed || input.kind() == Kind::Semicolon {
        input.parse(end())?;
    }
    let doc = input.doc(first);
    Ok(TypeDecl { is_abstract, base, attributes, pool, pack, initial, doc, ..TypeDecl::new(name, ty) })
}
