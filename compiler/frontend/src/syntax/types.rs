//! Types and initial values.

use crate::{
    ast::{Bound, Element, EnumValue, Expr, ExprKind, Initial, InitialKind, Name, TypeDecl, TypeKind, TypeSpec},
    lex::Kind,
    source::Span,
};

use super::{
    block_ends, declaration, diagnostics, doc,
    expression::{close, expression},
    foreign_syntax,
    parser::{Expected, In, Moves, Parsed, Problem, Start},
    recover,
};

pub fn type_spec<'s>(input: &mut In<'_, '_, 's>) -> Parsed<TypeSpec<'s>> {
    let start = input.here();
    input.enter()?;
    let kind = match input.kind() {
        Kind::Array => array(input)?,
        Kind::Struct => structure(input)?,
        Kind::OpenParen => enumeration(input, None)?,
        Kind::Name => named(input)?,
        _ if foreign_syntax::brace_list(input, "(", ")") => TypeKind::Error,
        _ => return Err(input.problem(Expected::Type)),
    };
    input.leave();
    Ok(TypeSpec { kind, span: start.to(input.last()) })
}

/// `ARRAY[1..3, 0..4] OF T`
fn array<'s>(input: &mut In<'_, '_, 's>) -> Parsed<TypeKind<'s>> {
    let opened = input.take();
    let bracket = input.number();
    let round = input.kind() == Kind::OpenParen;
    if round {
        let span = input.take();
        input.report(diagnostics::array_bounds(span, "`(`", "ARRAY[1..3] OF INT"));
    } else {
        input.expect(Kind::OpenBracket)?;
    }
    let mut bounds = Vec::with_capacity(1);
    loop {
        bounds.push(bound(input)?);
        if input.eat(Kind::Comma).is_none() {
            break;
        }
    }
    close(input, if round { Kind::CloseParen } else { Kind::CloseBracket }, bracket)?;
    if input.eat(Kind::Of).is_none() {
        diagnostics::missing_word(input, Kind::Of, opened);
    }
    let element = Box::new(type_spec(input)?);
    // Bounds that did not parse make a type that is not known.
    match bounds.into_iter().collect() {
        Some(bounds) => Ok(TypeKind::Array { bounds, element }),
        None => Ok(TypeKind::Error),
    }
}

/// None for `10` and `1:3`, which are reported.
fn bound<'s>(input: &mut In<'_, '_, 's>) -> Parsed<Option<Bound<'s>>> {
    if let Some(span) = input.eat(Kind::Star) {
        return Ok(Some(Bound::Open(span)));
    }
    let low = expression(input)?;
    let kind = input.kind();
    if input.eat(Kind::DotDot).is_some() {
        return Ok(Some(Bound::Range(low, expression(input)?)));
    }
    if !matches!(kind, Kind::Colon | Kind::Comma | Kind::CloseBracket | Kind::CloseParen) {
        return Err(input.problem(Expected::Token(Kind::DotDot)));
    }
    let text = input.text(low.span);
    let Some(colon) = input.eat(Kind::Colon) else {
        input.report(
            diagnostics::array_bounds(low.span, "one number", &format!("1..{text}"))
                .fix(low.span, format!("1..{text}")),
        );
        return Ok(None);
    };
    let high = expression(input)?;
    let meant = format!("{text}..{}", input.text(high.span));
    input.report(diagnostics::array_bounds(colon, "`:`", &meant).fix(colon, ".."));
    Ok(None)
}

fn structure<'s>(input: &mut In<'_, '_, 's>) -> Parsed<TypeKind<'s>> {
    let opened = input.take();
    Ok(structure_behind(input, opened).kind)
}

/// The members of a structure, and its end.
pub fn structure_behind<'s>(input: &mut In<'_, '_, 's>, opened: Span) -> TypeSpec<'s> {
    let fields = declaration::list(input, Kind::EndStruct, opened);
    block_ends::close_block(input, Kind::EndStruct, opened);
    TypeSpec { kind: TypeKind::Struct(fields), span: opened.to(input.last()) }
}

