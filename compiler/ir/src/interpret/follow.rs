//! Accesses through references: all by the runtime's table of objects.

use super::place::Scope;
use super::{Frame, Interpreter, Watch};
use crate::evaluate::{Storage, scalar, text};
use crate::layout::usize_of;
use crate::reference::{Followed, followed, view, wanted};
use crate::{Chars, Expr, Location, Place, Projection, Repr, Root, StringType, Type, Value};
use core::cell::Cell;
use staunch_runtime::reference::{Memory, Table, View};
use staunch_runtime::{Fault, FaultKind, ops, text::Destination};

/// A scalar or string that a reference leads to: where from there, and as what it is seen.
pub(super) struct Reached {
    reference: u64,
    distance: u64,
    view: View,
    at: Location,
}

/// The state, for reading.
struct Bytes<'a>(&'a [u8]);

impl Memory for Bytes<'_> {
    fn read(&self, at: usize, out: &mut [u8]) {
        out.copy_from_slice(&self.0[at..at + out.len()]);
    }

    fn write(&self, _at: usize, _bytes: &[u8]) {
        unreachable!("a load writes nothing")
    }
}

impl<W: Watch> Scope<'_, W> {
    fn table(&self) -> Table<'_> {
        Table::new(&self.interpreter.table)
    }

    fn state(&self) -> Bytes<'_> {
        Bytes(&self.interpreter.memory[..self.interpreter.initial.len()])
    }

    /// A scalar or string reached through a reference, except a standard block's pin, whose block is found whole.
    pub(super) fn reached(&self, place: &Place) -> Result<Option<Reached>, Fault> {
        let program = self.interpreter.program;
        let Some(followed) = followed(program, place) else { return Ok(None) };
        if followed.pin.is_some() || !is_simple(place.ty) {
            return Ok(None);
        }
        let (reference, distance) = self.start(&followed)?;
        Ok(Some(Reached { reference, distance, view: view(program, place.ty), at: followed.at }))
    }

    /// The reference, and the distance from where it points to what is looked at.
    fn start(&self, followed: &Followed<'_>) -> Result<(u64, u64), Fault> {
        let Value::U64(reference) = self.load(&followed.pointer)? else {
            unreachable!("verified IR: a reference is 64 bits")
        };
        let (mut distance, mut ty) = (0, followed.target);
        for projection in followed.way {
            let (step, part) = match projection {
                Projection::Field(field) => self.field(ty, *field),
                Projection::Index { index, at } => self.element(ty, index, *at)?,
                Projection::Deref { .. } => unreachable!("the way starts at the last reference"),
            };
            distance += step;
            ty = part;
        }
        Ok((reference, u64::try_from(distance).expect("sizes are below the limit of 1 GiB")))
    }

    /// Where a variable reached through a reference is, to be passed on whole.
    pub(super) fn find(&self, place: &Place) -> Result<usize, Fault> {
        let program = self.interpreter.program;
        let followed = followed(program, place).expect("a place that leads through a reference");
        let (reference, distance) = self.start(&followed)?;
        let found = self.table().find(&self.state(), reference, distance, wanted(program, followed.ty));
        let offset = found.map_err(|kind| Fault { kind, at: followed.at })?;
        let pin = followed.pin.map_or(0, |(block, pin)| self.interpreter.layout.offset(Type::Block(block), pin));
        Ok(offset + usize_of(pin))
    }

    pub(super) fn load_reached(&self, it: &Reached, repr: Repr) -> Result<Value, Fault> {
        let value = self.table().load_value(&self.state(), it.reference, it.distance, it.view, repr);
        value.map_err(|kind| Fault { kind, at: it.at })
    }

    pub(super) fn load_reached_text(&self, it: &Reached, ty: StringType) -> Result<Chars, Fault> {
        let (table, state) = (self.table(), self.state());
        let loaded = if ty.wide {
            Chars::build(ty.capacity, |out: &mut Destination<'_, u16>| {
                table.load_text(&state, it.reference, it.distance, out)
            })
        } else {
            Chars::build(ty.capacity, |out: &mut Destination<'_>| {
                table.load_text(&state, it.reference, it.distance, out)
            })
        };
        loaded.map_err(|kind| Fault { kind, at: it.at })
    }

    pub(super) fn reference_to(&self, place: &Place) -> Result<Value, Fault> {
        if place.is_followed() {
            let followed = followed(self.interpreter.program, place).expect("a place that leads through a reference");
            let (reference, distance) = self.start(&followed)?;
            return Ok(Value::U64(ops::advance(reference, distance.cast_signed())));
        }
        let offset = self.resolve(place)?;
        let size = usize_of(self.interpreter.layout.size(place.ty));
        debug_assert!(!matches!(place.root, Root::Local(_)), "verified IR: the address of what lasts");
        Ok(Value::U64(self.table().address(offset, size)))
    }
}

impl<W: Watch> Interpreter<'_, W> {
    pub(super) fn assign_reached(&mut self, frame: &Frame, it: &Reached, value: &Expr) -> Result<(), Fault> {
        let stored = match value.ty {
            Type::String(_) => {
                let value = text(&self.scope(frame), value)?;
                self.with_table(|table, state| match &value {
                    Chars::Narrow(units) => table.store_text(state, it.reference, it.distance, units),
                    Chars::Wide(units) => table.store_text(state, it.reference, it.distance, units),
                })
            }
            Type::Elementary(_)
            | Type::Subrange(..)
            | Type::Enum(_)
            | Type::Reference(_)
            | Type::Array(_)
            | Type::Struct(_)
            | Type::Block(_) => {
                let value = scalar(&self.scope(frame), value)?;
                self.with_table(|table, state| table.store_value(state, it.reference, it.distance, it.view, value))
            }
        };
        stored.map_err(|kind| Fault { kind, at: it.at })
    }

    fn with_table(
        &mut self,
        access: impl FnOnce(Table<'_>, &[Cell<u8>]) -> Result<(), FaultKind>,
    ) -> Result<(), FaultKind> {
        let size = self.initial.len();
        let state = Cell::from_mut(&mut self.memory[..size]).as_slice_of_cells();
        access(Table::new(&self.table), state)
    }
}

/// Whether a value of the type is looked at as numbers or characters.
fn is_simple(ty: Type) -> bool {
    match ty {
        Type::Elementary(_) | Type::Subrange(..) | Type::Enum(_) | Type::Reference(_) | Type::String(_) => true,
        Type::Array(_) | Type::Struct(_) | Type::Block(_) => false,
    }
}
