//! A language server for Structured Text: messages in, messages out. What the files of a project are, and what is in them, is asked of
//! a [`Host`].
#![forbid(unsafe_code)]

mod calls;
mod place;
mod uri;

mod host;
mod project;
mod results;

mod answers;

mod server;

pub use host::{Choice, Host, TestResult, Unit, Work};
pub use lsp_server::Connection;
pub use server::serve;
