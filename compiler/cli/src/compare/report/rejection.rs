//! Why a program cannot be compared: the other system rejects it.

use crate::session::Session;
use staunch_compare::difference::pitfall::Pitfall;
use staunch_frontend::{Code, Diagnostic, Dialect, Severity, Subject};
use staunch_ir::Elementary;
use staunch_runtime::{BlockInfo, KeptCount, PinRole};

/// What is in the way, and what to do.
pub struct Rejection {
    pub pitfall: Option<Pitfall>,
    pub why: String,
    pub advice: String,
}

const TO_LOGIX: &str =
    "Logix has no counter blocks. Declare a COUNTER (it has CU CD DN OV UN : BOOL; PRE ACC : DINT) and write its \
instructions, one a rung:
    c.PRE := preset;
    CTU(Counter := c, RungIn := sensor);
    light := c.DN;
    RES(Counter := c, RungIn := clear);
Give the rewritten program with --against FILE to compare it";

const FROM_LOGIX: &str = "A COUNTER and its instructions become an instance and its call: CTU(c, rung) and RES(c, clear) are \
`c(CU := rung, {R} := clear, PV := preset)` (of a CTD `c(CD := rung, {LD} := load, PV := preset)`), c.DN is c.Q, c.ACC is c.CV. Give the rewritten program with --against FILE to \
compare it";

const TIMERS_FROM_LOGIX: &str = "A TIMER and its instructions become an instance and its call: TON(t, rung) is \
`t(IN := rung, PT := preset)` of a TON with a TIME, t.DN is t.Q, t.ACC is t.ET; an RTO has no counterpart. ONS and OSR become \
an R_TRIG, OSF an F_TRIG, OTL and OTU an IF. Give the rewritten program with --against FILE to compare it";

/// What Logix has in addition to its counters, by name.
const TIMERS_OF_LOGIX: [&str; 9] = ["TIMER", "TON", "TOF", "RTO", "ONS", "OSR", "OSF", "OTL", "OTU"];

/// The reason after the first error.
pub fn find(to: &Session, from: Dialect, target: Dialect) -> Rejection {
    let errors = to.diagnostics.iter().filter(|it| it.severity == Severity::Error);
    let found = errors.map(|it| of(to, it, from, target));
    let mut found: Vec<_> = found.collect();
    let at = found.iter().position(|it| it.pitfall.is_some()).unwrap_or(0);
    if found.is_empty() {
        return Rejection {
            pitfall: None,
            why: format!("{} rejects the program", target.name()),
            advice: String::new(),
        };
    }
    found.swap_remove(at)
}

fn of(to: &Session, error: &Diagnostic, from: Dialect, target: Dialect) -> Rejection {
    let name = to.sources.text(error.span).to_ascii_uppercase();
    let system = target.name().to_ascii_uppercase();
    let block = matches!(error.code, Code::E0309 | Code::E0102 | Code::E0305 | Code::E0307);
    let why = format!("{system} rejects the program: {}", error.message);
    let pitfall = |number| Some(Pitfall::numbered(number));
    if target == Dialect::Logix && (block || error.code == Code::E0301) {
        return Rejection { pitfall: None, why, advice: TO_LOGIX.to_owned() };
    }
    if from == Dialect::Logix && block && TIMERS_OF_LOGIX.contains(&name.as_str()) {
        return Rejection { pitfall: None, why, advice: TIMERS_FROM_LOGIX.to_owned() };
    }
    if from == Dialect::Logix && block {
        return Rejection { pitfall: pitfall(11), why, advice: from_logix(target) };
    }
    let counter = from.block(&name);
    let kept = counter.and_then(|it| it.facts.kept);
    let both = |it: &BlockInfo| it.pin_for(PinRole::Up).is_some() && it.pin_for(PinRole::Down).is_some();
    match kept {
        Some(KeptCount { plain, .. }) => {
            let advice = format!("Use a {plain} in VAR RETAIN, without RCV; its count survives a restart there");
            Rejection { pitfall: pitfall(11), why, advice }
        }
        None if counter.is_some_and(both) && target == Dialect::Cscape => {
            let advice = "Use a CTU and a CTD and subtract, or count in a variable of your own".to_owned();
            Rejection { pitfall: None, why, advice }
        }
        None if block && counter.is_some() => Rejection {
            pitfall: None,
            why,
            advice: "Write the program for that system, with a block that it has or that names its family, and give it with \
                     --against FILE to compare it"
                .to_owned(),
        },
        None if widths(error) => Rejection {
            pitfall: pitfall(8),
            why,
            advice: "Convert the count or the preset explicitly, as `WORD_TO_INT(…)`".to_owned(),
        },
        None => Rejection { pitfall: None, why, advice: "Change it as the message says".to_owned() },
    }
}

/// With the names that the system has for the pins of its counters.
fn from_logix(target: Dialect) -> String {
    let pin = |block: &str, role: PinRole| target.block(block).and_then(|it| it.pin_for(role)).map_or("", |it| it.name);
    FROM_LOGIX.replace("{R}", pin("CTU", PinRole::Reset)).replace("{LD}", pin("CTD", PinRole::Load))
}

/// Whether the error is about whole numbers that do not fit one another's types, and of no other type.
fn widths(error: &Diagnostic) -> bool {
    let is_whole = |it: Elementary| it.repr().is_integer() && it.is_integral();
    match error.subject {
        Some(Subject::Beyond(ty)) => is_whole(ty),
        Some(Subject::Mismatch(a, b)) => is_whole(a) && is_whole(b),
        Some(
            Subject::Missing { .. }
            | Subject::Unavailable { .. }
            | Subject::Elsewhere { .. }
            | Subject::Unclosed { .. },
        )
        | None => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use staunch_frontend::Span;

    fn is_widths(code: Code, subject: Subject) -> bool {
        widths(&Diagnostic::new(code, Span::default(), "").about(subject))
    }

    #[test]
    fn widths_are_those_of_whole_numbers() {
        assert!(is_widths(Code::E0203, Subject::Mismatch(Elementary::Int, Elementary::Word)));
        assert!(is_widths(Code::E0202, Subject::Beyond(Elementary::Int)));
        assert!(!is_widths(Code::E0203, Subject::Mismatch(Elementary::Int, Elementary::Real)));
        assert!(!is_widths(Code::E0203, Subject::Mismatch(Elementary::Time, Elementary::Int)));
        assert!(!widths(&Diagnostic::new(Code::E0201, Span::default(), "CASE needs an integer, found STRING[80]")));
    }
}
