//! What the server answers: a program, and a place in it, in; values of the protocol out.

pub mod actions;
pub mod complete;
pub mod declare;
pub mod describe;
pub mod dialects;
pub mod folds;
pub mod hierarchy;
pub mod hints;
pub mod layout;
pub mod lenses;
pub mod navigate;
pub mod problems;
pub mod rename;
pub mod select;
pub mod signature;
pub mod symbols;
pub mod tokens;
