//! Source files, and positions in them.

use staunch_runtime::Location;

/// Bytes `start..end` of file number `file`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Span {
    pub file: u16,
    pub start: u32,
    pub end: u32,
}

impl Span {
    /// From the start of `self` to the end of `other`.
    #[must_use]
    pub fn to(self, other: Self) -> Self {
        Self { file: self.file, start: self.start, end: other.end }
    }
}

/// One file's text, decoded to UTF-8.
#[derive(Clone, Debug)]
pub struct Source {
    /// As the user named it.
    pub path: String,
    pub text: String,
    /// Byte offset at which each line starts.
    lines: Vec<u32>,
    /// Whether each character is one byte.
    ascii: bool,
}

/// All files of one compilation; `Span::file` counts them.
#[derive(Clone, Debug, Default)]
pub struct Sources {
    files: Vec<Source>,
}

impl Source {
    pub fn new(path: impl Into<String>, text: String) -> Self {
        let starts = text.match_indices('\n');
        let lines =
            core::iter::once(0).chain(starts.map(|(at, _)| u32::try_from(at + 1).unwrap_or(u32::MAX))).collect();
        let ascii = text.is_ascii();
        Self { path: path.into(), text, lines, ascii }
    }

    /// UTF-8, with or without a byte order mark; any other text is read as Windows-1252.
    pub fn decode(path: impl Into<String>, bytes: &[u8]) -> Self {
        let bytes = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes);
        let text = match core::str::from_utf8(bytes) {
            Ok(text) => text.to_owned(),
            Err(_) => bytes.iter().map(|it| windows_1252(*it)).collect(),
        };
        Self::new(path, text)
    }

    /// Where a 1-based line starts and ends, without its line break; an empty range for a line
    /// that does not exist.
    pub fn line_range(&self, line: u32) -> core::ops::Range<usize> {
        let at = |line: u32| {
            let start = usize::try_from(line).ok().and_then(|it| self.lines.get(it));
            start.map_or(self.text.len(), |it| usize::try_from(*it).unwrap_or(usize::MAX))
        };
        let (start, end) = (at(line.saturating_sub(1)), at(line));
        start..start + self.text[start..end].trim_end_matches(['\r', '\n']).len()
    }

    /// The bytes of a 1-based line, its line end included.
    pub fn line_bounds(&self, line: u32) -> (u32, u32) {
        let at = usize::try_from(line).unwrap_or(usize::MAX).saturating_sub(1);
        let start = self.lines.get(at).copied().unwrap_or(0);
        let end = self.lines.get(at + 1).copied();
        (start, end.unwrap_or_else(|| u32::try_from(self.text.len() + 1).unwrap_or(u32::MAX)))
    }

    pub fn is_ascii(&self) -> bool {
        self.ascii
    }

    /// The 1-based line of a byte.
    pub fn line(&self, offset: u32) -> u32 {
        u32::try_from(self.lines.partition_point(|start| *start <= offset).max(1)).unwrap_or(u32::MAX)
    }

    /// 1-based line, and 1-based column in characters.
    pub fn line_column(&self, offset: u32) -> (u32, u32) {
        let line = self.lines.partition_point(|start| *start <= offset).max(1);
        let start = usize::try_from(self.lines[line - 1]).unwrap_or(usize::MAX);
        let offset = usize::try_from(offset).unwrap_or(usize::MAX).min(self.text.len());
        let before = self.text.get(start.min(offset)..offset).unwrap_or_default();
        let column = before.chars().count() + 1;
        (u32::try_from(line).unwrap_or(u32::MAX), u32::try_from(column).unwrap_or(u32::MAX))
    }
}

/// A byte of Windows-1252; the five that it leaves open stay control characters, as browsers do.
fn windows_1252(byte: u8) -> char {
    const UPPER: [char; 32] = [
        '€', '\u{81}', '‚', 'ƒ', '„', '…', '†', '‡', 'ˆ', '‰', 'Š', '‹', 'Œ', '\u{8d}', 'Ž', '\u{8f}', '\u{90}', '‘',
        '’', '“', '”', '•', '–', '—', '˜', '™', 'š', '›', 'œ', '\u{9d}', 'ž', 'Ÿ',
    ];
    match byte {
        0x80..=0x9f => UPPER[usize::from(byte - 0x80)],
        _ => char::from(byte),
    }
}

impl Sources {
    /// Adds a file; its number is its position.
    pub fn add(&mut self, source: Source) {
        self.files.push(source);
    }

    pub fn files(&self) -> &[Source] {
        &self.files
    }

    pub fn get(&self, file: u16) -> &Source {
        &self.files[usize::from(file)]
    }

    pub fn text(&self, span: Span) -> &str {
        let text = &self.get(span.file).text;
        let (start, end) = (usize::try_from(span.start), usize::try_from(span.end));
        let range = start.unwrap_or(usize::MAX)..end.unwrap_or(usize::MAX);
        text.get(range).unwrap_or_default()
    }

    pub fn location(&self, span: Span) -> Location {
        let (line, column) = self.get(span.file).line_column(span.start);
        Location { file: span.file, line, column: u16::try_from(column).unwrap_or(u16::MAX) }
    }
}
