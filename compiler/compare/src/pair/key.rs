//! What decides all that is to come of both programs, as a number.

use super::idle::{Idle, bytes_of};
use super::settled::{self, Known, Settled};
use super::side::Side;
use super::{Matched, Pair, normal};
use crate::program::dependency::{Declared, Dependencies};
use crate::program::flow::Range;
use crate::program::walked::Name;
use staunch_host::Machine;
use staunch_ir::effects::{Rules, effects};
use std::collections::{HashMap, HashSet};

impl Pair {
    /// Looks for counts of which many are equivalent, by what is compared now.
    pub fn settle_counts(&mut self) {
        self.settled = Settled::of(self.known());
        self.open = self.counters.iter().map(|it| self.is_idle_block(*it)).collect();
    }

    fn known(&self) -> Known<'_> {
        let Self { sides, inputs, compared, counters, idle, .. } = self;
        Known { sides, inputs, compared, counters, idle }
    }

    /// The values at the start of the variables that one side's program alone writes.
    pub fn starts(&self, side: usize) -> HashMap<Name, Range> {
        settled::starts(self.known(), side)
    }

    /// What decides all that is to come, as a number: two states with the same key behave the same way under
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
            let passed_over = self.remaining.get(&self.passed).map(|it| &it.idle[number]);
            let idle = passed_over.into_iter().flatten().chain(&self.idle.bytes[number]);
            idle.for_each(|it| state[it.clone()].fill(0));
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
}

impl Pair {
    /// Whether neither program can fault.
    pub fn is_faultless(&self) -> bool {
        let is = |it: &Side| effects(&it.program, &Rules::PLAIN).iter().all(|routine| !routine.faults);
        self.sides.iter().all(is)
    }

    /// Looks for what decides nothing of what is compared now. A program that may fault may do so by everything.
    pub fn find_idle(&mut self) {
        if !self.is_faultless() {
            self.idle = Idle::default();
            return;
        }
        let fields = [0, 1].map(|side: usize| {
            let compared: Vec<Declared> = self.compared.iter().filter_map(|it| self.declared(side, *it)).collect();
            let deciding = Dependencies::of(&self.sides[side].program).deciding(&compared);
            let scalars = &self.sides[side].scalars;
            let all = scalars.all.iter().filter_map(|it| it.field);
            let all = all.chain(scalars.blocks.iter().filter_map(|it| it.field));
            all.filter(|it| !deciding.contains(it)).collect::<HashSet<_>>()
        });
        let bytes = [0, 1].map(|side: usize| bytes_of(&self.sides[side].scalars, &fields[side]));
        self.idle = Idle { bytes, fields };
    }

    /// Whether nothing compared depends on a block, by its positions.
    pub fn is_idle_block(&self, block: Matched) -> bool {
        (0..2).all(|side| {
            let field = self.sides[side].scalars.blocks[block[side]].field;
            field.is_some_and(|it| self.idle.fields[side].contains(&it))
        })
    }
}
