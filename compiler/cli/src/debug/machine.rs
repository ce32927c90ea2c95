//! The interpreter under a debugger, as the host sees it.

use super::console::{Console, StoppedAt};
use staunch_host::{Domain, Machine, Map};
use staunch_ir::interpret::debug::Debugger;
use staunch_ir::interpret::{Interpreter, Stop};
use staunch_ir::{Location, Program};
use staunch_runtime::{Context, Fault, Time};
use std::collections::HashSet;

pub(super) struct Debugged<'p> {
    interpreter: Interpreter<'p, Debugger<Console<'p>>>,
    domain: Domain,
}

impl<'p> Debugged<'p> {
    pub fn new(program: &'p Program, map: &Map, breakpoints: HashSet<Location>, console: Console<'p>) -> Self {
        let debugger = Debugger::new(breakpoints, console);
        Self { interpreter: Interpreter::watched(program, debugger), domain: Domain::of(map) }
    }

    pub fn stopped_at(&mut self) -> StoppedAt {
        self.interpreter.watch().asks().map(|it| it.stopped_at()).unwrap_or_default()
    }
}

impl Machine for Debugged<'_> {
    fn state(&self) -> &[u8] {
        self.interpreter.state()
    }

    fn write(&mut self, offset: usize, bytes: &[u8]) {
        self.domain.write(self.interpreter.state_mut(), offset, bytes);
    }

    fn init(&mut self) {
        self.interpreter.init();
    }

    fn scan_begins(&mut self, number: u64, time: Time) {
        if let Some(console) = self.interpreter.watch().asks() {
            console.scan_begins(number, time);
        }
    }

    fn ends(&mut self) -> bool {
        self.interpreter.watch().asks().is_some_and(|it| it.is_over())
    }

    fn scan(&mut self, instance: usize, cx: &Context) -> Result<(), Fault> {
        match self.interpreter.scan(instance, cx) {
            Ok(()) => Ok(()),
            Err(Stop::Fault(fault)) => Err(fault),
            Err(Stop::OutOfSteps) => unreachable!("the interpreter has no budget here"),
        }
    }
}
