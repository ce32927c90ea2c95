//! Which counts matter only by comparisons with constants and with values whose range is known, and within which limits: a CTU above all of them and above
//! every preset stays above them until it is reset, and a CTD below them stays below until it is loaded.
//!
//! What is not understood leaves a counter out. A counter is known by its declaration. Where a way leads to one through a
//! parameter or a reference, or a copy holds one, the declaration is not known: then no counter of that type has bounds.

use super::dependency::Declared;
use super::flow::{Range, Ranges};
use super::walked::{Name, Walked};
use staunch_ir::visit::{self, Access};
use staunch_ir::{
    BlockId, Conversion, Expr, ExprKind, FieldId, Op, Place, Program, Projection, Root, Routine, RoutineId, Statement,
    StatementKind, Type, reference,
};
use staunch_runtime::{BlockInfo, Family, PinRole};
use std::collections::{HashMap, HashSet};

/// All that a count is compared with, and 0, lies from `least` to `greatest`; but for resets and loads it goes one way.
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

/// By the declarations of the counters that have bounds. `starts` are the values of variables at the start; of what is assigned to
/// `idle` variables nothing depends that is asked for.
pub fn of(program: &Program, starts: &HashMap<Name, Range>, idle: &HashSet<Declared>) -> HashMap<Name, Bounds> {
    let ranges = Ranges::of(program, starts);
    let (open, open_types) = (HashSet::new(), HashSet::new());
    let mut walk = Walk { program, ranges, idle, found: HashMap::new(), open, open_types };
    for (at, routine) in program.routines.iter().enumerate() {
        visit::statements(&routine.body, &mut |it| walk.statement((routine, RoutineId::next(at)), it));
    }
    for (owner, field) in reference::reached(program) {
        walk.open_in(program.structure(owner).fields[field.index()].ty);
    }
    let Walk { mut found, open, open_types, .. } = walk;
    found.retain(|name, (block, it)| !open.contains(name) && !open_types.contains(block) && it.rises != it.falls);
    found.into_iter().map(|(name, (_, it))| (name, it)).collect()
}

struct Walk<'p> {
    program: &'p Program,
    ranges: Ranges<'p>,
    idle: &'p HashSet<Declared>,
    found: HashMap<Name, (BlockId, Bounds)>,
    /// Counters that are used in a way that is not understood.
    open: HashSet<Name>,
    /// Types of counters that are used so, it is not known which.
    open_types: HashSet<BlockId>,
}

/// A counter, or a pin of one.
#[derive(Clone, Copy, Debug)]
struct Counter {
    block: BlockId,
    pin: Option<FieldId>,
    /// Its declaration, where it is known.
    name: Option<Name>,
}

impl Counter {
    fn role(self) -> Option<PinRole> {
        self.block.info().pins.get(self.pin?.index())?.role
    }
}

