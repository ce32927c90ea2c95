//! Declarations and types as other languages write them: each is reported, and read as what is meant.

use chumsky::prelude::*;

use crate::{
    ast::{BinaryOp, Expr, ExprKind, Name, TypeKind, TypeSpec, VarKind},
    diagnostic::{Code, Diagnostic},
    lex::Kind,
    source::Span,
};

use super::{
    combinator::{Rule, ahead, delimited, name, reported, rule, token},
    diagnostics,
    expression::expr,
    parser::{Expected, In, Problem, State, TokenReader},
};

/// `{1, 2}` or `{Red, Green}`, which the lexer took for a pragma, before the current token.
pub fn brace_list<'t, 's: 't>(open: &'static str, close: &'static str) -> impl Rule<'t, 's, Span> {
    rule(move |input| {
        let (last, here) = (input.last(), input.here());
        let state = input.state();
        let from = state.tokens.pragmas.partition_point(|it| it.span.start < last.end);
        let list = state.tokens.pragmas.get(from).copied().filter(|it| it.span.end <= here.start);
        let Some(list) = list else { return Err(input.problem(Expected::Other)) };
        state.braces.push(list.span);
        let whole = Span { start: list.span.start - 1, end: list.span.end + 1, ..list.span };
        // Members of a structure have names.
        let (open, close) = if list.text.contains(":=") { ("(", ")") } else { (open, close) };
        let meant = format!("{open}{}{close}", list.text);
        input.report(
            Diagnostic::new(Code::E0020, whole, "Structured Text has no lists in braces")
                .label("this is a pragma")
                .help(format!("write `{meant}`"))
                .fix(whole, meant),
        );
        Ok(here)
    })
}

/// `=` before an initial value.
pub fn equal_for_assign<'t, 's: 't>() -> impl Rule<'t, 's, Span> {
    reported(token(Kind::Equal), |sign, state, _| {
        state.report(diagnostics::equal_for_assign(sign, "="));
        sign
    })
}

/// Before the `(` of `ARRAY(1..3)`.
pub fn bounds_in_parentheses<'t, 's: 't>() -> impl Rule<'t, 's, ()> {
    let parenthesis = ahead(|input| input.kind() == Kind::OpenParen);
    reported(parenthesis, |(), state, tokens| {
        let span = state.span(tokens);
        let close = state.tokens.kinds.iter().skip(tokens.start).position(|it| *it == Kind::CloseParen);
        let bounds = close.map(|it| Span { start: span.end, end: state.place(tokens.start + it).start, ..span });
        let bounds = bounds.map_or("1..3", |it| state.slice(it));
        state.report(diagnostics::array_bounds(span, "`(`", &format!("ARRAY[{bounds}] OF …")));
    })
}

/// What is between a first bound and the next `,` or bracket, if that is not `..` and a last bound.
pub fn other_bound<'t, 's: 't>() -> impl Rule<'t, 's, Option<(Span, Expr<'s>)>> {
    let colon = token(Kind::Colon).then(expr()).map(Some);
    let ends = |kind| matches!(kind, Kind::Comma | Kind::CloseBracket | Kind::CloseParen);
    let nothing = rule(move |input| {
        let kind = input.kind();
        if ends(kind) { Ok(None) } else { Err(input.problem(Expected::Token(Kind::DotDot))) }
    });
    colon.or(nothing)
}

/// What `1,5` is between the brackets of an array: where its comma is, if `low` is the first of the two.
fn pair(state: &State<'_, '_>, low: Span) -> Option<(bool, Span)> {
    let at = state.tokens.places.partition_point(|it| it.0 < low.start);
    let first = if state.tokens.kinds.get(at + 1) == Some(&Kind::Comma) { at } else { at.checked_sub(2)? };
    let shape = [Kind::OpenBracket, Kind::Integer, Kind::Comma, Kind::Integer, Kind::CloseBracket];
    let around = state.tokens.kinds.get(first.checked_sub(1)?..first + 4)?;
    let counts_from = state.slice(state.place(first));
    (around == shape && matches!(counts_from, "0" | "1")).then(|| (first == at, state.place(first + 1)))
}

/// `10`, `1:10`, `1-10` and `1,10` as the bounds of an array.
pub fn report_bound<'s>(state: &mut State<'_, 's>, low: &Expr<'s>, high: Option<(Span, Expr<'s>)>) {
    let text = state.slice(low.span);
    let pair = pair(state, low.span).filter(|_| high.is_none());
    let it = match (high, &low.kind) {
        // It was reported at the first.
        _ if pair.is_some_and(|it| !it.0) => return,
        _ if let Some((_, comma)) = pair => {
            diagnostics::array_bounds(comma, "`,`", &format!("{text}..last")).fix(comma, "..")
        }
        (Some((colon, high)), _) => {
            let meant = format!("{text}..{}", state.slice(high.span));
            diagnostics::array_bounds(colon, "`:`", &meant).fix(colon, "..")
        }
        (None, ExprKind::Binary(_, BinaryOp::Sub, sign)) => {
            let (before, after) = (Span { end: sign.start, ..low.span }, Span { start: sign.end, ..low.span });
            let meant = format!("{}..{}", state.slice(before).trim_end(), state.slice(after).trim_start());
            diagnostics::array_bounds(low.span, "`-`", &meant).fix(low.span, meant)
        }
        (None, _) => {
            let meant = bounds_of_length(text);
            diagnostics::array_bounds(low.span, "one number", &meant).fix(low.span, meant)
        }
    };
    state.report(it);
}

