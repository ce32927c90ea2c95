//! `[[gpio]]` of staunch.toml. No test has a chip: `runtime/host` runs programs between lines of memory.

use crate::{Folder, has};

const PLANT: &str = "PROGRAM Main
VAR
    start AT %IX0.0 : BOOL; level AT %IW10 : INT; motor AT %QX0.0 : BOOL; lamps AT %QX8.0 : ARRAY[0..2] OF BOOL;
    flag AT %MX0.0 : BOOL; plain : BOOL;
END_VAR
motor := start AND level > 3; lamps[0] := flag OR plain;
END_PROGRAM
";

fn folder(name: &str, settings: &str) -> Folder {
    Folder::with(name, &[("main.st", PLANT), ("staunch.toml", settings)])
}

const LINES: &str = "[[gpio]]
variable = \"start\"
chip = \"gpiochip77\"
line = 17
active-low = true
bias = \"pull-up\"
debounce = \"5ms\"

[[gpio]]
variable = \"%QX0.0\"
chip = \"/dev/gpiochip77\"
line = \"RELAY 1\"
safe = true
";

#[test]
fn lines_are_in_the_executable() {
    let folder = folder("io_gpio", LINES);
    folder.staunch("check main.st").out(0);
    let map = folder.staunch("build main.st --emit map -o -").out(0);
    has(
        &map,
        &[
            "gpio\tstart\tgpiochip77\tnumber\t17\tlow\tpull-up\t5000\t-\n",
            "gpio\t%QX0.0\t/dev/gpiochip77\tname\tRELAY 1\thigh\tas-is\t0\tTRUE\n",
        ],
    );
    folder.staunch("build main.st -o plant -q").out(0);
    let ran = std::process::Command::new(folder.0.join("plant")).args(["--realtime", "--scans", "2"]).output().unwrap();
    let refused = crate::Ran::of(ran).err(2);
    has(&refused, &["error: gpio: gpiochip77: no such chip: "]);
    has(&folder.staunch("run main.st --realtime --scans 2").err(2), &["gpio: gpiochip77: no such chip: "]);
    // On the virtual clock nothing is connected.
    folder.staunch("run main.st --scans 2").out(0);
}

#[test]
fn a_wrong_line_is_reported_at_its_setting() {
    let line = |variable: &str, more: &str| {
        format!("[[gpio]]\nvariable = \"{variable}\"\nchip = \"gpiochip0\"\nline = 17\n{more}")
    };
    let start = line("start", "");
    for (settings, expected) in [
        (line("starts", ""), "staunch.toml:2: `starts`: "),
        (line("level", ""), "staunch.toml:2: `level`: a line is one bit: use a BOOL, at %IX or %QX"),
        (line("lamps", ""), "staunch.toml:2: `lamps`: it has 3 values, and a line is one: name one of them"),
        (line("flag", ""), "staunch.toml:2: `flag`: %M is neither read nor written"),
        (line("plain", ""), "staunch.toml:2: `plain`: only variables at addresses are connected"),
        (line("start", "safe = true\n"), "staunch.toml:2: `start`: it is an input, and `safe` is for outputs"),
        (line("motor", "debounce = \"1ms\"\n"), "`motor`: it is an output, and `debounce` is for inputs"),
        (line("start", "debounce = \"0ms\"\n"), "staunch.toml:5: `debounce`: `0ms` is not a time above zero"),
        (line("start", "debounce = \"2h\"\n"), "staunch.toml:5: `debounce`: `2h` is not between 1us and 4294s"),
        (line("start", "bias = \"up\"\n"), "`bias` must be one of \"pull-up\", \"pull-down\", \"disabled\", \"as-is\""),
        (line("start", "activelow = true\n"), "`[[gpio]]` has no setting `activelow`; did you mean `active-low`?"),
        (start.replace("line = 17", "line = 5000000000"), "staunch.toml:4: `line` is the number of a line, as 17"),
        (start.replace("line = 17", "line = 1.5"), "`line` must be the number of a line, from 0 on, or its name"),
        (start.replace("chip = \"gpiochip0\"\n", ""), "`[[gpio]]` needs a setting `chip`"),
        (
            format!("{start}{}", line("motor", "")),
            "staunch.toml:6: `motor`: line 17 of gpiochip0 has another variable, too",
        ),
        (
            format!("{start}{}", line("%IX0.0", "").replace("17", "18")),
            "staunch.toml:6: `%IX0.0`: it has another line, too",
        ),
        (
            format!("{start}[[modbus]]\nserver = \"a:1\"\n[modbus.map]\nstart = \"discrete-input 3\"\n"),
            "staunch.toml:2: `start`: a Modbus server writes the same input",
        ),
        ("gpio = 3\n".to_owned(), "`gpio` must be tables: write `[[gpio]]` above each"),
    ] {
        let folder = folder("io_gpio_wrong", &settings);
        for call in ["check main.st", "build main.st -o plant", "run main.st"] {
            has(&folder.staunch(call).err(2), &[expected]);
        }
    }
}
