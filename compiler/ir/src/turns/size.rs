//! About how many operations a loop's body is, so that a back end knows how many copies of it are worth while.

use crate::{ExprKind, Projection, Statement, StatementKind, visit};

/// A loop within, or a reference that is followed.
const LARGE: usize = 32;
const CALL: usize = 16;
const TEXT: usize = 8;

/// About how many operations the statements are.
pub(super) fn size(block: &[Statement]) -> usize {
    let mut size = 0;
    visit::statements(block, &mut |statement| {
        size += match &statement.kind {
            StatementKind::Turn | StatementKind::Stop(_) => 0,
            StatementKind::For(_) | StatementKind::Loop { .. } => LARGE,
            StatementKind::Call { .. }
            | StatementKind::External(_)
            | StatementKind::CallBlock { .. }
            | StatementKind::PrescanBlock { .. }
            | StatementKind::Try { .. } => CALL,
            StatementKind::Assign { .. }
            | StatementKind::If { .. }
            | StatementKind::Case { .. }
            | StatementKind::Finally { .. }
            | StatementKind::Exit
            | StatementKind::Continue
            | StatementKind::Return
            | StatementKind::Fault(_) => 1,
        };
        visit::targets(statement, &mut |it| size += of_projections(&it.projections));
        visit::all_exprs(statement, &mut |it| {
            size += match &it.kind {
                ExprKind::Const(_) => 0,
                ExprKind::Load(place) => 1 + of_projections(&place.projections),
                ExprKind::Apply(..) | ExprKind::Convert(..) => 1,
                ExprKind::Text(_) | ExprKind::AddressOf(_) | ExprKind::ApplyText(..) | ExprKind::Aggregate(_) => TEXT,
            }
        });
    });
    size
}

/// An index is checked, and multiplied.
fn of_projections(projections: &[Projection]) -> usize {
    let of = |it: &Projection| match it {
        Projection::Field(_) => 0,
        Projection::Index { .. } => 4,
        Projection::Deref { .. } => LARGE,
    };
    projections.iter().map(of).sum()
}
