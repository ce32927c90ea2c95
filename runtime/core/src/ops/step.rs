//! The step of a FOR loop, which ends if the step would leave the counter's type.

use crate::{FaultKind, Scalar, Value};

/// The counter of a FOR loop after one more `step`, if its type has the values `low..=high`.
/// `None`, which ends the loop, if the result is out of this range and past `last`;
/// [`FaultKind::SubrangeViolated`] if it is out of this range but not past `last`.
///
/// ```
/// use staunch_runtime::{FaultKind, ops::step};
/// assert_eq!(step(4_i16, 1, 5, (0, 5)), Ok(Some(5)));
/// assert_eq!(step(5_i16, 1, 5, (0, 5)), Ok(None));
/// assert_eq!(step(5_i16, 1, 9, (0, 5)), Err(FaultKind::SubrangeViolated));
/// ```
pub fn step<T: Scalar>(counter: T, step: i128, last: T, range: (i128, i128)) -> Result<Option<T>, FaultKind> {
    let next = step_value(counter.into_value(), step, last.into_value(), range)?;
    Ok(next.and_then(T::from_value))
}

/// [`step`] for an executor that learns the type at run time.
pub fn step_value(
    counter: Value,
    step: i128,
    last: Value,
    (low, high): (i128, i128),
) -> Result<Option<Value>, FaultKind> {
    let (Some(now), Some(last)) = (counter.as_integer(), last.as_integer()) else { return Ok(None) };
    let next = now.saturating_add(step);
    if low <= next && next <= high {
        return Ok(counter.repr().integer(next));
    }
    let is_past = if step.is_positive() { next > last } else { next < last };
    if is_past { Ok(None) } else { Err(FaultKind::SubrangeViolated) }
}
