//! The tokens of a text with its comments and pragmas, and with what the layout asks of the white space between them.

use crate::lex::{Kind, Scanner};

#[derive(Clone, Copy, Debug)]
pub struct Token<'s> {
    pub kind: Kind,
    pub text: &'s str,
    /// Line breaks between the token before it and this one.
    pub breaks: usize,
    /// There is white space before it.
    pub is_apart: bool,
    /// It is the name of a member, or marked as a name, whatever word it is: `.type`, `#by` of SCL.
    pub is_member: bool,
    /// It is printed as it stands, with the white space around it.
    pub is_kept: bool,
}

impl Token<'_> {
    /// A comment or a pragma, which may be anywhere.
    pub fn is_aside(&self) -> bool {
        matches!(self.kind, Kind::Comment | Kind::Pragma)
    }

    fn marks_name(&self, next: &Self) -> bool {
        self.kind == Kind::Dot && next.breaks == 0 || self.text == "#" && !next.is_apart
    }

    pub fn is_word(&self, word: &str) -> bool {
        self.kind == Kind::Name && self.text.eq_ignore_ascii_case(word)
    }

    /// A name, or a word that is reserved.
    pub fn is_name_like(&self) -> bool {
        self.kind == Kind::Name || self.kind.keyword().is_some()
    }
}

const fn is_number(kind: Kind) -> bool {
    matches!(kind, Kind::Integer | Kind::Based | Kind::Real | Kind::Time | Kind::Date)
}

/// Reads a text; nothing of it but white space is left out.
pub fn read(text: &str) -> Vec<Token<'_>> {
    let mut tokens: Vec<Token<'_>> = Vec::with_capacity(text.len() / 4 + 16);
    let mut lexer = Scanner::new(text);
    let mut end = 0;
    while let Some(kind) = lexer.next() {
        let place = lexer.span();
        let between = &text[end..place.start];
        let mut token = Token {
            kind,
            text: &text[place.clone()],
            breaks: between.bytes().filter(|it| *it == b'\n').count(),
            is_apart: !between.is_empty(),
            is_member: false,
            is_kept: false,
        };
        // `T#1. c` would be another literal without its space: as what has no meaning, it is left as it is written.
        if token.kind == Kind::Dot && tokens.last().is_some_and(|it| is_number(it.kind)) {
            token.kind = Kind::Unknown;
        }
        token.is_member = tokens.last().is_some_and(|it| it.marks_name(&token));
        if token.is_member && token.kind.keyword().is_some() {
            token.kind = Kind::Name;
        }
        if (token.breaks > 0 || tokens.last().is_none_or(ends_line)) && takes_line(&token, lexer.remainder()) {
            let name = lexer.remainder().lines().next().unwrap_or_default();
            lexer.bump(name.len());
            token.text = text[place.start..lexer.span().end].trim_end();
        }
        let is_off = switch(&token) == Some("off");
        tokens.push(token);
        if is_off {
            let kept = until_on(lexer.remainder());
            let start = lexer.span().end;
            lexer.bump(kept);
            let text = &text[start..start + kept];
            tokens.push(Token {
                kind: Kind::Comment,
                text,
                breaks: 0,
                is_apart: false,
                is_member: false,
                is_kept: true,
            });
        }
        end = lexer.span().end;
    }
    tokens
}

/// Whether a statement may begin after a token, which then has a line of its own.
fn ends_line(token: &Token<'_>) -> bool {
    let kinds = [Kind::Semicolon, Kind::Colon, Kind::Then, Kind::Do, Kind::Else, Kind::Of, Kind::Repeat];
    kinds.contains(&token.kind) || token.text.get(..4).is_some_and(|it| it.eq_ignore_ascii_case("END_"))
}

/// Whether any text may follow up to the end of the line: `REGION Pumps & valves`, `TITLE = What it's for` of SCL.
fn takes_line(token: &Token<'_>, after: &str) -> bool {
    let blanks = [' ', '\t'];
    let text = after.trim_start_matches(blanks);
    let is_named = || after.starts_with(blanks) && !text.starts_with([':', '(', '.', '=']);
    token.is_word("REGION") && is_named()
        || token.is_word("END_REGION")
        || token.is_word("TITLE") && text.starts_with('=')
}

/// `// staunch: off`: what follows is left as it is, up to `// staunch: on`.
fn switch<'s>(token: &Token<'s>) -> Option<&'s str> {
    match token.kind {
        Kind::Comment => switched(token.text),
        _ => None,
    }
}

fn switched(comment: &str) -> Option<&str> {
    let inner = comment.strip_prefix("//").or_else(|| comment.strip_prefix("(*")?.strip_suffix("*)"))?;
    inner.trim().strip_prefix("staunch:").map(str::trim)
}

/// The length of what is left as it is, with the white space before the comment that ends it.
fn until_on(text: &str) -> usize {
    let mut lexer = Scanner::new(text);
    while let Some(kind) = lexer.next() {
        let place = lexer.span();
        if kind == Kind::Comment && switched(&text[place.clone()]) == Some("on") {
            return place.start;
        }
    }
    text.len()
}
