//! What C leaves undefined, in the dialects of systems that compile to C or C++: shifts past the width, and numbers beyond
//! a type.

use super::checker::Checker;
use crate::dialect::rules::Functions;
use crate::{Code, Diagnostic, Span};
use staunch_ir::{Elementary, Expr, ExprKind, Op, Part, Place, Type, Use, Value, loops, visit};
use staunch_runtime::Class;

impl Checker<'_, '_> {
    /// What a number may be, by the types and constants in it.
    pub(crate) fn known_range(&self, number: &Expr) -> (i128, i128) {
        let program = &self.decl.program;
        let known = loops::Known { program, loops: &[], checked: &|_| false };
        let declared = program.range(number.ty).or_else(|| known.range(number));
        declared.unwrap_or((i128::from(i64::MIN), i128::from(i64::MAX)))
    }

    /// Notes a count that may be negative, or not below the bits in which C shifts: 32 for what has fewer (C11, 6.5.7; C++17,
    /// 8.8). Of one that is so for certain, a lint says it.
    pub(super) fn undefined_shift(&mut self, op: Op, ty: Type, count: &Expr, span: Span) {
        let Some(size) = self.decl.program.repr(ty).map(|it| it.size()) else { return };
        let bits = if size > 4 { 64 } else { 32 };
        let (least, most) = self.known_range(count);
        if !matches!(op, Op::Shl | Op::Shr) || least >= 0 && most < bits {
            return;
        }
        self.note_use(Use::Part(Part::ShiftPastWidth), span);
        let is_c = match self.decl.dialect(span).rules().functions.choice {
            Functions::OfMatiec | Functions::OfStrucpp => true,
            Functions::OfTheStandard => false,
        };
        let Some(number) = count.as_const().and_then(Value::as_integer).filter(|_| is_c) else { return };
        let name = self.type_name(ty);
        self.report(
            Diagnostic::new(Code::W0521, span, format!("a shift of {name} by {number} is undefined in OpenPLC"))
                .label(format!("its C shifts in {bits} bits, and only by 0 to {}", bits - 1))
                .help("shift by fewer bits, or write the result"),
        );
    }

    /// Notes an operation on signed integers of 32 or 64 bits that C leaves undefined beyond the type, where that shows: a
    /// quotient by -1, and a comparison with what is computed of the same variable, as `n + 1 > n`.
    pub(super) fn note_undefined(&mut self, made: &Expr) {
        let ExprKind::Apply(op, operands) = &made.kind else { return };
        let [a, b] = operands.as_slice() else { return };
        let is_undefined = match op {
            Op::Div | Op::Mod => {
                let [(least, _), (low, high)] = [a, b].map(|it| self.known_range(it));
                let whole = a.ty.elementary().and_then(|it| it.repr().range());
                is_wide(a) && whole.is_some_and(|it| it.0 == least) && (low..=high).contains(&-1)
            }
            Op::Lt | Op::Le | Op::Gt | Op::Ge | Op::Eq | Op::Ne => {
                (self.may_overflow(a) || self.may_overflow(b)) && share_a_variable(a, b)
            }
            _ => false,
        };
        if is_undefined {
            self.decl.program.uses.note(Use::Part(Part::Overflow), made.at);
        }
    }

    fn may_overflow(&self, side: &Expr) -> bool {
        let program = &self.decl.program;
        let known = loops::Known { program, loops: &[], checked: &|_| false };
        let is_sum = matches!(&side.kind, ExprKind::Apply(Op::Add | Op::Sub | Op::Mul, _));
        is_sum && is_wide(side) && !known.is_exact(side)
    }
}

/// What C computes at its own width, and does not promote.
fn is_wide(number: &Expr) -> bool {
    let is_wide = |it: Elementary| it.is(Class::Signed) && it.repr().size() >= 4;
    number.ty.elementary().is_some_and(is_wide)
}

fn share_a_variable(a: &Expr, b: &Expr) -> bool {
    let mut of_a: Vec<Place> = Vec::new();
    visit::reads(a, &mut |place| of_a.push(place.clone()));
    let mut shares = false;
    visit::reads(b, &mut |place| shares |= of_a.iter().any(|it| it.is_same_variable(place)));
    shares
}
