//! Which block a closing keyword closes, when the innermost one waits for another.

use crate::{
    lex::{Kind, index},
    source::Span,
};

use super::{
    diagnostics, misspelt,
    parser::{In, State, TokenReader},
    token_class::{end_of, is_end, is_pou_end, opens_item},
};

/// What a closing keyword is that the innermost block does not wait for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// It closes the innermost block, under another block's word.
    WrongWord,
    /// It closes a block further out: the innermost one has no end.
    Missing,
    /// It closes nothing.
    Stray,
}

/// Tries the three readings, and takes the one that leaves least to complain about in what follows.
/// `innermost` is the end of the innermost block, if that has left the state's list already.
pub fn judge(input: &mut In<'_, '_, '_>, innermost: Option<Kind>) -> Verdict {
    let at = input.number();
    let own = usize::from(input.state().instead.is_none());
    let here = input.kind();
    let state = input.state();
    let mut open: Vec<Kind> = state.open.iter().map(|(end, _)| *end).filter(|it| !is_pou_end(*it)).collect();
    open.extend(innermost);
    let Some((_, outer)) = open.split_last() else { return Verdict::Stray };
    let rest = at + own;
    let wrong = mistakes(state, outer.to_vec(), None, rest);
    let missing = mistakes(state, outer.to_vec(), Some(here), rest);
    let stray = mistakes(state, open.clone(), None, rest);
    if missing <= wrong && missing <= stray {
        Verdict::Missing
    } else if wrong <= stray {
        Verdict::WrongWord
    } else {
        Verdict::Stray
    }
}

/// How far ahead the readings are compared: further on, one block more or less shows nothing.
const HORIZON: usize = 2000;

/// How many of the innermost blocks take part.
const BLOCKS: usize = 16;

/// How many ends are missing or too many from the token `at` to the end of the POU, if the blocks
/// `open` are open there and `first` comes before it.
fn mistakes(state: &State<'_, '_>, mut open: Vec<Kind>, first: Option<Kind>, mut at: usize) -> usize {
    open.drain(..open.len().saturating_sub(BLOCKS));
    let mut found = first.map_or(0, |it| close(&mut open, it));
    let horizon = at + HORIZON;
    loop {
        let (kind, count) = token(state, at, &open);
        if at > horizon || kind == Kind::End || opens_item(kind) || is_pou_end(kind) {
            return found + open.len();
        }
        if let Some(end) = end_of(kind) {
            open.push(end);
        } else if is_end(kind) {
            found += close(&mut open, kind);
        }
        at += count;
    }
}

/// The kind at `at`, misspelt ends by what they stand for where the blocks `open` are, and how many tokens it takes.
fn token(state: &State<'_, '_>, at: usize, open: &[Kind]) -> (Kind, usize) {
    let kind = state.tokens.kinds.get(at).copied().unwrap_or(Kind::End);
    if kind != Kind::Name {
        return (kind, 1);
    }
    let (start, end) = state.tokens.places[at];
    let word = state.text.get(index(start)..index(end)).unwrap_or_default();
    let next = state.tokens.kinds.get(at + 1).copied().unwrap_or(Kind::End);
    let is_used = matches!(next, Kind::Assign | Kind::Dot | Kind::OpenParen | Kind::OpenBracket | Kind::Comma);
    let end = if is_used { None } else { misspelt::misspelt_end(word, next, open.iter().rev().copied()) };
    end.unwrap_or((kind, 1))
}

fn close(open: &mut Vec<Kind>, end: Kind) -> usize {
    let near = open.len().saturating_sub(BLOCKS);
    match open[near..].iter().rposition(|it| *it == end) {
        Some(place) => {
            let place = place + near;
            let lost = open.len() - place - 1;
            open.truncate(place);
            lost
        }
        None => 1,
    }
}

/// Takes the end of a block that was opened at `opened`, or reports what is in its place.
pub fn close_block(input: &mut In<'_, '_, '_>, end: Kind, opened: Span) {
    if let Some(closed) = input.eat(end) {
        note_columns(input, opened, closed);
        return;
    }
    if input.state().braced.contains(&opened) {
        return;
    }
    if misspelt::takes_end(input, end) {
        return;
    }
    let kind = input.kind();
    let ends = is_end(kind) && !is_pou_end(kind);
    if ends && judge(input, Some(end)) == Verdict::WrongWord {
        diagnostics::wrong_end(input, end, opened);
        input.take();
    } else {
        diagnostics::missing_end(input, end, opened);
    }
}

/// Keeps the first block whose end is in another column: if an end is missing, it is missing there.
fn note_columns(input: &mut In<'_, '_, '_>, opened: Span, closed: Span) {
    let state = input.state();
    if state.misaligned.is_none()
        && let (Some(first), Some(last)) = (column(state.text, opened), column(state.text, closed))
        && first != last
        && state.breaks(opened.end, closed.start)
    {
        state.misaligned = Some(opened);
    }
}

/// How far in a token is that is the first on its line.
pub fn column(text: &str, span: Span) -> Option<usize> {
    let before = text.get(..index(span.start))?;
    let line = before.trim_end_matches([' ', '\t']);
    (line.is_empty() || line.ends_with('\n')).then_some(before.len() - line.len())
}
