//! The inner loop of a cyclic redundancy check is one look-up.
//!
//! ```text
//! FOR k := 1 TO 8 DO
//!     IF crc.0 THEN crc := SHR(crc, 1) XOR 16#A001;      crc := SHR(crc, 8) XOR added[crc AND 255];
//!     ELSE crc := SHR(crc, 1); END_IF                    k := 9;
//! END_FOR
//! ```
//!
//! It applies to the loops that [`shifted`] finds. The table is a constant of 256 numbers of the bit string's size. It may not assume
//! which polynomial is meant: the table is what the statements themselves do to each byte.

use crate::address::Address;
use crate::function::{Flow, Function};
use crate::place::PlaceValue;
use crate::signature::clif_type;
use crate::target::Aim;
use cranelift_codegen::ir::{self as clif, InstBuilder, InstructionData, Opcode, types};
use staunch_ir::layout::usize_of;
use staunch_ir::shifted::{Shifted, shifted};
use staunch_ir::{For, Location};

/// The bits of a byte.
const BYTE: i64 = 8;

impl<'p> Function<'_, 'p> {
    /// The loop as a look-up, where it is one.
    pub(crate) fn looked_up_by_table(&mut self, it: &'p For, at: Location) -> Option<Flow> {
        let found = (self.module.aim == Aim::Speed).then(|| shifted(it))??;
        let running = self.start_for(it, at);
        let before = self.load_place(found.register);
        let after = self.shifted_by_a_byte(&found, before);
        match self.place_value(found.register) {
            PlaceValue::Variable(variable) => self.builder.def_var(variable, after),
            PlaceValue::Memory(address) => self.store(after, address),
        }
        let end = self.integer(types::I64, running.end().expect("the loop's ends are constant"));
        self.set_counter(&running, end, true);
        self.set_late(&running);
        Some(Flow::Continues)
    }

    fn shifted_by_a_byte(&mut self, it: &Shifted<'_>, before: clif::Value) -> clif::Value {
        let (ty, size) = (clif_type(it.repr), usize_of(it.repr.size().into()));
        let rest = i64::from(ty.bits()) - BYTE;
        let byte = match (it.is_up, rest) {
            (_, 0) => before,
            (true, _) => self.ins().ushr_imm_u(before, rest),
            (false, _) => self.ins().ireduce(types::I8, before),
        };
        let position = if ty == types::I64 && it.is_up { byte } else { self.ins().uextend(types::I64, byte) };
        let distance = self.ins().imul_imm_s(position, i64::from(ty.bytes()));
        let bytes = it.added.iter().flat_map(|it| it.to_le_bytes().into_iter().take(size)).collect();
        let table = self.data(bytes);
        let entry = self.ins().iadd(table.base, distance);
        let added = self.load_as(ty, Address { base: entry, ..table });
        if rest == 0 {
            return added;
        }
        let stays = self.without_byte(before, it.is_up);
        let shifted = if it.is_up { self.ins().ishl_imm_u(stays, BYTE) } else { self.ins().ushr_imm_u(stays, BYTE) };
        self.ins().bxor(shifted, added)
    }

    /// A value whose bits are the same, but for those of the byte that leaves: what was added to them is not needed.
    fn without_byte(&self, value: clif::Value, is_up: bool) -> clif::Value {
        let Some(InstructionData::Binary { opcode: Opcode::Bxor, args }) = self.instruction(value) else {
            return value;
        };
        let rest = i64::from(self.builder.func.dfg.value_type(value).bits()) - BYTE;
        let is_byte = |it: clif::Value| match self.instruction(it) {
            Some(InstructionData::Unary { opcode: Opcode::Uextend, arg }) if !is_up => {
                self.builder.func.dfg.value_type(*arg) == types::I8
            }
            Some(InstructionData::Binary { opcode: Opcode::Ishl, args: [_, by] }) if is_up => {
                matches!(self.instruction(*by), Some(InstructionData::UnaryImm { imm, .. }) if imm.bits() == rest)
            }
            _ => false,
        };
        match args {
            [rest, added] | [added, rest] if is_byte(*added) => *rest,
            _ => value,
        }
    }
}
