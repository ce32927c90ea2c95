//! A run in real time: when its scans begin, what it requests from the system, and how punctual the programs were.
//!
//! One thread runs all programs, without preemption: they share their variables, and none sees another in the middle of a
//! scan. Whenever a scan has ended, the program with the highest priority among those that are due is next.

mod figures;
mod histogram;
mod reporter;
mod system;
mod watchdog;

pub use figures::{Figures, Kept};
pub use histogram::Histogram;

use crate::map::Map;
use crate::schedule::{Schedule, Turn};
use crate::spoken::rounded;
use crate::{Error, signal};
use reporter::Reporter;
use staunch_runtime::Time;
use std::io;
use std::path::PathBuf;
use std::time::Duration;
use watchdog::Watchdog;

/// Settings of a run in real time.
#[derive(Clone, Debug, Default)]
pub struct Pacing {
    /// From 1 to [`HIGHEST_PRIORITY`](Self::HIGHEST_PRIORITY): the scans run before everything with a lower priority, with SCHED_FIFO and
    /// all memory locked. `None` is the priority of an ordinary process.
    pub priority: Option<u8>,
    /// The processor that the scans run on.
    pub cpu: Option<usize>,
    pub overrun: Overrun,
    /// If no scan ends for this long, in nanoseconds, the process ends.
    pub watchdog: Option<Time>,
    /// A device that restarts the machine if no scan ends, such as `/dev/watchdog`.
    pub watchdog_device: Option<PathBuf>,
}

impl Pacing {
    /// The watchdog's priority is one higher, and 99 is the highest of the system.
    pub const HIGHEST_PRIORITY: u8 = 98;

    /// Whether a setting is used that only a run in real time has.
    pub fn is_asked_for(&self) -> bool {
        let Self { priority, cpu, overrun, watchdog, watchdog_device } = self;
        let watched = watchdog.is_some() || watchdog_device.is_some();
        priority.is_some() || cpu.is_some() || *overrun != Overrun::default() || watched
    }
}

/// What happens after a scan that has not ended when the next one is due. It is counted in any case.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Overrun {
    /// The next scan begins at once, and scans for which a whole period has passed are skipped.
    #[default]
    Skip,
    /// All scans that are due follow at once.
    CatchUp,
    /// It ends the run, like a fault.
    Fault,
}

