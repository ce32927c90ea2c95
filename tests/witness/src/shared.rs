//! Bytes that several variables share: the members of a UNION, and variables whose direct addresses overlap.
//! A place there is some bits of one cell, the lowest byte first. Structures have C's layout there.

use crate::machine::Machine;
use crate::storage::{Cell, Place, Value};
use crate::types::{Elementary, Type};
use staunch_runtime::Value as Scalar;

/// Nanoseconds.
const DAY: i64 = 86_400_000_000_000;

/// Where in its cell a place begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Window {
    pub bit: usize,
    /// Whether a BOOL is one bit there, not a byte.
    pub single: bool,
}

/// Bytes, and what their number a variable's address is a multiple of.
struct Layout {
    size: usize,
    align: usize,
}

impl<'a> Type<'a> {
    /// How many bytes a value takes among shared ones; `None` where it cannot be there.
    pub fn bytes(&self) -> Option<usize> {
        self.shared_layout().map(|it| it.size)
    }

    /// A text by itself is its characters and a zero.
    fn shared_layout(&self) -> Option<Layout> {
        match self {
            Self::Text(it) => Some(Layout { size: (it.capacity + 1) * it.unit(), align: it.unit() }),
            _ => self.layout(),
        }
    }

    fn layout(&self) -> Option<Layout> {
        match self {
            Self::Elementary(it) => Some(of_elementary(*it)),
            Self::Enum(it) => Some(of_elementary(it.base)),
            Self::Array(it) => {
                let element = it.element.ty.layout()?;
                Some(Layout { size: element.size * it.count(), ..element })
            }
            Self::Record(it) if it.pou.is_none() => {
                let mut whole = Layout { size: 0, align: 1 };
                for (_, slot) in &it.fields {
                    let field = slot.ty.layout()?;
                    whole.size = whole.size.next_multiple_of(field.align) + field.size;
                    whole.align = whole.align.max(field.align);
                }
                Some(Layout { size: whole.size.next_multiple_of(whole.align), ..whole })
            }
            Self::Union(it) => {
                let mut whole = Layout { size: 0, align: 1 };
                for (_, slot) in &it.fields {
                    let field = slot.ty.shared_layout()?;
                    whole.size = whole.size.max(field.size);
                    whole.align = whole.align.max(field.align);
                }
                Some(Layout { size: whole.size.next_multiple_of(whole.align), ..whole })
            }
            // In structures and arrays it lies as it does anywhere, with room for its length.
            Self::Text(it) => Some(Layout { size: 2 + (it.capacity * it.unit()).next_multiple_of(2), align: 2 }),
            Self::Subrange(..) | Self::Record(_) | Self::Block(_) | Self::Reference(_) => None,
        }
    }

    /// The bit string that is as wide as the narrowest variable there.
    pub fn smallest_part(&self) -> Option<Elementary> {
        let bits = [Elementary::Byte, Elementary::Word, Elementary::Dword, Elementary::Lword];
        match self {
            Self::Elementary(it) => bits.into_iter().find(|bits| bits.repr().size() == it.repr().size()),
            Self::Enum(it) => Type::Elementary(it.base).smallest_part(),
            Self::Array(it) => it.element.ty.smallest_part(),
            Self::Record(it) | Self::Union(it) => {
                it.fields.iter().filter_map(|(_, slot)| slot.ty.smallest_part()).min_by_key(|it| it.repr().size())
            }
            Self::Text(it) => Some(if it.wide { Elementary::Word } else { Elementary::Byte }),
            Self::Subrange(..) | Self::Block(_) | Self::Reference(_) => None,
        }
    }

    /// The bytes before the field with this number.
    pub fn bytes_before(&self, field: usize) -> usize {
        let Self::Record(record) = self else { return 0 };
        let mut offset: usize = 0;
        for (at, (_, slot)) in record.fields.iter().enumerate() {
            let Some(layout) = slot.ty.layout() else { return 0 };
            offset = offset.next_multiple_of(layout.align);
            if at == field {
                return offset;
            }
            offset += layout.size;
        }
        offset
    }
}

fn of_elementary(ty: Elementary) -> Layout {
    let size = usize::try_from(ty.repr().size()).unwrap_or(1);
    Layout { size, align: size }
}

impl<'a> Place<'a> {
    /// The part that begins so many bytes further on.
    pub fn further(&self, window: Window, bytes: usize, ty: &Type<'a>) -> Self {
        let window = Window { bit: window.bit + 8 * bytes, ..window };
        Self { ty: ty.clone(), window: Some(window), declared: None, ..self.clone() }
    }

    /// The field of a structure, or the member of a UNION, with this number.
    pub fn field(&self, number: usize) -> Option<Self> {
        match (&self.ty, self.window) {
            (Type::Union(it), window) => {
                let start = window.unwrap_or(Window { bit: 0, single: false });
                Some(self.further(start, 0, &it.fields.get(number)?.1.ty))
            }
            (Type::Record(it), Some(window)) => {
                Some(self.further(window, self.ty.bytes_before(number), &it.fields.get(number)?.1.ty))
            }
            (Type::Record(it), None) => {
                let before = it.fields.iter().take(number).map(|it| it.1.ty.size()).sum();
                Some(self.part(before, &it.fields.get(number)?.1.ty))
            }
            _ => None,
        }
    }

