//! Timers whose PT may change while they run: it is assigned beside the calls, or several calls give several.

use super::walked::{Name, Walked};
use staunch_ir::{Expr, ExprKind, Place, Program, Routine, RoutineId, StatementKind, Type, Value, visit};
use std::collections::HashMap;

/// The first line that moves one.
pub fn line(program: &Program) -> Option<u32> {
    let mut given: HashMap<Name, Option<i128>> = HashMap::new();
    let mut first: Option<u32> = None;
    for (number, routine) in program.routines.iter().enumerate() {
        let at = (routine, RoutineId::next(number));
        visit::statements(&routine.body, &mut |statement| {
            let moves = match &statement.kind {
                StatementKind::Assign { target, .. } => is_preset(program, at, target),
                StatementKind::CallBlock { block, inputs, .. } => called(program, at, block, inputs, &mut given),
                _ => false,
            };
            let line = statement.at.line;
            if moves {
                first = Some(first.map_or(line, |it| it.min(line)));
            }
        });
    }
    first
}

fn is_preset(program: &Program, at: (&Routine, RoutineId), place: &Place) -> bool {
    let pin = Walked::of(program, at, place).pin;
    pin.is_some_and(|(block, pin)| {
        let info = block.info();
        info.pin("ET").is_some() && info.pins.get(pin.index()).is_some_and(|it| it.name == "PT")
    })
}

/// Whether a call gives its timer another PT than a call before. One that gives none leaves it as it is.
fn called(
    program: &Program,
    at: (&Routine, RoutineId),
    block: &Place,
    inputs: &[Expr],
    given: &mut HashMap<Name, Option<i128>>,
) -> bool {
    let Type::Block(id) = block.ty else { return false };
    let preset = id.info().inputs().position(|it| it.name == "PT").filter(|_| id.info().pin("ET").is_some());
    let Some(preset) = preset.and_then(|it| inputs.get(it)) else { return false };
    if matches!(&preset.kind, ExprKind::Load(place) if is_preset(program, at, place)) {
        return false;
    }
    let Some(name) = Walked::of(program, at, block).variable() else { return true };
    let number = preset.as_const().and_then(Value::as_integer);
    given.insert(name, number).is_some_and(|before| before != number)
}
