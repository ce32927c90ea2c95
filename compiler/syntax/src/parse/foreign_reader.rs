//! Looking ahead in what is of another language, and passing over it.

use crate::{
    diagnostic::{Code, Diagnostic},
    lex::Kind,
    source::Span,
};

use super::{
    block_ends::column,
    parser::{In, TokenReader},
    token_class::{ends_statements, is_pou_end},
};

/// Tokens after which the end of a block is not looked for.
pub const FURTHEST: usize = 2000;

pub fn refuse(input: &mut In<'_, '_, '_>, span: Span, message: impl Into<String>, help: impl Into<String>) {
    input.report(Diagnostic::new(Code::E0020, span, message).label("this is not a statement here").help(help));
}

/// How many tokens ahead the one after the parentheses is that open so many ahead.
pub fn behind_parentheses(input: &mut In<'_, '_, '_>, open: usize) -> usize {
    let (mut depth, mut ahead) = (0usize, open);
    loop {
        match input.kind_ahead(ahead) {
            Kind::OpenParen => depth += 1,
            Kind::CloseParen => depth = depth.saturating_sub(1),
            kind if ends_statements(kind) => return ahead,
            _ => {}
        }
        ahead += 1;
        if depth == 0 {
            return ahead;
        }
    }
}

/// Whether braces with statements are directly before the token so many ahead; then they are not a pragma.
pub fn has_braces(input: &mut In<'_, '_, '_>, ahead: usize) -> bool {
    let at = input.number() + ahead;
    let state = input.state();
    let (before, here) = (state.place(at - 1), state.place(at));
    let inside = |it: &Span| before.end <= it.start && it.end <= here.start;
    let found = state.tokens.pragmas.iter().find(|it| inside(&it.span) && it.text.contains([';', '\n']));
    let Some(span) = found.map(|it| it.span) else { return false };
    state.braces.push(span);
    true
}

pub fn is_word(input: &mut In<'_, '_, '_>, ahead: usize, word: &str) -> bool {
    let at = input.number() + ahead;
    let span = input.state().place(at);
    input.kind_ahead(ahead) == Kind::Name && input.text(span).eq_ignore_ascii_case(word)
}

/// Whether the token so many ahead is the first on its line.
pub fn starts_line(input: &mut In<'_, '_, '_>, ahead: usize) -> bool {
    let at = input.number() + ahead;
    let state = input.state();
    state.breaks(state.place(at - 1).end, state.place(at).start)
}

pub fn skip_tokens(input: &mut In<'_, '_, '_>, count: usize) {
    for _ in 0..count {
        input.take();
    }
    input.eat(Kind::Semicolon);
}

/// After the `;` of the line, or the line: what other languages have often ends without one.
pub fn skip_rest(input: &mut In<'_, '_, '_>) {
    while !input.on_new_line() && !ends_statements(input.kind()) {
        if input.eat(Kind::Semicolon).is_some() {
            return;
        }
        input.take();
    }
}

pub fn skip_line(input: &mut In<'_, '_, '_>) {
    input.take();
    while !input.on_new_line() && input.kind() != Kind::End {
        input.take();
    }
}

/// After `END_WITH`, `End With` or the END of a BEGIN, where there is one before the unit ends; else after the line.
pub fn skip_to_end_of(input: &mut In<'_, '_, '_>, word: &str) {
    let joined = format!("END_{word}");
    let mut ahead = 1;
    loop {
        let kind = input.kind_ahead(ahead);
        if kind == Kind::End || is_pou_end(kind) || ahead == FURTHEST {
            return skip_line(input);
        }
        let is_end = is_word(input, ahead, &joined);
        let is_apart = is_word(input, ahead, "END") && is_word(input, ahead + 1, word);
        if is_end || is_apart {
            return skip_tokens(input, ahead + 1 + usize::from(is_apart));
        }
        ahead += 1;
    }
}

/// Whether a line starts so many tokens ahead that is further in than the line of a word, which is its first.
pub fn is_further_in(input: &mut In<'_, '_, '_>, word: Span, ahead: usize) -> bool {
    let at = input.number();
    let state = input.state();
    match (column(state.text, word), column(state.text, state.place(at + ahead))) {
        (Some(own), Some(inner)) => own < inner,
        _ => false,
    }
}

/// After the lines that are further in than that of a word, and its `else`, where the first of them starts so many tokens ahead.
pub fn skip_further_in(input: &mut In<'_, '_, '_>, word: Span, ahead: usize) -> bool {
    if !is_further_in(input, word, ahead) {
        return false;
    }
    let own = column(input.state().text, word).unwrap_or(0);
    input.take();
    loop {
        let kind = input.kind();
        if kind == Kind::End || is_pou_end(kind) {
            return true;
        }
        if input.on_new_line() {
            let here = input.here();
            let goes_on = matches!(kind, Kind::Else | Kind::Elsif)
                || ["ELIF", "EXCEPT", "FINALLY"].iter().any(|it| input.is_word(it));
            let inner = column(input.state().text, here).unwrap_or(0);
            if inner < own || inner == own && !goes_on {
                return true;
            }
        }
        input.take();
    }
}

/// The type here that a word of another language is.
pub fn type_of_ours(word: &str) -> Option<&'static str> {
    let types = [
        ("int", "DINT"),
        ("integer", "DINT"),
        ("long", "DINT"),
        ("short", "INT"),
        ("unsigned", "UDINT"),
        ("bool", "BOOL"),
        ("boolean", "BOOL"),
        ("float", "REAL"),
        ("single", "REAL"),
        ("double", "LREAL"),
        ("char", "BYTE"),
        ("string", "STRING"),
        ("i8", "SINT"),
        ("i16", "INT"),
        ("i32", "DINT"),
        ("i64", "LINT"),
        ("u8", "USINT"),
        ("u16", "UINT"),
        ("u32", "UDINT"),
        ("u64", "ULINT"),
        ("f32", "REAL"),
        ("f64", "LREAL"),
        ("int8_t", "SINT"),
        ("int16_t", "INT"),
        ("int32_t", "DINT"),
        ("int64_t", "LINT"),
        ("uint8_t", "USINT"),
        ("uint16_t", "UINT"),
        ("uint32_t", "UDINT"),
        ("uint64_t", "ULINT"),
    ];
    let found = types.iter().find(|it| word.eq_ignore_ascii_case(it.0));
    let same = || staunch_ir::Elementary::named(word).map(|it| it.name());
    // `INT x` is said as ours: nobody means another type by it.
    same().or_else(|| found.map(|it| it.1))
}
