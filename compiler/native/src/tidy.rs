//! Makes a function plain after the code of callees was put in place of their calls.
//!
//! ```text
//! v1 = iadd_imm v0, 16            v1 = iadd_imm v0, 16
//! store v2, v1+4                  store v2, v0+20
//! v3 = iconst 0                   v3 = iconst 0
//! jump block1(v3)                 jump block1(v3)
//! block1(v4):                     block1(v4):
//! brif v4, block2(v4), block3     jump block3
//! ```
//!
//! The code generator knows two accesses for the same one only by equal bases and offsets: what a caller stores by its own instance
//! and a callee loads by its pointer is at one place for it after this. And whether a callee faulted is decided where its code says
//! so, and not again after the call.

use crate::signature::CODE;
use crate::unused::{Uses, drop_unused_params};
use cranelift_codegen::flowgraph::ControlFlowGraph;
use cranelift_codegen::ir::{Block, BlockArg, BlockCall, Function, Inst, InstructionData, Opcode, Value};

/// Makes it so everywhere.
pub(crate) fn tidy(function: &mut Function) {
    let blocks: Vec<Block> = function.layout.blocks().collect();
    for block in &blocks {
        let instructions: Vec<Inst> = function.layout.block_insts(*block).collect();
        instructions.into_iter().for_each(|it| rebase(function, it));
    }
    let uses = Uses::of_all(function);
    let flow = ControlFlowGraph::with_function(function);
    for block in blocks {
        if let Some(test) = Test::of(function, &uses, block) {
            test.decide(function, &flow);
        }
    }
    drop_unused_params(function);
}

/// Gives a load or a store the base that its pointer was made of by adding a constant.
fn rebase(function: &mut Function, inst: Inst) {
    let (at, mut offset) = match function.dfg.insts[inst] {
        InstructionData::Load { offset, .. } => (0, i64::from(offset)),
        InstructionData::Store { offset, .. } => (1, i64::from(offset)),
        _ => return,
    };
    let mut base = function.dfg.resolve_aliases(function.dfg.inst_args(inst)[at]);
    while let Some((inner, constant)) = sum(function, base) {
        let Some(further) = offset.checked_add(constant).filter(|it| i32::try_from(*it).is_ok()) else { break };
        (base, offset) = (inner, further);
    }
    let Ok(wanted) = i32::try_from(offset) else { return };
    function.dfg.inst_args_mut(inst)[at] = base;
    if let InstructionData::Load { offset, .. } | InstructionData::Store { offset, .. } = &mut function.dfg.insts[inst]
    {
        *offset = wanted.into();
    }
}

/// A value plus a constant.
fn sum(function: &Function, value: Value) -> Option<(Value, i64)> {
    let inst = function.dfg.value_def(value).inst()?;
    let InstructionData::Binary { opcode: Opcode::Iadd, args } = function.dfg.insts[inst] else { return None };
    let [a, b] = args.map(|it| function.dfg.resolve_aliases(it));
    let one = |value, other| Some((value, constant(function, other)?));
    one(a, b).or_else(|| one(b, a))
}

fn constant(function: &Function, value: Value) -> Option<i64> {
    let inst = function.dfg.value_def(function.dfg.resolve_aliases(value)).inst()?;
    match function.dfg.insts[inst] {
        InstructionData::UnaryImm { opcode: Opcode::Iconst, imm } => Some(imm.bits()),
        _ => None,
    }
}

/// A block that begins with the test of the code that a callee returned.
struct Test {
    block: Block,
    branch: Inst,
    /// Which of the block's parameters is the code.
    code: usize,
    /// Whether it is the code of a fault, and no BOOL.
    is_code: bool,
    faulted: BlockCall,
    fine: BlockCall,
}

impl Test {
    fn of(function: &Function, uses: &Uses, block: Block) -> Option<Self> {
        let branch = function.layout.first_inst(block)?;
        let InstructionData::Brif { arg, blocks: [faulted, fine], .. } = function.dfg.insts[branch] else {
            return None;
        };
        let params = function.dfg.block_params(block);
        let arg = function.dfg.resolve_aliases(arg);
        let code = params.iter().position(|it| *it == arg)?;
        let pool = &function.dfg.value_lists;
        let is_code = |it: BlockArg| it.as_value().is_some_and(|it| function.dfg.resolve_aliases(it) == arg);
        let passed = faulted.args(pool).filter(|it| is_code(*it)).count();
        // Nobody else asks for the code, and all that is known of the others comes after the test.
        let is_only = uses.of(arg) == 1 + passed;
        let ends = leaves(function, faulted.block(pool), params);
        let is_code = function.dfg.value_type(arg) == CODE;
        (is_only && ends && passed == faulted.len(pool)).then_some(Self { block, branch, code, is_code, faulted, fine })
    }

    /// Sends each way into the block to where it leads, if that is known.
    fn decide(&self, function: &mut Function, flow: &ControlFlowGraph) {
        let mut is_always_fine = true;
        let ways: Vec<Inst> = flow.pred_iter(self.block).map(|it| it.inst).collect();
        for way in ways {
            let InstructionData::Jump { destination, .. } = function.dfg.insts[way] else {
                is_always_fine = false;
                continue;
            };
            let passed = destination.args(&function.dfg.value_lists).nth(self.code).and_then(|it| it.as_value());
            match passed.and_then(|it| Some((it, constant(function, it)?))) {
                Some((_, 0)) => {}
                Some((code, _)) => {
                    let mut to = self.faulted.deep_clone(&mut function.dfg.value_lists);
                    to.update_args(&mut function.dfg.value_lists, |_| BlockArg::Value(code));
                    jump(function, way, to);
                }
                // A callee returns what is not constant only where it has a fault.
                None if self.is_code => {
                    let mut to = self.faulted.deep_clone(&mut function.dfg.value_lists);
                    if let Some(code) = passed {
                        to.update_args(&mut function.dfg.value_lists, |_| BlockArg::Value(code));
                    }
                    jump(function, way, to);
                }
                None => is_always_fine = false,
            }
        }
        if is_always_fine {
            jump(function, self.branch, self.fine);
        }
    }
}

/// Puts a jump at the end of a block, in place of the branch.
fn jump(function: &mut Function, end: Inst, destination: BlockCall) {
    function.dfg.insts[end] = InstructionData::Jump { opcode: Opcode::Jump, destination };
}

/// Blocks on the way out of a function that are looked at.
const MOST_ON_THE_WAY: usize = 8;

/// Whether a block leads straight out of the function, on a way that needs none of some values.
fn leaves(function: &Function, mut block: Block, values: &[Value]) -> bool {
    let needs = |it: Inst| function.dfg.inst_values(it).any(|it| values.contains(&function.dfg.resolve_aliases(it)));
    for _ in 0..MOST_ON_THE_WAY {
        let Some(last) = function.layout.last_inst(block) else { return false };
        if function.layout.block_insts(block).any(needs) {
            return false;
        }
        match function.dfg.insts[last] {
            InstructionData::Jump { destination, .. } => block = destination.block(&function.dfg.value_lists),
            _ => return function.dfg.insts[last].opcode() == Opcode::Return,
        }
    }
    false
}
