//! What is compared with what: the numbers and texts that a variable is worth trying with.

use super::numbers::Number;
use super::walk::{Walk, number};
use staunch_ir::{Expr, ExprKind, visit};

impl Walk<'_, '_> {
    /// A text as it is compared with another.
    pub(super) fn texts(&mut self, a: &Expr, b: &Expr, is_exact: bool) {
        match (self.variable(a), &b.kind) {
            (Some(name), ExprKind::Text(text)) => {
                self.facts.near_to_text(name, text);
                if is_exact { self.operand(a) } else { self.expr(a) }
            }
            (name, other) => {
                self.facts.flows.extend(name.zip(self.variable(b)));
                self.expr(a);
                if let ExprKind::Text(text) = other {
                    self.reaches(a, text);
                }
            }
        }
    }

    /// `a` as it is compared with `b`.
    pub(super) fn comparison(&mut self, a: &Expr, b: &Expr) {
        match number(b) {
            Some(limit) => {
                self.compared(a, limit);
                self.operand(a);
            }
            None => {
                if let (Some(x), Some(y)) = (self.variable(a), self.variable(b)) {
                    self.facts.flows.insert((x, y));
                }
                self.expr(a);
            }
        }
    }

    /// An operand of which only a comparison with a constant is seen.
    pub(super) fn operand(&mut self, expr: &Expr) {
        match self.variable(expr) {
            Some(name) => {
                self.note_read(name);
                visit::reads(expr, &mut |it| self.indices(it));
            }
            None => self.expr(expr),
        }
    }

    /// Notes for which values of its variables an expression comes near a limit.
    pub(super) fn compared(&mut self, expr: &Expr, limit: Number) {
        match &expr.kind {
            ExprKind::Load(place) => {
                if let (Some(name), Some(value)) = (self.name(place), limit.value()) {
                    self.facts.near_to(name, value);
                }
            }
            ExprKind::Convert(_, inner) => self.compared(inner, limit.of_type(self.program, inner.ty)),
            ExprKind::Apply(op, operands) => {
                for (at, operand) in operands.iter().enumerate() {
                    let other = operands.get(1 - at.min(1)).and_then(number);
                    for limit in limit.before(*op, at, other) {
                        self.compared(operand, limit);
                    }
                }
            }
            ExprKind::ApplyText(op, operands) => self.is_character(*op, operands, limit),
            ExprKind::Const(_) | ExprKind::Text(_) | ExprKind::Aggregate(_) | ExprKind::AddressOf(_) => {}
        }
    }
}
