//! A run: scan after scan, with what goes in and what comes out.

use crate::column::{columns, overlays};
use crate::json::quote;
use crate::map::Map;
use crate::messages::Messages;
use crate::minor::{minor_faults_json, minor_faults_note};
use crate::path::{nearest, same};
use crate::replace::{Role, keep_apart};
use crate::retain::{Ending, Pace, Retention};
use crate::schedule::Schedule;
use crate::start::{Event, Start};
use crate::stimulus::{Stimulus, Write};
use crate::trace::{self, Row, Subject, Table, Trace};
use crate::{Error, Machine, format_time, signal, terminal};
use staunch_runtime::{Context, MinorFaults, Time};
use std::io::{self, Write as _};
use std::path::PathBuf;
use std::time::{Duration, Instant};

/// Scans of a run that nothing else ends.
const DEFAULT_SCANS: u64 = 100;
/// The priority of a program without a TASK.
const LOWEST_PRIORITY: u32 = 65535;

/// A point of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Moment {
    Scan(u64),
    Time(Time),
}

impl Moment {
    fn is_after(self, scan: u64, time: Time) -> bool {
        match self {
            Self::Scan(it) => it > scan,
            Self::Time(it) => it > time,
        }
    }

    fn is_before(self, scan: u64, time: Time) -> bool {
        match self {
            Self::Scan(it) => it < scan,
            Self::Time(it) => it < time,
        }
    }
}

/// What to run and how. The default is 100 scans.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// An instance or a PROGRAM by name; all of them if the source has a CONFIGURATION.
    pub program: Option<String>,
    /// `None`: to [`to`](Self::to), else to the last row of the stimulus, or 100; in real time without a
    /// stimulus, for ever.
    pub scans: Option<u64>,
    /// Nanoseconds between two scans, above zero; 10 ms, or the TASKs' intervals.
    pub cycle: Option<Time>,
    /// Turns that the loops of one scan may take together; [`Context::TURNS`].
    pub loop_budget: Option<u64>,
    pub stimulus: Option<PathBuf>,
    /// CSV, VCD, SVG or HTML by its ending; `-` is standard output.
    pub trace: Option<PathBuf>,
    /// The first and the last scan of the trace or table.
    pub from: Option<Moment>,
    pub to: Option<Moment>,
    /// Variables to trace, separated by commas.
    pub vars: Option<String>,
    /// Numbers that a picture shows in one lane, each time two or three names separated by commas.
    pub overlay: Vec<String>,
    /// A file that keeps retained variables from run to run.
    pub retain: Option<PathBuf>,
    /// In real time, how soon a change of retained variables is on disk, in nanoseconds; 0 is after every
    /// scan. [`RETAIN_WITHIN`](Self::RETAIN_WITHIN) without.
    pub retain_within: Option<Time>,
    /// Waits for the time at which each scan is due.
    pub realtime: bool,
    /// Prints nothing but errors and the trace.
    pub quiet: bool,
    /// Prints the last scans as a table, unless a trace is written.
    pub table: bool,
    /// Prints the result of the run as JSON, in place of the table.
    pub json: bool,
}

impl Options {
    /// How soon a change of retained variables is on disk where nothing else is asked for: a second.
    pub const RETAIN_WITHIN: Time = 1_000_000_000;

    /// A large array has many columns: they are not made for nothing.
    fn shows_values(&self) -> bool {
        self.trace.is_some() || self.vars.is_some() || (self.table && !self.quiet && !self.json)
    }
}

impl Options {
    /// No file is read and written, or written twice.
    fn keep_apart(&self) -> Result<(), String> {
        // What runs is not a file to write either.
        let own = std::env::current_exe().ok();
        let own = own.iter().map(|it| ("the executable", it.as_path()));
        let inputs: Vec<Role<'_>> = self.stimulus.iter().map(|it| ("--stimulus", it.as_path())).chain(own).collect();
        let outputs = [("--retain", &self.retain), ("--trace", &self.trace)];
        let outputs: Vec<Role<'_>> =
            outputs.iter().filter_map(|(what, path)| Some((*what, path.as_deref()?))).collect();
        keep_apart(&inputs, &outputs)
    }

