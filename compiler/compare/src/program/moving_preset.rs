//! Timers whose PT may change while they run: it varies, or several calls and assignments give several.

use super::flow::{Range, Ranges};
use super::walked::{Name, Walked};
use staunch_ir::visit;
use staunch_ir::{BlockId, Expr, ExprKind, Place, Program, Projection, Routine, RoutineId, StatementKind, Type, Value};
use std::collections::HashMap;

/// What a call or an assignment gives as the PT.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Preset {
    Constant(i128),
    /// The call gives none: it keeps the last one, or the initial one.
    Kept,
    Varying,
}

/// The subscripts on the way to a timer, as far as they are constant.
type Subscripts = Vec<Option<i128>>;

#[derive(Debug)]
struct Given {
    subscripts: Subscripts,
    preset: Preset,
    line: u32,
}

/// The first line that moves one. `starts` are the values of variables at the start.
pub fn line(program: &Program, starts: &HashMap<Name, Range>) -> Option<u32> {
    let given = given(program, starts);
    // It is not known which timers those without a name are.
    let moved = given.iter().flat_map(|(name, all)| {
        all.iter().enumerate().filter(move |(at, it)| name.is_none() || moves(it, &all[..*at])).map(|it| it.1.line)
    });
    moved.min()
}

/// The longest PT of all timers, if each is given a constant wherever it is called.
pub fn longest(program: &Program) -> Option<i128> {
    let given = given(program, &HashMap::new());
    let constant = |it: &Given| match it.preset {
        Preset::Constant(number) => Some(number),
        Preset::Kept | Preset::Varying => None,
    };
    given.values().flatten().map(constant).try_fold(0, |longest, it| Some(it?.max(longest)))
}

fn given(program: &Program, starts: &HashMap<Name, Range>) -> HashMap<Option<Name>, Vec<Given>> {
    let finder = Finder { program, ranges: Ranges::of(program, starts) };
    let mut given: HashMap<Option<Name>, Vec<Given>> = HashMap::new();
    for (number, routine) in program.routines.iter().enumerate() {
        let at = (routine, RoutineId::next(number));
        visit::statements(&routine.body, &mut |statement| {
            let found = match &statement.kind {
                StatementKind::Assign { target, value } => finder.assigned(at, target, value),
                StatementKind::CallBlock { block, inputs, .. } => finder.called(at, block, inputs),
                _ => None,
            };
            if let Some((timer, preset)) = found {
                let name = Walked::of(program, at, &timer).variable();
                let subscripts = subscripts(&timer);
                given.entry(name).or_default().push(Given { subscripts, preset, line: statement.at.line });
            }
        });
    }
    given
}

fn moves(given: &Given, before: &[Given]) -> bool {
    given.preset == Preset::Varying
        || before.iter().any(|it| overlap(&it.subscripts, &given.subscripts) && it.preset != given.preset)
}

fn overlap(a: &Subscripts, b: &Subscripts) -> bool {
    a.iter().zip(b).all(|(a, b)| a.is_none() || b.is_none() || a == b)
}

fn subscripts(place: &Place) -> Subscripts {
    let subscript = |it: &Projection| match it {
        Projection::Index { index, .. } => Some(index.as_const().and_then(Value::as_integer)),
        Projection::Field(_) | Projection::Deref { .. } => None,
    };
    place.projections.iter().filter_map(subscript).collect()
}

struct Finder<'p> {
    program: &'p Program,
    ranges: Ranges<'p>,
}

type At<'p> = (&'p Routine, RoutineId);

impl Finder<'_> {
    /// The timer whose PT is assigned.
    fn assigned(&self, at: At<'_>, target: &Place, value: &Expr) -> Option<(Place, Preset)> {
        self.is_preset(at, target).then(|| {
            let mut timer = target.clone();
            timer.projections.pop();
            (timer, self.preset(at, value))
        })
    }

    fn called(&self, at: At<'_>, block: &Place, inputs: &[Expr]) -> Option<(Place, Preset)> {
        let Type::Block(id) = block.ty else { return None };
        let input = |name: &str| id.info().inputs().position(|it| it.name == name).and_then(|it| inputs.get(it));
        let preset = input("PT").filter(|_| id.info().pin("ET").is_some())?;
        let is_kept = matches!(&preset.kind, ExprKind::Load(place) if self.is_preset(at, place));
        let is_off = input("IN").and_then(Expr::as_const) == Some(Value::Bool(false));
        if is_kept && is_off && runs_while_on(id) {
            return None;
        }
        Some((block.clone(), if is_kept { Preset::Kept } else { self.preset(at, preset) }))
    }

    fn preset(&self, at: At<'_>, value: &Expr) -> Preset {
        match self.ranges.of_value(at, value) {
            (least, most) if least == most => Preset::Constant(least),
            _ => Preset::Varying,
        }
    }

    fn is_preset(&self, at: At<'_>, place: &Place) -> bool {
        let pin = Walked::of(self.program, at, place).pin;
        pin.is_some_and(|(block, pin)| {
            let info = block.info();
            info.pin("ET").is_some() && info.pins.get(pin.index()).is_some_and(|it| it.name == "PT")
        })
    }
}

/// An on-delay does not run where its input is FALSE.
fn runs_while_on(block: BlockId) -> bool {
    block.info().name.contains("TON")
}
