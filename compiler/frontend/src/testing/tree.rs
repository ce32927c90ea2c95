//! Pieces of trees that tests are written out with.

use crate::Span;
use crate::ast::{
    Expr, ExprKind, Literal, LiteralValue, Name, Statement, StatementKind, TypeKind, TypeSpec, VarBlock, VarDecl,
    VarKind,
};

pub(crate) fn variables<'s>(wanted: &[(&'static str, &[&'static str])], at: Span) -> VarBlock<'s> {
    let variable = |(name, ty): &(&'static str, &[&'static str])| {
        let ty = TypeSpec { kind: TypeKind::Named(ty.iter().map(|text| Name { text, span: at }).collect()), span: at };
        VarDecl::new(vec![Name { text: name, span: at }], ty, at)
    };
    VarBlock { vars: wanted.iter().map(variable).collect(), ..VarBlock::new(VarKind::Var, at) }
}

pub(crate) fn named(name: &'static str, at: Span) -> Expr<'static> {
    Expr { kind: ExprKind::Name(Name { text: name, span: at }), span: at }
}

pub(crate) fn is_named(expr: &Expr<'_>, name: &str) -> bool {
    matches!(&expr.kind, ExprKind::Name(it) if it.text.eq_ignore_ascii_case(name))
}

pub(crate) fn literal<'s>(value: LiteralValue<'s>, at: Span) -> Expr<'s> {
    Expr { kind: ExprKind::Literal(Literal { prefix: None, value }), span: at }
}

pub(crate) fn statement(kind: StatementKind<'_>, span: Span) -> Statement<'_> {
    Statement { kind, span }
}

pub(crate) fn assign<'s>(name: &'static str, value: Expr<'s>) -> Statement<'s> {
    let span = value.span;
    Statement { kind: StatementKind::Assign { target: named(name, span), value }, span }
}

/// A whole number.
pub(crate) fn number<'s>(value: usize, at: Span) -> Expr<'s> {
    literal(LiteralValue::Integer { value: u64::try_from(value).unwrap_or(u64::MAX), based: false }, at)
}
