//! How many instructions the scans of a task run at most, when it is due.

use super::task::Task;
use staunch_ir::{Location, Program};
use staunch_native::{Gap, Longest, Measures, Unknown, Why};

/// The instructions of one scan of each instance of a task.
pub struct Time {
    /// `None` where something is not bounded.
    pub instructions: Option<u64>,
    /// The chain of calls of the longest scan, each function with what a call of it runs.
    pub path: Vec<(String, u64)>,
    pub unbounded: Vec<Unbounded>,
}

/// What is not bounded.
pub struct Unbounded {
    /// A loop's file, and its line and column.
    pub place: Option<(String, Location)>,
    pub text: String,
}

pub fn of_task(task: &Task, program: &Program, measures: &Measures) -> Time {
    let scan = |it: &super::task::Instance| measures.longest_scan(&|caller, callee| it.makes(measures, caller, callee));
    let scans: Vec<Longest> = task.instances.iter().map(scan).collect();
    let mut unknown: Vec<Unknown> = scans.iter().flat_map(|it| it.unknown.iter().cloned()).collect();
    unknown.sort_unstable();
    unknown.dedup();
    let sum = scans.iter().map(|it| it.instructions).fold(0, u64::saturating_add);
    let longest = scans.into_iter().max_by_key(|it| it.instructions);
    Time {
        instructions: unknown.is_empty().then_some(sum),
        path: longest.map(|it| it.path).unwrap_or_default(),
        unbounded: unknown.iter().map(|it| unbounded(program, it)).collect(),
    }
}

/// On a machine whose instructions are not counted.
pub fn not_counted() -> Time {
    let text = "instructions are counted for x86-64 only".to_owned();
    Time { instructions: None, path: Vec::new(), unbounded: vec![Unbounded { place: None, text }] }
}

fn unbounded(program: &Program, it: &Unknown) -> Unbounded {
    match it {
        Unknown::Loop { at, why } => {
            let file = program.files.get(usize::from(at.file)).map_or_else(|| "?".to_owned(), |it| it.path.clone());
            Unbounded { place: Some((file, *at)), text: reason(*why).to_owned() }
        }
        Unknown::Call(symbol) => {
            Unbounded { place: None, text: format!("it is not known how long a call of {symbol} takes") }
        }
        Unknown::Code(function, gap) => {
            Unbounded { place: None, text: format!("the code of {function}: {}", part(*gap)) }
        }
    }
}

fn part(gap: Gap) -> &'static str {
    match gap {
        Gap::All => "it was not counted",
        Gap::Instruction => "it has an unknown instruction",
        Gap::Call => "it has a call whose target is not known",
        Gap::Loop => "it has a loop that does not come from the source",
    }
}

fn reason(why: Why) -> &'static str {
    match why {
        Why::Limits => "the limits of this FOR are not constant",
        Why::Written => "something else may write the counter of this FOR",
        Why::Condition => "it is not known how many times this loop runs",
        Why::Constant => "this loop has no limit",
    }
}

impl Unbounded {
    /// As a line of a diagnostic.
    pub fn line(&self) -> String {
        match &self.place {
            Some((file, at)) => format!("{file}:{}:{}: {}", at.line, at.column, self.text),
            None => self.text.clone(),
        }
    }
}
