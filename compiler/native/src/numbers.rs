//! What indices and assignments say of integer variables, where the code continues.
//!
//! ```text
//! buffer[pos] := x;             IF pos > 31 THEN fault; END_IF
//! pos := (pos + 1) MOD 32;      pos is in 0..31, so that MOD is AND here
//! ```
//!
//! A variable is forgotten with each statement that may write it. A call may write any.

use crate::function::Function;
use crate::target::Aim;
use staunch_ir::alias::{Alias, Frame, alias};
use staunch_ir::interval::Range;
use staunch_ir::loops::running;
use staunch_ir::visit::{self, Access};
use staunch_ir::{ArrayId, Conversion, Expr, ExprKind, Place, Statement, StatementKind};

impl Function<'_, '_> {
    /// An index was found to be within the bounds of an array.
    pub(crate) fn note_index(&mut self, index: &Expr, array: ArrayId) {
        let array = self.module.program.array(array);
        if let Some(place) = self.variable(index) {
            self.note_range(place, (array.low.into(), array.high.into()));
        }
    }

    /// What a statement will have assigned, before it does.
    pub(crate) fn assigned(&self, statement: &Statement) -> Option<Range> {
        let StatementKind::Assign { target, value } = &statement.kind else { return None };
        let whole = self.module.program.repr(target.ty)?.range()?;
        let range = self.known(&|known| known.range(value)).filter(|it| *it != whole)?;
        is_plain(target).then_some(range)
    }

    /// Forgets what a statement may have written, and notes what it has assigned.
    pub(crate) fn note_written(&mut self, statement: &Statement, assigned: Option<Range>) {
        match &statement.kind {
            StatementKind::Assign { .. } | StatementKind::CallBlock { .. } => {
                visit::accesses(statement, &mut |place, access| {
                    if access != Access::Read {
                        self.forget(place);
                    }
                });
            }
            StatementKind::Turn | StatementKind::Stop(_) => {}
            StatementKind::If { .. }
            | StatementKind::Case { .. }
            | StatementKind::Loop { .. }
            | StatementKind::For(_)
            | StatementKind::Try { .. }
            | StatementKind::Finally { .. }
            | StatementKind::Exit
            | StatementKind::Continue
            | StatementKind::Return
            | StatementKind::Call { .. }
            | StatementKind::External(_)
            | StatementKind::PrescanBlock { .. }
            | StatementKind::Fault(_) => self.seen.forget_variables(),
        }
        if let (StatementKind::Assign { target, .. }, Some(range)) = (&statement.kind, assigned) {
            self.note_range(target, range);
        }
        // A debugger writes variables between statements.
        if self.module.aim == Aim::Debugging {
            self.seen.forget_variables();
        }
    }

    /// A variable was written.
    pub(crate) fn forget(&mut self, place: &Place) {
        let frame = Frame::of(self.module.program, self.routine);
        self.seen.keep_ranges(|it| alias(&frame, place, it) == Alias::No);
    }

    /// Counters of loops are known by their loops.
    fn note_range(&mut self, place: &Place, range: Range) {
        if running(&self.counters, place).is_none() {
            self.seen.note_range(self.builder.current_block(), place, range);
        }
    }

    /// The variable whose value an expression is.
    fn variable<'e>(&self, expr: &'e Expr) -> Option<&'e Place> {
        match &expr.kind {
            ExprKind::Load(place) if is_plain(place) => Some(place),
            ExprKind::Convert(Conversion::Value | Conversion::Same, operand) if self.keeps_value(operand, expr) => {
                self.variable(operand)
            }
            _ => None,
        }
    }
}

/// Whether a place is a variable or a member of one, whatever other variables are.
fn is_plain(place: &Place) -> bool {
    !place.is_followed() && place.indices().next().is_none()
}
