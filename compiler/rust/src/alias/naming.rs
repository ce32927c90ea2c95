//! What copies and their parameters are called: what is copied, and what is special about it.

use staunch_ir::{Program, Routine, RoutineKind, Type};

use super::{Binding, Key, SharedRoot, Step};

/// The names of the parameters that share storage, `a_b`.
fn sharing(source: &Routine, key: &Key, with: SharedRoot) -> String {
    let bound = key.bindings[1..].iter().zip(&source.params);
    let names = bound.filter_map(|(binding, param)| match binding {
        Binding::Within { root, .. } if *root == with => Some(param.name.clone()),
        Binding::Within { .. } | Binding::Own => None,
    });
    names.collect::<Vec<_>>().join("_")
}

pub fn group_name(source: &Routine, key: &Key, number: usize) -> String {
    format!("shared_{}", sharing(source, key, SharedRoot::Group(number)))
}

/// `Motor_scan_on_pump`, `Swap_sharing_a_b`: what is copied, and what is special about the copy.
pub fn copy_name(program: &Program, source: &Routine, key: &Key) -> String {
    let verb = match source.kind {
        RoutineKind::Function => String::new(),
        RoutineKind::Body => "_scan".to_owned(),
        RoutineKind::Prescan => "_prescan".to_owned(),
    };
    let own = key.bindings[0] == Binding::Own && source.kind != RoutineKind::Function;
    let mut name = if own { verb.trim_start_matches('_').to_owned() } else { format!("{}{verb}", source.name) };
    let mut roots = vec![SharedRoot::Instance];
    roots.extend((0..key.groups.len()).map(SharedRoot::Group));
    for root in roots {
        let sharing = sharing(source, key, root);
        if !sharing.is_empty() {
            name.push_str(&format!("_sharing_{sharing}"));
        }
    }
    for binding in &key.bindings {
        if let Binding::Within { root: SharedRoot::Globals, steps } = binding {
            name.push_str(&format!("_on{}", path_name(program, steps)));
        }
    }
    name
}

/// The fields on a way from the globals, `_plant_pump`.
fn path_name(program: &Program, steps: &[Step]) -> String {
    let mut ty = Type::Struct(program.globals);
    let mut name = String::new();
    for step in steps {
        ty = match (step, ty) {
            (Step::Field(field), Type::Struct(id)) => {
                let field = &program.structure(id).fields[field.index()];
                name.push('_');
                name.push_str(&field.name);
                field.ty
            }
            (Step::Field(pin), Type::Block(id)) => {
                name.push('_');
                name.push_str(id.info().pins[pin.index()].name);
                id.pin_type(*pin).expect("verified IR: the pin exists")
            }
            (Step::Index, Type::Array(id)) => program.array(id).element,
            (Step::Field(_) | Step::Index, _) => unreachable!("verified IR: projections fit their types"),
        };
    }
    name
}
