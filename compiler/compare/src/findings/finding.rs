//! For each counter and pitfall: reachable, with inputs that show it; impossible, and why; or undecided.

use super::enable;
use crate::difference::accept::{Accepted, Line};
use crate::difference::beyond;
use crate::difference::kind::Kind;
use crate::difference::pitfall::{self, Cause, Pitfall, Use};
use crate::pair::{Matched, Pair, Row};
use crate::program::scalar::Role;
use crate::search::progress::Outcome;
use crate::search::shrink::{self, Goal};
use crate::search::sighting::Subject;
use crate::search::trace::Trace;
use crate::search::world::World;
use staunch_ir::Location;
use std::collections::{HashMap, HashSet};

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
    pub kind: Kind,
    /// The counter, block or variable; of a fault, its kind.
    pub subject: String,
    /// Where the first program says so; that of a counter is its name.
    pub at: Option<Location>,
    pub pitfall: Option<Pitfall>,
    /// Why, where neither the trap nor the kind says so.
    pub because: Option<String>,
    pub verdict: Verdict,
}

#[derive(Debug, Default)]
pub struct Findings {
    pub all: Vec<Finding>,
    /// Where in `all` those are that are of no counter.
    others: HashMap<Subject, usize>,
    /// Which outputs follow from accepted findings is known: the search went on past those, or found nothing at all.
    pub has_all_outputs: bool,
}

impl Findings {
    /// What the systems' rules and the programs' texts alone say.
    pub fn new(pair: &Pair, world: &World, uses: &[Use], renamed: &[Option<String>]) -> Self {
        let mut all = Vec::new();
        for (at, usage) in uses.iter().enumerate() {
            let instances = pair.instances(at);
            for pitfall in Pitfall::of_counters() {
                let is_named = || renamed.iter().any(|it| is_of(it.as_deref(), &instances[0].path));
                let verdict = match pitfall::impossible(pitfall, instances, *usage) {
                    _ if pitfall.number() == 9 && instances[0].is_renamed(instances[1]) && is_named() => {
                        Verdict::Reachable(None)
                    }
                    Some(why) => Verdict::Impossible(why.to_owned()),
                    None => Verdict::Undecided,
                };
                let (kind, subject) = (Kind::Counter, instances[0].path.clone());
                all.push(Finding { kind, subject, at: None, pitfall: Some(pitfall), because: None, verdict });
            }
        }
        let mut found = Self { all, others: HashMap::new(), has_all_outputs: false };
        found.add_others(pair, world);
        found
    }

    /// What else may differ: it is open until the search has seen it.
    fn add_others(&mut self, pair: &Pair, world: &World) {
        let program = &pair.sides[0].program;
        for (at, [ours, _]) in pair.blocks.iter().enumerate() {
            let instance = &pair.sides[0].scalars.blocks[*ours];
            let place = instance.field.map(|it| beyond::location(program, it));
            self.add(Subject::Block(at), Kind::of(instance), instance.path.clone(), place);
        }
        for (at, it) in world.computed.iter().enumerate() {
            self.add(Subject::Computed(at), it.kind, pair.path(it.variable).to_owned(), Some(it.at));
        }
        for it in beyond::kept_by_one(pair) {
            let subject = pair.path(it.variable).to_owned();
            self.add(Subject::Variable(it.variable), Kind::Retention, subject, Some(it.at));
        }
    }

    fn add(&mut self, key: Subject, kind: Kind, subject: String, at: Option<Location>) {
        self.others.insert(key, self.all.len());
        self.all.push(Finding { kind, subject, at, pitfall: None, because: None, verdict: Verdict::Undecided });
    }

    pub fn all_impossible(&mut self, why: &str) {
        for finding in &mut self.all {
            finding.verdict = Verdict::Impossible(why.to_owned());
        }
        self.has_all_outputs = true;
    }

    /// Whether anything can be reached that is not accepted.
    pub fn fail(&self, accepted: &Accepted) -> bool {
        self.all.iter().any(|it| it.is_reachable() && !it.is_accepted(accepted))
    }

    /// A sentence for each line that accepts nothing.
    pub fn stale(&self, accepted: &Accepted) -> Vec<String> {
        let is_of = |it: &Finding, line: &Line| line.takes(it.kind, &it.subject, it.pitfall);
        let stale = |line: &&Line| {
            if line.is_of(Kind::Output) && !self.has_all_outputs {
                return false;
            }
            let open = |it: &&Finding| is_of(it, line) && !matches!(it.verdict, Verdict::Impossible(_));
            !self.all.iter().any(|it| open(&it))
        };
        let sentence = |line: &Line| {
            let why = self.all.iter().find(|it| is_of(it, line)).and_then(|it| match &it.verdict {
                Verdict::Impossible(why) => Some(format!("is impossible: {why}")),
                Verdict::Reachable(_) | Verdict::Undecided => None,
            });
            let why = why.unwrap_or_else(|| "does not exist".to_owned());
            format!("{} is accepted, but {why}", accepted.describe(line))
        };
        accepted.lines.iter().filter(stale).map(sentence).collect()
    }

