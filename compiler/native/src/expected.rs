//! Looking for what a reference leads to where it is expected: in line, by a comparison with each of the few variables
//! of the type. All else is left to who asks: the table of objects decides it.

use crate::expectation::{Expectation, Which};
use crate::function::Function;
use cranelift_codegen::ir::{self as clif, BlockArg, InstBuilder, condcodes::IntCC, types};
use staunch_ir::Type;
use staunch_runtime::reference::{CLASS, ORIGIN, Reference, inverse};

/// The bits above an object's number.
const CLASS_BITS: i64 = 64 - CLASS as i64;

impl Function<'_, '_> {
    /// The offset in the state of a variable that the reference leads to, or to so many bytes before it, where that is where it is
    /// expected, in the block that is current then, and the block for all
    /// else, which is still to be filled.
    pub(crate) fn expected(
        &mut self,
        reference: clif::Value,
        near: Option<clif::Value>,
        ty: Type,
    ) -> Option<(clif::Value, clif::Block)> {
        let all = self.module.expectations(ty);
        let (last, others) = all.split_last()?;
        let (found, slow) = (self.builder.create_block(), self.builder.create_block());
        self.builder.set_cold_block(slow);
        self.builder.append_block_param(found, types::I64);
        let low = self.ins().ireduce(types::I32, reference);
        let address = self.ins().uextend(types::I64, low);
        let address = near.map_or(address, |near| self.ins().iadd(address, near));
        let without_class = self.ins().ishl_imm_u(reference, CLASS_BITS);
        for it in others {
            let next = self.builder.create_block();
            self.compare(it, (without_class, address), near.is_some(), found, next);
            self.go_on_in(next);
        }
        self.compare(last, (without_class, address), near.is_some(), found, slow);
        self.builder.seal_block(slow);
        self.go_on_in(found);
        Some((self.builder.block_params(found)[0], slow))
    }

    /// Goes to `found` with the offset if the variable is at that place, else to the other block.
    fn compare(
        &mut self,
        it: &Expectation,
        (without_class, address): (clif::Value, clif::Value),
        is_near: bool,
        found: clif::Block,
        otherwise: clif::Block,
    ) {
        let first = ORIGIN + it.offset;
        let is_there = if is_near {
            // The object is compared by itself: an address and a distance may be more than 32 bits.
            let object = self.ins().ushr_imm_u(without_class, CLASS_BITS + 32);
            let is_object = self.ins().icmp_imm_u(IntCC::Equal, object, i64::from(it.object));
            let behind = self.ins().iadd_imm_s(address, -i64::from(first));
            let is_one = self.is_one(it.which, behind, 0);
            self.ins().band(is_object, is_one)
        } else {
            let first = Reference { object: it.object, address: first }.bits() << CLASS_BITS;
            let first = self.ins().iconst(types::I64, first.cast_signed());
            let behind = self.ins().isub(without_class, first);
            self.is_one(it.which, behind, CLASS_BITS)
        };
        let offset = match (it.which, is_near) {
            (Which::One, _) => self.ins().iconst(types::I64, i64::from(it.offset)),
            _ => self.ins().iadd_imm_s(address, -i64::from(ORIGIN)),
        };
        self.ins().brif(is_there, found, &[BlockArg::Value(offset)], otherwise, &[]);
    }

    /// Whether a variable begins so far after the first, which is shifted to the left.
    fn is_one(&mut self, which: Which, behind: clif::Value, shift: i64) -> clif::Value {
        match which {
            Which::One => self.ins().icmp_imm_u(IntCC::Equal, behind, 0),
            Which::Anywhere { last } => {
                let last = self.ins().iconst(types::I64, last.cast_signed() << shift);
                self.ins().icmp(IntCC::UnsignedLessThanOrEqual, behind, last)
            }
            Which::Elements { stride, len } => {
                // By the odd part's inverse and a rotation a multiple of the size becomes its position, and all else a
                // number beyond each array.
                let twos = stride.trailing_zeros();
                let behind = match stride >> twos {
                    1 => behind,
                    odd => {
                        let inverse = self.ins().iconst(types::I64, inverse(odd).cast_signed());
                        self.ins().imul(behind, inverse)
                    }
                };
                let position = self.ins().rotr_imm_u(behind, shift + i64::from(twos));
                let len = self.ins().iconst(types::I64, len.cast_signed());
                self.ins().icmp(IntCC::UnsignedLessThan, position, len)
            }
        }
    }
}
