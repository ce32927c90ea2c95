//! The statements of a routine in their plain form, with what is known of variables at each.

use super::exact::{Here, Values, is_small};
use super::known::{Known, may_share};
use super::names::{Names, Written};
use crate::program::walked::Walked;
use staunch_ir::faults::{Faults, code_faults};
use staunch_ir::interval::{Interval, result};
use staunch_ir::visit::{self, Access};
use staunch_ir::{
    Argument, Arm, ArrayId, Block, Const, Expr, ExprKind, For, LocalId, Mode, Op, Place, Program, Root, Routine,
    RoutineId, Statement, StatementKind, Step, Type,
};
use std::rc::Rc;

/// A routine in its plain form.
pub struct Plain {
    pub body: Block,
    /// A statement of it may end the scan.
    pub faults: bool,
    /// A loop of it may come to the limit of its counter's type.
    pub reaches_limit: bool,
    /// A sum, difference or product of it may pass the range of a signed type of 32 or 64 bits.
    pub overflows: bool,
}

pub fn routine(names: &Names<'_>, id: RoutineId, written: &mut Written) -> Plain {
    let routine = names.program.routine(id);
    let mut known = Known::new(names, id);
    let is_given = |it: LocalId| routine.params.iter().any(|param| param.mode == Mode::Value(it));
    for (at, local) in routine.locals.iter().enumerate() {
        let local_id = LocalId::next(at);
        let number = match local.initial {
            Const::Scalar(value) => value.as_integer(),
            Const::Zero => names.whole(local.ty).map(|_| 0),
            Const::Text(_) | Const::Array(_) | Const::Struct(_) => None,
        };
        // Members of the same structure elsewhere have one name with these, and start with other values.
        if matches!(local.ty, Type::Struct(_) | Type::Array(_)) {
            written.opens(names.program, &[], local.ty);
        }
        if !is_given(local_id) {
            known.give(&Place::local(local_id, local.ty), number.map(Interval::only));
        }
    }
    let way = Way { known, values: Values::new() };
    let mut walk =
        Walk { program: names.program, routine, id, written, faults: false, reaches_limit: false, overflows: false };
    let (body, _) = walk.block(&routine.body, Some(way));
    Plain { body, faults: walk.faults, reaches_limit: walk.reaches_limit, overflows: walk.overflows }
}

/// What is known on the way to a statement.
#[derive(Clone)]
struct Way<'n, 'p> {
    known: Known<'n, 'p>,
    values: Values,
}

impl<'n, 'p> Way<'n, 'p> {
    fn here(&self) -> Here<'_, 'n, 'p> {
        Here { known: &self.known, values: &self.values }
    }

    fn with(&self, known: Known<'n, 'p>) -> Self {
        Self { known, values: self.values.clone() }
    }

    /// A place may have been written.
    fn forget(&mut self, place: &Place) {
        self.known.forget(place);
        self.forget_values(place);
    }

    fn forget_values(&mut self, place: &Place) {
        if place.is_followed() || matches!(place.root, Root::Param(_)) {
            self.values.clear();
        }
        let depends = |it: &Expr| {
            let mut found = false;
            visit::reads(it, &mut |read| {
                found |= read.is_followed() || matches!(read.root, Root::Param(_)) || may_share(read, place);
            });
            found
        };
        self.values.retain(|local, value| place.root != Root::Local(*local) && !depends(value));
    }

    /// What a block of statements may write.
    fn forget_written(&mut self, block: &[Statement]) {
        visit::statements(block, &mut |statement| {
            if runs_others(statement) {
                self.forget_all();
            }
            visit::accesses(statement, &mut |place, access| match access {
                Access::Read => {}
                Access::Write | Access::Borrow => self.forget(place),
            });
        });
    }

    fn forget_all(&mut self) {
        self.known.forget_all();
        self.values.clear();
    }

    /// Where two ways meet.
    fn or(self, other: Self) -> Self {
        let mut values = self.values;
        values.retain(|local, value| other.values.get(local).is_some_and(|it| Rc::ptr_eq(it, value)));
        Self { known: self.known.or(&other.known), values }
    }
}

fn either<'n, 'p>(a: Option<Way<'n, 'p>>, b: Option<Way<'n, 'p>>) -> Option<Way<'n, 'p>> {
    match (a, b) {
        (Some(a), Some(b)) => Some(a.or(b)),
        (a, b) => a.or(b),
    }
}

