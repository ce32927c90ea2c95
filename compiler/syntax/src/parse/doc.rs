//! Comments that document a declaration: the one on its line, else those directly before it.

use chumsky::prelude::SimpleSpan;

use crate::{
    lex::{Kind, index},
    source::Span,
};

use super::parser::State;

/// For what these tokens are, and the `,` after them.
pub fn comment(state: &State<'_, '_>, tokens: SimpleSpan) -> Option<String> {
    let comma = state.tokens.kinds.get(tokens.end) == Some(&Kind::Comma);
    let end = tokens.end + usize::from(comma);
    let (last, next) = (state.place(end.saturating_sub(1)), state.place(end));
    trailing(state, last, next).or_else(|| before(state, tokens.start))
}

/// For a POU: only what is before it.
pub fn before(state: &State<'_, '_>, first: usize) -> Option<String> {
    let start = state.place(first).start;
    let floor = if first == 0 { 0 } else { state.place(first - 1).end };
    let comments = &state.tokens.comments;
    let end = comments.partition_point(|it| it.0 < start);
    let mut from = end;
    let mut below = start;
    while from > 0 {
        let (open, close) = comments[from - 1];
        let own_line = floor == 0 || state.breaks(floor, open);
        if open < floor || !own_line || !adjoins(state, close, below) {
            break;
        }
        from -= 1;
        below = open;
    }
    clean(comments[from..end].iter().map(|it| slice(state, *it)))
}

fn trailing(state: &State<'_, '_>, last: Span, next: Span) -> Option<String> {
    let comments = &state.tokens.comments;
    let at = comments.partition_point(|it| it.0 < last.end);
    let it = *comments.get(at)?;
    let same_line = it.0 < next.start && !state.breaks(last.end, it.0);
    // A comment in front of the next thing on the line belongs to that.
    let alone = state.breaks(it.0, next.start) || index(next.start) == state.text.len();
    (same_line && alone).then(|| clean(core::iter::once(slice(state, it)))).flatten()
}

/// At most one line break between two places.
fn adjoins(state: &State<'_, '_>, from: u32, to: u32) -> bool {
    let between = state.text.get(index(from)..index(to)).unwrap_or_default();
    between.bytes().filter(|it| *it == b'\n').count() <= 1
}

fn slice<'s>(state: &State<'_, 's>, (start, end): (u32, u32)) -> &'s str {
    state.text.get(index(start)..index(end)).unwrap_or_default()
}

/// Without comment marks, and without lines that only draw.
fn clean<'s>(comments: impl Iterator<Item = &'s str>) -> Option<String> {
    let mut text = String::new();
    for line in comments.flat_map(|it| inner(it).lines()) {
        let line = line.trim().trim_matches(['*', '/']).trim();
        if line.chars().any(char::is_alphanumeric) {
            if !text.is_empty() {
                text.push('\n');
            }
            text.push_str(line);
        }
    }
    (!text.is_empty()).then_some(text)
}

/// What is between the marks of a comment.
fn inner(comment: &str) -> &str {
    let body = comment.get(2..).unwrap_or_default();
    if comment.starts_with("//") {
        return body;
    }
    body.strip_suffix("*)").or_else(|| body.strip_suffix("*/")).unwrap_or(body)
}
