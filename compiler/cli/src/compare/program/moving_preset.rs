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

/// What a call has that gives no PT: the one that is there, which may be the initial one.
const KEPT: Option<i128> = Some(-1);

/// Whether a call gives its timer another PT than a call before.
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
    let is_kept = matches!(&preset.kind, ExprKind::Load(place) if is_preset(program, at, place));
    let input = id.info().inputs().position(|it| it.name == "IN").and_then(|it| inputs.get(it));
    let is_off = input.and_then(Expr::as_const) == Some(Value::Bool(false));
    if is_kept && is_off && id.info().name.contains("TON") {
        // It does not run.
        return false;
    }
    let Some(name) = Walked::of(program, at, block).variable() else { return true };
    let number = if is_kept { KEPT } else { preset.as_const().and_then(Value::as_integer) };
    given.insert(name, number).is_some_and(|before| before != number)
}
