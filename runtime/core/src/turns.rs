//! Loops that take all of their turns before the first one.

use crate::ops::Integer;
use crate::{Context, FaultKind};

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
