//! The routines of a PROGRAM or FUNCTION_BLOCK: METHOD, ACTION and PROPERTY. Their words are names everywhere else.

use chumsky::prelude::*;

use crate::{
    ast::{
        Access, Expr, ExprKind, Item, Modifiers, Name, Pou, PouKind, Statement, StatementKind, TypeKind, TypeSpec,
        VarBlock, VarDecl, VarKind,
    },
    lex::Kind,
    source::Span,
};

use super::{
    combinator::{Rule, ahead, name, rule, token},
    declaration::{ACCESSES, access, before_name, type_spec},
    diagnostics, doc,
    expression::expression,
    parser::{In, TokenReader},
    pragma::attributes_here,
    recovery,
    token_class::is_end,
    unsupported,
};

const ROUTINES: [(&str, PouKind, Kind); 5] = [
    ("METHOD", PouKind::Method, Kind::EndMethod),
    ("ACTION", PouKind::Action, Kind::EndAction),
    (PROPERTY, PouKind::Getter, Kind::EndProperty),
    ("PROPERTY_GET", PouKind::Getter, Kind::EndProperty),
    ("PROPERTY_SET", PouKind::Setter, Kind::EndProperty),
];

/// With GET and SET inside.
const PROPERTY: &str = "PROPERTY";

const ACCESSORS: [(&str, PouKind, Kind); 2] =
    [("GET", PouKind::Getter, Kind::EndGet), ("SET", PouKind::Setter, Kind::EndSet)];

/// Reads VAR blocks and statements: units hold routines, and these hold what units do.
type Contents = for<'t, 'p, 's> fn(&mut In<'t, 'p, 's>, &mut Pou<'s>);

/// The routine that begins here, with its end.
pub fn begins(input: &mut In<'_, '_, '_>) -> Option<(PouKind, Kind)> {
    let before = modifiers_ahead(input);
    let next = input.kind_ahead(before + 1);
    // A reserved word in the place of the name is reported where it is read.
    let at = input.number() + before;
    let (here, after) = (input.state().place(at), input.state().place(at + 1));
    let is_reserved = next.keyword().is_some() && !input.state().breaks(here.end, after.start);
    if input.kind_ahead(before) != Kind::Name || next != Kind::Name && !is_reserved {
        return None;
    }
    let word = input.text(here);
    let found = ROUTINES.iter().find(|it| word.eq_ignore_ascii_case(it.0)).map(|it| (it.1, it.2));
    // An ACTION has no modifiers.
    found.filter(|it| before == 0 || it.0 != PouKind::Action)
}

/// How many words there are as in `PUBLIC METHOD`, which is another order than the standard's, and as clear.
fn modifiers_ahead(input: &mut In<'_, '_, '_>) -> usize {
    let is_modifier = |word: &str| {
        let accesses = ACCESSES.iter().map(|it| it.0);
        accesses.chain(["FINAL", "ABSTRACT", "OVERRIDE"]).any(|it| word.eq_ignore_ascii_case(it))
    };
    (0..)
        .take_while(|ahead| {
            let at = input.number() + ahead;
            let place = input.state().place(at);
            input.kind_ahead(*ahead) == Kind::Name && is_modifier(input.text(place))
        })
        .count()
}

/// Takes a routine that begins here into the unit around it.
pub fn member<'s>(input: &mut In<'_, '_, 's>, owner: &mut Pou<'s>, contents: Contents) -> bool {
    let Some((kind, end)) = begins(input) else { return false };
    if owner.kind.has_routines() {
        owner.routines.extend(routine(input, kind, end, contents));
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
    let is_class = |it: &&mut Pou<'s>| it.kind.has_routines();
    let is_first = items.is_empty();
    let owner = match items.last_mut() {
        Some(Item::Pou(pou)) => Some(pou).filter(is_class),
        Some(Item::Types(_) | Item::Globals(_) | Item::Configuration(_) | Item::Test(_)) | None => None,
    };
    match owner {
        Some(owner) if kind == PouKind::Action => owner.routines.extend(routine(input, kind, end, contents)),
        None if kind == PouKind::Action && is_first => {
            let span = input.here();
            let found = routine(input, kind, end, contents);
            let found = found.into_iter().map(|it| (it, diagnostics::routine_outside(span, kind)));
            input.state().apart.extend(found);
        }
        Some(_) | None => {
            let span = input.here();
            input.report(diagnostics::routine_outside(span, kind));
            unsupported::skip_construct(input, end);
        }
    }
    true
}