    /// Says on standard error what went wrong; with `json`, as an object where all objects go.
    pub fn report(&self, error: &Error) {
        match error {
            Error::ClosedPipe => {}
            error if self.json => drop(self.print_json(&error.json())),
            error => crate::error::tell(format_args!("error: {error}")),
        }
    }

    /// On standard output, unless a trace is written there.
    fn print_json(&self, object: &str) -> Result<(), Error> {
        let line = format!("{object}\n");
        let written = match self.trace.as_deref().is_some_and(|it| it.as_os_str() == "-") {
            true => io::stderr().write_all(line.as_bytes()),
            false => io::stdout().write_all(line.as_bytes()).and_then(|()| io::stdout().flush()),
        };
        written.map_err(|error| Error::file("standard output".as_ref(), "write", error))
    }
}

impl Summary {
    /// Times in nanoseconds.
    fn json(&self, title: &str, lost: u64) -> String {
        let Self { scans, time, elapsed, real } = self;
        let mut text = format!(
            "{{\"reason\":\"run\",\"program\":{},\"scans\":{scans},\"time_ns\":{time},\"elapsed_ns\":{}",
            quote(title),
            elapsed.as_nanos()
        );
        if let Some(RealTime { overruns, shortest, longest, .. }) = real {
            // If nothing ran, no scan is the shortest.
            let shortest = if *shortest == Duration::MAX { 0 } else { shortest.as_nanos() };
            let longest = longest.as_nanos();
            text += &format!(",\"overruns\":{overruns},\"shortest_ns\":{shortest},\"longest_ns\":{longest}");
        }
        if lost > 0 {
            text += &format!(",\"rows_lost\":{lost}");
        }
        text + "}"
    }
}

/// The result of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Summary {
    pub scans: u64,
    /// On the clock of the program, in nanoseconds, to the end of the last cycle.
    pub time: Time,
    /// How long the run took.
    pub elapsed: Duration,
    /// Of a run in real time.
    pub real: Option<RealTime>,
}

/// How well a run kept the real time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RealTime {
    /// Scans that began late because the one before took too long.
    pub overruns: u64,
    pub shortest: Duration,
    pub longest: Duration,
    pub total: Duration,
}

/// Runs a program from its initial state: what `staunch run` does.
///
/// The trace holds the rows before a fault, and retained variables are saved whatever happens.
pub fn run(machine: &mut dyn Machine, map: &Map, options: &Options) -> Result<Summary, Error> {
    let running = running(map, options.program.as_deref())?;
    if options.cycle.is_some_and(|it| it <= 0) {
        return Err(Error::Usage("the cycle must be a time above zero".to_owned()));
    }
    options.trace.as_deref().map_or(Ok(()), trace::check_name)?;
    options.keep_apart().map_err(Error::Usage)?;
    let stimulus = options.stimulus.as_deref().map(|path| Stimulus::read(path, map, &running)).transpose()?;
    let columns = match options.shows_values() {
        true => columns(map, &running, options.vars.as_deref()).map_err(|it| Error::Usage(format!("--vars: {it}")))?,
        false => Vec::new(),
    };
    let schedule = Schedule::new(map, &running, options.cycle);
    let overlays = match options.overlay.is_empty() || options.trace.as_deref().is_some_and(trace::is_picture) {
        true => overlays(&columns, &options.overlay),
        false => Err("it is only for a picture: write --trace OUT.svg".to_owned()),
    };
    let overlays = overlays.map_err(|it| Error::Usage(format!("--overlay: {it}")))?;
    let subject = Subject { map, columns, overlays, title: title(map, &running), cycle: schedule.shortest_period() };
    let mut runner = Runner {
        machine,
        map,
        options,
        schedule,
        stimulus: stimulus.unwrap_or_default(),
        next_row: 0,
        held: Vec::new(),
        fresh: vec![true; map.instances.len()],
        retention: None,
        start: Start::of(map),
        messages: Messages::of(map),
        epoch: 0,
        out: Output { rows: 0, lost: 0, trace: None, table: Table::new(terminal::width()) },
        clock: None,
        summary: Summary::default(),
        minor_faults: MinorFaults::default(),
    };
    runner.start()?;
    if let Some(path) = &options.trace {
        let trace = Trace::create(path, &subject, options.realtime);
        runner.out.trace = runner.needed(trace)?;
    }
    let ran = runner.scans(&subject);
    let finished = runner.finish(&subject, &ran);
    let told = runner.tell_minor_faults();
    runner.needed(told)?;
    ran.and(finished)?;
    if options.json {
        let printed = options.print_json(&runner.summary.json(&subject.title, runner.out.lost));
        runner.needed(printed)?;
    }
    Ok(runner.summary)
}

