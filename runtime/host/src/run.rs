//! A run: scan after scan, with what goes in and what comes out.

mod around;
mod aside;
pub(crate) mod options;
mod ring;
mod summary;

pub use options::{Moment, Options};
pub use summary::Summary;

use around::{AROUND, Programs, Scan, Step};
use aside::Aside;

use crate::attachments::{Attachments, Ended};
use crate::column::{columns, overlays};
use crate::force::Forces;
use crate::map::Map;
use crate::messages::Messages;
use crate::minor::{minor_faults_json, minor_faults_note};
use crate::path::{nearest, same};
use crate::realtime::{RealTime, Scanned};
use crate::retain::{Ending, Pace, Retention};
use crate::schedule::{Due, Schedule};
use crate::start::{Event, Start};
use crate::stimulus::Stimulus;
use crate::trace::{self, Row, Subject, Table, Trace};
use crate::{Error, Machine, terminal};
use staunch_runtime::{Context, MinorFaults, Time};
use std::io::{self, Write as _};
use std::time::{Duration, Instant};

/// Scans of a run that nothing else ends.
const DEFAULT_SCANS: u64 = 100;
/// The priority of a program without a TASK.
const LOWEST_PRIORITY: u32 = 65535;

/// Runs a program from its initial state: what `staunch run` does.
///
/// The trace holds the rows before a fault, and retained variables are saved whatever happens.
pub fn run(machine: &mut dyn Machine, map: &Map, options: &Options) -> Result<Summary, Error> {
    let running = running(map, options.program.as_deref())?;
    if options.cycle.is_some_and(|it| it <= 0) {
        return Err(Error::Usage("the cycle must be a time above zero".to_owned()));
    }
    let is_connected = !options.io.connections.is_empty();
    if (options.pacing.is_asked_for() || is_connected) && !options.realtime {
        let text = "--priority, --cpu, --overrun, --watchdog and --io are for a run in real time: add --realtime";
        return Err(Error::Usage(text.to_owned()));
    }
    options.trace.as_deref().map_or(Ok(()), trace::check_name)?;
    options.keep_apart().map_err(Error::Usage)?;
    let stimulus = options.stimulus.as_deref().map(|path| Stimulus::read(path, map, &running)).transpose()?;
    let forces = Forces::parse(map, &running, &options.forces)?;
    if let Some(note) = forces.note().filter(|_| !options.quiet) {
        crate::error::tell(format_args!("{note}"));
    }
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
    let stimulus = stimulus.unwrap_or_default();
    let held = Vec::with_capacity(stimulus.columns);
    let mut runner = Runner {
        machine,
        map,
        options,
        schedule,
        stimulus,
        next_row: 0,
        held,
        forces,
        fresh: vec![true; map.instances.len()],
        retention: None,
        start: Start::of(map),
        messages: Messages::of(map),
        epoch: 0,
        out: Output { rows: 0, lost: 0, trace: None, aside: None, table: Table::new(&subject, terminal::width()) },
        real: None,
        attachments: None,
        alone: None,
        summary: Summary::default(),
        has_begun: false,
        minor_faults: MinorFaults::default(),
    };
    runner.start()?;
    if let Some(path) = options.trace.as_ref().filter(|_| !options.realtime) {
        runner.out.trace = Some(Trace::create(path, &subject, false)?);
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
    /// What the stimulus wrote to inputs, by row and place in it: they hold over a restart.
    held: Vec<(usize, usize)>,
    forces: Forces,
    /// Instances that have not run since the start.
    fresh: Vec<bool>,
    retention: Option<Retention>,
    start: Start,
    messages: Messages,
    /// The program's clock at this run's time 0: a retained timer continues where it stopped.
    epoch: Time,
    out: Output,
    real: Option<RealTime>,
    /// Where inputs and outputs are connected with something.
    attachments: Option<Attachments>,
    /// The program that has nothing around its scans.
    alone: Option<Due>,
    summary: Summary,
    /// All that a run needs was there.
    has_begun: bool,
    minor_faults: MinorFaults,
}

struct Output {
    /// Rows within the window that is shown.
    rows: u64,
    /// Of these, how many a trace that cannot be written lacks.
    lost: u64,
    /// On the virtual clock.
    trace: Option<Trace>,
    /// In real time, the trace and what the program logs.
    aside: Option<Aside>,
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
            if let Some(retention) = &mut self.retention {
                let within = self.options.retain_within.unwrap_or(Options::RETAIN_WITHIN);
                let pace = Pace::within(Duration::from_nanos(u64::try_from(within).unwrap_or(0)));
                retention.save_always(pace)?;
            }
            // Before a priority is taken: their threads are to have none.
            self.attach()?;
            self.out.aside = Aside::start(subject, self.options, self.machine.state())?;
            let line = if self.options.json { summary::figures_json } else { summary::figures_text };
            self.real = Some(RealTime::start(self.map, &self.schedule, &self.options.pacing, line)?);
        }
        self.has_begun = true;
        if self.options.scans == Some(0) {
            self.record(subject, 0)?;
        }
        self.alone = self.alone();
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
        self.detach(&ran);
        self.summary.real = self.real.take().map(RealTime::end);
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
        if let Some(program) = self.alone {
            let now = self.schedule.next();
            self.schedule.step();
            self.program(program, number, now)?;
            self.summary.scans = number;
            return Ok(Some(now));
        }
        let placed = self.stimulus.placed(self.next_row, number, before)?;
        let due = placed.unwrap_or_else(|| self.schedule.next());
        if self.real.is_some() {
            return self.real_scan(subject, number, due, placed.is_some());
        }
        self.around(
            subject,
            &mut Scan { number, time: due, ended: due, programs: Programs::Due { placed: placed.is_some() } },
        )?;
        let ends = self.options.debugged && self.machine.ends();
        Ok((!ends).then_some(due))
    }

    /// In real time, one program runs at a time: its scan sees when it really begins.
    fn real_scan(
        &mut self,
        subject: &Subject<'_>,
        number: u64,
        due: Time,
        placed: bool,
    ) -> Result<Option<Time>, Error> {
        let Some(real) = &self.real else { return Ok(None) };
        let Some(now) = real.wait(due) else { return Ok(None) };
        let Some(turn) = self.schedule.pick(now, placed, real.catches_up()) else { return Ok(None) };
        let mut scan = Scan { number, time: now, ended: now, programs: Programs::One(turn.program) };
        self.around(subject, &mut scan)?;
        let Scan { time: began, ended, .. } = scan;
        match self.real.as_mut().map(|it| it.add(&turn, began, ended)) {
            Some(Scanned { faults: true, took }) => Err(Error::Overrun {
                scan: number,
                instance: self.map.instances[turn.program.instance].name.clone(),
                late: began - turn.due,
                took,
                period: turn.program.period,
            }),
            _ => Ok(Some(began)),
        }
    }

    /// A scan, with what is around it.
    fn around(&mut self, subject: &Subject<'_>, scan: &mut Scan) -> Result<(), Error> {
        let mut ran = Ok(());
        for step in AROUND {
            match step {
                Step::Programs => ran = self.programs(scan),
                _ if ran.is_err() && !step.is_after_a_fault() => {}
                _ => self.step(step, subject, scan)?,
            }
        }
        ran
    }

    /// What comes before and after the programs.
    #[inline]
    fn step(&mut self, step: Step, subject: &Subject<'_>, scan: &Scan) -> Result<(), Error> {
        match step {
            Step::Stimulus => self.stimulate(scan.number, scan.time)?,
            Step::Inputs => self.inputs()?,
            Step::Programs => {}
            Step::Outputs => self.attachments.iter_mut().for_each(|it| it.after(self.machine.state())),
            Step::Messages => self.tell(scan.number)?,
            Step::Retained => self.keep(scan.number),
            Step::Trace => self.record(subject, scan.time)?,
        }
        Ok(())
    }

    /// What the world outside writes; an input of the stimulus is not the world's.
    fn inputs(&mut self) -> Result<(), Error> {
        let Some(attachments) = &mut self.attachments else { return Ok(()) };
        attachments.before(self.machine)?;
        self.hold();
        Ok(())
    }

    /// The scan was whole: what is retained is that of now.
    fn keep(&mut self, number: u64) {
        self.summary.scans = number;
        if self.retention.is_some() {
            let clock = self.saved_clock();
            self.retention.iter_mut().for_each(|it| it.offer(clock, self.machine.state()));
        }
    }

    fn now(&self) -> Time {
        self.real.as_ref().map_or(0, RealTime::now)
    }

    fn attach(&mut self) -> Result<(), Error> {
        if !self.options.io.connections.is_empty() || self.map.is_connected() {
            let (state, quiet) = (self.machine.state(), self.options.quiet);
            self.attachments = Some(Attachments::start(self.map, &self.options.io, state, quiet)?);
        }
        Ok(())
    }

    /// Outputs take their safe values.
    fn detach(&mut self, ran: &Result<(), Error>) {
        let faulted = matches!(ran, Err(Error::Fault { .. } | Error::Overrun { .. } | Error::Connection { .. }));
        let ended = if faulted { Ended::Fault } else { Ended::Well };
        self.attachments.iter_mut().for_each(|it| it.end(ended));
    }

    /// The programs of a scan: on the virtual clock all that are due, in real time one, of which it is seen when it began and ended.
    fn programs(&mut self, scan: &mut Scan) -> Result<(), Error> {
        match scan.programs {
            Programs::One(program) => {
                scan.time = self.now();
                let ran = self.forced(program, scan.number, scan.time);
                scan.ended = self.now();
                ran
            }
            Programs::Due { placed } => {
                if self.options.debugged {
                    self.machine.scan_begins(scan.number, scan.time);
                }
                self.schedule.advance(scan.time, placed);
                (0..self.schedule.due().len())
                    .try_for_each(|at| self.forced(self.schedule.due()[at], scan.number, scan.time))
            }
        }
    }

    /// What others than the program see of a forced variable is its value, and so does the program at first.
    fn forced(&mut self, due: Due, number: u64, now: Time) -> Result<(), Error> {
        self.forces.put(self.machine);
        self.program(due, number, now)?;
        self.forces.put(self.machine);
        Ok(())
    }

    #[inline]
    fn program(&mut self, Due { instance, period }: Due, number: u64, now: Time) -> Result<(), Error> {
        let first_scan = std::mem::take(&mut self.fresh[instance]);
        let turns = self.options.loop_budget.unwrap_or(Context::TURNS);
        let cx = Context::new(self.epoch.saturating_add(now), first_scan).with_turns(turns).with_cycle(period);
        let ran = self.machine.scan(instance, &cx);
        let minor = cx.minor_faults();
        if minor.count > 0 {
            self.minor_faults = self.minor_faults.and(minor);
        }
        ran.map_err(|fault| Error::Fault {
            fault,
            scan: number,
            instance: self.map.instances[instance].name.clone(),
            path: self.map.file(fault.at.file).to_owned(),
        })
    }

    /// The only program, where nothing comes before or after its scans: it runs as fast as it can.
    fn alone(&self) -> Option<Due> {
        let Options { from, to, trace, .. } = self.options;
        let is_shown = trace.is_some() || self.options.has_table() || from.is_some() || to.is_some();
        let is_kept = self.real.is_some() || self.retention.is_some();
        let has_input = !self.stimulus.rows.is_empty() || !self.forces.is_empty();
        let is_kept = is_kept || self.options.debugged;
        self.schedule.only().filter(|_| !is_shown && !is_kept && !has_input && !self.messages.is_there)
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
        if self.real.is_some() {
            self.out.aside.iter_mut().for_each(|it| it.messages(scan, self.machine.state()));
            return Ok(());
        }
        self.messages.take(self.map, self.machine.state()).iter().try_for_each(|it| it.tell(scan, self.options))
    }

    /// Events and values that come before scan `number`.
    fn stimulate(&mut self, number: u64, now: Time) -> Result<(), Error> {
        while self.stimulus.acts(self.next_row, number, now) {
            if let Some(event) = self.stimulus.rows[self.next_row].event {
                self.start_again(event)?;
            }
            for (at, write) in self.stimulus.rows[self.next_row].writes.iter().enumerate() {
                write.put(self.machine);
                if write.input {
                    let rows = &self.stimulus.rows;
                    self.held.retain(|(row, at)| !rows[*row].writes[*at].replaces(write));
                    self.held.push((self.next_row, at));
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
        self.hold();
        self.fresh.fill(true);
        self.machine.starts_again(event);
        Ok(())
    }

    /// Inputs are as the stimulus has them.
    fn hold(&mut self) {
        for (row, at) in &self.held {
            self.stimulus.rows[*row].writes[*at].put(self.machine);
        }
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
        if let Some(aside) = &mut self.out.aside {
            aside.row(row);
        }
        match &mut self.out.trace {
            Some(trace) => trace.row(subject, row)?,
            None if self.options.has_table() => self.out.table.row(row),
            None => {}
        }
        Ok(())
    }

    fn finish(&mut self, subject: &Subject<'_>, ran: &Result<(), Error>) -> Result<(), Error> {
        let text = ran.as_ref().err().map(Error::to_string);
        let ending = match (ran, &text) {
            (Err(Error::Fault { .. } | Error::Overrun { .. } | Error::Connection { .. }), Some(text)) => {
                Ending::Fault(text)
            }
            (Err(_), _) => Ending::Early,
            (Ok(()), _) => Ending::Well,
        };
        let saved = self.retention.as_mut().map_or(Ok(()), |it| it.finish(ending));
        if self.out.rows == 0 && (self.options.from.is_some() || self.options.to.is_some()) {
            crate::error::tell(format_args!("note: no scan is between --from and --to"));
        }
        self.out.lost += self.out.aside.take().map_or(0, Aside::finish);
        let written = self.show(subject);
        let written = self.needed(written).map(|_| ());
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
            // It has not begun: an error says why.
            None if !self.has_begun => Ok(()),
            None => {
                let mut text = Vec::new();
                let printed = self.out.table.print(subject, &mut text);
                text.extend_from_slice(self.summary.text(&subject.title).as_bytes());
                let printed = printed.and_then(|()| io::stdout().write_all(&text)).and_then(|()| io::stdout().flush());
                printed.map_err(|error| Error::file("standard output".as_ref(), "write", error))
            }
        }
    }
}

#[cfg(test)]
mod tests;
