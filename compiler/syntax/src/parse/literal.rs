//! Literals: their tokens' values, with what is wrong in them reported at the place.

use chumsky::prelude::*;

use crate::{
    ast::{Literal, LiteralValue, Name},
    diagnostic::{Code, Diagnostic},
    lex::{self, Fault, Kind},
    source::Span,
};

use super::{
    combinator::{Rule, name, rule},
    foreign_syntax,
    parser::{In, State, TokenReader},
};

/// Reads the value of the literal at a token number.
type Read<'t, 's> = fn(&mut State<'t, 's>, usize) -> LiteralValue<'s>;

/// A literal; `prefix` is the type before its `#`.
pub fn literal<'t, 's: 't>(prefix: Option<Name<'s>>) -> impl Rule<'t, 's, Literal<'s>> {
    let read = select! {
        Kind::True | Kind::False => boolean as Read<'t, 's>,
        Kind::Integer | Kind::Based => integer,
        Kind::Real => real,
        Kind::Time => duration,
        Kind::Date => date,
        Kind::Text | Kind::WideText | Kind::OpenText => string,
    };
    let is_wide = prefix.is_some_and(|it| ["WSTRING", "WCHAR"].iter().any(|wide| it.text.eq_ignore_ascii_case(wide)));
    let value = read.map_with(move |read, extra| {
        let token: SimpleSpan = extra.span();
        let state: &mut State<'t, 's> = extra.state();
        let is_wide = is_wide && state.tokens.kinds.get(token.start) == Some(&Kind::Text);
        if is_wide { text(state, token.start, true) } else { read(state, token.start) }
    });
    value.then(rule(|input| Ok(has_more(input)))).map(move |(value, more)| {
        let value = if more { LiteralValue::Error } else { value };
        Literal { prefix: prefix.map(Box::new), value }
    })
}

/// What follows `INT#` or `Color#`.
pub fn typed<'t, 's: 't>(prefix: Name<'s>) -> impl Rule<'t, 's, Literal<'s>> {
    let enumerator = name().map(move |name| {
        let value = LiteralValue::Enumerator(Box::new(name));
        Literal { prefix: Some(Box::new(prefix)), value }
    });
    enumerator.or(literal(Some(prefix)))
}

/// What follows a literal and belongs to it, taken: letters after a number or a duration, the time of day after a date.
fn has_more(input: &mut In<'_, '_, '_>) -> bool {
    let (literal, at) = (input.last(), input.number().saturating_sub(1));
    let is_name = input.kind() == Kind::Name;
    match input.state().tokens.kinds.get(at) {
        Some(Kind::Date) => {
            let count = clock_apart(input.state(), at).max(slashes(input.state(), at));
            for _ in 0..count {
                input.take();
            }
            count > 0
        }
        Some(Kind::Integer | Kind::Real) if is_name => foreign_syntax::glued(input, literal),
        Some(Kind::Time) if decimal_comma(input.state(), at).is_some() => {
            for _ in 0..3 {
                input.take();
            }
            true
        }
        Some(Kind::Time) if is_name && lacks_unit(input.state(), at) => {
            input.take();
            true
        }
        _ => false,
    }
}

/// `T#5 s`: a duration that lacks the unit that follows it.
fn lacks_unit(state: &State<'_, '_>, at: usize) -> bool {
    let (duration, unit) = (state.place(at), state.place(at + 1));
    state.tokens.kinds.get(at + 1) == Some(&Kind::Name)
        && foreign_syntax::is_unit(state.slice(unit))
        && !state.breaks(duration.end, unit.start)
        && lex::duration(state.slice(duration)).is_err()
}

/// `T#1,5s`, which is one duration, and as it is meant.
fn decimal_comma(state: &State<'_, '_>, at: usize) -> Option<(Span, String)> {
    let follows = state.tokens.kinds.get(at + 1..)?.starts_with(&[Kind::Comma, Kind::Integer, Kind::Name]);
    let is_joined = || (at..at + 3).all(|it| state.place(it).end == state.place(it + 1).start);
    if !follows || !is_joined() {
        return None;
    }
    let whole = state.place(at).to(state.place(at + 3));
    let meant = state.slice(whole).replace(',', ".");
    lex::duration(&meant).is_ok().then_some((whole, meant))
}

/// `DT#2024-02-29 12:30:00`: how many tokens its time of day has after a space.
fn clock_apart(state: &State<'_, '_>, at: usize) -> usize {
    let is_part = |it: &usize| matches!(state.tokens.kinds.get(*it), Some(Kind::Integer | Kind::Real | Kind::Colon));
    let count = (at + 1..).take_while(is_part).count();
    let (date, first) = (state.place(at), state.place(at + 1));
    let is_meant = count >= 3
        && !state.breaks(date.end, first.start)
        && lex::date(state.slice(date)).is_err()
        && lex::date(&in_one_piece(state, at, count).1).is_ok();
    if is_meant { count } else { 0 }
}

/// `D#2024/02/29`: how many tokens follow the year.
fn slashes(state: &State<'_, '_>, at: usize) -> usize {
    let shape = [Kind::Slash, Kind::Integer, Kind::Slash, Kind::Integer];
    let is_joined = (at..at + shape.len()).all(|it| state.place(it).end == state.place(it + 1).start);
    let follows = state.tokens.kinds.get(at + 1..).is_some_and(|it| it.starts_with(&shape));
    let is_meant = follows && is_joined && lex::date(&with_hyphens(state, at).1).is_ok();
    if is_meant { shape.len() } else { 0 }
}