    /// How many of counters are not decided.
    pub fn open(&self) -> usize {
        self.all.iter().filter(|it| it.is_open()).count()
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
        let per_counter = Pitfall::of_counters().count();
        for (sighting, trace) in &traces {
            let place = |it: Pitfall| Pitfall::of_counters().position(|own| own == it);
            if let (Subject::Counter(at), Some(number)) = (sighting.0, sighting.1.and_then(place)) {
                let known = &mut self.all[at * per_counter + number].verdict;
                if !matches!(known, Verdict::Reachable(Some(_))) {
                    *known = Verdict::Reachable(Some(trace.clone()));
                }
            }
        }
        let all_seen = if outcome.found.is_some() { outcome.all_seen } else { outcome.complete };
        if all_seen && exact {
            let unseen = self.not_compared(pair, world);
            let is_open = |at: usize| pair.open.get(at / per_counter).is_some_and(|it| *it) || unseen.contains(&at);
            let undecided = self.all.iter_mut().enumerate().filter(|it| matches!(it.1.verdict, Verdict::Undecided));
            for (_, finding) in undecided.filter(|it| !is_open(it.0)) {
                finding.verdict = Verdict::Impossible("every reachable state was seen".to_owned());
            }
        }
        let mut others: Vec<_> = traces.into_iter().collect();
        others.sort_by_key(|(sighting, trace)| (trace.scans(), *sighting));
        for ((subject, pitfall), trace) in others {
            if !matches!((subject, pitfall), (Subject::Counter(_), Some(_))) {
                self.sighted(pair, subject, pitfall, trace);
            }
        }
    }

    /// Where those are in the list that the search does not look at: variables that are not compared, and blocks that decide nothing
    /// which is.
    fn not_compared(&self, pair: &Pair, world: &World) -> HashSet<usize> {
        let variable = |it: &Subject| match it {
            Subject::Variable(it) | Subject::Parted(it) | Subject::Output(it) => Some(*it),
            Subject::Computed(at) => Some(world.computed[*at].variable),
            Subject::Counter(_) | Subject::Block(_) | Subject::Fault(..) => None,
        };
        let is_left_out = |it: &Subject| match it {
            Subject::Block(at) => pair.is_idle_block(pair.blocks[*at]),
            it => variable(it).is_some_and(|it| !pair.compared.contains(&it)),
        };
        self.others.iter().filter(|it| is_left_out(it.0)).map(|it| *it.1).collect()
    }

    /// What the whole difference is put down to has been seen, also where the counter had parted before: the search
    /// looks for what parts counters that agree. So have variables that an event has parted, compared or not.
    pub fn explain(&mut self, pair: &Pair, rows: &[Row], cause: &Cause, trace: &Trace) {
        let is_parted = |it: Matched| {
            let parts = |at: usize| {
                let agreed = at.checked_sub(1).is_none_or(|before| pair.same(it, &rows[before]));
                rows[at].event.is_some() && agreed && !pair.same(it, &rows[at])
            };
            (0..rows.len()).any(parts)
        };
        for (subject, at) in &self.others {
            let known = &mut self.all[*at];
            if let Subject::Variable(it) = subject
                && !matches!(known.verdict, Verdict::Reachable(_))
                && is_parted(*it)
            {
                (known.pitfall, known.verdict) = (Some(Pitfall::RESTART), Verdict::Reachable(Some(trace.clone())));
            }
        }
        let is_it = |it: &&mut Finding| {
            it.kind == Kind::Counter && it.pitfall == cause.pitfall && Some(&it.subject) == cause.counter.as_ref()
        };
        if let Some(it) = self.all.iter_mut().find(is_it)
            && !matches!(it.verdict, Verdict::Reachable(_))
        {
            it.verdict = Verdict::Reachable(Some(trace.clone()));
        }
    }

    /// Variables that differ at the end of a trace which no trap explains, and no finding does. A fault is a finding.
    pub fn unexplained(&mut self, pair: &Pair, row: &Row, differences: &[Matched], trace: &Trace) {
        if pair.faults_differ(row.faults) {
            return;
        }
        let is_known =
            |it: &Finding, at| it.at == at && !matches!(it.verdict, Verdict::Impossible(_) | Verdict::Undecided);
        for matched in differences.iter().filter(|it| pair.scalar(0, it[0]).role == Role::Variable) {
            let (kind, subject, at) = described(pair, Subject::Parted(*matched));
            if !self.all.iter().any(|it| it.subject == subject && is_known(it, at)) {
                let verdict = Verdict::Reachable(Some(trace.clone()));
                let because = enable::reason(pair, row, *matched);
                self.all.push(Finding { kind, subject, at, pitfall: None, because, verdict });
            }
        }
    }

