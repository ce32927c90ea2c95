//! Expressions, by precedence climbing.
//!
//! Written as productions over chumsky's input rather than with its `pratt`: that tries eight
//! levels after each operand, and needs a stack frame for each, where a nesting limit counts.

use crate::{
    ast::{Argument, ArgumentKind, BinaryOp, Expr, ExprKind, Literal, LiteralValue, Name, UnaryOp},
    lex::Kind,
    source::Span,
};

use super::{
    combinator::{Rule, rule},
    diagnostics, foreign_expression, foreign_syntax, literal,
    parser::{Expected, In, Parsed, Problem, TokenReader, Waiting},
    token_class::ends_statements,
    unsupported,
};

/// Arguments of one call.
const MAX_ARGUMENTS: usize = 10_000;

/// An operator and how strongly it binds; `=` and what C writes for it are 4.
fn infix(kind: Kind) -> Option<(BinaryOp, u8)> {
    Some(match kind {
        Kind::Or | Kind::OrOr => (BinaryOp::Or, 1),
        Kind::OrElse => (BinaryOp::OrElse, 1),
        Kind::Xor => (BinaryOp::Xor, 2),
        Kind::And | Kind::Ampersand | Kind::AndAnd => (BinaryOp::And, 3),
        Kind::AndThen => (BinaryOp::AndThen, 3),
        Kind::Equal | Kind::EqualEqual => (BinaryOp::Eq, 4),
        Kind::Unequal | Kind::BangEqual | Kind::TildeEqual | Kind::SlashEqual => (BinaryOp::Ne, 4),
        Kind::Less => (BinaryOp::Lt, 5),
        Kind::Greater => (BinaryOp::Gt, 5),
        Kind::LessEqual => (BinaryOp::Le, 5),
        Kind::GreaterEqual | Kind::Arrow => (BinaryOp::Ge, 5),
        Kind::Plus => (BinaryOp::Add, 6),
        Kind::Minus => (BinaryOp::Sub, 6),
        Kind::Star => (BinaryOp::Mul, 7),
        Kind::Slash => (BinaryOp::Div, 7),
        Kind::Mod | Kind::Percent => (BinaryOp::Mod, 7),
        Kind::Power | Kind::Caret => (BinaryOp::Power, 8),
        _ => return None,
    })
}

/// Signs of other languages that are read as ours, and reported.
fn is_foreign(kind: Kind) -> bool {
    matches!(
        kind,
        Kind::EqualEqual
            | Kind::BangEqual
            | Kind::TildeEqual
            | Kind::SlashEqual
            | Kind::AndAnd
            | Kind::OrOr
            | Kind::Percent
            | Kind::Arrow
            | Kind::Caret
            | Kind::Name
    )
}

/// `a DIV b`
fn named_division(input: &mut In<'_, '_, '_>) -> Option<(BinaryOp, u8)> {
    let divides = input.is_word("DIV") && matches!(input.kind_ahead(1), Kind::Name | Kind::Integer | Kind::OpenParen);
    (divides && !input.on_new_line()).then_some((BinaryOp::Div, 7)).or_else(|| misspelt_operator(input))
}

/// `a ADN b`, `a ANDTHEN b`: two operands with a word between them that is nearly an operator.
fn misspelt_operator(input: &mut In<'_, '_, '_>) -> Option<(BinaryOp, u8)> {
    let operand = matches!(
        input.kind_ahead(1),
        Kind::Name | Kind::Integer | Kind::Real | Kind::OpenParen | Kind::Not | Kind::True | Kind::False
    );
    if input.kind() != Kind::Name || !operand || input.on_new_line() {
        return None;
    }
    let span = input.here();
    let words = [Kind::And, Kind::AndThen, Kind::Xor, Kind::OrElse, Kind::Mod];
    let near = crate::spelling::nearest(input.text(span), words.iter().filter_map(|it| it.keyword()))?;
    infix(words.into_iter().find(|it| it.keyword() == Some(near))?)
}

/// An expression as a part of other rules.
pub fn expr<'t, 's: 't>() -> impl Rule<'t, 's, Expr<'s>> {
    rule(|input| expression(input))
}

