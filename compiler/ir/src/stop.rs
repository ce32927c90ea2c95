//! Stops: places between statements where an interpreted run can be looked at.

use crate::Expr;

/// The front end makes stops only for a program that is to be debugged.
#[derive(Clone, Debug)]
pub struct Stop {
    /// So many of the routine's locals, from the first, are declared; the others are temporaries.
    pub declared: usize,
    pub asked: Option<Asked>,
}

/// What a stop evaluates. It calls nothing, and changes nothing.
#[derive(Clone, Debug)]
pub struct Asked {
    pub value: Expr,
    /// The run stops here only if the value, a BOOL, is TRUE. Without it, the value is for somebody to see.
    pub is_condition: bool,
}
