//! Values in memory: addresses, loads and stores, copies, and the frame.

use crate::address::{Address, Class, Kind};
use crate::function::{Function, Temporaries};
use crate::signature::{POINTER, clif_type};
use cranelift_codegen::ir::{
    self as clif, AliasRegionData, InstBuilder, InstructionData, MemFlagsData, StackSlot, StackSlotData, StackSlotKind,
    types,
};
use staunch_ir::layout::{Shape, usize_of};
use staunch_ir::{Const, Repr, Type, Value};
use std::borrow::Cow;

/// Of the part of the frame for temporaries: that of the largest elementary type.
const TEMPORARY_ALIGN: u64 = 8;

impl Function<'_, '_> {
    pub(crate) fn slot(&mut self, shape: Shape) -> StackSlot {
        let size = u32::try_from(shape.size.max(1)).expect("verified IR: sizes are within 1 GiB");
        let align_shift = u8::try_from(shape.align.trailing_zeros()).expect("alignments are small");
        let data = StackSlotData::new(StackSlotKind::ExplicitSlot, size, align_shift);
        self.builder.create_sized_stack_slot(data)
    }

    pub(crate) fn slot_address(&mut self, slot: StackSlot) -> Address {
        Address::own(self.ins().stack_addr(POINTER, slot, 0))
    }

    /// Space until the end of the statement.
    pub(crate) fn temporary(&mut self, shape: Shape) -> Address {
        let slot = match self.temporaries.slot {
            Some(slot) => slot,
            // How large it is shows when all statements have been emitted.
            None => self.slot(Shape { size: 0, align: TEMPORARY_ALIGN }),
        };
        let offset = self.temporaries.taken.next_multiple_of(shape.align);
        let taken = offset + shape.size.max(1);
        let most = self.temporaries.most.max(taken);
        self.temporaries = Temporaries { slot: Some(slot), taken, most };
        self.slot_address(slot).plus(offset)
    }

    pub(crate) fn release_temporaries(&mut self) {
        self.temporaries.taken = 0;
    }

    pub(crate) fn close_temporaries(&mut self) {
        if let Some(slot) = self.temporaries.slot {
            let size = u32::try_from(self.temporaries.most).expect("verified IR: sizes are within 1 GiB");
            self.builder.func.sized_stack_slots[slot].size = size;
        }
    }

    pub(crate) fn pointer(&mut self, address: Address) -> clif::Value {
        match address.displacement() {
            0 => address.base,
            offset => self.ins().iadd_imm_s(address.base, i64::from(offset)),
        }
    }

    /// Reads a value of an elementary or enumeration type.
    pub(crate) fn load(&mut self, ty: Type, from: Address) -> clif::Value {
        let repr = self.module.program.repr(ty).expect("verified IR: an elementary type");
        self.load_as(clif_type(repr), from)
    }

    pub(crate) fn load_as(&mut self, ty: clif::Type, from: Address) -> clif::Value {
        let flags = self.reading(from);
        self.ins().load(ty, flags, from.base, from.displacement())
    }

    pub(crate) fn store(&mut self, value: clif::Value, to: Address) {
        let value = self.as_immediate(value);
        let flags = self.writing(to);
        self.ins().store(flags, value, to.base, to.displacement());
    }

    /// A real constant as the integer of its bits, which an instruction stores without a register.
    fn as_immediate(&mut self, value: clif::Value) -> clif::Value {
        let dfg = &self.builder.func.dfg;
        let (ty, bits) = match dfg.value_def(value).inst().map(|it| dfg.insts[it]) {
            Some(InstructionData::UnaryIeee32 { imm, .. }) => (types::I32, imm.bits().into()),
            Some(InstructionData::UnaryIeee64 { imm, .. }) => (types::I64, imm.bits().into()),
            _ => return value,
        };
        self.integer(ty, bits)
    }

    /// The flags of a load.
    pub(crate) fn reading(&mut self, from: Address) -> MemFlagsData {
        if matches!(from.kind, Kind::Any) {
            self.read_any();
        }
        self.flags(from)
    }

    /// The flags of a store.
    pub(crate) fn writing(&mut self, to: Address) -> MemFlagsData {
        match to.kind {
            Kind::Class(_) => self.known_in = None,
            // The code generator takes it for a store to anything. But it assumes that the value there is still that of the
            // last store without a class: stores with a class since then need a fence.
            Kind::Any => self.read_any(),
            Kind::Own => self.known_in = self.builder.current_block(),
        }
        self.flags(to)
    }

    fn flags(&mut self, of: Address) -> MemFlagsData {
        match of.kind {
            Kind::Class(class) => self.class_flags(class),
            Kind::Any | Kind::Own => MemFlagsData::trusted(),
        }
    }

