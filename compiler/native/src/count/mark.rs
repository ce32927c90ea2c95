//! What is known of a place in a function's code when it is emitted, and needed when its instructions are counted. A mark is on
//! an instruction of the code generator's input, as its place in the source, which stays with it to the machine code.

use cranelift_codegen::flowgraph::ControlFlowGraph;
use cranelift_codegen::ir::{self as clif, Opcode, SourceLoc};
use staunch_ir::Location;
use std::collections::BTreeMap;

/// How often a loop is repeated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Repeats {
    /// How often control goes back to its start at most, each time that it is entered; `None` where it is not known.
    pub most: Option<u64>,
    pub why: Why,
    pub at: Location,
}

/// What says how often a loop is repeated, or why nothing does.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Why {
    /// Its limits are constant.
    Constant,
    /// A limit of a FOR is not constant.
    Limits,
    /// Something else may write the counter of a FOR.
    Written,
    /// A WHILE or REPEAT by a condition of which nothing is known.
    Condition,
}

/// What a mark says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Mark {
    /// On what leads back to the start of a loop.
    Repeats(Repeats),
    /// On a call: the size that it is given, in bytes or characters.
    Size(u64),
}

/// The marks of a function by the instructions of the code generator's input that have them.
pub(crate) type Marks = Vec<(clif::Inst, Mark)>;

/// Marks in the order of their numbers, which the machine code has.
#[derive(Clone, Debug, Default)]
pub(crate) struct Numbered(Vec<Mark>);

impl Numbered {
    /// Sets them on a function's instructions.
    pub(crate) fn set(function: &mut clif::Function, marks: &Marks) -> Self {
        let mut numbers: BTreeMap<clif::Inst, u32> = BTreeMap::new();
        for ((inst, _), number) in marks.iter().zip(0..) {
            numbers.insert(*inst, number);
        }
        let further = before_jumps(function, &numbers);
        let mut all: Vec<_> = numbers.into_iter().chain(further).collect();
        // Places are kept as distances from the first that is set: it is that of number 0, and none is before it.
        all.sort_by_key(|it| it.1);
        for (inst, number) in all {
            function.set_srcloc(inst, SourceLoc::new(number));
        }
        Self(marks.iter().map(|it| it.1).collect())
    }

    pub(crate) fn get(&self, of: SourceLoc) -> Option<(u32, Mark)> {
        let number = usize::try_from(of.bits()).ok().filter(|_| !of.is_default())?;
        self.0.get(number).map(|it| (of.bits(), *it))
    }
}

/// The code generator leaves out a block that is nothing but a jump: its mark is that of the branches to it, too.
fn before_jumps(function: &clif::Function, numbers: &BTreeMap<clif::Inst, u32>) -> Vec<(clif::Inst, u32)> {
    let mut found = Vec::new();
    if numbers.is_empty() {
        return found;
    }
    let graph = ControlFlowGraph::with_function(function);
    for (inst, number) in numbers {
        let Some(block) = function.layout.inst_block(*inst) else { continue };
        let is_jump = function.dfg.insts[*inst].opcode() == Opcode::Jump;
        if is_jump && function.layout.first_inst(block) == Some(*inst) {
            let before = graph.pred_iter(block).map(|it| it.inst).filter(|it| !numbers.contains_key(it));
            found.extend(before.map(|it| (it, *number)));
        }
    }
    found
}
