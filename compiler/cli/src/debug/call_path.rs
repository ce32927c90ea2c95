//! The way of calls to a statement: `Main > motors[2] > Step`.

use crate::declared;
use staunch_frontend::Sources;
use staunch_host::{Map, Type, instance_at};
use staunch_ir::interpret::debug::{Ask, Running, Stopped};
use staunch_ir::{HELD_PROGRAM, Program, RoutineKind};

/// What is called, from the PROGRAM on.
pub(super) fn call_path<A: Ask>(stopped: &Stopped<'_, A>, map: &Map, sources: &Sources) -> Vec<String> {
    let mut names = Vec::new();
    let mut caller: Option<String> = None;
    let mut instance = None;
    for running in stopped.running() {
        let routine = stopped.program().routine(running.routine());
        let own = routine.state.map(|state| (running.instance(), state));
        if let Some((offset, state)) = own.filter(|it| instance != Some(*it)) {
            let path = instance_at(map, offset, Type::Struct(state.0));
            let path = path.unwrap_or_else(|| class_name(stopped.program(), running));
            // A run of a CONFIGURATION holds its PROGRAM, which has no name of its own.
            if !path.ends_with(HELD_PROGRAM) {
                names.push(relative(&path, caller.as_deref()).to_owned());
            }
            caller = Some(path);
        }
        if matches!(routine.kind, RoutineKind::Function | RoutineKind::Method) {
            names.push(declared::name(sources, routine));
        }
        // A FUNCTION has no instance: what it calls is seen from its caller.
        instance = own.or(instance);
    }
    names
}

/// A path as it is seen from the instance that calls.
fn relative<'a>(path: &'a str, caller: Option<&str>) -> &'a str {
    caller.and_then(|it| path.strip_prefix(it)?.strip_prefix('.')).unwrap_or(path)
}

/// What an instance among local variables is called.
fn class_name(program: &Program, running: &Running) -> String {
    let state = program.routine(running.routine()).state;
    state.and_then(|it| program.class_of_state(it)).map_or_else(String::new, |it| it.name.clone())
}
