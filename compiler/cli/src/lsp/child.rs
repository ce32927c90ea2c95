//! What lenses run: this command, on files as they are on disk. A program that never ends, or takes all memory, does not end the server.

use crate::args::Common;
use serde_json::Value as Json;
use staunch_frontend::Dialect;
use staunch_lsp::{TestResult, Work};
use std::path::PathBuf;
use std::process::{Command, Stdio};

/// Runs the tests of files whose titles contain one.
pub fn test(common: &Common, files: &[PathBuf], title: &str) -> Result<Work<Vec<TestResult>>, String> {
    let mut command = command("test", common, files)?;
    command.arg(format!("--filter={title}"));
    if let Some(dialect) = common.dialect {
        command.args(["--dialect", dialect.name()]);
    }
    Ok(Box::new(move || {
        let objects = objects(command)?;
        let tests = objects.iter().filter(|it| it["reason"] == "test");
        let results: Vec<_> = tests.map(|it| TestResult { title: text(&it["title"]), outcome: of_test(it) }).collect();
        if results.is_empty() { Err(of_diagnostics(&objects)) } else { Ok(results) }
    }))
}

/// Compares the program in files with itself on another system.
pub fn compare(common: &Common, files: &[PathBuf], from: Dialect, to: Dialect) -> Result<Work<String>, String> {
    let mut command = command("compare", common, files)?;
    command.args(["--from", from.name(), "--to", to.name()]);
    Ok(Box::new(move || {
        let objects = objects(command)?;
        let compared = objects.iter().find(|it| it["reason"] == "compare");
        Ok(compared.map_or_else(|| of_diagnostics(&objects), of_comparison))
    }))
}

fn command(verb: &str, common: &Common, files: &[PathBuf]) -> Result<Command, String> {
    let own = std::env::current_exe().map_err(|it| format!("the command's own file: {it}"))?;
    let mut command = Command::new(own);
    command.args([verb, "--quiet", "--message-format", "json"]).args(files).stdin(Stdio::null());
    for (option, codes) in [("-W", &common.warn), ("-D", &common.deny), ("-A", &common.allow)] {
        codes.iter().for_each(|it| _ = command.args([option, it.as_str()]));
    }
    Ok(command)
}

/// The JSON objects that a command prints; where there is none, what it says instead.
fn objects(mut command: Command) -> Result<Vec<Json>, String> {
    let output = command.output().map_err(|it| format!("{}: {it}", command.get_program().display()))?;
    let printed = String::from_utf8_lossy(&output.stdout);
    let objects: Vec<_> = printed.lines().filter_map(|it| serde_json::from_str(it).ok()).collect();
    if objects.is_empty() {
        let said = String::from_utf8_lossy(&output.stderr);
        let last = said.lines().rfind(|it| !it.trim().is_empty());
        return Err(last.map_or_else(|| format!("it ended with {}", output.status), str::to_owned));
    }
    Ok(objects)
}

/// `passed`, or `failed: expected to be 5, found 4`.
fn of_test(it: &Json) -> String {
    let (result, message) = (text(&it["result"]), text(&it["message"]));
    match message.lines().last() {
        Some(last) => format!("{result}: {last}"),
        None => result,
    }
}

fn of_comparison(it: &Json) -> String {
    match it["verdict"].as_str() {
        Some("equal") => "no difference".to_owned(),
        Some("different") => match it["scans"].as_u64() {
            Some(1) => "differs in the first scan".to_owned(),
            Some(scans) => format!("differs after {scans} scans: {}", text(&it["sentence"])),
            None => format!("differs: {}", text(&it["sentence"])),
        },
        Some("rejected") => format!("rejected there: {}", text(&it["why"])),
        Some(_) | None => "no difference found, none ruled out".to_owned(),
    }
}

/// Of a program that did not run.
fn of_diagnostics(objects: &[Json]) -> String {
    let error = objects.iter().find(|it| it["severity"] == "error" || it["reason"] == "error");
    error.map_or_else(|| "it did not run".to_owned(), |it| format!("it did not run: {}", text(&it["message"])))
}

fn text(it: &Json) -> String {
    it.as_str().unwrap_or_default().to_owned()
}
