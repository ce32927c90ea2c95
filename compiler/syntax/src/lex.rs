//! Text to tokens. Lexing never fails: characters that do not form a token become one
//! [`Kind::Unknown`] a run, reported here; comments and pragmas are kept separately.

mod comment;
mod condition;
mod conditional;
mod declared;
mod kind;
mod literal;
mod scan;

pub use condition::miswritten;
pub use declared::{Declaration, Declared, Known, Scope, Subject};
pub use kind::Kind;
pub use literal::{DECIMAL, Fault, date, duration, integer, real, string};
pub use scan::Scanner;

use crate::{
    ast::Name,
    diagnostic::{Code, Diagnostic},
    source::{Comments, Habits, Span},
};

/// Errors of one file after which reading stops.
pub const MAX_REPORTS: usize = 100;

/// One file's tokens, ended by one [`Kind::End`]; `kinds` and `places` go together.
#[derive(Debug, Default)]
pub struct Tokens<'s> {
    pub kinds: Vec<Kind>,
    /// First byte, and the byte after the last.
    pub places: Vec<(u32, u32)>,
    pub comments: Vec<(u32, u32)>,
    pub pragmas: Vec<Name<'s>>,
    pub diagnostics: Vec<Diagnostic>,
    /// The end of the tokens is not the end of the program: an unclosed comment or too many errors came before it.
    pub cut: bool,
    /// Each `{IF …}` that is decided when all declarations are known.
    pub undecided: Vec<Span>,
    /// The first CONFIGURATION that is read as a name.
    pub reserved: Option<Span>,
    /// Each `{{ … }}`, code in C: its braces.
    pub c_code: Vec<Span>,
}

/// Reads a text of at most `u32::MAX` bytes.
pub fn lex(file: u16, text: &str) -> Tokens<'_> {
    lex_with(file, text, Habits::default(), Known::Never)
}

/// The same, where something is known of the file, and of what is declared.
pub fn lex_with<'s>(file: u16, text: &'s str, habits: Habits<'s>, known: Known<'_, 's>) -> Tokens<'s> {
    // Real programs have a token for each five bytes or so.
    let guess = text.len() / 4 + 16;
    let tokens = Tokens { kinds: Vec::with_capacity(guess), places: Vec::with_capacity(guess), ..Tokens::default() };
    let comments = habits.comments;
    let mut reading = Reading { file, text, tokens, comments, named: Vec::new(), unknown: false, has_external: false };
    let mut scanner = Scanner::new(text);
    scanner.end_comments(comments);
    while let Some(kind) = scanner.next() {
        let range = scanner.span();
        if kind == Kind::Pragma
            && let Some(dialect) = dialect_named(&text[range.clone()])
        {
            reading.comments = Comments::of_dialect(dialect);
            scanner.end_comments(reading.comments);
        }
        reading.token(kind, (offset(range.start), offset(range.end)));
        if reading.tokens.diagnostics.len() >= MAX_REPORTS {
            reading.tokens.cut = true;
            break;
        }
    }
    let end = offset(text.len());
    reading.push(Kind::End, (end, end));
    conditional::choose(&mut reading.tokens, habits.defined, known);
    reading.tokens
}

/// The name in `{dialect 'openplc'}`.
fn dialect_named(pragma: &str) -> Option<&str> {
    let words = pragma.strip_prefix('{')?.strip_suffix('}')?.trim();
    let (word, name) = words.split_at_checked("dialect".len())?;
    let name = name.trim();
    word.eq_ignore_ascii_case("dialect").then(|| name.trim_matches(['\'', '"']))
}

struct Reading<'s> {
    file: u16,
    text: &'s str,
    tokens: Tokens<'s>,
    comments: Comments,
    /// Names with letters that names cannot have: each is reported once.
    named: Vec<&'s str>,
    /// The last token is a run of unknown characters.
    unknown: bool,
    /// `@EXTERNAL` has been reported.
    has_external: bool,
}

impl<'s> Reading<'s> {
    fn token(&mut self, kind: Kind, place: (u32, u32)) {
        match kind {
            Kind::Comment => self.comment(place),
            Kind::Pragma => self.pragma(place),
            Kind::Unknown => self.unknown(place),
            Kind::Name => self.name(place),
            Kind::OpenText => self.open_text(place),
            kind => self.push(kind, place),
        }
    }

    fn push(&mut self, kind: Kind, place: (u32, u32)) {
        if std::mem::take(&mut self.unknown) {
            self.report_unknown();
        }
        self.tokens.kinds.push(kind);
        self.tokens.places.push(place);
    }

