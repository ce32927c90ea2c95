//! One program under two dialects, scanned side by side.

mod normal;

mod scan;
mod settled;
mod side;

mod comparison;
mod exchange;
mod matching;
pub mod passing;

pub use scan::{Faults, Input, Matched, Row, Step};
pub use side::Side;

use crate::compare::program::scalar::{self, Instance, Role, Scalar};
use comparison::Comparison;
use passing::{Passed, Passing};
use settled::{Known, Settled};
use staunch_frontend::rules::{Part, is_followed};
use staunch_host::{Bookmark, Event, Machine, Snapshot};
use staunch_ir::{Chars, FieldId, StructId, Value};
use staunch_runtime::FaultKind;
use std::collections::HashMap;
use std::ops::Range;

/// A state of both sides that can be gone back to.
#[derive(Clone, Debug)]
pub struct Place {
    snapshots: [Snapshot; 2],
    bookmarks: [Bookmark; 2],
    passed: Passed,
}

/// What is compared after some accepted findings have been seen, and what of the states decides nothing of it.
#[derive(Debug)]
struct Remaining {
    is_empty: bool,
    comparison: Comparison,
    idle: [Vec<Range<usize>>; 2],
}

pub struct Pair {
    pub sides: [Side; 2],
    pub inputs: Vec<Input>,
    /// What keeps its first value, because nothing writes it, though the world outside might.
    pub kept: Vec<Input>,
    /// What is compared after each scan, in the order of the declarations.
    pub compared: Vec<Matched>,
    /// Counters that both sides have.
    pub counters: Vec<Matched>,
    /// For each counter, its outputs.
    pub outputs: Vec<Vec<Matched>>,
    /// Other blocks that both sides have, and their outputs.
    pub blocks: Vec<Matched>,
    pub block_outputs: Vec<Vec<Matched>>,
    /// Whether all of both states is compared, or decides nothing.
    pub whole: bool,
    /// The counters of the second program are COUNTERs of Logix that `compare` has put in their place: what asked for Q of
    /// a CTD asks for `ACC <= 0`, and nothing for its DN.
    pub is_ported: bool,
    compared_bytes: Comparison,
    counter_bytes: Comparison,
    block_bytes: Comparison,
    /// Counts of which many are alike.
    settled: Settled,
    /// Whether some were taken as one.
    pub are_settled: bool,
    /// The counters of which a trap may be left that was not seen by that.
    pub open: Vec<bool>,
    /// Bytes of a state, and of what else decides.
    scratch: Vec<u8>,
    rest: Vec<u8>,
    first: bool,
    /// A program had not run since an event.
    restarted: bool,
    /// Which accepted findings have been seen since the start.
    passed: Passed,
    /// What is compared after those have been seen.
    remaining: HashMap<Passed, Remaining>,
    /// Events that are said never to happen.
    pub never: Vec<Event>,
    /// Scans that both sides have made together.
    pub scans: u64,
}

impl Pair {
    pub fn new(sides: [Side; 2], only: &[String]) -> Self {
        let mut pair = Self {
            sides,
            inputs: Vec::new(),
            kept: Vec::new(),
            compared: Vec::new(),
            counters: Vec::new(),
            outputs: Vec::new(),
            blocks: Vec::new(),
            block_outputs: Vec::new(),
            whole: false,
            is_ported: false,
            compared_bytes: Comparison::default(),
            counter_bytes: Comparison::default(),
            block_bytes: Comparison::default(),
            settled: Settled::default(),
            are_settled: false,
            open: Vec::new(),
            scratch: Vec::new(),
            rest: Vec::new(),
            first: false,
            restarted: false,
            passed: Passed::new(),
            remaining: HashMap::new(),
            never: Vec::new(),
            scans: 0,
        };
        pair.counters = matching::blocks(&pair.sides, true);
        pair.blocks = matching::blocks(&pair.sides, false);
        pair.whole = !pair.sides.iter().any(|it| it.scalars.truncated);
        (pair.outputs, pair.block_outputs) =
            (matching::outputs(&pair.sides, &pair.counters), matching::outputs(&pair.sides, &pair.blocks));
        pair.counter_bytes = Comparison::of(&pair.sides, &pair.outputs.concat());
        pair.block_bytes = Comparison::of(&pair.sides, &pair.block_outputs.concat());
        pair.compare_only(only);
        pair
    }

