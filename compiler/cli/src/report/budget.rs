//! The budgets of `staunch.toml`: what a task may take.

use super::figures::{Figures, OfTask};
use super::stack::Need;
use super::time::Time;
use staunch_build::Project;

/// A sentence for each budget that a task exceeds, or may exceed.
pub fn exceeded(figures: &Figures, project: &Project) -> Vec<String> {
    let mut sentences = Vec::new();
    for OfTask { task, stack, time, .. } in &figures.tasks {
        let stack = project.max_stack.and_then(|most| over_stack(stack, most));
        let time = project.max_scan_instructions.and_then(|most| over_time(time, most));
        for (key, problem) in [("max-stack", stack), ("max-scan-instructions", time)] {
            let place = || project.place(key, None);
            sentences.extend(problem.map(|it| format!("{}: `{key}`: the scan of {} {it}", place(), task.name)));
        }
    }
    sentences
}

fn over_stack(need: &Need, most: u64) -> Option<String> {
    if !need.unknown.is_empty() {
        let unknown = need.unknown_names();
        return Some(format!(
            "needs an unknown amount of stack: it calls {unknown}, which is implemented outside Structured Text"
        ));
    }
    (need.bytes > most)
        .then(|| format!("takes {} bytes of the stack, more than {most}: {}", need.bytes, path(&need.path)))
}

fn over_time(time: &Time, most: u64) -> Option<String> {
    match time.instructions {
        Some(it) if it <= most => None,
        Some(it) => Some(format!("runs up to {it} instructions, more than {most}: {}", path(&time.path))),
        None => {
            let reasons: Vec<_> = time.unbounded.iter().map(|it| format!("\n  {}", it.line())).collect();
            Some(format!("has no bound:{}", reasons.concat()))
        }
    }
}

/// From the outermost function, each with its number.
pub fn path(path: &[(String, u64)]) -> String {
    path.iter().map(|(name, number)| format!("{name} {number}")).collect::<Vec<_>>().join(" > ")
}
