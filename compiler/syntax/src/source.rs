//! Source files, and positions in them. A text may be made of pieces of a file: what it says of places is said
//! of the file.

mod habits;

use crate::vendor::{self, Assembly, Device, Piece, Problem, Reference};
use core::sync::atomic::{AtomicUsize, Ordering};
use staunch_runtime::Location;

pub use habits::{Comments, Habits};

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
    /// The line that was asked for last.
    line: Hint,
    /// The characters that start before each [`CHUNK`] of bytes; empty where each is one byte.
    characters: Vec<u32>,
    encoding: Encoding,
    origin: Option<Box<Origin>>,
    /// Of a library: its name.
    library: Option<Box<str>>,
    /// It is a part of the compiler, whatever its path is.
    is_bundled: bool,
    /// Of what has no body in it, nothing says what it does.
    only_declares: bool,
    /// It is one expression, which is asked about the program, and nothing of the program.
    is_expression: bool,
}

/// The file that a text is made of.
#[derive(Clone, Debug)]
struct Origin {
    file: Source,
    pieces: Vec<Piece>,
    /// The piece that was asked for last.
    piece: Hint,
    problems: Vec<Problem>,
    device: Option<Device>,
}

/// Where something was found in a list that is in order. The next question is most often about the same place, or the next.
#[derive(Debug, Default)]
struct Hint(AtomicUsize);

impl Clone for Hint {
    fn clone(&self) -> Self {
        Self::default()
    }
}

impl Hint {
    /// How many of the items start at an offset or before it.
    fn started<T>(&self, items: &[T], offset: u32, start: impl Fn(&T) -> u32) -> usize {
        let is_it = |count: &usize| {
            let last = count.checked_sub(1).and_then(|it| items.get(it));
            last.is_some_and(|it| start(it) <= offset) && items.get(*count).is_none_or(|it| offset < start(it))
        };
        let known = self.0.load(Ordering::Relaxed);
        let near = [known, known + 1].into_iter().find(is_it);
        let found = near.unwrap_or_else(|| items.partition_point(|it| start(it) <= offset));
        if found != known {
            self.0.store(found, Ordering::Relaxed);
        }
        found
    }
}

/// How a file's bytes hold its text.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Encoding {
    /// Bytes of the byte order mark, which is not part of the text.
    mark: u32,
    units: Units,
}

/// What the characters are made of in the file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Units {
    #[default]
    Utf8,
    /// Each character is one byte.
    Windows1252,
    /// Each character is one or two words.
    Utf16,
}

/// Bytes of a text between two counts of its characters: a column is then found at once in a line
/// of any length.
const CHUNK: usize = 1024;
/// The byte order mark of UTF-8.
const MARK: &[u8] = b"\xEF\xBB\xBF";

/// All files of one compilation; `Span::file` counts them.
#[derive(Clone, Debug, Default)]
pub struct Sources {
    files: Vec<Source>,
    /// The libraries that a project of TwinCAT's refers to.
    references: Vec<Reference>,
    /// What it defines for the conditional compilation of its own files.
    defined: Vec<String>,
    /// Its name.
    project: Option<String>,
    /// What a project of OpenPLC Editor says of its device.
    device: Option<Device>,
    /// One of the files is a list of B&R's Automation Studio.
    is_of_studio: bool,
}

impl Source {
    pub fn new(path: impl Into<String>, text: String) -> Self {
        let starts = text.match_indices('\n');
        let lines =
            core::iter::once(0).chain(starts.map(|(at, _)| u32::try_from(at + 1).unwrap_or(u32::MAX))).collect();
        let characters = if text.is_ascii() { Vec::new() } else { counted(text.as_bytes()) };
        let (encoding, line) = (Encoding::default(), Hint::default());
        Self {
            path: path.into(),
            text,
            lines,
            line,
            characters,
            encoding,
            origin: None,
            library: None,
            is_bundled: false,
            only_declares: false,
            is_expression: false,
        }
    }

    /// An expression that is asked about a program: what is said of it has this name.
    pub fn expression(name: impl Into<String>, text: String) -> Self {
        Self { is_expression: true, ..Self::new(name, text) }
    }

    pub fn is_expression(&self) -> bool {
        self.is_expression
    }

