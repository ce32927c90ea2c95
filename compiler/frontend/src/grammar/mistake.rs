//! What is said about each mistake: one sentence, once, at the place, with what to write instead.

use crate::{
    ast::{BinaryOp, Expr, ExprKind, MAX_CHAIN, MAX_DEPTH},
    diagnostic::{Code, Diagnostic},
    lex::{Kind, index},
    source::Span,
};

use super::{
    moves::{Expected, In, Moves, Problem},
    recover,
};

/// The general sentence: what was expected, and what stands there.
pub fn report(input: &mut In<'_, '_, '_>, problem: Problem) {
    let found = input.state().tokens.kinds.get(problem.at).copied().unwrap_or(Kind::End);
    // The lexer has spoken about those.
    let known = matches!(found, Kind::Unknown | Kind::OpenText) || (found == Kind::End && input.state().tokens.cut);
    if problem.expected == Expected::Reported || known || behind_text(input, problem.at) {
        return;
    }
    if found == Kind::End && std::mem::replace(&mut input.state().ended, true) {
        return;
    }
    let mut span = input.state().place(problem.at);
    if found == Kind::End {
        span = input.state().place(problem.at.saturating_sub(1));
    }
    let shown = shown(input, found, span);
    let it = match (problem.expected, found.keyword()) {
        (Expected::Name, Some(word)) if !recover::ends_statements(found) => {
            let own = input.text(span);
            super::names::reserved(span, word, own)
        }
        (Expected::Expression, _) if is_comparison(found) && behind_junction(input, problem.at) => {
            Diagnostic::new(Code::E0001, span, format!("expected an expression, found {shown}"))
                .label("each side of AND and OR is a comparison of its own")
                .help("name the variable again: `x > 1 AND x < 5`")
        }
        (Expected::Expression, _) if found == Kind::OpenBracket => {
            Diagnostic::new(Code::E0001, span, "a list of values stands only in a declaration")
                .label("expected an expression")
                .help("assign to one element after the other: `a[0] := 1;`")
        }
        (Expected::Expression, Some(word)) if recover::opens_statement(found) => {
            Diagnostic::new(Code::E0001, span, format!("{word} is a statement, and has no value"))
                .label("expected an expression")
                .help("assign in its branches, or choose a value with `SEL(condition, value_if_false, value_if_true)`")
        }
        (Expected::Block, _) => {
            Diagnostic::new(Code::E0001, span, format!("expected {}, found {shown}", said(problem.expected)))
                .label("this belongs to no unit of the program")
        }
        (Expected::More(end, opened) | Expected::Closing(end, opened), _) => {
            let open = input.state().place(opened);
            Diagnostic::new(Code::E0001, span, format!("expected {}, found {shown}", said(problem.expected)))
                .label(format!("expected {end} before this"))
                .other(open, format!("this is closed by {end}"))
                .help(format!("write {end} here"))
                .fix(behind(input, problem.at), bracket(end))
        }
        (Expected::Token(Kind::Colon), _) if found == Kind::Semicolon => {
            let behind = Span { end: span.start, ..span };
            Diagnostic::new(Code::E0001, span, "expected `:` and a type, found `;`")
                .label("a type is missing before this")
                .help("write the type behind the name: ` : INT`")
                .fix(behind, " : INT")
        }
        (expected, _) => {
            let expected = said(expected);
            Diagnostic::new(Code::E0001, span, format!("expected {expected}, found {shown}"))
                .label(format!("expected {expected}"))
        }
    };
    input.report(it);
}

fn is_comparison(kind: Kind) -> bool {
    matches!(kind, Kind::Less | Kind::Greater | Kind::LessEqual | Kind::GreaterEqual | Kind::Equal | Kind::Unequal)
}

fn behind_junction(input: &mut In<'_, '_, '_>, at: usize) -> bool {
    let before = at.checked_sub(1).and_then(|it| input.state().tokens.kinds.get(it).copied());
    matches!(before, Some(Kind::And | Kind::Or | Kind::Xor | Kind::Ampersand | Kind::AndThen | Kind::OrElse))
}

/// `'it's late'`: what follows the second quote is a part of the text, and the third has no partner.
fn behind_text(input: &mut In<'_, '_, '_>, at: usize) -> bool {
    let Some(before) = at.checked_sub(1) else { return false };
    let state = input.state();
    let text = state.tokens.kinds.get(before) == Some(&Kind::Text);
    if !text || state.place(before).end != state.place(at).start {
        return false;
    }
    let from = state.place(at).end;
    let quotes = state.tokens.kinds.iter().zip(&state.tokens.places).skip(at);
    let open = quotes.into_iter().find(|(kind, _)| matches!(kind, Kind::OpenText | Kind::Semicolon | Kind::End));
    open.is_some_and(|(kind, place)| *kind == Kind::OpenText && !state.breaks(from, place.0))
}

