//! What the search knows of the world around the programs.

use super::tolerance::Tolerance;
use crate::difference::beyond::{self, Candidate};
use crate::difference::pitfall::{self, Habits};
use crate::inputs::alphabet::{self, Alphabet};
use crate::inputs::assume::{Assumptions, Mentioned};
use crate::pair::Pair;
use crate::program::facts::Facts;
use crate::program::unfollowed;
use crate::request::Request;
use staunch_ir::Value;
use std::collections::BTreeSet;

#[derive(Debug)]
pub struct World {
    pub alphabet: Alphabet,
    pub assumptions: Assumptions,
    /// The inputs before anything sets them.
    pub initial: Vec<Value>,
    /// Every sequence of more scans is left to patterns.
    pub depth: Option<usize>,
    /// Every constant of the programs.
    pub constants: BTreeSet<i128>,
    /// Scans that the longest wait in the programs takes.
    pub longest: usize,
    /// Whether a program assigns its own inputs, so that a stimulus has to write them in each scan.
    pub inputs_written: bool,
    /// How the programs use each counter.
    pub habits: Vec<Habits>,
    /// Variables that the two systems compute in other types.
    pub computed: Vec<Candidate>,
    /// Rules of the two systems that the programs use and that are not followed.
    pub unfollowed: Vec<String>,
    /// Values that the documents of the two systems leave open, and that the programs may come to.
    pub open: Vec<String>,
    /// Of which inputs only a part of the values is tried, since the other system has no more.
    pub in_common: Vec<String>,
    /// What is accepted, if the search continues past it.
    pub tolerance: Option<Tolerance>,
}

impl World {
    /// The inputs, and what is known of them.
    pub fn of(pair: &mut Pair, request: &Request) -> Result<Self, String> {
        let mut facts = [0, 1].map(|side: usize| Facts::of(&pair.sides[side].program));
        let mentioned = request.assumed.as_ref().map(|it| Mentioned::of(&it.1)).unwrap_or_default();
        let mut sources = alphabet::sources(pair, facts.each_ref(), &mentioned);
        if alphabet::has_tables(pair, facts.each_ref(), &sources.inputs) {
            facts = [0, 1].map(|side: usize| Facts::without_tables(&pair.sides[side].program));
            sources = alphabet::sources(pair, facts.each_ref(), &mentioned);
        }
        let facts = facts.each_ref();
        (pair.inputs, pair.kept) = (sources.inputs, sources.kept);
        let assumptions = match &request.assumed {
            Some((path, text)) => Assumptions::of(path, text, pair)?,
            None => Assumptions::default(),
        };
        pair.never.clone_from(&assumptions.never);
        let alphabet = Alphabet::of(pair, facts, &assumptions);
        if alphabet.vectors.is_empty() {
            return Err("the assumptions allow no combination of the values of inputs that are tried".to_owned());
        }
        for (input, choice) in pair.inputs.iter_mut().zip(&alphabet.choices) {
            input.range = choice.range;
        }
        let cycle = pair.shortest_cycle();
        let wait = facts.iter().flat_map(|it| it.times.last().copied()).max().unwrap_or(0);
        let longest = usize::try_from(wait / pair.shortest_cycle().max(1)).unwrap_or(usize::MAX);
        let habits = pitfall::uses(pair).into_iter().map(|it| it.habits).collect();
        let mut computed = if request.against.is_none() { beyond::computed_apart(pair) } else { Vec::new() };
        let known: Vec<_> = computed.iter().map(|it| it.variable).collect();
        computed.extend(beyond::held_apart(pair).into_iter().filter(|it| !known.contains(&it.variable)));
        beyond::note_counters(pair, &mut computed);
        if pair.is_ported {
            // A counter's pins are written otherwise there: what differs by that is the counter's.
            let ty = |it: &Candidate, side: usize| pair.scalar(side, it.variable[side]).ty.elementary();
            computed.retain(|it| it.counters.is_empty() || ty(it, 0) != ty(it, 1));
        }
        let sides = || pair.sides.iter().enumerate().map(|(side, it)| (it, pair.starts(side)));
        let unfollowed = sides().flat_map(|(it, starts)| unfollowed::find(&it.program, it.dialect, cycle, &starts));
        let unfollowed = unfollowed.collect();
        let open = sides().flat_map(|(it, starts)| unfollowed::open(&it.program, it.dialect, &starts)).collect();
        Ok(Self {
            alphabet,
            assumptions,
            initial: pair.initial(),
            depth: request.depth,
            constants: facts.iter().flat_map(|it| it.constants.iter().copied()).collect(),
            longest: longest.min(20_000),
            inputs_written: alphabet::are_written(pair, facts),
            habits,
            computed,
            unfollowed,
            open,
            in_common: alphabet::in_common(pair),
            tolerance: None,
        })
    }
}
