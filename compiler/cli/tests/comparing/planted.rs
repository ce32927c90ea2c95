//! A hundred programs whose shortest difference is known by construction, planted at depths from 1 to 5000
//! scans. `staunch compare` finds it within its default budget, or says that it has not: never that the
//! systems are equal, and never a difference before there is one.
//!
//! `cargo test -p staunch --test comparing planted -- --ignored --nocapture` tries all and prints the count.

use super::programs::{self, Folder};

struct Planted {
    name: String,
    from: &'static str,
    to: &'static str,
    source: String,
    /// Scans of the shortest difference.
    depth: usize,
}

const DEPTHS: [usize; 13] = [1, 3, 8, 20, 50, 100, 200, 400, 800, 1500, 2500, 3500, 5000];

fn program(declared: &str, body: &str) -> String {
    format!(
        "PROGRAM p\nVAR_INPUT item : BOOL; END_VAR\nVAR out : BOOL; e : R_TRIG; END_VAR\n{declared}\n{body}\nEND_PROGRAM\n"
    )
}

/// Edges that fit into so many scans, after the first.
fn edges(depth: usize) -> usize {
    depth.saturating_sub(1) / 2
}

/// Past a large preset: the surplus edge is the one after `n`, in scan `2n + 1`.
fn preset(depth: usize) -> Planted {
    let n = edges(depth).max(1);
    let source = program("VAR c : CTU; END_VAR", &format!("e(CLK := item); c(e.Q, FALSE, {n}); out := c.CV > {n};"));
    Planted { name: format!("preset_{depth}"), from: "iec", to: "cscape", source, depth: 2 * n + 1 }
}

/// Three inputs in turn, each in a scan of its own, before anything counts.
fn sequence(depth: usize) -> Planted {
    let n = edges(depth).max(1);
    let source = program(
        "VAR_INPUT a, b, d : BOOL; END_VAR VAR s1, s2, s3 : BOOL; c : CTU; END_VAR",
        &format!(
            "IF d AND s2 THEN s3 := TRUE; END_IF IF b AND s1 THEN s2 := TRUE; END_IF IF a THEN s1 := TRUE; END_IF
             e(CLK := item AND s3); c(e.Q, FALSE, {n}); out := c.CV > {n};"
        ),
    );
    Planted { name: format!("sequence_{depth}"), from: "iec", to: "cscape", source, depth: 2 + 2 * n + 1 }
}

/// Only between two levels, and of one recipe.
fn threshold(depth: usize) -> Planted {
    let n = edges(depth).max(1);
    let source = program(
        "VAR_INPUT level : REAL; recipe : INT; END_VAR VAR c : CTU; END_VAR",
        &format!(
            "e(CLK := item AND level > 71.5 AND level < 72.25 AND recipe * 3 = 1251);
             c(e.Q, FALSE, {n}); out := c.CV > {n};"
        ),
    );
    Planted { name: format!("threshold_{depth}"), from: "iec", to: "cscape", source, depth: 2 * n + 1 }
}

/// A restart that one system counts on after: it costs no scan, once something is counted.
fn restart(depth: usize) -> Planted {
    let n = edges(depth).max(1) + 1;
    let source = format!(
        "PROGRAM p\nVAR_INPUT item : BOOL; END_VAR\nVAR out : BOOL; END_VAR\nVAR RETAIN e : R_TRIG; c : CTU; END_VAR\n\
         e(CLK := item); c(e.Q, FALSE, 32767); out := c.CV >= {n};\nEND_PROGRAM\n"
    );
    Planted { name: format!("restart_{depth}"), from: "iec", to: "cscape", source, depth: 2 * n - 1 }
}

/// A counter that counts how often another is full.
fn cascade(depth: usize) -> Planted {
    let inner = 3;
    let outer = (depth / (2 * inner)).saturating_sub(1).max(1);
    let source = program(
        "VAR a, b : CTU; END_VAR",
        &format!("e(CLK := item); a(e.Q, a.Q, {inner}); b(a.Q, FALSE, {outer}); out := b.CV > {outer};"),
    );
    Planted { name: format!("cascade_{depth}"), from: "iec", to: "cscape", source, depth: 2 * inner * (outer + 1) - 1 }
}

