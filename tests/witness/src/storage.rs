//! Memory: a list of cells, each one elementary value or one text. A place is where a variable's
//! cells start, and its type; two paths to one variable are the same place.

use crate::machine::{Frame, Machine, Outcome, Stop, unknown};
use crate::shared::Window;
use crate::types::{Elementary, Slot, Type};
use staunch_frontend::Span;
use staunch_frontend::ast::{Initial, InitialKind};
use staunch_runtime::{FaultKind, Value as Scalar};

#[derive(Clone, Debug)]
pub(crate) enum Cell<'a> {
    Scalar(Scalar),
    Text(Vec<u8>),
    /// What several variables share.
    Bytes(Vec<u8>),
    /// What a reference leads to, as it was declared there: an instance's own class.
    Reference(Option<Box<Place<'a>>>),
}

/// A value with its type; a whole array or structure has many cells.
#[derive(Clone, Debug)]
pub(crate) struct Value<'a> {
    pub ty: Type<'a>,
    pub cells: Vec<Cell<'a>>,
}

#[derive(Clone, Debug)]
pub(crate) struct Place<'a> {
    pub at: usize,
    pub ty: Type<'a>,
    /// Where a reference to nothing was followed: the place faults when it is used.
    pub nowhere: Option<Span>,
    /// The class that a reference or an in-out declares, where `ty` may be one that extends it.
    pub declared: Option<usize>,
    /// Where it begins in a cell that is shared.
    pub window: Option<Window>,
}

impl<'a> Value<'a> {
    pub fn scalar(ty: Elementary, value: Scalar) -> Self {
        Self { ty: Type::Elementary(ty), cells: vec![Cell::Scalar(value)] }
    }

    pub fn bool(value: bool) -> Self {
        Self::scalar(Elementary::Bool, Scalar::Bool(value))
    }

    pub fn text(bytes: Vec<u8>) -> Self {
        Self { ty: Type::Text(usize::from(u16::MAX)), cells: vec![Cell::Text(bytes)] }
    }

    /// The elementary value, of an enumeration that of its base.
    pub fn as_scalar(&self) -> Outcome<Scalar> {
        match self.cells.as_slice() {
            [Cell::Scalar(it)] => Ok(*it),
            _ => unknown("a value that is not elementary"),
        }
    }

    pub fn as_integer(&self) -> Outcome<i128> {
        self.as_scalar()?.as_integer().map_or_else(|| unknown("a value that is not an integer"), Ok)
    }

    pub fn as_bool(&self) -> Outcome<bool> {
        match self.as_scalar()? {
            Scalar::Bool(it) => Ok(it),
            _ => unknown("a condition that is not a BOOL"),
        }
    }

    pub fn as_text(&self) -> Outcome<&[u8]> {
        match self.cells.as_slice() {
            [Cell::Text(it)] => Ok(it),
            _ => unknown("a value that is not a text"),
        }
    }
}

impl<'a> Place<'a> {
    /// A part that starts `offset` cells in.
    pub fn part(&self, offset: usize, ty: &Type<'a>) -> Self {
        Self { at: self.at + offset, ty: ty.clone(), nowhere: self.nowhere, declared: None, window: None }
    }
}