/// `ACTIONS Pou … END_ACTIONS`, as RuSTy writes those of a POU; without a name, of the one before.
pub fn actions<'s>(input: &mut In<'_, '_, 's>, items: &mut [Item<'s>], contents: Contents) -> bool {
    if !input.is_word("ACTIONS") || input.kind_ahead(1) != Kind::Name {
        return false;
    }
    let word = input.take();
    let of = (begins(input).is_none() && !input.is_word("END_ACTIONS")).then(|| input.take());
    let name = of.map(|it| input.text(it));
    let is_meant =
        |it: &&mut Pou<'s>| it.kind.has_routines() && name.is_none_or(|name| it.name.text.eq_ignore_ascii_case(name));
    let pous = items.iter_mut().rev().filter_map(|it| match it {
        Item::Pou(pou) => Some(pou),
        Item::Types(_) | Item::Globals(_) | Item::Configuration(_) | Item::Test(_) => None,
    });
    let mut found = Vec::new();
    while let Some((kind, end)) = begins(input) {
        found.extend(routine(input, kind, end, contents));
    }
    if input.is_word("END_ACTIONS") {
        input.take();
    }
    match pous.take(if name.is_some() { usize::MAX } else { 1 }).find(is_meant) {
        Some(owner) => owner.routines.append(&mut found),
        None => input.report(diagnostics::routine_outside(of.unwrap_or(word), PouKind::Action)),
    }
    true
}

fn routine<'s>(input: &mut In<'_, '_, 's>, kind: PouKind, end: Kind, contents: Contents) -> Vec<Pou<'s>> {
    let first = input.number();
    let doc = doc::before(input.state(), first);
    let attributes = attributes_here(input);
    let before = input.parse(modifiers()).unwrap_or_default();
    let opened = input.take();
    let (modifiers, name, result) = input.parse(head(kind)).unwrap_or_else(|problem| {
        diagnostics::report(input, problem);
        recovery::go_to(input, problem);
        recovery::skip_head(input);
        (Modifiers::default(), Name { text: "", span: opened }, None)
    });
    let is_property = input.text(opened).eq_ignore_ascii_case(PROPERTY);
    let starts_with = if is_property { start_of_property(input) } else { None };
    input.eat(Kind::Semicolon);
    let modifiers = modifiers.or(before);
    let mut pou = Pou { modifiers, result, attributes, doc, ..Pou::new(kind, name, opened.to(name.span)) };
    if is_property {
        return property(input, (&pou, starts_with), opened, contents);
    }
    take_value(&mut pou);
    body(input, &mut pou, end, opened, contents);
    if kind == PouKind::Action
        && let Some(block) = pou.blocks.first()
    {
        let it = diagnostics::variables_of_action(block.span);
        input.report(it);
        pou.blocks.clear();
    }
    vec![pou]
}

/// `PROPERTY State : INT := 3`: what its GET gives where it assigns nothing, as TwinCAT has it.
fn start_of_property<'s>(input: &mut In<'_, '_, 's>) -> Option<Expr<'s>> {
    input.eat(Kind::Assign)?;
    let value = expression(input);
    value.map_err(|problem| diagnostics::report(input, problem)).ok()
}

fn assigned<'s>(name: Name<'s>, value: Expr<'s>) -> Statement<'s> {
    let span = value.span;
    let target = Expr { kind: ExprKind::Name(name), span: name.span };
    Statement { kind: StatementKind::Assign { target, value }, span }
}

/// VAR blocks and statements up to an end.
fn body<'s>(input: &mut In<'_, '_, 's>, pou: &mut Pou<'s>, end: Kind, opened: Span, contents: Contents) {
    input.state().open.push((end, opened));
    contents(input, pou);
    input.state().open.pop();
    close(input, end, opened);
    pou.extent = opened.to(input.last());
}

fn close(input: &mut In<'_, '_, '_>, end: Kind, opened: Span) {
    if input.eat(end).is_none() {
        let found = input.kind();
        let is_awaited = input.state().open.iter().any(|it| it.0 == found);
        if is_end(found) && !is_awaited {
            diagnostics::wrong_end(input, end, opened);
            input.take();
        } else {
            diagnostics::missing_end(input, end, opened);
        }
    }
    input.eat(Kind::Semicolon);
}

