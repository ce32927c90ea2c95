//! Habits of other languages, each answered once in the words of Structured Text: the braces and
//! counting loops of C, BEGIN and END of Pascal, numbers as other compilers spell them.

use crate::{
    ast::BinaryOp,
    diagnostic::{Code, Diagnostic},
    lex::{Kind, index},
    source::Span,
};

use super::{
    diagnostics,
    parser::{In, TokenReader},
    token_class::{ends_statements, is_pou_end},
};

/// Takes and reports a BEGIN, or the END that belongs to one.
pub fn begin_or_end(input: &mut In<'_, '_, '_>) -> bool {
    if input.is_word("BEGIN") && !is_used(input.kind_ahead(1)) {
        let body = matches!(kind_before(input), Some(Kind::Then | Kind::Do | Kind::Else));
        let span = input.take();
        input.eat(Kind::Semicolon);
        let open = input.state().open.len();
        input.state().begins.push((open, body));
        input.report(
            Diagnostic::new(Code::E0020, span, "Structured Text has no BEGIN and END")
                .label("delete this")
                .help("end the body of an IF with `END_IF;`, of a FOR with `END_FOR;`, and so on"),
        );
        return true;
    }
    let open = input.state().open.len();
    let Some((_, body)) = input.state().begins.last().copied().filter(|it| it.0 == open) else { return false };
    if !input.is_word("END") {
        return false;
    }
    input.state().begins.pop();
    input.take();
    if !matches!(input.kind(), Kind::Else | Kind::Elsif) {
        let _ = input.eat(Kind::Semicolon).or_else(|| input.eat(Kind::Dot));
        let end = input.state().open.last().map(|(end, _)| *end).filter(|it| body && !is_pou_end(*it));
        // The body's own end may still follow.
        let kind = input.kind();
        input.state().instead = end.filter(|it| *it != kind);
    }
    true
}

/// Whether a name is a variable's: something is done with it.
fn is_used(next: Kind) -> bool {
    matches!(next, Kind::Assign | Kind::Dot | Kind::OpenBracket | Kind::OpenParen | Kind::Colon)
}

fn kind_before(input: &mut In<'_, '_, '_>) -> Option<Kind> {
    let at = input.number().checked_sub(1)?;
    input.state().tokens.kinds.get(at).copied()
}

/// Reports a body in braces, which the lexer took for a pragma, between the last token and the next, unless its head was.
pub fn braces(input: &mut In<'_, '_, '_>, opened: Span, reports: bool) -> bool {
    let (last, here) = (input.last(), input.here());
    let state = input.state();
    let pragmas = &state.tokens.pragmas;
    let inside = |it: &Span| last.end <= it.start && it.end <= here.start;
    let found = pragmas.iter().find(|it| inside(&it.span) && it.text.contains([';', '\n'])).map(|it| it.span);
    let Some(span) = found else { return false };
    state.braces.push(span);
    let again = state.braced.contains(&opened);
    state.braced.push(opened);
    if !again && reports {
        let word = input.text(opened).to_ascii_uppercase();
        let shape = match word.as_str() {
            "IF" | "ELSIF" => "IF … THEN … END_IF",
            "FOR" => "FOR … DO … END_FOR",
            "WHILE" => "WHILE … DO … END_WHILE",
            _ => "CASE … OF … END_CASE",
        };
        let brace = Span { start: span.start - 1, end: span.start, ..span };
        input.report(
            Diagnostic::new(Code::E0020, brace, "Structured Text has no braces around statements")
                .label("this starts a pragma")
                .help(format!("write `{shape}`")),
        );
    }
    true
}

