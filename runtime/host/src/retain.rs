//! Variables that keep their values over a restart, in memory and in a file.
//!
//! A type is written with everything that gives its bytes a meaning: an enumeration with its values, a subrange with its
//! bounds, a standard block with its pins.

mod content;
mod format;
mod keeper;
mod kept;
mod lock;
mod storage;
mod text;
mod writer;

use crate::domain::Domain;
use crate::map::{Map, Type};
use crate::path;
use crate::start::{Event, Part, kept_parts};
use crate::{Error, Machine};
use content::{Content, Found};
use format::Layout;
use keeper::Keeper;
use kept::Kept;
use staunch_runtime::Time;
use std::ops::Range;
use std::path::{Path, PathBuf};
use storage::Disk;
use writer::Writer;

pub(crate) use writer::Pace;

/// A file may be as long as this, and longer for a large state: version 2 took two bytes for each.
const LONGEST: u64 = 16 << 20;

/// A program's retained variables and the file that they are kept in.
#[derive(Debug)]
pub(crate) struct Retention {
    path: PathBuf,
    /// The parts of the state that are kept, in the order of the file.
    kept: Kept,
    /// The kept values after the last whole scan, and the clock at that time: a scan that faults, or that a power cut
    /// interrupts, leaves no trace.
    whole: Vec<u8>,
    clock: Time,
    /// The fault that ended a run, if no run has ended normally since; otherwise empty.
    fault: String,
    saving: Saving,
}

/// How a run ends, for the next one to know.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Ending<'a> {
    Well,
    /// With the fault that the text names.
    Fault(&'a str),
    /// Early, but not because of the program: an earlier fault is still recorded.
    Early,
}

/// When values are written to disk.
#[allow(clippy::large_enum_variant, reason = "a run has one; paths are larger on Windows")]
#[derive(Debug)]
enum Saving {
    /// When the run requests it; the run waits.
    Now(Keeper<Disk>),
    /// After every change, in a separate thread.
    Always(Writer),
    Ended,
}

/// What a file held in addition to the values.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Loaded {
    /// The time from which the clock continues; retained timers use it.
    pub clock: Time,
    /// For each variable of the file that the program no longer retains, and for a damaged half of the file.
    pub notes: Vec<String>,
}

impl Retention {
    /// Reads the file into the state. A file that does not exist changes nothing: this is a first start. Its
    /// bytes are not trusted, even with a correct checksum: they become valid values of the variables' types.
    pub fn load(map: &Map, path: &Path, machine: &mut dyn Machine) -> Result<(Self, Loaded), Error> {
        let retained = Retained::of(map);
        let layout = retained.layout();
        let refused = |text: &str| Error::Retain {
            path: path.to_owned(),
            text: format!("{text}; move it away to start with initial values"),
        };
        let limit = LONGEST + 8 * map.size as u64;
        let (disk, bytes) = Disk::open(path, limit + 1).map_err(|error| Error::file(path, "read", error))?;
        let (mut loaded, mut found, mut fault) = (Loaded::default(), None, String::new());
        if let Some(bytes) = bytes {
            if bytes.len() as u64 > limit {
                return Err(refused(&format!("it is longer than {limit} bytes")));
            }
            let content = format::recover(&bytes).map_err(|it| refused(&it.text()))?;
            loaded = retained.load(map, &content, machine).map_err(|it| refused(&it))?;
            fault = content.found.as_ref().map_or_else(String::new, |it| it.fault.clone());
            found = content.found.filter(|_| layout.is_of(&bytes)).map(|it| (content.clock, it));
        }
        let saving = Saving::Now(Keeper::new(disk, layout, found));
        let kept = Kept::new(retained.ranges(), &Domain::of(map));
        let whole = kept.of(machine.state());
        Ok((Self { path: path.to_owned(), kept, whole, clock: loaded.clock, fault, saving }, loaded))
    }

    /// From now on, changes are saved while the program runs.
    pub fn save_always(&mut self, pace: Pace) -> Result<(), Error> {
        let Saving::Now(keeper) = std::mem::replace(&mut self.saving, Saving::Ended) else {
            return Ok(());
        };
        let path = self.path.clone();
        let tell = move |text: &str| crate::error::tell(format_args!("warning: {}: {text}", path.display()));
        let writer = Writer::start(keeper, pace, (&self.whole, &self.fault), tell);
        self.saving = Saving::Always(writer.map_err(|error| Error::file(&self.path, "write", error))?);
        Ok(())
    }