impl<'a> Machine<'a> {
    pub(crate) fn read(&self, place: &Place<'a>) -> Value<'a> {
        let ty = match &place.ty {
            Type::Subrange(base, ..) => Type::Elementary(*base),
            other => other.clone(),
        };
        let cells = match place.window {
            Some(window) => self.unpacked(place, window),
            None => self.memory[place.at..place.at + place.ty.size()].to_vec(),
        };
        Value { ty, cells }
    }

    /// Stores a value that has the place's type already.
    pub(crate) fn write(&mut self, place: &Place<'a>, value: &Value<'a>) {
        match place.window {
            Some(window) => self.pack(place, window, &value.cells),
            None => self.memory[place.at..place.at + value.cells.len()].clone_from_slice(&value.cells),
        }
    }

    /// The value as one of `ty`: widened, cut at a text's capacity, checked against a subrange.
    pub(crate) fn converted(&self, value: Value<'a>, ty: &Type<'a>, span: Span) -> Outcome<Value<'a>> {
        match ty {
            Type::Elementary(to) => self.widened(&value, *to),
            Type::Subrange(base, low, high) => {
                let value = self.widened(&value, *base)?;
                if (*low..=*high).contains(&value.as_integer()?) {
                    return Ok(value);
                }
                Err(self.fault(FaultKind::SubrangeViolated, span))
            }
            Type::Text(capacity) => {
                let mut bytes = value.as_text()?.to_vec();
                bytes.truncate(*capacity);
                Ok(Value { ty: ty.clone(), cells: vec![Cell::Text(bytes)] })
            }
            Type::Reference(_) => Ok(Value { ty: ty.clone(), cells: value.cells }),
            Type::Enum(_) | Type::Array(_) | Type::Record(_) | Type::Union(_) | Type::Block(_) => Ok(value),
        }
    }

    pub(crate) fn widened(&self, value: &Value<'a>, to: Elementary) -> Outcome<Value<'a>> {
        let scalar = staunch_runtime::ops::convert_value(value.as_scalar()?, to.repr());
        match value.ty.elementary() {
            Some(from) if self.widens(from, to) => Ok(Value::scalar(to, scalar)),
            from => unknown(&format!("{from:?} where {to:?} is asked for")),
        }
    }

    /// New memory for a variable, not started yet.
    pub(crate) fn allocate(&mut self, ty: &Type<'a>) -> Place<'a> {
        let at = self.memory.len();
        self.memory.resize(at + ty.size(), Cell::Scalar(Scalar::Bool(false)));
        Place { at, ty: ty.clone(), nowhere: None, declared: None, window: None }
    }

    /// Gives a variable its initial value.
    pub(crate) fn start(
        &mut self,
        frame: &Frame<'a>,
        place: &Place<'a>,
        initial: Option<&'a Initial<'a>>,
    ) -> Outcome<()> {
        match initial.map(|it| &it.kind) {
            None => self.start_unset(frame, place),
            Some(InitialKind::Value(expr)) => {
                let value = self.value_as(frame, expr, &place.ty)?;
                self.write(place, &value);
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
                            let Some(element) = place.nth(at).filter(|it| it.at < self.memory.len()) else {
                                return unknown("too many elements");
                            };
                            self.start(frame, &element, Some(value))?;
                            at += 1;
                        }
                    }
                }
                Ok(())
            }
            Some(InitialKind::Bind(_)) => Err(Stop::Unknown("REF= as an initial value".into())),
            Some(InitialKind::Fields(fields)) => {
                self.start_unset(frame, place)?;
                for (name, initial) in fields {
                    let field = self.member(place, name.text).ok_or(Stop::Unknown("an unknown member".into()))?;
                    self.start(frame, &field, Some(initial))?;
                }
                Ok(())
            }
        }
    }

    /// What a variable starts with that has no initial value of its own.
    fn start_unset(&mut self, frame: &Frame<'a>, place: &Place<'a>) -> Outcome<()> {
        if place.window.is_some() {
            // The shared bytes are zeros until an initial value says otherwise.
            return Ok(());
        }
        match &place.ty {
            Type::Elementary(it) => self.memory[place.at] = Cell::Scalar(it.repr().zero()),
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

pub(crate) fn integer_cell<'a>(ty: Elementary, number: i128) -> Cell<'a> {
    Cell::Scalar(ty.repr().integer(number).unwrap_or(ty.repr().zero()))
}

fn is_zero(cell: &Cell<'_>) -> bool {
    match cell {
        Cell::Scalar(Scalar::F32(it)) => it.to_bits() == 0,
        Cell::Scalar(Scalar::F64(it)) => it.to_bits() == 0,
        Cell::Scalar(Scalar::Bool(it)) => !it,
        Cell::Scalar(it) => it.as_integer() == Some(0),
        Cell::Bytes(it) => it.iter().all(|it| *it == 0),
        Cell::Text(_) | Cell::Reference(_) => false,
    }
}
