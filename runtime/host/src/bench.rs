//! How long a scan takes.

use crate::compiled::Compiled;
use crate::map::{Map, Type, Variable};
use crate::minor::minor_faults_note;
use crate::path::Place;
use crate::run::running;
use crate::schedule::{Due, Schedule};
use crate::stimulus::Stimulus;
use crate::{Error, Machine};
use staunch_runtime::{Context, Elementary, MinorFaults, Time};
use std::fmt;
use std::path::PathBuf;
use std::str::FromStr;
use std::time::{Duration, Instant};

/// A batch is so long that the time for reading the clock does not matter.
const BATCH: Duration = Duration::from_micros(50);
const LARGEST_BATCH: u64 = 1 << 16;
/// Measuring takes this long unless the number of scans is given.
const LENGTH: Duration = Duration::from_millis(700);
const WARM_UP: Duration = Duration::from_millis(100);
/// Batches of empty scans that are measured.
const EMPTY_BATCHES: usize = 100;

#[derive(Clone, Debug, Default)]
pub struct BenchOptions {
    pub program: Option<String>,
    /// Scans to measure, after the warm-up.
    pub scans: Option<u64>,
    pub cycle: Option<Time>,
    /// Turns that the loops of one scan may take together; [`Context::TURNS`].
    pub loop_budget: Option<u64>,
    /// Its rows repeat. Without one, every BOOL input changes in each scan.
    pub stimulus: Option<PathBuf>,
}

/// Nanoseconds per scan, measured in batches, without the time that measuring takes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Timing {
    /// Scans that were measured.
    pub scans: u64,
    pub min: f64,
    pub median: f64,
    pub p99: f64,
    /// The time of a scan of an empty program, called in the same way after its inputs are written. It is not included in the other figures.
    pub overhead: f64,
}

/// One line that people and programs read: `scans=500 ns_min=1.50 ns_median=1.60 ns_p99=2.00 ns_overhead=2.40`.
impl fmt::Display for Timing {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { scans, min, median, p99, overhead } = self;
        write!(f, "scans={scans} ns_min={min:.2} ns_median={median:.2} ns_p99={p99:.2} ns_overhead={overhead:.2}")
    }
}

impl FromStr for Timing {
    type Err = ();

    fn from_str(text: &str) -> Result<Self, ()> {
        let field = |name: &str| {
            let found = text.split_whitespace().find_map(|it| it.strip_prefix(name)?.strip_prefix('='));
            found.ok_or(())
        };
        let number = |name| field(name).and_then(|it| it.parse().map_err(drop));
        let scans = field("scans")?.parse().map_err(drop)?;
        Ok(Self {
            scans,
            min: number("ns_min")?,
            median: number("ns_median")?,
            p99: number("ns_p99")?,
            overhead: number("ns_overhead")?,
        })
    }
}

/// Measures only the scans, on the monotonic clock. The time of the calls themselves, which is measured with an empty program, is subtracted.
pub fn bench(machine: &mut Compiled, map: &Map, options: &BenchOptions) -> Result<Timing, Error> {
    let running = running(map, options.program.as_deref())?;
    machine.init();
    let lists = match &options.stimulus {
        Some(path) => repeated(&Stimulus::read(path, map, &running)?, machine.state()),
        None => toggled(&bool_inputs(map, &running), machine.state()),
    };
    let overhead = overhead(&mut machine.without_code(), map, &running, options, &lists)?;
    let mut bench = Bench::new(machine, map, &running, options, &lists);
    let batch = bench.warm_up()?;
    let mut samples = Vec::with_capacity(1 << 16);
    let (began, mut scans) = (Instant::now(), 0);
    while options.scans.map_or(began.elapsed() < LENGTH, |wanted| scans < wanted) {
        let count = options.scans.map_or(batch, |wanted| batch.min(wanted - scans));
        samples.push(bench.sample(count)?);
        scans += count;
    }
    if let Some(note) = minor_faults_note(bench.minor_faults, map) {
        crate::error::tell(format_args!("{note}"));
    }
    let at = quantiles(samples, overhead);
    Ok(Timing { scans, min: at(0.0), median: at(0.5), p99: at(0.99), overhead })
}

/// The time of a scan of a program that does nothing.
fn overhead(
    empty: &mut Compiled,
    map: &Map,
    running: &[usize],
    options: &BenchOptions,
    lists: &Lists,
) -> Result<f64, Error> {
    let mut bench = Bench::new(empty, map, running, options, lists);
    let batch = bench.warm_up()?;
    let samples = (0..EMPTY_BATCHES).map(|_| bench.sample(batch)).collect::<Result<Vec<_>, _>>()?;
    Ok(quantiles(samples, 0.0)(0.5))
}

