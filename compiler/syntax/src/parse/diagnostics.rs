//! What is said about each mistake: one sentence, once, at the place, with what to write instead.

use crate::{
    ast::PouKind,
    diagnostic::{Code, Diagnostic, Severity, wording::article},
    lex::{Kind, index},
    source::Span,
};

mod chart;
mod declared;
mod operator;

pub use chart::*;
pub use declared::*;
pub use operator::*;

use super::{
    parser::{Expected, In, Problem, TokenReader},
    token_class::{ends_statements, opens_statement},
};

/// The general sentence: what was expected, and what was found.
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
    if let Some(doubled) = doubled_quote(input, problem.at) {
        return input.report(doubled);
    }
    let shown = shown(input, found, span);
    let it = match (problem.expected, found.keyword()) {
        (Expected::Name, Some(word)) if !ends_statements(found) => {
            let own = input.text(span);
            reserved(span, word, own)
        }
        (Expected::Expression, _) if is_comparison(found) && behind_junction(input, problem.at) => {
            Diagnostic::new(Code::E0001, span, format!("expected an expression, found {shown}"))
                .label("each side of AND and OR is a comparison of its own")
                .help("name the variable again: `x > 1 AND x < 5`")
        }
        (Expected::Expression, _) if found == Kind::OpenBracket => {
            Diagnostic::new(Code::E0001, span, "a list of values is allowed only in a declaration")
                .label("expected an expression")
                .help("assign to one element after the other: `a[0] := 1;`")
        }
        (Expected::Expression, Some(word)) if opens_statement(found) => {
            Diagnostic::new(Code::E0001, span, format!("{word} is a statement, and has no value"))
                .label("expected an expression")
                .help("assign in its branches, or choose a value with `SEL(condition, value_if_false, value_if_true)`")
        }
        (Expected::Block, _) => {
            let it = Diagnostic::new(Code::E0001, span, format!("expected {}, found {shown}", said(problem.expected)))
                .label("this is outside any unit of the program");
            let is_test =
                ["TEST_PROGRAM", "TEST_FUNCTION_BLOCK"].iter().any(|it| it.eq_ignore_ascii_case(input.text(span)));
            if is_test { it.help("a unit test is written `TEST 'what it shows' … END_TEST`") } else { it }
        }
        (Expected::Closing(Kind::CloseParen, opened), _) if found == Kind::Comma && names_member(input, opened) => {
            Diagnostic::new(Code::E0001, span, "a list of members is allowed only in a declaration")
                .label("expected `)`")
                .help("assign to one member after the other: `s.a := 1;`")
        }
        (Expected::More(end, opened) | Expected::Closing(end, opened), _) => {
            let open = input.state().place(opened);
            let it = Diagnostic::new(Code::E0001, span, format!("expected {}, found {shown}", said(problem.expected)))
                .label(format!("expected {end} before this"))
                .other(open, format!("this is closed by {end}"));
            match found {
                // What is in brackets seems to be a list, which a closing bracket would cut off.
                Kind::Comma => it,
                _ => it.help(format!("write {end} here")).fix(after(input, problem.at), bracket(end)),
            }
        }
        (Expected::Token(Kind::Colon), _) if found == Kind::Semicolon && in_case(input) => {
            Diagnostic::new(Code::E0001, span, "a CASE label ends with `:`, not with `;`")
                .label("expected `:`")
                .help("write `:`")
                .fix(span, ":")
        }
        (Expected::Token(Kind::Colon), _) if found == Kind::Semicolon => {
            let after = Span { end: span.start, ..span };
            Diagnostic::new(Code::E0001, span, "expected `:` and a type, found `;`")
                .label("a type is missing before this")
                .help("write the type after the name: ` : INT`")
                .fix(after, " : INT")
        }
        (Expected::Action, _) if is_operator(found) => {
            Diagnostic::new(Code::E0001, span, "a statement assigns a value, or calls something")
                .label("this only computes")
                .help("assign what it computes: `x := …;`")
        }
        (Expected::Action, _) if found == Kind::Name && names_a_word_more(input, problem.at) => {
            return two_words(input, problem.at);
        }
        (Expected::Other, _) => {
            let it = Diagnostic::new(Code::E0001, span, format!("{shown} cannot be here"));
            it.label("this does not fit what comes before it")
        }
        (expected, _) => {
            let expected = said(expected);
            Diagnostic::new(Code::E0001, span, format!("expected {expected}, found {shown}"))
                .label(format!("expected {expected}"))
        }
    };
    input.report(it);
}

