//! The routines of a PROGRAM or FUNCTION_BLOCK: METHOD and ACTION. Their words are names everywhere else.

use chumsky::prelude::*;

use crate::{
    ast::{Access, Item, Modifiers, Name, Pou, PouKind, TypeSpec},
    lex::Kind,
    source::Span,
};

use super::{
    combinator::{Rule, ahead, name, reported, rule, token, word},
    declaration::type_spec,
    diagnostics, doc,
    parser::{In, TokenReader},
    recovery,
    token_class::is_pou_end,
    unsupported,
};

const ROUTINES: [(&str, PouKind, Kind); 2] =
    [("METHOD", PouKind::Method, Kind::EndMethod), ("ACTION", PouKind::Action, Kind::EndAction)];

/// Reads VAR blocks and statements: units hold routines, and these hold what units do.
type Contents = for<'t, 'p, 's> fn(&mut In<'t, 'p, 's>, &mut Pou<'s>);

/// The routine that begins here, with its end.
pub fn begins(input: &mut In<'_, '_, '_>) -> Option<(PouKind, Kind)> {
    if input.kind() != Kind::Name || input.kind_ahead(1) != Kind::Name {
        return None;
    }
    let word = input.here();
    let word = input.text(word);
    ROUTINES.iter().find(|it| word.eq_ignore_ascii_case(it.0)).map(|it| (it.1, it.2))
}

/// Takes a routine that begins here into the unit around it.
pub fn member<'s>(input: &mut In<'_, '_, 's>, owner: &mut Pou<'s>, contents: Contents) -> bool {
    let Some((kind, end)) = begins(input) else { return false };
    let holds = match owner.kind {
        PouKind::Program | PouKind::FunctionBlock => true,
        PouKind::Function | PouKind::Test | PouKind::Action | PouKind::Method => false,
    };
    if holds {
        owner.routines.push(routine(input, kind, end, contents));
    } else {
        let span = input.here();
        input.report(diagnostics::routine_of_no_class(span, kind, owner.kind));
        unsupported::skip_construct(input, end);
    }
    true
}

/// An ACTION that follows its POU, as exports of CODESYS have it. A METHOD there is misplaced.
pub fn following<'s>(input: &mut In<'_, '_, 's>, items: &mut [Item<'s>], contents: Contents) -> bool {
    let Some((kind, end)) = begins(input) else { return false };
    let is_class = |it: &&mut Pou<'s>| matches!(it.kind, PouKind::Program | PouKind::FunctionBlock);
    let owner = match items.last_mut() {
        Some(Item::Pou(pou)) => Some(pou).filter(is_class),
        Some(Item::Types(_) | Item::Globals(_) | Item::Configuration(_) | Item::Test(_)) | None => None,
    };
    match owner {
        Some(owner) if kind == PouKind::Action => owner.routines.push(routine(input, kind, end, contents)),
        Some(_) | None => {
            let span = input.here();
            input.report(diagnostics::routine_outside(span, kind));
            unsupported::skip_construct(input, end);
        }
    }
    true
}

fn routine<'s>(input: &mut In<'_, '_, 's>, kind: PouKind, end: Kind, contents: Contents) -> Pou<'s> {
    let first = input.number();
    let doc = doc::before(input.state(), first);
    let opened = input.take();
    let (modifiers, name, result) = input.parse(head(kind)).unwrap_or_else(|problem| {
        diagnostics::report(input, problem);
        recovery::go_to(input, problem);
        recovery::skip_head(input);
        (Modifiers::default(), Name { text: "", span: opened }, None)
    });
    input.eat(Kind::Semicolon);
    let mut pou = Pou { modifiers, result, doc, ..Pou::new(kind, name, opened.to(name.span)) };
    input.state().open.push((end, opened));
    contents(input, &mut pou);
    input.state().open.pop();
    if input.eat(end).is_none() {
        let found = input.kind();
        let is_awaited = input.state().open.iter().any(|it| it.0 == found);
        if (is_pou_end(found) || matches!(found, Kind::EndMethod | Kind::EndAction)) && !is_awaited {
            diagnostics::wrong_end(input, end, opened);
            input.take();
        } else {
            diagnostics::missing_end(input, end, opened);
        }
    }
    input.eat(Kind::Semicolon);
    if kind == PouKind::Action
        && let Some(block) = pou.blocks.first()
    {
        let it = diagnostics::variables_of_action(block.span);
        input.report(it);
        pou.blocks.clear();
    }
    pou
}

fn head<'t, 's: 't>(kind: PouKind) -> impl Rule<'t, 's, (Modifiers, Name<'s>, Option<TypeSpec<'s>>)> {
    let is_method = ahead(move |_| kind == PouKind::Method);
    let result = is_method.ignore_then(token(Kind::Colon)).ignore_then(type_spec()).map(Some);
    // An ACTION's name may have a colon after it.
    let none = rule(move |input| {
        if kind == PouKind::Action {
            input.eat(Kind::Colon);
        }
        Ok(None)
    });
    let no_colon = ahead(move |input| kind == PouKind::Action || input.kind() != Kind::Colon);
    let result = result.or(no_colon.ignore_then(none));
    modifiers().then(name()).then(result).map(|((modifiers, name), result)| (modifiers, name, result))
}

/// `PUBLIC`, `FINAL` and the like before a name.
pub fn modifiers<'t, 's: 't>() -> impl Rule<'t, 's, Modifiers> {
    let accesses = [
        ("PUBLIC", Access::Public),
        ("PRIVATE", Access::Private),
        ("PROTECTED", Access::Protected),
        ("INTERNAL", Access::Internal),
    ];
    let access = choice(accesses.map(|(text, access)| before_name(text).map(move |span| (Some(access), span))));
    let is_final = before_name("FINAL").map(|span| (None, span));
    let known = access.or(is_final).map(Some);
    let refused = choice(["ABSTRACT", "OVERRIDE"].map(|text| {
        reported(before_name(text), move |span, state, _| {
            state.report(diagnostics::unsupported(span, text));
            None
        })
    }));
    empty().to(Modifiers::default()).foldl(known.or(refused).repeated(), |mut all, it| {
        match it {
            Some((Some(access), span)) => all.access = Some((access, span)),
            Some((None, span)) => all.is_final = Some(span),
            None => {}
        }
        all
    })
}

/// A word before a name.
fn before_name<'t, 's: 't>(text: &'static str) -> impl Rule<'t, 's, Span> {
    ahead(|input| input.kind_ahead(1) == Kind::Name).ignore_then(word(text))
}
