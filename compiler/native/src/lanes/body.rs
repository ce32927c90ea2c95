//! What the body of a loop reads and writes, and whether its turns can be in lanes.

use crate::unrolled::values;
use staunch_ir::alias::{Alias, Frame, alias};
use staunch_ir::loops::{Known, running};
use staunch_ir::{
    Conversion, Expr, ExprKind, For, Op, Place, Projection, Repr, Routine, Statement, StatementKind, Taking, Type,
};

/// Turns of a loop within, all of which are in line; and operations in all.
const MOST_TURNS: usize = 32;
const MOST: usize = 128;
/// Vectors one after the other, and their operations.
const MOST_VECTORS: usize = 4;
const MOST_OF_GROUP: usize = 64;

pub(super) struct Body<'p> {
    /// Scalar variables that each turn assigns before it reads them.
    pub(super) variables: Vec<&'p Place>,
    /// Elements, at the counter.
    stored: Vec<&'p Place>,
    read: Vec<&'p Place>,
    /// Of all numbers.
    pub(super) repr: Option<Repr>,
    operations: usize,
}

impl<'p> Body<'p> {
    /// Of a loop; `None` where its turns cannot be in lanes, whatever is the same storage.
    pub(super) fn of(it: &'p For, around: &[&'p For], routine: &'p Routine, known: Known<'_>) -> Option<Self> {
        let body = Self { variables: Vec::new(), stored: Vec::new(), read: Vec::new(), repr: None, operations: 0 };
        let mut look = Look { of: it, routine, loops: around.to_vec(), within: Vec::new(), known, body, repeated: 1 };
        look.statements(&it.body)?;
        let is_worth_it = !look.body.stored.is_empty() && look.body.operations <= MOST;
        is_worth_it.then_some(look.body)
    }

    /// How many vectors of turns are one after the other, of so many.
    pub(super) fn vectors(&self, count: usize) -> usize {
        let fits = |it: &usize| count.is_multiple_of(*it) && it * self.operations <= MOST_OF_GROUP;
        (2..=MOST_VECTORS).rev().find(fits).unwrap_or(1)
    }

    /// Whether what one turn writes is no other's.
    pub(super) fn is_separate(&self, frame: &Frame<'_>) -> bool {
        let written: Vec<&Place> = self.stored.iter().chain(&self.variables).copied().collect();
        // The same element is of one turn alone: its index follows the counter.
        let is_apart = |a: &Place, b: &Place| matches!(alias(frame, a, b), Alias::No) || is_same_element(a, b);
        let all = written.iter().enumerate();
        let mut pairs = all.flat_map(|(at, a)| written[at + 1..].iter().chain(&self.read).map(move |b| (*a, *b)));
        pairs.all(|(a, b)| is_apart(a, b))
    }
}

/// Whether two places have the same form, and are elements at the counter: one of the two is stored to.
fn is_same_element(a: &Place, b: &Place) -> bool {
    let same = |(a, b): (&Projection, &Projection)| match (a, b) {
        (Projection::Field(a), Projection::Field(b)) => a == b,
        (Projection::Index { index: a, .. }, Projection::Index { index: b, .. }) => is_same_index(a, b),
        (Projection::Field(_) | Projection::Index { .. } | Projection::Deref { .. }, _) => false,
    };
    let has_index = a.indices().next().is_some();
    has_index && a.root == b.root && a.projections.len() == b.projections.len() && {
        a.projections.iter().zip(&b.projections).all(same)
    }
}

/// Whether two sums of counters and constants are.
fn is_same_index(a: &Expr, b: &Expr) -> bool {
    match (&a.kind, &b.kind) {
        (ExprKind::Const(a), ExprKind::Const(b)) => a == b,
        (ExprKind::Load(a), ExprKind::Load(b)) => a.is_same_variable(b),
        (ExprKind::Convert(how, a), ExprKind::Convert(other, b)) => how == other && is_same_index(a, b),
        (ExprKind::Apply(op, a), ExprKind::Apply(other, b)) => {
            op == other && a.len() == b.len() && a.iter().zip(b).all(|(a, b)| is_same_index(a, b))
        }
        _ => false,
    }
}

/// Whether the last index of an element names a counter.
pub(super) fn follows(place: &Place, counter: &Place) -> bool {
    let Some(Projection::Index { index, .. }) = place.projections.last() else { return false };
    names(index, counter)
}

fn names(index: &Expr, counter: &Place) -> bool {
    match &index.kind {
        ExprKind::Load(place) => place.is_same_variable(counter),
        ExprKind::Apply(_, operands) => operands.iter().any(|it| names(it, counter)),
        ExprKind::Convert(_, operand) => names(operand, counter),
        ExprKind::Const(_)
        | ExprKind::Text(_)
        | ExprKind::AddressOf(_)
        | ExprKind::ApplyText(..)
        | ExprKind::Aggregate(_) => false,
    }
}

/// What a place is in the next turn.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Way {
    Stays,
    /// The next element.
    Further,
}

struct Look<'p, 'k> {
    of: &'p For,
    routine: &'p Routine,
    /// Those around, and those within around a statement.
    loops: Vec<&'p For>,
    /// Those within alone.
    within: Vec<&'p For>,
    known: Known<'k>,
    body: Body<'p>,
    /// The turns of the loop within, around a statement.
    repeated: usize,
}