fn is_operator(kind: Kind) -> bool {
    matches!(kind, Kind::Plus | Kind::Minus | Kind::Star | Kind::Slash | Kind::And | Kind::Or | Kind::Xor | Kind::Mod)
        || (is_comparison(kind) && kind != Kind::Equal)
}

/// `motor speed := 3`, at the second word.
fn names_a_word_more(input: &mut In<'_, '_, '_>, at: usize) -> bool {
    let state = input.state();
    let Some(before) = at.checked_sub(1) else { return false };
    let kinds = state.tokens.kinds.get(before..).unwrap_or_default();
    let is_first = before == 0 || !matches!(state.tokens.kinds.get(before - 1), Some(Kind::Dot));
    is_first
        && kinds.starts_with(&[Kind::Name, Kind::Name, Kind::Assign])
        && !state.breaks(state.place(before).end, state.place(at).start)
}

fn two_words(input: &mut In<'_, '_, '_>, at: usize) {
    let (first, second) = (input.state().place(at - 1), input.state().place(at));
    name_of_two_words(input, first, second);
}

fn is_comparison(kind: Kind) -> bool {
    matches!(kind, Kind::Less | Kind::Greater | Kind::LessEqual | Kind::GreaterEqual | Kind::Equal | Kind::Unequal)
}

fn behind_junction(input: &mut In<'_, '_, '_>, at: usize) -> bool {
    let before = at.checked_sub(1).and_then(|it| input.state().tokens.kinds.get(it).copied());
    matches!(before, Some(Kind::And | Kind::Or | Kind::Xor | Kind::Ampersand | Kind::AndThen | Kind::OrElse))
}

/// `(a := 1`
fn names_member(input: &mut In<'_, '_, '_>, opened: usize) -> bool {
    let kinds = &input.state().tokens.kinds;
    kinds.get(opened..).is_some_and(|it| it.starts_with(&[Kind::OpenParen, Kind::Name, Kind::Assign]))
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

/// `'it''s'`, which is two strings.
fn doubled_quote(input: &mut In<'_, '_, '_>, at: usize) -> Option<Diagnostic> {
    let before = at.checked_sub(1)?;
    let state = input.state();
    let is_text = |at| state.tokens.kinds.get(at) == Some(&Kind::Text);
    let (first, second) = (state.place(before), state.place(at));
    if !is_text(before) || !is_text(at) || first.end != second.start {
        return None;
    }
    let quotes = Span { start: second.start - 1, end: second.start + 1, ..second };
    let error = Diagnostic::new(Code::E0001, quotes, "two quotes end a string and begin another one");
    Some(error.label("here").help("in a string, `$'` is a quote").fix(quotes, "$'"))
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
        Expected::Other => "something else".into(),
        Expected::Reported => String::new(),
    }
}

/// A token as a message names it: names and literals by their own text.
pub fn shown(input: &mut In<'_, '_, '_>, kind: Kind, span: Span) -> String {
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
    match kind {
        Kind::End if input.state().is_expression => "the end of the expression".to_owned(),
        _ if own && text.len() <= 40 => format!("`{text}`"),
        _ => kind.to_string(),
    }
}

/// The empty place after the token before the one at `at`.
fn after(input: &mut In<'_, '_, '_>, at: usize) -> Span {
    let last = input.state().place(at.saturating_sub(1));
    Span { start: last.end, ..last }
}

fn bracket(end: Kind) -> &'static str {
    if end == Kind::CloseBracket { "]" } else { ")" }
}

/// `word` with spaces where it would touch the text next to `span`, which it replaces.
pub fn padded(input: &mut In<'_, '_, '_>, span: Span, word: &str) -> String {
    let text = input.state().text;
    let before = text[..index(span.start)].chars().next_back();
    let after = text[index(span.end)..].chars().next();
    let space = |it: Option<char>| if it.is_some_and(|it| !it.is_whitespace()) { " " } else { "" };
    format!("{}{word}{}", space(before), space(after))
}

