//! Calls within one expression of which one writes what another one reads: there the order in which operands are evaluated
//! decides.

use crate::dialect::rules::is_followed;
use crate::types::declarations::Declarations;
use crate::types::siblings::{Own, Touched, touched};
use staunch_ir::{Part, Routine, RoutineId, Use};
use std::collections::HashMap;

/// Keeps what a routine touches, where the order of calls may be another one: its body may be dropped.
pub(crate) fn keep(declarations: &mut Declarations<'_>, slot: usize, routine: &Routine) {
    let dialect = declarations.dialect(declarations.pous[slot].ast.name.span);
    if !is_followed(dialect, Part::EvaluationOrder) {
        declarations.touched.insert(RoutineId::next(slot), Own::of(&routine.body));
    }
}

/// Notes each pair whose order decides.
pub(crate) fn note(declarations: &mut Declarations<'_>) {
    let (siblings, bodies) = (std::mem::take(&mut declarations.siblings), std::mem::take(&mut declarations.touched));
    let mut known = HashMap::new();
    for it in siblings {
        let [first, second] = [&it.first, &it.second].map(|ids| {
            let mut all = Touched::default();
            ids.iter().for_each(|id| all.add(touched(&bodies, *id, &mut known)));
            all
        });
        if first.shared.meets(second.shared) || it.share && first.given.meets(second.given) {
            declarations.program.uses.note(Use::Part(Part::EvaluationOrder), it.at);
        }
    }
}
