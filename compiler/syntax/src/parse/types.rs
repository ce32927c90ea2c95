//! Types but for STRUCT and UNION, whose members are declarations.

use chumsky::prelude::*;

use crate::{
    ast::{Bound, EnumValue, Expr, Name, TypeKind, TypeSpec},
    lex::Kind,
};

use staunch_ir::{Elementary, RefKind};

use super::{
    combinator::{Rule, ahead, delimited, from_here, list, name, reported, rule, token, word},
    doc,
    expression::expr,
    foreign_types,
    initial::assign,
    parser::{Expected, In, TokenReader},
    recovery, unsupported,
};

/// `spec` is the type of an element, or of what a reference refers to.
pub fn type_kind<'t, 's: 't>(spec: impl Rule<'t, 's, TypeSpec<'s>>) -> impl Rule<'t, 's, TypeKind<'s>> {
    choice((
        array(spec.clone()),
        enumeration().then(name().or_not()).map(|(values, base)| TypeKind::Enum { base, values }),
        reference(spec),
        string(),
        named(),
        foreign_types::brace_list("(", ")").to(TypeKind::Error),
        rule(|input| Err(input.problem(Expected::Type))),
    ))
}

/// Whether a name and nothing else is here: most types are that.
pub fn is_plain(input: &mut In<'_, '_, '_>) -> bool {
    let is_alone = input.kind() == Kind::Name && matches!(input.kind_ahead(1), Kind::Semicolon | Kind::Assign);
    is_alone && !is_string(input)
}

fn is_string(input: &mut In<'_, '_, '_>) -> bool {
    input.is_word("STRING") || input.is_word("WSTRING")
}

fn is_elementary(input: &mut In<'_, '_, '_>) -> bool {
    let here = input.here();
    !is_string(input) && Elementary::named(input.text(here)).is_some()
}

/// `ARRAY[1..3, 0..4] OF T`
fn array<'t, 's: 't>(spec: impl Rule<'t, 's, TypeSpec<'s>>) -> impl Rule<'t, 's, TypeKind<'s>> {
    let in_brackets = delimited(Kind::OpenBracket, list(bound()), Kind::CloseBracket);
    let in_parentheses = delimited(Kind::OpenParen, list(bound()), Kind::CloseParen);
    let bounds = foreign_types::bounds_in_parentheses().ignore_then(in_parentheses).or(in_brackets);
    from_here(move |opened| {
        let of = rule(move |input| {
            if input.eat(Kind::Of).is_none() {
                recovery::missing_word(input, Kind::Of, opened);
            }
            Ok(())
        });
        token(Kind::Array).ignore_then(bounds.clone()).then_ignore(of).then(spec.clone())
    })
    .map(|(bounds, element)| match bounds.into_iter().collect() {
        Some(bounds) => TypeKind::Array { bounds, element: Box::new(element) },
        // Bounds that did not parse make a type that is not known.
        None => TypeKind::Error,
    })
}

/// `1..3` or `*`; None for `10` and `1:3`, which are reported.
fn bound<'t, 's: 't>() -> impl Rule<'t, 's, Option<Bound<'s>>> {
    let open = token(Kind::Star).map(|span| Some(Bound::Open(span)));
    let last = token(Kind::DotDot).ignore_then(expr()).map(Ok);
    let range = expr().then(last.or(foreign_types::other_bound().map(Err)));
    open.or(reported(range, |(low, high), state, _| match high {
        Ok(high) => Some(Bound::Range(low, high)),
        Err(other) => {
            foreign_types::report_bound(state, &low, other);
            None
        }
    }))
}

/// `(Red, Green := 5)`
fn enumeration<'t, 's: 't>() -> impl Rule<'t, 's, Vec<EnumValue<'s>>> {
    let value = name().then(assign().ignore_then(expr()).or_not()).map_with(|(name, value), extra| {
        let tokens: SimpleSpan = extra.span();
        EnumValue { name, value, doc: doc::comment(extra.state(), tokens) }
    });
    let comma = token(Kind::Comma).ignored().or(foreign_types::missing_comma());
    delimited(Kind::OpenParen, value.separated_by(comma).at_least(1).collect(), Kind::CloseParen)
}

