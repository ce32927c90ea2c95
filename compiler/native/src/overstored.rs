//! Stores that a later one covers before anything can see them.
//!
//! ```text
//! store v1, v0+8
//! v2 = ushr_imm v1, 1             v2 = ushr_imm v1, 1
//! store v2, v0+8                  store v2, v0+8
//! ```
//!
//! It applies within one block, which ends wherever a fault may be, to stores by the same pointer. Calls, loads that may be of
//! the same storage, and whatever else has effects see a store. It may not assume that two pointers are different.

use cranelift_codegen::ir::{Block, Function, Inst, InstructionData, Opcode, Value};

/// More stores that follow are not looked at.
const MOST: usize = 64;

pub(crate) fn drop_overstored(function: &mut Function) {
    for block in function.layout.blocks().collect::<Vec<_>>() {
        let overstored = overstored(function, block);
        overstored.into_iter().for_each(|it| function.layout.remove_inst(it));
    }
}

/// Bytes after a pointer.
#[derive(Clone, Copy)]
struct Bytes {
    base: Value,
    from: i64,
    to: i64,
}

impl Bytes {
    fn covers(self, it: Self) -> bool {
        self.base == it.base && self.from <= it.from && it.to <= self.to
    }

    fn may_meet(self, it: Self) -> bool {
        self.base != it.base || self.from < it.to && it.from < self.to
    }
}

fn overstored(function: &Function, block: Block) -> Vec<Inst> {
    let (mut found, mut later): (Vec<Inst>, Vec<Bytes>) = (Vec::new(), Vec::new());
    for inst in function.layout.block_insts(block).collect::<Vec<_>>().into_iter().rev() {
        let data = &function.dfg.insts[inst];
        let is_plain = data.memflags_trap_code(&function.dfg).is_none();
        match *data {
            InstructionData::Store { args, offset, opcode: Opcode::Store, .. } if is_plain => {
                let bytes = bytes(function, args[1], offset.into(), args[0]);
                if later.iter().any(|it| it.covers(bytes)) {
                    found.push(inst);
                } else {
                    later.push(bytes);
                }
            }
            InstructionData::Load { arg, offset, opcode: Opcode::Load, .. } if is_plain => {
                let read = bytes(function, arg, offset.into(), function.dfg.first_result(inst));
                later.retain(|it| !it.may_meet(read));
            }
            _ if has_effects(data.opcode()) => later.clear(),
            _ => {}
        }
        if later.len() > MOST {
            later.clear();
        }
    }
    found
}

fn bytes(function: &Function, pointer: Value, offset: i64, value: Value) -> Bytes {
    let size = i64::from(function.dfg.value_type(value).bytes());
    Bytes { base: function.dfg.resolve_aliases(pointer), from: offset, to: offset + size }
}

fn has_effects(opcode: Opcode) -> bool {
    opcode.can_load()
        || opcode.can_store()
        || opcode.can_trap()
        || opcode.is_call()
        || opcode.is_branch()
        || opcode.other_side_effects()
}
