//! When TASKs run.

use staunch_frontend::{Options, Source, Sources, compile};

/// The interval at which a task with a SINGLE and this INTERVAL, in nanoseconds, looks at it.
fn looked_at(interval: i64) -> Option<i64> {
    let text = format!(
        "CONFIGURATION c
VAR_GLOBAL go : BOOL; END_VAR
TASK t(SINGLE := go, INTERVAL := LTIME_TO_TIME(LTIME#{interval}ns), PRIORITY := 1);
PROGRAM p WITH t : Main;
END_CONFIGURATION
PROGRAM Main END_PROGRAM"
    );
    let mut sources = Sources::default();
    sources.add(Source::new("main.st", text));
    let compiled = compile(&sources, &Options::default());
    let program = compiled.program.unwrap_or_else(|| panic!("{:?}", compiled.diagnostics));
    program.instances[0].interval
}

#[test]
fn a_single_is_looked_at_in_whole_parts_of_its_interval() {
    // In microseconds. 1,999 ms have no part that is found.
    let expected = [
        (10_000, 10_000),
        (11_000, 1_000),
        (20_000, 10_000),
        (21_000, 7_000),
        (25_000, 5_000),
        (30_000, 10_000),
        (31_000, 1_000),
        (99_000, 9_000),
        (1_999_000, 1_000),
        (1_500, 1_500),
        (15_500, 7_750),
        (500, 500),
    ];
    for (interval, part) in expected {
        assert_eq!(looked_at(interval * 1000), Some(part * 1000), "of {interval} us");
    }
}
