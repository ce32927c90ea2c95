//! VAR blocks and the declarations in them and in structures.

use chumsky::prelude::*;

use crate::{
    ast::{Access, Construction, Edge, Initial, Name, TypeKind, TypeSpec, VarBlock, VarDecl, VarKind},
    lex::Kind,
    source::Span,
};

use super::{
    access::access_paths,
    block_ends,
    combinator::{Rule, ahead, delimited, list as list_of, name, nested, rule, token, word},
    diagnostics,
    expression::arguments,
    foreign_declaration, foreign_types,
    initial::optional_initial,
    misspelt,
    parser::{Expected, In, Parsed, Start, TokenReader},
    pragma::{instance_path_here, starts_at_calls_here},
    recovery,
    token_class::ends_declarations,
    types::{self, type_kind},
};

/// From VAR to END_VAR. None for a section that is refused, and for VAR_ACCESS.
pub fn section<'s>(input: &mut In<'_, '_, 's>) -> Option<VarBlock<'s>> {
    let (kind, opened) = (input.kind(), input.here());
    if kind == Kind::VarAccess {
        access_paths(input);
        return None;
    }
    match input.parse(section_head()) {
        Ok(mut block) => {
            block.vars = list(input, Kind::EndVar, block.span);
            block_ends::close_block(input, Kind::EndVar, block.span);
            input.eat(Kind::Semicolon);
            Some(block)
        }
        Err(_) => {
            input.take();
            input.report(diagnostics::unsupported(opened, kind.keyword().unwrap_or_default()));
            recovery::skip_section(input);
            None
        }
    }
}

#[derive(Clone, Copy)]
enum Qualifier {
    Constant,
    Retain,
    NonRetain,
    Persistent,
    Access(Access),
}

/// `VAR_GLOBAL CONSTANT`
fn section_head<'t, 's: 't>() -> impl Rule<'t, 's, VarBlock<'s>> {
    let kinds = [
        (Kind::Var, VarKind::Var),
        (Kind::VarInput, VarKind::Input),
        (Kind::VarOutput, VarKind::Output),
        (Kind::VarInOut, VarKind::InOut),
        (Kind::VarTemp, VarKind::Temp),
        (Kind::VarStat, VarKind::Stat),
        (Kind::VarInst, VarKind::Inst),
        (Kind::VarGlobal, VarKind::Global),
        (Kind::VarExternal, VarKind::External),
    ];
    let kind = choice(kinds.map(|(keyword, kind)| token(keyword).map(move |span| (kind, span))));
    let qualifier = choice((
        token(Kind::Constant).map(|span| (Qualifier::Constant, span)),
        token(Kind::Retain).map(|span| (Qualifier::Retain, span)),
        token(Kind::NonRetain).map(|span| (Qualifier::NonRetain, span)),
        token(Kind::Persistent).map(|span| (Qualifier::Persistent, span)),
        section_access().map(|(access, span)| (Qualifier::Access(access), span)),
        misspelt_qualifier(),
    ));
    let opened = foreign_types::section_of_two_words().or(kind).map(|(kind, span)| VarBlock::new(kind, span));
    opened.foldl(qualifier.repeated(), |mut block, (qualifier, span)| {
        match qualifier {
            Qualifier::Constant => block.constant = Some(span),
            Qualifier::Retain => block.retain = Some(span),
            Qualifier::NonRetain => block.non_retain = Some(span),
            Qualifier::Persistent => block.persistent = Some(span),
            Qualifier::Access(access) => block.access = Some((access, span)),
        }
        block
    })
}

/// `VAR RETIAN`: a word before the first declaration that is nearly a qualifier.
fn misspelt_qualifier<'t, 's: 't>() -> impl Rule<'t, 's, (Qualifier, Span)> {
    rule(|input| {
        let meant = misspelt::misspelt_qualifier(input).ok_or_else(|| input.problem(Expected::Name))?;
        let span = input.take();
        diagnostics::misspelt_keyword(input, meant, span);
        Ok(match meant {
            Kind::Retain => (Qualifier::Retain, span),
            Kind::NonRetain => (Qualifier::NonRetain, span),
            Kind::Persistent => (Qualifier::Persistent, span),
            _ => (Qualifier::Constant, span),
        })
    })
}

pub const ACCESSES: [(&str, Access); 4] = [
    ("PUBLIC", Access::Public),
    ("PRIVATE", Access::Private),
    ("PROTECTED", Access::Protected),
    ("INTERNAL", Access::Internal),
];

/// `PUBLIC` and the like before a name.
pub fn access<'t, 's: 't>() -> impl Rule<'t, 's, (Access, Span)> {
    choice(ACCESSES.map(|(text, access)| before_name(text).map(move |span| (access, span))))
}

/// `PUBLIC` and the like after `VAR`, where a variable with that name would be declared.
fn section_access<'t, 's: 't>() -> impl Rule<'t, 's, (Access, Span)> {
    let declares = |input: &mut In<'_, '_, '_>| matches!(input.kind_ahead(1), Kind::Colon | Kind::Comma | Kind::At);
    let alone = move |text| ahead(move |input| !declares(input)).ignore_then(word(text));
    choice(ACCESSES.map(|(text, access)| alone(text).map(move |span| (access, span))))
}

