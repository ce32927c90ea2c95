//! What is declared `{external}`: where it is called, and where it is missing.

use super::{Folder, Ran, has};
use std::path::Path;
use std::process::Command;

const PROGRAM: &str = "\
TYPE Sample : STRUCT raw : INT; when : TIME; name : STRING[10]; values : ARRAY[0..1, 0..2] OF INT; END_STRUCT; END_TYPE
TYPE Mode : (Off, Slow, Fast); END_TYPE
{external}
FUNCTION Measure : REAL
VAR_INPUT channel : SINT; label : STRING[10] := 'left'; mode : Mode; END_VAR
VAR_OUTPUT ok : BOOL := TRUE; END_VAR
VAR_IN_OUT one, other : Sample; END_VAR
END_FUNCTION
{external 'label_of'}
FUNCTION LabelOf : STRING[10] VAR_INPUT channel : SINT; END_VAR END_FUNCTION
{external}
FUNCTION_BLOCK Axis
VAR_INPUT speed : INT := 5; END_VAR
VAR_OUTPUT mode : Mode; END_VAR
VAR_IN_OUT total : LINT; END_VAR
VAR position : LREAL := 0.5; now : TIME; END_VAR
END_FUNCTION_BLOCK
PROGRAM Main
VAR s : Sample; axis_1 : Axis; total : LINT; ok : BOOL; level : REAL; label : STRING[10]; END_VAR
s.values[1, 2] := 7;
level := Measure(-3, mode := Fast, ok => ok, one := s, other := s);
label := LabelOf(-1);
axis_1(total := total);
END_PROGRAM
";

const OUTSIDE: &str = r#"
#include "plant.h"
#include <stdio.h>
#include <string.h>

float Measure(int8_t channel, const struct staunch_string_10 *label, int16_t mode, bool *ok, struct Sample *one,
              struct Sample *other) {
    printf("%d %.*s %d %d %d\n", channel, label->length, (const char *)label->units, mode, *ok, one->values[1][2]);
    *ok = false;
    one->raw = 1;
    other->raw = 2;
    other->when = 1500;
    return 2.5f;
}

void label_of(int8_t channel, struct staunch_string_10 *result) {
    result->length = channel == -1 ? 5 : 0;
    memcpy(result->units, "right", 5);
}

void Axis(struct Axis *block, const staunch_context *cx, int64_t *total) {
    block->position += block->speed;
    block->now = cx->now;
    block->mode = 2;
    *total += 10;
}

_Alignas(STAUNCH_STATE_ALIGN) static uint8_t state[STAUNCH_STATE_SIZE];

int main(void) {
    staunch_init(state);
    for (int scan = 0; scan < 2; scan++) {
        staunch_context cx = {.now = scan * 10000000LL, .first_scan = scan == 0, .turns = STAUNCH_TURNS, .cycle = 10000000LL};
        if (staunch_scan(state, &cx, STAUNCH_MAIN) != 0) {
            return 1;
        }
    }
    const struct Sample *s = (const struct Sample *)(state + STAUNCH_OFFSET_MAIN_S);
    const struct Axis *axis = (const struct Axis *)(state + STAUNCH_OFFSET_MAIN_AXIS_1);
    const struct staunch_string_10 *label = (const struct staunch_string_10 *)(state + STAUNCH_OFFSET_MAIN_LABEL);
    printf("%.1f %d %d %d %.*s\n", STAUNCH_MAIN_LEVEL(state), STAUNCH_MAIN_OK(state), s->raw, (int)s->when, label->length,
           (const char *)label->units);
    printf("%.1f %d %d %d\n", axis->position, (int)axis->now, axis->mode, (int)STAUNCH_MAIN_TOTAL(state));
    return 0;
}
"#;

