//! The walks over statements, places and expressions, in the order of evaluation.

use crate::{Argument, Expr, ExprKind, Place, Projection, Statement, StatementKind, Step};

/// What a statement does with a place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Access {
    Read,
    /// The whole place gets a new value.
    Write,
    /// It is handed to a callee that may read and write it.
    Borrow,
}

/// Changes expressions and places where they are.
pub trait Rewrite {
    /// The parts of the expression have been changed.
    fn expr(&mut self, expr: &mut Expr);
    /// The indices in the place have been changed.
    fn place(&mut self, place: &mut Place);
}

/// Changes all of a block, inner parts before outer ones.
pub fn rewrite(block: &mut [Statement], by: &mut impl Rewrite) {
    for statement in block {
        rewrite_statement(&mut statement.kind, by);
        statement.kind.blocks_mut().into_iter().for_each(|inner| rewrite(inner, by));
    }
}

fn rewrite_statement(kind: &mut StatementKind, by: &mut impl Rewrite) {
    match kind {
        StatementKind::Assign { target, value } => {
            rewrite_place(target, by);
            rewrite_expr(value, by);
        }
        StatementKind::If { condition: value, .. } | StatementKind::Case { selector: value, .. } => {
            rewrite_expr(value, by)
        }
        StatementKind::For(it) => {
            rewrite_place(&mut it.counter, by);
            rewrite_expr(&mut it.first, by);
            rewrite_expr(&mut it.last, by);
            if let Step::Variable(step) = &mut it.step {
                rewrite_expr(step, by);
            }
        }
        StatementKind::Call { instance, arguments, result, .. } => {
            instance.iter_mut().for_each(|it| rewrite_place(it, by));
            arguments.iter_mut().for_each(|it| rewrite_argument(it, by));
            result.iter_mut().for_each(|it| rewrite_place(it, by));
        }
        StatementKind::External(it) => {
            it.instance.iter_mut().for_each(|it| rewrite_place(it, by));
            it.arguments.iter_mut().for_each(|it| rewrite_argument(it, by));
            it.result.iter_mut().for_each(|it| rewrite_place(it, by));
        }
        StatementKind::CallBlock { block, inputs, .. } => {
            rewrite_place(block, by);
            inputs.iter_mut().for_each(|it| rewrite_expr(it, by));
        }
        StatementKind::PrescanBlock { block: place, .. } | StatementKind::Try { kind: place, .. } => {
            rewrite_place(place, by)
        }
        StatementKind::Stop(it) => it.asked.iter_mut().for_each(|it| rewrite_expr(&mut it.value, by)),
        StatementKind::Loop { count, .. } => {
            if let Some(it) = count {
                rewrite_place(&mut it.counter, by);
                rewrite_expr(&mut it.bound, by);
            }
        }
        StatementKind::Finally { .. }
        | StatementKind::Turn
        | StatementKind::Exit
        | StatementKind::Continue
        | StatementKind::Return
        | StatementKind::Fault(_) => {}
    }
}

fn rewrite_argument(argument: &mut Argument, by: &mut impl Rewrite) {
    match argument {
        Argument::Value(value) => rewrite_expr(value, by),
        Argument::Reference(place) => rewrite_place(place, by),
    }
}

fn rewrite_expr(expr: &mut Expr, by: &mut impl Rewrite) {
    match &mut expr.kind {
        ExprKind::Const(_) | ExprKind::Text(_) | ExprKind::Aggregate(_) => {}
        ExprKind::Load(place) => rewrite_place(place, by),
        ExprKind::AddressOf(place) => rewrite_place(place, by),
        ExprKind::Apply(_, operands) | ExprKind::ApplyText(_, operands) => {
            operands.iter_mut().for_each(|it| rewrite_expr(it, by));
        }
        ExprKind::Convert(_, value) => rewrite_expr(value, by),
    }
    by.expr(expr);
}

