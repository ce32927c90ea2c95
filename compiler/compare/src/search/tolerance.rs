//! What is accepted while the search continues: an accepted finding that has been seen is passed over from then on, with
//! all that its counter, block or variable decides. What else is compared still is.

use super::sighting::{Sighting, Subject};
use crate::difference::accept::Accepted;
use crate::difference::beyond::{self, Candidate};
use crate::difference::kind::Kind;
use crate::difference::pitfall::{Pitfall, Use};
use crate::pair::idle::bytes_of;
use crate::pair::passing::{Passed, Passing};
use crate::pair::{Matched, Pair};
use crate::program::dependency::{Declared, Dependencies};
use crate::program::scalar::Role;
use staunch_host::Event;
use std::collections::{HashMap, HashSet};

#[derive(Debug)]
pub struct Tolerance {
    /// The bit of each sighting that is accepted.
    sightings: HashMap<Sighting, usize>,
    /// Variables that are accepted to differ, by how they are computed or for no known reason.
    differing: Vec<(Matched, usize)>,
    /// Those for no known reason.
    parted: Vec<Matched>,
    /// Outputs that are accepted to follow from what is accepted.
    outputs: Vec<Matched>,
    /// What an event is accepted to part.
    events: Vec<(Event, usize)>,
    /// What each bit leaves out of the comparison.
    pub passing: Passing,
    /// Variables and blocks that are not accepted, of declarations of which others are: their effects are not distinguished.
    pub beside: Vec<String>,
}

impl Tolerance {
    /// `is_named`: what is compared was asked for by name, so that all of it is an output.
    pub fn of(pair: &Pair, computed: &[Candidate], uses: &[Use], accepted: &Accepted, is_named: bool) -> Self {
        let found = Self {
            sightings: HashMap::new(),
            differing: Vec::new(),
            parted: Vec::new(),
            outputs: Vec::new(),
            events: Vec::new(),
            passing: Passing {
                faults: [0, 1].map(|side: usize| accepted.takes(Kind::Fault, pair.sides[side].dialect.name(), None)),
                is_faultless: pair.is_faultless(),
                ..Passing::default()
            },
            beside: Vec::new(),
        };
        let roots = HashMap::new();
        let dependencies = pair.sides.each_ref().map(|it| Dependencies::of(&it.program));
        let own = outputs(pair, accepted, is_named);
        let mut builder = Builder { pair, accepted, dependencies, own, roots, subjects: HashMap::new(), found };
        builder.outputs(is_named);
        builder.counters(uses);
        builder.blocks();
        builder.variables(computed);
        builder.found.beside = builder.beside();
        builder.found
    }

    /// The accepted findings that the last scan shows.
    pub fn passed(&self, pair: &Pair, event: Option<Event>, sightings: &[Sighting]) -> Passed {
        let seen = sightings.iter().filter_map(|it| self.sightings.get(it).copied());
        let differing = self.differing.iter().filter(|it| pair.differs_now(it.0)).map(|it| it.1);
        let parted = self.events.iter().filter(|it| Some(it.0) == event).map(|it| it.1);
        let mut bits = Passed::new();
        for bit in seen.chain(differing).chain(parted) {
            let word = bit / 64;
            bits.resize(bits.len().max(word + 1), 0);
            bits[word] |= 1 << (bit % 64);
        }
        bits
    }

    /// Variables that are accepted to differ for no known reason, and outputs that are accepted to follow, where they
    /// differ since the last scan.
    pub fn parted(&self, pair: &Pair) -> impl Iterator<Item = Sighting> {
        let parted = self.parted.iter().map(|it| (*it, Subject::Parted(*it)));
        let all = parted.chain(self.outputs.iter().map(|it| (*it, Subject::Output(*it))));
        all.filter(|it| pair.newly_differs(it.0)).map(|it| (it.1, None))
    }
}

/// What has to be named to be passed over: outputs by their declaration, and what `--vars` asks for.
fn is_output(pair: &Pair, matched: Matched, is_named: bool) -> bool {
    is_named || (0..2).any(|side| pair.scalar(side, matched[side]).at.is_output)
}

