//! Statements of other languages, each answered once by its name, and passed over: SWITCH, WITH, FOREACH, declarations among
//! statements, functions inside of a unit.

use crate::{
    ast::{Name, TypeKind, TypeSpec, VarDecl},
    diagnostic::{Code, Diagnostic},
    lex::Kind,
    source::Span,
};

use super::{
    block_ends::column,
    expression::is_latch,
    parser::{In, TokenReader},
    recovery,
    token_class::{ends_statements, is_pou_end},
};

/// Tokens after which the end of a block is not looked for.
pub const FURTHEST: usize = 2000;

/// Refuses and skips such a statement, if one starts here.
pub fn skip(input: &mut In<'_, '_, '_>) -> bool {
    if input.state().instead.is_some() {
        return false;
    }
    match (input.kind(), input.kind_ahead(1)) {
        (Kind::Name, Kind::OpenParen) => loop_in_braces(input),
        (Kind::Name, Kind::Name) => !is_latch(input, 1) && two_names(input),
        (Kind::Name, Kind::Case) => select(input),
        (Kind::Var, Kind::Name) => input.kind_ahead(2) == Kind::Equal && declared(input),
        (Kind::Function, Kind::Name) => input.kind_ahead(2) == Kind::OpenParen && function(input),
        (Kind::Do, _) => do_loop(input),
        (Kind::Plus, Kind::Plus) | (Kind::Minus, Kind::Minus) => doubled(input),
        (Kind::Exit, Kind::For | Kind::While | Kind::Repeat | Kind::Do) => exit_by_name(input),
        _ => false,
    }
}

pub fn refuse(input: &mut In<'_, '_, '_>, span: Span, message: impl Into<String>, help: impl Into<String>) {
    input.report(Diagnostic::new(Code::E0020, span, message).label("this is no statement here").help(help));
}

/// `SWITCH (x) { … }`, `foreach (int v in a) { … }`: what is in braces the lexer took for a pragma.
fn loop_in_braces(input: &mut In<'_, '_, '_>) -> bool {
    let (message, help) = if input.is_word("SWITCH") {
        ("Structured Text has no SWITCH", "write `CASE x OF 1: …; 2, 3: …; ELSE …; END_CASE`")
    } else if input.is_word("FOREACH") {
        ("Structured Text has no FOREACH", "write `FOR i := 0 TO 9 DO … a[i] … END_FOR`")
    } else {
        return false;
    };
    let after = behind_parentheses(input, 1);
    if !has_braces(input, after) {
        return false;
    }
    let word = input.here();
    refuse(input, word, message, help);
    skip_tokens(input, after);
    true
}

/// `int z = 1;`, `Dim z As Integer`, `WITH s DO … END_WITH`, `def f(x):`
fn two_names(input: &mut In<'_, '_, '_>) -> bool {
    let word = input.here();
    let text = input.text(word);
    let is = |words: &[&str]| words.iter().any(|it| text.eq_ignore_ascii_case(it));
    if is(&["DIM", "LET", "CONST"]) || type_of_ours(text).is_some() {
        return declared(input);
    }
    if is(&["DEF", "FUNC", "FN", "SUB", "VOID"]) && input.kind_ahead(2) == Kind::OpenParen {
        return function(input);
    }
    if is(&["WITH"]) {
        let help = "write the variable before each member: `s.x := 1;`";
        refuse(input, word, "Structured Text has no WITH", help);
        skip_to_end_of(input, "WITH");
        return true;
    }
    let (message, help) = if is(&["SET"]) {
        ("an assignment has no word before it", "write `x := …;`")
    } else if is(&["GOTO"]) {
        ("Structured Text has no GOTO", "what it jumps over goes into an IF; what it goes back to into a WHILE")
    } else if is(&["IMPORT", "USING", "INCLUDE"]) && !starts_line(input, 1) {
        (
            "nothing is imported among statements",
            "name other files with the program's own, or as `libraries` in `staunch.toml`",
        )
    } else {
        return false;
    };
    refuse(input, word, message, help);
    input.take();
    skip_rest(input);
    true
}

/// The type here that a word of another language is.
fn type_of_ours(word: &str) -> Option<&'static str> {
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
    ];
    let found = types.iter().find(|it| word.eq_ignore_ascii_case(it.0));
    let same = || staunch_ir::Elementary::named(word).map(|it| it.name());
    // `INT x` is said as ours: nobody means another type by it.
    same().or_else(|| found.map(|it| it.1))
}

