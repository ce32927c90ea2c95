//! A call and the references it hands over; which copy of its callee it needs.

use staunch_ir::{Argument, FieldId, Location, Place, Program, Projection, Routine, RoutineId};

use super::key::{Binding, Globals, Key, SharedRoot, Step};
use super::overlap::{Ancestor, Slot, overlap};
use super::rewrite::Body;

#[derive(Clone)]
pub struct Call {
    pub callee: RoutineId,
    pub instance: Option<Place>,
    pub arguments: Vec<Argument>,
    /// The globals that the callee is handed one by one.
    pub globals: Vec<(FieldId, Place)>,
    pub result: Option<Place>,
    pub at: Location,
}

impl Call {
    /// What the callee may write through: the instance (0), parameters from 1, and then globals.
    pub fn references(&self) -> Vec<Slot<'_>> {
        let instance = self.instance.iter().map(|place| Slot { number: 0, place });
        let arguments = self.arguments.iter().enumerate().filter_map(|(at, argument)| match argument {
            Argument::Reference(place) => Some(Slot { number: at + 1, place }),
            Argument::Value(_) => None,
        });
        let first = self.arguments.len() + 1;
        let globals = self.globals.iter().enumerate().map(|(at, (_, place))| Slot { number: first + at, place });
        instance.chain(arguments).chain(globals).collect()
    }

    /// Whether a value, or a subscript, is read from storage that an argument before it borrows.
    pub fn reads_borrowed(&self) -> bool {
        let mut borrowed: Vec<&Place> = Vec::new();
        let mut conflict = false;
        for argument in &self.arguments {
            let mut see = |read: &Place| conflict |= borrowed.iter().any(|it| overlap(it, read));
            match argument {
                Argument::Value(value) => staunch_ir::visit::reads(value, &mut see),
                Argument::Reference(place) => {
                    staunch_ir::visit::index_reads(place, &mut see);
                    borrowed.push(place);
                }
            }
        }
        conflict
    }

    /// The copy this call needs, and what is handed to the copy's shared parameters.
    pub fn key(&self, callee: &Routine, ancestors: &[Ancestor], body: &Body, program: &Program) -> (Key, Vec<Place>) {
        let mut bindings = vec![Binding::Own; callee.params.len() + 1 + self.globals.len()];
        let (mut types, mut groups) = (Vec::new(), Vec::new());
        let references = self.references();
        for ancestor in ancestors {
            let root = match ancestor.shared_root(&references) {
                Some(root) => root,
                None => {
                    let place = ancestor.place(program, body.root_type(program, ancestor.root));
                    types.push(place.ty);
                    groups.push(place);
                    SharedRoot::Group(groups.len() - 1)
                }
            };
            for slot in references.iter().filter(|slot| ancestor.slots.contains(&slot.number)) {
                // The instance that contains the others stays the callee's own.
                if !(root == SharedRoot::Instance && slot.number == 0) {
                    let steps = slot.place.projections[ancestor.prefix.len()..].iter().map(step).collect();
                    bindings[slot.number] = Binding::Within { root, steps };
                }
            }
        }
        let apart = bindings.split_off(callee.params.len() + 1);
        let globals = if apart.is_empty() {
            Globals::Whole
        } else {
            Globals::Apart(self.globals.iter().map(|(field, _)| *field).zip(apart).collect())
        };
        (Key { routine: self.callee, bindings, globals, groups: types }, groups)
    }
}

fn step(projection: &Projection) -> Step {
    match projection {
        Projection::Field(field) => Step::Field(*field),
        Projection::Index { .. } => Step::Index,
        Projection::Deref { .. } => unreachable!("programs with references share their storage in cells"),
    }
}
