//! Where the objects are, and which types they contain.
//!
//! A table is words, so that a back end can put it into a program as plain data: the number of objects, the
//! node of the state, how many words there are; for each object its offset and size, in the order of their
//! offsets, its size again where all of it is numbers, else 0, its mark and its node; then the nodes. Bytes within
//! those that are numbers may be seen as any number without a look at the nodes. The mark of an object in a pool is the
//! offset, and 1, of the BOOL that says whether the object exists; other objects, which always exist, have 0.

use super::{Memory, ORIGIN, Reference};
use crate::{FaultKind, Repr, StringType};
use core::ops::Range;

/// The view of memory that an access asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum View {
    /// A BOOL.
    Truth,
    /// A number, of this many bytes.
    Number(u32),
    /// A string: a WSTRING, or a STRING.
    Text { wide: bool },
    /// Exactly this: the number of a type that is viewed as nothing else.
    Exact(u32),
}

impl View {
    /// The view as a number, for native code.
    pub const fn code(self) -> u32 {
        match self {
            Self::Truth => 0,
            Self::Text { wide } => 1 | (wide as u32) << 2,
            Self::Number(size) => 2 | size << 2,
            Self::Exact(id) => 3 | id << 2,
        }
    }

    pub const fn from_code(code: u32) -> Self {
        match code & 3 {
            0 => Self::Truth,
            1 => Self::Text { wide: code >> 2 != 0 },
            2 => Self::Number(code >> 2),
            _ => Self::Exact(code >> 2),
        }
    }
}

/// The kind of an access.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// Bytes at an offset of the state, and how many there are to the end of the variable.
    Bytes { at: usize, rest: usize },
    /// The byte of a BOOL.
    Truth { at: usize },
    /// Bytes of several numbers, and such as belong to no variable: those are 0, and take no write.
    Spread { at: usize },
    /// The characters of the string at an offset of the state, from this byte of them on.
    Characters { text: usize, ty: StringType, index: usize },
}

/// A byte, and those around it that have the same view.
#[derive(Clone, Debug)]
pub(super) struct Run {
    pub(super) at: usize,
    /// With that one.
    pub(super) bytes: Range<usize>,
    /// They belong to no variable: they are 0, and take no write.
    pub(super) is_gap: bool,
}

impl Run {
    /// How many bytes there are from that one on, with it.
    pub(super) fn left(&self, up: bool) -> usize {
        if up { self.bytes.end - self.at } else { self.at - self.bytes.start + 1 }
    }
}

/// The objects of a program, by its words.
#[derive(Clone, Copy, Debug)]
pub struct Table<'t> {
    words: &'t [u32],
}

/// The parts of a table, for the compiler.
pub mod encode {
    use crate::Repr;

    pub const NUMBERS: u32 = 0;
    pub const TRUTHS: u32 = 1;
    pub const TEXT: u32 = 2;
    pub const EXACT: u32 = 3;
    pub const ARRAY: u32 = 4;
    pub const STRUCTURE: u32 = 5;

    /// Words before the objects.
    pub const HEAD: usize = 3;
    /// Words of an object.
    pub const OBJECT: usize = 5;

    /// The same in bytes, for native code.
    pub const HEAD_BYTES: i32 = 4 * HEAD as i32;
    pub const OBJECT_BYTES: i64 = 4 * OBJECT as i64;

    /// A number of its own for each repr.
    pub const fn repr(repr: Repr) -> u32 {
        repr as u32
    }
}

/// A node: what it is, its size, and two words whose meaning depends on what it is.
///
/// | kind | first | second | after it |
/// |---|---|---|---|
/// | `NUMBERS`, `TRUTHS` | the repr | | |
/// | `TEXT` | the capacity | 1 for a WSTRING | |
/// | `EXACT` | the type's number | 1 if it may be seen as bytes, too | |
/// | `ARRAY` | the type's number | the element's size | the element's node; the kind and the repr of the numbers that it consists of, through all dimensions |
/// | `STRUCTURE` | the type's number | the number of members | for each its offset and node |
#[derive(Clone, Copy, Debug)]
struct Node {
    kind: u32,
    size: usize,
    first: u32,
    second: u32,
}

impl Node {
    /// What a `TEXT` is.
    fn string_type(self) -> StringType {
        StringType { wide: self.second == 1, capacity: self.first as u16 }
    }

    /// Bytes of a `TEXT`'s characters.
    fn characters(self) -> usize {
        let ty = self.string_type();
        usize::from(ty.capacity) * ty.unit_size() as usize
    }
}

/// A part of the state, with where it begins.
#[derive(Clone, Copy, Debug)]
struct Found {
    node: Node,
    /// Where its words end.
    after: usize,
    start: usize,
}