    /// After each whole scan: remembers what is kept, and hands over what has changed, where changes are saved
    /// while the program runs. It allocates nothing.
    pub fn offer(&mut self, clock: Time, state: &[u8]) {
        self.clock = clock;
        let changed = self.kept.copy_changed(state, &mut self.whole);
        match &mut self.saving {
            Saving::Always(writer) if changed => writer.offer(clock, &self.whole),
            Saving::Always(_) | Saving::Now(_) | Saving::Ended => {}
        }
    }

    /// Saves the values of a run that continues.
    pub fn save(&mut self, clock: Time, state: &[u8]) -> Result<(), Error> {
        self.offer(clock, state);
        match &mut self.saving {
            Saving::Now(keeper) => {
                let saved = keeper.save(clock, &self.whole, &self.fault);
                saved.map_err(|error| Error::file(&self.path, "write", error))
            }
            Saving::Always(_) | Saving::Ended => Ok(()),
        }
    }

    /// Saves the values and the clock of the last whole scan of a run that ends, and how it ends; waits for the
    /// disk.
    pub fn finish(&mut self, ending: Ending<'_>) -> Result<(), Error> {
        match ending {
            Ending::Well => self.fault.clear(),
            Ending::Fault(text) => text.clone_into(&mut self.fault),
            Ending::Early => {}
        }
        let saved = match std::mem::replace(&mut self.saving, Saving::Ended) {
            Saving::Always(writer) => writer.finish(self.clock, &self.whole, &self.fault),
            Saving::Now(mut keeper) => {
                let saved = keeper.save(self.clock, &self.whole, &self.fault);
                self.saving = Saving::Now(keeper);
                saved
            }
            Saving::Ended => Ok(()),
        };
        saved.map_err(|error| Error::file(&self.path, "write", error))
    }
}

/// The retained variables of a program, as parts that a file can carry over one by one.
#[derive(Clone, Debug)]
struct Retained {
    regions: Vec<Region>,
    /// The PROGRAMs, by which a file is known to be of this program.
    programs: String,
}

#[derive(Clone, Debug, PartialEq, Eq)]
struct Region {
    path: String,
    /// All that decides what the bytes mean; see [`type_text`].
    ty: String,
    offset: usize,
    size: usize,
}

impl Retained {
    fn of(map: &Map) -> Self {
        let region = |it: Part| {
            let (ty, size) = (type_text(map, it.ty, it.range), map.size_of(it.ty));
            Region { path: it.path, ty, offset: it.offset, size }
        };
        let regions = kept_parts(map, Event::Restart).into_iter().map(region).collect();
        let mut programs: Vec<&str> = map.instances.iter().map(|it| it.program.as_str()).collect();
        programs.sort_unstable();
        programs.dedup();
        Self { regions, programs: programs.join(" ") }
    }

    fn layout(&self) -> Layout {
        Layout::new(&self.programs, self.regions.iter().map(|it| (it.path.as_str(), it.ty.as_str(), it.size)))
    }

    fn ranges(&self) -> impl Iterator<Item = Range<usize>> {
        self.regions.iter().map(|it| it.offset..it.offset + it.size)
    }

    /// Why the content is of no use, or what it held.
    fn load(&self, map: &Map, content: &Content, machine: &mut dyn Machine) -> Result<Loaded, String> {
        let theirs = &content.programs;
        if !theirs.split(' ').any(|it| self.programs.split(' ').any(|ours| ours.eq_ignore_ascii_case(it))) {
            return Err(format!("it belongs to another program: to PROGRAM {theirs}, not {}", self.programs));
        }
        let mut loaded = Loaded { clock: content.clock, notes: Vec::new() };
        if let Some(fault) = content.found.as_ref().map(|it| &it.fault).filter(|it| !it.is_empty()) {
            loaded.notes.push(format!(
                "a run ended with a fault, and no run has ended normally since: {fault}; the values are those of \
                 the scan before"
            ));
        }
        if content.found.as_ref().is_some_and(|it: &Found| it.other_is_broken) {
            let text =
                "one of its two states is incomplete, as after a power cut while it was written; the other is used";
            loaded.notes.push(text.to_owned());
        }
        for (path, ty, bytes) in &content.variables {
            loaded.notes.extend(self.load_variable(map, (path, ty, bytes.as_deref()), machine));
        }
        Ok(loaded)
    }

