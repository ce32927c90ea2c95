//! Scalars that a loop works on are in locals while it runs.
//!
//! ```text
//! FOR state.i := 1 TO 16 DO              i := 1 ...
//!     state.sum := state.sum + a[state.i]   sum := state.sum
//! END_FOR                                FOR i := 1 TO 16 DO sum := sum + a[i] END_FOR
//!                                        state.i := i; state.sum := sum
//! ```
//!
//! It applies to a loop that does not return: nobody sees the state before the loop has ended. A routine that it calls sees
//! no variable that is taken (`unseen`). Where the loop can fault, the values are stored after a fault as well
//! ([`Finally`](StatementKind::Finally)), so that the state is what it was when the loop faulted. A variable is taken if all
//! that the loop touches is either this variable or, whatever indices and references are, another one.
//!
//! A back end then has the variables in registers, where it would have to store them in each turn, since an element of an
//! array, or what a reference leads to, might be the same storage. That an index is within its bounds is also known more
//! often: a local counter is private to its loop.

mod kept;
mod local;
mod pointed;
mod read_once;
mod set_first;
mod unseen;
mod walked;
mod within;

use crate::alias::{Alias, Frame, alias};
use crate::effects::{Effects, Rules, effects, statement_faults};
use crate::faults::code_faults;
use crate::loops::{checked_locals, privatise};
use crate::visit::{self, Access, Rewrite};
use crate::{
    Block, Const, Expr, For, Local, LocalId, Place, Program, Projection, Root, Routine, Statement, StatementKind, Type,
    Value,
};
use kept::kept;
use local::{MOST_LOCALS, name, private_head};
use pointed::directly;
use read_once::read_once;
use set_first::is_set_first;
use staunch_runtime::Repr;
use unseen::Others;
use walked::walked;
use within::twice;

/// A loop that touches more places than this stays: each is compared with each.
const MOST_PLACES: usize = 128;

/// What a back end gains by.
#[expect(missing_debug_implementations, reason = "it holds a function, and lives for one question")]
#[derive(Clone, Copy)]
pub struct Gain<'a> {
    /// Whether a statement may be in such a loop.
    pub suits: &'a dyn Fn(&Statement) -> bool,
    /// Whether variables are taken that the loop only reads, while it stores elements of arrays.
    pub of_reads: bool,
    /// Whether a WHILE or REPEAT is taken that can fault and stores neither to an element of an array nor through a reference: where the
    /// back end itself keeps variables in registers up to a fault, more of them only have to be moved there.
    pub of_scalars: bool,
    /// Whether a variable that is read again after an element of an array was stored is read once.
    pub of_repeats: bool,
    /// Whether a loop gets a second version that needs no checks of its indices.
    pub of_ends: bool,
}

impl Gain<'_> {
    /// Of all that can be.
    pub const WHOLE: Self =
        Self { suits: &|_| true, of_reads: true, of_scalars: false, of_repeats: true, of_ends: false };
}

/// The program with such loops.
#[must_use]
pub fn promoted(program: &Program, gain: Gain<'_>) -> Program {
    let mut program = program.clone();
    let known = effects(&program, &RULES);
    for at in 0..program.routines.len() {
        let checked = checked_locals(&program.routines[at]);
        let mut body = std::mem::take(&mut program.routines[at].body);
        let mut routine = program.routines[at].clone();
        let declared = routine.locals.len();
        directly(&program, &mut routine, &mut body, declared);
        walked(&program, (&RULES, &known), &routine, &mut body);
        if gain.of_ends {
            twice(&program, &mut routine, &mut body, declared);
        }
        let (known, around) = (&known, Vec::new());
        Promoter { program: &program, gain, known, routine: &mut routine, declared, checked, around }.block(&mut body);
        read_once(&program, &mut routine, &mut body, declared);
        if gain.of_repeats {
            kept(&program, &mut routine, &mut body, declared);
        }
        program.routines[at] = Routine { body, ..routine };
    }
    program
}

const RULES: Rules = Rules { operation_faults: code_faults, drops_checks: true, ..Rules::PLAIN };

