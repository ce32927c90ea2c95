//! What a reference leads to is named itself, where it has just been given the variable's address.
//!
//! ```text
//! p := ADR(motors[i + 1]);      at := i + 1;
//!                               p := ADR(motors[at]);
//! p^.speed := 5;                motors[at].speed := 5;
//! ```
//!
//! It applies to references to which none leads, for the statements that follow, before one that may write the reference. The
//! variable is looked at as what it is, so that no such access can fault: that the index is within its bounds has been
//! checked when the address was taken, and its value stays in a local, unless it is a constant or goes by the counters of loops
//! around. In a program with pools
//! nothing is replaced: what is in one may be deleted.

use super::local::MOST_LOCALS;
use crate::alias::{Frame, changes};
use crate::visit::{self, Rewrite};
use crate::{
    Block, Const, Expr, ExprKind, Local, LocalId, Location, Place, Program, Projection, Root, Routine, Statement,
    StatementKind, Type, Value,
};

/// So many statements later it is followed again.
const FAR: usize = 64;

/// In a routine's statements. `declared` is how many locals it had before all passes.
pub(super) fn directly(program: &Program, routine: &mut Routine, body: &mut Block, declared: usize) {
    if !program.references.is_empty() && program.reached.is_some() && program.places.is_empty() {
        Pointer { program, routine, declared, counters: Vec::new() }.block(body);
    }
}

struct Pointer<'p> {
    program: &'p Program,
    /// Without its body.
    routine: &'p mut Routine,
    declared: usize,
    /// Those of the loops around, which nothing but the loop writes.
    counters: Vec<Place>,
}

impl Pointer<'_> {
    fn block(&mut self, block: &mut Block) {
        let mut at = 0;
        while at < block.len() {
            at += self.replace(block, at);
            let count = self.counters.len();
            self.counters.extend(counter(&block[at]));
            block[at].kind.blocks_mut().into_iter().for_each(|it| self.block(it));
            self.counters.truncate(count);
            at += 1;
        }
    }

    /// Replaces what follows the reference that the statement gives a value; how many statements are before it now.
    fn replace(&mut self, block: &mut Block, at: usize) -> usize {
        let Some((reference, target)) = self.taken(&block[at]) else { return 0 };
        let last = self.last(&block[at + 1..], &reference, target.ty);
        if last == 0 {
            return 0;
        }
        let (target, before) = self.fixed(target, block[at].at);
        let given = &mut block[at].kind;
        if let StatementKind::Assign { value, .. } = given {
            *value = Expr::new(value.ty, ExprKind::AddressOf(Box::new(target.clone())), value.at);
        }
        visit::rewrite(&mut block[at + 1..=at + last], &mut Renamer { reference, target });
        let count = before.len();
        block.splice(at..at, before);
        count
    }

    /// `reference := ADR(variable)`, where all is known of both.
    fn taken(&self, statement: &Statement) -> Option<(Place, Place)> {
        let StatementKind::Assign { target: reference, value } = &statement.kind else { return None };
        let ExprKind::AddressOf(variable) = &value.kind else { return None };
        let frame = Frame::of(self.program, self.routine);
        let is_named = reference.projections.iter().all(|it| matches!(it, Projection::Field(_)));
        let is_own = match reference.root {
            Root::Local(_) => reference.projections.is_empty(),
            Root::Instance | Root::Globals => !frame.is_reached(reference),
            Root::Param(_) => false,
        };
        let is_fixed = matches!(variable.root, Root::Instance | Root::Globals) && !variable.is_followed();
        let has_room = self.routine.locals.len() + variable.projections.len() < self.declared + MOST_LOCALS;
        (is_named && is_own && is_fixed && has_room).then(|| (reference.clone(), (**variable).clone()))
    }

    /// How many of the statements there are up to the last that follows the reference to what has this type.
    fn last(&self, statements: &[Statement], reference: &Place, ty: Type) -> usize {
        let frame = Frame::of(self.program, self.routine);
        let value = Expr::load(reference.clone(), Location::default());
        let kept = statements.iter().take_while(|it| !changes(&frame, std::slice::from_ref(it), &value));
        let follows = kept.take(FAR).enumerate().filter(|(_, it)| follows(it, reference, ty));
        follows.last().map_or(0, |(at, _)| at + 1)
    }

    /// Whether an index is nothing but constants and counters of loops.
    fn stays(&self, index: &Expr) -> bool {
        let mut stays = true;
        visit::reads(index, &mut |it| stays &= self.counters.iter().any(|counter| counter.is_same_variable(it)));
        stays
    }

    /// The variable with indices that nothing changes, and what finds them.
    fn fixed(&mut self, mut variable: Place, at: Location) -> (Place, Block) {
        let mut before = Block::new();
        for projection in &mut variable.projections {
            let Projection::Index { index, .. } = projection else { continue };
            if self.stays(index) {
                continue;
            }
            let local = LocalId::next(self.routine.locals.len());
            let (name, initial) = ("position".to_owned(), Const::Scalar(Value::I64(0)));
            self.routine.locals.push(Local { name, ty: index.ty, initial, doc: None });
            let place = Place::local(local, index.ty);
            let value = std::mem::replace(&mut **index, Expr::load(place.clone(), at));
            before.push(Statement::assign(place, value, at));
        }
        (variable, before)
    }
}

fn counter(statement: &Statement) -> Option<Place> {
    match &statement.kind {
        StatementKind::For(it) if it.is_private => Some(it.counter.clone()),
        _ => None,
    }
}

/// Whether a statement, or one in it, follows the reference to what has this type.
fn follows(statement: &Statement, reference: &Place, ty: Type) -> bool {
    let mut found = false;
    visit::statements(std::slice::from_ref(statement), &mut |it| {
        let mut see = |it: &Place| found |= way(it, reference, ty).is_some();
        visit::accesses(it, &mut |place, _| see(place));
    });
    found
}

/// Where the way of a place has followed the reference.
fn way(place: &Place, reference: &Place, ty: Type) -> Option<usize> {
    let at = place.projections.iter().position(|it| matches!(it, Projection::Deref { .. }))?;
    let leads = |it: &Projection| matches!(it, Projection::Deref { target, .. } if *target == ty);
    (leads(&place.projections[at]) && place.before(at, reference.ty).is_same_variable(reference)).then_some(at)
}

struct Renamer {
    reference: Place,
    target: Place,
}

impl Rewrite for Renamer {
    fn expr(&mut self, _: &mut Expr) {}

    fn place(&mut self, place: &mut Place) {
        if let Some(at) = way(place, &self.reference, self.target.ty) {
            place.root = self.target.root;
            place.projections.splice(..=at, self.target.projections.iter().cloned());
        }
    }
}
