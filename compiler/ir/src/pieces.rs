//! How the value of a string is written where it belongs: piece after piece, without strings in between.
//!
//! All operations on strings write from the left to the right, and what does not fit is cut from the end. So
//! `CONCAT(CONCAT(a, b), INT_TO_STRING(n))` may be written as `a`, then `b`, then the digits of `n`, if no operand is cut
//! before it is joined, and a shorter target cuts as the operation would.

use crate::alias::{self, Alias, Frame};
use crate::{Expr, ExprKind, Place, TextOp, visit};

/// A part of a text.
#[derive(Clone, Copy, Debug)]
pub enum Piece<'e> {
    /// The characters of a string.
    Text(&'e Expr),
    /// What an operation makes.
    Made(TextOp, &'e [Expr]),
}

/// What a text is written after.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Start {
    /// Nothing.
    Anew,
    /// What the target holds.
    AtEnd,
}

impl<'e> Piece<'e> {
    /// The expressions that are evaluated for it.
    pub fn operands(self) -> &'e [Expr] {
        match self {
            Self::Text(expr) => core::slice::from_ref(expr),
            Self::Made(_, operands) => operands,
        }
    }
}

/// The pieces that `value`, of a string's type, is made of.
pub fn pieces(value: &Expr) -> Vec<Piece<'_>> {
    let mut found = Vec::new();
    collect(value, capacity(value), &mut found);
    found
}

/// How `value` is written into `target` itself: where no piece reads what is being written. `None` where that cannot be
/// said, or where the value is no more than another string or a constant.
pub fn in_place<'e>(frame: &Frame<'_>, target: &Place, value: &'e Expr) -> Option<(Start, Vec<Piece<'e>>)> {
    if target.is_followed() {
        return None;
    }
    let mut pieces = pieces(value);
    let start = match pieces.first()? {
        Piece::Text(Expr { kind: ExprKind::Load(place), .. }) if pieces.len() > 1 && is_same(frame, place, target) => {
            pieces.remove(0);
            Start::AtEnd
        }
        _ => Start::Anew,
    };
    let is_apart = pieces.iter().flat_map(|it| it.operands()).all(|it| is_apart(frame, it, target));
    is_apart.then_some((start, pieces))
}

/// Whether both are one place, whatever is in indices: there are none but constants.
fn is_same(frame: &Frame<'_>, a: &Place, b: &Place) -> bool {
    let is_fixed = |it: &Place| it.indices().all(|index| index.as_const().is_some());
    let same = !a.is_followed() && is_fixed(a) && is_fixed(b) && a.root == b.root;
    same && a.projections.len() == b.projections.len() && alias::alias(frame, a, b) == Alias::Must
}

fn is_apart(frame: &Frame<'_>, operand: &Expr, target: &Place) -> bool {
    let mut apart = true;
    visit::reads(operand, &mut |it| {
        let by_name = it.root != target.root || !alias::borrows_meet(&it.projections, &target.projections);
        apart &= by_name && !it.is_followed() && alias::alias(frame, it, target) == Alias::No;
    });
    apart
}

/// Adds the pieces of an expression, of which more than `room` characters are cut in any case.
fn collect<'e>(expr: &'e Expr, room: usize, into: &mut Vec<Piece<'e>>) {
    let is_whole = capacity(expr) >= room || longest(expr) <= capacity(expr);
    // What asks for the room that there is has its own, at the start of a target of its type.
    let fills = into.is_empty() && capacity(expr) == room;
    match &expr.kind {
        ExprKind::ApplyText(TextOp::Concat, operands) if is_whole => {
            for (at, operand) in operands.iter().enumerate() {
                collect(operand, if at == 0 { room } else { usize::MAX }, into);
            }
        }
        ExprKind::ApplyText(op, operands) if is_whole && (op.writes_in_order() || fills) => {
            into.push(Piece::Made(*op, operands));
        }
        ExprKind::Convert(_, inner) if is_whole => collect(inner, room, into),
        ExprKind::Text(_)
        | ExprKind::Load(_)
        | ExprKind::ApplyText(..)
        | ExprKind::Convert(..)
        | ExprKind::Const(_)
        | ExprKind::Aggregate(_)
        | ExprKind::AddressOf(_)
        | ExprKind::Apply(..) => into.push(Piece::Text(expr)),
    }
}

/// The most characters that the value has.
pub fn most(expr: &Expr) -> usize {
    longest(expr).min(capacity(expr))
}

/// The most characters that the value would have, if its own type cut nothing.
fn longest(expr: &Expr) -> usize {
    match &expr.kind {
        ExprKind::Text(text) => text.len(),
        ExprKind::Convert(_, inner) => most(inner),
        ExprKind::ApplyText(op, operands) => longest_of(*op, operands),
        ExprKind::Load(_)
        | ExprKind::Const(_)
        | ExprKind::Aggregate(_)
        | ExprKind::AddressOf(_)
        | ExprKind::Apply(..) => capacity(expr),
    }
}

fn longest_of(op: TextOp, operands: &[Expr]) -> usize {
    let of = |at: usize| operands.get(at).map_or(0, most);
    match op {
        TextOp::Concat | TextOp::Insert | TextOp::Replace => of(0) + of(1),
        TextOp::Left | TextOp::Right | TextOp::Mid => of(0).min(count(operands)),
        TextOp::Delete => of(0),
        _ => op.longest().map_or(usize::MAX, usize::from),
    }
}

/// The count of characters that is the second operand, if it is a constant.
fn count(operands: &[Expr]) -> usize {
    let known = operands.get(1).and_then(Expr::as_const).and_then(|it| it.as_integer());
    known.map_or(usize::MAX, |it| usize::try_from(it.max(0)).unwrap_or(usize::MAX))
}

/// How many characters the expression's own type holds.
fn capacity(expr: &Expr) -> usize {
    expr.ty.string_type().map_or(0, |it| usize::from(it.capacity))
}
