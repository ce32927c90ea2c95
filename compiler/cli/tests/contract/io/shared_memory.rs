//! The process image in `/dev/shm`, by the layout in `docs/io.md`.
#![cfg(target_os = "linux")]

use super::{PLANT, Plant, built, has, until};
use crate::Folder;
use std::fs::{File, OpenOptions};
use std::os::unix::fs::FileExt as _;
use std::path::PathBuf;

const SIZE: u64 = 70_720;
pub const INPUTS: u64 = 64;
pub const OUTPUTS: u64 = 64 + 23_552;
pub const MEMORY: u64 = 64 + 2 * 23_552;
/// Bytes of an area.
pub const AREA: usize = 23_552;
const WORDS: u64 = 9216;
const DOUBLES: u64 = 11_264;
const LONGS: u64 = 15_360;

const INPUT_COUNTER: u64 = 16;
const OUTPUT_COUNTER: u64 = 20;
const SCANS: u64 = 24;
const STATE: u64 = 32;

/// The image, as another process sees it.
pub struct Image(PathBuf, File);

impl Drop for Image {
    fn drop(&mut self) {
        let _ = std::fs::remove_file(&self.0);
    }
}

/// A name that no other test has.
pub fn name(of: &str) -> String {
    format!("staunch-test-{}-{of}", std::process::id())
}

impl Image {
    pub fn open(name: &str) -> Self {
        let path = PathBuf::from("/dev/shm").join(name);
        until("the image exists", || std::fs::metadata(&path).is_ok_and(|it| it.len() == SIZE));
        let file = OpenOptions::new().read(true).write(true).open(&path).unwrap();
        let image = Self(path, file);
        until("it runs", || image.number::<4>(STATE) == 1);
        image
    }

    fn number<const N: usize>(&self, at: u64) -> i64 {
        let mut bytes = [0; N];
        self.1.read_exact_at(&mut bytes, at).unwrap();
        let mut long = [0; 8];
        long[..N].copy_from_slice(&bytes);
        i64::from_le_bytes(long)
    }

    fn write(&self, at: u64, bytes: &[u8]) {
        self.1.write_all_at(bytes, at).unwrap();
    }

    /// Writes several places, which a scan has all or none of.
    pub fn together(&self, all: &[(u64, &[u8])]) {
        let even = self.number::<4>(INPUT_COUNTER);
        let counted = |by| u32::try_from(even + by).unwrap().to_le_bytes();
        self.write(INPUT_COUNTER, &counted(1));
        all.iter().for_each(|(at, bytes)| self.write(*at, bytes));
        self.write(INPUT_COUNTER, &counted(2));
    }

    pub fn bytes(&self, at: u64, count: usize) -> Vec<u8> {
        let mut bytes = vec![0; count];
        self.1.read_exact_at(&mut bytes, at).unwrap();
        bytes
    }

    pub fn scan(&self) {
        let scans = self.number::<8>(SCANS);
        until("two scans end", || self.number::<8>(SCANS) >= scans + 2);
    }

    /// Bytes of all outputs that are not 0.
    fn outputs(&self) -> usize {
        self.bytes(OUTPUTS, AREA).iter().filter(|it| **it != 0).count()
    }
}

fn plant(test: &str, arguments: &str) -> (Folder, Plant, Image) {
    let folder = built(test, PLANT);
    let name = name(test);
    let _ = std::fs::remove_file(format!("/dev/shm/{name}"));
    let plant = Plant::start(&folder, "plant", &format!("--cycle 2ms --io shm:{name} {arguments}"));
    (folder, plant, Image::open(&name))
}

