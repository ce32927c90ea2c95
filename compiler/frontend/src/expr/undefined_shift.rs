//! Shifts that C leaves undefined, in the dialect of a system that compiles to C.

use super::checker::Checker;
use crate::dialect::rules::Functions;
use crate::{Code, Diagnostic, Span};
use staunch_ir::{Expr, Op, Type, Value};

impl Checker<'_, '_> {
    /// Reports a constant count that is negative, or not below the bits in which C shifts: 32 for what has fewer (C11, 6.5.7).
    pub(super) fn undefined_shift(&mut self, op: Op, ty: Type, count: &Expr, span: Span) {
        let shifts =
            matches!(op, Op::Shl | Op::Shr) && self.decl.dialect(span).rules().functions.choice == Functions::OfMatiec;
        let Some(number) = count.as_const().and_then(Value::as_integer).filter(|_| shifts) else { return };
        let Some(size) = self.decl.program.repr(ty).map(|it| it.size()) else { return };
        let bits = if size > 4 { 64 } else { 32 };
        if (0..bits).contains(&number) {
            return;
        }
        let name = self.type_name(ty);
        self.report(
            Diagnostic::new(Code::W0521, span, format!("a shift of {name} by {number} is undefined in OpenPLC"))
                .label(format!("its C shifts in {bits} bits, and only by 0 to {}", bits - 1))
                .help("shift by fewer bits, or write the result"),
        );
    }
}