/// REF_TO, POINTER TO and REFERENCE TO are words only here.
fn reference<'t, 's: 't>(spec: impl Rule<'t, 's, TypeSpec<'s>>) -> impl Rule<'t, 's, TypeKind<'s>> {
    let kind = choice((
        word("POINTER").then(token(Kind::To)).to(RefKind::PointerTo),
        word("REFERENCE").then(token(Kind::To)).to(RefKind::ReferenceTo),
        word("REF_TO").then(token(Kind::To).or_not()).to(RefKind::RefTo),
    ));
    kind.then(spec).map(|(kind, target)| TypeKind::Reference { kind, target: Box::new(target) })
}

/// `STRING`, `STRING[80]`, `STRING(80)`, and the same for WSTRING.
fn string<'t, 's: 't>() -> impl Rule<'t, 's, TypeKind<'s>> {
    let wide = word("STRING").to(false).or(word("WSTRING").to(true));
    let in_brackets = expr().delimited_by(token(Kind::OpenBracket), token(Kind::CloseBracket));
    let in_parentheses = expr().delimited_by(token(Kind::OpenParen), token(Kind::CloseParen));
    let capacity = in_brackets.or(in_parentheses).map(Box::new).or_not();
    let no_more = ahead(|input| !matches!(input.kind(), Kind::OpenBracket | Kind::OpenParen));
    wide.then(capacity).then_ignore(no_more).map(|(wide, capacity)| TypeKind::String { wide, capacity })
}

/// What may follow the name of a type.
#[derive(Clone)]
enum Suffix<'s> {
    Values(Vec<EnumValue<'s>>),
    Range(Expr<'s>, Expr<'s>),
    Members(Vec<Name<'s>>),
    /// Read and reported.
    Foreign,
}

/// `INT (0..100)`, `INT (Red, Green)`, `CODESYS.CTU`
fn named<'t, 's: 't>() -> impl Rule<'t, 's, TypeKind<'s>> {
    let lists = ahead(|input| {
        input.kind_ahead(1) == Kind::Name
            && matches!(input.kind_ahead(2), Kind::Comma | Kind::CloseParen | Kind::Assign)
    });
    let values = lists.clone().ignore_then(enumeration()).map(Suffix::Values);
    let range = expr().then_ignore(token(Kind::DotDot)).then(expr());
    let range = range.delimited_by(token(Kind::OpenParen), token(Kind::CloseParen));
    let any_range = range.map(|(low, high)| Suffix::Range(low, high));
    let range = lists.not().ignore_then(any_range.clone());
    let member = token(Kind::Dot).ignore_then(name());
    let members = member.clone().repeated().collect().map(Suffix::Members);
    let some_members = member.repeated().at_least(1).collect().map(Suffix::Members);
    let no_more = ahead(|input| input.kind() != Kind::OpenParen);
    let length = foreign_types::length().to(Suffix::Foreign);
    let alone = no_more.map(|()| Suffix::Members(Vec::new()));
    let of_number = choice((values, range.clone(), length.clone(), some_members, alone));
    // What is in parentheses after another name may be for the FB_init of an instance.
    let members = members.then_ignore(unsupported::generic_values());
    let of_other = choice((any_range, length, members));
    let number = ahead(is_elementary).ignore_then(name()).then(of_number);
    let other = ahead(|input| !is_elementary(input) && !is_string(input)).ignore_then(name()).then(of_other);
    number.or(other).map(|(name, suffix)| match suffix {
        Suffix::Values(values) => TypeKind::Enum { base: Some(name), values },
        Suffix::Range(low, high) => TypeKind::Subrange { base: name, low: Box::new(low), high: Box::new(high) },
        Suffix::Members(mut members) => {
            members.insert(0, name);
            TypeKind::Named(members)
        }
        Suffix::Foreign => TypeKind::Error,
    })
}
