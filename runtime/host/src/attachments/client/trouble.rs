//! Why a request was not answered.

use std::fmt;

/// Why a request was not answered.
#[derive(Debug)]
pub(super) enum Trouble {
    /// The connection was closed, or the port has gone, before the answer.
    Closed,
    /// Nothing further is to be expected of the connection.
    Failed(String),
    /// The request was not answered; the connection is as good as before.
    Unanswered(String),
    /// What was received is not as it was sent. The connection is as good as before.
    Damaged(String),
    /// The server's code for what is wrong with the request, with what was asked for.
    Refused(String),
}

impl fmt::Display for Trouble {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Closed => f.write_str("the connection was closed"),
            Self::Failed(text) | Self::Unanswered(text) | Self::Damaged(text) | Self::Refused(text) => {
                f.write_str(text)
            }
        }
    }
}
