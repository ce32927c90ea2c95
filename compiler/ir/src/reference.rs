//! References: which variables' addresses a program takes, how a place leads through a reference, and the
//! table of objects by which every access is checked.

mod addresses;
pub mod escape;
mod fixed;
mod followed;
mod objects;
mod table;
mod targets;

pub use addresses::{addressable, reach, reached};
pub use fixed::fixed;
pub use followed::{Followed, followed, looked_up};
pub use objects::objects;
pub use table::{table, view, wanted};
pub use targets::{Step, Target, Targets};

use crate::{Expr, ExprKind, Type};

/// Whether the expression is null, as a constant.
pub fn is_null(expr: &Expr) -> bool {
    matches!((&expr.kind, expr.ty), (ExprKind::Const(crate::Value::U64(0)), Type::Reference(_)))
}
