//! A reference that several statements follow is looked up once for all of them.
//!
//! ```text
//! p^.a := p^.b;                 IF p leads to where it is expected THEN
//! IF p^.a > 3 THEN                  motors[…].a := motors[…].b;
//!     p^.n := p^.n + 1;             IF motors[…].a > 3 THEN motors[…].n := motors[…].n + 1; END_IF
//! END_IF                        ELSE
//!                                   all of it by the runtime, away from the common path
//!                               END_IF
//! ```
//!
//! It applies to a reference in a local variable, up to the last statement that follows it before it gets another value, where
//! that is more than once, and where variables of the type are [expected](crate::expectation) in a few places. Since the
//! statements are duplicated, they are limited in size, and among those by the runtime no further reference is looked up for
//! several. A reference that the statement before has made of the
//! address of such a variable leads there, and nothing is duplicated. It may not assume where another reference leads: a pointer may be laid
//! over any variable.

use crate::function::{Flow, Function, Leads, LocalSlot, LookedUp};
use cranelift_codegen::ir::{self as clif, InstBuilder};
use staunch_ir::alias::{Frame, changes};
use staunch_ir::{Expr, LocalId, Location, Place, Projection, Root, Statement, StatementKind, Type, turns, visit};
use std::slice::from_ref;

/// More statements, and more operations, are not there twice.
const FAR: usize = 64;
const MOST: usize = 1024;
/// Operations in one routine that are there twice, so that its code grows by no more.
const MOST_IN_A_ROUTINE: usize = 8192;
/// A loop follows it so many times.
const OF_A_LOOP: usize = 8;

/// Statements that follow a reference.
pub(crate) struct Run {
    pointer: Place,
    local: LocalId,
    ty: Type,
    pub(crate) len: usize,
}

impl<'p> Function<'_, 'p> {
    /// The reference that the first of the statements follows, and others after it, if looking it up once is worth while.
    pub(crate) fn next_run(&mut self, statements: &'p [Statement]) -> Option<Run> {
        if self.module.program.references.is_empty() || self.is_elsewhere() {
            return None;
        }
        let mut found: Vec<(Place, LocalId, Type)> = Vec::new();
        see_followed(&statements[0], &mut |pointer, local, ty| {
            if !found.iter().any(|it| it.1 == local && it.2 == ty) {
                found.push((pointer, local, ty));
            }
        });
        let (len, size, (pointer, local, ty)) = found.into_iter().find_map(|it| self.length_of_run(statements, it))?;
        self.doubled += size;
        Some(Run { pointer, local, ty, len })
    }

    /// How many statements there are up to the last that follows the reference, and their size.
    fn length_of_run(
        &mut self,
        statements: &[Statement],
        (pointer, local, ty): (Place, LocalId, Type),
    ) -> Option<(usize, usize, (Place, LocalId, Type))> {
        let is_known = self.looked_up.iter().any(|it| it.pointer == local);
        let is_variable = matches!(self.locals[local.index()], LocalSlot::Variable(_));
        let is_fresh = self.fresh(local, ty).is_some();
        if is_known || !is_variable || !is_fresh && self.module.expectations(ty).is_empty() {
            return None;
        }
        let frame = Frame::of(self.module.program, self.routine);
        let value = Expr::load(pointer.clone(), Location::default());
        let (mut uses, mut size, mut last) = (0, 0, None);
        for (at, statement) in statements.iter().take(FAR).enumerate() {
            size += turns::size_of(from_ref(statement));
            let ends = changes(&frame, from_ref(statement), &value);
            // What is assigned to it is found before that.
            if size > MOST || takes_turn(statement) || ends && !is_assigned(statement, &pointer) {
                break;
            }
            let followed = times_followed(statement, local, ty);
            uses += followed;
            if followed > 0 {
                last = Some((at + 1, size));
            }
            if ends {
                break;
            }
        }
        let (len, size) = last?;
        let is_worth_it = is_fresh || uses > 1 && self.doubled + size <= MOST_IN_A_ROUTINE;
        if !is_worth_it {
            return None;
        }
        let size = if is_fresh { 0 } else { size };
        Some((len, size, (pointer, local, ty)))
    }

    /// Where a variable's reference leads that the statement before has made, if it is to such a variable itself.
    fn fresh(&self, local: LocalId, ty: Type) -> Option<clif::Value> {
        self.fresh.filter(|it| it.0 == local && it.1.ty == ty).map(|it| it.1.offset)
    }

    /// The statements of a run.
    pub(crate) fn looked_up_once(&mut self, run: &Run, statements: &'p [Statement]) -> Flow {
        if let Some(offset) = self.fresh(run.local, run.ty) {
            self.looked_up.push(LookedUp { pointer: run.local, ty: run.ty, leads: Leads::To(offset) });
            let flow = self.block(statements);
            self.looked_up.pop();
            return flow;
        }
        let reference = self.load_place(&run.pointer);
        let (offset, slow) = self.expected(reference, None, run.ty).expect("variables of the type are expected");
        let after = self.builder.create_block();
        let flow = self.statements_where(run, Leads::To(offset), statements, after);
        self.builder.switch_to_block(slow);
        let flow = [flow, self.statements_where(run, Leads::Elsewhere, statements, after)];
        self.join(&flow, after)
    }

    fn statements_where(&mut self, run: &Run, leads: Leads, statements: &'p [Statement], after: clif::Block) -> Flow {
        self.looked_up.push(LookedUp { pointer: run.local, ty: run.ty, leads });
        let flow = self.block(statements);
        self.looked_up.pop();
        if flow == Flow::Continues {
            self.ins().jump(after, &[]);
        }
        flow
    }

    /// Where the reference in a variable leads that has been looked up as such a type.
    pub(crate) fn leads(&self, pointer: &Place, ty: Type) -> Option<Leads> {
        let local = local(pointer)?;
        self.looked_up.iter().find(|it| it.pointer == local && it.ty == ty).map(|it| it.leads)
    }

    /// Whether the statements that are being emitted are those by the runtime.
    pub(crate) fn is_elsewhere(&self) -> bool {
        self.looked_up.last().is_some_and(|it| matches!(it.leads, Leads::Elsewhere))
    }
}

