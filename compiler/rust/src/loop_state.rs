//! What the loops around a statement have: labels, turns that are taken, subscripts that are found.

use proc_macro2::{Ident, TokenStream};
use staunch_ir::Place;

/// The labels of the loops around a statement, innermost last.
#[derive(Debug, Default)]
pub struct Loops {
    pub around: Vec<Labels>,
    pub made: usize,
    /// Of the innermost loop: the variable that says that it has few turns, which it need not take.
    pub few: Option<Ident>,
    /// How many operations the turns come to that are taken at once.
    pub copied: usize,
}

#[derive(Clone, Debug)]
pub struct Labels {
    /// `Exit` inside of the body.
    pub leave: TokenStream,
    /// `Continue`.
    pub next: TokenStream,
    /// Before the loop, where something names it.
    pub label: Option<TokenStream>,
    /// Of the block around the body.
    pub body: Option<TokenStream>,
}

/// A counter's position in arrays of certain bounds.
#[derive(Clone, Debug)]
pub struct HoistedIndex {
    pub counter: Place,
    pub low: i64,
    pub high: i64,
    pub name: Ident,
}
