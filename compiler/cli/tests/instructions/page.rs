//! `docs/performance.md`: its tables are written from `tests/perf/instructions.tsv`.

use crate::root;
use crate::table::Table;
use std::fmt::Write;
use std::fs;
use std::path::PathBuf;

const START: &str = "<!-- written by the test `instructions`: -->\n";
const END: &str = "<!-- end -->\n";

fn path() -> PathBuf {
    root().join("docs/performance.md")
}

pub fn write(table: &Table) {
    fs::write(path(), with_tables(&fs::read_to_string(path()).unwrap(), table)).unwrap();
}

pub fn is_of(table: &Table) -> bool {
    let text = fs::read_to_string(path()).unwrap();
    text == with_tables(&text, table)
}

fn with_tables(text: &str, table: &Table) -> String {
    let (before, rest) = text.split_once(START).expect("the page marks its tables");
    let (_, after) = rest.split_once(END).expect("the page marks its tables' end");
    format!("{before}{START}\n{}\n{}\n{END}{after}", beside_by_hand(table), others(table))
}

fn beside_by_hand(table: &Table) -> String {
    let mut text = "| program | by hand | Rust | | native | |\n|---|---:|---:|---:|---:|---:|\n".to_owned();
    let mut ratios = [const { Vec::new() }; 2];
    for (name, row) in &table.0 {
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

fn others(table: &Table) -> String {
    let mut text = "| program | Rust | native |\n|---|---:|---:|\n".to_owned();
    for (name, row) in &table.0 {
        let [Some(rust), Some(native), _, _, None] = row.figures else { continue };
        writeln!(text, "| {name} | {rust} | {native} |").unwrap();
    }
    text
}

fn geometric_mean(ratios: &[f64]) -> f64 {
    (ratios.iter().map(|it| it.ln()).sum::<f64>() / ratios.len() as f64).exp()
}
