//! Saves state after state so that, whenever the power goes, the last one that was saved can be
//! recovered, or one whose saving had begun after it.

use super::content::{Found, Slot};
use super::format::{Layout, Record};
use super::storage::{Storage, Which, write_all};
use staunch_runtime::Time;
use std::io;

#[derive(Debug)]
pub(super) struct Keeper<S> {
    storage: S,
    layout: Layout,
    /// The slot of the kept file that is not written, because the last state is in it.
    good: Option<Good>,
    sequence: u64,
    buffer: Vec<u8>,
}

#[derive(Clone, Debug)]
struct Good {
    slot: Slot,
    /// The record as it was found, until it and the file's name are known to be on disk: whoever wrote it may
    /// have ended before.
    found: Option<(Time, Found)>,
}

/// Sequence numbers that saving reaches in no life of a machine: past them a new file counts from 1.
const MAX_SEQUENCE: u64 = u64::MAX / 2;

impl<S: Storage> Keeper<S> {
    /// `found` is what was recovered from the kept file, if its slots are of the layout.
    pub fn new(storage: S, layout: Layout, found: Option<(Time, Found)>) -> Self {
        let found = found.filter(|it| it.1.sequence < MAX_SEQUENCE);
        let sequence = found.as_ref().map_or(0, |(_, it)| it.sequence);
        let good = found.map(|it| Good { slot: it.1.slot, found: Some(it) });
        Self { storage, layout, good, sequence, buffer: Vec::new() }
    }

    /// Saves a state. After an error nothing is lost that was saved before.
    ///
    /// A file that is full to its end can still be written inside, and one whose disk fails in a place can be
    /// made anew in another.
    pub fn save(&mut self, clock: Time, values: &[u8], fault: &str) -> io::Result<()> {
        match self.save_inside(clock, values, fault) {
            Ok(true) => Ok(()),
            Ok(false) | Err(_) => self.save_anew(clock, values, fault),
        }
    }

    /// Into the slot that may be written; FALSE if there is none.
    fn save_inside(&mut self, clock: Time, values: &[u8], fault: &str) -> io::Result<bool> {
        let Some(good) = &mut self.good else { return Ok(false) };
        let slot = good.slot;
        if let Some((clock, found)) = &good.found {
            // The same bytes in the same place: whatever of them gets there, the record is whole, or the
            // other slot's is what it would have been.
            let (clock, Found { sequence, values, fault, .. }) = (*clock, found.clone());
            self.write_slot(slot, Record { sequence, clock, values: &values, fault: &fault })?;
            self.storage.sync_name()?;
        }
        self.sequence += 1;
        self.write_slot(slot.other(), Record { sequence: self.sequence, clock, values, fault })?;
        self.good = Some(Good { slot: slot.other(), found: None });
        Ok(true)
    }

    fn write_slot(&mut self, slot: Slot, record: Record<'_>) -> io::Result<()> {
        self.layout.encode_slot(record, &mut self.buffer);
        write_all(&mut self.storage, Which::Kept, self.layout.offset(slot), &self.buffer)?;
        self.storage.sync(Which::Kept)
    }

    /// As a new file.
    fn save_anew(&mut self, clock: Time, values: &[u8], fault: &str) -> io::Result<()> {
        self.sequence += 1;
        let file = self.layout.encode_file(Record { sequence: self.sequence, clock, values, fault });
        let written = self.storage.create().and_then(|()| {
            write_all(&mut self.storage, Which::New, 0, &file)?;
            self.storage.sync(Which::New)
        });
        if let Err(error) = written {
            self.storage.discard();
            return Err(error);
        }
        if let Err(error) = self.storage.publish() {
            self.storage.discard();
            return Err(error);
        }
        // Until the name is on disk, it is open which file the next start finds.
        self.good = None;
        self.storage.sync_name()?;
        self.good = Some(Good { slot: Slot::First, found: None });
        Ok(())
    }
}

#[cfg(test)]
mod tests;