/// Operands and operators, joined by precedence, from the left. What waits for a right side is on
/// a stack of the state: neither a frame nor memory of its own for each level.
pub fn expression<'s>(input: &mut In<'_, '_, 's>) -> Parsed<Expr<'s>> {
    let mut left = unary(input)?;
    let base = input.state().waiting.len();
    loop {
        let next = infix(input.kind()).or_else(|| named_division(input));
        left = reduce(input, left, base, next.map_or(0, |(_, power)| power))?;
        let Some((op, power)) = next else { return Ok(left) };
        let kind = input.kind();
        let sign = input.take();
        let (op, sign) = operator(input, kind, op, sign).inspect_err(|_| input.state().waiting.truncate(base))?;
        let state = input.state();
        let height = state.height;
        state.waiting.push(Waiting { left, height, op, power, sign });
        left = unary(input).inspect_err(|_| input.state().waiting.truncate(base))?;
    }
}

/// The operator that was taken; one of another language is read as ours, and reported.
fn operator(input: &mut In<'_, '_, '_>, kind: Kind, op: BinaryOp, sign: Span) -> Parsed<(BinaryOp, Span)> {
    if is_foreign(kind) {
        diagnostics::foreign_operator(input, kind, op, sign);
    } else if matches!(kind, Kind::Equal | Kind::Less | Kind::Greater) {
        let Some(second) = foreign_syntax::second_sign(input, kind, sign) else { return Err(Problem::REPORTED) };
        return Ok(second.unwrap_or((op, sign)));
    }
    Ok((op, sign))
}

/// Joins what waits for `right` above `base` and binds at least as strongly as `power`.
fn reduce<'s>(input: &mut In<'_, '_, 's>, mut right: Expr<'s>, base: usize, power: u8) -> Parsed<Expr<'s>> {
    while let state = input.state()
        && state.waiting.len() > base
        && let Some(waiting) = state.waiting.pop_if(|it| it.power >= power)
    {
        let height = state.height.max(waiting.height);
        input.grow(height)?;
        // `a ^ b` may be a power, or the XOR of C: what it gives is not known.
        let is_known = waiting.op != BinaryOp::Power || input.text(waiting.sign) != "^";
        right = if is_known {
            join(waiting.left, waiting.op, waiting.sign, right)
        } else {
            let span = waiting.left.span.to(right.span);
            Expr { kind: ExprKind::Error(vec![waiting.left, right]), span }
        };
    }
    Ok(right)
}

/// A condition: an expression, which may assign.
pub fn condition<'s>(input: &mut In<'_, '_, 's>) -> Parsed<Expr<'s>> {
    let left = expression(input)?;
    if input.kind() == Kind::Assign { assigned(input, left) } else { Ok(left) }
}

/// `left := right`, where `right` may be one more.
fn assigned<'s>(input: &mut In<'_, '_, 's>, left: Expr<'s>) -> Parsed<Expr<'s>> {
    let sign = input.take();
    input.enter(1)?;
    let right = condition(input)?;
    input.leave(1);
    let height = input.state().height;
    input.grow(height)?;
    let span = left.span.to(right.span);
    Ok(Expr { kind: ExprKind::Assign(Box::new([left, right]), sign), span })
}

fn join<'s>(left: Expr<'s>, op: BinaryOp, sign: Span, right: Expr<'s>) -> Expr<'s> {
    let span = left.span.to(right.span);
    Expr { kind: ExprKind::Binary(Box::new([left, right]), op, sign), span }
}

// The functions on the way around a pair of brackets are small: without optimisation, a frame has
// room for every value of its function.

pub fn unary<'s>(input: &mut In<'_, '_, 's>) -> Parsed<Expr<'s>> {
    match input.kind() {
        Kind::Minus => signed(input, UnaryOp::Neg),
        Kind::Plus => signed(input, UnaryOp::Plus),
        Kind::Not if names_its_operand(input) => postfix(input),
        Kind::Not | Kind::Bang => signed(input, UnaryOp::Not),
        Kind::Star | Kind::Ampersand if foreign_syntax::joins_name(input) => pointed(input),
        _ => postfix(input),
    }
}

/// `*p` and `&n` of C.
pub fn pointed<'s>(input: &mut In<'_, '_, 's>) -> Parsed<Expr<'s>> {
    let sign = input.take();
    let operand = postfix(input)?;
    foreign_syntax::pointer_sign(input, sign, operand.span);
    Ok(Expr { kind: ExprKind::Error(Vec::new()), span: sign.to(operand.span) })
}

