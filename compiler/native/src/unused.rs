//! What a function computes and does not use, and the code generator would keep.
//!
//! ```text
//! v1 = load v0+8                  jump block1
//! jump block1(v1)                 block1:
//! block1(v2):                     return
//! return
//! ```
//!
//! A callee in place of its call hands over its result, wanted or not; and the code generator takes each load for one that could
//! fault. It applies to loads that cannot, and to parameters of blocks that only jumps lead to.

use cranelift_codegen::flowgraph::ControlFlowGraph;
use cranelift_codegen::ir::{Block, Function, Inst, InstructionData, Value};

/// Unused parameters that are handed on to others are looked for so often.
const MOST_ROUNDS: usize = 3;

/// How often each value is used.
pub(crate) struct Uses(Vec<usize>);

impl Uses {
    pub(crate) fn of_all(function: &Function) -> Self {
        let mut uses = vec![0; function.dfg.num_values()];
        for block in function.layout.blocks() {
            for inst in function.layout.block_insts(block) {
                for value in function.dfg.inst_values(inst) {
                    uses[number(function.dfg.resolve_aliases(value))] += 1;
                }
            }
        }
        Self(uses)
    }

    pub(crate) fn of(&self, value: Value) -> usize {
        self.0[number(value)]
    }
}

fn number(value: Value) -> usize {
    value.as_u32() as usize
}

pub(crate) fn drop_unused_params(function: &mut Function) {
    let flow = ControlFlowGraph::with_function(function);
    let blocks: Vec<Block> = function.layout.blocks().skip(1).collect();
    for _ in 0..MOST_ROUNDS {
        let uses = Uses::of_all(function);
        let mut has_dropped = false;
        for block in &blocks {
            let params = function.dfg.block_params(*block).to_vec();
            for (at, param) in params.into_iter().enumerate().rev().filter(|it| uses.of(it.1) == 0) {
                has_dropped |= drop_param(function, &flow, *block, (at, param));
            }
        }
        if !has_dropped {
            break;
        }
    }
}

/// Whether the parameter could be dropped.
fn drop_param(function: &mut Function, flow: &ControlFlowGraph, block: Block, (at, param): (usize, Value)) -> bool {
    let ways: Vec<Inst> = flow.pred_iter(block).map(|it| it.inst).collect();
    if !ways.iter().all(|it| matches!(function.dfg.insts[*it], InstructionData::Jump { .. })) {
        return false;
    }
    let dfg = &mut function.dfg;
    for way in ways {
        if let InstructionData::Jump { destination, .. } = &mut dfg.insts[way] {
            destination.remove(at, &mut dfg.value_lists);
        }
    }
    dfg.remove_block_param(param);
    true
}

pub(crate) fn drop_unused_loads(function: &mut Function) {
    let uses = Uses::of_all(function);
    let is_unused = |function: &Function, inst: Inst| {
        let data = &function.dfg.insts[inst];
        let is_plain = matches!(data, InstructionData::Load { .. }) && data.memflags_trap_code(&function.dfg).is_none();
        is_plain && function.dfg.inst_results(inst).iter().all(|it| uses.of(*it) == 0)
    };
    for block in function.layout.blocks().collect::<Vec<_>>() {
        for inst in function.layout.block_insts(block).collect::<Vec<_>>() {
            if is_unused(function, inst) {
                function.layout.remove_inst(inst);
            }
        }
    }
}