fn said(expected: Expected) -> String {
    match expected {
        Expected::Token(kind) => kind.to_string(),
        Expected::More(end, _) => format!("`,` or {end}"),
        Expected::Closing(end, _) => end.to_string(),
        Expected::Name => "a name".into(),
        Expected::Expression => "an expression".into(),
        Expected::Variable => "a statement".into(),
        Expected::Type => "a type".into(),
        Expected::Label => "a CASE label such as `1:` or `1..5, 8:`".into(),
        Expected::Action => "`:=` or a call".into(),
        Expected::Block => "PROGRAM, FUNCTION_BLOCK, FUNCTION, TYPE, VAR_GLOBAL or CONFIGURATION".into(),
        Expected::Reported => String::new(),
    }
}

/// A token as a message names it: names and literals by their own text.
fn shown(input: &mut In<'_, '_, '_>, kind: Kind, span: Span) -> String {
    let text = input.text(span);
    let own = matches!(
        kind,
        Kind::Name
            | Kind::Prefix
            | Kind::Integer
            | Kind::Based
            | Kind::Real
            | Kind::Time
            | Kind::Date
            | Kind::Address
            | Kind::Part
    );
    if own && text.len() <= 40 { format!("`{text}`") } else { kind.to_string() }
}

/// The empty place behind the token before the one at `at`.
fn behind(input: &mut In<'_, '_, '_>, at: usize) -> Span {
    let last = input.state().place(at.saturating_sub(1));
    Span { start: last.end, ..last }
}

fn bracket(end: Kind) -> &'static str {
    if end == Kind::CloseBracket { "]" } else { ")" }
}

/// `word` with spaces where it would touch what stands beside `span`, which it replaces.
fn padded(input: &mut In<'_, '_, '_>, span: Span, word: &str) -> String {
    let text = input.state().text;
    let before = text[..index(span.start)].chars().next_back();
    let after = text[index(span.end)..].chars().next();
    let space = |it: Option<char>| if it.is_some_and(|it| !it.is_whitespace()) { " " } else { "" };
    format!("{}{word}{}", space(before), space(after))
}

/// Directly behind the token before the current one.
fn behind_last(input: &mut In<'_, '_, '_>) -> Span {
    let last = input.last();
    let len = input.text(last).chars().next_back().map_or(0, char::len_utf8);
    Span { start: last.end - u32::try_from(len).unwrap_or(0), ..last }
}

fn insertion(input: &mut In<'_, '_, '_>) -> Span {
    let last = input.last();
    Span { start: last.end, ..last }
}

/// Whether something before this place was already said to reach over its end.
fn swallowed(input: &mut In<'_, '_, '_>) -> bool {
    let at = input.number().saturating_sub(1);
    let state = input.state();
    let last = state.tokens.kinds.get(at).copied();
    matches!(last, Some(Kind::OpenText | Kind::Unknown)) || (state.tokens.cut && state.tokens.kinds.len() <= at + 2)
}

pub fn missing_semicolon(input: &mut In<'_, '_, '_>) {
    // At the end of the file the block around is not closed either, which is said once.
    if swallowed(input) || input.kind() == Kind::End {
        return;
    }
    let (span, place) = (behind_last(input), insertion(input));
    let kind = input.kind();
    let here = input.here();
    let found = shown(input, kind, here);
    input.report(
        Diagnostic::new(Code::E0012, span, format!("expected `;`, found {found}"))
            .label("a `;` is missing behind this")
            .help("write `;` here")
            .fix(place, ";"),
    );
}

