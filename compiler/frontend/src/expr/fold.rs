//! Operations and conversions, as their values where all operands are constant.

use super::checker::{Checker, Context};
use crate::{Code, Diagnostic, Span};
use staunch_ir::{Const, Conversion, Expr, ExprKind, Op, Repr, Type, Value};

impl Checker<'_, '_> {
    /// An operation node at the repr of `operands`, folded where all operands are constant.
    pub(crate) fn apply(
        &mut self,
        op: Op,
        operands: Type,
        values: Vec<Expr>,
        result: Type,
        span: Span,
    ) -> Option<Expr> {
        if let (Type::Enum(id), false) = (operands, op.result().is_some()) {
            return self.apply_to_enums(op, id, values, result, span);
        }
        let at = self.at(span);
        let repr = self.decl.program.repr(operands)?;
        if !op.allows(repr) {
            return None;
        }
        if values.iter().any(|it| it.as_const().is_none()) {
            self.constant_zero_divisor(op, &values, span);
        }
        self.evaluated(Expr::apply(op, result, values, at), span)
    }

    /// An operation on constants as its value: what it gives at run time.
    pub(crate) fn evaluated(&mut self, expr: Expr, span: Span) -> Option<Expr> {
        self.note_types(&expr);
        match staunch_ir::fold(&expr) {
            Some(Ok(value)) => Some(constant(expr, value)),
            Some(Err(_)) if self.may_not_run => Some(expr),
            Some(Err(fault)) => {
                let label = match self.context {
                    Context::Initial => "this would fault as the program starts",
                    Context::Body | Context::Constant => "this would fault in every scan",
                };
                let error = Diagnostic::new(Code::E0207, span, format!("{} in a constant expression", fault.kind));
                self.report(error.label(label));
                None
            }
            None => Some(expr),
        }
    }

    /// SEL, MAX and the like take enumerations as numbers of their base type.
    fn apply_to_enums(
        &mut self,
        op: Op,
        id: staunch_ir::EnumId,
        values: Vec<Expr>,
        result: Type,
        span: Span,
    ) -> Option<Expr> {
        let base = Type::Elementary(self.decl.program.enumeration(id).base);
        let number = |this: &mut Self, value: Expr| match value.ty {
            Type::Enum(_) => this.convert(Conversion::Same, base, value),
            _ => value,
        };
        let values = values.into_iter().map(|it| number(self, it)).collect();
        let value = self.apply(op, base, values, base, span)?;
        Some(self.convert(Conversion::Same, result, value))
    }

    /// `x / 0` faults whatever `x` is.
    fn constant_zero_divisor(&mut self, op: Op, values: &[Expr], span: Span) {
        let divides = matches!(op, Op::Div | Op::Mod);
        let zero = values.get(1).and_then(Expr::as_const).and_then(Value::as_integer) == Some(0);
        if divides && zero && !self.may_not_run {
            self.report(Diagnostic::new(Code::E0207, span, "division by zero").label("the divisor is the constant 0"));
        }
    }

    /// A conversion node, folded where the value is constant.
    pub(crate) fn convert(&mut self, how: Conversion, ty: Type, value: Expr) -> Expr {
        let at = value.at;
        if value.ty == ty {
            return value;
        }
        let how = match how {
            Conversion::Value if self.same_repr(value.ty, ty) => Conversion::Same,
            other => other,
        };
        let expr = Expr::convert(how, ty, value, at);
        self.note_types(&expr);
        match staunch_ir::fold(&expr) {
            Some(Ok(value)) => constant(expr, value),
            Some(Err(_)) | None => expr,
        }
    }

    fn same_repr(&self, a: Type, b: Type) -> bool {
        let (a, b): (Option<Repr>, Option<Repr>) = (self.decl.program.repr(a), self.decl.program.repr(b));
        a.is_some() && a == b
    }
}

/// The expression with its value in its place.
pub(crate) fn constant(expr: Expr, value: Const) -> Expr {
    let kind = match value {
        Const::Scalar(value) => ExprKind::Const(value),
        Const::Text(bytes) => ExprKind::Text(bytes),
        aggregate @ (Const::Zero | Const::Array(_) | Const::Struct(_)) => ExprKind::Aggregate(aggregate),
    };
    Expr { kind, ..expr }
}
