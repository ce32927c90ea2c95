//! The variables at addresses, each as a place outside and a place in the state.

use super::options::AtEnd;
use crate::Machine;
use crate::map::{Map, Type, Variable};
use staunch_runtime::Elementary;
use staunch_runtime::firmware::Place;
pub(super) use staunch_runtime::firmware::{Area, Width};

/// Numbers of each width of an area.
pub(super) const NUMBERS: usize = Width::Word.count();
/// Bits of an area.
pub(super) const BITS: usize = Width::Bit.count();
/// Names that a note lists.
const SHOWN: usize = 5;

/// One value at an address.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Point {
    pub area: Area,
    pub width: Width,
    /// Of a bit, eight times its byte and its place there.
    pub number: usize,
    /// In the state.
    offset: usize,
    /// The one bit of the byte there.
    bit: Option<u8>,
    /// It shares the bits of another variable, whose point there is as well.
    pub view: bool,
    /// Of an output, what it is before the first scan and at the end, where that is stated.
    pub safe: Option<u64>,
}

impl Point {
    /// In the state.
    pub fn offset(&self) -> usize {
        self.offset
    }

    /// The one bit of the byte there that it is, if it is one.
    pub fn bit(&self) -> Option<u8> {
        self.bit
    }

    /// What it is at the end of a run, after its `last` value.
    pub fn at_end(&self, at_end: AtEnd, last: u64) -> u64 {
        match (self.safe, at_end) {
            (Some(safe), _) => safe,
            (None, AtEnd::Zero) if self.area == Area::Output => 0,
            (None, AtEnd::Zero | AtEnd::Hold) => last,
        }
    }

    /// Its bits, the others being 0.
    pub fn read(&self, state: &[u8]) -> u64 {
        let size = self.width.size();
        let mut bytes = [0; 8];
        bytes[..size].copy_from_slice(&state[self.offset..self.offset + size]);
        let value = native(bytes, size);
        match self.bit {
            Some(number) => value >> number & 1,
            None => value,
        }
    }

    /// Writes those of its bits that `mask` has.
    pub fn write(&self, machine: &mut dyn Machine, value: u64, mask: u64) {
        let old = self.read(machine.state());
        let new = old & !mask | value & mask;
        if new == old {
            return;
        }
        let new = match (self.width, self.bit) {
            (_, Some(number)) => u64::from(machine.state()[self.offset]) & !(1 << number) | (new & 1) << number,
            (Width::Bit, None) => u64::from(new != 0),
            _ => new,
        };
        let size = self.width.size();
        machine.write(self.offset, &bytes_of(new, size)[..size]);
    }
}

/// A number of `size` bytes that are at the start.
fn native(bytes: [u8; 8], size: usize) -> u64 {
    let number = u64::from_ne_bytes(bytes);
    if cfg!(target_endian = "big") { number >> (64 - 8 * size) } else { number }
}

/// The bytes of a number of `size` bytes, at the start.
fn bytes_of(number: u64, size: usize) -> [u8; 8] {
    let number = if cfg!(target_endian = "big") { number << (64 - 8 * size) } else { number };
    number.to_ne_bytes()
}

/// Every value at an address, and what has none.
#[derive(Clone, Debug, Default)]
pub(super) struct Points {
    pub all: Vec<Point>,
    /// The variable of each, as a message names it.
    names: Vec<String>,
    /// Variables whose address or type has no place.
    unplaced: Vec<String>,
}

impl Points {
    /// All storage at addresses is among the globals: what a program declares is a second name of it.
    pub fn of(map: &Map) -> Self {
        let mut points = Self::default();
        let (globals, base) = map.globals();
        for variable in globals {
            if let Some(address) = &variable.address {
                points.add(map, variable, address, base);
            }
        }
        points
    }

    fn add(&mut self, map: &Map, variable: &Variable, address: &str, base: usize) {
        let name = format!("{} ({address})", map.name_of_global(&variable.name));
        let mut values = Vec::new();
        let placed = Place::parse(address).filter(|place| {
            leaves(map, variable.ty, base + variable.offset, place.room(), &mut values)
                && values.iter().all(|(ty, _)| fits(map, *ty, *place))
        });
        let Some(Place { area, width, number: first }) = placed else {
            self.unplaced.push(name);
            return;
        };
        for (at, (ty, offset)) in values.into_iter().enumerate() {
            let bit = if let Type::Bit(number) = ty { Some(number) } else { None };
            self.all.push(Point { area, width, number: first + at, offset, bit, view: variable.view, safe: None });
            self.names.push(name.clone());
        }
    }

