//! Places: their contents, their type, and whether they may be written.

use super::Verifier;
use super::statement::Body;
use crate::{FieldId, Location, Place, Projection, RefKind, RefType, Root, RoutineKind, Type};

impl Verifier<'_> {
    /// `place` exists and has the type it says.
    pub(super) fn place(&mut self, body: &Body, place: &Place, at: Location) {
        let Some(mut ty) = self.root(body, place.root, at) else { return };
        let mut is_pin = false;
        for projection in &place.projections {
            is_pin = matches!(ty, Type::Block(_));
            let part = match projection {
                Projection::Field(field) => self.field(ty, *field, at),
                Projection::Index { index, at } => {
                    self.location(*at);
                    self.expr_of(body, index, Type::LINT);
                    self.element(ty, *at)
                }
                Projection::Deref { reference, target, at } => self.target(ty, *reference, *target, *at),
            };
            let Some(part) = part else { return };
            ty = part;
        }
        let may_fault_at_call = body.routine.kind == RoutineKind::Function;
        let faults_at_call = place.projections.iter().any(Projection::faults_at_call);
        self.require(!faults_at_call || may_fault_at_call, at, "a fault at the call of what is no FUNCTION");
        let same = ty == place.ty || is_pin && Self::same_repr(ty, place.ty);
        self.require(same, at, format_args!("a place of type {ty:?} that says {:?}", place.ty));
    }

    /// A pin has a repr; whether it is a WORD or a UINT is for the front end to say.
    fn same_repr(pin: Type, says: Type) -> bool {
        Self::elementary_repr(pin) == Self::elementary_repr(says)
    }

    fn root(&mut self, body: &Body, root: Root, at: Location) -> Option<Type> {
        let ty = self.program.root_type(body.routine, root).filter(|_| body.refers(root));
        self.require(ty.is_some(), at, format_args!("no such storage: {root:?}"));
        ty
    }

    fn field(&mut self, ty: Type, field: FieldId, at: Location) -> Option<Type> {
        let member = self.program.member(ty, field);
        self.require(member.is_some(), at, format_args!("{ty:?} has no member {}", field.0));
        member
    }

    fn element(&mut self, ty: Type, at: Location) -> Option<Type> {
        let Type::Array(id) = ty else {
            self.report(at, format_args!("an index into {ty:?}"));
            return None;
        };
        Some(self.program.array(id).element)
    }

    /// What a reference leads to is of the type that it says.
    fn target(&mut self, ty: Type, reference: Type, target: Type, at: Location) -> Option<Type> {
        self.location(at);
        let declared = match ty {
            Type::Reference(id) => self.program.references.get(id.index()),
            Type::Elementary(_)
            | Type::Subrange(..)
            | Type::String(_)
            | Type::Enum(_)
            | Type::Array(_)
            | Type::Struct(_)
            | Type::Block(_) => None,
        };
        let holds = ty == reference && declared.is_some_and(|it| it.target == target || self.may_be(*it, target));
        self.require(holds, at, format_args!("{ty:?} does not refer to {target:?}")).then_some(target)
    }

    /// Whether a reference may lead to an instance whose class it does not name: any access checks that.
    fn may_be(&self, reference: RefType, target: Type) -> bool {
        let is_instance = |ty| matches!(ty, Type::Struct(id) if self.program.class_of_state(id).is_some());
        is_instance(target) && (matches!(reference.kind, RefKind::Interface(_)) || is_instance(reference.target))
    }

    /// `place` exists, has the type it says, and no part of the way to it is constant.
    pub(super) fn writable(&mut self, body: &Body, place: &Place, at: Location) {
        let before = self.violations.len();
        self.place(body, place, at);
        if self.violations.len() == before {
            let constant = self.is_constant(body, place);
            self.require(!constant, at, "a write to a constant");
        }
    }

    fn is_constant(&mut self, body: &Body, place: &Place) -> bool {
        let Some(mut ty) = self.root(body, place.root, Location::default()) else { return false };
        for projection in &place.projections {
            let part = match projection {
                Projection::Field(field) => {
                    if let Type::Struct(id) = ty
                        && self.program.structure(id).fields[field.index()].constant
                    {
                        return true;
                    }
                    self.program.member(ty, *field)
                }
                Projection::Index { at, .. } => self.element(ty, *at),
                // A constant's address is not taken.
                Projection::Deref { target, .. } => Some(*target),
            };
            let Some(part) = part else { return false };
            ty = part;
        }
        false
    }
}
