//! EDGEPOS, EDGENEG and EDGE: Automation Studio gives each call in the text a bit that keeps what it was called with. Here the bits
//! of a PROGRAM or FUNCTION_BLOCK are an array, and the call passes its own to a function of the library.

use crate::Span;
use crate::added::EDGES as BITS;
use crate::ast::{
    Argument, ArgumentKind, Bound, Expr, ExprKind, Name, Pou, PouKind, Statement, StatementKind, TypeKind, TypeSpec,
    VarBlock, VarDecl, VarKind,
};
use crate::testing::tree;

/// Writes the calls out in the bodies that share the state of a unit.
pub(super) fn expand(pou: &mut Pou<'_>) {
    if !matches!(pou.kind, PouKind::Program | PouKind::FunctionBlock) {
        return;
    }
    let mut count = 0;
    let mut write = |it: &mut Expr<'_>| written_out(it, &mut count);
    each_expr(&mut pou.body, &mut write);
    pou.routines.iter_mut().for_each(|it| each_expr(&mut it.body, &mut write));
    if count > 0 {
        pou.blocks.push(bits(count, pou.name.span));
    }
}

/// `EDGEPOS(x)` becomes `__EDGEPOS(x, __edges[0])`.
fn written_out(expr: &mut Expr<'_>, count: &mut usize) {
    let span = expr.span;
    let ExprKind::Call(callee, arguments) = &mut expr.kind else { return };
    let ExprKind::Name(name) = &mut callee.kind else { return };
    let Some((_, function)) = super::EDGES.iter().find(|it| it.0.eq_ignore_ascii_case(name.text)) else { return };
    if !matches!(arguments.as_slice(), [Argument { kind: ArgumentKind::Positional(_), .. }]) {
        return;
    }
    name.text = function;
    let index = vec![tree::number(*count, span)];
    let bit = Expr { kind: ExprKind::Index(Box::new(tree::named(BITS, span)), index), span };
    arguments.push(Argument { kind: ArgumentKind::Positional(bit), span });
    *count += 1;
}

/// `__edges : ARRAY[0..n] OF BOOL`
fn bits<'s>(count: usize, at: Span) -> VarBlock<'s> {
    let element = TypeSpec { kind: TypeKind::Named(vec![Name { text: "BOOL", span: at }]), span: at };
    let bounds = vec![Bound::Range(tree::number(0, at), tree::number(count - 1, at))];
    let ty = TypeSpec { kind: TypeKind::Array { bounds, element: Box::new(element) }, span: at };
    let decl = VarDecl::new(vec![Name { text: BITS, span: at }], ty, at);
    VarBlock { vars: vec![decl], ..VarBlock::new(VarKind::Var, at) }
}

/// Calls `write` with every expression in the statements, inner ones first.
pub(super) fn each_expr<'s>(statements: &mut [Statement<'s>], write: &mut dyn FnMut(&mut Expr<'s>)) {
    for statement in statements {
        match &mut statement.kind {
            StatementKind::Empty
            | StatementKind::Label(_)
            | StatementKind::Jump(_)
            | StatementKind::Exit
            | StatementKind::Continue
            | StatementKind::Return
            | StatementKind::Error => {}
            StatementKind::ReturnIf(it) | StatementKind::Expr(it) => each_part(it, write),
            StatementKind::Assign { target, value }
            | StatementKind::SetReset { target, value, .. }
            | StatementKind::Bind { target, value }
            | StatementKind::Attempt { target, value } => {
                [target, value].into_iter().for_each(|it| each_part(it, write));
            }
            StatementKind::AssignAll { targets, value } => {
                targets.iter_mut().chain([value]).for_each(|it| each_part(it, write));
            }
            StatementKind::SetResetAll { targets, value } => {
                targets.iter_mut().map(|it| &mut it.0).chain([value]).for_each(|it| each_part(it, write));
            }
            StatementKind::If { branches, otherwise } => {
                for (condition, body) in branches {
                    each_part(condition, write);
                    each_expr(body, write);
                }
                otherwise.iter_mut().for_each(|it| each_expr(it, write));
            }
            StatementKind::Case { selector, arms, otherwise } => {
                each_part(selector, write);
                arms.iter_mut().for_each(|it| each_expr(&mut it.body, write));
                otherwise.iter_mut().for_each(|it| each_expr(it, write));
            }
            StatementKind::For { counter, from, to, by, body } => {
                [counter, from, to].into_iter().chain(by).for_each(|it| each_part(it, write));
                each_expr(body, write);
            }
            StatementKind::While { condition: it, body } | StatementKind::Repeat { body, until: it } => {
                each_part(it, write);
                each_expr(body, write);
            }
            StatementKind::Try(it) => {
                each_expr(&mut it.body, write);
                each_expr(&mut it.handler, write);
                it.finally.iter_mut().for_each(|it| each_expr(&mut it.body, write));
            }
        }
    }
}

fn each_part<'s>(expr: &mut Expr<'s>, write: &mut dyn FnMut(&mut Expr<'s>)) {
    match &mut expr.kind {
        ExprKind::Literal(_) | ExprKind::Name(_) | ExprKind::Address(_) => {}
        ExprKind::Member(inner, _)
        | ExprKind::Part(inner, _)
        | ExprKind::Deref(inner)
        | ExprKind::Unary(_, inner)
        | ExprKind::Paren(inner) => each_part(inner, write),
        ExprKind::Index(base, indices) => {
            each_part(base, write);
            indices.iter_mut().for_each(|it| each_part(it, write));
        }
        ExprKind::Call(callee, arguments) => {
            each_part(callee, write);
            for argument in arguments {
                match &mut argument.kind {
                    ArgumentKind::Positional(value) | ArgumentKind::Input(_, value) => each_part(value, write),
                    ArgumentKind::Output { target, .. } => target.iter_mut().for_each(|it| each_part(it, write)),
                }
            }
        }
        ExprKind::Binary(sides, ..) | ExprKind::Assign(sides, _) => {
            sides.iter_mut().for_each(|it| each_part(it, write))
        }
        ExprKind::Error(parts) => parts.iter_mut().for_each(|it| each_part(it, write)),
    }
    write(expr);
}