/// Whether a result may pass the range of a signed type of 32 or 64 bits; also the quotient of the least number and -1, which C
/// leaves undefined for the remainder, too.
fn may_overflow(known: &Known<'_, '_>, value: &Expr) -> bool {
    let ExprKind::Apply(op, operands) = &value.kind else { return false };
    let Some(whole) = known.whole(value.ty) else { return false };
    let exact = |op: Op| known.all(operands).and_then(|it| result(op, &it));
    let passes = || match (op, operands.as_slice()) {
        (Op::Add | Op::Sub | Op::Mul | Op::Neg | Op::Abs, _) => !exact(*op).is_some_and(|it| it.lies_in(whole)),
        (Op::Div | Op::Mod | Op::DivOrZero | Op::ModOrZero, [a, b]) => {
            let reaches = |it: &Expr, number: i128| known.of(it).is_none_or(|it| it.and((number, number)).is_some());
            reaches(a, whole.0) && reaches(b, -1)
        }
        _ => false,
    };
    // More than 16 bits, and a sign.
    whole.0 < i128::from(i16::MIN) && passes()
}

/// Whether it runs statements that are not in it.
fn runs_others(statement: &Statement) -> bool {
    matches!(statement.kind, StatementKind::Call { .. } | StatementKind::External(_))
}

struct Walk<'w, 'p> {
    program: &'p Program,
    routine: &'p Routine,
    id: RoutineId,
    written: &'w mut Written,
    faults: bool,
    reaches_limit: bool,
    overflows: bool,
}

type Ways<'n, 'p> = Option<Way<'n, 'p>>;