/// `(Red, Green := 5)`, and a base type behind it.
fn enumeration<'s>(input: &mut In<'_, '_, 's>, base: Option<Name<'s>>) -> Parsed<TypeKind<'s>> {
    let opened = input.number();
    input.take();
    let mut values: Vec<EnumValue<'s>> = Vec::new();
    loop {
        let first = input.number();
        let name = input.name()?;
        let value = if assign(input) { Some(expression(input)?) } else { None };
        let mut more = input.eat(Kind::Comma).is_some();
        if !more && input.kind() == Kind::Name {
            diagnostics::missing_comma(input);
            more = true;
        }
        values.push(EnumValue { name, value, doc: doc::comment(input, first) });
        if !more {
            break;
        }
    }
    close(input, Kind::CloseParen, opened)?;
    let base = match base {
        None if input.kind() == Kind::Name => Some(input.name()?),
        base => base,
    };
    Ok(TypeKind::Enum { base, values })
}

/// A name and what may follow it: a length, a range, enumerators.
fn named<'s>(input: &mut In<'_, '_, 's>) -> Parsed<TypeKind<'s>> {
    if let Some(what) = reference(input) {
        return what;
    }
    let name = input.name()?;
    let wide = name.text.eq_ignore_ascii_case("WSTRING");
    if wide || name.text.eq_ignore_ascii_case("STRING") {
        return Ok(TypeKind::String { wide, capacity: capacity(input)? });
    }
    if input.kind() == Kind::OpenParen {
        return refined(input, name);
    }
    if input.kind() == Kind::OpenBracket && matches!(input.kind_ahead(1), Kind::Integer | Kind::Name) {
        return sized(input, name);
    }
    let mut path = vec![name];
    while input.eat(Kind::Dot).is_some() {
        path.push(input.name()?);
    }
    Ok(TypeKind::Named(path))
}

/// `INT[10]`, as other languages write an array.
fn sized<'s>(input: &mut In<'_, '_, 's>, element: Name<'s>) -> Parsed<TypeKind<'s>> {
    let opened = input.number();
    input.take();
    let length = expression(input)?;
    let high = if input.eat(Kind::DotDot).is_some() { Some(expression(input)?) } else { None };
    let end = close(input, Kind::CloseBracket, opened)?;
    let bounds = match high {
        Some(high) => input.text(length.span.to(high.span)).to_owned(),
        None => format!("1..{}", input.text(length.span)),
    };
    let meant = format!("ARRAY[{bounds}] OF {}", element.text);
    let whole = element.span.to(end);
    input.report(diagnostics::array_bounds(whole, "a length behind the type", &meant).fix(whole, meant));
    Ok(TypeKind::Error)
}

/// REF_TO, POINTER TO, REFERENCE TO and UNION are words only here.
fn reference<'s>(input: &mut In<'_, '_, 's>) -> Option<Parsed<TypeKind<'s>>> {
    let span = input.here();
    let to = input.kind_ahead(1) == Kind::To;
    let what = if to && input.is_word("POINTER") {
        "POINTER TO"
    } else if to && input.is_word("REFERENCE") {
        "REFERENCE TO"
    } else if input.is_word("REF_TO") {
        "REF_TO"
    } else if input.is_word("UNION") && input.kind_ahead(1) == Kind::Name {
        "UNION"
    } else {
        return None;
    };
    input.take();
    input.eat(Kind::To);
    let whole = span.to(input.last());
    input.report(diagnostics::unsupported(whole, what));
    if what == "UNION" {
        declaration::list(input, Kind::EndUnion, span);
        input.eat(Kind::EndUnion);
    } else if let Err(problem) = type_spec(input) {
        return Some(Err(problem));
    }
    Some(Ok(TypeKind::Unsupported(what)))
}

/// `[80]` or `(80)`
fn capacity<'s>(input: &mut In<'_, '_, 's>) -> Parsed<Option<Box<Expr<'s>>>> {
    let end = match input.kind() {
        Kind::OpenBracket => Kind::CloseBracket,
        Kind::OpenParen => Kind::CloseParen,
        _ => return Ok(None),
    };
    input.take();
    let capacity = expression(input)?;
    input.expect(end)?;
    Ok(Some(Box::new(capacity)))
}

