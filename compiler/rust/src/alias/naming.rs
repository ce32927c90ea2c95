//! What copies and their parameters are called: what is copied, and what is special about it.

use staunch_ir::{Program, Routine, RoutineKind};

use super::key::{Binding, Globals, Key, SharedRoot};

/// The names of the parameters and globals that share storage, `a_b`.
fn sharing(program: &Program, source: &Routine, key: &Key, with: SharedRoot) -> String {
    let is_shared = |binding: &Binding| match binding {
        Binding::Within { root, .. } => *root == with,
        Binding::Own => false,
    };
    let params = key.bindings[1..].iter().zip(&source.params).filter(|(binding, _)| is_shared(binding));
    let mut names: Vec<&str> = params.map(|(_, param)| param.name.as_str()).collect();
    if let Globals::Apart(bindings) = &key.globals {
        let fields = &program.structure(program.globals).fields;
        let shared = bindings.iter().filter(|(_, binding)| is_shared(binding));
        names.extend(shared.map(|(field, _)| fields[field.index()].name.as_str()));
    }
    names.join("_")
}

pub fn group_name(program: &Program, source: &Routine, key: &Key, number: usize) -> String {
    format!("shared_{}", sharing(program, source, key, SharedRoot::Group(number)))
}

/// `scan_apart`, `Swap_sharing_a_b`: what is copied, and what is special about the copy.
pub fn copy_name(program: &Program, source: &Routine, key: &Key) -> String {
    let verb = match source.kind {
        RoutineKind::Function | RoutineKind::Method => String::new(),
        RoutineKind::Body => "_scan".to_owned(),
        RoutineKind::Prescan => "_prescan".to_owned(),
    };
    let is_scan = matches!(source.kind, RoutineKind::Body | RoutineKind::Prescan);
    let own = key.bindings[0] == Binding::Own && is_scan;
    let mut name = if own { verb.trim_start_matches('_').to_owned() } else { format!("{}{verb}", source.name) };
    if key.is_apart() {
        name.push_str("_apart");
    }
    let groups = (0..key.groups.len()).map(SharedRoot::Group);
    for root in [SharedRoot::Instance].into_iter().chain(groups) {
        let sharing = sharing(program, source, key, root);
        if !sharing.is_empty() {
            name.push_str(&format!("_sharing_{sharing}"));
        }
    }
    name
}