    /// What has no place where `has_place` says what does: the first few names.
    pub fn without_place(&self, has_place: impl Fn(&Point) -> bool) -> Option<String> {
        let lacking = self.all.iter().zip(&self.names).filter(|(point, _)| !has_place(point));
        let mut names: Vec<&str> = self.unplaced.iter().map(String::as_str).collect();
        names.extend(lacking.map(|(_, name)| name.as_str()));
        names.dedup();
        let more = names.len().saturating_sub(SHOWN);
        let shown = names.iter().take(SHOWN).copied().collect::<Vec<_>>().join(", ");
        match (names.is_empty(), more) {
            (true, _) => None,
            (_, 0) => Some(shown),
            _ => Some(format!("{shown} and {more} more")),
        }
    }
}

/// The values of a variable, of an array one after the other. `false` where there are more than `limit`.
fn leaves(map: &Map, ty: Type, offset: usize, limit: usize, values: &mut Vec<(Type, usize)>) -> bool {
    let Some(array) = map.array(ty) else {
        values.push((ty, offset));
        return values.len() <= limit;
    };
    let mut elements = 0..array.len();
    elements.all(|at| leaves(map, array.element, offset + at * array.stride, limit, values))
}

/// A text and a structure have no place: their bytes are the compiler's affair.
fn fits(map: &Map, ty: Type, place: Place) -> bool {
    match ty {
        Type::Elementary(Elementary::Bool) | Type::Bit(_) => place.holds(true, 1),
        Type::Elementary(_) | Type::Enum(_) => place.holds(false, map.size_of(ty)),
        Type::String(_) | Type::Characters(_) | Type::Array(_) | Type::Struct(_) | Type::Block(_) | Type::Reference => {
            false
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture::{Bytes, map_with};

    #[test]
    fn every_address_has_its_place() {
        let map =
            map_with(&[("BOOL", 0, "-", "%IX2.3"), ("array:0", 2, "-", "%QW1020"), ("LREAL", 16, "-", "%ML1023")]);
        let points = Points::of(&map).all;
        let found: Vec<_> = points.iter().map(|it| (it.area, it.width, it.number, it.offset)).collect();
        assert_eq!(found[0], (Area::Input, Width::Bit, 19, 0));
        let words = [0, 1, 2, 3].map(|at| (Area::Output, Width::Word, 1020 + at, 2 + 2 * at));
        assert_eq!(found[1..5], words);
        assert_eq!(found[5], (Area::Memory, Width::Long, 1023, 16));
    }

    #[test]
    fn what_has_no_place_is_named() {
        let map = map_with(&[
            ("array:0", 0, "-", "%QW1021"),
            ("INT", 8, "-", "%IW1.2.3"),
            ("STRING[6]", 10, "-", "%MB0"),
            ("INT", 20, "-", "%MW1024"),
            ("BOOL", 22, "-", "%QX0.0"),
            ("enum:0", 24, "-", "%QW0"),
        ]);
        let points = Points::of(&map);
        assert_eq!(points.all.len(), 2);
        let names = "v0 (%QW1021), v1 (%IW1.2.3), v2 (%MB0), v3 (%MW1024)";
        assert_eq!(points.without_place(|_| true).unwrap(), names);
        let all = points.without_place(|_| false).unwrap();
        assert_eq!(all, format!("{names}, v4 (%QX0.0) and 1 more"));
    }

    #[test]
    fn bits_are_written_alone() {
        let map = map_with(&[("BYTE", 1, "-", "%MB0"), ("bit:3", 1, "view", "%MX0.3"), ("DINT", 4, "-", "%MD1")]);
        let points = Points::of(&map).all;
        let mut machine = Bytes::new(&map);
        points[0].write(&mut machine, 0x81, u64::MAX);
        points[1].write(&mut machine, 1, 1);
        assert_eq!((points[0].read(&machine.state), points[1].read(&machine.state)), (0x89, 1));
        points[1].write(&mut machine, 0, 1);
        assert_eq!(points[0].read(&machine.state), 0x81);
        points[2].write(&mut machine, 0x1122_3344, 0xFFFF_0000);
        assert_eq!(points[2].read(&machine.state), 0x1122_0000);
    }
}
