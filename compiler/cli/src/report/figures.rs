//! All that is known of a program's code for one target.

use super::memory::{self, Memory, Sizes};
use super::stack::{self, Need};
use super::task::{Task, tasks};
use super::time::{self, Time};
use staunch_ir::Program;
use staunch_native::Target;

pub struct Figures {
    pub target: String,
    pub tasks: Vec<OfTask>,
    /// Of all tasks together, with the global variables and what an object has once.
    pub whole: Memory,
}

/// What one task takes.
pub struct OfTask {
    pub task: Task,
    pub memory: Memory,
    pub stack: Need,
    pub time: Time,
}

impl Figures {
    pub fn of(program: &Program, target: &Target) -> Result<Self, String> {
        let measures = staunch_native::measures(program, target).map_err(|it| it.to_string())?;
        let sizes = Sizes::of(program)?;
        let of_task = |task: Task| OfTask {
            memory: memory::of_task(&task, &measures, &sizes),
            stack: stack::of_task(&task, &measures),
            time: match target.has_counts() {
                true => time::of_task(&task, program, &measures),
                false => time::not_counted(),
            },
            task,
        };
        Ok(Self {
            target: target.name(),
            tasks: tasks(program).into_iter().map(of_task).collect(),
            whole: memory::whole(&measures, &sizes),
        })
    }
}