    /// Outputs that differ at the end of a trace because of what is accepted.
    pub fn outputs(&mut self, pair: &Pair, differences: &[Matched], trace: &Trace) {
        for it in differences {
            let (kind, subject, at) = described(pair, Subject::Output(*it));
            let verdict = Verdict::Reachable(Some(trace.clone()));
            self.all.push(Finding { kind, subject, at, pitfall: None, because: None, verdict });
        }
    }

    /// What is seen of no counter's trap: the shortest trace is the first of several.
    fn sighted(&mut self, pair: &Pair, subject: Subject, pitfall: Option<Pitfall>, trace: Trace) {
        let place = self.others.get(&self.declared(pair, subject)).copied();
        let verdict = Verdict::Reachable(Some(trace));
        match place.and_then(|at| self.all.get_mut(at)) {
            Some(known) if matches!(known.verdict, Verdict::Reachable(_)) && known.pitfall == pitfall => {}
            Some(known) if !matches!(known.verdict, Verdict::Reachable(_)) => {
                (known.pitfall, known.verdict) = (pitfall, verdict);
            }
            Some(known) => {
                let more = Finding { pitfall, verdict, ..known.clone() };
                self.all.push(more);
            }
            None => {
                let (kind, subject, at) = described(pair, subject);
                self.all.push(Finding { kind, subject, at, pitfall, because: None, verdict });
            }
        }
    }

    /// The subject that is listed: of a variable, one scalar of its declaration.
    fn declared(&self, pair: &Pair, subject: Subject) -> Subject {
        let Subject::Variable(seen) = subject else { return subject };
        let field = |it: Matched| pair.scalar(0, it[0]).field;
        let same = |it: &&Subject| matches!(it, Subject::Variable(other) if field(*other) == field(seen));
        self.others.keys().find(same).copied().unwrap_or(subject)
    }
}

/// Whether a name in the text may be that of an instance: by the last part of its path.
fn is_of(name: Option<&str>, path: &str) -> bool {
    let last = path.rsplit('.').next().unwrap_or(path);
    let last = last.split('[').next().unwrap_or(last);
    name.is_none_or(|it| it.eq_ignore_ascii_case(last))
}

/// What the text does not say beforehand.
fn described(pair: &Pair, subject: Subject) -> (Kind, String, Option<Location>) {
    let variable = |it: Matched, kind: Kind| {
        let scalar = pair.scalar(0, it[0]);
        let at = scalar.field.map(|it| beyond::location(&pair.sides[0].program, it));
        (kind, scalar.path.clone(), at)
    };
    match subject {
        Subject::Counter(at) => (Kind::Counter, pair.instances(at)[0].path.clone(), None),
        Subject::Variable(it) => variable(it, Kind::Retention),
        Subject::Parted(it) => variable(it, Kind::Variable),
        Subject::Output(it) => variable(it, Kind::Output),
        Subject::Fault(side, at) => (Kind::Fault, pair.sides[side].dialect.name().to_owned(), Some(at)),
        Subject::Block(_) | Subject::Computed(_) => unreachable!("they are listed before the search"),
    }
}

impl Finding {
    /// Why it differs, where no trap says so.
    pub fn reason(&self, is_one_program: bool) -> &str {
        self.because.as_deref().unwrap_or_else(|| self.kind.reason(is_one_program))
    }

    /// Whether it is reason enough to fail: not what only follows from another finding.
    pub fn is_reachable(&self) -> bool {
        let follows = match self.kind {
            Kind::Timer | Kind::OneShot | Kind::Latch => self.pitfall.is_none(),
            Kind::Counter
            | Kind::Width
            | Kind::Address
            | Kind::Retention
            | Kind::Fault
            | Kind::Variable
            | Kind::Output => false,
        };
        matches!(self.verdict, Verdict::Reachable(Some(_))) && !follows
    }

    pub fn is_accepted(&self, accepted: &Accepted) -> bool {
        accepted.takes(self.kind, &self.subject, self.pitfall)
    }

    /// Whether a trap of a counter is neither shown nor ruled out.
    pub fn is_open(&self) -> bool {
        self.kind == Kind::Counter && matches!(self.verdict, Verdict::Undecided)
    }

    pub fn trace(&self) -> Option<&Trace> {
        match &self.verdict {
            Verdict::Reachable(trace) => trace.as_ref(),
            Verdict::Impossible(_) | Verdict::Undecided => None,
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    #[test]
    fn a_line_that_accepts_nothing_is_stale() {
        let accepted = Accepted::parse("parts 2: nobody reads it\nparts 3: never below 0", "a.txt").unwrap();
        let finding = Finding {
            kind: Kind::Counter,
            at: None,
            subject: "parts".to_owned(),
            pitfall: Some(Pitfall::numbered(2)),
            because: None,
            verdict: Verdict::Impossible("it does not count up".to_owned()),
        };
        let findings = Findings { all: vec![finding], ..Findings::default() };
        assert_eq!(
            findings.stale(&accepted),
            [
                "a.txt:1: trap 2 of `parts` is accepted, but is impossible: it does not count up",
                "a.txt:2: trap 3 of `parts` is accepted, but does not exist"
            ]
        );
    }
}
