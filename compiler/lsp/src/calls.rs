//! Calls as they are written, found by their brackets: a call that is being typed has no syntax tree.

use staunch_frontend::Span;
use staunch_syntax::lex::{Kind, lex};

/// `name(…)`
#[derive(Clone, Debug)]
pub struct Call {
    /// The last name before the bracket, or before the index or the `^` in front of it.
    pub name: Span,
    /// The bracket that opens it.
    pub open: u32,
    /// The one that closes it, or the end of the text.
    pub close: u32,
    pub arguments: Vec<Argument>,
    /// What is between the arguments.
    commas: Vec<u32>,
}

#[derive(Clone, Copy, Debug)]
pub struct Argument {
    /// From its first token to its last; empty where nothing is written.
    pub span: Span,
    /// `IN := x`, `Q => y`: its name.
    pub name: Option<Span>,
}

/// All calls of a text, each before those in its arguments.
pub fn calls(file: u16, text: &str) -> Vec<Call> {
    let tokens = lex(file, text);
    let tokens: Vec<_> = tokens.kinds.iter().copied().zip(tokens.places.iter().copied()).collect();
    let span = |(start, end): (u32, u32)| Span { file, start, end };
    let mut found: Vec<Call> = Vec::new();
    // The call that each open bracket began, if it did.
    let mut open: Vec<Option<usize>> = Vec::new();
    for (at, (kind, place)) in tokens.iter().enumerate() {
        let before = at.checked_sub(1).map(|it| tokens[it]);
        match kind {
            Kind::OpenParen => {
                let named = callee(&tokens[..at]);
                if named.is_none() {
                    extend(&mut found, &open, span(*place));
                }
                open.push(named.map(|name| {
                    found.push(Call {
                        name: span(name),
                        open: place.0,
                        close: u32::MAX,
                        arguments: Vec::new(),
                        commas: Vec::new(),
                    });
                    found.len() - 1
                }));
            }
            Kind::OpenBracket => {
                extend(&mut found, &open, span(*place));
                open.push(None);
            }
            Kind::CloseParen | Kind::CloseBracket => {
                if let Some(Some(call)) = open.pop() {
                    found[call].close = place.0;
                }
                extend(&mut found, &open, span(*place));
            }
            Kind::Comma => {
                if let Some(Some(call)) = open.last() {
                    let call = &mut found[*call];
                    call.commas.push(place.0);
                    if call.arguments.is_empty() {
                        call.arguments.push(Argument { span: span((place.0, place.0)), name: None });
                    }
                    call.arguments.push(Argument { span: span((place.1, place.1)), name: None });
                }
            }
            // A call ends with its statement, whether it is closed or not.
            Kind::Semicolon => open.clear(),
            Kind::Assign | Kind::Arrow => {
                if let (Some(Some(call)), Some((Kind::Name, name))) = (open.last(), before)
                    && let Some(argument) = found[*call].arguments.last_mut()
                    && argument.span.start == name.0
                {
                    argument.name = Some(span(name));
                }
                extend(&mut found, &open, span(*place));
            }
            _ => extend(&mut found, &open, span(*place)),
        }
    }
    found
}

/// The name of what is called, of the tokens before the bracket: `f`, `a[i]`, `p^`.
fn callee(tokens: &[(Kind, (u32, u32))]) -> Option<(u32, u32)> {
    let mut depth = 0usize;
    for (kind, place) in tokens.iter().rev() {
        match kind {
            Kind::CloseBracket => depth += 1,
            Kind::OpenBracket => depth = depth.checked_sub(1)?,
            Kind::Semicolon => return None,
            _ if depth > 0 => {}
            Kind::Caret => {}
            Kind::Name => return Some(*place),
            _ => return None,
        }
    }
    None
}

/// Adds a token to the last argument of the calls around it.
fn extend(found: &mut [Call], open: &[Option<usize>], token: Span) {
    let mut is_innermost = true;
    for call in open.iter().rev().flatten() {
        let arguments = &mut found[*call].arguments;
        match arguments.last_mut() {
            None => arguments.push(Argument { span: token, name: None }),
            Some(it) if it.span.start == it.span.end && is_innermost => it.span = token,
            Some(it) => it.span.end = token.end,
        }
        is_innermost = false;
    }
}

/// The innermost call around a place, and the number of the argument there.
pub fn around(calls: &[Call], offset: u32) -> Option<(&Call, usize)> {
    let call = calls.iter().rev().find(|it| it.open < offset && offset <= it.close)?;
    Some((call, call.commas.iter().filter(|it| **it < offset).count()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arguments_are_found_while_they_are_typed() {
        let text = "t(IN := f(1, (2)), PT := T#1s); g(a,";
        let found = calls(0, text);
        let part = |it: Span| &text[it.start as usize..it.end as usize];
        let shown: Vec<_> = found
            .iter()
            .map(|it| (part(it.name), it.arguments.iter().map(|it| part(it.span)).collect::<Vec<_>>()))
            .collect();
        assert_eq!(
            shown,
            [("t", vec!["IN := f(1, (2))", "PT := T#1s"]), ("f", vec!["1", "(2)"]), ("g", vec!["a", ""])]
        );
        assert_eq!(found[0].arguments[1].name.map(part), Some("PT"));
        let (call, argument) = around(&found, 11).expect("in the inner call");
        assert_eq!((part(call.name), argument), ("f", 0));
        let (call, argument) = around(&found, text.len() as u32).expect("after the comma");
        assert_eq!((part(call.name), argument), ("g", 1));
    }
}
