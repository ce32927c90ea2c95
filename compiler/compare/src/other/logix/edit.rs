//! A replacement in the text, and where what follows it was before.

use staunch_frontend::Span;

/// A replacement in one file.
#[derive(Debug)]
pub struct Edit {
    pub start: usize,
    pub end: usize,
    pub text: String,
}

/// The place before the replacements of one after them; in a replacement, its start or end.
pub fn origin(edits: &[Edit], at: usize, is_end: bool) -> usize {
    let (mut old, mut new) = (0, 0);
    for edit in edits {
        let begins = new + edit.start - old;
        let ends = begins + edit.text.len();
        if at < begins || is_end && at == begins {
            break;
        }
        if at < ends || is_end && at == ends {
            return if is_end { edit.end } else { edit.start };
        }
        (old, new) = (edit.end, ends);
    }
    old + at - new
}

pub fn bounds(span: Span) -> (usize, usize) {
    let at = |it: u32| usize::try_from(it).unwrap_or(usize::MAX);
    (at(span.start), at(span.end))
}
