//! Array indices, and their check.

use super::Integer;
use crate::FaultKind;

/// The 0-based position of element `value` in an array whose subscripts are `low..=high`, otherwise
/// [`FaultKind::IndexOutOfRange`].
///
/// ```
/// use staunch_runtime::{FaultKind, ops::index};
/// assert_eq!(index(-2, -3, 3), Ok(1));
/// assert_eq!(index(4, -3, 3), Err(FaultKind::IndexOutOfRange));
/// ```
#[inline]
pub fn index(value: i64, low: i64, high: i64) -> Result<usize, FaultKind> {
    if value < low || value > high {
        Err(FaultKind::IndexOutOfRange)
    } else {
        // An array that fits the memory has no more elements than a `usize` counts.
        Ok(value.wrapping_sub(low) as usize)
    }
}

/// `value` if it is in `low..=high`, otherwise [`FaultKind::IndexOutOfRange`]: an index that is checked
/// before its element is read or written.
#[inline]
pub fn checked_index<T: Integer>(low: T, value: T, high: T) -> Result<T, FaultKind> {
    if value < low || value > high { Err(FaultKind::IndexOutOfRange) } else { Ok(value) }
}