fn only_if(it: bool) -> Option<()> {
    it.then_some(())
}

impl<'p> Look<'p, '_> {
    fn statements(&mut self, body: &'p [Statement]) -> Option<()> {
        for statement in body {
            if let StatementKind::For(inner) = &statement.kind {
                self.turns(inner)?;
                continue;
            }
            let StatementKind::Assign { target, value } = &statement.kind else { return None };
            self.value(value)?;
            self.target(target)?;
        }
        Some(())
    }

    fn turns(&mut self, inner: &'p For) -> Option<()> {
        let (_, _, count) = values(inner)?;
        let is_plain = inner.is_private && matches!(inner.taking, Taking::Each) && !inner.may_leave_range();
        only_if(is_plain && count <= MOST_TURNS && self.repeated == 1)?;
        self.repeated = count;
        self.loops.push(inner);
        self.within.push(inner);
        self.statements(&inner.body)?;
        self.within.pop();
        self.loops.pop();
        self.repeated = 1;
        Some(())
    }

    fn target(&mut self, target: &'p Place) -> Option<()> {
        self.number(target.ty)?;
        self.body.operations += self.repeated;
        if target.indices().next().is_some() {
            // With a counter of a loop within, it would be the element of another turn's, too: `a[i + j]`.
            let is_of_turn = !self.within.iter().any(|it| follows(target, &it.counter));
            only_if(is_of_turn && self.place(target)? == Way::Further)?;
            self.body.stored.push(target);
            return Some(());
        }
        // One that was read before it is assigned has the value of the turn before.
        let is_same = |it: &&Place| it.is_same_variable(target);
        only_if(!target.is_followed() && !self.body.read.iter().any(is_same))?;
        if !self.body.variables.iter().any(is_same) {
            self.body.variables.push(target);
        }
        Some(())
    }

    fn value(&mut self, expr: &'p Expr) -> Option<()> {
        self.number(expr.ty)?;
        self.body.operations += self.repeated;
        match &expr.kind {
            ExprKind::Const(_) => Some(()),
            ExprKind::Load(place) => {
                self.place(place)?;
                if !self.body.variables.iter().any(|it| it.is_same_variable(place)) {
                    self.body.read.push(place);
                }
                Some(())
            }
            ExprKind::Apply(Op::Add | Op::Sub | Op::Mul | Op::Div, operands) if operands.len() == 2 => {
                operands.iter().try_for_each(|it| self.value(it))
            }
            ExprKind::Convert(..)
            | ExprKind::Apply(..)
            | ExprKind::Text(_)
            | ExprKind::AddressOf(_)
            | ExprKind::ApplyText(..)
            | ExprKind::Aggregate(_) => None,
        }
    }

    /// All numbers are reals of one type.
    fn number(&mut self, ty: Type) -> Option<()> {
        let repr = self.known.program.repr(ty).filter(|it| it.is_float())?;
        let is_same = self.body.repr.is_none_or(|it| it == repr);
        self.body.repr = Some(repr);
        only_if(is_same)
    }

    /// Whether an index is one further in each turn, or the same.
    fn steps(&self, index: &Expr, known: &Known<'_>) -> Option<bool> {
        match &index.kind {
            ExprKind::Const(_) => Some(false),
            ExprKind::Load(place) if place.is_same_variable(&self.of.counter) => Some(true),
            ExprKind::Load(place) => running(&self.loops, place).map(|_| false),
            ExprKind::Convert(Conversion::Value | Conversion::Same, operand) => {
                let whole = known.program.repr(index.ty)?.range()?;
                let range = known.range(operand)?;
                only_if(whole.0 <= range.0 && range.1 <= whole.1)?;
                self.steps(operand, known)
            }
            ExprKind::Apply(op @ (Op::Add | Op::Sub), operands) if known.is_exact(index) => {
                let [a, b] = [&operands[0], &operands[1]].map(|it| self.steps(it, known));
                match (op, a?, b?) {
                    (_, a, false) => Some(a),
                    (Op::Add, false, true) => Some(true),
                    _ => None,
                }
            }
            ExprKind::Convert(..)
            | ExprKind::Apply(..)
            | ExprKind::Text(_)
            | ExprKind::AddressOf(_)
            | ExprKind::ApplyText(..)
            | ExprKind::Aggregate(_) => None,
        }
    }

    /// How a place moves from turn to turn, if nothing about it can fault.
    fn place(&self, place: &Place) -> Option<Way> {
        only_if(!place.is_followed())?;
        let mut ty = self.known.program.root_type(self.routine, place.root);
        let mut way = Way::Stays;
        for projection in &place.projections {
            only_if(way == Way::Stays)?;
            if let (Projection::Index { index, .. }, Some(Type::Array(id))) = (projection, ty) {
                let known = Known { loops: &self.loops, ..self.known };
                only_if(known.is_within(index, id))?;
                way = if self.steps(index, &known)? { Way::Further } else { Way::Stays };
            }
            ty = ty.and_then(|it| self.known.program.part(it, projection));
        }
        Some(way)
    }
}
