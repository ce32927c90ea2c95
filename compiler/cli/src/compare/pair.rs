//! One program under two dialects, scanned side by side.

use super::leaf::{self, Leaf, Leaves, Role};
use crate::machine::Native;
use staunch_frontend::Dialect;
use staunch_host::Machine;
use staunch_ir::{Program, Value};
use staunch_runtime::{Context, Family, Fault};
use std::collections::HashMap;

/// The program as one system runs it.
pub struct Side {
    pub dialect: Dialect,
    pub program: Program,
    pub leaves: Leaves,
    machine: Native,
    /// The instances in the order in which they run.
    order: Vec<usize>,
    /// What a restart keeps: offset and size.
    kept: Vec<(usize, usize)>,
    initial: Vec<u8>,
}

/// Something that the world outside sets.
pub struct Input {
    pub leaves: [usize; 2],
    /// The initial value first.
    pub values: Vec<Value>,
}

/// What comes before one scan: an event, and a value for each input.
#[derive(Clone, Debug, PartialEq)]
pub struct Step {
    pub restart: bool,
    pub inputs: Vec<Value>,
}

/// The states of both sides after a scan, and how the scan ended.
#[derive(Clone, Debug)]
pub struct Row {
    pub restart: bool,
    pub states: [Vec<u8>; 2],
    pub faults: [Option<Fault>; 2],
}

/// Two leaves of one meaning, by their positions.
pub type Matched = [usize; 2];

pub struct Pair {
    pub sides: [Side; 2],
    pub inputs: Vec<Input>,
    /// What is compared after each scan, in the order of the declarations.
    pub compared: Vec<Matched>,
    /// Those whose bytes are equal when their values are, as runs: two offsets and a length.
    runs: Vec<([usize; 2], usize)>,
    /// The others.
    singles: Vec<Matched>,
    /// Nanoseconds from scan to scan.
    pub cycle: i64,
}

impl Side {
    pub fn new(dialect: Dialect, program: Program) -> Result<Self, String> {
        let (machine, _) = Native::new(&program)?;
        let leaves = Leaves::of(&program);
        let mut order: Vec<usize> = (0..program.instances.len()).collect();
        order.sort_by_key(|it| program.instances[*it].priority);
        let kept = leaves.all.iter().filter(|it| it.retain).map(|it| (it.offset, it.size)).collect();
        let initial = machine.state().to_vec();
        Ok(Self { dialect, program, leaves, machine, order, kept, initial })
    }

    pub fn state(&self) -> &[u8] {
        self.machine.state()
    }

    pub fn machine(&mut self) -> &mut Native {
        &mut self.machine
    }

    /// What counters of CSCAPE start with after a restart, whatever their declaration retains.
    pub fn forgotten(&self) -> Vec<(usize, Vec<u8>)> {
        let cscape = self.leaves.blocks.iter().filter(|it| it.block.info().family == Family::Cscape);
        cscape.map(|it| (it.offset, self.initial[it.offset..it.offset + it.block.info().size].to_vec())).collect()
    }

    /// A power cycle: all but the retained variables start anew.
    fn restart(&mut self) {
        let kept: Vec<Vec<u8>> =
            self.kept.iter().map(|(offset, size)| self.state()[*offset..offset + size].to_vec()).collect();
        self.machine.init();
        for ((offset, _), bytes) in self.kept.iter().zip(kept) {
            self.machine.write(*offset, &bytes);
        }
    }

    fn scan(&mut self, cx: &Context) -> Option<Fault> {
        self.order.iter().find_map(|instance| self.machine.scan(*instance, cx).err())
    }

    pub fn show(&self, leaf: usize, state: &[u8]) -> String {
        leaf::show(&self.program, &self.leaves.all[leaf], state)
    }
}

impl Pair {
    pub fn new(sides: [Side; 2], cycle: i64, only: &[String]) -> Self {
        let mut pair =
            Self { sides, inputs: Vec::new(), compared: Vec::new(), runs: Vec::new(), singles: Vec::new(), cycle };
        pair.inputs = pair.find_inputs();
        pair.compared = pair.find_compared(only);
        pair.find_runs();
        pair
    }

    /// Arrays of one type on both sides are compared in one go.
    fn find_runs(&mut self) {
        for [a, b] in self.compared.clone() {
            let (x, y) = (self.leaf(0, a), self.leaf(1, b));
            let (offsets, size) = ([x.offset, y.offset], x.size);
            if x.ty.elementary().is_none() || x.ty != y.ty {
                self.singles.push([a, b]);
                continue;
            }
            match self.runs.last_mut() {
                Some((start, length)) if [start[0] + *length, start[1] + *length] == offsets => *length += size,
                _ => self.runs.push((offsets, size)),
            }
        }
    }

    fn leaf(&self, side: usize, at: usize) -> &Leaf {
        &self.sides[side].leaves.all[at]
    }

    /// The leaves that both sides have, by their common names.
    fn matched(&self, wanted: impl Fn(&Leaf) -> bool) -> Vec<Matched> {
        let other = self.sides[1].leaves.all.iter().enumerate();
        let other: HashMap<&str, usize> = other.map(|(at, leaf)| (leaf.key.as_str(), at)).collect();
        let all = self.sides[0].leaves.all.iter().enumerate();
        let wanted = all.filter(|(_, leaf)| wanted(leaf));
        wanted.filter_map(|(at, leaf)| Some([at, *other.get(leaf.key.as_str())?])).collect()
    }

