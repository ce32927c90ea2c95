//! A variable that holds a reference is read once for the statements that follow it one after the other.
//!
//! ```text
//! state.p^.a := 1;            p := state.p;
//! state.b := state.p^.c;      p^.a := 1;
//!                             state.b := p^.c;
//! ```
//!
//! It applies to variables that no reference leads to, from the first statement that reads one to the last before one that
//! may write it. A back end then sees that it is the same reference, and looks but once where it leads: it cannot know that
//! what is written through a reference is another variable.

use super::local::{MOST_LOCALS, name};
use crate::alias::{Frame, changes};
use crate::loops::exit_condition;
use crate::visit::{self, Access, Rewrite};
use crate::{
    Block, Const, Expr, Local, LocalId, Place, Program, Projection, Root, Routine, Statement, StatementKind, Type,
    Value,
};

/// So many statements later it is read again.
const FAR: usize = 64;

/// What a routine's statements read of references, once. `declared` is how many locals it had before all passes.
pub(super) fn read_once(program: &Program, routine: &mut Routine, body: &mut Block, declared: usize) {
    if !program.references.is_empty() && program.reached.is_some() {
        Reader { program, routine, declared }.block(body, 0);
    }
}

struct Reader<'p> {
    program: &'p Program,
    /// Without its body.
    routine: &'p mut Routine,
    declared: usize,
}

impl Reader<'_> {
    /// The first statements of a loop's body, its test and turn, say how it runs, and stay.
    fn block(&mut self, block: &mut Block, first: usize) {
        let mut at = first;
        while at < block.len() {
            while let Some((place, last)) = self.next(&block[at..]) {
                let local = self.local(&place);
                let mut renamer = Renamer { place: &place, local };
                visit::rewrite(&mut block[at..=at + last], &mut renamer);
                let from = block[at].at;
                let value = Expr::load(place.clone(), from);
                block.insert(at, Statement::assign(Place::local(local, place.ty), value, from));
                at += 1;
            }
            self.inside(&mut block[at]);
            at += 1;
        }
    }

    fn inside(&mut self, statement: &mut Statement) {
        match &mut statement.kind {
            StatementKind::Loop { body, continuing, .. } => {
                let first = head(body);
                self.block(body, first);
                self.block(continuing, usize::MAX);
            }
            StatementKind::For(it) => {
                let first = head(&it.body);
                self.block(&mut it.body, first);
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
        visit::statements(&statements[..1], &mut |it| {
            visit::accesses(it, &mut |place, access| {
                let is_known = read.iter().any(|it| it.is_same_variable(place));
                if access == Access::Read && is_variable(&frame, place) && !is_known {
                    read.push(place.clone());
                }
            });
        });
        read.into_iter().find_map(|place| run(&frame, statements, &place).map(|last| (place, last)))
    }

    fn local(&mut self, place: &Place) -> LocalId {
        let name = name(self.program, self.routine, place);
        self.routine.locals.push(Local { name, ty: place.ty, initial: Const::Scalar(Value::U64(0)), doc: None });
        LocalId::next(self.routine.locals.len() - 1)
    }
}

/// Where the statements of a loop's body begin, after those that control the loop.
fn head(body: &[Statement]) -> usize {
    let test = body.iter().position(|it| exit_condition(it).is_some()).map_or(0, |it| it + 1);
    test + usize::from(body.get(test).is_some_and(|it| matches!(it.kind, StatementKind::Turn)))
}

/// A variable of the instance or among the globals that holds a reference, and to which none leads.
fn is_variable(frame: &Frame<'_>, place: &Place) -> bool {
    let is_named = place.projections.iter().all(|it| matches!(it, Projection::Field(_)));
    let is_stored = matches!(place.root, Root::Instance | Root::Globals);
    is_named && is_stored && matches!(place.ty, Type::Reference(_)) && !frame.is_reached(place)
}

/// The last of the statements in which the variable is read, before what may write it: where it is read more than once.
fn run(frame: &Frame<'_>, statements: &[Statement], place: &Place) -> Option<usize> {
    let value = Expr::load(place.clone(), crate::Location::default());
    let (mut uses, mut last) = (0, 0);
    for (at, statement) in statements.iter().enumerate() {
        let ends = changes(frame, std::slice::from_ref(statement), &value);
        // What is assigned to it is read before that.
        if ends && !is_assigned(statement, place) {
            break;
        }
        let read = count(statement, place);
        uses += read;
        if read > 0 {
            last = at;
        }
        if ends || at - last > FAR {
            break;
        }
    }
    (uses > 1).then_some(last)
}

fn is_assigned(statement: &Statement, place: &Place) -> bool {
    matches!(&statement.kind, StatementKind::Assign { target, .. } if target.is_same_variable(place))
}

fn count(statement: &Statement, place: &Place) -> usize {
    let mut found = 0;
    visit::statements(std::slice::from_ref(statement), &mut |it| {
        visit::accesses(it, &mut |read, access| {
            found += usize::from(access == Access::Read && read.is_same_variable(place));
        });
    });
    found
}

struct Renamer<'a> {
    place: &'a Place,
    local: LocalId,
}

impl Rewrite for Renamer<'_> {
    fn expr(&mut self, expr: &mut Expr) {
        if let crate::ExprKind::Load(place) = &mut expr.kind
            && place.is_same_variable(self.place)
        {
            *place = Place::local(self.local, place.ty);
        }
    }

    /// The target of the reference.
    fn place(&mut self, place: &mut Place) {
        let Some(at) = place.projections.iter().position(|it| matches!(it, Projection::Deref { .. })) else { return };
        if place.before(at, self.place.ty).is_same_variable(self.place) {
            place.root = Root::Local(self.local);
            place.projections.drain(..at);
        }
    }
}