/// THEN, DO or OF. Another of them in its place is taken for it.
pub fn missing_word(input: &mut In<'_, '_, '_>, word: Kind, opened: Span) {
    if swallowed(input) || input.kind() == Kind::End {
        return;
    }
    super::habit::extra_brackets(input, word);
    if input.eat(word).is_some() {
        return;
    }
    if input.kind() == Kind::Semicolon && input.kind_ahead(1) == word {
        return extra_semicolon(input, word);
    }
    if let Some(ahead) = on_this_line(input, word) {
        return missing_operator(input, word, ahead);
    }
    let opener = input.text(opened).to_ascii_uppercase();
    let kind = input.kind();
    let here = input.here();
    let found = shown(input, kind, here);
    let wrong = matches!(kind, Kind::Then | Kind::Do | Kind::Of | Kind::Semicolon | Kind::Colon);
    let message = format!("expected {word}, found {found}");
    let it = if wrong {
        input.take();
        let replacement = padded(input, here, word.keyword().unwrap_or_default());
        Diagnostic::new(Code::E0013, here, message)
            .label(format!("expected {word}"))
            .help(format!("write {word} here"))
            .fix(here, replacement)
    } else {
        let (span, place) = (behind_last(input), insertion(input));
        Diagnostic::new(Code::E0013, span, message)
            .label(format!("{word} is missing behind this"))
            .help(format!("write {word} here"))
            .fix(place, format!(" {}", word.keyword().unwrap_or_default()))
    };
    let word = word.keyword().unwrap_or_default();
    input.report(it.other(opened, format!("this {opener} needs {}", crate::key::article(word))));
}

/// How far ahead `word` stands on the current line, before the statement ends.
fn on_this_line(input: &mut In<'_, '_, '_>, word: Kind) -> Option<usize> {
    let mut ahead = 0;
    while input.kind_ahead(ahead) != word {
        let kind = input.kind_ahead(ahead);
        let at = input.number() + ahead;
        let state = input.state();
        let (before, here) = (state.place(at.saturating_sub(1)), state.place(at));
        let ends = matches!(kind, Kind::Semicolon | Kind::Assign | Kind::Colon) || recover::ends_statements(kind);
        if ends || recover::opens_statement(kind) || state.breaks(before.end, here.start) {
            return None;
        }
        ahead += 1;
    }
    (ahead > 0).then_some(ahead)
}

/// `IF a b THEN`
fn missing_operator(input: &mut In<'_, '_, '_>, word: Kind, ahead: usize) {
    let (kind, here) = (input.kind(), input.here());
    let found = shown(input, kind, here);
    input.report(
        Diagnostic::new(Code::E0001, here, format!("expected an operator or {word}, found {found}"))
            .label("expected an operator before this")
            .help("write `AND` or `OR` between two conditions"),
    );
    for _ in 0..=ahead {
        input.take();
    }
}

/// `IF a; THEN`
fn extra_semicolon(input: &mut In<'_, '_, '_>, word: Kind) {
    let span = input.take();
    input.take();
    input.report(
        Diagnostic::new(Code::E0013, span, format!("expected {word}, found `;`"))
            .label("the condition goes on to the next word")
            .help("delete this `;`")
            .fix(span, ""),
    );
}

pub fn missing_end(input: &mut In<'_, '_, '_>, end: Kind, opened: Span) {
    let kind = input.kind();
    if swallowed(input) || (kind == Kind::End && input.state().tokens.cut) {
        return;
    }
    let opener = input.text(opened).to_ascii_uppercase();
    let mut here = input.here();
    let found = shown(input, kind, here);
    if kind == Kind::End {
        if std::mem::replace(&mut input.state().ended, true) {
            return;
        }
        here = input.last();
    }
    let close = end.keyword().unwrap_or_default();
    let outer: Vec<_> = input.state().open.iter().rev().map(|(end, _)| end.to_string()).collect();
    let help = if kind == Kind::End && !outer.is_empty() {
        format!("the file ends too early: write `{close}`, then {}", outer.join(", then "))
    } else {
        format!("write `{close}` where the {opener} ends")
    };
    let mut it = Diagnostic::new(Code::E0014, here, format!("expected {end}, found {found}"))
        .label(format!("expected {end} before this"))
        .other(opened, format!("this {opener} is not closed"));
    let inner = input.state().misaligned.filter(|it| it.start > opened.start);
    if let Some(inner) = inner {
        let inner_opener = input.text(inner).to_ascii_uppercase();
        it = it.other(inner, format!("or this {inner_opener} is not: the end behind it stands in another column"));
    }
    input.report(it.help(help));
}

/// `WHILE … END_IF`
pub fn wrong_end(input: &mut In<'_, '_, '_>, end: Kind, opened: Span) {
    let here = input.here();
    let found = input.kind();
    let opener = input.text(opened).to_ascii_uppercase();
    input.report(
        Diagnostic::new(Code::E0014, here, format!("expected {end}, found {found}"))
            .label(format!("expected {end}"))
            .other(opened, format!("this {opener} is closed by {end}"))
            .help(format!("write {end}"))
            .fix(here, end.keyword().unwrap_or_default()),
    );
}