/// The outputs that no line accepts.
fn outputs(pair: &Pair, accepted: &Accepted, is_named: bool) -> HashSet<Matched> {
    let is_accepted = |path: &str| [Kind::Output, Kind::Variable].into_iter().any(|it| accepted.names(it, path));
    let outputs = pair.compared.iter().filter(|it| is_output(pair, **it, is_named));
    outputs.filter(|it| !is_accepted(pair.path(**it))).copied().collect()
}

struct Builder<'p> {
    pair: &'p Pair,
    accepted: &'p Accepted,
    dependencies: [Dependencies; 2],
    /// Outputs that are passed over by lines of their own alone.
    own: HashSet<Matched>,
    roots: HashMap<[Option<Declared>; 2], usize>,
    /// What is accepted by itself, by its declaration: others of that are not.
    subjects: HashMap<Declared, HashSet<String>>,
    found: Tolerance,
}

impl Builder<'_> {
    /// The outputs that a line accepts, whatever they follow from.
    fn outputs(&mut self, is_named: bool) {
        let is_accepted = |it: &&Matched| {
            is_output(self.pair, **it, is_named) && self.accepted.names(Kind::Output, self.pair.path(**it))
        };
        self.found.outputs = self.pair.compared.iter().filter(is_accepted).copied().collect();
    }

    fn counters(&mut self, uses: &[Use]) {
        for (at, usage) in uses.iter().enumerate() {
            let instances = self.pair.instances(at);
            let fields = instances.map(|it| it.field);
            let path = instances[0].path.clone();
            for pitfall in Pitfall::of_counters().map(Some).chain([None]) {
                if self.accepted.takes(Kind::Counter, &path, pitfall) {
                    let bit = self.root(fields);
                    self.note(fields[0], &path);
                    self.found.sightings.insert((Subject::Counter(at), pitfall), bit);
                    if pitfall == Some(Pitfall::RESTART) && !usage.kept_alike {
                        self.found.events.extend(Event::ALL.map(|it| (it, bit)));
                    }
                }
            }
        }
    }

    fn blocks(&mut self) {
        let pair = self.pair;
        for (at, [a, b]) in pair.blocks.iter().enumerate() {
            let instances = [&pair.sides[0].scalars.blocks[*a], &pair.sides[1].scalars.blocks[*b]];
            let kind = Kind::of(instances[0]);
            let keeps = |side: usize, event| pair.sides[side].keeps(event, instances[side].offset);
            for pitfall in [None, Some(Pitfall::RESTART), Some(Pitfall::FIRST_FALL), Some(Pitfall::LATER_CALL)] {
                if self.accepted.takes(kind, &instances[0].path, pitfall) {
                    let bit = self.root(instances.map(|it| it.field));
                    self.note(instances[0].field, &instances[0].path);
                    self.found.sightings.insert((Subject::Block(at), pitfall), bit);
                    if pitfall == Some(Pitfall::RESTART) {
                        let apart = Event::ALL.into_iter().filter(|it| keeps(0, *it) != keeps(1, *it));
                        self.found.events.extend(apart.map(|it| (it, bit)));
                    }
                }
            }
        }
    }

    fn variables(&mut self, computed: &[Candidate]) {
        let pair = self.pair;
        let kept = beyond::kept_by_one(pair);
        let listed: HashMap<Declared, Matched> =
            kept.iter().filter_map(|it| Some((pair.scalar(0, it.variable[0]).field?, it.variable))).collect();
        for it in &kept {
            if self.accepted.takes(Kind::Retention, pair.path(it.variable), Some(Pitfall::RESTART)) {
                let bit = self.root(self.fields(it.variable));
                let keeps =
                    |side: usize, event| pair.sides[side].keeps(event, pair.scalar(side, it.variable[side]).offset);
                let apart = Event::ALL.into_iter().filter(|it| keeps(0, *it) != keeps(1, *it));
                self.found.events.extend(apart.map(|it| (it, bit)));
            }
        }
        for it in computed {
            if self.accepted.takes(it.kind, pair.path(it.variable), None) {
                let bit = self.root(self.fields(it.variable));
                self.found.differing.push((it.variable, bit));
            }
        }
        let is_variable = |it: &&Matched| pair.scalar(0, it[0]).role == Role::Variable;
        for variable in pair.compared.iter().filter(is_variable) {
            let declared = pair.scalar(0, variable[0]).field.and_then(|it| listed.get(&it)).unwrap_or(variable);
            if self.accepted.takes(Kind::Retention, pair.path(*declared), Some(Pitfall::RESTART)) {
                let bit = self.root(self.fields(*variable));
                self.found.sightings.insert((Subject::Variable(*variable), Some(Pitfall::RESTART)), bit);
            }
            if self.accepted.takes(Kind::Variable, pair.path(*variable), None) {
                let bit = self.root(self.fields(*variable));
                self.note(self.fields(*variable)[0], pair.path(*variable));
                self.found.differing.push((*variable, bit));
                self.found.parted.push(*variable);
            }
        }
    }

    fn note(&mut self, declared: Option<Declared>, path: &str) {
        if let Some(declared) = declared {
            self.subjects.entry(declared).or_default().insert(path.to_owned());
        }
    }

    /// What is declared with what is accepted, and is not accepted itself.
    fn beside(&self) -> Vec<String> {
        let scalars = &self.pair.sides[0].scalars;
        let variables = scalars.all.iter().filter(|it| it.role == Role::Variable).map(|it| (it.field, &it.path));
        let all = scalars.blocks.iter().map(|it| (it.field, &it.path)).chain(variables);
        let is_beside = |(declared, path): &(Option<Declared>, &String)| {
            let accepted = declared.and_then(|it| self.subjects.get(&it));
            accepted.is_some_and(|it| !it.contains(*path))
        };
        all.filter(is_beside).map(|it| it.1.clone()).collect()
    }

    fn fields(&self, variable: Matched) -> [Option<Declared>; 2] {
        [0, 1].map(|side| self.pair.declared(side, variable))
    }

    /// The bit of a variable or block.
    fn root(&mut self, fields: [Option<Declared>; 2]) -> usize {
        if let Some(bit) = self.roots.get(&fields) {
            return *bit;
        }
        let follows =
            [0, 1].map(|side: usize| fields[side].map_or_else(HashSet::new, |it| self.dependencies[side].follow(it)));
        let is_in = |it: &&Matched| {
            (0..2).any(|side| self.pair.declared(side, **it).is_some_and(|it| follows[side].contains(&it)))
        };
        let (kept, passed): (Vec<Matched>, Vec<Matched>) = self
            .pair
            .compared
            .iter()
            .filter(is_in)
            .partition(|it| self.own.contains(*it) && !self.is_own(**it, fields));
        let bit = self.found.passing.cones.len();
        self.found.passing.cones.push(passed.into_iter().collect());
        let idle = [0, 1].map(|side: usize| self.idle(side, &follows[side], &kept));
        self.found.passing.kept.push(kept.into_iter().collect());
        self.found.passing.bytes.push([0, 1].map(|side: usize| bytes_of(&self.pair.sides[side].scalars, &idle[side])));
        self.roots.insert(fields, bit);
        bit
    }
}

impl Builder<'_> {
    /// Whether it is an output itself that is accepted to differ, by its name: not that it follows from something else.
    fn is_own(&self, output: Matched, fields: [Option<Declared>; 2]) -> bool {
        let path = self.pair.path(output);
        let is_named = self.accepted.lines.iter().any(|it| it.names(path));
        is_named && self.fields(output) == fields && self.pair.scalar(0, output[0]).role == Role::Variable
    }

    /// Of what follows from an accepted finding, the variables that decide nothing which is compared still.
    fn idle(&self, side: usize, follows: &HashSet<Declared>, kept: &[Matched]) -> HashSet<Declared> {
        let kept: HashSet<Declared> = kept.iter().filter_map(|it| self.pair.declared(side, *it)).collect();
        let decides = |it: &Declared| !self.dependencies[side].follow(*it).is_disjoint(&kept);
        let idle = follows.iter().filter(|it| kept.is_empty() || !decides(it));
        idle.copied().collect()
    }
}
