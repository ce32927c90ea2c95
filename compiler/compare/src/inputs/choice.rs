//! The values of one input that are tried, and why the others would show nothing else.

use staunch_ir::Value;

/// The values of an input that are tried, the initial one first.
#[derive(Clone, Debug)]
pub struct Choice {
    pub values: Vec<Value>,
    /// Why the values that are not tried would show nothing else; `None` where they might.
    pub covered: Option<Covered>,
    /// The whole numbers that the type, or its subrange, has.
    pub range: Option<(i128, i128)>,
    /// What all of them are multiples of.
    pub step: i128,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Covered {
    /// Every value is tried.
    All,
    /// The program compares it with constants alone, and values on every side of each are tried.
    Compared,
    /// Nothing reads it.
    Unread,
}
