//! A search for the shortest inputs after which two systems differ: every sequence up to a depth,
//! then inputs that are held, long patterns, and random ones from a fixed seed. The same program
//! gives the same answer.

use super::pair::{Pair, Step};
use super::{hold, shrink};
use staunch_ir::Value;
use std::collections::HashSet;
use std::hash::{DefaultHasher, Hash, Hasher};

/// Input vectors that are tried in every scan of the exhaustive part.
const MAX_VECTORS: usize = 256;
/// Bytes of states that the exhaustive part keeps at a time.
const MAX_BYTES: usize = 256 << 20;
/// Bytes that all scans together compare.
const MAX_COMPARED: usize = 4 << 30;
/// Scans of a random sequence.
const EPISODE: usize = 120;
/// Enough scans to count past the limit of a WORD.
pub const LONG: usize = 140_000;

#[derive(Clone, Copy, Debug)]
pub struct Limits {
    /// Scans of a sequence in the exhaustive part.
    pub depth: usize,
    /// Scans in all.
    pub budget: u64,
}

/// How the search went.
#[derive(Clone, Debug, Default)]
pub struct Outcome {
    /// Sequences of inputs, up to the first difference.
    pub steps: Option<Vec<Step>>,
    /// Every sequence of this many scans was tried.
    pub depth: usize,
    /// Every state that the inputs can reach was tried.
    pub complete: bool,
    pub scans: u64,
}

pub fn search(pair: &mut Pair, limits: Limits) -> Outcome {
    // A large state takes its time to compare and to keep.
    let bytes = pair.states().iter().map(Vec::len).sum::<usize>().max(1);
    let affordable = u64::try_from(MAX_COMPARED / bytes).unwrap_or(u64::MAX);
    let limits = Limits { budget: limits.budget.min(affordable.max(1000)), ..limits };
    let mut search = Search { left: limits.budget, outcome: Outcome::default(), pair };
    search.outcome.steps = search.run(limits);
    search.outcome.scans = limits.budget - search.left;
    search.outcome
}

struct Search<'p> {
    pair: &'p mut Pair,
    left: u64,
    outcome: Outcome,
}

/// How a state of the exhaustive part was reached.
struct Node {
    parent: usize,
    symbol: usize,
}

