//! The sentence of a diagnostic: it is shown and compared as a whole. What follows from a diagnostic is decided by its
//! [`Subject`](super::Subject), so nothing outside of this module can look into the words.

use std::fmt;

#[derive(Clone, PartialEq, Eq, Hash)]
pub struct Sentence(String);

impl Sentence {
    /// For those who lay out the diagnostic.
    pub(super) fn as_str(&self) -> &str {
        &self.0
    }
}

impl<T: Into<String>> From<T> for Sentence {
    fn from(text: T) -> Self {
        Self(text.into())
    }
}

impl fmt::Display for Sentence {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl fmt::Debug for Sentence {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Debug::fmt(&self.0, f)
    }
}
