//! Other machines than this one do what this one does: native code for 64 bits, Rust for 32 bits
//! and for a microcontroller, all run by QEMU.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod support;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use support::{folder, have, project, staunch, succeed};

/// A foreign machine with Linux, and the tools for it as Debian names them.
struct Machine {
    target: &'static str,
    backend: &'static str,
    compiler: &'static str,
    emulator: &'static str,
    libraries: &'static str,
}

const AARCH64: Machine = Machine {
    target: "aarch64-unknown-linux-gnu",
    backend: "native",
    compiler: "aarch64-linux-gnu-gcc",
    emulator: "qemu-aarch64",
    libraries: "/usr/aarch64-linux-gnu",
};
const RISCV64: Machine = Machine {
    target: "riscv64gc-unknown-linux-gnu",
    backend: "native",
    compiler: "riscv64-linux-gnu-gcc",
    emulator: "qemu-riscv64",
    libraries: "/usr/riscv64-linux-gnu",
};
/// 32 bits, where a 64-bit integer still aligns to 8.
const ARMV7: Machine = Machine {
    target: "armv7-unknown-linux-gnueabihf",
    backend: "rust",
    compiler: "arm-linux-gnueabihf-gcc",
    emulator: "qemu-arm",
    libraries: "/usr/arm-linux-gnueabihf",
};

/// Reals, strings, timers, conversions and 64-bit integers, without a stimulus.
const MATHS: &str = "
TYPE Pair : STRUCT small : SINT; wide : LINT; END_STRUCT END_TYPE
FUNCTION Blend : REAL
VAR_INPUT a, b : REAL; END_VAR
Blend := (a + b) / 3.0 - SQRT(ABS(a * b));
END_FUNCTION
PROGRAM Main
VAR
    r : REAL := 0.1; l : LREAL := 1.5; sine, cosine, power, logs, arcs : LREAL;
    pair : Pair; u : ULINT := 18446744073709551615; w : LWORD; d : DINT; s : SINT; i : INT;
    text, cut : STRING[12] := 'abc'; found : INT;
    on, off : TON; step : CTUD; edges : ARRAY[0..2] OF CTU; clock : TIME; b : BOOL;
