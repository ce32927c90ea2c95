//! `layout = "openplc"` of a server, and the same layout of a program's own server, as mbpoll sees it.

use super::modbus::{COILS, Client, HOLDING};
use super::{Plant, until};
use crate::{Folder, has};

/// A variable at both ends of each area, and one in each of memory.
const AREAS: &str = "PROGRAM Main
VAR
    first AT %QX0.0 : BOOL; edge AT %QX99.7 : BOOL; last AT %QX1023.7 : BOOL;
    word AT %QW0 : INT := 11; high AT %QW1023 : INT := 12;
    first_input AT %IX0.0 : BOOL; last_input AT %IX1023.7 : BOOL; level AT %IW0 : INT; last_level AT %IW1023 : INT;
    m AT %MW0 : INT := 13; last_m AT %MW1023 : INT := 14;
    d AT %MD0 : DINT := 16#0001_0002; last_d AT %MD1023 : DINT := 16#0003_0004;
    l AT %ML0 : LINT := 16#0001_0002_0003_0004; last_l AT %ML1023 : LINT := 5;
    n : INT;
END_VAR
edge := TRUE;
last := first;
END_PROGRAM
";

/// As a program of OpenPLC, where addresses of several widths share no bits.
fn areas(name: &str) -> Folder {
    let folder = Folder::with(name, &[("main.st", AREAS)]);
    folder.staunch("build main.st -o plant -q --dialect openplc").out(0);
    folder
}

#[test]
fn mbpoll_finds_each_area_where_openplc_has_it() {
    let folder = areas("io_areas");
    let plant = Plant::start(&folder, "plant", "--cycle 2ms --io modbus:127.0.0.1:0").listening();
    let Some(mbpoll) = super::mbpoll(&plant) else { return };
    let shows = |arguments: &str, number: u16, values: &[u32]| {
        let text = mbpoll(&format!("{arguments} -r {number} -c {} 127.0.0.1", values.len()));
        let lines: Vec<_> = text.lines().filter_map(|it| it.strip_prefix('[')?.split_once("]: \t")).collect();
        let found: Vec<&str> = lines.iter().map(|it| it.1.split(' ').next().unwrap()).collect();
        let expected: Vec<String> = values.iter().map(u32::to_string).collect();
        assert_eq!((found.len(), lines[0].0), (values.len(), number.to_string().as_str()), "{text}");
        assert_eq!(found, expected, "{text}");
    };
    until("a scan has ended", || mbpoll("-t 0 -r 799 127.0.0.1").contains("[799]: \t1"));
    shows("-t 0", 798, &[0, 1, 0]);
    mbpoll("-t 0 -r 0 127.0.0.1 -- 1");
    until("the last coil follows", || mbpoll("-t 0 -r 8191 127.0.0.1").contains("[8191]: \t1"));
    shows("-t 1", 0, &[0]);
    shows("-t 1", 8191, &[0]);
    shows("-t 3", 0, &[0]);
    shows("-t 3", 1023, &[0]);
    shows("-t 4", 0, &[11]);
    shows("-t 4", 1023, &[12, 13]);
    // The high word comes first.
    shows("-t 4", 2047, &[14, 1, 2]);
    shows("-t 4", 4094, &[3, 4, 1, 2, 3, 4]);
    shows("-t 4:int -B", 2048, &[0x0001_0002]);
    shows("-t 4", 8188, &[0, 0, 0, 5]);
    plant.signal("-TERM");
    plant.ended(0);
}

/// Two programs: the second has its inputs and outputs at the first, by their addresses alone.
#[test]
fn a_server_with_the_layout_of_openplc_needs_no_entries() {
    let first = areas("io_layout_first");
    let server = Plant::start(&first, "plant", "--cycle 2ms --io modbus:127.0.0.1:0").listening();
    // A server's own inputs are written by nobody here; its outputs are read by an entry.
    let source = "PROGRAM Main
VAR
    seen AT %IX50.0 : BOOL; level AT %IW7 : INT; high AT %IW8 : INT;
    first AT %QX0.0 : BOOL; words AT %QW5 : ARRAY[0..2] OF INT; memory AT %MW0 : INT; long AT %QD9 : DINT;
END_VAR
first := high = 12;
words[0] := level + 1; words[1] := 32; words[2] := high;
END_PROGRAM
";
    let folder = Folder::with("io_layout_second", &[("main.st", source)]);
    let head = format!("[[modbus]]\nserver = \"127.0.0.1:{}\"\nperiod = \"5ms\"\nlayout = \"openplc\"\n", server.port);
    folder.write("staunch.toml", format!("{head}[modbus.map]\nhigh = \"holding-register 1023\"\n"));
    folder.staunch("build main.st -o plant -q").out(0);
    let plant = Plant::start(&folder, "plant", "--cycle 2ms --io-stop hold");
    let mut client = Client::of(&server);
    until("all outputs are there", || client.words(HOLDING, 5, 3) == [1, 32, 12] && client.bit(COILS, 0));
    // What has no place there, and %M, is left alone.
    assert_eq!(client.words(HOLDING, 1024, 1), [13]);
    plant.signal("-TERM");
    has(&plant.ended(0), &[" requests answered, 0 not"]);
    server.signal("-TERM");
    server.ended(0);
}

#[test]
fn a_layout_does_not_hide_a_mistake() {
    let outputs =
        "PROGRAM Main VAR a AT %QX0.0 : BOOL; b AT %QX0.1 : BOOL; i AT %IW0 : INT; END_VAR a := b; END_PROGRAM";
    let none = "PROGRAM Main VAR a AT %MW0 : INT; d AT %QD0 : DINT; END_VAR a := 1; END_PROGRAM";
    let laid_out = "[[modbus]]\nserver = \"a:1\"\nlayout = \"openplc\"\n";
    for (source, settings, expected) in [
        (
            outputs,
            format!("{laid_out}[modbus.map]\na = \"coil 1\"\n"),
            "staunch.toml:3: `%QX0.1`: another variable is written to coil 1, too",
        ),
        (outputs, format!("{laid_out}{laid_out}"), "staunch.toml:6: `%IW0`: another connection writes the same input"),
        (none, laid_out.to_owned(), "staunch.toml:3: no variable has a place there"),
        (outputs, laid_out.replace("openplc", "codesys"), "`layout` must be one of \"openplc\""),
    ] {
        let folder = Folder::with("io_layout_wrong", &[("main.st", source)]);
        folder.write("staunch.toml", settings);
        for call in ["check main.st", "build main.st -o plant", "run main.st"] {
            has(&folder.staunch(call).err(2), &[expected]);
        }
    }
}
