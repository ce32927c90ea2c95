//! Layout of Structured Text: of its tokens, with comments and pragmas, so that files with mistakes are laid out, too.
//!
//! What is on lines of its own stays there: nothing is joined. Indentation is by blocks and brackets, spaces by the two tokens
//! they are between.

mod blocks;
mod columns;
mod file;
mod indent;
mod lines;
mod long;
mod print;
mod roles;
mod spacing;
mod token;

pub use file::{Refusal, bytes};

use crate::lex::Kind;
use indent::Layout;
use token::Token;

/// How a text is laid out.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Style {
    pub indent: Indent,
    /// Columns of a line, without the comment at its end.
    pub width: usize,
    pub keywords: Letters,
    /// What is in a POU stands to the right of its first line.
    pub indents_pous: bool,
}

impl Default for Style {
    fn default() -> Self {
        Self { indent: Indent::Spaces(4), width: 100, keywords: Letters::Upper, indents_pous: false }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Indent {
    Spaces(u8),
    /// Counts as four columns.
    Tab,
}

impl Indent {
    fn width(self) -> usize {
        match self {
            Self::Spaces(count) => count.into(),
            Self::Tab => 4,
        }
    }
}

/// The letters of keywords.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Letters {
    Upper,
    Lower,
    AsWritten,
}

/// The text of a whole file. `None` where its layout would change what it says, which is a mistake of the formatter.
pub fn whole(text: &str, style: &Style) -> Option<String> {
    let mut laid_out = part(text, style)?;
    if !laid_out.is_empty() && !laid_out.ends_with('\n') {
        laid_out.push_str(line_end(text));
    }
    Some(laid_out)
}

/// A part of a file, as a vendor's editor keeps it: it ends with a line break only where it did.
pub fn part(text: &str, style: &Style) -> Option<String> {
    let tokens = token::read(text);
    let blocks = blocks::Blocks::of(&tokens);
    let roles = roles::roles(&tokens, &blocks);
    let code = next_code(&tokens);
    let layout = Layout { tokens: &tokens, blocks: &blocks, roles: &roles, code: &code, style };
    let mut breaks = lines::breaks(layout);
    long::shorten(layout, &mut breaks);
    let mut lines = columns::lines(layout, &breaks);
    columns::align(&mut lines);
    let mut laid_out = print::print(&lines, style);
    if text.trim_end_matches([' ', '\t', '\r']).ends_with('\n') && !laid_out.is_empty() && !laid_out.ends_with('\n') {
        laid_out.push('\n');
    }
    if line_end(text) == "\r\n" {
        laid_out = laid_out.replace("\r\n", "\n").replace('\n', "\r\n");
    }
    says_the_same(&tokens, &token::read(&laid_out)).then_some(laid_out)
}

/// For each token the next one that is no comment; comments at the end of the text are left out.
fn next_code(tokens: &[Token<'_>]) -> Vec<usize> {
    let last = tokens.iter().rposition(|it| !it.is_aside());
    let mut next = last.unwrap_or(0);
    let mut code: Vec<_> = (0..last.map_or(0, |it| it + 1)).collect();
    for at in code.iter_mut().rev() {
        if tokens[*at].is_aside() {
            *at = next;
        } else {
            next = *at;
        }
    }
    code
}

/// What ends the first line of a text.
fn line_end(text: &str) -> &'static str {
    let first = text.find('\n').unwrap_or(0);
    if text[..first].ends_with('\r') { "\r\n" } else { "\n" }
}

/// The lines of a comment; one that is not closed may end with blank ones.
fn lines(comment: &str) -> impl Iterator<Item = &str> {
    comment.trim_end().lines().map(str::trim_end)
}

/// Whether two texts have the same tokens and comments.
fn says_the_same(a: &[Token<'_>], b: &[Token<'_>]) -> bool {
    let is_same = |(a, b): (&Token<'_>, &Token<'_>)| {
        a.kind == b.kind
            && match a.kind {
                Kind::Comment | Kind::Pragma => lines(a.text).eq(lines(b.text)),
                Kind::Name => a.text.eq_ignore_ascii_case(b.text),
                kind if kind.keyword().is_some() => true,
                _ => a.text == b.text,
            }
    };
    a.len() == b.len() && a.iter().zip(b).all(is_same)
}

#[cfg(test)]
mod tests;
