//! What references may lead to: a set, so that the address of one variable costs nothing where another is used.

use crate::{FieldId, Place, Program, Projection, Root, StructId, Type};
use std::collections::BTreeSet;

/// The variables that references may lead to, and so read and write: fields of the globals and of states.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Reached {
    /// Those whose addresses are taken, and all variables of the instances in them.
    variables: BTreeSet<(StructId, FieldId)>,
    /// The states that have such variables.
    owners: BTreeSet<StructId>,
}

impl Reached {
    /// By the variables whose addresses are taken. A type of which `is_state` holds is an instance's state.
    pub fn by(
        program: &Program,
        variables: BTreeSet<(StructId, FieldId)>,
        is_state: &dyn Fn(StructId) -> bool,
    ) -> Self {
        let mut reached = Self::default();
        for (owner, field) in variables {
            reached.add(program, is_state, owner, field);
        }
        reached.add_around(program, is_state);
        reached
    }

    /// A reference to the first variable of an instance may be followed as one to the instance, or to what that is the
    /// first part of, where the program has references to what holds such instances.
    fn add_around(&mut self, program: &Program, is_state: &dyn Fn(StructId) -> bool) {
        let mut before = None;
        while before != Some(self.variables.len()) {
            before = Some(self.variables.len());
            let targets = || program.references.iter().map(|it| it.target);
            let is_around = |it: &StructId| targets().any(|ty| program.holds(ty, |part| part == Type::Struct(*it)));
            let around: BTreeSet<StructId> = self.owners.iter().copied().filter(is_around).collect();
            let holds = |ty| program.holds(ty, |it| matches!(it, Type::Struct(id) if around.contains(&id)));
            for target in targets().filter(|it| holds(*it)) {
                self.add_inside(program, is_state, target);
            }
            for owner in (0..program.structs.len()).map(StructId::next).filter(|it| is_state(*it)) {
                for (at, field) in program.structure(owner).fields.iter().enumerate() {
                    if holds(field.ty) {
                        self.add(program, is_state, owner, FieldId::next(at));
                    }
                }
            }
        }
    }

    fn add(&mut self, program: &Program, is_state: &dyn Fn(StructId) -> bool, owner: StructId, field: FieldId) {
        if self.variables.insert((owner, field)) {
            self.owners.insert(owner);
            self.add_inside(program, is_state, program.structure(owner).fields[field.index()].ty);
        }
    }

    fn add_inside(&mut self, program: &Program, is_state: &dyn Fn(StructId) -> bool, ty: Type) {
        match ty {
            Type::Struct(id) => {
                for (at, field) in program.structure(id).fields.iter().enumerate() {
                    match is_state(id) {
                        true => self.add(program, is_state, id, FieldId::next(at)),
                        false => self.add_inside(program, is_state, field.ty),
                    }
                }
            }
            Type::Array(id) => self.add_inside(program, is_state, program.array(id).element),
            Type::Elementary(_)
            | Type::Subrange(..)
            | Type::Reference(_)
            | Type::String(_)
            | Type::Enum(_)
            | Type::Block(_) => {}
        }
    }

    /// Whether a reference may lead to a place of a routine, to a part of it, or to what it is a part of. The routine's
    /// state is `state`.
    pub fn holds(&self, program: &Program, state: Option<StructId>, place: &Place) -> bool {
        let mut ty = match (place.root, state) {
            (Root::Globals, _) => Type::Struct(program.globals),
            (Root::Instance, Some(state)) => Type::Struct(state),
            // A local whose address is taken has fixed storage among the globals.
            (Root::Local(_), _) => return place.is_followed(),
            (Root::Instance, None) | (Root::Param(_), _) => return true,
        };
        for projection in &place.projections {
            match (projection, ty) {
                (Projection::Deref { .. }, _) => return true,
                (Projection::Field(field), Type::Struct(owner)) if self.variables.contains(&(owner, *field)) => {
                    return true;
                }
                (Projection::Field(_) | Projection::Index { .. }, _) => {}
            }
            match program.part(ty, projection) {
                Some(part) => ty = part,
                None => return true,
            }
        }
        self.is_owner_in(program, ty)
    }

    /// With the variables of states that hold an instance with one.
    pub fn with_holders(&self, program: &Program) -> BTreeSet<(StructId, FieldId)> {
        let mut all = self.variables.clone();
        let states = program.classes.iter().map(|it| it.state).chain([program.globals]);
        for state in states.chain(program.places.iter().copied()) {
            let fields = program.structure(state).fields.iter().enumerate();
            let holders = fields.filter(|(_, it)| self.is_owner_in(program, it.ty));
            all.extend(holders.map(|(at, _)| (state, FieldId::next(at))));
        }
        all
    }

    /// Whether a variable of the type is, or holds, an instance with such a variable.
    fn is_owner_in(&self, program: &Program, ty: Type) -> bool {
        program.holds(ty, |it| matches!(it, Type::Struct(id) if self.owners.contains(&id)))
    }

    /// Whether it has all that another has.
    pub fn covers(&self, other: &Self) -> bool {
        other.variables.is_subset(&self.variables)
    }
}
