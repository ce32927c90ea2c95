//! Loads of what a register has already.
//!
//! ```text
//! v2 = load.i16 v1+4              v2 = load.i16 v1+4
//! v3 = icmp slt v2, v0            v3 = icmp slt v2, v0
//! brif v3, block1, block2         brif v3, block1, block2
//! block1:                         block1:
//! v4 = load.i16 v1+4              v5 = iadd v2, …
//! v5 = iadd v4, …
//! ```
//!
//! The code generator finds such loads, but in a loop none of those in other blocks. Facts at the end of a block hold at the start of the blocks
//! after it, as far as all paths to them agree; nothing is known where a loop begins. It applies to loads and stores that
//! cannot trap. A store leaves what is known of other [classes](crate::address), and of other bytes after the same pointer. It may not
//! assume that two pointers are different, nor anything of a call.

use cranelift_codegen::flowgraph::ControlFlowGraph;
use cranelift_codegen::ir::immediates::Offset32;
use cranelift_codegen::ir::{AliasRegion, Block, Function, Inst, InstructionData, Opcode, Type, Value};
use rustc_hash::{FxHashMap, FxHashSet};

/// More places are not remembered at once.
const MOST: usize = 64;

/// What values are called that are gone.
pub(crate) fn drop_reloaded(function: &mut Function) -> FxHashMap<Value, Value> {
    let flow = ControlFlowGraph::with_function(function);
    let mut ends: FxHashMap<Block, Memory> = FxHashMap::default();
    let mut names = FxHashMap::default();
    for block in in_order(function, &flow) {
        let before: Vec<Option<&Memory>> = flow.pred_iter(block).map(|it| ends.get(&it.block)).collect();
        let mut memory = Memory::at_start(&before);
        for inst in function.layout.block_insts(block).collect::<Vec<_>>() {
            function.dfg.map_inst_values(inst, |it| names.get(&it).copied().unwrap_or(it));
            if let Some(known) = memory.after(function, inst) {
                names.insert(function.dfg.first_result(inst), known);
                function.layout.remove_inst(inst);
            }
        }
        ends.insert(block, memory);
    }
    names
}

/// The blocks, each after all that lead to it but those that lead back.
fn in_order(function: &Function, flow: &ControlFlowGraph) -> Vec<Block> {
    let Some(entry) = function.layout.entry_block() else { return Vec::new() };
    let (mut found, mut seen) = (Vec::new(), FxHashSet::from_iter([entry]));
    let mut open = vec![(entry, flow.succ_iter(entry).collect::<Vec<_>>())];
    while let Some((block, rest)) = open.last_mut() {
        match rest.pop() {
            Some(next) if seen.insert(next) => open.push((next, flow.succ_iter(next).collect())),
            Some(_) => {}
            None => {
                found.push(*block);
                open.pop();
            }
        }
    }
    found.reverse();
    found
}

/// Bytes that are read or written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Place {
    base: Value,
    offset: Offset32,
    ty: Type,
    class: Option<AliasRegion>,
}

impl Place {
    fn may_meet(&self, it: &Self) -> bool {
        let is_other = self.class.zip(it.class).is_some_and(|(a, b)| a != b);
        let [(from, to), (other_from, other_to)] = [self, it].map(|it| {
            let from = i64::from(i32::from(it.offset));
            (from, from + i64::from(it.ty.bytes()))
        });
        let is_apart = self.base == it.base && (to <= other_from || other_to <= from);
        !is_other && !is_apart
    }
}

/// What places are known to have.
#[derive(Clone, Debug, Default)]
struct Memory(Vec<(Place, Value)>);

impl Memory {
    /// Where blocks lead to of whose ends this is known.
    fn at_start(before: &[Option<&Self>]) -> Self {
        let Some((Some(first), others)) = before.split_first() else { return Self::default() };
        let agree = |it: &&(Place, Value)| others.iter().all(|other| other.is_some_and(|other| other.0.contains(it)));
        Self(first.0.iter().filter(agree).copied().collect())
    }

    /// Goes past an instruction; gives what it would load.
    fn after(&mut self, function: &Function, inst: Inst) -> Option<Value> {
        let data = &function.dfg.insts[inst];
        let is_plain = data.memflags_trap_code(&function.dfg).is_none();
        let class = data.alias_region(&function.dfg);
        match *data {
            InstructionData::Load { arg, offset, opcode: Opcode::Load, .. } if is_plain => {
                let value = function.dfg.first_result(inst);
                let place = Place { base: arg, offset, ty: function.dfg.value_type(value), class };
                let known = self.0.iter().find(|it| it.0 == place).map(|it| it.1);
                if known.is_none() {
                    self.note(place, value);
                }
                known
            }
            InstructionData::Store { args: [value, base], offset, opcode: Opcode::Store, .. } if is_plain => {
                let place = Place { base, offset, ty: function.dfg.value_type(value), class };
                self.0.retain(|it| !it.0.may_meet(&place));
                self.note(place, value);
                None
            }
            _ => {
                let opcode = data.opcode();
                if opcode.can_store() || opcode.is_call() || opcode.other_side_effects() && !opcode.is_branch() {
                    self.0.clear();
                }
                None
            }
        }
    }

    fn note(&mut self, place: Place, value: Value) {
        if self.0.len() >= MOST {
            self.0.clear();
        }
        self.0.push((place, value));
    }
}
