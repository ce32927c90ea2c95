//! Loops whose number of turns is known before the first one, and loops that take several turns at once.

use crate::ops::Integer;
use crate::{Context, FaultKind};

mod strips;

pub use strips::Strips;

impl Context {
    /// A loop with at most this many turns takes none from the budget, if their number is known before the first one and the loop
    /// contains no other loop.
    pub const FREE_TURNS: u64 = 1024;

    /// Takes all turns of a loop whose counter goes from `first` to `last` by `step`, which is not 0.
    ///
    /// # Errors
    /// [`FaultKind::LoopBudget`] if not enough turns are left: then none is taken.
    ///
    /// ```
    /// use staunch_runtime::{Context, FaultKind};
    /// let cx = Context::at(0).with_turns(5);
    /// assert_eq!(cx.take_turns(1_i16, 3, 1), Ok(()));
    /// assert_eq!(cx.take_turns(10_i16, 30, 10), Err(FaultKind::LoopBudget));
    /// assert_eq!(cx.take_turns(10_i16, 29, 10), Ok(()));
    /// assert_eq!(cx.take_turns(3_i16, 1, 1), Ok(()));
    /// ```
    #[inline]
    pub fn take_turns<T: Integer>(&self, first: T, last: T, step: i128) -> Result<(), FaultKind> {
        match further(first, last, step) {
            Some(further) => self.take(further),
            None => Ok(()),
        }
    }

    /// [`Context::take_turns`] for a loop that continues while its counter is before `bound`: below it, or above it if the step
    /// is negative.
    #[inline]
    pub fn take_turns_before<T: Integer>(&self, first: T, bound: T, step: i128) -> Result<(), FaultKind> {
        match further_before(first, bound, step) {
            Some(further) => self.take(further),
            None => Ok(()),
        }
    }

    /// [`Context::take_turns`] if there are more than [`Context::FREE_TURNS`]; otherwise it takes none.
    ///
    /// ```
    /// use staunch_runtime::{Context, FaultKind};
    /// let cx = Context::at(0).with_turns(1030);
    /// assert_eq!(cx.take_many_turns(1_i16, 1024, 1), Ok(()));
    /// assert_eq!(cx.take_many_turns(1_i16, 1025, 1), Ok(()));
    /// assert_eq!(cx.take_many_turns(1_i16, 1025, 1), Err(FaultKind::LoopBudget));
    /// ```
    #[inline]
    pub fn take_many_turns<T: Integer>(&self, first: T, last: T, step: i128) -> Result<(), FaultKind> {
        if Self::has_few_turns(first, last, step) { Ok(()) } else { self.take_turns(first, last, step) }
    }

    /// [`Context::take_turns_before`] if there are more than [`Context::FREE_TURNS`]; otherwise it takes none.
    #[inline]
    pub fn take_many_turns_before<T: Integer>(&self, first: T, bound: T, step: i128) -> Result<(), FaultKind> {
        if Self::has_few_turns_before(first, bound, step) { Ok(()) } else { self.take_turns_before(first, bound, step) }
    }

    /// Whether a loop whose counter goes from `first` to `last` by `step`, which is not 0, has at most
    /// [`Context::FREE_TURNS`] turns.
    #[inline]
    pub fn has_few_turns<T: Integer>(first: T, last: T, step: i128) -> bool {
        is_below(first, last, step, few(step))
    }

    /// [`Context::has_few_turns`] for a loop that continues while its counter is before `bound`.
    #[inline]
    pub fn has_few_turns_before<T: Integer>(first: T, bound: T, step: i128) -> bool {
        is_below(first, bound, step, few(step).saturating_add(1))
    }

    #[inline]
    fn take(&self, further: u64) -> Result<(), FaultKind> {
        let left = self.turns_left();
        if further >= left {
            return Err(FaultKind::LoopBudget);
        }
        self.set_turns(left - further - 1);
        Ok(())
    }
}

/// The number of turns after the first one; `None` for a loop without turns.
#[inline]
fn further<T: Integer>(first: T, last: T, step: i128) -> Option<u64> {
    way(first, last, step).map(|it| it / size(step))
}

#[inline]
fn further_before<T: Integer>(first: T, bound: T, step: i128) -> Option<u64> {
    way(first, bound, step)?.checked_sub(1).map(|it| it / size(step))
}

/// The distance from `first` to `last`, if `first` is not past it.
#[inline]
fn way<T: Integer>(first: T, last: T, step: i128) -> Option<u64> {
    let (low, high) = if step > 0 { (first, last) } else { (last, first) };
    (low <= high).then(|| high.extended().wrapping_sub(low.extended()))
}

/// Whether the distance from `first` to `last` is shorter, or negative.
#[inline]
fn is_below<T: Integer>(first: T, last: T, step: i128, length: u64) -> bool {
    if T::BITS > 32 {
        return way(first, last, step).is_none_or(|it| it < length);
    }
    // One comparison: as numbers with a sign, of which 64 bits hold all.
    const SIGN: u64 = 1 << 63;
    let (low, high) = if step > 0 { (first, last) } else { (last, first) };
    let way = high.extended().wrapping_sub(low.extended());
    way ^ SIGN < length ^ SIGN
}

/// The length of [`Context::FREE_TURNS`] steps.
#[inline]
fn few(step: i128) -> u64 {
    size(step).saturating_mul(Context::FREE_TURNS)
}

/// The magnitude of a step, which fits the counter's type.
#[inline]
fn size(step: i128) -> u64 {
    u64::try_from(step.unsigned_abs()).unwrap_or(u64::MAX).max(1)
}
