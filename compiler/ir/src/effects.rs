//! What each routine does, itself or through what it calls: which variables it reads and writes, whether
//! it takes turns or runs blocks that want the context, and whether it may fault. Found in one walk,
//! since a callee is before its callers.
//!
//! A back end says by its [`Rules`] what its code for operations and blocks needs; what follows from
//! that for routines is here alone.

mod variables;

use crate::faults::{Faults, op_faults};
use crate::loops::{Known, checked_locals, constant_position};
use crate::visit::{self, Access};
use crate::{
    Argument, ArrayId, Class, ClassKind, Expr, ExprKind, FieldId, For, LocalId, Location, Op, ParamId, Place, Program,
    Projection, Root, Routine, RoutineId, RoutineKind, Statement, StatementKind, StructId, Type, reference,
};
use std::collections::BTreeSet;

pub use variables::Variables;

/// What the code of a back end needs.
#[derive(Clone, Copy, Debug)]
pub struct Rules {
    /// Whether the code for an instruction of a standard block takes the context.
    pub block_takes_context: fn(&Place, usize) -> bool,
    /// Whether the code for an operation on these operands has a way to a fault.
    pub operation_faults: fn(&Program, Op, &[Expr]) -> bool,
    /// Whether an index has no check where it is known to lie within its bounds.
    pub drops_checks: bool,
    /// Whether the body of a PROGRAM or FUNCTION_BLOCK takes the context and returns a fault
    /// whatever it does, and a PROGRAM's runs its prescan.
    pub scans_take_all: bool,
}

#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Effects {
    pub faults: bool,
    pub context: bool,
    /// Whether its loops take turns of the scan's.
    pub turns: bool,
    /// What it reads or writes, and what it hands on even if the callee does neither.
    pub names: Variables,
    pub reads: Variables,
    pub writes: Variables,
    /// The routines that it calls itself, each once, in order.
    pub calls: Vec<RoutineId>,
    /// For each local, whether a call gets a reference to it.
    pub borrowed: Vec<bool>,
    /// For each local, whether its values are always within its subrange.
    pub checked: Vec<bool>,
    /// Whether it makes references or follows them, and so needs to find all of the state.
    pub reaches: bool,
    /// Whether it has faults that are at the place of its call.
    pub faults_at_call: bool,
    /// Whether it follows references, and may read and write what they lead to.
    follows: bool,
}

impl Effects {
    /// Whether its code needs to find the globals.
    pub fn uses_globals(&self) -> bool {
        self.names.any_global() || self.reaches
    }
}

/// For each routine of a verified program.
pub fn effects(program: &Program, rules: &Rules) -> Vec<Effects> {
    let mut known: Vec<Effects> = Vec::with_capacity(program.routines.len());
    let reached = reference::reached(program);
    for routine in &program.routines {
        let (borrowed, checked) = (vec![false; routine.locals.len()], checked_locals(routine));
        let effects = Effects { borrowed, checked, ..Effects::default() };
        let mut finder =
            Finder { program, rules, known: &known, reached: &reached, routine, loops: Vec::new(), effects };
        finder.block(&routine.body);
        let mut effects = finder.effects;
        effects.calls.sort_unstable();
        effects.calls.dedup();
        known.push(effects);
    }
    if rules.scans_take_all {
        program.classes.iter().for_each(|class| scan_takes_all(class, &mut known));
    }
    known
}

/// Whether a statement may fault, where it is known what the routines do that it calls. Around it are these loops with private counters; of each local it is
/// known whether its values are checked.
pub fn statement_faults<'a>(
    program: &'a Program,
    rules: &'a Rules,
    known: &'a [Effects],
    routine: &'a Routine,
    (around, checked): (Vec<&'a For>, Vec<bool>),
    statement: &'a Statement,
) -> bool {
    let effects = Effects { borrowed: vec![false; routine.locals.len()], checked, ..Effects::default() };
    let reached = BTreeSet::new();
    let mut finder = Finder { program, rules, known, reached: &reached, routine, loops: around, effects };
    finder.statement(statement);
    finder.effects.faults
}

/// No routine calls a PROGRAM's body, so that its prescan adds to nothing else.
fn scan_takes_all(class: &Class, known: &mut [Effects]) {
    let prescan = class.prescan.filter(|_| class.kind == ClassKind::Program);
    let Some(prescan) = prescan.map(|it| known[it.index()].clone()) else { return };
    let body = &mut known[class.body.index()];
    body.context = true;
    body.names.add_globals(&prescan.names);
}