fn rewrite_place(place: &mut Place, by: &mut impl Rewrite) {
    for projection in &mut place.projections {
        match projection {
            Projection::Index { index, .. } => rewrite_expr(index, by),
            Projection::Field(_) | Projection::Deref { .. } => {}
        }
    }
    by.place(place);
}

/// Calls `see` for each place that evaluating `expr` reads.
pub fn reads(expr: &Expr, see: &mut dyn FnMut(&Place)) {
    match &expr.kind {
        ExprKind::Const(_) | ExprKind::Text(_) | ExprKind::Aggregate(_) => {}
        ExprKind::Load(place) => {
            index_reads(place, see);
            see(place);
        }
        ExprKind::AddressOf(place) => index_reads(place, see),
        ExprKind::Apply(_, operands) | ExprKind::ApplyText(_, operands) => {
            operands.iter().for_each(|it| reads(it, see));
        }
        ExprKind::Convert(_, value) => reads(value, see),
    }
}

/// Calls `see` for each place that finding `place` reads.
pub fn index_reads(place: &Place, see: &mut dyn FnMut(&Place)) {
    for (position, projection) in place.projections.iter().enumerate() {
        match projection {
            Projection::Field(_) => {}
            Projection::Index { index, .. } => reads(index, see),
            Projection::Deref { reference, .. } => see(&place.before(position, *reference)),
        }
    }
}

/// Calls `see` for each place that the statement itself, without the blocks in it, touches.
pub fn accesses(statement: &Statement, see: &mut dyn FnMut(&Place, Access)) {
    match &statement.kind {
        StatementKind::Assign { target, value } => {
            index_reads(target, &mut |it| see(it, Access::Read));
            reads(value, &mut |it| see(it, Access::Read));
            see(target, Access::Write);
        }
        StatementKind::If { condition: value, .. } | StatementKind::Case { selector: value, .. } => {
            reads(value, &mut |it| see(it, Access::Read));
        }
        StatementKind::Call { instance, arguments, result, .. } => {
            instance.iter().for_each(|place| borrow(place, see));
            arguments.iter().for_each(|argument| argument_accesses(argument, see));
            result.iter().for_each(|place| see(place, Access::Write));
        }
        StatementKind::External(it) => {
            it.instance.iter().for_each(|place| borrow(place, see));
            it.arguments.iter().for_each(|argument| argument_accesses(argument, see));
            it.result.iter().for_each(|place| see(place, Access::Write));
        }
        StatementKind::CallBlock { block, inputs, .. } => {
            borrow(block, see);
            inputs.iter().for_each(|it| reads(it, &mut |place| see(place, Access::Read)));
        }
        StatementKind::PrescanBlock { block, .. } => borrow(block, see),
        StatementKind::Try { kind, .. } => see(kind, Access::Write),
        StatementKind::Stop(it) => {
            it.asked.iter().for_each(|it| reads(&it.value, &mut |place| see(place, Access::Read)));
        }
        StatementKind::For(it) => {
            index_reads(&it.counter, &mut |place| see(place, Access::Read));
            reads(&it.first, &mut |place| see(place, Access::Read));
            see(&it.counter, Access::Write);
            reads(&it.last, &mut |place| see(place, Access::Read));
            if let Step::Variable(step) = &it.step {
                reads(step, &mut |place| see(place, Access::Read));
            }
            see(&it.counter, Access::Read);
            see(&it.counter, Access::Write);
        }
        StatementKind::Loop { .. }
        | StatementKind::Finally { .. }
        | StatementKind::Turn
        | StatementKind::Exit
        | StatementKind::Continue
        | StatementKind::Return
        | StatementKind::Fault(_) => {}
    }
}

fn argument_accesses(argument: &Argument, see: &mut dyn FnMut(&Place, Access)) {
    match argument {
        Argument::Value(value) => reads(value, &mut |it| see(it, Access::Read)),
        Argument::Reference(place) => borrow(place, see),
    }
}

fn borrow(place: &Place, see: &mut dyn FnMut(&Place, Access)) {
    index_reads(place, &mut |it| see(it, Access::Read));
    see(place, Access::Borrow);
}

