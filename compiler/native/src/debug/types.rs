//! Types: what a debugger shows of a variable, and how.

use super::entries::{Entries, is_declared};
use gimli::constants::{
    DW_AT_bit_size, DW_AT_byte_size, DW_AT_byte_stride, DW_AT_const_value, DW_AT_data_bit_offset,
    DW_AT_data_member_location, DW_AT_decimal_scale, DW_AT_encoding, DW_AT_lower_bound, DW_AT_upper_bound,
    DW_ATE_boolean, DW_ATE_float, DW_ATE_signed, DW_ATE_signed_fixed, DW_ATE_unsigned, DW_ATE_unsigned_char,
    DW_ATE_unsigned_fixed, DW_TAG_array_type, DW_TAG_base_type, DW_TAG_enumeration_type, DW_TAG_enumerator,
    DW_TAG_member, DW_TAG_pointer_type, DW_TAG_structure_type, DW_TAG_subrange_type, DW_TAG_typedef, DwAte,
};
use gimli::write::{AttributeValue, UnitEntryId};
use staunch_ir::{
    ArrayId, BlockId, BoundsId, Elementary, EnumId, FieldId, Overlay, RefKind, Repr, StringType, StructId, Type, Value,
};
use staunch_runtime::Class;
use staunch_runtime::reference::CLASS;

/// A unit of times is so many powers of ten of a second.
const NANO: i64 = -9;

