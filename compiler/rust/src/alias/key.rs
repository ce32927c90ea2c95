//! Which form of a routine a call needs: what of the callee shares storage with what.

use staunch_ir::{FieldId, Program, Projection, RoutineId, Type};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Origin {
    Declared,
    /// A declared POU that is handed the globals that it uses one by one.
    Apart,
    /// A copy of a declared POU in which parameters share storage.
    Copy,
}

/// A callee, and what of it shares storage with what.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Key {
    pub routine: RoutineId,
    /// For the instance, then for each parameter.
    pub bindings: Vec<Binding>,
    pub globals: Globals,
    /// The types of the parameters that a copy gets for shared storage.
    pub groups: Vec<Type>,
}

/// How a routine reaches the globals.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Globals {
    /// It is handed all of them, if it uses any.
    Whole,
    /// It is handed each variable that it uses.
    Apart(Vec<(FieldId, Binding)>),
}

#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Binding {
    /// It is handed over as declared.
    Own,
    /// It is part of what the callee reaches anyway.
    Within { root: SharedRoot, steps: Vec<Step> },
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum SharedRoot {
    Instance,
    Group(usize),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Step {
    Field(FieldId),
    /// The subscript arrives as a parameter.
    Index,
}

impl Key {
    /// The routine as it is declared.
    pub fn declared(routine: RoutineId, params: usize) -> Self {
        Self { routine, bindings: vec![Binding::Own; params + 1], globals: Globals::Whole, groups: Vec::new() }
    }

    pub fn shares(&self) -> bool {
        let apart = match &self.globals {
            Globals::Whole => &[][..],
            Globals::Apart(bindings) => bindings,
        };
        self.bindings.iter().chain(apart.iter().map(|(_, it)| it)).any(|it| *it != Binding::Own)
    }

    pub fn is_apart(&self) -> bool {
        matches!(self.globals, Globals::Apart(_)) && !self.shares()
    }

    pub fn origin(&self) -> Origin {
        match self.globals {
            _ if self.shares() => Origin::Copy,
            Globals::Whole => Origin::Declared,
            Globals::Apart(_) => Origin::Apart,
        }
    }
}

/// The type of a part.
pub fn element(program: &Program, ty: Type, projection: &Projection) -> Type {
    program.part(ty, projection).expect("verified IR: each part exists")
}
