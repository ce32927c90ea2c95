//! Every sequence of inputs, the shortest first, each pair of states once. Where it comes to its
//! end, every reachable state was seen.

use super::look::Seen;
use super::progress::Search;
use super::trace::Trace;
use crate::pair::{Place, Step};
use staunch_host::Event;
use std::collections::HashSet;
use std::hash::{BuildHasherDefault, Hasher};

/// Bytes of states that are kept at a time.
const MAX_BYTES: usize = 192 << 20;
/// States in all.
const MAX_STATES: usize = 6_000_000;

/// How a state was reached.
#[derive(Clone, Copy, Debug)]
struct Node {
    parent: usize,
    symbol: usize,
}

#[derive(Debug)]
struct Entry {
    node: usize,
    place: Place,
    ages: Vec<u8>,
    vector: usize,
}

/// The search, which can be gone on with.
#[derive(Debug)]
pub struct Exhaustive {
    symbols: Vec<(usize, Step)>,
    nodes: Vec<Node>,
    frontier: Vec<Entry>,
    next: Vec<Entry>,
    /// The entry of the frontier and the symbol that come next.
    at: (usize, usize),
    seen: HashSet<u128, BuildHasherDefault<Given>>,
    /// Every sequence of this many scans was tried.
    pub depth: usize,
    /// No state is left.
    pub complete: bool,
    /// More states do not fit, or one of them shows what is not seen from the start.
    full: bool,
    /// It continues from states with other counts than those which were reached.
    are_moved: bool,
}

/// The keys are hashes.
#[derive(Debug, Default)]
struct Given(u64);

impl Hasher for Given {
    fn finish(&self) -> u64 {
        self.0
    }

    fn write(&mut self, bytes: &[u8]) {
        let half = bytes.first_chunk::<8>().copied().unwrap_or_default();
        self.0 = u64::from_ne_bytes(half);
    }
}

/// No vector comes before the first scan.
const START: usize = usize::MAX;

impl Exhaustive {
    /// With the first of the combinations of inputs.
    pub fn of(search: &mut Search<'_>, vectors: usize) -> Self {
        let vectors = search.world.alphabet.vectors.iter().take(vectors).enumerate();
        let plain: Vec<(usize, Step)> = vectors.map(|(at, it)| (at, Step::of(it.clone()))).collect();
        let with = |event: Event| plain.iter().map(move |(at, it)| (*at, Step { event: Some(event), ..it.clone() }));
        let events = search.pair.events();
        let symbols = plain.iter().cloned().chain(events.into_iter().flat_map(with)).collect();
        search.pair.init();
        let ages = search.world.assumptions.ages();
        let start = Entry { node: usize::MAX, place: search.pair.place(), ages, vector: START };
        Self {
            symbols,
            nodes: Vec::new(),
            frontier: vec![start],
            next: Vec::new(),
            at: (0, 0),
            seen: HashSet::default(),
            depth: 0,
            complete: false,
            full: false,
            are_moved: false,
        }
    }

    /// Goes on until `reserve` scans are left, every state was seen, or what is looked for is found.
    pub fn run(&mut self, search: &mut Search<'_>, reserve: u64) {
        let bytes = search.pair.size() + 256;
        while search.left > reserve && !self.complete && !self.full && !search.is_done() {
            let (entry, symbol) = self.at;
            if entry == self.frontier.len() {
                self.level();
                continue;
            }
            if search.world.depth.is_some_and(|it| self.depth >= it) {
                return;
            }
            self.at = if symbol + 1 < self.symbols.len() { (entry, symbol + 1) } else { (entry + 1, 0) };
            self.step(search, entry, symbol);
            self.full |= (self.next.len() + self.frontier.len()) * bytes > MAX_BYTES || self.seen.len() >= MAX_STATES;
        }
    }

    fn level(&mut self) {
        self.depth += 1;
        self.complete = self.next.is_empty();
        self.frontier = std::mem::take(&mut self.next);
        self.at = (0, 0);
    }

    fn step(&mut self, search: &mut Search<'_>, entry: usize, symbol: usize) {
        let Entry { node: parent, place, ages, vector } = &self.frontier[entry];
        let (parent, (now, step)) = (*parent, &self.symbols[symbol]);
        if step.event.is_some() && parent == usize::MAX {
            // Before the first scan it is a start.
            return;
        }
        let alphabet = &search.world.alphabet;
        let before = alphabet.vectors.get(*vector).unwrap_or(&search.world.initial);
        let Some(mut ages) = search.world.assumptions.age(ages, before, &step.inputs) else { return };
        search.pair.go_to(place);
        let seen = search.scan(step);
        let node = Node { parent, symbol };
        if search.is_new(&seen) {
            let trace = self.path(node);
            if self.are_moved && !search.is_shown(&seen, &trace) {
                self.full = true;
                return;
            }
            search.record(seen, || trace);
        }
        if search.ended() {
            return;
        }
        let count = ages.len();
        if count > 0 {
            ages.extend(now.to_ne_bytes());
        }
        let key = search.pair.settled_key(&ages);
        ages.truncate(count);
        if self.seen.insert(key) {
            self.are_moved |= search.pair.move_counts();
            self.next.push(Entry { node: self.nodes.len(), place: search.pair.place(), ages, vector: *now });
            self.nodes.push(node);
        }
    }

    fn path(&self, last: Node) -> Trace {
        let mut steps = vec![self.symbols[last.symbol].1.clone()];
        let mut parent = last.parent;
        while let Some(node) = self.nodes.get(parent) {
            steps.push(self.symbols[node.symbol].1.clone());
            parent = node.parent;
        }
        steps.reverse();
        Trace::of(steps)
    }
}

impl Seen {
    pub fn is_empty(&self) -> bool {
        !self.differs && self.sightings.is_empty()
    }
}