impl Entries<'_> {
    /// The entry of a type.
    pub(crate) fn type_of(&mut self, ty: Type) -> UnitEntryId {
        if let Some(known) = self.types.get(&ty) {
            return *known;
        }
        let id = match ty {
            Type::Elementary(it) => self.elementary(it),
            Type::String(it) => self.string(it),
            Type::Enum(it) => self.enumeration(it),
            Type::Subrange(of, bounds) => self.subrange(of, bounds),
            Type::Array(it) => self.array(it),
            Type::Struct(it) => self.structure(it),
            Type::Block(it) => self.block(it),
            Type::Reference(id) => self.reference(ty, self.program.references[id.index()].kind),
        };
        self.types.insert(ty, id);
        self.name_type(ty, id);
        id
    }

    /// Debuggers of Pascal look types up among variables, where structures and enumerations are not. Nor are function blocks, which have the
    /// name of their routine.
    fn name_type(&mut self, ty: Type, id: UnitEntryId) {
        let program = self.program;
        let is_state = |it| program.globals == it || program.classes.iter().any(|class| class.state == it);
        let is_looked_up = match ty {
            Type::Enum(_) | Type::Block(_) => true,
            Type::Struct(it) => !is_state(it),
            Type::Elementary(_) | Type::String(_) | Type::Subrange(..) | Type::Array(_) | Type::Reference(_) => false,
        };
        if is_looked_up {
            let name = self.add_named(self.root(), DW_TAG_typedef, &program.type_name(ty));
            self.set_type(name, id);
        }
    }

    /// A pointer of the machine to a variable.
    pub(crate) fn pointer_to(&mut self, ty: Type) -> UnitEntryId {
        if let Some(known) = self.pointers.get(&ty) {
            return *known;
        }
        let target = self.type_of(ty);
        let id = self.add(self.root(), DW_TAG_pointer_type);
        self.set(id, DW_AT_byte_size, AttributeValue::Udata(8));
        self.set_type(id, target);
        self.pointers.insert(ty, id);
        id
    }

    /// A reference that is a part of something: the address in it, and of an INTERFACE the class.
    fn reference(&mut self, ty: Type, kind: RefKind) -> UnitEntryId {
        let id = self.add_named(self.root(), DW_TAG_structure_type, &self.program.type_name(ty));
        self.set(id, DW_AT_byte_size, AttributeValue::Udata(8));
        let address = self.type_of(Type::Elementary(Elementary::Udint));
        self.member(id, "at", address, 0);
        if let RefKind::Interface(interface) = kind {
            let classes = self.program.implementers.get(interface.index()).cloned().unwrap_or_default();
            let ty = self.classes(&classes);
            let class = self.add_named(id, DW_TAG_member, "is");
            self.set_type(class, ty);
            self.set(class, DW_AT_bit_size, AttributeValue::Udata(u64::from(u64::BITS - CLASS)));
            self.set(class, DW_AT_data_bit_offset, AttributeValue::Udata(CLASS.into()));
        }
        id
    }

    /// The numbers of classes in references, by the names of the classes.
    fn classes(&mut self, classes: &[(u64, StructId)]) -> UnitEntryId {
        let of = self.type_of(Type::Elementary(Elementary::Ulint));
        let id = self.add(self.root(), DW_TAG_enumeration_type);
        self.set(id, DW_AT_byte_size, AttributeValue::Udata(8));
        self.set_type(id, of);
        let none = self.add_named(id, DW_TAG_enumerator, "none");
        self.set(none, DW_AT_const_value, AttributeValue::Udata(0));
        for (number, state) in classes {
            let name = self.add_named(id, DW_TAG_enumerator, &self.program.structure(*state).name);
            self.set(name, DW_AT_const_value, AttributeValue::Udata(*number));
        }
        id
    }

    /// A variable of a type at each address up to `last`.
    pub(crate) fn at_each_byte(&mut self, ty: Type, last: u64) -> UnitEntryId {
        let element = self.type_of(ty);
        let id = self.sequence(element, (0, i64::try_from(last).unwrap_or(i64::MAX)));
        self.set(id, DW_AT_byte_stride, AttributeValue::Udata(1));
        id
    }

    fn base(&mut self, name: &str, encoding: DwAte, size: u64) -> UnitEntryId {
        let id = self.add_named(self.root(), DW_TAG_base_type, name);
        self.set(id, DW_AT_encoding, AttributeValue::Encoding(encoding));
        self.set(id, DW_AT_byte_size, AttributeValue::Udata(size));
        id
    }

    fn elementary(&mut self, it: Elementary) -> UnitEntryId {
        let (name, size) = (it.own_name(), u64::from(it.repr().size()));
        match it.class() {
            Class::Duration | Class::Date => self.seconds(name, it.repr()),
            Class::Char => self.base(name, DW_ATE_unsigned_char, size),
            _ => self.base(name, encoding(it.repr()), size),
        }
    }

    /// Times are numbers of nanoseconds: with a scale, a debugger shows seconds. It does so for a Pascal type only if that is a
    /// range of them.
    fn seconds(&mut self, name: &str, repr: Repr) -> UnitEntryId {
        let encoding = if repr.is_signed() { DW_ATE_signed_fixed } else { DW_ATE_unsigned_fixed };
        let of = self.base(name, encoding, 8);
        self.set(of, DW_AT_decimal_scale, AttributeValue::Sdata(NANO));
        let id = self.add_named(self.root(), DW_TAG_subrange_type, name);
        self.set_type(id, of);
        let (low, high) = repr.range().expect("a number of nanoseconds is an integer");
        self.set(id, DW_AT_lower_bound, limit(low));
        self.set(id, DW_AT_upper_bound, limit(high));
        id
    }

    /// Debuggers know a Pascal string by the names of these members.
    fn string(&mut self, it: StringType) -> UnitEntryId {
        let id = self.add_named(self.root(), DW_TAG_structure_type, &self.program.type_name(Type::String(it)));
        self.set(id, DW_AT_byte_size, AttributeValue::Udata(it.size().into()));
        let length = self.type_of(Type::Elementary(Elementary::Uint));
        self.member(id, "length", length, 0);
        let unit = self.type_of(Type::Elementary(if it.wide { Elementary::Wchar } else { Elementary::Char }));
        let units = self.sequence(unit, (1, i64::from(it.capacity)));
        self.member(id, "st", units, 2);
        id
    }

    fn sequence(&mut self, element: UnitEntryId, (low, high): (i64, i64)) -> UnitEntryId {
        let id = self.add(self.root(), DW_TAG_array_type);
        self.set_type(id, element);
        let index = self.type_of(Type::LINT);
        let range = self.add(id, DW_TAG_subrange_type);
        self.set_type(range, index);
        self.set(range, DW_AT_lower_bound, AttributeValue::Sdata(low));
        self.set(range, DW_AT_upper_bound, AttributeValue::Sdata(high));
        id
    }

    fn array(&mut self, id: ArrayId) -> UnitEntryId {
        let array = self.program.array(id);
        let element = self.type_of(array.element);
        self.sequence(element, (array.low, array.high))
    }

    fn enumeration(&mut self, id: EnumId) -> UnitEntryId {
        let program = self.program;
        let it = program.enumeration(id);
        let of = self.type_of(Type::Elementary(it.base));
        let entry = self.add_named(self.root(), DW_TAG_enumeration_type, &it.name);
        self.set(entry, DW_AT_byte_size, AttributeValue::Udata(u64::from(it.base.repr().size())));
        self.set_type(entry, of);
        for value in &it.values {
            let name = self.add_named(entry, DW_TAG_enumerator, &value.name);
            self.set(name, DW_AT_const_value, number(value.value));
        }
        entry
    }

    fn subrange(&mut self, of: Elementary, bounds: BoundsId) -> UnitEntryId {
        let name = self.program.type_name(Type::Subrange(of, bounds));
        let (low, high) = self.program.bounds(bounds);
        let of = self.type_of(Type::Elementary(of));
        let id = self.add_named(self.root(), DW_TAG_subrange_type, &name);
        self.set_type(id, of);
        self.set(id, DW_AT_lower_bound, limit(low));
        self.set(id, DW_AT_upper_bound, limit(high));
        id
    }

    fn structure(&mut self, id: StructId) -> UnitEntryId {
        let program = self.program;
        let it = program.structure(id);
        let entry = self.add_named(self.root(), DW_TAG_structure_type, &it.name);
        self.set(entry, DW_AT_byte_size, AttributeValue::Udata(self.layout.size(Type::Struct(id))));
        for (at, field) in it.fields.iter().enumerate() {
            let at = FieldId::next(at);
            if !it.is_storage(at) && is_declared(&field.name) {
                let ty = self.type_of(field.ty);
                self.member(entry, &field.name, ty, self.layout.field(id, at));
            }
        }
        for overlay in &it.overlays {
            self.overlay(entry, overlay, self.layout.field(id, overlay.field));
        }
        entry
    }

    pub(crate) fn member(&mut self, of: UnitEntryId, name: &str, ty: UnitEntryId, offset: u64) {
        let id = self.add_named(of, DW_TAG_member, name);
        self.set_type(id, ty);
        self.set(id, DW_AT_data_member_location, AttributeValue::Udata(offset));
    }

    /// A member that is bits of others. A text in a UNION has no length.
    fn overlay(&mut self, of: UnitEntryId, overlay: &Overlay, field: u64) {
        let bit = field * 8 + overlay.bit;
        let ty = match overlay.ty {
            Type::String(it) => self.characters(it),
            other => self.type_of(other),
        };
        if !overlay.is_bit && bit.is_multiple_of(8) {
            return self.member(of, &overlay.name, ty, bit / 8);
        }
        let size = if overlay.is_bit { 1 } else { self.layout.size(overlay.ty) * 8 };
        let id = self.add_named(of, DW_TAG_member, &overlay.name);
        self.set_type(id, ty);
        self.set(id, DW_AT_bit_size, AttributeValue::Udata(size));
        self.set(id, DW_AT_data_bit_offset, AttributeValue::Udata(bit));
    }

    fn characters(&mut self, it: StringType) -> UnitEntryId {
        let unit = self.type_of(Type::Elementary(if it.wide { Elementary::Wchar } else { Elementary::Char }));
        self.sequence(unit, (0, i64::from(it.capacity)))
    }

    fn block(&mut self, id: BlockId) -> UnitEntryId {
        let info = id.info();
        let entry = self.add_named(self.root(), DW_TAG_structure_type, info.name);
        self.set(entry, DW_AT_byte_size, AttributeValue::Udata(self.layout.size(Type::Block(id))));
        for (at, pin) in info.pins.iter().enumerate() {
            let at = FieldId::next(at);
            let ty = self.type_of(id.pin_type(at).expect("position of a pin"));
            self.member(entry, pin.name, ty, self.layout.offset(Type::Block(id), at));
        }
        entry
    }
}

fn encoding(repr: Repr) -> DwAte {
    match repr {
        Repr::Bool => DW_ATE_boolean,
        Repr::I8 | Repr::I16 | Repr::I32 | Repr::I64 => DW_ATE_signed,
        Repr::U8 | Repr::U16 | Repr::U32 | Repr::U64 => DW_ATE_unsigned,
        Repr::F32 | Repr::F64 => DW_ATE_float,
    }
}

fn number(value: Value) -> AttributeValue {
    limit(value.as_integer().unwrap_or_default())
}

fn limit(value: i128) -> AttributeValue {
    match i64::try_from(value) {
        Ok(value) => AttributeValue::Sdata(value),
        Err(_) => AttributeValue::Udata(u64::try_from(value).unwrap_or(u64::MAX)),
    }
}