/// The value that a part of the samples does not exceed, less what each of them has too much.
fn quantiles(mut samples: Vec<f64>, overhead: f64) -> impl Fn(f64) -> f64 {
    samples.sort_by(f64::total_cmp);
    move |part| {
        let at = (samples.len() as f64 - 1.0).max(0.0) * part;
        samples.get(at as usize).map_or(0.0, |it| (it - overhead).max(0.0))
    }
}

/// What is written before each scan; the lists repeat.
type Lists = Vec<Vec<(usize, Vec<u8>)>>;

/// Rows as scans; a row that is placed by time alone counts as one scan.
fn repeated(stimulus: &Stimulus, state: &[u8]) -> Lists {
    let mut scans = Lists::new();
    // Bits are written into the bytes that the rows above them left.
    let mut state = state.to_vec();
    for row in &stimulus.rows {
        let number = row.scan.and_then(|it| usize::try_from(it).ok()).unwrap_or(scans.len() + 1);
        // A row far ahead would only repeat the one before it.
        if number > scans.len() && number < scans.len() + (1 << 20) {
            scans.resize_with(number, Vec::new);
        }
        if let Some(last) = scans.last_mut() {
            for write in &row.writes {
                let bytes = write.over(&state).into_owned();
                state[write.offset..write.offset + bytes.len()].copy_from_slice(&bytes);
                last.push((write.offset, bytes));
            }
        }
    }
    scans
}

/// Every BOOL input changes in each scan.
fn toggled(offsets: &[usize], state: &[u8]) -> Lists {
    let with = |change: u8| offsets.iter().map(|at| (*at, vec![state[*at] ^ change])).collect();
    if offsets.is_empty() { Lists::new() } else { vec![with(1), with(0)] }
}

fn bool_inputs(map: &Map, running: &[usize]) -> Vec<usize> {
    let is_input = |it: &&Variable| {
        let is_bool = matches!(it.ty, Type::Elementary(Elementary::Bool));
        it.is_input() && is_bool && !it.constant
    };
    let (globals, base) = map.globals();
    let own = running.iter().flat_map(|at| &map.instances[*at].variables).filter(is_input).map(|it| Place::of(it, 0));
    let global = globals.iter().filter(is_input).map(|it| Place::of(it, base));
    let mut offsets: Vec<usize> = own.chain(global).map(|it| it.offset).collect();
    offsets.sort_unstable();
    offsets.dedup();
    offsets
}

struct Bench<'a> {
    machine: &'a mut Compiled,
    map: &'a Map,
    /// How many lists of writes the machine keeps, and which comes before the next scan.
    lists: usize,
    next: usize,
    schedule: Schedule,
    fresh: Vec<bool>,
    turns: u64,
    number: u64,
    now: Time,
    minor_faults: MinorFaults,
}

impl<'a> Bench<'a> {
    fn new(machine: &'a mut Compiled, map: &'a Map, running: &[usize], options: &BenchOptions, lists: &Lists) -> Self {
        machine.prepare(lists);
        Self {
            machine,
            map,
            lists: lists.len(),
            next: 0,
            schedule: Schedule::new(map, running, options.cycle),
            fresh: vec![true; map.instances.len()],
            turns: options.loop_budget.unwrap_or(Context::TURNS),
            number: 0,
            now: 0,
            minor_faults: MinorFaults::default(),
        }
    }

    /// Nanoseconds per scan, of a batch.
    fn sample(&mut self, count: u64) -> Result<f64, Error> {
        Ok(self.batch(count)?.as_nanos() as f64 / count as f64)
    }

    /// Finds how many scans make a batch, and continues until caches and clock rate have settled.
    fn warm_up(&mut self) -> Result<u64, Error> {
        let began = Instant::now();
        let mut count = 1;
        loop {
            let took = self.batch(count)?;
            if took < BATCH && count < LARGEST_BATCH {
                count *= 2;
            } else if began.elapsed() >= WARM_UP {
                return Ok(count);
            }
        }
    }

    fn batch(&mut self, count: u64) -> Result<Duration, Error> {
        let began = Instant::now();
        let end = match self.schedule.only() {
            Some(program) => self.only(count, program),
            None => self.scheduled(count),
        };
        let took = began.elapsed();
        end.map(|()| took)
    }

