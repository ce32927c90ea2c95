//! The tokens of a text, one after the other, each the longest that begins at its place. Written by hand: a generated lexer
//! costs each user's build script a quarter of its time.

use super::comment;
use super::kind::Kind;
use crate::source::Comments;
use core::ops::Range;

/// Reads a text from its start to its end.
#[derive(Clone, Debug)]
pub struct Scanner<'s> {
    text: &'s str,
    /// Of the last token.
    start: usize,
    end: usize,
    comments: Comments,
}

impl<'s> Scanner<'s> {
    pub fn new(text: &'s str) -> Self {
        Self { text, start: 0, end: 0, comments: Comments::default() }
    }

    /// Says how comments end from here on.
    pub fn end_comments(&mut self, comments: Comments) {
        self.comments = comments;
    }

    pub fn comments(&self) -> Comments {
        self.comments
    }

    /// Where the last token is.
    pub fn span(&self) -> Range<usize> {
        self.start..self.end
    }

    /// The text after the last token.
    pub fn remainder(&self) -> &'s str {
        self.text.get(self.end..).unwrap_or_default()
    }

    /// Lengthens the last token by so many bytes, which end before a character.
    pub fn bump(&mut self, bytes: usize) {
        self.end += bytes;
    }

    /// The kind and the length of the token that `rest` begins with.
    fn token(&self, rest: &'s str) -> (Kind, usize) {
        let bytes = rest.as_bytes();
        match bytes[0] {
            b'A'..=b'Z' | b'a'..=b'z' | b'_' => word(rest),
            b'0'..=b'9' => number(bytes),
            b'\'' | b'"' => text(rest),
            b'%' => percent(bytes),
            b'(' if bytes.get(1) == Some(&b'*') => {
                let length = || match self.comments {
                    Comments::Nested => comment::nested(&rest[2..]),
                    Comments::Plain => comment::first(&rest[2..]),
                };
                (Kind::Comment, comment::debugger(rest).unwrap_or_else(|| 2 + length()))
            }
            b'/' if bytes.get(1) == Some(&b'*') => (Kind::Comment, 2 + comment::plain(&rest[2..])),
            b'/' if bytes.get(1) == Some(&b'/') => (Kind::Comment, rest.find('\n').unwrap_or(rest.len())),
            b'{' => (Kind::Pragma, 1 + comment::pragma(&rest[1..])),
            0x80.. => {
                let first = rest.chars().next().map_or(1, char::len_utf8);
                if rest.starts_with(char::is_alphabetic) { word(rest) } else { (Kind::Unknown, first) }
            }
            _ => sign(bytes),
        }
    }
}

impl Iterator for Scanner<'_> {
    type Item = Kind;

    fn next(&mut self) -> Option<Kind> {
        let rest = self.remainder();
        let space = count(rest.as_bytes(), |it| matches!(it, b' ' | b'\t' | b'\r' | b'\n' | 0x0c));
        self.start = self.end + space;
        let rest = &rest[space..];
        if rest.is_empty() {
            self.end = self.start;
            return None;
        }
        let (kind, length) = self.token(rest);
        self.end = self.start + length;
        Some(kind)
    }
}

/// How many bytes from the first on are such.
fn count(bytes: &[u8], is: impl Fn(u8) -> bool) -> usize {
    bytes.iter().position(|it| !is(*it)).unwrap_or(bytes.len())
}

fn is_part_of_name(byte: u8) -> bool {
    byte.is_ascii_alphanumeric() || byte == b'_'
}

fn is_digit(byte: u8) -> bool {
    byte.is_ascii_digit() || byte == b'_'
}

/// A name, a keyword, or what begins with a type: `T#5s`, `INT#`.
fn word(rest: &str) -> (Kind, usize) {
    let bytes = rest.as_bytes();
    let plain = count(bytes, is_part_of_name);
    if bytes.get(plain).is_some_and(|it| *it >= 0x80) {
        let part = |it: char| it.is_alphabetic() || it.is_ascii_digit() || it == '_';
        let length = rest.find(|it| !part(it)).unwrap_or(rest.len());
        if length > plain {
            return (Kind::Name, length);
        }
    }
    if bytes.get(plain) == Some(&b'#') {
        return typed(bytes, plain);
    }
    (Kind::of_word(&bytes[..plain]).unwrap_or(Kind::Name), plain)
}

