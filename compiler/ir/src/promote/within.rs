//! A loop whose ends show whether its indices are within their bounds has two versions: without checks, and as it is.
//!
//! ```text
//! FOR i := 1 TO n - 1 DO             last := n - 1;
//!     low := MIN(low, a[i]);         IF last <= 31 THEN
//! END_FOR                                FOR i := 1 TO MIN(last, 31) DO low := MIN(low, a[i]) END_FOR
//!                                    ELSE
//!                                        FOR i := 1 TO last DO low := MIN(low, a[i]) END_FOR
//!                                    END_IF
//! ```
//!
//! It applies to a FOR by a constant step, whose counter nothing else writes, with no loop and no call in it, of few operations. Its indices
//! are the counter, or at a constant distance from it; its ends are sums of variables that cannot fault. The back end sees by the ends
//! that no such index can fault. So the loop does not store what it computes in each turn for a fault. It may not assume
//! that the ends are within the bounds: where they are not, the loop faults in its own turn.

use super::local::{MOST_LOCALS, private_head};
use crate::interval::Range;
use crate::loops::Known;
use crate::visit;
use crate::{
    ArrayId, Block, Const, Conversion, Elementary, Expr, ExprKind, For, Local, LocalId, Location, Op, Place, Program,
    Projection, Routine, Statement, StatementKind, Step, Taking, Type, Value, turns,
};
use staunch_runtime::Context;

/// Operations of a loop with two versions, and of all those in a routine.
const MOST: usize = 64;
const MOST_IN_A_ROUTINE: usize = 1024;

/// In a routine's statements. `declared` is how many locals it had before all passes.
pub(super) fn twice(program: &Program, routine: &mut Routine, body: &mut Block, declared: usize) {
    Doubler { program, routine, declared, made: 0, around: Vec::new() }.block(body);
}

struct Doubler<'p> {
    program: &'p Program,
    /// Without its body.
    routine: &'p mut Routine,
    declared: usize,
    /// Operations that are there twice so far.
    made: usize,
    /// The private loops around, without their bodies.
    around: Vec<For>,
}

impl Doubler<'_> {
    fn block(&mut self, block: &mut Block) {
        for mut statement in std::mem::take(block) {
            let depth = self.around.len();
            self.around.extend(private_head(&statement));
            statement.kind.blocks_mut().into_iter().for_each(|it| self.block(it));
            self.around.truncate(depth);
            match self.doubled(&statement) {
                Some(statements) => block.extend(statements),
                None => block.push(statement),
            }
        }
    }

    fn doubled(&mut self, statement: &Statement) -> Option<Block> {
        let StatementKind::For(it) = &statement.kind else { return None };
        let (Step::Constant(step), Type::Elementary(ty)) = (&it.step, it.counter.ty) else { return None };
        let size = turns::size_of(&it.body);
        let has_room = size <= MOST && self.made + size <= MOST_IN_A_ROUTINE;
        let has_locals = self.routine.locals.len() + 2 <= self.declared + MOST_LOCALS;
        let is_plain = it.is_private && has_room && has_locals && it.body.iter().all(is_plain);
        let ends = [&it.first, &it.last];
        let is_simple = |end: &&Expr| end.ty == it.counter.ty && is_simple(end, &it.counter);
        if !is_plain || !ends.iter().all(is_simple) {
            return None;
        }
        let (least, most) = self.wanted(it)?;
        let (low, high) = if *step > 0 { (ends[0], ends[1]) } else { (ends[1], ends[0]) };
        let number = |it: &Expr| it.as_const().and_then(Value::as_integer);
        let is_hopeless = number(low).is_some_and(|it| it < least) || number(high).is_some_and(|it| it > most);
        if is_hopeless || number(low).is_some() && number(high).is_some() {
            return None;
        }
        self.made += size;
        let mut made = Made { at: statement.at, ty, before: Block::new(), tests: Vec::new() };
        let names = if *step > 0 { ["first", "last"] } else { ["last", "first"] };
        let low = self.end(&mut made, low, names[0], (Op::Ge, Op::Max, least));
        let high = self.end(&mut made, high, names[1], (Op::Le, Op::Min, most));
        let [first, last] = if *step > 0 { [low, high] } else { [high, low] };
        let mut within = For { first: first.1, last: last.1, ..(**it).clone() };
        if u64::try_from(most - least).is_ok_and(|it| it < Context::FREE_TURNS) {
            takes_none(&mut within);
        }
        let other = For { first: first.0, last: last.0, ..(**it).clone() };
        let condition =
            made.tests.into_iter().reduce(|a, b| Expr::apply(Op::And, Type::BOOL, vec![a, b], statement.at))?;
        let loops = [within, other].map(|it| vec![Statement::new(StatementKind::For(Box::new(it)), statement.at)]);
        let [then, otherwise] = loops;
        made.before.push(Statement::new(StatementKind::If { condition, then, otherwise }, statement.at));
        Some(made.before)
    }

    /// The end as it is, and within the limit. A test of it is added where it is not a constant.
    fn end(&mut self, made: &mut Made, end: &Expr, name: &str, (test, limit, by): (Op, Op, i128)) -> (Expr, Expr) {
        let at = made.at;
        let limited = made.ty.repr().integer(by).filter(|_| end.as_const().is_none());
        let Some(by) = limited else { return (end.clone(), end.clone()) };
        let id = LocalId::next(self.routine.locals.len());
        let zero = Const::Scalar(made.ty.repr().zero());
        self.routine.locals.push(Local { name: name.to_owned(), ty: end.ty, initial: zero, doc: None });
        let local = Place::local(id, end.ty);
        made.before.push(Statement::assign(local.clone(), end.clone(), at));
        let (read, by) = (Expr::load(local, at), Expr::constant(made.ty, by, at));
        made.tests.push(Expr::apply(test, Type::BOOL, vec![read.clone(), by.clone()], at));
        let within = Expr::apply(limit, end.ty, vec![read.clone(), by], at);
        (read, within)
    }

    /// The values of the counter with which all of its indices are within their bounds, if some are not known to be.
    fn wanted(&self, it: &For) -> Option<Range> {
        let mut wanted = self.program.repr(it.counter.ty)?.range()?;
        let mut is_unknown = false;
        let loops: Vec<&For> = self.around.iter().chain([it]).collect();
        let known = Known { program: self.program, loops: &loops, checked: &|_| false, seen: &[] };
        visit::statements(&it.body, &mut |statement| {
            visit::accesses(statement, &mut |place, _| {
                self.indices(place, &mut |index, id| {
                    let Some(distance) = distance(index, &it.counter) else { return };
                    let array = self.program.array(id);
                    wanted.0 = wanted.0.max(i128::from(array.low) - distance);
                    wanted.1 = wanted.1.min(i128::from(array.high) - distance);
                    is_unknown |= !known.is_within(index, id);
                });
            });
        });
        (is_unknown && wanted.0 <= wanted.1).then_some(wanted)
    }

    /// The indices of a place, each with its array.
    fn indices(&self, place: &Place, see: &mut dyn FnMut(&Expr, ArrayId)) {
        let mut ty = self.program.root_type(self.routine, place.root);
        for projection in &place.projections {
            if let (Projection::Index { index, .. }, Some(Type::Array(id))) = (projection, ty) {
                see(index, id);
            }
            ty = ty.and_then(|it| self.program.part(it, projection));
        }
    }
}