impl<'t> Table<'t> {
    pub const fn new(words: &'t [u32]) -> Self {
        Self { words }
    }

    /// How many bytes the state has.
    pub fn state_size(&self) -> usize {
        self.state().map_or(0, |it| it.node.size)
    }

    fn word(&self, at: usize) -> u32 {
        self.words.get(at).copied().unwrap_or_default()
    }

    /// An object's offset in the state, and its size.
    pub fn object(&self, number: u32) -> Option<(usize, usize)> {
        let position = number.checked_sub(1).filter(|it| *it < self.word(0))?;
        let at = encode::HEAD + position as usize * encode::OBJECT;
        Some((self.word(at) as usize, self.word(at + 1) as usize))
    }

    /// Whether the object that a reference names exists: one in a pool may have been deleted.
    pub(super) fn check_is_there(&self, memory: &(impl Memory + ?Sized), bits: u64) -> Result<(), FaultKind> {
        let position = (Reference::from_bits(bits).object as usize).wrapping_sub(1);
        if position >= self.word(0) as usize {
            return Ok(());
        }
        let Some(mark) = self.word(encode::HEAD + position * encode::OBJECT + 3).checked_sub(1) else { return Ok(()) };
        let mut is_there = [0];
        memory.read(mark as usize, &mut is_there);
        if is_there[0] == 0 { Err(FaultKind::Deleted) } else { Ok(()) }
    }

    /// Whether all of the object is numbers.
    fn is_plain(&self, bits: u64) -> bool {
        let position = Reference::from_bits(bits).object.wrapping_sub(1) as usize;
        self.word(encode::HEAD + position.saturating_mul(encode::OBJECT).saturating_add(2)) > 0
    }

    /// The smallest object that holds the bytes.
    pub(super) fn holding(&self, offset: usize, size: usize) -> Option<u32> {
        let (mut low, mut high) = (0, self.word(0));
        while low < high {
            let middle = low + (high - low) / 2;
            let begins_later = self.object(middle + 1).is_some_and(|(start, _)| start > offset);
            if begins_later { high = middle } else { low = middle + 1 }
        }
        // Objects that begin at one offset are in the order of their sizes, the largest first, so that
        // the first that is met from here holds no other.
        (1..=low)
            .rev()
            .find(|number| self.object(*number).is_some_and(|(start, length)| offset + size <= start + length))
    }

    /// The place at `distance` bytes from where a reference points, as `view` wants to see it.
    pub fn part(&self, bits: u64, distance: u64, view: View) -> Result<Part, FaultKind> {
        let (offset, rest) = self.locate(bits, distance)?;
        if matches!(view, View::Number(size) if size as usize <= rest) && self.is_plain(bits) {
            return Ok(Part::Bytes { at: offset, rest });
        }
        let around = self.around(bits);
        let leaf = around.and_then(|it| self.leaf(it, offset));
        let Some(found) = leaf else { return self.spread(around, offset, rest, view) };
        let index = offset - found.start;
        let left = found.node.size - index;
        match (found.node.kind, view) {
            // What a text in a structure or array takes beyond its characters is as bytes between members.
            (encode::TEXT, View::Number(1))
                if index > found.node.characters() && around.is_some_and(|it| it.node.kind != encode::TEXT) =>
            {
                Ok(Part::Spread { at: offset })
            }
            (encode::TEXT, View::Number(1)) => self.characters(found, index),
            (encode::TEXT, View::Number(2)) if found.node.string_type().wide => self.units(found, index),
            (encode::TEXT, View::Text { wide }) if found.node.string_type().wide == wide => self.units(found, index),
            (encode::NUMBERS, View::Number(size)) => {
                if size as usize <= left.min(rest) {
                    Ok(Part::Bytes { at: offset, rest: left.min(rest) })
                } else {
                    self.spread(around, offset, rest, view)
                }
            }
            (encode::EXACT, View::Number(1)) if found.node.second == 1 => Ok(Part::Bytes { at: offset, rest: left }),
            (encode::NUMBERS, View::Truth) | (encode::TRUTHS, View::Truth | View::Number(1)) => {
                Ok(Part::Truth { at: offset })
            }
            (encode::NUMBERS, View::Text { .. }) => Ok(Part::Bytes { at: offset, rest: left.min(rest) }),
            (encode::EXACT, View::Exact(id)) if found.node.first == id && index == 0 => {
                Ok(Part::Bytes { at: offset, rest: left })
            }
            _ => Err(FaultKind::ForbiddenView),
        }
    }