/// Directly after the token before the current one.
pub fn behind_last(input: &mut In<'_, '_, '_>) -> Span {
    let last = input.last();
    let len = input.text(last).chars().next_back().map_or(0, char::len_utf8);
    Span { start: last.end - u32::try_from(len).unwrap_or(0), ..last }
}

pub fn insertion(input: &mut In<'_, '_, '_>) -> Span {
    let last = input.last();
    Span { start: last.end, ..last }
}

/// Whether something before this place was already said to reach over its end.
pub fn swallowed(input: &mut In<'_, '_, '_>) -> bool {
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
            .label("a `;` is missing after this")
            .help("write `;` here")
            .fix(place, ";"),
    );
}

fn in_case(input: &mut In<'_, '_, '_>) -> bool {
    input.state().open.last().is_some_and(|(end, _)| *end == Kind::EndCase)
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
    let mut it = Diagnostic::unclosed(end.to_string(), here, &found)
        .label(format!("expected {end} before this"))
        .other(opened, format!("this {opener} is not closed"));
    let inner = input.state().misaligned.filter(|it| it.start > opened.start);
    if let Some(inner) = inner {
        let inner_opener = input.text(inner).to_ascii_uppercase();
        it = it.other(inner, format!("or this {inner_opener} is not closed: the END after it is in another column"));
    }
    let it = it.help(help);
    let has_errors = input.state().diagnostics.iter().any(|it| it.severity == Severity::Error);
    let is_only_one = opened == input.state().first() && !has_errors;
    match kind == Kind::End && is_only_one && outer.is_empty() {
        true => input.state().unclosed.push(it),
        false => input.report(it),
    }
}

