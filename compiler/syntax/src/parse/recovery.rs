//! Where reading continues after a mistake. Each list skips to its own next item, and never over a
//! keyword that an enclosing list waits for.

use crate::{
    diagnostic::{Code, Diagnostic},
    lex::Kind,
    source::Span,
};

use super::{
    block_ends, diagnostics, foreign_syntax, misspelt,
    parser::{Expected, In, Parsed, Problem, Start, TokenReader},
    token_class::{
        closes, ends_declarations, ends_statements, is_end, is_pou_end, opens_item, opens_statement, partners,
    },
};

/// Takes and reports a closing keyword that no open block waits for.
pub fn stray(input: &mut In<'_, '_, '_>) -> bool {
    let kind = input.kind();
    if !closes(kind) || is_pou_end(kind) {
        return false;
    }
    let partners = partners(kind);
    let open = &input.state().open;
    let ends = is_end(kind);
    if ends {
        let awaited = open.last().is_some_and(|(end, _)| *end == kind);
        if awaited || block_ends::judge(input, None) != block_ends::Verdict::Stray {
            return false;
        }
    } else if open.iter().any(|(end, _)| partners.contains(end)) {
        return false;
    }
    let span = input.take();
    let told = kind == Kind::EndIf && std::mem::take(&mut input.state().orphaned);
    if !told {
        let it = diagnostics::stray(span, kind);
        input.report(it);
    }
    input.state().orphaned |= matches!(kind, Kind::Else | Kind::Elsif);
    input.eat(Kind::Semicolon);
    true
}

/// Whether the next token starts a statement of its own, so that only a `;` is missing.
pub fn begins_statement(input: &mut In<'_, '_, '_>) -> bool {
    let kind = input.kind();
    ends_statements(kind)
        || opens_statement(kind)
        || starts_action(input)
        || (input.on_new_line() && matches!(kind, Kind::Name | Kind::Address | Kind::Integer))
}

/// A name with `:=` directly after it.
fn starts_action(input: &mut In<'_, '_, '_>) -> bool {
    input.kind() == Kind::Name && input.kind_ahead(1) == Kind::Assign
}

/// Reports what broke the statement that starts at `start`, and skips what is left of it.
pub fn statement<'t, 'p>(input: &mut In<'t, 'p, '_>, problem: Problem, start: Start<'t, 'p>) {
    let first = *start.cursor().inner();
    if respell(input, start) {
        return;
    }
    diagnostics::report(input, problem);
    let start = input.state().place(first);
    let block_as_value = input.number() == problem.at && problem.at != first && !input.on_new_line();
    if block_as_value && opens_statement(input.kind()) {
        skip_block(input);
    }
    skip_statement(input, start);
}

/// After the END_ of the block that starts here.
fn skip_block(input: &mut In<'_, '_, '_>) {
    let mut depth = 0usize;
    loop {
        let kind = input.kind();
        if kind == Kind::End || is_pou_end(kind) || opens_item(kind) {
            return;
        }
        let opens = matches!(kind, Kind::If | Kind::Case | Kind::For | Kind::While | Kind::Repeat | Kind::Try);
        let ends = is_end(kind);
        input.take();
        depth += usize::from(opens);
        depth = depth.saturating_sub(usize::from(ends));
        if depth == 0 {
            return;
        }
    }
}

/// As [`statement`], for a declaration. Whether it was one at all, and no misspelt keyword.
pub fn declaration<'t, 'p>(input: &mut In<'t, 'p, '_>, problem: Problem, start: Start<'t, 'p>) -> bool {
    let first = *start.cursor().inner();
    if respell(input, start) {
        return false;
    }
    diagnostics::report(input, problem);
    go_to(input, problem);
    let start = input.state().place(first);
    if input.kind() == Kind::Struct {
        skip_structure(input);
    }
    skip_declaration(input, start);
    true
}

/// After the END_STRUCT of a structure that is not read.
fn skip_structure(input: &mut In<'_, '_, '_>) {
    let mut ahead = 0;
    while input.kind_ahead(ahead) != Kind::EndStruct {
        let kind = input.kind_ahead(ahead);
        if kind == Kind::End || kind == Kind::EndType || opens_item(kind) || is_pou_end(kind) {
            return;
        }
        ahead += 1;
    }
    for _ in 0..=ahead {
        input.take();
    }
}

/// If what broke is a misspelt keyword: goes back to it, and reads it as that keyword.
fn respell<'t, 'p>(input: &mut In<'t, 'p, '_>, start: Start<'t, 'p>) -> bool {
    let now = input.save();
    input.rewind(start);
    input.forget();
    let Some((kind, words)) = misspelt::misspelt(input) else {
        input.rewind(now);
        return false;
    };
    let span = input.here();
    for _ in 0..words {
        input.take();
    }
    let span = span.to(input.last());
    diagnostics::misspelt_keyword(input, kind, span);
    input.state().instead = Some(kind);
    true
}

