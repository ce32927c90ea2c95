//! The example runs, and does what its README shows.

use std::process::Command;

#[test]
fn the_program_calls_rust() {
    let run = Command::new(env!("CARGO_BIN_EXE_staunch-example-external-rust")).output().expect("the example runs");
    let text = String::from_utf8_lossy(&run.stdout);
    let readme = include_str!("../README.md");
    let shown = readme.split_once("-p staunch-example-external-rust\n").and_then(|(_, it)| it.split_once("```"));
    assert!(run.status.success());
    assert_eq!(Some(&*text), shown.map(|(it, _)| it));
}