/// What is in front of the two loops, and the tests that decide which of them runs.
struct Made {
    at: Location,
    ty: Elementary,
    before: Block,
    tests: Vec<Expr>,
}

/// A loop of few turns takes none.
fn takes_none(it: &mut For) {
    match it.taking {
        Taking::AheadOfMany(_) => it.taking = Taking::Each,
        Taking::EachOfMany if matches!(it.body.first(), Some(Statement { kind: StatementKind::Turn, .. })) => {
            it.taking = Taking::Each;
            it.body.remove(0);
        }
        Taking::Each | Taking::EachOfMany | Taking::Ahead(_) => {}
    }
}

/// An index less the counter, if that is constant where nothing wraps.
fn distance(index: &Expr, counter: &Place) -> Option<i128> {
    let number = |it: &Expr| it.as_const().and_then(Value::as_integer);
    match &index.kind {
        ExprKind::Load(place) => place.is_same_variable(counter).then_some(0),
        ExprKind::Convert(Conversion::Value | Conversion::Same, operand) => distance(operand, counter),
        ExprKind::Apply(Op::Add, operands) => match (number(&operands[0]), number(&operands[1])) {
            (Some(a), None) => Some(distance(&operands[1], counter)? + a),
            (None, Some(b)) => Some(distance(&operands[0], counter)? + b),
            _ => None,
        },
        ExprKind::Apply(Op::Sub, operands) => Some(distance(&operands[0], counter)? - number(&operands[1])?),
        ExprKind::Convert(Conversion::Truncate | Conversion::Bits, _)
        | ExprKind::Apply(..)
        | ExprKind::ApplyText(..)
        | ExprKind::Const(_)
        | ExprKind::Text(_)
        | ExprKind::AddressOf(_)
        | ExprKind::Aggregate(_) => None,
    }
}

/// Whether an end of a loop cannot fault, wherever it is evaluated, and is not made of the counter.
fn is_simple(end: &Expr, counter: &Place) -> bool {
    match &end.kind {
        ExprKind::Const(_) => true,
        ExprKind::Load(place) => {
            place.projections.iter().all(|it| matches!(it, Projection::Field(_))) && !place.is_same_variable(counter)
        }
        ExprKind::Convert(Conversion::Value | Conversion::Same, operand) => is_simple(operand, counter),
        ExprKind::Apply(Op::Add | Op::Sub | Op::Mul | Op::Min | Op::Max, operands) => {
            operands.iter().all(|it| is_simple(it, counter))
        }
        ExprKind::Convert(Conversion::Truncate | Conversion::Bits, _)
        | ExprKind::Apply(..)
        | ExprKind::ApplyText(..)
        | ExprKind::Text(_)
        | ExprKind::AddressOf(_)
        | ExprKind::Aggregate(_) => false,
    }
}

/// A statement of a body that may be there twice.
fn is_plain(statement: &Statement) -> bool {
    match &statement.kind {
        StatementKind::Assign { .. } | StatementKind::Turn | StatementKind::Exit | StatementKind::Continue => true,
        StatementKind::If { then, otherwise, .. } => then.iter().chain(otherwise).all(is_plain),
        StatementKind::Case { .. }
        | StatementKind::Loop { .. }
        | StatementKind::For(_)
        | StatementKind::Try { .. }
        | StatementKind::Finally { .. }
        | StatementKind::Return
        | StatementKind::Call { .. }
        | StatementKind::External(_)
        | StatementKind::CallBlock { .. }
        | StatementKind::PrescanBlock { .. }
        | StatementKind::Stop(_)
        | StatementKind::Fault(_) => false,
    }
}
