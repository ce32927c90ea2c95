//! The order of instructions, when the code generator has optimised a function and before it chooses machine instructions.
//!
//! ```text
//! v1 = load v0+8                  v1 = load v0+8
//! v2 = load v0+16                 v2 = load v0+16
//! v3 = load v0+24                 v5 = fmul v1, v2
//! v4 = load v0+32                 v3 = load v0+24
//! v5 = fmul v1, v2                v4 = load v0+32
//! v6 = fmul v3, v4                v6 = fmul v3, v4
//! v7 = fadd v5, v6                v7 = fadd v5, v6
//! ```
//!
//! The optimiser leaves loads and stores in their order, and puts what is computed of them where it is stored or tested. So straight code
//! loads all that it reads before it computes: that takes many registers, and a load that is far from its only use is not an operand in
//! memory. An operation that uses up what was just loaded or computed comes right after it. It applies to operations without effects that
//! have one result, on machines whose instructions have operands in memory; loads and stores keep their order.
//!
//! The code generator takes a load for an operand only where what is computed of it is used once, because it may compute a value wherever that is used. So a result
//! that is used several times is handed to a new block, which the code runs into: it is computed once.
//!
//! A constant that only code away from the common path needs, or that is handed to another block, is made there: the optimiser has it
//! before the loop, in a register or in the frame all the time. It may not assume that a block away from the common path is never entered.

use crate::at_32_bits::at_32_bits;
use crate::away::copies_for_calls;
use crate::dying::dying_first;
use crate::overstored::drop_overstored;
use crate::reloaded::drop_reloaded;
use crate::unused::Uses;
use cranelift_codegen::flowgraph::ControlFlowGraph;
use cranelift_codegen::ir::{Block, BlockArg, BlockCall, Function, Inst, InstructionData, Opcode, Value};
use rustc_hash::{FxHashMap, FxHashSet};

/// More results of a function stay where they are.
const MOST_HANDED: usize = 4096;

pub(crate) fn schedule(function: &mut Function, has_operands_in_memory: bool) {
    merge(function);
    let names = drop_reloaded(function);
    rename(function, &names, &FxHashSet::default());
    drop_overstored(function);
    reuse_sums(function);
    if has_operands_in_memory {
        let names = at_32_bits(function);
        rename(function, &names, &FxHashSet::default());
    }
    let blocks: Vec<Block> = function.layout.blocks().collect();
    for block in &blocks {
        constants_near(function, *block);
    }
    if !has_operands_in_memory {
        return;
    }
    blocks.iter().for_each(|it| constants_second(function, *it));
    copies_for_calls(function, &blocks);
    dying_first(function);
    let uses = Uses::of_all(function);
    let mut handed = Handed::default();
    for block in blocks {
        let order = Order::of(function, &uses, block);
        let shared = order.shared(function, &uses);
        order.place(function, block);
        if !function.layout.is_cold(block) {
            shared.into_iter().rev().for_each(|it| handed.hand(function, block, it));
        }
    }
    rename(function, &handed.names, &handed.jumps);
}

/// Results that are handed to a block of their own.
#[derive(Default)]
struct Handed {
    names: FxHashMap<Value, Value>,
    jumps: FxHashSet<Inst>,
}

impl Handed {
    /// Ends the block after what makes a value.
    fn hand(&mut self, function: &mut Function, block: Block, maker: Inst) {
        let Some(following) = function.layout.next_inst(maker).filter(|_| self.names.len() < MOST_HANDED) else {
            return;
        };
        let value = function.dfg.first_result(maker);
        let next = function.dfg.make_block();
        let ty = function.dfg.value_type(value);
        let name = function.dfg.append_block_param(next, ty);
        function.layout.split_block(next, following);
        let destination = BlockCall::new(next, [BlockArg::Value(value)], &mut function.dfg.value_lists);
        let jump = function.dfg.make_inst(InstructionData::Jump { opcode: Opcode::Jump, destination });
        function.layout.append_inst(jump, block);
        self.names.insert(value, name);
        self.jumps.insert(jump);
    }
}