/// The bounds of an array of so many elements, as it is in languages that write its length: the first has the index 0.
fn bounds_of_length(length: &str) -> String {
    match length.parse::<u64>() {
        Ok(0) | Err(_) => format!("0..{length} - 1"),
        Ok(length) => format!("0..{}", length - 1),
    }
}

/// No `,` between two enumerators.
pub fn missing_comma<'t, 's: 't>() -> impl Rule<'t, 's, ()> {
    rule(|input| {
        if input.kind() != Kind::Name {
            return Err(input.problem(Expected::Token(Kind::Comma)));
        }
        diagnostics::missing_comma(input);
        Ok(())
    })
}

/// `INT[10]`, as other languages write an array, after its `INT`; `Motor[3(9)]`, which would repeat arguments.
pub fn length<'t, 's: 't>() -> impl Rule<'t, 's, ()> {
    let starts =
        ahead(|input| input.kind() == Kind::OpenBracket && matches!(input.kind_ahead(1), Kind::Integer | Kind::Name));
    let bounds = expr().then(token(Kind::DotDot).ignore_then(expr()).or_not());
    let brackets = delimited(Kind::OpenBracket, bounds, Kind::CloseBracket);
    reported(starts.ignore_then(brackets), |(length, high), state, tokens| {
        let element = state.place(tokens.start - 1);
        if let ExprKind::Call(count, _) = &length.kind
            && matches!(count.kind, ExprKind::Literal(_))
        {
            let list = Span { start: count.span.end, ..length.span };
            let error = diagnostics::repeated_arguments(length.span, state.slice(list));
            return state.report(error);
        }
        let bounds = match high {
            Some(high) => state.slice(length.span.to(high.span)).to_owned(),
            None => bounds_of_length(state.slice(length.span)),
        };
        let meant = format!("ARRAY[{bounds}] OF {}", state.slice(element));
        let whole = element.to(state.span(tokens));
        state.report(diagnostics::array_bounds(whole, "a length after the type", &meant).fix(whole, meant));
    })
}

/// `VAR INPUT`
pub fn section_of_two_words<'t, 's: 't>() -> impl Rule<'t, 's, (VarKind, Span)> {
    const SECTIONS: [(&str, VarKind, Kind); 6] = [
        ("INPUT", VarKind::Input, Kind::VarInput),
        ("OUTPUT", VarKind::Output, Kind::VarOutput),
        ("IN_OUT", VarKind::InOut, Kind::VarInOut),
        ("TEMP", VarKind::Temp, Kind::VarTemp),
        ("GLOBAL", VarKind::Global, Kind::VarGlobal),
        ("EXTERNAL", VarKind::External, Kind::VarExternal),
    ];
    let second = rule(|input| {
        let found = SECTIONS.into_iter().find(|(word, ..)| input.is_word(word));
        let Some((_, section, kind)) = found.filter(|_| input.kind_ahead(1) == Kind::Name) else {
            return Err(input.problem(Expected::Name));
        };
        let span = input.last().to(input.take());
        diagnostics::misspelt_keyword(input, kind, span);
        Ok((section, span))
    });
    // A keyword that is read for a misspelt one is not in the tokens, so nothing goes back over it.
    let word = ahead(|input| input.state().instead.is_none() && input.kind_ahead(1) == Kind::Name);
    word.ignore_then(token(Kind::Var)).ignore_then(second)
}

/// `my var : INT`
pub fn name_of_two_words<'t, 's: 't>() -> impl Rule<'t, 's, Name<'s>> {
    let two = ahead(|input| {
        let names = input.kind() == Kind::Name && input.kind_ahead(1) == Kind::Name;
        let at = input.number();
        let joined = |state: &State<'_, '_>| !state.breaks(state.place(at).end, state.place(at + 1).start);
        names && input.kind_ahead(2) == Kind::Colon && input.kind_ahead(3) != Kind::Assign && joined(input.state())
    });
    two.ignore_then(rule(|input| {
        let (first, second) = (input.take(), input.take());
        diagnostics::name_of_two_words(input, first, second);
        let span = first.to(second);
        Ok(Name { text: input.text(span), span })
    }))
}

/// Names and their type, read in the other order.
#[derive(Clone)]
pub struct Swapped<'s> {
    pub names: Vec<Name<'s>>,
    pub ty: TypeSpec<'s>,
}

