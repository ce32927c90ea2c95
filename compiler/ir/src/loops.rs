//! What is known of FOR loops and of checked indices: which counters nothing but the loop writes, and
//! what values they have. A back end may keep such a counter in a register in addition to its storage, and an
//! index whose range follows from the loop's bounds, or from a check before, needs no check.

use crate::alias::{self, Frame};
use crate::interval::{Range, of_operands};
use crate::limits::length;
use crate::visit;
use crate::{
    ArrayId, Conversion, Expr, ExprKind, For, LocalId, Mode, Op, Place, Program, Root, Routine, Statement,
    StatementKind, Step, Type, Value,
};
use staunch_runtime::Repr;

/// The condition of `IF … THEN EXIT; END_IF`.
pub fn exit_condition(statement: &Statement) -> Option<&Expr> {
    let StatementKind::If { condition, then, otherwise } = &statement.kind else { return None };
    let exits = matches!(then.as_slice(), [only] if matches!(only.kind, StatementKind::Exit));
    (exits && otherwise.is_empty()).then_some(condition)
}

/// Whether nothing but the loop itself can write its counter while it runs: others cannot name it,
/// and the body neither writes it nor hands it on. A back end knows such a counter where it is read by
/// its name, so an element of an array is none.
pub fn is_private(frame: &Frame<'_>, counter: &Place, body: &[Statement]) -> bool {
    let nobody_else = frame.is_private(counter) || frame.is_own(counter) && !calls(body);
    counter.indices().next().is_none() && nobody_else && !alias::writes(frame, body, counter)
}

/// Says of each loop whose counter is private that it is.
pub fn privatise(frame: &Frame<'_>, block: &mut [Statement]) {
    for statement in block {
        if let StatementKind::For(it) = &mut statement.kind {
            it.is_private |= is_private(frame, &it.counter, &it.body);
        }
        statement.kind.blocks_mut().into_iter().for_each(|it| privatise(frame, it));
    }
}

fn calls(body: &[Statement]) -> bool {
    let mut found = false;
    visit::statements(body, &mut |it| found |= matches!(it.kind, StatementKind::Call { .. }));
    found
}

/// The 0-based position of an index that is constant and within the bounds.
pub fn constant_position(program: &Program, index: &Expr, array: ArrayId) -> Option<u64> {
    let array = program.array(array);
    let Some(Value::I64(index)) = index.as_const() else { return None };
    (array.low..=array.high).contains(&index).then(|| index.abs_diff(array.low))
}

/// What is known where an expression is.
#[expect(missing_debug_implementations, reason = "it holds a function, and lives for one question")]
#[derive(Clone, Copy)]
pub struct Known<'a> {
    pub program: &'a Program,
    /// The FOR loops around, with private counters.
    pub loops: &'a [&'a For],
    /// Whether a local's values [are checked](checked_locals).
    pub checked: &'a dyn Fn(LocalId) -> bool,
    /// What integer variables are here, by assignments and checks before.
    pub seen: &'a [(Place, Range)],
}

/// For each local, whether it holds a value of its subrange at any time: it starts with one, and
/// nothing writes it but assignments of constants and of checked values. What a caller hands over, and
/// what is read from a state that a host may have written, is not relied on.
pub fn checked_locals(routine: &Routine) -> Vec<bool> {
    let mut checked: Vec<bool> = routine.locals.iter().map(|it| matches!(it.ty, Type::Subrange(..))).collect();
    let values = routine.params.iter().filter_map(|it| match it.mode {
        Mode::Value(id) => Some(id),
        Mode::Reference => None,
    });
    values.for_each(|id| checked[id.index()] = false);
    visit::statements(&routine.body, &mut |statement| {
        let is_checked = matches!(&statement.kind, StatementKind::Assign { value, .. } if is_check(value));
        visit::targets(statement, &mut |place| {
            if let Root::Local(id) = place.root
                && !place.is_followed()
            {
                checked[id.index()] &= is_checked;
            }
        });
    });
    checked
}

/// `verify` sees to it that such a value of a subrange is within its limits.
fn is_check(value: &Expr) -> bool {
    matches!(value.kind, ExprKind::Const(_) | ExprKind::Apply(Op::CheckIndex | Op::InRange, _))
}

