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

#[test]
fn an_edited_program_takes_what_still_fits() {
    let folder = folder("edited");
    folder.staunch(RUN).out(0);
    folder.write("main.st", PROGRAM.replace("other : DINT := 4", "more : INT; other : LINT := 4"));
    let ran = folder.staunch(RUN);
    has(&ran.err, &["other"]);
    assert_eq!(ran.out(0), "scan,time_ms,kept,other,c.CV,plain\n1,0,3,5,3,1\n2,10,4,6,4,2\n");
}

#[test]
fn a_damaged_file_is_refused_and_kept() {
    let folder = folder("damaged");
    folder.staunch(RUN).out(0);
    let whole = std::fs::read(folder.0.join("plant.retain")).unwrap();
    for cut in [0, 1, whole.len() / 2, whole.len() - 1] {
        folder.write("plant.retain", &whole[..cut]);
        has(&folder.staunch(RUN).err(2), &["plant.retain"]);
        assert_eq!(std::fs::read(folder.0.join("plant.retain")).unwrap(), &whole[..cut]);
    }
    for flipped in (0..whole.len()).step_by(7) {
        let mut bytes = whole.clone();
        bytes[flipped] ^= 0x10;
        folder.write("plant.retain", &bytes);
        folder.staunch(RUN).err(2);
    }
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

/// CRC-32 (IEEE 802.3), as the file ends with.
fn checksum(text: &str) -> u32 {
    !text.bytes().fold(u32::MAX, |crc, byte| {
        (0..8).fold(crc ^ u32::from(byte), |crc, _| crc >> 1 ^ 0xEDB8_8320 & (crc & 1).wrapping_neg())
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

#[test]
fn any_bytes_of_a_file_are_the_same_values_on_every_back_end() {
    let folder = Folder::with("forged", &[("main.st", TYPES)]);
    folder.staunch("run main.st --scans 1 --retain good --quiet").out(0);
    let forge = |line: &str| {
        let mut cells: Vec<&str> = line.split('\t').collect();
        let forged = cells.last().unwrap().replace(|it: char| it.is_ascii_hexdigit(), "f");
        if let (3, Some(last)) = (cells.len(), cells.last_mut()) {
            *last = &forged;
        }
        cells.join("\t") + "\n"
    };
    let good = folder.read("good");
    let text: String = good.lines().filter(|it| !it.starts_with("crc32")).map(forge).collect();
    let forged = format!("{text}crc32\t{:08x}\n", checksum(&text));
    assert!(good.lines().count() > 8 && forged.contains("STRING[4]\tffffffff"), "{forged}");
    let run = |backend| {
        folder.write("plant.retain", &forged);
        folder.staunch(&format!(
            "run main.st --scans 2 --trace - --retain plant.retain --backend {backend} \
             --vars on,level,color,length,chosen,element,neither,timer.Q,timer.in_before"
        ))
    };
    let expected = "scan,time_ms,on,level,color,length,chosen,element,neither,timer.Q,timer.in_before\n\
                    1,0,TRUE,0,-1,4,0,-1,FALSE,TRUE,TRUE\n2,10,TRUE,0,-1,4,0,-1,FALSE,TRUE,TRUE\n";
    for backend in ["interpret", "native", "rust"] {
        assert_eq!(run(backend).out(0), expected, "{backend}");
    }
}
