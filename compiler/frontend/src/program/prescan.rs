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
    make_room(declarations);
    let open = nest::open_counts(declarations, &uses);
    kept::check(declarations, &uses, &open);
    for (at, uses) in uses.iter().enumerate() {
        own(declarations, at, uses);
    }
    nest::nest(declarations, &open);
    true
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
    if declarations.program.routines[at].kind == RoutineKind::Function {
        return;
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