/// `ELSE IF` with one END_IF for two IFs.
pub fn else_if(input: &mut In<'_, '_, '_>, words: Span, opened: Span) {
    if input.kind() == Kind::End && input.state().tokens.cut {
        return;
    }
    input.report(
        Diagnostic::new(Code::E0011, words, "`ELSE IF` starts a second IF, which has no END_IF of its own")
            .label("a further branch is written `ELSIF`")
            .other(opened, "the END_IF of this IF is missing")
            .help("write `ELSIF`, or close both IFs with an `END_IF` each")
            .fix(words, "ELSIF"),
    );
    input.eat(Kind::Semicolon);
}

pub fn behind_else(word: Span, kind: Kind) -> Diagnostic {
    Diagnostic::new(Code::E0015, word, format!("{kind} stands behind the ELSE of the same IF"))
        .label("expected `END_IF`")
        .help("move this branch before the ELSE")
}

pub fn stray(span: Span, kind: Kind) -> Diagnostic {
    let (what, help) = match kind {
        Kind::Else => ("there is no open IF or CASE here".to_owned(), "delete it, or open the IF that it belongs to"),
        Kind::Elsif => ("there is no open IF here".to_owned(), "delete it, or open the IF that it belongs to"),
        Kind::Until => ("there is no open REPEAT here".to_owned(), "delete it, or write REPEAT before the loop"),
        kind => {
            let opener = kind.keyword().unwrap_or_default().trim_start_matches("END_");
            (format!("there is no open {opener} here"), "delete it, or look for the block that ends too early")
        }
    };
    Diagnostic::new(Code::E0015, span, format!("{kind} belongs to nothing: {what}"))
        .label("nothing to close or continue")
        .help(help)
}

pub fn equal_for_assign(sign: Span, text: &str) -> Diagnostic {
    let message = match text {
        "=" | "==" => format!("`{text}` compares; an assignment is written `:=`"),
        _ => "`:=` is written in one piece".into(),
    };
    Diagnostic::new(Code::E0008, sign, message).label("expected `:=`").help("write `:=`").fix(sign, ":=")
}

pub fn assign_for_equal(left: &str, sign: Span) -> Diagnostic {
    let shown = if left.len() <= 40 { left } else { "a" };
    Diagnostic::new(Code::E0009, sign, "`:=` assigns, and a condition cannot; a comparison is written `=`")
        .label("expected `=`")
        .help(format!("write `{shown} = …`"))
        .fix(sign, "=")
}

pub fn foreign_operator(input: &mut In<'_, '_, '_>, kind: Kind, op: BinaryOp, sign: Span) {
    let ours = op.text();
    let replacement = spaced(input, ours, sign);
    let theirs = if kind == Kind::Name { format!("`{}`", input.text(sign)) } else { kind.to_string() };
    let mut it = Diagnostic::new(Code::E0010, sign, format!("Structured Text writes `{ours}` for {theirs}"))
        .label(format!("expected `{ours}`"))
        .help(format!("write `{ours}`"))
        .fix(sign, replacement);
    match op {
        BinaryOp::And => it = it.note("`AND_THEN` evaluates its right side only when it is needed"),
        BinaryOp::Or => it = it.note("`OR_ELSE` evaluates its right side only when it is needed"),
        _ => {}
    }
    input.report(it);
}

/// A word keeps its distance from what stood directly beside the sign.
fn spaced(input: &mut In<'_, '_, '_>, operator: &str, sign: Span) -> String {
    if !operator.starts_with(|it: char| it.is_ascii_alphabetic()) {
        return operator.into();
    }
    let bytes = input.state().text.as_bytes();
    let beside = |at: usize| bytes.get(at).is_some_and(|it| !it.is_ascii_whitespace());
    let before = if beside(index(sign.start).wrapping_sub(1)) { " " } else { "" };
    let after = if beside(index(sign.end)) { " " } else { "" };
    format!("{before}{operator}{after}")
}

pub fn foreign_not(sign: Span) -> Diagnostic {
    Diagnostic::new(Code::E0010, sign, "Structured Text writes `NOT` for `!`")
        .label("expected `NOT`")
        .help("write `NOT`")
        .fix(sign, "NOT ")
}

/// `x += 1`
pub fn compound_assignment(input: &mut In<'_, '_, '_>, target: &Expr<'_>) {
    let sign = input.here();
    let (text, target) = (input.text(sign), input.text(target.span));
    let op = &text[..1];
    input.report(
        Diagnostic::new(Code::E0010, sign, format!("Structured Text has no `{text}`"))
            .label("expected `:=`")
            .help(format!("write `{target} := {target} {op} …`"))
            .fix(sign, format!(":= {target} {op}")),
    );
}