fn cc(folder: &Folder, arguments: &str) {
    let mut command = Command::new("cc");
    command.args(["-Wall", "-Wextra", "-Werror", "-o", "plant"]).args(arguments.split_whitespace());
    Ran::of(command.args(["-lm", "-lpthread"]).current_dir(&folder.0).output().unwrap()).err(0);
}

fn ran(folder: &Folder) -> String {
    Ran::of(Command::new(folder.0.join("plant")).current_dir(&folder.0).output().unwrap()).out(0)
}

/// Numbers of all widths, texts, structures, enumerations, results of both kinds, and in-outs that are one variable: each
/// gets a copy, and the last one that is written back holds.
#[test]
#[cfg(target_os = "linux")]
fn c_is_called_with_values_of_its_types() {
    let folder = Folder::with("external_c", &[("plant.st", PROGRAM), ("outside.c", OUTSIDE)]);
    folder.staunch("check plant.st -q").out(0);
    folder.staunch("build plant.st --emit header -o plant.h -q").out(0);
    folder.staunch("build plant.st --emit lib -o libplant.a -q").out(0);
    cc(&folder, "outside.c libplant.a");
    let first = "-3 left 2 1 7\n";
    assert_eq!(ran(&folder), format!("{first}{first}2.5 0 2 1500 right\n10.5 10000000 2 20\n"));
}

#[test]
#[cfg(target_os = "linux")]
fn the_example_in_c_does_what_its_readme_shows() {
    let example = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../st_examples/external_c");
    let read = |file: &str| std::fs::read_to_string(example.join(file)).unwrap();
    let folder = Folder::new("external_example");
    ["scale.st", "scale.c", "main.c"].iter().for_each(|it| folder.write(it, read(it)));
    let readme = read("README.md");
    for line in readme.lines().filter_map(|it| it.strip_prefix("staunch ")) {
        folder.staunch(&format!("{line} -q")).out(0);
    }
    cc(&folder, "main.c scale.c libscale.a");
    let shown = readme.split_once("```text\n").and_then(|(_, it)| it.split_once("```")).map(|(it, _)| it);
    assert_eq!(Some(&*ran(&folder)), shown);
}

/// Commands that run the program report what is missing, and a mock can replace it.
#[test]
fn what_is_outside_is_not_there_in_a_run() {
    let tests = "\
TEST 'with a mock' VAR line : Main; END_VAR MOCK_FUNCTION Speed RETURNS 7; MOCK line.drive; line(); ASSERT_EQ(line.x, 7); END_TEST
TEST 'without' VAR line : Main; END_VAR MOCK line.drive; line(); END_TEST
";
    let program = "\
{external}
FUNCTION Speed : INT VAR_INPUT axis : INT; END_VAR END_FUNCTION
{external}
FUNCTION_BLOCK Drive VAR_INPUT on : BOOL; END_VAR END_FUNCTION_BLOCK
PROGRAM Main VAR x : INT; drive : Drive; END_VAR
x := Speed(1);
drive(on := TRUE);
END_PROGRAM
";
    let folder = Folder::with("external_run", &[("main.st", program), ("tests.st", &format!("{program}{tests}"))]);
    folder.staunch("check main.st -D warnings -q").out(0);
    for command in ["run main.st", "bench main.st", "build main.st -o plant", "run main.st --backend rust"] {
        let refused = folder.staunch(command).err(1);
        has(&refused, &["error[E0318]: `Speed` has no implementation here", "`Drive` has no implementation here"]);
    }
    has(&folder.staunch("build main.st --emit lib --backend rust").err(2), &["--emit rust", "--backend native"]);
    for backend in ["native", "interpret", "rust"] {
        let tested = folder.staunch(&format!("test tests.st --backend {backend}"));
        has(
            &tested.out(1),
            &[
                "ok      with a mock",
                "FAILED  without",
                "tests.st:2:10: what is called is not implemented here",
                "the test calls `Speed`, which has no body here",
                "`MOCK_FUNCTION Speed RETURNS value;`",
            ],
        );
    }
}
