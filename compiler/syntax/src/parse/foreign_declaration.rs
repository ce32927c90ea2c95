//! Declarations as C and languages like it write them, among those of a VAR block: `int *p;`, `float x = 1.0;`,
//! `char name[20];`, `const int K = 5;`, `let x: i32 = 5;`. Each is reported once, with the declaration that is meant.

use crate::{
    ast::{Name, TypeKind, TypeSpec, VarDecl},
    diagnostic::{Code, Diagnostic},
    lex::Kind,
    source::Span,
};
use staunch_ir::Elementary;

use super::{
    foreign_reader::type_of_ours,
    parser::{In, TokenReader},
};

/// What other languages write before a type or a name.
const QUALIFIERS: [&str; 12] =
    ["const", "static", "volatile", "let", "mut", "var", "dim", "unsigned", "signed", "extern", "register", "final"];

/// Blocks that are written before their instance's name, as a class is elsewhere.
const BLOCKS: [&str; 12] =
    ["TON", "TOF", "TP", "CTU", "CTD", "CTUD", "R_TRIG", "F_TRIG", "SR", "RS", "TIMER", "COUNTER"];

/// The parts of such a declaration, as token numbers.
#[derive(Default)]
struct Shape {
    /// The words before the name.
    words: usize,
    stars: usize,
    name: usize,
    /// The length in each pair of brackets after the name.
    lengths: Vec<usize>,
    /// The type after a `:`.
    ty: Option<usize>,
    /// The first and the last token of the value.
    value: Option<(usize, usize)>,
    /// Of the `;`.
    end: usize,
}

/// Takes such a declaration, and reports it.
pub fn read<'s>(input: &mut In<'_, '_, 's>) -> Option<VarDecl<'s>> {
    // Each declaration is looked at: its second token decides first.
    if !matches!(input.kind_ahead(1), Kind::Name | Kind::Star | Kind::Power) || input.state().instead.is_some() {
        return None;
    }
    let shape = shape(input).filter(|it| is_foreign(input, it))?;
    let at = input.number() + shape.name;
    let span = input.state().place(at);
    let name = Name { text: input.text(span), span };
    let whole = input.here();
    let end = input.number() + shape.end;
    let whole = whole.to(input.state().place(end - 1));
    let (declaration, value) = declared(input, &shape, name.text);
    let error = report(whole, &shape);
    input.report(match value {
        Some(value) => {
            let meant = declaration + &value;
            error.help(format!("write `{meant}`")).fix(whole, meant)
        }
        None => error.help(format!("write `{declaration} := …`")),
    });
    while input.number() <= end {
        input.take();
    }
    let ty = TypeSpec { kind: TypeKind::Error, span: whole };
    Some(VarDecl::new(vec![name], ty, whole))
}

/// What is wrong with such a declaration.
fn report(whole: Span, shape: &Shape) -> Diagnostic {
    let message = if shape.stars > 0 {
        "a pointer is declared with POINTER TO, after its name"
    } else if !shape.lengths.is_empty() {
        "an array is declared with ARRAY and its first and last index, after its name"
    } else {
        "a declaration is a name, `:` and a type"
    };
    Diagnostic::new(Code::E0001, whole, message).label("expected a name, `:` and a type")
}

/// What is declared, and its value as it is appended; none where the value cannot be written here.
fn declared(input: &mut In<'_, '_, '_>, shape: &Shape, name: &str) -> (String, Option<String>) {
    let first = input.number();
    let mut text = |at: usize| {
        let span = input.state().place(first + at);
        input.text(span)
    };
    let words: Vec<&str> = match shape.ty {
        Some(at) => vec![text(at)],
        None => (0..shape.words).map(&mut text).collect(),
    };
    let value = match shape.value {
        None => Some(String::new()),
        Some((from, to)) if to == from || to == from + 1 && text(from) == "-" => {
            let sign = if to == from { "" } else { "-" };
            Some(format!(" := {sign}{}", text(to)))
        }
        Some(_) => None,
    };
    let element = element(&words);
    let lengths: Vec<&str> = shape.lengths.iter().map(|it| text(*it)).collect();
    let is_text = matches!(words.as_slice(), [word] if word.eq_ignore_ascii_case("char"));
    let mut ty = match lengths.as_slice() {
        [] => element.to_owned(),
        [length] if is_text => format!("STRING[{length}]"),
        _ => {
            let bound =
                |it: &&str| it.parse::<u64>().map_or(format!("0..{it} - 1"), |it| format!("0..{}", it.max(1) - 1));
            let bounds: Vec<String> = lengths.iter().map(bound).collect();
            format!("ARRAY[{}] OF {element}", bounds.join(", "))
        }
    };
    ty.insert_str(0, &"POINTER TO ".repeat(shape.stars));
    (format!("{name} : {ty}"), value)
}