/// `NOT(IN := x)`, the function.
fn names_its_operand(input: &mut In<'_, '_, '_>) -> bool {
    let named = input.kind_ahead(1) == Kind::OpenParen
        && input.kind_ahead(2) == Kind::Name
        && input.kind_ahead(3) == Kind::Assign;
    let at = input.number() + 2;
    let name = input.state().place(at);
    named && input.text(name).eq_ignore_ascii_case("IN")
}

fn signed<'s>(input: &mut In<'_, '_, 's>, op: UnaryOp) -> Parsed<Expr<'s>> {
    if input.kind() == Kind::Bang {
        let span = input.here();
        input.report(diagnostics::foreign_not(span));
    }
    let sign = input.take();
    input.enter(1)?;
    let operand = unary(input)?;
    input.leave(1);
    let height = input.state().height;
    input.grow(height)?;
    Ok(negated(op, sign, operand))
}

fn negated<'s>(op: UnaryOp, sign: Span, operand: Expr<'s>) -> Expr<'s> {
    let span = sign.to(operand.span);
    Expr { kind: ExprKind::Unary(op, Box::new(operand)), span }
}

/// An operand and what follows it: `.member`, `.3`, `[i]`, `^`, `(…)`.
pub fn postfix<'s>(input: &mut In<'_, '_, 's>) -> Parsed<Expr<'s>> {
    let expr = primary(input)?;
    match input.kind() {
        Kind::Dot | Kind::OpenBracket | Kind::OpenParen | Kind::Caret => suffixes(input, expr),
        Kind::Minus if input.kind_ahead(1) == Kind::Greater => suffixes(input, expr),
        _ => Ok(expr),
    }
}

fn suffixes<'s>(input: &mut In<'_, '_, 's>, mut expr: Expr<'s>) -> Parsed<Expr<'s>> {
    let mut height = input.state().height;
    loop {
        // Arguments and indices leave their own height.
        input.state().height = 0;
        let start = expr.span;
        let kind = match input.kind() {
            Kind::Dot if is_number(&expr) && foreign_syntax::ends_line(input) => break,
            Kind::Dot => member(input, expr)?,
            // `a [:=] b`
            Kind::OpenBracket if input.kind_ahead(1) == Kind::Assign && input.kind_ahead(2) == Kind::CloseBracket => {
                break;
            }
            Kind::OpenBracket => ExprKind::Index(Box::new(expr), indices(input)?),
            Kind::OpenParen => ExprKind::Call(Box::new(expr), arguments(input)?),
            Kind::Minus if foreign_syntax::arrow(input) => {
                let followed = Expr { span: expr.span, kind: ExprKind::Deref(Box::new(expr)) };
                named_member(input, followed)?
            }
            // Nothing is dereferenced before an operand.
            Kind::Caret if before_operand(input) => break,
            Kind::Caret => {
                input.take();
                ExprKind::Deref(Box::new(expr))
            }
            _ => break,
        };
        height = height.max(input.state().height);
        input.grow(height)?;
        height += 1;
        expr = Expr { kind, span: start.to(input.last()) };
    }
    input.state().height = height;
    Ok(expr)
}

/// Whether an operand follows `^`, which is a power in other languages: not the `S=` of `p^ S= b`.
fn before_operand(input: &mut In<'_, '_, '_>) -> bool {
    match input.kind_ahead(1) {
        Kind::Integer | Kind::Real => true,
        Kind::Name => !is_latch(input, 1),
        _ => false,
    }
}

/// Whether `S=`, `R=` or `REF=` is so many tokens ahead.
pub fn is_latch(input: &mut In<'_, '_, '_>, ahead: usize) -> bool {
    joins_equal(input, ahead, &["S", "R", "REF"])
}

/// Whether one of the words is so many tokens ahead, with the `=` directly after it: only so they have a meaning.
pub fn joins_equal(input: &mut In<'_, '_, '_>, ahead: usize, words: &[&str]) -> bool {
    let number = input.number() + ahead;
    let (word, sign) = (input.state().place(number), input.state().place(number + 1));
    let is_word = words.iter().any(|it| input.text(word).eq_ignore_ascii_case(it));
    is_word && input.kind_ahead(ahead + 1) == Kind::Equal && sign.start == word.end
}

