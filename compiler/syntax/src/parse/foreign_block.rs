//! Blocks of other languages, each answered once and passed over: those of Python, which indentation ends, LOOP of Ada, SWITCH,
//! FOREACH, WITH, and a loop that starts with DO.

use crate::{
    diagnostic::{Code, Diagnostic},
    lex::Kind,
    source::Span,
};

use super::{
    expression::is_latch,
    foreign_reader::{
        FURTHEST, behind_parentheses, has_braces, is_further_in, is_word, refuse, skip_further_in, skip_line,
        skip_to_end_of, skip_tokens, starts_line,
    },
    parser::{In, TokenReader},
    recovery,
    token_class::is_pou_end,
};

/// Tokens of a head: a whole program may be on one line.
const LONGEST_HEAD: usize = 200;
/// A condition of the user's is shown in help up to this length.
const LONGEST: usize = 60;

/// Refuses and skips such a block, if one starts here.
pub fn skip(input: &mut In<'_, '_, '_>) -> bool {
    if input.state().instead.is_some() {
        return false;
    }
    match (input.kind(), input.kind_ahead(1)) {
        (Kind::For, Kind::Name) if is_word(input, 1, "EACH") => each(input),
        (Kind::If | Kind::While | Kind::For, _) => of_python(input) || of_ada(input),
        (Kind::Exit, Kind::Name) => exit_when(input),
        (Kind::Name, Kind::Name | Kind::Integer) if input.is_word("SWITCH") => switch(input, "SWITCH"),
        (Kind::Name, Kind::Name | Kind::Integer) if input.is_word("MATCH") => switch(input, "MATCH"),
        (Kind::Name, Kind::Name) if input.is_word("FOREACH") => each(input),
        (Kind::Name, Kind::OpenParen) if input.is_word("SWITCH") => in_braces(input, refuse_switch),
        (Kind::Name, Kind::OpenParen) if input.is_word("FOREACH") => in_braces(input, refuse_each),
        (Kind::Name, Kind::Name) if input.is_word("WITH") => !is_latch(input, 1) && with(input),
        (Kind::Name, Kind::Case) if input.is_word("SELECT") => select(input),
        (Kind::Do, _) => do_loop(input),
        (Kind::Name, _) if input.is_word("LOOP") => endless(input),
        _ => false,
    }
}

/// Tokens up to the end of the line.
fn rest_of_line(input: &mut In<'_, '_, '_>) -> usize {
    let mut ahead = 1;
    while ahead < LONGEST_HEAD && !starts_line(input, ahead) && input.kind_ahead(ahead) != Kind::End {
        ahead += 1;
    }
    ahead
}

/// Whether one of these kinds is among the tokens up to so many ahead.
fn has_kind(input: &mut In<'_, '_, '_>, until: usize, kinds: &[Kind]) -> bool {
    (1..until).any(|it| kinds.contains(&input.kind_ahead(it)))
}

/// The text of the tokens from so many ahead up to another, as Structured Text writes its operators.
fn written<'s>(input: &mut In<'_, '_, 's>, from: usize, until: usize) -> Option<String> {
    let at = input.number();
    let span = (from < until).then(|| input.state().place(at + from).to(input.state().place(at + until - 1)))?;
    let text = input.text(span).replace("==", "=").replace("!=", "<>");
    (text.len() <= LONGEST && !text.contains('\n')).then_some(text)
}

/// `if a == 1:`, with a body further in.
fn of_python(input: &mut In<'_, '_, '_>) -> bool {
    let (kind, word, at) = (input.kind(), input.here(), input.number());
    let end = rest_of_line(input);
    let others = [Kind::Then, Kind::Do, Kind::Semicolon, Kind::Assign, Kind::Of];
    if input.kind_ahead(end - 1) != Kind::Colon || has_kind(input, end, &others) {
        return false;
    }
    let head = word.to(input.state().place(at + end - 1));
    if !is_further_in(input, word, end) {
        return false;
    }
    let condition = written(input, 1, end - 1);
    let condition = condition.as_deref();
    let help = match kind {
        Kind::If => format!("write `IF {} THEN … ELSIF … THEN … ELSE … END_IF`", condition.unwrap_or("x = 1")),
        Kind::While => format!("write `WHILE {} DO … END_WHILE`", condition.unwrap_or("x < 5")),
        _ => "write `FOR i := 0 TO 9 DO … END_FOR`".to_owned(),
    };
    input.report(
        Diagnostic::new(Code::E0020, head, "a block ends with a keyword, not by indentation")
            .label("this is written as in Python")
            .help(help),
    );
    skip_further_in(input, word, end)
}