/// `WHILE … END_IF`
pub fn wrong_end(input: &mut In<'_, '_, '_>, end: Kind, opened: Span) {
    let here = input.here();
    let found = input.kind();
    let opener = input.text(opened).to_ascii_uppercase();
    input.report(
        Diagnostic::unclosed(end.to_string(), here, &found.to_string())
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

/// `REPEAT … END_REPEAT UNTIL x;`
pub fn until_after_end(whole: Span, opened: Span, condition: &str) -> Diagnostic {
    let meant = format!("UNTIL {condition} END_REPEAT");
    Diagnostic::new(Code::E0001, whole, "UNTIL and its condition come before END_REPEAT")
        .label("these are in the wrong order")
        .other(opened, "this REPEAT ends here")
        .help(format!("write `{meant}`"))
        .fix(whole, meant)
}

/// `REPEAT … END_REPEAT`
pub fn no_until(end: Span) -> Diagnostic {
    Diagnostic::new(Code::E0001, end, "expected UNTIL, found END_REPEAT")
        .label("a REPEAT ends with a condition")
        .help("write `UNTIL condition` before END_REPEAT: the loop ends when it is TRUE")
}

pub fn behind_else(word: Span, kind: Kind) -> Diagnostic {
    Diagnostic::new(Code::E0015, word, format!("{kind} comes after the ELSE of the same IF"))
        .label("expected `END_IF`")
        .help("move this branch before the ELSE")
}

pub fn stray(span: Span, kind: Kind) -> Diagnostic {
    let (what, help) = match kind {
        Kind::Else => ("no IF or CASE is open here".to_owned(), "delete it, or open the IF that it belongs to"),
        Kind::Elsif => ("no IF is open here".to_owned(), "delete it, or open the IF that it belongs to"),
        Kind::Until => ("no REPEAT is open here".to_owned(), "delete it, or write REPEAT before the loop"),
        kind => {
            let opener = kind.keyword().unwrap_or_default().trim_start_matches("END_");
            (format!("no {opener} is open here"), "delete it, or look for the block that ends too early")
        }
    };
    Diagnostic::new(Code::E0015, span, format!("{kind} is misplaced: {what}"))
        .label("nothing to close or continue")
        .help(help)
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
        .other(value, "the value must be assigned first")
        .help("assign the result to the function's own name, then write `RETURN;`")
}

/// `RETURN();`
pub fn return_called(parentheses: Span) -> Diagnostic {
    Diagnostic::new(Code::E0019, parentheses, "RETURN is a statement, and takes no parentheses")
        .label("delete this")
        .help("write `RETURN;`")
        .fix(parentheses, "")
}

/// More of one list than anybody writes.
pub fn too_many(limit: usize) -> String {
    format!("this list has more than {limit} items")
}

pub fn declaration_behind_statements(span: Span) -> Diagnostic {
    Diagnostic::new(Code::E0017, span, "this declaration comes after statements")
        .label("all VAR blocks come before the first statement")
        .help("move this block to the top of its PROGRAM, FUNCTION_BLOCK or FUNCTION")
}

/// A METHOD in a FUNCTION.
pub fn routine_of_no_class(span: Span, kind: PouKind, owner: PouKind) -> Diagnostic {
    let (word, owner) = (kind.word(), owner.word());
    Diagnostic::new(Code::E0403, span, format!("{} cannot have {word}s", article(owner)))
        .label("only a PROGRAM and a FUNCTION_BLOCK can")
        .help(format!("write it as a FUNCTION, or move the {word} into a FUNCTION_BLOCK"))
}

/// A METHOD after its FUNCTION_BLOCK.
pub fn routine_outside(span: Span, kind: PouKind) -> Diagnostic {
    let word = kind.word();
    Diagnostic::new(Code::E0403, span, format!("{} must be inside a FUNCTION_BLOCK or PROGRAM", article(word)))
        .label("this one is outside")
        .help("move it before END_FUNCTION_BLOCK")
}

/// A PROPERTY with neither GET nor SET.
pub fn property_without_accessors(span: Span) -> Diagnostic {
    Diagnostic::new(Code::E0403, span, "a PROPERTY needs GET … END_GET, SET … END_SET, or both")
        .label("this has neither")
        .help("write `GET … END_GET` after its declaration")
}

pub fn property_without_type(span: Span) -> Diagnostic {
    Diagnostic::new(Code::E0403, span, "a PROPERTY needs a type")
        .label("this has none")
        .help("write it after the name: `PROPERTY level : INT`")
}

/// A statement or a VAR_INPUT in a CLASS.
pub fn not_in_a_class(span: Span, what: &str) -> Diagnostic {
    Diagnostic::new(Code::E0403, span, format!("a CLASS has no {what}"))
        .label("only VAR, METHODs and PROPERTYs are allowed")
        .help("make it a FUNCTION_BLOCK, or move this into a METHOD")
}

/// A second base class, or one of a unit that is not a class.
pub fn too_many_bases(span: Span, kind: PouKind) -> Diagnostic {
    let message = if kind.is_block() {
        format!("{} can EXTEND only one other", article(kind.word()))
    } else {
        format!("{} cannot have EXTENDS or IMPLEMENTS", article(kind.word()))
    };
    Diagnostic::new(Code::E0403, span, message)
        .label("this is one too many")
        .help("delete it: only IMPLEMENTS can name several")
}

/// `INTERFACE a IMPLEMENTS b`
pub fn interface_implements(span: Span, name: &str, base: &str) -> Diagnostic {
    Diagnostic::new(Code::E0403, span, "an INTERFACE EXTENDS other INTERFACEs; it cannot IMPLEMENT them")
        .label("it has no bodies")
        .help(format!("write `INTERFACE {name} EXTENDS {base}`"))
}

/// VAR in an ACTION.
pub fn variables_of_action(span: Span) -> Diagnostic {
    Diagnostic::new(Code::E0403, span, "an ACTION has no variables of its own")
        .label("it uses those of its POU")
        .help("declare them in the POU, or make the ACTION a METHOD")
}

/// GSV and its like.
pub fn controller_service(name: Span, text: &str, service: &str) -> Diagnostic {
    Diagnostic::new(Code::E0902, name, format!("`{}` is not supported: {service}", text.to_ascii_uppercase()))
        .label("this is a service of the controller")
        .help("pass the data that the program needs in tags")
}

/// VAR_CONFIG among the declarations of a POU.
pub fn bindings_in_a_unit(span: Span) -> Diagnostic {
    Diagnostic::new(Code::E0403, span, "a VAR_CONFIG cannot be inside a POU")
        .label("expected in a CONFIGURATION, or at the top level of the file")
        .help("move it after the end of the POU, and start each path with the PROGRAM: `Main.y AT %QX0.0 : BOOL;`")
}

pub fn unsupported(span: Span, what: &str) -> Diagnostic {
    Diagnostic::new(Code::E0090, span, format!("{what} is not supported yet"))
}

/// `5; y := 1;` among the arms of a CASE.
pub fn semicolon_for_colon(sign: Span) -> Diagnostic {
    Diagnostic::new(Code::E0001, sign, "expected `:` after a CASE label, found `;`")
        .label("expected `:`")
        .help("write `:`")
        .fix(sign, ":")
}

/// `CASE 1:` among the arms of a CASE.
pub fn case_before_label(word: Span) -> Diagnostic {
    Diagnostic::new(Code::E0020, word, "a branch of a CASE begins with its value, without the word CASE")
        .label("delete this")
        .help("write `1: …;` for the value 1")
        .fix(word, "")
}

/// `1 => y := 1;` among the arms of a CASE.
pub fn arrow_for_colon(sign: Span) -> Diagnostic {
    Diagnostic::new(Code::E0001, sign, "a CASE label ends with `:`, not with `=>`")
        .label("expected `:`")
        .help("write `:`")
        .fix(sign, ":")
}

/// `5 y := 1;` among the arms of a CASE.
pub fn missing_colon(input: &mut In<'_, '_, '_>) {
    let (span, place) = (behind_last(input), insertion(input));
    let kind = input.kind();
    let here = input.here();
    let found = shown(input, kind, here);
    input.report(
        Diagnostic::new(Code::E0001, span, format!("expected `:`, found {found}"))
            .label("a `:` is missing after this label")
            .help("write `:` here")
            .fix(place, ":"),
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
                .label("the list continues after this")
                .help("write `,`")
                .fix(here, ","),
        );
        return;
    }
    input.report(
        Diagnostic::new(Code::E0001, span, format!("expected `,`, found {found}"))
            .label("a `,` is missing after this")
            .help("write `,` here")
            .fix(place, ","),
    );
}

/// `else:`
pub fn colon_behind_else(span: Span) -> Diagnostic {
    Diagnostic::new(Code::E0001, span, "the ELSE of an IF has no `:`")
        .label("delete this")
        .help("delete it")
        .fix(span, "")
}

/// A name alone on its line.
pub fn name_alone(input: &mut In<'_, '_, '_>, span: Span) {
    let text = input.text(span);
    input.report(
        Diagnostic::new(Code::E0001, span, "expected `:=` or a call after this")
            .label("this alone is not a statement")
            .help(format!("to assign, write `{text} := …;`; to call, `{text}(…);`")),
    );
}

/// `IN: x`, `IN REF= x` among arguments.
pub fn sign_for_assign(input: &mut In<'_, '_, '_>, sign: Span) {
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
            .label("a `:=` is missing after this")
            .help("write `:=` here")
            .fix(place, " :="),
    );
}

/// `ENDIF`, `VAR INPUT`: what is written for a keyword.
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

pub fn reserved(span: Span, word: &str, own: &str) -> Diagnostic {
    Diagnostic::new(Code::E0016, span, format!("`{word}` is a reserved word and cannot be a name"))
        .label("expected a name")
        .help(format!("choose another name, say `{own}_1`"))
}

/// `flags.[n]` of Logix: the bit of an integer whose number an expression gives.
pub fn chosen_bit(span: Span, [integer, number]: [&str; 2]) -> Diagnostic {
    let bit = format!("DWORD_TO_DINT(SHL(DWORD#1, {number}))");
    Diagnostic::new(Code::E0902, span, format!("a bit whose number is an expression, `.[{number}]`, is not supported"))
        .label("a bit's number is written as digits, `.3`")
        .note(format!("a bit of a DINT is set by `{integer} := {integer} OR {bit};`, reset by `{integer} := {integer} AND NOT {bit};`"))
        .help(format!("write `({integer} AND {bit}) <> 0` for its value"))
}
