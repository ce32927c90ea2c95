//! What is known of a loop while it is emitted: what leads to a further turn, and what says how many there are.

use cranelift_codegen::ir as clif;
use cranelift_frontend::Variable;
use staunch_ir::{Count, Expr, For, Location, Repr, Step, Taking, Value};

/// What leads to a further turn.
pub(crate) enum Control<'p> {
    Count(Running<'p>),
    /// It leaves the loop.
    Unless(&'p Expr),
    Always,
}

/// A FOR loop that is being emitted. Values are of 64 bits.
#[derive(Clone, Copy)]
pub(crate) struct Running<'p> {
    pub(crate) it: &'p For,
    pub(crate) repr: Repr,
    pub(crate) at: Location,
    /// The counter, in addition to its storage, if only the loop writes it.
    pub(crate) register: Option<Variable>,
    /// The storage, where it is a variable too: it is given the counter when the loop has ended.
    pub(crate) late: Option<Variable>,
    /// What is not constant.
    pub(crate) last: Option<clif::Value>,
    pub(crate) step: Option<clif::Value>,
}

impl Running<'_> {
    /// Whether the counter may leave its type by a step, which is past the last value then: the register is wider, so that this
    /// need not be tested in each turn.
    pub(crate) fn oversteps(&self) -> bool {
        let is_whole = self.repr.size() < 8 && self.repr.range() == Some(self.it.range);
        let is_constant = matches!(self.it.step, Step::Constant(_));
        self.register.is_some() && is_whole && is_constant && self.it.may_leave_range()
    }

    /// What the counter is after the last turn, if that is constant.
    pub(crate) fn end(&self) -> Option<i128> {
        let [first, last] = [&self.it.first, &self.it.last].map(|it| it.as_const().and_then(Value::as_integer));
        let (first, last, Step::Constant(step)) = (first?, last?, &self.it.step) else { return None };
        let is_past = if *step > 0 { first > last } else { first < last };
        let turns = if is_past { 0 } else { (last - first) / step + 1 };
        (self.register.is_some() && !self.it.may_leave_range()).then_some(first + turns * step)
    }
}

/// What says how many turns a loop has, when it starts.
#[derive(Clone, Copy)]
pub(crate) enum Known<'p> {
    Nothing,
    While(&'p Count),
    For(Running<'p>),
}

impl Known<'_> {
    pub(crate) fn taking(&self) -> Taking {
        match self {
            Known::Nothing => Taking::Each,
            Known::While(it) => it.taking,
            Known::For(it) => it.it.taking,
        }
    }

    /// Whether there is a turn as long as the counter is on its way, whatever else the loop tests.
    pub(crate) fn is_all_that_is_tested(&self) -> bool {
        match self {
            Known::Nothing => false,
            Known::While(it) => it.taking.is_ahead(),
            Known::For(_) => true,
        }
    }
}
