//! What `report` shows, without running anything.

use super::{COUNTER, Folder, has};
use serde_json::Value;

const TASKS: &str = "CONFIGURATION Plant
  TASK fast (INTERVAL := T#10ms, PRIORITY := 1);
  TASK slow (INTERVAL := T#100ms, PRIORITY := 2);
  PROGRAM a WITH fast : Small;
  PROGRAM b WITH fast : Small;
  PROGRAM c WITH slow : Large;
END_CONFIGURATION
PROGRAM Small
VAR RETAIN total : DINT; END_VAR
VAR step : DINT; END_VAR
total := total + step;
END_PROGRAM
FUNCTION Deep : LREAL
VAR_INPUT x : LREAL; END_VAR
VAR t : ARRAY[0..99] OF LREAL; i : INT; END_VAR
FOR i := 0 TO 99 DO t[i] := SIN(x * INT_TO_LREAL(i)); END_FOR
Deep := t[7] + COS(x * 2.0);
END_FUNCTION
PROGRAM Large
VAR_OUTPUT y : LREAL; text : STRING[80]; END_VAR
VAR x : LREAL; END_VAR
x := x + 0.1;
y := Deep(x);
text := CONCAT('a text of some length: ', text);
END_PROGRAM
";

fn object(text: &str) -> Value {
    assert_eq!(text.lines().count(), 1, "{text}");
    serde_json::from_str(text).unwrap()
}

fn number(value: &Value, key: &str) -> u64 {
    value[key].as_u64().unwrap_or_else(|| panic!("no `{key}` in {value}"))
}

#[test]
fn bytes_are_shown_by_task() {
    let folder = Folder::with("report_tasks", &[("main.st", TASKS)]);
    let found = object(&folder.staunch("report main.st --message-format json").out(0));
    assert_eq!(found["reason"], "report");
    let [fast, slow] = [&found["tasks"][0], &found["tasks"][1]];
    assert_eq!((&fast["name"], &slow["name"]), (&"fast".into(), &"slow".into()));
    assert_eq!(fast["programs"], serde_json::json!(["a", "b"]));
    assert_eq!((number(fast, "interval_ns"), number(slow, "interval_ns")), (10_000_000, 100_000_000));
    assert_eq!((number(fast, "state_bytes"), number(fast, "retained_bytes")), (16, 8));
    assert_eq!((number(fast, "constant_bytes"), number(slow, "retained_bytes")), (0, 0));
    assert!(number(slow, "state_bytes") >= 96 && number(slow, "constant_bytes") >= 20, "{slow}");
    assert!(number(slow, "text_bytes") > number(fast, "text_bytes"), "{found}");
    assert!(number(slow, "stack_bytes") > number(fast, "stack_bytes") + 512, "{found}");
    let path: Vec<_> = slow["stack_path"].as_array().unwrap().iter().map(|it| it["name"].as_str().unwrap()).collect();
    assert_eq!(path[..3], ["staunch_scan", "Large", "Deep"]);
    let sum: u64 = slow["stack_path"].as_array().unwrap().iter().map(|it| number(it, "bytes")).sum();
    assert_eq!(number(slow, "stack_bytes"), sum);
    let total = &found["total"];
    assert_eq!(number(total, "state_bytes"), number(fast, "state_bytes") + number(slow, "state_bytes"));
    assert!(number(total, "text_bytes") >= number(slow, "text_bytes"));
}

#[test]
fn a_table_is_for_people() {
    let folder = Folder::with("report_table", &[("main.st", TASKS), ("one.st", COUNTER)]);
    let table = folder.staunch("report main.st --target aarch64").out(0);
    has(
        &table,
        &[
            "Bytes, and the most instructions of a scan, for aarch64-unknown-linux-gnu",
            "state  retained  constant",
            "\nfast",
            "\nslow",
            "\nwhole program",
        ],
    );
    has(&table, &["Stack of slow: staunch_scan ", "> Large ", "> Deep ", "> staunch_"]);
    // The one PROGRAM is the scan itself.
    has(&folder.staunch("report one.st").out(0), &["Stack of Main: Main "]);
    let [speed, size] = ["speed", "size"].map(|opt| folder.staunch(&format!("report one.st --opt {opt}")).out(0));
    assert_ne!(speed, size);
}

#[test]
fn what_is_outside_is_unknown() {
    let source = "{external}\nFUNCTION Read_Sensor : INT\nEND_FUNCTION
PROGRAM Main VAR_OUTPUT n : INT; END_VAR n := Read_Sensor(); END_PROGRAM";
    let folder = Folder::with("report_outside", &[("main.st", source)]);
    let found = object(&folder.staunch("report main.st --message-format json").out(0));
    assert_eq!(found["tasks"][0]["stack_bytes"], Value::Null);
    assert_eq!(found["tasks"][0]["stack_unknown"].as_array().unwrap().len(), 1);
    has(
        &folder.staunch("report main.st").out(0),
        &["unknown", "External code may need any amount of stack: Read_Sensor"],
    );
}

#[test]
fn wrong_programs_and_targets_are_refused() {
    let folder = Folder::with("report_wrong", &[("main.st", "PROGRAM Main x := 1; END_PROGRAM"), ("one.st", COUNTER)]);
    folder.staunch("report main.st").err(1);
    has(&folder.staunch("report one.st --target thumbv7em-none-eabihf").err(2), &["64-bit code only"]);
    folder.staunch("report one.st --target nonsense").err(2);
    folder.staunch("report none.st").err(2);
}

#[test]
fn instructions_are_bounded_by_the_limits_of_loops() {
    let program = |body: &str| {
        format!(
            "PROGRAM Main VAR_INPUT n : INT; few : USINT; END_VAR VAR i, w : INT; f : USINT; sum : DINT; END_VAR\n{body}\nEND_PROGRAM\n"
        )
    };
    let bound = |name: &str, body: &str| {
        let folder = Folder::with(&format!("report_bound_{name}"), &[("main.st", &program(body))]);
        let found = object(&folder.staunch("report main.st --target x86_64 --message-format json -A warnings").out(0));
        let task = found["tasks"][0].clone();
        (task["instructions"].as_u64(), task["unbounded"].clone())
    };
    let known = |name: &str, body: &str| bound(name, body).0.unwrap_or_else(|| panic!("no bound: {body}"));
    let straight = known("straight", "sum := sum + 1;");
    assert!((3..30).contains(&straight), "{straight}");
    let [some, more] = [("some", 999), ("more", 9999)]
        .map(|(name, last)| known(name, &format!("FOR i := 0 TO {last} DO sum := sum + i * sum; END_FOR")));
    assert!(some > 999 && (9 * some..20 * some).contains(&more), "{some}, {more}");
    let nested = known("nested", "FOR i := 0 TO 99 DO FOR w := i TO 99 DO sum := sum + w * i; END_FOR END_FOR");
    assert!(nested > 5050, "{nested}");
    let small = known("small", "FOR f := 1 TO few DO sum := sum + f; END_FOR");
    assert!(small > 255, "{small}");
    let counted = known("counted", "w := 0; WHILE w < 50 AND sum < 1000 DO w := w + 1; sum := sum + n; END_WHILE");
    assert!(counted > 150, "{counted}");
    let divided = known("divided", "w := n; WHILE w <> 0 DO w := w / 10; sum := sum + 1; END_WHILE");
    assert!(divided > 20, "{divided}");
    let (none, reasons) =
        bound("open", "\nFOR i := 1 TO n DO sum := sum + i; END_FOR\nWHILE sum > n DO sum := sum - n; END_WHILE");
    assert_eq!(none, None);
    let places: Vec<_> =
        reasons.as_array().unwrap().iter().map(|it| (number(it, "line"), it["file"].as_str())).collect();
    assert_eq!(places, [(3, Some("main.st")), (4, Some("main.st"))]);
    has(reasons[0]["message"].as_str().unwrap(), &["limits of this FOR"]);
}

#[test]
fn budgets_fail_the_build() {
    let folder = Folder::with("report_budgets", &[("main.st", TASKS), ("staunch.toml", "files = [\"main.st\"]\n")]);
    folder.staunch("build --emit obj -o made.o -q").out(0);
    folder.write("staunch.toml", "files = [\"main.st\"]\nmax-stack = 100\n");
    let path = [
        "staunch.toml:2: `max-stack`: the scan of slow takes",
        "more than 100: staunch_scan ",
        "> Large ",
        "> staunch_",
    ];
    for command in ["build --emit obj -o other.o -q", "build --emit lib -o other.a -q", "report"] {
        has(&folder.staunch(command).err(1), &path);
    }
    assert!(!folder.0.join("other.o").exists());
    folder.staunch("build --emit rust -o made.rs -q").out(0);
    has(&folder.staunch("build --emit obj --backend rust -o made.o").err(2), &["budgets of native code"]);
    folder.write("staunch.toml", "files = [\"main.st\"]\nmax-stack = 100000\nmax-scan-instructions = 1000\n");
    let run = folder.staunch("build --target x86_64 --emit obj -o other.o -q --message-format json").out(1);
    has(
        &run,
        &["{\"reason\":\"error\",\"message\":\"staunch.toml:3: `max-scan-instructions`: the scan of slow runs up to "],
    );
    folder.write("staunch.toml", "files = [\"main.st\"]\nmax-scan-instructions = 100000000\n");
    folder.staunch("build --target x86_64 --emit obj -o other.o -q").out(0);
    has(&folder.staunch("report --target aarch64").err(1), &["has no bound:", "x86-64 only"]);
    folder.write("staunch.toml", "max-stack = \"4k\"\n");
    has(&folder.staunch("report main.st").err(2), &["staunch.toml:1: `max-stack` must be a whole number"]);
}
