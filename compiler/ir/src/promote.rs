//! Scalars that a loop works on are in locals while it runs.
//!
//! ```text
//! FOR state.i := 1 TO 16 DO              i := 1 ...
//!     state.sum := state.sum + a[state.i]   sum := state.sum
//! END_FOR                                FOR i := 1 TO 16 DO sum := sum + a[i] END_FOR
//!                                        state.i := i; state.sum := sum
//! ```
//!
//! It applies to a loop that cannot fault, calls no routine and does not return: nobody sees the state before the loop has
//! ended. A variable is taken if all that the loop touches is either this variable or, whatever indices and references
//! are, another one. The counter of a loop that takes its turns before the first one stays where it is: a fault there
//! shows the counter's first value.
//!
//! A back end then has the variables in registers, where it would have to store them in each turn, since an element of an
//! array, or what a reference leads to, might be the same storage. That an index is within its bounds is also known more
//! often: a local counter is private to its loop.

use crate::alias::{Alias, Frame, alias};
use crate::effects::{Rules, statement_faults};
use crate::faults::code_faults;
use crate::loops::{checked_locals, is_private};
use crate::visit::{self, Access, Rewrite};
use crate::{
    Block, Const, Expr, For, Local, LocalId, Place, Program, Projection, Root, Routine, Statement, StatementKind,
    Taking, Type, Value,
};
use staunch_runtime::Repr;

/// The program with such loops.
#[must_use]
pub fn promoted(program: &Program) -> Program {
    let mut program = program.clone();
    for at in 0..program.routines.len() {
        let mut routine = program.routines[at].clone();
        let checked = checked_locals(&routine);
        let mut body = std::mem::take(&mut routine.body);
        Promoter { program: &program, routine: &mut routine, checked, around: Vec::new() }.block(&mut body);
        routine.body = body;
        program.routines[at] = routine;
    }
    program
}

const RULES: Rules = Rules { operation_faults: code_faults, drops_checks: true, ..Rules::PLAIN };

struct Promoter<'p> {
    program: &'p Program,
    /// Without its body.
    routine: &'p mut Routine,
    /// Of each local that was declared, whether its values are always within its subrange.
    checked: Vec<bool>,
    /// The private loops around, without their bodies.
    around: Vec<For>,
}

/// A variable that a loop works on.
struct Candidate {
    place: Place,
    local: LocalId,
    is_written: bool,
}

impl Promoter<'_> {
    fn block(&mut self, block: &mut Block) {
        let statements = std::mem::take(block);
        for mut statement in statements {
            if is_loop(&statement) && self.promote(&mut statement, block) {
                continue;
            }
            let head = private_head(&statement);
            let depth = self.around.len();
            self.around.extend(head);
            statement.kind.blocks_mut().into_iter().for_each(|it| self.block(it));
            self.around.truncate(depth);
            block.push(statement);
        }
    }

    /// Appends the loop with its variables in locals to `block`, if that can be.
    fn promote(&mut self, statement: &mut Statement, block: &mut Block) -> bool {
        if !is_closed(statement) {
            return false;
        }
        let count = self.routine.locals.len();
        let candidates = self.candidates(statement);
        if !candidates.iter().any(|it| it.is_written) {
            return false;
        }
        let locals: Vec<Local> = candidates.iter().map(|it| self.local(&it.place)).collect();
        self.routine.locals.extend(locals);
        let mut promoted = statement.clone();
        let frame = Frame::of(self.program, self.routine);
        in_locals(&frame, &mut promoted, &candidates);
        if self.faults(&promoted) {
            self.routine.locals.truncate(count);
            return false;
        }
        let at = statement.at;
        let assign = |target, value| Statement::new(StatementKind::Assign { target, value }, at);
        for it in candidates.iter().filter(|it| !is_set_first(statement, &it.place)) {
            block.push(assign(it.as_local(), Expr::load(it.place.clone(), at)));
        }
        block.push(promoted);
        for it in candidates.iter().filter(|it| it.is_written) {
            block.push(assign(it.place.clone(), Expr::load(it.as_local(), at)));
        }
        true
    }

    /// Named as the variable, or as the last member on the way to it.
    fn local(&self, place: &Place) -> Local {
        let mut ty = Frame::of(self.program, self.routine).root_type(place.root);
        let mut name = match place.root {
            Root::Param(id) => self.routine.params[id.index()].name.clone(),
            Root::Instance | Root::Globals | Root::Local(_) => String::new(),
        };
        for projection in &place.projections {
            if let (Some(Type::Struct(id)), Projection::Field(field)) = (ty, projection) {
                name.clone_from(&self.program.structure(id).fields[field.index()].name);
            }
            ty = ty.and_then(|it| self.program.part(it, projection));
        }
        let zero = self.program.repr(place.ty).map_or(Value::Bool(false), Repr::zero);
        Local { name, ty: place.ty, initial: Const::Scalar(zero), doc: None }
    }

    /// The variables that the loop touches and nothing else in it can be.
    fn candidates(&self, statement: &Statement) -> Vec<Candidate> {
        let frame = Frame::of(self.program, self.routine);
        let mut touched: Vec<(Place, Access)> = Vec::new();
        let mut see = |it: &Statement| visit::accesses(it, &mut |place, access| touched.push((place.clone(), access)));
        visit::statements(std::slice::from_ref(statement), &mut see);
        let stores_elements =
            touched.iter().any(|(it, access)| *access != Access::Read && it.indices().next().is_some());
        let mut candidates: Vec<Candidate> = Vec::new();
        for (place, access) in &touched {
            if let Some(known) = candidates.iter_mut().find(|it| it.place.is_same_variable(place)) {
                known.is_written |= *access == Access::Write;
                continue;
            }
            let is_apart = |(other, access): &(Place, Access)| {
                let is_it = other.is_same_variable(place) && *access != Access::Borrow;
                is_it || alias(&frame, other, place) == Alias::No
            };
            if self.is_scalar_variable(place) && !is_counter_of_turns(statement, place) && touched.iter().all(is_apart)
            {
                let local = LocalId::next(self.routine.locals.len() + candidates.len());
                candidates.push(Candidate { place: place.clone(), local, is_written: *access == Access::Write });
            }
        }
        // What is only read needs no copy, unless the loop stores what might be it.
        candidates.retain(|it| it.is_written || stores_elements);
        for (at, it) in candidates.iter_mut().enumerate() {
            it.local = LocalId::next(self.routine.locals.len() + at);
        }
        candidates
    }

    fn is_scalar_variable(&self, place: &Place) -> bool {
        let is_stored = match place.root {
            Root::Instance | Root::Globals => !place.projections.is_empty(),
            Root::Param(_) => true,
            Root::Local(_) => false,
        };
        let is_named = place.projections.iter().all(|it| matches!(it, Projection::Field(_)));
        is_stored && is_named && matches!(place.ty, Type::Elementary(_) | Type::Enum(_))
    }

    /// Whether the loop can fault after it has begun, or before by what its head evaluates.
    fn faults(&self, statement: &Statement) -> bool {
        let mut begun = statement.clone();
        match &mut begun.kind {
            StatementKind::For(it) => it.taking = Taking::Each,
            StatementKind::Loop { count: Some(it), .. } => it.taking = Taking::Each,
            _ => {}
        }
        let mut checked = self.checked.clone();
        checked.resize(self.routine.locals.len(), false);
        statement_faults(self.program, &RULES, self.routine, (self.around.iter().collect(), checked), &begun)
    }
}

