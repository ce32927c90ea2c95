//! What a program's statements say of its inputs: the constants that each is compared with, and
//! whether it is compared with constants alone.
//!
//! Variables are distinguished by their declarations. A fact about one holds for each instance of it.

mod numbers;

mod found;

mod table;
mod walk;

mod compared;

pub use found::Facts;
pub use numbers::Numbers;

use super::walked::Name;
use numbers::Number;
use staunch_ir::{Expr, FieldId, Program, RoutineId, StructId};
use std::collections::HashMap;
use walk::Walk;

/// Assignments in a row, through which a limit of the last target is followed back.
const MAX_BACK: usize = 4;
/// Limits of one variable that are followed back.
const MAX_LIMITS: usize = 24;

impl Facts {
    /// With arrays that nothing writes as tables of constants, so that what they are indexed with is compared.
    pub fn of(program: &Program) -> Self {
        let first = Self::with(program, HashMap::new());
        let tables = table::find(program, &first);
        if tables.is_empty() { first } else { Self::with(program, tables) }
    }

    /// Where the world outside writes arrays that no statement does.
    pub fn without_tables(program: &Program) -> Self {
        Self::with(program, HashMap::new())
    }

    fn with(program: &Program, tables: HashMap<Name, Vec<i128>>) -> Self {
        let mut facts = Self { tables, ..Self::default() };
        let mut computed = Vec::new();
        for (at, routine) in program.routines.iter().enumerate() {
            let id = RoutineId::next(at);
            let mut walk = Walk { program, routine, id, facts: &mut facts, computed: Vec::new() };
            walk.block(&routine.body);
            computed.extend(walk.computed.into_iter().map(|(target, value)| (id, target, value)));
            routine.locals.iter().for_each(|it| facts.initial(Some(it.ty), &it.initial));
        }
        let fields = program.structs.iter().flat_map(|it| &it.fields);
        fields.for_each(|it| facts.initial(Some(it.ty), &it.initial));
        for (id, layout) in program.structs.iter().enumerate() {
            for (at, field) in layout.fields.iter().enumerate() {
                let name = Name::Field(StructId::next(id), FieldId::next(at));
                facts.unwritten(program, name, field.ty, &field.initial);
            }
        }
        facts.follow();
        for _ in 0..MAX_BACK {
            facts.go_back(program, &computed);
        }
        facts
    }

    /// Takes the limits of what is computed back to what it is computed from.
    fn go_back(&mut self, program: &Program, computed: &[(RoutineId, Name, &Expr)]) {
        let mut found = Self::default();
        for (id, target, value) in computed {
            let routine = program.routine(*id);
            let limits = self.worth_trying(*target);
            let integers = limits.integers.into_iter().map(Number::Integer);
            let limits: Vec<_> = integers.chain(limits.reals.into_iter().map(Number::Real)).take(MAX_LIMITS).collect();
            let texts = self.texts(*target);
            let mut walk = Walk { program, routine, id: *id, facts: &mut found, computed: Vec::new() };
            limits.iter().for_each(|it| walk.compared(value, *it));
            texts.iter().for_each(|it| walk.reaches(value, it));
        }
        // As they are: what is assigned, or handed to a call.
        for (from, to) in &self.flows {
            if let Some(more) = self.hints.get(to) {
                found.near.entry(*from).or_default().add_all(more.clone());
            }
        }
        for (name, numbers) in found.near {
            self.hints.entry(name).or_default().add_all(numbers);
        }
        for (name, texts) in found.texts {
            texts.iter().for_each(|it| _ = self.near_to_text(name, it));
        }
        for (from, to) in self.flows.clone() {
            self.texts(to).iter().for_each(|it| _ = self.near_to_text(from, it));
        }
    }

    /// What is known of a variable is known of those whose values go to it.
    fn follow(&mut self) {
        let mut changed = true;
        while changed {
            changed = false;
            for (from, to) in self.flows.clone() {
                if self.computed.contains(&to) {
                    changed |= self.computed.insert(from);
                }
                let theirs = self.near(to);
                let ours = self.near.entry(from).or_default();
                let before = (ours.integers.len(), ours.reals.len());
                ours.add_all(theirs);
                changed |= before != (ours.integers.len(), ours.reals.len());
                for text in self.texts(to) {
                    changed |= self.near_to_text(from, &text);
                }
            }
        }
    }
}
