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
    let known = matches!(found, Kind::Unknown) || (found == Kind::End && input.state().tokens.cut);
    if problem.expected == Expected::Reported || known {
        return;
    }
    let mut span = input.state().place(problem.at);
    if found == Kind::End {
        span = input.state().place(problem.at.saturating_sub(1));
    }
    let shown = shown(input, found, span);
    let it = match (problem.expected, found.keyword()) {
        (Expected::Name, Some(word)) if !recover::ends_statements(found) => {
            Diagnostic::new(Code::E0016, span, format!("`{word}` is a reserved word and cannot be a name"))
                .label("expected a name")
                .help("choose another name")
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
        }
        (expected, _) => {
            let expected = said(expected);
            Diagnostic::new(Code::E0001, span, format!("expected {expected}, found {shown}"))
                .label(format!("expected {expected}"))
        }
    };
    input.report(it);
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
    if swallowed(input) {
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
    if swallowed(input) {
        return;
    }
    let opener = input.text(opened).to_ascii_uppercase();
    let kind = input.kind();
    let here = input.here();
    let found = shown(input, kind, here);
    let wrong = matches!(kind, Kind::Then | Kind::Do | Kind::Of | Kind::Semicolon | Kind::Colon);
    let message = format!("expected {word}, found {found}");
    let it = if wrong {
        input.take();
        Diagnostic::new(Code::E0013, here, message)
            .label(format!("expected {word}"))
            .help(format!("write {word} here"))
            .fix(here, word.keyword().unwrap_or_default())
    } else {
        let (span, place) = (behind_last(input), insertion(input));
        Diagnostic::new(Code::E0013, span, message)
            .label(format!("{word} is missing behind this"))
            .help(format!("write {word} here"))
            .fix(place, format!(" {}", word.keyword().unwrap_or_default()))
    };
    input.report(it.other(opened, format!("this {opener} needs a {}", word.keyword().unwrap_or_default())));
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
        here = input.last();
    }
    let close = end.keyword().unwrap_or_default();
    input.report(
        Diagnostic::new(Code::E0014, here, format!("expected {end}, found {found}"))
            .label(format!("expected {end} before this"))
            .other(opened, format!("this {opener} is not closed"))
            .help(format!("write `{close}` where the {opener} ends")),
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
    let mut it = Diagnostic::new(Code::E0010, sign, format!("Structured Text writes `{ours}` for {kind}"))
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

/// A POU that is closed by another kind's keyword.
pub fn wrong_pou_end(input: &mut In<'_, '_, '_>, end: Kind, opened: Span) {
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

/// The misspelt keyword at the current place, and how many tokens it takes: `END IF` has two.
pub fn misspelt(input: &mut In<'_, '_, '_>) -> Option<(Kind, usize)> {
    if !input.is_word("END") {
        let span = input.here();
        return misspelt_word(input.text(span)).map(|kind| (kind, 1));
    }
    let second = input.kind_ahead(1).keyword()?;
    misspelt_word(&format!("END{second}")).map(|kind| (kind, 2))
}

/// Whether a name that stands alone is a misspelt keyword.
pub fn is_misspelt(target: &Expr<'_>) -> bool {
    let ExprKind::Name(name) = &target.kind else { return false };
    misspelt_word(name.text).is_some()
}

pub fn misspelt_keyword(input: &mut In<'_, '_, '_>, kind: Kind, span: Span) {
    let found = input.text(span);
    let word = kind.keyword().unwrap_or_default();
    input.report(
        Diagnostic::new(Code::E0018, span, format!("`{found}` is written {kind}"))
            .label(format!("expected {kind}"))
            .help(format!("write {kind}"))
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
