//! Code in memory, for running at once, with the runtime that is linked into this process.

use crate::Error;
use crate::entry::EntryPoints;
use crate::program::{self, Also};
use crate::target::{self, Aim};
use core::ffi::c_int;
use core::fmt;
use cranelift_jit::{ArenaMemoryProvider, JITBuilder, JITModule};
use cranelift_module::default_libcall_names;
use staunch_ir::Program;
use staunch_runtime::Context;

/// Addresses set aside for code and data; only what is used becomes memory. On Windows all of it counts as memory in use.
const RESERVED: usize = if cfg!(windows) { 1 << 27 } else { 1 << 30 };

/// Writes the initial values over all of the state.
pub type Init = unsafe extern "C" fn(state: *mut u8);

/// One scan of an instance; 0, or a fault's code. Every variable of the state has a value of its
/// type, before and after: a BOOL is 0 or 1, and a string's length within its capacity.
pub type Scan = unsafe extern "C" fn(state: *mut u8, cx: *const Context, instance: u32) -> u64;

/// A program's code in memory. Its functions can be called as long as this value lives; they work on
/// a state of the size and alignment that the program's [`Layout`](staunch_ir::layout::Layout) gives.
pub struct Jit {
    /// Taken only when dropped.
    module: Option<JITModule>,
    pub init: Init,
    pub scan: Scan,
}

impl Jit {
    /// Compiles a verified program for this machine.
    ///
    /// # Errors
    /// If this machine is not supported, a function is too large for it, or something is called that is
    /// implemented outside.
    pub fn new(program: &Program) -> Result<Self, Error> {
        Self::aiming_at(program, Aim::Speed)
    }

    /// The same, with code for that aim.
    ///
    /// # Errors
    /// As above.
    pub fn aiming_at(program: &Program, aim: Aim) -> Result<Self, Error> {
        if let Some(external) = program.externals().first() {
            return Err(Error::External(external.name.clone()));
        }
        let isa = target::native_isa(aim)?;
        let mut builder = JITBuilder::with_isa(isa, default_libcall_names());
        staunch_runtime_abi::for_each_symbol(&mut |name, address| {
            builder.symbol(name, address);
        });
        builder.symbols(of_c_library());
        // Code and data must lie near each other.
        let memory = ArenaMemoryProvider::new_with_size(RESERVED).map_err(|error| Error::Output(error.to_string()))?;
        builder.memory_provider(Box::new(memory));
        let mut module = JITModule::new(builder);
        let entry_points = program::emit(program, &mut module, Also::Nothing)?.entry_points;
        module.finalize_definitions()?;
        Ok(Self::of_module(module, entry_points))
    }

    fn of_module(module: JITModule, entry_points: EntryPoints) -> Self {
        let init = module.get_finalized_function(entry_points.init);
        let scan = module.get_finalized_function(entry_points.scan);
        Self {
            // SAFETY: `entry` defines these functions with these signatures; the code is final,
            // and stays in memory until `drop`.
            init: unsafe { core::mem::transmute::<*const u8, Init>(init) },
            // SAFETY: as above.
            scan: unsafe { core::mem::transmute::<*const u8, Scan>(scan) },
            module: Some(module),
        }
    }
}

/// What Cranelift calls. A process that is linked statically has no table in which it could be looked up.
fn of_c_library() -> [(&'static str, *const u8); 5] {
    unsafe extern "C" {
        fn memcpy(to: *mut u8, from: *const u8, size: usize) -> *mut u8;
        fn memmove(to: *mut u8, from: *const u8, size: usize) -> *mut u8;
        fn memset(to: *mut u8, byte: c_int, size: usize) -> *mut u8;
        fn nearbyint(value: f64) -> f64;
        fn nearbyintf(value: f32) -> f32;
    }
    [
        ("memcpy", memcpy as *const u8),
        ("memmove", memmove as *const u8),
        ("memset", memset as *const u8),
        ("nearbyint", nearbyint as *const u8),
        ("nearbyintf", nearbyintf as *const u8),
    ]
}

impl Drop for Jit {
    fn drop(&mut self) {
        if let Some(module) = self.module.take() {
            // SAFETY: who calls the code has promised that this value lives meanwhile.
            unsafe { module.free_memory() }
        }
    }
}

impl fmt::Debug for Jit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Jit").finish_non_exhaustive()
    }
}