#[test]
fn a_process_image_is_read_and_written() {
    let (_folder, plant, image) = plant("io_shm", "");
    assert_eq!(image.number::<8>(0), i64::from_le_bytes(*b"STAUNCH\0"));
    assert_eq!((image.number::<4>(8), image.number::<4>(12)), (1, 70_720));
    assert_eq!(image.number::<4>(36), i64::from(plant.child.id()));
    // %IX0.0, %IW3, %QX1.1, %QW2 and %MW4.
    image.write(INPUTS, &[1]);
    image.write(INPUTS + WORDS + 6, &60_i16.to_le_bytes());
    until("the output follows", || image.number::<1>(OUTPUTS + 9) == 1);
    until("the word follows", || image.number::<2>(OUTPUTS + WORDS + 4) == 60);
    assert_eq!((image.number::<2>(MEMORY + WORDS + 8), image.number::<1>(OUTPUTS + 16)), (50, 1));
    image.write(MEMORY + WORDS + 8, &70_i16.to_le_bytes());
    until("the limit is higher", || image.number::<1>(OUTPUTS + 16) == 0);
    // What is not written outside is the program's.
    let total = image.number::<8>(MEMORY + LONGS + 8000);
    image.scan();
    assert!(total > 0 && image.number::<8>(MEMORY + LONGS + 8000) > total);
    assert_eq!(image.number::<4>(OUTPUT_COUNTER) & !1, image.number::<4>(OUTPUT_COUNTER) / 2 * 2);
    // While the counter is odd, nothing is taken.
    image.write(INPUT_COUNTER, &7_u32.to_le_bytes());
    image.write(INPUTS, &[0]);
    image.write(MEMORY + DOUBLES + 2000, &9_i32.to_le_bytes());
    image.scan();
    assert_eq!(image.number::<1>(OUTPUTS + 9), 1);
    image.write(MEMORY + DOUBLES + 2080, &9_i32.to_le_bytes());
    image.write(INPUT_COUNTER, &8_u32.to_le_bytes());
    until("all of it is taken", || image.number::<1>(OUTPUTS + 9) == 0);
    image.scan();
    assert_eq!((image.number::<4>(MEMORY + DOUBLES + 2000), image.number::<1>(OUTPUTS + 24)), (9, 0));
    image.write(INPUTS, &[255]);
    until("any byte is TRUE", || image.number::<1>(OUTPUTS + 9) == 1);
    plant.signal("-TERM");
    plant.ended(0);
    assert_eq!((image.outputs(), image.number::<4>(STATE)), (0, 2));
    assert_eq!(image.number::<2>(MEMORY + WORDS + 8), 70);
}

#[test]
fn outputs_are_zero_after_a_fault_or_stay() {
    for (test, arguments, stays) in [("io_fault", "", false), ("io_hold", "--io-stop hold", true)] {
        let (_folder, plant, image) = plant(test, arguments);
        image.write(INPUTS, &[1]);
        until("the output follows", || image.number::<1>(OUTPUTS + 9) == 1);
        image.write(MEMORY + WORDS + 1800, &[0, 0]);
        has(&plant.ended(3), &["fault: division by zero"]);
        assert_eq!(image.number::<4>(STATE), 3);
        assert_eq!(image.outputs() > 0, stays);
        // The scan of the fault is not in it: it had counted before.
        let scans = image.number::<8>(SCANS);
        assert_eq!(image.number::<8>(MEMORY + LONGS + 8000), scans);
        assert_eq!(image.number::<2>(OUTPUTS + WORDS + 80), if stays { scans & 0xFFFF } else { 0 });
    }
}

#[test]
fn outputs_are_zero_where_a_scan_does_not_end() {
    let source = "PROGRAM Main VAR q AT %QX0.0 : BOOL; go AT %IX0.0 : BOOL; n : DINT; END_VAR
q := TRUE;
WHILE go DO n := n + 1; END_WHILE
END_PROGRAM";
    let folder = built("io_endless", source);
    let cases: [(&str, &str); 2] = [("io_watchdog", "--watchdog 1s"), ("io_signals", "")];
    for (test, arguments) in cases {
        let name = name(test);
        let arguments = format!("--cycle 5ms --loop-budget 1000000000000000 --io shm:{name} {arguments}");
        let mut plant = Plant::start(&folder, "plant", &arguments);
        let image = Image::open(&name);
        until("it is on", || image.outputs() == 1);
        image.write(INPUTS, &[1]);
        if test == "io_watchdog" {
            has(&plant.ended(3), &["no scan has ended"]);
        } else {
            until("the scan hangs", || {
                let scans = image.number::<8>(SCANS);
                std::thread::sleep(std::time::Duration::from_millis(400));
                scans == image.number::<8>(SCANS)
            });
            // The first asks for an end, the second makes one.
            plant.signal("-TERM");
            std::thread::sleep(std::time::Duration::from_millis(50));
            plant.signal("-TERM");
            assert_eq!(plant.child.wait().unwrap().code(), None);
        }
        assert_eq!((image.outputs(), image.number::<4>(STATE)), (0, 3), "{test}");
    }
}

