//! Notes what the source uses that systems may compute otherwise: before constants are folded, which leaves no trace.

use super::checker::Checker;
use super::operand::Operand;
use super::operator::{Sides, compares};
use crate::Span;
use crate::ast::{self, BinaryOp};
use crate::types::coercion::is_narrow;
use staunch_ir::{Elementary, Expr, ExprKind, Op, Type, Use};
use staunch_runtime::Class;

impl Checker<'_, '_> {
    pub(super) fn note_use(&mut self, found: Use, span: Span) {
        let at = self.at(span);
        self.decl.program.uses.note(found, at);
    }

    pub(super) fn note_operator(&mut self, text: &'static str, operands: &[&Operand], span: Span) {
        for class in operands.iter().filter_map(|it| class_of(it)) {
            self.note_use(Use::Operator(text, class), span);
        }
    }

    /// A number without a type that is an operand; an integer, beside one of fewer bits than 32, or another literal. It makes
    /// no difference where a wider type would give the same: to what is compared with it, and to a sum, difference or product
    /// that is stored in the type of the other operand.
    pub(super) fn note_literals(&mut self, sides: &Sides) {
        let Sides { a, b, op, op_span, hint, .. } = sides;
        let is_wide = |it: &Operand| matches!(it.ty(), Some(Type::Elementary(ty)) if !is_narrow(ty));
        let is_same = |it: &Operand| {
            compares(*op) || it.ty().is_some_and(|ty| Some(ty) == hint.map(Type::read)) && self.stored.contains(op_span)
        };
        let counts =
            |it: &Operand, other: &Operand| !matches!(it, Operand::Integer(_)) || !is_wide(other) && !is_same(other);
        let found = [(a, b), (b, a)]
            .map(|(literal, other)| class_of(literal).filter(|_| literal.typed().is_none() && counts(literal, other)));
        found.into_iter().flatten().for_each(|it| self.note_use(Use::Literal(it), *op_span));
    }

    /// Notes which operators of an assignment make no more than what is stored, by their low bits.
    pub(crate) fn note_stored(&mut self, value: &ast::Expr<'_>) {
        self.stored.clear();
        let mut open = vec![value.bare()];
        while let Some(expr) = open.pop() {
            if let ast::ExprKind::Binary(sides, BinaryOp::Add | BinaryOp::Sub | BinaryOp::Mul, span) = &expr.kind {
                self.stored.push(*span);
                open.extend(sides.iter().map(ast::Expr::bare));
            }
        }
    }

    /// From one class of types to another; within one, to another type.
    pub(super) fn note_conversion(&mut self, from: Type, to: Type, span: Span) {
        if let (Some(own), Some(class)) = (class(from), class(to))
            && from != to
        {
            self.note_use(Use::Conversion(own, class), span);
        }
    }

    /// The elementary types that an operation computes with: what is only assigned or compared cannot leave its type's range.
    pub(super) fn note_types(&mut self, made: &Expr) {
        let elementary = |it: &Expr| it.ty.elementary();
        let types: Vec<Elementary> = match &made.kind {
            ExprKind::Apply(op, operands) if !chooses(*op) => {
                operands.iter().chain([made]).filter_map(elementary).collect()
            }
            ExprKind::ApplyText(_, operands) => operands.iter().filter_map(elementary).collect(),
            ExprKind::Convert(_, inner) if elementary(inner) != elementary(made) => {
                [&**inner, made].into_iter().filter_map(elementary).collect()
            }
            ExprKind::Apply(..)
            | ExprKind::Convert(..)
            | ExprKind::Const(_)
            | ExprKind::Text(_)
            | ExprKind::Aggregate(_)
            | ExprKind::AddressOf(_)
            | ExprKind::Load(_) => return,
        };
        types.into_iter().for_each(|it| self.decl.program.uses.note(Use::Type(it), made.at));
    }
}

fn class_of(operand: &Operand) -> Option<Class> {
    match operand {
        Operand::Integer(_) => Some(Class::Int),
        Operand::Real { .. } => Some(Class::Real),
        Operand::Typed(_) | Operand::Promoted(..) => class(operand.ty()?),
    }
}

/// The narrowest class of a type, if that has values of its own.
fn class(ty: Type) -> Option<Class> {
    match ty {
        Type::Elementary(it) | Type::Subrange(it, _) => Some(it.class()),
        Type::String(_) => Some(Class::String),
        Type::Enum(_) | Type::Array(_) | Type::Struct(_) | Type::Block(_) | Type::Reference(_) => None,
    }
}

const fn chooses(op: Op) -> bool {
    matches!(op, Op::Lt | Op::Le | Op::Gt | Op::Ge | Op::Eq | Op::Ne | Op::Min | Op::Max)
}
