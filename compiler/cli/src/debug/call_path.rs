//! The way of calls to a statement: `Main > motors[2] > Step`.

use staunch_host::{Map, path_at};
use staunch_ir::interpret::debug::{Ask, Running, Stopped};
use staunch_ir::{Program, RoutineKind, Type};

/// What is called, from the PROGRAM on.
pub(super) fn call_path<A: Ask>(stopped: &Stopped<'_, A>, map: &Map) -> Vec<String> {
    let mut names = Vec::new();
    let mut caller = None;
    for running in stopped.running() {
        let routine = stopped.program().routine(running.routine());
        let instance = routine.state.map(|state| (running.instance(), state));
        if let Some((offset, state)) = instance.filter(|it| caller != Some(*it)) {
            let path = instance_path(map, stopped.program(), offset, stopped.size(Type::Struct(state)));
            let path = path.unwrap_or_else(|| class_name(stopped.program(), running));
            names.push(relative(path, caller.and_then(|it| full(stopped, map, it))));
        }
        if matches!(routine.kind, RoutineKind::Function | RoutineKind::Method) {
            names.push(routine.name.clone());
        }
        // A FUNCTION has no instance: what it calls is seen from its caller.
        caller = instance.or(caller);
    }
    names
}

fn full<A: Ask>(stopped: &Stopped<'_, A>, map: &Map, (offset, state): (usize, staunch_ir::StructId)) -> Option<String> {
    instance_path(map, stopped.program(), offset, stopped.size(Type::Struct(state)))
}

/// A PROGRAM that runs, or a variable.
fn instance_path(map: &Map, program: &Program, offset: usize, size: usize) -> Option<String> {
    let whole = map.instances.iter().find(|it| it.offset == offset && map.size_of(it.ty) == size);
    let held = |it: String| it.replace(&format!(".{}", staunch_ir::HELD_PROGRAM), "");
    let is_state = offset < map.size && !program.instances.is_empty();
    whole.map(|it| it.name.clone()).or_else(|| path_at(map, offset, size).filter(|_| is_state).map(held))
}

/// A path as it is seen from the instance that calls.
fn relative(path: String, caller: Option<String>) -> String {
    let inner = caller.and_then(|it| path.strip_prefix(&it)?.strip_prefix('.').map(str::to_owned));
    inner.unwrap_or(path)
}

/// What an instance among local variables is called.
fn class_name(program: &Program, running: &Running) -> String {
    let state = program.routine(running.routine()).state;
    state.and_then(|it| program.class_of_state(it)).map_or_else(String::new, |it| it.name.clone())
}