impl Overrun {
    pub const ALL: [(&'static str, Self); 3] =
        [("skip", Self::Skip), ("catch-up", Self::CatchUp), ("fault", Self::Fault)];

    /// What a user writes.
    pub fn parse(text: &str) -> Result<Self, String> {
        let found = Self::ALL.iter().find(|it| it.0 == text);
        found.map(|it| it.1).ok_or_else(|| format!("`{text}` is not a policy: write skip, catch-up or fault"))
    }
}

/// A signal may arrive just before a sleep, so none is longer than this.
const NAP: Duration = Duration::from_millis(50);

/// A run in real time in progress.
pub(crate) struct RealTime {
    /// What the clock showed at the program's time 0.
    start: Duration,
    overrun: Overrun,
    figures: Figures,
    /// The place of an instance's figures.
    places: Vec<usize>,
    reporter: Reporter,
    watchdog: Option<Watchdog>,
}

impl RealTime {
    /// `line` makes the text of figures that are asked for by SIGUSR1.
    pub fn start(map: &Map, schedule: &Schedule, pacing: &Pacing, line: fn(&Figures) -> String) -> Result<Self, Error> {
        let mut places = vec![0; map.instances.len()];
        let mut figures = Figures::default();
        for program in schedule.programs() {
            places[program.instance] = figures.programs.len();
            figures.programs.push(Kept::new(&map.instances[program.instance].name, program.period));
        }
        signal::listen();
        let reporter = Reporter::start(&figures, line).map_err(|it| Error::Usage(format!("no thread: {it}")))?;
        ask(pacing)?;
        let limit = watched(pacing, schedule)?;
        let device = pacing.watchdog_device.as_deref();
        let watchdog = Watchdog::start(limit, device, pacing.priority);
        let watchdog =
            watchdog.map_err(|error| Error::file(device.unwrap_or("the watchdog's thread".as_ref()), "open", error))?;
        Ok(Self { start: system::time(), overrun: pacing.overrun, figures, places, reporter, watchdog })
    }

    /// The program's time.
    pub fn now(&self) -> Time {
        let passed = system::time().saturating_sub(self.start);
        Time::try_from(passed.as_nanos()).unwrap_or(Time::MAX)
    }

    /// Sleeps until `due`, and returns the time that it is then; `None` when the user has asked for an end.
    pub fn wait(&self, due: Time) -> Option<Time> {
        let deadline = self.start + Duration::from_nanos(u64::try_from(due).unwrap_or(0));
        loop {
            if signal::asked_to_stop() {
                return None;
            }
            let now = system::time();
            if now >= deadline {
                return Some(self.now());
            }
            system::sleep_until(deadline.min(now + NAP));
        }
    }

    pub fn catches_up(&self) -> bool {
        self.overrun == Overrun::CatchUp
    }

    /// Counts a whole scan.
    pub fn add(&mut self, turn: &Turn, began: Time, ended: Time) -> Scanned {
        let kept = &mut self.figures.programs[self.places[turn.program.instance]];
        kept.missed += turn.missed;
        let overran = kept.add(turn.due, began, ended, turn.next);
        self.watchdog.iter().for_each(Watchdog::pet);
        if signal::asked_for_figures() && !self.reporter.print(&self.figures) {
            signal::ask_for_figures_again();
        }
        Scanned { faults: overran && self.overrun == Overrun::Fault, took: ended.saturating_sub(began) }
    }

    /// Ends the run, with its watchdog, and returns its result.
    pub fn end(self) -> Figures {
        self.figures
    }
}

/// The result of a scan.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Scanned {
    /// It took too long, and ends the run.
    pub faults: bool,
    pub took: Time,
}

/// Requests the settings from the system.
fn ask(pacing: &Pacing) -> Result<(), Error> {
    system::wake_on_time();
    if let Some(cpu) = pacing.cpu {
        let what = || format!("cannot run on processor {cpu} (--cpu)");
        system::pin(cpu).map_err(|error| Error::Usage(format!("{}: {error}; `nproc --all` counts them", what())))?;
    }
    if let Some(priority) = pacing.priority {
        system::lock_memory().map_err(|error| refused("lock memory", &error, "memlock unlimited"))?;
        system::touch_stack();
        let doing = format!("take the priority {priority}");
        system::take_priority(priority)
            .map_err(|error| refused(&doing, &error, &format!("rtprio {}", priority + 1)))?;
    }
    Ok(())
}

fn refused(doing: &str, error: &io::Error, limit: &str) -> Error {
    if error.kind() == io::ErrorKind::Unsupported {
        return Error::Usage(format!("cannot {doing} (--priority): only Linux has it"));
    }
    let name = std::env::current_exe().map_or_else(|_| "FILE".to_owned(), |it| it.display().to_string());
    Error::Usage(format!(
        "cannot {doing} (--priority): {error}\n  \
         help: allow it to this file: sudo setcap cap_sys_nice,cap_ipc_lock+ep {name}\n  \
         help: or to a user, by a line `USER - {limit}` in /etc/security/limits.conf and a new login\n  \
         help: or run it as a service: `staunch build --emit systemd` writes the unit"
    ))
}

/// A watchdog that is shorter than the programs' own periods would end every run.
fn watched(pacing: &Pacing, schedule: &Schedule) -> Result<Option<Duration>, Error> {
    let Some(limit) = pacing.watchdog else { return Ok(None) };
    let limit = Duration::from_nanos(u64::try_from(limit).unwrap_or(0));
    let period = Duration::from_nanos(u64::try_from(schedule.shortest_period()).unwrap_or(0));
    if limit <= period {
        let (limit, period) = (rounded(limit), rounded(period));
        return Err(Error::Usage(format!(
            "--watchdog {limit} is not longer than {period}, the time between two scans"
        )));
    }
    Ok(Some(limit))
}