impl Search<'_> {
    fn run(&mut self, limits: Limits) -> Option<Vec<Step>> {
        if let Some(found) = self.exhaustive(limits.depth, limits.budget / 4 * 3) {
            return Some(found);
        }
        if self.outcome.complete {
            return None;
        }
        let found =
            self.holds(limits.budget / 2).or_else(|| self.patterns(limits.budget / 8)).or_else(|| self.random());
        found.map(|it| shrink::shrink(self.pair, it))
    }

    /// The input vectors, those that change little first.
    fn symbols(&self) -> Vec<Step> {
        let mut vectors = vec![(0, Vec::new())];
        for input in &self.pair.inputs {
            let with = |(changes, vector): &(usize, Vec<Value>)| {
                let each = |(at, value): (usize, &Value)| {
                    let mut vector = vector.clone();
                    vector.push(*value);
                    (changes + usize::from(at > 0), vector)
                };
                input.values.iter().enumerate().map(each).collect::<Vec<_>>()
            };
            vectors = vectors.iter().flat_map(with).collect();
            vectors.sort_by_key(|it| it.0);
            vectors.truncate(MAX_VECTORS * 4);
        }
        vectors.truncate(MAX_VECTORS);
        let plain = |(_, inputs)| Step { restart: false, inputs };
        let mut symbols: Vec<Step> = vectors.into_iter().map(plain).collect();
        if self.pair.retains() {
            let restarts: Vec<_> = symbols.iter().map(|it| Step { restart: true, ..it.clone() }).collect();
            symbols.extend(restarts);
        }
        symbols
    }

    /// Breadth first, each pair of states once. Timers make the time a part of the state.
    fn exhaustive(&mut self, depth: usize, reserve: u64) -> Option<Vec<Step>> {
        let symbols = self.symbols();
        let timed = self.pair.sides[0]
            .leaves
            .blocks
            .iter()
            .any(|it| it.block.info().instructions.iter().any(|it| it.needs_context));
        self.pair.init();
        let mut nodes: Vec<Node> = Vec::new();
        let mut frontier = vec![(usize::MAX, self.pair.states())];
        let mut seen = HashSet::new();
        seen.insert(hash(&frontier[0].1, 0));
        let bytes = frontier[0].1.iter().map(Vec::len).sum::<usize>().max(1);
        for level in 1..=depth {
            let mut next = Vec::new();
            for (parent, states) in &frontier {
                for (symbol, step) in symbols.iter().enumerate() {
                    if self.left <= reserve || (next.len() + frontier.len()) * bytes > MAX_BYTES {
                        return None;
                    }
                    if step.restart && level == 1 {
                        continue;
                    }
                    self.left -= 1;
                    self.pair.restore(states);
                    let faults = self.pair.scan(level, step);
                    let node = Node { parent: *parent, symbol };
                    if self.pair.differs(faults) {
                        return Some(path(&nodes, node, &symbols));
                    }
                    if faults[0].is_some() {
                        continue;
                    }
                    let reached = self.pair.states();
                    if seen.insert(hash(&reached, if timed { level } else { 0 })) {
                        next.push((nodes.len(), reached));
                        nodes.push(node);
                    }
                }
            }
            self.outcome.depth = level;
            if next.is_empty() {
                self.outcome.complete = true;
                return None;
            }
            frontier = next;
        }
        None
    }

    /// Runs steps from the start until the two differ; `None` if they do not, or the budget ends.
    fn drive(&mut self, count: usize, reserve: u64, mut make: impl FnMut(usize) -> Step) -> Option<Vec<Step>> {
        self.pair.init();
        let mut steps = Vec::new();
        for number in 1..=count {
            if self.left <= reserve {
                return None;
            }
            self.left -= 1;
            let step = make(number);
            let faults = self.pair.scan(number, &step);
            steps.push(step);
            if self.pair.differs(faults) {
                return Some(steps);
            }
            if faults[0].is_some() {
                return None;
            }
        }
        None
    }

    /// Inputs that are TRUE for long; the first that makes a difference.
    fn holds(&mut self, reserve: u64) -> Option<Vec<Step>> {
        hold::sequences(self.pair, &self.symbols()).into_iter().find_map(|runs| {
            let count = runs.iter().map(|it| it.scans).sum();
            let mut steps = runs.iter().flat_map(|it| std::iter::repeat_n(&it.step, it.scans));
            let last = runs.last().map(|it| &it.step)?;
            self.drive(count, reserve, |_| steps.next().unwrap_or(last).clone())
        })
    }

    /// One input pulses in every second scan, long enough for a limit, while the others keep
    /// still: all at their start, then all TRUE.
    fn patterns(&mut self, reserve: u64) -> Option<Vec<Step>> {
        let initial = self.pair.initial();
        let raised = hold::raised(&initial);
        for still in [&initial, &raised] {
            for at in 0..initial.len() {
                if initial[at].lane() != staunch_ir::Lane::Bool {
                    continue;
                }
                let pulse = |number: usize| {
                    let mut inputs = still.clone();
                    inputs[at] = Value::Bool(number.is_multiple_of(2));
                    Step { restart: false, inputs }
                };
                if let Some(found) = self.drive(LONG, reserve, pulse) {
                    return Some(found);
                }
            }
        }
        None
    }

    /// Sequences in which inputs hold, change one at a time, and now and then all at once.
    fn random(&mut self) -> Option<Vec<Step>> {
        let mut dice = Dice(0x5EED);
        let initial = self.pair.initial();
        let retains = self.pair.retains();
        let values: Vec<Vec<Value>> = self.pair.inputs.iter().map(|it| it.values.clone()).collect();
        if values.is_empty() && !retains {
            return self.drive(usize::MAX, 0, |_| Step { restart: false, inputs: Vec::new() });
        }
        while self.left > 0 {
            let mut inputs = initial.clone();
            let found = self.drive(EPISODE, 0, |number| {
                match dice.below(8) {
                    0 | 1 => {}
                    7 => (0..values.len()).for_each(|at| inputs[at] = *dice.pick(&values[at])),
                    _ if values.is_empty() => {}
                    _ => {
                        let at = dice.below(values.len());
                        inputs[at] = *dice.pick(&values[at]);
                    }
                }
                let restart = retains && number > 1 && dice.below(16) == 0;
                Step { restart, inputs: inputs.clone() }
            });
            if found.is_some() {
                return found;
            }
        }
        None
    }
}

fn hash(states: &[Vec<u8>; 2], level: usize) -> u64 {
    let mut hasher = DefaultHasher::new();
    (states, level).hash(&mut hasher);
    hasher.finish()
}

fn path(nodes: &[Node], last: Node, symbols: &[Step]) -> Vec<Step> {
    let mut steps = vec![symbols[last.symbol].clone()];
    let mut parent = last.parent;
    while let Some(node) = nodes.get(parent) {
        steps.push(symbols[node.symbol].clone());
        parent = node.parent;
    }
    steps.reverse();
    steps
}

/// SplitMix64.
struct Dice(u64);

impl Dice {
    fn below(&mut self, limit: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut bits = self.0;
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        let limit = u64::try_from(limit.max(1)).unwrap_or(1);
        usize::try_from((bits ^ (bits >> 31)) % limit).unwrap_or(0)
    }

    fn pick<'v, T>(&mut self, values: &'v [T]) -> &'v T {
        &values[self.below(values.len())]
    }
}
