//! Signs that other languages write for ours.

use crate::{
    ast::{BinaryOp, Expr},
    diagnostic::{Code, Diagnostic},
    lex::{Kind, index},
    source::Span,
};

use super::super::parser::{In, TokenReader};

pub fn equal_for_assign(sign: Span, text: &str) -> Diagnostic {
    let message = match text {
        "=" | "==" => format!("`{text}` compares; an assignment is written `:=`"),
        _ => "`:=` is written in one piece".into(),
    };
    Diagnostic::new(Code::E0008, sign, message).label("expected `:=`").help("write `:=`").fix(sign, ":=")
}

pub fn foreign_operator(input: &mut In<'_, '_, '_>, kind: Kind, op: BinaryOp, sign: Span) {
    if kind == Kind::Caret {
        input.report(
            Diagnostic::new(Code::E0010, sign, "Structured Text has no `^` between two values")
                .label("expected `**` or `XOR`")
                .help("write `x ** 2.0` for a power, which is a REAL, and `a XOR b` for bits that differ"),
        );
        return;
    }
    let ours = op.text();
    let replacement = spaced(input, ours, sign);
    let theirs = if kind == Kind::Name { format!("`{}`", input.text(sign)) } else { kind.to_string() };
    let mut it = Diagnostic::new(Code::E0010, sign, format!("Structured Text writes `{ours}` for {theirs}"))
        .label(format!("expected `{ours}`"))
        .help(format!("write `{ours}`"))
        .fix(sign, replacement);
    match op {
        BinaryOp::And => it = it.note("`AND_THEN` evaluates its right side only when it is needed"),
        BinaryOp::Or => it = it.note("`OR_ELSE` evaluates its right side only when it is needed"),
        _ => {}
    }
    input.report(it);
}

/// A word needs a space where the sign directly touched its neighbours.
fn spaced(input: &mut In<'_, '_, '_>, operator: &str, sign: Span) -> String {
    if !operator.starts_with(|it: char| it.is_ascii_alphabetic()) {
        return operator.into();
    }
    let bytes = input.state().text.as_bytes();
    let beside = |at: usize| bytes.get(at).is_some_and(|it| !it.is_ascii_whitespace());
    let before = if beside(index(sign.start).wrapping_sub(1)) { " " } else { "" };
    let after = if beside(index(sign.end)) { " " } else { "" };
    format!("{before}{operator}{after}")
}

pub fn foreign_not(sign: Span) -> Diagnostic {
    Diagnostic::new(Code::E0010, sign, "Structured Text writes `NOT` for `!`")
        .label("expected `NOT`")
        .help("write `NOT`")
        .fix(sign, "NOT ")
}

/// `x += 1`
pub fn compound_assignment(input: &mut In<'_, '_, '_>, target: &Expr<'_>) -> Diagnostic {
    let sign = input.here();
    let (text, target) = (input.text(sign), input.text(target.span));
    let op = &text[..1];
    Diagnostic::new(Code::E0010, sign, format!("Structured Text has no `{text}`"))
        .label("expected `:=`")
        .help(format!("write `{target} := {target} {op} …`"))
        .fix(sign, format!(":= {target} {op}"))
}

/// `x++;`
pub fn increment(input: &mut In<'_, '_, '_>, target: &Expr<'_>) -> bool {
    let kind = input.kind();
    let doubled = matches!(kind, Kind::Plus | Kind::Minus) && input.kind_ahead(1) == kind;
    if !doubled || input.kind_ahead(2) != Kind::Semicolon {
        return false;
    }
    let sign = input.take();
    let sign = sign.to(input.take());
    let (text, name) = (input.text(sign), input.text(target.span));
    let op = &text[..1];
    input.report(
        Diagnostic::new(Code::E0010, sign, format!("Structured Text has no `{text}`"))
            .label("expected `:=`")
            .help(format!("write `{name} := {name} {op} 1`"))
            .fix(target.span.to(sign), format!("{name} := {name} {op} 1")),
    );
    true
}