    /// Scans of one program, with as little as possible between them.
    fn only(&mut self, count: u64, program: Due) -> Result<(), Error> {
        for _ in 0..count {
            self.write();
            let now = self.now;
            self.number += 1;
            self.now += program.period;
            self.scan(program, now)?;
        }
        Ok(())
    }

    fn scheduled(&mut self, count: u64) -> Result<(), Error> {
        for _ in 0..count {
            self.write();
            self.number += 1;
            self.now = self.schedule.next();
            self.schedule.advance(self.now, false);
            for at in 0..self.schedule.due().len() {
                self.scan(self.schedule.due()[at], self.now)?;
            }
        }
        Ok(())
    }

    #[inline]
    fn write(&mut self) {
        if self.lists > 0 {
            self.machine.apply(self.next);
            self.next = if self.next + 1 < self.lists { self.next + 1 } else { 0 };
        }
    }

    #[inline]
    fn scan(&mut self, Due { instance, period }: Due, now: Time) -> Result<(), Error> {
        let first_scan = std::mem::take(&mut self.fresh[instance]);
        let cx = Context::new(now, first_scan).with_turns(self.turns).with_cycle(period);
        let ran = self.machine.scan(instance, &cx);
        let reported = cx.minor_faults();
        if reported.count > 0 {
            self.minor_faults = self.minor_faults.and(reported);
        }
        ran.map_err(|fault| Error::Fault {
            fault,
            scan: self.number,
            instance: self.map.instances[instance].name.clone(),
            path: self.map.file(fault.at.file).to_owned(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture::{map, offset_of};

    unsafe extern "C" fn init(state: *mut u8) {
        // SAFETY: the machines below have the state of the fixture's map.
        unsafe { state.write_bytes(0, 128) }
    }

    unsafe extern "C" fn scan(_: *mut u8, _: *const Context, _: u32) -> u64 {
        0
    }

    unsafe extern "C" fn faulting(_: *mut u8, cx: *const Context, _: u32) -> u64 {
        // SAFETY: a machine gives it a context.
        if unsafe { (*cx).now() } >= 30_000_000 { 1 | 5 << 24 | 9 << 40 } else { 0 }
    }

    fn machine(scan: crate::Scan) -> Compiled {
        // SAFETY: the functions above stay within the state of the fixture's map.
        unsafe { Compiled::new(&map(), init, scan) }
    }

    #[test]
    fn a_given_number_of_scans_is_measured() {
        let options = BenchOptions { scans: Some(500), ..BenchOptions::default() };
        let timing = bench(&mut machine(scan), &map(), &options).unwrap();
        assert_eq!(timing.scans, 500);
        assert!(0.0 <= timing.min && timing.min <= timing.median && timing.median <= timing.p99, "{timing:?}");
        assert!(timing.overhead > 0.0, "{timing:?}");
    }

    #[test]
    fn a_timing_reads_back() {
        let timing = Timing { scans: 500, min: 1.5, median: 1.75, p99: 2.0, overhead: 2.5 };
        assert_eq!(timing.to_string(), "scans=500 ns_min=1.50 ns_median=1.75 ns_p99=2.00 ns_overhead=2.50");
        assert_eq!(timing.to_string().parse(), Ok(timing));
        assert_eq!("scans=500".parse::<Timing>(), Err(()));
    }

    #[test]
    fn a_fault_ends_it() {
        let error = bench(&mut machine(faulting), &map(), &BenchOptions::default()).unwrap_err();
        assert_eq!(error.exit_code(), 3);
    }

    /// The values of `up` that six scans see.
    fn seen(lists: &Lists) -> Vec<u8> {
        let mut machine = machine(scan);
        machine.prepare(lists);
        let mut see = |number: usize| {
            machine.apply(number % lists.len());
            machine.state()[offset_of("up")]
        };
        (0..6).map(&mut see).collect()
    }

    #[test]
    fn inputs_toggle_or_repeat() {
        let inputs = bool_inputs(&map(), &[0]);
        assert_eq!(inputs, [offset_of("up")]);
        assert_eq!(seen(&toggled(&inputs, &[0; 128])), [1, 0, 1, 0, 1, 0]);
        let stimulus = Stimulus::parse("s.csv".as_ref(), "scan,up\n1,1\n3,0\n", &map(), &[0]).unwrap();
        assert_eq!(seen(&repeated(&stimulus, &[0; 128])), [1, 1, 0, 1, 1, 0]);
    }

    #[test]
    #[should_panic(expected = "a part of a value")]
    fn only_whole_values_are_prepared() {
        machine(scan).prepare(&[vec![(offset_of("name"), vec![9])]]);
    }
}
