//! The reference interpreter: runs a program over the bytes of its state, with the runtime's own
//! operations and blocks. Every back end must do the same.

pub mod debug;
mod exchange;
mod execute;
mod follow;
mod loops;
mod place;

use crate::layout::{Layout, usize_of};
use crate::stop;
use crate::{Location, Place, Program, Routine, RoutineId, Value, reference};
use core::fmt;
use exchange::Exchange;
use place::Scope;
use staunch_runtime::{BlockInfo, Context, Fault};

/// Why a scan ended early.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stop {
    /// What every executor reports.
    Fault(Fault),
    /// The scan used up the steps of [`Interpreter::set_budget`].
    OutOfSteps,
}

impl Stop {
    fn of_call(self, at: Location) -> Self {
        match self {
            Self::Fault(fault) => Self::Fault(fault.of_call(at)),
            Self::OutOfSteps => self,
        }
    }
}

/// One running program.
#[derive(Debug)]
pub struct Interpreter<'p, W = ()> {
    program: &'p Program,
    layout: Layout,
    frames: Vec<FrameImage>,
    initial: Vec<u8>,
    /// The words of the table by which accesses through references are checked.
    table: Vec<u32>,
    /// The state, and after it the locals of the routines that are running, callee after caller.
    memory: Vec<u8>,
    /// Where the by-reference parameters of the running routines refer to: offsets in `memory`.
    references: Vec<usize>,
    /// The inputs of a standard block between their evaluation and the call.
    inputs: Vec<Value>,
    /// Whether the loop that is running takes no turns.
    has_few_turns: bool,
    budget: Option<u64>,
    steps_left: Option<u64>,
    exchange: Option<Exchange>,
    watch: W,
}

/// What watches a run. It is a type parameter of the interpreter, so that a run that nobody watches has none of this in its
/// code: `()` watches nothing.
pub trait Watch: Sized {
    /// A routine begins, which was called at a place.
    fn enter(&mut self, frame: &Frame, called_at: Location);

    /// How many routines are running.
    fn depth(&self) -> usize;

    /// Routines end until so many are running.
    fn leave(&mut self, depth: usize);

    /// The run is at a stop.
    fn stop(interpreter: &mut Interpreter<'_, Self>, stop: &stop::Stop, at: Location, cx: &Context);
}

impl Watch for () {
    #[inline(always)]
    fn enter(&mut self, _: &Frame, _: Location) {}

    #[inline(always)]
    fn depth(&self) -> usize {
        0
    }

    #[inline(always)]
    fn leave(&mut self, _: usize) {}

    #[inline(always)]
    fn stop(_: &mut Interpreter<'_, Self>, _: &stop::Stop, _: Location, _: &Context) {}
}

/// A routine's locals at the start of a call.
#[derive(Debug)]
struct FrameImage {
    bytes: Vec<u8>,
    offsets: Vec<usize>,
}

/// A routine that is running. Positions are offsets in `Interpreter::memory`.
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    routine: RoutineId,
    instance: usize,
    locals: usize,
    /// Offset in `Interpreter::references` of its first parameter.
    references: usize,
}

impl<'p> Interpreter<'p> {
    /// A program in its initial state.
    ///
    /// # Panics
    /// Here and later if `program` is not verified.
    pub fn new(program: &'p Program) -> Self {
        Self::watched(program, ())
    }
}

impl<'p, W: Watch> Interpreter<'p, W> {
    /// As [`new`](Interpreter::new), for a run that is watched.
    ///
    /// # Panics
    /// Here and later if `program` is not verified.
    pub fn watched(program: &'p Program, watch: W) -> Self {
        let layout = Layout::new(program);
        let initial = layout.image(program);
        Self {
            program,
            frames: program.routines.iter().map(|routine| FrameImage::new(program, &layout, routine)).collect(),
            memory: initial.clone(),
            initial,
            table: reference::table(program, &layout),
            layout,
            references: Vec::new(),
            inputs: Vec::new(),
            has_few_turns: false,
            budget: None,
            steps_left: None,
            exchange: None,
            watch,
        }
    }

    /// Writes the initial image over all of the state.
    pub fn init(&mut self) {
        self.memory.clone_from(&self.initial);
    }

    /// Limits each later scan to this many statements and turns of loops; `None` for no limit.
    pub fn set_budget(&mut self, steps: Option<u64>) {
        self.budget = steps;
    }

