//! One program under two dialects, scanned side by side.

mod normal;

mod scan;
mod settled;
mod side;

mod comparison;
pub mod exchange;
pub mod idle;
mod key;
mod matching;
mod parting;
pub mod passing;
mod rest;
mod same;

pub use scan::{Faults, Input, Matched, Row, Step};
pub use side::Side;

use crate::program::held;
use crate::program::scalar::{Role, Scalar};
use comparison::Comparison;
use idle::Idle;
use passing::Passed;
use settled::Settled;
use staunch_frontend::rules::{Part, is_followed};
use staunch_host::{Bookmark, Event, Machine, Snapshot};
use staunch_ir::{Chars, FieldId, StructId, Value};
use staunch_runtime::{Fault, FaultKind};
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

#[derive(Debug)]
pub struct Pair {
    pub sides: [Side; 2],
    pub inputs: Vec<Input>,
    /// What keeps its first value, because nothing writes it, though the world outside might.
    pub kept: Vec<Input>,
    /// What is compared after each scan, in the order of the declarations.
    pub compared: Vec<Matched>,
    /// Outputs that share a name and mean different things, and are compared only where they are named.
    pub unlike: Vec<Matched>,
    /// Counters that both sides have.
    pub counters: Vec<Matched>,
    /// For each counter, its outputs.
    pub outputs: Vec<Vec<Matched>>,
    /// Other blocks that both sides have, and their outputs.
    pub blocks: Vec<Matched>,
    pub block_outputs: Vec<Vec<Matched>>,
    /// Whether all of both states is compared, or decides nothing.
    pub whole: bool,
    /// The counters of the second program are COUNTERs of Logix that `compare` has put in their place.
    pub is_ported: bool,
    compared_bytes: Comparison,
    counter_bytes: Comparison,
    block_bytes: Comparison,
    /// Counts of which many are equivalent.
    settled: Settled,
    /// What decides nothing of what is compared.
    pub idle: Idle,
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
    /// A fault that both programs have ended with: what each system does then was not compared.
    pub ended: Option<Fault>,
}

impl Pair {
    pub fn new(sides: [Side; 2], only: &[String]) -> Self {
        let mut pair = Self {
            sides,
            inputs: Vec::new(),
            kept: Vec::new(),
            compared: Vec::new(),
            unlike: Vec::new(),
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
            idle: Idle::default(),
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
            ended: None,
        };
        pair.counters = matching::blocks(&pair.sides, true);
        pair.blocks = matching::blocks(&pair.sides, false);
        pair.whole = !pair.sides.iter().any(|it| it.scalars.truncated);
        pair.block_outputs = matching::outputs(&pair.sides, &pair.blocks);
        pair.block_bytes = Comparison::of(&pair.sides, &pair.block_outputs.concat());
        pair.compare_only(only);
        pair
    }

    /// The variables that are compared: all that both sides have, or those that are named.
    pub fn compare_only(&mut self, only: &[String]) {
        self.compared = matching::compared(&self.sides, &self.inputs, only);
        let named = if only.is_empty() { Vec::new() } else { self.compared.clone() };
        self.outputs = matching::outputs(&self.sides, &self.counters);
        let sides = &self.sides;
        let is_left_out = |it: &Matched| matching::is_done_of_down(sides, *it) && !named.contains(it);
        self.unlike = self.compared.iter().copied().filter(is_left_out).collect();
        self.compared.retain(|it| !is_left_out(it));
        self.drop_unread();
        self.counter_bytes = Comparison::of(&self.sides, &self.outputs.concat());
        self.compared_bytes = Comparison::of(&self.sides, &self.compared);
    }

    /// A DN of Logix that nothing reads, and that is not compared, says nothing.
    fn drop_unread(&mut self) {
        let unread = matching::unread_done(&self.sides, &self.outputs);
        let compared = &self.compared;
        for outputs in &mut self.outputs {
            outputs.retain(|it| compared.contains(it) || !unread.contains(it));
        }
    }

    /// Whether what says that a counter is done is looked at.
    pub fn shows_done(&self, counter: usize) -> bool {
        let is_done = |it: &Matched| (0..2).any(|side| matching::is_done_of_logix(&self.sides, side, *it));
        self.outputs[counter].iter().any(is_done)
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
        input.texts.first().map_or_else(|| held::spell(&self.sides[0].program, ty, input.initial), Chars::to_string)
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
        let faults = self.sides.each_mut().map(|side| {
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
        });
        if let [Some(fault), Some(_)] = faults {
            self.ended.get_or_insert(fault);
        }
        faults
    }

    fn equal(&self, matched: Matched, states: [&[u8]; 2]) -> bool {
        comparison::equal(&self.sides, matched, states)
    }

    fn all_equal(&self, comparison: &Comparison) -> bool {
        comparison.is_same(&self.sides, self.states())
    }

    /// Whether the compared values, or how the scan ended, differ.
    pub fn differs(&self, faults: Faults) -> bool {
        self.faults_differ(faults) || !ends_both(faults) && !self.all_equal(&self.compared_bytes)
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

/// Whether both sides fault: what such a scan has computed until then is not output.
fn ends_both(faults: Faults) -> bool {
    faults.iter().all(Option::is_some)
}

fn kinds(faults: Faults) -> [Option<FaultKind>; 2] {
    faults.map(|it| it.map(|it| it.kind))
}
