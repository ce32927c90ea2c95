//! Variables that live for one call and whose addresses are taken get fixed storage among the globals: no
//! routine calls itself, so that no two calls use it at a time. They start at their initial values in every
//! call, as before.

use super::addresses::addressed_locals;
use crate::loops::exit_condition;
use crate::{
    Argument, Block, Chars, Const, Expr, ExprKind, Field, FieldId, For, Local, LocalId, Location, Mode, Place, Program,
    Projection, Retain, Root, Routine, Section, Statement, StatementKind, Step, Type,
};
use std::collections::{BTreeMap, BTreeSet};

/// The program, with fixed storage for what needs it.
pub fn fixed(program: Program) -> Program {
    let addressed = addressed_locals(&program);
    if addressed.iter().all(BTreeSet::is_empty) {
        return program;
    }
    let globals = program.globals;
    let mut program = program;
    for (at, locals) in addressed.into_iter().enumerate() {
        let mut moved = BTreeMap::new();
        for local in locals {
            let routine = &program.routines[at];
            let field = field_of(routine, &routine.locals[local.index()]);
            let fields = &mut program.structs[globals.index()].fields;
            moved.insert(local, FieldId::next(fields.len()));
            fields.push(field);
        }
        if !moved.is_empty() {
            let routine = std::mem::replace(&mut program.routines[at], empty());
            let moved = Mover { program: &program, globals: Type::Struct(globals), moved, routine: &routine }.moved();
            program.routines[at] = moved;
        }
    }
    program
}

fn empty() -> Routine {
    Routine {
        kind: crate::RoutineKind::Function,
        name: String::new(),
        doc: None,
        location: Location::default(),
        state: None,
        params: Vec::new(),
        locals: Vec::new(),
        result: None,
        body: Vec::new(),
    }
}

fn field_of(routine: &Routine, local: &Local) -> Field {
    Field {
        name: format!("{}_{}", routine.name, local.name),
        ty: local.ty,
        initial: local.initial.clone(),
        section: Section::Temp,
        retain: Retain::Anew,
        constant: false,
        address: None,
        doc: None,
        location: routine.location,
        declared: None,
    }
}

struct Mover<'r> {
    program: &'r Program,
    globals: Type,
    moved: BTreeMap<LocalId, FieldId>,
    routine: &'r Routine,
}

