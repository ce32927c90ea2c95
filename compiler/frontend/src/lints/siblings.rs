//! Calls within one expression of which one writes what another one reads: there the order in which operands are evaluated
//! decides.

use crate::types::declarations::Declarations;
use crate::types::siblings::{Touched, touched};
use staunch_ir::{Part, Use};
use std::collections::HashMap;

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
        let read = Touched::reading(it.reads);
        let is_read = first.shared.meets(read.shared) || first.given.meets(read.given);
        if is_read || first.shared.meets(second.shared) || it.share && first.given.meets(second.given) {
            declarations.program.uses.note(Use::Part(Part::EvaluationOrder), it.at);
        }
    }
}
