//! What the Rust back end printed for cases, vectors and operations, compiled into this crate.

use staunch_host::Machine;
use staunch_runtime::{Context, Fault};

mod modules {
    #![allow(
        missing_debug_implementations,
        unused_qualifications,
        clippy::empty_line_after_doc_comments,
        reason = "generated"
    )]

    use super::Entry;

    include!(concat!(env!("OUT_DIR"), "/generated.rs"));
}

/// The C entry points of one program.
pub(crate) struct Entry {
    name: &'static str,
    size: usize,
    map: &'static [u8],
    map_len: usize,
    init: unsafe extern "C" fn(*mut u8),
    scan: unsafe extern "C" fn(*mut u8, *const Context, u32) -> u64,
}

/// Bytes to which every lane aligns.
const ALIGN: usize = 16;

/// A program that the Rust back end printed, running.
pub(crate) struct Generated {
    entry: &'static Entry,
    /// The state, from `start` on.
    memory: Vec<u8>,
    start: usize,
}

impl Generated {
    /// `None` when the back end printed no such program.
    pub fn new(module: &str) -> Option<Self> {
        let entry = modules::ENTRIES.iter().find(|it| it.name == module)?;
        let memory = vec![0; entry.size + ALIGN];
        let start = memory.as_ptr().align_offset(ALIGN);
        let mut machine = Self { entry, memory, start };
        machine.init();
        Some(machine)
    }

    /// Whether the module was printed from a program with this map.
    pub fn has_map(&self, map: &str) -> bool {
        self.entry.map == map.as_bytes() && self.entry.map_len == map.len()
    }
}

impl Machine for Generated {
    fn state(&self) -> &[u8] {
        &self.memory[self.start..][..self.entry.size]
    }

    fn state_mut(&mut self) -> &mut [u8] {
        &mut self.memory[self.start..][..self.entry.size]
    }

    fn init(&mut self) {
        let init = self.entry.init;
        let state = self.state_mut().as_mut_ptr();
        // SAFETY: the state has the machine's size, and its alignment by the choice of `start`.
        unsafe { init(state) }
    }

    fn scan(&mut self, instance: usize, cx: &Context) -> Result<(), Fault> {
        let scan = self.entry.scan;
        let instance = u32::try_from(instance).unwrap_or(u32::MAX);
        let state = self.state_mut().as_mut_ptr();
        // SAFETY: as above, and `new` has initialised it. Tests write values of the variables'
        // types into it, so that a BOOL stays one.
        let code = unsafe { scan(state, cx, instance) };
        Fault::from_code(code).map_or(Ok(()), Err)
    }
}