fn member<'s>(input: &mut In<'_, '_, 's>, of: Expr<'s>) -> Parsed<ExprKind<'s>> {
    input.take();
    match input.kind() {
        Kind::Integer | Kind::Part => {
            let span = input.take();
            Ok(ExprKind::Part(Box::new(of), Name { text: input.text(span), span }))
        }
        _ if is_number(&of) => {
            foreign_syntax::point_last(input, of.span);
            Ok(ExprKind::Error(Vec::new()))
        }
        Kind::OpenBracket => {
            let point = input.last();
            let chosen = indices(input)?;
            let text = [of.span, chosen[0].span].map(|it| input.text(it));
            let error = diagnostics::chosen_bit(point.to(input.last()), text);
            input.report(error);
            Ok(ExprKind::Error(Vec::new()))
        }
        // `Plant.Colour#Red` is `Plant.Colour.Red`.
        Kind::Prefix if input.kind_ahead(1) == Kind::Name => {
            let prefix = input.take();
            let span = Span { end: prefix.end - 1, ..prefix };
            let whole = of.span.to(span);
            let ty = Name { text: input.text(span), span };
            let ty = Expr { kind: ExprKind::Member(Box::new(of), ty), span: whole };
            Ok(ExprKind::Member(Box::new(ty), input.name()?))
        }
        _ => named_member(input, of),
    }
}

fn is_number(expr: &Expr<'_>) -> bool {
    matches!(&expr.kind, ExprKind::Literal(Literal { value: LiteralValue::Integer { .. }, .. }))
}

fn named_member<'s>(input: &mut In<'_, '_, 's>, of: Expr<'s>) -> Parsed<ExprKind<'s>> {
    Ok(ExprKind::Member(Box::new(of), input.name()?))
}

fn indices<'s>(input: &mut In<'_, '_, 's>) -> Parsed<Vec<Expr<'s>>> {
    let opened = input.number();
    input.take();
    let mut indices = Vec::with_capacity(1);
    let mut height = 0;
    input.enter(1)?;
    loop {
        indices.push(expression(input)?);
        height = height.max(input.state().height);
        if input.eat(Kind::Comma).is_none() {
            break;
        }
    }
    close(input, Kind::CloseBracket, opened)?;
    input.leave(1);
    input.state().height = height;
    Ok(indices)
}

/// `( [argument {, argument}] )`
pub fn arguments<'s>(input: &mut In<'_, '_, 's>) -> Parsed<Vec<Argument<'s>>> {
    let opened = input.number();
    input.take();
    let mut arguments = Vec::new();
    let mut height = 0;
    if input.eat(Kind::CloseParen).is_some() {
        return Ok(arguments);
    }
    input.enter(1)?;
    loop {
        input.state().height = 0;
        if let Some(argument) = argument(input)? {
            arguments.push(argument);
            if arguments.len() > MAX_ARGUMENTS {
                let span = input.here();
                return Err(input.state().stop(span, diagnostics::too_many(MAX_ARGUMENTS)));
            }
        }
        height = height.max(input.state().height);
        if input.eat(Kind::Comma).is_none() {
            let semicolon = is_comma_like(input);
            if !lacks_comma(input, usize::from(semicolon)) {
                break;
            }
            diagnostics::missing_comma(input);
            if semicolon {
                input.take();
            }
        } else if input.kind() == Kind::CloseParen && (arguments.last().is_some_and(is_named) || input.on_new_line()) {
            // TwinCAT passes over the last comma of a list with one argument a line.
            break;
        }
    }
    close(input, Kind::CloseParen, opened)?;
    input.leave(1);
    input.state().height = height;
    arguments.shrink_to_fit();
    Ok(arguments)
}

fn is_named(argument: &Argument<'_>) -> bool {
    !matches!(argument.kind, ArgumentKind::Positional(_))
}

/// `t(IN := x; PT := y)`: a `;` with more on its line.
fn is_comma_like(input: &mut In<'_, '_, '_>) -> bool {
    let at = input.number();
    let state = input.state();
    let (here, next) = (state.place(at), state.place(at + 1));
    input.kind() == Kind::Semicolon && !input.state().breaks(here.end, next.start)
}