END_VAR
b := NOT b;
r := Blend(r + 1.0e-3, 7.25) * -1.7;
l := l * 1.0000001 + 0.25;
sine := SIN(l); cosine := COS(l) + TAN(l); power := EXPT(l, 2.5); logs := LN(l) + LOG(l) + EXP(-l); arcs := ATAN(l) + ASIN(sine);
pair.small := pair.small + 37; pair.wide := pair.wide * 3 - INT_TO_LINT(i) + 1;
u := u / 3 + 7; w := SHR(ROL(ULINT_TO_LWORD(u), 5), 3) XOR 16#5A5A;
d := REAL_TO_DINT(r * 1.0e9); s := LREAL_TO_SINT(l * 50.0); i := i + REAL_TO_INT(r) - DINT_TO_INT(d MOD 7);
text := CONCAT(RIGHT(text, 9), MID('0123456789', 1, ABS(i) MOD 10 + 1)); found := FIND(text, 'c');
cut := REPLACE(INSERT(text, 'xyz', found), 'Q', 2, 3);
on(IN := TRUE, PT := T#45ms); off(IN := b, PT := T#10ms); clock := on.ET * 3;
step(CU := b, CD := off.Q, PV := 4);
edges[ABS(i) MOD 3](CU := b, PV := 2);
END_PROGRAM
";

/// Runs to the end of its third scan.
const FAULT: &str = "
PROGRAM Main
VAR left : INT := 3; share : INT; END_VAR
left := left - 1;
share := 100 / left;
END_PROGRAM
";

/// A program and what drives it.
struct Subject {
    name: &'static str,
    source: PathBuf,
    run: Vec<String>,
}

fn written(name: &'static str, text: &str, scans: &str) -> Subject {
    let source = folder("sources").join(format!("{name}.st"));
    // Tests run at once, and all write the same text.
    let aside = source.with_extension(format!("{:?}", std::thread::current().id()));
    fs::write(&aside, text).unwrap();
    fs::rename(&aside, &source).unwrap();
    Subject { name, source, run: vec!["--scans".to_owned(), scans.to_owned()] }
}

fn example(name: &'static str) -> Subject {
    let source = project().join("st_examples").join(name);
    let stimulus = source.join("stimulus.csv").display().to_string();
    Subject { name, source, run: vec!["--stimulus".to_owned(), stimulus] }
}

impl Machine {
    fn has_tools(&self, test: &str) -> bool {
        have(test, &[self.compiler, self.emulator], self.target)
    }

    fn emulate(&self, program: &Path) -> Command {
        let mut command = Command::new(self.emulator);
        command.arg("-L").arg(self.libraries).arg(program);
        command
    }

    fn build(&self, subject: &Subject) -> PathBuf {
        let out = folder(self.target).join(subject.name);
        let mut command = staunch();
        command.args(["build", "-q", "--emit", "exe", "--target", self.target, "--backend", self.backend]);
        succeed(command.arg(&subject.source).arg("-o").arg(&out));
        out
    }

    /// Its trace, its end and what it says of a fault are this machine's.
    fn agrees(&self, subject: &Subject) {
        let here =
            staunch().arg("run").arg(&subject.source).args(&subject.run).args(["--trace", "-"]).output().unwrap();
        let there = self.emulate(&self.build(subject)).args(&subject.run).args(["--trace", "-"]).output().unwrap();
        let text =
            |it: &Output| format!("{}{}", String::from_utf8_lossy(&it.stdout), String::from_utf8_lossy(&it.stderr));
        let (expected, found) = (text(&here), text(&there));
        assert!(expected.lines().count() > 2, "{expected}");
        let different = expected.lines().zip(found.lines()).find(|(a, b)| a != b);
        assert_eq!(different, None, "{} on {}", subject.name, self.target);
        assert_eq!(expected.len(), found.len(), "{} on {}", subject.name, self.target);
        assert_eq!(here.status.code(), there.status.code(), "{} on {}", subject.name, self.target);
    }

    fn faults(&self) {
        let subject = written("fault", FAULT, "9");
        self.agrees(&subject);
        let code = self.emulate(&self.build(&subject)).arg("-q").output().unwrap().status.code();
        assert_eq!(code, Some(3));
    }
}

#[test]
fn aarch64_does_what_the_host_does() {
    if AARCH64.has_tools("native code for aarch64") {
        let examples = ["small_plant", "four_families", "typed_counters"].map(example);
        examples.iter().for_each(|it| AARCH64.agrees(it));
        AARCH64.agrees(&written("maths", MATHS, "200"));
        AARCH64.faults();
    }
}

#[test]
fn riscv64_does_what_the_host_does() {
    if RISCV64.has_tools("native code for riscv64") {
        let examples = ["small_plant", "logix_light", "cscape_retentive"].map(example);
        examples.iter().for_each(|it| RISCV64.agrees(it));
        RISCV64.agrees(&written("maths", MATHS, "200"));
        RISCV64.faults();
    }
}

#[test]
fn armv7_does_what_the_host_does() {
    if ARMV7.has_tools("Rust for armv7") {
        ARMV7.agrees(&example("small_plant"));
        ARMV7.agrees(&written("maths", MATHS, "200"));
        ARMV7.faults();
    }
}

/// Counts in C what `staunch run` counts.
const C_MAIN: &str = r#"
#include "plc.h"
#include <stdio.h>
static _Alignas(STAUNCH_STATE_ALIGN) uint8_t state[STAUNCH_STATE_SIZE];
int main(void) {
    staunch_context cx = { 0, true };
    staunch_init(state);
    for (int scan = 1; scan <= 9; scan++) {
        STAUNCH_MAIN_PULSE(state) = scan % 2;
        if (staunch_scan(state, &cx, STAUNCH_MAIN)) return 3;
        printf("%d %d\n", STAUNCH_MAIN_C_CV(state), STAUNCH_MAIN_LENGTH(state));
        cx.now += 10000000;
        cx.first_scan = false;
    }
    return 0;
}
"#;
const C_COUNTS: &str = "1 1\n1 1\n2 3\n2 3\n3 6\n3 6\n4 8\n4 8\n5 8\n";
const COUNTED: &str = "
PROGRAM Main
VAR_INPUT pulse : BOOL; END_VAR
VAR c : CTU; text : STRING[8]; length : INT; END_VAR
c(CU := pulse, PV := 3);
IF pulse THEN text := CONCAT(LEFT('xxxxxxxx', c.CV), text); END_IF;
length := LEN(text);
END_PROGRAM
";

/// Links what `--emit` makes with a `main` of C's, which the library must leave room for.
fn links_into_c(name: &str, compiler: &str, arguments: &[&str], run: impl Fn(&Path) -> Command) {
    let source = written("counted", COUNTED, "1").source;
    let folder = folder(name);
    let make = |emit: &str, file: &str| {
        let mut command = staunch();
        command.args(["build", "-q", "--emit", emit]).args(arguments).arg(&source).arg("-o").arg(folder.join(file));
        succeed(&mut command);
        folder.join(file)
    };
    make("header", "plc.h");
    fs::write(folder.join("main.c"), C_MAIN).unwrap();
    let library = make("lib", "libplc.a");
    let mut linked = vec![library];
    if arguments.contains(&"rust") {
        linked.push(make("obj", "plc.o"));
    }
    for plc in linked {
        let program = folder.join("program");
        let mut command = Command::new(compiler);
        command.args(["-std=c11", "-Wall", "-Werror", "main.c"]).arg(&plc).arg("-o").arg(&program);
        succeed(command.current_dir(&folder));
        assert_eq!(succeed(&mut run(&program)), C_COUNTS, "{}", plc.display());
    }
}

#[test]
fn a_library_leaves_main_to_c() {
    if have("a library for C", &["cc"], "x86_64-unknown-linux-gnu") {
        for backend in ["native", "rust"] {
            links_into_c(&format!("c-{backend}"), "cc", &["--backend", backend], |it| Command::new(it));
        }
    }
    for machine in [&AARCH64, &ARMV7] {
        let name = format!("c-{}", machine.target);
        if machine.has_tools(&format!("a library for C on {}", machine.target)) {
            let arguments = ["--target", machine.target, "--backend", machine.backend];
            links_into_c(&name, machine.compiler, &arguments, |it| machine.emulate(it));
        }
    }
}

/// Calls scans on a stack that was filled before, and prints how much of it they changed.
const PAINTED: &str = r#"
#include "plc.h"
#include <stdio.h>
#include <string.h>
#include <ucontext.h>
enum { SIZE = 1 << 18, PAINT = 0xA5, SCANS = 400 };
static _Alignas(64) uint8_t stack[SIZE];
static _Alignas(64) uint8_t state[STAUNCH_STATE_SIZE];
static ucontext_t here, there;
static uint64_t nothing(uint8_t *state, staunch_context *cx, uint32_t instance) { return 0; }
static uint64_t (*volatile called)(uint8_t *, staunch_context *, uint32_t);
static staunch_context cx;
static volatile long used;
static void call(void) {
    called(state, &cx, 0);
    long at = 0;
    while (at < SIZE && stack[at] == PAINT) at++;
    used = SIZE - at;
}
static long deepest(void) {
    memset(stack, PAINT, SIZE);
    getcontext(&there);
    there.uc_stack.ss_sp = stack;
    there.uc_stack.ss_size = SIZE;
    there.uc_link = &here;
    makecontext(&there, call, 0);
    swapcontext(&here, &there);
    return used;
}
int main(void) {
    called = nothing;
    long before = deepest(), most = 0;
#ifdef __x86_64__
    before -= 8; /* The address to return to. */
#else
    before = (before + 15) & ~15L; /* The lowest bytes of a frame may be unused. */
#endif
    called = staunch_scan;
    staunch_init(state);
    for (int scan = 0; scan < SCANS; scan++) {
        cx = (staunch_context){ scan * 10000000ll, scan == 0, STAUNCH_TURNS, 10000000 };
        long depth = deepest() - before;
        if (depth > most) most = depth;
    }
    printf("%ld\n", most);
    return 0;
}
"#;

/// The stack that scans of a program use, and the one that is reported.
fn stack_of(source: &Path, target: &str, compiler: &str, run: &dyn Fn(&Path) -> Command) -> (u64, u64) {
    let folder = folder(&format!("stack-{target}"));
    let make = |arguments: &[&str], file: &str| {
        let mut command = staunch();
        command.args(["build", "-q"]).args(arguments).arg(source).arg("-o").arg(folder.join(file));
        succeed(&mut command);
    };
    make(&["--emit", "header"], "plc.h");
    make(&["--emit", "lib", "--target", target], "libplc.a");
    fs::write(folder.join("main.c"), PAINTED).unwrap();
    let program = folder.join("program");
    let mut command = Command::new(compiler);
    command.args(["-O1", "-fno-optimize-sibling-calls", "main.c", "libplc.a", "-lm", "-o"]).arg(&program);
    succeed(command.current_dir(&folder));
    let used = succeed(&mut run(&program)).trim().parse().unwrap();
    let mut report = staunch();
    let report = succeed(report.args(["report", "--message-format", "json", "--target", target]).arg(source));
    let report: serde_json::Value = serde_json::from_str(report.lines().last().unwrap()).unwrap();
    (used, report["tasks"][0]["stack_bytes"].as_u64().unwrap())
}

#[test]
fn a_scan_uses_no_more_of_the_stack_than_is_reported() {
    const HOST: &str = "x86_64-unknown-linux-gnu";
    let subjects = ["small_plant", "parking_garage", "four_families", "typed_counters"].map(example);
    let subjects = || subjects.iter().map(|it| &it.source);
    let maths = written("maths", MATHS, "200").source;
    let hold = |target: &str, compiler: &str, run: &dyn Fn(&Path) -> Command| {
        for source in subjects().chain([&maths]) {
            let (used, reported) = stack_of(source, target, compiler, run);
            assert!(used <= reported, "{} on {target}: {used} of {reported}", source.display());
            // What is in the runtime is said with room to spare.
            let is_own = *source != maths && reported < 300;
            assert!(!is_own || reported <= 2 * used + 32, "{} on {target}: {used} of {reported}", source.display());
        }
    };
    if have("the stack of this machine", &["cc"], HOST) {
        hold(HOST, "cc", &|it| Command::new(it));
    }
    for machine in [&AARCH64, &RISCV64] {
        if machine.has_tools(&format!("the stack of {}", machine.target)) {
            hold(machine.target, machine.compiler, &|it| machine.emulate(it));
        }
    }
}

#[test]
fn native_code_for_32_bits_is_refused_with_the_way_to_go() {
    let source = written("refused", FAULT, "1").source;
    for target in ["armv7-unknown-linux-gnueabihf", "thumbv7em-none-eabihf", "riscv32imac-unknown-none-elf"] {
        for emit in ["obj", "lib", "exe"] {
            let mut command = staunch();
            command.args(["build", "--emit", emit, "--target", target, "-o", "/dev/null"]).arg(&source);
            let output = command.output().unwrap();
            let expected = format!(
                "error: the native back end makes 64-bit code only; for {target} use --backend rust (or --emit rust) \
                 and compile the result with rustc\n"
            );
            assert_eq!(String::from_utf8_lossy(&output.stderr), expected);
            assert_eq!(output.status.code(), Some(2));
        }
    }
}

#[test]
fn a_microcontroller_does_what_the_host_does() {
    const TARGET: &str = "thumbv7em-none-eabihf";
    if !have("the example on a microcontroller", &["qemu-system-arm"], TARGET) {
        return;
    }
    let example = project().join("st_examples/mcu_counter");
    let built = Path::new(env!("CARGO_TARGET_TMPDIR")).join("mcu");
    let mut cargo = Command::new(env!("CARGO"));
    // Cargo gives its tests variables about this crate, which that one must not see.
    for (name, _) in std::env::vars_os().filter(|(name, _)| name.to_string_lossy().starts_with("CARGO_PKG_")) {
        cargo.env_remove(name);
    }
    cargo.args(["run", "--quiet", "--locked", "--target-dir"]).arg(&built).current_dir(&example);
    let rows = succeed(cargo.env_remove("RUSTFLAGS"));
    assert_eq!(rows, fs::read_to_string(example.join("expected.csv")).unwrap());
    let firmware = fs::read(built.join(TARGET).join("debug/staunch-example-mcu-counter")).unwrap();
    let holds = |name: &[u8]| firmware.windows(name.len()).any(|it| it == name);
    assert!(holds(b"__INTERRUPTS"), "the firmware has its symbols");
    assert!(!holds(b"__rust_alloc") && !holds(b"__rdl_alloc"), "the firmware holds an allocator");
}
