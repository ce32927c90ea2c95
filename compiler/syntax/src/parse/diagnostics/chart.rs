//! Mistakes in the text of a sequential function chart.

use crate::{
    ast::{Name, PouKind, Qualifier},
    diagnostic::{Code, Diagnostic, wording::article},
    source::Span,
    spelling::nearest,
};

/// A chart in what is called without a state.
pub fn chart_outside(span: Span, kind: PouKind) -> Diagnostic {
    let word = kind.word();
    Diagnostic::new(Code::E0515, span, format!("{} cannot be a sequential function chart", article(word)))
        .label("a step of a chart")
        .help("write the chart as the body of a PROGRAM or FUNCTION_BLOCK")
}

/// `STEP Fill: Valve(N);` without END_STEP.
pub fn open_element(opened: Span, end: &str) -> Diagnostic {
    Diagnostic::new(Code::E0515, opened, format!("{end} is missing"))
        .label("this is not closed")
        .help(format!("write `{end}` where it ends"))
}

/// `Valve(M)`
pub fn unknown_qualifier(name: Name<'_>) -> Diagnostic {
    let it = Diagnostic::new(Code::E0515, name.span, format!("`{}` is not an action qualifier", name.text))
        .label("expected a qualifier")
        .help(format!("the qualifiers are {}", Qualifier::names().collect::<Vec<_>>().join(", ")));
    match nearest(name.text, Qualifier::names()) {
        Some(meant) => it.fix(name.span, meant),
        None => it,
    }
}

/// `Valve(L)`
pub fn qualifier_without_time(name: Name<'_>) -> Diagnostic {
    let word = name.text.to_ascii_uppercase();
    Diagnostic::new(Code::E0515, name.span, format!("the qualifier {word} needs a time"))
        .label("expected a time after it")
        .help(format!("write it after a comma: `{word}, T#5s`"))
}

/// `Valve(N, T#5s)`
pub fn qualifier_with_time(name: Name<'_>, time: Span) -> Diagnostic {
    let word = name.text.to_ascii_uppercase();
    Diagnostic::new(Code::E0515, time, format!("the qualifier {word} has no time"))
        .label("this time has no meaning")
        .help("remove it, or write L (limited), D (delayed), SD, DS or SL")
        .fix(time, "")
}

/// `TRANSITION x := y; END_TRANSITION`
pub fn transition_without_steps(span: Span) -> Diagnostic {
    Diagnostic::new(Code::E0515, span, "this transition does not name its steps")
        .label("expected FROM")
        .help("write the steps before and after it: `TRANSITION FROM a TO b := condition; END_TRANSITION`")
}

/// `INITIAL STEP Start:`
pub fn initial_step_in_two_words(span: Span) -> Diagnostic {
    Diagnostic::new(Code::E0515, span, "INITIAL_STEP is one word")
        .label("two words")
        .help("write it with an underscore")
        .fix(span, "INITIAL_STEP")
}

/// `(PRIORITY = 1)`
pub fn wrong_priority(word: Span) -> Diagnostic {
    Diagnostic::new(Code::E0515, word, "a priority is a whole number, 0 or more")
        .label("expected `:=` and a number after this")
        .help("write `(PRIORITY := 1)`: the lowest number comes first")
}
