//! Runs programs from what was recorded of them on another machine, and says where a state differs: any machine of little endian.

use core::fmt::Write;
use staunch_runtime::Context;

include!("hash.rs");

pub struct Entry {
    pub init: unsafe extern "C" fn(state: *mut u8),
    pub scan: unsafe extern "C" fn(state: *mut u8, cx: *const Context, instance: u32) -> u64,
}

/// As large as the largest state.
const SIZE: usize = include!("size");
#[repr(C, align(16))]
struct Room([u8; SIZE]);
static mut ROOM: Room = Room([0; SIZE]);

const MOST_PARTS: usize = include!("parts");
static mut PARTS: [Part; MOST_PARTS] = [Part { at: 0, kind: 0 }; MOST_PARTS];

struct Record(&'static [u8]);

impl Record {
    fn take(&mut self, count: usize) -> &'static [u8] {
        let (first, rest) = self.0.split_at(count);
        self.0 = rest;
        first
    }

    fn u32(&mut self) -> u32 {
        u32::from_le_bytes(first(self.take(4)))
    }

    fn u64(&mut self) -> u64 {
        u64::from_le_bytes(first(self.take(8)))
    }

    fn bytes(&mut self) -> &'static [u8] {
        let count = self.u32() as usize;
        self.take(count)
    }
}

/// The number of programs that differ.
pub fn all(entries: &[Entry], out: &mut dyn Write) -> usize {
    let mut record = Record(include_bytes!("record"));
    let (mut scans, mut wrong) = (0, 0);
    for entry in entries {
        let name = core::str::from_utf8(record.bytes()).unwrap_or_default();
        let mut drive = Record(record.bytes());
        match one(entry, &mut drive, &mut scans) {
            Ok(()) => {}
            Err(Different { scan, fault }) => {
                wrong += 1;
                let _ = writeln!(out, "{name} differs in scan {scan}, which returns {fault:x}");
            }
        }
    }
    let _ = writeln!(out, "{} programs, {scans} scans, {wrong} differ", entries.len());
    wrong
}

struct Different {
    scan: u64,
    fault: u64,
}

fn one(entry: &Entry, drive: &mut Record, scans: &mut u64) -> Result<(), Different> {
    // SAFETY: nothing else has them; this runs in one thread.
    let (state, parts) = unsafe { (&mut (*(&raw mut ROOM)).0, &mut *(&raw mut PARTS)) };
    let parts = &mut parts[..drive.u32() as usize];
    parts.iter_mut().for_each(|it| *it = Part { at: drive.u32() as usize, kind: drive.u32() });
    // SAFETY: the room is as large as any state, and aligned for all of them.
    unsafe { (entry.init)(state.as_mut_ptr()) };
    let mut scan = 0;
    while !drive.0.is_empty() {
        let patches = drive.u32();
        for _ in 0..patches {
            let at = drive.u32() as usize;
            let bytes = drive.bytes();
            state[at..at + bytes.len()].copy_from_slice(bytes);
        }
        let (instance, first) = (drive.u32(), drive.u32() != 0);
        let cx = Context::new(drive.u64() as i64, first).with_turns(drive.u64()).with_cycle(drive.u64() as i64);
        let expected = (drive.u64(), drive.u64());
        scan += 1;
        *scans += 1;
        // SAFETY: the state is that of the program, and what was written into it are values of the variables' types.
        let fault = unsafe { (entry.scan)(state.as_mut_ptr(), &cx, instance) };
        let hash = parts.iter().fold(START, |hash, it| stir_part(hash, state, *it));
        if (fault, hash) != expected {
            return Err(Different { scan, fault });
        }
    }
    Ok(())
}
