//! Memory: a list of cells, each one elementary value or one text. A place is where a variable's
//! cells start, and its type; two paths to one variable are the same place.

use crate::machine::{Machine, Outcome, unknown};
use crate::places::Character;
use crate::shared::Window;
use crate::texts::Units;
use crate::types::{Elementary, Text, Type};
use staunch_frontend::Span;
use staunch_runtime::{FaultKind, Value as Scalar};

#[derive(Clone, Debug)]
pub(crate) enum Cell<'a> {
    Scalar(Scalar),
    Text(Units),
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
    /// Where a reference to nothing, or to what was deleted, was followed: the place faults when it is used.
    pub nowhere: Option<(Span, FaultKind)>,
    /// The class that a reference or an in-out declares, where `ty` may be one that extends it.
    pub declared: Option<usize>,
    /// Where it begins in a cell that is shared.
    pub window: Option<Window>,
    /// Which character of the text there it is.
    pub character: Option<Character>,
}

impl<'a> Value<'a> {
    pub fn scalar(ty: Elementary, value: Scalar) -> Self {
        Self { ty: Type::Elementary(ty), cells: vec![Cell::Scalar(value)] }
    }

    pub fn bool(value: bool) -> Self {
        Self::scalar(Elementary::Bool, Scalar::Bool(value))
    }

    pub fn text(units: Units, wide: bool) -> Self {
        let ty = Type::Text(Text { capacity: usize::from(u16::MAX), wide });
        Self { ty, cells: vec![Cell::Text(units)] }
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
}

impl<'a> Place<'a> {
    /// A part that starts `offset` cells in.
    pub fn part(&self, offset: usize, ty: &Type<'a>) -> Self {
        Self {
            at: self.at + offset,
            ty: ty.clone(),
            nowhere: self.nowhere,
            declared: None,
            window: None,
            character: None,
        }
    }
}

impl<'a> Machine<'a> {
    pub(crate) fn read(&self, place: &Place<'a>) -> Value<'a> {
        let ty = match &place.ty {
            Type::Subrange(base, ..) => Type::Elementary(*base),
            other => other.clone(),
        };
        let cells = match (place.window, place.character) {
            (Some(window), _) => self.unpacked(place, window),
            (None, Some(character)) => vec![self.read_character(place, character.at)],
            (None, None) => self.memory[place.at..place.at + place.ty.size()].to_vec(),
        };
        Value { ty, cells }
    }

    /// Stores a value that has the place's type already.
    pub(crate) fn write(&mut self, place: &Place<'a>, value: &Value<'a>) {
        match (place.window, place.character) {
            (Some(window), _) => self.pack(place, window, &value.cells),
            (None, Some(character)) => self.write_character(place, character, &value.cells[0]),
            (None, None) => self.memory[place.at..place.at + value.cells.len()].clone_from_slice(&value.cells),
        }
    }

    /// The value as one of `ty`: widened, cut at a text's capacity, checked against a subrange.
    pub(crate) fn converted(&self, value: Value<'a>, ty: &Type<'a>, span: Span) -> Outcome<Value<'a>> {
        match ty {
            // A literal of one character is one where that is wanted.
            Type::Elementary(to @ (Elementary::Char | Elementary::Wchar)) => match value.as_text()?.as_slice() {
                [unit] => Ok(Value { ty: ty.clone(), cells: vec![integer_cell(*to, i128::from(*unit))] }),
                _ => unknown("a text where a character is asked for"),
            },
            Type::Elementary(to) => self.widened(&value, *to),
            Type::Subrange(base, low, high) => {
                let value = self.widened(&value, *base)?;
                if (*low..=*high).contains(&value.as_integer()?) {
                    return Ok(value);
                }
                Err(self.fault(FaultKind::SubrangeViolated, span))
            }
            Type::Text(text) => {
                let mut units = value.as_text()?;
                units.truncate(text.capacity);
                Ok(Value { ty: ty.clone(), cells: vec![Cell::Text(units)] })
            }
            Type::Reference(_) => Ok(Value { ty: ty.clone(), cells: value.cells }),
            _ if ty.class() != value.ty.class() => unknown("a copy of an heir as its base"),
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
        Place { at, ty: ty.clone(), nowhere: None, declared: None, window: None, character: None }
    }
}

pub(crate) fn integer_cell<'a>(ty: Elementary, number: i128) -> Cell<'a> {
    Cell::Scalar(ty.repr().integer(number).unwrap_or(ty.repr().zero()))
}