/// A timer between the input and the counter: it takes 20 scans, and a scan to fall.
fn timer(depth: usize) -> Planted {
    let n = (depth / 22).max(1);
    let source = program(
        "VAR t : TON; c : CTU; END_VAR",
        &format!("t(IN := item AND NOT t.Q, PT := T#200ms); c(t.Q, FALSE, {n}); out := c.CV > {n};"),
    );
    Planted { name: format!("timer_{depth}"), from: "iec", to: "cscape", source, depth: 21 + 22 * n }
}

/// Below zero, further and further.
fn below(depth: usize) -> Planted {
    let m = edges(depth);
    let source = program("VAR c : CTD; END_VAR", &format!("e(CLK := item); c(e.Q, FALSE, 3); out := c.CV < -{m};"));
    Planted { name: format!("below_{depth}"), from: "iec", to: "openplc", source, depth: 2 * m + 1 }
}

/// The first edge counts on one system alone; it shows when the preset is reached.
fn start_up(depth: usize) -> Planted {
    let n = edges(depth).max(1) + 1;
    let source = program("VAR c : CTU; END_VAR", &format!("c(CU := item, R := FALSE, PV := {n}); out := c.Q;"));
    Planted { name: format!("start_up_{depth}"), from: "iec", to: "logix", source, depth: 2 * n - 1 }
}

fn planted() -> Vec<Planted> {
    let shapes = [preset, sequence, threshold, restart, cascade, timer, below, start_up];
    let all = DEPTHS.into_iter().flat_map(|depth| shapes.map(|shape| shape(depth)));
    all.take(100).collect()
}

/// After how many scans the difference was found; `None` where the command says that it has found none.
fn found(planted: &Planted) -> Option<usize> {
    let path = Folder("planted").written(&format!("{}.st", planted.name), &planted.source);
    let systems = ["--from", planted.from, "--to", planted.to, "--vars", "out", "-A", "warnings"];
    let output = programs::command().arg(&path).args(systems).output().expect("the command starts");
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let scans = text.split(" differ after ").nth(1).and_then(|it| it.split(' ').next()).and_then(|it| it.parse().ok());
    match (output.status.code(), scans) {
        (Some(1), Some(scans)) => {
            assert!(
                scans >= planted.depth,
                "{}: {scans} scans, where {} are needed\n{text}",
                planted.name,
                planted.depth
            );
            Some(scans)
        }
        (Some(4), None) => None,
        (code, _) => panic!("{}: {code:?}\n{text}{}", planted.name, String::from_utf8_lossy(&output.stderr)),
    }
}

fn count(all: &[Planted]) -> (usize, usize) {
    // Each compares by itself: as many at a time as there are processors.
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let scans: Vec<_> = std::thread::scope(|scope| {
        let part = |first: usize| all.iter().skip(first).step_by(threads).map(|it| (it, found(it))).collect::<Vec<_>>();
        let parts: Vec<_> = (0..threads).map(|first| scope.spawn(move || part(first))).collect();
        parts.into_iter().flat_map(|it| it.join().expect("no comparison panics")).collect()
    });
    for (planted, scans) in &scans {
        match scans {
            None => println!("{}: not found, planted at {}", planted.name, planted.depth),
            Some(scans) if *scans > planted.depth => println!("{}: {scans} for {}", planted.name, planted.depth),
            Some(_) => {}
        }
    }
    let shortest = scans.iter().filter(|it| it.1 == Some(it.0.depth)).count();
    (scans.iter().filter(|it| it.1.is_some()).count(), shortest)
}

#[test]
fn what_is_planted_is_found() {
    let mut sample = planted();
    sample.retain(|it| [3, 200].iter().any(|depth| it.name.ends_with(&format!("_{depth}"))));
    assert_eq!(count(&sample), (sample.len(), sample.len()));
}

#[test]
#[ignore = "it takes minutes"]
fn all_that_is_planted_is_found() {
    let all = planted();
    let (found, shortest) = count(&all);
    println!("{found} of {} found, {shortest} of them by a shortest trace", all.len());
    assert_eq!(all.len(), 100);
    assert!(found >= 95, "{found}");
}