/// Whether one more argument is here, and only the `,` before it is missing: the call is
/// closed before the statement ends.
fn lacks_comma(input: &mut In<'_, '_, '_>, from: usize) -> bool {
    if !matches!(
        input.kind_ahead(from),
        Kind::Name | Kind::Integer | Kind::Real | Kind::Time | Kind::True | Kind::False
    ) {
        return false;
    }
    let (mut depth, mut ahead) = (0usize, from);
    loop {
        match input.kind_ahead(ahead) {
            Kind::OpenParen => depth += 1,
            Kind::CloseParen if depth == 0 => return true,
            Kind::CloseParen => depth -= 1,
            Kind::Semicolon | Kind::Then | Kind::Do | Kind::Of => return false,
            kind if ends_statements(kind) => return false,
            _ => {}
        }
        ahead += 1;
    }
}

/// None for `IN :=` without a value, which vendors' editors write for a pin that is left out.
fn argument<'s>(input: &mut In<'_, '_, 's>) -> Parsed<Option<Argument<'s>>> {
    match (input.kind(), input.kind_ahead(1)) {
        (Kind::Name, Kind::Assign) => named(input),
        (Kind::Name, Kind::Name) if joins_equal(input, 1, &["REF"]) => bound(input),
        (Kind::Name, Kind::Name | Kind::Integer | Kind::Time | Kind::True | Kind::False | Kind::Not)
            if names_pin(input) =>
        {
            unassigned(input)
        }
        (Kind::Name, Kind::Colon) => with_colon(input),
        (Kind::Name, Kind::Arrow) => output(input).map(Some),
        (Kind::Not, Kind::Name) if input.kind_ahead(2) == Kind::Arrow => output(input).map(Some),
        _ => positional(input).map(Some),
    }
}

/// `IN x`
fn unassigned<'s>(input: &mut In<'_, '_, 's>) -> Parsed<Option<Argument<'s>>> {
    let name = input.name()?;
    diagnostics::missing_assign(input);
    let value = expression(input)?;
    let span = name.span.to(value.span);
    Ok(Some(Argument { kind: ArgumentKind::Input(name, value), span }))
}

/// `IN: x`
fn with_colon<'s>(input: &mut In<'_, '_, 's>) -> Parsed<Option<Argument<'s>>> {
    let at = input.number() + 1;
    let sign = input.state().place(at);
    diagnostics::sign_for_assign(input, sign);
    named(input)
}

/// `reference REF= x`
fn bound<'s>(input: &mut In<'_, '_, 's>) -> Parsed<Option<Argument<'s>>> {
    let at = input.number() + 1;
    let sign = input.state().place(at).to(input.state().place(at + 1));
    diagnostics::sign_for_assign(input, sign);
    let name = input.name()?;
    input.take();
    input.take();
    let value = expression(input)?;
    let span = name.span.to(value.span);
    Ok(Some(Argument { kind: ArgumentKind::Input(name, value), span }))
}

/// Whether a standard block has a pin of the current token's name.
fn names_pin(input: &mut In<'_, '_, '_>) -> bool {
    let span = input.here();
    let text = input.text(span);
    staunch_runtime::BLOCKS.iter().any(|it| it.pin(text).is_some())
}

fn positional<'s>(input: &mut In<'_, '_, 's>) -> Parsed<Argument<'s>> {
    if let Some(value) = unsupported::reference_type(input) {
        return Ok(Argument { span: value.span, kind: ArgumentKind::Positional(value) });
    }
    let value = expression(input)?;
    let span = value.span;
    Ok(Argument { kind: ArgumentKind::Positional(value), span })
}

fn named<'s>(input: &mut In<'_, '_, 's>) -> Parsed<Option<Argument<'s>>> {
    let name = input.name()?;
    input.take();
    if is_left_out(input) {
        return Ok(None);
    }
    let value = expression(input)?;
    let span = name.span.to(value.span);
    Ok(Some(Argument { kind: ArgumentKind::Input(name, value), span }))
}

fn output<'s>(input: &mut In<'_, '_, 's>) -> Parsed<Argument<'s>> {
    let start = input.here();
    let negated = input.eat(Kind::Not).is_some();
    let name = input.name()?;
    input.take();
    let target = if is_left_out(input) { None } else { Some(expression(input)?) };
    let span = start.to(input.last());
    Ok(Argument { kind: ArgumentKind::Output { name, negated, target }, span })
}

fn is_left_out(input: &mut In<'_, '_, '_>) -> bool {
    matches!(input.kind(), Kind::Comma | Kind::CloseParen)
}