/// `INT (0..100)`, or `INT (Red, Green)`.
fn refined<'s>(input: &mut In<'_, '_, 's>, base: Name<'s>) -> Parsed<TypeKind<'s>> {
    let lists = input.kind_ahead(1) == Kind::Name
        && matches!(input.kind_ahead(2), Kind::Comma | Kind::CloseParen | Kind::Assign);
    if lists {
        return enumeration(input, Some(base));
    }
    input.take();
    let low = Box::new(expression(input)?);
    input.expect(Kind::DotDot)?;
    let high = Box::new(expression(input)?);
    input.expect(Kind::CloseParen)?;
    Ok(TypeKind::Subrange { base, low, high })
}

/// `:= value`, if it is there.
pub fn optional_initial<'s>(input: &mut In<'_, '_, 's>) -> Parsed<Option<Initial<'s>>> {
    if !assign(input) {
        return Ok(None);
    }
    let start = input.here();
    // `:= 1, 2, 3` and `:= 3(0), 4`: an array without its brackets, as older code writes it.
    if is_repeat(input) {
        let elements = elements(input, Vec::new())?;
        return Ok(Some(array_initial(elements, start.to(input.last()))));
    }
    let first = initial(input)?;
    if input.eat(Kind::Comma).is_none() {
        return Ok(Some(first));
    }
    let first = Element { count: None, values: vec![first] };
    let elements = elements(input, vec![first])?;
    Ok(Some(array_initial(elements, start.to(input.last()))))
}

/// `:=`, also as the `=` of other languages.
fn assign(input: &mut In<'_, '_, '_>) -> bool {
    if let Some(sign) = input.eat(Kind::Equal) {
        input.report(diagnostics::equal_for_assign(sign, "="));
        return true;
    }
    input.eat(Kind::Assign).is_some()
}

fn array_initial(elements: Vec<Element<'_>>, span: Span) -> Initial<'_> {
    Initial { kind: InitialKind::Elements(elements), span }
}

pub fn initial<'s>(input: &mut In<'_, '_, 's>) -> Parsed<Initial<'s>> {
    let start = input.here();
    input.enter()?;
    let kind = match input.kind() {
        Kind::OpenBracket => bracketed(input)?,
        Kind::OpenParen if input.kind_ahead(1) == Kind::Name && input.kind_ahead(2) == Kind::Assign => fields(input)?,
        Kind::Semicolon if foreign_syntax::brace_list(input, "[", "]") => {
            InitialKind::Value(Expr { kind: ExprKind::Error(Vec::new()), span: start })
        }
        _ => InitialKind::Value(expression(input)?),
    };
    input.leave();
    Ok(Initial { kind, span: start.to(input.last()) })
}

fn bracketed<'s>(input: &mut In<'_, '_, 's>) -> Parsed<InitialKind<'s>> {
    let opened = input.number();
    input.take();
    if input.eat(Kind::CloseBracket).is_some() {
        return Ok(InitialKind::Elements(Vec::new()));
    }
    let elements = elements(input, Vec::new())?;
    close(input, Kind::CloseBracket, opened)?;
    Ok(InitialKind::Elements(elements))
}

fn elements<'s>(input: &mut In<'_, '_, 's>, mut elements: Vec<Element<'s>>) -> Parsed<Vec<Element<'s>>> {
    loop {
        elements.push(element(input)?);
        if input.eat(Kind::Comma).is_none() {
            return Ok(elements);
        }
    }
}

fn is_repeat(input: &mut In<'_, '_, '_>) -> bool {
    matches!(input.kind(), Kind::Integer | Kind::Based) && input.kind_ahead(1) == Kind::OpenParen
}

