//! What a pointer leads to that walks over an array is the element itself.
//!
//! ```text
//! p := ADR(table[0]);                p := ADR(table[0]);
//! FOR i := 0 TO 99 DO                FOR i := 0 TO 99 DO
//!     p^ := p^ + 1;                      table[i] := table[i] + 1;
//!     p := p + SIZEOF(DINT);         END_FOR
//! END_FOR                            p := p + 100 * SIZEOF(DINT);
//! ```
//!
//! It applies to a FOR from a constant to a constant, whose counter nothing else writes, that moves the pointer once in each turn
//! by a constant: a multiple of what goes from element to element. The pointer has been given the address of an element, or of the array,
//! before, and no reference leads to it. All elements that the loop may look at are within the array. So no such access can fault,
//! which is no less than the object that references name: that is a whole variable. The pointer is moved after the loop if
//! nothing in it looks at the pointer and nothing can leave it, by a fault or otherwise. Three kinds stay as they are: a loop with a
//! CONTINUE, after which the pointer may lag the counter; one that takes the address of what the pointer leads to, which does not fault
//! beyond the array either; and all loops in a program with pools, since what is in one may be deleted.

use crate::alias::{Frame, changes};
use crate::effects::{Effects, Rules, statement_faults};
use crate::loops::{checked_locals, constant_position};
use crate::visit::{self, Rewrite};
use crate::{
    Block, Conversion, Elementary, Expr, ExprKind, For, Location, Op, Place, Program, Projection, Root, Routine,
    Statement, StatementKind, Step, Type, Value, layout::Layout,
};
use std::slice::from_ref;

/// So many statements after the pointer got its value a loop is looked for.
const FAR: usize = 16;

/// In a routine's statements; `known` is what each routine does, by these rules.
pub(super) fn walked(program: &Program, (rules, known): (&Rules, &[Effects]), routine: &Routine, body: &mut Block) {
    if !program.references.is_empty() && program.reached.is_some() && program.places.is_empty() {
        Walker { program, rules, known, routine, layout: None }.block(body);
    }
}

struct Walker<'p> {
    program: &'p Program,
    rules: &'p Rules,
    known: &'p [Effects],
    /// Without its body.
    routine: &'p Routine,
    /// When it is needed.
    layout: Option<Layout>,
}

/// A pointer, and the element that it has been given the address of.
struct Start {
    pointer: Place,
    array: Place,
    id: crate::ArrayId,
    /// Its position in the array, from 0.
    position: i128,
}

/// What a loop does with it.
struct Walk {
    /// Which of the loop's statements moves it.
    moved: usize,
    /// By so many elements.
    by: i128,
    turns: i128,
}