    /// The variables that are compared: all that both sides have, or those that are named.
    pub fn compare_only(&mut self, only: &[String]) {
        self.compared = matching::compared(&self.sides, &self.inputs, only);
        if self.is_ported {
            let has_counterpart = |it: &Matched| !matching::is_done_of_down(&self.sides, *it);
            let is_named = |it: &Matched, compared: &[Matched]| !only.is_empty() && compared.contains(it);
            let named = self.compared.clone();
            self.compared.retain(|it| has_counterpart(it) || is_named(it, &named));
            for outputs in &mut self.outputs {
                outputs.retain(|it| has_counterpart(it) || is_named(it, &named));
            }
            self.counter_bytes = Comparison::of(&self.sides, &self.outputs.concat());
        }
        self.compared_bytes = Comparison::of(&self.sides, &self.compared);
    }

    pub fn scalar(&self, side: usize, at: usize) -> &Scalar {
        &self.sides[side].scalars.all[at]
    }

    /// The declaration of a variable, or of the block that an output is of.
    pub fn declared(&self, side: usize, matched: Matched) -> Option<(StructId, FieldId)> {
        let scalar = self.scalar(side, matched[side]);
        match scalar.role {
            Role::Output(block) => self.sides[side].scalars.blocks[block].field,
            Role::Input | Role::Variable | Role::Hidden => scalar.field,
        }
    }

    /// The path of what both sides have, in the words of the first.
    pub fn path(&self, matched: Matched) -> &str {
        &self.scalar(0, matched[0]).path
    }

    /// The scalars that both sides have, by their common names.
    pub fn matched(&self, wanted: impl Fn(&Scalar) -> bool) -> Vec<Matched> {
        matching::matched(&self.sides, wanted)
    }

