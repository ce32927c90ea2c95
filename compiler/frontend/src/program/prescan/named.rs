//! The element that an index names in a prescan. Logix runs each instruction once, with the tags as they
//! are then: it touches one element, and none where the index is out of range, which its prescan
//! ignores (Rockwell 1756-PM014, "Major faults": array faults are cleared during prescan).

use staunch_ir::{
    Block, Chars, Const, Elementary, Expr, ExprKind, LocalId, Location, Op, Place, Program, Projection, Repr, Root,
    Routine, Statement, StatementKind, Type, Value,
};

/// A place as another routine sees it: `load` says what its indices read.
pub(super) fn with_indices(place: &Place, load: &dyn Fn(Place) -> Expr) -> Place {
    let projection = |it: &Projection| match it {
        Projection::Field(_) | Projection::Deref { .. } => it.clone(),
        Projection::Index { index, at } => Projection::Index { index: Box::new(with_loads(index, load)), at: *at },
    };
    Place { projections: place.projections.iter().map(projection).collect(), ..place.clone() }
}

fn with_loads(expr: &Expr, load: &dyn Fn(Place) -> Expr) -> Expr {
    let all = |operands: &[Expr]| operands.iter().map(|it| with_loads(it, load)).collect();
    let kind = match &expr.kind {
        ExprKind::Const(_) | ExprKind::Text(_) | ExprKind::Aggregate(_) => return expr.clone(),
        ExprKind::Load(place) => return Expr { ty: expr.ty, ..load(with_indices(place, load)) },
        ExprKind::AddressOf(place) => ExprKind::AddressOf(Box::new(with_indices(place, load))),
        ExprKind::Apply(op, operands) => ExprKind::Apply(*op, all(operands)),
        ExprKind::ApplyText(op, operands) => ExprKind::ApplyText(*op, all(operands)),
        ExprKind::Convert(how, inner) => ExprKind::Convert(*how, Box::new(with_loads(inner, load))),
    };
    Expr { kind, ..expr.clone() }
}

/// Whether an index of the place reads what a caller passes.
pub(super) fn reads_param(place: &Place) -> bool {
    let mut found = false;
    staunch_ir::visit::index_reads(place, &mut |it| found |= matches!(it.root, Root::Param(_)));
    found
}

/// The place before any call: a variable that lives for one call has its initial value.
pub(super) fn before_calls(program: &Program, routine: &Routine, place: &Place) -> Place {
    with_indices(place, &|it: Place| match it.root {
        Root::Local(local) => initial(program, routine, local, &it),
        Root::Instance | Root::Globals | Root::Param(_) => Expr::load(it, Location::default()),
    })
}

/// What a local, or a part of it, holds before its routine runs; parts of aggregates count as 0.
pub(super) fn initial(program: &Program, routine: &Routine, local: LocalId, place: &Place) -> Expr {
    let at = Location::default();
    let kind = match (program.repr(place.ty), &routine.locals[local.index()].initial) {
        (Some(_), Const::Scalar(value)) if place.projections.is_empty() => ExprKind::Const(*value),
        (Some(repr), _) => ExprKind::Const(repr.zero()),
        (None, Const::Text(text)) if place.projections.is_empty() => ExprKind::Text(text.clone()),
        (None, _) => match place.ty.string_type() {
            Some(ty) => ExprKind::Text(Chars::empty(ty)),
            None => ExprKind::Aggregate(Const::Zero),
        },
    };
    Expr::new(place.ty.read(), kind, at)
}

/// `body`, where every index on the way to the place is in range and nothing in it faults.
pub(super) fn where_it_is_one(program: &Program, routine: &Routine, place: &Place, body: Block, at: Location) -> Block {
    let mut guards = Vec::new();
    Guards { program, routine, at, found: &mut guards }.place(place);
    guards.into_iter().rev().fold(body, |then, condition| {
        vec![Statement::new(StatementKind::If { condition, then, otherwise: Vec::new() }, at)]
    })
}

/// Conditions, each of which can be evaluated once those before it hold.
struct Guards<'p, 'g> {
    program: &'p Program,
    routine: &'p Routine,
    at: Location,
    found: &'g mut Vec<Expr>,
}

impl Guards<'_, '_> {
    fn place(&mut self, place: &Place) {
        let mut ty = self.program.root_type(self.routine, place.root);
        for projection in &place.projections {
            ty = match (projection, ty) {
                (Projection::Index { index, .. }, Some(Type::Array(id))) => {
                    let array = self.program.array(id);
                    self.index(index, array.low, array.high);
                    Some(array.element)
                }
                (Projection::Field(field), Some(ty)) => self.program.member(ty, *field),
                // References are null then.
                (Projection::Deref { target, .. }, _) => {
                    self.found.push(Expr::bool(false, self.at));
                    Some(*target)
                }
                (Projection::Index { .. } | Projection::Field(_), _) => None,
            };
        }
    }

    fn index(&mut self, index: &Expr, low: i64, high: i64) {
        self.expr(index);
        if index.as_const().is_none() {
            let lint = |value| Expr::constant(Elementary::Lint, Value::I64(value), self.at);
            self.within(index, lint(low), lint(high));
        }
    }

    fn within(&mut self, value: &Expr, low: Expr, high: Expr) {
        for (op, limit) in [(Op::Ge, low), (Op::Le, high)] {
            self.found.push(Expr::apply(op, Type::BOOL, vec![value.clone(), limit], self.at));
        }
    }

    fn expr(&mut self, expr: &Expr) {
        match &expr.kind {
            ExprKind::Const(_) | ExprKind::Text(_) | ExprKind::Aggregate(_) => {}
            ExprKind::Load(place) => self.place(place),
            ExprKind::AddressOf(place) => self.place(place),
            ExprKind::Apply(op, operands) => {
                operands.iter().for_each(|it| self.expr(it));
                self.operation(*op, operands);
            }
            ExprKind::ApplyText(_, operands) => operands.iter().for_each(|it| self.expr(it)),
            ExprKind::Convert(_, inner) => self.expr(inner),
        }
    }

    fn operation(&mut self, op: Op, operands: &[Expr]) {
        match (op, operands) {
            (Op::Div | Op::Mod, [_, divisor]) => {
                let repr = self.program.repr(divisor.ty).filter(|it| Repr::is_integer(*it));
                if let Some(zero) = repr.map(Repr::zero).filter(|_| divisor.as_const().is_none()) {
                    let zero = Expr::new(divisor.ty, ExprKind::Const(zero), self.at);
                    self.found.push(Expr::apply(Op::Ne, Type::BOOL, vec![divisor.clone(), zero], self.at));
                }
            }
            (Op::InRange | Op::CheckIndex, [low, value, high]) => self.within(value, low.clone(), high.clone()),
            _ => {}
        }
    }
}
