//! What C++ makes of an expression in OpenPLC from v4.1 on: STruC++ keeps variables in a class of its own, and its library computes
//! otherwise with what is a plain `bool`, `int` or `char *`.

use super::checker::Checker;
use super::conversion::truncated_by;
use crate::ast::{self, ArgumentKind, BinaryOp, ExprKind, LiteralValue, UnaryOp};
use crate::dialect::rules::Functions;
use crate::types::coercion::widens;
use crate::{Code, Diagnostic, Span};
use staunch_ir::{Conversion, Elementary, Expr, Type};

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

    /// Whether a value is stored as one of another type, by C++'s conversion. Where it may be another value then, a lint says so.
    pub(super) fn becomes_as_cpp(&mut self, from: Elementary, to: Elementary, span: Span) -> bool {
        let is_number = |it: Elementary| it.is_real() || it.is_integer() || it.is_bits();
        if !self.decl.dialect(span).converts_as_cpp() || !is_number(from) || !is_number(to) || widens(from, to) {
            return false;
        }
        let name = format!("{} becomes {}", from.name(), to.name());
        match (from.repr().range(), to.repr().range()) {
            _ if to == Elementary::Bool => {
                self.report_implicit(Code::W0513, format!("{name}: TRUE where it is not 0"), from, to, span);
            }
            (None, Some(_)) => self.report(
                Diagnostic::new(Code::W0511, span, format!("{name}: its fraction is cut"))
                    .label("implicit conversion")
                    .help(format!("write `TRUNC(…)`, or round it with `{}_TO_{}(…)`", from.name(), to.name())),
            ),
            (_, None) => _ = self.loses_precision(from, to, span),
            (Some(own), Some(into)) if own.0 >= into.0 && own.1 <= into.1 => {}
            (Some(_), Some(_)) if from.repr().size() > to.repr().size() => self.report_cut(from, to, span),
            (Some(_), Some(_)) => self.report_sign(from, to, span),
        }
        true
    }

    /// A number as C++ stores it: a real is cut, and beyond the type x86-64 decides.
    pub(super) fn as_cpp(&mut self, value: Expr, to: Elementary, span: Span) -> Option<Expr> {
        let target = Type::Elementary(to);
        self.note_conversion(value.ty, target, span);
        let is_cut = value.ty.elementary().is_some_and(Elementary::is_real) && !to.is_real() && to != Elementary::Bool;
        let value = match is_cut {
            true => self.apply(truncated_by(to), value.ty, vec![value], Type::LINT, span)?,
            false => value,
        };
        Some(self.convert(Conversion::Value, target, value))
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