    /// A name that nothing has which is compared; with how many sides have it otherwise.
    pub fn unknown_name<'n>(&self, only: &'n [String]) -> Option<(&'n str, usize)> {
        matching::unknown_name(&self.sides, only)
    }

    /// Variables and outputs of blocks that only one side has: its number, and their paths.
    pub fn only_one_has(&self, wanted: impl Fn(&Scalar) -> bool) -> Vec<(usize, &str)> {
        matching::only_one_has(&self.sides, wanted)
    }

    fn given(&self, step: &Step) -> Vec<String> {
        let program = &self.sides[0].program;
        let spelled =
            |(input, value): (&Input, &Value)| input.spelled(program, self.scalar(0, input.scalars[0]).ty, *value);
        self.inputs.iter().zip(&step.inputs).map(spelled).collect()
    }

    /// The first value of an input, as a trace shows it.
    pub fn shown(&self, input: &Input) -> String {
        let ty = self.scalar(0, input.scalars[0]).ty;
        input.texts.first().map_or_else(|| scalar::spell(&self.sides[0].program, ty, input.initial), Chars::to_string)
    }

    /// The inputs' values before anything sets them.
    pub fn initial(&self) -> Vec<Value> {
        self.inputs.iter().map(|it| it.initial).collect()
    }

    /// Both sides as they start.
    pub fn init(&mut self) {
        for side in &mut self.sides {
            side.machine.init();
            side.drive.go_to(&side.start);
        }
        self.passed.clear();
    }

    pub fn place(&self) -> Place {
        let snapshots = self.sides.each_ref().map(|it| it.machine.snapshot());
        let bookmarks = self.sides.each_ref().map(|it| it.drive.bookmark());
        Place { snapshots, bookmarks, passed: self.passed.clone() }
    }

    pub fn go_to(&mut self, place: &Place) {
        for ((side, snapshot), bookmark) in self.sides.iter_mut().zip(&place.snapshots).zip(&place.bookmarks) {
            side.machine.compiled().restore(snapshot);
            side.drive.go_to(bookmark);
        }
        self.passed.clone_from(&place.passed);
    }

    /// Bytes of both states.
    pub fn size(&self) -> usize {
        self.sides.iter().map(|it| it.state().len()).sum()
    }

    pub fn states(&self) -> [&[u8]; 2] {
        self.sides.each_ref().map(Side::state)
    }

    /// The states before the last scan.
    pub fn before(&self) -> [&[u8]; 2] {
        self.sides.each_ref().map(|it| it.before.as_slice())
    }

    /// The events that do more on either side than to start all anew, one of those that do the same.
    pub fn events(&self) -> Vec<Event> {
        let same = |a: Event, b: Event| self.sides.iter().all(|it| it.drive.are_alike(a, b));
        let mut found: Vec<Event> = Vec::new();
        for event in Event::ALL {
            let keeps = self.sides.iter().any(|it| it.drive.keeps_anything(event));
            if keeps && !self.never.contains(&event) && !found.iter().any(|it| same(*it, event)) {
                found.push(event);
            }
        }
        found
    }

    /// Whether a timer runs on either side, so that time is a part of the state.
    pub fn has_timers(&self) -> bool {
        self.sides.iter().any(|it| !it.timers.is_empty())
    }

    /// The least time between two scans of a program.
    pub fn shortest_cycle(&self) -> i64 {
        self.sides.iter().map(|it| it.drive.shortest_period()).min().unwrap_or(1)
    }

    /// The next scan, on both sides.
    pub fn scan(&mut self, step: &Step) -> Faults {
        self.scans += 1;
        self.first = self.sides[0].drive.next() == 0;
        self.restarted = !self.first && self.sides[0].drive.phases().any(|it| it.1);
        let inputs = &self.inputs;
        let mut number = 0;
        self.sides.each_mut().map(|side| {
            side.before.copy_from_slice(side.machine.state());
            if let Some(event) = step.event {
                side.drive.start_again(event, &mut side.machine);
                side.restarted.copy_from_slice(side.machine.state());
            }
            for (input, value) in inputs.iter().zip(&step.inputs) {
                match input.text(*value) {
                    Some(text) => side.write_text(input.scalars[number], text),
                    None => side.write(side.scalars.all[input.scalars[number]].offset, *value),
                }
            }
            number += 1;
            side.drive.scan(side.machine.compiled()).err()
        })
    }

    /// Looks for counts of which many are alike, by what is compared now.
    pub fn settle_counts(&mut self) {
        let Self { sides, inputs, compared, counters, .. } = &*self;
        self.settled = Settled::of(Known { sides, inputs, compared, counters });
        self.open = vec![false; self.counters.len()];
    }

    /// What decides all that is to come, as a number: two states with one key behave alike under
    /// the same inputs.
    pub fn key(&mut self, ages: &[u8]) -> u128 {
        self.settled.clear();
        self.key_of(ages)
    }

    /// The same of states in which counts past all that they are compared with are one.
    pub fn settled_key(&mut self, ages: &[u8]) -> u128 {
        let states = self.sides.each_ref().map(Side::state);
        self.are_settled |= self.settled.look(states, &mut self.open);
        self.key_of(ages)
    }

    /// Goes on with counts that are just past all that they are compared with, in place of those of the last key that are
    /// further; whether there are any.
    pub fn move_counts(&mut self) -> bool {
        for (side, offset, value) in self.settled.moved() {
            self.sides[*side].write(*offset, *value);
        }
        !self.settled.moved().is_empty()
    }

    fn key_of(&mut self, ages: &[u8]) -> u128 {
        let mut all = std::mem::take(&mut self.rest);
        all.clear();
        for (number, side) in self.sides.iter_mut().enumerate() {
            self.scratch.clear();
            self.scratch.extend_from_slice(side.machine.state());
            let state = self.scratch.as_mut_slice();
            for input in &self.inputs {
                let scalar = &side.scalars.all[input.scalars[number]];
                state[scalar.offset..scalar.offset + scalar.size].fill(0);
            }
            let now = side.drive.next();
            side.timers.iter().for_each(|it| it.settle(state, now));
            self.settled.write(number, state);
            let idle = self.remaining.get(&self.passed).map(|it| &it.idle[number]);
            idle.into_iter().flatten().for_each(|it| state[it.clone()].fill(0));
            all.extend_from_slice(&side.digest.of(state).to_ne_bytes());
            if side.reads_clock {
                all.extend_from_slice(&now.to_ne_bytes());
            }
        }
        for (wait, fresh) in self.sides.iter().flat_map(|it| it.drive.phases()) {
            all.extend_from_slice(&wait.to_ne_bytes());
            all.push(u8::from(fresh));
        }
        all.extend(self.passed.iter().flat_map(|it| it.to_ne_bytes()));
        all.extend_from_slice(ages);
        self.rest = all;
        normal::hash(&self.rest)
    }

    fn equal(&self, matched: Matched, states: [&[u8]; 2]) -> bool {
        comparison::equal(&self.sides, matched, states)
    }

    fn all_equal(&self, comparison: &Comparison) -> bool {
        comparison.is_same(&self.sides, self.states())
    }

    /// Whether the compared values, or how the scan ended, differ.
    pub fn differs(&self, faults: Faults) -> bool {
        self.faults_differ(faults) || !self.all_equal(&self.compared_bytes)
    }

    /// Whether anything differs that does not follow from accepted findings seen since the start; and whether
    /// nothing is left to compare.
    pub fn differs_beyond(&mut self, passing: &Passing, seen: &Passed, faults: Faults) -> (bool, bool) {
        self.passed.resize(self.passed.len().max(seen.len()), 0);
        self.passed.iter_mut().zip(seen).for_each(|(all, it)| *all |= it);
        if !self.remaining.contains_key(&self.passed) {
            let remaining = self.remaining_compared(passing);
            let comparison = Comparison::of(&self.sides, &remaining);
            let idle = [0, 1].map(|side| passing.idle_bytes(side, &self.passed));
            let known = Remaining { is_empty: remaining.is_empty(), comparison, idle };
            self.remaining.insert(self.passed.clone(), known);
        }
        let Remaining { is_empty, comparison, .. } = &self.remaining[&self.passed];
        if self.faults_differ(faults) {
            let accepted = (0..2).all(|side| faults[side].is_none() || passing.accepts_fault(side));
            return (!accepted, *is_empty);
        }
        (!self.all_equal(comparison), *is_empty && passing.is_faultless)
    }

    /// What is still compared after the accepted findings that have been seen.
    pub fn remaining_compared(&self, passing: &Passing) -> Vec<Matched> {
        self.compared.iter().copied().filter(|it| passing.remains(*it, &self.passed)).collect()
    }

    /// Of these, the outputs that may follow from accepted findings which have been seen.
    pub fn following(&self, passing: &Passing, found: &[Matched]) -> Vec<Matched> {
        found.iter().copied().filter(|it| passing.keeps(*it, &self.passed)).collect()
    }

    /// Whether these do not show the same.
    pub fn differs_now(&self, matched: Matched) -> bool {
        !self.equal(matched, self.states())
    }

    pub fn faults_differ(&self, faults: Faults) -> bool {
        let kinds = kinds(faults);
        // What is a fault here is none on a system that stores what lies outside of a subrange.
        let goes_on = [0, 1].map(|side| {
            kinds[side] == Some(FaultKind::SubrangeViolated) && !is_followed(self.sides[side].dialect, Part::Subrange)
        });
        kinds[0] != kinds[1] || goes_on[0] != goes_on[1]
    }

    /// Whether every counter shows the same on both sides.
    pub fn counters_agree(&self) -> bool {
        self.all_equal(&self.counter_bytes)
    }

    /// Whether every other block shows the same on both sides.
    pub fn blocks_agree(&self) -> bool {
        self.all_equal(&self.block_bytes)
    }

    /// Whether a one-shot is another block on the other system: F_TRIG is on OPENPLC.
    pub fn is_other_one_shot(&self, at: usize) -> bool {
        self.is_other(at, "CLK")
    }

    /// Whether a timer is: each is on OPENPLC4.
    pub fn is_other_timer(&self, at: usize) -> bool {
        self.is_other(at, "PT")
    }

    /// Whether a block is given the same on both sides; else it differs by that.
    pub fn is_given_alike(&self, at: usize, states: [&[u8]; 2]) -> bool {
        let pins = |side: usize| self.sides[side].scalars.blocks[self.blocks[at][side]].block.info().inputs();
        let shared = pins(0).filter(|it| pins(1).any(|other| other.name == it.name));
        let mut both = shared.filter_map(|it| Some([self.pin(at, 0, it.name)?, self.pin(at, 1, it.name)?]));
        both.all(|it| self.equal(it, states))
    }

    /// Whether the time of a timer is over as it begins.
    pub fn is_over_at_once(&self, at: usize, states: [&[u8]; 2]) -> bool {
        (0..2).all(|side| {
            let preset = self.pin(at, side, "PT").map(|it| &self.sides[side].scalars.all[it]);
            let program = &self.sides[side].program;
            let value = preset.and_then(|it| scalar::number(program, it, states[side]));
            value.is_none_or(|it| it <= 0)
        })
    }

    /// The scalar of a block's pin.
    fn pin(&self, at: usize, side: usize, pin: &str) -> Option<usize> {
        let scalars = &self.sides[side].scalars;
        let path = format!("{}.{pin}", scalars.blocks[self.blocks[at][side]].path);
        scalars.all.iter().position(|it| it.path == path)
    }

    fn is_other(&self, at: usize, pin: &str) -> bool {
        let [a, b] = self.blocks[at];
        let [a, b] = [&self.sides[0].scalars.blocks[a], &self.sides[1].scalars.blocks[b]];
        a.block != b.block && a.block.info().pin(pin).is_some()
    }

    /// Whether all that is compared was the same before the last scan.
    pub fn agreed_in_all(&self) -> bool {
        self.compared.iter().all(|it| self.agreed(*it))
    }

    /// Whether these show the same, and did before the last scan.
    pub fn newly_differs(&self, matched: Matched) -> bool {
        !self.equal(matched, self.states()) && self.equal(matched, self.before())
    }

    /// Whether these showed the same before the last scan.
    pub fn agreed(&self, matched: Matched) -> bool {
        self.equal(matched, self.before())
    }

    /// A counter on both sides, by its position among the counters.
    pub fn instances(&self, counter: usize) -> [&Instance; 2] {
        let [a, b] = self.counters[counter];
        [&self.sides[0].scalars.blocks[a], &self.sides[1].scalars.blocks[b]]
    }

    /// Whether the last scan was the first since the start.
    pub fn is_first(&self) -> bool {
        self.first
    }

    /// Whether a program that had not run since a restart may have run in the last scan.
    pub fn is_restarted(&self) -> bool {
        self.restarted
    }

    /// Both states before anything ran.
    pub fn start(&self) -> [&[u8]; 2] {
        self.sides.each_ref().map(|it| it.initial.as_slice())
    }

    /// Variables that differ since the last scan.
    pub fn newly_different(&self) -> Vec<Matched> {
        let Comparison { runs, singles } = &self.compared_bytes;
        let runs = runs.iter().filter(|it| !it.is_same(self.states())).flat_map(|it| &it.scalars);
        let variables = runs.chain(singles).copied().filter(|it| self.scalar(0, it[0]).role == Role::Variable);
        let mut found: Vec<Matched> = variables.filter(|it| self.newly_differs(*it)).collect();
        found.sort_unstable();
        found
    }

    /// Variables that the event before the last scan has made differ, before anything ran.
    pub fn parted_by_event(&self) -> Vec<Matched> {
        let restarted = self.sides.each_ref().map(|it| it.restarted.as_slice());
        let variables = self.compared.iter().filter(|it| self.scalar(0, it[0]).role == Role::Variable);
        variables.copied().filter(|it| self.agreed(*it) && !self.equal(*it, restarted)).collect()
    }

    /// What differs, in the order of the declarations.
    pub fn differences(&self, row: &Row) -> Vec<Matched> {
        self.compared.iter().copied().filter(|it| !self.same(*it, row)).collect()
    }

    pub fn same(&self, matched: Matched, row: &Row) -> bool {
        self.equal(matched, row.states.each_ref().map(Vec::as_slice))
    }

    /// The rows of a run that starts anew, one for each step, or up to a fault.
    pub fn replay(&mut self, steps: &[Step]) -> Vec<Row> {
        self.init();
        let mut rows = Vec::new();
        for step in steps {
            let faults = self.scan(step);
            let states = self.sides.each_ref().map(|it| it.state().to_vec());
            rows.push(Row { event: step.event, inputs: self.given(step), states, faults });
            if faults.iter().any(Option::is_some) {
                break;
            }
        }
        rows
    }
}

fn kinds(faults: Faults) -> [Option<FaultKind>; 2] {
    faults.map(|it| it.map(|it| it.kind))
}
