//! Past which counts a counter goes on alike: where a count is compared with constants alone, a CTU above all of them and
//! above every preset stays above them until it is reset, and a CTD below them stays below.

use super::walked::{Name, Walked};
use staunch_ir::visit::{self, Access};
use staunch_ir::{
    BlockId, Conversion, Expr, ExprKind, FieldId, Op, Place, Program, Routine, RoutineId, Statement, StatementKind,
    Type, Value, reference,
};
use staunch_runtime::{BlockInfo, Family, PinRole};
use std::collections::{HashMap, HashSet};

/// All that a count is compared with lies from `least` to `greatest`; but for resets and loads it goes one way.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Bounds {
    pub least: i128,
    pub greatest: i128,
    pub rises: bool,
    pub falls: bool,
}

impl Bounds {
    pub fn add(&mut self, number: i128) {
        self.least = self.least.min(number);
        self.greatest = self.greatest.max(number);
    }
}

/// By the declarations of the counters that have bounds.
pub fn of(program: &Program) -> HashMap<Name, Bounds> {
    let mut walk = Walk { program, found: HashMap::new(), reads: HashMap::new(), open: HashSet::new() };
    for (at, routine) in program.routines.iter().enumerate() {
        visit::statements(&routine.body, &mut |it| walk.statement((routine, RoutineId::next(at)), it));
    }
    walk.open.extend(reference::reached(program).into_iter().map(|(owner, field)| Name::Field(owner, field)));
    let Walk { mut found, reads, open, .. } = walk;
    let is_followed = |name: &Name| !open.contains(name) && reads.get(name).is_none_or(|it| *it == 0);
    found.retain(|name, it| is_followed(name) && it.rises != it.falls);
    found
}

struct Walk<'p> {
    program: &'p Program,
    found: HashMap<Name, Bounds>,
    /// Reads of a count that are no comparison with a constant.
    reads: HashMap<Name, isize>,
    /// What is used in a way that is not followed.
    open: HashSet<Name>,
}

type At<'p> = (&'p Routine, RoutineId);

