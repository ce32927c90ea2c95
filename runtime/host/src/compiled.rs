//! Compiled code as a machine.

use crate::domain::Domain;
use crate::map::Map;
use crate::{Error, Machine};
use staunch_runtime::{Context, Fault};
use std::fmt;
use std::sync::atomic::{AtomicU64, Ordering};

/// `staunch_init`: writes the initial values over all of the state.
pub type Init = unsafe extern "C" fn(state: *mut u8);
/// `staunch_scan`: one scan of an instance; returns 0, or a fault's code. Every variable of the state has a
/// valid value of its type, before and after.
pub type Scan = unsafe extern "C" fn(state: *mut u8, cx: *const Context, instance: u32) -> u64;

/// The entry points of a compiled program.
#[derive(Clone, Copy)]
pub struct Code {
    map: &'static str,
    init: Init,
    scan: Scan,
}

impl Code {
    /// # Safety
    /// `init` and `scan` are the entry points of the program that `map` describes.
    pub const unsafe fn new(map: &'static str, init: Init, scan: Scan) -> Self {
        Self { map, init, scan }
    }

    /// The map, and a machine that runs the program.
    pub(crate) fn machine(&self) -> Result<(Map, Compiled), Error> {
        let map = Map::parse(self.map)?;
        // SAFETY: `new` was promised that the entry points belong to the map.
        let machine = unsafe { Compiled::new(&map, self.init, self.scan) };
        Ok((map, machine))
    }
}

impl fmt::Debug for Code {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Code").finish_non_exhaustive()
    }
}

/// A compiled program and its state.
pub struct Compiled {
    /// Aligned for every type; the state is at its start.
    memory: Vec<u128>,
    size: usize,
    instances: usize,
    domain: Domain,
    init: Init,
    scan: Scan,
    prepared: Vec<Vec<Ready>>,
    number: u64,
}

/// A state of a [`Compiled`], which can be restored.
#[derive(Clone, Debug)]
pub struct Snapshot {
    /// The machine's number.
    owner: u64,
    bytes: Box<[u8]>,
}

impl Snapshot {
    pub fn bytes(&self) -> &[u8] {
        &self.bytes
    }
}

/// Machines made so far: each has a number of its own.
static MACHINES: AtomicU64 = AtomicU64::new(0);

/// Bytes that are complete, valid values of their variables' types.
struct Ready {
    offset: usize,
    bytes: Vec<u8>,
}

impl Compiled {
    /// The program in its initial state.
    ///
    /// # Safety
    /// `init` and `scan` are the entry points of the program that `map` describes, and stay
    /// callable as long as this value lives.
    pub unsafe fn new(map: &Map, init: Init, scan: Scan) -> Self {
        let memory = vec![0; map.size.div_ceil(size_of::<u128>()).max(1)];
        let (size, instances, domain) = (map.size, map.instances.len(), Domain::of(map));
        let number = MACHINES.fetch_add(1, Ordering::Relaxed);
        let mut compiled = Self { memory, size, instances, domain, init, scan, prepared: Vec::new(), number };
        compiled.init();
        compiled
    }

    /// A machine with the same state, whose scans do nothing.
    pub(crate) fn without_code(&self) -> Self {
        unsafe extern "C" fn init(_: *mut u8) {}
        unsafe extern "C" fn scan(_: *mut u8, _: *const Context, _: u32) -> u64 {
            0
        }
        Self {
            memory: self.memory.clone(),
            size: self.size,
            instances: self.instances,
            domain: self.domain.clone(),
            init,
            scan,
            prepared: Vec::new(),
            number: MACHINES.fetch_add(1, Ordering::Relaxed),
        }
    }

    /// The present state, for [`restore`](Self::restore).
    pub fn snapshot(&self) -> Snapshot {
        Snapshot { owner: self.number, bytes: self.state().into() }
    }

    /// Restores a state that this machine had: less work than [writing](Machine::write) it.
    ///
    /// # Panics
    /// If the snapshot belongs to another machine.
    #[inline]
    pub fn restore(&mut self, snapshot: &Snapshot) {
        assert_eq!(snapshot.owner, self.number, "the state of another machine");
        let pointer = self.pointer();
        // SAFETY: as in `state`; the bytes were this machine's state, so each variable has a value
        // of its type.
        let state = unsafe { std::slice::from_raw_parts_mut(pointer, self.size) };
        state.copy_from_slice(&snapshot.bytes);
    }

    /// Keeps writes for [`apply`](Self::apply), each a list of offsets and bytes.
    ///
    /// # Panics
    /// If bytes are only part of a value.
    pub(crate) fn prepare(&mut self, lists: &[Vec<(usize, Vec<u8>)>]) {
        let mut state = self.state().to_vec();
        let mut ready = |(offset, bytes): &(usize, Vec<u8>)| {
            let end = offset + bytes.len();
            assert!(self.domain.is_boundary(*offset) && self.domain.is_boundary(end), "a part of a value");
            self.domain.write(&mut state, *offset, bytes);
            Ready { offset: *offset, bytes: state[*offset..end].to_vec() }
        };
        self.prepared = lists.iter().map(|list| list.iter().map(&mut ready).collect()).collect();
    }

