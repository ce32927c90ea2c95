//! Addresses: what loads, stores and copies take.

use cranelift_codegen::ir as clif;
use staunch_ir::{FieldId, StructId};
use staunch_runtime::BlockInfo;

/// A pointer and a constant distance from it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Address {
    pub(crate) base: clif::Value,
    pub(crate) offset: u64,
    pub(crate) kind: Kind,
}

/// What is known of who else may have a variable's storage.
///
/// Two scalars of different classes are different storage: that of each field of a structure, and of each pin of a standard
/// block, is one class in all routines, whatever leads to it. So an element of an array in a structure, and what a structure
/// is that is passed on, stay what they are in a callee. Classes are few, and several fields may share one.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Kind {
    /// It may be any variable: a number that is passed by reference, an element of an array that is, or what a reference leads to.
    Any,
    /// It is the frame's, a constant's or the context's.
    Own,
    Class(Class),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Class(u8);

impl Class {
    /// The turns that are left in the context.
    pub(crate) const TURNS: Self = Self(128);
    const COUNT: usize = 128;

    pub(crate) fn of_field(of: StructId, field: FieldId) -> Self {
        Self::of(of.index() * 31 + field.index())
    }

    pub(crate) fn of_pin(block: &BlockInfo, pin: usize) -> Self {
        let name = block.name.bytes().fold(0, |sum: usize, byte| sum * 5 % 8192 + usize::from(byte));
        Self::of(name + pin)
    }

    fn of(number: usize) -> Self {
        Self(u8::try_from(number % Self::COUNT).expect("less than 128"))
    }

    /// As the code generator calls it; the same in all functions.
    pub(crate) fn user_id(self) -> u32 {
        u32::from(self.0)
    }
}

impl Address {
    pub(crate) fn at(base: clif::Value) -> Self {
        Self { base, offset: 0, kind: Kind::Any }
    }

    /// Of storage that only the code of one function has.
    pub(crate) fn own(base: clif::Value) -> Self {
        Self { kind: Kind::Own, ..Self::at(base) }
    }

    #[must_use]
    pub(crate) fn plus(self, offset: u64) -> Self {
        Self { offset: self.offset + offset, ..self }
    }

    #[must_use]
    pub(crate) fn of(self, class: Class) -> Self {
        Self { kind: Kind::Class(class), ..self }
    }

    /// The distance as instructions carry it.
    pub(crate) fn displacement(self) -> i32 {
        i32::try_from(self.offset).expect("verified IR: sizes are within 1 GiB")
    }
}
