//! Retained variables from file to state; `faulty` is a disk for the tests below this folder.

pub(super) mod faulty;

use super::*;
use crate::fixture::{Bytes, MAP, map, offset_of};
use crate::start::Start;

fn file(name: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("staunch-retain-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    folder.join(name)
}

fn load(map: &Map, path: &Path, machine: &mut Bytes) -> Result<Loaded, Error> {
    Retention::load(map, path, machine).map(|it| it.1)
}

/// Saves a state in place of what the file held.
fn save(map: &Map, path: &Path, state: &[u8]) {
    let _ = std::fs::remove_file(path);
    Retention::load(map, path, &mut Bytes::new(map)).unwrap().0.save(0, state).unwrap();
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
    let path = file("values");
    let mut machine = Bytes::new(&map());
    assert_eq!(load(&map(), &path, &mut machine).unwrap(), Loaded::default());
    for number in [42, 43, 44] {
        let (mut retention, _) = Retention::load(&map(), &path, &mut machine).unwrap();
        machine.state[offset_of("total")] = number;
        retention.save(7, &machine.state).unwrap();
        drop(retention);
        machine.init();
        assert_eq!(load(&map(), &path, &mut machine).unwrap(), Loaded { clock: 7, notes: Vec::new() });
        assert_eq!(machine.state[offset_of("total")], number);
    }
}

#[test]
fn an_edited_program_keeps_what_still_fits() {
    let path = file("edited");
    save(&map(), &path, &[3; 128]);
    let edited = MAP.replace("field\tcount", "field\tcounter").replace("field\ttotal\tDINT", "field\ttotal\tREAL");
    let edited = Map::parse(&edited).unwrap();
    let mut machine = Bytes::new(&edited);
    assert_eq!(
        load(&edited, &path, &mut machine).unwrap().notes,
        [
            "dropped the retained value of `Globals.total`: it was DINT, and is now REAL",
            "dropped the retained value of `main.mixer.count`: the program does not have this variable",
        ]
    );
    assert!(machine.state.iter().all(|it| *it == 0));
    // The file is of another form now: it is made anew.
    let (mut retention, _) = Retention::load(&edited, &path, &mut machine).unwrap();
    retention.save(0, &[4; 128]).unwrap();
    drop(retention);
    assert_eq!(load(&edited, &path, &mut machine).unwrap().notes, [""; 0]);
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
    save(&old, &path, &[1; 64]);
    let mut machine = Bytes::new(&new);
    let notes = load(&new, &path, &mut machine).unwrap().notes;
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
    assert_eq!(edited("range", &int("0..100"), &int("0..10")), dropped("it was INT(0..100), and is now INT(0..10)"));
    assert_eq!(edited("no-range", &int("-"), &int("0..10")), dropped("it was INT, and is now INT(0..10)"));
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
    assert_eq!(edited("point", int, point), ["dropped the retained value of `main.v`: it was INT, and is now Point"]);
    assert_eq!(
        edited("no-point", point, int),
        ["dropped the retained value of `main.v.x`: the program does not have this variable"]
    );
}

#[test]
fn a_file_that_cannot_be_trusted_is_refused() {
    let path = file("damaged");
    save(&map(), &path, &[0; 128]);
    let good = std::fs::read(&path).unwrap();
    let error = |bytes: &[u8], map: &Map| {
        std::fs::write(&path, bytes).unwrap();
        load(map, &path, &mut Bytes::new(map)).unwrap_err().to_string()
    };
    let mut flipped = good.clone();
    flipped[40] ^= 1;
    assert!(error(&flipped, &map()).contains("it is damaged: the checksum of its header does not match; move it away"));
    assert!(error(&good[..4100], &map()).contains("it is damaged: neither of its two states has the right checksum"));
    assert!(
        error(b"staunch retained variables 1\n", &map()).contains("its format is version 1, and this Staunch reads")
    );
    assert!(error(b"hello", &map()).contains("does not hold retained"));
    let mixer = Map::parse(&MAP.replace("main\tGarage", "main\tMixer")).unwrap();
    assert!(error(&good, &mixer).contains("another program: to PROGRAM Garage, not Mixer"));
}

#[test]
fn a_state_that_was_cut_off_gives_way_to_the_one_before() {
    let path = file("cut-off");
    let mut state = [0; 128];
    let (mut retention, _) = Retention::load(&map(), &path, &mut Bytes::new(&map())).unwrap();
    for number in [1, 2] {
        state[offset_of("total")] = number;
        retention.save(0, &state).unwrap();
    }
    drop(retention);
    let mut bytes = std::fs::read(&path).unwrap();
    assert_eq!(bytes.len(), 3 * format::SECTOR);
    bytes[2 * format::SECTOR + 24] ^= 4;
    std::fs::write(&path, bytes).unwrap();
    let mut machine = Bytes::new(&map());
    let notes = load(&map(), &path, &mut machine).unwrap().notes;
    assert!(notes.len() == 1 && notes[0].starts_with("one of its two states is incomplete"), "{notes:?}");
    assert_eq!(machine.state[offset_of("total")], 1);
}

/// A file of version 2.
#[test]
fn an_old_file_is_read_and_made_anew() {
    let head = "staunch retained variables 2\nprogram\tGarage\nclock\t90\n";
    let (loaded, state) = forged("old", &format!("{head}Globals.total\tDINT\t2a000000\nmain.mixer.count\tINT\t0300\n"));
    assert_eq!(loaded.unwrap(), Loaded { clock: 90, notes: Vec::new() });
    assert_eq!(state[offset_of("total")], 42);
    let (path, mut machine) = (file("old"), Bytes::new(&map()));
    let (mut retention, _) = Retention::load(&map(), &path, &mut machine).unwrap();
    retention.save(100, &machine.state).unwrap();
    drop(retention);
    assert!(std::fs::read(&path).unwrap().starts_with(b"staunch retained variables 4\n"));
    assert_eq!(load(&map(), &path, &mut machine).unwrap().clock, 100);
    assert_eq!(machine.state[offset_of("total")], 42);
}

/// Loads a file with this text and a right checksum; the state after it.
fn forged(name: &str, text: &str) -> (Result<Loaded, Error>, Vec<u8>) {
    let path = file(name);
    std::fs::write(&path, format!("{text}crc32\t{:08x}\n", staunch_runtime::crc32(text.as_bytes()))).unwrap();
    let mut machine = Bytes::new(&map());
    let loaded = load(&map(), &path, &mut machine);
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
        ("Globals.total\tSTRING[65535]\t2a000000", Some("it was STRING[65535], and is now DINT")),
        ("Globals.total[9223372036854775807]\tDINT\t2a000000", Some("the program does not have this variable")),
        ("main.m[-1,99999999999999999999]\tINT\t2a00", Some("the program does not have this variable")),
        ("main.name\tSTRING[4]\tffff01020304", Some("but does not retain it")),
        ("%IX0.0\tBOOL\tff", Some("but does not retain it")),
        (&long, None),
        (&format!("{long}\tDINT\t00"), Some("the program does not have this variable")),
    ] {
        let (loaded, state) = forged("forged", &format!("{head}{line}\n"));
        let notes = loaded.unwrap().notes;
        assert_eq!(notes.is_empty(), note.is_none(), "{line}");
        assert!(notes.iter().zip(note).all(|(found, wanted)| found.contains(wanted)), "{line}: {notes:?}");
        assert_eq!(state.iter().any(|it| *it != 0), line.contains("DINT\t2a000000") && note.is_none(), "{line}");
    }
    for (line, problem) in
        [("clock\t99999999999999999999\n", "its clock is not a number"), ("clock\tsoon\n", "its clock is not a number")]
    {
        let error = forged("clock", &format!("{head}{line}")).0.unwrap_err().to_string();
        assert!(error.contains(problem), "{error}");
    }
    assert_eq!(forged("past", &format!("{head}clock\t{}\n", i64::MIN)).0.unwrap().clock, i64::MIN);
}

