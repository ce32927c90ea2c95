//! The locals that variables get, and the loops whose counters nothing else writes.

use crate::alias::Frame;
use crate::{For, Place, Program, Projection, Root, Routine, Statement, StatementKind, Type};

/// Of one routine.
pub(super) const MOST_LOCALS: usize = 256;

/// As the variable, or as the last member on the way to it.
pub(super) fn name(program: &Program, routine: &Routine, place: &Place) -> String {
    let mut ty = Frame::of(program, routine).root_type(place.root);
    let mut name = match place.root {
        Root::Param(id) => routine.params[id.index()].name.clone(),
        Root::Instance | Root::Globals | Root::Local(_) => String::new(),
    };
    for projection in &place.projections {
        if let (Some(Type::Struct(id)), Projection::Field(field)) = (ty, projection) {
            name.clone_from(&program.structure(id).fields[field.index()].name);
        }
        ty = ty.and_then(|it| program.part(it, projection));
    }
    name
}

/// A loop whose counter only it writes, without its body.
pub(super) fn private_head(statement: &Statement) -> Option<For> {
    match &statement.kind {
        StatementKind::For(it) if it.is_private => Some(For { body: Vec::new(), ..(**it).clone() }),
        _ => None,
    }
}
