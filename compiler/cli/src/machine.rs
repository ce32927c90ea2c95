//! The executors that run in this process, as the host sees them.

use staunch_host::Machine;
use staunch_ir::interpret::{Interpreter, Stop};
use staunch_native::{Jit, State};
use staunch_runtime::{Context, Fault};

/// Native code in memory.
#[derive(Debug)]
pub struct Native {
    jit: Jit,
    state: State,
}

impl Native {
    pub fn new(program: &staunch_ir::Program) -> Result<Self, String> {
        let jit = Jit::new(program).map_err(|it| it.to_string())?;
        let state = jit.state();
        Ok(Self { jit, state })
    }
}

impl Machine for Native {
    fn state(&self) -> &[u8] {
        self.state.bytes()
    }

    fn state_mut(&mut self) -> &mut [u8] {
        self.state.bytes_mut()
    }

    fn init(&mut self) {
        self.jit.init(&mut self.state);
    }

    fn scan(&mut self, instance: usize, cx: &Context) -> Result<(), Fault> {
        self.jit.scan(&mut self.state, instance, cx)
    }
}

/// The reference interpreter.
pub struct Interpreted<'p>(pub Interpreter<'p>);

impl Machine for Interpreted<'_> {
    fn state(&self) -> &[u8] {
        self.0.state()
    }

    fn state_mut(&mut self) -> &mut [u8] {
        self.0.state_mut()
    }

    fn init(&mut self) {
        self.0.init();
    }

    fn scan(&mut self, instance: usize, cx: &Context) -> Result<(), Fault> {
        match self.0.scan(instance, cx) {
            Ok(()) => Ok(()),
            Err(Stop::Fault(fault)) => Err(fault),
            Err(Stop::OutOfSteps) => unreachable!("the interpreter has no budget here"),
        }
    }
}

impl core::fmt::Debug for Interpreted<'_> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("Interpreted").finish_non_exhaustive()
    }
}
