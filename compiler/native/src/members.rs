//! The members of a standard block whose step is emitted in place.

use crate::address::{Address, Class};
use crate::function::Function;
use crate::signature::clif_type;
use cranelift_codegen::ir::{InstBuilder, Value as Clif};
use staunch_runtime::{BlockInfo, Pin};

/// A block's members, by the names of their Rust fields.
pub(crate) struct Members<'s, 'a, 'p> {
    pub(crate) f: &'s mut Function<'a, 'p>,
    pub(crate) info: &'static BlockInfo,
    pub(crate) at: Address,
}

impl Members<'_, '_, '_> {
    pub(crate) fn pin(&self, field: &str) -> &'static Pin {
        let pin = self.info.pins.iter().find(|pin| pin.field == field);
        pin.expect("a block of the table has the members that its step uses")
    }

    pub(crate) fn member(&self, field: &str) -> Address {
        let at = self.info.pins.iter().position(|pin| pin.field == field);
        let at = at.expect("a block of the table has the members that its step uses");
        self.at.plus(offset(self.info.pins[at].offset)).of(Class::of_pin(self.info, at))
    }

    pub(crate) fn load(&mut self, field: &str) -> Clif {
        let (repr, from) = (self.pin(field).repr(), self.member(field));
        self.f.load_as(clif_type(repr), from)
    }

    pub(crate) fn store(&mut self, field: &str, value: Clif) {
        let to = self.member(field);
        self.f.store(value, to);
    }

    /// A rising edge of `input`, which is also remembered.
    pub(crate) fn edge(&mut self, field: &str, input: Clif) -> Clif {
        let memory = format!("{field}_before");
        let before = self.load(&memory);
        self.store(&memory, input);
        self.f.ins().band_not(input, before)
    }
}

/// The offset of a pin in its block.
pub(crate) fn offset(of_pin: usize) -> u64 {
    u64::try_from(of_pin).expect("blocks are small")
}