    /// The same with spaces in place of parts of its text; all else is where it was.
    #[must_use]
    pub fn blanked(&self, parts: impl Iterator<Item = Span>) -> Self {
        let offset = |it: u32| usize::try_from(it).unwrap_or(usize::MAX);
        let mut bytes = self.text.clone().into_bytes();
        for span in parts {
            let part = bytes.get_mut(offset(span.start)..offset(span.end)).into_iter().flatten();
            part.filter(|it| !matches!(it, b'\n' | b'\r')).for_each(|it| *it = b' ');
        }
        let text = String::from_utf8(bytes).unwrap_or_default();
        let characters = if text.is_ascii() { Vec::new() } else { counted(text.as_bytes()) };
        Self { text, characters, ..self.clone() }
    }

    /// The Structured Text in a file, also in one of another system's.
    pub fn decode(path: impl Into<String>, bytes: &[u8]) -> Self {
        let file = Self::decoded(path, bytes);
        match vendor::read_named(&file.path, &file.text) {
            Some(Assembly { text, pieces, problems, device }) => {
                let path = file.path.clone();
                Self {
                    origin: Some(Box::new(Origin { file, pieces, piece: Hint::default(), problems, device })),
                    ..Self::new(path, text)
                }
            }
            None if vendor::is_twincat_name(&file.path) && file.text.trim().is_empty() => {
                Self::without_text(file.path, vendor::Trouble::Odd, |name| format!("`{name}` is empty"))
            }
            None => file,
        }
    }

    /// A file that a project lists, and that is not there.
    pub fn absent(path: impl Into<String>) -> Self {
        let message = |name: &str| format!("the project lists `{name}`, but the file does not exist");
        Self::without_text(path, vendor::Trouble::Absent, message)
    }

    fn without_text(path: impl Into<String>, trouble: vendor::Trouble, message: impl Fn(&str) -> String) -> Self {
        let file = Self::new(path, "\n".to_owned());
        let message = message(file.path.rsplit(['/', '\\']).next().unwrap_or_default());
        let problems = vec![Problem { at: 0, trouble, message, help: None }];
        let pieces = vec![Piece { start: 0, at: 0, end: 1, verbatim: true }];
        let origin = Origin { file: file.clone(), pieces, piece: Hint::default(), problems, device: None };
        Self { origin: Some(Box::new(origin)), ..file }
    }

    /// Whether a file is the `project.json` of a project of OpenPLC Editor: it says so of itself.
    pub fn is_openplc_project(file: &[u8]) -> bool {
        vendor::is_openplc_project(&Self::decoded("", file).text)
    }

    /// The files that a project of TwinCAT's lists, as it writes them.
    pub fn listed(project: &[u8]) -> Result<Vec<String>, String> {
        vendor::listed(&Self::decoded("", project).text)
    }

    /// The libraries that a PLC project of TwinCAT's refers to.
    pub fn references(project: &[u8]) -> Vec<Reference> {
        vendor::references(&Self::decoded("", project).text)
    }

    /// What a PLC project of TwinCAT's defines for conditional compilation.
    pub fn definitions(project: &[u8]) -> Vec<String> {
        vendor::definitions(&Self::decoded("", project).text)
    }

    /// The name of a PLC project of TwinCAT's.
    pub fn project_name(project: &[u8]) -> Option<String> {
        vendor::project_name(&Self::decoded("", project).text)
    }

    /// The name by which others refer to a PLC project of TwinCAT's as a library, where it has one.
    pub fn project_title(project: &[u8]) -> Option<String> {
        vendor::project_title(&Self::decoded("", project).text)
    }

    /// The same, as one of a library, which a project uses and which is not its own.
    #[must_use]
    pub fn of_library(self, name: &str) -> Self {
        Self { library: Some(name.into()), ..self }
    }

    /// The same, as a unit of the library that the compiler brings along.
    #[must_use]
    pub fn bundled(self) -> Self {
        Self { is_bundled: true, ..self }
    }

    /// The same, of a vendor's library: what has no body there needs the machine.
    #[must_use]
    pub fn declarations(self) -> Self {
        Self { is_bundled: true, only_declares: true, ..self }
    }

    pub fn only_declares(&self) -> bool {
        self.only_declares
    }

    pub fn is_bundled(&self) -> bool {
        self.is_bundled
    }

    /// Whether it is that unit of the library, and not a file of the user's with its path.
    pub fn is_unit(&self, path: &str) -> bool {
        self.is_bundled && self.path == path
    }

    pub fn is_of_library(&self) -> bool {
        self.library.is_some()
    }

    /// The name of the library that it is of.
    pub fn library(&self) -> Option<&str> {
        self.library.as_deref()
    }

    /// The file as it is, where the text is made of pieces of it.
    pub fn file(&self) -> &Self {
        self.origin.as_ref().map_or(self, |it| &it.file)
    }