/// Such a literal, and as it is meant.
fn with_hyphens(state: &State<'_, '_>, at: usize) -> (Span, String) {
    let whole = state.place(at).to(state.place(at + 4));
    (whole, state.slice(whole).replace('/', "-"))
}

/// Such a literal, and as it is meant.
fn in_one_piece(state: &State<'_, '_>, at: usize, count: usize) -> (Span, String) {
    let (date, clock) = (state.place(at), state.place(at + 1).to(state.place(at + count)));
    (date.to(clock), format!("{}-{}", state.slice(date), state.slice(clock)))
}

fn report(state: &mut State<'_, '_>, code: Code, whole: Span, fault: Fault) {
    let at = |place: usize| whole.start + u32::try_from(place).unwrap_or(0);
    let span = Span { start: at(fault.start), end: at(fault.end), ..whole };
    let it = Diagnostic::new(code, span, fault.message);
    state.report(match fault.meant {
        Some(meant) => it.help(format!("write `{meant}`")).fix(whole, meant),
        None => match fault.help {
            Some(help) => it.help(help),
            None => it,
        },
    });
}

/// A number that cannot be read; where letters directly follow it, they are what is wrong.
fn number_fault<'s>(state: &mut State<'_, '_>, at: usize, fault: Fault) -> LiteralValue<'s> {
    let (span, next) = (state.place(at), state.place(at + 1));
    if state.tokens.kinds.get(at + 1) != Some(&Kind::Name) || next.start != span.end {
        report(state, Code::E0005, span, fault);
    }
    LiteralValue::Error
}

fn boolean<'s>(state: &mut State<'_, 's>, at: usize) -> LiteralValue<'s> {
    LiteralValue::Bool(state.tokens.kinds.get(at) == Some(&Kind::True))
}

fn real<'s>(state: &mut State<'_, 's>, at: usize) -> LiteralValue<'s> {
    match lex::real(state.slice(state.place(at))) {
        Ok(digits) => LiteralValue::Real(digits.into()),
        Err(fault) => number_fault(state, at, fault),
    }
}

fn integer<'s>(state: &mut State<'_, 's>, at: usize) -> LiteralValue<'s> {
    let text = state.slice(state.place(at));
    match lex::integer(text) {
        Ok(value) => LiteralValue::Integer { value, based: text.contains('#') },
        Err(fault) => number_fault(state, at, fault),
    }
}

fn duration<'s>(state: &mut State<'_, 's>, at: usize) -> LiteralValue<'s> {
    let span = state.place(at);
    let fault = match lex::duration(state.slice(span)) {
        Ok((ty, nanoseconds)) => return LiteralValue::Time { ty, nanoseconds },
        Err(fault) => fault,
    };
    if let Some((whole, meant)) = decimal_comma(state, at) {
        state.report(foreign_syntax::comma_for_point(whole, meant));
        return LiteralValue::Error;
    }
    if !lacks_unit(state, at) {
        report(state, Code::E0006, span, fault);
        return LiteralValue::Error;
    }
    let unit = state.place(at + 1);
    let (meant, whole) = (format!("{}{}", state.slice(span), state.slice(unit)), span.to(unit));
    state.report(
        Diagnostic::new(Code::E0006, whole, "a duration is written in one piece")
            .help(format!("write `{meant}`"))
            .fix(whole, meant),
    );
    LiteralValue::Error
}

fn string<'s>(state: &mut State<'_, 's>, at: usize) -> LiteralValue<'s> {
    let is_wide = state.slice(state.place(at)).starts_with('"');
    text(state, at, is_wide)
}

/// `'…'` or `"…"`; after `WSTRING#` the first is wide, too, and the dialect says whether it may be there.
fn text<'s>(state: &mut State<'_, 's>, at: usize, is_wide: bool) -> LiteralValue<'s> {
    let span = state.place(at);
    let text = state.slice(span);
    let (chars, faults) = lex::string(text, is_wide);
    for fault in faults {
        report(state, Code::E0007, span, fault);
    }
    LiteralValue::String(Box::new(chars))
}

fn date<'s>(state: &mut State<'_, 's>, at: usize) -> LiteralValue<'s> {
    let span = state.place(at);
    let count = clock_apart(state, at);
    if count > 0 {
        let (whole, meant) = in_one_piece(state, at, count);
        state.report(
            Diagnostic::new(Code::E0006, whole, "a date and a time of day are written in one piece")
                .help(format!("write `{meant}`"))
                .fix(whole, meant),
        );
        return LiteralValue::Error;
    }
    if slashes(state, at) > 0 {
        let (whole, meant) = with_hyphens(state, at);
        state.report(
            Diagnostic::new(Code::E0006, whole, "the parts of a date are separated by `-`")
                .help(format!("write `{meant}`"))
                .fix(whole, meant),
        );
        return LiteralValue::Error;
    }
    match lex::date(state.slice(span)) {
        Ok((ty, nanoseconds)) => LiteralValue::Time { ty, nanoseconds },
        Err(fault) => {
            report(state, Code::E0006, span, fault);
            LiteralValue::Error
        }
    }
}