/// Behind a name and its operands in parentheses, and the semicolon.
pub fn skip_operands(input: &mut In<'_, '_, '_>) {
    input.take();
    let mut depth = 0;
    while !matches!(input.kind(), Kind::End | Kind::Semicolon) {
        depth += match input.kind() {
            Kind::OpenParen => 1,
            Kind::CloseParen => -1,
            _ => 0,
        };
        input.take();
        if depth == 0 {
            break;
        }
    }
    input.eat(Kind::Semicolon);
}

/// After the next `;`, or before a keyword or a line that starts another statement.
pub fn skip_statement(input: &mut In<'_, '_, '_>, start: Span) {
    loop {
        let kind = input.kind();
        if ends_statements(kind) {
            return;
        }
        let fresh = input.here().start == start.start;
        if !fresh && (opens_statement(kind) || (input.on_new_line() && starts_line(input))) {
            return;
        }
        input.take();
        if kind == Kind::Semicolon {
            return;
        }
    }
}

fn starts_line(input: &mut In<'_, '_, '_>) -> bool {
    input.kind() == Kind::Name
        && matches!(input.kind_ahead(1), Kind::Assign | Kind::OpenParen | Kind::Dot | Kind::OpenBracket | Kind::Colon)
}

/// After `ends`, if it is before the next statement.
pub fn skip_header(input: &mut In<'_, '_, '_>, ends: Kind, opened: Span) {
    loop {
        let kind = input.kind();
        if kind == ends || kind == Kind::Semicolon {
            input.take();
            return;
        }
        let away = input.last().start != opened.start && input.on_new_line();
        if ends_statements(kind) || opens_statement(kind) || (away && starts_line(input)) {
            return;
        }
        input.take();
    }
}

/// After the `:` of a broken label on its line, or at the next statement.
pub fn skip_label(input: &mut In<'_, '_, '_>, start: Span) {
    while input.here().start == start.start || !input.on_new_line() {
        let kind = input.kind();
        if ends_statements(kind) {
            return;
        }
        if opens_statement(kind) && input.here().start != start.start {
            return;
        }
        input.take();
        if matches!(kind, Kind::Colon | Kind::Semicolon) {
            return;
        }
    }
}

/// After the next `;`, or before a line that starts another declaration, or a guard.
pub fn skip_declaration(input: &mut In<'_, '_, '_>, start: Span) {
    loop {
        let kind = input.kind();
        let fresh = input.here().start == start.start;
        if ends_declarations(kind) || (!fresh && input.on_new_line() && starts_declaration(input)) {
            return;
        }
        input.take();
        if kind == Kind::Semicolon {
            return;
        }
    }
}

pub fn starts_declaration(input: &mut In<'_, '_, '_>) -> bool {
    input.kind() == Kind::Name && matches!(input.kind_ahead(1), Kind::Colon | Kind::Comma | Kind::At)
}

/// Whether what is in a VAR block is a statement, and the block's end is missing before it.
pub fn is_statement_in_section(input: &mut In<'_, '_, '_>) -> bool {
    let looks = input.kind() == Kind::Name
        && matches!(input.kind_ahead(1), Kind::Assign | Kind::OpenParen | Kind::Dot | Kind::OpenBracket);
    looks && {
        let mut ahead = 0;
        while !ends_statements(input.kind_ahead(ahead)) {
            ahead += 1;
        }
        input.kind_ahead(ahead) != Kind::EndVar
    }
}

/// After the END_VAR of a section that is not read.
pub fn skip_section(input: &mut In<'_, '_, '_>) {
    loop {
        let kind = input.kind();
        if kind == Kind::EndVar {
            input.take();
            input.eat(Kind::Semicolon);
            return;
        }
        if ends_statements(kind) {
            return;
        }
        input.take();
    }
}

/// Before the next POU, TYPE, VAR_GLOBAL or CONFIGURATION.
pub fn skip_to_item(input: &mut In<'_, '_, '_>) {
    loop {
        let kind = input.kind();
        if kind == Kind::End || kind == Kind::VarGlobal || opens_item(kind) {
            return;
        }
        input.take();
    }
}

/// After the first line of a POU whose head does not parse.
pub fn skip_head(input: &mut In<'_, '_, '_>) {
    while !ends_statements(input.kind()) && !input.on_new_line() {
        input.take();
    }
}

