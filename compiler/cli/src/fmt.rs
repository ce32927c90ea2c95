//! `fmt`: sources laid out in place.

use crate::args::{Common, Fmt};
use crate::{REJECTED, input, output, session};
use similar::TextDiff;
use staunch_frontend::format::{self, Refusal, Style};
use std::collections::HashSet;
use std::path::{Path, PathBuf};

/// Lays out all files; what cannot be laid out is said, and the others are.
pub fn fmt(common: &Common, args: &Fmt) -> Result<u8, String> {
    let (project, named) = session::named(&args.files)?;
    let common = common.with(&project);
    let (mut changes, mut problems, mut seen) = (0, 0, HashSet::new());
    for path in input::found(&named)? {
        if !seen.insert(path.canonicalize().unwrap_or_else(|_| path.clone())) {
            continue;
        }
        match laid_out(&path, &project.layout)? {
            (name, _, Err(refusal)) => {
                let is_named = named.contains(&path);
                // A folder may hold other systems' files next to the text.
                if is_named || refusal != Refusal::Foreign {
                    problems += 1;
                    output::tell(format_args!("error: {name}: {}", refusal.text()));
                }
            }
            (name, before, Ok(after)) => changes += usize::from(put(args, &common, (&path, &name), &before, &after)?),
        }
    }
    if problems > 0 {
        return Ok(REJECTED);
    }
    Ok(if args.check && changes > 0 { REJECTED } else { 0 })
}

type LaidOut = (String, Vec<u8>, Result<Vec<u8>, Refusal>);

fn laid_out(path: &Path, style: &Style) -> Result<LaidOut, String> {
    let (name, bytes) = input::bytes(path)?;
    let after = format::bytes(&name, &bytes, style);
    Ok((name, bytes, after))
}

/// Writes a file, or says what would be written. Whether it changes.
fn put(
    args: &Fmt,
    common: &Common,
    (path, name): (&PathBuf, &str),
    before: &[u8],
    after: &[u8],
) -> Result<bool, String> {
    let changes = before != after;
    if args.diff && changes {
        output::print(difference(name, before, after).as_bytes())?;
    }
    if args.check && changes && !common.quiet {
        output::tell(format_args!("{name}: not laid out as `staunch fmt` does"));
    }
    if args.check || args.diff {
        return Ok(changes);
    }
    if path == Path::new("-") {
        output::print(after)?;
    } else if changes {
        output::write(path, after)?;
        if !common.quiet {
            output::tell(format_args!("{:>12} {name}", "Formatted"));
        }
    }
    Ok(changes)
}

fn difference(name: &str, before: &[u8], after: &[u8]) -> String {
    let [before, after] = [before, after].map(String::from_utf8_lossy);
    let diff = TextDiff::from_lines(&*before, &*after);
    diff.unified_diff().header(name, name).to_string()
}
