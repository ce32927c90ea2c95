//! The executors that run in this process, as the host sees them.

use staunch_host::{Compiled, Domain, Machine, Map, Snapshot};
use staunch_ir::Program;
use staunch_ir::interpret::debug::{Ask, Debugger};
use staunch_ir::interpret::{Interpreter, Stop, Watch};
use staunch_ir::layout::Layout;
use staunch_native::Jit;
use staunch_runtime::{Context, Fault, Time};

/// Where the variables are in a program's state.
pub fn map(program: &Program) -> Result<Map, String> {
    let text = staunch_ir::symbols::map_text(program, &Layout::new(program));
    Map::parse(&text).map_err(|it| it.to_string())
}

/// Native code in memory.
#[derive(Debug)]
pub struct Native {
    /// Before the code that it calls: it goes first.
    compiled: Compiled,
    _jit: Jit,
}

impl Native {
    /// The machine, and the map of its state.
    pub fn new(program: &Program) -> Result<(Self, Map), String> {
        let (jit, map) = (Jit::new(program).map_err(|it| it.to_string())?, map(program)?);
        // SAFETY: the code was made of the program that the map describes, and is kept as long as
        // the machine that calls it.
        let compiled = unsafe { Compiled::new(&map, jit.init, jit.scan) };
        Ok((Self { compiled, _jit: jit }, map))
    }

    pub fn compiled(&mut self) -> &mut Compiled {
        &mut self.compiled
    }

    pub fn snapshot(&self) -> Snapshot {
        self.compiled.snapshot()
    }
}

impl Machine for Native {
    fn state(&self) -> &[u8] {
        self.compiled.state()
    }

    fn write(&mut self, offset: usize, bytes: &[u8]) {
        self.compiled.write(offset, bytes);
    }

    fn init(&mut self) {
        self.compiled.init();
    }

    fn scan(&mut self, instance: usize, cx: &Context) -> Result<(), Fault> {
        self.compiled.scan(instance, cx)
    }
}

/// What watches an interpreted run, as the host sees it.
pub trait Watching: Watch {
    fn scan_begins(&mut self, number: u64, time: Time);

    /// Whether the run ends after this scan.
    fn ends(&mut self) -> bool;
}

/// Nothing.
impl Watching for () {
    fn scan_begins(&mut self, _: u64, _: Time) {}

    fn ends(&mut self) -> bool {
        false
    }
}

/// Whoever a debugger asks, as the host sees them.
pub trait Debugs: Ask {
    fn scan_begins(&mut self, number: u64, time: Time);

    /// Whether the run ends after this scan.
    fn ends(&self) -> bool;
}

impl<A: Debugs> Watching for Debugger<A> {
    fn scan_begins(&mut self, number: u64, time: Time) {
        self.asks().into_iter().for_each(|it| it.scan_begins(number, time));
    }

    fn ends(&mut self) -> bool {
        self.asks().is_some_and(|it| it.ends())
    }
}

/// The reference interpreter.
pub struct Interpreted<'p, W = ()> {
    interpreter: Interpreter<'p, W>,
    domain: Domain,
}

impl<'p> Interpreted<'p> {
    /// The machine, and the map of its state.
    pub fn new(program: &'p Program) -> Result<(Self, Map), String> {
        let map = map(program)?;
        Ok((Self::watched(program, &map, ()), map))
    }
}

impl<'p, W: Watching> Interpreted<'p, W> {
    pub fn watched(program: &'p Program, map: &Map, watch: W) -> Self {
        Self { interpreter: Interpreter::watched(program, watch), domain: Domain::of(map) }
    }

    pub fn interpreter(&mut self) -> &mut Interpreter<'p, W> {
        &mut self.interpreter
    }
}

impl<W: Watching> Machine for Interpreted<'_, W> {
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
        self.interpreter.watch().scan_begins(number, time);
    }

    fn ends(&mut self) -> bool {
        self.interpreter.watch().ends()
    }

    fn scan(&mut self, instance: usize, cx: &Context) -> Result<(), Fault> {
        match self.interpreter.scan(instance, cx) {
            Ok(()) => Ok(()),
            Err(Stop::Fault(fault)) => Err(fault),
            Err(Stop::OutOfSteps) => unreachable!("the interpreter has no budget here"),
        }
    }
}

impl<W> core::fmt::Debug for Interpreted<'_, W> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("Interpreted").finish_non_exhaustive()
    }
}