/// `FOR (i = 0; i < 10; i++)`
pub fn counting_loop(input: &mut In<'_, '_, '_>) -> bool {
    if input.kind() != Kind::OpenParen {
        return false;
    }
    let (mut depth, mut ahead, mut semicolon) = (0usize, 0, false);
    loop {
        match input.kind_ahead(ahead) {
            Kind::OpenParen => depth += 1,
            Kind::CloseParen => depth -= 1,
            Kind::Semicolon => semicolon = true,
            Kind::Do | Kind::To => return false,
            kind if ends_statements(kind) => return false,
            _ => {}
        }
        ahead += 1;
        if depth == 0 {
            break;
        }
    }
    if !semicolon {
        return false;
    }
    let start = input.here();
    for _ in 0..ahead {
        input.take();
    }
    let span = start.to(input.last());
    input.report(
        Diagnostic::new(Code::E0020, span, "a FOR loop counts from one value to another")
            .label("expected a counter, `:=`, the first value, `TO` and the last")
            .help("write `FOR i := 0 TO 9 DO … END_FOR`"),
    );
    true
}

/// `FOR x IN list`
pub fn loop_over_a_list(input: &mut In<'_, '_, '_>, opened: Span) -> bool {
    if !input.is_word("IN") {
        return false;
    }
    let span = input.take();
    let mut ahead = 0;
    while !matches!(input.kind_ahead(ahead), Kind::Colon | Kind::Do | Kind::Semicolon | Kind::End) {
        ahead += 1;
    }
    if input.kind_ahead(ahead) == Kind::Colon {
        // Of Python, where nothing ends it.
        input.state().braced.push(opened);
    }
    input.report(
        Diagnostic::new(Code::E0020, span, "a FOR loop counts from one value to another")
            .label("expected `:=`, the first value, `TO` and the last")
            .help("write `FOR i := 0 TO 9 DO … END_FOR`"),
    );
    true
}

/// The second half of an operator that other languages write in two signs, after the first one:
/// `=<`, `><`, `<<`. None where the statement cannot be read on.
pub fn second_sign(input: &mut In<'_, '_, '_>, first: Kind, sign: Span) -> Option<Option<(BinaryOp, Span)>> {
    if input.here().start != sign.end {
        return Some(None);
    }
    let (op, shift) = match (first, input.kind()) {
        (Kind::Equal, Kind::Less) => (BinaryOp::Le, None),
        (Kind::Equal, Kind::Greater) => (BinaryOp::Ge, None),
        (Kind::Greater, Kind::Less) => (BinaryOp::Ne, None),
        (Kind::Less, Kind::Less) => (BinaryOp::Mul, Some("SHL")),
        (Kind::Greater, Kind::Greater) => (BinaryOp::Mul, Some("SHR")),
        _ => return Some(None),
    };
    let whole = sign.to(input.take());
    let text = input.text(whole);
    let Some(function) = shift else {
        let ours = op.text();
        input.report(
            Diagnostic::new(Code::E0010, whole, format!("Structured Text writes `{ours}` for `{text}`"))
                .label(format!("expected `{ours}`"))
                .help(format!("write `{ours}`"))
                .fix(whole, ours),
        );
        return Some(Some((op, whole)));
    };
    input.report(
        Diagnostic::new(Code::E0010, whole, format!("Structured Text shifts with a function, not with `{text}`"))
            .label(format!("expected `{function}`"))
            .help(format!("write `{function}(value, places)`")),
    );
    None
}

/// `a->b`
pub fn arrow(input: &mut In<'_, '_, '_>) -> bool {
    let at = input.number();
    let state = input.state();
    let joined = state.place(at).end == state.place(at + 1).start;
    let arrow = joined && input.kind_ahead(1) == Kind::Greater && input.kind_ahead(2) == Kind::Name;
    if !arrow {
        return false;
    }
    let sign = input.take();
    let sign = sign.to(input.take());
    input.report(
        Diagnostic::new(Code::E0010, sign, "Structured Text writes `^.` for `->`")
            .label("expected `^.`")
            .help("write `^.`")
            .fix(sign, "^."),
    );
    true
}