impl<'p> Walk<'_, 'p> {
    /// A block, and what is known after it; nothing where that is never reached.
    fn block<'n>(&mut self, block: &[Statement], mut way: Ways<'n, 'p>) -> (Block, Ways<'n, 'p>) {
        let mut plain = Block::new();
        for statement in block {
            // What is never reached is left out.
            let Some(here) = way else { break };
            way = self.statement(statement, here, &mut plain);
        }
        (plain, way)
    }

    fn statement<'n>(&mut self, statement: &Statement, mut way: Way<'n, 'p>, plain: &mut Block) -> Ways<'n, 'p> {
        self.note_faults(statement, &way);
        self.note_written(statement, &way);
        let kind = match &statement.kind {
            StatementKind::Assign { target, value } => self.assign(&mut way, target, value),
            StatementKind::If { condition, then, otherwise } => {
                return self.branches(statement, (condition, then, otherwise), way, plain);
            }
            StatementKind::Case { selector, arms, otherwise } => {
                return self.arms(statement, (selector, arms, otherwise), &way, plain);
            }
            StatementKind::For(it) => self.loop_for(statement, &mut way, it),
            StatementKind::Loop { body, continuing, count } => {
                let count = count.clone();
                // It may be a FOR with a computed step.
                self.reaches_limit = true;
                way.forget_written(body);
                way.forget_written(continuing);
                let (body, _) = self.block(body, Some(way.clone()));
                let (continuing, _) = self.block(continuing, Some(way.clone()));
                StatementKind::Loop { body, continuing, count }
            }
            StatementKind::Try { body, kind, handler } => {
                let (within, _) = self.block(body, Some(way.clone()));
                way.forget_written(body);
                way.forget(kind);
                let (handled, _) = self.block(handler, Some(way.clone()));
                way.forget_written(handler);
                StatementKind::Try { body: within, kind: kind.clone(), handler: handled }
            }
            StatementKind::Finally { body, last } => {
                let (within, _) = self.block(body, Some(way.clone()));
                way.forget_written(body);
                let (after, _) = self.block(last, Some(way.clone()));
                way.forget_written(last);
                StatementKind::Finally { body: within, last: after }
            }
            StatementKind::Call { callee, instance, arguments, result } => {
                let here = way.here();
                let argument = |it: &Argument| match it {
                    Argument::Value(value) => Argument::Value(here.plain(value)),
                    Argument::Reference(place) => Argument::Reference(here.place(place)),
                };
                let kind = StatementKind::Call {
                    callee: *callee,
                    instance: instance.as_ref().map(|it| here.place(it)),
                    arguments: arguments.iter().map(argument).collect(),
                    result: result.as_ref().map(|it| here.place(it)),
                };
                way.forget_all();
                kind
            }
            StatementKind::CallBlock { block, instruction, inputs } => {
                let here = way.here();
                let inputs = inputs.iter().map(|it| here.plain(it)).collect();
                let kind = StatementKind::CallBlock { block: here.place(block), instruction: *instruction, inputs };
                way.forget(block);
                kind
            }
            StatementKind::PrescanBlock { block, .. } => {
                way.forget(block);
                statement.kind.clone()
            }
            StatementKind::External(_) => {
                way.forget_all();
                statement.kind.clone()
            }
            StatementKind::Turn | StatementKind::Stop(_) => statement.kind.clone(),
            StatementKind::Exit | StatementKind::Continue | StatementKind::Return | StatementKind::Fault(_) => {
                plain.push(statement.clone());
                return None;
            }
        };
        plain.push(Statement::new(kind, statement.at));
        Some(way)
    }

    fn assign(&mut self, way: &mut Way<'_, 'p>, target: &Place, value: &Expr) -> StatementKind {
        let here = way.here();
        let (place, plain, number) = (here.place(target), here.plain(value), way.known.of(value));
        way.forget_values(target);
        way.known.give(target, number.filter(|it| way.known.whole(target.ty).is_some_and(|whole| it.lies_in(whole))));
        if let (Root::Local(local), []) = (target.root, target.projections.as_slice()) {
            let reads_itself = {
                let mut found = false;
                visit::reads(&plain, &mut |it| found |= it.root == target.root);
                found
            };
            if !reads_itself && is_small(&plain) {
                way.values.insert(local, Rc::new(plain.clone()));
            }
        }
        StatementKind::Assign { target: place, value: plain }
    }

    fn branches<'n>(
        &mut self,
        statement: &Statement,
        (condition, then, otherwise): (&Expr, &Block, &Block),
        way: Way<'n, 'p>,
        plain: &mut Block,
    ) -> Ways<'n, 'p> {
        let [met, not] = [true, false].map(|holds| way.known.when(condition, holds).map(|it| way.with(it)));
        let (block, found) = match (met, not) {
            (Some(met), None) => self.block(then, Some(met)),
            (None, not) => self.block(otherwise, not),
            (Some(met), Some(not)) => {
                let condition = way.here().plain(condition);
                let (then, after_then) = self.block(then, Some(met));
                let (otherwise, after_otherwise) = self.block(otherwise, Some(not));
                let kind = StatementKind::If { condition, then, otherwise };
                (vec![Statement::new(kind, statement.at)], either(after_then, after_otherwise))
            }
        };
        plain.extend(block);
        found
    }

    fn arms<'n>(
        &mut self,
        statement: &Statement,
        (selector, arms, otherwise): (&Expr, &[Arm], &Block),
        way: &Way<'n, 'p>,
        plain: &mut Block,
    ) -> Ways<'n, 'p> {
        let mut found = None;
        let mut kept = Vec::new();
        for arm in arms {
            let Some(known) = way.known.selected(selector, &arm.labels) else { continue };
            let (body, after) = self.block(&arm.body, Some(way.with(known)));
            found = either(found, after);
            kept.push(Arm { labels: arm.labels.clone(), body });
        }
        let (otherwise, after) = self.block(otherwise, Some(way.clone()));
        let kind = StatementKind::Case { selector: way.here().plain(selector), arms: kept, otherwise };
        plain.push(Statement::new(kind, statement.at));
        either(found, after)
    }

    fn loop_for(&mut self, statement: &Statement, way: &mut Way<'_, 'p>, it: &For) -> StatementKind {
        let (first, counter) = (way.here().plain(&it.first), way.here().place(&it.counter));
        let start = way.known.of(&it.first);
        // The last value and the step are found once the counter has its first value.
        way.forget_values(&it.counter);
        way.known.give(&it.counter, start);
        self.note_faults(statement, way);
        let here = way.here();
        let step = match &it.step {
            Step::Constant(step) => Step::Constant(*step),
            Step::Variable(step) => Step::Variable(here.plain(step)),
        };
        let last = here.plain(&it.last);
        let end = way.known.of(&it.last);
        let steps = match &it.step {
            Step::Constant(step) => Some((*step, *step)),
            Step::Variable(step) => way.known.of(step).map(|it| it.range),
        };
        let reaches = end.zip(steps).map(|(end, steps)| {
            let up = steps.1 > 0 && end.range.1 + steps.1 > it.range.1;
            up || steps.0 < 0 && end.range.0 + steps.0 < it.range.0
        });
        self.reaches_limit |= !it.is_private || reaches.unwrap_or(true);
        let turns = start.zip(end).and_then(|(start, end)| match it.step {
            Step::Constant(step) if step > 0 => Interval::new(it.range).and((start.range.0, end.range.1)),
            Step::Constant(_) => Interval::new(it.range).and((end.range.0, start.range.1)),
            Step::Variable(_) => None,
        });
        way.forget_written(&it.body);
        way.forget(&it.counter);
        let mut within = way.clone();
        within.known.give(&it.counter, turns.filter(|_| it.is_private));
        let (body, _) = self.block(&it.body, Some(within));
        StatementKind::For(Box::new(For { counter, first, last, step, body, ..it.clone() }))
    }

    /// Whether it may end the scan, by itself.
    fn note_faults(&mut self, statement: &Statement, way: &Way<'_, 'p>) {
        let known = &way.known;
        visit::all_exprs(statement, &mut |it| self.overflows |= may_overflow(known, it));
        let is_within = |index: &Expr, array: Option<ArrayId>| {
            let array = array.map(|it| self.program.array(it));
            array.zip(known.of(index)).is_some_and(|(array, it)| it.lies_in((array.low.into(), array.high.into())))
        };
        let operation = |program: &Program, op: Op, operands: &[Expr]| match (op, operands) {
            (Op::Div | Op::Mod, [_, by]) => {
                !known.of(by).is_some_and(|it| it.is_not_zero) && code_faults(program, op, operands)
            }
            (Op::CheckIndex | Op::InRange, [low, it, high]) => {
                let limits = known.of(low).zip(known.of(high)).map(|(low, high)| (low.range.1, high.range.0));
                !limits.zip(known.of(it)).is_some_and(|(limits, it)| it.lies_in(limits))
            }
            _ => code_faults(program, op, operands),
        };
        let root_type = |root: Root| self.program.root_type(self.routine, root);
        let faults =
            Faults { program: self.program, root_type: &root_type, is_within: &is_within, operation: &operation };
        let mut found = match &statement.kind {
            StatementKind::Turn
            | StatementKind::Loop { .. }
            | StatementKind::External(_)
            | StatementKind::Fault(_)
            | StatementKind::Try { .. } => true,
            StatementKind::For(it) => it.step_may_fault(known.whole(it.counter.ty)) || it.takes_turns(),
            StatementKind::Assign { .. }
            | StatementKind::If { .. }
            | StatementKind::Case { .. }
            | StatementKind::Finally { .. }
            | StatementKind::Exit
            | StatementKind::Continue
            | StatementKind::Return
            | StatementKind::Call { .. }
            | StatementKind::CallBlock { .. }
            | StatementKind::PrescanBlock { .. }
            | StatementKind::Stop(_) => false,
        };
        visit::values(statement, &mut |it| found |= faults.expr(it));
        visit::accesses(statement, &mut |place, access| found |= access != Access::Read && faults.place(place));
        self.faults |= found;
    }

    /// What variables it gives which numbers.
    fn note_written(&mut self, statement: &Statement, way: &Way<'_, 'p>) {
        let assigned = match &statement.kind {
            StatementKind::Assign { target, value } => Some((target, value)),
            _ => None,
        };
        // The routine's own statements are walked for themselves.
        let called = match &statement.kind {
            StatementKind::Call { instance, .. } => instance.as_ref(),
            _ => None,
        };
        visit::accesses(statement, &mut |place, access| {
            if access == Access::Read || called.is_some_and(|it| std::ptr::eq(it, place)) {
                return;
            }
            let walked = Walked::of(self.program, (self.routine, self.id), place);
            let value = assigned.filter(|it| std::ptr::eq(it.0, place)).and_then(|it| way.known.of(it.1));
            match (value, walked.variable()) {
                (Some(value), Some(name)) => self.written.gives(name, value.range),
                _ => self.written.opens(self.program, &walked.names, place.ty),
            }
        });
    }
}