/// `INT x;`: what was read as the one name is the type.
pub fn type_before_name<'t, 's: 't>(names: &[Name<'s>]) -> impl Rule<'t, 's, Option<Swapped<'s>>> {
    let ty = if let [ty] = names { Some(*ty) } else { None };
    let swapped = ahead(move |input| {
        let is_type = || ty.is_some_and(|it| staunch_ir::Elementary::named(it.text).is_some());
        let follows = matches!(input.kind_ahead(1), Kind::Semicolon | Kind::Assign | Kind::Equal | Kind::Comma);
        input.kind() == Kind::Name && follows && is_type()
    });
    let first = rule(move |input| {
        let name = input.name()?;
        let Some(ty) = ty else { return Ok(name) };
        if input.kind() != Kind::Equal {
            let mut more = 0;
            while input.kind_ahead(more) == Kind::Comma && input.kind_ahead(more + 1) == Kind::Name {
                more += 2;
            }
            let last = input.number() + more - 1;
            let names = name.span.to(input.state().place(last));
            let error = diagnostics::type_first(input.state(), ty.span, names);
            input.report(error);
            return Ok(name);
        }
        // `INT x = 3` is one mistake.
        let sign = input.take();
        let meant = format!("{} : {} :=", name.text, ty.text);
        let error = diagnostics::type_first(input.state(), ty.span, name.span);
        input.report(error.help(format!("write `{meant} …`")).fix(ty.span.to(sign), meant));
        input.state().instead = Some(Kind::Assign);
        Ok(name)
    });
    let names = first.then(token(Kind::Comma).ignore_then(name()).repeated().collect::<Vec<_>>());
    swapped.ignore_then(names).or_not().map(move |found| {
        let (ty, (first, more)) = ty.zip(found)?;
        let names = std::iter::once(first).chain(more).collect();
        Some(Swapped { names, ty: TypeSpec { kind: TypeKind::Named(vec![ty]), span: ty.span } })
    })
}

/// A declaration without its `:`, where nothing else is missing; `:=` in its place is refused.
pub fn no_colon_in_declaration<'t, 's: 't>() -> impl Rule<'t, 's, ()> {
    rule(|input| {
        if input.kind() == Kind::Assign {
            let sign = input.here();
            input.report(diagnostics::assign_for_colon(sign));
            return Err(Problem::REPORTED);
        }
        if !lacks_colon(input) {
            return Err(input.problem(Expected::Token(Kind::Colon)));
        }
        diagnostics::missing_type_colon(input);
        Ok(())
    })
}

fn lacks_colon(input: &mut In<'_, '_, '_>) -> bool {
    let next = input.kind_ahead(1);
    match input.kind() {
        Kind::Name => {
            !input.on_new_line() && matches!(next, Kind::Semicolon | Kind::Assign | Kind::OpenParen | Kind::OpenBracket)
        }
        Kind::Array | Kind::Struct => true,
        Kind::Equal => matches!(next, Kind::Name | Kind::Array | Kind::Struct),
        Kind::Semicolon => next == Kind::Name && matches!(input.kind_ahead(2), Kind::Semicolon | Kind::Assign),
        _ => false,
    }
}

/// A type's declaration without its `:`.
pub fn no_colon_in_type<'t, 's: 't>() -> impl Rule<'t, 's, ()> {
    rule(|input| {
        if !matches!(input.kind(), Kind::Struct | Kind::OpenParen | Kind::Array | Kind::Equal | Kind::Semicolon) {
            return Err(input.problem(Expected::Token(Kind::Colon)));
        }
        diagnostics::missing_type_colon(input);
        Ok(())
    })
}

/// `AT IX0.0`, after its AT.
pub fn address_without_sign<'t, 's: 't>() -> impl Rule<'t, 's, ()> {
    let number = token(Kind::Integer).or(token(Kind::Real));
    let more = token(Kind::Dot).ignore_then(number.clone().or_not()).ignored().or(number.ignored());
    reported(name().then(more.repeated()), |_, state, tokens| {
        let span = state.span(tokens);
        state.report(diagnostics::address_without_sign(span, state.slice(span)));
    })
}

/// `FUNCTION f INT`: a result type without its `:`.
pub fn no_colon_in_head<'t, 's: 't>() -> impl Rule<'t, 's, ()> {
    rule(|input| {
        if !matches!(input.kind(), Kind::Name | Kind::Array) || input.on_new_line() {
            return Err(input.problem(Expected::Token(Kind::Colon)));
        }
        diagnostics::missing_type_colon(input);
        Ok(())
    })
}

/// `FUNCTION INT f`
pub fn result_before_name<'t, 's: 't>() -> impl Rule<'t, 's, (Name<'s>, TypeSpec<'s>)> {
    let swapped = ahead(|input| {
        let at = input.number();
        let (ty, name) = (input.here(), input.state().place(at + 1));
        let names = input.kind() == Kind::Name && input.kind_ahead(1) == Kind::Name;
        names && !input.state().breaks(ty.end, name.start) && staunch_ir::Elementary::named(input.text(ty)).is_some()
    });
    reported(swapped.ignore_then(name()).then(name()), |(ty, name), state, _| {
        state.report(diagnostics::type_first(state, ty.span, name.span));
        (name, TypeSpec { kind: TypeKind::Named(vec![ty]), span: ty.span })
    })
}
