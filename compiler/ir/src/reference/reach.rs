//! What references may lead to: a set, so that the address of one variable costs nothing where another is used.

use super::{Finder, holds};
use crate::{FieldId, Place, Program, Projection, Root, Statement, StatementKind, StructId, Type};
use std::collections::BTreeSet;

/// The variables that references may lead to, and so read and write: fields of the globals and of states.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Reach {
    /// Those whose addresses are taken, and all variables of the instances in them.
    variables: BTreeSet<(StructId, FieldId)>,
    /// The states that have such variables.
    owners: BTreeSet<StructId>,
}

impl Reach {
    pub fn of(program: &Program) -> Self {
        let mut reach = Self::default();
        if program.references.is_empty() {
            return reach;
        }
        let mut finder = Finder::search(program);
        for (owner, field) in std::mem::take(&mut finder.variables) {
            reach.add(&finder, owner, field);
        }
        reach
    }

    fn add(&mut self, finder: &Finder<'_>, owner: StructId, field: FieldId) {
        if self.variables.insert((owner, field)) {
            self.owners.insert(owner);
            self.add_inside(finder, finder.program.structure(owner).fields[field.index()].ty);
        }
    }

    fn add_inside(&mut self, finder: &Finder<'_>, ty: Type) {
        match ty {
            Type::Struct(id) => {
                let is_state = finder.states.contains(&id);
                for (at, field) in finder.program.structure(id).fields.iter().enumerate() {
                    match is_state {
                        true => self.add(finder, id, FieldId::next(at)),
                        false => self.add_inside(finder, field.ty),
                    }
                }
            }
            Type::Array(id) => self.add_inside(finder, finder.program.array(id).element),
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
        holds(program, ty, &self.owners)
    }

    /// With the variables of states that hold an instance with one.
    pub fn with_holders(self, program: &Program) -> BTreeSet<(StructId, FieldId)> {
        let Self { variables: mut all, owners } = self;
        let states = program.classes.iter().map(|it| it.state).chain([program.globals]);
        for state in states.chain(program.places.iter().copied()) {
            let fields = program.structure(state).fields.iter().enumerate();
            let holders = fields.filter(|(_, it)| holds(program, it.ty, &owners));
            all.extend(holders.map(|(at, _)| (state, FieldId::next(at))));
        }
        all
    }

    /// Whether it has all that another has.
    pub fn covers(&self, other: &Self) -> bool {
        other.variables.is_subset(&self.variables)
    }
}

/// Finds what references of a program may lead to. What is known of the program from here on goes by it: whose addresses
/// are taken must not become more.
pub fn settle(program: &mut Program) {
    program.reached = Some(Reach::of(program));
    for at in 0..program.routines.len() {
        let mut body = std::mem::take(&mut program.routines[at].body);
        let frame = crate::alias::Frame::of(program, &program.routines[at]);
        crate::loops::privatise(&frame, &mut body);
        leave_turns(&mut body);
        program.routines[at].body = body;
    }
}

/// Loops that are short, now that their counters are private, take no turns.
fn leave_turns(block: &mut [Statement]) {
    for statement in block {
        statement.kind.blocks_mut().into_iter().for_each(|it| leave_turns(it));
        if let StatementKind::For(it) = &mut statement.kind
            && it.takes_turns()
            && it.is_short()
        {
            it.body.remove(0);
        }
    }
}
