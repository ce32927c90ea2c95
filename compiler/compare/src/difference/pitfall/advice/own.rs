//! A counter in variables of the program's own: what the block does on the system that the program comes from, in statements
//! that every system has.

use super::form::{Counting, Form, Rules};
use staunch_runtime::Family;

/// The statements in place of a call, with what they are named.
pub fn text(counting: Counting) -> Option<String> {
    let rules = counting.rules?;
    let (statements, outputs) = match (rules.family, counting.form) {
        (Family::Logix, form) => logix(form),
        (Family::Cscape, Form::Up) => (CSCAPE_UP.to_owned(), "`full` for Q"),
        (Family::Cscape, Form::Down) => (CSCAPE_DOWN.to_owned(), "`empty` for Q"),
        (Family::Cscape, Form::UpDown) => return None,
        (Family::Iec | Family::Codesys | Family::Openplc | Family::Openplc4 | Family::S7, form) => edges(rules, form),
    };
    let kept = match rules.family {
        Family::Logix if counting.form == Form::UpDown => "RETAIN but for `bu` and `bd`, which are initially TRUE,",
        Family::Logix => "RETAIN but for `before`, which is initially TRUE,",
        Family::Iec | Family::Codesys | Family::Cscape | Family::Openplc | Family::Openplc4 | Family::S7 => {
            "RETAIN where `c` is,"
        }
    };
    let of_tag = if rules.family == Family::Logix { "ACC" } else { "CV" };
    let left_out = if counting.is_partial { " An input that a call leaves out keeps its value there." } else { "" };
    Some(format!(
        "In place of each call, count in variables of your own, {kept} with `n` ({}) for {of_tag} and {outputs}: `{statements}`.{left_out}",
        type_of(rules)
    ))
}

const CSCAPE_UP: &str =
    "IF clear THEN n := 0; ELSIF sensor AND n < preset THEN n := n + 1; END_IF; full := n = preset;";

const CSCAPE_DOWN: &str = "IF load THEN n := preset; ELSIF pulse AND n > 0 THEN n := n - 1; END_IF; empty := n = 0;";

/// A type that holds all that the count may be.
fn type_of(rules: Rules) -> &'static str {
    match (rules.least, rules.greatest) {
        (least, greatest) if least >= i128::from(i16::MIN) && greatest <= i128::from(i16::MAX) => "an INT",
        (least, greatest) if least >= i128::from(i32::MIN) && greatest <= i128::from(i32::MAX) => "a DINT",
        (_, greatest) if greatest <= i128::from(i64::MAX) => "a LINT",
        _ => "a ULINT",
    }
}

/// Of the blocks that count edges.
fn edges(rules: Rules, form: Form) -> (String, &'static str) {
    let greatest = rules.greatest;
    let below = if rules.stops { "n < preset".to_owned() } else { format!("n < {greatest}") };
    let above = if goes_below(rules) { format!("n > {}", rules.least) } else { "n > 0".to_owned() };
    let down = if rules.falls { "before AND NOT pulse" } else { "pulse AND NOT before" };
    let (loaded, load) = match rules.loads_once {
        true => ("first := load AND NOT loaded; loaded := load; ", "load THEN IF first THEN n := preset; END_IF;"),
        false => ("", "load THEN n := preset;"),
    };
    match form {
        Form::Up => (
            format!(
                "edge := sensor AND NOT before; before := sensor; \
                 IF clear THEN n := 0; ELSIF edge AND {below} THEN n := n + 1; END_IF; full := n >= preset;"
            ),
            "`full` for Q",
        ),
        Form::Down => (
            format!(
                "{loaded}edge := {down}; before := pulse; \
                 IF {load} ELSIF edge AND {above} THEN n := n - 1; END_IF; empty := n <= 0;"
            ),
            "`empty` for Q",
        ),
        Form::UpDown => (up_down(rules, [&below, &above], [loaded, load]), "`full`, `empty` for QU, QD"),
    }
}

fn up_down(rules: Rules, [below, above]: [&str; 2], [loaded, load]: [&str; 2]) -> String {
    let fall = if rules.falls { "bd AND NOT pulse" } else { "pulse AND NOT bd" };
    let count = match rules.family {
        // Each edge by itself.
        Family::Openplc4 => format!(
            "ELSE IF eu AND {below} THEN n := n + 1; END_IF; IF ed AND {above} THEN n := n - 1; END_IF; END_IF;"
        ),
        Family::Iec | Family::Codesys | Family::Cscape | Family::Openplc | Family::S7 | Family::Logix => format!(
            "ELSIF eu AND NOT ed AND {below} THEN n := n + 1; ELSIF ed AND NOT eu AND {above} THEN n := n - 1; END_IF;"
        ),
    };
    format!(
        "{loaded}eu := sensor AND NOT bu; bu := sensor; ed := {fall}; bd := pulse; \
         IF clear THEN n := 0; ELSIF {load} {count} full := n >= preset; empty := n <= 0;"
    )
}

/// Whether CTD goes below 0.
fn goes_below(rules: Rules) -> bool {
    matches!(rules.family, Family::Iec | Family::S7) && rules.least < 0
}

/// Of a COUNTER, and of CTUD of an FBD_COUNTER. ACC turns round at the limits of DINT, and DN is then what it would be of a
/// count that had not: OV and UN say so.
fn logix(form: Form) -> (String, &'static str) {
    let count = |rung: &str, step: &str, turns: &str, full: &str| {
        format!(
            "rung := {rung}; IF rung THEN IF NOT before THEN {step} {turns} END_IF; full := {full}; END_IF; before := rung;` in \
             place of its instruction, and in place of RES `IF clear THEN n := 0; full := FALSE; before := FALSE; turned := FALSE; \
             END_IF;"
        )
    };
    let text = match form {
        Form::Up => count("sensor", "n := n + 1;", "turned := turned OR n < -2147483647;", "turned OR n >= preset"),
        Form::Down => {
            count("pulse", "n := n - 1;", "turned := turned OR n = 2147483647;", "NOT turned AND n >= preset")
        }
        Form::UpDown => "eu := sensor AND NOT bu; bu := sensor; ed := pulse AND NOT bd; bd := pulse; \
             IF clear THEN n := 0; full := FALSE; bu := FALSE; bd := FALSE; over := FALSE; under := FALSE; ELSE \
             IF eu THEN n := n + 1; IF n < -2147483647 THEN over := NOT under; under := FALSE; END_IF; END_IF; \
             IF ed THEN n := n - 1; IF n = 2147483647 THEN under := NOT over; over := FALSE; END_IF; END_IF; \
             full := over OR NOT under AND n >= preset; END_IF;"
            .to_owned(),
    };
    (text, "`full` for DN")
}