struct Finder<'a> {
    program: &'a Program,
    rules: &'a Rules,
    known: &'a [Effects],
    /// What references may lead into.
    reached: &'a BTreeSet<(StructId, FieldId)>,
    routine: &'a Routine,
    /// The loops around, with private counters.
    loops: Vec<&'a For>,
    effects: Effects,
}

impl<'a> Finder<'a> {
    fn block(&mut self, block: &'a [Statement]) {
        block.iter().for_each(|it| self.statement(it));
    }

    fn takes_turns(&mut self) {
        self.effects.faults = true;
        self.effects.context = true;
        self.effects.turns = true;
    }

    fn statement(&mut self, statement: &'a Statement) {
        visit::values(statement, &mut |it| {
            self.effects.faults |= self.asked(&|faults| faults.expr(it));
            self.expr(it);
        });
        visit::accesses(statement, &mut |place, access| self.touches(place, access));
        visit::targets(statement, &mut |it| {
            self.effects.faults |= self.asked(&|faults| faults.place(it));
            self.place(it);
        });
        match &statement.kind {
            StatementKind::Call { callee, instance, arguments, .. } => {
                self.callee(*callee);
                self.handed_over(*callee, instance.as_ref(), arguments);
            }
            StatementKind::CallBlock { block, instruction, .. } => {
                self.reads_and_writes(block);
                self.effects.context |= (self.rules.block_takes_context)(block, *instruction);
            }
            StatementKind::External(it) => {
                it.arguments.iter().filter_map(Argument::place).for_each(|place| self.reads_and_writes(place));
                it.instance.iter().for_each(|place| self.reads_and_writes(place));
                self.effects.context |= it.instance.is_some();
            }
            StatementKind::Turn => self.takes_turns(),
            // Not every fault of its body is caught.
            StatementKind::Fault(_) | StatementKind::Try { .. } => {
                self.effects.faults = true;
                self.effects.faults_at_call |= statement.at == Location::CALLER;
            }
            StatementKind::For(it) => {
                let repr = self.program.repr(it.counter.ty);
                self.effects.faults |= it.step_may_fault(repr.and_then(|repr| repr.range()));
                if it.taking.is_ahead() {
                    self.takes_turns();
                }
            }
            StatementKind::Loop { count: Some(it), .. } if it.taking.is_ahead() => self.takes_turns(),
            StatementKind::Assign { .. }
            | StatementKind::If { .. }
            | StatementKind::Case { .. }
            | StatementKind::Loop { .. }
            | StatementKind::Finally { .. }
            | StatementKind::Exit
            | StatementKind::Continue
            | StatementKind::Stop(_)
            | StatementKind::Return => {}
            StatementKind::PrescanBlock { block, .. } => self.reads_and_writes(block),
        }
        let counted = match &statement.kind {
            StatementKind::For(it) if it.is_private => Some(&**it),
            _ => None,
        };
        self.loops.extend(counted);
        statement.kind.blocks().into_iter().for_each(|it| self.block(it));
        self.loops.truncate(self.loops.len() - usize::from(counted.is_some()));
    }

    fn callee(&mut self, callee: RoutineId) {
        let known = &self.known[callee.index()];
        let takes_all = self.rules.scans_take_all && self.program.routine(callee).kind == RoutineKind::Body;
        self.effects.faults |= known.faults || takes_all;
        self.effects.context |= known.context || takes_all;
        self.effects.turns |= known.turns;
        self.effects.names.add_globals(&known.names);
        self.effects.reads.add_globals(&known.reads);
        self.effects.writes.add_globals(&known.writes);
        self.effects.calls.push(callee);
        self.effects.reaches |= known.reaches;
        if known.follows {
            self.reaches_any();
        }
    }

    /// What a callee does to its instance and through its parameters is done to what it is handed.
    fn handed_over(&mut self, callee: RoutineId, instance: Option<&Place>, arguments: &[Argument]) {
        let known = &self.known[callee.index()];
        if let Some(place) = instance {
            self.passed(place, known.reads.any_own(), known.writes.any_own());
        }
        for (at, argument) in arguments.iter().enumerate() {
            let id = ParamId::next(at);
            match argument {
                Argument::Reference(place) => self.passed(place, known.reads.has_param(id), known.writes.has_param(id)),
                Argument::Value(_) => {}
            }
        }
    }

