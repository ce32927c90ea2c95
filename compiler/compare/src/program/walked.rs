//! The variables that a place leads through, by their declarations: one walk for all that ask.
//!
//! All elements of an array are one variable, and so are a member of all instances of a block.

use staunch_ir::{
    BlockId, FieldId, LocalId, ParamId, Place, Program, Projection, Root, Routine, RoutineId, StructId, Type,
};

/// A variable, by its declaration.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Name {
    Field(StructId, FieldId),
    Local(RoutineId, LocalId),
    Param(RoutineId, ParamId),
}

#[derive(Clone, Debug)]
pub struct Walked {
    /// The outermost first.
    pub names: Vec<Name>,
    /// The pin of a standard block, which the last of them is.
    pub pin: Option<(BlockId, FieldId)>,
    /// It leads on through a reference, which the last of them holds.
    pub is_followed: bool,
    /// It leads further, to something without a declaration, as a character of a string.
    is_further: bool,
}

impl Walked {
    pub fn of(program: &Program, (routine, id): (&Routine, RoutineId), place: &Place) -> Self {
        let names = match place.root {
            Root::Instance | Root::Globals => Vec::new(),
            Root::Local(local) => vec![Name::Local(id, local)],
            Root::Param(param) => vec![Name::Param(id, param)],
        };
        let mut found = Self { names, pin: None, is_followed: false, is_further: false };
        let mut ty = program.root_type(routine, place.root);
        for projection in &place.projections {
            ty = match (projection, ty) {
                (Projection::Field(field), Some(Type::Struct(owner))) => {
                    found.names.push(Name::Field(owner, *field));
                    program.member(Type::Struct(owner), *field)
                }
                (Projection::Index { .. }, Some(Type::Array(id))) => Some(program.array(id).element),
                (Projection::Field(pin), Some(Type::Block(block))) => {
                    found.pin = Some((block, *pin));
                    return found;
                }
                (Projection::Deref { .. }, _) => {
                    found.is_followed = true;
                    return found;
                }
                (Projection::Field(_) | Projection::Index { .. }, _) => {
                    found.is_further = true;
                    return found;
                }
            };
        }
        found
    }

    /// The innermost declaration that all of the place is an element of.
    pub fn variable(&self) -> Option<Name> {
        let is_it = self.pin.is_none() && !self.is_followed && !self.is_further;
        self.names.last().copied().filter(|_| is_it)
    }
}