struct Promoter<'p> {
    program: &'p Program,
    gain: Gain<'p>,
    /// What each routine does.
    known: &'p [Effects],
    /// Without its body.
    routine: &'p mut Routine,
    /// How many locals it had.
    declared: usize,
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

/// What a loop touches, each variable once.
#[derive(Default)]
struct Touched(Vec<Touch>);

struct Touch {
    place: Place,
    is_written: bool,
    is_borrowed: bool,
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
        if !self.is_closed(statement) {
            return false;
        }
        let count = self.routine.locals.len();
        let candidates = self.candidates(statement);
        let mut promoted = statement.clone();
        in_locals(&Frame::of(self.program, self.routine), &mut promoted, &candidates);
        if !candidates.iter().any(|it| it.is_written) {
            self.routine.locals.truncate(count);
            return false;
        }
        let at = statement.at;
        let faults = self.faults(&promoted);
        let is_for = matches!(statement.kind, StatementKind::For(_));
        if faults && !is_for && !self.gain.of_scalars && !stores_element(statement) {
            self.routine.locals.truncate(count);
            return false;
        }
        // What is not loaded before must not be stored after a fault that comes before it is set.
        let is_loaded = |it: &&Candidate| faults || !is_set_first(statement, &it.place);
        let loaded = candidates.iter().filter(is_loaded);
        block.extend(loaded.map(|it| Statement::assign(it.as_local(), Expr::load(it.place.clone(), at), at)));
        let written = candidates.iter().filter(|it| it.is_written);
        let last = written.map(|it| Statement::assign(it.place.clone(), Expr::load(it.as_local(), at), at));
        if faults {
            let kind = StatementKind::Finally { body: vec![promoted], last: last.collect() };
            block.push(Statement::new(kind, at));
        } else {
            block.push(promoted);
            block.extend(last);
        }
        true
    }

    /// Whether nothing but its own statements and routines runs in a loop, and it is left at its end alone.
    fn is_closed(&self, statement: &Statement) -> bool {
        let mut closed = true;
        visit::statements(std::slice::from_ref(statement), &mut |it| {
            closed = closed && is_plain(&it.kind) && (self.gain.suits)(it);
        });
        closed
    }

    /// The variables that the loop touches and nothing else in it can be, each with a local of its own.
    fn candidates(&mut self, statement: &Statement) -> Vec<Candidate> {
        let Some(Touched(touched)) = Touched::by(statement) else { return Vec::new() };
        let takes_reads = self.gain.of_reads && stores_element(statement);
        let frame = Frame::of(self.program, self.routine);
        let others = Others::of(&frame, self.known, statement);
        let is_taken = |(at, it): &(usize, &Touch)| {
            let is_useful = it.is_written || takes_reads && !self.is_counter_around(&it.place);
            let can_be = is_useful && !it.is_borrowed && self.is_scalar_variable(&it.place);
            let is_apart =
                |(other, of): (usize, &Touch)| other == *at || alias(&frame, &of.place, &it.place) == Alias::No;
            can_be && others.do_not_see(&it.place) && touched.iter().enumerate().all(is_apart)
        };
        let taken: Vec<&Touch> = touched.iter().enumerate().filter(is_taken).map(|(_, it)| it).collect();
        let mut candidates = Vec::new();
        for it in taken {
            if let Some(local) = self.local(&it.place, &candidates) {
                candidates.push(Candidate { place: it.place.clone(), local, is_written: it.is_written });
            }
        }
        candidates
    }

    /// Whether a back end has it in a register.
    fn is_counter_around(&self, place: &Place) -> bool {
        self.around.iter().any(|it| it.counter.is_same_variable(place))
    }

    fn is_scalar_variable(&self, place: &Place) -> bool {
        let is_stored = match place.root {
            Root::Instance | Root::Globals => !place.projections.is_empty(),
            Root::Param(_) => true,
            Root::Local(_) => false,
        };
        let is_named = place.projections.iter().all(|it| matches!(it, Projection::Field(_)));
        let is_scalar = match place.ty {
            Type::Elementary(_) | Type::Enum(_) | Type::Reference(_) => true,
            Type::Subrange(..) | Type::String(_) | Type::Array(_) | Type::Struct(_) | Type::Block(_) => false,
        };
        is_stored && is_named && is_scalar
    }

    /// A local for a variable. Where a routine has many, they are those of loops before.
    fn local(&mut self, place: &Place, taken: &[Candidate]) -> Option<LocalId> {
        let (name, ty) = (name(self.program, self.routine, place), place.ty);
        let count = self.routine.locals.len();
        if count < self.declared + MOST_LOCALS {
            let zero = self.program.repr(ty).map_or(Value::Bool(false), Repr::zero);
            self.routine.locals.push(Local { name, ty, initial: Const::Scalar(zero), doc: None });
            return Some(LocalId::next(count));
        }
        (self.declared..count).map(LocalId::next).find(|id| {
            let local = &self.routine.locals[id.index()];
            local.name == name && local.ty == ty && !taken.iter().any(|it| it.local == *id)
        })
    }

    fn faults(&self, statement: &Statement) -> bool {
        let mut checked = self.checked.clone();
        checked.resize(self.routine.locals.len(), false);
        statement_faults(
            self.program,
            &RULES,
            self.known,
            self.routine,
            (self.around.iter().collect(), checked),
            statement,
        )
    }
}

