//! Round times for the axis of a picture, and how they read.

use super::milliseconds;
use crate::format_time;
use staunch_runtime::Time;

const SECOND: Time = 1_000_000_000;
/// Distances that read well from a minute on.
const LONG: [Time; 12] = [
    60 * SECOND,
    120 * SECOND,
    300 * SECOND,
    600 * SECOND,
    1800 * SECOND,
    3600 * SECOND,
    7200 * SECOND,
    21_600 * SECOND,
    43_200 * SECOND,
    86_400 * SECOND,
    172_800 * SECOND,
    864_000 * SECOND,
];

/// The round times from `start` to `end`, at least `distance` from each other, with their labels.
pub(super) fn ticks(start: Time, end: Time, distance: Time) -> Vec<(Time, String)> {
    let step = round(distance);
    let first = start.div_euclid(step) * step + if start.rem_euclid(step) == 0 { 0 } else { step };
    let count = usize::try_from((end - first).div_euclid(step) + 1).unwrap_or(0);
    std::iter::successors(Some(first), |it| it.checked_add(step))
        .take(count)
        .map(|time| (time, label(time, step, end)))
        .collect()
}

/// 1, 2 or 5 of a power of ten below a minute, and what clocks show above.
fn round(distance: Time) -> Time {
    let powers = std::iter::successors(Some(1), |it: &Time| it.checked_mul(10)).take_while(|it| *it <= 10 * SECOND);
    let short = powers.flat_map(|it| [it, 2 * it, 5 * it]).filter(|it| *it <= 20 * SECOND);
    let mut all = short.chain(LONG);
    all.find(|it| *it >= distance).unwrap_or_else(|| ((distance - 1) / LONG[11] + 1).saturating_mul(LONG[11]))
}

/// All labels have the unit of the last one.
fn label(time: Time, step: Time, end: Time) -> String {
    match end.max(step) {
        _ if time == 0 => "0 s".to_owned(),
        60_000_000_000.. => format_time(time).trim_start_matches("T#").to_owned(),
        1_000_000_000.. => format!("{} s", milliseconds(time / 1000)),
        1_000_000.. => format!("{} ms", milliseconds(time)),
        1_000.. => format!("{} µs", milliseconds(time * 1000)),
        _ => format!("{time} ns"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(start: Time, end: Time, distance: Time) -> String {
        ticks(start, end, distance).into_iter().map(|it| it.1).collect::<Vec<_>>().join(" | ")
    }

    #[test]
    fn labels_have_units() {
        assert_eq!(labels(0, 50_000_000, 9_000_000), "0 s | 10 ms | 20 ms | 30 ms | 40 ms | 50 ms");
        assert_eq!(labels(1, 2_100_000_000, 900_000_000), "1 s | 2 s");
        assert_eq!(labels(0, 250 * SECOND, 50 * SECOND), "0 s | 1m | 2m | 3m | 4m");
        assert_eq!(labels(0, 7200 * SECOND, 1700 * SECOND), "0 s | 30m | 1h | 1h30m | 2h");
        assert_eq!(labels(0, 3_000, 1_500), "0 s | 2 µs");
        assert_eq!(labels(0, 1_100_000_000, 400_000_000), "0 s | 0.5 s | 1 s");
        assert_eq!(labels(61 * SECOND, 62 * SECOND, 400_000_000), "1m1s | 1m1s500ms | 1m2s");
        assert_eq!(labels(0, 30, 12), "0 s | 20 ns");
    }

    #[test]
    fn there_are_never_very_many() {
        for exponent in 0..18 {
            let span = 10_i64.pow(exponent);
            assert!(ticks(0, span, span / 10).len() <= 12, "{span}");
        }
        assert!(ticks(0, Time::MAX / 2, Time::MAX / 20).len() <= 12);
    }
}