pub(crate) fn local(pointer: &Place) -> Option<LocalId> {
    match pointer.root {
        Root::Local(id) if pointer.projections.is_empty() => Some(id),
        Root::Local(_) | Root::Instance | Root::Globals | Root::Param(_) => None,
    }
}

/// Calls `see` for each reference in a local variable that the statement follows, with the type that it is looked up as.
fn see_followed(statement: &Statement, see: &mut dyn FnMut(Place, LocalId, Type)) {
    let mut of = |place: &Place| {
        let Some(Projection::Deref { reference, target, .. }) = place.projections.first() else { return };
        let pointer = place.before(0, *reference);
        // An element is looked up by itself.
        let is_element = matches!(place.projections.get(1), Some(Projection::Index { .. }));
        if let Some(local) = local(&pointer).filter(|_| !is_element) {
            see(pointer, local, *target);
        }
    };
    visit::statements(from_ref(statement), &mut |it| visit::accesses(it, &mut |place, _| of(place)));
}

/// How many times a statement follows a reference to a type, about.
fn times_followed(statement: &Statement, local: LocalId, ty: Type) -> usize {
    let mut count = 0;
    see_followed(statement, &mut |_, of, target| count += usize::from(of == local && target == ty));
    let is_loop = matches!(statement.kind, StatementKind::For(_) | StatementKind::Loop { .. });
    if is_loop { count * OF_A_LOOP } else { count }
}

fn is_assigned(statement: &Statement, pointer: &Place) -> bool {
    matches!(&statement.kind, StatementKind::Assign { target, .. } if target.is_same_variable(pointer))
}

/// Whether the loop around takes a turn in a statement, which exists once in each copy of its body.
fn takes_turn(statement: &Statement) -> bool {
    match &statement.kind {
        StatementKind::Turn => true,
        StatementKind::For(_) | StatementKind::Loop { .. } => false,
        kind => kind.blocks().into_iter().flatten().any(takes_turn),
    }
}