/// A word before a name.
pub fn before_name<'t, 's: 't>(text: &'static str) -> impl Rule<'t, 's, Span> {
    ahead(|input| input.kind_ahead(1) == Kind::Name).ignore_then(word(text))
}

/// What follows the `:` of a declaration.
pub fn type_spec<'t, 's: 't>() -> impl Rule<'t, 's, TypeSpec<'s>> {
    rule(read_type)
}

fn read_type<'t, 's: 't>(input: &mut In<'t, '_, 's>) -> Parsed<TypeSpec<'s>> {
    if types::is_plain(input) {
        let name = input.name()?;
        return Ok(TypeSpec { kind: TypeKind::Named(vec![name]), span: name.span });
    }
    let structure = token(Kind::Struct).then(rule(|input| Ok(structure_members(input)))).map(|(_, it)| it);
    let kind = choice((structure, union(), type_kind(type_spec())));
    input.parse(nested(kind).map_with(|kind, extra| {
        let tokens = extra.span();
        TypeSpec { kind, span: extra.state().span(tokens) }
    }))
}

/// The members of a structure after its keyword, and its end.
pub fn structure_members<'s>(input: &mut In<'_, '_, 's>) -> TypeKind<'s> {
    let opened = input.last();
    let overlaps = input.is_word("OVERLAP") && input.kind_ahead(1) == Kind::Name;
    if overlaps {
        input.take();
    }
    let fields = list(input, Kind::EndStruct, opened);
    block_ends::close_block(input, Kind::EndStruct, opened);
    if overlaps { TypeKind::Union(fields) } else { TypeKind::Struct(fields) }
}

/// UNION is a word only here.
fn union<'t, 's: 't>() -> impl Rule<'t, 's, TypeKind<'s>> {
    rule(|input| {
        if !input.is_word("UNION") || !matches!(input.kind_ahead(1), Kind::Name | Kind::EndUnion) {
            return Err(input.problem(Expected::Type));
        }
        let opened = input.take();
        let members = list(input, Kind::EndUnion, opened);
        block_ends::close_block(input, Kind::EndUnion, opened);
        Ok(TypeKind::Union(members))
    })
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
            kind if ends_declarations(kind) => {
                if kind == end || !recovery::stray(input) {
                    break;
                }
            }
            Kind::Name if recovery::is_statement_in_section(input) => break,
            Kind::Name if let Some(it) = foreign_declaration::read(input) => vars.push(it),
            _ => vars.extend(declaration_or_names(input, start)),
        }
    }
    input.state().open.pop();
    vars.shrink_to_fit();
    vars
}

/// A declaration, or the names of one that does not parse: their uses are not reported again.
fn declaration_or_names<'t, 'p, 's>(input: &mut In<'t, 'p, 's>, start: Start<'t, 'p>) -> Option<VarDecl<'s>> {
    let from = input.here();
    let mut names = Vec::new();
    match declaration(input, &mut names) {
        Ok(it) => return Some(it),
        Err(problem) => {
            if !recovery::declaration(input, problem, start) || names.is_empty() {
                return None;
            }
        }
    }
    let span = from.to(input.last());
    let ty = TypeSpec { kind: TypeKind::Error, span };
    Some(VarDecl::new(names, ty, span))
}

/// `names` holds what was read of the names, also if the rest does not parse.
pub fn declaration<'s>(input: &mut In<'_, '_, 's>, names: &mut Vec<Name<'s>>) -> Parsed<VarDecl<'s>> {
    let (first, start) = (input.number(), input.here());
    let (instance_path, starts_at_calls) = (instance_path_here(input), starts_at_calls_here(input));
    // What is at an address needs no other name.
    let nameless = input.kind() == Kind::At;
    // Most declarations have one name, and no address.
    let is_usual = input.kind() == Kind::Name && input.kind_ahead(1) == Kind::Colon;
    if is_usual {
        names.push(input.name()?);
    } else if !nameless {
        let (name, more) = input.parse(declared_names())?;
        names.push(name);
        names.extend(more);
    }
    let (address, swapped) = match is_usual {
        true => (None, None),
        false => input.parse(address(!nameless).then(foreign_types::type_before_name(names)))?,
    };
    if nameless {
        names.extend(address);
    }
    let (((ty, construction), (edge, late)), initial) = match swapped {
        Some(named) => {
            *names = named.names;
            (((named.ty, None), (None, None)), input.parse(optional_initial().then_ignore(end()))?)
        }
        None => (read_typed(input)?, initial_to_end(input)?),
    };
    let doc = input.doc(first);
    if let Some(late) = late {
        let problem = diagnostics::address_after_type(input, names.last(), &ty, late);
        input.state().late_addresses.push((late.1, problem));
    }
    let address = address.or(late.map(|it| it.1));
    let declared = VarDecl::new(std::mem::take(names), ty, start.to(input.last()));
    Ok(VarDecl { address, edge, construction, initial, instance_path, starts_at_calls, doc, ..declared })
}