    /// From now on the block at an offset gives what another one does, which begins as `bytes` say. Their pins are matched by
    /// what they are for. Both are function blocks: of an instruction's structure nothing is exchanged.
    pub fn compute_as(&mut self, offset: usize, blocks: [&'static BlockInfo; 2], bytes: &[u8]) {
        self.exchange = Some(Exchange::new(offset, blocks, bytes, false));
    }

    /// From now on each call of the block at an offset gives what another one has [been given](Self::give) at the end of the scan.
    pub fn show_as(&mut self, offset: usize, blocks: [&'static BlockInfo; 2], bytes: &[u8]) {
        self.exchange = Some(Exchange::new(offset, blocks, bytes, true));
    }

    /// What the other block has at the end of the scan that comes.
    pub fn give(&mut self, bytes: &[u8]) {
        if let Some(exchange) = &mut self.exchange {
            exchange.give(bytes);
        }
    }

    /// After an event: `keeps` says which bytes of what computes the exchanged block it leaves as they are.
    pub fn restart_exchanged(&mut self, keeps: &dyn Fn(usize) -> bool) {
        if let Some(exchange) = &mut self.exchange {
            exchange.restart(&mut self.memory, keeps);
        }
    }

    /// Whether what computes the exchanged block has given each pin a number of the pin's type.
    pub fn exchange_fits(&self) -> bool {
        self.exchange.as_ref().is_none_or(|it| it.fits)
    }

    /// One scan of an instance. After an early end the state stays as it was at that point.
    pub fn scan(&mut self, instance: usize, cx: &Context) -> Result<(), Stop> {
        self.steps_left = self.budget;
        self.has_few_turns = false;
        let class = self.program.class(self.program.instances[instance].program);
        let state = usize_of(self.layout.machine.instances[instance]);
        let starts = if cx.first_scan { self.program.starts() } else { Vec::new() };
        for (at, start) in starts {
            self.run(start, usize_of(self.layout.machine.instances[at]), cx)?;
        }
        if let Some(prescan) = class.prescan.filter(|_| cx.first_scan) {
            self.run(prescan, state, cx)?;
        }
        self.run(class.body, state, cx)
    }

    pub fn state(&self) -> &[u8] {
        &self.memory[..self.initial.len()]
    }

    pub fn state_mut(&mut self) -> &mut [u8] {
        &mut self.memory[..self.initial.len()]
    }

    pub fn layout(&self) -> &Layout {
        &self.layout
    }

    pub fn program(&self) -> &'p Program {
        self.program
    }

    pub fn watch(&mut self) -> &mut W {
        &mut self.watch
    }

    /// Runs a routine of a PROGRAM with nothing below it on the stack.
    fn run(&mut self, routine: RoutineId, instance: usize, cx: &Context) -> Result<(), Stop> {
        let frame = self.enter(routine, instance);
        self.watch.enter(&frame, Location::default());
        let end = self.block(&frame, &self.program.routine(routine).body, cx);
        self.memory.truncate(self.initial.len());
        self.references.clear();
        self.watch.leave(0);
        end.map(|_| ())
    }

    /// Opens a frame with the locals at their initial values.
    fn enter(&mut self, routine: RoutineId, instance: usize) -> Frame {
        let frame = Frame { routine, instance, locals: self.memory.len(), references: self.references.len() };
        self.memory.extend_from_slice(&self.frames[routine.index()].bytes);
        frame
    }

    fn leave(&mut self, frame: &Frame) {
        self.memory.truncate(frame.locals);
        self.references.truncate(frame.references);
    }

    fn scope<'a>(&'a self, frame: &'a Frame) -> Scope<'a, W> {
        Scope { interpreter: self, frame }
    }

    fn resolve(&self, frame: &Frame, place: &Place) -> Result<usize, Fault> {
        self.scope(frame).resolve(place)
    }
}

impl FrameImage {
    fn new(program: &Program, layout: &Layout, routine: &Routine) -> Self {
        let frame = layout.frame(&routine.locals);
        let mut bytes = vec![0; usize_of(frame.size)];
        let offsets: Vec<usize> = frame.offsets.into_iter().map(usize_of).collect();
        for (local, offset) in routine.locals.iter().zip(&offsets) {
            layout.write_const(program, local.ty, &local.initial, &mut bytes[*offset..]);
        }
        Self { bytes, offsets }
    }
}

impl From<Fault> for Stop {
    fn from(fault: Fault) -> Self {
        Self::Fault(fault)
    }
}

impl fmt::Display for Stop {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Fault(fault) => fault.fmt(f),
            Self::OutOfSteps => f.write_str("the scan used up its steps"),
        }
    }
}

impl core::error::Error for Stop {}

#[cfg(test)]
mod tests;