#[test]
fn an_image_is_one_programs_and_of_this_version() {
    let (folder, plant, image) = plant("io_taken", "");
    let name = name("io_taken");
    let other = Plant::start(&folder, "plant", &format!("--io shm:{name}"));
    has(&other.ended(2), &["cannot open /dev/shm/", "another running program has it"]);
    plant.signal("-TERM");
    plant.ended(0);
    // Inputs that are there before the program count from the first scan on.
    image.write(INPUTS + WORDS + 6, &5_i16.to_le_bytes());
    let trace = "--realtime --scans 1 --trace t.csv --vars level,speed";
    Plant::start(&folder, "plant", &format!("{trace} --io shm:{name}")).ended(0);
    assert_eq!(folder.read("t.csv").lines().nth(1).unwrap().rsplit(',').next(), Some("5"));
    image.write(8, &[2]);
    has(
        &Plant::start(&folder, "plant", &format!("--io shm:{name}")).ended(2),
        &["not a process image of this version"],
    );
    image.1.set_len(100).unwrap();
    has(
        &Plant::start(&folder, "plant", &format!("--io shm:{name}")).ended(2),
        &["not a process image of this version"],
    );
}

#[test]
fn restarts_and_the_stimulus_keep_working() {
    let source = "PROGRAM Main
VAR a AT %IW0 : INT; b AT %IW1 : INT; sum AT %QW0 : INT; END_VAR
VAR RETAIN kept : INT; END_VAR
VAR lost : INT; END_VAR
sum := a + b; kept := kept + 1; lost := lost + 1;
END_PROGRAM";
    let folder = built("io_restart", source);
    let name = name("io_restart");
    let first = Plant::start(&folder, "plant", &format!("--cycle 2ms --io shm:{name}"));
    let image = Image::open(&name);
    image.write(INPUTS + WORDS, &[1, 0, 7, 0]);
    drop(first);
    folder.write("in.csv", "scan,a,@event\n2,100,\n4,,restart\n6,,\n");
    let arguments = format!(
        "--realtime --cycle 2ms --stimulus in.csv --retain r --trace t.csv --vars sum,kept,lost --io shm:{name}"
    );
    Plant::start(&folder, "plant", &arguments).ended(0);
    let trace = folder.read("t.csv");
    let rows: Vec<_> = trace.lines().skip(1).map(|it| it.splitn(3, ',').nth(2).unwrap()).collect();
    assert_eq!(rows, ["8,1,1", "107,2,2", "107,3,3", "107,4,1", "107,5,2", "107,6,3"]);
    assert_eq!((image.outputs(), image.number::<8>(SCANS)), (0, 6));
}

#[test]
fn tasks_and_what_a_configuration_binds_are_connected() {
    let source = "FUNCTION_BLOCK Valve VAR closed AT %I* : BOOL; open AT %Q* : BOOL; END_VAR open := NOT closed; END_FUNCTION_BLOCK
PROGRAM Line VAR_INPUT start : BOOL; END_VAR VAR_OUTPUT lamp : BOOL; END_VAR
VAR inlet : Valve; level AT %I* : INT; END_VAR
inlet(); lamp := start AND level > 3; END_PROGRAM
PROGRAM Slow VAR n AT %QW9 : INT; END_VAR n := n + 1; END_PROGRAM
CONFIGURATION c RESOURCE r ON cpu
TASK fast(INTERVAL := T#2ms, PRIORITY := 1); TASK slow(INTERVAL := T#20ms, PRIORITY := 2);
PROGRAM line WITH fast : Line(start := %IX3.0, lamp => %QX3.0); PROGRAM other WITH slow : Slow; END_RESOURCE
VAR_CONFIG line.inlet.closed AT %IX0.0 : BOOL; line.inlet.open AT %QX0.0 : BOOL; line.level AT %IW2 : INT; END_VAR
END_CONFIGURATION";
    let folder = built("io_bound", source);
    let name = name("io_bound");
    let plant = Plant::start(&folder, "plant", &format!("--io shm:{name}"));
    let image = Image::open(&name);
    until("the valve opens", || image.number::<1>(OUTPUTS) == 1);
    image.write(INPUTS, &[1]);
    until("the valve closes", || image.number::<1>(OUTPUTS) == 0);
    image.write(INPUTS + 24, &[1]);
    image.write(INPUTS + WORDS + 4, &[4, 0]);
    until("the lamp is on", || image.number::<1>(OUTPUTS + 24) == 1);
    let slow = image.number::<2>(OUTPUTS + WORDS + 18);
    until("the slow task runs", || image.number::<2>(OUTPUTS + WORDS + 18) > slow);
    plant.signal("-INT");
    plant.ended(0);
}