/// Whether a name is directly after the sign that is next: `*p`, `&n`.
pub fn joins_name(input: &mut In<'_, '_, '_>) -> bool {
    let at = input.number() + 1;
    let (sign, name) = (input.here(), input.state().place(at));
    input.kind_ahead(1) == Kind::Name && sign.end == name.start
}

/// `*p` and `&n` of C, after the sign: the operand is what follows.
pub fn pointer_sign(input: &mut In<'_, '_, '_>, sign: Span, operand: Span) {
    let (whole, text) = (sign.to(operand), input.text(operand));
    let (meant, what) = match input.text(sign) {
        "*" => (format!("{text}^"), "dereferences a pointer with `^` after it"),
        _ => (format!("ADR({text})"), "takes an address with `ADR`"),
    };
    input.report(
        Diagnostic::new(Code::E0010, whole, format!("Structured Text {what}"))
            .label(format!("expected `{meant}`"))
            .help(format!("write `{meant}`"))
            .fix(whole, meant),
    );
}

/// A number with letters directly after it, such as `0xFF` or `5s`, and what is meant.
pub fn glued(input: &mut In<'_, '_, '_>, number: Span) -> bool {
    if input.kind() != Kind::Name || input.here().start != number.end {
        return false;
    }
    let letters = input.take();
    let (digits, word, whole) = (input.text(number), input.text(letters), number.to(letters));
    let text = input.text(whole);
    let based = word.split_at_checked(1).filter(|it| digits == "0" && !it.1.is_empty());
    let meant = match based {
        Some(("x" | "X", rest)) => Some(format!("16#{rest}")),
        Some(("b" | "B", rest)) => Some(format!("2#{rest}")),
        Some(("o" | "O", rest)) => Some(format!("8#{rest}")),
        _ if is_unit(word) => Some(format!("T#{text}")),
        _ if type_of_rust(word) => Some(digits.to_owned()),
        _ if digits == "16" && word.bytes().all(|it| it.is_ascii_hexdigit()) => Some(format!("16#{word}")),
        _ if let Some(meant) = base_after(digits, word) => Some(meant),
        _ if matches!(word, "f" | "F" | "l" | "L" | "u" | "U" | "UL" | "ul") => Some(digits.to_owned()),
        _ => None,
    };
    let code = if is_unit(word) { Code::E0006 } else { Code::E0005 };
    let it = Diagnostic::new(code, whole, format!("`{text}` is neither a number nor a name"));
    input.report(match meant {
        Some(meant) => it.help(format!("write `{meant}`")).fix(whole, meant),
        None => it.help("write an operator between the number and the name"),
    });
    true
}

/// `10u8`
fn type_of_rust(word: &str) -> bool {
    let bits = word.strip_prefix(['u', 'i', 'f']).unwrap_or_default();
    matches!(bits, "8" | "16" | "32" | "64" | "size")
}

/// `0FFh`, `101b`, whose last letter is the base.
fn base_after(digits: &str, word: &str) -> Option<String> {
    let (more, last) = word.split_at_checked(word.len().checked_sub(1)?)?;
    let all = |is: fn(u8) -> bool| digits.bytes().chain(more.bytes()).all(is);
    let (base, is_number) = match last {
        "h" | "H" => ("16", all(|it| it.is_ascii_hexdigit())),
        "b" | "B" => ("2", all(|it| matches!(it, b'0' | b'1'))),
        "o" | "O" => ("8", all(|it| matches!(it, b'0'..=b'7'))),
        _ => return None,
    };
    let digits = if digits == "0" && !more.is_empty() { "" } else { digits };
    is_number.then(|| format!("{base}#{digits}{more}"))
}

pub fn is_unit(word: &str) -> bool {
    let letters = word.split(|it: char| it.is_ascii_digit() || it == '_').filter(|it| !it.is_empty());
    let units = ["d", "h", "m", "s", "ms", "us", "ns"];
    letters.clone().next().is_some() && letters.into_iter().all(|it| units.iter().any(|u| it.eq_ignore_ascii_case(u)))
}