/// `FOR i IN 1..10 LOOP`, `WHILE x < 5 LOOP`
fn of_ada(input: &mut In<'_, '_, '_>) -> bool {
    let (kind, at) = (input.kind(), input.number());
    let end = rest_of_line(input);
    if kind == Kind::If || !is_word(input, end - 1, "LOOP") || has_kind(input, end, &[Kind::Do]) {
        return false;
    }
    let Some(count) = end_of_loop(input, end) else { return false };
    let head = input.here().to(input.state().place(at + end - 1));
    let help = match kind {
        Kind::While => {
            let condition = written(input, 1, end - 1);
            format!("write `WHILE {} DO … END_WHILE`", condition.as_deref().unwrap_or("x < 5"))
        }
        _ => counted(input, end - 1),
    };
    refuse_loop(input, head, help);
    skip_tokens(input, count);
    true
}

fn refuse_loop(input: &mut In<'_, '_, '_>, span: Span, help: String) {
    input.report(
        Diagnostic::new(Code::E0020, span, "Structured Text has no LOOP and END LOOP")
            .label("this is not a statement here")
            .help(help),
    );
}

/// The FOR for `i IN REVERSE 1..10`, which ends so many tokens ahead.
fn counted(input: &mut In<'_, '_, '_>, end: usize) -> String {
    let counts = is_word(input, 2, "IN");
    let first = if is_word(input, 3, "REVERSE") { 4 } else { 3 };
    let middle = (first..end).find(|it| input.kind_ahead(*it) == Kind::DotDot);
    let parts = middle.filter(|_| counts).and_then(|middle| {
        Some((written(input, 1, 2)?, written(input, first, middle)?, written(input, middle + 1, end)?))
    });
    match parts {
        Some((name, low, high)) if first == 4 => format!("write `FOR {name} := {high} TO {low} BY -1 DO … END_FOR`"),
        Some((name, low, high)) => format!("write `FOR {name} := {low} TO {high} DO … END_FOR`"),
        None => "write `FOR i := 1 TO 10 DO … END_FOR`".to_owned(),
    }
}

/// Tokens up to after the `END LOOP` of a loop whose body starts so many ahead.
fn end_of_loop(input: &mut In<'_, '_, '_>, from: usize) -> Option<usize> {
    let (mut depth, mut ahead) = (1usize, from);
    while ahead < FURTHEST {
        let kind = input.kind_ahead(ahead);
        if kind == Kind::End || is_pou_end(kind) {
            return None;
        }
        let apart = is_word(input, ahead, "END") && is_word(input, ahead + 1, "LOOP");
        if apart || is_word(input, ahead, "END_LOOP") {
            depth -= 1;
            ahead += usize::from(apart);
        } else if is_word(input, ahead, "LOOP") {
            depth += 1;
        }
        ahead += 1;
        if depth == 0 {
            return Some(ahead);
        }
    }
    None
}

