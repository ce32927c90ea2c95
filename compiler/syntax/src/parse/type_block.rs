//! TYPE … END_TYPE.

use chumsky::prelude::*;

use crate::{
    ast::{Name, TypeDecl, TypeKind, TypeSpec},
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
    pragma::{attributes_here, pack_here, pool_here},
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
