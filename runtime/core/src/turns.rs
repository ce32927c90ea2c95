//! Loops that take all of their turns before the first one, or several at once.

use crate::ops::Integer;
use crate::{Context, FaultKind};

mod strips;

pub use strips::Strips;

/// The turns that a FOR loop has taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Turns<T> {
    /// The last value of the counter that they suffice for.
    pub limit: T,
    last: T,
    step: i128,
}

impl Context {
    /// Takes the turns of a loop whose counter goes from `first` by `step`, which is not 0, to `last`; where they
    /// do not suffice, as many as there are. [`FaultKind::LoopBudget`] if it has a turn and none is left.
    ///
    /// ```
    /// use staunch_runtime::{Context, FaultKind};
    /// let cx = Context::at(0).with_turns(5);
    /// assert_eq!(cx.take_turns(1_i16, 3, 1)?.limit, 3);
    /// assert_eq!(cx.take_turns(10_i16, 90, 10)?.limit, 20);
    /// assert_eq!(cx.take_turns(1_i16, 3, 1).err(), Some(FaultKind::LoopBudget));
    /// # Ok::<(), FaultKind>(())
    /// ```
    #[inline]
    pub fn take_turns<T: Integer>(&self, first: T, last: T, step: i128) -> Result<Turns<T>, FaultKind> {
        let turns = Turns { limit: last, last, step };
        if turns.is_past(first) {
            return Ok(turns);
        }
        let (left, further) = (self.turns_left(), turns.after(first));
        if further < left {
            self.set_turns(left - further - 1);
            return Ok(turns);
        }
        let further = left.checked_sub(1).ok_or(FaultKind::LoopBudget)?;
        self.set_turns(0);
        let way = further.wrapping_mul(size(step));
        let start = first.extended();
        let limit = if step > 0 { start.wrapping_add(way) } else { start.wrapping_sub(way) };
        Ok(Turns { limit: T::of_low_bits(limit), ..turns })
    }
}

/// The turns that a loop has taken which goes on while its counter is before a bound.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TurnsBefore<T> {
    /// The bound, or what is before it and next to the last value that the turns suffice for.
    pub limit: T,
    bound: T,
}

impl Context {
    /// [`Context::take_turns`] for a loop that goes on while its counter is before `bound`: below it, or above it where
    /// the step is negative. There is a value from which a step leads to `bound` or past it, within the type.
    ///
    /// ```
    /// use staunch_runtime::{Context, FaultKind};
    /// let cx = Context::at(0).with_turns(5);
    /// let all = cx.take_turns_before(0_i16, 3, 1)?;
    /// assert_eq!((all.limit, all.end()), (3, Ok(())));
    /// let some = cx.take_turns_before(10_i16, 90, 10)?;
    /// assert_eq!((some.limit, some.end()), (21, Err(FaultKind::LoopBudget)));
    /// # Ok::<(), FaultKind>(())
    /// ```
    #[inline]
    pub fn take_turns_before<T: Integer>(&self, first: T, bound: T, step: i128) -> Result<TurnsBefore<T>, FaultKind> {
        let is_before = if step > 0 { first < bound } else { first > bound };
        if !is_before {
            return Ok(TurnsBefore { limit: bound, bound });
        }
        let one = if step > 0 { 1 } else { 1_u64.wrapping_neg() };
        let last = T::of_low_bits(bound.extended().wrapping_sub(one));
        let turns = self.take_turns(first, last, step)?;
        let limit = T::of_low_bits(turns.limit.extended().wrapping_add(one));
        Ok(TurnsBefore { limit, bound })
    }
}

impl<T: PartialEq> TurnsBefore<T> {
    /// After the loop, which nothing but its bound ends: [`FaultKind::LoopBudget`] where it would have gone further.
    #[inline]
    pub fn end(&self) -> Result<(), FaultKind> {
        if self.limit == self.bound { Ok(()) } else { Err(FaultKind::LoopBudget) }
    }
}

impl<T: Integer> Turns<T> {
    /// After the loop, with its counter: [`FaultKind::LoopBudget`] where it came past the limit and would have
    /// gone further.
    #[inline]
    pub fn end(&self, cx: &Context, counter: T) -> Result<(), FaultKind> {
        if !self.is_past(counter) {
            self.give_back(cx, counter);
            return Ok(());
        }
        if self.limit == self.last { Ok(()) } else { Err(FaultKind::LoopBudget) }
    }

    /// In the turn with `counter`: there will be no further one.
    #[inline]
    pub fn give_back(&self, cx: &Context, counter: T) {
        cx.set_turns(cx.turns_left().wrapping_add(self.after(counter)));
    }

    #[inline]
    fn is_past(&self, counter: T) -> bool {
        if self.step > 0 { counter > self.limit } else { counter < self.limit }
    }

    /// How many come after the one with `counter`, which is not past the limit.
    #[inline]
    fn after(&self, counter: T) -> u64 {
        let (limit, counter) = (self.limit.extended(), counter.extended());
        let way = if self.step > 0 { limit.wrapping_sub(counter) } else { counter.wrapping_sub(limit) };
        way / size(self.step)
    }
}

/// A step's magnitude, which a counter's type holds.
#[inline]
fn size(step: i128) -> u64 {
    u64::try_from(step.unsigned_abs()).unwrap_or(u64::MAX).max(1)
}