    /// The inputs by their declaration; without any, the BOOLs that no statement writes.
    fn find_inputs(&self) -> Vec<Input> {
        let mut found = self.matched(|it| it.role == Role::Input);
        if found.is_empty() {
            let written = leaf::written(&self.sides[0].program);
            found = self.matched(|it| {
                let unwritten = matches!(it.role, Role::Variable(Some(field)) if !written.contains(&field));
                unwritten && it.ty == staunch_ir::Type::BOOL
            });
        }
        let program = &self.sides[0].program;
        let scalar = |[a, b]: &Matched| {
            program.lane(self.leaf(0, *a).ty).is_some() && self.leaf(0, *a).ty == self.leaf(1, *b).ty
        };
        let input = |leaves: Matched| {
            let leaf = self.leaf(0, leaves[0]);
            let lane = program.lane(leaf.ty)?;
            let initial = Value::read(lane, &self.sides[0].state()[leaf.offset..]);
            Some(Input { leaves, values: leaf::interesting(program, leaf, initial) })
        };
        found.into_iter().filter(scalar).filter_map(input).collect()
    }

    fn find_compared(&self, only: &[String]) -> Vec<Matched> {
        let inputs: Vec<_> = self.inputs.iter().map(|it| it.leaves[0]).collect();
        let named = |key: &str| {
            only.is_empty()
                || only.iter().any(|it| {
                    let it = it.to_ascii_lowercase();
                    key.strip_prefix(&it).is_some_and(|rest| rest.is_empty() || rest.starts_with(['.', '[']))
                })
        };
        let mut found = self.matched(|it| matches!(it.role, Role::Variable(_) | Role::Output(_)));
        found.retain(|[a, b]| {
            let compares = |side, at| matches!(self.leaf(side, at).role, Role::Variable(_) | Role::Output(_));
            let path = self.leaf(0, *a).path.to_ascii_lowercase();
            compares(1, *b) && !inputs.contains(a) && (named(&self.leaf(0, *a).key) || named(&path))
        });
        found
    }

    /// The inputs' values before anything sets them.
    pub fn initial(&self) -> Vec<Value> {
        self.inputs.iter().map(|it| it.values[0]).collect()
    }

    /// Both sides as they start.
    pub fn init(&mut self) {
        self.sides.iter_mut().for_each(|it| it.machine.init());
    }

    pub fn restore(&mut self, states: &[Vec<u8>; 2]) {
        for (side, state) in self.sides.iter_mut().zip(states) {
            side.machine.write(0, state);
        }
    }

    pub fn states(&self) -> [Vec<u8>; 2] {
        [0, 1].map(|side| self.sides[side].state().to_vec())
    }

    /// Whether a restart keeps anything, so that it is more than a new start.
    pub fn retains(&self) -> bool {
        self.sides.iter().any(|it| !it.kept.is_empty())
    }

    /// Scan `number`, counted from 1, on both sides.
    pub fn scan(&mut self, number: usize, step: &Step) -> [Option<Fault>; 2] {
        let elapsed = i64::try_from(number - 1).unwrap_or(i64::MAX);
        let cx = Context::new(elapsed.saturating_mul(self.cycle), number == 1 || step.restart);
        let inputs = &self.inputs;
        let mut at = 0;
        self.sides.each_mut().map(|side| {
            if step.restart {
                side.restart();
            }
            for (input, value) in inputs.iter().zip(&step.inputs) {
                let offset = side.leaves.all[input.leaves[at]].offset;
                side.machine.write_value(offset, *value);
            }
            at += 1;
            side.scan(&cx)
        })
    }

    fn equal(&self, [a, b]: Matched, states: [&[u8]; 2]) -> bool {
        let programs = [&self.sides[0].program, &self.sides[1].program];
        leaf::equal(programs, [self.leaf(0, a), self.leaf(1, b)], states)
    }

    /// Whether the two states, or how the scan ended, differ.
    pub fn differs(&self, faults: [Option<Fault>; 2]) -> bool {
        let kind = |it: Option<Fault>| it.map(|it| it.kind);
        let states = [self.sides[0].state(), self.sides[1].state()];
        kind(faults[0]) != kind(faults[1])
            || self.runs.iter().any(|([a, b], length)| states[0][*a..a + length] != states[1][*b..b + length])
            || self.singles.iter().any(|it| !self.equal(*it, states))
    }

    /// What differs, in the order of the declarations.
    pub fn differences(&self, row: &Row) -> Vec<Matched> {
        self.compared.iter().copied().filter(|it| !self.same(*it, row)).collect()
    }

    /// The outputs of standard blocks, whether they are compared or not.
    pub fn outputs(&self) -> Vec<Matched> {
        self.matched(|it| matches!(it.role, Role::Output(_)))
    }

    pub fn same(&self, leaves: Matched, row: &Row) -> bool {
        self.equal(leaves, row.states.each_ref().map(Vec::as_slice))
    }

    /// All rows of a run that starts anew, up to the first difference.
    pub fn replay(&mut self, steps: &[Step]) -> Option<Vec<Row>> {
        self.init();
        let mut rows = Vec::new();
        for (step, number) in steps.iter().zip(1..) {
            let faults = self.scan(number, step);
            rows.push(Row { restart: step.restart, states: self.states(), faults });
            if self.differs(faults) {
                return Some(rows);
            }
            if faults[0].is_some() {
                return None;
            }
        }
        None
    }

    /// The number of steps after which the two differ.
    pub fn differs_after(&mut self, steps: &[Step]) -> Option<usize> {
        self.init();
        for (step, number) in steps.iter().zip(1..) {
            let faults = self.scan(number, step);
            if self.differs(faults) {
                return Some(number);
            }
            if faults[0].is_some() {
                return None;
            }
        }
        None
    }
}