    /// What is wrong with the file.
    pub fn problems(&self) -> &[Problem] {
        self.origin.as_ref().map_or(&[], |it| &it.problems)
    }

    /// A part of the text as a part of the file.
    pub fn in_file(&self, span: Span) -> Span {
        let Some(origin) = &self.origin else { return span };
        let start = origin.place(span.start, false);
        let end = if span.end > span.start { origin.place(span.end - 1, true) } else { start };
        Span { start, end: end.max(start), ..span }
    }

    /// Whether what is at a part of the text can be replaced in the file.
    pub fn is_verbatim(&self, span: Span) -> bool {
        self.origin.as_ref().is_none_or(|it| {
            let (first, last) = (it.piece(span.start), it.piece(span.end));
            first == last && first.is_some_and(|it| it.verbatim)
        })
    }

    /// Where a byte of the file is in the text.
    pub fn in_text(&self, offset: u32) -> Option<u32> {
        let Some(origin) = &self.origin else { return Some(offset) };
        let holds = |it: &&Piece| it.verbatim && (it.at..it.end).contains(&offset);
        origin.pieces.iter().find(holds).map(|it| it.start + (offset - it.at))
    }

    /// UTF-8 or UTF-16, with or without a byte order mark; any other text is read as Windows-1252.
    pub(crate) fn decoded(path: impl Into<String>, bytes: &[u8]) -> Self {
        if let Some((mark, text)) = utf16(bytes) {
            return Self { encoding: Encoding { mark, units: Units::Utf16 }, ..Self::new(path, text) };
        }
        let (mark, bytes) = bytes.strip_prefix(MARK).map_or((0, bytes), |it| (3, it));
        let (units, text) = match core::str::from_utf8(bytes) {
            Ok(text) => (Units::Utf8, text.to_owned()),
            Err(_) => (Units::Windows1252, bytes.iter().map(|it| windows_1252(*it)).collect()),
        };
        Self { encoding: Encoding { mark, units }, ..Self::new(path, text) }
    }

    /// A text in the encoding of this file, whose bytes are given; `None` where it has characters that cannot be written so.
    pub(crate) fn encode(&self, text: &str, file: &[u8]) -> Option<Vec<u8>> {
        let mark = file.get(..usize::try_from(self.encoding.mark).ok()?)?;
        let is_big = file.first().is_some_and(|it| matches!(it, 0xFE | 0));
        let units = match self.encoding.units {
            Units::Utf8 => text.as_bytes().to_vec(),
            Units::Windows1252 => text.chars().map(windows_1252_byte).collect::<Option<_>>()?,
            Units::Utf16 if is_big => text.encode_utf16().flat_map(u16::to_be_bytes).collect(),
            Units::Utf16 => text.encode_utf16().flat_map(u16::to_le_bytes).collect(),
        };
        Some([mark, &units].concat())
    }

    /// Where a byte of the text is in the file as it was read.
    pub fn file_offset(&self, offset: u32) -> u32 {
        let before = match self.encoding.units {
            Units::Utf8 => offset,
            Units::Windows1252 => self.characters_before(offset),
            Units::Utf16 => {
                let text = self.text.get(..usize::try_from(offset).unwrap_or(usize::MAX)).unwrap_or(&self.text);
                u32::try_from(2 * text.encode_utf16().count()).unwrap_or(u32::MAX)
            }
        };
        self.encoding.mark + before
    }

