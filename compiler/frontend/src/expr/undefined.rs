//! What C leaves undefined, in the dialects of systems that compile to C or C++: shifts past the width, and numbers beyond
//! a type.

use super::checker::Checker;
use crate::dialect::rules::Functions;
use crate::{Code, Diagnostic, Span};
use staunch_ir::{Conversion, Elementary, Expr, ExprKind, For, Op, Part, Type, Use, Value, loops};
use staunch_runtime::Class;

impl Checker<'_, '_> {
    /// What a number may be, by the types, subranges, loops and constants in it.
    pub(crate) fn known_range(&self, number: &Expr) -> (i128, i128) {
        let program = &self.decl.program;
        let loops: Vec<&For> = self.counters.iter().map(|it| &it.head).filter(|it| it.is_private).collect();
        let known = loops::Known { program, loops: &loops, checked: &|_| false, seen: &[] };
        let declared = match &number.kind {
            ExprKind::Convert(Conversion::Value | Conversion::Same, inner) if program.repr(inner.ty).is_some() => {
                return self.known_range(inner);
            }
            ExprKind::Apply(Op::Limit | Op::LimitLow | Op::LimitFirst, operands) => {
                let end = |at: usize| operands.get(at).and_then(Expr::as_const).and_then(Value::as_integer);
                end(0).zip(end(2)).filter(|it| it.0 <= it.1)
            }
            _ => program.range(number.ty),
        };
        let declared = declared.or_else(|| known.range(number));
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

    /// Notes where C leaves signed numbers beyond 32 or 64 bits undefined, and where that shows whatever the compiler's
    /// options are: the least one divided by -1, and a sum, difference or product that is compared, chosen or divided at once.
    pub(super) fn note_undefined(&mut self, made: &Expr) {
        let ExprKind::Apply(op, operands) = &made.kind else { return };
        if self.may_overflow(made) {
            self.decl.program.uses.note(Use::Part(Part::StoredOverflow), made.at);
        }
        let is_undefined = match op {
            Op::Div | Op::Mod | Op::DivOrZero | Op::ModOrZero => {
                self.is_least_by_negative(operands) || operands.iter().any(|it| self.may_overflow(it))
            }
            Op::Lt | Op::Le | Op::Gt | Op::Ge | Op::Eq | Op::Ne | Op::Max | Op::Min | Op::Abs => {
                operands.iter().any(|it| self.may_overflow(it))
            }
            Op::Limit | Op::LimitLow | Op::LimitFirst => operands.iter().any(|it| self.may_overflow(it)),
            _ => false,
        };
        if is_undefined {
            self.decl.program.uses.note(Use::Part(Part::Overflow), made.at);
        }
    }

    /// So too where a CASE selects by it.
    pub(crate) fn note_selected(&mut self, selector: &Expr) {
        if self.may_overflow(selector) {
            self.decl.program.uses.note(Use::Part(Part::Overflow), selector.at);
        }
    }

    fn is_least_by_negative(&self, operands: &[Expr]) -> bool {
        let [a, b] = operands else { return false };
        let [(least, _), (low, high)] = [a, b].map(|it| self.known_range(it));
        let whole = a.ty.elementary().and_then(|it| it.repr().range());
        is_wide(a) && whole.is_some_and(|it| it.0 == least) && (low..=high).contains(&-1)
    }

    fn may_overflow(&self, side: &Expr) -> bool {
        let whole = side.ty.elementary().and_then(|it| it.repr().range());
        match &side.kind {
            ExprKind::Convert(Conversion::Value | Conversion::Same, inner) => self.may_overflow(inner),
            ExprKind::Apply(Op::Neg | Op::Abs, operands) => {
                let least = operands.first().map(|it| self.known_range(it).0);
                is_wide(side) && least == whole.map(|it| it.0)
            }
            ExprKind::Apply(op @ (Op::Add | Op::Sub | Op::Mul), operands) => {
                let [a, b] = operands.as_slice() else { return false };
                let exact = exact(*op, self.known_range(a), self.known_range(b));
                is_wide(side) && whole.is_none_or(|it| exact.0 < it.0 || it.1 < exact.1)
            }
            _ => false,
        }
    }
}

/// What an operation gives that has room enough.
fn exact(op: Op, a: (i128, i128), b: (i128, i128)) -> (i128, i128) {
    let ends = |combine: fn(i128, i128) -> i128| {
        let all = [combine(a.0, b.0), combine(a.0, b.1), combine(a.1, b.0), combine(a.1, b.1)];
        (all.into_iter().min().unwrap_or(i128::MIN), all.into_iter().max().unwrap_or(i128::MAX))
    };
    match op {
        Op::Add => ends(i128::saturating_add),
        Op::Sub => ends(i128::saturating_sub),
        _ => ends(i128::saturating_mul),
    }
}

/// What C computes at its own width, and does not promote.
fn is_wide(number: &Expr) -> bool {
    let is_wide = |it: Elementary| it.is(Class::Signed) && it.repr().size() >= 4;
    number.ty.elementary().is_some_and(is_wide)
}
