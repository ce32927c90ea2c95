//! Retained variables between processes.

use super::{Folder, has};

const PROGRAM: &str = "PROGRAM Main
VAR_INPUT pulse : BOOL; END_VAR
VAR RETAIN kept : INT; other : DINT := 4; END_VAR
VAR c : CSCAPE.R_CTU; plain : INT; END_VAR
c(CU := pulse, RESET := FALSE, PV := 100, RCV := kept);
plain := plain + 1;
other := other + 1;
END_PROGRAM
";

const RUN: &str = "run main.st --stimulus in.csv --trace - --retain plant.retain --vars kept,other,c.CV,plain";

fn folder(name: &str) -> Folder {
    Folder::with(name, &[("main.st", PROGRAM), ("in.csv", "scan,pulse\n1,TRUE\n2,TRUE\n")])
}

#[test]
fn they_live_from_process_to_process() {
    let folder = folder("retain");
    assert_eq!(folder.staunch(RUN).out(0), "scan,time_ms,kept,other,c.CV,plain\n1,0,1,5,1,1\n2,10,2,6,2,2\n");
    assert_eq!(folder.staunch(RUN).out(0), "scan,time_ms,kept,other,c.CV,plain\n1,0,3,7,3,1\n2,10,4,8,4,2\n");
    let interpreted = folder.staunch(&format!("{RUN} --backend interpret")).out(0);
    assert_eq!(interpreted, "scan,time_ms,kept,other,c.CV,plain\n1,0,5,9,5,1\n2,10,6,10,6,2\n");
}

/// The members of a UNION are there once, as its bytes: none has a value of its own that another one would be dropped for.
#[test]
fn a_union_is_kept_as_its_bytes() {
    let text = "TYPE Number : UNION bytes : ARRAY[1..4] OF BYTE; number : UDINT; text : STRING[3]; END_UNION; END_TYPE
PROGRAM Main VAR RETAIN w : Number; END_VAR w.number := w.number + 16#00202122; END_PROGRAM";
    let folder = Folder::with("union", &[("main.st", text)]);
    let run = "run main.st --scans 1 --trace - --retain plant.retain --vars w.number,w.bytes[1],w.text";
    assert_eq!(folder.staunch(run).out(0), "scan,time_ms,w.number,w.bytes[1],w.text\n1,0,2105634,34,\"\"\"! \"\n");
    let again = folder.staunch(run);
    assert_eq!(again.err, "");
    assert_eq!(again.out(0), "scan,time_ms,w.number,w.bytes[1],w.text\n1,0,4211268,68,DB@\n");
}

#[test]
fn an_edited_program_takes_what_still_fits() {
    let folder = folder("edited");
    folder.staunch(RUN).out(0);
    folder.write("main.st", PROGRAM.replace("other : DINT := 4", "more : INT; other : LINT := 4"));
    let ran = folder.staunch(RUN);
    has(&ran.err, &["other"]);
    assert_eq!(ran.out(0), "scan,time_ms,kept,other,c.CV,plain\n1,0,3,5,3,1\n2,10,4,6,4,2\n");
}

/// The head's text takes less than a sector; the first slot is the next, with a head of 24 bytes.
const SECTOR: usize = 4096;
const SLOT_HEAD: usize = 24;
/// Room for the text of a fault, after the values.
const FAULT: usize = 232;

#[test]
fn a_damaged_file_is_refused_and_kept() {
    let folder = folder("damaged");
    folder.staunch(RUN).out(0);
    let whole = std::fs::read(folder.0.join("plant.retain")).unwrap();
    let head = whole.iter().position(|it| *it == 0).unwrap();
    let values = 2 + 4;
    for cut in [0, 1, head / 2, head, SECTOR, SECTOR + SLOT_HEAD + values + FAULT - 1] {
        folder.write("plant.retain", &whole[..cut]);
        has(&folder.staunch(RUN).err(2), &["plant.retain", "move it away"]);
        assert_eq!(std::fs::read(folder.0.join("plant.retain")).unwrap(), &whole[..cut]);
    }
    for flipped in (0..head).step_by(7).chain(SECTOR..SECTOR + SLOT_HEAD + values) {
        let mut bytes = whole.clone();
        bytes[flipped] ^= 0x10;
        folder.write("plant.retain", &bytes);
        folder.staunch(RUN).err(2);
        assert_eq!(std::fs::read(folder.0.join("plant.retain")).unwrap(), bytes);
    }
}

#[test]
fn a_damaged_state_gives_way_to_the_one_before_and_a_note() {
    let folder = folder("cut-off");
    folder.staunch(RUN).out(0);
    assert_eq!(folder.staunch(RUN).out(0).lines().last(), Some("2,10,4,8,4,2"));
    let mut bytes = std::fs::read(folder.0.join("plant.retain")).unwrap();
    bytes[2 * SECTOR + SLOT_HEAD] ^= 0x10;
    folder.write("plant.retain", &bytes);
    let ran = folder.staunch(RUN);
    has(&ran.err, &["note: plant.retain: one of its two states is incomplete"]);
    assert_eq!(ran.out(0).lines().last(), Some("2,10,4,8,4,2"));
}

