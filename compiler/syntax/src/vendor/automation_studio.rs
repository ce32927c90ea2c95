//! Files `.var` of B&R's Automation Studio: VAR blocks alone, whose variables are those of the programs in their folder, or of all.

use super::assembly::{Assembly, Chunk};
use super::scl::token::{Kind, Tokens};

/// Whether a file with this name declares variables, types or functions.
pub fn is_list(path: &str) -> bool {
    let extension = path.rsplit_once('.').map_or("", |it| it.1);
    ["var", "typ", "fun"].iter().any(|it| it.eq_ignore_ascii_case(extension))
}

/// The blocks as VAR_GLOBAL; `None` where the file begins otherwise.
pub fn variables(path: &str, text: &str) -> Option<Assembly> {
    let is_it = path.rsplit_once('.').is_some_and(|it| it.1.eq_ignore_ascii_case("var"));
    let is_block =
        |it: &super::scl::token::Token| it.kind == Kind::Word && text[it.place.clone()].eq_ignore_ascii_case("VAR");
    let mut tokens = Tokens::new(text).filter(|it| it.kind != Kind::Pragma).peekable();
    if !is_it || !tokens.peek().is_some_and(is_block) {
        return None;
    }
    let (mut out, mut from) = (Assembly::default(), 0);
    for block in tokens.filter(is_block) {
        out.copy(text, &[Chunk::verbatim(from..block.place.start), Chunk::words("VAR_GLOBAL", &block.place)]);
        from = block.place.end;
    }
    out.copy(text, &[Chunk::verbatim(from..text.len())]);
    Some(out)
}
