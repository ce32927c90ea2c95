//! Statements of other languages, each answered once by its name, and passed over: declarations among statements, functions
//! inside of a unit, GOTO, `++x`.

use crate::{
    ast::{Name, TypeKind, TypeSpec, VarDecl},
    diagnostic::{Code, Diagnostic},
    lex::Kind,
};

use super::{
    expression::{is_latch, pointed},
    foreign_reader::{
        behind_parentheses, has_braces, is_word, refuse, skip_further_in, skip_line, skip_rest, skip_tokens,
        starts_line, type_of_ours,
    },
    foreign_syntax::joins_name,
    parser::{In, Parsed, Problem, TokenReader},
};

/// Refuses and skips such a statement, if one starts here.
pub fn skip(input: &mut In<'_, '_, '_>) -> bool {
    if input.state().instead.is_some() {
        return false;
    }
    match (input.kind(), input.kind_ahead(1)) {
        (Kind::Name, Kind::Name) => !is_latch(input, 1) && two_names(input),
        (Kind::Var, Kind::Name) => input.kind_ahead(2) == Kind::Equal && declared(input),
        (Kind::Function, Kind::Name) => input.kind_ahead(2) == Kind::OpenParen && function(input),
        (Kind::Plus, Kind::Plus) | (Kind::Minus, Kind::Minus) => doubled(input),
        (Kind::Star, Kind::Name) => joins_name(input) && followed(input),
        (Kind::Exit, Kind::For | Kind::While | Kind::Repeat | Kind::Do) => exit_by_name(input),
        _ => false,
    }
}

/// `int z = 1;`, `Dim z As Integer`, `def f(x):`
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
    let (message, help) = if is(&["SET"]) {
        ("an assignment has no keyword before it", "write `x := …;`")
    } else if is(&["GOTO"]) {
        ("Structured Text has no GOTO", "put statements to skip into an IF, and statements to repeat into a WHILE")
    } else if is(&["IMPORT", "USING", "INCLUDE"]) && !starts_line(input, 1) {
        (
            "imports are not statements",
            "list other files together with the program's own, or as `libraries` in `staunch.toml`",
        )
    } else {
        return false;
    };
    refuse(input, word, message, help);
    input.take();
    skip_rest(input);
    true
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
        starts_at_calls: false,
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
    refuse(input, word, "a function is not a statement, and has no braces", help);
    if input.kind_ahead(after) == Kind::Colon && skip_further_in(input, word, after + 1) {
        return true;
    }
    skip_tokens(input, after);
    input.eat(Kind::Colon);
    true
}

/// `*p := 5;`
fn followed(input: &mut In<'_, '_, '_>) -> bool {
    if pointed(input).is_err() {
        return false;
    }
    skip_rest(input);
    true
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
            .label("`--` does not start a comment")
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
        Diagnostic::new(Code::E0020, word, "EXIT leaves the innermost loop and takes no name")
            .label("delete this")
            .help("write `EXIT;`"),
    );
    input.eat(Kind::Semicolon);
    true
}

/// `REF =`, `S =`: refused where the `=` follows the word at some distance.
pub fn split_latch(input: &mut In<'_, '_, '_>) -> Parsed<()> {
    let words = ["REF=", "S=", "R="];
    let (word, at) = (input.here(), input.number());
    let text = input.text(word).to_ascii_uppercase();
    let meant = words.into_iter().find(|it| it.strip_suffix('=') == Some(text.as_str()));
    let Some(meant) = meant.filter(|_| input.kind_ahead(1) == Kind::Equal) else { return Ok(()) };
    let whole = word.to(input.state().place(at + 1));
    input.report(
        Diagnostic::new(Code::E0001, whole, format!("`{meant}` is written in one piece"))
            .label(format!("expected `{meant}`"))
            .help(format!("write `{meant}`"))
            .fix(whole, meant),
    );
    Err(Problem::REPORTED)
}
