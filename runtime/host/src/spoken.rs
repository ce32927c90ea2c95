//! Durations in sentences.

use crate::format_time;
use staunch_runtime::Time;
use std::time::Duration;

/// `2 s`, `1 min 30 s`: a time for a sentence.
pub(crate) fn spoken(time: Time) -> String {
    let text = format_time(time);
    let mut out = String::new();
    let mut digit = true;
    for character in text.trim_start_matches("T#").chars() {
        if character.is_ascii_digit() != digit {
            out.push(' ');
            digit = !digit;
        }
        out.push(character);
    }
    let words = out.split(' ').map(|it| if it == "m" { "min" } else { it });
    words.collect::<Vec<_>>().join(" ")
}

/// Three digits are enough for people.
pub(crate) fn rounded(duration: Duration) -> String {
    let nanoseconds = duration.as_nanos();
    let (value, unit) = match nanoseconds {
        0..=999 => return format!("{nanoseconds} ns"),
        1_000..=999_999 => (nanoseconds as f64 / 1e3, "µs"),
        1_000_000..=999_999_999 => (nanoseconds as f64 / 1e6, "ms"),
        _ => (nanoseconds as f64 / 1e9, "s"),
    };
    let digits = if value < 10.0 { 2 } else { usize::from(value < 100.0) };
    format!("{value:.digits$} {unit}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_for_people() {
        assert_eq!(spoken(2_000_000_000), "2 s");
        assert_eq!(spoken(90_500_000_000), "1 min 30 s 500 ms");
        assert_eq!(rounded(Duration::from_nanos(950)), "950 ns");
        assert_eq!(rounded(Duration::from_nanos(1_234_567)), "1.23 ms");
        assert_eq!(rounded(Duration::from_secs(123)), "123 s");
    }
}
