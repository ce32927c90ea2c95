//! What was run of a project, and what came of it. It is shown until a text of the project changes.

use rustc_hash::FxHashMap;
use staunch_frontend::Dialect;

/// What can be run.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Task {
    /// The test with a title.
    Test(String),
    /// The comparison of the program with itself on another system.
    Compare(Dialect),
}

#[derive(Debug, Default)]
pub struct Results {
    /// How often all was forgotten: what runs meanwhile is of other texts.
    generation: u64,
    outcomes: FxHashMap<Task, Outcome>,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Outcome {
    Runs,
    /// In a line.
    Ended(String),
}

impl Results {
    pub fn forget(&mut self) {
        self.generation += 1;
        self.outcomes.clear();
    }

    pub fn generation(&self) -> u64 {
        self.generation
    }

    pub fn get(&self, task: &Task) -> Option<&Outcome> {
        self.outcomes.get(task)
    }

    pub fn begin(&mut self, task: Task) {
        self.outcomes.insert(task, Outcome::Runs);
    }

    /// Notes what came of tasks that began in a generation.
    pub fn end(&mut self, generation: u64, ended: impl IntoIterator<Item = (Task, String)>) {
        if generation == self.generation {
            self.outcomes.extend(ended.into_iter().map(|(task, outcome)| (task, Outcome::Ended(outcome))));
        }
    }
}
