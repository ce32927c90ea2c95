//! The file of retained variables as bytes: what is written, and what is recovered of whatever is
//! found. It touches no file.
//!
//! A head of text comes first: the format's version, the PROGRAMs, a line a variable with its path,
//! type and size, and a checksum. Two slots follow, each on sectors of its own, of which one is
//! written while the other holds the state before: a checksum over all of the rest and the head's
//! checksum, a sequence number, the program's clock, and the variables' bytes in the order of the
//! head's lines, and the fault that ended the last run. Numbers of the slot are little endian, and so are values on every supported target.

use super::content::{Content, Found, Refusal, Slot, TEXT_VERSION, VERSION, WITHOUT_FAULT};
use super::text;
use staunch_runtime::{Crc32, Time, crc32};
use std::fmt::Write as _;

/// The first line, before the version.
pub(super) const TITLE: &str = "staunch retained variables ";

/// Slots do not share a sector, nor a page of what stores them, so that writing one leaves the other alone.
pub(super) const SECTOR: usize = 4096;

/// Checksum, a word that is 0, sequence number, clock.
const SLOT_HEAD: usize = 24;
/// The fault's text after the values, with zeros after it: a slot's head and this are 256 bytes.
const FAULT: usize = 232;

/// A variable as the file names it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Named {
    pub path: String,
    /// Everything that decides the meaning of the bytes.
    pub ty: String,
    pub size: usize,
}

/// The layout of a program's file: its head, and where its slots are.
#[derive(Clone, Debug)]
pub(super) struct Layout {
    head: String,
    fingerprint: u32,
    /// Bytes of all values.
    size: usize,
    /// Bytes for the text of a fault.
    fault: usize,
}

/// The contents of a slot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Record<'a> {
    /// Counts up with each record that is written, so that the later one is known.
    pub sequence: u64,
    pub clock: Time,
    pub values: &'a [u8],
    /// Why the run ended; empty where it did not fault. A text that is too long loses its beginning: the end has the
    /// kind and the line.
    pub fault: &'a str,
}

impl Layout {
    pub fn new<'a>(programs: &str, variables: impl Iterator<Item = (&'a str, &'a str, usize)>) -> Self {
        Self::of_version(VERSION, programs, variables)
    }

    fn of_version<'a>(
        version: &str,
        programs: &str,
        variables: impl Iterator<Item = (&'a str, &'a str, usize)>,
    ) -> Self {
        let (mut head, mut size) = (format!("{TITLE}{version}\nprogram\t{programs}\n"), 0);
        let fault = if version == WITHOUT_FAULT { 0 } else { FAULT };
        for (path, ty, bytes) in variables {
            let _ = writeln!(head, "{path}\t{ty}\t{bytes}");
            size += bytes;
        }
        let fingerprint = crc32(head.as_bytes());
        let _ = writeln!(head, "{CHECKSUM}{fingerprint:08x}");
        Self { head, fingerprint, size, fault }
    }

    /// Where a slot is in the file.
    pub fn offset(&self, slot: Slot) -> usize {
        let first = self.head.len().next_multiple_of(SECTOR);
        match slot {
            Slot::First => first,
            Slot::Second => first + self.slot_size(),
        }
    }

    /// Bytes of a slot that mean something.
    fn used(&self) -> usize {
        SLOT_HEAD + self.size + self.fault
    }

    fn slot_size(&self) -> usize {
        self.used().next_multiple_of(SECTOR)
    }

    fn file_size(&self) -> usize {
        self.offset(Slot::Second) + self.slot_size()
    }

    /// Whether a file of these bytes is of this layout, so that its slots may be written.
    pub fn is_of(&self, file: &[u8]) -> bool {
        file.starts_with(self.head.as_bytes()) && file.len() == self.file_size()
    }

    /// The bytes of a slot, in place of what `out` holds.
    pub fn encode_slot(&self, record: Record<'_>, out: &mut Vec<u8>) {
        out.clear();
        out.extend([0; 8]);
        out.extend(record.sequence.to_le_bytes());
        out.extend(record.clock.to_le_bytes());
        out.extend(record.values);
        out.extend(tail(record.fault, self.fault).bytes());
        out.resize(self.used(), 0);
        let checksum = slot_checksum(self.fingerprint, out);
        out[..4].copy_from_slice(&checksum.to_le_bytes());
    }

    /// The bytes of a new file, which holds the record in its first slot.
    pub fn encode_file(&self, record: Record<'_>) -> Vec<u8> {
        let mut slot = Vec::new();
        self.encode_slot(record, &mut slot);
        let mut file = self.head.clone().into_bytes();
        file.resize(self.offset(Slot::First), 0);
        file.extend(slot);
        // Written rather than left out: the disk has room for the second slot from now on.
        file.resize(self.file_size(), 0);
        file
    }
}

/// How the last line of a head begins. No variable does: its path has a dot in it.
const CHECKSUM: &str = "crc32\t";

fn slot_checksum(fingerprint: u32, slot: &[u8]) -> u32 {
    Crc32::new().with(&fingerprint.to_le_bytes()).with(&slot[4..]).value()
}

/// The last whole state of a file, of any bytes.
pub(super) fn recover(file: &[u8]) -> Result<Content, Refusal> {
    let title = String::from_utf8_lossy(file.split(|it| *it == b'\n').next().unwrap_or_default());
    match title.strip_prefix(TITLE).map(str::trim_end) {
        Some(version @ (VERSION | WITHOUT_FAULT)) => recover_slots(file, version),
        Some(TEXT_VERSION) => text::recover(file),
        Some(other) => Err(Refusal::Version(other.to_owned())),
        None => Err(Refusal::Foreign),
    }
}