#[test]
fn a_file_of_another_program_is_refused() {
    let folder = folder("another");
    folder.staunch(RUN).out(0);
    folder.write("main.st", PROGRAM.replace("Main", "Other"));
    has(&folder.staunch(RUN).err(2), &["plant.retain", "Main"]);
}

#[test]
fn a_retained_timer_goes_on_where_it_stood() {
    let timer = "PROGRAM Main\nVAR_INPUT go : BOOL; END_VAR\nVAR RETAIN t : TON; END_VAR\nt(IN := go, PT := T#100ms);\nEND_PROGRAM\n";
    let folder = Folder::with("timer", &[("main.st", timer), ("in.csv", "scan,go\n50,TRUE\n55,TRUE\n")]);
    folder.staunch("run main.st --stimulus in.csv --retain plant.retain -q").out(0);
    folder.write("in.csv", "scan,go\n1,TRUE\n7,TRUE\n");
    let out = folder.staunch("run main.st --stimulus in.csv --retain plant.retain --trace - --vars t.ET,t.Q").out(0);
    assert!(out.starts_with("scan,time_ms,t.ET,t.Q\n1,0,T#60ms,FALSE\n2,10,T#70ms,FALSE\n"), "{out}");
    assert!(out.ends_with("5,40,T#100ms,TRUE\n6,50,T#100ms,TRUE\n7,60,T#100ms,TRUE\n"), "{out}");
}

/// CRC-32 (IEEE 802.3).
fn checksum(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(u32::MAX, |crc, byte| {
        (0..8).fold(crc ^ u32::from(*byte), |crc, _| crc >> 1 ^ 0xEDB8_8320 & (crc & 1).wrapping_neg())
    })
}

const TYPES: &str = "TYPE Color : (Red, Green); END_TYPE
PROGRAM Main
VAR RETAIN
    on : BOOL; text : STRING[4]; level : INT(0..10); color : Color; list : ARRAY[0..10] OF INT; timer : TON;
END_VAR
VAR copy : STRING[20]; length, chosen, element : INT; neither : BOOL; END_VAR
timer(IN := on, PT := T#5ms);
copy := CONCAT(text, '!'); length := LEN(text); element := list[level];
neither := NOT on AND NOT timer.Q;
CASE color OF Red: chosen := 1; Green: chosen := 2; END_CASE
END_PROGRAM
";

/// A file with a right checksum in which every byte of a value is 255: as version 2, and as it is now.
fn forged(good: &[u8]) -> [Vec<u8>; 2] {
    let end = good.windows(7).position(|it| it == b"\ncrc32\t").unwrap() + 1;
    let head = std::str::from_utf8(&good[..end]).unwrap();
    let mut size = 0;
    let old = |line: &str| match line.split('\t').collect::<Vec<_>>()[..] {
        [path, ty, count] => {
            size += count.parse::<usize>().unwrap();
            format!("{path}\t{ty}\t{}\n", "ff".repeat(count.parse().unwrap()))
        }
        _ => format!("{line}\n").replace("variables 4", "variables 2"),
    };
    let text: String = head.lines().map(old).collect();
    assert!(head.lines().count() > 7 && text.contains("STRING[4]\tffffffff"), "{text}");
    let mut slots = good.to_vec();
    slots[SECTOR + SLOT_HEAD..SECTOR + SLOT_HEAD + size].fill(0xFF);
    let mut covered = checksum(head.as_bytes()).to_le_bytes().to_vec();
    covered.extend(&slots[SECTOR + 4..SECTOR + SLOT_HEAD + size + FAULT]);
    slots[SECTOR..SECTOR + 4].copy_from_slice(&checksum(&covered).to_le_bytes());
    [format!("{text}crc32\t{:08x}\n", checksum(text.as_bytes())).into_bytes(), slots]
}

#[test]
fn any_bytes_of_a_file_are_the_same_values_on_every_back_end() {
    let folder = Folder::with("forged", &[("main.st", TYPES)]);
    folder.staunch("run main.st --scans 1 --retain good --quiet").out(0);
    let good = std::fs::read(folder.0.join("good")).unwrap();
    let run = |backend, forged: &[u8]| {
        folder.write("plant.retain", forged);
        folder.staunch(&format!(
            "run main.st --scans 2 --trace - --retain plant.retain --backend {backend} \
             --vars on,level,color,length,chosen,element,neither,timer.Q,timer.in_before"
        ))
    };
    let expected = "scan,time_ms,on,level,color,length,chosen,element,neither,timer.Q,timer.in_before\n\
                    1,0,TRUE,0,-1,4,0,-1,FALSE,TRUE,TRUE\n2,10,TRUE,0,-1,4,0,-1,FALSE,TRUE,TRUE\n";
    for (version, forged) in forged(&good).iter().enumerate() {
        for backend in ["interpret", "native", "rust"] {
            assert_eq!(run(backend, forged).out(0), expected, "{backend}, version {}", version + 2);
        }
    }
}