/// `LOOP … EXIT WHEN x > 5; … END LOOP;`, `loop { … }`
fn endless(input: &mut In<'_, '_, '_>) -> bool {
    let is_used = matches!(
        input.kind_ahead(1),
        Kind::Assign | Kind::Dot | Kind::OpenParen | Kind::OpenBracket | Kind::Caret | Kind::Semicolon | Kind::Colon
    );
    if is_used {
        return false;
    }
    if has_braces(input, 1) {
        let word = input.here();
        refuse(
            input,
            word,
            "Structured Text has no LOOP",
            "write `WHILE TRUE DO … IF x > 5 THEN EXIT; END_IF … END_WHILE`",
        );
        input.take();
        return true;
    }
    let Some(count) = end_of_loop(input, 1) else { return false };
    let mut depth = 1usize;
    let leaves = (1..count).find(|it| {
        if is_word(input, *it, "LOOP") {
            depth = if is_word(input, it - 1, "END") { depth - 1 } else { depth + 1 };
        }
        depth == 1 && input.kind_ahead(*it) == Kind::Exit && is_word(input, it + 1, "WHEN")
    });
    let condition = leaves.and_then(|from| {
        let until = (from..count).find(|it| input.kind_ahead(*it) == Kind::Semicolon)?;
        written(input, from + 2, until)
    });
    let condition = condition.as_deref().unwrap_or("x > 5");
    let word = input.here();
    refuse_loop(input, word, format!("write `WHILE TRUE DO … IF {condition} THEN EXIT; END_IF … END_WHILE`"));
    skip_tokens(input, count);
    true
}

/// `EXIT WHEN x > 5;`
fn exit_when(input: &mut In<'_, '_, '_>) -> bool {
    if !is_word(input, 1, "WHEN") || starts_line(input, 1) {
        return false;
    }
    let end = rest_of_line(input);
    let Some(until) = (2..end).find(|it| input.kind_ahead(*it) == Kind::Semicolon) else { return false };
    let Some(condition) = written(input, 2, until) else { return false };
    let (word, at) = (input.here(), input.number());
    let whole = word.to(input.state().place(at + until));
    let meant = format!("IF {condition} THEN EXIT; END_IF");
    input.report(
        Diagnostic::new(Code::E0020, whole, "EXIT has no condition")
            .label("put it into an IF")
            .help(format!("write `{meant}`"))
            .fix(whole, format!("{meant};")),
    );
    skip_tokens(input, until + 1);
    true
}

/// `SWITCH (x) { … }`, `foreach (int v in a) { … }`: what is in braces the lexer took for a pragma.
fn in_braces(input: &mut In<'_, '_, '_>, refuse: fn(&mut In<'_, '_, '_>)) -> bool {
    let after = behind_parentheses(input, 1);
    if !has_braces(input, after) {
        return false;
    }
    refuse(input);
    skip_tokens(input, after);
    true
}

fn refuse_switch(input: &mut In<'_, '_, '_>) {
    refuse_choice(input, "SWITCH", None);
}

/// A CASE by another name, of this value.
fn refuse_choice(input: &mut In<'_, '_, '_>, name: &str, value: Option<&str>) {
    let word = input.here();
    let help = format!("write `CASE {} OF 1: …; 2, 3: …; ELSE …; END_CASE`", value.unwrap_or("x"));
    refuse(input, word, format!("Structured Text has no {name}"), help);
}

fn refuse_each(input: &mut In<'_, '_, '_>) {
    let word = input.here();
    refuse(input, word, "Structured Text has no FOREACH", "write `FOR i := 0 TO 9 DO … a[i] … END_FOR`");
}

/// `WITH s DO … END_WITH`
fn with(input: &mut In<'_, '_, '_>) -> bool {
    let word = input.here();
    refuse(input, word, "Structured Text has no WITH", "write the variable before each member: `s.x := 1;`");
    skip_to_end_of(input, "WITH");
    true
}

/// `Select Case x … End Select`
fn select(input: &mut In<'_, '_, '_>) -> bool {
    refuse_choice(input, "SELECT", None);
    skip_to_end_of(input, "SELECT");
    true
}

/// `do { … } while (x < 5);`, `Do While x < 5 … Loop`
fn do_loop(input: &mut In<'_, '_, '_>) -> bool {
    let word = input.here();
    let (message, help) =
        ("Structured Text has no DO at the start of a loop", "write `REPEAT … UNTIL x >= 5 END_REPEAT`");
    if has_braces(input, 1) {
        refuse(input, word, message, help);
        input.take();
        if input.kind() == Kind::While {
            recovery::skip_operands(input);
        }
        return true;
    }
    if let Some(count) = repeated(input) {
        refuse(input, word, message, help);
        skip_tokens(input, count);
        return true;
    }
    let is_of_basic = matches!(input.kind_ahead(1), Kind::While | Kind::Until) && !starts_line(input, 1);
    if is_of_basic {
        refuse(input, word, message, "write `WHILE x < 5 DO … END_WHILE`");
        while !input.is_word("LOOP") {
            let kind = input.kind();
            if kind == Kind::End || is_pou_end(kind) {
                return true;
            }
            input.take();
        }
        skip_tokens(input, 1);
    }
    is_of_basic
}

