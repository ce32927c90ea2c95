//! Expressions: typed trees that read, compute or fault.

use crate::{Chars, Const, Elementary, Location, Op, Place, TextOp, Type, Value};

/// A value with its type. Reads, computes or faults; changes nothing.
#[derive(Clone, Debug)]
pub struct Expr {
    pub ty: Type,
    pub kind: ExprKind,
    /// Where a fault in this node (not in its operands) is reported.
    pub at: Location,
}

#[derive(Clone, Debug)]
pub enum ExprKind {
    /// An elementary or enumeration constant, in the repr of the expression's type.
    Const(Value),
    /// A string constant no longer than the capacity of the expression's type.
    Text(Chars),
    /// An array or structure constant.
    Aggregate(Const),
    /// Reads a place of the expression's type, or of a subrange that is made of it.
    Load(Place),
    /// A reference to a place.
    AddressOf(Box<Place>),
    /// An operation at `repr`: that of each operand and the result which the operation's row
    /// calls `T`. Operands of a comparison may be enumerations; both then have one type.
    Apply(Op, Vec<Expr>),
    /// A string function, for STRINGs or WSTRINGs as its operands are. A string result is cut at the
    /// capacity of the expression's type.
    ApplyText(TextOp, Vec<Expr>),
    /// A change of type: between elementary types, from or to an enumeration through its base
    /// type, between the capacities of STRINGs, and of WSTRINGs.
    Convert(Conversion, Box<Expr>),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Conversion {
    /// `staunch_runtime::ops::convert`: integers keep their low bits, reals round to nearest
    /// (ties to even) and saturate, BOOL is `<> 0` one way and 0 or 1 the other. Between
    /// strings: cut at the capacity.
    Value,
    /// `staunch_runtime::ops::trunc`: a real toward zero, saturating.
    Truncate,
    /// Same repr, other type: WORD and UINT, LINT and TIME, an enumeration and its base.
    Same,
    /// `staunch_runtime::ops::same_bits`: between a real and an unsigned number of its width.
    Bits,
}

impl Expr {
    pub fn new(ty: Type, kind: ExprKind, at: Location) -> Self {
        Self { ty, kind, at }
    }

    pub fn constant(ty: Elementary, value: Value, at: Location) -> Self {
        Self::new(Type::Elementary(ty), ExprKind::Const(value), at)
    }

    pub fn bool(value: bool, at: Location) -> Self {
        Self::constant(Elementary::Bool, Value::Bool(value), at)
    }

    pub fn load(place: Place, at: Location) -> Self {
        Self::new(place.ty, ExprKind::Load(place), at)
    }

    /// The same value, of the type that its subrange is made of.
    #[must_use]
    pub fn read(self) -> Self {
        Self { ty: self.ty.read(), ..self }
    }

    pub fn apply(op: Op, ty: Type, operands: Vec<Self>, at: Location) -> Self {
        Self::new(ty, ExprKind::Apply(op, operands), at)
    }

    pub fn convert(how: Conversion, ty: Type, value: Self, at: Location) -> Self {
        Self::new(ty, ExprKind::Convert(how, Box::new(value)), at)
    }

    /// The type of the variable that is read, where the expression is nothing more; else its own.
    pub fn declared(&self) -> Type {
        match &self.kind {
            ExprKind::Load(place) => place.ty,
            ExprKind::Const(_)
            | ExprKind::Text(_)
            | ExprKind::Aggregate(_)
            | ExprKind::AddressOf(_)
            | ExprKind::Apply(..)
            | ExprKind::ApplyText(..)
            | ExprKind::Convert(..) => self.ty,
        }
    }

    /// The value, when the expression is an elementary or enumeration constant.
    pub fn as_const(&self) -> Option<Value> {
        match &self.kind {
            ExprKind::Const(value) => Some(*value),
            ExprKind::Text(_)
            | ExprKind::Aggregate(_)
            | ExprKind::Load(_)
            | ExprKind::AddressOf(_)
            | ExprKind::Apply(..)
            | ExprKind::ApplyText(..)
            | ExprKind::Convert(..) => None,
        }
    }
}