fn recover_slots(file: &[u8], version: &str) -> Result<Content, Refusal> {
    let (layout, programs, variables) =
        head(file, version).ok_or(Refusal::Damaged("the checksum of its header does not match"))?;
    let slots = Slot::BOTH.map(|slot| slot_at(file, &layout, slot));
    let [first, second] = slots.map(|it| decode_slot(&layout, it?));
    let (slot, record) = match (first, second) {
        (Some(first), Some(second)) if second.sequence > first.sequence => (Slot::Second, second),
        (Some(first), _) => (Slot::First, first),
        (None, Some(second)) => (Slot::Second, second),
        (None, None) => return Err(Refusal::Damaged("neither of its two states has the right checksum")),
    };
    let other = slots[usize::from(slot == Slot::First)];
    let other_is_broken = other.is_none_or(|it| it.iter().any(|byte| *byte != 0) && decode_slot(&layout, it).is_none());
    let mut rest = record.values;
    let variables = variables.into_iter().map(|Named { path, ty, size }| {
        let (bytes, after) = rest.split_at(size);
        rest = after;
        (path, ty, Some(bytes.to_vec()))
    });
    Ok(Content {
        programs,
        clock: record.clock,
        variables: variables.collect(),
        found: Some(Found {
            slot,
            sequence: record.sequence,
            values: record.values.to_vec(),
            fault: record.fault.to_owned(),
            other_is_broken,
        }),
    })
}

/// The head's layout, PROGRAMs and variables, if its checksum is right.
fn head(file: &[u8], version: &str) -> Option<(Layout, String, Vec<Named>)> {
    let last = CHECKSUM.len() + 9;
    let line = format!("\n{CHECKSUM}");
    let at = 1 + file.windows(line.len()).position(|it| it == line.as_bytes())?;
    let head = std::str::from_utf8(file.get(..at + last)?).ok()?;
    let mut lines = head[..at].lines().skip(1);
    let programs = lines.next()?.strip_prefix("program\t")?.to_owned();
    let variables = lines.map(named).collect::<Option<Vec<_>>>()?;
    variables.iter().try_fold(0_usize, |sum, it| sum.checked_add(it.size)).filter(|it| *it <= file.len())?;
    let rows = variables.iter().map(|it| (it.path.as_str(), it.ty.as_str(), it.size));
    let layout = Layout::of_version(version, &programs, rows);
    // What reads as the same head is the same text, checksum included.
    (layout.head == head).then_some((layout, programs, variables))
}

fn named(line: &str) -> Option<Named> {
    let mut cells = line.split('\t');
    let named =
        Named { path: cells.next()?.to_owned(), ty: cells.next()?.to_owned(), size: cells.next()?.parse().ok()? };
    cells.next().is_none().then_some(named)
}

fn slot_at<'a>(file: &'a [u8], layout: &Layout, slot: Slot) -> Option<&'a [u8]> {
    let at = layout.offset(slot);
    file.get(at..at + layout.used())
}

fn decode_slot<'a>(layout: &Layout, slot: &'a [u8]) -> Option<Record<'a>> {
    let (head, rest) = slot.split_first_chunk::<SLOT_HEAD>()?;
    let (values, fault) = rest.split_at_checked(layout.size)?;
    let fault = std::str::from_utf8(fault).unwrap_or_default().trim_end_matches('\0');
    let checksum = u32::from_le_bytes(*head.first_chunk()?);
    let sequence = u64::from_le_bytes(*head[8..].first_chunk()?);
    let clock = Time::from_le_bytes(*head.last_chunk()?);
    (checksum == slot_checksum(layout.fingerprint, slot)).then_some(Record { sequence, clock, values, fault })
}

/// The last of a text, as many bytes as there is room for.
fn tail(text: &str, room: usize) -> &str {
    let from = (text.len().saturating_sub(room)..=text.len()).find(|at| text.is_char_boundary(*at));
    from.map_or("", |it| &text[it..])
}

/// A file of these bytes, of which the first line is a number of bytes of the head, with the checksums that it should have: no fuzzer guesses them.
#[cfg(fuzzing)]
pub(super) fn with_checksums(bytes: &[u8]) -> Vec<u8> {
    let (length, rest) = bytes.split_first().map_or((0, bytes), |(it, rest)| (usize::from(*it), rest));
    let (head, slots) = rest.split_at(length.min(rest.len()));
    let mut file = format!("{TITLE}{VERSION}\n").into_bytes();
    file.extend(head);
    file.push(b'\n');
    let fingerprint = crc32(&file);
    file.extend(format!("{CHECKSUM}{fingerprint:08x}\n").bytes());
    let Some((layout, ..)) = self::head(&file, VERSION) else { return file };
    if layout.file_size() > 1 << 16 {
        return file;
    }
    file.resize(layout.file_size(), 0);
    for slot in Slot::BOTH {
        let at = layout.offset(slot);
        for (to, from) in file[at..at + layout.used()].iter_mut().zip(slots) {
            *to = *from;
        }
        let checksum = slot_checksum(layout.fingerprint, &file[at..at + layout.used()]);
        file[at..at + 4].copy_from_slice(&checksum.to_le_bytes());
    }
    file
}

#[cfg(test)]
mod tests;
