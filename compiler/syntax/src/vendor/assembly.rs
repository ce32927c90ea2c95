//! A text that is made of pieces of a file: each knows where in the file it is from.

use super::device::Device;
use core::ops::Range;
use std::borrow::Cow;

/// A part of the text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Piece {
    /// Where it begins in the text.
    pub start: u32,
    /// What it is from, in the file.
    pub at: u32,
    pub end: u32,
    /// It is the file's own text, byte for byte.
    pub verbatim: bool,
}

/// What is wrong with a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Problem {
    /// A place in the text, whose piece says where in the file.
    pub at: u32,
    pub trouble: Trouble,
    pub message: String,
    /// What to write, where that is not the same for all of its kind.
    pub help: Option<String>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Trouble {
    /// The file cannot be read as what it is.
    Broken,
    /// The file does not exist.
    Absent,
    /// A body in another language.
    OtherLanguage,
    /// A second body.
    SecondBody,
    /// What has no words in Structured Text here.
    NotSupported,
    /// What the system itself does not write.
    Odd,
    /// A comment that takes in what follows.
    Open,
    /// A text that ends with the word that its file stands for.
    SecondEnd,
    /// A diagram that other versions of its editor execute in another order.
    OtherOrder,
}

/// The text, and what it is made of.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Assembly {
    pub text: String,
    /// In the order of the text; they cover all of it.
    pub pieces: Vec<Piece>,
    pub problems: Vec<Problem>,
    /// What a project of OpenPLC Editor says of its device.
    pub device: Option<Device>,
}

/// A part of a file's text, or what it stands for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Chunk {
    pub place: Range<usize>,
    pub says: Says,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Says {
    /// The text as it is.
    Itself,
    /// `<` for `&lt;`.
    Symbol(char),
    /// Words of Structured Text for what is said in another way.
    Words(String),
    /// Nothing, and why the text is wrong.
    Wrong(Trouble, String),
}

impl Chunk {
    pub fn verbatim(place: Range<usize>) -> Self {
        Self { place, says: Says::Itself }
    }

    pub fn words(words: impl Into<String>, place: &Range<usize>) -> Self {
        Self { place: place.clone(), says: Says::Words(words.into()) }
    }

    /// What it says, as Structured Text.
    pub fn said<'c>(&'c self, file: &'c str) -> Cow<'c, str> {
        match &self.says {
            Says::Itself => Cow::Borrowed(&file[self.place.clone()]),
            Says::Symbol(symbol) => Cow::Owned(symbol.to_string()),
            Says::Words(words) => Cow::Borrowed(words),
            Says::Wrong(..) => Cow::Borrowed(""),
        }
    }

    /// The text is not what its system writes.
    pub fn odd(message: impl Into<String>, place: &Range<usize>) -> Self {
        Self { place: place.clone(), says: Says::Wrong(Trouble::Odd, message.into()) }
    }
}

/// What chunks say together, without space around it.
pub fn text(file: &str, chunks: &[Chunk]) -> String {
    let said: String = chunks.iter().map(|it| it.said(file)).collect();
    said.trim().to_owned()
}

/// How much of a text there was.
#[derive(Clone, Copy, Debug)]
pub struct Mark {
    text: usize,
    pieces: usize,
    problems: usize,
}

impl Assembly {
    pub fn mark(&self) -> Mark {
        Mark { text: self.text.len(), pieces: self.pieces.len(), problems: self.problems.len() }
    }

    /// Leaves out what was written, and what was wrong, after a mark.
    pub fn rewind(&mut self, mark: Mark) {
        self.text.truncate(mark.text);
        self.pieces.truncate(mark.pieces);
        self.problems.truncate(mark.problems);
    }

    /// Takes what the chunks of the file hold.
    pub fn copy(&mut self, file: &str, chunks: &[Chunk]) {
        for Chunk { place, says } in chunks {
            match says {
                Says::Symbol(symbol) => self.write(symbol.encode_utf8(&mut [0; 4]), place),
                Says::Words(words) => self.write(words, place),
                Says::Wrong(trouble, message) => self.problem(*trouble, message.clone(), place),
                Says::Itself => {
                    self.piece(place, true);
                    self.text.push_str(&file[place.clone()]);
                }
            }
        }
    }

    /// Adds a text that the file says in another way, at `place`.
    pub fn write(&mut self, text: &str, place: &Range<usize>) {
        self.piece(place, false);
        self.text.push_str(text);
    }

    /// Notes what is wrong at `place`.
    pub fn problem(&mut self, trouble: Trouble, message: String, place: &Range<usize>) {
        let at = offset(self.text.len());
        self.write("\n", place);
        self.problems.push(Problem { at, trouble, message, help: None });
    }

    /// Says what to write in place of what the last problem is about.
    pub fn help(&mut self, help: impl Into<String>) {
        if let Some(problem) = self.problems.last_mut() {
            problem.help = Some(help.into());
        }
    }

    fn piece(&mut self, place: &Range<usize>, verbatim: bool) {
        let start = offset(self.text.len());
        self.pieces.push(Piece { start, at: offset(place.start), end: offset(place.end), verbatim });
    }
}

/// A file has at most `u32::MAX` bytes.
fn offset(at: usize) -> u32 {
    u32::try_from(at).unwrap_or(u32::MAX)
}
