//! Emitted Rust and an executable have the same process image, byte for byte (`docs/rust.md`, `docs/io.md`).
#![cfg(target_os = "linux")]

use super::shared_memory::{AREA, INPUTS, Image, MEMORY, OUTPUTS, name};
use super::{Plant, built};
use crate::{Folder, Ran};
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::OnceLock;

/// Each width in each area, alone and in arrays, and types that not all bits are values of.
const WIDTHS: &str = "
TYPE Mode : (Off, Auto := 5); END_TYPE
PROGRAM Main
VAR
    ix AT %IX1023.7 : BOOL; ib AT %IB0 : SINT; iw AT %IW1 : INT; id AT %ID2 : REAL; il AT %IL1023 : LREAL;
    ixs AT %IX100.0 : ARRAY[0..8] OF BOOL; iws AT %IW300 : ARRAY[1..2, 0..2] OF UINT; ils AT %IL400 : ARRAY[0..1] OF LINT;
    imode AT %IW60 : Mode; iclock AT %IL60 : TOD; iday AT %IL61 : DATE; ilevel AT %IW70 : INT(-4..5); ichar AT %IB70 : CHAR;
    qx AT %QX1023.7 : BOOL; qb AT %QB0 : SINT; qw AT %QW1 : INT; qd AT %QD2 : REAL; ql AT %QL1023 : LREAL;
    qxs AT %QX100.0 : ARRAY[0..8] OF BOOL; qws AT %QW300 : ARRAY[1..2, 0..2] OF UINT; qls AT %QL400 : ARRAY[0..1] OF LINT;
    qmode AT %QW60 : Mode; qclock AT %QL60 : TOD; qday AT %QL61 : DATE; qlevel AT %QW70 : INT(-4..5); qchar AT %QB70 : CHAR;
    mx AT %MX1023.7 : BOOL; mb AT %MB0 : SINT := 7; mw AT %MW1 : INT := -2; md AT %MD2 : REAL := 1.5; ml AT %ML1023 : LREAL;
    mxs AT %MX100.0 : ARRAY[0..8] OF BOOL; mws AT %MW300 : ARRAY[1..2, 0..2] OF UINT := [6(9)]; mls AT %ML400 : ARRAY[0..1] OF LINT;
    mlevel AT %MW70 : INT(-4..5); mmode AT %MW60 : Mode := Auto; mid AT %MD3 : DWORD;
END_VAR
qx := ix XOR mx; qb := ib; qw := iw; qd := id; ql := il; qxs := ixs; qws := iws; qls := ils;
qmode := imode; qclock := iclock; qday := iday; qlevel := ilevel; qchar := ichar;
mb := ib; mls[0] := ils[1]; mxs[3] := ixs[2]; mws[2, 1] := mws[1, 2]; mid := INT_TO_DWORD(mlevel);
END_PROGRAM
";

/// Addresses that share bits: inputs are those of the widest, and of memory each may be written outside.
const SHARED: &str = "
PROGRAM Main
VAR
    iw AT %IW1 : WORD; ix AT %IX2.3 : BOOL; ib AT %IB3 : BYTE; qw AT %QW1 : WORD; qx AT %QX2.3 : BOOL; qb AT %QB3 : BYTE;
    md AT %MD1 : DWORD; mx AT %MX4.3 : BOOL; mw AT %MW3 : WORD; mb AT %MB5 : BYTE; seen AT %QD9 : DWORD;
    mws AT %MW40 : ARRAY[0..3] OF WORD; mbs AT %MB82 : ARRAY[0..2] OF BYTE; mflag AT %MX80.0 : BOOL;
    heard AT %QW40 : ARRAY[0..3] OF WORD;
END_VAR
qw := iw; qx := ix OR mx; qb := qb OR ib; seen := md; heard := mws;
END_PROGRAM
";

/// Variables that references lead to are in cells. Variables without an address are left out.
const REFERRED: &str = "
TYPE Head : STRUCT number : INT; ready : BOOL; END_STRUCT; Mode : (Off, Auto := 5); END_TYPE
PROGRAM Main
VAR
    iws AT %IW10 : ARRAY[1..2, 0..1] OF INT; imodes AT %IW20 : ARRAY[0..1] OF Mode; ix AT %IX0.0 : BOOL; ihead AT %IB800 : Head;
    qws AT %QW10 : ARRAY[1..2, 0..1] OF INT; qmodes AT %QW20 : ARRAY[0..1] OF Mode; qx AT %QX0.0 : BOOL; qhead AT %QB800 : Head;
    qtext AT %QB100 : STRING[8] := 'abc'; qfar AT %QW1024 : INT := 5; qlong AT %QW1020 : ARRAY[0..9] OF INT; qtop AT %QW1019 : INT;
    mw AT %MW0 : INT := 3; mws AT %MW10 : ARRAY[0..3] OF INT;
END_VAR
VAR r : REF_TO INT; END_VAR
r := REF(mws[1]);
r^ := iws[2, 0]; qws := iws; qmodes := imodes; qx := ix; qhead := ihead; qws[1, 1] := mw; qtop := mws[3]; qlong[9] := 7;
END_PROGRAM
";

/// Scans with the inputs and memory that it reads, twice each, and writes outputs and memory.
const MAIN: &str = r#"mod code;
use staunch_runtime::Context;
use staunch_runtime::firmware::{Areas, Place};
use std::io::{Read as _, Write as _};

