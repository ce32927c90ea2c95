//! A run that can be stopped between two statements.

use super::{Frame, Interpreter, Watch};
use crate::evaluate::{scalar, text};
use crate::layout::usize_of;
use crate::stop;
use crate::{Expr, Location, Place, Program, RoutineId, Type, Value};
use staunch_runtime::{Context, Fault};
use std::collections::HashSet;

/// How a run continues after a stop.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Go {
    /// To the next breakpoint.
    On,
    /// To the next statement, also of what is called.
    Step,
    /// To the next statement that is not of what is called.
    Next,
    /// To the next statement after the return to the caller.
    Out,
    /// There are no more stops.
    Unwatched,
}

/// Why a run stops.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cause {
    Breakpoint,
    /// The condition of the breakpoint cannot be evaluated.
    Faulted(Fault),
    /// As [`Go`] has asked.
    Step,
}

/// Whoever is asked at each stop.
pub trait Ask: Sized {
    fn stopped(&mut self, stopped: &Stopped<'_, Self>) -> Go;
}

/// Stops a run at breakpoints, and after steps.
#[derive(Debug)]
pub struct Debugger<A> {
    /// The places of the statements before which the run stops.
    breakpoints: HashSet<Location>,
    go: Go,
    /// How many routines were running at the last stop.
    depth: usize,
    running: Vec<Running>,
    /// Not here while it is asked.
    asks: Option<A>,
}

/// A routine that is running.
#[derive(Clone, Copy, Debug)]
pub struct Running {
    pub called_at: Location,
    frame: Frame,
}

impl Running {
    pub fn routine(&self) -> RoutineId {
        self.frame.routine
    }

    /// The offset in the state of the instance that it works on, if it does.
    pub fn instance(&self) -> usize {
        self.frame.instance
    }
}

/// A run between two statements.
#[derive(Debug)]
pub struct Stopped<'a, A> {
    /// Of the statement that comes.
    pub at: Location,
    pub cause: Cause,
    pub cx: &'a Context,
    /// So many of the innermost routine's locals, from the first, are declared.
    pub declared: usize,
    interpreter: &'a Interpreter<'a, Debugger<A>>,
}

impl<A> Debugger<A> {
    pub fn new(breakpoints: HashSet<Location>, asks: A) -> Self {
        Self { breakpoints, go: Go::On, depth: 0, running: Vec::new(), asks: Some(asks) }
    }

    pub fn asks(&mut self) -> Option<&mut A> {
        self.asks.as_mut()
    }

    /// Whether a step ends here.
    fn steps(&self) -> bool {
        match self.go {
            Go::On | Go::Unwatched => false,
            Go::Step => true,
            Go::Next => self.running.len() <= self.depth,
            // Its end is seen where the routine leaves.
            Go::Out => false,
        }
    }
}

impl<A: Ask> Watch for Debugger<A> {
    fn enter(&mut self, frame: &Frame, called_at: Location) {
        self.running.push(Running { called_at, frame: *frame });
    }

    fn depth(&self) -> usize {
        self.running.len()
    }

    fn leave(&mut self, depth: usize) {
        self.running.truncate(depth);
        if self.go == Go::Out && depth < self.depth {
            self.go = Go::Step;
        }
    }

    fn stop(interpreter: &mut Interpreter<'_, Self>, stop: &stop::Stop, at: Location, cx: &Context) {
        let Some(cause) = interpreter.cause(stop.asked.as_ref(), at) else { return };
        let Some(mut asks) = interpreter.watch.asks.take() else { return };
        interpreter.watch.go = asks.stopped(&Stopped { at, cause, cx, declared: stop.declared, interpreter });
        interpreter.watch.depth = interpreter.watch.running.len();
        interpreter.watch.asks = Some(asks);
    }
}

impl<A: Ask> Interpreter<'_, Debugger<A>> {
    fn cause(&self, asked: Option<&stop::Asked>, at: Location) -> Option<Cause> {
        if self.watch.steps() {
            return Some(Cause::Step);
        }
        if self.watch.go == Go::Unwatched || !self.watch.breakpoints.contains(&at) {
            return None;
        }
        let Some(stop::Asked { value: condition, is_condition: true }) = asked else { return Some(Cause::Breakpoint) };
        let frame = self.watch.running.last()?.frame;
        match scalar(&self.scope(&frame), condition) {
            Ok(value) => (value == Value::Bool(true)).then_some(Cause::Breakpoint),
            Err(fault) => Some(Cause::Faulted(fault)),
        }
    }
}

impl<A: Ask> Stopped<'_, A> {
    pub fn program(&self) -> &Program {
        self.interpreter.program
    }

    /// The routines that are running, callee after caller.
    pub fn running(&self) -> &[Running] {
        &self.interpreter.watch.running
    }

    pub fn state(&self) -> &[u8] {
        self.interpreter.state()
    }

    /// What a variable of the innermost routine holds.
    pub fn bytes(&self, place: &Place) -> Result<&[u8], Fault> {
        let Some(running) = self.running().last() else { return Ok(&[]) };
        let offset = self.interpreter.resolve(&running.frame, place)?;
        let size = usize_of(self.interpreter.layout.size(place.ty));
        Ok(&self.interpreter.memory[offset..offset + size])
    }

    /// The bytes of a value in the innermost routine; `None` for one that is neither a number nor a text.
    pub fn evaluate(&self, value: &Expr) -> Result<Option<Vec<u8>>, Fault> {
        let Some(running) = self.running().last() else { return Ok(None) };
        let scope = self.interpreter.scope(&running.frame);
        let mut bytes = vec![0; usize_of(self.interpreter.layout.size(value.ty))];
        match value.ty {
            Type::Elementary(_) | Type::Reference(_) | Type::Subrange(..) | Type::Enum(_) => {
                scalar(&scope, value)?.write(&mut bytes);
            }
            Type::String(_) => text(&scope, value)?.write(&mut bytes),
            Type::Array(_) | Type::Struct(_) | Type::Block(_) => return Ok(None),
        }
        Ok(Some(bytes))
    }
}