impl Mover<'_> {
    fn moved(&self) -> Routine {
        let mut body = self.start();
        body.extend(self.block(&self.routine.body));
        body.extend(self.end(self.routine.location));
        Routine { body, ..self.routine.clone() }
    }

    /// What a caller passed, or the initial value.
    fn start(&self) -> Vec<Statement> {
        let at = self.routine.location;
        let start = |(local, _): (&LocalId, &FieldId)| {
            let it = &self.routine.locals[local.index()];
            let is_passed = self.routine.params.iter().any(|param| param.mode == Mode::Value(*local));
            let value =
                if is_passed { Expr::load(Place::local(*local, it.ty), at) } else { initial(self.program, it, at) };
            Statement::assign(self.storage(*local), value, at)
        };
        self.moved.iter().map(start).collect()
    }

    /// The result, where it has fixed storage, goes back to where the caller gets it from.
    fn end(&self, at: Location) -> Option<Statement> {
        let result = self.routine.result.filter(|it| self.moved.contains_key(it))?;
        let target = Place::local(result, self.routine.locals[result.index()].ty);
        Some(Statement::assign(target, Expr::load(self.storage(result), at), at))
    }

    fn storage(&self, local: LocalId) -> Place {
        Place::root(Root::Globals, self.globals).field(self.moved[&local], self.routine.locals[local.index()].ty)
    }

    fn block(&self, block: &[Statement]) -> Vec<Statement> {
        let mut moved = Vec::with_capacity(block.len());
        for statement in block {
            if matches!(statement.kind, StatementKind::Return) {
                moved.extend(self.end(statement.at));
            }
            self.statement(statement, &mut moved);
        }
        moved
    }

    fn statement(&self, statement: &Statement, out: &mut Vec<Statement>) {
        let mut new = statement.clone();
        for block in new.kind.blocks_mut() {
            *block = self.block(block);
        }
        match &mut new.kind {
            StatementKind::Assign { target, value } => {
                self.place(target);
                self.expr(value);
            }
            StatementKind::If { condition: value, .. } | StatementKind::Case { selector: value, .. } => {
                self.expr(value)
            }
            StatementKind::For(it) => self.for_loop(it, statement.at),
            StatementKind::Call { instance, arguments, result, .. } => {
                instance.iter_mut().for_each(|it| self.place(it));
                arguments.iter_mut().for_each(|it| match it {
                    Argument::Value(value) => self.expr(value),
                    Argument::Reference(place) => self.place(place),
                });
                // A call's result goes to a local; what has fixed storage gets it from there.
                if let Some(Root::Local(local)) = result.as_ref().map(|it| it.root)
                    && self.moved.contains_key(&local)
                {
                    let back = Expr::load(Place::local(local, self.routine.locals[local.index()].ty), statement.at);
                    out.push(new);
                    return out.push(Statement::assign(self.storage(local), back, statement.at));
                }
            }
            StatementKind::External(it) => {
                it.instance.iter_mut().for_each(|it| self.place(it));
                it.arguments.iter_mut().for_each(|it| match it {
                    Argument::Value(value) => self.expr(value),
                    Argument::Reference(place) => self.place(place),
                });
                it.result.iter_mut().for_each(|it| self.place(it));
            }
            StatementKind::CallBlock { block, inputs, .. } => {
                self.place(block);
                inputs.iter_mut().for_each(|it| self.expr(it));
            }
            StatementKind::PrescanBlock { block: place, .. } | StatementKind::Try { kind: place, .. } => {
                self.place(place)
            }
            StatementKind::Loop { body, .. } => self.take_turns(body, new.at),
            StatementKind::Stop(it) => it.asked.iter_mut().for_each(|it| self.expr(&mut it.value)),
            StatementKind::Finally { .. }
            | StatementKind::Turn
            | StatementKind::Exit
            | StatementKind::Continue
            | StatementKind::Return
            | StatementKind::Fault(_) => {}
        }
        out.push(new);
    }

    /// Others may write what a loop without turns divides, where its address is taken.
    fn take_turns(&self, body: &mut Block, at: Location) {
        let takes = body.iter().any(|it| matches!(it.kind, StatementKind::Turn));
        if !takes && !self.moved.is_empty() {
            let after_test = usize::from(body.first().is_some_and(|it| exit_condition(it).is_some()));
            body.insert(after_test, Statement::new(StatementKind::Turn, at));
        }
    }

    /// Others may write a counter whose address is taken.
    fn for_loop(&self, it: &mut For, at: Location) {
        let was_moved = matches!(it.counter.root, Root::Local(id) if self.moved.contains_key(&id));
        self.place(&mut it.counter);
        self.expr(&mut it.first);
        self.expr(&mut it.last);
        match &mut it.step {
            Step::Variable(step) => self.expr(step),
            Step::Constant(_) => {}
        }
        if was_moved {
            it.is_private = false;
            if !it.body.first().is_some_and(|it| matches!(it.kind, StatementKind::Turn)) {
                it.body.insert(0, Statement::new(StatementKind::Turn, at));
            }
        }
    }

    fn expr(&self, expr: &mut Expr) {
        match &mut expr.kind {
            ExprKind::Const(_) | ExprKind::Text(_) | ExprKind::Aggregate(_) => {}
            ExprKind::Load(place) => self.place(place),
            ExprKind::AddressOf(place) => self.place(place),
            ExprKind::Apply(_, operands) | ExprKind::ApplyText(_, operands) => {
                operands.iter_mut().for_each(|it| self.expr(it));
            }
            ExprKind::Convert(_, value) => self.expr(value),
        }
    }

    fn place(&self, place: &mut Place) {
        for projection in &mut place.projections {
            match projection {
                Projection::Index { index, .. } => self.expr(index),
                Projection::Field(_) | Projection::Deref { .. } => {}
            }
        }
        if let Root::Local(local) = place.root
            && let Some(field) = self.moved.get(&local)
        {
            place.root = Root::Globals;
            place.projections.insert(0, Projection::Field(*field));
        }
    }
}

fn initial(program: &Program, local: &Local, at: Location) -> Expr {
    let kind = match (&local.initial, local.ty, program.repr(local.ty)) {
        (Const::Scalar(value), _, _) => ExprKind::Const(*value),
        (Const::Text(text), _, _) => ExprKind::Text(text.clone()),
        (Const::Zero, Type::String(it), _) => ExprKind::Text(Chars::empty(it)),
        (Const::Zero, _, Some(repr)) => ExprKind::Const(repr.zero()),
        (Const::Zero | Const::Array(_) | Const::Struct(_), _, _) => ExprKind::Aggregate(local.initial.clone()),
    };
    Expr::new(local.ty, kind, at)
}
