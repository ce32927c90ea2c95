//! Sums of narrow numbers on x86-64, at 32 bits.
//!
//! ```text
//! v2 = ireduce.i8 v0              v5 = ireduce.i32 v0
//! v3 = load.i8 v1+8               v6 = uload8.i64 v1+8
//! v4 = iadd v2, v3                v7 = iadd v5, (ireduce.i32 v6)
//!                                 v4 = ireduce.i8 v7
//! ```
//!
//! The machine has no sum of 8 or 16 bits that leaves its operands as they are, and at 32 bits it has (`lea`). The lower bits of a
//! result are those of the operands. It applies to operations of which that is true, and whose operands are at hand with more bits: loaded
//! numbers, parts of wider ones, constants, and results of such operations. A loaded number that is used several times is extended
//! when it is loaded, and not again. It may not assume anything of the upper bits of a part.

use crate::unused::Uses;
use cranelift_codegen::cursor::{Cursor, FuncCursor};
use cranelift_codegen::ir::{Block, Function, Inst, InstBuilder, InstructionData, Opcode, Type, Value, types};
use rustc_hash::{FxHashMap, FxHashSet};

/// Makes it so everywhere; returns what values are called that are gone.
pub(crate) fn at_32_bits(function: &mut Function) -> FxHashMap<Value, Value> {
    let uses = Uses::of_all(function);
    let blocks: Vec<Block> = function.layout.blocks().collect();
    let instructions: Vec<Inst> = blocks.iter().flat_map(|it| function.layout.block_insts(*it)).collect();
    let mut wide = Wide { loads: loads(function, &uses, &instructions), ..Wide::default() };
    for inst in instructions {
        wide.rewrite(function, inst);
    }
    wide.names
}

/// The narrow loads that are extended at once.
fn loads(function: &Function, uses: &Uses, instructions: &[Inst]) -> FxHashSet<Value> {
    let mut found = FxHashSet::default();
    for inst in instructions {
        let opcode = function.dfg.insts[*inst].opcode();
        for value in function.dfg.inst_args(*inst) {
            let is_shared = uses.of(*value) > 1;
            let is_wanted = (opcode == Opcode::Uextend && is_shared) || is_sum(function, *inst);
            if is_wanted && is_load(function, *value) {
                found.insert(*value);
            }
        }
    }
    found
}

fn is_load(function: &Function, value: Value) -> bool {
    let is_load = |it: Inst| matches!(function.dfg.insts[it].opcode(), Opcode::Load);
    is_narrow(function.dfg.value_type(value)) && function.dfg.value_def(value).inst().is_some_and(is_load)
}

fn is_narrow(ty: Type) -> bool {
    ty == types::I8 || ty == types::I16
}

/// Whether the lower bits of an operation's result are those of its operands.
fn is_sum(function: &Function, inst: Inst) -> bool {
    let is_narrow = function.dfg.inst_results(inst).first().is_some_and(|it| is_narrow(function.dfg.value_type(*it)));
    is_narrow && matches!(function.dfg.insts[inst].opcode(), Opcode::Iadd | Opcode::Isub | Opcode::Imul)
}

#[derive(Default)]
struct Wide {
    loads: FxHashSet<Value>,
    /// Narrow values, and the ones of 32 or 64 bits that they are parts of.
    of: FxHashMap<Value, Value>,
    /// Those of `of` that are extended without a sign.
    extended: FxHashMap<Value, Value>,
    names: FxHashMap<Value, Value>,
}

impl Wide {
    fn rewrite(&mut self, function: &mut Function, inst: Inst) {
        match function.dfg.insts[inst] {
            InstructionData::Load { .. } => self.load(function, inst),
            InstructionData::Unary { opcode: Opcode::Ireduce, arg } => {
                let result = function.dfg.first_result(inst);
                let whole = self.of.get(&arg).copied().unwrap_or(arg);
                let is_wide = [types::I32, types::I64].contains(&function.dfg.value_type(whole));
                if is_narrow(function.dfg.value_type(result)) && is_wide {
                    self.of.insert(result, whole);
                }
            }
            InstructionData::Unary { opcode: Opcode::Uextend, arg } => self.extend(function, inst, arg),
            InstructionData::Binary { opcode, args } if is_sum(function, inst) => {
                self.sum(function, inst, opcode, args);
            }
            _ => {}
        }
    }

    fn load(&mut self, function: &mut Function, inst: Inst) {
        let InstructionData::Load { arg, flags, offset, .. } = function.dfg.insts[inst] else { return };
        let result = function.dfg.first_result(inst);
        if !self.loads.contains(&result) {
            return;
        }
        let ty = function.dfg.value_type(result);
        let opcode = if ty == types::I8 { Opcode::Uload8 } else { Opcode::Uload16 };
        let load = function.dfg.make_inst(InstructionData::Load { opcode, arg, flags, offset });
        function.dfg.make_inst_results(load, types::I64);
        function.layout.insert_inst(load, inst);
        let value = function.dfg.first_result(load);
        function.dfg.insts[inst] = reduced(value);
        self.of.insert(result, value);
        self.extended.insert(result, value);
    }

    fn extend(&mut self, function: &mut Function, inst: Inst, arg: Value) {
        let Some(value) = self.extended.get(&arg).copied() else { return };
        let result = function.dfg.first_result(inst);
        match function.dfg.value_type(result) {
            types::I64 => {
                self.names.insert(result, value);
                function.layout.remove_inst(inst);
            }
            ty if ty.bits() < 64 => {
                function.dfg.insts[inst] = reduced(value);
            }
            _ => {}
        }
    }

    fn sum(&mut self, function: &mut Function, inst: Inst, opcode: Opcode, args: [Value; 2]) {
        if !args.iter().all(|it| self.of.contains_key(it) || constant(function, *it).is_some()) {
            return;
        }
        let result = function.dfg.first_result(inst);
        let args = args.map(|it| self.at_32(function, inst, it));
        let sum = function.dfg.make_inst(InstructionData::Binary { opcode, args });
        function.dfg.make_inst_results(sum, types::I32);
        function.layout.insert_inst(sum, inst);
        let value = function.dfg.first_result(sum);
        function.dfg.insts[inst] = reduced(value);
        self.of.insert(result, value);
    }

    fn at_32(&self, function: &mut Function, user: Inst, narrow: Value) -> Value {
        let value = self.of.get(&narrow).copied();
        let number = constant(function, narrow);
        let mut cursor = FuncCursor::new(function).at_inst(user);
        match (value, number) {
            (Some(value), _) if cursor.func.dfg.value_type(value) == types::I32 => value,
            (Some(value), _) => cursor.ins().ireduce(types::I32, value),
            (None, number) => cursor.ins().iconst(types::I32, number.unwrap_or_default()),
        }
    }
}

fn reduced(value: Value) -> InstructionData {
    InstructionData::Unary { opcode: Opcode::Ireduce, arg: value }
}

/// A constant with its sign.
fn constant(function: &Function, value: Value) -> Option<i64> {
    let inst = function.dfg.value_def(value).inst()?;
    match (function.dfg.insts[inst], function.dfg.value_type(value)) {
        (InstructionData::UnaryImm { opcode: Opcode::Iconst, imm }, types::I8) => {
            let [low, ..] = imm.bits().to_le_bytes();
            Some(i64::from(i8::from_le_bytes([low])))
        }
        (InstructionData::UnaryImm { opcode: Opcode::Iconst, imm }, types::I16) => {
            let [low, high, ..] = imm.bits().to_le_bytes();
            Some(i64::from(i16::from_le_bytes([low, high])))
        }
        _ => None,
    }
}