/// `x++;`
pub fn increment(input: &mut In<'_, '_, '_>, target: &Expr<'_>) -> bool {
    let kind = input.kind();
    let doubled = matches!(kind, Kind::Plus | Kind::Minus) && input.kind_ahead(1) == kind;
    if !doubled || input.kind_ahead(2) != Kind::Semicolon {
        return false;
    }
    let sign = input.take();
    let sign = sign.to(input.take());
    let (text, name) = (input.text(sign), input.text(target.span));
    let op = &text[..1];
    input.report(
        Diagnostic::new(Code::E0010, sign, format!("Structured Text has no `{text}`"))
            .label("expected `:=`")
            .help(format!("write `{name} := {name} {op} 1`"))
            .fix(target.span.to(sign), format!("{name} := {name} {op} 1")),
    );
    true
}

/// `x := INT;` among declarations.
pub fn assign_for_colon(sign: Span) -> Diagnostic {
    Diagnostic::new(Code::E0001, sign, "expected `:` and a type, found `:=`")
        .label("expected `:`")
        .help("write the type before the initial value: `name : INT := 0;`")
}

/// `RETURN x;`
pub fn return_value(span: Span, value: Span) -> Diagnostic {
    Diagnostic::new(Code::E0019, span, "RETURN takes no value")
        .other(value, "this belongs into an assignment")
        .help("assign the result to the function's own name, then write `RETURN;`")
}

/// More of one list than anybody writes.
pub fn too_many(limit: usize) -> String {
    format!("this list has more than {limit} items")
}

pub fn declaration_behind_statements(span: Span) -> Diagnostic {
    Diagnostic::new(Code::E0017, span, "this declaration stands behind statements")
        .label("all VAR blocks come before the first statement")
        .help("move this block to the head of its PROGRAM, FUNCTION_BLOCK or FUNCTION")
}

pub fn unsupported(span: Span, what: &str) -> Diagnostic {
    Diagnostic::new(Code::E0090, span, format!("{what} is not supported yet"))
}

pub fn too_deep() -> String {
    format!("this is nested more than {MAX_DEPTH} levels deep")
}

pub fn too_long() -> String {
    format!("this chain is longer than {MAX_CHAIN}")
}

/// `ENDIF`, `ELSEIF`: the keyword that a name at the start of a statement stands for.
fn misspelt_word(word: &str) -> Option<Kind> {
    const WORDS: [(&str, Kind); 14] = [
        ("ELSEIF", Kind::Elsif),
        ("ELSE_IF", Kind::Elsif),
        ("ELIF", Kind::Elsif),
        ("ENDIF", Kind::EndIf),
        ("ENDFOR", Kind::EndFor),
        ("ENDWHILE", Kind::EndWhile),
        ("ENDCASE", Kind::EndCase),
        ("ENDREPEAT", Kind::EndRepeat),
        ("ENDVAR", Kind::EndVar),
        ("ENDSTRUCT", Kind::EndStruct),
        ("ENDTYPE", Kind::EndType),
        ("ENDPROGRAM", Kind::EndProgram),
        ("ENDFUNCTION", Kind::EndFunction),
        ("ENDFUNCTION_BLOCK", Kind::EndFunctionBlock),
    ];
    WORDS.iter().find(|(it, _)| word.eq_ignore_ascii_case(it)).map(|(_, kind)| *kind)
}

/// The end that a name stands for, with the kind behind it, and how many tokens that takes:
/// `ENDIF`, `END_FOOR`, `END IF`.
pub fn misspelt_end(word: &str, next: Kind) -> Option<(Kind, usize)> {
    if word.eq_ignore_ascii_case("END") {
        return misspelt_word(&format!("END{}", next.keyword()?)).map(|kind| (kind, 2));
    }
    if let Some(kind) = misspelt_word(word) {
        return Some((kind, 1));
    }
    let ends = word.get(..3).is_some_and(|it| it.eq_ignore_ascii_case("END")) && word.len() > 4;
    ends.then(|| nearest_of(word, ENDS)).flatten().map(|kind| (kind, 1))
}

const ENDS: &[Kind] = &[
    Kind::EndIf,
    Kind::EndFor,
    Kind::EndWhile,
    Kind::EndCase,
    Kind::EndRepeat,
    Kind::EndVar,
    Kind::EndStruct,
    Kind::EndType,
    Kind::EndProgram,
    Kind::EndFunction,
    Kind::EndFunctionBlock,
];

