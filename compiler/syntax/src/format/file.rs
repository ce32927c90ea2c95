//! Whole files: their encoding stays, and of TwinCAT's the XML around the text.

use super::style::Style;
use super::text::{part, whole};
use crate::source::Source;
use crate::vendor;

/// Why a file is not laid out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Refusal {
    /// It is another system's, whose editor lays it out.
    Foreign,
    /// It is not well-formed XML.
    Broken,
    /// It has bytes that are not UTF-8.
    Encoding,
    /// Its tokens would change, which is a mistake of the formatter.
    Internal,
}

impl Refusal {
    /// As the end of a sentence that begins with the file's name.
    pub const fn text(self) -> &'static str {
        match self {
            Self::Foreign => "this file of another system is not laid out: only files of text and TwinCAT's are",
            Self::Broken => "this file of TwinCAT is not well-formed XML",
            Self::Encoding => "this file has bytes that are not characters",
            Self::Internal => "the formatter would change what this file says; this is a bug in Staunch",
        }
    }
}

/// A file, laid out.
pub fn bytes(path: &str, bytes: &[u8], style: &Style) -> Result<Vec<u8>, Refusal> {
    let file = Source::decoded(path, bytes);
    if file.encode(&file.text, bytes).as_deref() != Some(bytes) {
        return Err(Refusal::Encoding);
    }
    let text = match vendor::texts_of_twincat(&file.text) {
        Some(texts) => pieces(&file.text, &texts, style)?,
        None if vendor::is_twincat_name(path) => return Err(Refusal::Broken),
        None if vendor::is_of_other_editor(path, &file.text) => return Err(Refusal::Foreign),
        None => whole(&file.text, style).ok_or(Refusal::Internal)?,
    };
    file.encode(&text, bytes).ok_or(Refusal::Encoding)
}

/// A file whose texts are laid out each by itself.
fn pieces(file: &str, texts: &[core::ops::Range<usize>], style: &Style) -> Result<String, Refusal> {
    let mut result = String::with_capacity(file.len());
    let mut end = 0;
    for text in texts {
        result += &file[end..text.start];
        result += &part(&file[text.clone()], style).ok_or(Refusal::Internal)?;
        end = text.end;
    }
    Ok(result + &file[end..])
}
