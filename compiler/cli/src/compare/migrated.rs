//! `compare --write`: the program as the other system accepts it.

use crate::output;
use crate::session::Session;
use staunch_compare::other::renamed;
use staunch_frontend::{Dialect, Fix, Source, Sources};
use std::path::Path;

/// Writes the program's own files as one, with the system's names; nothing where it would be rejected as it is.
pub fn write(from: &Session, path: &Path, sources: &Sources, names: &[Fix], to: Dialect) -> Result<(), String> {
    let text = text(sources, names, to);
    let name = path.display().to_string();
    let mut migrated = Sources::default();
    migrated.refer(sources.references().iter().cloned());
    migrated.add(Source::new(name.as_str(), text.clone()));
    sources.files().iter().filter(|it| it.is_of_library()).for_each(|it| migrated.add(it.clone()));
    let errors = from.errors_of(to, &migrated)?;
    if let Some(first) = errors.first() {
        let line = migrated.get(first.span.file).line(first.span.start);
        return Err(format!(
            "no file is written to {name}: {} would reject it, in line {line}: {}",
            to.name(),
            first.message
        ));
    }
    output::write(path, text.as_bytes())?;
    if let Some(remark) = ladder(&text).filter(|_| to == Dialect::Logix) {
        output::tell(format_args!("{name}: {remark}"));
    }
    Ok(())
}

/// What Studio 5000 takes only in ladder.
const LADDER: [&str; 11] = ["CTU", "CTD", "RES", "TON", "TOF", "RTO", "ONS", "OSR", "OSF", "OTL", "OTU"];

/// Which lines of a text for Logix are rungs there, and what the others are.
fn ladder(text: &str) -> Option<String> {
    let is_called = |line: &str, name: &str| {
        let line = line.to_ascii_uppercase();
        line.match_indices(name).any(|(at, _)| {
            let is_word = |it: char| it.is_ascii_alphanumeric() || matches!(it, '_' | '.');
            let before = line[..at].chars().next_back().is_some_and(is_word);
            !before && line[at + name.len()..].trim_start().starts_with('(')
        })
    };
    let mut names: Vec<&str> = Vec::new();
    let mut lines: Vec<String> = Vec::new();
    for (number, line) in (1..).zip(text.lines()) {
        let code = line.split("//").next().unwrap_or_default();
        let here: Vec<&str> = LADDER.into_iter().filter(|it| is_called(code, it)).collect();
        if !here.is_empty() {
            lines.push(number.to_string());
        }
        names.extend(here);
    }
    names.sort_unstable();
    names.dedup();
    let (last, others) = names.split_last()?;
    let names = if others.is_empty() { (*last).to_owned() } else { format!("{} and {last}", others.join(", ")) };
    let lines = if lines.len() == 1 { format!("line {}", lines[0]) } else { format!("lines {}", lines.join(", ")) };
    Some(format!(
        "Studio 5000 has {names} only in ladder: make a rung of each ({lines}), with the argument of `RungIn` as its condition. It takes \
         the other statements as Structured Text, including CTUD with an FBD_COUNTER; there the variables are tags"
    ))
}

fn text(sources: &Sources, names: &[Fix], to: Dialect) -> String {
    // What a project file defines is not in the sources.
    let definition = |it: &String| match it.split_once('=') {
        Some((name, value)) => format!("{{define {name} '{value}'}}"),
        None => format!("{{define {it}}}"),
    };
    let mut parts: Vec<_> = sources.definitions().iter().map(definition).collect();
    let mut is_named = false;
    for (source, file) in sources.files().iter().zip(0u16..).filter(|(it, _)| !it.is_of_library()) {
        let text = renamed::with_own_names(&source.text, names.iter().filter(|it| it.span.file == file));
        let without = renamed::without_dialect(&text);
        is_named |= without.is_some();
        parts.push(without.unwrap_or(text));
    }
    if is_named {
        // A file has one dialect.
        parts.insert(0, format!("{{dialect '{}'}}", to.name()));
    }
    parts.join("\n")
}