const SECTIONS: &[Kind] = &[
    Kind::VarInput,
    Kind::VarOutput,
    Kind::VarInOut,
    Kind::VarTemp,
    Kind::VarStat,
    Kind::VarGlobal,
    Kind::VarExternal,
];

const OPENERS: &[Kind] = &[Kind::While, Kind::Repeat, Kind::Case, Kind::For, Kind::If, Kind::Elsif, Kind::Return];

const ITEMS: &[Kind] =
    &[Kind::Program, Kind::FunctionBlock, Kind::Function, Kind::Type, Kind::Configuration, Kind::VarGlobal];

fn nearest_of(word: &str, kinds: &[Kind]) -> Option<Kind> {
    let near = crate::key::nearest(word, kinds.iter().filter_map(|it| it.keyword()))?;
    kinds.iter().copied().find(|it| it.keyword() == Some(near))
}

/// The misspelt keyword at the current place, and how many tokens it takes: `END IF` has two.
pub fn misspelt(input: &mut In<'_, '_, '_>) -> Option<(Kind, usize)> {
    if input.kind() != Kind::Name {
        return None;
    }
    let span = input.here();
    let (word, next) = (input.text(span), input.kind_ahead(1));
    if let Some(found) = misspelt_end(word, next) {
        return Some(found);
    }
    if word.eq_ignore_ascii_case("WEND") && waits_for(input, Kind::EndWhile) {
        return Some((Kind::EndWhile, 1));
    }
    if word.eq_ignore_ascii_case("NEXT") && next == Kind::Name && waits_for(input, Kind::EndFor) {
        let at = input.number();
        let state = input.state();
        let joined = !state.breaks(state.place(at).end, state.place(at + 1).start);
        return Some((Kind::EndFor, if joined { 2 } else { 1 }));
    }
    if word.eq_ignore_ascii_case("END") || (word.eq_ignore_ascii_case("NEXT") && waits_for(input, Kind::EndFor)) {
        return innermost(input).map(|end| (end, 1));
    }
    let section = match word.to_ascii_uppercase().as_str() {
        "VARIN" | "VAR_IN" | "VARINPUT" | "VAR_INPUTS" => Some(Kind::VarInput),
        "VAROUT" | "VAR_OUT" | "VAROUTPUT" | "VAR_OUTPUTS" => Some(Kind::VarOutput),
        "VARINOUT" | "VAR_INOUT" => Some(Kind::VarInOut),
        "VARS" | "VAR_RETAIN" | "VAR_CONSTANT" | "VAR_PERSISTENT" => Some(Kind::Var),
        upper if upper.starts_with("VAR") && upper.len() > 4 => nearest_of(word, SECTIONS),
        _ => None,
    };
    if let Some(section) = section.filter(|_| next == Kind::Name) {
        return Some((section, 1));
    }
    let operand = matches!(next, Kind::Name | Kind::Integer | Kind::Not | Kind::True | Kind::False | Kind::OpenParen);
    match word.to_ascii_uppercase().as_str() {
        "SWITCH" | "SELECT" if operand => Some((Kind::Case, 1)),
        _ if operand => nearest_of(word, OPENERS).map(|kind| (kind, 1)),
        _ => None,
    }
}

fn waits_for(input: &mut In<'_, '_, '_>, end: Kind) -> bool {
    input.state().open.last().is_some_and(|(it, _)| *it == end)
}

/// The end of the innermost block of statements.
fn innermost(input: &mut In<'_, '_, '_>) -> Option<Kind> {
    input.state().open.last().map(|(end, _)| *end).filter(|it| !recover::is_pou_end(*it))
}

/// `PROGRM Main`, `FUNCTION BLOCK f`: the keyword that opens an item.
pub fn misspelt_item(input: &mut In<'_, '_, '_>) -> Option<Kind> {
    if input.kind() != Kind::Name || input.kind_ahead(1) != Kind::Name {
        return None;
    }
    let span = input.here();
    nearest_of(input.text(span), ITEMS)
}

/// Whether a name that stands alone is a misspelt keyword.
pub fn is_misspelt(input: &mut In<'_, '_, '_>, target: &Expr<'_>) -> bool {
    let ExprKind::Name(name) = &target.kind else { return false };
    (name.text.eq_ignore_ascii_case("END") && innermost(input).is_some())
        || (name.text.eq_ignore_ascii_case("NEXT") && waits_for(input, Kind::EndFor))
        || (name.text.eq_ignore_ascii_case("WEND") && waits_for(input, Kind::EndWhile))
        || misspelt_end(name.text, Kind::Semicolon).is_some()
}