    /// Where the byte is that a reference leads to, if it is nothing but a byte, with those around it in the same variable of
    /// the object; or if it belongs to no variable.
    pub(super) fn run(&self, bits: u64) -> Option<Run> {
        let (at, rest) = self.locate(bits, 0).ok()?;
        let (start, _) = self.object(Reference::from_bits(bits).object)?;
        let end = at + rest;
        if self.is_plain(bits) {
            return Some(Run { at, bytes: start..end, is_gap: false });
        }
        let Some(found) = self.leaf(self.around(bits)?, at) else {
            return Some(Run { at, bytes: at..at + 1, is_gap: true });
        };
        let is_bytes = found.node.kind == encode::NUMBERS || found.node.kind == encode::EXACT && found.node.second == 1;
        let bytes = start.max(found.start)..end.min(found.start + found.node.size);
        is_bytes.then_some(Run { at, bytes, is_gap: false })
    }

    /// A number across several variables, which are all numbers, and the bytes between them.
    fn spread(&self, around: Option<Found>, offset: usize, rest: usize, view: View) -> Result<Part, FaultKind> {
        let View::Number(size) = view else { return Err(FaultKind::ForbiddenView) };
        let size = size as usize;
        if rest < size {
            return Err(FaultKind::OutsideObject);
        }
        let mut at = offset;
        while at < offset + size {
            at = match around.and_then(|it| self.leaf(it, at)) {
                None => at + 1,
                Some(found) if found.node.kind == encode::NUMBERS => found.start + found.node.size,
                Some(_) => return Err(FaultKind::ForbiddenView),
            };
        }
        Ok(Part::Spread { at: offset })
    }

    /// Whether the byte is a number's.
    pub(super) fn is_number(&self, offset: usize) -> bool {
        let leaf = self.state().and_then(|it| self.leaf(it, offset));
        leaf.is_some_and(|it| it.node.kind == encode::NUMBERS)
    }

    /// Characters from a byte of them on.
    fn characters(&self, found: Found, index: usize) -> Result<Part, FaultKind> {
        let ty = found.node.string_type();
        // A string of full length ends with a zero, too.
        if index >= found.node.characters() + ty.unit_size() as usize {
            return Err(FaultKind::OutsideObject);
        }
        Ok(Part::Characters { text: found.start, ty, index })
    }

    /// Characters from one of them on.
    fn units(&self, found: Found, index: usize) -> Result<Part, FaultKind> {
        if index.checked_rem(found.node.string_type().unit_size() as usize) != Some(0) {
            return Err(FaultKind::MisalignedReference);
        }
        self.characters(found, index)
    }

    /// Where a variable of exactly this type lies: the offset in the state. `repr` for a number or a BOOL,
    /// the capacity for a string, else the type's number, which arrays and structures have, too.
    pub fn find(
        &self,
        memory: &(impl Memory + ?Sized),
        bits: u64,
        distance: u64,
        wanted: Wanted,
    ) -> Result<usize, FaultKind> {
        self.check_is_there(memory, bits)?;
        let (offset, rest) = self.locate_up_to_end(bits, distance)?;
        // An instance without variables has no bytes, and may be at the object's end.
        if self.finds(self.around(bits), offset, wanted) {
            return Ok(offset);
        }
        if rest == 0 {
            return Err(FaultKind::OutsideObject);
        }
        // What is not within the object may be around it: the structure of which it is the first member.
        if self.finds(self.state(), offset, wanted) { Ok(offset) } else { Err(FaultKind::ForbiddenView) }
    }

    /// Whether a variable of this type is at an offset in what was `found`.
    fn finds(&self, mut found: Option<Found>, offset: usize, wanted: Wanted) -> bool {
        while let Some(at) = found {
            let index = offset - at.start;
            // Only what has no bytes may be where another part ends.
            if index >= at.node.size && at.node.size > 0 && !matches!(at.node.kind, encode::STRUCTURE) {
                return false;
            }
            let is_it = match (at.node.kind, wanted) {
                (encode::NUMBERS | encode::TRUTHS, Wanted::Repr(repr)) => {
                    at.node.first == encode::repr(repr) && index.checked_rem(repr.size() as usize) == Some(0)
                }
                (encode::TEXT, Wanted::Text(ty)) => index == 0 && at.node.string_type() == ty,
                (encode::EXACT | encode::ARRAY | encode::STRUCTURE, Wanted::Exact(id)) => {
                    index == 0 && at.node.first == id
                }
                _ => false,
            };
            if is_it || self.has_empty_part(at, offset, wanted) {
                return true;
            }
            found = self.below(at, offset);
        }
        false
    }

    /// The offset in the state, and how many bytes of the object follow.
    fn locate(&self, bits: u64, distance: u64) -> Result<(usize, usize), FaultKind> {
        self.locate_up_to_end(bits, distance)
            .and_then(|it| if it.1 == 0 { Err(FaultKind::OutsideObject) } else { Ok(it) })
    }

