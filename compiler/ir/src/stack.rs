//! How much of the stack a call of a routine takes in native code: its locals, the strings and other
//! values that its statements make on the way, and what the code generator keeps in addition. It is
//! never less than that; a test compares it with the frames that are made.

use crate::{Argument, Expr, ExprKind, Place, Program, Projection, Routine, Statement, StatementKind, Type};
use crate::{pieces, visit};

/// A register's size, to which all parts of a frame are rounded.
const WORD: u64 = 8;
/// What every frame has: the registers that a callee keeps, the address to return to, and the few bytes of routines whose code
/// is in place of their calls.
const FIXED: u64 = 256;
/// More values than these are not alive at a time: code that large is not optimised, so that none is
/// kept from one statement for another.
const MOST_VALUES: u64 = 4096;

/// The bytes of one call, without those of the calls it makes. `size` is that of a type.
pub fn of_routine(program: &Program, routine: &Routine, size: &dyn Fn(Type) -> u64) -> u64 {
    of_body(routine, size).saturating_add(of_ignored_results(program, routine, size))
}

/// What can be said without the callees.
pub fn of_body(routine: &Routine, size: &dyn Fn(Type) -> u64) -> u64 {
    let mut taken = Taken { size, values: 0, made: 0 };
    let mut most_made = 0;
    visit::statements(&routine.body, &mut |statement| {
        taken.made = 0;
        taken.statement(statement);
        most_made = most_made.max(taken.made);
    });
    let locals = routine.locals.iter().map(|it| rounded(size(it.ty))).fold(0, u64::saturating_add);
    let params = u64::try_from(routine.params.len()).unwrap_or(u64::MAX).saturating_mul(WORD);
    let values = taken.values.min(MOST_VALUES) * WORD;
    [locals, params, most_made, values].into_iter().fold(FIXED, u64::saturating_add)
}

/// Where callees put results that nobody wants.
pub fn of_ignored_results(program: &Program, routine: &Routine, size: &dyn Fn(Type) -> u64) -> u64 {
    let mut most = 0;
    visit::statements(&routine.body, &mut |statement| {
        if let StatementKind::Call { callee, result: None, .. } = &statement.kind {
            let callee = program.routine(*callee);
            let result = callee.result.map_or(0, |id| rounded(size(callee.locals[id.index()].ty)));
            most = most.max(result);
        }
    });
    most
}

fn rounded(size: u64) -> u64 {
    size.checked_next_multiple_of(WORD).unwrap_or(u64::MAX)
}

struct Taken<'a> {
    size: &'a dyn Fn(Type) -> u64,
    /// Values that may be in registers, and so be saved to the frame.
    values: u64,
    /// Bytes of what the statement makes in the frame; later statements use them again.
    made: u64,
}

impl Taken<'_> {
    fn make(&mut self, ty: Type) {
        self.made = self.made.saturating_add(rounded((self.size)(ty)));
    }

    fn statement(&mut self, statement: &Statement) {
        self.values += 1;
        visit::targets(statement, &mut |it| self.place(it));
        match &statement.kind {
            // A constant goes to its target.
            StatementKind::Assign { value, .. } if matches!(value.kind, ExprKind::Aggregate(_)) => {}
            StatementKind::Call { arguments, .. } => arguments.iter().for_each(|it| self.argument(it)),
            StatementKind::External(it) => it.arguments.iter().for_each(|it| self.argument(it)),
            StatementKind::For(_) => {
                // Counter, end and step.
                self.values += 3;
                visit::values(statement, &mut |it| self.expr(it));
            }
            StatementKind::Assign { .. }
            | StatementKind::If { .. }
            | StatementKind::Case { .. }
            | StatementKind::Loop { .. }
            | StatementKind::Try { .. }
            | StatementKind::Finally { .. }
            | StatementKind::Turn
            | StatementKind::Exit
            | StatementKind::Continue
            | StatementKind::Return
            | StatementKind::CallBlock { .. }
            | StatementKind::PrescanBlock { .. }
            | StatementKind::Stop(_)
            | StatementKind::Fault(_) => visit::values(statement, &mut |it| self.expr(it)),
        }
    }

    fn argument(&mut self, argument: &Argument) {
        self.values += 1;
        match argument {
            Argument::Value(value) => self.expr(value),
            Argument::Reference(_) => {}
        }
    }

    fn place(&mut self, place: &Place) {
        self.values += 1;
        for projection in &place.projections {
            match projection {
                Projection::Field(_) => {}
                // The reference, the distance, a value on its way, and the fault of an access.
                Projection::Deref { .. } => {
                    self.values += 4;
                    (0..2).for_each(|_| self.make(Type::Elementary(crate::Elementary::Lword)));
                }
                Projection::Index { index, .. } => {
                    // The distance and the address.
                    self.values += 2;
                    self.expr(index);
                }
            }
        }
    }

    fn expr(&mut self, expr: &Expr) {
        self.values += 1;
        match &expr.kind {
            ExprKind::Const(_) | ExprKind::Text(_) => {}
            ExprKind::Aggregate(_) => self.make(expr.ty),
            ExprKind::Load(place) => {
                self.place(place);
                // What is found through a reference is copied.
                if place.is_followed() {
                    self.make(place.ty);
                }
            }
            ExprKind::AddressOf(place) => self.place(place),
            ExprKind::Apply(op, operands) => {
                operands.iter().for_each(|it| self.expr(it));
                // The runtime's function writes its result to a given address.
                if op.can_fault() {
                    self.make(expr.ty);
                }
            }
            ExprKind::ApplyText(..) | ExprKind::Convert(..) if matches!(expr.ty, Type::String(_)) => self.text(expr),
            ExprKind::ApplyText(_, operands) => operands.iter().for_each(|it| self.expr(it)),
            ExprKind::Convert(_, operand) => self.expr(operand),
        }
    }

    /// A string of its pieces.
    fn text(&mut self, expr: &Expr) {
        for operand in pieces::pieces(expr).iter().flat_map(|it| it.operands()) {
            self.expr(operand);
        }
        let most = u16::try_from(pieces::most(expr)).unwrap_or(u16::MAX);
        let made = expr.ty.string_type().map(|it| it.of_capacity(most.min(it.capacity)));
        made.into_iter().for_each(|it| self.make(Type::String(it)));
    }
}
