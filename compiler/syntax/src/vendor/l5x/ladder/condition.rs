//! What is known of the condition of a rung at some place in it.

use super::super::super::assembly::Chunk;
use core::ops::Range;

#[derive(Clone, Debug)]
pub enum Condition {
    True,
    Variable(String),
    Expression(Expression),
}

#[derive(Clone, Debug)]
pub struct Expression {
    pub words: Vec<Chunk>,
    /// Its last operation is an OR.
    pub is_or: bool,
}

impl Condition {
    /// The expression, for what is at `place` in the file.
    pub fn words(&self, place: &Range<usize>) -> Vec<Chunk> {
        match self {
            Self::True => vec![Chunk::words("TRUE", place)],
            Self::Variable(name) => vec![Chunk::words(name.clone(), place)],
            Self::Expression(it) => it.words.clone(),
        }
    }

    #[must_use]
    pub fn and(self, test: Expression, place: &Range<usize>) -> Self {
        let mut words = match self {
            Self::True => return Self::Expression(test),
            Self::Variable(name) => vec![Chunk::words(name, place)],
            Self::Expression(it) => it.in_parentheses(place),
        };
        words.push(Chunk::words(" AND ", place));
        words.extend(test.in_parentheses(place));
        Self::Expression(Expression { words, is_or: false })
    }
}

impl Expression {
    pub fn new(words: Vec<Chunk>) -> Self {
        Self { words, is_or: false }
    }

    /// As an operand of an AND.
    fn in_parentheses(self, place: &Range<usize>) -> Vec<Chunk> {
        if !self.is_or {
            return self.words;
        }
        let mut words = vec![Chunk::words("(", place)];
        words.extend(self.words);
        words.push(Chunk::words(")", place));
        words
    }

    /// Any of them.
    pub fn any(all: Vec<Self>, place: &Range<usize>) -> Self {
        let is_or = all.len() > 1 || all.iter().any(|it| it.is_or);
        let mut words = Vec::new();
        for it in all {
            if !words.is_empty() {
                words.push(Chunk::words(" OR ", place));
            }
            words.extend(it.words);
        }
        Self { words, is_or }
    }
}
