//! How a text is laid out: what people choose.

/// How a text is laid out.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Style {
    pub indent: Indent,
    /// Columns of a line, without the comment at its end.
    pub width: usize,
    pub keywords: Letters,
    /// What is in a POU is indented.
    pub indents_pous: bool,
}

impl Default for Style {
    fn default() -> Self {
        Self { indent: Indent::Spaces(4), width: 100, keywords: Letters::Upper, indents_pous: false }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Indent {
    Spaces(u8),
    /// Counts as four columns.
    Tab,
}

impl Indent {
    pub fn width(self) -> usize {
        match self {
            Self::Spaces(count) => count.into(),
            Self::Tab => 4,
        }
    }
}

/// The letters of keywords.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Letters {
    Upper,
    Lower,
    AsWritten,
}
