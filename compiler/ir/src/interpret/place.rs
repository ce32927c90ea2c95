//! The places of a running routine: where they are in the interpreter's memory.

use super::{Frame, Interpreter, Watch};
use crate::evaluate::{Storage, scalar, string_type};
use crate::layout::usize_of;
use crate::{Chars, Expr, FaultKind, FieldId, Location, Place, Projection, Root, Type, Value};
use staunch_runtime::{Fault, ops};

/// The storage that a running routine sees.
pub(super) struct Scope<'a, W> {
    pub(super) interpreter: &'a Interpreter<'a, W>,
    pub(super) frame: &'a Frame,
}

impl<W: Watch> Storage for Scope<'_, W> {
    fn load(&self, place: &Place) -> Result<Value, Fault> {
        let repr = self.interpreter.program.repr(place.ty).expect("verified IR: an elementary place");
        if let Some(reached) = self.reached(place)? {
            return self.load_reached(&reached, repr);
        }
        let at = self.resolve(place)?;
        Ok(Value::read(repr, &self.interpreter.memory[at..]))
    }

    fn load_text(&self, place: &Place) -> Result<Chars, Fault> {
        if let Some(reached) = self.reached(place)? {
            return self.load_reached_text(&reached, string_type(place.ty));
        }
        let at = self.resolve(place)?;
        Ok(Chars::read(string_type(place.ty), &self.interpreter.memory[at..]))
    }

    fn address_of(&self, place: &Place) -> Result<Value, Fault> {
        self.reference_to(place)
    }
}

impl<W: Watch> Scope<'_, W> {
    /// The offset in the interpreter's memory that `place` means.
    pub(super) fn resolve(&self, place: &Place) -> Result<usize, Fault> {
        if place.is_followed() {
            return self.find(place);
        }
        let (mut offset, mut ty) = self.root(place.root);
        for projection in &place.projections {
            let (step, part) = match projection {
                Projection::Field(field) => self.field(ty, *field),
                Projection::Index { index, at } => self.element(ty, index, *at)?,
                Projection::Deref { .. } => unreachable!("a place that leads through no reference"),
            };
            offset += step;
            ty = part;
        }
        Ok(offset)
    }

    fn root(&self, root: Root) -> (usize, Type) {
        let Self { interpreter, frame } = self;
        let program = interpreter.program;
        let routine = program.routine(frame.routine);
        match root {
            Root::Instance => {
                let state = routine.state.expect("verified IR: a routine with an instance");
                (frame.instance, Type::Struct(state))
            }
            Root::Globals => (usize_of(interpreter.layout.machine.globals), Type::Struct(program.globals)),
            Root::Local(id) => {
                let offset = interpreter.frames[frame.routine.index()].offsets[id.index()];
                (frame.locals + offset, routine.locals[id.index()].ty)
            }
            Root::Param(id) => {
                let offset = interpreter.references[frame.references + id.index()];
                (offset, routine.params[id.index()].ty)
            }
        }
    }

    pub(super) fn field(&self, ty: Type, field: FieldId) -> (usize, Type) {
        let part = self.interpreter.program.member(ty, field).expect("verified IR: a member's id");
        (usize_of(self.interpreter.layout.offset(ty, field)), part)
    }

    pub(super) fn element(&self, ty: Type, index: &Expr, at: Location) -> Result<(usize, Type), Fault> {
        let Type::Array(id) = ty else { unreachable!("verified IR: an index into an array") };
        let Value::I64(index) = scalar(self, index)? else { unreachable!("verified IR: a LINT index") };
        let array = self.interpreter.program.array(id);
        let position = ops::index(index, array.low, array.high).map_err(|kind: FaultKind| Fault { kind, at })?;
        Ok((position * usize_of(self.interpreter.layout.stride(id)), array.element))
    }
}