    /// Writes one of the prepared lists: less work than [`write`](Machine::write), before each of
    /// many scans.
    #[inline]
    pub(crate) fn apply(&mut self, list: usize) {
        let pointer = self.pointer();
        // SAFETY: as in `state`; nothing else of `self` is changed.
        let state = unsafe { std::slice::from_raw_parts_mut(pointer, self.size) };
        for Ready { offset, bytes } in &self.prepared[list] {
            match bytes.as_slice() {
                [byte] => state[*offset] = *byte,
                bytes => state[*offset..offset + bytes.len()].copy_from_slice(bytes),
            }
        }
    }

    fn pointer(&mut self) -> *mut u8 {
        self.memory.as_mut_ptr().cast()
    }
}

impl fmt::Debug for Compiled {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Compiled").field("size", &self.size).finish_non_exhaustive()
    }
}

impl Machine for Compiled {
    fn state(&self) -> &[u8] {
        // SAFETY: `memory` holds at least `size` bytes, all initialised.
        unsafe { std::slice::from_raw_parts(self.memory.as_ptr().cast(), self.size) }
    }

    fn write(&mut self, offset: usize, bytes: &[u8]) {
        let (pointer, size) = (self.pointer(), self.size);
        // SAFETY: `memory` holds at least `size` bytes, all initialised, and is borrowed here.
        let state = unsafe { std::slice::from_raw_parts_mut(pointer, size) };
        self.domain.write(state, offset, bytes);
    }

    fn init(&mut self) {
        let (init, state) = (self.init, self.pointer());
        // SAFETY: `new` was promised that `init` writes the state that the map describes.
        unsafe { init(state) }
    }

    fn scan(&mut self, instance: usize, cx: &Context) -> Result<(), Fault> {
        assert!(instance < self.instances, "instance {instance} of {}", self.instances);
        let (scan, state) = (self.scan, self.pointer());
        // SAFETY: `new` was promised that `scan` works on the state that the map describes, and
        // the instance is one of that map's. The state was written by the program alone, and by its
        // domain: each variable has a value of its type.
        let code = unsafe { scan(state, cx, instance as u32) };
        Fault::from_code(code).map_or(Ok(()), Err)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::executable::{main_with, version};
    use crate::fixture::{MAP, map, offset_of};
    use std::ffi::OsString;

    unsafe extern "C" fn init(state: *mut u8) {
        // SAFETY: the tests below give it the state of the fixture's map.
        unsafe { state.write_bytes(0, 128) }
    }

    unsafe extern "C" fn scan(state: *mut u8, cx: *const Context, instance: u32) -> u64 {
        // SAFETY: as above; the offset is below the map's size.
        unsafe {
            *state.add(36) = instance as u8 + 7;
            if (*cx).now() >= 20_000_000 { 1 | 5 << 24 | 9 << 40 } else { 0 }
        }
    }

    fn arguments(text: &str) -> impl Iterator<Item = OsString> {
        std::iter::once("garage").chain(text.split_whitespace()).map(OsString::from).collect::<Vec<_>>().into_iter()
    }

    #[test]
    fn compiled_code_is_a_machine() {
        // SAFETY: the functions above stay within the map's size.
        let mut machine = unsafe { Compiled::new(&map(), init, scan) };
        assert_eq!(machine.state().len(), 128);
        machine.write(0, &[1; 128]);
        machine.init();
        assert_eq!(machine.scan(0, &Context::at(0)), Ok(()));
        assert_eq!(machine.state()[offset_of("speed")], 7);
        let fault = machine.scan(0, &Context::at(20_000_000)).unwrap_err();
        assert_eq!((fault.at.line, fault.at.column), (9, 5));
    }

    #[test]
    #[should_panic(expected = "the state of another machine")]
    fn a_machine_goes_back_to_its_own_states_only() {
        // SAFETY: as above.
        let [mut machine, other] = [0, 1].map(|_| unsafe { Compiled::new(&map(), init, scan) });
        let start = machine.snapshot();
        assert_eq!(machine.scan(0, &Context::at(0)), Ok(()));
        machine.restore(&start);
        assert_eq!(machine.state(), start.bytes());
        machine.restore(&other.snapshot());
    }

    #[test]
    #[cfg_attr(miri, ignore = "it measures time")]
    fn an_executable_reports_as_the_command_does() {
        // SAFETY: as above.
        let code = unsafe { Code::new(MAP, init, scan) };
        assert_eq!(main_with(code, arguments("--scans 2 -q")), 0);
        assert_eq!(main_with(code, arguments("--bench --scans 2 --cycle 1us")), 3);
        assert_eq!(main_with(code, arguments("--scans 9 -q")), 3);
        assert_eq!(main_with(code, arguments("--scan 9")), 2);
        assert_eq!(main_with(code, arguments("--scans 1 --vars nothing")), 2);
        assert_eq!(main_with(code, arguments("--version")), 0);
        assert_eq!(version(&map()), "Garage (garage.st), compiled by Staunch 1.2.3\n");
    }
}
