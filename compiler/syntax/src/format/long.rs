//! Lines that are too long: broken at commas, at AND and OR, at operators, or in the widest brackets.

use super::indent::{Indenter, Layout};
use super::lines::{gap, width};
use super::roles::Role;
use super::token::Token;
use crate::lex::Kind;
use core::ops::Range;

/// Adds line breaks where lines are longer than the style has it, and where they can be broken.
pub fn shorten(layout: Layout<'_, '_>, breaks: &mut [u8]) {
    let count = layout.tokens.len();
    let mut indenter = Indenter::new(layout);
    let mut start = 0;
    while start < count {
        let level = indenter.start_line(start);
        let mut line = start..end_of_line(breaks, start);
        let indent = level * layout.style.indent.width();
        // Deeper brackets have no room on any line.
        while indent < layout.style.width && indent + length(layout, line.clone()) > layout.style.width {
            let places = places(layout, line.clone(), indenter.is_in_brackets(), indent);
            if places.is_empty() {
                break;
            }
            places.into_iter().for_each(|it| breaks[it] = 1);
            line.end = end_of_line(breaks, start);
        }
        line.clone().for_each(|it| indenter.pass(it));
        start = line.end;
    }
}

fn end_of_line(breaks: &[u8], start: usize) -> usize {
    breaks[start + 1..].iter().position(|it| *it > 0).map_or(breaks.len(), |it| start + 1 + it)
}

/// How long a line is without the comment at its end.
fn length(layout: Layout<'_, '_>, line: Range<usize>) -> usize {
    let has_kept = layout.tokens[line.clone()].iter().any(|it| it.is_kept || it.text.contains('\n'));
    let end = without_comments(layout, &line);
    if has_kept {
        return 0;
    }
    (line.start..end).map(|it| width(layout, it) + if it > line.start { gap(layout, it) } else { 0 }).sum()
}

fn without_comments(layout: Layout<'_, '_>, line: &Range<usize>) -> usize {
    let asides = layout.tokens[line.clone()].iter().rev().take_while(|it| it.is_aside()).count();
    line.end - asides
}

/// A bracket of a line, with the commas directly in it.
struct Bracket {
    open: usize,
    /// Where it closes, if that is in the line.
    close: Option<usize>,
    commas: Vec<usize>,
}

/// What of a line is in no bracket of it.
#[derive(Default)]
struct Outer {
    commas: Vec<usize>,
    junctions: Vec<usize>,
    operators: Vec<usize>,
    assignments: Vec<usize>,
    brackets: Vec<Bracket>,
}

fn outer(layout: Layout<'_, '_>, line: Range<usize>) -> Outer {
    let mut found = Outer::default();
    let mut depth = 0_usize;
    for at in line.clone() {
        let kind = layout.tokens[at].kind;
        match kind {
            Kind::OpenParen | Kind::OpenBracket => {
                if depth == 0 && !is_index(layout, at) {
                    found.brackets.push(Bracket { open: at, close: None, commas: Vec::new() });
                }
                depth += 1;
            }
            Kind::CloseParen | Kind::CloseBracket => {
                if depth == 1
                    && let Some(it) = found.brackets.last_mut().filter(|it| it.close.is_none())
                {
                    it.close = Some(at);
                }
                depth = depth.saturating_sub(1);
            }
            Kind::Comma if depth == 0 => found.commas.push(at),
            Kind::Comma if depth == 1 => {
                let open = found.brackets.last_mut().filter(|it| it.close.is_none());
                open.into_iter().for_each(|it| it.commas.push(at));
            }
            _ if depth > 0 || at == line.start || matches!(layout.roles[at], Role::Unary | Role::Function) => {}
            Kind::And | Kind::Or | Kind::Xor | Kind::AndThen | Kind::OrElse | Kind::Ampersand => {
                found.junctions.push(at);
            }
            Kind::Assign => found.assignments.push(at),
            Kind::Plus | Kind::Minus | Kind::Star | Kind::Slash | Kind::Mod => found.operators.push(at),
            _ => {}
        }
    }
    found
}

/// Whether a bracket is an index or a dimension, which stays with its array.
fn is_index(layout: Layout<'_, '_>, at: usize) -> bool {
    let is_value = |it: &Token<'_>| matches!(it.kind, Kind::Assign | Kind::Comma | Kind::OpenParen | Kind::OpenBracket);
    layout.tokens[at].kind == Kind::OpenBracket && !at.checked_sub(1).is_some_and(|it| is_value(&layout.tokens[it]))
}

/// So wide is what is worth lines of its own in brackets.
const WORTH: usize = 20;

/// The tokens before which a line is broken.
fn places(layout: Layout<'_, '_>, line: Range<usize>, is_in_brackets: bool, indent: usize) -> Vec<usize> {
    let line = line.start..without_comments(layout, &line);
    let outer = outer(layout, line.clone());
    let after =
        |commas: &[usize]| -> Vec<usize> { commas.iter().map(|it| it + 1).filter(|it| *it < line.end).collect() };
    let at_commas = if is_in_brackets { after(&outer.commas) } else { Vec::new() };
    if !at_commas.is_empty() {
        return at_commas;
    }
    if !outer.junctions.is_empty() {
        return outer.junctions;
    }
    let inner = |it: &Bracket| it.open + 1..it.close.unwrap_or(line.end);
    let widest = outer.brackets.iter().max_by_key(|it| length(layout, inner(it)));
    let inside = widest.map_or(0, |it| length(layout, inner(it)));
    let is_small = inside * 2 < length(layout, line.clone());
    let Some(widest) = widest.filter(|_| inside >= WORTH && (outer.operators.is_empty() || !is_small)) else {
        return match outer.operators.is_empty() {
            true => after(&outer.assignments),
            false => outer.operators,
        };
    };
    let mut places = vec![widest.open + 1];
    match is_of_atoms(layout, inner(widest)) {
        true => places.extend(filled(layout, widest, line.end, indent + layout.style.indent.width())),
        false => places.extend(after(&widest.commas)),
    }
    places.extend(widest.close);
    places
}

/// Whether brackets list nothing but numbers and the like: many go in a line.
fn is_of_atoms(layout: Layout<'_, '_>, inner: Range<usize>) -> bool {
    layout.tokens[inner].iter().all(|it| {
        matches!(
            it.kind,
            Kind::Integer
                | Kind::Based
                | Kind::Real
                | Kind::Time
                | Kind::Date
                | Kind::Text
                | Kind::WideText
                | Kind::True
                | Kind::False
                | Kind::Minus
                | Kind::Prefix
                | Kind::Comma
                | Kind::OpenParen
                | Kind::CloseParen
        )
    })
}

/// The breaks in a list whose lines are as long as can be.
fn filled(layout: Layout<'_, '_>, bracket: &Bracket, end: usize, indent: usize) -> Vec<usize> {
    let end = bracket.close.unwrap_or(end);
    let mut places = Vec::new();
    let (mut start, mut column) = (bracket.open + 1, indent);
    for next in bracket.commas.iter().map(|it| it + 1).chain([end]) {
        let item = length(layout, start..next);
        if column > indent && column + 1 + item > layout.style.width {
            places.push(start);
            column = indent;
        }
        column += item + usize::from(column > indent);
        start = next;
    }
    places
}