impl Walker<'_> {
    fn block(&mut self, block: &mut Block) {
        let mut at = 0;
        while at < block.len() {
            if let Some(behind) = self.replace(block, at) {
                block.splice(behind.0..behind.0, [behind.1]);
            }
            block[at].kind.blocks_mut().into_iter().for_each(|it| self.block(it));
            at += 1;
        }
    }

    /// Replaces what a loop follows of the pointer that this statement gives a value; what is to follow the loop, and where.
    fn replace(&mut self, block: &mut Block, at: usize) -> Option<(usize, Statement)> {
        let start = self.start(&block[at])?;
        let frame = Frame::of(self.program, self.routine);
        let value = Expr::load(start.pointer.clone(), Location::default());
        let mut next = (at + 1..block.len()).take(FAR);
        let behind = next.find(|it| changes(&frame, from_ref(&block[*it]), &value))?;
        let StatementKind::For(it) = &block[behind].kind else { return None };
        let walk = self.walk(it, &start)?;
        let mut rewritten = (**it).clone();
        let (before, after) = rewritten.body.split_at_mut(walk.moved);
        for (part, ahead) in [(before, 0), (&mut after[1..], walk.by)] {
            let target = self.element(it, &start, &walk, ahead)?;
            visit::rewrite(part, &mut Renamer { pointer: &start.pointer, target });
        }
        let moved = rewritten.body[walk.moved].clone();
        let at = block[behind].at;
        let mut without = rewritten.clone();
        without.body.remove(walk.moved);
        let without = Statement::new(StatementKind::For(Box::new(without)), at);
        if self.can_move_behind(&without, &start.pointer) {
            block[behind] = without;
            return Some((behind + 1, times(moved, walk.turns)?));
        }
        block[behind].kind = StatementKind::For(Box::new(rewritten));
        None
    }

    /// `pointer := ADR(array[constant])`, or `ADR(array)` for a pointer to its elements' type.
    fn start(&self, statement: &Statement) -> Option<Start> {
        let StatementKind::Assign { target: pointer, value } = &statement.kind else { return None };
        let variable = address(value)?;
        let frame = Frame::of(self.program, self.routine);
        let is_named = pointer.projections.iter().all(|it| matches!(it, Projection::Field(_)));
        let is_own = match pointer.root {
            Root::Local(_) => pointer.projections.is_empty(),
            Root::Instance | Root::Globals => !frame.is_reached(pointer),
            Root::Param(_) => false,
        };
        let is_fixed = matches!(variable.root, Root::Instance | Root::Globals) && !variable.is_followed();
        if !is_named || !is_own || !is_fixed {
            return None;
        }
        if let Type::Array(id) = variable.ty {
            let is_constant = self.has_constant_indices(variable);
            return is_constant.then(|| Start { pointer: pointer.clone(), array: variable.clone(), id, position: 0 });
        }
        let (last, before) = variable.projections.split_last()?;
        let Projection::Index { index, .. } = last else { return None };
        let mut array = Place::root(variable.root, self.program.root_type(self.routine, variable.root)?);
        for projection in before {
            array.ty = self.program.part(array.ty, projection)?;
            array.projections.push(projection.clone());
        }
        let Type::Array(id) = array.ty else { return None };
        let position = i128::from(constant_position(self.program, index, id)?);
        self.has_constant_indices(&array).then(|| Start { pointer: pointer.clone(), array, id, position })
    }

    fn has_constant_indices(&self, place: &Place) -> bool {
        place.indices().all(|it| it.as_const().is_some())
    }

    /// What the loop does with the pointer, if each element that it may look at is one of the array's.
    fn walk(&mut self, it: &For, start: &Start) -> Option<Walk> {
        let number = |it: &Expr| it.as_const().and_then(Value::as_integer);
        let Step::Constant(step) = it.step else { return None };
        let (first, last) = (number(&it.first)?, number(&it.last)?);
        let further = (last - first) / step;
        let is_counted = (last - first) * step.signum() >= 0 && matches!(it.counter.ty, Type::Elementary(_));
        let stays = has_continue(&it.body) || takes_address(&it.body, &start.pointer);
        if !it.is_private || !is_counted || it.may_leave_range() || stays {
            return None;
        }
        let array = self.program.array(start.id);
        let is_simple = matches!(array.element, Type::Elementary(_) | Type::Struct(_));
        let has_states = self.program.instance_in(array.element, &|id| self.program.class_of_state(id).is_some());
        if !is_simple || has_states.is_some() {
            return None;
        }
        let (moved, bytes) = self.moved(&it.body, &start.pointer)?;
        let layout = self.layout.get_or_insert_with(|| Layout::new(self.program));
        let stride = i128::from(layout.stride(start.id));
        if stride == 0 || bytes % stride != 0 || bytes / stride % step != 0 {
            return None;
        }
        let by = bytes / stride;
        // Of the last turn, after the pointer has been moved there: no more than where it is looked at.
        let follows = |part: &[Statement]| part.iter().any(|it| follows(it, &start.pointer, array.element));
        let turns = further + 1 - i128::from(!follows(&it.body[moved + 1..]));
        let from = if follows(&it.body[..moved]) { 0 } else { by };
        let ends = [start.position + from, start.position + by * turns];
        let is_within = ends.iter().all(|it| (0..i128::from(array.len())).contains(it));
        is_within.then_some(Walk { moved, by, turns: further + 1 })
    }

    /// The only statement that changes the pointer, by how many bytes.
    fn moved(&self, body: &[Statement], pointer: &Place) -> Option<(usize, i128)> {
        let frame = Frame::of(self.program, self.routine);
        let value = Expr::load(pointer.clone(), Location::default());
        let mut changing = body.iter().enumerate().filter(|(_, it)| changes(&frame, from_ref(it), &value));
        let (at, only) = changing.next()?;
        let bytes = distance(only, pointer)?;
        changing.next().is_none().then_some((at, bytes))
    }

    /// The element in the turn of the loop's counter, and so many further.
    fn element(&self, it: &For, start: &Start, walk: &Walk, ahead: i128) -> Option<Place> {
        let (Step::Constant(step), at) = (&it.step, it.step_at) else { return None };
        let array = self.program.array(start.id);
        let lint = |value: i128| Some(Expr::constant(Elementary::Lint, Value::I64(i64::try_from(value).ok()?), at));
        let times = walk.by / step;
        let first = it.first.as_const().and_then(Value::as_integer)?;
        let from = i128::from(array.low) + start.position + ahead - first.checked_mul(times)?;
        let mut index = Expr::convert(Conversion::Value, Type::LINT, Expr::load(it.counter.clone(), at), at);
        if times != 1 {
            index = Expr::apply(Op::Mul, Type::LINT, vec![index, lint(times)?], at);
        }
        if from != 0 {
            index = Expr::apply(Op::Add, Type::LINT, vec![index, lint(from)?], at);
        }
        Some(start.array.clone().index(index, array.element, at))
    }

    /// Whether nobody sees the pointer before the loop has had all of its turns.
    fn can_move_behind(&self, statement: &Statement, pointer: &Place) -> bool {
        let mut can = true;
        visit::statements(from_ref(statement), &mut |it| {
            can &= is_plain(&it.kind);
            visit::accesses(it, &mut |place, _| can &= !touches(place, pointer));
        });
        let checked = checked_locals(self.routine);
        can && !statement_faults(self.program, self.rules, self.known, self.routine, (Vec::new(), checked), statement)
    }
}