    /// Whatever references lead to may be read and written.
    fn reaches_any(&mut self) {
        self.effects.reaches = true;
        if std::mem::replace(&mut self.effects.follows, true) {
            return;
        }
        let roots = [(Root::Globals, Some(self.program.globals)), (Root::Instance, self.routine.state)];
        for (owner, field) in self.reached {
            for (root, _) in roots.iter().filter(|(_, of)| *of == Some(*owner)) {
                let ty = self.program.structure(*owner).fields[field.index()].ty;
                let variable = Place::root(*root, Type::Struct(*owner)).field(*field, ty);
                self.effects.names.add(&variable, 0);
                self.passed(&variable, true, true);
            }
        }
        for (at, param) in self.routine.params.iter().enumerate() {
            let place = Place::root(Root::Param(ParamId::next(at)), param.ty);
            self.passed(&place, true, true);
        }
    }

    fn reads_and_writes(&mut self, place: &Place) {
        self.passed(place, true, true);
    }

    fn passed(&mut self, place: &Place, is_read: bool, is_written: bool) {
        if place.is_followed() {
            return;
        }
        let fields = self.fields(place);
        if is_read {
            self.effects.reads.add(place, fields);
        }
        if is_written {
            self.effects.writes.add(place, fields);
        }
    }

    /// A borrowed place is read and written as far as the callee does so.
    fn touches(&mut self, place: &Place, access: Access) {
        if place.is_followed() {
            return;
        }
        let fields = self.fields(place);
        self.effects.names.add(place, fields);
        self.passed(place, access == Access::Read, access == Access::Write);
        if let (Root::Local(id), Access::Borrow) = (place.root, access) {
            self.effects.borrowed[id.index()] = true;
        }
    }

    /// How many variables the root of a place holds.
    fn fields(&self, place: &Place) -> usize {
        match self.program.root_type(self.routine, place.root) {
            Some(Type::Struct(id)) => self.program.structure(id).fields.len(),
            Some(
                Type::Elementary(_)
                | Type::Reference(_)
                | Type::Subrange(..)
                | Type::String(_)
                | Type::Enum(_)
                | Type::Array(_)
                | Type::Block(_),
            )
            | None => 0,
        }
    }

    /// What an expression makes or follows references to.
    fn expr(&mut self, expr: &Expr) {
        match &expr.kind {
            ExprKind::Const(_) | ExprKind::Text(_) | ExprKind::Aggregate(_) => {}
            ExprKind::Load(place) => self.place(place),
            ExprKind::AddressOf(place) => {
                self.place(place);
                self.effects.reaches = true;
            }
            ExprKind::Apply(_, operands) | ExprKind::ApplyText(_, operands) => {
                operands.iter().for_each(|it| self.expr(it));
            }
            ExprKind::Convert(_, operand) => self.expr(operand),
        }
    }

    fn place(&mut self, place: &Place) {
        place.indices().for_each(|it| self.expr(it));
        if place.is_followed() {
            self.reaches_any();
        }
        self.effects.faults_at_call |= place.projections.iter().any(Projection::faults_at_call);
    }

    /// What is known of faults here.
    fn asked(&self, question: &dyn Fn(Faults<'_>) -> bool) -> bool {
        let is_within = |index: &Expr, array: Option<ArrayId>| {
            let Some(array) = array else { return false };
            let is_constant = constant_position(self.program, index, array).is_some();
            is_constant || self.rules.drops_checks && self.is_within(index, array)
        };
        question(Faults {
            program: self.program,
            root_type: &|root| self.program.root_type(self.routine, root),
            is_within: &is_within,
            operation: &self.rules.operation_faults,
        })
    }

    fn is_within(&self, index: &Expr, array: ArrayId) -> bool {
        let checked = |id: LocalId| self.effects.checked[id.index()];
        Known { program: self.program, loops: &self.loops, checked: &checked, seen: &[] }.is_within(index, array)
    }
}

impl Rules {
    /// Nothing is proven, and blocks take the context where their row says so.
    pub const PLAIN: Self = Self {
        block_takes_context: |block, instruction| {
            let Type::Block(id) = block.ty else { unreachable!("verified IR: a block is called") };
            id.info().instructions[instruction].needs_context
        },
        operation_faults: op_faults,
        drops_checks: false,
        scans_take_all: false,
    };
}

#[cfg(test)]
mod tests;
