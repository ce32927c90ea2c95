//! The counters of the systems, scan by scan, as programs on every executor.

use staunch_frontend::{Format, Source, Sources, Style, render};
use staunch_tests::execute::{Settings, agree};
use staunch_tests::folder;
use staunch_tests::scan::{Row, Table};
use staunch_tests::vector::{self, Scan, Vector};

const VECTORS: usize = 211;
const ROWS: usize = 1304;

#[test]
fn every_counter_vector_holds_on_every_executor() {
    let text = std::fs::read_to_string(folder().join("vectors/counters.json")).unwrap();
    let vectors = vector::read(&text);
    let failures: Vec<_> = vectors
        .iter()
        .filter_map(|it| run(it).err().map(|error| format!("{}: {error}\n{}", it.id, it.source)))
        .collect();
    assert!(failures.is_empty(), "{} of {} fail\n{}", failures.len(), vectors.len(), failures.join("\n"));
    assert_eq!((vectors.len(), vectors.iter().map(|it| it.scans.len()).sum()), (VECTORS, ROWS));
}

fn run(vector: &Vector) -> Result<(), String> {
    let mut sources = Sources::default();
    sources.add(Source::new("program.st", vector.source.clone()));
    let compilation = staunch_frontend::compile(&sources, &vector.options);
    let messages = || {
        compilation
            .diagnostics
            .iter()
            .map(|it| render(it, &sources, Format::Human, Style::default()))
            .collect::<String>()
    };
    let program = compilation.program.as_ref().ok_or_else(messages)?;
    let table = table(vector)?;
    let first = Some(vector.scans.iter().map(|it| it.first).collect());
    let outcome = agree(program, &vector.module(), &table, &Settings { first, ..Settings::default() })?;
    for (number, (row, scan)) in outcome.table.rows.iter().zip(&vector.scans).enumerate() {
        let found = table.outputs.iter().zip(&row.outputs);
        for (path, value) in found {
            let expected = scan.expected.iter().find(|it| it.0 == *path);
            if let Some((_, expected)) = expected.filter(|it| it.1 != *value) {
                return Err(format!("row {}: {path} is {value}, not {expected}", number + 1));
            }
        }
        if row.outputs.len() != table.outputs.len() {
            return Err(format!("row {} did not run", number + 1));
        }
    }
    Ok(())
}

/// The vector's rows as a stimulus, and its outputs as columns.
fn table(vector: &Vector) -> Result<Table, String> {
    let inputs = columns(vector, |it| &it.inputs);
    let outputs = columns(vector, |it| &it.expected);
    let header = format!("@event,{},|,{}", inputs.join(","), outputs.join(","));
    let mut table = Table::parse(&format!("{header}\n{}|\n", ",".repeat(inputs.len() + 1)))?;
    table.rows = vector.scans.iter().map(|it| Row { inputs: cells(it, &inputs), outputs: Vec::new() }).collect();
    Ok(table)
}

fn cells(scan: &Scan, columns: &[String]) -> Vec<String> {
    // The last value of a pin counts: a row's, before that which holds for the table.
    let value = |column: &String| {
        scan.inputs.iter().rev().find(|it| it.0 == *column).map_or_else(String::new, |it| it.1.clone())
    };
    [scan.event.unwrap_or_default().to_owned()].into_iter().chain(columns.iter().map(value)).collect()
}

fn columns(vector: &Vector, of: impl Fn(&Scan) -> &Vec<(String, String)>) -> Vec<String> {
    let mut columns: Vec<String> = Vec::new();
    for (name, _) in vector.scans.iter().flat_map(&of) {
        if !columns.contains(name) {
            columns.push(name.clone());
        }
    }
    columns
}
