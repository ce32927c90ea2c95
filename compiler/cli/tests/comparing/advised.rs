//! Advice is for the kind of counter, and in the words of the system of the move.

use super::programs::{Folder, NO_EVENT, command};

const OWN: Folder = Folder("advised");

/// A CTUD on Logix is no CTU, so that advice for one is not given for the other.
#[test]
fn advice_is_for_the_kind_of_counter() {
    let source = "PROGRAM p
VAR_INPUT up, down, r : BOOL; END_VAR
VAR c : CTUD; END_VAR
VAR_OUTPUT full : BOOL; END_VAR
c(CU := up, CD := down, R := r, LD := FALSE, PV := 5); full := c.QU;
END_PROGRAM
";
    let (code, text) = OWN.compare("both_ways", source, &["--from", "iec", "--to", "logix"]);
    assert_eq!(code, Some(1), "{text}");
    let advice = text.lines().find(|it| it.starts_with("What to do: ")).unwrap_or_default();
    assert!(advice.contains("ed := pulse AND NOT bd") && !advice.contains("CTU(c"), "{text}");
}

/// An Editor of OpenPLC that counts CD as it rises is not given CD negated.
#[test]
fn advice_is_for_the_edge_that_is_counted() {
    OWN.written("rising/staunch.toml", "openplc4-cd-edge = \"rising\"\n");
    let source = "PROGRAM p
VAR_INPUT up, down : BOOL; END_VAR
VAR_OUTPUT full : BOOL; END_VAR
VAR c : CTUD; END_VAR
c(CU := up, CD := down, R := FALSE, LD := FALSE, PV := 2); full := c.QU;
END_PROGRAM
";
    let (code, text) = OWN.compare("rising/p", source, &["--from", "openplc", "--to", "openplc4", "--vars", "full"]);
    assert_eq!(code, Some(1), "{text}");
    assert!(text.contains("Trap 18 (`c`)") && text.contains("CD := d.Q AND NOT u.Q, …)"), "{text}");
    let (_, text) = OWN.compare("falls", source, &["--from", "openplc", "--to", "openplc4"]);
    assert!(text.contains("CD := NOT (d.Q AND NOT u.Q), …)"), "{text}");
}

/// RESET and LOAD on CODESYS and CSCAPE, R and LD elsewhere; a CTD counts by CD.
#[test]
fn advice_has_the_pins_of_the_block() {
    let logix = "PROGRAM p
VAR_INPUT s, r : BOOL; END_VAR
VAR c : COUNTER; END_VAR
CTU(c, s); RES(c, r);
END_PROGRAM
";
    for (to, reset, load) in [("codesys", "RESET", "LOAD"), ("cscape", "RESET", "LOAD"), ("iec", "R", "LD")] {
        let (_, text) = OWN.compare(&format!("pins_{to}"), logix, &["--from", "logix", "--to", to]);
        assert!(text.contains(&format!("c(CU := rung, {reset} := clear, ")), "{to}: {text}");
        assert!(text.contains(&format!("c(CD := rung, {load} := load, ")), "{to}: {text}");
    }
    let down = "PROGRAM p
VAR_INPUT s, l : BOOL; END_VAR
VAR c : CTD; END_VAR
c(s, l, 3);
END_PROGRAM
";
    for from in ["codesys", "openplc"] {
        let none = OWN.written("no_event.txt", NO_EVENT);
        let (_, text) =
            OWN.compare(&format!("cd_{from}"), down, &["--from", from, "--to", "cscape", "--assume", &none]);
        let advice = text.lines().find(|it| it.starts_with("What to do: ")).unwrap_or_default();
        assert!(advice.contains("c(CD := e.Q, …)") && !advice.contains("CU :="), "{from}: {text}");
    }
}

/// S7 has the standard's SR here, and is not called IEC.
#[test]
fn a_pin_is_called_as_on_the_system_of_the_move() {
    let source = "PROGRAM p
VAR_INPUT s : BOOL; END_VAR
VAR c : CTU; t : SR; END_VAR
c(CU := s, RESET := FALSE, PV := 3);
t(SET1 := s, RESET := FALSE);
END_PROGRAM
";
    let path = OWN.written("pin_names.st", source);
    let arguments = ["--from", "codesys", "--to", "siemens"];
    let output = command().arg(&path).args(arguments).output().expect("it starts");
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(
        said.contains("`RESET` is called `R` in S7") && said.contains("`SET1` is called `S1` in SIEMENS"),
        "{said}"
    );
    assert!(!said.contains(" in IEC"), "{said}");
}
