//! Columns: the types and values of declarations, and the comments at the ends of lines, are aligned.

use super::indent::{Indenter, Layout};
use super::lines::gap;
use super::roles::Role;
use super::words::word;
use crate::lex::Kind;
use core::ops::Range;

/// What is wider takes no part in a column: it would push all others away.
const WIDEST: usize = 40;

/// A line, in parts that columns move.
pub struct Line {
    pub blank_before: bool,
    pub level: usize,
    /// The name of a declaration, its type, and its value; of other lines all at once.
    cells: Vec<String>,
    comment: Option<String>,
    kind: LineKind,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum LineKind {
    Declaration,
    Other,
    /// Nothing but a comment or a pragma.
    Aside,
    /// It is printed as it stands.
    Kept,
}

/// The lines of a text.
pub fn lines(layout: Layout<'_, '_>, breaks: &[u8]) -> Vec<Line> {
    let mut indenter = Indenter::new(layout);
    let mut lines = Vec::new();
    let mut start = 0;
    while start < breaks.len() {
        let end = breaks[start + 1..].iter().position(|it| *it > 0).map_or(breaks.len(), |it| start + 1 + it);
        let level = indenter.start_line(start);
        let declares = indenter.declares() && indenter.starts && layout.blocks.closed(start).is_none();
        lines.push(line(layout, start..end, (level, declares, breaks[start] > 1)));
        (start..end).for_each(|it| indenter.pass(it));
        start = end;
    }
    lines
}

fn line(layout: Layout<'_, '_>, line: Range<usize>, (level, declares, blank_before): (usize, bool, bool)) -> Line {
    let tokens = &layout.tokens[line.clone()];
    let is_kept = tokens.iter().any(|it| it.is_kept);
    let is_aside = tokens.iter().all(super::token::Token::is_aside);
    let has_comment = !is_kept && !is_aside && tokens.last().is_some_and(|it| it.kind == Kind::Comment);
    let code = line.start..line.end - usize::from(has_comment);
    let cuts = if declares && !is_kept && !is_aside { cuts(layout, code.clone()) } else { Vec::new() };
    let kind = match cuts.is_empty() {
        _ if is_kept => LineKind::Kept,
        _ if is_aside => LineKind::Aside,
        false => LineKind::Declaration,
        true => LineKind::Other,
    };
    let ends = cuts.iter().copied().chain([code.end]);
    let starts = [code.start].into_iter().chain(cuts.iter().copied());
    let cells = starts.zip(ends).map(|(start, end)| text(layout, start..end)).collect();
    let comment = has_comment.then(|| word(layout, line.end - 1).into_owned());
    Line { blank_before, level, cells, comment, kind }
}

/// Where the type of a declaration starts, and its value.
fn cuts(layout: Layout<'_, '_>, code: Range<usize>) -> Vec<usize> {
    let (mut depth, mut cuts) = (0_usize, Vec::new());
    for at in code {
        match layout.tokens[at].kind {
            Kind::OpenParen | Kind::OpenBracket => depth += 1,
            Kind::CloseParen | Kind::CloseBracket => depth = depth.saturating_sub(1),
            Kind::Colon if depth == 0 && cuts.is_empty() && layout.roles[at] != Role::LabelEnd => cuts.push(at),
            Kind::Assign if depth == 0 && cuts.len() == 1 => cuts.push(at),
            _ => {}
        }
    }
    cuts
}

fn text(layout: Layout<'_, '_>, tokens: Range<usize>) -> String {
    let mut text = String::new();
    for at in tokens.clone() {
        if at > tokens.start && gap(layout, at) > 0 {
            text.push(' ');
        }
        text += &word(layout, at);
    }
    text
}

/// Widens the cells of declarations that follow one another, and moves the comments below one another.
pub fn align(lines: &mut [Line]) {
    for group in groups(lines, |it| matches!(it.kind, LineKind::Declaration | LineKind::Aside)) {
        for column in 0..2 {
            let lines = &mut lines[group.clone()];
            let own = |it: &Line| {
                let has_next = it.kind == LineKind::Declaration && it.cells.len() > column + 1;
                has_next.then(|| count(&it.cells[column])).filter(|it| *it <= WIDEST)
            };
            let Some(widest) = lines.iter().filter_map(own).max() else { continue };
            lines.iter_mut().filter(|it| own(it).is_some()).for_each(|it| pad(&mut it.cells[column], widest));
        }
        align_comments(&mut lines[group]);
    }
    for group in groups(lines, |it| it.kind == LineKind::Other && it.comment.is_some()) {
        align_comments(&mut lines[group]);
    }
}

/// The comments of lines that differ by so much are not below one another.
const FARTHEST: usize = 40;

fn align_comments(lines: &mut [Line]) {
    let own = |it: &Line| it.comment.is_some().then(|| it.width());
    let shortest = lines.iter().filter_map(own).min().unwrap_or(0);
    let own = |it: &Line| own(it).filter(|it| *it <= shortest + FARTHEST);
    let Some(widest) = lines.iter().filter_map(own).max() else { return };
    for line in lines.iter_mut() {
        if let Some(width) = own(line) {
            let cell = line.cells.last_mut();
            cell.into_iter().for_each(|it| it.extend(core::iter::repeat_n(' ', widest - width)));
        }
    }
}

/// The lines that follow one another at one level, without a blank one between.
fn groups(lines: &[Line], belongs: fn(&Line) -> bool) -> Vec<Range<usize>> {
    let mut groups: Vec<Range<usize>> = Vec::new();
    for (at, line) in lines.iter().enumerate().filter(|it| belongs(it.1)) {
        match groups.last_mut() {
            Some(it) if it.end == at && lines[it.start].level == line.level && !line.blank_before => it.end = at + 1,
            _ => groups.push(at..at + 1),
        }
    }
    groups
}

impl Line {
    fn width(&self) -> usize {
        self.cells.iter().map(|it| count(it) + 1).sum()
    }

    /// The text without its indentation.
    pub fn text(&self) -> String {
        let parts = self.cells.iter().map(String::as_str).chain(self.comment.as_deref());
        parts.collect::<Vec<_>>().join(" ").trim_end().to_owned()
    }
}

fn count(text: &str) -> usize {
    text.chars().count()
}

fn pad(cell: &mut String, width: usize) {
    let missing = width.saturating_sub(count(cell));
    cell.extend(core::iter::repeat_n(' ', missing));
}