/// Puts a block that one jump leads to after that jump.
pub(crate) fn merge(function: &mut Function) {
    let flow = ControlFlowGraph::with_function(function);
    let blocks: Vec<Block> = function.layout.blocks().collect();
    for block in blocks {
        while let Some((jump, next)) = only_next(function, &flow, block) {
            function.layout.remove_inst(jump);
            let instructions: Vec<Inst> = function.layout.block_insts(next).collect();
            for inst in instructions {
                function.layout.remove_inst(inst);
                function.layout.append_inst(inst, block);
            }
            function.layout.remove_block(next);
        }
    }
}

/// The jump at a block's end, and where it leads, if nothing else leads there and nothing is handed over.
fn only_next(function: &Function, flow: &ControlFlowGraph, block: Block) -> Option<(Inst, Block)> {
    // Blocks that are gone have no instructions.
    let jump = function.layout.is_block_inserted(block).then(|| function.layout.last_inst(block))??;
    let InstructionData::Jump { destination, .. } = function.dfg.insts[jump] else { return None };
    let next = destination.block(&function.dfg.value_lists);
    let is_only = flow.pred_iter(next).count() == 1 && function.dfg.block_params(next).is_empty();
    let is_other = next != block && function.layout.entry_block() != Some(next);
    let is_alike = function.layout.is_cold(block) == function.layout.is_cold(next);
    (is_only && is_other && is_alike).then_some((jump, next))
}

/// In a block that one other leads to, a sum with a constant that the other hands on is the same value, and not computed again: the
/// optimiser does that so that no register holds it, but in a loop two would hold the counter, before and after its step.
fn reuse_sums(function: &mut Function) {
    let flow = ControlFlowGraph::with_function(function);
    let mut names = FxHashMap::default();
    let blocks: Vec<Block> = function.layout.blocks().collect();
    for block in blocks {
        let mut ways = flow.pred_iter(block);
        let (Some(way), None) = (ways.next(), ways.next()) else { continue };
        let known = handed_on(function, way.inst).into_iter().filter_map(|it| Some((sum(function, it)?, it)));
        let known: FxHashMap<Sum, Value> =
            known.filter(|it| function.layout.inst_block(maker(function, it.1)) == Some(way.block)).collect();
        let instructions: Vec<Inst> = function.layout.block_insts(block).collect();
        for inst in instructions {
            let Some(value) = function.dfg.inst_results(inst).first().copied() else { continue };
            if let Some(same) = sum(function, value).and_then(|it| known.get(&it)) {
                names.insert(value, *same);
                function.layout.remove_inst(inst);
            }
        }
    }
    rename(function, &names, &FxHashSet::default());
}

/// A value, and the constant that is added to it.
type Sum = (Value, i64);

fn sum(function: &Function, value: Value) -> Option<Sum> {
    let inst = function.dfg.value_def(value).inst()?;
    let InstructionData::Binary { opcode: Opcode::Iadd, args: [of, by] } = function.dfg.insts[inst] else {
        return None;
    };
    match function.dfg.insts[function.dfg.value_def(by).inst()?] {
        InstructionData::UnaryImm { opcode: Opcode::Iconst, imm } => Some((of, imm.bits())),
        _ => None,
    }
}

fn maker(function: &Function, value: Value) -> Inst {
    function.dfg.value_def(value).inst().expect("a sum is computed")
}

/// Gives values other names, except in these instructions.
fn rename(function: &mut Function, names: &FxHashMap<Value, Value>, except: &FxHashSet<Inst>) {
    if names.is_empty() {
        return;
    }
    let blocks: Vec<Block> = function.layout.blocks().collect();
    for block in blocks {
        let instructions: Vec<Inst> = function.layout.block_insts(block).collect();
        for inst in instructions.into_iter().filter(|it| !except.contains(it)) {
            function.dfg.map_inst_values(inst, |it| last_name(names, it));
        }
    }
}

