//! Variables that keep their values over a restart, in memory and in a file.
//!
//! The file is text: a line a variable with its path, type and bytes (in hexadecimal, in the
//! byte order of the machine, which is little endian on every supported target), and a checksum.
//! A type is written with all that its bytes mean: an enumeration with its values, a subrange
//! with its bounds, a standard block with its pins.

use crate::map::{Map, Type};
use crate::path;
use crate::start::{Event, Part, kept_parts};
use crate::{Error, Machine};
use staunch_runtime::Time;
use std::fmt::Write as _;
use std::fs::File;
use std::io::{self, Read as _, Write as _};
use std::path::Path;

/// The first line, before the version.
const TITLE: &str = "staunch retained variables ";

/// Version 1 named types without what they mean.
const VERSION: &str = "2";

/// A file may be as long as this, and longer for a large state, of which each byte takes two.
const LONGEST: u64 = 16 << 20;

/// The retained variables of a program, as parts that a file can carry over one by one.
#[derive(Clone, Debug)]
pub(crate) struct Retained {
    regions: Vec<Region>,
    /// The PROGRAMs, by which a file is known to be of this program.
    programs: String,
}

/// What a file held beside the values.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Loaded {
    /// Where the clock goes on, which retained timers measure by.
    pub clock: Time,
    /// For each variable of the file that the program no longer retains.
    pub notes: Vec<String>,
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
    pub fn of(map: &Map) -> Self {
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

    /// Reads the file into the state. A file that does not exist changes nothing: it is a first
    /// start. Its bytes are anybody's, also with a right checksum: they become values of the
    /// variables' types.
    pub fn load(&self, map: &Map, path: &Path, machine: &mut dyn Machine) -> Result<Loaded, Error> {
        let damaged = |text: &str| Error::Retain {
            path: path.to_owned(),
            text: format!("{text}; move it away to start with initial values"),
        };
        let limit = LONGEST + 8 * map.size as u64;
        let mut bytes = Vec::new();
        match File::open(path).and_then(|file| file.take(limit + 1).read_to_end(&mut bytes)) {
            Ok(_) => {}
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(Loaded::default()),
            Err(error) => return Err(Error::file(path, "read", error)),
        }
        if bytes.len() as u64 > limit {
            return Err(damaged(&format!("it is longer than {limit} bytes")));
        }
        let title = String::from_utf8_lossy(bytes.split(|it| *it == b'\n').next().unwrap_or_default());
        match title.strip_prefix(TITLE).map(str::trim_end) {
            Some(VERSION) => {}
            Some(other) => {
                let text = format!("its format is version {other}, and this Staunch reads version {VERSION}");
                return Err(damaged(&text));
            }
            None => return Err(damaged("it does not hold retained variables")),
        }
        let body = checked(&bytes).ok_or_else(|| damaged("it is damaged: its checksum does not match"))?;
        let mut lines = body.lines().skip(1);
        let theirs = lines.next().and_then(|it| it.strip_prefix("program\t")).unwrap_or_default();
        if !theirs.split(' ').any(|it| self.programs.split(' ').any(|ours| ours.eq_ignore_ascii_case(it))) {
            let text = format!("it belongs to another program: to PROGRAM {theirs}, not {}", self.programs);
            return Err(damaged(&text));
        }
        let mut loaded = Loaded::default();
        for line in lines {
            match line.strip_prefix("clock\t").map(str::parse) {
                Some(clock) => loaded.clock = clock.map_err(|_| damaged("its clock is not a number"))?,
                None => loaded.notes.extend(self.load_line(map, line, machine)),
            }
        }
        Ok(loaded)
    }

    /// A note if the line's variable cannot be carried over.
    fn load_line(&self, map: &Map, line: &str, machine: &mut dyn Machine) -> Option<String> {
        let mut cells = line.split('\t');
        let (path, ty, hex) = (cells.next()?, cells.next()?, cells.next()?);
        let Some(region) = self.regions.iter().find(|it| it.path.eq_ignore_ascii_case(path)) else {
            return Some(format!("dropped the retained value of `{path}`: {}", self.why_gone(map, path, ty)));
        };
        // IEC names are the same in any case.
        let fits = |it: &Vec<u8>| it.len() == region.size && region.ty.eq_ignore_ascii_case(ty);
        let bytes = from_hex(hex).filter(fits);
        match bytes {
            Some(bytes) => {
                machine.write(region.offset, &bytes);
                None
            }
            None => Some(format!("dropped the retained value of `{path}`: {}", difference(ty, &region.ty))),
        }
    }

    /// Why no region has the path: in parts now, no longer retained, or no longer there.
    fn why_gone(&self, map: &Map, path: &str, ty: &str) -> String {
        let running: Vec<usize> = (0..map.instances.len()).collect();
        let Ok(place) = path::resolve(map, &running, path) else {
            return "the program has no such variable".to_owned();
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

    /// Writes the file in one step: whatever happens, there is the old file or the new one.
    pub fn save(&self, path: &Path, clock: Time, state: &[u8]) -> Result<(), Error> {
        let text = self.text(clock, state);
        write_aside(path, text.as_bytes()).map_err(|error| Error::file(path, "write", error))
    }

    fn text(&self, clock: Time, state: &[u8]) -> String {
        let mut text = format!("{TITLE}{VERSION}\nprogram\t{}\nclock\t{clock}\n", self.programs);
        for region in &self.regions {
            let _ = write!(text, "{}\t{}\t", region.path, region.ty);
            for byte in &state[region.offset..region.offset + region.size] {
                let _ = write!(text, "{byte:02x}");
            }
            text.push('\n');
        }
        let checksum = crc32(text.as_bytes());
        let _ = writeln!(text, "crc32\t{checksum:08x}");
        text
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
        Type::String(_) | Type::Struct(_) => name,
    }
}

/// How two types differ, without lists of values and pins.
fn difference(was: &str, is: &str) -> String {
    let (old, new) = (brief(was), brief(is));
    if old.eq_ignore_ascii_case(new) {
        return format!("it was another {new}");
    }
    format!("it was {old}, and is {new} now")
}

/// The type's text as a user writes it: bounds stay.
fn brief(text: &str) -> &str {
    match text.split_once('(') {
        Some((name, list)) if list.contains([':', '=']) => name,
        _ => text,
    }
}

/// The text before the checksum, if that is right.
fn checked(bytes: &[u8]) -> Option<&str> {
    let text = std::str::from_utf8(bytes).ok()?;
    let at = text.rfind("crc32\t")?;
    let (body, last) = text.split_at(at);
    let checksum = u32::from_str_radix(last.strip_prefix("crc32\t")?.strip_suffix('\n')?, 16).ok()?;
    (crc32(body.as_bytes()) == checksum).then_some(body)
}

fn write_aside(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(format!(".{}.new", std::process::id()));
    let aside = path.with_file_name(name);
    let written = File::create(&aside).and_then(|mut file| {
        file.write_all(bytes)?;
        file.sync_all()
    });
    let renamed = written.and_then(|()| std::fs::rename(&aside, path));
    if renamed.is_err() {
        let _ = std::fs::remove_file(&aside);
    }
    // The folder's entry is on disk only when the folder is; some systems cannot sync a folder.
    if let Some(Ok(folder)) = path.parent().map(File::open) {
        let _ = folder.sync_all();
    }
    renamed
}

fn from_hex(text: &str) -> Option<Vec<u8>> {
    let digits = text.as_bytes().chunks(2);
    digits.map(|pair| u8::from_str_radix(std::str::from_utf8(pair).ok()?, 16).ok()).collect()
}

/// CRC-32 (IEEE 802.3).
fn crc32(bytes: &[u8]) -> u32 {
    let mut crc = u32::MAX;
    for byte in bytes {
        crc ^= u32::from(*byte);
        for _ in 0..8 {
            crc = (crc >> 1) ^ (0xEDB8_8320 & (crc & 1).wrapping_neg());
        }
    }
    !crc
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture::{Bytes, MAP, map, offset_of};
    use crate::start::Start;

    fn file(name: &str) -> std::path::PathBuf {
        let folder = std::env::temp_dir().join(format!("staunch-retain-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        folder.join(name)
    }

    #[test]
    fn only_retained_variables_are_kept() {
        let retained = Retained::of(&map());
        let start = Start::of(&map());
        let paths: Vec<&str> = retained.regions.iter().map(|it| it.path.as_str()).collect();
        assert_eq!(paths, ["Globals.total", "main.mixer.count"]);
        let mut machine = Bytes::new(&map());
        machine.state.fill(1);
        start.again(Event::Restart, &mut machine);
        assert_eq!(machine.state.iter().filter(|it| **it == 1).count(), 6);
        assert_eq!(machine.state[offset_of("total")], 1);
    }

    #[test]
    fn a_file_carries_values_over() {
        let (path, retained) = (file("values"), Retained::of(&map()));
        let mut machine = Bytes::new(&map());
        assert_eq!(retained.load(&map(), &path, &mut machine).unwrap().notes, Vec::<String>::new());
        machine.state[offset_of("total")] = 42;
        retained.save(&path, 0, &machine.state).unwrap();
        machine.init();
        assert_eq!(retained.load(&map(), &path, &mut machine).unwrap().notes, Vec::<String>::new());
        assert_eq!(machine.state[offset_of("total")], 42);
    }

    #[test]
    fn an_edited_program_keeps_what_still_fits() {
        let path = file("edited");
        Retained::of(&map()).save(&path, 0, &[3; 128]).unwrap();
        let mut retained = Retained::of(&map());
        retained.regions[0].ty = "REAL".to_owned();
        let edited = Map::parse(&MAP.replace("field\tcount", "field\tcounter")).unwrap();
        retained.regions[1].path = "main.mixer.counter".to_owned();
        let mut machine = Bytes::new(&map());
        assert_eq!(
            retained.load(&edited, &path, &mut machine).unwrap().notes,
            [
                "dropped the retained value of `Globals.total`: it was DINT, and is REAL now",
                "dropped the retained value of `main.mixer.count`: the program has no such variable",
            ]
        );
        assert!(machine.state.iter().all(|it| *it == 0));
    }

    /// The notes when a program with the one variable `v` is edited.
    fn edited(name: &str, before: &str, after: &str) -> Vec<String> {
        let path = file(name);
        let of = |text: &str| {
            let (types, v) = text.rsplit_once('\n').unwrap_or(("file\t0\tp.st", text));
            let mut cells: Vec<&str> = v.split('\t').collect();
            let field = cells.join("\t");
            cells.swap(1, 2);
            cells.swap(0, 1);
            let variable = cells.join("\t");
            Map::parse(&format!(
                "map\t1\nmachine\t64\t8\n{types}\nstruct\t9\tP\t32\tprogram\nfield\tv\t{field}\n\
                 instance\t0\tmain\tP\tstruct:9\t0\t-\t0\nvariable\t0\tv\t{variable}\n"
            ))
            .unwrap()
        };
        let (old, new) = (of(before), of(after));
        Retained::of(&old).save(&path, 0, &[1; 64]).unwrap();
        let mut machine = Bytes::new(&new);
        let notes = Retained::of(&new).load(&new, &path, &mut machine).unwrap().notes;
        assert_eq!(machine.state[0] == 0, !notes.is_empty(), "{name}");
        notes
    }

    #[test]
    fn a_value_stays_only_where_its_type_means_the_same() {
        let dropped = |why: &str| [format!("dropped the retained value of `main.v`: {why}")];
        let color = |values: &str| format!("enum\t0\tColor\ti16\t{values}\nenum:0\t0\tvar\tretain\t-\t-");
        assert!(edited("enum-same", &color("Red=0\tGreen=1"), &color("RED=0\tGreen=1")).is_empty());
        assert_eq!(edited("enum", &color("Red=0\tGreen=1"), &color("Green=0\tRed=1")), dropped("it was another Color"));
        let int = |range: &str| format!("INT\t0\tvar\tretain\t-\t{range}");
        assert!(edited("range-same", &int("0..100"), &int("0..100")).is_empty());
        assert_eq!(
            edited("range", &int("0..100"), &int("0..10")),
            dropped("it was INT(0..100), and is INT(0..10) now")
        );
        assert_eq!(edited("no-range", &int("-"), &int("0..10")), dropped("it was INT, and is INT(0..10) now"));
        let counter = |number: &str| {
            let pins = format!("field\tPV\t{number}\t0\tinput\t-\t-\t-\nfield\tCV\t{number}\t2\toutput\t-\t-\t-");
            format!("block\t7\tCTD\t4\n{pins}\nblock:7\t0\tvar\tretain\t-\t-")
        };
        assert!(edited("block-same", &counter("INT"), &counter("INT")).is_empty());
        assert_eq!(edited("block", &counter("INT"), &counter("WORD")), dropped("it was another CTD"));
        let array = counter("INT").replace("\nblock:7\t", "\narray\t0\t1\t3\tblock:7\t4\narray:0\t");
        let words = array.replace("INT", "WORD");
        assert_eq!(edited("blocks", &array, &words), dropped("it was another ARRAY[1..3] OF CTD"));
    }

    #[test]
    fn a_variable_that_is_no_longer_retained_is_told_from_one_that_is_gone() {
        let int = "INT\t0\tvar\tretain\t-\t-";
        assert_eq!(
            edited("kept", int, &int.replace("retain", "-")),
            ["dropped the retained value of `main.v`: the program has this variable, but does not retain it"]
        );
        let point = "struct\t0\tPoint\t2\tstructure\nfield\tx\tINT\t0\tmember\t-\t-\t-\n\
                     struct:0\t0\tvar\tretain\t-\t-";
        assert_eq!(
            edited("point", int, point),
            ["dropped the retained value of `main.v`: it was INT, and is Point now"]
        );
        assert_eq!(
            edited("no-point", point, int),
            ["dropped the retained value of `main.v.x`: the program has no such variable"]
        );
    }

    #[test]
    fn a_file_that_cannot_be_trusted_is_refused() {
        let (path, mut retained) = (file("damaged"), Retained::of(&map()));
        let mut machine = Bytes::new(&map());
        retained.save(&path, 0, &machine.state).unwrap();
        let good = std::fs::read_to_string(&path).unwrap();
        let mut error = |text: &str, retained: &Retained| {
            std::fs::write(&path, text).unwrap();
            retained.load(&map(), &path, &mut machine).unwrap_err().to_string()
        };
        assert!(error(&good.replace("00", "01"), &retained).contains("checksum"));
        assert!(error(&good[..good.len() - 3], &retained).contains("checksum"));
        let old = good.replacen("variables 2", "variables 1", 1);
        assert!(
            error(&old, &retained).contains("its format is version 1, and this Staunch reads version 2; move it away")
        );
        assert!(error("hello", &retained).contains("does not hold retained"));
        retained.programs = "Mixer".to_owned();
        assert!(error(&good, &retained).contains("another program: to PROGRAM Garage, not Mixer"));
    }

    /// Loads a file with this text and a right checksum; the state after it.
    fn forged(name: &str, text: &str) -> (Result<Loaded, Error>, Vec<u8>) {
        let path = file(name);
        std::fs::write(&path, format!("{text}crc32\t{:08x}\n", crc32(text.as_bytes()))).unwrap();
        let mut machine = Bytes::new(&map());
        let loaded = Retained::of(&map()).load(&map(), &path, &mut machine);
        (loaded, machine.state)
    }

    #[test]
    fn a_forged_file_is_refused_or_made_into_values() {
        let head = "staunch retained variables 2\nprogram\tGarage\n";
        let long = "x".repeat(1 << 20);
        for (line, note) in [
            ("Globals.total\tDINT\t2a000000", None),
            ("Globals.total\tDINT\t2a0000", Some("it was another DINT")),
            ("Globals.total\tDINT\t2a000000000000000000", Some("it was another DINT")),
            ("Globals.total\tDINT\tzz000000", Some("it was another DINT")),
            ("Globals.total\tDINT\t", Some("it was another DINT")),
            ("Globals.total\tSTRING[65535]\t2a000000", Some("it was STRING[65535], and is DINT now")),
            ("Globals.total[9223372036854775807]\tDINT\t2a000000", Some("the program has no such variable")),
            ("main.m[-1,99999999999999999999]\tINT\t2a00", Some("the program has no such variable")),
            ("main.name\tSTRING[4]\tffff01020304", Some("but does not retain it")),
            ("%IX0.0\tBOOL\tff", Some("but does not retain it")),
            (&long, None),
            (&format!("{long}\tDINT\t00"), Some("the program has no such variable")),
        ] {
            let (loaded, state) = forged("forged", &format!("{head}{line}\n"));
            let notes = loaded.unwrap().notes;
            assert_eq!(notes.is_empty(), note.is_none(), "{line}");
            assert!(notes.iter().zip(note).all(|(found, wanted)| found.contains(wanted)), "{line}: {notes:?}");
            assert_eq!(state.iter().any(|it| *it != 0), line.contains("DINT\t2a000000") && note.is_none(), "{line}");
        }
        for (line, problem) in [
            ("clock\t99999999999999999999\n", "its clock is not a number"),
            ("clock\tsoon\n", "its clock is not a number"),
        ] {
            let error = forged("clock", &format!("{head}{line}")).0.unwrap_err().to_string();
            assert!(error.contains(problem), "{error}");
        }
        assert_eq!(forged("past", &format!("{head}clock\t{}\n", i64::MIN)).0.unwrap().clock, i64::MIN);
    }

    #[test]
    fn a_file_without_an_end_is_refused() {
        let path = file("huge");
        File::create(&path).unwrap().set_len(1 << 40).unwrap();
        let error = Retained::of(&map()).load(&map(), &path, &mut Bytes::new(&map())).unwrap_err();
        assert!(error.to_string().contains("it is longer than 16778240 bytes"), "{error}");
        std::fs::remove_file(&path).unwrap();
    }

    #[test]
    fn the_checksum_is_the_usual_one() {
        assert_eq!(crc32(b"123456789"), 0xCBF4_3926);
    }
}
