//! How often durations of each length were seen: of a fixed size, so that counting neither allocates nor searches.

/// Each power of two has as many counts, so that a figure is at most 1/32 too large.
const PARTS: u64 = 1 << PARTS_BITS;
const PARTS_BITS: u32 = 5;
const COUNTS: usize = ((64 - PARTS_BITS + 1) as usize) << PARTS_BITS;

/// Durations in nanoseconds.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Histogram {
    counts: Box<[u64]>,
    count: u64,
    total: u128,
    min: u64,
    max: u64,
}

impl Default for Histogram {
    fn default() -> Self {
        Self { counts: vec![0; COUNTS].into(), count: 0, total: 0, min: u64::MAX, max: 0 }
    }
}

impl Histogram {
    pub fn add(&mut self, value: u64) {
        self.counts[place(value)] += 1;
        self.count += 1;
        self.total += u128::from(value);
        self.min = self.min.min(value);
        self.max = self.max.max(value);
    }

    /// Takes over what another one counted, without an allocation.
    pub fn copy_from(&mut self, other: &Self) {
        self.counts.copy_from_slice(&other.counts);
        (self.count, self.total, self.min, self.max) = (other.count, other.total, other.min, other.max);
    }

    pub const fn count(&self) -> u64 {
        self.count
    }

    /// The shortest; 0 where nothing was counted.
    pub fn min(&self) -> u64 {
        if self.count == 0 { 0 } else { self.min }
    }

    /// The longest; 0 where nothing was counted.
    pub const fn max(&self) -> u64 {
        self.max
    }

    /// The mean, rounded down; 0 where nothing was counted.
    pub fn mean(&self) -> u64 {
        let mean = self.total.checked_div(u128::from(self.count)).unwrap_or(0);
        u64::try_from(mean).unwrap_or(u64::MAX)
    }

    /// What so many of a million durations do not exceed: at most 1/32 too large, and never more than the longest.
    pub fn quantile(&self, millionths: u64) -> u64 {
        let wanted = (u128::from(self.count) * u128::from(millionths)).div_ceil(1_000_000).max(1);
        let mut seen = 0;
        let found = self.counts.iter().position(|count| {
            seen += u128::from(*count);
            seen >= wanted
        });
        found.map_or(0, |at| largest(at).min(self.max))
    }
}

/// The count that a duration belongs to.
fn place(value: u64) -> usize {
    let shift = (u64::BITS - value.leading_zeros()).saturating_sub(PARTS_BITS + 1);
    let part = (value >> shift) as usize;
    ((shift as usize) << PARTS_BITS) + part
}

/// The longest duration of a count.
fn largest(place: usize) -> u64 {
    let shift = (place >> PARTS_BITS).saturating_sub(1) as u32;
    let part = place as u64 - (u64::from(shift) << PARTS_BITS);
    debug_assert!(part < 2 * PARTS);
    // The last count ends at the greatest number.
    ((u128::from(part) + 1) << shift).wrapping_sub(1).min(u128::from(u64::MAX)) as u64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_duration_has_a_place_that_ends_near_it() {
        let mut last = 0;
        for shift in 0..64 {
            for value in [1 << shift, (1 << shift) + (1 << shift >> 1), u64::MAX >> (63 - shift)] {
                let at = place(value);
                assert!(at < COUNTS && at >= last, "{value}");
                last = at.min(place(1 << shift));
                let end = largest(at);
                assert!(end >= value && end - value <= value / PARTS, "{value}: {end}");
                assert_eq!(place(end), at, "{value}");
            }
        }
        assert_eq!((place(0), largest(0)), (0, 0));
        assert_eq!((place(u64::MAX), largest(COUNTS - 1)), (COUNTS - 1, u64::MAX));
    }

    #[test]
    fn quantiles_are_those_of_what_was_counted() {
        let mut histogram = Histogram::default();
        assert_eq!((histogram.min(), histogram.quantile(500_000), histogram.max(), histogram.mean()), (0, 0, 0, 0));
        (1..=1000).for_each(|it| histogram.add(it * 1000));
        assert_eq!((histogram.min(), histogram.max(), histogram.mean()), (1000, 1_000_000, 500_500));
        for (millionths, exact) in [(500_000, 500_000), (990_000, 990_000), (999_000, 999_000)] {
            let found = histogram.quantile(millionths);
            assert!(exact <= found && found <= exact + exact / PARTS, "{millionths}: {found}");
        }
        assert_eq!(histogram.quantile(1_000_000), 1_000_000);
        let mut other = Histogram::default();
        other.copy_from(&histogram);
        assert_eq!(other, histogram);
    }
}
