//! The statements of a prescan.

use super::named;
use crate::expr::uses::Preparation;
use crate::types::declarations::Declarations;
use crate::types::signature::pin_place;
use staunch_ir::startup::{Event, Fate, Startup};
use staunch_ir::{
    Block, Chars, Const, Elementary, Expr, ExprKind, For, Local, LocalId, Location, Op, Place, Program, Projection,
    Repr, RoutineId, Statement, StatementKind, Type, Value,
};

/// Builds the prescan of one POU.
pub(super) struct Builder<'p> {
    program: &'p Program,
    pou: usize,
    prescan: RoutineId,
    locals: Vec<Local>,
    block: Block,
    at: Location,
}

/// What is added to a prescan.
pub(super) struct Addition {
    prescan: RoutineId,
    locals: Vec<Local>,
    block: Block,
}

impl Addition {
    pub fn add_to(mut self, declarations: &mut Declarations<'_>) {
        let routine = &mut declarations.program.routines[self.prescan.index()];
        routine.body.append(&mut self.block);
        routine.locals = self.locals;
    }
}

impl<'p> Builder<'p> {
    /// Goes on with the prescan of the POU in slot `pou`.
    pub fn new(declarations: &'p Declarations<'_>, pou: usize) -> Self {
        let (program, prescan) = (&declarations.program, routine_of(declarations, pou));
        let it = program.routine(prescan);
        Self { program, pou, prescan, locals: it.locals.clone(), block: Block::new(), at: it.location }
    }

    pub fn finish(self) -> Addition {
        Addition { prescan: self.prescan, locals: self.locals, block: self.block }
    }

    /// What an instruction does to the structure or bit that it works on, and to no other element of an array.
    pub fn instruction(&mut self, place: &Place, preparation: Preparation) {
        let routine = &self.program.routines[self.pou];
        let place = named::before_calls(self.program, routine, place);
        let Some(kind) = self.prepared(&place, preparation) else { return };
        let prescan = vec![Statement::new(kind, self.at)];
        self.block.extend(named::where_it_is_one(self.program, routine, &place, prescan, self.at));
    }

    fn prepared(&self, place: &Place, preparation: Preparation) -> Option<StatementKind> {
        let (at, target) = (self.at, place.clone());
        match preparation {
            Preparation::Instruction(instruction) => {
                let Type::Block(id) = place.ty else { return None };
                id.info().instructions[instruction].prescan?;
                Some(StatementKind::PrescanBlock { block: target, instruction })
            }
            Preparation::Zero => {
                let zero = match target.ty.string_type() {
                    Some(ty) => ExprKind::Text(Chars::empty(ty)),
                    None => ExprKind::Const(self.program.repr(target.ty)?.zero()),
                };
                Some(StatementKind::Assign { value: Expr::new(target.ty.read(), zero, at), target })
            }
            Preparation::Bit { shift: None, value } => {
                Some(StatementKind::Assign { target, value: Expr::bool(value, at) })
            }
            Preparation::Bit { shift: Some(shift), value } => {
                let ty = place.ty.read();
                let Type::Elementary(of) = ty else { return None };
                // All bits of an integer but one, or that one.
                let bit = if value { 1i128 << shift } else { !(1i128 << shift) };
                let mask = Expr::new(ty, ExprKind::Const(wrapped(of.repr(), bit)?), at);
                let op = if value { Op::Or } else { Op::And };
                let value = Expr::apply(op, ty, vec![Expr::load(target.clone(), at), mask], at);
                Some(StatementKind::Assign { target, value })
            }
        }
    }

    /// CV starts at the kept count where that is retained, else at 0. Counters and counts in arrays
    /// belong together element by element.
    ///
    /// A counter that stays as it is over IDLE -> RUN has its count then, and is at 0 after a power
    /// cycle alone.
    pub fn restore(&mut self, counter: &Place, kept: &Place) {
        let Type::Block(id) = counter.ty else { return };
        let (startup, routine) = (Startup::new(self.program), &self.program.routines[self.pou]);
        let retained = startup.place(routine, kept, Event::PowerCycle).is_kept();
        let stays = startup.place(routine, counter, Event::Run) == Fate::Whole;
        if !retained && stays {
            return;
        }
        let at = self.at;
        let bounds = self.open_bounds(kept);
        let needs_guard = bounds != self.open_bounds(counter);
        self.everywhere(counter, &mut |indices, counter| {
            let zero = Expr::constant(Elementary::Int, Value::I16(0), at);
            let value = if retained { Expr::load(at_indices(kept, indices), at) } else { zero.clone() };
            let count = pin_place(counter, id, "CV");
            let restore = vec![Statement::assign(count.clone(), value, at)];
            let restore = if needs_guard { where_within(indices, &bounds, restore, at) } else { restore };
            if !stays {
                return restore;
            }
            let condition = Expr::apply(Op::Eq, Type::BOOL, vec![Expr::load(count, at), zero], at);
            vec![Statement::new(StatementKind::If { condition, then: restore, otherwise: Vec::new() }, at)]
        });
    }

