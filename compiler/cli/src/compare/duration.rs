//! For how long an input is worth holding: what the program's constants count and wait for.

use staunch_ir::{Block, Const, Expr, ExprKind, Program, Type, Value, visit};
use std::collections::BTreeSet;

/// Scans that each of a program's constants stands for: a TIME as the scans that pass in it, a
/// number as that many.
pub fn scans(program: &Program, cycle: i64) -> BTreeSet<usize> {
    let mut constants = Constants { cycle: cycle.max(1), found: BTreeSet::new() };
    for routine in &program.routines {
        constants.block(&routine.body);
        routine.locals.iter().for_each(|it| constants.initial(Some(it.ty), &it.initial));
    }
    let fields = program.structs.iter().flat_map(|it| &it.fields);
    fields.for_each(|it| constants.initial(Some(it.ty), &it.initial));
    constants.found
}

struct Constants {
    cycle: i64,
    found: BTreeSet<usize>,
}

impl Constants {
    fn value(&mut self, ty: Option<Type>, value: Value) {
        let waits = ty.and_then(Type::elementary).is_some_and(|it| it.is_time());
        let scans = match value {
            Value::I64(time) if waits => i128::from(time / self.cycle),
            other => other.as_integer().unwrap_or(0),
        };
        self.found.extend(usize::try_from(scans).ok().filter(|it| *it > 1));
    }

    fn initial(&mut self, ty: Option<Type>, value: &Const) {
        let pin = |at: usize| match ty {
            Some(Type::Block(id)) => id.pin_type(staunch_ir::FieldId::next(at)),
            _ => None,
        };
        match value {
            Const::Scalar(it) => self.value(ty, *it),
            Const::Zero | Const::Text(_) => {}
            Const::Array(runs) => runs.iter().for_each(|it| self.initial(None, &it.1)),
            Const::Struct(fields) => fields.iter().enumerate().for_each(|(at, it)| self.initial(pin(at), it)),
        }
    }

    fn expr(&mut self, expr: &Expr) {
        match &expr.kind {
            ExprKind::Const(it) => self.value(Some(expr.ty), *it),
            ExprKind::Aggregate(it) => self.initial(Some(expr.ty), it),
            ExprKind::Apply(_, operands) | ExprKind::ApplyText(_, operands) => {
                operands.iter().for_each(|it| self.expr(it));
            }
            ExprKind::Convert(_, inner) => self.expr(inner),
            ExprKind::Text(_) | ExprKind::Load(_) => {}
        }
    }

    fn block(&mut self, block: &Block) {
        visit::statements(block, &mut |statement| visit::values(statement, &mut |it| self.expr(it)));
    }
}