/// After a list: its end, or one more item. `opened` is the number of the opening token.
pub fn close(input: &mut In<'_, '_, '_>, end: Kind, opened: usize) -> Parsed<Span> {
    match input.eat(end) {
        Some(span) => Ok(span),
        None => Err(input.problem(Expected::More(end, opened))),
    }
}

fn primary<'s>(input: &mut In<'_, '_, 's>) -> Parsed<Expr<'s>> {
    input.state().height = 0;
    match input.kind() {
        Kind::OpenParen => parenthesis(input),
        Kind::Prefix => typed(input),
        _ => atom(input),
    }
}

fn atom<'s>(input: &mut In<'_, '_, 's>) -> Parsed<Expr<'s>> {
    let span = input.here();
    let kind = match input.kind() {
        Kind::Name if foreign_expression::module_tag(input).is_some() => ExprKind::Error(Vec::new()),
        Kind::Name if foreign_expression::lacks_parentheses(input) => {
            input.take();
            let operand = postfix(input)?;
            return Ok(foreign_expression::without_parentheses(input, span, &operand));
        }
        Kind::Name if foreign_expression::quoted_number(input) => ExprKind::Error(Vec::new()),
        Kind::Name => ExprKind::Name(input.name()?),
        // The functions of these names: `AND(a, b, c)`.
        Kind::And | Kind::Or | Kind::Xor | Kind::Mod | Kind::Not if input.kind_ahead(1) == Kind::OpenParen => {
            input.take();
            ExprKind::Name(Name { text: input.text(span), span })
        }
        Kind::Address => {
            input.take();
            ExprKind::Address(Name { text: input.text(span), span })
        }
        Kind::Dot if foreign_syntax::point_first(input) => ExprKind::Error(Vec::new()),
        kind if !is_literal(kind) => return Err(input.problem(Expected::Expression)),
        _ => {
            let literal = input.parse(literal::literal(None))?;
            return Ok(Expr { kind: ExprKind::Literal(literal), span: span.to(input.last()) });
        }
    };
    Ok(Expr { kind, span })
}

fn is_literal(kind: Kind) -> bool {
    matches!(kind, Kind::True | Kind::False | Kind::Integer | Kind::Based | Kind::Real | Kind::Time | Kind::Date)
        || matches!(kind, Kind::Text | Kind::WideText | Kind::OpenText)
}

fn parenthesis<'s>(input: &mut In<'_, '_, 's>) -> Parsed<Expr<'s>> {
    let opened = input.number();
    let start = input.take();
    input.enter(1)?;
    let inner = Box::new(expression(input)?);
    let inner = if input.kind() == Kind::Assign { Box::new(assigned(input, *inner)?) } else { inner };
    input.leave(1);
    if input.eat(Kind::CloseParen).is_none() {
        return Err(input.problem(Expected::Closing(Kind::CloseParen, opened)));
    }
    if let Some(ty) = foreign_expression::cast_type(input, &inner) {
        let operand = postfix(input)?;
        return Ok(foreign_expression::cast(input, start, ty, &operand));
    }
    let height = input.state().height;
    input.grow(height)?;
    Ok(Expr { kind: ExprKind::Paren(inner), span: start.to(input.last()) })
}

/// `INT#5`, `INT#-5`, `Color#Red`; a sign becomes an operator around the literal.
fn typed<'s>(input: &mut In<'_, '_, 's>) -> Parsed<Expr<'s>> {
    let span = input.take();
    let name = Span { end: span.end - 1, ..span };
    let prefix = Name { text: input.text(name), span: name };
    if foreign_syntax::step_time(input, prefix) {
        return Ok(Expr { kind: ExprKind::Error(Vec::new()), span: span.to(input.last()) });
    }
    let sign = match input.kind() {
        Kind::Minus => Some((UnaryOp::Neg, input.take())),
        Kind::Plus => Some((UnaryOp::Plus, input.take())),
        _ => None,
    };
    let literal = input.parse(literal::typed(prefix))?;
    let mut expr = Expr { kind: ExprKind::Literal(literal), span: span.to(input.last()) };
    if let Some((op, at)) = sign {
        input.state().height = 1;
        // The operator is inside the literal, so the whole has one span.
        expr = Expr { span: expr.span, ..negated(op, at, expr) };
    }
    Ok(expr)
}