/// The instances to run, by their numbers.
pub(crate) fn running(map: &Map, program: Option<&str>) -> Result<Vec<usize>, Error> {
    let all = 0..map.instances.len();
    let names = || map.instances.iter().flat_map(|it| [it.name.as_str(), it.program.as_str()]);
    let Some(wanted) = program else {
        if map.instances.is_empty() {
            return Err(Error::Usage("there is no PROGRAM to run".to_owned()));
        }
        let unconfigured = |at: usize| {
            let it = &map.instances[at];
            it.interval.is_none() && it.priority == LOWEST_PRIORITY && it.name == it.program
        };
        if all.len() > 1 && all.clone().all(unconfigured) {
            let names: Vec<String> = map.instances.iter().map(|it| format!("`{}`", it.name)).collect();
            let text =
                format!("no CONFIGURATION says which PROGRAM runs: pick one with --program: {}", names.join(", "));
            return Err(Error::Usage(text));
        }
        return Ok(all.collect());
    };
    if let Some(at) = all.clone().find(|at| same(&map.instances[*at].name, wanted)) {
        return Ok(vec![at]);
    }
    let found: Vec<usize> = all.filter(|at| same(&map.instances[*at].program, wanted)).collect();
    match found.is_empty() {
        true => Err(Error::Usage(format!("there is no PROGRAM `{wanted}`{}", nearest(wanted, names())))),
        false => Ok(found),
    }
}

pub(crate) fn title(map: &Map, running: &[usize]) -> String {
    let mut names: Vec<&str> = running.iter().map(|at| map.instances[*at].program.as_str()).collect();
    names.dedup();
    names.join(", ")
}

struct Runner<'a> {
    machine: &'a mut dyn Machine,
    map: &'a Map,
    options: &'a Options,
    schedule: Schedule,
    stimulus: Stimulus,
    /// The next row of the stimulus.
    next_row: usize,
    /// What the stimulus wrote to inputs: they hold over a restart.
    held: Vec<Write>,
    /// Instances that have not run since the start.
    fresh: Vec<bool>,
    retention: Option<Retention>,
    start: Start,
    messages: Messages,
    /// The program's clock at this run's time 0: a retained timer continues where it stopped.
    epoch: Time,
    out: Output,
    clock: Option<Clock>,
    summary: Summary,
    minor_faults: MinorFaults,
}

struct Output {
    /// Rows within the window that is shown.
    rows: u64,
    /// Of these, how many a trace that cannot be written lacks.
    lost: u64,
    trace: Option<Trace>,
    table: Table,
}

