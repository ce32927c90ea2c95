//! What the grammar's rules are made of, besides chumsky's own combinators.
//!
//! A rule that fails after its first token ends the production around it: the farthest problem is
//! the one that is reported.

use chumsky::{input::InputRef, prelude::*};

use crate::{ast::Name, lex::Kind, source::Span};

use super::parser::{Expected, Extra, Parsed, State, TokenReader};

/// A parser of `T` from tokens: `'t` are the tokens, `'s` is the text.
pub trait Rule<'t, 's: 't, T>: Parser<'t, &'t [Kind], T, Extra<'t, 's>> + Clone {}
impl<'t, 's: 't, T, P: Parser<'t, &'t [Kind], T, Extra<'t, 's>> + Clone> Rule<'t, 's, T> for P {}

/// A rule that is written as moves over the tokens.
pub fn rule<'t, 's: 't, T>(
    read: impl Fn(&mut InputRef<'t, '_, &'t [Kind], Extra<'t, 's>>) -> Parsed<T> + Clone,
) -> impl Rule<'t, 's, T> {
    custom(read)
}

pub fn token<'t, 's: 't>(kind: Kind) -> impl Rule<'t, 's, Span> {
    rule(move |input| input.expect(kind))
}

pub fn name<'t, 's: 't>() -> impl Rule<'t, 's, Name<'s>> {
    rule(|input| input.name())
}

/// A word with a meaning in some places, and a name elsewhere.
pub fn word<'t, 's: 't>(word: &'static str) -> impl Rule<'t, 's, Span> {
    rule(move |input| if input.is_word(word) { Ok(input.take()) } else { Err(input.problem(Expected::Name)) })
}

/// Takes nothing, and fails unless the tokens ahead are as `look` wants them.
pub fn ahead<'t, 's: 't>(
    look: impl Fn(&mut InputRef<'t, '_, &'t [Kind], Extra<'t, 's>>) -> bool + Clone,
) -> impl Rule<'t, 's, ()> {
    rule(move |input| if look(input) { Ok(()) } else { Err(input.problem(Expected::Other)) })
}

/// `item, item, …`
pub fn list<'t, 's: 't, T>(item: impl Rule<'t, 's, T>) -> impl Rule<'t, 's, Vec<T>> {
    item.separated_by(token(Kind::Comma)).at_least(1).collect()
}

/// [`list`], or nothing before `end`.
pub fn list_before<'t, 's: 't, T>(end: Kind, item: impl Rule<'t, 's, T>) -> impl Rule<'t, 's, Vec<T>> {
    ahead(move |input| input.kind() == end).map(|()| Vec::new()).or(list(item))
}

/// `inner` in brackets. Without the closing one, the message shows where it was opened.
pub fn delimited<'t, 's: 't, T>(open: Kind, inner: impl Rule<'t, 's, T>, end: Kind) -> impl Rule<'t, 's, T> {
    rule(move |input| {
        let opened = input.number();
        let close = rule(move |input| input.eat(end).ok_or_else(|| input.problem(Expected::More(end, opened))));
        input.parse(token(open).ignore_then(&inner).then_ignore(close))
    })
}

/// `inner`, and what is said about it. A report must not be made in chumsky's own `map_with`, which
/// is left out where nobody wants the value.
pub fn reported<'t, 's: 't, T, U>(
    inner: impl Rule<'t, 's, T>,
    report: impl Fn(T, &mut State<'t, 's>, SimpleSpan) -> U + Clone,
) -> impl Rule<'t, 's, U> {
    rule(move |input| {
        let first = input.number();
        let it = input.parse(&inner)?;
        let tokens = SimpleSpan::from(first..input.number());
        Ok(report(it, input.state(), tokens))
    })
}

/// A rule that knows where it starts.
pub fn from_here<'t, 's: 't, T, R: Rule<'t, 's, T>>(make: impl Fn(Span) -> R + Clone) -> impl Rule<'t, 's, T> {
    rule(move |input| {
        let here = input.here();
        input.parse(make(here))
    })
}

/// A level of combinators takes as much of the stack as this many of an expression.
const LEVELS: usize = 4;

/// One level deeper, unless that is too deep.
pub fn nested<'t, 's: 't, T>(inner: impl Rule<'t, 's, T>) -> impl Rule<'t, 's, T> {
    rule(move |input| {
        input.enter(LEVELS)?;
        let it = input.parse(&inner);
        input.leave(LEVELS);
        it
    })
}
