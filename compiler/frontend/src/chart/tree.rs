//! Pieces of trees that charts are written out with. What nobody wrote has an empty place: coverage does not count it.

use super::Action;
use crate::Span;
use crate::added::{ACTIONS, FIRED};
use crate::ast::{
    Argument, ArgumentKind, BinaryOp, Bound, Expr, ExprKind, Initial, InitialKind, LiteralValue, Name, Statement,
    StatementKind, Transition, TypeKind, TypeSpec, UnaryOp, VarDecl,
};
pub(super) use crate::testing::tree::named;
use crate::testing::tree::{literal, number};

/// Where something is, of which nothing is written there.
fn unwritten(span: Span) -> Span {
    Span { end: span.start, ..span }
}

pub(super) fn name(name: Name<'_>) -> Expr<'_> {
    Expr { kind: ExprKind::Name(name), span: name.span }
}

pub(super) fn member<'s>(of: Expr<'s>, text: &'static str) -> Expr<'s> {
    let span = unwritten(of.span);
    Expr { kind: ExprKind::Member(Box::new(of), Name { text, span }), span }
}

pub(super) fn truth<'s>(value: bool, span: Span) -> Expr<'s> {
    literal(LiteralValue::Bool(value), span)
}

/// What is missing, as has been reported.
pub(super) fn missing<'s>(span: Span) -> Expr<'s> {
    Expr { kind: ExprKind::Error(Vec::new()), span }
}

fn element<'s>(of: &'static str, at: usize, span: Span) -> Expr<'s> {
    let span = unwritten(span);
    Expr { kind: ExprKind::Index(Box::new(named(of, span)), vec![number(at, span)]), span }
}

/// Whether a transition fires.
pub(super) fn fires<'s>(at: usize, span: Span) -> Expr<'s> {
    element(FIRED, at, span)
}

/// What controls an action.
pub(super) fn controls<'s>(action: Action<'_>, span: Span) -> Expr<'s> {
    element(ACTIONS, action.number, span)
}

/// A variable of what controls an action.
pub(super) fn control<'s>(action: Action<'_>, variable: &'static str, span: Span) -> Expr<'s> {
    member(controls(action, span), variable)
}

pub(super) fn not(of: Expr<'_>) -> Expr<'_> {
    let span = unwritten(of.span);
    Expr { kind: ExprKind::Unary(UnaryOp::Not, Box::new(of)), span }
}

pub(super) fn binary<'s>(left: Expr<'s>, operator: BinaryOp, right: Expr<'s>) -> Expr<'s> {
    let span = unwritten(left.span);
    Expr { kind: ExprKind::Binary(Box::new([left, right]), operator, span), span }
}

/// Some expressions with an operator between them, or nothing.
pub(super) fn joined<'s>(parts: impl IntoIterator<Item = Expr<'s>>, operator: BinaryOp) -> Option<Expr<'s>> {
    parts.into_iter().reduce(|left, right| binary(left, operator, right))
}

pub(super) fn input<'s>(name: &'static str, value: Expr<'s>) -> Argument<'s> {
    let span = value.span;
    Argument { kind: ArgumentKind::Input(Name { text: name, span }, value), span }
}

pub(super) fn call<'s>(callee: Expr<'s>, arguments: Vec<Argument<'s>>) -> Statement<'s> {
    let span = unwritten(callee.span);
    let call = Expr { kind: ExprKind::Call(Box::new(callee), arguments), span };
    Statement { kind: StatementKind::Expr(call), span }
}

/// What a METHOD says.
pub(super) fn asked(method: Expr<'_>) -> Expr<'_> {
    let span = unwritten(method.span);
    Expr { kind: ExprKind::Call(Box::new(method), Vec::new()), span }
}

pub(super) fn assign<'s>(target: Expr<'s>, value: Expr<'s>) -> Statement<'s> {
    let span = unwritten(target.span);
    Statement { kind: StatementKind::Assign { target, value }, span }
}

pub(super) fn when<'s>(condition: Expr<'s>, body: Vec<Statement<'s>>) -> Statement<'s> {
    either(vec![(condition, body)], None)
}

/// The test of a transition, which is written: coverage counts it.
pub(super) fn test<'s>(transition: &Transition<'s>, fire: Vec<Statement<'s>>) -> Statement<'s> {
    Statement { span: transition.span, ..when(transition.condition.clone(), fire) }
}

pub(super) fn either<'s>(
    branches: Vec<(Expr<'s>, Vec<Statement<'s>>)>,
    otherwise: Option<Vec<Statement<'s>>>,
) -> Statement<'s> {
    let span = unwritten(branches.first().map_or(Span::default(), |it| it.0.span));
    Statement { kind: StatementKind::If { branches, otherwise }, span }
}

fn of_type<'s>(text: &'static str, span: Span) -> TypeSpec<'s> {
    TypeSpec { kind: TypeKind::Named(vec![Name { text, span }]), span }
}

pub(super) fn variable<'s>(name: Name<'s>, ty: &'static str) -> VarDecl<'s> {
    VarDecl::new(vec![name], of_type(ty, name.span), name.span)
}

pub(super) fn array<'s>(text: &'static str, length: usize, ty: &'static str, span: Span) -> VarDecl<'s> {
    let bounds = vec![Bound::Range(number(0, span), number(length - 1, span))];
    let ty = TypeSpec { kind: TypeKind::Array { bounds, element: Box::new(of_type(ty, span)) }, span };
    VarDecl::new(vec![Name { text, span }], ty, span)
}

/// `(X := TRUE)`
pub(super) fn initially<'s>(member: &'static str, span: Span) -> Initial<'s> {
    let value = Initial { kind: InitialKind::Value(truth(true, span)), span };
    Initial { kind: InitialKind::Fields(vec![(Name { text: member, span }, value)]), span }
}
