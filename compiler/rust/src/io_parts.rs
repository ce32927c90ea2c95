//! What a structure or an array at a direct address is made of: each number in it is an input or output of its own.

use proc_macro2::{Literal, TokenStream};
use quote::quote;
use staunch_ir::{Address, ArrayId, FieldId, Repr, StructId, Type};

use crate::emitter::Emitter;

/// A number in the variable at an address.
pub struct Part {
    /// As traces name it, `heads[1].ready`.
    pub name: String,
    pub address: Address,
    pub repr: Repr,
    pub ty: Type,
    /// Where it is kept; nothing where that is some bits of another field.
    pub place: Option<TokenStream>,
}

/// The way to a part.
struct Way {
    name: String,
    place: Option<TokenStream>,
    /// From the start of the area, or of the module's part of it.
    bit: u64,
    /// It ends with an index.
    is_element: bool,
}

impl Emitter<'_> {
    /// The numbers in a variable; a text is none. `place` is where it is kept, if it is a field of its own.
    pub fn parts(&self, name: &str, ty: Type, place: Option<TokenStream>, address: Address) -> Vec<Part> {
        let mut parts = Vec::new();
        self.part(ty, Way { name: name.to_owned(), place, bit: address.bit, is_element: false }, address, &mut parts);
        parts
    }

    fn part(&self, ty: Type, way: Way, whole: Address, out: &mut Vec<Part>) {
        match ty {
            Type::Array(id) => self.elements(id, way, whole, out),
            Type::Struct(id) => self.members(id, &way, whole, out),
            Type::Elementary(_) | Type::Subrange(..) | Type::Enum(_) => {
                let Some(repr) = self.program.repr(ty) else { return };
                let width = u8::try_from(repr.size() * 8).unwrap_or(u8::MAX);
                // What an odd byte begins has no address of its own width.
                let width = if way.bit.is_multiple_of(width.into()) { width } else { 8 };
                let address = Address { bit: way.bit, width, ..whole };
                out.push(Part { name: way.name, address, repr, ty, place: way.place });
            }
            Type::String(_) | Type::Block(_) | Type::Reference(_) => {}
        }
    }

    /// The indices of nested arrays are in one pair of brackets.
    fn elements(&self, id: ArrayId, way: Way, whole: Address, out: &mut Vec<Part>) {
        let array = self.program.array(id);
        for (position, index) in (0_u64..).zip(array.low..=array.high) {
            let number = Literal::u64_unsuffixed(position);
            let name = match way.name.strip_suffix(']').filter(|_| way.is_element) {
                Some(outer) => format!("{outer},{index}]"),
                None => format!("{}[{index}]", way.name),
            };
            let place = way.place.as_ref().map(|it| quote!(#it[#number]));
            let bit = way.bit + 8 * self.layout.stride(id) * position;
            self.part(array.element, Way { name, place, bit, is_element: true }, whole, out);
        }
    }

    fn members(&self, id: StructId, way: &Way, whole: Address, out: &mut Vec<Part>) {
        let structure = self.program.structure(id);
        for (at, field) in structure.fields.iter().enumerate() {
            let at = FieldId::next(at);
            let member = self.names.field(id, at);
            let place = way.place.as_ref().map(|it| quote!(#it.#member));
            let bit = way.bit + 8 * self.layout.field(id, at);
            let name = format!("{}.{}", way.name, field.name);
            self.part(field.ty, Way { name, place, bit, is_element: false }, whole, out);
        }
    }
}
