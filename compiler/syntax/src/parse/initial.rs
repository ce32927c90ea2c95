//! Initial values, after `:=`.

use chumsky::prelude::*;

use crate::{
    ast::{Element, Expr, ExprKind, Initial, InitialKind, Name},
    lex::Kind,
    source::Span,
};

use super::{
    combinator::{Rule, ahead, delimited, list, list_before, name, nested, rule, token},
    expression::{expr, joins_equal},
    foreign_types, literal,
    parser::{In, Parsed, TokenReader},
};

/// `:= value` or `REF= x`, if present.
pub fn optional_initial<'t, 's: 't>() -> impl Rule<'t, 's, Option<Initial<'s>>> {
    let none = ahead(|input| !binds(input, 0) && !matches!(input.kind(), Kind::Assign | Kind::Equal)).to(None);
    let bound = ahead(|input| binds(input, 0)).ignore_then(binding()).map(Some);
    none.or(bound).or(assign().ignore_then(value_or_elements()).map(Some))
}

fn binds(input: &mut In<'_, '_, '_>, ahead: usize) -> bool {
    joins_equal(input, ahead, &["REF"])
}

/// `REF= x`
fn binding<'t, 's: 't>() -> impl Rule<'t, 's, Initial<'s>> {
    let value = token(Kind::Name).ignore_then(token(Kind::Equal)).ignore_then(expr());
    value.map(|it| Initial { span: it.span, kind: InitialKind::Bind(it) })
}

/// `:=`, also as the `=` of other languages.
pub fn assign<'t, 's: 't>() -> impl Rule<'t, 's, Span> {
    token(Kind::Assign).or(foreign_types::equal_for_assign())
}

/// One value, or an array without its brackets, as older code writes it: `:= 1, 2, 3(0)`.
fn value_or_elements<'t, 's: 't>() -> impl Rule<'t, 's, Initial<'s>> {
    list(element()).map_with(|mut elements, extra| match (elements.pop(), elements.is_empty()) {
        (Some(Element { count: None, mut values }), true) if values.len() == 1 => values.remove(0),
        (last, _) => {
            elements.extend(last);
            let tokens = extra.span();
            Initial { kind: InitialKind::Elements(elements), span: extra.state().span(tokens) }
        }
    })
}

/// A rule for what is inside of itself ends in a function: its type would have no end.
fn initial<'t, 's: 't>() -> impl Rule<'t, 's, Initial<'s>> {
    rule(read_initial)
}

fn read_initial<'t, 's: 't>(input: &mut In<'t, '_, 's>) -> Parsed<Initial<'s>> {
    let elements = delimited(Kind::OpenBracket, list_before(Kind::CloseBracket, element()), Kind::CloseBracket);
    let bound = ahead(|input| binds(input, 0)).ignore_then(binding());
    let given = token(Kind::Assign).ignore_then(initial());
    let indices =
        delimited(Kind::OpenBracket, list(expr()), Kind::CloseBracket).repeated().at_least(1).collect::<Vec<_>>();
    let element = indices.then_ignore(token(Kind::Assign)).then(initial()).map_with(|(indices, value), extra| {
        let tokens = extra.span();
        let kind = InitialKind::Indexed(vec![(indices.into_iter().flatten().collect(), value)]);
        Initial { kind, span: extra.state().span(tokens) }
    });
    let element = ahead(|input| input.kind() == Kind::OpenBracket).ignore_then(element);
    let field = name().then(bound.or(given).or(element));
    let fields = delimited(Kind::OpenParen, list(field), Kind::CloseParen).map(join_elements);
    let members = delimited(Kind::OpenParen, list(initial()), Kind::CloseParen);
    let unread = |span| Expr { kind: ExprKind::Error(Vec::new()), span };
    let kind = choice((
        elements.map(InitialKind::Elements),
        ahead(is_empty)
            .ignore_then(token(Kind::OpenParen))
            .ignore_then(token(Kind::CloseParen))
            .map(|_| InitialKind::Fields(Vec::new())),
        ahead(opens_fields).ignore_then(fields).map(InitialKind::Fields),
        ahead(opens_members).ignore_then(members).map(InitialKind::Members),
        foreign_types::brace_list("[", "]").map(unread).map(InitialKind::Value),
        ahead(|input| !opens_fields(input) && !opens_members(input) && !is_empty(input))
            .ignore_then(expr())
            .map(InitialKind::Value),
    ));
    input.parse(nested(kind).map_with(|kind, extra| {
        let tokens = extra.span();
        Initial { kind, span: extra.state().span(tokens) }
    }))
}

/// `()`
fn is_empty(input: &mut In<'_, '_, '_>) -> bool {
    input.kind() == Kind::OpenParen && input.kind_ahead(1) == Kind::CloseParen
}

