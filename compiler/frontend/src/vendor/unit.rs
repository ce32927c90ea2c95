//! A POU as the files of other systems hold it, in parts, and how it is written in Structured Text.

use super::assembly::{Assembly, Chunk, Says, Trouble};
use core::ops::Range;

/// What a part of a file declares.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum What {
    /// A POU, an interface, a type or a list of global variables: its declaration says which.
    Unit,
    Method,
    Property,
    Get,
    Set,
    Action,
}

/// A body.
#[derive(Clone, Debug, Default)]
pub enum Body {
    #[default]
    None,
    Text(Vec<Chunk>),
    /// A language that is no text, and where it begins.
    Other(&'static str, Range<usize>),
}

#[derive(Clone, Debug)]
pub struct Unit<'t> {
    pub what: What,
    pub name: &'t str,
    /// Where it begins in the file.
    pub place: Range<usize>,
    /// Where it ends.
    pub end: Range<usize>,
    pub declaration: Vec<Chunk>,
    pub body: Body,
    pub parts: Vec<Unit<'t>>,
}

impl<'t> Unit<'t> {
    pub fn new(what: What, name: &'t str, place: Range<usize>) -> Self {
        let end = place.end..place.end;
        Self { what, name, place, end, declaration: Vec::new(), body: Body::None, parts: Vec::new() }
    }

    /// Writes it with its parts before its body, and its end, which declarations of other systems lack.
    pub fn write(&self, file: &str, out: &mut Assembly) {
        match self.what {
            What::Get => out.write("\nGET\n", &self.place),
            What::Set => out.write("\nSET\n", &self.place),
            What::Action => out.write(&format!("\nACTION {}\n", self.name), &self.place),
            What::Unit | What::Method | What::Property => {}
        }
        out.copy(file, &self.declaration);
        out.write("\n", &self.end);
        for part in &self.parts {
            part.write(file, out);
        }
        match &self.body {
            Body::None => {}
            Body::Text(chunks) => out.copy(file, chunks),
            Body::Other(language, place) => {
                let message = format!("the body of `{}` is {language}, which is no text", self.name);
                out.problem(Trouble::OtherLanguage, message, place);
            }
        }
        let end = match self.what {
            What::Get => "END_GET",
            What::Set => "END_SET",
            What::Action => "END_ACTION",
            What::Method => "END_METHOD",
            What::Property => "END_PROPERTY",
            What::Unit => end(file, &self.declaration),
        };
        out.write(&format!("\n{end}\n"), &self.end);
    }
}

/// The word that ends what a declaration begins; none where it holds its end itself.
fn end(file: &str, declaration: &[Chunk]) -> &'static str {
    const ENDS: [(&str, &str); 4] = [
        ("FUNCTION_BLOCK", "END_FUNCTION_BLOCK"),
        ("FUNCTION", "END_FUNCTION"),
        ("PROGRAM", "END_PROGRAM"),
        ("INTERFACE", "END_INTERFACE"),
    ];
    let text: String = declaration
        .iter()
        .map(|it| match &it.says {
            Says::Itself | Says::Symbol(_) => &file[it.place.clone()],
            Says::Words(words) => words.as_str(),
        })
        .collect();
    let word = first_word(&text);
    ENDS.iter().find(|it| word.eq_ignore_ascii_case(it.0)).map_or("", |it| it.1)
}

/// The first word after comments and pragmas.
fn first_word(text: &str) -> &str {
    let mut rest = text.trim_start();
    loop {
        let after = if rest.starts_with("//") {
            rest.split_once('\n').map_or("", |it| it.1)
        } else if let Some(inner) = rest.strip_prefix("(*") {
            after_comment(inner)
        } else if let Some(inner) = rest.strip_prefix("/*") {
            inner.split_once("*/").map_or("", |it| it.1)
        } else if rest.starts_with('{') {
            rest.split_once('}').map_or("", |it| it.1)
        } else {
            let end = rest.find(|it: char| !it.is_ascii_alphanumeric() && it != '_').unwrap_or(rest.len());
            return &rest[..end];
        };
        rest = after.trim_start();
    }
}

/// What follows a comment, which may hold others.
fn after_comment(mut text: &str) -> &str {
    let mut open = 1_usize;
    while open > 0 {
        match (text.find("(*"), text.find("*)")) {
            (Some(inner), Some(end)) if inner < end => {
                open += 1;
                text = &text[inner + 2..];
            }
            (_, Some(end)) => {
                open -= 1;
                text = &text[end + 2..];
            }
            (_, None) => return "",
        }
    }
    text
}