/// Tokens up to the `;` of `DO … WHILE x < 5;`, which starts here.
fn repeated(input: &mut In<'_, '_, '_>) -> Option<usize> {
    let mut loops = 0usize;
    let mut ahead = 1;
    while ahead < FURTHEST {
        let kind = input.kind_ahead(ahead);
        match kind {
            Kind::End => return None,
            _ if is_pou_end(kind) => return None,
            Kind::For | Kind::Do => loops += 1,
            Kind::While => {
                let ends = (ahead..FURTHEST).find(|it| {
                    let kind = input.kind_ahead(*it);
                    matches!(kind, Kind::Semicolon | Kind::Do | Kind::End) || is_pou_end(kind)
                })?;
                if input.kind_ahead(ends) == Kind::Semicolon {
                    return (loops == 0 && ahead > 1).then_some(ends);
                }
                ahead = ends;
            }
            _ => {}
        }
        ahead += 1;
    }
    None
}

/// `SWITCH x … END_SWITCH`, `switch x { … }`, `match x { … }`
fn switch(input: &mut In<'_, '_, '_>, name: &str) -> bool {
    let end = rest_of_line(input);
    if has_kind(input, end, &[Kind::Of, Kind::Assign, Kind::Semicolon]) {
        return false;
    }
    let ends = |input: &mut In<'_, '_, '_>, ahead: usize| {
        let apart = is_word(input, ahead, "END") && is_word(input, ahead + 1, "SWITCH");
        let joined = ["END_SWITCH", "ENDSWITCH"].iter().any(|it| is_word(input, ahead, it));
        (apart || joined).then_some(ahead + 1 + usize::from(apart))
    };
    let Some(count) = block_to(input, end, ends) else { return false };
    let value = written(input, 1, end);
    refuse_choice(input, name, value.as_deref());
    skip_tokens(input, count);
    true
}

/// `foreach x in list DO … END_FOR`, `For Each x In list … Next`
fn each(input: &mut In<'_, '_, '_>) -> bool {
    let end = rest_of_line(input);
    if !(1..end).any(|it| is_word(input, it, "IN")) {
        return false;
    }
    let mut depth = 1usize;
    let ends = |input: &mut In<'_, '_, '_>, ahead: usize| {
        let kind = input.kind_ahead(ahead);
        let is_end =
            kind == Kind::EndFor || ["NEXT", "END_FOREACH", "ENDFOR"].iter().any(|it| is_word(input, ahead, it));
        depth = depth + usize::from(kind == Kind::For) - usize::from(is_end);
        // `Next x`
        let named = is_end && is_word(input, ahead, "NEXT") && !starts_line(input, ahead + 1);
        (depth == 0).then_some(ahead + 1 + usize::from(named))
    };
    let count = block_to(input, end, ends);
    refuse_each(input);
    match count {
        Some(count) => skip_tokens(input, count),
        None => skip_line(input),
    }
    true
}

/// Tokens up to after a block in braces after the line, or up to where `ends` says, if either exists.
fn block_to(
    input: &mut In<'_, '_, '_>,
    end: usize,
    mut ends: impl FnMut(&mut In<'_, '_, '_>, usize) -> Option<usize>,
) -> Option<usize> {
    if has_braces(input, end) {
        return Some(end);
    }
    for ahead in end..FURTHEST {
        let kind = input.kind_ahead(ahead);
        if kind == Kind::End || is_pou_end(kind) {
            return None;
        }
        if let Some(count) = ends(input, ahead) {
            return Some(count);
        }
    }
    None
}
