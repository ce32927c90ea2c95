//! The text of a rung, in one piece, and where each part of it is in the file.

use super::super::super::assembly::{Chunk, Says};
use core::ops::Range;

/// A rung as the file has it.
#[derive(Clone, Debug)]
pub struct Text {
    /// As the file counts it.
    pub number: String,
    /// What is said of it before its statements.
    pub remark: Option<String>,
    /// Its type, where it is an edit that is not finished.
    pub edit: Option<String>,
    pub text: String,
    /// What the text is made of, with where each begins in it.
    chunks: Vec<(usize, Chunk)>,
    /// The element that holds it.
    place: Range<usize>,
}

impl Text {
    pub fn new(file: &str, number: String, chunks: Vec<Chunk>, place: Range<usize>) -> Self {
        let mut it = Self { number, remark: None, edit: None, text: String::new(), chunks: Vec::new(), place };
        for chunk in chunks {
            let start = it.text.len();
            match &chunk.says {
                Says::Itself => it.text.push_str(&file[chunk.place.clone()]),
                Says::Symbol(symbol) => it.text.push(*symbol),
                Says::Words(words) => it.text.push_str(words),
                Says::Wrong(..) => {}
            }
            it.chunks.push((start, chunk));
        }
        it
    }

    /// With its number, and a comment in one line, before its statements.
    #[must_use]
    pub fn remarked(self, comment: &str) -> Self {
        let comment = comment.split_whitespace().collect::<Vec<_>>().join(" ");
        let number = &self.number;
        let remark = if comment.is_empty() { format!("rung {number}") } else { format!("rung {number}: {comment}") };
        Self { remark: Some(remark), ..self }
    }

    /// With the type of an edit that is not finished.
    #[must_use]
    pub fn edited(self, edit: Option<String>) -> Self {
        Self { edit, ..self }
    }

    /// Where a part of the text is in the file.
    pub fn place(&self, part: &Range<usize>) -> Range<usize> {
        let pieces = self.part(part);
        match (pieces.first(), pieces.last()) {
            (Some(first), Some(last)) => first.place.start..last.place.end,
            _ => self.place.clone(),
        }
    }

    /// A part of the text, as the file has it.
    pub fn part(&self, part: &Range<usize>) -> Vec<Chunk> {
        let mut found = Vec::new();
        for (at, (start, chunk)) in self.chunks.iter().enumerate() {
            let end = self.chunks.get(at + 1).map_or(self.text.len(), |it| it.0);
            let (from, to) = (part.start.max(*start), part.end.min(end));
            if from >= to {
                continue;
            }
            found.push(match chunk.says {
                Says::Itself => {
                    let first = chunk.place.start;
                    Chunk::verbatim(first + from - start..first + to - start)
                }
                Says::Symbol(_) | Says::Words(_) | Says::Wrong(..) => chunk.clone(),
            });
        }
        found
    }
}