const DURATIONS: [&[u8]; 4] = [b"T", b"TIME", b"LT", b"LTIME"];
const DATES: [&[u8]; 12] = [
    b"D",
    b"DATE",
    b"LD",
    b"LDATE",
    b"TOD",
    b"TIME_OF_DAY",
    b"LTOD",
    b"LTIME_OF_DAY",
    b"DT",
    b"DATE_AND_TIME",
    b"LDT",
    b"LDATE_AND_TIME",
];

/// What begins with a type of so many bytes and a `#`.
fn typed(bytes: &[u8], ty: usize) -> (Kind, usize) {
    let value = &bytes[ty + 1..];
    let is = |types: &[&[u8]]| types.iter().any(|it| it.eq_ignore_ascii_case(&bytes[..ty]));
    let sign = usize::from(matches!(value, [b'+' | b'-', b'0'..=b'9', ..]));
    if is(&DURATIONS) && value.get(sign).is_some_and(u8::is_ascii_digit) {
        let first = sign + count(&value[sign..], is_part_of_name);
        return (Kind::Time, ty + 1 + first + groups(&value[first..], |it| it == b'.', is_part_of_name));
    }
    if is(&DATES) && value.first().is_some_and(u8::is_ascii_digit) {
        let first = count(value, is_digit);
        let separates = |it| matches!(it, b'-' | b':' | b'.');
        return (Kind::Date, ty + 1 + first + groups(&value[first..], separates, is_digit));
    }
    (Kind::Prefix, ty + 1)
}

/// The length of `.5.6`: parts that are not empty, each after a separator.
fn groups(bytes: &[u8], separates: impl Fn(u8) -> bool, is_part: impl Fn(u8) -> bool + Copy) -> usize {
    let mut length = 0;
    while bytes.get(length).is_some_and(|it| separates(*it)) {
        let part = count(&bytes[length + 1..], is_part);
        if part == 0 {
            break;
        }
        length += 1 + part;
    }
    length
}

fn number(bytes: &[u8]) -> (Kind, usize) {
    let whole = count(bytes, is_digit);
    if bytes.get(whole) == Some(&b'#') {
        return (Kind::Based, whole + 1 + count(&bytes[whole + 1..], is_part_of_name));
    }
    let has_point = bytes.get(whole) == Some(&b'.') && bytes.get(whole + 1).is_some_and(u8::is_ascii_digit);
    let mantissa = if has_point { whole + 1 + count(&bytes[whole + 1..], is_digit) } else { whole };
    let length = mantissa + exponent(&bytes[mantissa..]);
    (if length > whole { Kind::Real } else { Kind::Integer }, length)
}

/// The length of `e-5`.
fn exponent(bytes: &[u8]) -> usize {
    let sign = match bytes {
        [b'e' | b'E', b'+' | b'-', b'0'..=b'9', ..] => 2,
        [b'e' | b'E', b'0'..=b'9', ..] => 1,
        _ => return 0,
    };
    sign + count(&bytes[sign..], is_digit)
}

/// A string, up to its second quote, or to where its line ends without one.
fn text(rest: &str) -> (Kind, usize) {
    let bytes = rest.as_bytes();
    let quote = bytes[0];
    let mut at = 1;
    loop {
        match bytes.get(at) {
            Some(b'$') if bytes.get(at + 1).is_some_and(|it| !matches!(it, b'\r' | b'\n')) => {
                at += 1 + rest[at + 1..].chars().next().map_or(1, char::len_utf8);
            }
            Some(byte) if *byte == quote => {
                return (if quote == b'"' { Kind::WideText } else { Kind::Text }, at + 1);
            }
            None | Some(b'$' | b'\r' | b'\n') => return (Kind::OpenText, at),
            Some(_) => at += 1,
        }
    }
}

/// `%IX0.3`, `%Q*`, `%X5`, or the sign.
fn percent(bytes: &[u8]) -> (Kind, usize) {
    let is_area = matches!(bytes.get(1), Some(b'I' | b'Q' | b'M' | b'i' | b'q' | b'm'));
    if is_area {
        let place = 2 + usize::from(bytes.get(2).is_some_and(u8::is_ascii_alphabetic));
        match bytes.get(place) {
            Some(b'*') => return (Kind::Address, place + 1),
            Some(b'0'..=b'9') => {
                let first = place + count(&bytes[place..], |it| it.is_ascii_digit());
                return (Kind::Address, first + groups(&bytes[first..], |it| it == b'.', is_part_of_name));
            }
            _ => {}
        }
    }
    let is_part = matches!(bytes.get(1).map(u8::to_ascii_uppercase), Some(b'X' | b'B' | b'W' | b'D' | b'L'));
    match count(bytes.get(2..).unwrap_or_default(), |it| it.is_ascii_digit()) {
        digits if is_part && digits > 0 => (Kind::Part, 2 + digits),
        _ => (Kind::Percent, 1),
    }
}