/// THEN, DO or OF. Another of them in its place is taken for it. Whether what is before it was read whole.
pub fn missing_word(input: &mut In<'_, '_, '_>, word: Kind, opened: Span) -> bool {
    if diagnostics::swallowed(input) || input.kind() == Kind::End {
        return true;
    }
    foreign_syntax::extra_brackets(input, word);
    foreign_syntax::decimal_comma(input);
    if input.eat(word).is_some() {
        return true;
    }
    if is_nearly(input, word) {
        let span = input.take();
        diagnostics::misspelt_keyword(input, word, span);
        return true;
    }
    if input.kind() == Kind::Semicolon && input.kind_ahead(1) == word {
        extra_semicolon(input, word);
        return true;
    }
    if misspelt::is_misspelt_then(input, word) {
        let span = input.take();
        diagnostics::misspelt_keyword(input, word, span);
        return true;
    }
    if let Some(ahead) = on_this_line(input, word) {
        missing_operator(input, word, ahead);
        return false;
    }
    let opener = input.text(opened).to_ascii_uppercase();
    let kind = input.kind();
    let here = input.here();
    let found = diagnostics::shown(input, kind, here);
    let wrong = matches!(kind, Kind::Then | Kind::Do | Kind::Of | Kind::Semicolon | Kind::Colon);
    let message = format!("expected {word}, found {found}");
    let it = if wrong {
        input.take();
        let replacement = diagnostics::padded(input, here, word.keyword().unwrap_or_default());
        Diagnostic::new(Code::E0013, here, message)
            .label(format!("expected {word}"))
            .help(format!("write {word} here"))
            .fix(here, replacement)
    } else {
        let (span, place) = (diagnostics::behind_last(input), diagnostics::insertion(input));
        Diagnostic::new(Code::E0013, span, message)
            .label(format!("{word} is missing after this"))
            .help(format!("write {word} here"))
            .fix(place, format!(" {}", word.keyword().unwrap_or_default()))
    };
    let word = word.keyword().unwrap_or_default();
    input.report(it.other(opened, format!("this {opener} needs {}", crate::diagnostic::wording::article(word))));
    true
}

/// Whether the current token is `word` with a slip: `THNE`.
fn is_nearly(input: &mut In<'_, '_, '_>, word: Kind) -> bool {
    let used = matches!(input.kind_ahead(1), Kind::Assign | Kind::Dot | Kind::OpenBracket | Kind::OpenParen);
    if input.kind() != Kind::Name || used || input.on_new_line() {
        return false;
    }
    let span = input.here();
    crate::spelling::nearest(input.text(span), word.keyword().into_iter()).is_some()
}

/// How far ahead `word` is on the current line, before the statement ends.
fn on_this_line(input: &mut In<'_, '_, '_>, word: Kind) -> Option<usize> {
    let mut ahead = 0;
    while input.kind_ahead(ahead) != word {
        let kind = input.kind_ahead(ahead);
        let at = input.number() + ahead;
        let state = input.state();
        let (before, here) = (state.place(at.saturating_sub(1)), state.place(at));
        let ends = matches!(kind, Kind::Semicolon | Kind::Assign | Kind::Colon) || ends_statements(kind);
        if ends || opens_statement(kind) || state.breaks(before.end, here.start) {
            return None;
        }
        ahead += 1;
    }
    (ahead > 0).then_some(ahead)
}

/// `IF a b THEN`
fn missing_operator(input: &mut In<'_, '_, '_>, word: Kind, ahead: usize) {
    let (kind, here) = (input.kind(), input.here());
    let found = diagnostics::shown(input, kind, here);
    let help = match input.text(here).to_ascii_uppercase().as_str() {
        "IS" => "two values are compared with `=` and `<>`",
        "IN" => "join comparisons: `x = 1 OR x = 2`, or write a CASE",
        "BETWEEN" => "join two comparisons: `x >= 1 AND x <= 5`",
        _ => "write `AND` or `OR` between two conditions",
    };
    input.report(
        Diagnostic::new(Code::E0001, here, format!("expected an operator or {word}, found {found}"))
            .label("expected an operator before this")
            .help(help),
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
            .label("the condition continues up to the next keyword")
            .help("delete this `;`")
            .fix(span, ""),
    );
}

/// What stands for the `;` of a declaration, or a complaint that leaves what follows in place.
pub fn end_of_declaration(input: &mut In<'_, '_, '_>) -> Parsed<()> {
    if foreign_syntax::wrong_terminator(input) {
        return Ok(());
    }
    if star_after_type(input) && input.eat(Kind::Semicolon).is_some() {
        return Ok(());
    }
    let kind = input.kind();
    let next = ends_declarations(kind) || starts_declaration(input);
    if next || (input.on_new_line() && kind == Kind::Name) {
        diagnostics::missing_semicolon(input);
        return Ok(());
    }
    Err(input.problem(Expected::Token(Kind::Semicolon)))
}

/// `p : INT*`, after the `INT`.
fn star_after_type(input: &mut In<'_, '_, '_>) -> bool {
    let at = input.number();
    let kinds = &input.state().tokens.kinds;
    let follows = at
        .checked_sub(2)
        .and_then(|it| kinds.get(it..))
        .is_some_and(|it| it.starts_with(&[Kind::Colon, Kind::Name, Kind::Star]));
    if !follows {
        return false;
    }
    let ty = input.last();
    let span = ty.to(input.take());
    let it = diagnostics::star_after_type(span, input.text(ty));
    input.report(it);
    true
}

/// Forward to where a problem is: rules may have gone back over what they read.
pub fn go_to(input: &mut In<'_, '_, '_>, problem: Problem) {
    while input.number() < problem.at && input.kind() != Kind::End {
        input.take();
    }
}
