//! A printed expression and how tightly it binds, so that only needed parentheses are written.

use proc_macro2::TokenStream;
use quote::quote;

/// From loose to tight, as Rust has it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Level {
    /// A block or closure: never an operand as it is.
    Block,
    LazyOr,
    LazyAnd,
    Compare,
    Or,
    Xor,
    And,
    Shift,
    Sum,
    Product,
    Unary,
    Postfix,
}

#[derive(Clone, Debug)]
pub struct Code {
    pub tokens: TokenStream,
    pub level: Level,
}

impl Code {
    pub fn new(tokens: TokenStream, level: Level) -> Self {
        Self { tokens, level }
    }

    /// A literal, path, call, field or element.
    pub fn postfix(tokens: TokenStream) -> Self {
        Self::new(tokens, Level::Postfix)
    }

    /// The expression as an operand that must bind at least as tightly as `level`.
    pub fn at_least(self, level: Level) -> TokenStream {
        let tokens = self.tokens;
        if self.level < level { quote!((#tokens)) } else { tokens }
    }

    /// The expression as an operand that must bind more tightly than `level`.
    pub fn above(self, level: Level) -> TokenStream {
        let tokens = self.tokens;
        if self.level <= level { quote!((#tokens)) } else { tokens }
    }
}
