//! The program as one system runs it.

use super::normal::{self, Digest, Timer};
use crate::program::scalar::{Scalar, Scalars};
use crate::program::{held, moving_preset};
use staunch_frontend::Dialect;
use staunch_host::{Bookmark, Drive, Event, Machine};
use staunch_ir::{Chars, Program, Value};
use staunch_machine::Native;

#[derive(Debug)]
pub struct Side {
    pub dialect: Dialect,
    pub program: Program,
    pub scalars: Scalars,
    pub(super) machine: Native,
    pub(super) drive: Drive,
    pub(super) start: Bookmark,
    pub(super) timers: Vec<Timer>,
    /// States at different times are different ones.
    pub(super) reads_clock: bool,
    /// Of the states that keys are made of.
    pub(super) digest: Digest,
    /// The state before the last scan.
    pub(super) before: Vec<u8>,
    /// After the last event, before anything ran.
    pub(super) restarted: Vec<u8>,
    pub(super) initial: Vec<u8>,
}

impl Side {
    pub fn new(dialect: Dialect, program: Program, cycle: Option<i64>) -> Result<Self, String> {
        let (machine, map) = Native::new(&program)?;
        let scalars = Scalars::of(&program);
        let drive = Drive::new(&map, cycle);
        let timers = normal::timers(&scalars.blocks, moving_preset::longest(&program));
        let reads_clock = normal::reads_clock(&program);
        let (start, before) = (drive.bookmark(), machine.state().to_vec());
        Ok(Self {
            dialect,
            program,
            scalars,
            machine,
            drive,
            start,
            timers,
            reads_clock,
            digest: Digest::default(),
            restarted: before.clone(),
            initial: before.clone(),
            before,
        })
    }

    pub fn state(&self) -> &[u8] {
        self.machine.state()
    }

    pub fn machine(&mut self) -> &mut Native {
        &mut self.machine
    }

    /// Whether an event keeps the byte at this offset.
    pub fn keeps(&self, event: Event, offset: usize) -> bool {
        self.drive.keeps(event, offset)
    }

    pub(super) fn write_text(&mut self, scalar: usize, text: &Chars) {
        let Scalar { offset, size, is_shared, .. } = self.scalars.all[scalar];
        let mut bytes = vec![0; size];
        if is_shared {
            let units = text.units_as_bytes();
            bytes[..units.len()].copy_from_slice(&units);
        } else {
            text.write(&mut bytes);
        }
        if self.state()[offset..offset + size] != bytes {
            self.machine.write(offset, &bytes);
        }
    }

    pub(super) fn write(&mut self, offset: usize, value: Value) {
        let mut bytes = [0; 8];
        value.write(&mut bytes);
        let size = usize::try_from(value.repr().size()).expect("reprs are small");
        if self.state()[offset..offset + size] != bytes[..size] {
            self.machine.write(offset, &bytes[..size]);
        }
    }

    pub fn show(&self, scalar: usize, state: &[u8]) -> String {
        held::show(&self.program, &self.scalars, &self.scalars.all[scalar], state)
    }
}
