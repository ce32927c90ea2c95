//! A block whose EN stops its body on one of the two systems alone.

use crate::pair::{Matched, Pair, Row};
use crate::program::apart::Declared;
use crate::program::dependency::Dependencies;
use crate::program::held;
use crate::program::walked::{Name, Walked};
use staunch_ir::{Expr, Program, Routine, RoutineId, StatementKind, visit};

/// Why a variable differs, where it follows from the body of a block that was called with EN FALSE.
pub fn reason(pair: &Pair, row: &Row, variable: Matched) -> Option<String> {
    let stops = [0, 1].map(|side: usize| stopping(&pair.sides[side].program));
    (0..2).find_map(|side| {
        let program = &pair.sides[side].program;
        let name = |it: &Declared| program.structure(it.0).name.to_ascii_uppercase();
        let others = |it: &Declared| {
            let other = &pair.sides[1 - side].program;
            stops[1 - side].iter().any(|own| other.structure(own.0).name.to_ascii_uppercase() == name(it))
        };
        let dependencies = Dependencies::of(program);
        let declared = pair.declared(side, variable)?;
        let decides = |it: &&Declared| dependencies.follow(**it).contains(&declared);
        let was_false = |it: &&Declared| {
            let mut all = pair.sides[side].scalars.all.iter().filter(|scalar| scalar.field == Some(**it));
            all.any(|it| held::number(program, it, &row.states[side]) == Some(0))
        };
        let own = stops[side].iter().filter(|it| !others(it));
        let enable = own.filter(decides).find(was_false)?;
        let structure = program.structure(enable.0);
        let system = pair.sides[side].dialect.name();
        let field = &structure.fields[enable.1.index()].name;
        Some(format!("`{field}` stops the body of `{}` only on {system}, where a call gives FALSE", structure.name))
    })
}

/// The inputs EN that a body begins by asking for, to be left where one is FALSE.
fn stopping(program: &Program) -> Vec<Declared> {
    let of = |(at, routine): (usize, &Routine)| {
        let asks = routine.body.iter().find_map(|it| match &it.kind {
            StatementKind::If { condition, then, .. }
                if then.last().is_some_and(|it| matches!(it.kind, StatementKind::Return)) =>
            {
                Some(condition)
            }
            _ => None,
        });
        enable(program, (routine, RoutineId::next(at)), asks?)
    };
    program.routines.iter().enumerate().filter_map(of).collect()
}

fn enable(program: &Program, routine: (&Routine, RoutineId), condition: &Expr) -> Option<Declared> {
    let mut found = None;
    visit::reads(condition, &mut |place| {
        if let Some(Name::Field(owner, field)) = Walked::of(program, routine, place).variable() {
            found = Some((owner, field));
        }
    });
    found.filter(|(owner, field)| program.structure(*owner).fields[field.index()].name.eq_ignore_ascii_case("EN"))
}