    /// The element of an array that comes after so many others.
    pub fn nth(&self, number: usize) -> Option<Self> {
        let Type::Array(array) = &self.ty else { return None };
        let element = &array.element.ty;
        match self.window {
            Some(window) => Some(self.further(window, number * element.layout()?.size, element)),
            None => Some(self.part(number * element.size(), element)),
        }
    }
}

impl<'a> Place<'a> {
    /// The element that comes after so many others in the row in which they are written.
    pub fn flat(&self, number: usize) -> Option<Self> {
        let Type::Array(array) = &self.ty else { return None };
        let Type::Array(inner) = &array.element.ty else { return self.nth(number).filter(|_| number < array.count()) };
        if array.dimensions == 1 {
            return self.nth(number).filter(|_| number < array.count());
        }
        let each = inner.elements();
        self.nth(number / each).filter(|_| number / each < array.count())?.flat(number % each)
    }
}

impl<'a> Machine<'a> {
    /// The value at a place among shared bytes. A type that cannot be there was refused when it was declared.
    pub(crate) fn unpacked(&self, place: &Place<'a>, window: Window) -> Vec<Cell<'a>> {
        let first = window.bit / 8;
        match &place.ty {
            Type::Array(array) => self.unpacked_parts((0..array.count()).map_while(|it| place.nth(it))),
            Type::Record(record) => self.unpacked_parts((0..record.fields.len()).map_while(|it| place.field(it))),
            Type::Union(_) => {
                let size = place.ty.bytes().unwrap_or(0);
                vec![Cell::Bytes(self.bytes_of(place)[first..first + size].to_vec())]
            }
            Type::Text(text) => {
                let bytes = &self.bytes_of(place)[first..first + text.capacity * text.unit()];
                let units = bytes.chunks(text.unit()).map(|it| u16::from_le_bytes([it[0], *it.get(1).unwrap_or(&0)]));
                vec![Cell::Text(units.take_while(|it| *it != 0).collect())]
            }
            ty => {
                let bytes = &self.bytes_of(place)[first..];
                let scalar = match ty.base() {
                    Some(Elementary::Bool) | None => {
                        let mask = if window.single { 1 << (window.bit % 8) } else { u8::MAX };
                        Scalar::Bool(bytes[0] & mask != 0)
                    }
                    Some(base) => on_its_day(base, Scalar::read(base.repr(), bytes)),
                };
                vec![Cell::Scalar(scalar)]
            }
        }
    }

    fn unpacked_parts(&self, parts: impl Iterator<Item = Place<'a>>) -> Vec<Cell<'a>> {
        parts.flat_map(|it| self.read(&it).cells).collect()
    }

    /// Puts cells where they lie among shared bytes.
    pub(crate) fn pack(&mut self, place: &Place<'a>, window: Window, cells: &[Cell<'a>]) {
        let parts: Vec<Place<'a>> = match &place.ty {
            Type::Array(array) => (0..array.count()).map_while(|it| place.nth(it)).collect(),
            Type::Record(record) => (0..record.fields.len()).map_while(|it| place.field(it)).collect(),
            _ => return self.pack_one(place, window, &cells[0]),
        };
        let mut rest = cells;
        for part in parts {
            let (own, others) = rest.split_at(part.ty.size());
            self.write(&part, &Value { ty: part.ty.clone(), cells: own.to_vec() });
            rest = others;
        }
    }

    fn pack_one(&mut self, place: &Place<'a>, window: Window, cell: &Cell<'a>) {
        let Cell::Bytes(bytes) = &mut self.memory[place.at] else { return };
        let first = window.bit / 8;
        match cell {
            Cell::Scalar(Scalar::Bool(value)) if window.single => {
                let mask = 1 << (window.bit % 8);
                bytes[first] = if *value { bytes[first] | mask } else { bytes[first] & !mask };
            }
            Cell::Scalar(Scalar::Bool(value)) => bytes[first] = u8::from(*value),
            Cell::Scalar(value) => value.write(&mut bytes[first..]),
            Cell::Bytes(own) => bytes[first..first + own.len()].copy_from_slice(own),
            // Zeros to its end.
            Cell::Text(text) => {
                let Type::Text(ty) = place.ty else { return };
                let units = text.iter().chain(std::iter::repeat(&0)).take(ty.capacity + 1);
                for (unit, to) in units.zip(bytes[first..].chunks_mut(ty.unit())) {
                    to.copy_from_slice(&unit.to_le_bytes()[..ty.unit()]);
                }
            }
            Cell::Reference(_) => {}
        }
    }

    fn bytes_of(&self, place: &Place<'a>) -> &[u8] {
        match &self.memory[place.at] {
            Cell::Bytes(it) => it,
            Cell::Scalar(_) | Cell::Text(_) | Cell::Reference(_) => &[],
        }
    }
}

/// Of any bits a DATE is the midnight before, a TOD the time of day.
fn on_its_day(ty: Elementary, value: Scalar) -> Scalar {
    match (ty, value) {
        (Elementary::Date | Elementary::Ldate, Scalar::I64(it)) => Scalar::I64(it - it.rem_euclid(DAY)),
        (Elementary::Tod | Elementary::Ltod, Scalar::I64(it)) => Scalar::I64(it.rem_euclid(DAY)),
        _ => value,
    }
}