    fn span(&self, (start, end): (u32, u32)) -> Span {
        Span { file: self.file, start, end }
    }

    fn slice(&self, (start, end): (u32, u32)) -> &'s str {
        &self.text[index(start)..index(end)]
    }

    fn comment(&mut self, place: (u32, u32)) {
        self.tokens.comments.push(place);
        let opening = self.slice(place);
        if index(place.1) == self.text.len() && !comment::is_closed(opening, self.comments) {
            let (open, close) = if opening.starts_with("(*") { ("(*", "*)") } else { ("/*", "*/") };
            let mut it = self.unclosed(place, 2, "the comment", open, close);
            if open == "(*" && self.comments == Comments::Nested {
                it = it.note("comments nest: each `(*` needs its own `*)`");
            }
            self.tokens.diagnostics.push(it);
        }
    }

    fn pragma(&mut self, place: (u32, u32)) {
        let text = self.slice(place);
        if text.starts_with("{{") && text.ends_with("}}") {
            let span = self.span((place.0, place.0 + 2));
            self.tokens.c_code.push(span);
        } else if text.ends_with('}') {
            let span = self.span((place.0 + 1, place.1 - 1));
            self.tokens.pragmas.push(Name { text: &text[1..text.len() - 1], span });
        } else {
            let it = self.unclosed(place, 1, "the pragma", "{", "}");
            self.tokens.diagnostics.push(it);
        }
    }

    fn unclosed(&mut self, at: (u32, u32), len: u32, what: &str, open: &str, close: &str) -> Diagnostic {
        self.tokens.cut = true;
        let span = self.span((at.0, at.0 + len));
        Diagnostic::new(Code::E0003, span, format!("{what} that starts here is not closed"))
            .label(format!("this `{open}` has no matching `{close}`"))
            .help(format!("write `{close}` where {what} ends"))
    }

    /// Lengthens the run of unknown characters, or starts one.
    fn unknown(&mut self, place: (u32, u32)) {
        if let (Some(Kind::Unknown), Some(last)) = (self.tokens.kinds.last(), self.tokens.places.last_mut())
            && last.1 == place.0
        {
            last.1 = place.1;
        } else {
            self.push(Kind::Unknown, place);
        }
        self.unknown = true;
    }

    /// Reports a run of unknown characters once it has ended.
    fn report_unknown(&mut self) {
        let (Some(Kind::Unknown), Some(place)) = (self.tokens.kinds.last(), self.tokens.places.last()) else {
            return;
        };
        let place = *place;
        if self.closes_text(place) {
            return;
        }
        if self.slice(place) == "@" && self.text[index(place.1)..].starts_with("EXTERNAL") {
            return self.report_external(place);
        }
        let shown: String = self.slice(place).chars().take(20).flat_map(char::escape_debug).collect();
        let mut it =
            Diagnostic::new(Code::E0002, self.span(place), format!("`{shown}` has no meaning in Structured Text"));
        it = match shown.chars().next() {
            Some('‘' | '’' | '‚' | '`') => it.help("a string is written between two `'`"),
            Some('“' | '”' | '„') => it.help("a string is written between two `'`, a WSTRING between two `\"`"),
            Some('–' | '—' | '−') => it.help("write `-`"),
            Some('\u{a0}') => it.help("write an ordinary space"),
            Some('#') if crate::spelling::is_preprocessor(&self.text[index(place.1)..]) => it.help(
                "Structured Text has no preprocessor: declare a `VAR CONSTANT` for `#define`, and give all files to the command for `#include`",
            ),
            Some('#') if self.text[index(place.1)..].starts_with(|it: char| it.is_ascii_alphabetic()) => {
                it.help("variables are written without `#`").fix(self.span(place), "")
            }
            Some('#') if self.is_duration_after(place.1) => {
                it.help("a TIME begins with `T#`").fix(self.span(place), "T#")
            }
            Some('|') => it.help("write `OR`").fix(self.span(place), self.apart(place, "OR")),
            Some('#') => it.help("a comment is written `// …` or `(* … *)`, a number of base 16 `16#FF`"),
            Some('$') if let Some(digits) = self.hexadecimal_after(place.1) => {
                it.help(format!("a number of base 16 is written `16#{digits}`")).fix(self.span(place), "16#")
            }
            Some('$') => it.help("a number of base 16 is written `16#FF`"),
            Some('~') => it.help("write `NOT`").fix(self.span(place), "NOT "),
            Some('?') => it.help("choose a value with `SEL(condition, value_if_false, value_if_true)`"),
            Some('}') => it.help("a block ends with its own keyword: `END_IF`, `END_FOR`, `END_WHILE`"),
            _ => it.label("delete this"),
        };
        self.tokens.diagnostics.push(it);
    }

    /// A word with spaces where it would touch the text next to a place, which it replaces.
    fn apart(&self, place: (u32, u32), word: &str) -> String {
        let touches = |it: Option<char>| it.is_some_and(|it| !it.is_whitespace());
        let before = touches(self.text[..index(place.0)].chars().next_back());
        let after = touches(self.text[index(place.1)..].chars().next());
        format!("{}{word}{}", if before { " " } else { "" }, if after { " " } else { "" })
    }

    /// Whether a number with a unit of time is at a place.
    fn is_duration_after(&self, at: u32) -> bool {
        let rest = &self.text[index(at)..];
        let unit = rest.trim_start_matches(|it: char| it.is_ascii_digit() || it == '.');
        let word = unit.split(|it: char| !it.is_ascii_alphanumeric()).next().unwrap_or_default();
        unit.len() < rest.len() && ["d", "h", "m", "s", "ms", "us", "ns"].iter().any(|it| word.eq_ignore_ascii_case(it))
    }

    /// The digits of base 16 that are at a place.
    fn hexadecimal_after(&self, at: u32) -> Option<&'s str> {
        let rest = &self.text[index(at)..];
        let digits = &rest[..rest.find(|it: char| !it.is_ascii_alphanumeric() && it != '_').unwrap_or(rest.len())];
        let is_number = !digits.is_empty() && digits.bytes().all(|it| it.is_ascii_hexdigit());
        is_number.then_some(digits)
    }

    /// ruSTy's word for a POU that is implemented elsewhere: reported once in a file.
    fn report_external(&mut self, place: (u32, u32)) {
        if std::mem::replace(&mut self.has_external, true) {
            return;
        }
        let message = "`@EXTERNAL` is ruSTy's pragma for POUs that are implemented elsewhere";
        let end = place.1 + 8;
        self.tokens.diagnostics.push(
            Diagnostic::new(Code::E0002, self.span((place.0, end)), message)
                .label("Staunch has another pragma for it")
                .help("write `{external}` before each FUNCTION and FUNCTION_BLOCK that is implemented in Rust or C")
                .note("standard functions such as `INT_TO_STRING` need no declaration"),
        );
    }

    /// `’` after `‘Mixer`: the pair is one mistake.
    fn closes_text(&mut self, place: (u32, u32)) -> bool {
        let Some(opened) = self.tokens.diagnostics.last().map(|it| it.span) else { return false };
        let whole = (opened.start, place.1);
        let (open, close) = (self.slice((opened.start, opened.end)), self.slice(place));
        let pair = matches!((open, close), ("‘" | "‚", "’" | "‘") | ("“" | "„", "”" | "“"));
        if !pair || self.slice(whole).contains('\n') {
            return false;
        }
        let inner = &self.text[index(opened.end)..index(place.0)];
        let meant = format!("'{inner}'");
        self.tokens.diagnostics.pop();
        self.tokens.diagnostics.push(
            Diagnostic::new(
                Code::E0002,
                self.span(whole),
                format!("`{open}` and `{close}` have no meaning in Structured Text"),
            )
            .label("a string is written between two `'`")
            .help(format!("write `{meant}`"))
            .fix(self.span(whole), meant),
        );
        true
    }

    fn name(&mut self, place: (u32, u32)) {
        let name = self.slice(place);
        if !name.is_ascii() && !self.named.contains(&name) {
            self.named.push(name);
            let it = Diagnostic::new(
                Code::E0002,
                self.span(place),
                format!("`{name}` contains a letter that a name cannot contain"),
            )
            .label("expected only A to Z, 0 to 9 and `_`")
            .help("write the name with unaccented letters");
            self.tokens.diagnostics.push(it);
        }
        self.push(Kind::Name, place);
    }

    fn open_text(&mut self, place: (u32, u32)) {
        let quote = &self.slice(place)[..1];
        let it = Diagnostic::new(Code::E0004, self.span(place), "the string is not closed on its line")
            .label(format!("this {quote} has no closing one"))
            .help(format!(
                "write {quote} where the string ends; inside a string `${quote}` is a quote, `$N` a line break"
            ));
        self.tokens.diagnostics.push(it);
        self.push(Kind::OpenText, place);
    }
}

fn offset(at: usize) -> u32 {
    u32::try_from(at).unwrap_or(u32::MAX)
}

/// A stored offset as an index of the text.
pub fn index(at: u32) -> usize {
    usize::try_from(at).unwrap_or(usize::MAX)
}