/// GET and SET, up to END_PROPERTY.
fn property<'s>(
    input: &mut In<'_, '_, 's>,
    (head, starts_with): (&Pou<'s>, Option<Expr<'s>>),
    opened: Span,
    contents: Contents,
) -> Vec<Pou<'s>> {
    let mut accessors: Vec<Pou<'s>> = Vec::new();
    let mut head = head.clone();
    if head.result.is_none() {
        input.report(diagnostics::property_without_type(head.span));
        head.result = Some(TypeSpec { kind: TypeKind::Error, span: head.span });
    }
    input.state().open.push((Kind::EndProperty, opened));
    while let Some((_, kind, end)) = ACCESSORS.iter().copied().find(|it| input.is_word(it.0)) {
        let opened = input.take();
        let mut pou = Pou { kind, ..head.clone() };
        // TwinCAT's accessors may have words of their own.
        while let Some((_, access)) = ACCESSES.iter().copied().find(|it| input.is_word(it.0) && !is_assigned(input)) {
            pou.modifiers.access = Some((access, input.take()));
        }
        take_value(&mut pou);
        let is_head = head_only(input);
        if is_head {
            input.eat(Kind::Semicolon);
        } else {
            body(input, &mut pou, end, opened, contents);
            let value = starts_with.clone().filter(|_| kind == PouKind::Getter);
            pou.body.splice(0..0, value.map(|it| assigned(head.name, it)));
        }
        accessors.push(pou);
    }
    input.state().open.pop();
    if accessors.is_empty() {
        input.report(diagnostics::property_without_accessors(head.span));
    }
    close(input, Kind::EndProperty, opened);
    accessors
}

/// Whether the word here is a name that a statement begins with.
fn is_assigned(input: &mut In<'_, '_, '_>) -> bool {
    matches!(input.kind_ahead(1), Kind::Assign | Kind::Dot | Kind::OpenParen | Kind::OpenBracket | Kind::Caret)
}

/// Whether GET or SET has no body, as in an INTERFACE.
fn head_only(input: &mut In<'_, '_, '_>) -> bool {
    let next = usize::from(input.kind() == Kind::Semicolon);
    input.kind_ahead(next) == Kind::EndProperty || ACCESSORS.iter().any(|it| next == 0 && input.is_word(it.0))
}

/// What is assigned to a PROPERTY is an input of its SET, by its own name.
fn take_value(pou: &mut Pou<'_>) {
    if pou.kind != PouKind::Setter {
        return;
    }
    let (names, span) = (vec![pou.name], pou.name.span);
    pou.blocks.extend(
        pou.result
            .take()
            .map(|ty| VarBlock { vars: vec![VarDecl::new(names, ty, span)], ..VarBlock::new(VarKind::Input, span) }),
    );
}

fn head<'t, 's: 't>(kind: PouKind) -> impl Rule<'t, 's, (Modifiers, Name<'s>, Option<TypeSpec<'s>>)> {
    let has_result = ahead(move |_| kind != PouKind::Action);
    let result = has_result.ignore_then(token(Kind::Colon)).ignore_then(type_spec()).map(Some);
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
    let word = |text, what: fn(&mut Modifiers, Span)| before_name(text).map(move |span| (what, span));
    let words = choice((
        word("FINAL", |all, span| all.is_final = Some(span)),
        word("ABSTRACT", |all, span| all.is_abstract = Some(span)),
        word("OVERRIDE", |all, span| all.overrides = Some(span)),
    ));
    let set = access().map(|it| Modifier::Access(it.0, it.1)).or(words.map(|(set, span)| Modifier::Word(set, span)));
    empty().to(Modifiers::default()).foldl(set.repeated(), |mut all, it| {
        match it {
            Modifier::Access(_, span) if all.access.is_some() => all.again = Some(span),
            Modifier::Access(access, span) => all.access = Some((access, span)),
            Modifier::Word(set, span) => set(&mut all, span),
        }
        all
    })
}

#[derive(Clone, Copy)]
enum Modifier {
    Access(Access, Span),
    Word(fn(&mut Modifiers, Span), Span),
}