fn last_name(names: &FxHashMap<Value, Value>, mut value: Value) -> Value {
    while let Some(next) = names.get(&value) {
        value = *next;
    }
    value
}

/// Constants as second operands, which may be in memory. The result is the same, unless both operands are NaN.
fn constants_second(function: &mut Function, block: Block) {
    let instructions: Vec<Inst> = function.layout.block_insts(block).collect();
    for inst in instructions {
        let InstructionData::Binary { opcode: Opcode::Fadd | Opcode::Fmul, args: [a, b] } = function.dfg.insts[inst]
        else {
            continue;
        };
        if is_number(function, a) && !is_number(function, b) {
            function.dfg.inst_args_mut(inst).swap(0, 1);
        }
    }
}

/// Whether a value is a constant real, and no NaN.
fn is_number(function: &Function, value: Value) -> bool {
    let Some(inst) = function.dfg.value_def(value).inst() else { return false };
    match function.dfg.insts[inst] {
        InstructionData::UnaryIeee32 { imm, .. } => !f32::from_bits(imm.bits()).is_nan(),
        InstructionData::UnaryIeee64 { imm, .. } => !f64::from_bits(imm.bits()).is_nan(),
        _ => false,
    }
}

/// Makes the constants in a block that are wanted there alone.
fn constants_near(function: &mut Function, block: Block) {
    let is_cold = function.layout.is_cold(block);
    let Some(last) = function.layout.last_inst(block) else { return };
    let mut made: FxHashMap<Value, Value> = FxHashMap::default();
    let is_call = |it: &Inst| function.dfg.insts[*it].opcode().is_call();
    let is_wanted = |it: &Inst| is_cold || *it == last || is_call(it);
    let instructions: Vec<Inst> = function.layout.block_insts(block).filter(is_wanted).collect();
    for inst in instructions {
        let takes_all = is_cold || inst != last;
        let values: Vec<Value> =
            if takes_all { function.dfg.inst_values(inst).collect() } else { handed_on(function, inst) };
        let far: Vec<(Value, Inst)> =
            values.iter().filter_map(|it| Some((*it, constant_of(function, *it, (block, last), inst)?))).collect();
        for (value, maker) in far {
            made.entry(value).or_insert_with(|| copy_before(function, maker, inst));
        }
        let arguments = tested(function, inst);
        let mut at = 0;
        function.dfg.map_inst_values(inst, |value| {
            at += 1;
            // What a branch tests stays as it is.
            if takes_all || at > arguments { made.get(&value).copied().unwrap_or(value) } else { value }
        });
    }
}

/// The values that a block's end hands to other blocks, or to a caller.
fn handed_on(function: &Function, last: Inst) -> Vec<Value> {
    function.dfg.inst_values(last).skip(tested(function, last)).collect()
}

/// How many values a block's end uses before those.
fn tested(function: &Function, last: Inst) -> usize {
    match function.dfg.insts[last].opcode() {
        Opcode::Return => 0,
        _ => function.dfg.inst_args(last).len(),
    }
}

/// What makes a constant in another block, or anywhere before a block's end.
fn constant_of(function: &Function, value: Value, (block, last): (Block, Inst), user: Inst) -> Option<Inst> {
    let inst = function.dfg.value_def(value).inst()?;
    let is_constant = function.dfg.insts[inst].opcode() == Opcode::Iconst;
    let is_far = user == last || function.layout.inst_block(inst) != Some(block);
    (is_constant && is_far).then_some(inst)
}

fn copy_before(function: &mut Function, maker: Inst, next: Inst) -> Value {
    let data = function.dfg.insts[maker];
    let ty = function.dfg.value_type(function.dfg.first_result(maker));
    let copy = function.dfg.make_inst(data);
    function.dfg.make_inst_results(copy, ty);
    function.layout.insert_inst(copy, next);
    function.dfg.first_result(copy)
}

/// The order of a block's instructions.
struct Order {
    before: Vec<Inst>,
    after: Vec<Inst>,
    /// The operations that use up what the block loads or computes.
    noted: FxHashSet<Inst>,
}

