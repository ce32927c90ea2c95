//! What the last scan, or an event before it, has parted; and by which blocks.

use super::comparison::Comparison;
use super::{Matched, Pair};
use crate::program::held;
use crate::program::scalar::{Instance, Role};

impl Pair {
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
            let value = preset.and_then(|it| held::number(program, it, states[side]));
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
}
