//! What decides all that is to come of both programs, as a number.

use super::settled::{self, Known, Settled};
use super::side::Side;
use super::{Pair, normal};
use crate::compare::program::flow::Range;
use crate::compare::program::walked::Name;
use staunch_host::Machine;
use std::collections::HashMap;

impl Pair {
    /// Looks for counts of which many are equivalent, by what is compared now.
    pub fn settle_counts(&mut self) {
        self.settled = Settled::of(self.known());
        self.open = vec![false; self.counters.len()];
    }

    fn known(&self) -> Known<'_> {
        let Self { sides, inputs, compared, counters, .. } = self;
        Known { sides, inputs, compared, counters }
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
}