/// A declaration as other languages write one, among statements. Its name is known from then on.
fn declared(input: &mut In<'_, '_, '_>) -> bool {
    let start = input.take();
    let mut ty = type_of_ours(input.text(start));
    // `const int K = 5;`
    while input.kind_ahead(1) == Kind::Name && !is_word(input, 1, "AS") && !starts_line(input, 1) {
        let span = input.take();
        ty = ty.or_else(|| type_of_ours(input.text(span)));
    }
    if input.kind() != Kind::Name {
        skip_rest(input);
        return true;
    }
    let span = input.take();
    let name = Name { text: input.text(span), span };
    if input.is_word("AS") && input.kind_ahead(1) == Kind::Name {
        input.take();
        let span = input.here();
        ty = type_of_ours(input.text(span));
    }
    let ty = ty.unwrap_or("INT");
    let text = name.text;
    input.report(
        Diagnostic::new(Code::E0017, start.to(span), "a variable is declared between VAR and END_VAR")
            .label("only statements are allowed here")
            .help(format!("write `VAR {text} : {ty}; END_VAR` before the first statement")),
    );
    input.state().strays.push(VarDecl {
        names: vec![name],
        address: None,
        ty: TypeSpec { kind: TypeKind::Error, span },
        edge: None,
        construction: None,
        initial: None,
        started: None,
        instance_path: None,
        doc: None,
        span,
    });
    skip_rest(input);
    true
}

/// `function f() { … }`, `def f(x):`
fn function(input: &mut In<'_, '_, '_>) -> bool {
    let after = behind_parentheses(input, 2);
    let is_body = has_braces(input, after) || input.kind_ahead(after) == Kind::Colon && starts_line(input, after + 1);
    if !is_body {
        return false;
    }
    let word = input.here();
    let at = input.number();
    let name = input.state().place(at + 1);
    let name = input.text(name);
    let help = format!("write `FUNCTION {name} : INT VAR_INPUT … END_VAR … END_FUNCTION` before this unit or after it");
    refuse(input, word, "a function is no statement, and has no braces", help);
    if input.kind_ahead(after) == Kind::Colon && skip_further_in(input, word, after + 1) {
        return true;
    }
    skip_tokens(input, after);
    input.eat(Kind::Colon);
    true
}

/// `Select Case x … End Select`
fn select(input: &mut In<'_, '_, '_>) -> bool {
    if !input.is_word("SELECT") {
        return false;
    }
    let word = input.here();
    refuse(input, word, "Structured Text has no SELECT", "write `CASE x OF 1: …; 2, 3: …; ELSE …; END_CASE`");
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

/// `++x;`, and `-- a remark`
fn doubled(input: &mut In<'_, '_, '_>) -> bool {
    let first = input.here();
    let at = input.number();
    let second = input.state().place(at + 1);
    if first.end != second.start {
        return false;
    }
    let sign = first.to(second);
    let text = input.text(sign);
    let name = input.state().place(at + 2);
    if input.kind_ahead(2) == Kind::Name && name.start == second.end {
        let (op, name) = (&text[..1], input.text(name));
        let meant = format!("{name} := {name} {op} 1");
        input.report(
            Diagnostic::new(Code::E0010, sign, format!("Structured Text has no `{text}`"))
                .label("expected `:=`")
                .help(format!("write `{meant}`")),
        );
        input.take();
        skip_rest(input);
        return true;
    }
    if text != "--" {
        return false;
    }
    input.report(
        Diagnostic::new(Code::E0010, sign, "Structured Text has no `--`")
            .label("a remark starts otherwise")
            .help("a comment is written `// …` or `(* … *)`"),
    );
    skip_line(input);
    true
}

/// `EXIT FOR`
fn exit_by_name(input: &mut In<'_, '_, '_>) -> bool {
    if starts_line(input, 1) || !matches!(input.kind_ahead(2), Kind::Semicolon) && !starts_line(input, 2) {
        return false;
    }
    input.take();
    let word = input.take();
    input.report(
        Diagnostic::new(Code::E0020, word, "EXIT leaves the loop around it, and names none")
            .label("delete this")
            .help("write `EXIT;`"),
    );
    input.eat(Kind::Semicolon);
    true
}

/// How many tokens ahead the one after the parentheses is that open so many ahead.
fn behind_parentheses(input: &mut In<'_, '_, '_>, open: usize) -> usize {
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

/// Whether braces with statements are directly before the token so many ahead; they are no pragma then.
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

fn skip_line(input: &mut In<'_, '_, '_>) {
    input.take();
    while !input.on_new_line() && input.kind() != Kind::End {
        input.take();
    }
}

/// After `END_WITH`, `End With` or the END of a BEGIN, where there is one before the unit ends; else after the line.
fn skip_to_end_of(input: &mut In<'_, '_, '_>, word: &str) {
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