    /// The same, where there may be no bytes.
    fn locate_up_to_end(&self, bits: u64, distance: u64) -> Result<(usize, usize), FaultKind> {
        let reference = Reference::from_bits(bits);
        if reference.object == 0 {
            return Err(FaultKind::NullReference);
        }
        let (start, size) = self.object(reference.object).ok_or(FaultKind::OutsideObject)?;
        let offset = (u64::from(reference.address) + distance).checked_sub(u64::from(ORIGIN));
        let position = offset.and_then(|it| usize::try_from(it).ok()?.checked_sub(start));
        match position {
            Some(position) if position <= size => Ok((start + position, size - position)),
            Some(_) | None => Err(FaultKind::OutsideObject),
        }
    }

    fn state(&self) -> Option<Found> {
        self.node(self.word(1) as usize, 0)
    }

    /// The object that a reference names.
    fn around(&self, bits: u64) -> Option<Found> {
        let position = Reference::from_bits(bits).object.checked_sub(1).filter(|it| *it < self.word(0))?;
        let at = encode::HEAD + position as usize * encode::OBJECT;
        self.node(self.word(at + 4) as usize, self.word(at) as usize)
    }

    fn node(&self, at: usize, start: usize) -> Option<Found> {
        let &[kind, size, first, second] = self.words.get(at..at + 4)? else { return None };
        Some(Found { node: Node { kind, size: size as usize, first, second }, after: at + 4, start })
    }

    /// The part of an array or structure that holds the byte at `offset`.
    fn below(&self, found: Found, offset: usize) -> Option<Found> {
        let inside = offset - found.start;
        match found.node.kind {
            encode::ARRAY => {
                let stride = found.node.second as usize;
                let position = inside.checked_div(stride)?;
                self.node(self.word(found.after) as usize, found.start + position * stride)
            }
            encode::STRUCTURE => {
                let part = self.nth_part(found, self.parts_up_to(found, inside).checked_sub(1)?)?;
                (offset < part.start + part.node.size).then_some(part)
            }
            _ => None,
        }
    }

    /// How many parts of a structure begin at a byte of it or before.
    fn parts_up_to(&self, found: Found, inside: usize) -> usize {
        let (mut low, mut high) = (0, found.node.second as usize);
        while low < high {
            let middle = low + (high - low) / 2;
            if self.word(found.after + 2 * middle) as usize > inside { high = middle } else { low = middle + 1 }
        }
        low
    }

    fn nth_part(&self, found: Found, number: usize) -> Option<Found> {
        let at = found.after + 2 * number;
        self.node(self.word(at + 1) as usize, found.start + self.word(at) as usize)
    }

    /// Whether an instance without variables is part of a structure, before what holds the byte.
    fn has_empty_part(&self, found: Found, offset: usize, wanted: Wanted) -> bool {
        let (encode::STRUCTURE, Wanted::Exact(id)) = (found.node.kind, wanted) else { return false };
        let parts = (0..self.parts_up_to(found, offset - found.start)).rev();
        let mut there = parts.map_while(|it| self.nth_part(found, it).filter(|it| it.start == offset));
        there.any(|it| it.node.size == 0 && it.node.first == id)
    }

    /// The variable without parts in what is `found` that holds the byte, or the array of numbers.
    fn leaf(&self, mut found: Found, offset: usize) -> Option<Found> {
        loop {
            match (found.node.kind, self.word(found.after + 1)) {
                (encode::ARRAY, kind @ (encode::NUMBERS | encode::TRUTHS)) => {
                    // Numbers one after the other are looked at as one run of them.
                    let node = Node { kind, first: self.word(found.after + 2), ..found.node };
                    return Some(Found { node, ..found });
                }
                (encode::ARRAY | encode::STRUCTURE, _) => found = self.below(found, offset)?,
                _ => return Some(found),
            }
        }
    }
}

/// The one type that a variable is wanted as, to be handed on whole.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wanted {
    Repr(Repr),
    Text(StringType),
    Exact(u32),
}

impl Wanted {
    /// As a number, for native code.
    pub const fn code(self) -> u32 {
        match self {
            Self::Repr(repr) => encode::repr(repr) << 2,
            Self::Text(ty) => 1 | (ty.wide as u32) << 2 | (ty.capacity as u32) << 3,
            Self::Exact(id) => 2 | id << 2,
        }
    }

    pub fn from_code(code: u32) -> Self {
        let repr = || Repr::ALL.into_iter().find(|it| encode::repr(*it) == code >> 2);
        match code & 3 {
            0 => Self::Repr(repr().unwrap_or(Repr::U8)),
            1 => Self::Text(StringType { wide: code & 4 != 0, capacity: (code >> 3) as u16 }),
            _ => Self::Exact(code >> 2),
        }
    }
}
