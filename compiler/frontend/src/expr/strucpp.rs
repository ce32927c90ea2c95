//! What C++ makes of an expression in OpenPLC from v4.1 on: STruC++ keeps variables in a class of its own, and its library computes
//! otherwise with what is a plain `bool`, `int` or `char *`.

use super::checker::Checker;
use crate::Span;
use crate::ast::{self, ArgumentKind, BinaryOp, ExprKind, LiteralValue, UnaryOp};
use crate::dialect::rules::Functions;
use staunch_ir::{Conversion, Expr, Type};

/// What a BOOL is in C++.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Held {
    /// A variable's class.
    Class,
    /// A `bool`.
    Plain,
    /// The bit of a variable, an `int`.
    Bit,
}

impl<'s> Checker<'_, 's> {
    pub(super) fn has_functions_of_strucpp(&self, at: Span) -> bool {
        self.decl.dialect(at).rules().functions.choice == Functions::OfStrucpp
    }

    /// A BOOL that is a plain one there has the text of a number, `1` or `0`.
    pub(super) fn plain_bool_as_number(&mut self, value: Expr, written: &ast::Expr<'s>) -> Expr {
        let is_plain =
            value.ty == Type::BOOL && self.has_functions_of_strucpp(written.span) && held(written) != Held::Class;
        if is_plain { self.convert(Conversion::Value, Type::LINT, value) } else { value }
    }

    /// Whether it is a pointer to characters, which as a BOOL is TRUE: a text that is written.
    pub(super) fn is_pointer_in_strucpp(&self, written: &ast::Expr<'s>) -> bool {
        let is_text = |it: &ast::Literal<'_>| it.prefix.is_none() && matches!(it.value, LiteralValue::String(_));
        self.has_functions_of_strucpp(written.span)
            && matches!(&written.bare().kind, ExprKind::Literal(it) if is_text(it))
    }
}

fn held(expr: &ast::Expr<'_>) -> Held {
    match &expr.kind {
        ExprKind::Paren(inner) => held(inner),
        ExprKind::Literal(it) if it.prefix.is_none() => Held::Plain,
        // In parentheses its operand is the argument of a function.
        ExprKind::Unary(UnaryOp::Not, inner) => match inner.kind {
            ExprKind::Paren(_) => held(inner),
            _ => Held::Plain,
        },
        ExprKind::Binary(sides, BinaryOp::And | BinaryOp::Or | BinaryOp::Xor, _) => {
            let sides = sides.each_ref().map(held);
            let is_class = sides.contains(&Held::Class) && !sides.contains(&Held::Bit);
            if is_class { Held::Class } else { Held::Plain }
        }
        ExprKind::Binary(..) => Held::Plain,
        ExprKind::Part(..) => Held::Bit,
        ExprKind::Call(callee, arguments) => of_call(callee, arguments),
        _ => Held::Class,
    }
}

/// Templates give what they are given.
fn of_call(callee: &ast::Expr<'_>, arguments: &[ast::Argument<'_>]) -> Held {
    const TEMPLATES: [&str; 9] = ["SEL", "MUX", "MAX", "MIN", "LIMIT", "MOVE", "AND", "OR", "XOR"];
    let ExprKind::Name(name) = &callee.kind else { return Held::Class };
    let Some(template) = TEMPLATES.iter().find(|it| it.eq_ignore_ascii_case(name.text)) else { return Held::Class };
    // What selects is not among them.
    let passed = usize::from(matches!(*template, "SEL" | "MUX"));
    let given = arguments.iter().skip(passed).filter_map(|it| match &it.kind {
        ArgumentKind::Positional(value) | ArgumentKind::Input(_, value) => Some(held(value)),
        ArgumentKind::Output { .. } => None,
    });
    let given: Vec<Held> = given.collect();
    let is_class = match *template {
        "AND" | "OR" | "XOR" => given.contains(&Held::Class) && !given.contains(&Held::Bit),
        _ => given.iter().all(|it| *it == Held::Class),
    };
    if is_class { Held::Class } else { Held::Plain }
}
