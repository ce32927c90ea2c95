//! Places in documents: an editor counts lines from 0, and in a line the words of UTF-16.

use gen_lsp_types::{Position, Range};
use staunch_frontend::{Source, Span};

/// A byte of a source's text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place {
    pub file: u16,
    pub offset: u32,
}

/// Where a byte of a document is.
pub fn position(document: &Source, offset: u32) -> Position {
    let line = document.line(offset);
    let range = document.line_range(line);
    let end = usize::try_from(offset).unwrap_or(usize::MAX).clamp(range.start, range.end.max(range.start));
    let before = document.text.get(range.start..end).unwrap_or_default();
    Position { line: line.saturating_sub(1), character: count(before.encode_utf16().count()) }
}

/// The byte of a document at a position; a position after the end of a line is that end.
pub fn offset(document: &Source, position: Position) -> u32 {
    let range = document.line_range(position.line.saturating_add(1));
    let mut words = 0;
    for (at, character) in document.text.get(range.clone()).unwrap_or_default().char_indices() {
        if words >= position.character {
            return count(range.start + at);
        }
        words += count(character.len_utf16());
    }
    count(range.end)
}

/// Where a part of a text is in its document.
pub fn range(source: &Source, span: Span) -> Range {
    let (document, span) = (source.file(), source.in_file(span));
    Range { start: position(document, span.start), end: position(document, span.end) }
}

pub fn count(number: usize) -> u32 {
    u32::try_from(number).unwrap_or(u32::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_words_of_utf_16() {
        let document = Source::new("x.st", "a := 'ü😀';\r\nb".to_owned());
        let at = |character| Position { line: 0, character };
        assert_eq!(offset(&document, at(6)), 6);
        assert_eq!(offset(&document, at(7)), 8);
        assert_eq!(offset(&document, at(9)), 12);
        assert_eq!(position(&document, 12), at(9));
        assert_eq!(position(&document, 16), Position { line: 1, character: 0 });
        assert_eq!(offset(&document, at(99)), 14, "the end of the line, without its break");
        assert_eq!(offset(&document, Position { line: 7, character: 3 }), 17);
    }
}