fn opens_fields(input: &mut In<'_, '_, '_>) -> bool {
    let is_given = |input: &mut In<'_, '_, '_>| {
        let at = after_indices(input, 2);
        input.kind_ahead(at) == Kind::Assign || at == 2 && binds(input, 2)
    };
    input.kind() == Kind::OpenParen && input.kind_ahead(1) == Kind::Name && is_given(input)
}

/// What follows indices, `[1][2, 3]`.
fn after_indices(input: &mut In<'_, '_, '_>, from: usize) -> usize {
    let mut at = from;
    while input.kind_ahead(at) == Kind::OpenBracket {
        let Some(close) = closing(input, at) else { return from };
        at = close + 1;
    }
    at
}

/// Where the bracket or parenthesis is closed that is opened `ahead`, in the same statement.
fn closing(input: &mut In<'_, '_, '_>, ahead: usize) -> Option<usize> {
    let mut depth = 0_usize;
    for at in ahead.. {
        match input.kind_ahead(at) {
            Kind::OpenBracket | Kind::OpenParen => depth += 1,
            Kind::CloseBracket | Kind::CloseParen => depth = depth.checked_sub(1)?,
            Kind::End | Kind::Semicolon => return None,
            _ => {}
        }
        if depth == 0 {
            return Some(at);
        }
    }
    None
}

/// Whether values in parentheses are a list: an expression has no comma there, and does not begin with a bracket.
fn opens_members(input: &mut In<'_, '_, '_>) -> bool {
    if input.kind() != Kind::OpenParen {
        return false;
    }
    let Some(close) = closing(input, 0) else { return false };
    let mut depth = 0_usize;
    for at in 1..close {
        match input.kind_ahead(at) {
            Kind::OpenBracket if at == 1 => return true,
            Kind::OpenBracket | Kind::OpenParen => depth += 1,
            Kind::CloseBracket | Kind::CloseParen => depth = depth.saturating_sub(1),
            Kind::Comma if depth == 0 => return true,
            _ => {}
        }
    }
    false
}

/// Puts the elements of a member together.
fn join_elements<'s>(given: Vec<(Name<'s>, Initial<'s>)>) -> Vec<(Name<'s>, Initial<'s>)> {
    let mut fields: Vec<(Name<'s>, Initial<'s>)> = Vec::with_capacity(given.len());
    for (name, initial) in given {
        let is_same = |it: &&mut (Name<'s>, Initial<'s>)| {
            it.0.text.eq_ignore_ascii_case(name.text) && matches!(it.1.kind, InitialKind::Indexed(_))
        };
        let InitialKind::Indexed(more) = initial.kind else {
            fields.push((name, initial));
            continue;
        };
        match fields.iter_mut().rev().find(is_same).map(|it| &mut it.1.kind) {
            Some(InitialKind::Indexed(elements)) => elements.extend(more),
            _ => fields.push((name, Initial { kind: InitialKind::Indexed(more), span: initial.span })),
        }
    }
    fields
}

fn is_repeat(input: &mut In<'_, '_, '_>) -> bool {
    matches!(input.kind(), Kind::Integer | Kind::Based) && input.kind_ahead(1) == Kind::OpenParen
}

/// `x`, or `4(x, y)`.
fn element<'t, 's: 't>() -> impl Rule<'t, 's, Element<'s>> {
    // The number before `(` must not be read as a call.
    let count = literal::literal(None).map_with(|literal, extra| {
        let tokens = extra.span();
        Expr { kind: ExprKind::Literal(literal), span: extra.state().span(tokens) }
    });
    let values = delimited(Kind::OpenParen, list_before(Kind::CloseParen, initial()), Kind::CloseParen);
    let repeated = count.then(values).map(|(count, values)| Element { count: Some(count), values });
    let single = initial().map(|it| Element { count: None, values: vec![it] });
    let named = name().map(|name| Expr { span: name.span, kind: ExprKind::Name(name) });
    let values = delimited(Kind::OpenParen, list_before(Kind::CloseParen, initial()), Kind::CloseParen);
    let named = named.then(values).map(|(count, values)| Element { count: Some(count), values });
    let is_single = |input: &mut In<'_, '_, 's>| !is_repeat(input) && !is_named_repeat(input);
    choice((
        ahead(is_repeat).ignore_then(repeated),
        ahead(is_named_repeat).ignore_then(named),
        ahead(is_single).ignore_then(single),
    ))
}

/// `COUNT((x := 1))`: as a call it would make no sense.
fn is_named_repeat(input: &mut In<'_, '_, '_>) -> bool {
    let is_given = |input: &mut In<'_, '_, '_>| input.kind_ahead(4) == Kind::Assign || binds(input, 4);
    let opens = (input.kind(), input.kind_ahead(1), input.kind_ahead(2), input.kind_ahead(3));
    opens == (Kind::Name, Kind::OpenParen, Kind::OpenParen, Kind::Name) && is_given(input)
}
