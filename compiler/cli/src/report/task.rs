//! The tasks of a program: what runs together, at one period.

use staunch_ir::{Program, RoutineId};
use staunch_native::{Callee, Measures};
use std::collections::BTreeSet;

/// A TASK of the source; or a PROGRAM that no TASK runs.
pub struct Task {
    /// Of the TASK, or of the instance.
    pub name: String,
    /// Nanoseconds between two scans, where the source says so.
    pub interval: Option<i64>,
    pub instances: Vec<Instance>,
}

/// A PROGRAM that runs in a task.
pub struct Instance {
    pub name: String,
    /// Its position in the program.
    pub at: usize,
    /// The routines that `staunch_scan` calls for it.
    roots: BTreeSet<usize>,
}

/// In the order in which they run when all are due.
pub fn tasks(program: &Program) -> Vec<Task> {
    let mut order: Vec<_> = program.instances.iter().enumerate().collect();
    order.sort_by_key(|(_, it)| it.priority);
    let mut tasks: Vec<Task> = Vec::new();
    for (at, it) in order {
        let instance = Instance { name: it.name.clone(), at, roots: roots(program, at) };
        let known = it.task.as_ref().and_then(|name| tasks.iter_mut().find(|task| task.name == *name));
        match known {
            Some(task) => task.instances.push(instance),
            None => tasks.push(Task {
                name: it.task.as_ref().unwrap_or(&it.name).clone(),
                interval: it.interval,
                instances: vec![instance],
            }),
        }
    }
    tasks
}

/// Its body, its prescan, and what starts the instances of all.
fn roots(program: &Program, instance: usize) -> BTreeSet<usize> {
    let class = program.class(program.instances[instance].program);
    let starts = program.starts().into_iter().map(|it| it.1);
    [Some(class.body), class.prescan].into_iter().flatten().chain(starts).map(RoutineId::index).collect()
}

impl Instance {
    /// Whether a scan of this instance makes a call: `staunch_scan` calls the bodies of others too, unless it is a body itself.
    pub fn makes(&self, measures: &Measures, caller: usize, callee: &Callee) -> bool {
        let is_body_of_scan = self.roots.contains(&measures.scan);
        match callee {
            Callee::Function(it) if caller == measures.scan && !is_body_of_scan => self.roots.contains(it),
            Callee::Function(_) | Callee::Outside(_) => true,
        }
    }

    /// All functions that a scan of this instance may run.
    pub fn functions(&self, measures: &Measures) -> BTreeSet<usize> {
        let (mut found, mut open) = (BTreeSet::new(), vec![measures.scan]);
        while let Some(at) = open.pop() {
            if !found.insert(at) {
                continue;
            }
            for callee in measures.functions[at].calls.iter().filter(|it| self.makes(measures, at, it)) {
                match callee {
                    Callee::Function(it) => open.push(*it),
                    Callee::Outside(_) => {}
                }
            }
        }
        found
    }
}
