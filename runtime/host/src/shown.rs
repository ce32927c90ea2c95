//! Values of any type as Structured Text writes them, for people who look at one moment of a run.

use crate::map::{Map, Section, Type, Variable};
use crate::path::Place;
use crate::value::format;
use std::fmt::Write;

/// What is written where a value is longer than the room for it.
const MORE: char = '…';

/// The value of type `ty` at the start of `bytes`: `T#1s`, `'text'`, `(x := 1, y := 2)`, `[1, 2, …]`. After about `room`
/// characters the rest of arrays, structures and texts is left out.
pub fn shown(map: &Map, ty: Type, bytes: &[u8], room: usize) -> String {
    let mut shown = Shown { map, bytes, room, out: String::new() };
    shown.value(Place::of_type(ty));
    shown.out
}

struct Shown<'a> {
    map: &'a Map,
    bytes: &'a [u8],
    room: usize,
    out: String,
}

impl Shown<'_> {
    fn value(&mut self, place: Place) {
        let bytes = self.bytes.get(place.offset..).unwrap_or_default();
        match place.ty {
            Type::String(ty) | Type::Characters(ty) => self.text(place.ty, if ty.wide { '"' } else { '\'' }, bytes),
            Type::Elementary(it) if it.is_char() => {
                let quote = if self.map.size_of(place.ty) > 1 { '"' } else { '\'' };
                self.out.push(quote);
                format(self.map, place.ty, bytes, &mut self.out);
                self.out.push(quote);
            }
            Type::Elementary(_) | Type::Bit(_) | Type::Enum(_) | Type::Reference => {
                format(self.map, place.ty, bytes, &mut self.out);
            }
            Type::Array(_) => self.elements(place),
            Type::Struct(_) | Type::Block(_) => self.members(place),
        }
    }

    fn text(&mut self, ty: Type, quote: char, bytes: &[u8]) {
        let mut text = String::new();
        format(self.map, ty, bytes, &mut text);
        self.out.push(quote);
        for character in text.chars() {
            if self.is_full() {
                self.out.push(MORE);
                break;
            }
            // Writing to a String cannot fail.
            let _ = match character {
                '$' => write!(self.out, "$$"),
                '\n' => write!(self.out, "$N"),
                '\r' => write!(self.out, "$R"),
                '\t' => write!(self.out, "$T"),
                it if it == quote => write!(self.out, "${it}"),
                it if it.is_control() => write!(self.out, "${:02X}", u32::from(it)),
                it => write!(self.out, "{it}"),
            };
        }
        self.out.push(quote);
    }

    fn elements(&mut self, place: Place) {
        let Some(array) = self.map.array(place.ty) else { return };
        self.out.push('[');
        for position in 0..array.len() {
            if !self.separate(position) {
                break;
            }
            self.value(place.part(array.element, position * array.stride));
        }
        self.out.push(']');
    }

    fn members(&mut self, place: Place) {
        let Some(structure) = self.map.structure(place.ty) else { return };
        // What the compiler has added, and what an in-out refers to, is not a value of the user's.
        let is_shown =
            |it: &&Variable| !matches!(it.section, Section::Memory | Section::InOut) && !it.name.starts_with("__");
        self.out.push('(');
        for (position, member) in structure.members.iter().filter(is_shown).enumerate() {
            if !self.separate(position) {
                break;
            }
            self.out.push_str(&member.name);
            self.out.push_str(" := ");
            self.value(place.member(member));
        }
        self.out.push(')');
    }

    /// Whether there is room for one more part of a list.
    fn separate(&mut self, position: usize) -> bool {
        if position > 0 {
            self.out.push_str(", ");
        }
        let has_room = !self.is_full();
        if !has_room {
            self.out.push(MORE);
        }
        has_room
    }

    fn is_full(&self) -> bool {
        self.out.len() >= self.room
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture::map;
    use crate::path::resolve;
    use staunch_runtime::StringType;

    #[test]
    fn texts_are_quoted_as_literals_and_end_where_the_room_does() {
        let map = map();
        let text = |ty, bytes: &[u8], room| shown(&map, Type::String(ty), bytes, room);
        assert_eq!(text(StringType::narrow(5), &[5, 0, b'a', b'\'', b'$', b'\n', 1], 80), "'a$'$$$N$01'");
        assert_eq!(text(StringType::narrow(5), &[5, 0, b'a', b'b', b'c', b'd', b'e'], 4), "'abc…'");
    }

    #[test]
    fn an_instance_is_a_list_of_its_members() {
        let map = map();
        let place = resolve(&map, &[0], "c").unwrap();
        let bytes = vec![0; map.size_of(place.ty)];
        let all = shown(&map, place.ty, &bytes, 200);
        assert!(all.starts_with('(') && all.contains("CV := 0") && all.ends_with(')'), "{all}");
        let some = shown(&map, place.ty, &bytes, 12);
        assert!(some.ends_with(", …)") && some.len() < all.len(), "{some}");
    }
}
