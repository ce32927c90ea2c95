//! For each counter and pitfall: reachable, with inputs that show it; impossible, and why; or undecided.

use super::facts::Name;
use super::pair::Pair;
use super::pitfall::{self, Habits, Pitfall, Use};
use super::search::{Outcome, Subject, World};
use super::shrink::{self, Goal};
use super::trace::Trace;
use super::usage::{self, Usage};
use staunch_host::Event;
use staunch_runtime::PinRole;
use std::collections::HashMap;

/// Findings whose traces are made shorter; the others keep theirs.
const MAX_SHRUNK: usize = 24;

#[derive(Clone, Debug)]
pub enum Verdict {
    /// With inputs that show it, where it is not the text alone that does.
    Reachable(Option<Trace>),
    /// With the reason.
    Impossible(String),
    Undecided,
}

#[derive(Clone, Debug)]
pub struct Finding {
    /// The counter or variable.
    pub subject: String,
    pub pitfall: Option<Pitfall>,
    pub verdict: Verdict,
}

#[derive(Debug, Default)]
pub struct Findings {
    pub all: Vec<Finding>,
}

/// How both programs use each counter.
pub fn uses(pair: &Pair) -> Vec<Use> {
    let found = [0, 1].map(|side: usize| usage::of(&pair.sides[side].program));
    let each = |at: usize| {
        let instances = pair.instances(at);
        let of = |side: usize| -> Usage {
            let name = instances[side].field.map(|(owner, field)| Name::Field(owner, field));
            name.and_then(|it| found[side].get(&it)).cloned().unwrap_or_default()
        };
        let [a, b] = [of(0), of(1)];
        let presets: Vec<_> = a.presets.union(&b.presets).collect();
        let kept = |side: usize| {
            let count = instances[side].block.info().pin_for(PinRole::Count);
            let keeps =
                |event| count.is_some_and(|it| pair.sides[side].keeps(event, instances[side].offset + it.offset));
            Event::ALL.map(|it| !pair.never.contains(&it) && keeps(it))
        };
        Use {
            constant_preset: presets.len() == 1 && presets[0].is_some(),
            habits: Habits {
                feeds_itself: a.feeds_itself || b.feeds_itself,
                guards_itself: a.count_depends || b.count_depends,
            },
            resets: a.resets || b.resets,
            reset_depends: a.reset_depends || b.reset_depends,
            kept_alike: kept(0) == kept(1),
        }
    };
    (0..pair.counters.len()).map(each).collect()
}

impl Findings {
    /// What the systems' rules and the programs' texts alone say.
    pub fn new(pair: &Pair, uses: Vec<Use>, renamed: usize) -> Self {
        let mut all = Vec::new();
        for (at, usage) in uses.iter().enumerate() {
            let instances = pair.instances(at);
            for pitfall in Pitfall::all() {
                let verdict = match pitfall::impossible(pitfall, instances, *usage) {
                    _ if pitfall.number() == 9 && renamed > 0 => Verdict::Reachable(None),
                    Some(why) => Verdict::Impossible(why.to_owned()),
                    None => Verdict::Undecided,
                };
                all.push(Finding { subject: instances[0].path.clone(), pitfall: Some(pitfall), verdict });
            }
        }
        Self { all }
    }

    pub fn all_impossible(&mut self, why: &str) {
        for finding in &mut self.all {
            finding.verdict = Verdict::Impossible(why.to_owned());
        }
    }

    /// How many are not decided.
    pub fn open(&self) -> usize {
        self.all.iter().filter(|it| matches!(it.verdict, Verdict::Undecided)).count()
    }

    /// What the search adds. `exact`: it left nothing out that the inputs could do.
    pub fn note(&mut self, pair: &mut Pair, world: &World, outcome: &Outcome, exact: bool) {
        let mut sightings: Vec<_> = outcome.sightings.iter().collect();
        sightings.sort_by_key(|(sighting, trace)| (trace.scans(), **sighting));
        let mut traces: HashMap<_, Trace> = HashMap::new();
        for (at, (sighting, trace)) in sightings.into_iter().enumerate() {
            let shown = match at < MAX_SHRUNK {
                true => shrink::shrink(pair, world, Goal::Sees(*sighting), trace.clone()),
                false => trace.clone(),
            };
            traces.insert(*sighting, shown);
        }
        let per_counter = Pitfall::all().count();
        for (sighting, trace) in &traces {
            if let (Subject::Counter(at), Some(pitfall)) = sighting {
                self.all[at * per_counter + pitfall.number() - 1].verdict = Verdict::Reachable(Some(trace.clone()));
            }
        }
        let all_seen = if outcome.found.is_some() { outcome.all_seen } else { outcome.complete };
        if all_seen && exact {
            for finding in self.all.iter_mut().filter(|it| matches!(it.verdict, Verdict::Undecided)) {
                finding.verdict = Verdict::Impossible("every reachable state was seen".to_owned());
            }
        }
        let mut others: Vec<_> = traces.into_iter().collect();
        others.sort_by_key(|(sighting, trace)| (trace.scans(), *sighting));
        for (sighting, trace) in others {
            let (subject, pitfall) = match sighting {
                (Subject::Variable(matched), pitfall) => (pair.path(matched).to_owned(), pitfall),
                (Subject::Counter(at), None) => (pair.instances(at)[0].path.clone(), None),
                (Subject::Counter(_), Some(_)) => continue,
            };
            self.all.push(Finding { subject, pitfall, verdict: Verdict::Reachable(Some(trace)) });
        }
    }
}

impl Finding {
    pub fn trace(&self) -> Option<&Trace> {
        match &self.verdict {
            Verdict::Reachable(trace) => trace.as_ref(),
            Verdict::Impossible(_) | Verdict::Undecided => None,
        }
    }
}
