//! Where lines end. What the text has on lines of its own stays there; a block that is not all on one line has each
//! statement and each of its words on one.

use super::blocks::Block;
use super::indent::{Indenter, Layout};
use super::roles::Role;
use super::spacing;
use crate::lex::Kind;

/// The line breaks before each token: two where a line is left blank.
pub fn breaks(layout: Layout<'_, '_>) -> Vec<u8> {
    let tokens = layout.tokens;
    let mut breaks = Vec::with_capacity(tokens.len());
    let mut indenter = Indenter::new(layout);
    let (mut column, mut flat_until) = (0, 0);
    for at in 0..tokens.len() {
        let token = &tokens[at];
        let own = if at == 0 { 0 } else { u8::try_from(token.breaks.min(2)).unwrap_or(2) };
        let is_free = at > 0 && own == 0 && at >= flat_until && !token.is_kept && !tokens[at - 1].is_kept;
        let found = if is_free && is_forced(layout, &indenter, at) { 1 } else { own };
        breaks.push(found);
        if found > 0 || at == 0 {
            column = indenter.start_line(at) * layout.style.indent.width();
        } else {
            column += gap(layout, at);
        }
        if at >= flat_until
            && let Some(pair) = layout.blocks.opened(at)
            && is_flat(layout, at, pair.close, column)
        {
            flat_until = pair.close + 1;
        }
        column += width(layout, at);
        indenter.pass(at);
    }
    breaks
}

/// Whether a new line starts here, in a block of several lines.
fn is_forced(layout: Layout<'_, '_>, indenter: &Indenter<'_, '_>, at: usize) -> bool {
    let token = &layout.tokens[at];
    let Some(before) = indenter.before() else { return false };
    if token.is_aside() || token.kind == Kind::Semicolon {
        return false;
    }
    let opens = layout.blocks.opened(at);
    let begins_part = opens.is_some_and(|it| match it.block {
        Block::Pou | Block::Type => true,
        Block::Declarations => !matches!(token.kind, Kind::Struct | Kind::Name),
        Block::Case | Block::Statements => false,
    });
    if layout.blocks.closed(at).is_some() || begins_part {
        return true;
    }
    let is_name_of_type = layout.blocks.opened(before).is_some_and(|it| it.block == Block::Type);
    let is_labelled = layout.roles[before] == Role::LabelEnd && opens.is_none() && is_alone(layout, at);
    indenter.starts && !is_name_of_type && !is_labelled && !indenter.is_qualifier(at)
}

/// Whether the statement that starts here is all that its label has.
fn is_alone(layout: Layout<'_, '_>, at: usize) -> bool {
    let rest = layout.tokens[at..]
        .iter()
        .position(|it| it.kind == Kind::Semicolon)
        .map_or(layout.tokens.len(), |it| at + it + 1);
    let next = (rest..layout.tokens.len()).find(|it| !layout.tokens[*it].is_aside());
    next.is_none_or(|it| {
        layout.roles[it] == Role::Label || layout.tokens[it].kind == Kind::Else || layout.blocks.closed(it).is_some()
    })
}

/// Whether a block stays on its line.
fn is_flat(layout: Layout<'_, '_>, open: usize, close: usize, column: usize) -> bool {
    // `TYPE Point : STRUCT` is on one line as a whole, or not at all.
    let is_named_type = |it: usize| layout.blocks.opened(it).is_some_and(|it| it.block == Block::Type);
    let line = (0..open).rev().take_while(|it| layout.tokens[it + 1].breaks == 0);
    if layout.tokens[open].kind == Kind::Struct && line.take(8).any(is_named_type) {
        return false;
    }
    let inner = &layout.tokens[open + 1..=close];
    if inner.iter().any(|it| it.breaks > 0 || it.is_kept) {
        return false;
    }
    let mut end = column + width(layout, open);
    for at in open + 1..=close {
        end += gap(layout, at) + width(layout, at);
        if end >= layout.style.width {
            return false;
        }
    }
    true
}

/// The space before a token in its line.
pub fn gap(layout: Layout<'_, '_>, at: usize) -> usize {
    let placed = |it: usize| (&layout.tokens[it], layout.roles[it]);
    usize::from(at > 0 && spacing::is_apart(placed(at - 1), placed(at)))
}

pub fn width(layout: Layout<'_, '_>, at: usize) -> usize {
    let text = layout.tokens[at].text;
    let last = text.rsplit('\n').next().unwrap_or_default();
    if last.is_ascii() { last.len() } else { last.chars().count() }
}
