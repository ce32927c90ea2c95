//! The test of one bit.
//!
//! ```text
//! (SHR(w, 3) AND 1) <> 0        (w AND 8) <> 0
//! (w AND 16#80) = 16#80         (w AND 16#80) <> 0
//! w.3                           (w AND 8) <> 0
//! ```
//!
//! It applies to a comparison of an AND that leaves one bit with a constant, by = or <>, and to its conversion to BOOL: machines test bits against zero in one
//! instruction. It may not assume that a bit comes from the word that is shifted: one that a shift has moved in is zero, and
//! such a comparison stays as it is.

use crate::function::Function;
use cranelift_codegen::ir::condcodes::IntCC;
use cranelift_codegen::ir::{InstBuilder, InstructionData, Opcode, Value as Clif};

/// The comparison of two integers, if it is one of a bit.
pub(crate) fn test(f: &mut Function<'_, '_>, is_equal: bool, a: Clif, b: Clif) -> Option<Clif> {
    let wanted = f.known_bits(b)?;
    let InstructionData::Binary { opcode: Opcode::Band, args: [value, mask] } = *f.instruction(a)? else { return None };
    let bit = f.known_bits(mask).filter(|it| it.is_power_of_two() && (wanted == 0 || wanted == *it))?;
    let condition = if is_equal == (wanted == 0) { IntCC::Equal } else { IntCC::NotEqual };
    let (value, bit) = before_shift(f, value, bit).unwrap_or((value, bit));
    let ty = f.builder.func.dfg.value_type(value);
    let bit = f.integer(ty, i128::from(bit));
    let masked = f.ins().band(value, bit);
    Some(f.ins().icmp_imm_u(condition, masked, 0))
}

/// What is shifted to the right by a constant, and where the bit is in it.
fn before_shift(f: &Function<'_, '_>, value: Clif, bit: u64) -> Option<(Clif, u64)> {
    let InstructionData::Binary { opcode: Opcode::Ushr, args: [word, count] } = *f.instruction(value)? else {
        return None;
    };
    let position = u64::from(bit.trailing_zeros()).checked_add(f.known_bits(count)?)?;
    let width = u64::from(f.builder.func.dfg.value_type(word).bits());
    (position < width).then(|| (word, 1 << position))
}

impl Function<'_, '_> {
    /// The bits of an integer that is known: the low ones of a constant.
    pub(crate) fn known_bits(&self, value: Clif) -> Option<u64> {
        let bits = match *self.instruction(value)? {
            InstructionData::UnaryImm { opcode: Opcode::Iconst, imm } => imm.bits().cast_unsigned(),
            InstructionData::Unary { opcode: Opcode::Ireduce, arg } => self.known_bits(arg)?,
            _ => return None,
        };
        let width = self.builder.func.dfg.value_type(value).bits();
        Some(bits & (u64::MAX >> (64 - width.clamp(1, 64))))
    }
}
