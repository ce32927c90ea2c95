//! What variables start with: their initial values, or what their types say.

use crate::dates::START_OF_S7;
use crate::machine::{Frame, Machine, Outcome, Stop, unknown};
use crate::storage::{Cell, Place, integer_cell};
use crate::types::{Elementary, Slot, Type};
use staunch_frontend::ast::{Initial, InitialKind};
use staunch_runtime::{BlockInfo, Family, FaultKind, Value as Scalar};

/// What an initial value gives a variable.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Assigns {
    pub values: bool,
    /// What is an address, or an instance for an INTERFACE: these are known when all variables are there.
    pub references: bool,
    /// Parts that it does not name start as their types say.
    pub others: bool,
}

impl Assigns {
    pub const ALL: Self = Self { values: true, references: true, others: true };
    pub const VALUES: Self = Self { references: false, ..Self::ALL };
    pub const REFERENCES: Self = Self { values: false, references: true, others: false };
    pub const NAMED: Self = Self { others: false, ..Self::ALL };
}

impl<'a> Machine<'a> {
    /// Gives a variable its initial value.
    pub(crate) fn start(
        &mut self,
        frame: &Frame<'a>,
        place: &Place<'a>,
        initial: Option<&'a Initial<'a>>,
    ) -> Outcome<()> {
        match initial.map(|it| &it.kind) {
            None => self.start_unset(frame, place),
            Some(InitialKind::Value(expr) | InitialKind::Bind(expr)) => {
                let is_wanted =
                    if let Type::Reference(_) = place.ty { self.assigns.references } else { self.assigns.values };
                if is_wanted {
                    let value = self.value_as(frame, expr, &place.ty).map_err(computed)?;
                    self.write(place, &value);
                } else if let Type::Reference(_) = place.ty {
                    self.start_unset(frame, place)?;
                }
                Ok(())
            }
            Some(InitialKind::Elements(elements)) => {
                self.start_unset(frame, place)?;
                let mut at = 0;
                for element in elements {
                    let count = element.count.as_ref().map_or(Ok(1), |it| self.value(frame, it, None)?.as_integer())?;
                    if element.values.is_empty() {
                        // `4()`: what the elements' type says.
                        at += usize::try_from(count).unwrap_or(0);
                    }
                    for _ in 0..count {
                        for value in &element.values {
                            let Some(element) = place.flat(at) else {
                                return unknown("too many elements");
                            };
                            self.start(frame, &element, Some(value))?;
                            at += 1;
                        }
                    }
                }
                Ok(())
            }
            Some(InitialKind::Indexed(_) | InitialKind::Members(_)) => {
                unknown("initial values of SCL, by index and by position")
            }
            Some(InitialKind::Fields(fields)) => {
                self.start_unset(frame, place)?;
                for (name, initial) in fields {
                    let is_count = |it: &BlockInfo| it.family == Family::Cscape && name.text.eq_ignore_ascii_case("CV");
                    if matches!(place.ty, Type::Block(info) if is_count(info)) {
                        return unknown("what a counter of Cscape does with a count that it is given first");
                    }
                    let field = self.member(place, name.text).ok_or(Stop::Unknown("an unknown member".into()))?;
                    self.start(frame, &field, Some(initial))?;
                }
                Ok(())
            }
        }
    }

    /// What a variable starts with that has no initial value of its own.
    fn start_unset(&mut self, frame: &Frame<'a>, place: &Place<'a>) -> Outcome<()> {
        if !self.assigns.others {
            return Ok(());
        }
        if place.window.is_some() {
            // The shared bytes are zeros until an initial value says otherwise.
            return Ok(());
        }
        match &place.ty {
            Type::Elementary(it) => self.memory[place.at] = Cell::Scalar(self.first_value(*it)),
            // Edition 2, 2.3.3.2: the leftmost value.
            Type::Subrange(base, low, _) => self.memory[place.at] = integer_cell(*base, *low),
            Type::Enum(it) => self.memory[place.at] = Cell::Scalar(it.values[0].1),
            Type::Text(_) => self.memory[place.at] = Cell::Text(Vec::new()),
            Type::Reference(_) => self.memory[place.at] = Cell::Reference(None),
            Type::Union(union) => {
                self.memory[place.at] = Cell::Bytes(vec![0; place.ty.bytes().unwrap_or(0)]);
                for (number, (_, slot)) in union.fields.iter().enumerate() {
                    if let Some(member) = place.field(number) {
                        self.start_member(frame, &member, slot)?;
                    }
                }
            }
            Type::Array(array) => {
                let size = array.element.ty.size();
                for number in 0..array.count() {
                    self.start_slot(frame, &place.part(number * size, &array.element.ty), &array.element)?;
                }
            }
            Type::Record(record) => {
                // The initial values of an instance may use those declared before them.
                let own = record.pou.map(|_| self.instance_frame(place));
                let mut offset = 0;
                for (_, slot) in &record.fields {
                    self.start_slot(own.as_ref().unwrap_or(frame), &place.part(offset, &slot.ty), slot)?;
                    offset += slot.ty.size();
                }
            }
            Type::Block(info) => {
                for (number, pin) in info.pins.iter().enumerate() {
                    let value = if pin.starts_true { Scalar::Bool(true) } else { pin.ty.repr().zero() };
                    self.memory[place.at + number] = Cell::Scalar(value);
                }
            }
        }
        Ok(())
    }

    /// Days and points in time of S7 start in 1990 (S7-1200 System Manual, 11/2011, p. 89).
    fn first_value(&self, ty: Elementary) -> Scalar {
        match ty {
            Elementary::Date | Elementary::Dt if self.declared.family == Family::S7 => Scalar::I64(START_OF_S7),
            _ => ty.repr().zero(),
        }
    }

    /// A member of a UNION that starts as all zeros leaves the others as they start.
    fn start_member(&mut self, frame: &Frame<'a>, member: &Place<'a>, slot: &Slot<'a>) -> Outcome<()> {
        let alone = self.allocate(&slot.ty);
        self.start_slot(frame, &alone, slot)?;
        let value = self.read(&alone);
        self.memory.truncate(alone.at);
        if !value.cells.iter().all(is_zero) {
            self.write(member, &value);
        }
        Ok(())
    }

    fn start_slot(&mut self, frame: &Frame<'a>, place: &Place<'a>, slot: &Slot<'a>) -> Outcome<()> {
        self.start(frame, place, slot.initial)
    }
}

/// What a reference leads to is read when all variables are there: in which order is not for the witness to say.
fn computed(stop: Stop) -> Stop {
    match stop {
        Stop::Fault(fault) if fault.kind == FaultKind::NullReference => {
            Stop::Unknown("an initial value reached through a reference".to_owned())
        }
        stop => stop,
    }
}

fn is_zero(cell: &Cell<'_>) -> bool {
    match cell {
        Cell::Scalar(Scalar::F32(it)) => it.to_bits() == 0,
        Cell::Scalar(Scalar::F64(it)) => it.to_bits() == 0,
        Cell::Scalar(Scalar::Bool(it)) => !it,
        Cell::Scalar(it) => it.as_integer() == Some(0),
        Cell::Bytes(it) => it.iter().all(|it| *it == 0),
        Cell::Text(it) => it.is_empty(),
        Cell::Reference(_) => false,
    }
}
