//! A POU in a file of its own whose body is not Structured Text: its head and its variables are, and count as such. A diagram is read;
//! another body is refused by name.

use super::super::assembly::{Assembly, Chunk, Trouble};
use super::super::json;
use super::drawn::{self, Language, Pou};
use core::ops::Range;

/// The editor's words for its languages, which are the endings of its files but for two.
const LANGUAGES: [(&str, &str); 7] = [
    ("il", "Instruction List (IL)"),
    ("ld", "a ladder diagram (LD)"),
    ("fbd", "a function block diagram (FBD)"),
    ("sfc", "a sequential function chart (SFC)"),
    ("python", "Python"),
    ("py", "Python"),
    ("cpp", "C or C++"),
];

/// The keywords that begin a POU, the longer one first.
const HEADS: [(&str, &str); 3] =
    [("FUNCTION_BLOCK", "END_FUNCTION_BLOCK"), ("FUNCTION", "END_FUNCTION"), ("PROGRAM", "END_PROGRAM")];

/// The language that the editor calls so.
pub fn named(word: &str) -> Option<&'static str> {
    LANGUAGES.iter().find(|it| it.0 == word).map(|it| it.1)
}

/// The editor's word for the language of a POU's file: its name says it, and it begins as a POU does.
pub fn language(name: &str, text: &str) -> Option<&'static str> {
    let word = name.rsplit_once('.')?.1;
    let (word, _) = LANGUAGES.iter().find(|it| it.0 == word)?;
    head(text).map(|_| *word)
}

pub fn read(file: &str, word: &str, out: &mut Assembly) {
    let Some((start, end)) = head(file) else { return };
    let (name, after) = name(file, start);
    let declared = declared(file, after);
    out.copy(file, &[Chunk::verbatim(0..declared)]);
    out.write("\n", &(declared..declared));
    match Language::named(word) {
        Some(language) => {
            let variables = drawn::in_text(&file[after..declared]);
            diagram(file, (declared, end), language, &Pou { name: &file[name], variables }, out);
        }
        // A FUNCTION_BLOCK in C++ is refused where it is called.
        None if word == "cpp" && end == "END_FUNCTION_BLOCK" => out.write("{{ }}\n", &body(file, declared)),
        None => {
            let language = named(word).unwrap_or_default();
            let message = format!("the body of `{}` is {language}, not Structured Text", &file[name]);
            out.problem(Trouble::OtherLanguage, message, &body(file, declared));
        }
    }
    out.write(&format!("{end}\n"), &(file.len()..file.len()));
}

/// A diagram, between the variables and the word that ends the POU.
fn diagram(file: &str, (start, end): (usize, &str), language: Language, pou: &Pou<'_>, out: &mut Assembly) {
    let inner = file[start..].trim_end();
    let length = inner.len().checked_sub(end.len()).filter(|it| inner.is_char_boundary(*it));
    let is_closed = length.is_some_and(|it| inner[it..].eq_ignore_ascii_case(end));
    let part = start..start + length.filter(|_| is_closed).unwrap_or(inner.len());
    match json::parse_within(file, part) {
        Ok(value) => {
            let (statements, variables) = drawn::read(file, &value, language, pou, out);
            out.write(&variables, &(start..start));
            out.copy(file, &statements);
        }
        Err(broken) => {
            let message = format!("the diagram of `{}` is not well-formed JSON: {}", pou.name, broken.why);
            out.problem(Trouble::Broken, message, &broken.place);
        }
    }
}

/// Where the keyword of the POU ends, and the word that ends the POU.
fn head(text: &str) -> Option<(usize, &'static str)> {
    let start = after_space(text, 0);
    let (keyword, end) = HEADS.into_iter().find(|it| is_word(text, start, it.0))?;
    Some((start + keyword.len(), end))
}

/// The name that is after a keyword, and where the result type after it ends.
fn name(text: &str, at: usize) -> (Range<usize>, usize) {
    let start = after_space(text, at);
    let end = start + word(&text[start..]);
    let colon = after_space(text, end);
    let rest = text[colon..].strip_prefix(':').filter(|it| !it.starts_with('='));
    match rest {
        None => (start..end, end),
        Some(_) => {
            let ty = after_space(text, colon + 1);
            let rest = &text[ty..];
            let length = rest.find(|it: char| it.is_whitespace()).unwrap_or(rest.len());
            (start..end, ty + length)
        }
    }
}

/// Where the blocks of variables end that begin here.
fn declared(text: &str, at: usize) -> usize {
    let mut declared = at;
    loop {
        let start = after_space(text, declared);
        let keyword = &text[start..start + word(&text[start..])];
        let is_block = keyword.get(..3).is_some_and(|it| it.eq_ignore_ascii_case("VAR"));
        let Some(end) = end_of_block(text, start).filter(|_| is_block) else { return declared };
        declared = end;
    }
}

/// Behind the END_VAR that closes a block.
fn end_of_block(text: &str, start: usize) -> Option<usize> {
    let mut at = start;
    while at < text.len() {
        at = after_space(text, at);
        if is_word(text, at, "END_VAR") {
            return Some(at + "END_VAR".len());
        }
        let length = word(&text[at..]);
        at += if length > 0 { length } else { text[at..].chars().next().map_or(0, char::len_utf8) };
    }
    None
}

/// The first line of the body; where there is none, what is before it.
fn body(text: &str, declared: usize) -> Range<usize> {
    let start = declared + text[declared..].len() - text[declared..].trim_start().len();
    let line = text[start..].lines().next().unwrap_or_default().trim_end();
    if line.is_empty() { declared.saturating_sub(1)..declared } else { start..start + line.len() }
}

/// Behind white space and comments.
fn after_space(text: &str, mut at: usize) -> usize {
    loop {
        at += text[at..].len() - text[at..].trim_start().len();
        let rest = &text[at..];
        let comment = match rest {
            _ if rest.starts_with("//") => rest.find('\n').unwrap_or(rest.len()),
            _ if rest.starts_with("(*") => rest.find("*)").map_or(rest.len(), |it| it + 2),
            _ => return at,
        };
        at += comment;
    }
}

/// The length of the word that a text begins with.
fn word(text: &str) -> usize {
    text.find(|it: char| !it.is_alphanumeric() && it != '_').unwrap_or(text.len())
}

fn is_word(text: &str, at: usize, keyword: &str) -> bool {
    let rest = &text[at..];
    rest[..word(rest)].eq_ignore_ascii_case(keyword)
}