    /// The characters that start before a byte of the text.
    fn characters_before(&self, offset: u32) -> u32 {
        let end = usize::try_from(offset).unwrap_or(usize::MAX).min(self.text.len());
        let chunk = end / CHUNK;
        match self.characters.get(chunk) {
            Some(before) => before + starts(&self.text.as_bytes()[chunk * CHUNK..end]),
            None => u32::try_from(end).unwrap_or(u32::MAX),
        }
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

    /// The statement at a place, as far as it is on its first line.
    pub fn statement_at(&self, at: Location) -> Span {
        let range = self.line_range(at.line);
        let line = self.text.get(range.clone()).unwrap_or_default();
        let before = usize::from(at.column.saturating_sub(1));
        let start = line.char_indices().nth(before).map_or(line.len(), |it| it.0);
        let rest = &line[start..];
        let length = rest.find(';').map_or(rest.trim_end().len(), |it| it + 1);
        let offset = |at: usize| u32::try_from(range.start + at).unwrap_or(u32::MAX);
        Span { file: at.file, start: offset(start), end: offset(start + length) }
    }

    /// The bytes of a 1-based line of the text, its line end included.
    pub fn line_bounds(&self, line: u32) -> (u32, u32) {
        let at = usize::try_from(line).unwrap_or(usize::MAX).saturating_sub(1);
        let start = self.lines.get(at).copied().unwrap_or(0);
        let end = self.lines.get(at + 1).copied();
        (start, end.unwrap_or_else(|| u32::try_from(self.text.len() + 1).unwrap_or(u32::MAX)))
    }

    /// Whether columns are counted in bytes of the text.
    pub fn is_ascii(&self) -> bool {
        self.characters.is_empty()
    }

    /// Whether the text is made of pieces.
    pub fn is_assembled(&self) -> bool {
        self.origin.is_some()
    }

    /// The 1-based line of a byte.
    pub fn line(&self, offset: u32) -> u32 {
        if let Some(origin) = &self.origin {
            return origin.file.line(origin.place(offset, false));
        }
        u32::try_from(self.lines.partition_point(|start| *start <= offset).max(1)).unwrap_or(u32::MAX)
    }

    /// 1-based line, and 1-based column in characters.
    pub fn line_column(&self, offset: u32) -> (u32, u32) {
        if let Some(origin) = &self.origin {
            return origin.file.line_column(origin.place(offset, false));
        }
        let line = self.line.started(&self.lines, offset, |it| *it).max(1);
        let column = self.characters_before(offset) - self.characters_before(self.lines[line - 1]) + 1;
        (u32::try_from(line).unwrap_or(u32::MAX), column)
    }
}

impl Origin {
    /// The piece that a byte of the text is in.
    fn piece(&self, offset: u32) -> Option<Piece> {
        let after = self.piece.started(&self.pieces, offset, |it| it.start);
        self.pieces.get(after.checked_sub(1)?).copied()
    }

    /// Where in the file a byte of the text begins, or ends.
    fn place(&self, offset: u32, end: bool) -> u32 {
        match self.piece(offset) {
            Some(it) if it.verbatim => it.end.min(it.at + (offset - it.start) + u32::from(end)),
            Some(it) if end => it.end,
            Some(it) => it.at,
            None => 0,
        }
    }
}

/// The length of the byte order mark, and the text, of UTF-16. Without a mark it is known by its zeros: a
/// program starts with ASCII.
fn utf16(bytes: &[u8]) -> Option<(u32, String)> {
    let word: fn([u8; 2]) -> u16 = match bytes {
        [0xFF, 0xFE, ..] | [1..=0x7F, 0, 1..=0x7F, 0, ..] => u16::from_le_bytes,
        [0xFE, 0xFF, ..] | [0, 1..=0x7F, 0, 1..=0x7F, ..] => u16::from_be_bytes,
        _ => return None,
    };
    let mark = if matches!(bytes, [0xFE | 0xFF, ..]) { 2 } else { 0 };
    let words = bytes[mark..].as_chunks::<2>().0.iter().map(|it| word(*it));
    let text = char::decode_utf16(words).map(|it| it.unwrap_or(char::REPLACEMENT_CHARACTER)).collect();
    Some((u32::try_from(mark).unwrap_or(0), text))
}

/// The characters that start before each chunk of a text.
fn counted(text: &[u8]) -> Vec<u32> {
    let mut before = 0;
    let count = |chunk: &[u8]| {
        before += starts(chunk);
        before
    };
    core::iter::once(0).chain(text.chunks(CHUNK).map(count)).collect()
}

/// The bytes that start a character.
fn starts(bytes: &[u8]) -> u32 {
    let count = bytes.iter().filter(|it| **it & 0b1100_0000 != 0b1000_0000).count();
    u32::try_from(count).unwrap_or(u32::MAX)
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

/// The byte of a character in Windows-1252.
fn windows_1252_byte(character: char) -> Option<u8> {
    (0..=u8::MAX).find(|it| windows_1252(*it) == character)
}

impl Sources {
    /// Adds what a project refers to.
    pub fn refer(&mut self, references: impl IntoIterator<Item = Reference>) {
        self.references.extend(references);
    }

    /// Adds what a project defines for conditional compilation.
    pub fn define(&mut self, names: impl IntoIterator<Item = String>) {
        self.defined.extend(names);
    }

    /// What is defined before a file begins. A library does not see what a project defines.
    pub fn defined(&self, source: &Source) -> &[String] {
        if source.is_of_library() { &[] } else { &self.defined }
    }

    /// What is known of a file before it is read.
    pub fn habits(&self, source: &Source) -> Habits<'_> {
        let is_of_studio = !source.is_bundled && self.is_of_automation_studio();
        Habits {
            defined: self.defined(source),
            comments: if is_of_studio { Comments::Plain } else { Comments::Nested },
            is_of_studio,
        }
    }

    /// Whether the files are those of a program of B&R's Automation Studio: no other system has files that are called as its lists are.
    pub const fn is_of_automation_studio(&self) -> bool {
        self.is_of_studio
    }

    /// The device of a project of OpenPLC Editor, where the files are of one.
    pub const fn device(&self) -> Option<&Device> {
        self.device.as_ref()
    }

    /// The name of the dialect that a project among the files is compiled by, unless the user names another.
    pub fn dialect(&self) -> Option<&'static str> {
        self.device.as_ref().map(Device::dialect)
    }

