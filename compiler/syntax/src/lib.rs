//! Files of each system in, syntax trees and diagnostics out. What a name means is asked elsewhere.
#![forbid(unsafe_code)]

pub mod vendor;

pub mod diagnostic;
pub mod source;
pub mod spelling;

pub mod ast;
pub mod foreign;
pub mod format;
pub mod lex;
pub mod parse;

pub use diagnostic::{Code, Diagnostic};
pub use source::{Source, Sources, Span};
