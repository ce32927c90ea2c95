//! A number that is read again after an element of an array has been stored is read once.
//!
//! ```text
//! state.ring[state.head] := value;            head := state.head;
//! state.head := (state.head + 1) MOD 32;      state.ring[head] := value;
//!                                             state.head := (head + 1) MOD 32;
//! ```
//!
//! It applies to variables that are named without an index, from the first statement that reads one to the last before one
//! that may write it, where one of those between stores an element at an index that is no constant. That such an element is
//! another variable the IR knows, and a compiler of emitted Rust does not: it would read the variable again, and know no more of it
//! that a check of an index said. It may not assume that a VAR_IN_OUT is another variable than those that its routine names.

use super::local::{MOST_LOCALS, name};
use crate::alias::{Frame, changes};
use crate::loops::exit_condition;
use crate::visit::{self, Access, Rewrite};
use crate::{
    Block, Const, Expr, ExprKind, Local, LocalId, Place, Program, Projection, Repr, Root, Routine, Statement,
    StatementKind, Type, Value,
};
use std::slice::from_ref;

/// So many statements later it is read again.
const FAR: usize = 16;

/// In a routine's statements. `declared` is how many locals it had before all passes.
pub(super) fn kept(program: &Program, routine: &mut Routine, body: &mut Block, declared: usize) {
    Keeper { program, routine, declared, counters: Vec::new() }.block(body, 0);
}

struct Keeper<'p> {
    program: &'p Program,
    /// Without its body.
    routine: &'p mut Routine,
    declared: usize,
    /// Those of the loops around, which a back end has in a register.
    counters: Vec<Place>,
}

impl Keeper<'_> {
    /// The first statements of a loop's body, its test and turn, say how it runs, and stay.
    fn block(&mut self, block: &mut Block, first: usize) {
        if !block.iter().any(stores_element) {
            return;
        }
        let mut at = first;
        while at < block.len() {
            // What stores an element has to be near.
            if block[at..].iter().take(FAR).any(stores_element) {
                at += self.keep(block, at);
            }
            self.inside(&mut block[at]);
            at += 1;
        }
    }

    /// Keeps what the statement reads; how many statements are before it now.
    fn keep(&mut self, block: &mut Block, at: usize) -> usize {
        let mut before = 0;
        while let Some((place, last)) = self.next(&block[at + before..]) {
            let at = at + before;
            let local = self.local(&place);
            visit::rewrite(&mut block[at..=at + last], &mut Renamer { place: &place, local });
            let from = block[at].at;
            let value = Expr::load(place.clone(), from);
            block.insert(at, Statement::assign(Place::local(local, place.ty), value, from));
            before += 1;
        }
        before
    }

    fn inside(&mut self, statement: &mut Statement) {
        match &mut statement.kind {
            StatementKind::Loop { body, .. } => {
                let first = head(body);
                self.block(body, first);
            }
            StatementKind::For(it) => {
                let first = head(&it.body);
                self.counters.push(it.counter.clone());
                self.block(&mut it.body, first);
                self.counters.pop();
            }
            kind => kind.blocks_mut().into_iter().for_each(|it| self.block(it, 0)),
        }
    }

    /// A variable that the first of the statements reads, and others after it, up to which one.
    fn next(&self, statements: &[Statement]) -> Option<(Place, usize)> {
        if self.routine.locals.len() >= self.declared + MOST_LOCALS {
            return None;
        }
        let frame = Frame::of(self.program, self.routine);
        let mut read: Vec<Place> = Vec::new();
        visit::accesses(&statements[0], &mut |place, access| {
            let is_known = read.iter().any(|it| it.is_same_variable(place));
            if access == Access::Read && self.is_variable(place) && !is_known {
                read.push(place.clone());
            }
        });
        read.into_iter().find_map(|place| run(&frame, statements, &place).map(|last| (place, last)))
    }

    /// A number or BOOL that has a name.
    fn is_variable(&self, place: &Place) -> bool {
        let is_named = place.projections.iter().all(|it| matches!(it, Projection::Field(_)));
        let is_stored = match place.root {
            Root::Instance | Root::Globals => !place.projections.is_empty(),
            Root::Param(_) => true,
            Root::Local(_) => false,
        };
        let is_counter = self.counters.iter().any(|it| it.is_same_variable(place));
        is_named && is_stored && !is_counter && matches!(place.ty, Type::Elementary(_) | Type::Enum(_))
    }

    fn local(&mut self, place: &Place) -> LocalId {
        let name = name(self.program, self.routine, place);
        let zero = self.program.repr(place.ty).map_or(Value::Bool(false), Repr::zero);
        self.routine.locals.push(Local { name, ty: place.ty, initial: Const::Scalar(zero), doc: None });
        LocalId::next(self.routine.locals.len() - 1)
    }
}

/// Where the statements of a loop's body begin, after those that control the loop.
fn head(body: &[Statement]) -> usize {
    let test = body.iter().position(|it| exit_condition(it).is_some()).map_or(0, |it| it + 1);
    test + usize::from(body.get(test).is_some_and(|it| matches!(it.kind, StatementKind::Turn)))
}

/// The last of the statements in which the variable is read, before what may write it: where an element is stored before that.
fn run(frame: &Frame<'_>, statements: &[Statement], place: &Place) -> Option<usize> {
    let value = Expr::load(place.clone(), crate::Location::default());
    let (mut has_stored, mut last) = (false, None);
    for (at, statement) in statements.iter().take(FAR).enumerate() {
        let ends = changes(frame, from_ref(statement), &value);
        // What is assigned to it is read before that.
        if ends && !is_assigned(statement, place) {
            break;
        }
        if has_stored && reads(statement, place) {
            last = Some(at);
        }
        if ends {
            break;
        }
        has_stored |= stores_element(statement);
    }
    last
}

fn is_assigned(statement: &Statement, place: &Place) -> bool {
    matches!(&statement.kind, StatementKind::Assign { target, .. } if target.is_same_variable(place))
}

fn reads(statement: &Statement, place: &Place) -> bool {
    let mut found = false;
    visit::statements(from_ref(statement), &mut |it| {
        visit::accesses(it, &mut |read, access| found |= access == Access::Read && read.is_same_variable(place));
    });
    found
}

/// Whether the statement itself, or one in it, stores an element of an array, at an index that is no constant.
fn stores_element(statement: &Statement) -> bool {
    let mut found = false;
    visit::statements(from_ref(statement), &mut |it| {
        if let StatementKind::Assign { target, .. } = &it.kind {
            found |= !target.is_followed() && target.indices().any(|it| it.as_const().is_none());
        }
    });
    found
}

struct Renamer<'a> {
    place: &'a Place,
    local: LocalId,
}

impl Rewrite for Renamer<'_> {
    fn expr(&mut self, expr: &mut Expr) {
        if let ExprKind::Load(place) = &mut expr.kind
            && place.is_same_variable(self.place)
        {
            *place = Place::local(self.local, place.ty);
        }
    }

    fn place(&mut self, _: &mut Place) {}
}
