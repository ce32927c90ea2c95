//! Addresses: what loads, stores and copies take.

use cranelift_codegen::ir as clif;

/// A pointer and a constant distance from it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Address {
    pub(crate) base: clif::Value,
    pub(crate) offset: u64,
}

impl Address {
    pub(crate) fn at(base: clif::Value) -> Self {
        Self { base, offset: 0 }
    }

    #[must_use]
    pub(crate) fn plus(self, offset: u64) -> Self {
        Self { offset: self.offset + offset, ..self }
    }

    /// The distance as instructions carry it.
    pub(crate) fn displacement(self) -> i32 {
        i32::try_from(self.offset).expect("verified IR: sizes are within 1 GiB")
    }
}