impl Candidate {
    fn as_local(&self) -> Place {
        Place::local(self.local, self.place.ty)
    }
}

fn is_loop(statement: &Statement) -> bool {
    matches!(statement.kind, StatementKind::For(_) | StatementKind::Loop { .. })
}

/// Whether nothing but its own statements runs in it, and it is left at its end alone.
fn is_closed(statement: &Statement) -> bool {
    let mut closed = true;
    visit::statements(std::slice::from_ref(statement), &mut |it| {
        closed &= match it.kind {
            StatementKind::Assign { .. }
            | StatementKind::If { .. }
            | StatementKind::Case { .. }
            | StatementKind::Loop { .. }
            | StatementKind::For(_)
            | StatementKind::Exit
            | StatementKind::Continue
            | StatementKind::CallBlock { .. } => true,
            StatementKind::Try { .. }
            | StatementKind::Turn
            | StatementKind::Return
            | StatementKind::Call { .. }
            | StatementKind::External(_)
            | StatementKind::PrescanBlock { .. }
            | StatementKind::Fault(_) => false,
        };
    });
    closed
}

/// Its counter, which a fault of taking turns shows at its first value.
fn is_counter_of_turns(statement: &Statement, place: &Place) -> bool {
    matches!(&statement.kind, StatementKind::For(it) if it.taking.is_ahead() && it.counter.is_same_variable(place))
}

/// Whether the loop gives the variable a value before it reads it.
fn is_set_first(statement: &Statement, place: &Place) -> bool {
    let StatementKind::For(it) = &statement.kind else { return false };
    let mut is_read = false;
    visit::reads(&it.first, &mut |read| is_read |= read.is_same_variable(place));
    it.counter.is_same_variable(place) && !is_read
}

fn private_head(statement: &Statement) -> Option<For> {
    match &statement.kind {
        StatementKind::For(it) if it.is_private => Some(For { body: Vec::new(), ..(**it).clone() }),
        _ => None,
    }
}

/// Puts the locals in place of the variables, and says which counters are private now.
fn in_locals(frame: &Frame<'_>, statement: &mut Statement, candidates: &[Candidate]) {
    let statements = std::slice::from_mut(statement);
    visit::rewrite(statements, &mut Renamer { candidates });
    privatise(frame, statements);
}

fn privatise(frame: &Frame<'_>, block: &mut [Statement]) {
    for statement in block {
        if let StatementKind::For(it) = &mut statement.kind {
            it.is_private |= is_private(frame, &it.counter, &it.body);
        }
        statement.kind.blocks_mut().into_iter().for_each(|it| privatise(frame, it));
    }
}

struct Renamer<'a> {
    candidates: &'a [Candidate],
}

impl Rewrite for Renamer<'_> {
    fn expr(&mut self, _: &mut Expr) {}

    fn place(&mut self, place: &mut Place) {
        if let Some(it) = self.candidates.iter().find(|it| it.place.is_same_variable(place)) {
            *place = Place::local(it.local, place.ty);
        }
    }
}

#[cfg(test)]
mod tests;