impl Walk<'_> {
    fn statement(&mut self, at: (&Routine, RoutineId), statement: &Statement) {
        let routine = at.0;
        if matches!(&statement.kind, StatementKind::Assign { target, .. } if self.is_idle(at, target)) {
            return;
        }
        let mut understood = Vec::new();
        visit::all_exprs(statement, &mut |it| {
            understood.extend(self.comparison(at, it));
            if let ExprKind::AddressOf(place) = &it.kind {
                self.access(routine, place, Access::Borrow);
            }
        });
        match &statement.kind {
            StatementKind::Case { selector, arms, .. } => {
                if let Some((name, place)) = self.count(routine, selector) {
                    let labels = arms.iter().flat_map(|it| &it.labels).flat_map(|it| [it.0, it.1]);
                    labels.for_each(|it| self.compared(name, it));
                    understood.push(place);
                }
            }
            StatementKind::Assign { target, value } => understood.extend(self.assigned(at, target, value)),
            StatementKind::CallBlock { block, instruction, inputs } => {
                self.call(at, block, *instruction, inputs);
                understood.push(block);
            }
            // The routine's own statements are walked for themselves.
            StatementKind::Call { instance, .. } => understood.extend(instance),
            StatementKind::If { .. }
            | StatementKind::For(_)
            | StatementKind::Loop { .. }
            | StatementKind::External(_)
            | StatementKind::PrescanBlock { .. }
            | StatementKind::Try { .. }
            | StatementKind::Finally { .. }
            | StatementKind::Turn
            | StatementKind::Exit
            | StatementKind::Continue
            | StatementKind::Return
            | StatementKind::Stop(_)
            | StatementKind::Fault(_) => {}
        }
        visit::accesses(statement, &mut |place, access| {
            if !understood.iter().any(|it| std::ptr::eq(*it, place)) {
                self.access(routine, place, access);
            }
        });
    }

    fn is_idle(&self, at: (&Routine, RoutineId), place: &Place) -> bool {
        match Walked::of(self.program, at, place).variable() {
            Some(Name::Field(owner, field)) => self.idle.contains(&(owner, field)),
            Some(Name::Local(..) | Name::Param(..)) | None => false,
        }
    }

    /// What is not one of the uses that are understood.
    fn access(&mut self, routine: &Routine, place: &Place, access: Access) {
        let Some(counter) = self.counter(routine, place) else { return self.open_in(place.ty) };
        let is_harmless = match counter.role() {
            Some(PinRole::Count) => false,
            Some(PinRole::Preset) => access == Access::Read,
            Some(_) | None => counter.pin.is_some(),
        };
        match counter.name {
            Some(_) if is_harmless => {}
            Some(name) => _ = self.open.insert(name),
            None => _ = self.open_types.insert(counter.block),
        }
    }

    /// The counter that a place is or is a pin of.
    fn counter(&self, routine: &Routine, place: &Place) -> Option<Counter> {
        let is_declared = matches!(place.root, Root::Instance | Root::Globals)
            && !place.projections.iter().any(|it| matches!(it, Projection::Deref { .. }));
        let (mut ty, mut name) = (self.program.root_type(routine, place.root)?, None);
        for projection in &place.projections {
            match (projection, ty) {
                (Projection::Field(field), Type::Struct(owner)) => name = Some(Name::Field(owner, *field)),
                (Projection::Field(pin), Type::Block(block)) => {
                    let counter = Counter { block, pin: Some(*pin), name: name.filter(|_| is_declared) };
                    return counts(block).then_some(counter);
                }
                (Projection::Field(_) | Projection::Index { .. } | Projection::Deref { .. }, _) => {}
            }
            ty = self.program.part(ty, projection)?;
        }
        match ty {
            Type::Block(block) if counts(block) => {
                Some(Counter { block, pin: None, name: name.filter(|_| is_declared) })
            }
            _ => None,
        }
    }

    /// What may be read and written through a place of this type.
    fn open_in(&mut self, ty: Type) {
        match ty {
            Type::Block(block) => _ = self.open_types.insert(block),
            Type::Array(id) => self.open_in(self.program.array(id).element),
            Type::Struct(id) => self.program.structure(id).fields.iter().for_each(|it| self.open_in(it.ty)),
            Type::Elementary(_) | Type::Reference(_) | Type::Subrange(..) | Type::String(_) | Type::Enum(_) => {}
        }
    }

    fn call(&mut self, at: (&Routine, RoutineId), block: &Place, instruction: usize, inputs: &[Expr]) {
        let Some(Counter { block, name, .. }) = self.counter(at.0, block) else { return };
        let info = block.info();
        // A count that turns round at its limit is not past all from there on, and a kept one is a variable as well.
        let is_followed = info.instructions.len() == 1 && info.facts.kept.is_none() && !turns(info);
        let Some(name) = name.filter(|_| is_followed && instruction == 0) else {
            self.open_types.insert(block);
            return;
        };
        let bounds = self.bounds(name, block);
        bounds.rises = info.pin_for(PinRole::Up).is_some();
        bounds.falls = info.pin_for(PinRole::Down).is_some();
        let presets = info.inputs().zip(inputs).filter(|it| it.0.role == Some(PinRole::Preset));
        presets.for_each(|it| self.preset(at, (name, block), it.1));
    }

    fn bounds(&mut self, name: Name, block: BlockId) -> &mut Bounds {
        &mut self.found.entry(name).or_insert((block, Bounds::default())).1
    }

    fn compared(&mut self, (name, block): (Name, BlockId), number: i128) {
        self.bounds(name, block).add(number);
    }

    /// A preset that is assigned.
    fn assigned<'s>(&mut self, at: (&Routine, RoutineId), target: &'s Place, value: &Expr) -> Option<&'s Place> {
        let counter = self.counter(at.0, target)?;
        let name = counter.name.filter(|_| counter.role() == Some(PinRole::Preset))?;
        self.preset(at, (name, counter.block), value);
        Some(target)
    }

    fn preset(&mut self, at: (&Routine, RoutineId), (name, block): (Name, BlockId), value: &Expr) {
        if let ExprKind::Load(place) = &value.kind
            && let Some(own) = self.counter(at.0, place)
            && own.name == Some(name)
            && own.role() == Some(PinRole::Preset)
        {
            // It stays as it is.
            return;
        }
        let (least, greatest) = self.ranges.of_value(at, value);
        let bounds = self.bounds(name, block);
        bounds.add(least);
        bounds.add(greatest);
    }

    /// A comparison of a count with a constant, or with what has a range, and where it reads the count.
    fn comparison<'e>(&mut self, at: (&Routine, RoutineId), expr: &'e Expr) -> Option<&'e Place> {
        let ExprKind::Apply(Op::Lt | Op::Le | Op::Gt | Op::Ge | Op::Eq | Op::Ne, operands) = &expr.kind else {
            return None;
        };
        let [a, b] = operands.as_slice() else { return None };
        [(a, b), (b, a)].into_iter().find_map(|(own, other)| {
            let (name, place) = self.count(at.0, own)?;
            let (least, greatest) = self.ranges.of_value(at, other);
            self.compared(name, least);
            self.compared(name, greatest);
            Some(place)
        })
    }

    /// The counter whose count an expression is, in its own type or one that holds all of its values.
    fn count<'e>(&self, routine: &Routine, expr: &'e Expr) -> Option<((Name, BlockId), &'e Place)> {
        match &expr.kind {
            ExprKind::Load(place) => {
                let counter = self.counter(routine, place)?;
                let name = counter.name.filter(|_| counter.role() == Some(PinRole::Count))?;
                Some(((name, counter.block), place))
            }
            ExprKind::Convert(Conversion::Same | Conversion::Value, inner) => {
                let (from, to) = (self.ranges.whole(inner.ty)?, self.ranges.whole(expr.ty)?);
                if to.0 <= from.0 && from.1 <= to.1 { self.count(routine, inner) } else { None }
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

fn counts(block: BlockId) -> bool {
    block.info().pin_for(PinRole::Count).is_some()
}

/// Whether a count turns round at the limit of its type.
fn turns(info: &BlockInfo) -> bool {
    info.family == Family::Logix
}