    /// A note if the variable cannot be carried over.
    fn load_variable(
        &self,
        map: &Map,
        (path, ty, bytes): (&str, &str, Option<&[u8]>),
        machine: &mut dyn Machine,
    ) -> Option<String> {
        let Some(region) = self.regions.iter().find(|it| it.path.eq_ignore_ascii_case(path)) else {
            return Some(format!("dropped the retained value of {}: {}", shown(path), self.why_gone(map, path, ty)));
        };
        // IEC names are the same in any case.
        let fits = |it: &&[u8]| it.len() == region.size && region.ty.eq_ignore_ascii_case(ty);
        match bytes.filter(fits) {
            Some(bytes) => {
                machine.write(region.offset, bytes);
                None
            }
            None => Some(format!("dropped the retained value of {}: {}", shown(path), difference(ty, &region.ty))),
        }
    }

    /// Why no region has the path: in parts now, no longer retained, or no longer there.
    fn why_gone(&self, map: &Map, path: &str, ty: &str) -> String {
        let running: Vec<usize> = (0..map.instances.len()).collect();
        let Ok(place) = path::resolve(map, &running, path) else {
            return "the program does not have this variable".to_owned();
        };
        let is_part = |it: &Region| {
            let (start, rest) = (it.path.get(..path.len()), it.path.get(path.len()..));
            start.is_some_and(|it| it.eq_ignore_ascii_case(path)) && rest.is_some_and(|it| it.starts_with(['.', '[']))
        };
        if self.regions.iter().any(is_part) {
            return difference(ty, &type_text(map, place.ty, place.range));
        }
        "the program has this variable, but does not retain it".to_owned()
    }
}

/// A variable by its name; what only keeps the bits of several by their address.
fn shown(path: &str) -> String {
    match path.strip_prefix("Globals.bits_of_") {
        Some(address) => format!("the variables that share bits from `%{}` on", address.replace('_', ".")),
        None => format!("`{path}`"),
    }
}

/// A type with all that decides what its bytes mean: `Color(Red=0,Green=1)`, `INT(0..100)`,
/// `CTU(CU:BOOL,R:BOOL,PV:INT,Q:BOOL,CV:INT,m:BOOL)`.
fn type_text(map: &Map, ty: Type, range: Option<(i128, i128)>) -> String {
    let name = map.type_name(ty);
    match ty {
        Type::Elementary(_) => range.map_or_else(|| name.clone(), |(low, high)| format!("{name}({low}..{high})")),
        Type::Enum(id) => {
            let values = map.enums.get(&id).map_or(&[][..], |it| &it.values);
            let values: Vec<String> = values.iter().map(|(value, number)| format!("{value}={number}")).collect();
            format!("{name}({})", values.join(","))
        }
        Type::Array(_) => map
            .array(ty)
            .map_or(name, |it| format!("ARRAY[{}..{}] OF {}", it.low, it.high, type_text(map, it.element, range))),
        Type::Block(_) => {
            let pins = map.structure(ty).map_or(&[][..], |it| &it.members);
            let pins: Vec<String> =
                pins.iter().map(|it| format!("{}:{}", it.name, type_text(map, it.ty, it.range))).collect();
            format!("{name}({})", pins.join(","))
        }
        // It is the number of an object, which another build may have for another.
        Type::Reference => {
            let objects: Vec<String> = map.objects.iter().map(|(offset, size)| format!("{offset},{size}")).collect();
            format!("{name}({:08x})", staunch_runtime::crc32(objects.join(";").as_bytes()))
        }
        Type::Bit(_) | Type::String(_) | Type::Characters(_) | Type::Struct(_) => name,
    }
}

/// How two types differ, without lists of values and pins.
fn difference(was: &str, is: &str) -> String {
    let (old, new) = (brief(was), brief(is));
    if old.eq_ignore_ascii_case(new) {
        return format!("it was another {new}");
    }
    format!("it was {old}, and is now {new}")
}

/// The type's text as a user writes it: bounds stay.
fn brief(text: &str) -> &str {
    match text.split_once('(') {
        Some((name, list)) if list.contains([':', '=']) => name,
        _ => text,
    }
}

/// What fuzzers hold it to: any bytes are a content or refused, and what was recovered has the right sizes.
#[cfg(fuzzing)]
pub(crate) fn recovered(bytes: &[u8]) {
    if let Ok(content) = format::recover(&format::with_checksums(bytes)) {
        let sizes = content.variables.iter().filter_map(|it| it.2.as_ref()).map(Vec::len).sum::<usize>();
        assert!(content.found.is_none_or(|it| it.values.len() == sizes));
    }
    let _ = format::recover(bytes);
}

#[cfg(test)]
mod tests;