/// The longest sign; what is none has one byte.
fn sign(bytes: &[u8]) -> (Kind, usize) {
    let two = match bytes {
        [first, second, ..] => Kind::of_signs(*first, *second),
        _ => None,
    };
    match two {
        Some(kind) => (kind, 2),
        None => (Kind::of_sign(bytes[0]).unwrap_or(Kind::Unknown), 1),
    }
}

#[cfg(test)]
mod tests {
    use super::{Kind, Scanner};

    /// The kinds of a text's tokens with their texts.
    fn tokens(text: &str) -> Vec<(Kind, &str)> {
        let mut scanner = Scanner::new(text);
        let mut all = Vec::new();
        while let Some(kind) = scanner.next() {
            all.push((kind, &text[scanner.span()]));
        }
        all
    }

    #[test]
    fn a_token_is_the_longest_that_begins_there() {
        let alone = |text| match tokens(text).as_slice() {
            [(kind, whole)] if *whole == text => *kind,
            other => panic!("{text}: {other:?}"),
        };
        for (kind, texts) in [
            (Kind::Name, ["ifx", "_1", "é_2", "End_Iff"]),
            (Kind::Prefix, ["INT#", "t#", "colour#", "DT#"]),
            (Kind::Integer, ["0", "1_000", "12__", "9"]),
            (Kind::Based, ["16#FF", "2#", "8#7_7", "16#gh"]),
            (Kind::Real, ["1.5", "1e5", "1.5E-3", "1_0.0_0e+1_0"]),
            (Kind::Time, ["T#5s", "ltime#-1.5h", "TIME#+1d_2h", "t#1.5.5"]),
            (Kind::Date, ["D#2024-02-29", "tod#12:30:00.5", "DT#2024-1-1-0:0:0", "ldate#1"]),
            (Kind::Text, ["''", "'a$'b'", "'$$'", "'é$é'"]),
            (Kind::WideText, ["\"\"", "\"a$\"b\"", "\"'\"", "\"ü\""]),
            (Kind::Address, ["%IX0.3", "%q*", "%MW1.2.3", "%I5"]),
            (Kind::Part, ["%X3", "%b0", "%w12", "%L1"]),
            (Kind::Comment, ["(* (* *) *)", "/* (* */", "// x", "(* open"]),
            (Kind::Pragma, ["{x}", "{{ a } b }}", "{open", "{}"]),
            (Kind::FunctionBlock, ["FUNCTION_BLOCK", "function_block", "Function_Block", "fUNCTION_bLOCK"]),
        ] {
            texts.into_iter().for_each(|it| assert_eq!(alone(it), kind, "{it}"));
        }
    }

    #[test]
    fn what_follows_a_token_begins_another_one() {
        let kinds = |text| tokens(text).into_iter().map(|it| it.0).collect::<Vec<_>>();
        assert_eq!(kinds("1..5"), [Kind::Integer, Kind::DotDot, Kind::Integer]);
        assert_eq!(kinds("1.e5"), [Kind::Integer, Kind::Dot, Kind::Name]);
        assert_eq!(kinds("a**=b"), [Kind::Name, Kind::Power, Kind::Equal, Kind::Name]);
        assert_eq!(kinds("'a$\nb"), [Kind::OpenText, Kind::Unknown, Kind::Name]);
        assert_eq!(kinds("%Z|?="), [Kind::Percent, Kind::Name, Kind::Unknown, Kind::Attempt]);
        assert_eq!(kinds("D#2024-x"), [Kind::Date, Kind::Minus, Kind::Name]);
    }

    #[test]
    fn each_keyword_is_found_in_any_case() {
        for word in ["IF", "if", "END_CONFIGURATION", "__TRY", "mod", "Var_In_Out", "OR_ELSE", "TO", "By"] {
            let [(kind, _)] = tokens(word)[..] else { panic!("{word}") };
            assert_eq!(kind.keyword(), Some(word.to_ascii_uppercase().as_str()));
        }
    }
}