impl Known<'_> {
    /// Whether an index needs no check here.
    pub fn is_within(&self, index: &Expr, array: ArrayId) -> bool {
        let array = self.program.array(array);
        let range = self.range(index);
        range.is_some_and(|(least, most)| i128::from(array.low) <= least && most <= i128::from(array.high))
    }

    /// What an integer expression may be.
    pub fn range(&self, expr: &Expr) -> Option<Range> {
        let whole = self.program.repr(expr.ty)?.range()?;
        let known = match &expr.kind {
            ExprKind::Const(value) => value.as_integer().map(|it| (it, it)),
            ExprKind::Load(place) => self.variable(place),
            ExprKind::Convert(Conversion::Value | Conversion::Same, operand) => self.range(operand),
            ExprKind::Apply(op, operands) => of_operands(*op, operands, |it| self.range(it)),
            ExprKind::ApplyText(op, operands) => length(*op, operands),
            ExprKind::Convert(Conversion::Truncate | Conversion::Bits, _)
            | ExprKind::Text(_)
            | ExprKind::AddressOf(_)
            | ExprKind::Aggregate(_) => None,
        };
        // What leaves the type wraps, and may be anything.
        Some(known.filter(|(least, most)| whole.0 <= *least && *most <= whole.1).unwrap_or(whole))
    }

    fn variable(&self, place: &Place) -> Option<Range> {
        if let Root::Local(id) = place.root
            && !place.is_followed()
            && (self.checked)(id)
        {
            return self.program.range(place.ty);
        }
        let seen = || Some(self.seen.iter().rfind(|it| it.0.is_same_variable(place))?.1);
        running(self.loops, place).map(|at| self.counter(at)).or_else(seen)
    }

    /// What the counter of a loop may be. Its first and last value are found when it starts, in the loops around it.
    fn counter(&self, at: usize) -> Range {
        let it = self.loops[at];
        let around = Self { loops: &self.loops[..at], seen: &[], ..*self };
        let [first, last] = [&it.first, &it.last].map(|it| around.range(it));
        let (first, last) = (first.unwrap_or(it.range), last.unwrap_or(it.range));
        match it.step {
            Step::Constant(step) if step > 0 => (first.0, last.1),
            Step::Constant(_) => (last.0, first.1),
            Step::Variable(_) => it.range,
        }
    }

    /// Whether an operation on integers has the exact result, which is no other than its low bits only if it fits the type.
    pub fn is_exact(&self, expr: &Expr) -> bool {
        let ExprKind::Apply(op @ (Op::Add | Op::Sub | Op::Mul), operands) = &expr.kind else { return false };
        let whole = self.program.repr(expr.ty).and_then(Repr::range);
        let exact = of_operands(*op, operands, |it| self.range(it));
        whole.zip(exact).is_some_and(|(whole, exact)| whole.0 <= exact.0 && exact.1 <= whole.1)
    }
}

impl Known<'_> {
    /// What an integer may be, where something is said of it: all values of a type say nothing, unless they are few.
    pub(crate) fn said(&self, expr: &Expr) -> Option<Range> {
        let repr = self.program.repr(expr.ty)?;
        self.range(expr).filter(|it| repr.size() == 1 || repr.range() != Some(*it))
    }
}

impl For {
    /// How many turns come after the first one at most, if only the loop writes its counter; `None` where nothing says it.
    pub fn most_further(&self, known: &Known<'_>) -> Option<u64> {
        let Step::Constant(step) = self.step else { return None };
        let whole = known.program.repr(self.counter.ty)?;
        // The loop ends where the counter would leave its subrange.
        let is_narrow = whole.size() == 1 || whole.range() != Some(self.range);
        let counter = is_narrow.then_some(self.range);
        let limits = [&self.first, &self.last].map(|it| known.said(it).or(counter));
        let [Some(first), Some(last)] = limits else { return None };
        let way = if step > 0 { last.1 - first.0 } else { first.1 - last.0 };
        u64::try_from(way.max(0) / step.abs()).ok()
    }
}

/// Which of the loops has `place` as its counter.
pub fn running(loops: &[&For], place: &Place) -> Option<usize> {
    loops.iter().rposition(|it| place.is_same_variable(&it.counter))
}

#[cfg(test)]
mod tests;
