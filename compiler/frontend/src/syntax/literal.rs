//! Literals: their tokens' values, with what is wrong in them reported at the place.

use crate::{
    ast::{Literal, LiteralValue, Name},
    diagnostic::{Code, Diagnostic},
    lex::{self, Fault, Kind},
    source::Span,
};

use super::{
    foreign_syntax,
    parser::{Expected, In, Moves, Parsed},
};

/// A literal, if the current token is one.
pub fn untyped<'s>(input: &mut In<'_, '_, 's>, prefix: Option<Name<'s>>) -> Option<Literal<'s>> {
    let kind = input.kind();
    let span = input.here();
    let text = input.text(span);
    let value = match kind {
        Kind::True => LiteralValue::Bool(true),
        Kind::False => LiteralValue::Bool(false),
        Kind::Integer | Kind::Based => integer(input, span, text),
        Kind::Real => real(input, span, text),
        Kind::Time => duration(input, span, text),
        Kind::Date => LiteralValue::Date(date_kind(text)),
        Kind::Text | Kind::WideText | Kind::OpenText => string(input, span, text),
        _ => return None,
    };
    input.take();
    let glued = if matches!(kind, Kind::Integer | Kind::Real) { foreign_syntax::glued(input, span) } else { None };
    Some(Literal { prefix: prefix.map(Box::new), value: glued.unwrap_or(value) })
}

/// What stands behind `INT#`.
pub fn typed<'s>(input: &mut In<'_, '_, 's>, prefix: Name<'s>) -> Parsed<Literal<'s>> {
    if input.kind() == Kind::Name {
        let value = LiteralValue::Enumerator(Box::new(input.name()?));
        return Ok(Literal { prefix: Some(Box::new(prefix)), value });
    }
    match untyped(input, Some(prefix)) {
        Some(literal) => Ok(literal),
        None => Err(input.problem(Expected::Expression)),
    }
}

fn report(input: &mut In<'_, '_, '_>, code: Code, whole: Span, fault: Fault) {
    let at = |place: usize| whole.start + u32::try_from(place).unwrap_or(0);
    let span = Span { start: at(fault.start), end: at(fault.end), ..whole };
    let it = Diagnostic::new(code, span, fault.message);
    input.report(match fault.meant {
        Some(meant) => it.help(format!("write `{meant}`")).fix(whole, meant),
        None => it,
    });
}

/// A number that cannot be read; where letters stand directly behind it, they are what is wrong.
fn number_fault(input: &mut In<'_, '_, '_>, span: Span, fault: Fault) {
    let at = input.number() + 1;
    let next = input.state().place(at);
    if input.kind_ahead(1) != Kind::Name || next.start != span.end {
        report(input, Code::E0005, span, fault);
    }
}

fn real<'s>(input: &mut In<'_, '_, '_>, span: Span, text: &str) -> LiteralValue<'s> {
    match lex::real(text) {
        Ok(digits) => LiteralValue::Real(digits.into()),
        Err(fault) => {
            number_fault(input, span, fault);
            LiteralValue::Error
        }
    }
}

fn integer<'s>(input: &mut In<'_, '_, '_>, span: Span, text: &str) -> LiteralValue<'s> {
    let value = lex::integer(text).map(Some).unwrap_or_else(|fault| {
        number_fault(input, span, fault);
        None
    });
    match value {
        Some(value) => LiteralValue::Integer { value, based: text.contains('#') },
        None => LiteralValue::Error,
    }
}

fn duration<'s>(input: &mut In<'_, '_, '_>, span: Span, text: &str) -> LiteralValue<'s> {
    match lex::duration(text) {
        Ok((nanoseconds, long)) => LiteralValue::Time { nanoseconds, long },
        Err(fault) => {
            if !split_unit(input, span) {
                report(input, Code::E0006, span, fault);
            }
            LiteralValue::Error
        }
    }
}

/// `T#5 s`: leaves the unit as the current token.
fn split_unit(input: &mut In<'_, '_, '_>, span: Span) -> bool {
    let at = input.number() + 1;
    let unit = input.state().place(at);
    if input.kind_ahead(1) != Kind::Name
        || !foreign_syntax::is_unit(input.text(unit))
        || input.state().breaks(span.end, unit.start)
    {
        return false;
    }
    let meant = format!("{}{}", input.text(span), input.text(unit));
    let whole = span.to(unit);
    input.report(
        Diagnostic::new(Code::E0006, whole, "a duration is written in one piece")
            .help(format!("write `{meant}`"))
            .fix(whole, meant),
    );
    input.take();
    true
}

fn string<'s>(input: &mut In<'_, '_, '_>, span: Span, text: &str) -> LiteralValue<'s> {
    let wide = text.starts_with('"');
    let (bytes, faults) = lex::string(text, wide);
    for fault in faults {
        report(input, Code::E0007, span, fault);
    }
    LiteralValue::String { bytes: bytes.into(), wide }
}

/// The type that a date literal's prefix names.
fn date_kind(text: &str) -> &'static str {
    let prefix = text.split('#').next().unwrap_or_default().to_ascii_uppercase();
    match prefix.as_str() {
        "D" | "DATE" => "DATE",
        "LD" | "LDATE" => "LDATE",
        "TOD" | "TIME_OF_DAY" => "TIME_OF_DAY",
        "LTOD" | "LTIME_OF_DAY" => "LTIME_OF_DAY",
        "DT" | "DATE_AND_TIME" => "DATE_AND_TIME",
        _ => "LDATE_AND_TIME",
    }
}
