//! What a key takes, in instructions: one check of the program for all that an editor shows after it, and for an answer at a place
//! no more than a part of a check.
//!
//! The test runs itself under cachegrind, and compares sessions, so what it holds does not depend on how it was optimised. This
//! prints the figures, of as many lines as are asked for:
//!
//! ```sh
//! STAUNCH_STATIONS=385 cargo test --release -p staunch-lsp --test typing -- --nocapture
//! ```
#![cfg(target_os = "linux")]

mod support;

use serde_json::{Value as Json, json};
use staunch_frontend::{Dialect, Options, Source, Sources, check};
use std::fmt::Write as _;
use std::process::Command;
use support::{Editor, uri};

/// What a session does after each key.
const SESSIONS: [&str; 5] = ["nothing", "keys", "hover", "completion", "all"];
const SESSION: &str = "STAUNCH_SESSION";
const KEYS: u64 = 2;
/// Of some fifty lines each.
const STATIONS: usize = 40;
const PER_FILE: usize = 4;

#[test]
fn a_key_takes_one_check() {
    if let Ok(session) = std::env::var(SESSION) {
        return run(&session);
    }
    if Command::new("valgrind").arg("--version").output().is_err() {
        println!("SKIPPED: for want of valgrind");
        return;
    }
    let counts: Vec<u64> = std::thread::scope(|scope| {
        let all = ["check"].iter().chain(&SESSIONS).map(|it| scope.spawn(|| counted(it)));
        all.collect::<Vec<_>>().into_iter().map(|it| it.join().expect("it is counted")).collect()
    });
    let [one, nothing, keys, hover, completion, all] = counts[..] else { panic!("six sessions") };
    let per_key = |it: u64, than: u64| it.saturating_sub(than) / KEYS;
    let key = per_key(keys, nothing);
    let (hover, completion, all) = (per_key(hover, keys), per_key(completion, keys), per_key(all, keys));
    println!("check {one}, key {key}, hover {hover}, completion {completion}, all other requests {all}");
    assert!(key < one + one / 2, "diagnostics after a key: {key}, a check: {one}");
    assert!(hover < one * 2 / 3, "hover: {hover}, a check: {one}");
    assert!(completion < one, "completion: {completion}, a check: {one}");
    assert!(all < one, "all other requests: {all}, a check: {one}");
}

/// The instructions of a session, or of one check.
fn counted(session: &str) -> u64 {
    let mut valgrind = Command::new("valgrind");
    valgrind.args([
        "--tool=cachegrind",
        "--cache-sim=no",
        "--cachegrind-out-file=/dev/null",
        "--main-stacksize=67108864",
    ]);
    valgrind.arg(std::env::current_exe().expect("this test"));
    valgrind.args(["--exact", "a_key_takes_one_check", "--nocapture"]).env(SESSION, session);
    let output = valgrind.output().expect("valgrind runs");
    let report = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{session}: {report}");
    let refs = report.lines().find_map(|it| it.split_once(" refs:")).expect("a count").1;
    let count: u64 = refs.trim().replace(',', "").parse().expect("a number");
    // The cost of making the texts, and of the test itself, is not part of a check.
    if session == "check" { count.saturating_sub(counted("no check")) } else { count }
}