fn main() {
    let [mut inputs, mut outputs, mut memory] = [const { [0; Place::AREA_SIZE] }; 3];
    let (mut given, mut out) = (std::io::stdin().lock(), std::io::stdout().lock());
    START
    let mut image = Areas { inputs: &inputs, outputs: &mut outputs, memory: &mut memory };
    GLOBALS.write_image(&mut image);
    loop {
        for now in 0..2 {
            let mut image = Areas { inputs: &inputs, outputs: &mut outputs, memory: &mut memory };
            GLOBALS.read_image(&image);
            SCAN.unwrap();
            GLOBALS.write_image(&mut image);
        }
        out.write_all(&outputs).and(out.write_all(&memory)).unwrap();
        if given.read_exact(&mut inputs).and_then(|()| given.read_exact(&mut memory)).is_err() {
            return;
        }
    }
}
"#;

const OWNED: [&str; 3] = [
    "let (mut globals, mut main) = (code::Globals::new(), code::Main::new());",
    "globals",
    "main.scan(&Context::at(now), &mut globals)",
];
const IN_CELLS: [&str; 3] =
    ["let mut machine = code::Machine::new();", "machine.globals", "machine.main.scan(&Context::at(now), &machine)"];

const ROUNDS: usize = 12;

/// Numbers that look random, and are the same in each run.
struct Random(u64);

impl Random {
    fn byte(&mut self) -> u8 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0.to_le_bytes()[3]
    }
}

/// The library of the runtime, built once, and the folder of what it depends on.
fn runtime() -> &'static Path {
    static BUILT: OnceLock<PathBuf> = OnceLock::new();
    BUILT.get_or_init(|| {
        let target = Path::new(env!("CARGO_TARGET_TMPDIR")).join("runtime");
        let manifest = concat!(env!("CARGO_MANIFEST_DIR"), "/../../Cargo.toml");
        let mut cargo = Command::new(env!("CARGO"));
        cargo.args(["build", "--release", "--offline", "-p", "staunch-runtime", "--manifest-path", manifest]);
        Ran::of(cargo.arg("--target-dir").arg(&target).output().unwrap()).out(0);
        target.join("release")
    })
}

/// The program as emitted Rust, which follows what it reads.
fn emitted(folder: &Folder) -> Command {
    folder.staunch("build main.st --emit rust -o code.rs -q").out(0);
    let [start, globals, scan] = if folder.read("code.rs").contains("struct Machine") { IN_CELLS } else { OWNED };
    folder.write("main.rs", MAIN.replace("START", start).replace("GLOBALS", globals).replace("SCAN", scan));
    let mut rustc = Command::new("rustc");
    rustc.args(["--edition", "2024", "main.rs", "-o", "emitted", "-D", "warnings", "--extern"]);
    rustc.arg(format!("staunch_runtime={}", runtime().join("libstaunch_runtime.rlib").display()));
    rustc.arg("-L").arg(runtime().join("deps")).current_dir(&folder.0);
    Ran::of(rustc.output().unwrap()).out(0);
    Command::new(folder.0.join("emitted"))
}

/// What is written outside in each round: inputs, then memory, where a byte of a bit is 0 or 1.
fn rounds() -> Vec<[Vec<u8>; 2]> {
    let mut random = Random(0x5EED_5EED_5EED_5EED);
    let mut area = |bits: u8| (0..AREA).map(|at| random.byte() & if at < 8192 { bits } else { 255 }).collect();
    (0..ROUNDS).map(|_| [area(255), area(1)]).collect()
}

/// Outputs and memory of the executable: without anything written, and after each round.
fn of_executable(folder: &Folder, test: &str, rounds: &[[Vec<u8>; 2]]) -> Vec<u8> {
    let name = name(test);
    let _ = std::fs::remove_file(format!("/dev/shm/{name}"));
    let plant = Plant::start(folder, "plant", &format!("--cycle 2ms --io shm:{name}"));
    let image = Image::open(&name);
    let mut found = Vec::new();
    let mut look = || {
        image.scan();
        found.extend(image.bytes(OUTPUTS, AREA));
        found.extend(image.bytes(MEMORY, AREA));
    };
    look();
    for [inputs, memory] in rounds {
        image.together(&[(INPUTS, inputs), (MEMORY, memory)]);
        look();
    }
    plant.signal("-TERM");
    plant.ended(0);
    found
}

fn of_emitted(folder: &Folder, rounds: &[[Vec<u8>; 2]]) -> Vec<u8> {
    let mut child = emitted(folder).stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().unwrap();
    let (mut stdin, given) = (child.stdin.take().unwrap(), rounds.concat().concat());
    let writer = std::thread::spawn(move || stdin.write_all(&given).unwrap());
    let output = child.wait_with_output().unwrap();
    writer.join().unwrap();
    assert!(output.status.success(), "{output:?}");
    output.stdout
}

#[test]
fn emitted_rust_has_the_image_of_an_executable() {
    let rounds = rounds();
    for (test, source) in [("image_widths", WIDTHS), ("image_shared", SHARED), ("image_referred", REFERRED)] {
        let folder = built(test, source);
        let (expected, found) = (of_executable(&folder, test, &rounds), of_emitted(&folder, &rounds));
        assert_eq!(found.len(), 2 * AREA * (ROUNDS + 1), "{test}");
        assert_eq!(expected.len(), found.len(), "{test}");
        let first = (0..found.len()).find(|at| found[*at] != expected[*at]);
        let place = first.map(|at| (at / (2 * AREA), at / AREA % 2, at % AREA, expected[at], found[at]));
        assert_eq!(place, None, "{test}: round, area (0 outputs, 1 memory), byte, expected, found");
        assert!(expected.iter().filter(|it| **it != 0).count() > 100, "{test}");
    }
}
