//! What a wire carries, as an expression. What several wires share is shared here, too.

use super::super::assembly::Chunk;
use super::super::assembly::text;
use core::ops::Range;
use std::rc::Rc;

/// An expression that is longer stands for wires that no one draws.
pub const LONGEST: usize = 100_000;

#[derive(Clone, Debug)]
pub struct Expression {
    /// Its length as text, or about that.
    pub length: usize,
    form: Form,
}

#[derive(Clone, Debug)]
enum Form {
    True,
    /// As it is written; one that has operators needs parentheses next to others.
    Written {
        chunks: Vec<Chunk>,
        is_simple: bool,
    },
    Not(Rc<Expression>),
    All(Vec<Rc<Expression>>),
    Any(Vec<Rc<Expression>>),
}

/// Where an expression stands: what binds more tightly needs no parentheses.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Around {
    Nothing,
    Or,
    And,
    Not,
}

impl Expression {
    /// Of a power rail.
    pub fn always() -> Rc<Self> {
        Rc::new(Self { length: 4, form: Form::True })
    }

    pub fn written(file: &str, chunks: Vec<Chunk>) -> Rc<Self> {
        let text = text(file, &chunks);
        let is_simple = text.chars().all(|it| it.is_alphanumeric() || "_.[]#%'\"".contains(it));
        Rc::new(Self { length: text.len(), form: Form::Written { chunks, is_simple } })
    }

    pub fn name(name: &str, place: &Range<usize>) -> Rc<Self> {
        let chunks = vec![Chunk::words(name, place)];
        Rc::new(Self { length: name.len(), form: Form::Written { chunks, is_simple: true } })
    }

    pub fn not(inner: Rc<Self>) -> Rc<Self> {
        Rc::new(Self { length: inner.length.saturating_add(4), form: Form::Not(inner) })
    }

    pub fn all(parts: Vec<Rc<Self>>) -> Rc<Self> {
        let parts: Vec<_> = parts.into_iter().filter(|it| !it.is_always()).collect();
        Self::joined(parts, Self::always, Form::All)
    }

    pub fn any(parts: Vec<Rc<Self>>) -> Rc<Self> {
        if parts.iter().any(|it| it.is_always()) {
            return Self::always();
        }
        Self::joined(parts, Self::always, Form::Any)
    }

    fn joined(mut parts: Vec<Rc<Self>>, none: fn() -> Rc<Self>, form: fn(Vec<Rc<Self>>) -> Form) -> Rc<Self> {
        match (parts.pop(), parts.is_empty()) {
            (None, _) => none(),
            (Some(only), true) => only,
            (Some(last), false) => {
                parts.push(last);
                let length = parts.iter().fold(0_usize, |sum, it| sum.saturating_add(it.length).saturating_add(5));
                Rc::new(Self { length, form: form(parts) })
            }
        }
    }

    pub fn is_always(&self) -> bool {
        matches!(self.form, Form::True)
    }

    /// It in Structured Text, after what was written.
    pub fn write(&self, place: &Range<usize>, out: &mut Vec<Chunk>) {
        self.write_in(Around::Nothing, place, out);
    }

    fn write_in(&self, around: Around, place: &Range<usize>, out: &mut Vec<Chunk>) {
        let own = match &self.form {
            Form::True | Form::Written { is_simple: true, .. } | Form::Not(_) => Around::Not,
            Form::Written { is_simple: false, .. } => Around::Nothing,
            Form::All(_) => Around::And,
            Form::Any(_) => Around::Or,
        };
        let is_inside = own < around;
        if is_inside {
            out.push(Chunk::words("(", place));
        }
        match &self.form {
            Form::True => out.push(Chunk::words("TRUE", place)),
            Form::Written { chunks, .. } => out.extend(chunks.iter().cloned()),
            Form::Not(inner) => {
                out.push(Chunk::words("NOT ", place));
                inner.write_in(Around::Not, place, out);
            }
            Form::All(parts) => write_parts(parts, " AND ", Around::And, place, out),
            Form::Any(parts) => write_parts(parts, " OR ", Around::Or, place, out),
        }
        if is_inside {
            out.push(Chunk::words(")", place));
        }
    }
}

fn write_parts(parts: &[Rc<Expression>], word: &str, around: Around, place: &Range<usize>, out: &mut Vec<Chunk>) {
    for (at, part) in parts.iter().enumerate() {
        if at > 0 {
            out.push(Chunk::words(word, place));
        }
        part.write_in(around, place, out);
    }
}
