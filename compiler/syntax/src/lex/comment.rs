//! The ends of comments and pragmas, as the bytes up to them from after their beginning. That is the rest of the text when the
//! end is missing; the caller sees that from the last characters.

use crate::source::Comments;

/// `(* … (* … *) … *)`
pub fn nested(rest: &str) -> usize {
    let bytes = rest.as_bytes();
    let mut depth = 1_usize;
    let mut at = 0;
    while at + 1 < bytes.len() {
        match (bytes[at], bytes[at + 1]) {
            (b'*', b')') => depth -= 1,
            (b'(', b'*') => depth += 1,
            _ => {
                at += 1;
                continue;
            }
        }
        at += 2;
        if depth == 0 {
            return at;
        }
    }
    bytes.len()
}

/// `(* … (* … *)`
pub fn first(rest: &str) -> usize {
    until(rest, "*)")
}

/// A line that OpenPLC's editor adds for its debugger, `(*DBG:… (void *) …*)`, which the runtime drops before it compiles.
pub fn debugger(text: &str) -> Option<usize> {
    let line = text.lines().next()?.trim_end();
    (line.starts_with(DEBUGGER) && line.ends_with("*)")).then_some(line.len())
}

const DEBUGGER: &str = "(*DBG:";

/// `/* … */`
pub fn plain(rest: &str) -> usize {
    until(rest, "*/")
}

/// `{ … }`, or `{{ … }}` around code in C.
pub fn pragma(rest: &str) -> usize {
    until(rest, if rest.starts_with('{') { "}}" } else { "}" })
}

fn until(rest: &str, end: &str) -> usize {
    rest.find(end).map_or(rest.len(), |at| at + end.len())
}

/// Whether a comment or pragma reached its own end.
pub fn is_closed(text: &str, comments: Comments) -> bool {
    let is_whole = || comments == Comments::Plain || text.starts_with(DEBUGGER) || balanced(text);
    match text.as_bytes() {
        [b'/', b'/', ..] => true,
        [b'(', b'*', rest @ ..] => rest.ends_with(b"*)") && is_whole(),
        [b'/', b'*', rest @ ..] => rest.ends_with(b"*/"),
        _ => text.ends_with('}'),
    }
}

/// A nested comment may end with the mark of an inner one.
fn balanced(text: &str) -> bool {
    let bytes = text.as_bytes();
    let (mut depth, mut at) = (0_usize, 0);
    while at + 1 < bytes.len() {
        match (bytes[at], bytes[at + 1]) {
            (b'(', b'*') => depth += 1,
            (b'*', b')') => depth = depth.saturating_sub(1),
            _ => {
                at += 1;
                continue;
            }
        }
        at += 2;
    }
    depth == 0
}