/// `.5`
pub fn point_first(input: &mut In<'_, '_, '_>) -> bool {
    if input.kind() != Kind::Dot || input.kind_ahead(1) != Kind::Integer {
        return false;
    }
    let is_third = kind_before(input) == Some(Kind::DotDot) && input.last().end == input.here().start;
    let point = input.take();
    let span = point.to(input.take());
    if is_third {
        input.report(
            Diagnostic::new(Code::E0001, point, "a range is written with two dots")
                .label("this is a third dot")
                .help("write `first..last`")
                .fix(point, ""),
        );
        return true;
    }
    let text = input.text(span);
    input.report(
        Diagnostic::new(Code::E0005, span, "a number needs a digit before its decimal point")
            .help(format!("write `0{text}`"))
            .fix(span, format!("0{text}")),
    );
    true
}

/// `5.`, at what comes after the point.
pub fn point_last(input: &mut In<'_, '_, '_>, number: Span) {
    let point = number.to(input.last());
    let exponent = input.here();
    let digits = input.text(exponent).strip_prefix(['e', 'E']).unwrap_or_default();
    let is_exponent = !digits.is_empty() && digits.bytes().all(|it| it.is_ascii_digit()) && point.end == exponent.start;
    if input.kind() == Kind::Name && is_exponent {
        input.take();
        let (whole, meant) = (point.to(exponent), format!("{}0{}", input.text(point), input.text(exponent)));
        input.report(
            Diagnostic::new(Code::E0005, whole, "a number needs a digit after its decimal point")
                .help(format!("write `{meant}`"))
                .fix(whole, meant),
        );
        return;
    }
    let whole = point;
    let text = input.text(whole);
    input.report(
        Diagnostic::new(Code::E0005, whole, "a number needs a digit after its decimal point")
            .help(format!("write `{text}0`"))
            .fix(whole, format!("{text}0")),
    );
}

/// `1,5` after the `1`.
pub fn decimal_comma(input: &mut In<'_, '_, '_>) -> bool {
    let digits = kind_before(input) == Some(Kind::Integer) && matches!(input.kind_ahead(1), Kind::Integer | Kind::Real);
    let is_group = input.kind_ahead(1) == Kind::Real;
    let (last, comma, at) = (input.last(), input.here(), input.number());
    let after = input.state().place(at + 1);
    if input.kind() != Kind::Comma || !digits || last.end != comma.start || comma.end != after.start {
        return false;
    }
    input.take();
    input.take();
    let mut whole = last.to(after);
    let mut is_group = is_group;
    // `1,000,000`
    while input.kind() == Kind::Comma && matches!(input.kind_ahead(1), Kind::Integer | Kind::Real) {
        let at = input.number();
        let (comma, next) = (input.here(), input.state().place(at + 1));
        if whole.end != comma.start || comma.end != next.start {
            break;
        }
        input.take();
        input.take();
        whole = whole.to(next);
        is_group = true;
    }
    let text = input.text(whole);
    if is_group {
        let meant = text.replace(',', "_");
        input.report(
            Diagnostic::new(Code::E0005, whole, "the digits of a number are grouped with `_`, not with `,`")
                .help(format!("write `{meant}`"))
                .fix(whole, meant),
        );
        return true;
    }
    input.report(comma_for_point(whole, text.replace(',', ".")));
    true
}

pub fn comma_for_point(whole: Span, meant: String) -> Diagnostic {
    let code = if meant.contains('#') { Code::E0006 } else { Code::E0005 };
    Diagnostic::new(code, whole, "the decimal separator is a point").help(format!("write `{meant}`")).fix(whole, meant)
}

/// Whether the current token is the last on its line.
pub fn ends_line(input: &mut In<'_, '_, '_>) -> bool {
    let at = input.number();
    let state = input.state();
    state.breaks(state.place(at).end, state.place(at + 1).start)
}

