//! Code in memory, for running at once, with the runtime that is linked into this process.

use crate::unit::{self, EntryPoints};
use crate::{Error, target};
use core::fmt;
use cranelift_jit::{ArenaMemoryProvider, JITBuilder, JITModule};
use cranelift_module::default_libcall_names;
use staunch_ir::Program;
use staunch_ir::layout::{Layout, usize_of};
use staunch_runtime::{Context, Fault};

/// Addresses set aside for code and data; only what is used becomes memory.
const RESERVED: usize = 1 << 30;

type Init = unsafe extern "C" fn(state: *mut u8);
type Scan = unsafe extern "C" fn(state: *mut u8, cx: *const Context, instance: u32) -> u64;

/// A program's code in memory.
pub struct Jit {
    /// Taken only when dropped.
    module: Option<JITModule>,
    init: Init,
    scan: Scan,
    size: usize,
    instances: usize,
}

/// The state of a program: bytes that are aligned for every value.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct State {
    words: Vec<u64>,
    size: usize,
}

impl Jit {
    /// Compiles a verified program for this machine.
    ///
    /// # Errors
    /// If there is no back end for this machine, or a function is too large for it.
    pub fn new(program: &Program) -> Result<Self, Error> {
        let isa = target::native_isa()?;
        let mut builder = JITBuilder::with_isa(isa, default_libcall_names());
        staunch_runtime_abi::for_each_symbol(&mut |name, address| {
            builder.symbol(name, address);
        });
        // Code and data must lie near each other.
        let memory = ArenaMemoryProvider::new_with_size(RESERVED).map_err(|error| Error::Output(error.to_string()))?;
        builder.memory_provider(Box::new(memory));
        let mut module = JITModule::new(builder);
        let (entry_points, _) = unit::emit(program, &mut module, None)?;
        module.finalize_definitions()?;
        Ok(Self::of_module(module, entry_points, program))
    }

    fn of_module(module: JITModule, entry_points: EntryPoints, program: &Program) -> Self {
        let init = module.get_finalized_function(entry_points.init);
        let scan = module.get_finalized_function(entry_points.scan);
        Self {
            // SAFETY: `entry` defines these functions with these signatures; the code is final,
            // and stays in memory until `drop`.
            init: unsafe { core::mem::transmute::<*const u8, Init>(init) },
            // SAFETY: as above.
            scan: unsafe { core::mem::transmute::<*const u8, Scan>(scan) },
            module: Some(module),
            size: usize_of(Layout::new(program).machine.size),
            instances: program.instances.len(),
        }
    }

    /// A new state, in which every variable has its initial value.
    pub fn state(&self) -> State {
        let mut state = State { words: vec![0; self.size.div_ceil(8)], size: self.size };
        self.init(&mut state);
        state
    }

    /// Gives every variable its initial value.
    ///
    /// # Panics
    /// If `state` is another program's and of another size.
    pub fn init(&self, state: &mut State) {
        assert_eq!(state.size, self.size, "the state of another program");
        // SAFETY: the code writes `size` bytes, which `words` has.
        unsafe { (self.init)(state.words.as_mut_ptr().cast()) }
    }

    /// One scan of an instance. After a fault the state stays as it was at that point.
    ///
    /// # Errors
    /// The fault that stopped it.
    ///
    /// # Panics
    /// If there is no such instance, or `state` is another program's and of another size.
    pub fn scan(&self, state: &mut State, instance: usize, cx: &Context) -> Result<(), Fault> {
        assert_eq!(state.size, self.size, "the state of another program");
        assert!(instance < self.instances, "no such instance");
        let instance = u32::try_from(instance).expect("instances are counted in 32 bits");
        // SAFETY: verified code stays within `size` bytes, which are aligned for every value and
        // nobody else's during the call; `cx` outlives it.
        let code = unsafe { (self.scan)(state.words.as_mut_ptr().cast(), cx, instance) };
        match Fault::from_code(code) {
            Some(fault) => Err(fault),
            None => Ok(()),
        }
    }
}

impl Drop for Jit {
    fn drop(&mut self) {
        if let Some(module) = self.module.take() {
            // SAFETY: `self` has the only pointers to the code, and none of it runs: a scan
            // borrows `self`.
            unsafe { module.free_memory() }
        }
    }
}

impl fmt::Debug for Jit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { size, instances, .. } = self;
        f.debug_struct("Jit").field("size", size).field("instances", instances).finish_non_exhaustive()
    }
}

impl State {
    pub fn bytes(&self) -> &[u8] {
        // SAFETY: the words are initialised, and have at least `size` bytes.
        unsafe { core::slice::from_raw_parts(self.words.as_ptr().cast(), self.size) }
    }

    /// A BOOL must stay 0 or 1, and a string's length within its capacity.
    pub fn bytes_mut(&mut self) -> &mut [u8] {
        // SAFETY: as in `bytes`, and any bytes make words.
        unsafe { core::slice::from_raw_parts_mut(self.words.as_mut_ptr().cast(), self.size) }
    }
}
