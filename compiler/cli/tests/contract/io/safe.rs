//! `[safe]` of staunch.toml: what outputs are before the first scan and at the end.

use super::modbus::{Client, HOLDING};
use super::{PLANT, Plant, built, has, until};
use crate::Folder;

const SAFE: &str = "[safe]\nmotor = true\n\"%QW2\" = -3\n";

#[cfg(target_os = "linux")]
#[test]
fn outputs_take_their_safe_values() {
    use super::shared_memory::{AREA, Image, OUTPUTS, name};
    const WORDS: usize = 9216;
    const ENDLESS: &str = "PROGRAM Main
VAR motor AT %QX1.1 : BOOL; speed AT %QW2 : INT; first AT %QW20 : UINT; go AT %IX0.0 : BOOL; n : DINT; END_VAR
first := 5;
WHILE go DO n := n + 1; END_WHILE
END_PROGRAM";
    for (test, source, arguments, ends, kept) in [
        ("io_safe_signal", PLANT, "", 0, false),
        ("io_safe_hold", PLANT, "--io-stop hold", 0, true),
        ("io_safe_fault", PLANT, "", 3, false),
        ("io_safe_watchdog", ENDLESS, "--watchdog 1s --loop-budget 1000000000000000", 3, false),
    ] {
        let folder = Folder::with(test, &[("main.st", source), ("staunch.toml", SAFE)]);
        folder.staunch("build main.st -o plant -q").out(0);
        let name = name(test);
        let _ = std::fs::remove_file(format!("/dev/shm/{name}"));
        let plant = Plant::start(&folder, "plant", &format!("--cycle 2ms --io shm:{name} {arguments}"));
        let image = Image::open(&name);
        let outputs = || image.bytes(OUTPUTS, AREA);
        until("the program has them", || outputs()[9] == 0 && outputs()[WORDS + 40] != 0);
        match (ends, source == PLANT) {
            (0, _) => plant.signal("-TERM"),
            // A divisor of 0.
            (_, true) => image.together(&[(super::shared_memory::MEMORY + 9216 + 1800, &[0, 0])]),
            // A scan that has no end.
            (_, false) => image.together(&[(super::shared_memory::INPUTS, &[1])]),
        }
        plant.ended(ends);
        let outputs = outputs();
        assert_eq!((outputs[9], &outputs[WORDS + 4..WORDS + 6]), (1, &(-3_i16).to_le_bytes()[..]), "{test}");
        assert_eq!(outputs[WORDS + 40] != 0, kept, "{test}");
    }
}

/// A client writes them to its server as its last act.
#[test]
fn a_server_has_the_safe_values_in_the_end() {
    let first = built("io_safe_first", PLANT);
    let server = Plant::start(&first, "plant", "--cycle 2ms --io modbus:127.0.0.1:0").listening();
    let source = "PROGRAM Main VAR speed AT %QW10 : INT; other AT %QW11 : INT; n : INT; END_VAR
n := n + 1; speed := 40 + 1 / (300 - n); other := 6; END_PROGRAM";
    let settings = format!(
        "[[modbus]]\nserver = \"127.0.0.1:{}\"\nperiod = \"2ms\"\n[modbus.map]\nspeed = \"holding-register 600\"\nother = \"holding-register 601\"\n[safe]\nspeed = 1234\n",
        server.port
    );
    let folder = Folder::with("io_safe_second", &[("main.st", source), ("staunch.toml", &settings)]);
    has(&folder.staunch("run main.st --realtime --cycle 2ms").err(3), &["fault: division by zero (scan 300"]);
    assert_eq!(Client::of(&server).words(HOLDING, 600, 2), [1234, 0]);
    server.signal("-TERM");
    server.ended(0);
}

#[test]
fn a_wrong_value_is_reported_at_its_line() {
    for (settings, expected) in [
        (
            "[safe]\nmotor = true\nmoter = true\n",
            "staunch.toml:3: `moter`: there is no variable `moter`; did you mean `motor`?",
        ),
        (
            "[safe]\nstart = true\n",
            "staunch.toml:2: `start`: it is an input, and safe values are of outputs: name a variable at %Q",
        ),
        ("[safe]\nn = 3\n", "staunch.toml:2: `n`: only variables at addresses are connected"),
        ("[safe]\nlimit = 3\n", "staunch.toml:2: `limit`: %M is neither read nor written"),
        ("[safe]\nspeed = 40000\n", "staunch.toml:2: `speed`: "),
        ("[safe]\nspeed = 1.5\n", "staunch.toml:2: `speed`: "),
        ("[safe]\nspeed = 1\n\"%QW2\" = 2\n", "another entry has a value for the same bits"),
        ("[safe]\nMain.speed = 1\n", "a name with a point is in quotes: \"Main.valve\" = true"),
        ("[safe]\nspeed = [1]\n", "`speed` must be true, false, a number, or a value in quotes"),
        (
            "[safe]\nmotor = true\n[[gpio]]\nvariable = \"motor\"\nchip = \"gpiochip0\"\nline = 1\nsafe = true\n",
            "staunch.toml:4: `motor`: it has a value in `[safe]`, too: remove one of both",
        ),
        ("safe = 3\n", "`safe` must be a table: write `[safe]`, and below it valve = true"),
    ] {
        let folder = Folder::with("io_safe_wrong", &[("main.st", PLANT), ("staunch.toml", settings)]);
        for call in ["check main.st", "build main.st -o plant", "run main.st"] {
            has(&folder.staunch(call).err(2), &[expected]);
        }
    }
}

/// One file of a project may have no PROGRAM that its connections are of.
#[test]
fn declarations_alone_are_connected_with_nothing() {
    let settings = "[safe]\nmotor = true\n[[modbus]]\nserver = \"127.0.0.1:1\"\n[modbus.map]\nmotor = \"coil 1\"\n";
    let function = "FUNCTION Half : INT\nVAR_INPUT whole : INT; END_VAR\nHalf := whole / 2;\nEND_FUNCTION\n";
    let folder = Folder::with("io_safe_alone", &[("half.st", function), ("staunch.toml", settings)]);
    folder.staunch("check half.st").err(0);
    folder.staunch("build half.st --emit rust -q").out(0);
}
