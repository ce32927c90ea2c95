//! Layout of Structured Text: of its tokens, with comments and pragmas, so that files with mistakes are laid out, too.
//!
//! What is on lines of its own stays there: nothing is joined. Indentation is by blocks and brackets, spaces by the two tokens
//! they are between.

mod blocks;
mod columns;
mod file;
mod indent;
mod lines;
mod long;
mod print;
mod roles;
mod spacing;
mod style;
mod text;
mod token;
mod words;

pub use file::{Refusal, bytes};
pub use style::{Indent, Letters, Style};
pub use text::{block_ranges, part, whole};

#[cfg(test)]
mod tests;
