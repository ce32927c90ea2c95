//! Declarations and units that are written as in another language, or in another place.

use crate::{
    ast::{Name, TypeSpec},
    diagnostic::{Code, Diagnostic},
    lex::Kind,
    source::Span,
};

use super::{
    super::parser::{In, State, TokenReader},
    behind_last, insertion, shown,
};

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
            .label("a `:` is missing after this")
            .help("write `:` here")
            .fix(place, " :"),
    );
}

/// `INT x;`
pub fn type_first(state: &State<'_, '_>, ty: Span, name: Span) -> Diagnostic {
    let meant = format!("{} : {}", state.slice(name), state.slice(ty));
    let whole = ty.to(name);
    Diagnostic::new(Code::E0001, whole, "a declaration is a name, `:` and a type")
        .label("expected a name, `:` and a type")
        .help(format!("write `{meant}`"))
        .fix(whole, meant)
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

/// `a : INT;` among statements; `closed` where an END_VAR comes after such declarations.
pub fn stray_declaration(input: &mut In<'_, '_, '_>, span: Span, closed: bool) {
    let it = Diagnostic::new(Code::E0017, span, "this declaration is outside of VAR … END_VAR");
    let text = input.text(span);
    input.report(if closed {
        it.label("expected `VAR` before this").help("write `VAR` here").fix(Span { end: span.start, ..span }, "VAR ")
    } else {
        it.label("only statements are allowed here")
            .help(format!("write `VAR {text} END_VAR` before the first statement"))
    });
}

/// A VAR block or a statement outside of all units.
pub fn outside_of_units(span: Span, statements: bool) -> Diagnostic {
    let it = Diagnostic::new(Code::E0001, span, "this is outside any unit of the program")
        .label("no PROGRAM, FUNCTION_BLOCK or FUNCTION is open here");
    if statements {
        it.help("write `PROGRAM Main` before it, and `END_PROGRAM` after it")
    } else {
        it.help("write `VAR_GLOBAL` for global variables, or `PROGRAM Main` before it")
    }
}

/// `FUNCTION f(x : INT) : INT`, `PROGRAM p()`
pub fn parameters_in_head(span: Span, declared: &str) -> Diagnostic {
    if declared.is_empty() {
        return Diagnostic::new(Code::E0020, span, "the name of a unit has no parentheses after it")
            .label("delete this")
            .help("delete them")
            .fix(span, "");
    }
    Diagnostic::new(Code::E0020, span, "parameters are declared in VAR_INPUT, not in parentheses")
        .label("expected no parentheses")
        .help(format!("write `VAR_INPUT {declared} END_VAR` on the next line"))
}

/// `ARRAY[10]`, `ARRAY[1:3]`, `ARRAY(1..3)`, `INT[10]`: what is wrong at `span`, and what is meant.
pub fn array_bounds(span: Span, found: &str, meant: &str) -> Diagnostic {
    Diagnostic::new(Code::E0001, span, "an array is declared with its first and last index")
        .label(format!("expected `[first..last]`, found {found}"))
        .help(format!("write `{meant}`"))
}

/// `x : INT*`
pub fn star_after_type(span: Span, ty: &str) -> Diagnostic {
    let meant = format!("POINTER TO {ty}");
    Diagnostic::new(Code::E0001, span, "a pointer is declared with POINTER TO")
        .label(format!("expected `{meant}`"))
        .help(format!("write `{meant}`"))
        .fix(span, meant)
}

/// `Motor[3(9)]`
pub fn repeated_arguments(span: Span, list: &str) -> Diagnostic {
    Diagnostic::new(Code::E0304, span, "a repeat count is not allowed for arguments of FB_init")
        .label("expected a list for each element")
        .help(format!("write each: `[{list}, {list}, …]`"))
}

/// `END_PROGRAM Main`
pub fn name_after_end(span: Span) -> Diagnostic {
    Diagnostic::new(Code::E0020, span, "the end of a unit has no name after it")
        .label("delete this")
        .help("delete it")
        .fix(span, "")
}

/// `STRUCT Name` outside of TYPE.
pub fn bare_structure(span: Span, name: &str) -> Diagnostic {
    Diagnostic::new(Code::E0001, span, "a structure is declared in TYPE … END_TYPE")
        .label("expected `TYPE` before this")
        .help(format!("write `TYPE {name} : STRUCT … END_STRUCT; END_TYPE`"))
}

/// TYPE or FUNCTION inside a PROGRAM.
pub fn nested_unit(span: Span, kind: Kind, outer: &str) -> Diagnostic {
    Diagnostic::new(Code::E0001, span, format!("{kind} is inside {}", crate::diagnostic::wording::article(outer)))
        .label("units of the program cannot be nested")
        .help(format!("move it before the {outer}"))
}

/// `FUNCTION_BLOCK f : INT`
pub fn no_result_type(span: Span, opener: &str) -> Diagnostic {
    let opener = opener.to_ascii_uppercase();
    Diagnostic::new(Code::E0001, span, format!("{} has no result type", crate::diagnostic::wording::article(&opener)))
        .label("delete this")
        .help("delete it, and declare what it returns in VAR_OUTPUT")
        .fix(span, "")
}

/// `x AT IX0.0`
pub fn address_without_sign(span: Span, text: &str) -> Diagnostic {
    let problem = Diagnostic::new(Code::E0409, span, "a direct address starts with `%`");
    match is_address(text) {
        true => problem.help(format!("write `%{text}`")).fix(span, format!("%{text}")),
        false => {
            problem.help("write the address, as `%QX0.0`: only projects of OpenPLC Editor have names for addresses")
        }
    }
}

/// `QX0.0`, `MW10`, `I*`
fn is_address(text: &str) -> bool {
    let upper = text.to_ascii_uppercase();
    let Some(rest) = upper.strip_prefix(['I', 'Q', 'M']) else { return false };
    let rest = rest.strip_prefix(['X', 'B', 'W', 'D', 'L']).unwrap_or(rest);
    rest.starts_with(|it: char| it.is_ascii_digit() || it == '*')
}

/// `x : BOOL AT %QX0.0;`, of which this is reported where the dialect does not have it.
pub fn address_after_type<'s>(
    input: &mut In<'_, '_, 's>,
    name: Option<&Name<'s>>,
    ty: &TypeSpec<'s>,
    (at, address): (Span, Name<'s>),
) -> Diagnostic {
    let (span, ty) = (at.to(address.span), input.text(ty.span));
    let problem = Diagnostic::new(Code::E0409, span, "the address of a variable is written before its type")
        .label("expected before the `:`");
    match name {
        Some(name) => problem
            .help(format!("write `{} AT {} : {ty}`", name.text, address.text))
            .fix(Span { start: name.span.end, ..span }, format!(" AT {} : {ty}", address.text)),
        None => problem.help("write `name AT %QX0.0 : BOOL;`"),
    }
}
