//! Bytes of variables, of read-only data and of code.

use super::task::Task;
use staunch_host::{Map, retained};
use staunch_ir::Program;
use staunch_ir::layout::Layout;
use staunch_ir::symbols::map_text;

use staunch_native::Measures;
use std::collections::BTreeSet;
use std::ops::Range;

/// In bytes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Memory {
    /// Variables that live from scan to scan.
    pub state: u64,
    /// Those of them that a power cycle keeps.
    pub retained: u64,
    /// Read-only data.
    pub constant: u64,
    /// Code, without the runtime's.
    pub text: u64,
}

/// Where variables are.
pub struct Sizes {
    /// All, with the global variables.
    state: u64,
    /// The part of each instance.
    instances: Vec<Range<u64>>,
    retained: Vec<Range<u64>>,
    /// The bytes of the map, which an object holds too.
    map: u64,
}

impl Sizes {
    pub fn of(program: &Program) -> Result<Self, String> {
        let layout = Layout::new(program);
        let map: Map = staunch_machine::map(program)?;
        let wide = |at: usize| u64::try_from(at).unwrap_or(u64::MAX);
        let starts = program.instances.iter().zip(&layout.machine.instances);
        let instance = |(it, start): (&staunch_ir::Instance, &u64)| {
            let state = program.class(it.program).state;
            *start..*start + layout.size(staunch_ir::Type::Struct(state))
        };
        Ok(Self {
            state: layout.machine.size,
            instances: starts.map(instance).collect(),
            retained: retained(&map).into_iter().map(|it| wide(it.start)..wide(it.end)).collect(),
            map: wide(map_text(program, &layout).len()) + 8,
        })
    }

    fn retained_in(&self, part: &Range<u64>) -> u64 {
        let within = |it: &Range<u64>| it.end.min(part.end).saturating_sub(it.start.max(part.start));
        self.retained.iter().map(within).sum()
    }
}

/// What is of one task: the variables of its instances, and what its code reads. Tasks may share code and constants.
pub fn of_task(task: &Task, measures: &Measures, sizes: &Sizes) -> Memory {
    let parts: Vec<_> = task.instances.iter().map(|it| &sizes.instances[it.at]).collect();
    let functions: BTreeSet<usize> = task.instances.iter().flat_map(|it| it.functions(measures)).collect();
    let constants: BTreeSet<usize> =
        functions.iter().flat_map(|it| measures.functions[*it].constants.iter().copied()).collect();
    Memory {
        state: parts.iter().map(|it| it.end - it.start).sum(),
        retained: parts.iter().map(|it| sizes.retained_in(it)).sum(),
        constant: constants.iter().map(|it| measures.constants[*it]).sum(),
        text: functions.iter().map(|it| measures.functions[*it].text).sum(),
    }
}

/// What an object of the program holds, and the state that it works on.
pub fn whole(measures: &Measures, sizes: &Sizes) -> Memory {
    Memory {
        state: sizes.state,
        retained: sizes.retained_in(&(0..sizes.state)),
        constant: measures.constants.iter().sum::<u64>() + sizes.map,
        text: measures.functions.iter().map(|it| it.text).sum(),
    }
}