/// The type that such words mean: `unsigned long` is UDINT.
fn element<'w>(words: &[&'w str]) -> &'w str {
    let is = |word: &str| words.iter().any(|it| it.eq_ignore_ascii_case(word));
    if is("unsigned") {
        let sizes = [("char", "USINT"), ("short", "UINT"), ("long", "UDINT")];
        return sizes.iter().find(|it| is(it.0)).map_or("UINT", |it| it.1);
    }
    let mut plain = words.iter().copied().filter(|it| !QUALIFIERS.iter().any(|of| it.eq_ignore_ascii_case(of)));
    let ty = plain.next_back();
    ty.and_then(type_of_ours).or(ty).unwrap_or("INT")
}

/// Whether nobody declares a variable in Structured Text so, with one slip.
fn is_foreign(input: &mut In<'_, '_, '_>, shape: &Shape) -> bool {
    let first = input.here();
    let first = input.text(first);
    let at = input.number() + 1;
    let second = input.state().place(at);
    let second = input.text(second);
    let is_one_of = |words: &[&str], word: &str| words.iter().any(|it| word.eq_ignore_ascii_case(it));
    let is_qualified = is_one_of(&QUALIFIERS, first);
    if shape.ty.is_some() {
        return is_qualified;
    }
    let is_type = |word: &str| type_of_ours(word).is_some() || is_one_of(&BLOCKS, word);
    let is_our_own = Elementary::named(first).is_some();
    match shape.words {
        _ if shape.stars > 0 => true,
        1 if !shape.lengths.is_empty() => !is_type(second),
        1 => is_qualified || (is_type(first) && !is_our_own && !is_type(second)),
        _ => is_qualified || is_type(first),
    }
}

/// The shape of what is here up to its `;`, if it can be such a declaration.
fn shape(input: &mut In<'_, '_, '_>) -> Option<Shape> {
    let mut shape = Shape::default();
    let mut at = 0;
    while input.kind_ahead(at) == Kind::Name {
        at += 1;
    }
    shape.words = at;
    // `**` is one token.
    while let kind @ (Kind::Star | Kind::Power) = input.kind_ahead(at) {
        shape.stars += if kind == Kind::Power { 2 } else { 1 };
        at += 1;
    }
    if shape.stars == 0 {
        shape.words = at.checked_sub(1)?;
        at = shape.words;
    }
    shape.name = at;
    if input.kind_ahead(at) != Kind::Name {
        return None;
    }
    at += 1;
    if input.kind_ahead(at) == Kind::Colon && input.kind_ahead(at + 1) == Kind::Name {
        shape.ty = Some(at + 1);
        at += 2;
    }
    while input.kind_ahead(at) == Kind::OpenBracket {
        if !matches!(input.kind_ahead(at + 1), Kind::Integer | Kind::Name)
            || input.kind_ahead(at + 2) != Kind::CloseBracket
        {
            return None;
        }
        shape.lengths.push(at + 1);
        at += 3;
    }
    if matches!(input.kind_ahead(at), Kind::Equal | Kind::Assign) {
        let from = at + 1;
        at = from;
        while is_of_a_value(input.kind_ahead(at)) {
            at += 1;
        }
        shape.value = Some((from, at.checked_sub(1).filter(|it| *it >= from)?));
    }
    shape.end = at;
    (input.kind_ahead(at) == Kind::Semicolon).then_some(shape)
}

/// What a value is made of on one line: no keyword and no `;`.
fn is_of_a_value(kind: Kind) -> bool {
    kind != Kind::Semicolon
        && kind != Kind::End
        && (kind.keyword().is_none() || matches!(kind, Kind::True | Kind::False))
}
