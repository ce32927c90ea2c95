//! Which expressions and places can fault. Nobody else decides that: who knows more of indices, or of the code
//! that an operation becomes, says so in [`Faults`].

use crate::{ArrayId, Expr, ExprKind, Op, Place, Program, Projection, Root, Type};
use staunch_runtime::Repr;

/// What is known where an expression is.
#[expect(missing_debug_implementations, reason = "it holds functions, and lives for one question")]
#[derive(Clone, Copy)]
pub struct Faults<'a> {
    pub program: &'a Program,
    /// What a place's root is; without it, `is_within` is not told which array an index is of.
    pub root_type: &'a dyn Fn(Root) -> Option<Type>,
    /// Whether an index is known to lie within the array's bounds.
    pub is_within: &'a dyn Fn(&Expr, Option<ArrayId>) -> bool,
    /// Whether an operation on these operands can.
    pub operation: &'a dyn Fn(&Program, Op, &[Expr]) -> bool,
}

/// Whether evaluating `expr` can fault. An index that is a constant has been checked.
pub fn expr_faults(program: &Program, expr: &Expr) -> bool {
    plain(program).expr(expr)
}

/// The division of reals is IEEE's, and never faults.
pub fn op_faults(program: &Program, op: Op, operands: &[Expr]) -> bool {
    let real = operands.first().and_then(|it| program.repr(it.ty)).is_some_and(Repr::is_float);
    op.can_fault() && !(real && matches!(op, Op::Div))
}

/// Whether code for the operation has a way to a fault: a division by a constant has none.
pub fn code_faults(program: &Program, op: Op, operands: &[Expr]) -> bool {
    let is_real = || operands.first().and_then(|it| program.repr(it.ty)).is_some_and(Repr::is_float);
    let divisor = || operands.get(1).and_then(Expr::as_const);
    let is_safe = || is_real() || divisor().is_some_and(|it| it.as_integer() != Some(0));
    op.can_fault() && !(matches!(op, Op::Div | Op::Mod) && is_safe())
}

/// Whether a projection can fault. An index that is a constant has been checked.
pub fn projection_faults(program: &Program, projection: &Projection) -> bool {
    plain(program).projection(projection, None)
}

fn plain(program: &Program) -> Faults<'_> {
    Faults { program, root_type: &|_| None, is_within: &|index, _| index.as_const().is_some(), operation: &op_faults }
}

impl Faults<'_> {
    /// Whether evaluating `expr` can fault.
    pub fn expr(&self, expr: &Expr) -> bool {
        match &expr.kind {
            ExprKind::Const(_) | ExprKind::Text(_) | ExprKind::Aggregate(_) => false,
            ExprKind::Load(place) => self.place(place),
            ExprKind::AddressOf(place) => self.place(place),
            ExprKind::Apply(op, operands) => {
                (self.operation)(self.program, *op, operands) || operands.iter().any(|it| self.expr(it))
            }
            ExprKind::ApplyText(_, operands) => operands.iter().any(|it| self.expr(it)),
            ExprKind::Convert(_, value) => self.expr(value),
        }
    }

    /// Whether finding `place` can fault.
    pub fn place(&self, place: &Place) -> bool {
        let mut ty = (self.root_type)(place.root);
        place.projections.iter().any(|projection| {
            let whole = ty;
            ty = match projection {
                Projection::Field(field) => whole.and_then(|it| self.program.member(it, *field)),
                Projection::Index { .. } => array(whole).map(|id| self.program.array(id).element),
                Projection::Deref { target, .. } => Some(*target),
            };
            self.projection(projection, array(whole))
        })
    }

    /// Whether finding a part of an array, or of another type, can.
    fn projection(&self, projection: &Projection, array: Option<ArrayId>) -> bool {
        match projection {
            Projection::Field(_) => false,
            Projection::Deref { .. } => true,
            Projection::Index { index, .. } => !(self.is_within)(index, array) || self.expr(index),
        }
    }
}

fn array(ty: Option<Type>) -> Option<ArrayId> {
    match ty? {
        Type::Array(id) => Some(id),
        Type::Elementary(_)
        | Type::Reference(_)
        | Type::Subrange(..)
        | Type::String(_)
        | Type::Enum(_)
        | Type::Struct(_)
        | Type::Block(_) => None,
    }
}