#[test]
fn a_file_without_an_end_is_refused() {
    let path = file("huge");
    std::fs::File::create(&path).unwrap().set_len(1 << 40).unwrap();
    let error = load(&map(), &path, &mut Bytes::new(&map())).unwrap_err();
    assert!(error.to_string().contains("it is longer than 16778240 bytes"), "{error}");
    std::fs::remove_file(&path).unwrap();
}

/// Whether a run ended by a fault is kept with the values until one ends well, and the values are those of the last
/// whole scan.
#[test]
fn a_fault_is_told_until_a_run_ends_well() {
    let path = file("faulted");
    save(&map(), &path, &[1; 128]);
    let end = |scan: Option<u8>, ending| {
        let mut machine = Bytes::new(&map());
        let (mut retention, loaded) = Retention::load(&map(), &path, &mut machine).unwrap();
        scan.iter().for_each(|it| retention.offer(5, &[*it; 128]));
        retention.finish(ending).unwrap();
        (machine.state[offset_of("total")], loaded.notes)
    };
    let told = |(number, notes): (u8, Vec<String>), expected| {
        assert_eq!(number, expected);
        assert!(notes.len() == 1 && notes[0].contains("p.st:7:1: fault: division by zero"), "{notes:?}");
    };
    assert_eq!(end(Some(2), Ending::Fault("p.st:7:1: fault: division by zero")), (1, vec![]));
    // A fault in the first scan.
    told(end(None, Ending::Fault("p.st:7:1: fault: division by zero")), 2);
    told(end(Some(3), Ending::Early), 2);
    told(end(Some(4), Ending::Well), 3);
    assert_eq!(end(None, Ending::Well), (4, vec![]));
}
