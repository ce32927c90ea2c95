//! Formatting: what `staunch fmt` makes of a document.

use crate::place::{count, position};
use gen_lsp_types::{Range, TextEdit};
use staunch_frontend::Source;
use staunch_frontend::format::{self, Style};

/// The changes of a document's lines. Nothing where it is another system's, or has mistakes of encoding.
pub fn whole(path: &str, text: &str, style: &Style) -> Vec<TextEdit> {
    let Ok(after) = format::bytes(path, text.as_bytes(), style) else { return Vec::new() };
    let Ok(after) = String::from_utf8(after) else { return Vec::new() };
    changed(text, &after)
}

/// The same for the lines of a part alone.
pub fn part(path: &str, text: &str, style: &Style, within: Range) -> Vec<TextEdit> {
    let Ok(after) = format::bytes(path, text.as_bytes(), style) else { return Vec::new() };
    let Ok(after) = String::from_utf8(after) else { return Vec::new() };
    let (old, new): (Vec<_>, Vec<_>) = (text.split_inclusive('\n').collect(), after.split_inclusive('\n').collect());
    // A line keeps its number only where none was added or removed.
    if old.len() != new.len() {
        return Vec::new();
    }
    let lines = within.start.line..=within.end.line;
    let changed = (0..).zip(old.iter().zip(&new)).filter(|(line, (old, new))| lines.contains(line) && old != new);
    let document = Source::new(path, text.to_owned());
    changed
        .map(|(line, (_, new))| {
            let range = document.line_range(line + 1);
            TextEdit {
                range: Range {
                    start: position(&document, count(range.start)),
                    end: position(&document, count(range.end)),
                },
                new_text: new.trim_end_matches(['\r', '\n']).to_owned(),
            }
        })
        .collect()
}

/// One change, from the first line that differs to the last.
fn changed(before: &str, after: &str) -> Vec<TextEdit> {
    if before == after {
        return Vec::new();
    }
    let (old, new): (Vec<_>, Vec<_>) = (before.split_inclusive('\n').collect(), after.split_inclusive('\n').collect());
    let same = old.iter().zip(&new).take_while(|(a, b)| a == b).count();
    let rest = old.len().min(new.len()) - same;
    let end = old.iter().rev().zip(new.iter().rev()).take(rest).take_while(|(a, b)| a == b).count();
    let start: usize = old[..same].iter().map(|it| it.len()).sum();
    let stop = before.len() - old[old.len() - end..].iter().map(|it| it.len()).sum::<usize>();
    let document = Source::new("", before.to_owned());
    let range = Range { start: position(&document, count(start)), end: position(&document, count(stop)) };
    vec![TextEdit { range, new_text: new[same..new.len() - end].concat() }]
}
