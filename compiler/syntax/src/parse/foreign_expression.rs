//! Operands as other languages write them: casts, functions without their parentheses, tags of Logix's modules.

use crate::{
    ast::{Expr, ExprKind},
    diagnostic::{Code, Diagnostic},
    lex::Kind,
    source::Span,
};

use super::{
    foreign_reader::type_of_ours,
    parser::{In, TokenReader},
};

/// Functions of one operand that are written like operators elsewhere.
const FUNCTIONS: [&str; 10] = ["ADR", "REF", "SIZEOF", "ABS", "SQRT", "LN", "LOG", "EXP", "LEN", "TRUNC"];

/// The type that `(REAL) n` is cast to, after the `(REAL)`: its operand follows.
pub fn cast_type(input: &mut In<'_, '_, '_>, ty: &Expr<'_>) -> Option<&'static str> {
    let ExprKind::Name(name) = &ty.kind else { return None };
    let follows = matches!(input.kind(), Kind::Name | Kind::Integer | Kind::Real | Kind::OpenParen);
    type_of_ours(name.text).filter(|_| follows && !input.on_new_line())
}

/// `(REAL) n`, from its first parenthesis on.
pub fn cast<'s>(input: &mut In<'_, '_, 's>, opened: Span, ty: &str, operand: &Expr<'s>) -> Expr<'s> {
    let whole = opened.to(operand.span);
    let inner = if let ExprKind::Paren(inner) = &operand.kind { inner.span } else { operand.span };
    let meant = format!("TO_{ty}({})", input.text(inner));
    input.report(
        Diagnostic::new(Code::E0010, whole, "Structured Text converts a value with a function, not with a cast")
            .label(format!("expected `{meant}`"))
            .help(format!("write `{meant}`"))
            .fix(whole, meant),
    );
    Expr { kind: ExprKind::Error(Vec::new()), span: whole }
}

/// `n as INT`, after the `n`.
pub fn cast_after(input: &mut In<'_, '_, '_>, value: &mut Expr<'_>) {
    if !input.is_word("AS") || input.kind_ahead(1) != Kind::Name || input.on_new_line() {
        return;
    }
    let at = input.number() + 1;
    let ty = input.state().place(at);
    let Some(ty) = type_of_ours(input.text(ty)) else { return };
    input.take();
    let opened = value.span;
    let whole = opened.to(input.take());
    let meant = format!("TO_{ty}({})", input.text(opened));
    input.report(
        Diagnostic::new(Code::E0010, whole, "Structured Text converts a value with a function, not with `as`")
            .label(format!("expected `{meant}`"))
            .help(format!("write `{meant}`"))
            .fix(whole, meant),
    );
    *value = Expr { kind: ExprKind::Error(Vec::new()), span: whole };
}

/// What other languages write before the quoted digits of a number, and its base.
const BASES: [(&str, u32); 4] = [("H", 16), ("X", 16), ("O", 8), ("B", 2)];

/// Refuses `H'FF'`, a number of base 16, and passes over it, if it is here.
pub fn quoted_number(input: &mut In<'_, '_, '_>) -> bool {
    if !matches!(input.kind_ahead(1), Kind::Text | Kind::WideText) {
        return false;
    }
    let at = input.number();
    let (word, quoted) = (input.here(), input.state().place(at + 1));
    let letter = input.text(word);
    let digits = input.text(quoted).trim_matches(['\'', '"']).to_ascii_uppercase();
    let base = BASES.iter().find(|it| it.0.eq_ignore_ascii_case(letter)).map(|it| it.1);
    let Some(base) = base.filter(|base| !digits.is_empty() && digits.chars().all(|it| it.is_digit(*base))) else {
        return false;
    };
    if word.end != quoted.start {
        return false;
    }
    let whole = word.to(quoted);
    let (own, meant) = (input.text(whole), format!("{base}#{digits}"));
    input.report(
        Diagnostic::new(Code::E0006, whole, format!("`{own}` is not a number"))
            .label(format!("expected `{meant}`"))
            .help(format!("a number of base {base} is written `{meant}`"))
            .fix(whole, meant),
    );
    input.take();
    input.take();
    true
}

/// Whether `ADR n` is here: a function and its one operand, which have no parentheses.
pub fn lacks_parentheses(input: &mut In<'_, '_, '_>) -> bool {
    // Each name is looked at: what follows decides first.
    if !matches!(input.kind_ahead(1), Kind::Name | Kind::Integer | Kind::Real) {
        return false;
    }
    let at = input.number();
    let (name, next) = (input.here(), input.state().place(at + 1));
    let text = input.text(name);
    let is_conversion = || text.to_ascii_uppercase().contains("TO_");
    let is_function = FUNCTIONS.iter().any(|it| text.eq_ignore_ascii_case(it)) || is_conversion();
    is_function && !input.state().breaks(name.end, next.start) && !is_infix(input)
}

/// `ADR n`, with its operand read.
pub fn without_parentheses<'s>(input: &mut In<'_, '_, 's>, name: Span, operand: &Expr<'s>) -> Expr<'s> {
    let text = input.text(name);
    let (whole, meant) = (name.to(operand.span), format!("{text}({})", input.text(operand.span)));
    input.report(
        Diagnostic::new(Code::E0001, whole, format!("`{text}` takes its argument in parentheses"))
            .label(format!("expected `{meant}`"))
            .help(format!("write `{meant}`"))
            .fix(whole, meant),
    );
    Expr { kind: ExprKind::Error(Vec::new()), span: whole }
}

/// Whether the second name is nearly an operator: `len ADN b`.
fn is_infix(input: &mut In<'_, '_, '_>) -> bool {
    input.kind_ahead(1) == Kind::Name
        && matches!(input.kind_ahead(2), Kind::Name | Kind::Integer | Kind::Real | Kind::Not | Kind::Equal)
}

/// `Local:1:I`, the tag of a module of Logix: taken, and refused.
pub fn module_tag(input: &mut In<'_, '_, '_>) -> Option<Span> {
    let kinds = [Kind::Name, Kind::Colon, Kind::Integer, Kind::Colon, Kind::Name];
    let at = input.number();
    let is_shape = (0..kinds.len()).all(|it| input.kind_ahead(it) == kinds[it]);
    let state = input.state();
    let is_joined = || (at..at + 4).all(|it| state.place(it).end == state.place(it + 1).start);
    if !is_shape || !is_joined() {
        return None;
    }
    let whole = input.here().to(input.state().place(at + 4));
    for _ in kinds {
        input.take();
    }
    let text = input.text(whole);
    input.report(
        Diagnostic::new(Code::E0020, whole, format!("`{text}` is the tag of a module of Logix"))
            .label("a module's tags are known only in an L5X project")
            .help("compile the project's L5X file, or declare a variable and use it in the tag's place"),
    );
    Some(whole)
}
