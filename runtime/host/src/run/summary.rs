//! What a run came to, for people and as JSON.

use crate::format_time;
use crate::json::quote;
use crate::realtime::Figures;
use staunch_runtime::Time;
use std::time::Duration;

/// What a run came to.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Summary {
    pub scans: u64,
    /// On the clock of the program, in nanoseconds, to the end of the last cycle.
    pub time: Time,
    /// How long the run took.
    pub elapsed: Duration,
    /// Of a run in real time.
    pub real: Option<Figures>,
}

impl Summary {
    /// Times in nanoseconds.
    pub(super) fn json(&self, title: &str, lost: u64) -> String {
        let Self { scans, time, elapsed, real } = self;
        let mut text = format!(
            "{{\"reason\":\"run\",\"program\":{},\"scans\":{scans},\"time_ns\":{time},\"elapsed_ns\":{}",
            quote(title),
            elapsed.as_nanos()
        );
        if let Some(figures) = real {
            let (shortest, longest) = (figures.shortest().as_nanos(), figures.longest().as_nanos());
            let overruns = figures.overruns();
            text += &format!(",\"overruns\":{overruns},\"shortest_ns\":{shortest},\"longest_ns\":{longest}");
            text += &format!(",\"programs\":{}", figures.json());
        }
        if lost > 0 {
            text += &format!(",\"rows_lost\":{lost}");
        }
        text + "}"
    }

    /// A line for people, and a table of a run in real time.
    pub(super) fn text(&self, title: &str) -> String {
        let Self { scans, time, elapsed, real } = self;
        let plural = if *scans == 1 { "" } else { "s" };
        let begin = format!("{scans} scan{plural} of {title}, ");
        let took = rounded(*elapsed);
        match real {
            None => format!("{begin}{} of virtual time, in {took}\n", spoken(*time)),
            Some(figures) => format!("{begin}{took} in real time\n{}", figures.table()),
        }
    }
}

/// What is printed of a run in real time while it goes on: for people, or as JSON.
pub(super) fn figures_text(figures: &Figures) -> String {
    figures.table()
}

pub(super) fn figures_json(figures: &Figures) -> String {
    format!("{{\"reason\":\"figures\",\"programs\":{}}}", figures.json())
}

/// `2 s`, `1 min 30 s`: a time for a sentence.
fn spoken(time: Time) -> String {
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
