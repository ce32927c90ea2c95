//! Which steps each transition leaves and enters, which actions each step has, and the order in which an editor of Beremiz' and
//! OpenPLC's kind writes them: it asks of each element what comes before it.

use super::super::super::assembly::Trouble;
use super::super::super::diagram::{Refusal, Wire};
use super::element::{Chart, Element, Kind};
use rustc_hash::{FxHashMap, FxHashSet};

/// No chart has as many lines in a row.
const DEEPEST: usize = 200;

type Of<T> = Result<T, Refusal>;

/// A step, by its place among the elements.
pub type StepAt = usize;

#[derive(Debug, Default)]
pub struct Networks {
    /// In the order in which they are found.
    pub initial: Vec<StepAt>,
    /// The transitions after each step, and its action blocks.
    pub transitions: FxHashMap<StepAt, Vec<usize>>,
    pub actions: FxHashMap<StepAt, Vec<usize>>,
    /// All transitions, in the order in which they are found.
    pub found: Vec<usize>,
    pub from: FxHashMap<usize, Vec<StepAt>>,
    pub to: FxHashMap<usize, Vec<StepAt>>,
}

struct Finder<'c> {
    chart: &'c Chart,
    by_id: FxHashMap<&'c str, usize>,
    steps: FxHashMap<String, StepAt>,
    seen: FxHashSet<usize>,
    found: Networks,
}

impl Networks {
    pub fn of(chart: &Chart) -> Of<Self> {
        let mut finder = Finder {
            chart,
            by_id: FxHashMap::default(),
            steps: FxHashMap::default(),
            seen: FxHashSet::default(),
            found: Self::default(),
        };
        finder.name_elements()?;
        for (at, element) in chart.elements.iter().enumerate() {
            match &element.kind {
                Kind::Step { .. } => finder.step(at)?,
                Kind::Transition { .. } => finder.transition(at)?,
                // One that is not connected to the chart does nothing.
                Kind::Actions(_) if element.inputs.iter().all(Vec::is_empty) => {}
                Kind::Actions(_) => {
                    let step = finder.step_of(element)?;
                    finder.step(step)?;
                    finder.found.actions.entry(step).or_default().push(at);
                }
                Kind::Jump(_) => finder.jump(element)?,
                Kind::Line => {}
                Kind::Refused(what) => {
                    return Err(refuse(element, Trouble::NotSupported, format!("{what} is not supported")));
                }
            }
        }
        let first = chart.elements.iter().find(|it| matches!(it.kind, Kind::Step { .. }));
        match first.filter(|_| finder.found.initial.is_empty()) {
            Some(first) => Err(odd(first, "no step is an initial step".to_owned())),
            None => Ok(finder.found),
        }
    }
}

impl<'c> Finder<'c> {
    fn name_elements(&mut self) -> Of<()> {
        for (at, element) in self.chart.elements.iter().enumerate() {
            if self.by_id.insert(&element.id, at).is_some() {
                return Err(odd(element, format!("another element has the localId `{}`, too", element.id)));
            }
            if let Kind::Step { name, .. } = &element.kind {
                let is_name = name.text.chars().all(|it| it.is_alphanumeric() || it == '_');
                match name.text.as_str() {
                    "" => return Err(odd(element, "this step has no name".to_owned())),
                    name if !is_name => return Err(odd(element, format!("`{name}` is not a name for a step"))),
                    _ => {}
                }
                if self.steps.insert(name.text.to_ascii_uppercase(), at).is_some() {
                    return Err(odd(element, format!("another step has the name `{}`, too", name.text)));
                }
            }
        }
        Ok(())
    }

    /// The element that a connection comes from.
    fn source(&self, wire: &Wire) -> Of<usize> {
        self.by_id.get(wire.from.as_str()).copied().ok_or_else(|| Refusal {
            place: wire.place.clone(),
            trouble: Trouble::Odd,
            message: format!("this connection comes from element {}, which is not in the chart", wire.from),
        })
    }

