//! One function's machine code, ready to be counted.

use super::blocks::{Run, runs};
use super::mark::{Mark, Numbered, Repeats};
use super::{graph, x86};
use cranelift_codegen::ir::SourceLoc;
use cranelift_module::ModuleRelocTarget;
use rustc_hash::FxHashMap;
use std::collections::{BTreeMap, BTreeSet};

/// A frame is touched page by page, in a loop where it has many pages.
const PAGE: u64 = 4096;

/// What the code generator says of a function's code.
pub(crate) struct CodeOf<'a> {
    pub(crate) bytes: &'a [u8],
    /// Where it began a block.
    pub(crate) starts: BTreeSet<usize>,
    /// Which marks bytes have, from byte to byte.
    pub(crate) places: Vec<(usize, usize, SourceLoc)>,
    /// What addresses of functions are of, and where they are; in the order of their places.
    pub(crate) functions: Vec<(usize, ModuleRelocTarget)>,
    pub(crate) frame: u64,
}

/// What is not known of a function's code.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Gap {
    /// Nothing is: it was not looked at.
    All,
    /// An instruction, or a table of jumps.
    Instruction,
    /// What a call calls.
    Call,
    /// Which loop of the source a loop of the code is of.
    Loop,
}

/// A call in a block.
#[derive(Clone, Debug)]
pub(crate) struct Call<C> {
    pub(crate) callee: C,
    /// The bytes or characters that it works on, at most.
    pub(crate) size: Option<u64>,
}

type Node = graph::Node<Call<ModuleRelocTarget>>;

/// The blocks of a function, which name what they call by a `C`.
#[derive(Clone, Debug)]
pub(crate) struct Counted<C> {
    pub(crate) nodes: Vec<graph::Node<Call<C>>>,
    /// The mark at the end of each block.
    marks: Vec<Option<(u32, Repeats)>>,
    before: Vec<Vec<usize>>,
    /// Blocks of the code before the first of the program's own, which touches the frame.
    is_prologue: Vec<bool>,
    pages: u64,
}

impl Counted<ModuleRelocTarget> {
    pub(crate) fn of(code: &CodeOf<'_>, marks: &Numbered) -> Result<Self, Gap> {
        let runs = runs(code.bytes, &code.starts, &x86::instruction).ok_or(Gap::Instruction)?;
        let positions: FxHashMap<usize, usize> = runs.iter().enumerate().map(|(at, it)| (it.start, at)).collect();
        let nodes = runs.iter().map(|it| node(it, code, marks, &positions)).collect::<Option<Vec<Node>>>();
        let nodes = nodes.ok_or(Gap::Call)?;
        let mut before = vec![Vec::new(); nodes.len()];
        for (at, node) in nodes.iter().enumerate() {
            node.next.iter().for_each(|it| before[*it].push(at));
        }
        let first = code.starts.first().copied().unwrap_or(0);
        Ok(Self {
            marks: runs.iter().map(|it| repeats(code, marks, it.last)).collect(),
            is_prologue: runs.iter().map(|it| it.start < first).collect(),
            nodes,
            before,
            pages: code.frame / PAGE + 1,
        })
    }

    /// The same with other names of what is called.
    pub(crate) fn renamed<C>(&self, rename: &dyn Fn(&ModuleRelocTarget) -> Option<C>) -> Result<Counted<C>, Gap> {
        let call = |it: &Call<ModuleRelocTarget>| Some(Call { callee: rename(&it.callee)?, size: it.size });
        let node = |it: &Node| {
            let calls = it.calls.iter().map(call).collect::<Option<_>>()?;
            Some(graph::Node { instructions: it.instructions, calls, next: it.next.clone() })
        };
        Ok(Counted {
            nodes: self.nodes.iter().map(node).collect::<Option<_>>().ok_or(Gap::Call)?,
            marks: self.marks.clone(),
            before: self.before.clone(),
            is_prologue: self.is_prologue.clone(),
            pages: self.pages,
        })
    }
}

impl<C> Counted<C> {
    /// What is known of a loop to whose start these blocks lead back, by the numbers of the marks; `None` if one of them has no
    /// mark.
    pub(crate) fn repeats(&self, from: &[usize]) -> Option<BTreeMap<u32, Repeats>> {
        from.iter().map(|it| self.mark_of(*it)).collect()
    }

    /// How often a loop of the prologue is repeated.
    pub(crate) fn probes(&self, from: &[usize]) -> Option<u64> {
        from.iter().all(|it| self.is_prologue[*it]).then_some(self.pages)
    }

    /// A jump may be in a block of its own, after the moves that it needs.
    fn mark_of(&self, at: usize) -> Option<(u32, Repeats)> {
        let own = self.marks[at];
        own.or_else(|| match self.before[at].as_slice() {
            [only] => self.marks[*only],
            [] => None,
            // From one branch by two ways.
            several => {
                let first = self.marks[several[0]]?;
                several.iter().all(|it| self.marks[*it] == Some(first)).then_some(first)
            }
        })
    }
}

fn node(run: &Run, code: &CodeOf<'_>, marks: &Numbered, positions: &FxHashMap<usize, usize>) -> Option<Node> {
    let within = code.functions.iter().filter(|it| (run.start..run.end).contains(&it.0));
    let targets: Vec<&ModuleRelocTarget> = within.map(|it| &it.1).collect();
    if targets.len() != run.calls.len() {
        return None;
    }
    let call = |(target, (at, _)): (&ModuleRelocTarget, &(usize, usize))| Call {
        callee: target.clone(),
        size: match mark(code, marks, *at) {
            Some((_, Mark::Size(size))) => Some(size),
            Some((_, Mark::Repeats(_))) | None => None,
        },
    };
    let calls = targets.into_iter().zip(&run.calls).map(call).collect();
    let next = run.next.iter().map(|it| positions.get(it).copied()).collect::<Option<_>>()?;
    Some(Node { instructions: run.instructions, calls, next })
}

fn mark(code: &CodeOf<'_>, marks: &Numbered, at: usize) -> Option<(u32, Mark)> {
    let after = code.places.partition_point(|it| it.0 <= at);
    let (_, _, place) = code.places.get(after.checked_sub(1)?).filter(|it| at < it.1)?;
    marks.get(*place)
}

fn repeats(code: &CodeOf<'_>, marks: &Numbered, at: usize) -> Option<(u32, Repeats)> {
    match mark(code, marks, at)? {
        (number, Mark::Repeats(repeats)) => Some((number, repeats)),
        (_, Mark::Size(_)) => None,
    }
}
