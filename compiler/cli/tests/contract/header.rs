//! The header for C: what a host of its own uses of it.

use super::{Folder, Ran, has};
use std::process::Command;

const PLANT: &str = "\
TYPE
    Color : (Red, Green := 5, Blue) BYTE;
    state : STRUCT of_plant : INT; END_STRUCT
    Tasks : (Count, Rest);
    Rec : STRUCT own : state; work : Tasks; a : INT; b : ARRAY[0..2, 1..2] OF REAL; s : STRING[10]; int, INT16_MAX : INT; thread_local, co_await, char8_t, static_assert, errno, EOF : SINT; END_STRUCT
END_TYPE
FUNCTION_BLOCK Nothing
;
END_FUNCTION_BLOCK
FUNCTION_BLOCK Motor
VAR_INPUT go : BOOL; END_VAR
VAR_OUTPUT on : BOOL; END_VAR
VAR t : TON; c : CTU; last : LREAL; END_VAR
t(IN := go, PT := T#10ms);
on := t.Q;
c(CU := on, R := FALSE, PV := 5);
END_FUNCTION_BLOCK
VAR_GLOBAL CONSTANT limit : INT := 7; title : STRING := 'a \"b\" ?'; half : REAL := 0.5; most : LINT := 9223372036854775807; least : LINT := -9223372036854775808; yes : BOOL := TRUE; END_VAR
VAR_GLOBAL RETAIN total : DINT; END_VAR
PROGRAM Main
VAR start AT %IX0.0 : BOOL; level AT %IW2 : INT; run AT %QX0.1 : BOOL; END_VAR
VAR motors : ARRAY[1..2] OF Motor; rec : Rec; hue : Color := Blue; none : Nothing; END_VAR
VAR RETAIN kept : LINT := 3; END_VAR
motors[2](go := start);
run := motors[2].on;
total := total + limit;
rec.b[1, 2] := 2.5;
rec.s := 'five';
kept := kept + level;
END_PROGRAM
CONFIGURATION C
RESOURCE R ON plc
TASK Fast(INTERVAL := T#10ms, PRIORITY := 2);
PROGRAM Line WITH Fast : Main;
END_RESOURCE
END_CONFIGURATION
";

const HOST: &str = r#"
#include "plant.h"
#include <stdio.h>
#include <string.h>

static struct plant_state state;
static const staunch_task tasks[] = PLANT_TASKS;
static const staunch_located located[PLANT_LOCATED_COUNT] = PLANT_LOCATED;
static const staunch_retained retained[] = PLANT_RETAINED;

int main(void) {
    uint8_t *bytes = (uint8_t *)&state;
    plant_init(bytes);
    printf("%d %d %s %.1f %d\n", PLANT_GLOBALS_LIMIT, state.Line.hue == PLANT_COLOR_BLUE, PLANT_GLOBALS_TITLE,
           (double)PLANT_GLOBALS_HALF, PLANT_GLOBALS_YES && PLANT_GLOBALS_MOST == INT64_MAX && PLANT_GLOBALS_LEAST == INT64_MIN);
    for (uint32_t i = 0; i < PLANT_TASKS_COUNT; i++) {
        printf("%s %u %lld %u\n", tasks[i].name, tasks[i].instance, (long long)tasks[i].interval, tasks[i].priority);
    }
    for (uint32_t i = 0; i < PLANT_LOCATED_COUNT; i++) {
        printf("%s %u %d\n", located[i].address, located[i].size, located[i].bit);
        if (strcmp(located[i].address, "%IX0.0") == 0) {
            bytes[located[i].offset] = 1;
        }
        if (strcmp(located[i].address, "%IW2") == 0) {
            int16_t level = 4;
            memcpy(bytes + located[i].offset, &level, located[i].size);
        }
    }
    for (int scan = 0; scan < 3; scan++) {
        staunch_context cx = {.now = scan * 10000000LL, .first_scan = scan == 0, .turns = STAUNCH_TURNS, .cycle = 10000000LL};
        if (plant_scan(bytes, &cx, PLANT_LINE) != 0) {
            return 1;
        }
    }
    printf("%d %d %d %.1f %.*s %d\n", state.globals.run, state.Line.motors[1].on, state.Line.motors[1].c.CV,
           (double)state.Line.rec.b[1][1], state.Line.rec.s.length, (const char *)state.Line.rec.s.units, state.Line.rec.int_ + state.Line.rec.INT16_MAX_);
    uint32_t kept = 0;
    for (uint32_t i = 0; i < PLANT_RETAINED_COUNT; i++) {
        kept += retained[i].size;
    }
    printf("%u %d %d\n", kept, state.globals.total == PLANT_GLOBALS_TOTAL(bytes), (int)state.Line.kept);
    return other(bytes);
}
"#;

/// In C++, with the header of another program.
const OTHER: &str = r#"
#include "plant.h"
#include "pump/plant.h"

static pump_state state;

extern "C" int other(uint8_t *plant) {
    uint8_t *bytes = reinterpret_cast<uint8_t *>(&state);
    pump_init(bytes);
    staunch_context cx = {};
    cx.first_scan = true;
    cx.turns = STAUNCH_TURNS;
    bool right = pump_scan(bytes, &cx, PUMP_MAIN) == 0 && state.Main.motors.t.PT == 7;
    return right && reinterpret_cast<plant_state *>(plant)->Line.rec.a == 0 ? 0 : 2;
}
"#;

/// Another program with the names of the first.
const PUMP: &str = "\
FUNCTION_BLOCK Motor VAR t : TON; END_VAR t(IN := FALSE, PT := T#7ns); END_FUNCTION_BLOCK
PROGRAM Main VAR motors : Motor; END_VAR motors(); END_PROGRAM
";

fn compiled(folder: &Folder, compiler: &str, arguments: &str) {
    let mut command = Command::new(compiler);
    command.args(["-Wall", "-Wextra", "-Wpedantic", "-Werror"]).args(arguments.split_whitespace());
    Ran::of(command.current_dir(&folder.0).output().unwrap()).err(0);
}

/// The state is a structure, constants are constants, tables have rows; and two programs, one of them in C++, link together.
#[test]
#[cfg(target_os = "linux")]
fn a_host_in_c_has_two_programs() {
    let host = HOST.replace("#include <string.h>\n", "#include <string.h>\n\nint other(uint8_t *plant);\n");
    let files = [("plant.st", PLANT), ("pump.st", PUMP), ("host.c", &host), ("other.cpp", OTHER)];
    let folder = Folder::with("header", &files);
    // Two headers with one file's name may be included.
    std::fs::create_dir_all(folder.0.join("pump")).unwrap();
    for (name, header) in [("plant", "plant.h"), ("pump", "pump/plant.h")] {
        folder.staunch(&format!("build {name}.st --emit header --prefix {name} -o {header} -q")).out(0);
        folder.staunch(&format!("build {name}.st --emit lib --prefix {name} -o lib{name}.a -q")).out(0);
    }
    compiled(&folder, "cc", "-std=c11 -c host.c -o host.o");
    compiled(&folder, "c++", "-std=c++17 -c other.cpp -o other.o");
    compiled(&folder, "c++", "host.o other.o libplant.a libpump.a -lm -lpthread -ldl -o host");
    let ran = Ran::of(Command::new(folder.0.join("host")).current_dir(&folder.0).output().unwrap()).out(0);
    let table = "7 1 a \"b\" ? 0.5 1\nLine 0 10000000 2\n%IX0.0 1 -1\n%IW2 2 -1\n%QX0.1 1 -1\n";
    assert_eq!(ran, format!("{table}1 1 1 2.5 five 0\n12 1 15\n"));
}

/// A host in C, with bytes after the context that a scan must not touch.
const COUNTS: &str = r#"
#include <stdio.h>
#include "plant.h"

static struct staunch_state state;
static struct { staunch_context cx; uint8_t after[32]; } told;

int main(void) {
    staunch_init((uint8_t *)&state);
    for (int scan = 0; scan < 2; scan++) {
        told.cx = (staunch_context){.now = scan * 10000000LL, .first_scan = scan == 0, .turns = STAUNCH_TURNS};
        if (staunch_scan((uint8_t *)&state, &told.cx, STAUNCH_MAIN) != 0) {
            return 1;
        }
        staunch_minor_faults minor = told.cx.minor_faults;
        printf("%d %d:%d\n", (int)minor.count, (int)minor.line, (int)minor.column);
    }
    for (int at = 0; at < 32; at++) {
        if (told.after[at] != 0) {
            return 2;
        }
    }
    return 0;
}
"#;

/// A division by zero after which the program continues is reported in the host's context only.
#[test]
#[cfg(target_os = "linux")]
fn a_host_in_c_is_told_of_minor_faults() {
    let program = "PROGRAM Main\nVAR a, b : DINT; END_VAR\nb := 7 / a;\nb := b MOD a;\na := a + 1;\nEND_PROGRAM\n";
    let folder = Folder::with("header_minor", &[("plant.st", program), ("host.c", COUNTS)]);
    folder.staunch("build plant.st --dialect logix --emit header -o plant.h -q").out(0);
    for backend in ["native", "rust"] {
        folder
            .staunch(&format!("build plant.st --dialect logix --backend {backend} --emit lib -o libplant.a -q"))
            .out(0);
        compiled(&folder, "cc", "-std=c11 host.c libplant.a -lm -lpthread -ldl -o host");
        let ran = Ran::of(Command::new(folder.0.join("host")).current_dir(&folder.0).output().unwrap()).out(0);
        assert_eq!(ran, "2 3:8\n0 0:0\n", "{backend}");
    }
}

/// A prefix is for what is linked with others, and a name of C.
#[test]
fn a_prefix_is_refused_where_nothing_has_it() {
    let folder = Folder::with("header_prefix", &[("pump.st", PUMP)]);
    for (arguments, said) in [
        ("--emit exe --prefix pump", "`--prefix` is for what is linked with others: `--emit obj`, `lib` or `header`"),
        ("--emit rust --prefix pump", "`--prefix` is for what is linked with others"),
        ("--emit lib --backend rust --prefix pump", "`--prefix` is for `--backend native`"),
        ("--emit obj --prefix 2nd", "`--prefix 2nd`: a symbol of C begins with a letter"),
        ("--emit header --prefix pump-1", "`--prefix pump-1`: a symbol of C begins with a letter"),
    ] {
        has(&folder.staunch(&format!("build pump.st {arguments} -o out")).err(2), &[said]);
    }
}