impl Walk<'_> {
    fn statement(&mut self, at: At<'_>, statement: &Statement) {
        let calls = matches!(statement.kind, StatementKind::CallBlock { .. } | StatementKind::PrescanBlock { .. });
        visit::accesses(statement, &mut |place, access| {
            if !(calls && access == Access::Borrow) {
                self.access(at, place, access);
            }
        });
        visit::values(statement, &mut |it| visit::within(it, &mut |it| self.comparison(at, it)));
        match &statement.kind {
            StatementKind::Assign { target, value } => {
                if let Some((name, _, Some(PinRole::Preset))) = self.pin(at, target) {
                    self.preset(name, value);
                }
            }
            StatementKind::CallBlock { block, instruction, inputs } => self.call(at, block, *instruction, inputs),
            StatementKind::Case { selector, arms, .. } => {
                if let Some(name) = self.count(at, selector) {
                    arms.iter().flat_map(|it| &it.labels).for_each(|it| self.compared(name, [it.0, it.1]));
                    *self.reads.entry(name).or_default() -= 1;
                }
            }
            StatementKind::If { .. }
            | StatementKind::For(_)
            | StatementKind::Loop { .. }
            | StatementKind::Call { .. }
            | StatementKind::External(_)
            | StatementKind::PrescanBlock { .. }
            | StatementKind::Try { .. }
            | StatementKind::Turn
            | StatementKind::Exit
            | StatementKind::Continue
            | StatementKind::Return
            | StatementKind::Fault(_) => {}
        }
    }

    /// A pin of a declared block.
    fn pin(&self, at: At<'_>, place: &Place) -> Option<(Name, BlockId, Option<PinRole>)> {
        let walked = Walked::of(self.program, at, place);
        let (block, pin) = walked.pin?;
        Some((*walked.names.last()?, block, role(block, pin)))
    }

    fn access(&mut self, at: At<'_>, place: &Place, access: Access) {
        match (self.pin(at, place), place.ty) {
            (Some((name, _, Some(PinRole::Count))), _) if access == Access::Read => {
                *self.reads.entry(name).or_default() += 1;
            }
            (Some((name, _, Some(PinRole::Count))), _) => _ = self.open.insert(name),
            // OV and UN of Logix say more than the count.
            (Some((name, block, None)), _) if turns(block.info()) => _ = self.open.insert(name),
            (Some(_), _) => {}
            // A copy of it, or a block that it is handed to.
            (None, Type::Block(_)) => self.open.extend(Walked::of(self.program, at, place).variable()),
            (None, _) => {}
        }
    }

    fn call(&mut self, at: At<'_>, block: &Place, instruction: usize, inputs: &[Expr]) {
        let (Some(name), Type::Block(id)) = (Walked::of(self.program, at, block).variable(), block.ty) else { return };
        let info = id.info();
        if info.pin_for(PinRole::Count).is_none() {
            return;
        }
        let called = &info.instructions[instruction];
        let has = |role| info.pin_for(role).is_some();
        let (rises, falls) = match called.name {
            "" => (has(PinRole::Up), has(PinRole::Down)),
            "CTU" => (true, false),
            "RES" => (false, false),
            _ => (true, true),
        };
        let bounds = self.found.entry(name).or_default();
        bounds.rises |= rises;
        bounds.falls |= falls;
        if info.facts.kept.is_some() {
            self.open.insert(name);
        }
        if !called.takes_rung {
            let presets = info.inputs().zip(inputs).filter(|it| it.0.role == Some(PinRole::Preset));
            presets.for_each(|it| self.preset(name, it.1));
        }
    }

    fn preset(&mut self, name: Name, value: &Expr) {
        let (least, greatest) = self.range(value);
        let bounds = self.found.entry(name).or_default();
        bounds.add(least);
        bounds.add(greatest);
    }

    fn range(&self, value: &Expr) -> (i128, i128) {
        let whole =
            |ty: Type| self.program.repr(ty).and_then(staunch_runtime::Repr::range).unwrap_or((i128::MIN, i128::MAX));
        match &value.kind {
            ExprKind::Const(it) => it.as_integer().map_or_else(|| whole(value.ty), |it| (it, it)),
            ExprKind::Load(place) => self.program.range(place.ty).unwrap_or_else(|| whole(place.ty)),
            ExprKind::Convert(Conversion::Same | Conversion::Value, inner) => {
                let (inner, all) = (self.range(inner), whole(value.ty));
                if all.0 <= inner.0 && inner.1 <= all.1 { inner } else { all }
            }
            ExprKind::Convert(..)
            | ExprKind::Text(_)
            | ExprKind::Aggregate(_)
            | ExprKind::AddressOf(_)
            | ExprKind::Apply(..)
            | ExprKind::ApplyText(..) => whole(value.ty),
        }
    }

    /// A comparison of a count with a constant.
    fn comparison(&mut self, at: At<'_>, expr: &Expr) {
        let ExprKind::Apply(Op::Lt | Op::Le | Op::Gt | Op::Ge | Op::Eq | Op::Ne, operands) = &expr.kind else { return };
        let [a, b] = operands.as_slice() else { return };
        for (own, other) in [(a, b), (b, a)] {
            let number = other.as_const().and_then(Value::as_integer);
            if let (Some(name), Some(number)) = (self.count(at, own), number) {
                self.compared(name, [number; 2]);
                *self.reads.entry(name).or_default() -= 1;
            }
        }
    }

    fn compared(&mut self, name: Name, numbers: [i128; 2]) {
        let bounds = self.found.entry(name).or_default();
        numbers.into_iter().for_each(|it| bounds.add(it));
    }

    /// The counter whose count an expression is, in its own type or a wider one.
    fn count(&self, at: At<'_>, expr: &Expr) -> Option<Name> {
        match &expr.kind {
            // A count that turns round at its limit is not past all from there on.
            ExprKind::Load(place) => match self.pin(at, place)? {
                (name, block, Some(PinRole::Count)) if !turns(block.info()) => Some(name),
                _ => None,
            },
            ExprKind::Convert(Conversion::Same | Conversion::Value, inner) => {
                let range = |ty| self.program.repr(ty).and_then(staunch_runtime::Repr::range);
                let (from, to) = (range(inner.ty)?, range(expr.ty)?);
                if to.0 <= from.0 && from.1 <= to.1 { self.count(at, inner) } else { None }
            }
            ExprKind::Convert(..)
            | ExprKind::Const(_)
            | ExprKind::Text(_)
            | ExprKind::Aggregate(_)
            | ExprKind::AddressOf(_)
            | ExprKind::Apply(..)
            | ExprKind::ApplyText(..) => None,
        }
    }
}

/// Whether a count turns round at the limit of its type.
fn turns(info: &BlockInfo) -> bool {
    info.family == Family::Logix
}

fn role(block: BlockId, pin: FieldId) -> Option<PinRole> {
    block.info().pins.get(pin.index())?.role
}
