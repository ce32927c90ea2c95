//! Places: the storage that a statement or expression names.

use crate::{Expr, FieldId, LocalId, Location, ParamId, Type};

/// Storage: a root and the way from it to the part that is meant.
#[derive(Clone, Debug)]
pub struct Place {
    pub root: Root,
    pub projections: Vec<Projection>,
    /// The type of the part.
    pub ty: Type,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Root {
    /// The state of the PROGRAM or FUNCTION_BLOCK instance whose body this is.
    Instance,
    /// The global variables.
    Globals,
    /// A variable that lives for one call: VAR_TEMP, a function's variables, inputs and result.
    Local(LocalId),
    /// What a by-reference parameter refers to: VAR_IN_OUT, a function's VAR_OUTPUT.
    Param(ParamId),
}

#[derive(Clone, Debug)]
pub enum Projection {
    /// A field of a structure, or a pin (by its position) of a standard block.
    Field(FieldId),
    /// An element of an array. `index` is a LINT in the array's own bounds; outside of them it
    /// faults with IndexOutOfRange at `at`.
    Index { index: Box<Expr>, at: Location },
    /// The target of the reference that the place up to here holds. Only the final target is
    /// checked: null, outside of the object, misaligned, and a view that is not allowed fault at `at`. In a FUNCTION
    /// that may be `Location::CALLER`: then they fault at the call.
    Deref { reference: Type, target: Type, at: Location },
}

impl Projection {
    /// Whether it follows a reference, and a fault of that is at the place of the call of its routine.
    pub fn faults_at_call(&self) -> bool {
        match self {
            Self::Deref { at, .. } => *at == Location::CALLER,
            Self::Field(_) | Self::Index { .. } => false,
        }
    }
}

impl Place {
    pub fn root(root: Root, ty: Type) -> Self {
        Self { root, projections: Vec::new(), ty }
    }

    pub fn local(local: LocalId, ty: Type) -> Self {
        Self::root(Root::Local(local), ty)
    }

    #[must_use]
    pub fn field(mut self, field: FieldId, ty: Type) -> Self {
        self.projections.reserve_exact(1);
        self.projections.push(Projection::Field(field));
        self.ty = ty;
        self
    }

    #[must_use]
    pub fn index(mut self, index: Expr, element: Type, at: Location) -> Self {
        self.projections.reserve_exact(1);
        self.projections.push(Projection::Index { index: Box::new(index), at });
        self.ty = element;
        self
    }

    #[must_use]
    pub fn deref(mut self, target: Type, at: Location) -> Self {
        self.projections.reserve_exact(1);
        self.projections.push(Projection::Deref { reference: self.ty, target, at });
        self.ty = target;
        self
    }

    /// Whether the way leads through a reference.
    pub fn is_followed(&self) -> bool {
        self.projections.iter().any(|it| matches!(it, Projection::Deref { .. }))
    }

    /// The way up to a projection, to something of type `ty`.
    #[must_use]
    pub fn before(&self, position: usize, ty: Type) -> Self {
        Self { root: self.root, projections: self.projections[..position].to_vec(), ty }
    }

    /// The indices on the way, from left to right.
    pub fn indices(&self) -> impl Iterator<Item = &Expr> {
        self.projections.iter().filter_map(|it| match it {
            Projection::Index { index, .. } => Some(&**index),
            Projection::Field(_) | Projection::Deref { .. } => None,
        })
    }

    /// Whether both are one variable, or one member of it. Places with subscripts are not compared.
    pub fn is_same_variable(&self, other: &Self) -> bool {
        let field = |it: &Projection| match it {
            Projection::Field(id) => Some(*id),
            Projection::Index { .. } | Projection::Deref { .. } => None,
        };
        let same = |(a, b)| field(a).is_some() && field(a) == field(b);
        self.root == other.root
            && self.projections.len() == other.projections.len()
            && self.projections.iter().zip(&other.projections).all(same)
    }
}
