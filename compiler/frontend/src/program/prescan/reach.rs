//! Uses of counters that reach a POU through its calls.

use super::named::{self, reads_param};
use crate::expr::uses::{KeptCount, Preparation, Uses, is_same_place, same_storage};
use staunch_ir::{
    Argument, Block, Expr, Location, Mode, Place, Program, Root, RoutineId, RoutineKind, Statement, StatementKind,
};

struct Call<'p> {
    callee: RoutineId,
    instance: Option<&'p Place>,
    arguments: &'p [Argument],
    at: Location,
}

/// Adds to the uses of the POU in slot `at` those of its callees that are of what it passes, and
/// all those of FUNCTIONs, which have no prescan of their own.
pub(super) fn through_calls(program: &Program, at: usize, uses: &mut [Uses]) {
    let mut calls = Vec::new();
    find(&program.routines[at].body, &mut calls);
    for call in calls {
        let callee = call.callee.index();
        if uses[callee].instructions.is_empty() && uses[callee].counts.is_empty() {
            continue;
        }
        let is_function = program.routines[callee].kind == RoutineKind::Function;
        for (place, instruction) in uses[callee].instructions.clone() {
            if (is_function || is_passed(&place) || reads_param(&place))
                && let Some(place) = call.named(program, &place)
            {
                add_instruction(&mut uses[at], place, instruction);
            }
        }
        for count in uses[callee].counts.clone() {
            if (is_function || is_passed(&count.counter) || is_passed(&count.kept))
                && let Some((counter, kept)) = call.carried(&count.counter).zip(call.carried(&count.kept))
            {
                add_count(&mut uses[at], KeptCount { counter, kept, through: Some(call.at), ..count });
            }
        }
    }
}

fn is_passed(place: &Place) -> bool {
    matches!(place.root, Root::Param(_))
}

impl Call<'_> {
    /// The same, with the indices as the caller finds them.
    fn named(&self, program: &Program, place: &Place) -> Option<Place> {
        let routine = program.routine(self.callee);
        let passed = |local| {
            let at = routine.params.iter().position(|it| it.mode == Mode::Value(local))?;
            match self.arguments.get(at)? {
                Argument::Value(value) => Some(value.clone()),
                Argument::Reference(_) => None,
            }
        };
        let load = |inner: Place| match inner.root {
            Root::Local(local) => passed(local).unwrap_or_else(|| named::initial(program, routine, local, &inner)),
            Root::Instance | Root::Globals | Root::Param(_) => match self.carried(&inner) {
                Some(place) => Expr::load(place, self.at),
                None => unreachable!("a callee that has an instance is called on one, and is passed what it refers to"),
            },
        };
        self.carried(&named::with_indices(place, &load))
    }

    /// The caller's name for a place of the callee's.
    fn carried(&self, place: &Place) -> Option<Place> {
        match place.root {
            Root::Globals => Some(place.clone()),
            Root::Instance => self.instance.map(|it| joined(it, place)),
            Root::Local(_) => None,
            Root::Param(id) => match self.arguments.get(id.index())? {
                Argument::Reference(actual) => Some(joined(actual, place)),
                Argument::Value(_) => None,
            },
        }
    }
}

/// The part of `outer` that `inner` is of its own root.
pub(super) fn joined(outer: &Place, inner: &Place) -> Place {
    let projections = outer.projections.iter().chain(&inner.projections).cloned().collect();
    Place { root: outer.root, projections, ty: inner.ty }
}

pub(super) fn add_instruction(uses: &mut Uses, place: Place, instruction: Preparation) {
    let known = uses.instructions.iter().any(|(it, at)| *at == instruction && is_same_place(it, &place));
    if !known {
        uses.instructions.push((place, instruction));
    }
}

pub(super) fn add_count(uses: &mut Uses, count: KeptCount) {
    let same = |it: &KeptCount| same_storage(&it.counter, &count.counter) && same_storage(&it.kept, &count.kept);
    if !uses.counts.iter().any(same) {
        uses.counts.push(count);
    }
}

fn find<'p>(block: &'p Block, found: &mut Vec<Call<'p>>) {
    for Statement { kind, at } in block {
        if let StatementKind::Call { callee, instance, arguments, result: _ } = kind {
            found.push(Call { callee: *callee, instance: instance.as_ref(), arguments, at: *at });
        }
        kind.blocks().into_iter().for_each(|inner| find(inner, found));
    }
}
