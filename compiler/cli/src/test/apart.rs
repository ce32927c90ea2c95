//! Tests in an executable of their own, which the back end `rust` makes: what it traces says how they went.

use super::fixture::Step;
use super::outcome::{Outcome, failed};
use super::suite::{self, Pace, Ran, See};
use crate::scratch;
use staunch_frontend::{Assertion, Test};
use staunch_host::csv_cells;
use std::cell::RefCell;
use std::collections::HashMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// A trace: its heading and rows, and the fault that ended it.
struct Trace {
    heading: Vec<String>,
    rows: Vec<Vec<String>>,
    fault: Option<String>,
}

impl Trace {
    fn value(&self, row: &[String], name: &str) -> Result<String, String> {
        let at = self.heading.iter().position(|it| it == name);
        at.and_then(|at| row.get(at)).cloned().ok_or_else(|| format!("the trace has no `{name}`"))
    }
}

fn trace(mut command: Command, test: &Test, scans: u64, turns: u64, names: &[String]) -> Result<Trace, String> {
    command.args(["--program", &test.instance, "--scans", &scans.to_string(), "--trace", "-"]);
    command.args(["--vars", &names.join(","), "--loop-budget", &turns.to_string()]);
    let ran = command.output().map_err(|error| format!("cannot run {:?}: {error}", command.get_program()))?;
    let text = String::from_utf8_lossy(&ran.stdout);
    let mut rows = csv_cells(&text).unwrap_or_default();
    if rows.is_empty() {
        return Err(String::from_utf8_lossy(&ran.stderr).into_owned());
    }
    let fault = (ran.status.code() != Some(0)).then(|| fault_in(&String::from_utf8_lossy(&ran.stderr)));
    Ok(Trace { heading: rows.remove(0), rows, fault })
}

pub fn test(executable: &Path, test: &Test, turns: u64, cycle: i64) -> Result<Outcome, String> {
    let assertions = test.assertions.iter();
    let kept = assertions.flat_map(Assertion::kept);
    let names: Vec<_> = [test.failed.clone()].into_iter().chain(kept.cloned()).collect();
    let mut command = Command::new(executable);
    command.arg(format!("--cycle={cycle}ns"));
    let traced = trace(command, test, 2, turns, &names)?;
    for row in &traced.rows {
        let outcome = failed(test, &|name| traced.value(row, name))?;
        if outcome != Outcome::Passed {
            return Ok(outcome);
        }
    }
    Ok(traced.fault.map_or(Outcome::Passed, Outcome::Faulted))
}

/// Runs tests of a fixture, up to a fault: once to see which assertions fail, and then for what these compared.
pub fn fixture(executable: &Path, test: &Test, turns: u64, pace: Pace, steps: &[Step]) -> Result<Vec<Outcome>, String> {
    let columns: Vec<_> = steps.iter().map(|it| it.values(test)).collect();
    let heading = columns.first().into_iter().flatten().map(|it| format!(",{}", it.0));
    let mut text = format!("scan{}\n", heading.collect::<String>());
    for (values, scan) in columns.iter().zip(1u32..) {
        let cells = values.iter().map(|it| format!(",{}", it.1.text()));
        text += &format!("{scan}{}\n", cells.collect::<String>());
    }
    let folder = scratch::folder()?;
    let stimulus = stimulus(folder.path(), &text)?;
    let traced = |names: &[String]| {
        let mut command = Command::new(executable);
        command.arg("--stimulus").arg(&stimulus).arg(format!("--cycle={}ns", pace.cycle));
        trace(command, test, u64::try_from(steps.len()).unwrap_or(u64::MAX), turns, names)
    };
    // Without assertions no variable says which one has failed.
    let seen = if test.failed.is_empty() { &columns[0][0].0 } else { &test.failed };
    let first = traced(std::slice::from_ref(seen))?;
    let failures = first.rows.iter().filter_map(|it| it.last()?.parse::<usize>().ok()?.checked_sub(1));
    let kept = failures.filter_map(|it| test.assertions.get(it));
    let kept = kept.flat_map(Assertion::kept).cloned();
    let mut names: Vec<_> = kept.chain([seen.clone()]).collect();
    names.sort_unstable();
    names.dedup();
    let second = if names.len() > 1 { traced(&names)? } else { first };
    // The row of a scan that faults is not written.
    let of_row = |row: &Vec<String>| failed(test, &|name| second.value(row, name));
    let mut outcomes = second.rows.iter().map(of_row).collect::<Result<Vec<_>, _>>()?;
    outcomes.extend(second.fault.clone().map(Outcome::Faulted));
    Ok(outcomes)
}

/// Runs a suite once to see when it is finished and how many tests it has, and then for the values that are asked for.
pub fn suite(
    executable: &Path,
    test: &Test,
    turns: u64,
    pace: Pace,
    wanted: usize,
    see: &mut See<'_>,
) -> Result<(), String> {
    let text = format!("scan,{}\n1,{wanted}\n", suite::variable(test, "__wanted"));
    let folder = scratch::folder()?;
    let stimulus = stimulus(folder.path(), &text)?;
    let traced = |scans: u64, names: &[String]| {
        let mut command = Command::new(executable);
        command.arg("--stimulus").arg(&stimulus).arg(format!("--cycle={}ns", pace.cycle));
        trace(command, test, scans, turns, names)
    };
    let (over, count) = (format!("{}.__over", test.instance), suite::variable(test, "__count"));
    let first = traced(pace.scans, &[over.clone(), count.clone()])?;
    let end = first.rows.iter().position(|it| first.value(it, &over).is_ok_and(|it| it == "TRUE"));
    let scans = end.map_or(pace.scans, |it| u64::try_from(it + 1).unwrap_or(pace.scans));
    let last = first.rows.last().map_or_else(|| Ok(String::from("0")), |it| first.value(it, &count))?;
    let names = suite::variables(test, last.parse().unwrap_or(0));
    let second = traced(scans, &names)?;
    let row = second.rows.last().ok_or("the trace is empty")?;
    let more: RefCell<HashMap<String, String>> = RefCell::default();
    let values = |name: &str| {
        if let Ok(known) = second.value(row, name) {
            return Ok(known);
        }
        if let Some(known) = more.borrow().get(name) {
            return Ok(known.clone());
        }
        let traced = traced(scans, &[name.to_owned()])?;
        let value =
            traced.rows.last().map_or_else(|| Err("the trace is empty".to_owned()), |it| traced.value(it, name))?;
        more.borrow_mut().insert(name.to_owned(), value.clone());
        Ok(value)
    };
    see(&Ran { values: &values, fault: first.fault.clone() })
}

fn stimulus(folder: &Path, text: &str) -> Result<PathBuf, String> {
    let path = folder.join("stimulus.csv");
    fs::write(&path, text).map_err(|error| format!("{}: {error}", path.display()))?;
    Ok(path)
}

/// The place and the kind of a fault, without the scan and the program that an executable adds.
fn fault_in(text: &str) -> String {
    let text = text.trim();
    let text = text.strip_prefix("error: ").unwrap_or(text).replacen(": fault: ", ": ", 1);
    text.rsplit_once(" (scan ").map_or(text.clone(), |it| it.0.to_owned())
}