pub fn misspelt_keyword(input: &mut In<'_, '_, '_>, kind: Kind, span: Span) {
    let found = input.text(span);
    let qualified = found.to_ascii_uppercase().replace('_', " ");
    let two_words = matches!(qualified.as_str(), "VAR RETAIN" | "VAR CONSTANT" | "VAR PERSISTENT");
    let word = if two_words { qualified.as_str() } else { kind.keyword().unwrap_or_default() };
    input.report(
        Diagnostic::new(Code::E0018, span, format!("`{found}` is written `{word}`"))
            .label(format!("expected `{word}`"))
            .help(format!("write `{word}`"))
            .fix(span, word),
    );
}

/// `5 y := 1;` among the arms of a CASE.
pub fn missing_colon(input: &mut In<'_, '_, '_>) {
    let (span, place) = (behind_last(input), insertion(input));
    let kind = input.kind();
    let here = input.here();
    let found = shown(input, kind, here);
    input.report(
        Diagnostic::new(Code::E0001, span, format!("expected `:`, found {found}"))
            .label("a `:` is missing behind this label")
            .help("write `:` here")
            .fix(place, ":"),
    );
}

/// `w INT;` or `q = INT;` among declarations.
pub fn missing_type_colon(input: &mut In<'_, '_, '_>) {
    let found = input.kind();
    let here = input.here();
    let shown = shown(input, found, here);
    let message = format!("expected `:`, found {shown}");
    if matches!(found, Kind::Equal | Kind::Semicolon) {
        input.take();
        input
            .report(Diagnostic::new(Code::E0001, here, message).label("expected `:`").help("write `:`").fix(here, ":"));
        return;
    }
    let (span, place) = (behind_last(input), insertion(input));
    input.report(
        Diagnostic::new(Code::E0001, span, message)
            .label("a `:` is missing behind this")
            .help("write `:` here")
            .fix(place, " :"),
    );
}

/// `INT x;`
pub fn type_first(input: &mut In<'_, '_, '_>, ty: Span, name: Span) {
    let meant = format!("{} : {}", input.text(name), input.text(ty));
    let whole = ty.to(name);
    input.report(
        Diagnostic::new(Code::E0001, whole, "the name stands before the type")
            .label("expected a name, `:` and a type")
            .help(format!("write `{meant}`"))
            .fix(whole, meant),
    );
}

/// `my var : INT;`
pub fn name_of_two_words(input: &mut In<'_, '_, '_>, first: Span, second: Span) {
    let meant = format!("{}_{}", input.text(first), input.text(second));
    let whole = first.to(second);
    input.report(
        Diagnostic::new(Code::E0001, whole, "a name is one word")
            .label("two words")
            .help(format!("write `{meant}`"))
            .fix(whole, meant),
    );
}

/// `MAX(1 2)`
pub fn missing_comma(input: &mut In<'_, '_, '_>) {
    let (span, place) = (behind_last(input), insertion(input));
    let kind = input.kind();
    let here = input.here();
    let found = shown(input, kind, here);
    if kind == Kind::Semicolon {
        input.report(
            Diagnostic::new(Code::E0001, here, "expected `,`, found `;`")
                .label("the list goes on behind this")
                .help("write `,`")
                .fix(here, ","),
        );
        return;
    }
    input.report(
        Diagnostic::new(Code::E0001, span, format!("expected `,`, found {found}"))
            .label("a `,` is missing behind this")
            .help("write `,` here")
            .fix(place, ","),
    );
}

/// `a : INT;` among statements; `closed` where an END_VAR stands behind such declarations.
pub fn stray_declaration(input: &mut In<'_, '_, '_>, span: Span, closed: bool) {
    let it = Diagnostic::new(Code::E0017, span, "this declaration stands outside of VAR … END_VAR");
    let text = input.text(span);
    input.report(if closed {
        it.label("expected `VAR` before this").help("write `VAR` here").fix(Span { end: span.start, ..span }, "VAR ")
    } else {
        it.label("only statements stand here").help(format!("write `VAR {text} END_VAR` before the first statement"))
    });
}

