//! What a scan passes to all code that runs in it: its time, whether it is the first, the time between two scans, and the turns
//! (iterations) that its loops have left.

use crate::{FaultKind, Location, Time};
use core::cell::Cell;

/// What a scan knows about the outside world: the runtime has no clock of its own.
///
/// Native code reads this struct by offset, and hosts in C allocate it, so its layout is part of the ABI.
#[repr(C)]
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Context {
    now: Cell<Time>,
    /// TRUE in the first scan after a start, a restart, or a change from IDLE to RUN.
    pub first_scan: bool,
    /// The turns that the loops of this scan have left.
    turns: Cell<u64>,
    /// Nanoseconds between two scans of this program, as the host runs them; 0 if the host does not set it.
    pub cycle: Time,
    minor_faults: Cell<Noted>,
}

/// [`MinorFaults`] in C's layout. The place is that of the first fault, if any.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Noted {
    count: u64,
    line: u32,
    column: u16,
    file: u16,
}

impl Noted {
    const NONE: Self = Self { count: 0, line: 0, column: 0, file: 0 };

    fn and(self, at: Location) -> Self {
        let count = self.count.saturating_add(1);
        match self.count {
            0 => Self { count, line: at.line, column: at.column, file: at.file },
            _ => Self { count, ..self },
        }
    }
}

// The size that C allocates for it, where 64-bit numbers are aligned to their size.
const _: () =
    assert!(align_of::<u64>() < 8 || size_of::<Context>() == 48 && core::mem::offset_of!(Context, minor_faults) == 32);

/// Divisions by zero after which the program continues, as in Logix (a minor fault of type 4, code 4).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MinorFaults {
    pub count: u64,
    pub first: Option<Location>,
}

impl MinorFaults {
    /// These faults together with those of a later scan.
    #[must_use]
    pub fn and(self, later: Self) -> Self {
        Self { count: self.count.saturating_add(later.count), first: self.first.or(later.first) }
    }
}

impl Context {
    /// The turns that all loops of one scan have together, unless [`with_turns`](Self::with_turns) sets another number. Loops
    /// whose constants show that they end after few turns take none.
    pub const TURNS: u64 = 10_000_000;

    /// Where native code finds the turns that are left: a `u64`.
    pub const TURNS_OFFSET: usize = core::mem::offset_of!(Self, turns);

    /// Where native code finds the scan's time: an `i64`.
    pub const NOW_OFFSET: usize = core::mem::offset_of!(Self, now);

    /// A scan at `now` nanoseconds.
    pub const fn new(now: Time, first_scan: bool) -> Self {
        Self {
            now: Cell::new(now),
            first_scan,
            turns: Cell::new(Self::TURNS),
            cycle: 0,
            minor_faults: Cell::new(Noted::NONE),
        }
    }

    /// A scan at `now` nanoseconds that is not the first.
    pub const fn at(now: Time) -> Self {
        Self::new(now, false)
    }

    /// The first scan, at `now` nanoseconds.
    pub const fn first(now: Time) -> Self {
        Self::new(now, true)
    }

    /// Time since start at the beginning of this scan, in nanoseconds; it never decreases.
    #[inline]
    pub fn now(&self) -> Time {
        self.now.get()
    }

    /// Lets time pass within a scan, as only a unit test does; a negative time is ignored.
    pub fn advance(&self, time: Time) {
        self.now.set(self.now.get().saturating_add(time.max(0)));
    }

    /// This context with another number of turns for its loops.
    #[must_use]
    pub fn with_turns(self, turns: u64) -> Self {
        Self { turns: Cell::new(turns), ..self }
    }

    /// This context for a program that is scanned every `cycle` nanoseconds.
    #[must_use]
    pub fn with_cycle(self, cycle: Time) -> Self {
        Self { cycle, ..self }
    }

    /// Takes one turn of a loop.
    ///
    /// # Errors
    /// [`FaultKind::LoopBudget`] if none is left.
    #[inline]
    pub fn take_turn(&self) -> Result<(), FaultKind> {
        let left = self.turns.get();
        self.turns.set(left.wrapping_sub(1));
        if left == 0 { Err(FaultKind::LoopBudget) } else { Ok(()) }
    }

    /// Notes a fault after which the program continues.
    pub fn report_minor_fault(&self, at: Location) {
        self.minor_faults.set(self.minor_faults.get().and(at));
    }

    /// The minor faults of this scan.
    pub fn minor_faults(&self) -> MinorFaults {
        let Noted { count, line, column, file } = self.minor_faults.get();
        MinorFaults { count, first: (count > 0).then_some(Location { file, column, line }) }
    }

    #[inline]
    pub(crate) fn turns_left(&self) -> u64 {
        self.turns.get()
    }

    #[inline]
    pub(crate) fn set_turns(&self, left: u64) {
        self.turns.set(left);
    }
}

impl Default for Context {
    fn default() -> Self {
        Self::at(0)
    }
}