fn run(session: &str) {
    let files = files();
    match session {
        "no check" => return,
        "check" => {
            let mut sources = Sources::default();
            files.iter().for_each(|(name, text)| sources.add(Source::new(*name, text.clone())));
            assert!(check(&sources, &Options::default()).is_empty());
            return;
        }
        _ => {}
    }
    let (name, text) = files[1].clone();
    let borrowed: Vec<_> = files.iter().map(|it| (it.0, it.1.as_str())).collect();
    let mut editor = Editor::open(Dialect::Iec, &borrowed);
    editor.problems(name);
    let (line, _) = text.lines().enumerate().filter(|it| it.1.starts_with("mean := ")).nth(2).expect("a line");
    let line = line as u32;
    let whole = json!({ "start": { "line": 0, "character": 0 }, "end": { "line": 9999, "character": 0 } });
    let about = json!({ "textDocument": { "uri": uri(name) }, "range": whole, "context": { "diagnostics": [] } });
    for at in 0..(if session == "nothing" { 0 } else { KEYS as u32 }) {
        editor.edit(name, (line, at), 0, if at == 0 { "l" } else { "i" });
        match session {
            "hover" => assert_ne!(editor.at("hover", name, (line, 10 + at)), Json::Null),
            "completion" => assert_ne!(editor.at("completion", name, (line, at + 1)), json!([])),
            _ => {}
        }
        editor.problems(name);
        if session == "all" {
            for method in ["semanticTokens/full", "inlayHint", "codeAction", "documentSymbol", "foldingRange"] {
                editor.ask(&format!("textDocument/{method}"), about.clone());
            }
            editor.at("documentHighlight", name, (line, 1));
        }
    }
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    println!("{session}: {}", status.lines().find(|it| it.starts_with("VmHWM")).unwrap_or_default());
    editor.close();
}

/// Stations, so many in each file, and a PROGRAM that has them all.
fn files() -> Vec<(&'static str, String)> {
    let count = std::env::var("STAUNCH_STATIONS").ok().and_then(|it| it.parse().ok()).unwrap_or(STATIONS);
    let mut main = "PROGRAM Main\nVAR start : BOOL; total : DINT;\n".to_owned();
    (0..count).for_each(|n| writeln!(main, "s{n} : Station{n};").expect("a text"));
    main.push_str("END_VAR\ntotal := 0;\n");
    for n in 0..count {
        writeln!(main, "s{n}(start := start, limit := {n});\ntotal := total + INT_TO_DINT(s{n}.full);")
            .expect("a text");
    }
    main.push_str("END_PROGRAM\n");
    let mut files = vec![("main.st", main)];
    for first in (0..count).step_by(PER_FILE) {
        let text = (first..count.min(first + PER_FILE)).map(|n| STATION.replace('@', &n.to_string())).collect();
        files.push((String::leak(format!("stations_{first}.st")), text));
    }
    files
}

const STATION: &str = "\
(* Station @ counts what it fills. *)
TYPE
    State@ : (Idle@, Filling@, Full@);
    Part@ : STRUCT
        weight : REAL;
        count : INT;
        label : STRING[16];
    END_STRUCT
END_TYPE
FUNCTION Mean@ : REAL
VAR_IN_OUT
    parts : ARRAY[0..9] OF Part@;
END_VAR
VAR
    i : INT;
    sum : REAL;
END_VAR
FOR i := 0 TO 9 DO
    sum := sum + parts[i].weight * INT_TO_REAL(parts[i].count + @);
END_FOR
Mean@ := sum / 10.0;
END_FUNCTION
FUNCTION_BLOCK Station@
VAR_INPUT start : BOOL; limit : INT; END_VAR
VAR_OUTPUT full : INT; mean : REAL; END_VAR
VAR
    state : State@;
    parts : ARRAY[0..9] OF Part@;
    wait : TON;
    filled : CTU;
END_VAR
wait(IN := start AND state <> Full@, PT := T#250ms);
filled(CU := wait.Q, R := NOT start, PV := 10);
CASE state OF
    Idle@:
        IF start THEN state := Filling@; END_IF
    Filling@:
        parts[filled.CV MOD 10].count := limit;
        parts[filled.CV MOD 10].label := CONCAT('part ', INT_TO_STRING(limit));
        IF filled.Q OR limit > 90 AND start THEN
            state := Full@;
        END_IF
    Full@:
        full := full + 1;
        state := Idle@;
END_CASE
mean := Mean@(parts := parts);
END_FUNCTION_BLOCK
";
