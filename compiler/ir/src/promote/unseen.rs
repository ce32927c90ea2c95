//! What of the state a loop shows to others while it runs: to the routines that it calls, and by references.

use crate::alias::{Alias, Frame, alias};
use crate::effects::Effects;
use crate::visit;
use crate::{ExprKind, Place, Root, RoutineId, Statement, StatementKind, Type};

/// Who else may see variables while a loop runs.
pub(super) struct Others<'a> {
    frame: &'a Frame<'a>,
    /// The global variables that the routines know which the loop calls, and what it takes the addresses of.
    known: Vec<Place>,
    /// Whether there may be someone who follows a reference, or is given a new one.
    follow: bool,
}

impl<'a> Others<'a> {
    pub(super) fn of(frame: &'a Frame<'a>, effects: &[Effects], statement: &Statement) -> Self {
        let mut callees: Vec<RoutineId> = Vec::new();
        let mut known: Vec<Place> = Vec::new();
        visit::statements(std::slice::from_ref(statement), &mut |it| {
            if let StatementKind::Call { callee, .. } = &it.kind {
                callees.push(*callee);
            }
            visit::all_exprs(it, &mut |it| {
                if let ExprKind::AddressOf(place) = &it.kind {
                    known.push((**place).clone());
                }
            });
        });
        callees.sort_unstable();
        callees.dedup();
        let follow = !callees.is_empty() || !known.is_empty();
        let globals = frame.program.globals;
        let fields = &frame.program.structure(globals).fields;
        let root = || Place::root(Root::Globals, Type::Struct(globals));
        let named = callees.iter().flat_map(|it| effects[it.index()].names.globals());
        known.extend(named.map(|it| root().field(it, fields[it.index()].ty)));
        Self { frame, known, follow }
    }

    /// What a callee is handed, it has by a place of the loop itself: whoever asks compares with those.
    pub(super) fn do_not_see(&self, place: &Place) -> bool {
        let is_led_to = self.follow && self.frame.is_reached(place);
        !is_led_to && self.known.iter().all(|it| alias(self.frame, it, place) == Alias::No)
    }
}
