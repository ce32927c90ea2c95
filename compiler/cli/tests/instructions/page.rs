//! `docs/performance.md`: its tables are written from `tests/perf/*.tsv`.

use crate::root;
use crate::table::{COMPILING, SCANS, Table};
use std::fmt::Write;
use std::fs;
use std::path::PathBuf;
use std::sync::Mutex;

const START: &str = "<!-- written by the test `instructions`: -->\n";
const COMPILING_START: &str = "<!-- written by the test `instructions`, of the command: -->\n";
const END: &str = "<!-- end -->\n";

/// Both tests may bless at a time.
static WRITING: Mutex<()> = Mutex::new(());

fn path() -> PathBuf {
    root().join("docs/performance.md")
}

pub fn write() {
    let _one = WRITING.lock().unwrap();
    fs::write(path(), with_tables(&fs::read_to_string(path()).unwrap())).unwrap();
}

pub fn is_of_tables() -> bool {
    let text = fs::read_to_string(path()).unwrap();
    text == with_tables(&text)
}

fn with_tables(text: &str) -> String {
    let scans = SCANS.read();
    let text = with(text, START, &format!("{}\n{}", beside_by_hand(&scans), others(&scans)));
    with(&text, COMPILING_START, &compiling(&COMPILING.read()))
}

fn with(text: &str, start: &str, tables: &str) -> String {
    let (before, rest) = text.split_once(start).expect("the page marks its tables");
    let (_, after) = rest.split_once(END).expect("the page marks its tables' end");
    format!("{before}{start}\n{tables}\n{END}{after}")
}

fn compiling(table: &Table<4>) -> String {
    let mut text =
        "| program | `check` | `build --emit rust` | `build --emit obj` | `lsp` |\n|---|---:|---:|---:|---:|\n"
            .to_owned();
    for (name, row) in table {
        let figures = row.figures.map(|it| it.map(|it| format!("{:.1}", it as f64 / 1e6)).unwrap_or_default());
        writeln!(text, "| {name} | {} |", figures.join(" | ")).unwrap();
    }
    text
}

fn beside_by_hand(table: &Table<5>) -> String {
    let mut text = "| program | by hand | Rust | | native | |\n|---|---:|---:|---:|---:|---:|\n".to_owned();
    let mut ratios = [const { Vec::new() }; 2];
    for (name, row) in table {
        let [Some(rust), Some(native), _, _, Some(hand)] = row.figures else { continue };
        let times = [rust, native].map(|it| it as f64 / hand as f64);
        ratios.iter_mut().zip(times).for_each(|(all, one)| all.push(one));
        let link = format!("[{name}](../tests/perf/programs/{name}.st)");
        let hand_link = format!("[{hand}](../tests/perf/by_hand/{name}.rs)");
        writeln!(text, "| {link} | {hand_link} | {rust} | {:.2} | {native} | {:.2} |", times[0], times[1]).unwrap();
    }
    let [rust, native] = ratios.map(|it| geometric_mean(&it));
    writeln!(text, "| **geometric mean** | | | **{rust:.2}** | | **{native:.2}** |").unwrap();
    text
}

fn others(table: &Table<5>) -> String {
    let mut text = "| program | Rust | native |\n|---|---:|---:|\n".to_owned();
    for (name, row) in table {
        let [Some(rust), Some(native), _, _, None] = row.figures else { continue };
        writeln!(text, "| {name} | {rust} | {native} |").unwrap();
    }
    text
}

fn geometric_mean(ratios: &[f64]) -> f64 {
    (ratios.iter().map(|it| it.ln()).sum::<f64>() / ratios.len() as f64).exp()
}
