//! Whether each loop of a function has a mark: where one has none, the emitter has a loop that it does not say how often it is
//! repeated.

use super::mark::{Mark, Marks};
use cranelift_codegen::flowgraph::ControlFlowGraph;
use cranelift_codegen::ir::{Block, Function, Inst};
use rustc_hash::FxHashSet;

/// Whether all that leads back to a block that control came from has a mark.
pub(crate) fn is_marked(function: &Function, marks: &Marks) -> bool {
    let repeats = |it: &(Inst, Mark)| matches!(it.1, Mark::Repeats(_)).then_some(it.0);
    let marked: FxHashSet<Inst> = marks.iter().filter_map(repeats).collect();
    let graph = ControlFlowGraph::with_function(function);
    let Some(entry) = function.layout.entry_block() else { return true };
    let next = |it: Block| graph.succ_iter(it).collect::<Vec<_>>();
    let (mut seen, mut around) = (FxHashSet::from_iter([entry]), FxHashSet::from_iter([entry]));
    let mut open = vec![(entry, next(entry))];
    while let Some((block, rest)) = open.last_mut() {
        let block = *block;
        match rest.pop() {
            Some(to) if around.contains(&to) => {
                let is_known = function.layout.last_inst(block).is_some_and(|it| marked.contains(&it));
                if !is_known {
                    return false;
                }
            }
            Some(to) if seen.insert(to) => {
                around.insert(to);
                open.push((to, next(to)));
            }
            Some(_) => {}
            None => {
                around.remove(&block);
                open.pop();
            }
        }
    }
    true
}
