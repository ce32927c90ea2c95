//! The prescan: what happens to counters before the first scan after a start, a restart or
//! IDLE -> RUN. Logix sets the edge memories of the counters that instructions work on; Cscape
//! gives its retentive counters the counts that were kept.
//!
//! Bodies have noted what they use. A use of what a caller passes is the caller's, so uses move
//! up through calls; then each POU's prescan is built, and runs those of the instances inside.

mod build;
mod kept;
mod named;
mod nest;
mod reach;

use crate::expr::uses::Uses;
use crate::types::declarations::Declarations;
use build::Builder;
use named::reads_param;
use staunch_ir::{Place, Root, Routine, RoutineKind};

/// Adds the prescans, given the slots of the POUs in an order in which a callee is before its
/// callers. `false` if there are none.
pub(super) fn add(declarations: &mut Declarations<'_>, mut uses: Vec<Uses>, order: &[usize]) -> bool {
    if uses.iter().all(|it| it.instructions.is_empty() && it.counts.is_empty()) {
        return false;
    }
    for at in order {
        reach::through_calls(&declarations.program, *at, &mut uses);
    }
    of_their_classes(declarations, &mut uses);
    make_room(declarations);
    let open = nest::open_counts(declarations, &uses);
    kept::check(declarations, &uses, &open);
    for (at, uses) in uses.iter().enumerate() {
        own(declarations, at, uses);
    }
    nest::nest(declarations, &open);
    true
}

/// What a METHOD or ACTION does with its instance, and with globals, is its POU's.
fn of_their_classes(declarations: &Declarations<'_>, uses: &mut [Uses]) {
    for (at, pou) in declarations.pous.iter().enumerate() {
        let Some(owner) = pou.owner else { continue };
        let routine = &declarations.program.routines[at];
        let Uses { instructions, counts, assigned, noted: _ } = std::mem::take(&mut uses[at]);
        for (place, instruction) in instructions.into_iter().filter(|(place, _)| lasts(place) && !reads_param(place)) {
            let place = named::before_calls(&declarations.program, routine, &place);
            reach::add_instruction(&mut uses[owner], place, instruction);
        }
        let (own, passed): (Vec<_>, Vec<_>) = counts.into_iter().partition(|it| lasts(&it.counter) && lasts(&it.kept));
        own.into_iter().for_each(|it| reach::add_count(&mut uses[owner], it));
        uses[at].counts = passed;
        let (own, passed): (Vec<_>, Vec<_>) = assigned.into_iter().partition(|it| lasts(&it.place));
        uses[owner].assigned.extend(own);
        uses[at].assigned = passed;
    }
}

/// Gives each slot an empty prescan.
fn make_room(declarations: &mut Declarations<'_>) {
    let routines = &mut declarations.program.routines;
    let prescan = |it: &Routine| Routine {
        kind: RoutineKind::Prescan,
        doc: None,
        params: Vec::new(),
        locals: Vec::new(),
        result: None,
        body: Vec::new(),
        name: it.name.clone(),
        ..*it
    };
    let prescans: Vec<_> = routines.iter().map(prescan).collect();
    routines.extend(prescans);
}

/// The prescan of what is a POU's own, or global.
fn own(declarations: &mut Declarations<'_>, at: usize, uses: &Uses) {
    match declarations.program.routines[at].kind {
        RoutineKind::Function | RoutineKind::Method => return,
        RoutineKind::Body | RoutineKind::Prescan => {}
    }
    let mut builder = Builder::new(declarations, at);
    for (place, instruction) in uses.instructions.iter().filter(|(place, _)| lasts(place) && !reads_param(place)) {
        builder.instruction(place, *instruction);
    }
    for count in uses.counts.iter().filter(|it| lasts(&it.counter) && lasts(&it.kept)) {
        builder.restore(&count.counter, &count.kept);
    }
    builder.finish().add_to(declarations);
}

/// Whether the place is storage that lasts from scan to scan and has one name.
fn lasts(place: &Place) -> bool {
    matches!(place.root, Root::Instance | Root::Globals)
}
