//! Constructs that are known and refused by name: METHOD, INTERFACE, NAMESPACE and the like.
//! Their words are names everywhere else.

use crate::lex::Kind;

use super::{
    diagnostics,
    parser::{In, Moves},
    recover,
};

const CONSTRUCTS: [(&str, Kind); 6] = [
    ("METHOD", Kind::EndMethod),
    ("PROPERTY", Kind::EndProperty),
    ("ACTION", Kind::EndAction),
    ("INTERFACE", Kind::EndInterface),
    ("CLASS", Kind::EndClass),
    ("NAMESPACE", Kind::EndNamespace),
];

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
    let jump = ["JMP", "USING"].into_iter().find(|it| word.eq_ignore_ascii_case(it));
    if let Some(name) = jump {
        input.report(diagnostics::unsupported(span, name));
        recover::skip_statement(input, span);
        return true;
    }
    false
}

/// Behind the construct's end; a construct without one ends before the next POU.
fn skip_construct(input: &mut In<'_, '_, '_>, end: Kind) {
    let holds_units = end == Kind::EndNamespace;
    loop {
        let kind = input.kind();
        let leaves = recover::opens_item(kind) || recover::is_pou_end(kind);
        if kind == Kind::End || (leaves && !holds_units) {
            return;
        }
        input.take();
        if kind == end {
            input.eat(Kind::Semicolon);
            return;
        }
    }
}
