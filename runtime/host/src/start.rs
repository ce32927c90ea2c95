//! The state of a program after an event: the initial values, and the values that the event keeps. The map lists
//! these variables; the compiler decides which they are.

use crate::Machine;
use crate::map::{Map, Structure, Type, Variable};
use std::collections::HashMap;
use std::ops::Range;

/// What starts a program again.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Event {
    /// A power cycle.
    Restart,
    /// IDLE -> RUN, STOP -> RUN.
    Run,
    /// A warm reset, which keeps retained variables.
    Reset,
}

impl Event {
    pub const ALL: [Self; 3] = [Self::Restart, Self::Run, Self::Reset];

    /// Its name in a stimulus.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Restart => "restart",
            Self::Run => "run",
            Self::Reset => "reset",
        }
    }
}

/// What each event keeps, as ranges of the state.
#[derive(Clone, Debug)]
pub(crate) struct Start {
    over_power_cycle: Vec<Range<usize>>,
    over_run: Vec<Range<usize>>,
}

impl Start {
    pub fn of(map: &Map) -> Self {
        let ranges = |event| {
            let parts = kept_parts(map, event).into_iter();
            joined(parts.map(|it| it.offset..it.offset + map.size_of(it.ty)))
        };
        Self { over_power_cycle: ranges(Event::Restart), over_run: ranges(Event::Run) }
    }

    pub fn kept(&self, event: Event) -> &[Range<usize>] {
        match event {
            Event::Restart | Event::Reset => &self.over_power_cycle,
            Event::Run => &self.over_run,
        }
    }

    /// Everything except what the event keeps takes its initial value.
    pub fn again(&self, event: Event, machine: &mut dyn Machine) {
        let before = machine.state().to_vec();
        machine.init();
        for range in self.kept(event) {
            machine.write(range.start, &before[range.clone()]);
        }
    }
}

/// What a power cycle keeps, as ranges of the state.
pub fn retained(map: &Map) -> Vec<Range<usize>> {
    Start::of(map).over_power_cycle
}

/// Neighbours as one.
fn joined(ranges: impl Iterator<Item = Range<usize>>) -> Vec<Range<usize>> {
    let mut found: Vec<Range<usize>> = Vec::new();
    for range in ranges {
        match found.last_mut() {
            Some(last) if last.end == range.start => last.end = range.end,
            _ => found.push(range),
        }
    }
    found
}

/// A part of the state that is kept as one.
#[derive(Clone, Debug)]
pub(crate) struct Part {
    pub path: String,
    pub ty: Type,
    pub range: Option<(i128, i128)>,
    pub offset: usize,
}

/// What an event keeps, in the order of the declarations.
pub(crate) fn kept_parts(map: &Map, event: Event) -> Vec<Part> {
    let mut walk = Walk { map, event, holds: HashMap::new(), found: Vec::new() };
    let (globals, base) = map.globals();
    for member in globals {
        walk.variable("Globals", base, member, Kept::Not);
    }
    for instance in &map.instances {
        for member in map.structure(instance.ty).map_or(&[][..], |it| &it.members) {
            walk.variable(&instance.name, instance.offset, member, Kept::Not);
        }
    }
    walk.found
}

/// What is known of that of which a variable is a part.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Kept {
    Not,
    /// But for parts that start anew.
    Retained,
    Whole,
}

struct Walk<'m> {
    map: &'m Map,
    event: Event,
    /// Whether a structure holds a variable that is kept.
    holds: HashMap<u32, bool>,
    found: Vec<Part>,
}

impl Walk<'_> {
    fn variable(&mut self, scope: &str, base: usize, variable: &Variable, outside: Kept) {
        let kept = self.own(variable, outside);
        if !variable.constant && (kept != Kept::Not || self.holds(variable.ty)) {
            let path = format!("{scope}.{}", variable.name);
            self.part(path, variable.ty, variable.range, base + variable.offset, kept);
        }
    }

    fn own(&self, variable: &Variable, outside: Kept) -> Kept {
        let stays = variable.stays && self.event == Event::Run;
        match outside {
            _ if variable.whole || stays => Kept::Whole,
            Kept::Whole => Kept::Whole,
            _ if variable.retain => Kept::Retained,
            Kept::Retained if !variable.restarts => Kept::Retained,
            Kept::Retained | Kept::Not => Kept::Not,
        }
    }

    fn part(&mut self, path: String, ty: Type, range: Option<(i128, i128)>, offset: usize, kept: Kept) {
        let map = self.map;
        match (ty, map.array(ty)) {
            _ if self.is_in_parts(ty, kept) => {
                // The members of a UNION are kept as the bytes that they share.
                let members = map.structure(ty).map_or(&[][..], |it| &it.members);
                for member in members.iter().filter(|it| !it.view) {
                    self.variable(&path, offset, member, kept);
                }
            }
            (_, Some(array)) if self.is_of_parts(array.element, kept) => {
                for (position, index) in (array.low..=array.high).enumerate() {
                    let element = offset + position * array.stride;
                    self.part(format!("{path}[{index}]"), array.element, None, element, kept);
                }
            }
            _ if kept != Kept::Not => self.found.push(Part { path, ty, range, offset }),
            _ => {}
        }
    }

    fn is_of_parts(&self, element: Type, kept: Kept) -> bool {
        match self.map.array(element) {
            Some(inner) => self.is_of_parts(inner.element, kept),
            None => self.is_in_parts(element, kept),
        }
    }

    /// Whether the members of the type are kept one by one.
    fn is_in_parts(&self, ty: Type, kept: Kept) -> bool {
        let restarts = |it: &Structure| it.members.iter().any(|it| it.restarts);
        match ty {
            Type::Struct(_) => true,
            Type::Block(_) => kept != Kept::Whole && self.map.structure(ty).is_some_and(restarts),
            Type::Elementary(_)
            | Type::Bit(_)
            | Type::Reference
            | Type::String(_)
            | Type::Characters(_)
            | Type::Enum(_)
            | Type::Array(_) => false,
        }
    }

    fn holds(&mut self, ty: Type) -> bool {
        match ty {
            Type::Array(_) => self.map.array(ty).is_some_and(|it| self.holds(it.element)),
            Type::Struct(id) => {
                if let Some(known) = self.holds.get(&id) {
                    return *known;
                }
                let structure: Option<&Structure> = self.map.structure(ty);
                let found = structure.is_some_and(|it| {
                    it.members.iter().any(|it| self.own(it, Kept::Not) != Kept::Not || self.holds(it.ty))
                });
                self.holds.insert(id, found);
                found
            }
            Type::Elementary(_)
            | Type::Bit(_)
            | Type::Reference
            | Type::String(_)
            | Type::Characters(_)
            | Type::Enum(_)
            | Type::Block(_) => false,
        }
    }
}
