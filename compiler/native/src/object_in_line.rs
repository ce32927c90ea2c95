//! What the runtime says of an object by its table, in line.

use crate::follow::Reached;
use crate::function::Function;
use cranelift_codegen::ir::{self as clif, BlockArg, InstBuilder, MemFlagsData, condcodes::IntCC, types};
use staunch_ir::Type;
use staunch_ir::reference::view;
use staunch_runtime::reference::{CLASS, ORIGIN, View, encode};

/// Where the table of objects has its first one, and their distance, in bytes.
const OBJECTS_AT: i32 = encode::HEAD_BYTES;
const OBJECT_BYTES: i64 = encode::OBJECT_BYTES;

impl Function<'_, '_> {
    /// Where a number is in an object that is nothing but numbers, and the block for all else, which is still to
    /// be filled: what the runtime says of such an object, in line.
    pub(crate) fn plain(&mut self, it: Reached) -> Option<(clif::Value, clif::Block)> {
        let View::Number(size) = view(self.module.program, it.ty) else { return None };
        let (slow, fast) = (self.builder.create_block(), self.builder.create_block());
        self.builder.set_cold_block(slow);
        let [words, state] = self.world().map(|it| it.1);
        let count = i64::from(self.module.reference_objects());
        let object = self.ins().ushr_imm_u(it.way.reference, 32);
        let object = self.ins().iadd_imm_s(object, -1);
        let is_known = self.ins().icmp_imm_u(IntCC::UnsignedLessThan, object, count);
        let known = self.builder.create_block();
        self.ins().brif(is_known, known, &[], slow, &[]);

        self.go_on_in(known);
        let entry = self.ins().imul_imm_s(object, OBJECT_BYTES);
        let entry = self.ins().iadd(words, entry);
        let start = self.ins().uload32(MemFlagsData::trusted(), entry, OBJECTS_AT);
        let length = self.ins().uload32(MemFlagsData::trusted(), entry, OBJECTS_AT + 8);
        let address = self.ins().ireduce(types::I32, it.way.reference);
        let address = self.ins().uextend(types::I64, address);
        let address = self.ins().iadd(address, it.way.distance);
        let offset = self.ins().iadd_imm_s(address, -i64::from(ORIGIN));
        let position = self.ins().isub(offset, start);
        // Neither is negative where the number lies within; the sizes are far from those of 64 bits.
        let after = self.ins().isub(length, position);
        let after = self.ins().iadd_imm_s(after, -i64::from(size));
        let wrong = self.ins().bor(position, after);
        let wrong = self.ins().icmp_imm_s(IntCC::SignedLessThan, wrong, 0);
        self.ins().brif(wrong, slow, &[], fast, &[]);
        self.builder.seal_block(slow);
        self.go_on_in(fast);
        let pointer = self.ins().iadd(state, offset);
        Some((pointer, slow))
    }

    /// Goes to the block that is returned, with the offset of an object that is exactly of the type and in no pool: what
    /// the runtime says of such an object, in line. Everything else continues in the block that is current then.
    pub(crate) fn whole(
        &mut self,
        reference: clif::Value,
        distance: clif::Value,
        (id, ty): (u32, Type),
    ) -> Option<clif::Block> {
        if self.module.layout.size(ty) == 0 {
            return None;
        }
        let kind = match ty {
            Type::Struct(_) => encode::STRUCTURE,
            Type::Array(_) => encode::ARRAY,
            Type::Elementary(_)
            | Type::Subrange(..)
            | Type::Reference(_)
            | Type::String(_)
            | Type::Enum(_)
            | Type::Block(_) => encode::EXACT,
        };
        if !self.module.has_object_of(kind, id) {
            return None;
        }
        let (slow, done) = (self.builder.create_block(), self.builder.create_block());
        self.builder.set_cold_block(slow);
        self.builder.append_block_param(done, types::I64);
        self.jump_to_object(reference, distance, (kind, id), slow, done);
        self.go_on_in(slow);
        Some(done)
    }

    fn jump_to_object(
        &mut self,
        reference: clif::Value,
        distance: clif::Value,
        (kind, id): (u32, u32),
        slow: clif::Block,
        done: clif::Block,
    ) {
        let words = self.world()[0].1;
        let count = i64::from(self.module.reference_objects());
        let object = self.ins().ishl_imm_u(reference, i64::from(64 - CLASS));
        let object = self.ins().ushr_imm_u(object, i64::from(64 - CLASS + 32));
        let object = self.ins().iadd_imm_s(object, -1);
        let is_known = self.ins().icmp_imm_u(IntCC::UnsignedLessThan, object, count);
        let known = self.builder.create_block();
        self.ins().brif(is_known, known, &[], slow, &[]);

        self.go_on_in(known);
        let entry = self.ins().imul_imm_s(object, OBJECT_BYTES);
        let entry = self.ins().iadd(words, entry);
        let word = |this: &mut Self, base, at| this.ins().uload32(MemFlagsData::trusted(), base, at);
        let start = word(self, entry, OBJECTS_AT);
        let mark = word(self, entry, OBJECTS_AT + 12);
        let node = word(self, entry, OBJECTS_AT + 16);
        let node = self.ins().ishl_imm_u(node, 2);
        let node = self.ins().iadd(words, node);
        let found_kind = word(self, node, 0);
        let found_id = word(self, node, 8);
        let address = self.ins().ireduce(types::I32, reference);
        let address = self.ins().uextend(types::I64, address);
        let address = self.ins().iadd(address, distance);
        let offset = self.ins().iadd_imm_s(address, -i64::from(ORIGIN));
        let position = self.ins().isub(offset, start);
        let other_kind = self.ins().bxor_imm_u(found_kind, i64::from(kind));
        let other_type = self.ins().bxor_imm_u(found_id, i64::from(id));
        let wrong = self.ins().bor(position, mark);
        let other = self.ins().bor(other_kind, other_type);
        let wrong = self.ins().bor(wrong, other);
        self.ins().brif(wrong, slow, &[], done, &[BlockArg::Value(offset)]);
    }
}
