//! Notes what the source uses that systems may compute otherwise: before constants are folded, which leaves no trace.

use super::checker::Checker;
use super::operand::Operand;
use super::real::Real;
use crate::Span;
use staunch_ir::{Elementary, Expr, ExprKind, Op, Part, Type, Use, Value};
use staunch_runtime::Class;

impl Checker<'_, '_> {
    pub(crate) fn note_use(&mut self, found: Use, span: Span) {
        let at = self.at(span);
        self.decl.program.uses.note(found, at);
    }

    pub(super) fn note_operator(&mut self, text: &'static str, operands: &[&Operand], span: Span) {
        for class in operands.iter().filter_map(|it| class_of(it)) {
            self.note_use(Use::Operator(text, class), span);
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
        self.note_undefined(made);
        let elementary = |it: &Expr| it.ty.elementary();
        let types: Vec<Elementary> = match &made.kind {
            ExprKind::Apply(op, operands) if compares(*op) => return self.note_compared_times(operands, made),
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

/// What all durations that a double holds are multiples of, in nanoseconds: 1/512 s.
const BINARY_FRACTION: i128 = 1_953_125;

impl Checker<'_, '_> {
    /// Durations that are compared with a literal that a binary fraction of a second does not hold, or with each other.
    fn note_compared_times(&mut self, operands: &[Expr], made: &Expr) {
        if !operands.iter().any(|it| it.ty.elementary().is_some_and(Elementary::is_duration)) {
            return;
        }
        let is_exact =
            |it: &Expr| it.as_const().and_then(Value::as_integer).is_some_and(|it| it % BINARY_FRACTION == 0);
        if !operands.iter().any(is_exact) {
            self.decl.program.uses.note(Use::Part(Part::ComparedTimes), made.at);
        }
    }

    /// A number that is another one as a REAL than as an LREAL, next to a REAL.
    pub(super) fn note_fraction(&mut self, a: &Operand, b: &Operand, span: Span) {
        let is_real = |it: &Operand| it.ty() == Some(Type::Elementary(Elementary::Real));
        if is_real(a) && is_inexact(b) || is_real(b) && is_inexact(a) {
            self.note_use(Use::Part(Part::FractionBesideReal), span);
        }
    }
}

fn is_inexact(operand: &Operand) -> bool {
    match operand {
        Operand::Real { number: Real::Literal(text) } => text.parse::<f64>().is_ok_and(|it| f64::from(it as f32) != it),
        Operand::Real { .. } => true,
        Operand::Typed(_) | Operand::Promoted(..) | Operand::Integer(_) => false,
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

const fn compares(op: Op) -> bool {
    matches!(op, Op::Lt | Op::Le | Op::Gt | Op::Ge | Op::Eq | Op::Ne)
}

const fn chooses(op: Op) -> bool {
    matches!(op, Op::Min | Op::Max)
}