impl Touched {
    /// `None` where there are too many.
    fn by(statement: &Statement) -> Option<Self> {
        let mut touched = Self::default();
        let mut see = |it: &Statement| visit::accesses(it, &mut |place, access| touched.add(place, access));
        visit::statements(std::slice::from_ref(statement), &mut see);
        (touched.0.len() <= MOST_PLACES).then_some(touched)
    }

    fn add(&mut self, place: &Place, access: Access) {
        if self.0.len() > MOST_PLACES {
            return;
        }
        let at = self.0.iter().position(|it| it.place.is_same_variable(place)).unwrap_or(self.0.len());
        if at == self.0.len() {
            self.0.push(Touch { place: place.clone(), is_written: false, is_borrowed: false });
        }
        self.0[at].is_written |= access == Access::Write;
        self.0[at].is_borrowed |= access == Access::Borrow;
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

/// Whether an element of an array is stored or handed on, or what a reference leads to.
fn stores_element(statement: &Statement) -> bool {
    let mut found = false;
    let is_named = |it: &Place| it.projections.iter().all(|it| matches!(it, Projection::Field(_)));
    visit::statements(std::slice::from_ref(statement), &mut |it| {
        visit::accesses(it, &mut |place, access| found |= access != Access::Read && !is_named(place));
    });
    found
}

/// Whether it is known what a statement runs, and it leaves no more than a loop.
fn is_plain(kind: &StatementKind) -> bool {
    match kind {
        StatementKind::Assign { .. }
        | StatementKind::If { .. }
        | StatementKind::Case { .. }
        | StatementKind::Loop { .. }
        | StatementKind::For(_)
        | StatementKind::Turn
        | StatementKind::Exit
        | StatementKind::Continue
        | StatementKind::Call { .. }
        | StatementKind::CallBlock { .. } => true,
        StatementKind::Try { .. }
        | StatementKind::Finally { .. }
        | StatementKind::Return
        | StatementKind::External(_)
        | StatementKind::PrescanBlock { .. }
        | StatementKind::Stop(_)
        | StatementKind::Fault(_) => false,
    }
}

/// Puts the locals in place of the variables, and says which counters are private now.
fn in_locals(frame: &Frame<'_>, statement: &mut Statement, candidates: &[Candidate]) {
    let statements = std::slice::from_mut(statement);
    visit::rewrite(statements, &mut Renamer { candidates });
    privatise(frame, statements);
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
        // A place reached through a reference.
        let way = place.projections.iter().position(|it| matches!(it, Projection::Deref { .. }));
        let holder = way.map(|at| (at, place.before(at, place.ty)));
        if let Some((at, holder)) = holder
            && let Some(it) = self.candidates.iter().find(|it| it.place.is_same_variable(&holder))
        {
            place.root = Root::Local(it.local);
            place.projections.drain(..at);
        }
    }
}

#[cfg(test)]
mod tests;
