//! Calls away from the common path.
//!
//! ```text
//! call quiet(v0, v1, v2)          v3 = band v1, v1
//!                                 v4 = band v2, v2
//!                                 call quiet(v0, v3, v4)
//! ```
//!
//! A call is given its values in certain registers. Where the values live on, the code generator keeps them in those on the common path as well, and
//! moves them to others and back around each call. A copy that is made for the call ends with it. It applies to values of 64 bits
//! that were made before, and not to what the function is given itself, which comes in such a register, nor to what a call on the common path is
//! given. It may not assume that such a block is never entered.

use cranelift_codegen::cursor::{Cursor, FuncCursor};
use cranelift_codegen::ir::{Block, Function, Inst, InstBuilder, Value, types};
use rustc_hash::FxHashSet;

pub(crate) fn copies_for_calls(function: &mut Function, blocks: &[Block]) {
    let (away, common): (Vec<Block>, Vec<Block>) = blocks.iter().partition(|it| function.layout.is_cold(**it));
    let given = |it: Block| calls(function, it).into_iter().flat_map(|it| function.dfg.inst_args(it).iter().copied());
    let mut kept: FxHashSet<Value> = common.into_iter().flat_map(given).collect();
    kept.extend(function.layout.entry_block().into_iter().flat_map(|it| function.dfg.block_params(it)));
    for block in away {
        for call in calls(function, block) {
            copies_for(function, block, call, &kept);
        }
    }
}

fn calls(function: &Function, block: Block) -> Vec<Inst> {
    function.layout.block_insts(block).filter(|it| function.dfg.insts[*it].opcode().is_call()).collect()
}

fn copies_for(function: &mut Function, block: Block, call: Inst, kept: &FxHashSet<Value>) {
    for at in 0..function.dfg.inst_args(call).len() {
        let value = function.dfg.inst_args(call)[at];
        let maker = function.dfg.value_def(value).inst();
        let is_near = maker.is_some_and(|it| function.layout.inst_block(it) == Some(block));
        if is_near || function.dfg.value_type(value) != types::I64 || kept.contains(&value) {
            continue;
        }
        let copy = FuncCursor::new(function).at_inst(call).ins().band(value, value);
        function.dfg.inst_args_mut(call)[at] = copy;
    }
}