impl Order {
    fn of(function: &Function, uses: &Uses, block: Block) -> Self {
        let before: Vec<Inst> = function.layout.block_insts(block).collect();
        let mut search =
            Search { function, uses, users: FxHashMap::default(), missing: FxHashMap::default(), after: Vec::new() };
        for inst in &before {
            search.note(*inst, block);
        }
        for inst in &before {
            search.put(*inst);
        }
        Self { after: search.after, before, noted: search.missing.into_keys().collect() }
    }

    /// The operations whose results are used several times, in the new order.
    fn shared(&self, function: &Function, uses: &Uses) -> Vec<Inst> {
        let is_shared = |it: &&Inst| self.noted.contains(*it) && uses.of(function.dfg.first_result(**it)) > 1;
        self.after.iter().filter(is_shared).copied().collect()
    }

    fn place(self, function: &mut Function, block: Block) {
        if self.before == self.after {
            return;
        }
        for inst in &self.before {
            function.layout.remove_inst(*inst);
        }
        for inst in self.after {
            function.layout.append_inst(inst, block);
        }
    }
}

struct Search<'a> {
    function: &'a Function,
    uses: &'a Uses,
    /// Which operations use the results of an instruction of the block.
    users: FxHashMap<Inst, Vec<Inst>>,
    /// Of each operation that is not in the new order yet, how many operands of the block are not.
    missing: FxHashMap<Inst, usize>,
    after: Vec<Inst>,
}

impl Search<'_> {
    /// An operation that may come earlier, because it uses up what the block loads or computes.
    fn note(&mut self, inst: Inst, block: Block) {
        if !is_movable(&self.function.dfg.insts[inst]) {
            return;
        }
        let mut makers: Vec<Inst> = Vec::new();
        let mut uses_up = false;
        for value in self.function.dfg.inst_args(inst) {
            let Some(maker) = self.function.dfg.value_def(*value).inst() else { continue };
            if self.function.layout.inst_block(maker) != Some(block) {
                continue;
            }
            let is_new = self.missing.contains_key(&maker) || is_load(&self.function.dfg.insts[maker]);
            uses_up |= is_new && self.uses.of(*value) == 1;
            if !makers.contains(&maker) {
                makers.push(maker);
            }
        }
        if uses_up {
            self.missing.insert(inst, makers.len());
            makers.into_iter().for_each(|it| self.users.entry(it).or_default().push(inst));
        }
    }

    /// The next instruction, and all operations that can follow now.
    fn put(&mut self, inst: Inst) {
        let mut ready = vec![inst];
        while let Some(inst) = ready.pop() {
            if self.missing.get(&inst).is_some_and(|it| *it == PLACED) {
                continue;
            }
            if let Some(missing) = self.missing.get_mut(&inst) {
                *missing = PLACED;
            }
            self.after.push(inst);
            for user in self.users.remove(&inst).unwrap_or_default() {
                let missing = self.missing.get_mut(&user).expect("users are noted");
                *missing -= 1;
                if *missing == 0 {
                    ready.push(user);
                }
            }
        }
    }
}

/// Of an operation that is in the new order.
const PLACED: usize = usize::MAX;

fn is_load(data: &InstructionData) -> bool {
    matches!(data.opcode(), Opcode::Load)
}

/// Operations whose operands may be in memory, and conversions between them.
fn is_movable(data: &InstructionData) -> bool {
    matches!(
        data.opcode(),
        Opcode::Fadd
            | Opcode::Fsub
            | Opcode::Fmul
            | Opcode::Fdiv
            | Opcode::Sqrt
            | Opcode::Fpromote
            | Opcode::Fdemote
            | Opcode::FcvtFromSint
            | Opcode::Iadd
            | Opcode::Isub
            | Opcode::Imul
            | Opcode::Band
            | Opcode::Bor
            | Opcode::Bxor
            | Opcode::Sextend
            | Opcode::Uextend
    )
}
