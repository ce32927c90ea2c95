//! Notes what the source uses that systems may compute otherwise: before constants are folded, which leaves no trace.

use super::checker::Checker;
use super::operand::Operand;
use crate::Span;
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

    /// A number without a type that is an operand; an integer, beside one of fewer bits than 32, or another literal.
    pub(super) fn note_literals(&mut self, sides: [&Operand; 2], span: Span) {
        let is_wide = |it: &Operand| matches!(it.ty(), Some(Type::Elementary(ty)) if !is_narrow(ty));
        for (literal, other) in [(sides[0], sides[1]), (sides[1], sides[0])] {
            let counts = !matches!(literal, Operand::Integer(_)) || !is_wide(other);
            if let (None, Some(class), true) = (literal.typed(), class_of(literal), counts) {
                self.note_use(Use::Literal(class), span);
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