    /// Of what is of a class.
    pub(crate) fn class_flags(&mut self, class: Class) -> MemFlagsData {
        let data = AliasRegionData { user_id: class.user_id(), description: Cow::Borrowed("") };
        let region = self.builder.func.dfg.alias_regions.insert(data);
        MemFlagsData::trusted().with_alias_region(Some(region))
    }

    /// Before what is read may be any variable: all stores so far are to be seen. The code generator takes it for granted
    /// that a load of no class is of no variable that has one.
    pub(crate) fn read_any(&mut self) {
        let block = self.builder.current_block();
        if self.known_in != block {
            self.ins().sequence_point();
            self.known_in = block;
        }
    }

    /// Stores as many low bits of a wider value as `repr` has.
    pub(crate) fn store_low(&mut self, repr: Repr, value: clif::Value, to: Address) {
        let (flags, displacement) = (self.writing(to), to.displacement());
        match repr.size() {
            1 => self.ins().istore8(flags, value, to.base, displacement),
            2 => self.ins().istore16(flags, value, to.base, displacement),
            4 => self.ins().istore32(flags, value, to.base, displacement),
            _ => self.ins().store(flags, value, to.base, displacement),
        };
    }

    /// Copies a value; both places may be the same.
    pub(crate) fn copy(&mut self, from: Address, to: Address, ty: Type) {
        let shape = self.module.layout.shape(ty);
        self.copy_bytes(from, to, shape);
    }

    pub(crate) fn copy_bytes(&mut self, from: Address, to: Address, shape: Shape) {
        if from.base == to.base && from.offset == to.offset {
            return;
        }
        self.read_any();
        let (from, to) = (self.pointer(from), self.pointer(to));
        let (config, align) = (self.module.output.target_config(), align_of(shape));
        let flags = MemFlagsData::trusted();
        self.builder.emit_small_memory_copy(config, to, from, shape.size, align, align, false, flags);
    }

    /// Writes a constant of any type.
    pub(crate) fn store_const(&mut self, ty: Type, value: &Const, to: Address) {
        if let Const::Scalar(value) = value {
            let value = self.constant(*value);
            return self.store(value, to);
        }
        let shape = self.module.layout.shape(ty);
        if let Some(from) = self.const_data(ty, value) {
            self.copy_bytes(from, to, shape);
        } else {
            let (config, align) = (self.module.output.target_config(), align_of(shape));
            let to = self.pointer(to);
            let flags = MemFlagsData::trusted();
            self.builder.emit_small_memset(config, to, 0, shape.size, align, flags);
        }
    }

    /// A constant as read-only data; `None` if its bytes are all zero.
    fn const_data(&mut self, ty: Type, value: &Const) -> Option<Address> {
        let layout = &self.module.layout;
        if matches!(value, Const::Zero) {
            return None;
        }
        let mut bytes = vec![0; usize_of(layout.size(ty))];
        layout.write_const(self.module.program, ty, value, &mut bytes);
        bytes.iter().any(|byte| *byte != 0).then(|| self.data(bytes))
    }

    /// Read-only bytes.
    pub(crate) fn data(&mut self, bytes: Vec<u8>) -> Address {
        let id = self.module.constant(bytes);
        Address::own(self.data_pointer(id))
    }

    pub(crate) fn constant(&mut self, value: Value) -> clif::Value {
        match value {
            Value::F32(it) => self.ins().f32const(it),
            Value::F64(it) => self.ins().f64const(it),
            Value::Bool(_)
            | Value::I8(_)
            | Value::I16(_)
            | Value::I32(_)
            | Value::I64(_)
            | Value::U8(_)
            | Value::U16(_)
            | Value::U32(_)
            | Value::U64(_) => {
                let number = value.as_integer().expect("not a real");
                self.integer(clif_type(value.repr()), number)
            }
        }
    }

    /// The low bits of `number`.
    pub(crate) fn integer(&mut self, ty: clif::Type, number: i128) -> clif::Value {
        self.ins().iconst(ty, low_bits(ty, number))
    }

    pub(crate) fn code(&mut self, code: u64) -> clif::Value {
        self.integer(types::I64, i128::from(code))
    }
}

/// `number` as an immediate: the bits that fit the type, zeros above them.
fn low_bits(ty: clif::Type, number: i128) -> i64 {
    let mask = (1_i128 << ty.bits()) - 1;
    u64::try_from(number & mask).expect("integers have at most 64 bits").cast_signed()
}

fn align_of(shape: Shape) -> u8 {
    u8::try_from(shape.align).expect("alignments are small")
}
