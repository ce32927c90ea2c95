//! Operations of x86-64 whose first operand is not needed after them.
//!
//! ```text
//! mov rcx, rax                    xor edx, eax
//! xor ecx, edx
//! ```
//!
//! An operation gives its result the register of its first operand, so that one that is needed afterwards is copied before. It applies to
//! operations of integers whose operands may change places, where the second is not needed any more and is in no
//! memory.

use crate::unused::Uses;
use cranelift_codegen::ir::{Block, Function, Inst, InstructionData, Opcode, Value, ValueDef, types};
use rustc_hash::FxHashMap;

pub(crate) fn dying_first(function: &mut Function) {
    let uses = Uses::of_all(function);
    for block in function.layout.blocks().collect::<Vec<_>>() {
        in_block(function, &uses, block);
    }
}

fn in_block(function: &mut Function, uses: &Uses, block: Block) {
    // How often a value is used from here on to the block's end.
    let mut later: FxHashMap<Value, usize> = FxHashMap::default();
    let instructions: Vec<Inst> = function.layout.block_insts(block).collect();
    let mut here: FxHashMap<Value, usize> = FxHashMap::default();
    for inst in &instructions {
        function.dfg.inst_values(*inst).for_each(|it| *here.entry(it).or_default() += 1);
    }
    for inst in instructions.into_iter().rev() {
        if let Some([a, b]) = exchangeable(function, inst) {
            let ends = |it: Value| {
                let is_only_here = here.get(&it).copied() == Some(uses.of(it)) && is_made_in(function, it, block);
                is_only_here && !later.contains_key(&it)
            };
            let dies = |it: Value| ends(it) && ends(whole(function, it));
            // One that is used once may be handed on around a loop.
            let is_shared = [a, whole(function, a)].iter().any(|it| uses.of(*it) > 1);
            if is_shared && !dies(a) && dies(b) && !is_operand(function, b) {
                function.dfg.inst_args_mut(inst).swap(0, 1);
            }
        }
        function.dfg.inst_values(inst).for_each(|it| *later.entry(it).or_default() += 1);
    }
}

fn exchangeable(function: &Function, inst: Inst) -> Option<[Value; 2]> {
    match function.dfg.insts[inst] {
        InstructionData::Binary {
            opcode: Opcode::Iadd | Opcode::Imul | Opcode::Band | Opcode::Bor | Opcode::Bxor,
            args,
        } => Some(args),
        _ => None,
    }
}

/// What a value is a part of, in the same register.
fn whole(function: &Function, mut value: Value) -> Value {
    while let Some(inst) = function.dfg.value_def(value).inst() {
        match function.dfg.insts[inst] {
            InstructionData::Unary { opcode: Opcode::Ireduce, arg } => value = arg,
            _ => break,
        }
    }
    value
}

fn is_made_in(function: &Function, value: Value, block: Block) -> bool {
    match function.dfg.value_def(value) {
        ValueDef::Result(inst, _) => function.layout.inst_block(inst) == Some(block),
        ValueDef::Param(of, _) => of == block,
        ValueDef::Union(..) => false,
    }
}

/// Whether a value is a constant, or may be in memory, as a second operand.
fn is_operand(function: &Function, value: Value) -> bool {
    let Some(inst) = function.dfg.value_def(value).inst() else { return false };
    let is_wide = [types::I32, types::I64].contains(&function.dfg.value_type(value));
    match function.dfg.insts[inst].opcode() {
        Opcode::Iconst => true,
        Opcode::Load => is_wide,
        _ => false,
    }
}
