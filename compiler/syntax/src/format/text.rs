//! A text, from its tokens to its lines; and whether these say the same.

use super::indent::Layout;
use super::style::Style;
use super::token::{self, Token};
use super::{blocks, columns, lines, long, print, roles};
use crate::lex::Kind;

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

/// The blocks of a text that are closed, each from its first word to its last: `IF` to `END_IF`.
pub fn block_ranges(text: &str) -> Vec<core::ops::Range<usize>> {
    let tokens = token::read(text);
    // Each token is a part of the text.
    let start = |at: usize| tokens[at].text.as_ptr().addr() - text.as_ptr().addr();
    blocks::Blocks::of(&tokens).pairs.iter().map(|it| start(it.open)..start(it.close)).collect()
}

/// For each token the next one that is not a comment; comments at the end of the text are left out.
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
                // It is not closed on its line, whose blanks at the end go.
                Kind::OpenText => a.text.trim_end() == b.text.trim_end(),
                Kind::Name => a.text.eq_ignore_ascii_case(b.text),
                kind if kind.keyword().is_some() => true,
                _ => a.text == b.text,
            }
    };
    a.len() == b.len() && a.iter().zip(b).all(is_same)
}