impl Runner<'_> {
    fn start(&mut self) -> Result<(), Error> {
        self.machine.init();
        if let Some(path) = &self.options.retain {
            let (retention, loaded) = Retention::load(self.map, path, self.machine)?;
            for note in loaded.notes {
                crate::error::tell(format_args!("note: {}: {note}", path.display()));
            }
            self.epoch = loaded.clock;
            self.retention = Some(retention);
        }
        Ok(())
    }

    fn scans(&mut self, subject: &Subject<'_>) -> Result<(), Error> {
        let began = Instant::now();
        if self.options.realtime {
            signal::listen();
            if let Some(retention) = &mut self.retention {
                let within = self.options.retain_within.unwrap_or(Options::RETAIN_WITHIN);
                let pace = Pace::within(Duration::from_nanos(u64::try_from(within).unwrap_or(0)));
                retention.save_always(pace)?;
            }
            self.clock = Some(Clock::start());
        }
        if self.options.scans == Some(0) {
            self.record(subject, 0)?;
        }
        let mut before = None;
        let mut ran = Ok(());
        while ran.is_ok() && !self.is_done() {
            match self.scan(subject, before) {
                Ok(Some(now)) => before = Some(now),
                Ok(None) => break,
                Err(error) => ran = Err(error),
            }
        }
        self.summary.elapsed = began.elapsed();
        self.summary.time = if self.summary.scans == 0 { 0 } else { self.schedule.next() };
        self.summary.real = self.clock.as_ref().map(|it| it.figures);
        ran
    }

    fn is_done(&self) -> bool {
        match self.options.scans {
            Some(scans) => self.summary.scans >= scans,
            None if self.options.to.is_some() => self.is_past_the_window(self.summary.scans + 1, self.schedule.next()),
            None if !self.stimulus.rows.is_empty() => self.next_row >= self.stimulus.rows.len(),
            None => !self.options.realtime && self.summary.scans >= DEFAULT_SCANS,
        }
    }

    fn is_past_the_window(&self, scan: u64, time: Time) -> bool {
        self.options.to.is_some_and(|it| it.is_before(scan, time))
    }

    /// Runs the next scan and returns its time; `None` when the user has asked for an end.
    fn scan(&mut self, subject: &Subject<'_>, before: Option<Time>) -> Result<Option<Time>, Error> {
        let number = self.summary.scans + 1;
        let placed = self.stimulus.placed(self.next_row, number, before)?;
        let mut now = placed.unwrap_or_else(|| self.schedule.next());
        if let Some(clock) = &mut self.clock {
            match clock.wait(now) {
                Some(actual) => now = actual,
                None => return Ok(None),
            }
        }
        self.stimulate(number, now)?;
        let began = self.clock.as_ref().map(|_| Instant::now());
        let mut ran = Ok(());
        self.schedule.advance(now, placed.is_some());
        for instance in self.schedule.due() {
            let first_scan = std::mem::take(&mut self.fresh[*instance]);
            let turns = self.options.loop_budget.unwrap_or(Context::TURNS);
            let cx = Context::new(self.epoch.saturating_add(now), first_scan).with_turns(turns);
            let cx = cx.with_cycle(self.schedule.period(*instance));
            ran = self.machine.scan(*instance, &cx).map_err(|fault| Error::Fault {
                fault,
                scan: number,
                instance: self.map.instances[*instance].name.clone(),
                path: self.map.file(fault.at.file).to_owned(),
            });
            self.minor_faults = self.minor_faults.and(cx.minor_faults());
            if ran.is_err() {
                break;
            }
        }
        self.tell(number)?;
        ran?;
        if let (Some(clock), Some(began)) = (&mut self.clock, began) {
            clock.figures.add(began.elapsed());
        }
        self.summary.scans = number;
        let clock = self.saved_clock();
        if let Some(retention) = &mut self.retention {
            retention.offer(clock, self.machine.state());
        }
        self.record(subject, now)?;
        Ok(Some(now))
    }

    /// Says how often the program has divided by zero and continued, and where first.
    fn tell_minor_faults(&self) -> Result<(), Error> {
        if self.options.json {
            let told = minor_faults_json(self.minor_faults, self.map);
            return told.map_or(Ok(()), |it| self.options.print_json(&it));
        }
        if let Some(note) = minor_faults_note(self.minor_faults, self.map).filter(|_| !self.options.quiet) {
            crate::error::tell(format_args!("{note}"));
        }
        Ok(())
    }

    /// What an output came to. A run in real time controls a machine: it continues without an output that cannot be
    /// written, and says so.
    fn needed<T>(&self, written: Result<T, Error>) -> Result<Option<T>, Error> {
        match written {
            Ok(it) => Ok(Some(it)),
            Err(error) if self.options.realtime => {
                crate::error::tell(format_args!("warning: {error}; the program continues without it"));
                Ok(None)
            }
            Err(error) => Err(error),
        }
    }

    /// Says on standard error, or as JSON, what the program has logged.
    fn tell(&mut self, scan: u64) -> Result<(), Error> {
        for message in self.messages.take(self.map, self.machine.state()) {
            if self.options.json {
                let printed = self.options.print_json(&message.json(scan));
                // In real time, users who do not read objects get a warning at the end.
                if !self.options.realtime {
                    printed?
                }
            } else if !self.options.quiet {
                crate::error::tell(message.line(scan));
            }
        }
        Ok(())
    }

    /// Events and values that come before scan `number`.
    fn stimulate(&mut self, number: u64, now: Time) -> Result<(), Error> {
        while self.stimulus.acts(self.next_row, number, now) {
            if let Some(event) = self.stimulus.rows[self.next_row].event {
                self.start_again(event)?;
            }
            for write in &self.stimulus.rows[self.next_row].writes {
                let bytes = write.over(self.machine.state()).into_owned();
                self.machine.write(write.offset, &bytes);
                if write.input {
                    self.held.retain(|it| !it.replaces(write));
                    self.held.push(write.clone());
                }
            }
            self.next_row += 1;
        }
        Ok(())
    }

    /// What the event keeps stays as it is, and so do inputs.
    fn start_again(&mut self, event: Event) -> Result<(), Error> {
        let clock = self.saved_clock();
        if let (Event::Restart, Some(retention)) = (event, &mut self.retention) {
            retention.save(clock, self.machine.state())?;
        }
        self.start.again(event, self.machine);
        for it in &self.held {
            let bytes = it.over(self.machine.state()).into_owned();
            self.machine.write(it.offset, &bytes);
        }
        self.fresh.fill(true);
        self.machine.starts_again(event);
        Ok(())
    }

    /// The program's clock as it is kept with retained variables.
    fn saved_clock(&self) -> Time {
        let ran = if self.summary.scans == 0 { 0 } else { self.schedule.next() };
        self.epoch.saturating_add(ran)
    }

    fn record(&mut self, subject: &Subject<'_>, now: Time) -> Result<(), Error> {
        let scan = self.summary.scans;
        if self.options.from.is_some_and(|it| it.is_after(scan, now)) || self.is_past_the_window(scan, now) {
            return Ok(());
        }
        self.out.rows += 1;
        let row = Row { scan: self.summary.scans, time: now, state: self.machine.state() };
        match &mut self.out.trace {
            Some(trace) if self.options.realtime => {
                let written = trace.row(subject, row).and_then(|()| trace.flush());
                if self.needed(written)?.is_none() {
                    self.out.trace = None;
                    self.out.lost += 1;
                }
                Ok(())
            }
            Some(trace) => trace.row(subject, row),
            None if self.options.trace.is_some() => {
                self.out.lost += 1;
                Ok(())
            }
            None => {
                if self.options.table {
                    self.out.table.row(subject, row);
                }
                Ok(())
            }
        }
    }

    fn finish(&mut self, subject: &Subject<'_>, ran: &Result<(), Error>) -> Result<(), Error> {
        let text = ran.as_ref().err().map(Error::to_string);
        let ending = match (ran, &text) {
            (Err(Error::Fault { .. }), Some(text)) => Ending::Fault(text),
            (Err(_), _) => Ending::Early,
            (Ok(()), _) => Ending::Well,
        };
        let saved = self.retention.as_mut().map_or(Ok(()), |it| it.finish(ending));
        if self.out.rows == 0 && (self.options.from.is_some() || self.options.to.is_some()) {
            crate::error::tell(format_args!("note: no scan is between --from and --to"));
        }
        let written = self.show(subject);
        let written = self.needed(written).map(drop);
        if let (Some(path), lost @ 1..) = (&self.options.trace, self.out.lost) {
            let plural = if lost == 1 { "" } else { "s" };
            crate::error::tell(format_args!("warning: {}: {lost} row{plural} could not be written", path.display()));
        }
        written.and(saved)
    }

    fn show(&mut self, subject: &Subject<'_>) -> Result<(), Error> {
        match &mut self.out.trace {
            Some(trace) => trace.finish(subject),
            None if self.options.quiet || self.options.json || self.options.trace.is_some() => Ok(()),
            None => {
                let mut text = Vec::new();
                let printed = self.out.table.print(subject, &mut text).and_then(|()| self.totals(subject, &mut text));
                let printed = printed.and_then(|()| io::stdout().write_all(&text)).and_then(|()| io::stdout().flush());
                printed.map_err(|error| Error::file("standard output".as_ref(), "write", error))
            }
        }
    }

    fn totals(&self, subject: &Subject<'_>, out: &mut dyn io::Write) -> io::Result<()> {
        let Summary { scans, time, elapsed, real } = self.summary;
        let plural = if scans == 1 { "" } else { "s" };
        write!(out, "{scans} scan{plural} of {}, ", subject.title)?;
        let Some(real) = real else {
            return writeln!(out, "{} of virtual time, in {}", spoken(time), rounded(elapsed));
        };
        let mean = real.total.checked_div(u32::try_from(scans).unwrap_or(u32::MAX)).unwrap_or_default();
        let (min, mean, max) = (rounded(real.shortest), rounded(mean), rounded(real.longest));
        let plural = if real.overruns == 1 { "" } else { "s" };
        write!(
            out,
            "{} in real time, {} overrun{plural}; a scan took at least {min}, ",
            rounded(elapsed),
            real.overruns
        )?;
        writeln!(out, "{mean} on average, at most {max}")
    }
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
fn rounded(duration: Duration) -> String {
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

/// The real time since the start of the run.
struct Clock {
    start: Instant,
    figures: RealTime,
    has_run: bool,
}

/// A signal cannot end a sleep, so none is longer than this.
const NAP: Duration = Duration::from_millis(50);

impl Clock {
    fn start() -> Self {
        let figures = RealTime { overruns: 0, shortest: Duration::MAX, longest: Duration::ZERO, total: Duration::ZERO };
        Self { start: Instant::now(), figures, has_run: false }
    }

    /// Sleeps until `time`. Returns the time at which the scan begins, later than that after an
    /// overrun; `None` when the user has asked for an end.
    fn wait(&mut self, time: Time) -> Option<Time> {
        let due = self.start + Duration::from_nanos(u64::try_from(time).unwrap_or(0));
        let mut slept = false;
        loop {
            if signal::asked_to_stop() {
                return None;
            }
            let left = due.saturating_duration_since(Instant::now());
            if left.is_zero() {
                break;
            }
            slept = true;
            std::thread::sleep(left.min(NAP));
        }
        let late = !slept && std::mem::replace(&mut self.has_run, true);
        self.has_run = true;
        if !late {
            return Some(time);
        }
        self.figures.overruns += 1;
        Some(time.max(Time::try_from(self.start.elapsed().as_nanos()).unwrap_or(Time::MAX)))
    }
}

impl RealTime {
    fn add(&mut self, scan: Duration) {
        self.shortest = self.shortest.min(scan);
        self.longest = self.longest.max(scan);
        self.total += scan;
    }
}

#[cfg(test)]
mod tests;