    /// Runs another POU's prescan on its instance.
    pub fn instance(&mut self, callee: RoutineId, place: &Place) {
        let at = self.at;
        self.everywhere(place, &mut |_, instance| {
            let kind = StatementKind::Call { callee, instance: Some(instance), arguments: Vec::new(), result: None };
            vec![Statement::new(kind, at)]
        });
    }

    /// Runs `make` on the place; where an index is not constant, on every element: of what a restart
    /// prepares nothing is left out.
    fn everywhere(&mut self, place: &Place, make: &mut dyn FnMut(&[Expr], Place) -> Block) {
        let mut made = self.elements(place.clone(), 0, &mut Vec::new(), make);
        self.block.append(&mut made);
    }

    fn elements(
        &mut self,
        mut place: Place,
        from: usize,
        indices: &mut Vec<Expr>,
        make: &mut dyn FnMut(&[Expr], Place) -> Block,
    ) -> Block {
        let open = (from..place.projections.len()).find(|position| is_open(&place.projections[*position]));
        let Some(position) = open else { return make(indices, place) };
        let Some((low, high)) = self.bounds_at(&place, position) else { return Block::new() };
        let counter = LocalId::next(self.locals.len());
        self.locals.push(Local { name: "element".to_owned(), ty: Type::LINT, initial: Const::Zero, doc: None });
        let counter = Place::local(counter, Type::LINT);
        let index = Expr::load(counter.clone(), self.at);
        place.projections[position] = Projection::Index { index: Box::new(index.clone()), at: self.at };
        indices.push(index.clone());
        let body = self.elements(place, position + 1, indices, make);
        indices.pop();
        for_each(counter, (low, high), body, self.at)
    }

    /// The bounds for the indices of a place that are known in the call only.
    fn open_bounds(&self, place: &Place) -> Vec<(i64, i64)> {
        let open = (0..place.projections.len()).filter(|position| is_open(&place.projections[*position]));
        open.filter_map(|position| self.bounds_at(place, position)).collect()
    }

    /// The bounds of the array that projection `position` indexes.
    fn bounds_at(&self, place: &Place, position: usize) -> Option<(i64, i64)> {
        let mut ty = self.program.root_type(&self.program.routines[self.pou], place.root)?;
        for projection in &place.projections[..position] {
            ty = self.program.part(ty, projection)?;
        }
        let Type::Array(id) = ty else { return None };
        Some((self.program.array(id).low, self.program.array(id).high))
    }
}

/// An index that is known in the call only; where counts are restored it stands for every element.
fn is_open(projection: &Projection) -> bool {
    matches!(projection, Projection::Index { index, .. } if index.as_const().is_none())
}

fn at_indices(place: &Place, indices: &[Expr]) -> Place {
    let mut place = place.clone();
    let open = place.projections.iter_mut().filter(|it| is_open(it));
    for (projection, given) in open.zip(indices) {
        if let Projection::Index { index, .. } = projection {
            **index = given.clone();
        }
    }
    place
}

/// `block`, where every index is within its bounds: of two arrays one may be the larger.
fn where_within(indices: &[Expr], bounds: &[(i64, i64)], block: Block, at: Location) -> Block {
    let lint = |value| Expr::constant(Elementary::Lint, Value::I64(value), at);
    let test = |op, a: &Expr, b| Expr::apply(op, Type::BOOL, vec![a.clone(), b], at);
    let tests = indices
        .iter()
        .zip(bounds)
        .flat_map(|(index, (low, high))| [test(Op::Ge, index, lint(*low)), test(Op::Le, index, lint(*high))]);
    let condition = tests.reduce(|a, b| Expr::apply(Op::And, Type::BOOL, vec![a, b], at));
    match condition {
        Some(condition) => {
            vec![Statement::new(StatementKind::If { condition, then: block, otherwise: Vec::new() }, at)]
        }
        None => block,
    }
}

/// Runs `body` with each index from `low` to `high` in a local that it does not write.
fn for_each(counter: Place, (low, high): (i64, i64), body: Block, at: Location) -> Block {
    let lint = |value| Expr::constant(Elementary::Lint, Value::I64(value), at);
    vec![For::over(counter, lint(low), lint(high), body, at)]
}

/// The routine of the prescan of the POU in a slot, until routines are put in order.
pub(super) fn routine_of(declarations: &Declarations<'_>, slot: usize) -> RoutineId {
    RoutineId::next(declarations.pous.len() + slot)
}

/// These low bits as a value, of whatever sign.
fn wrapped(repr: Repr, bits: i128) -> Option<Value> {
    let all = 1i128 << (repr.size() * 8);
    let low = bits & (all - 1);
    repr.integer(low).or_else(|| repr.integer(low - all))
}
