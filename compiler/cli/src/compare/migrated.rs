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
    let own = sources.files().iter().zip(0u16..).filter(|(it, _)| !it.is_of_library());
    let texts = own.map(|(source, file)| {
        let names = names.iter().filter(|it| it.span.file == file);
        renamed::in_dialect(&renamed::with_own_names(&source.text, names), to)
    });
    // What a project file defines is not in the sources.
    let defined = sources.definitions().iter().map(|it| format!("{{define {it}}}"));
    defined.chain(texts).collect::<Vec<_>>().join("\n")
}
