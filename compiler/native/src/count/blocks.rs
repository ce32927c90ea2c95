//! The machine code of a function as blocks: what is run from the first instruction to the last.

use super::flow::{Flow, Instruction};
use std::collections::{BTreeMap, BTreeSet};

/// Instructions that run one after the other.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Run {
    /// The first byte.
    pub(crate) start: usize,
    /// Where the last instruction begins, and where it ends.
    pub(crate) last: usize,
    pub(crate) end: usize,
    pub(crate) instructions: u64,
    /// Where each of them begins.
    pub(crate) begins: Vec<usize>,
    /// Where its calls begin and end.
    pub(crate) calls: Vec<(usize, usize)>,
    /// Where the blocks begin that may follow.
    pub(crate) next: Vec<usize>,
}

/// The blocks that control reaches from the first byte on, in the order of their places; `None` if an instruction is not known.
/// `starts` are places at which the code generator began a block: a table of jumps ends before the next of them.
pub(crate) fn runs(
    code: &[u8],
    starts: &BTreeSet<usize>,
    decode: &dyn Fn(&[u8], usize) -> Option<Instruction>,
) -> Option<Vec<Run>> {
    let reached = reached(code, starts, decode)?;
    let mut begins = BTreeSet::from([0]);
    for (instruction, next) in reached.values() {
        let is_plain = matches!(instruction.flow, Flow::Next | Flow::Call);
        begins.extend(next.iter().filter(|_| !is_plain));
    }
    let mut runs: Vec<Run> = Vec::new();
    for (at, (instruction, next)) in &reached {
        let open = runs.last_mut().filter(|it| it.end == *at && !begins.contains(at));
        let run = match open {
            Some(run) => run,
            None => {
                runs.push(Run {
                    start: *at,
                    last: *at,
                    end: *at,
                    instructions: 0,
                    begins: Vec::new(),
                    calls: Vec::new(),
                    next: Vec::new(),
                });
                runs.last_mut().expect("pushed above")
            }
        };
        run.instructions += 1;
        run.begins.push(*at);
        (run.last, run.end) = (*at, instruction.end);
        run.next.clone_from(next);
        if instruction.flow == Flow::Call {
            run.calls.push((*at, instruction.end));
        }
    }
    // Code that is reached by two ways which do not agree where its instructions begin is none that is understood.
    let overlaps = runs.windows(2).any(|it| it[0].end > it[1].start);
    (!overlaps).then_some(runs)
}

/// Each instruction that control reaches, and where it goes.
type Reached = BTreeMap<usize, (Instruction, Vec<usize>)>;

fn reached(
    code: &[u8],
    starts: &BTreeSet<usize>,
    decode: &dyn Fn(&[u8], usize) -> Option<Instruction>,
) -> Option<Reached> {
    let (mut found, mut open) = (Reached::new(), vec![0]);
    while let Some(at) = open.pop() {
        if found.contains_key(&at) {
            continue;
        }
        let instruction = decode(code, at)?;
        let next = match instruction.flow {
            Flow::Next | Flow::Call => vec![instruction.end],
            Flow::Jump(target) => vec![target],
            Flow::Branch(target) => vec![instruction.end, target],
            Flow::Table => table(code, instruction.end, starts)?,
            Flow::Ends => Vec::new(),
        };
        open.extend(&next);
        found.insert(at, (instruction, next));
    }
    Some(found)
}

/// The targets of a table of distances from its start.
fn table(code: &[u8], at: usize, starts: &BTreeSet<usize>) -> Option<Vec<usize>> {
    let end = starts.range(at..).next().copied()?;
    let entries = code.get(at..end)?.as_chunks::<4>();
    let target = |it: &[u8; 4]| {
        let distance = isize::try_from(i32::from_le_bytes(*it)).ok()?;
        at.checked_add_signed(distance).filter(|it| starts.contains(it))
    };
    let targets: Option<Vec<_>> = entries.0.iter().map(target).collect();
    targets.filter(|it| entries.1.is_empty() && !it.is_empty())
}