/// `x`, or `4(x, y)`.
fn element<'s>(input: &mut In<'_, '_, 's>) -> Parsed<Element<'s>> {
    if !is_repeat(input) {
        return Ok(Element { count: None, values: vec![initial(input)?] });
    }
    let count = count(input)?;
    let opened = input.number();
    input.take();
    let mut values = Vec::new();
    if input.eat(Kind::CloseParen).is_none() {
        loop {
            values.push(initial(input)?);
            if input.eat(Kind::Comma).is_none() {
                break;
            }
        }
        close(input, Kind::CloseParen, opened)?;
    }
    Ok(Element { count: Some(count), values })
}

/// The number before `(`, which must not be read as a call.
fn count<'s>(input: &mut In<'_, '_, 's>) -> Parsed<Expr<'s>> {
    let span = input.here();
    match super::literal::untyped(input, None) {
        Some(literal) => Ok(Expr { kind: ExprKind::Literal(literal), span }),
        None => Err(Problem::REPORTED),
    }
}

fn fields<'s>(input: &mut In<'_, '_, 's>) -> Parsed<InitialKind<'s>> {
    let opened = input.number();
    input.take();
    let mut fields = Vec::new();
    loop {
        let name = input.name()?;
        input.expect(Kind::Assign)?;
        fields.push((name, initial(input)?));
        if input.eat(Kind::Comma).is_none() {
            break;
        }
    }
    close(input, Kind::CloseParen, opened)?;
    Ok(InitialKind::Fields(fields))
}

/// `TYPE … END_TYPE`
pub fn types<'s>(input: &mut In<'_, '_, 's>) -> Vec<TypeDecl<'s>> {
    let opened = input.take();
    input.state().open.push((Kind::EndType, opened));
    let mut types = Vec::new();
    let depth = input.state().depth;
    loop {
        input.state().depth = depth;
        let start = input.save();
        match input.kind() {
            Kind::EndType => break,
            Kind::Semicolon => {
                input.take();
            }
            kind if recover::ends_declarations(kind) => {
                if !recover::stray(input) {
                    break;
                }
            }
            _ => types.extend(type_decl_or_name(input, start)),
        }
    }
    input.state().open.pop();
    block_ends::close_block(input, Kind::EndType, opened);
    input.eat(Kind::Semicolon);
    types
}

/// A type, or the name of one that does not parse, with all names in it: they may be enumerators.
fn type_decl_or_name<'t, 'p, 's>(input: &mut In<'t, 'p, 's>, start: Start<'t, 'p>) -> Option<TypeDecl<'s>> {
    let (first, from) = (input.number(), input.here());
    let named = input.kind() == Kind::Name;
    let name = Name { text: input.text(from), span: from };
    let problem = match type_decl(input) {
        Ok(it) => return Some(it),
        Err(problem) => problem,
    };
    if !recover::declaration(input, problem, start) || !named {
        return None;
    }
    let ty = TypeSpec { kind: TypeKind::Error, span: from.to(input.last()) };
    let last = input.number();
    let state = input.state();
    let names = (first + 1..last).filter(|at| state.tokens.kinds[*at] == Kind::Name).map(|at| state.place(at));
    let unread = names.map(|span| Name { text: state.slice(span), span }).collect();
    Some(TypeDecl { name, ty, initial: None, doc: None, unread })
}

fn type_decl<'s>(input: &mut In<'_, '_, 's>) -> Parsed<TypeDecl<'s>> {
    let first = input.number();
    let name = input.name()?;
    if input.is_word("EXTENDS") {
        let span = input.take();
        input.report(diagnostics::unsupported(span, "EXTENDS"));
        input.name()?;
    }
    if input.eat(Kind::Colon).is_none() {
        if !matches!(input.kind(), Kind::Struct | Kind::OpenParen | Kind::Array | Kind::Equal | Kind::Semicolon) {
            return Err(input.problem(Expected::Token(Kind::Colon)));
        }
        diagnostics::missing_type_colon(input);
    }
    let ty = type_spec(input)?;
    let initial = optional_initial(input)?;
    let closed = matches!(ty.kind, TypeKind::Struct(_) | TypeKind::Unsupported("UNION"));
    if !closed || input.kind() == Kind::Semicolon {
        declaration::end(input)?;
    }
    Ok(TypeDecl { name, ty, initial, doc: doc::comment(input, first), unread: Vec::new() })
}
