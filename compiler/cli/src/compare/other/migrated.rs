//! `compare --write`: the program as the other system accepts it.

use super::renamed;
use crate::output;
use crate::session::Session;
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
    output::write(path, text.as_bytes())
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