/// `,`, `.` or `:` at the end of a line, or between two declarations, in the place of `;`.
pub fn wrong_terminator(input: &mut In<'_, '_, '_>) -> bool {
    if !matches!(input.kind(), Kind::Comma | Kind::Dot | Kind::Colon) {
        return false;
    }
    let (here, next) = (input.here(), input.kind_ahead(1));
    let ends_line = ends_line(input);
    let declared = next == Kind::Name && input.kind_ahead(2) == Kind::Colon && input.kind() == Kind::Comma;
    if !ends_line && !declared && !ends_statements(next) {
        return false;
    }
    let kind = input.kind();
    input.take();
    input.report(
        Diagnostic::new(Code::E0012, here, format!("expected `;`, found {kind}"))
            .label("expected `;`")
            .help("write `;`")
            .fix(here, ";"),
    );
    true
}

/// Brackets that close nothing, at the end of a statement or of a condition.
pub fn extra_brackets(input: &mut In<'_, '_, '_>, follows: Kind) {
    while matches!(input.kind(), Kind::CloseParen | Kind::CloseBracket) {
        let mut ahead = 1;
        while matches!(input.kind_ahead(ahead), Kind::CloseParen | Kind::CloseBracket) {
            ahead += 1;
        }
        if input.kind_ahead(ahead) != follows {
            return;
        }
        let kind = input.kind();
        let span = input.take();
        input.report(
            Diagnostic::new(Code::E0001, span, format!("this {kind} has no opening one"))
                .label("no bracket is open here")
                .help("delete it")
                .fix(span, ""),
        );
    }
}

/// `FOR … STEP 2`
pub fn step(input: &mut In<'_, '_, '_>) -> bool {
    if !input.is_word("STEP") {
        return false;
    }
    let span = input.take();
    diagnostics::misspelt_keyword(input, Kind::By, span);
    true
}

/// `FOR … DOWNTO 1`
pub fn down_to(input: &mut In<'_, '_, '_>) -> bool {
    if !input.is_word("DOWNTO") {
        return false;
    }
    let span = input.take();
    let state = input.state();
    let line = state.text[..index(span.start)].rfind('\n').map_or(0, |it| it + 1);
    let begun = state.text[line..index(span.start)].trim();
    let limit = state.text[index(span.end)..].lines().next().unwrap_or_default();
    let limit = limit.to_ascii_uppercase().find(" DO").map(|it| limit[..it].trim());
    let meant = match limit {
        Some(limit) if begun.get(..4).is_some_and(|it| it.eq_ignore_ascii_case("FOR ")) => {
            format!("{begun} TO {limit} BY -1 DO")
        }
        Some(_) | None => "FOR i := 10 TO 1 BY -1 DO".to_owned(),
    };
    input.report(
        Diagnostic::new(Code::E0020, span, "a FOR loop counts down with a negative step")
            .label("expected `TO`")
            .help(format!("write `{meant}`")),
    );
    true
}

/// `S5T#5s`, a duration of Siemens STEP 7.
pub fn step_time(input: &mut In<'_, '_, '_>, prefix: crate::ast::Name<'_>) -> bool {
    if !["S5T", "S5TIME"].iter().any(|it| prefix.text.eq_ignore_ascii_case(it)) {
        return false;
    }
    let mut whole = Span { end: prefix.span.end + 1, ..prefix.span };
    let head = whole;
    while matches!(input.kind(), Kind::Name | Kind::Integer | Kind::Real) && input.here().start == whole.end {
        whole = whole.to(input.take());
    }
    let meant = input.text(whole).replacen(input.text(head), "T#", 1);
    input.report(
        Diagnostic::new(Code::E0020, whole, format!("`{}#` is a duration of STEP 7", prefix.text))
            .label("expected a TIME, `T#`")
            .help(format!("write `{meant}`"))
            .fix(head, "T#"),
    );
    true
}
