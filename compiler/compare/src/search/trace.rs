//! Sequences of inputs, as what repeats in them.

use crate::pair::Step;
use std::rc::Rc;

/// Steps that follow one another, each for some scans, again and again.
#[derive(Clone, Debug, PartialEq)]
pub struct Group {
    pub body: Vec<(Step, usize)>,
    pub times: usize,
}

/// A sequence from the start.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Trace {
    pub groups: Vec<Group>,
}

impl Trace {
    /// Puts together what repeats: one step, or a pattern of a few.
    pub fn of(steps: Vec<Step>) -> Self {
        let mut runs: Vec<(Step, usize)> = Vec::new();
        for step in steps {
            match runs.last_mut() {
                Some((last, count)) if *last == step && step.event.is_none() => *count += 1,
                _ => runs.push((step, 1)),
            }
        }
        let mut groups: Vec<Group> = Vec::new();
        let mut at = 0;
        while at < runs.len() {
            let (length, times) = repetition(&runs[at..]);
            groups.push(Group { body: runs[at..at + length].to_vec(), times });
            at += length * times;
        }
        Self { groups }
    }

    pub fn steps(&self) -> impl Iterator<Item = &Step> {
        let body = |group: &'_ Group| group.body.len();
        self.groups.iter().flat_map(move |group| {
            let count = body(group) * group.times;
            (0..count).flat_map(move |at| {
                let (step, scans) = &group.body[at % group.body.len()];
                std::iter::repeat_n(step, *scans)
            })
        })
    }

    pub fn scans(&self) -> usize {
        self.groups.iter().map(|it| it.times * it.body.iter().map(|it| it.1).sum::<usize>()).sum()
    }

    /// The first scans alone.
    #[must_use]
    pub fn first(&self, scans: usize) -> Self {
        Self::of(self.steps().take(scans).cloned().collect())
    }
}

/// How many runs at the start repeat, and how often.
fn repetition(runs: &[(Step, usize)]) -> (usize, usize) {
    let repeats = |length: usize| runs.chunks_exact(length).take_while(|it| *it == &runs[..length]).count();
    let found = (1..=4).filter(|it| *it <= runs.len()).map(|it| (it, repeats(it)));
    found.filter(|it| it.1 > 1).max_by_key(|(length, times)| (length * times, usize::MAX - length)).unwrap_or((1, 1))
}

/// How a state was reached: a tree whose branches are patterns.
#[derive(Debug, Default)]
pub struct Paths {
    nodes: Vec<(usize, Way)>,
}

/// What leads from one state to the next.
#[derive(Clone, Debug)]
pub enum Way {
    /// These steps, again and again, for as many scans.
    Cycle(Rc<[Step]>, usize),
    /// Two steps in turn, each for as many scans as it took.
    Wave(Rc<[Step]>, Vec<usize>),
}

/// The start.
pub const ROOT: usize = usize::MAX;

impl Paths {
    pub fn add(&mut self, parent: usize, way: Way) -> usize {
        self.nodes.push((parent, way));
        self.nodes.len() - 1
    }

    pub fn steps(&self, mut at: usize, last: &Way) -> Vec<Step> {
        let mut ways = vec![last];
        while let Some((parent, way)) = self.nodes.get(at) {
            ways.push(way);
            at = *parent;
        }
        ways.into_iter().rev().flat_map(Way::steps).collect()
    }
}

impl Way {
    fn steps(&self) -> Vec<Step> {
        match self {
            Self::Cycle(steps, scans) => steps.iter().cycle().take(*scans).cloned().collect(),
            Self::Wave(steps, halves) => {
                let half = |(step, scans): (&Step, &usize)| std::iter::repeat_n(step.clone(), *scans);
                steps.iter().cycle().zip(halves).flat_map(half).collect()
            }
        }
    }
}
