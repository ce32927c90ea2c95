//! Inputs that are edges: each has a trigger, which sees the input whenever the body of its instance runs.
//! Text of the class reads the trigger's Q by the input's name.

use crate::machine::{Frame, Machine};
use crate::storage::Place;
use crate::types::Type;
use staunch_frontend::ast::Edge;

/// The name that the executors give the trigger of an input.
pub(crate) fn trigger_of(input: &str) -> String {
    format!("{input}_edge")
}

pub(crate) fn block_of(edge: Edge) -> &'static str {
    match edge {
        Edge::Rising => "R_TRIG",
        Edge::Falling => "F_TRIG",
    }
}

impl<'a> Machine<'a> {
    /// Shows each trigger the value that its input has now.
    pub(crate) fn pull_triggers(&mut self, own: &Frame<'a>) {
        for (_, input, trigger) in self.triggers(own) {
            let Type::Block(info) = trigger.ty else { continue };
            let value = self.read(&input);
            if let Some(clock) = self.member(&trigger, "CLK") {
                self.write(&clock, &value);
            }
            self.run_block(&trigger, info, 0, false);
        }
    }

    /// The names of such inputs mean what their triggers saw.
    pub(crate) fn see_edges(&self, own: &mut Frame<'a>) {
        for (name, _, trigger) in self.triggers(own) {
            own.names.extend(self.member(&trigger, "Q").map(|it| (name, it)));
        }
    }

    /// The inputs that a body sees through a trigger: their names, places, and triggers.
    fn triggers(&self, own: &Frame<'a>) -> Vec<(String, Place<'a>, Place<'a>)> {
        let Some((_, instance)) = &own.this else { return Vec::new() };
        let Type::Record(record) = &instance.ty else { return Vec::new() };
        let inputs = record.fields.iter().zip(0..).filter(|(it, _)| record.edges.contains(&it.0));
        let known = inputs.filter_map(|((name, _), at)| {
            let name = name.to_ascii_uppercase();
            let (input, trigger) = (instance.field(at)?, instance.field(at + 1)?);
            // A variable of a METHOD hides them.
            (own.names.get(&name)?.at == input.at).then_some((name, input, trigger))
        });
        known.collect()
    }
}