/// `a, b`
fn declared_names<'t, 's: 't>() -> impl Rule<'t, 's, (Name<'s>, Vec<Name<'s>>)> {
    let first = foreign_types::name_of_two_words().or(name());
    first.then(token(Kind::Comma).ignore_then(name()).repeated().collect())
}

/// What may be after a type: an edge, and an AT with its address.
type After<'s> = (Option<(Edge, Span)>, Option<(Span, Name<'s>)>);
type Typed<'s> = ((TypeSpec<'s>, Option<Box<Construction<'s>>>), After<'s>);

/// `R_EDGE`; in OpenPLC Editor `AT %QX0.0`, too
fn after_type<'t, 's: 't>() -> impl Rule<'t, 's, After<'s>> {
    // These two are names everywhere else.
    let rising = word("R_EDGE").map(|span| (Edge::Rising, span));
    let falling = word("F_EDGE").map(|span| (Edge::Falling, span));
    let late = token(Kind::At).then(direct_address().or(alias()));
    rising.or(falling).or_not().then(late.or_not())
}

/// `: BOOL R_EDGE`, whose colon may be forgotten
fn typed<'t, 's: 't>() -> impl Rule<'t, 's, Typed<'s>> {
    let colon = token(Kind::Colon).ignored().or(foreign_types::no_colon_in_declaration());
    let after = after_type();
    let usual = ahead(|input| matches!(input.kind(), Kind::Semicolon | Kind::Assign)).to((None, None));
    colon.ignore_then(type_spec().then(rule(construction))).then(usual.or(after))
}

/// The same; mostly a type alone.
fn read_typed<'t, 's: 't>(input: &mut In<'t, '_, 's>) -> Parsed<Typed<'s>> {
    if input.kind() != Kind::Colon {
        return input.parse(typed());
    }
    input.take();
    let ty = read_type(input)?;
    let construction = construction(input)?;
    let is_alone = matches!(input.kind(), Kind::Semicolon | Kind::Assign);
    let after = if is_alone { (None, None) } else { input.parse(after_type())? };
    Ok(((ty, construction), after))
}

/// The initial value, if there is one, and the `;`.
fn initial_to_end<'s>(input: &mut In<'_, '_, 's>) -> Parsed<Option<Initial<'s>>> {
    if input.eat(Kind::Semicolon).is_some() {
        return Ok(None);
    }
    input.parse(optional_initial().then_ignore(end()))
}

/// `(5)` after the type of an instance, `[(5), (6)]` after that of an array of them.
fn construction<'s>(input: &mut In<'_, '_, 's>) -> Parsed<Option<Box<Construction<'s>>>> {
    let start = input.here();
    let is_of_elements = match (input.kind(), input.kind_ahead(1)) {
        (Kind::OpenParen, _) => false,
        (Kind::OpenBracket, Kind::OpenParen) => true,
        _ => return Ok(None),
    };
    let lists = match is_of_elements {
        false => vec![arguments(input)?],
        true => input.parse(delimited(Kind::OpenBracket, list_of(rule(arguments)), Kind::CloseBracket))?,
    };
    Ok(Some(Box::new(Construction { lists, is_of_elements, span: start.to(input.last()) })))
}

fn direct_address<'t, 's: 't>() -> impl Rule<'t, 's, Name<'s>> {
    rule(|input| {
        let span = input.expect(Kind::Address)?;
        Ok(Name { text: input.text(span), span })
    })
}

/// The alias of an address, as OpenPLC Editor has them.
fn alias<'t, 's: 't>() -> impl Rule<'t, 's, Name<'s>> {
    let ends = |input: &mut In<'t, '_, 's>| matches!(input.kind_ahead(1), Kind::Colon | Kind::Semicolon | Kind::Assign);
    ahead(ends).ignore_then(name())
}

/// `AT %IX0.0`; in a structure `AT %B4` and `AT %X0.3`. A member without a name of its own has no alias.
fn address<'t, 's: 't>(has_alias: bool) -> impl Rule<'t, 's, Option<Name<'s>>> {
    let relative = token(Kind::Part).then(token(Kind::Dot).ignore_then(token(Kind::Integer)).or_not());
    let relative = relative.map(|(start, end)| end.map_or(start, |it| start.to(it)));
    let place = ahead(|input| input.kind() == Kind::Part).ignore_then(relative).or(token(Kind::Address));
    let direct = place.map_with(|span, extra| Some(Name { text: extra.state().slice(span), span }));
    let unsigned = foreign_types::address_without_sign().to(None);
    let alias = ahead(move |_| has_alias).ignore_then(alias()).map(Some);
    token(Kind::At).ignore_then(alias.or(unsigned).or(direct)).or_not().map(Option::flatten)
}

/// The `;` of a declaration, or what is taken for it.
pub fn end<'t, 's: 't>() -> impl Rule<'t, 's, ()> {
    token(Kind::Semicolon).ignored().or(rule(recovery::end_of_declaration))
}
