//! How well the programs kept their time.

use super::histogram::Histogram;
use crate::json::quote;
use crate::spoken::rounded;
use staunch_runtime::Time;
use std::fmt::Write as _;
use std::time::Duration;

/// The figures of the programs of a run, in the order in which they run.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Figures {
    pub programs: Vec<Kept>,
}

/// How well one program kept its time. Durations are in nanoseconds.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Kept {
    /// The instance's name.
    pub name: String,
    /// From one scan to the next.
    pub period: Time,
    /// Scans that had not ended when the next one was due.
    pub overruns: u64,
    /// Scans that were left out, since a whole period had passed.
    pub missed: u64,
    /// From when a scan was due to when it began.
    pub late: Histogram,
    /// What a scan took.
    pub scan: Histogram,
    /// How much longer or shorter than the period it was from one beginning to the next.
    pub jitter: Histogram,
    began: Option<Time>,
}

impl Kept {
    pub(super) fn new(name: &str, period: Time) -> Self {
        Self {
            name: name.to_owned(),
            period,
            overruns: 0,
            missed: 0,
            late: Histogram::default(),
            scan: Histogram::default(),
            jitter: Histogram::default(),
            began: None,
        }
    }

    /// Counts a scan that was due, began and ended at these times. Returns whether it was an overrun: the next was `due_next`.
    pub(super) fn add(&mut self, due: Time, began: Time, ended: Time, due_next: Time) -> bool {
        let positive = |it: Time| u64::try_from(it).unwrap_or(0);
        self.late.add(positive(began.saturating_sub(due)));
        self.scan.add(positive(ended.saturating_sub(began)));
        if let Some(before) = self.began.replace(began) {
            self.jitter.add(began.saturating_sub(before).saturating_sub(self.period).unsigned_abs());
        }
        let overran = ended > due_next;
        self.overruns += u64::from(overran);
        overran
    }

    fn copy_from(&mut self, other: &Self) {
        (self.overruns, self.missed) = (other.overruns, other.missed);
        self.late.copy_from(&other.late);
        self.scan.copy_from(&other.scan);
        self.jitter.copy_from(&other.jitter);
    }

    fn rows(&self) -> [(&'static str, &Histogram); 3] {
        [("late", &self.late), ("scan", &self.scan), ("jitter", &self.jitter)]
    }
}

/// The columns of a distribution, in millionths of the scans.
const QUANTILES: [(&str, u64); 3] = [("p50", 500_000), ("p99", 990_000), ("p99.9", 999_000)];

impl Figures {
    /// Takes over what others counted of the same programs, without an allocation.
    pub(super) fn copy_from(&mut self, other: &Self) {
        self.programs.iter_mut().zip(&other.programs).for_each(|(own, other)| own.copy_from(other));
    }

    pub fn overruns(&self) -> u64 {
        self.programs.iter().map(|it| it.overruns).sum()
    }

    pub fn missed(&self) -> u64 {
        self.programs.iter().map(|it| it.missed).sum()
    }

    /// The shortest scan of any program.
    pub fn shortest(&self) -> Duration {
        let ran = self.programs.iter().filter(|it| it.scan.count() > 0);
        Duration::from_nanos(ran.map(|it| it.scan.min()).min().unwrap_or(0))
    }

    /// The longest scan of any program.
    pub fn longest(&self) -> Duration {
        Duration::from_nanos(self.programs.iter().map(|it| it.scan.max()).max().unwrap_or(0))
    }

    /// A table for people.
    pub fn table(&self) -> String {
        let mut text = String::new();
        for program in &self.programs {
            let Kept { name, period, overruns, missed, scan, .. } = program;
            let scans = scan.count();
            let every = rounded(Duration::from_nanos(u64::try_from(*period).unwrap_or(0)));
            let _ = writeln!(text, "{name}: every {every}, {scans} scans, {overruns} overruns, {missed} left out");
            let _ = write!(text, "{:>8}{:>10}", "", "min");
            let names = QUANTILES.map(|it| it.0);
            let _ = writeln!(text, "{:>10}{:>10}{:>10}{:>10}", names[0], names[1], names[2], "max");
            for (what, histogram) in program.rows() {
                let _ = write!(text, "{what:>8}");
                for value in distribution(histogram) {
                    let _ = write!(text, "{:>10}", rounded(Duration::from_nanos(value)));
                }
                text.push('\n');
            }
        }
        text
    }

    /// The programs as a JSON array. Durations are in nanoseconds.
    pub fn json(&self) -> String {
        let program = |it: &Kept| {
            let Kept { name, period, overruns, missed, scan, .. } = it;
            let mut text = format!(
                "{{\"name\":{},\"period_ns\":{period},\"scans\":{},\"overruns\":{overruns},\"missed\":{missed}",
                quote(name),
                scan.count()
            );
            for (what, histogram) in it.rows() {
                let [min, p50, p99, p999, max] = distribution(histogram);
                let _ = write!(
                    text,
                    ",\"{what}_ns\":{{\"min\":{min},\"p50\":{p50},\"p99\":{p99},\"p99.9\":{p999},\"max\":{max}}}"
                );
            }
            text + "}"
        };
        format!("[{}]", self.programs.iter().map(program).collect::<Vec<_>>().join(","))
    }
}

fn distribution(histogram: &Histogram) -> [u64; 5] {
    let [p50, p99, p999] = QUANTILES.map(|(_, millionths)| histogram.quantile(millionths));
    [histogram.min(), p50, p99, p999, histogram.max()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lateness_and_jitter_are_told_apart() {
        let mut kept = Kept::new("main", 1000);
        assert!(!kept.add(0, 10, 400, 1000));
        assert!(!kept.add(1000, 1300, 2000, 2000));
        assert!(kept.add(2000, 2010, 3500, 3000));
        assert_eq!((kept.late.min(), kept.late.max()), (10, 300));
        assert_eq!((kept.scan.min(), kept.scan.max()), (390, 1490));
        assert_eq!((kept.jitter.count(), kept.jitter.min(), kept.jitter.max()), (2, 290, 290));
        assert_eq!(kept.overruns, 1);
        let figures = Figures { programs: vec![kept] };
        let json = figures.json();
        assert!(json.starts_with("[{\"name\":\"main\",\"period_ns\":1000,\"scans\":3,\"overruns\":1,\"missed\":0"));
        assert!(json.contains("\"late_ns\":{\"min\":10,\"p50\":10,\"p99\":300,\"p99.9\":300,\"max\":300}"), "{json}");
        let table = figures.table();
        assert!(table.starts_with("main: every 1.00 µs, 3 scans, 1 overruns, 0 left out\n"), "{table}");
        assert_eq!(table.lines().count(), 5);
    }
}