    fn sources(&self, element: &Element) -> Of<Vec<usize>> {
        element.inputs.iter().flatten().map(|it| self.source(it)).collect()
    }

    fn step(&mut self, at: StepAt) -> Of<()> {
        if !self.seen.insert(at) {
            return Ok(());
        }
        let element = &self.chart.elements[at];
        if matches!(element.kind, Kind::Step { is_initial: true, .. }) {
            self.found.initial.push(at);
        }
        self.entered(element, at)
    }

    /// What enters a step does so after the element that is drawn above it, or above the jump to it.
    fn entered(&mut self, element: &'c Element, step: StepAt) -> Of<()> {
        let mut transitions = Vec::new();
        for source in self.sources(element)? {
            self.transitions_before(source, &mut transitions, 0)?;
        }
        for transition in transitions {
            self.transition(transition)?;
            self.found.to.entry(transition).or_default().push(step);
        }
        Ok(())
    }

    fn jump(&mut self, element: &'c Element) -> Of<()> {
        let Kind::Jump(name) = &element.kind else { return Ok(()) };
        let Some(step) = self.steps.get(&name.text.to_ascii_uppercase()).copied() else {
            return Err(odd(
                element,
                format!("this jump is to the step `{}`, which the chart does not have", name.text),
            ));
        };
        self.entered(element, step)
    }

    fn transition(&mut self, at: usize) -> Of<()> {
        if !self.seen.insert(at) {
            return Ok(());
        }
        self.found.found.push(at);
        let mut steps = Vec::new();
        for source in self.sources(&self.chart.elements[at])? {
            self.steps_before(source, &mut steps, 0)?;
        }
        for step in steps {
            self.step(step)?;
            self.found.from.entry(at).or_default().push(step);
            self.found.transitions.entry(step).or_default().push(at);
        }
        Ok(())
    }

    /// The transitions that a line, or the transition itself, comes from.
    fn transitions_before(&self, at: usize, found: &mut Vec<usize>, depth: usize) -> Of<()> {
        let element = self.within(at, depth)?;
        match &element.kind {
            Kind::Transition { .. } => found.push(at),
            Kind::Line => {
                for source in self.sources(element)? {
                    self.transitions_before(source, found, depth + 1)?;
                }
            }
            Kind::Step { name, .. } => {
                return Err(odd(
                    element,
                    format!("no transition is between the step `{}` and the next one", name.text),
                ));
            }
            Kind::Jump(_) | Kind::Actions(_) | Kind::Refused(_) => {}
        }
        Ok(())
    }

    fn steps_before(&self, at: usize, found: &mut Vec<StepAt>, depth: usize) -> Of<()> {
        let element = self.within(at, depth)?;
        match &element.kind {
            Kind::Step { .. } => found.push(at),
            Kind::Line => {
                for source in self.sources(element)? {
                    self.steps_before(source, found, depth + 1)?;
                }
            }
            Kind::Transition { .. } => {
                return Err(odd(element, "no step is between this transition and the next one".to_owned()));
            }
            Kind::Jump(_) | Kind::Actions(_) | Kind::Refused(_) => {}
        }
        Ok(())
    }

    fn within(&self, at: usize, depth: usize) -> Of<&'c Element> {
        let element = &self.chart.elements[at];
        match depth < DEEPEST {
            true => Ok(element),
            false => {
                let message = format!("more than {DEEPEST} lines of a chart are connected in a row");
                Err(refuse(element, Trouble::NotSupported, message))
            }
        }
    }

    fn step_of(&self, block: &Element) -> Of<StepAt> {
        let sources = self.sources(block)?;
        let is_step = |it: &&usize| matches!(self.chart.elements[**it].kind, Kind::Step { .. });
        let found = sources.iter().find(is_step).copied();
        found.ok_or_else(|| odd(block, "this action block is connected with no step".to_owned()))
    }
}

fn odd(element: &Element, message: String) -> Refusal {
    refuse(element, Trouble::Odd, message)
}

pub fn refuse(element: &Element, trouble: Trouble, message: String) -> Refusal {
    Refusal { place: element.place.clone(), trouble, message }
}