/// Calls `see` for each expression that the statement itself, without the blocks in it, evaluates, but
/// for the indices of its places.
pub fn values<'a>(statement: &'a Statement, see: &mut dyn FnMut(&'a Expr)) {
    match &statement.kind {
        StatementKind::Assign { target: _, value } => see(value),
        StatementKind::If { condition: value, .. } | StatementKind::Case { selector: value, .. } => see(value),
        StatementKind::For(it) => {
            see(&it.first);
            see(&it.last);
            if let Step::Variable(step) = &it.step {
                see(step);
            }
        }
        StatementKind::Call { arguments, .. } => arguments.iter().filter_map(Argument::value).for_each(see),
        StatementKind::External(it) => it.arguments.iter().filter_map(Argument::value).for_each(see),
        StatementKind::CallBlock { inputs, .. } => inputs.iter().for_each(see),
        StatementKind::Stop(it) => it.asked.iter().for_each(|it| see(&it.value)),
        StatementKind::Loop { .. }
        | StatementKind::Finally { .. }
        | StatementKind::Turn
        | StatementKind::Exit
        | StatementKind::Continue
        | StatementKind::Return
        | StatementKind::PrescanBlock { .. }
        | StatementKind::Try { .. }
        | StatementKind::Fault(_) => {}
    }
}

/// Calls `see` for each expression that the statement itself, without the blocks in it, evaluates, and for
/// those in them and in its places.
pub fn all_exprs<'a>(statement: &'a Statement, see: &mut dyn FnMut(&'a Expr)) {
    values(statement, &mut |it| within(it, see));
    targets(statement, &mut |place| place.indices().for_each(|it| within(it, see)));
}

/// Calls `see` for the expression, and for those in it and in its places.
pub fn within<'a>(expr: &'a Expr, see: &mut dyn FnMut(&'a Expr)) {
    see(expr);
    match &expr.kind {
        ExprKind::Const(_) | ExprKind::Text(_) | ExprKind::Aggregate(_) => {}
        ExprKind::Load(place) => place.indices().for_each(|it| within(it, see)),
        ExprKind::AddressOf(place) => place.indices().for_each(|it| within(it, see)),
        ExprKind::Apply(_, operands) | ExprKind::ApplyText(_, operands) => {
            operands.iter().for_each(|it| within(it, see));
        }
        ExprKind::Convert(_, value) => within(value, see),
    }
}

/// Calls `see` for each place that the statement itself writes or hands on.
pub fn targets<'a>(statement: &'a Statement, see: &mut dyn FnMut(&'a Place)) {
    match &statement.kind {
        StatementKind::Assign { target, .. } => see(target),
        StatementKind::For(it) => see(&it.counter),
        StatementKind::Call { instance, arguments, result, .. } => {
            instance.iter().for_each(&mut *see);
            arguments.iter().filter_map(Argument::place).for_each(&mut *see);
            result.iter().for_each(see);
        }
        StatementKind::External(it) => {
            it.instance.iter().for_each(&mut *see);
            it.arguments.iter().filter_map(Argument::place).for_each(&mut *see);
            it.result.iter().for_each(see);
        }
        StatementKind::CallBlock { block, .. } | StatementKind::PrescanBlock { block, .. } => see(block),
        StatementKind::Try { kind, .. } => see(kind),
        StatementKind::If { .. }
        | StatementKind::Case { .. }
        | StatementKind::Loop { .. }
        | StatementKind::Finally { .. }
        | StatementKind::Turn
        | StatementKind::Exit
        | StatementKind::Continue
        | StatementKind::Return
        | StatementKind::Stop(_)
        | StatementKind::Fault(_) => {}
    }
}

/// Calls `see` for each statement in `block`, at any depth.
pub fn statements<'a>(block: &'a [Statement], see: &mut dyn FnMut(&'a Statement)) {
    for statement in block {
        see(statement);
        statement.kind.blocks().into_iter().for_each(|inner| statements(inner, see));
    }
}
