//! Constructs that are known and refused by name: PROPERTY, INTERFACE and the like.
//! Their words are names everywhere else.

use chumsky::prelude::*;

use crate::{lex::Kind, source::Span};

use super::{
    combinator::{Rule, ahead, name, reported, token, word},
    diagnostics,
    parser::{In, TokenReader},
    recovery,
    token_class::{is_pou_end, opens_item},
};

const CONSTRUCTS: [(&str, Kind); 3] =
    [("PROPERTY", Kind::EndProperty), ("INTERFACE", Kind::EndInterface), ("CLASS", Kind::EndClass)];

/// Refuses and skips such a construct, if one starts here.
pub fn skip(input: &mut In<'_, '_, '_>) -> bool {
    if input.kind_ahead(1) != Kind::Name {
        return false;
    }
    let span = input.here();
    let word = input.text(span);
    if let Some((name, end)) = CONSTRUCTS.iter().find(|(it, _)| word.eq_ignore_ascii_case(it)) {
        input.report(diagnostics::unsupported(span, name));
        skip_construct(input, *end);
        return true;
    }
    if word.eq_ignore_ascii_case("JMP") {
        input.report(diagnostics::unsupported(span, "JMP"));
        recovery::skip_statement(input, span);
        return true;
    }
    false
}

/// Behind the construct's end; a construct without one ends before the next POU.
pub fn skip_construct(input: &mut In<'_, '_, '_>, end: Kind) {
    loop {
        let kind = input.kind();
        let leaves = opens_item(kind) || is_pou_end(kind);
        if kind == Kind::End || leaves {
            return;
        }
        input.take();
        if kind == end {
            input.eat(Kind::Semicolon);
            return;
        }
    }
}

/// `EXTENDS a, b`, if it is there.
pub fn bases<'t, 's: 't>(keyword: &'static str) -> impl Rule<'t, 's, ()> {
    let refused = reported(word(keyword), move |span, state, _| state.report(diagnostics::unsupported(span, keyword)));
    let separator = token(Kind::Comma).or(token(Kind::Dot));
    let bases = refused.ignore_then(name().separated_by(separator).at_least(1));
    ahead(move |input| !input.is_word(keyword)).or(bases)
}

/// `PUBLIC` and the like after VAR.
pub fn access<'t, 's: 't>() -> impl Rule<'t, 's, Span> {
    choice(["PUBLIC", "PRIVATE", "PROTECTED", "INTERNAL"].map(refused_word))
}

/// A word before a name.
fn refused_word<'t, 's: 't>(text: &'static str) -> impl Rule<'t, 's, Span> {
    let before_name = ahead(|input| input.kind_ahead(1) == Kind::Name);
    reported(before_name.ignore_then(word(text)), move |span, state, _| {
        state.report(diagnostics::unsupported(span, text));
        span
    })
}
