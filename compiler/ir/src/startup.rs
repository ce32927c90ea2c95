//! What a power cycle, IDLE -> RUN and a reset leave of each variable, by the system of the file
//! that declares it. The map has it for hosts, and the front end builds prescans by it.

use crate::{FieldId, Place, Program, Projection, Retain, Routine, StructId, Type};
use staunch_runtime::{BlockInfo, Keeps, Pin, Retention};
use std::collections::BTreeSet;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Event {
    /// The power fails and comes back.
    PowerCycle,
    /// IDLE -> RUN, STOP -> RUN.
    Run,
    /// The user resets the program, and what is retained stays: a warm reset.
    Reset,
}

/// What an event does to a variable.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fate {
    /// What it does to that of which the variable is a part; alone it starts anew.
    Inherited,
    /// It is kept, but for parts that say otherwise.
    Kept,
    /// It starts anew, also inside of what is kept.
    Anew,
    /// It is kept with all that is inside.
    Whole,
}

impl Fate {
    /// What holds for a part of something.
    #[must_use]
    pub fn within(self, whole: Self) -> Self {
        match (whole, self) {
            (Self::Whole, _) => Self::Whole,
            (_, Self::Inherited) => whole,
            (_, Self::Kept | Self::Anew | Self::Whole) => self,
        }
    }

    pub fn is_kept(self) -> bool {
        matches!(self, Self::Kept | Self::Whole)
    }
}

/// The rules of one program.
#[derive(Clone, Debug)]
pub struct Startup<'p> {
    program: &'p Program,
    /// The structures whose fields are variables; those of other structures are parts of variables.
    of_variables: BTreeSet<StructId>,
}

impl<'p> Startup<'p> {
    pub fn new(program: &'p Program) -> Self {
        let states = program.routines.iter().filter_map(|it| it.state);
        Self { program, of_variables: states.chain([program.globals]).collect() }
    }

    /// What an event does to a field of a structure, as far as the field itself says.
    pub fn field(&self, owner: StructId, id: FieldId, event: Event) -> Fate {
        let field = &self.program.structure(owner).fields[id.index()];
        if self.is_retentive(field.ty) {
            return Fate::Whole;
        }
        let system = self.program.files[usize::from(field.location.file)].system;
        let keeps = match event {
            // No system starts more variables anew in a warm reset than in a power cycle.
            Event::PowerCycle | Event::Reset => system.over_power_cycle(),
            Event::Run => system.over_run(),
        };
        match (keeps, field.retain) {
            (Keeps::Everything, _) if self.of_variables.contains(&owner) => Fate::Whole,
            // An address is not data that outlives the program.
            _ if self.is_reference(field.ty) => Fate::Anew,
            (_, Retain::Inherited) => Fate::Inherited,
            (_, Retain::Kept) => Fate::Kept,
            (_, Retain::Anew) => Fate::Anew,
        }
    }

    /// What an event does to the place of a routine, by the declarations on the way to it.
    pub fn place(&self, routine: &Routine, place: &Place, event: Event) -> Fate {
        let mut ty = self.program.root_type(routine, place.root);
        let mut fate = Fate::Inherited;
        for projection in &place.projections {
            ty = match (projection, ty) {
                (Projection::Field(field), Some(Type::Struct(id))) => {
                    fate = self.field(id, *field, event).within(fate);
                    Some(self.program.structure(id).fields[field.index()].ty)
                }
                (Projection::Index { .. }, Some(Type::Array(id))) => Some(self.program.array(id).element),
                // What a reference leads to is what its own declaration says, which is not known.
                (Projection::Deref { .. }, _) => return Fate::Inherited,
                // A pin of a standard block.
                (Projection::Field(_) | Projection::Index { .. }, _) => return fate,
            };
        }
        fate
    }

    fn is_reference(&self, ty: Type) -> bool {
        match ty {
            Type::Reference(_) => true,
            Type::Array(id) => self.is_reference(self.program.array(id).element),
            Type::Elementary(_)
            | Type::Subrange(..)
            | Type::String(_)
            | Type::Enum(_)
            | Type::Struct(_)
            | Type::Block(_) => false,
        }
    }

    /// Whether the instances of a type are kept whatever their declarations say.
    fn is_retentive(&self, ty: Type) -> bool {
        match ty {
            Type::Block(id) => id.info().retention == Retention::Always,
            Type::Array(id) => self.is_retentive(self.program.array(id).element),
            Type::Elementary(_)
            | Type::Reference(_)
            | Type::Subrange(..)
            | Type::String(_)
            | Type::Enum(_)
            | Type::Struct(_) => false,
        }
    }
}

/// What every event that starts variables anew does to a pin of a standard block.
pub fn pin(info: &BlockInfo, pin: &Pin) -> Fate {
    if info.retention.restarts(pin) { Fate::Anew } else { Fate::Inherited }
}
