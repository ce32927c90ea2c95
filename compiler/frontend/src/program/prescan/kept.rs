//! The rules on RCV, the variable that keeps a Cscape counter's count, where they span calls: it is
//! one counter's alone, no one else writes it, and it is RETAIN.

use super::nest::{OpenCounts, fate, kept_from_outside};
use crate::Span;
use crate::expr::uses::{
    Assigned, KeptCount, Uses, assigned_count, is_element_by_element, lost_count, same_storage, several_counts,
    shared_count,
};
use crate::types::declarations::{Declarations, Slot};
use crate::types::signature::Target;
use staunch_ir::Root;
use staunch_ir::alias::may_hold;
use staunch_ir::startup::Startup;
use std::collections::HashSet;

pub(super) fn check(declarations: &mut Declarations<'_>, uses: &[Uses], open: &OpenCounts) {
    let keeping = keeping_parameters(declarations, uses);
    for (at, own) in uses.iter().enumerate() {
        for (number, count) in own.counts.iter().enumerate() {
            shared(declarations, count, &own.counts[..number]);
            if count.through.is_some() && !is_element_by_element(&count.counter, &count.kept) {
                declarations.report(several_counts(place_of(declarations, count)));
            }
            assigned(declarations, count, at, uses, &keeping);
        }
    }
    lost(declarations, uses, open);
}

/// Two counters on one variable, at least one of which is in a called POU.
fn shared(declarations: &mut Declarations<'_>, count: &KeptCount, before: &[KeptCount]) {
    let other = before.iter().find(|it| {
        (it.through.is_some() || count.through.is_some())
            && same_storage(&it.kept, &count.kept)
            && !same_storage(&it.counter, &count.counter)
    });
    let Some(other) = other else { return };
    let (here, first) = (place_of(declarations, count), place_of(declarations, other));
    declarations.report(shared_count(here, first));
}

/// Where a reader sees that the count is kept: the call, or the RCV itself.
fn place_of(declarations: &Declarations<'_>, count: &KeptCount) -> Span {
    count.through.map_or(count.span, |at| declarations.log.name_at(at))
}

/// The declarations of VAR_IN_OUTs that are given as an RCV.
fn keeping_parameters(declarations: &Declarations<'_>, uses: &[Uses]) -> HashSet<Span> {
    let mut keeping = HashSet::new();
    for (slot, uses) in declarations.pous.iter().zip(uses) {
        let Slot::Done(signature) = &slot.slot else { continue };
        for count in &uses.counts {
            let Root::Param(id) = count.kept.root else { continue };
            let formal = signature.formals.iter().find(|it| it.target == Target::Param(id.index()));
            keeping.extend(formal.map(|it| it.name.span));
        }
    }
    keeping
}

/// An assignment in the POU that passes the variable; of a global one, in any.
fn assigned(declarations: &mut Declarations<'_>, count: &KeptCount, at: usize, uses: &[Uses], keeping: &HashSet<Span>) {
    let is_own = count.through.is_none();
    // What a body does to its own counters has been checked with it.
    let is_visible = |pou: usize| if pou == at { !is_own } else { count.kept.root == Root::Globals };
    let visible = uses.iter().enumerate().filter(|(pou, _)| is_visible(*pou)).flat_map(|(_, it)| &it.assigned);
    let writes = |it: &Assigned| !it.passed_for.is_some_and(|it| keeping.contains(&it));
    let mut found = visible.filter(|it| writes(it) && may_hold(&it.place, &count.kept));
    if let Some(it) = found.next() {
        declarations.report(assigned_count(it.span, place_of(declarations, count)));
    }
}

/// Counts of blocks that nothing around them keeps over a restart.
fn lost(declarations: &mut Declarations<'_>, uses: &[Uses], open: &OpenCounts) {
    let mut kept: HashSet<Span> = kept_from_outside(declarations, open).map(|it| it.span).collect();
    let all = || uses.iter().enumerate().flat_map(|(at, it)| it.counts.iter().map(move |count| (at, count)));
    let (program, startup) = (&declarations.program, Startup::new(&declarations.program));
    kept.extend(all().filter(|(at, it)| fate(&startup, program, *at, it).is_kept()).map(|(_, it)| it.span));
    let mut told = HashSet::new();
    let lost: Vec<_> = all().filter(|(_, it)| !it.told && !kept.contains(&it.span)).map(|(_, it)| it.span).collect();
    for span in lost {
        if told.insert(span) {
            declarations.report(lost_count(span));
        }
    }
}