/// A VAR block or a statement outside of all units.
pub fn outside_of_units(span: Span, statements: bool) -> Diagnostic {
    let it = Diagnostic::new(Code::E0001, span, "this belongs to no unit of the program")
        .label("no PROGRAM, FUNCTION_BLOCK or FUNCTION is open here");
    if statements {
        it.help("write `PROGRAM Main` before it, and `END_PROGRAM` behind it")
    } else {
        it.help("write `VAR_GLOBAL` for global variables, or `PROGRAM Main` before it")
    }
}

/// `FUNCTION f(x : INT) : INT`, `PROGRAM p()`
pub fn parameters_in_head(span: Span, empty: bool) -> Diagnostic {
    if empty {
        return Diagnostic::new(Code::E0020, span, "no parentheses stand behind the name of a unit")
            .label("delete this")
            .help("delete them")
            .fix(span, "");
    }
    Diagnostic::new(Code::E0020, span, "parameters stand in VAR_INPUT, not in parentheses")
        .label("expected no parentheses")
        .help("write `VAR_INPUT x : INT; END_VAR` on the next line")
}

/// `else:`
pub fn colon_behind_else(span: Span) -> Diagnostic {
    Diagnostic::new(Code::E0001, span, "no `:` stands behind the ELSE of an IF")
        .label("delete this")
        .help("delete it")
        .fix(span, "")
}

/// `ARRAY[10]`, `ARRAY[1:3]`, `ARRAY(1..3)`, `INT[10]`: what is wrong at `span`, and what is meant.
pub fn array_bounds(span: Span, found: &str, meant: &str) -> Diagnostic {
    Diagnostic::new(Code::E0001, span, "an array is declared by its first and its last index")
        .label(format!("expected `[first..last]`, found {found}"))
        .help(format!("write `{meant}`"))
}

/// A name alone on its line.
pub fn name_alone(input: &mut In<'_, '_, '_>, span: Span) {
    let text = input.text(span);
    input.report(
        Diagnostic::new(Code::E0001, span, "expected `:=` or a call behind this")
            .label("this alone is no statement")
            .help(format!("to assign, write `{text} := …;`; to call, `{text}(…);`")),
    );
}

/// `STRUCT Name` outside of TYPE.
pub fn bare_structure(span: Span, name: &str) -> Diagnostic {
    Diagnostic::new(Code::E0001, span, "a structure is declared in TYPE … END_TYPE")
        .label("expected `TYPE` before this")
        .help(format!("write `TYPE {name} : STRUCT … END_STRUCT; END_TYPE`"))
}

/// TYPE or FUNCTION inside a PROGRAM.
pub fn nested_unit(span: Span, kind: Kind, outer: &str) -> Diagnostic {
    Diagnostic::new(Code::E0001, span, format!("{kind} stands inside {}", crate::key::article(outer)))
        .label("units of the program stand beside one another")
        .help(format!("move it before the {outer}"))
}

/// `FUNCTION_BLOCK f : INT`
pub fn no_result_type(span: Span, opener: &str) -> Diagnostic {
    let opener = opener.to_ascii_uppercase();
    Diagnostic::new(Code::E0001, span, format!("{} has no result type", crate::key::article(&opener)))
        .label("delete this")
        .help("delete it, and declare what it returns in VAR_OUTPUT")
        .fix(span, "")
}

/// `x AT IX0.0`
pub fn address_without_sign(span: Span, text: &str) -> Diagnostic {
    Diagnostic::new(Code::E0409, span, "a direct address starts with `%`")
        .help(format!("write `%{text}`"))
        .fix(span, format!("%{text}"))
}

/// `x : BOOL AT %QX0.0;`
pub fn address_behind_type(span: Span) -> Diagnostic {
    Diagnostic::new(Code::E0409, span, "the address of a variable stands before its type")
        .label("expected before the `:`")
        .help("write `name AT %QX0.0 : BOOL;`")
}

/// `IN: x` among arguments.
pub fn colon_for_assign(input: &mut In<'_, '_, '_>, sign: Span) {
    let replacement = padded(input, sign, ":=");
    input.report(
        Diagnostic::new(Code::E0008, sign, "an argument is connected with `:=`")
            .label("expected `:=`")
            .help("write `:=`")
            .fix(sign, replacement),
    );
}

/// `IN x` among arguments.
pub fn missing_assign(input: &mut In<'_, '_, '_>) {
    let (span, place) = (input.last(), insertion(input));
    let (kind, here) = (input.kind(), input.here());
    let found = shown(input, kind, here);
    input.report(
        Diagnostic::new(Code::E0001, span, format!("expected `:=`, found {found}"))
            .label("a `:=` is missing behind this")
            .help("write `:=` here")
            .fix(place, " :="),
    );
}