/// The variable whose address it is.
fn address(value: &Expr) -> Option<&Place> {
    match &value.kind {
        ExprKind::AddressOf(variable) => Some(variable),
        ExprKind::Convert(Conversion::Same, operand) => address(operand),
        _ => None,
    }
}

/// `pointer := pointer + constant`, in bytes.
fn distance(statement: &Statement, pointer: &Place) -> Option<i128> {
    let StatementKind::Assign { target, value } = &statement.kind else { return None };
    let ExprKind::Convert(Conversion::Same, sum) = &value.kind else { return None };
    let ExprKind::Apply(Op::Advance, operands) = &sum.kind else { return None };
    let [from, by] = operands.as_slice() else { return None };
    let ExprKind::Convert(Conversion::Same, from) = &from.kind else { return None };
    let goes_on = matches!(&from.kind, ExprKind::Load(it) if it.is_same_variable(pointer));
    let by = by.as_const().and_then(Value::as_integer)?;
    (goes_on && target.is_same_variable(pointer)).then_some(by)
}

/// The statement that moves a pointer, so many times at once.
fn times(mut statement: Statement, count: i128) -> Option<Statement> {
    let StatementKind::Assign { value, .. } = &mut statement.kind else { return None };
    let ExprKind::Convert(_, sum) = &mut value.kind else { return None };
    let ExprKind::Apply(_, operands) = &mut sum.kind else { return None };
    let by = operands[1].as_const().and_then(Value::as_integer)?;
    let all = i64::try_from(by.checked_mul(count)?).ok()?;
    operands[1] = Expr::constant(Elementary::Lint, Value::I64(all), operands[1].at);
    Some(statement)
}

fn has_continue(body: &[Statement]) -> bool {
    let mut found = false;
    visit::statements(body, &mut |it| found |= matches!(it.kind, StatementKind::Continue));
    found
}

/// Whether the address of what the pointer leads to is taken, which does not fault past the end of the array either.
fn takes_address(body: &[Statement], pointer: &Place) -> bool {
    let mut found = false;
    visit::statements(body, &mut |it| {
        visit::all_exprs(it, &mut |expr| {
            if let ExprKind::AddressOf(place) = &expr.kind {
                found |= place.is_followed() && touches(place, pointer);
            }
        });
    });
    found
}

/// Whether a statement, or one in it, follows the pointer to what has this type.
fn follows(statement: &Statement, pointer: &Place, ty: Type) -> bool {
    let mut found = false;
    visit::statements(from_ref(statement), &mut |it| {
        visit::accesses(it, &mut |place, _| found |= way(place, pointer, ty).is_some());
    });
    found
}

/// Where the way of a place has followed the pointer.
fn way(place: &Place, pointer: &Place, ty: Type) -> Option<usize> {
    let at = place.projections.iter().position(|it| matches!(it, Projection::Deref { .. }))?;
    let leads = matches!(&place.projections[at], Projection::Deref { target, .. } if *target == ty);
    (leads && place.before(at, pointer.ty).is_same_variable(pointer)).then_some(at)
}

/// Whether a place is the pointer, or leads through it.
fn touches(place: &Place, pointer: &Place) -> bool {
    let at = place.projections.iter().position(|it| matches!(it, Projection::Deref { .. }));
    let named = at.map_or_else(|| place.clone(), |at| place.before(at, pointer.ty));
    named.projections.len() <= pointer.projections.len()
        && named.root == pointer.root
        && named.projections.iter().zip(&pointer.projections).all(|(a, b)| match (a, b) {
            (Projection::Field(a), Projection::Field(b)) => a == b,
            _ => true,
        })
}

/// A statement of a loop that nothing sees but itself, and which leaves no loop.
fn is_plain(kind: &StatementKind) -> bool {
    match kind {
        StatementKind::Assign { .. }
        | StatementKind::If { .. }
        | StatementKind::Case { .. }
        | StatementKind::For(_)
        | StatementKind::CallBlock { .. } => true,
        StatementKind::Loop { .. }
        | StatementKind::Turn
        | StatementKind::Exit
        | StatementKind::Continue
        | StatementKind::Try { .. }
        | StatementKind::Finally { .. }
        | StatementKind::Return
        | StatementKind::Call { .. }
        | StatementKind::External(_)
        | StatementKind::PrescanBlock { .. }
        | StatementKind::Stop(_)
        | StatementKind::Fault(_) => false,
    }
}

struct Renamer<'a> {
    pointer: &'a Place,
    target: Place,
}

impl Rewrite for Renamer<'_> {
    fn expr(&mut self, _: &mut Expr) {}

    fn place(&mut self, place: &mut Place) {
        if let Some(at) = way(place, self.pointer, self.target.ty) {
            place.root = self.target.root;
            place.projections.splice(..=at, self.target.projections.iter().cloned());
        }
    }
}
