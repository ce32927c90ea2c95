//! Charts of OpenPLC and of the standard.

use super::programs::Folder;

const OWN: Folder = Folder("charts");

fn chart(declared: &str, action: &str, transitions: &str) -> String {
    format!(
        "PROGRAM p
VAR_INPUT go : BOOL; END_VAR
VAR_OUTPUT motor, lamp : BOOL; END_VAR
{declared}
INITIAL_STEP Wait: END_STEP
STEP Run: {action} END_STEP
STEP Other: lamp(N); END_STEP
{transitions}
TRANSITION FROM Run TO Wait := NOT go; END_TRANSITION
TRANSITION FROM Other TO Wait := NOT go; END_TRANSITION
END_PROGRAM
"
    )
}

const GO: &str = "TRANSITION FROM Wait TO Run := go; END_TRANSITION";

/// The states of a chart have no end that a search sees, so that the most it says is that it found nothing.
#[test]
fn a_variable_of_a_step_is_not_found_to_differ() {
    let arguments = ["--from", "openplc", "--to", "iec", "--budget", "20000"];
    let (code, text) = OWN.compare("step", &chart("", "motor(N);", GO), &arguments);
    assert_eq!(code, Some(4), "{text}");
    assert!(text.contains("No difference"), "{text}");
}

/// Of two transitions that are TRUE at once the standard takes the first; MATIEC's C takes both.
#[test]
fn two_transitions_at_once_differ() {
    let transitions = format!("{GO}\nTRANSITION FROM Wait TO Other := go; END_TRANSITION");
    let (code, text) =
        OWN.compare("both", &chart("", "motor(N);", &transitions), &["--from", "openplc", "--to", "iec"]);
    assert_eq!(code, Some(1), "{text}");
    assert!(text.contains("openplc and iec differ after 1 scan"), "{text}");
}