    /// Takes the name of the project; the first one counts.
    pub fn name_project(&mut self, name: Option<String>) {
        self.project = self.project.take().or(name);
    }

    /// The name of the project that the files are of.
    pub fn project(&self) -> Option<&str> {
        self.project.as_deref()
    }

    pub fn references(&self) -> &[Reference] {
        &self.references
    }

    /// What the project defines.
    pub fn definitions(&self) -> &[String] {
        &self.defined
    }

    /// The same files and project, with these texts in place of theirs.
    #[must_use]
    pub fn with_texts(&self, texts: Vec<String>) -> Self {
        let files = self.files.iter().zip(texts);
        let files =
            files.map(|(it, text)| Source { library: it.library.clone(), ..Source::new(it.path.clone(), text) });
        Self { files: files.collect(), ..self.clone() }
    }

    /// The program's own files as one of plain text, each below a line that names it where there are several; libraries stay
    /// as they are. What a project defines for its files, and what it says of its device, is not a part of that. The text
    /// begins with the `dialect` where none of the files names one.
    #[must_use]
    pub fn as_one_file(&self, path: &str, dialect: Option<&str>) -> Self {
        let (own, others): (Vec<_>, Vec<_>) = self.files.iter().partition(|it| !it.is_of_library());
        let mut text = String::new();
        let mut dialects = Vec::new();
        for file in &own {
            // The files of a system name its dialect each in their first line; one file does it once.
            let first = file.text.lines().next().filter(|it| it.starts_with("{dialect "));
            let is_said = first.is_some_and(|it| dialects.contains(&it));
            dialects.extend(first);
            if own.len() > 1 {
                let gap = if text.is_empty() { "" } else { "\n" };
                text += &format!("{gap}// {}\n", file.path);
            }
            text += if is_said { file.text.split_once('\n').map_or("", |it| it.1) } else { &file.text };
            if !text.ends_with('\n') {
                text.push('\n');
            }
        }
        let unsaid = dialect.filter(|_| !own.iter().any(|it| it.text.contains("{dialect ")));
        let text = unsaid.map(|it| format!("{{dialect '{it}'}}\n")).unwrap_or_default() + &text;
        let files = core::iter::once(Source::new(path, text)).chain(others.into_iter().cloned());
        Self { files: files.collect(), defined: Vec::new(), device: None, is_of_studio: false, ..self.clone() }
    }

    /// Adds a file; its number is its position.
    pub fn add(&mut self, source: Source) {
        let device = source.origin.as_ref().and_then(|it| it.device.clone());
        if let Some(device) = device.filter(|_| !source.is_of_library()) {
            self.device.get_or_insert_default().merge(device);
        }
        self.is_of_studio |= vendor::is_list_of_automation_studio(&source.path);
        self.files.push(source);
    }

    /// Reads a file anew: an editor has another text of it.
    pub fn replace(&mut self, file: u16, text: &str) {
        let file = &mut self.files[usize::from(file)];
        let new = Source::decode(file.path.clone(), text.as_bytes());
        *file = Source { library: file.library.clone(), is_bundled: file.is_bundled, ..new };
    }

    /// Takes another source in the place of one.
    pub fn put(&mut self, file: u16, source: Source) {
        self.files[usize::from(file)] = source;
    }

    pub fn files(&self) -> &[Source] {
        &self.files
    }

    pub fn get(&self, file: u16) -> &Source {
        &self.files[usize::from(file)]
    }

    /// The file as it is, where a text is made of pieces of it.
    pub fn file(&self, file: u16) -> &Source {
        self.get(file).file()
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

#[cfg(test)]
mod tests;
