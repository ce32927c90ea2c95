//! What a difference is blamed on: what it depends on, and what explains it.

use super::programs::{ENABLED, Folder, NO_EVENT};

const OWN: Folder = Folder("blamed");

/// Both systems keep a RETAIN count in every event: a count below 0 is trap 3 there, whatever happens before it.
#[test]
fn a_restart_is_blamed_where_both_keep_nothing_alike() {
    let source = "PROGRAM p
VAR_INPUT s, l : BOOL; END_VAR
VAR RETAIN c : CTD; END_VAR
VAR_OUTPUT o : BOOL; END_VAR
c(s, l, 3);
o := c.CV < 0;
END_PROGRAM
";
    let accepted = OWN.written("below.txt", "c 3: the count below 0 is not used\n");
    let (code, text) = OWN.compare("kept", source, &["--from", "iec", "--to", "codesys", "--accept", &accepted]);
    assert_eq!(code, Some(1), "{text}");
    assert!(!text.contains("reachable after 2 scans: trap 11"), "{text}");
    assert!(text.contains("Not accepted: `o output`."), "{text}");
}

/// `lamp` follows from the second counter; the first parts before it, and decides nothing of it.
#[test]
fn the_counter_that_is_blamed_decides_the_difference() {
    for input in ["s", "s OR c.CV > 90"] {
        let source = format!(
            "PROGRAM p
VAR_INPUT s, r : BOOL; END_VAR
VAR c, d : CTU; END_VAR
VAR_OUTPUT lamp : BOOL; END_VAR
c(CU := s, R := r, PV := 2);
d(CU := {input}, R := r, PV := 3);
lamp := d.CV > 5;
END_PROGRAM
"
        );
        let (code, text) = OWN.compare("blame", &source, &["--from", "iec", "--to", "openplc", "--vars", "lamp"]);
        assert_eq!(code, Some(1), "{text}");
        assert!(text.contains("Trap 15 (`d`)"), "{text}");
    }
}

/// Of two counters that part, the one is blamed without whose rule nothing would differ: here the second comes to differ
/// first, and what is asked of it does not depend on that.
#[test]
fn the_counter_that_is_blamed_makes_the_difference_alone() {
    let second = "PROGRAM p
VAR_INPUT s : BOOL; END_VAR
VAR_OUTPUT o : BOOL; END_VAR
VAR c : CTU; d : CTD; END_VAR
c(s, FALSE, 3);
d(s, c.CV = 4, 2);
o := d.Q;
END_PROGRAM
";
    let element = "PROGRAM p
VAR_INPUT x, y : BOOL; END_VAR
VAR_OUTPUT o : BOOL; END_VAR
VAR c : CTD; i : INT; a : ARRAY[0..1] OF CTD; END_VAR
IF NOT y THEN c(x, x, 1); END_IF;
IF y THEN i := 1; ELSE i := 0; END_IF;
a[i](y OR x, c.Q, 1);
o := a[1].Q;
END_PROGRAM
";
    let none = OWN.written("no_event.txt", NO_EVENT);
    for (number, source, from, to, said) in [
        (0, second, "iec", "openplc", "Trap 15 (`c`)"),
        (1, second, "codesys", "siemens", "Trap 2 (`c`)"),
        (2, element, "siemens", "openplc4", "Trap 17 (`c`)"),
    ] {
        let arguments = ["--from", from, "--to", to, "--vars", "o", "--assume", &none];
        let (code, text) = OWN.compare(&format!("alone_{number}"), source, &arguments);
        assert_eq!(code, Some(1), "{text}");
        assert!(text.contains(said), "{text}");
    }
}

/// A number of a TIME is of milliseconds on IEC and OPENPLC4, and of seconds on OPENPLC: that it is given another PT is why
/// the timer differs, not that it looks at the time in a later call.
#[test]
fn a_timer_that_is_given_another_preset_is_not_blamed() {
    let source = "PROGRAM p
VAR_INPUT go : BOOL; END_VAR
VAR_OUTPUT lamp : BOOL; END_VAR
VAR ms : DINT := 1500; t : TON; END_VAR
t(IN := go, PT := DINT_TO_TIME(ms));
lamp := t.Q;
END_PROGRAM
";
    let (code, text) = OWN.compare("another_preset", source, &["--from", "openplc", "--to", "iec"]);
    assert_eq!(code, Some(1), "{text}");
    assert!(text.contains("the inputs of the block differ") && !text.contains("trap 19"), "{text}");
    let same = source.replace("DINT_TO_TIME(ms)", "T#0s");
    let (code, text) = OWN.compare("same_preset", &same, &["--from", "openplc", "--to", "iec"]);
    assert_eq!(code, Some(1), "{text}");
    assert!(text.contains("Trap 19 (`t`): TON, TOF and TP on OPENPLC, before and from v4.1,"), "{text}");
}

/// Of a timer with a PT that is not over at once, no call of OPENPLC comes too late: what differs is what it is given.
#[test]
fn a_timer_that_starts_otherwise_is_not_late() {
    let source = "PROGRAM p
VAR_INPUT s, r : BOOL; END_VAR
VAR_OUTPUT o : BOOL; END_VAR
VAR c : CTU; t : TON; END_VAR
c(s, r, 2);
t(IN := c.CV > 2, PT := T#30ms);
o := t.Q;
END_PROGRAM
";
    let accepted = OWN.written("timer.accept", "c 15: known\no output: known\n");
    let (code, text) =
        OWN.compare("timer", source, &["--from", "iec", "--to", "openplc", "--vars", "o", "--accept", &accepted]);
    assert_eq!(code, Some(0), "{text}");
    assert!(text.contains("the inputs of the block differ") && !text.contains("trap 19"), "{text}");
}

/// What is one program on both systems is never said to be two: a counter below 0 in one of its calls, a division by zero,
/// an EN that stops a body.
#[test]
fn one_program_is_not_two() {
    let calls = "PROGRAM p
VAR_INPUT s : BOOL; END_VAR
VAR_OUTPUT o : BOOL; END_VAR
VAR c : CTD; END_VAR
c(s, FALSE, 1);
c(CD := FALSE);
o := c.CV < 0;
END_PROGRAM
";
    let division = "PROGRAM p
VAR_INPUT on : BOOL; END_VAR
VAR x : DINT := 7; z : DINT; END_VAR
VAR_OUTPUT y : DINT; END_VAR
y := x / z;
END_PROGRAM
";
    let none = OWN.written("no_event.txt", NO_EVENT);
    for (name, source, vars, to, said) in [
        ("calls", calls, "o", "openplc", "Trap 15 (`c`)"),
        ("calls", calls, "o", "codesys", "Trap 3 (`c`)"),
        ("division", division, "y", "logix", "a division by zero ("),
        ("enable", ENABLED, "off", "siemens", "`En` stops the body of `Pump` only on iec"),
        ("enable", ENABLED, "off", "codesys", "`En` stops the body of `Pump` only on iec"),
    ] {
        let arguments = ["--from", "iec", "--to", to, "--vars", vars, "--assume", &none];
        let (code, text) = OWN.compare(&format!("one_{name}_{to}"), source, &arguments);
        assert_eq!(code, Some(1), "{name}: {text}");
        assert!(text.contains(said) && !text.contains("programs are not the same"), "{name}: {text}");
    }
}

/// Nothing reads DN of a CTD that replaces a block, so it is not a reason.
#[test]
fn what_the_port_does_not_read_is_no_reason() {
    let below = "PROGRAM p
VAR_INPUT s, l : BOOL; END_VAR
VAR_OUTPUT o : BOOL; END_VAR
VAR c : CTD; m, b : BOOL; END_VAR
b := s AND NOT m; m := s;
c(b, l, 3);
o := c.CV < 0;
END_PROGRAM
";
    let two = "PROGRAM p
VAR_INPUT s, r : BOOL; END_VAR
VAR_OUTPUT o : BOOL; END_VAR
VAR d : CTD; c : CTU; END_VAR
d(FALSE, FALSE, 2);
c(s, r, 2);
o := d.Q AND c.Q;
END_PROGRAM
";
    let none = OWN.written("no_event.txt", NO_EVENT);
    for (name, source, from, said) in
        [("below", below, "openplc", "Trap 15 (`c`)"), ("two", two, "iec", "Trap 5 (`c`)")]
    {
        let arguments = ["--from", from, "--to", "logix", "--vars", "o", "--assume", &none, "--budget", "100000"];
        let (code, text) = OWN.compare(&format!("unread_{name}"), source, &arguments);
        assert_eq!(code, Some(1), "{text}");
        assert!(text.contains(said) && !text.contains("Trap 4"), "{text}");
    }
}

/// Programs in which several things part, of which one alone takes the difference away where it is as on the other system.
#[test]
fn what_takes_the_difference_away_is_blamed() {
    let total = "i, tmp, total : INT; a : ARRAY[0..3] OF INT;";
    for (name, variables, body, systems, blamed) in [
        (
            "temporary",
            total,
            "tmp := 1; IF s AND total < 5 THEN total := total + tmp; END_IF; n := total;",
            ("codesys", "iec"),
            "Trap 11 (`total`)",
        ),
        (
            "loop_counter",
            total,
            "FOR i := 0 TO 2 DO IF s AND total < 5 THEN total := total + 1; END_IF; END_FOR; n := total;",
            ("codesys", "iec"),
            "Trap 11 (`total`)",
        ),
        (
            "two_timers",
            "t1, t2 : TON;",
            "t1(IN := s, PT := T#0s); t2(IN := s, PT := T#0s); q := t2.Q;",
            ("iec", "openplc"),
            "Trap 19 (`t2`)",
        ),
        (
            "kept_timer",
            "t : TON; k : INT;",
            "t(IN := s, PT := T#20ms); k := 2; q := t.Q AND k > 1;",
            ("iec", "codesys"),
            "Trap 11 (`t`)",
        ),
        (
            "kept_fall",
            "e : F_TRIG; r : R_TRIG;",
            "e(CLK := s); r(CLK := s); q := e.Q;",
            ("iec", "codesys"),
            "Trap 11 (`e`)",
        ),
        ("kept_edge", "e : R_TRIG;", "e(CLK := s); q := e.Q;", ("codesys", "siemens"), "Trap 11 (`e`)"),
        (
            "kept_timer_beside_a_counter",
            "t : TOF; c : CTU;",
            "t(IN := s, PT := T#20ms); c(CU := s, PV := 3); q := t.Q OR c.Q;",
            ("iec", "logix"),
            "Trap 11 (`t`)",
        ),
        (
            "lost_beside_a_counter",
            "k : INT; l : BOOL; c : CTUD;",
            "IF s AND k < 2 THEN k := k + 1; END_IF; l := l OR s; c(CU := NOT s, CD := l, RESET := s, LOAD := FALSE, PV := 1); q := k = 2 AND c.CV > 0;",
            ("codesys", "iec"),
            "Trap 11 (`k`)",
        ),
        ("two_falls", "a, b : F_TRIG;", "a(CLK := s); b(CLK := s); q := b.Q;", ("iec", "openplc"), "Trap 16 (`b`)"),
        (
            "timer_and_counter",
            "c : CTD; t : TON;",
            "c(CD := s, LD := FALSE, PV := 3); t(IN := s, PT := T#0s); q := t.Q AND c.Q;",
            ("iec", "openplc"),
            "Trap 19 (`t`)",
        ),
        (
            // A count below 0 does not fit CODESYS' type: what it would be there decides nothing.
            "lost_beside_a_count_below_0",
            "c : CTD; was : BOOL;",
            "q := was; c(CD := TRUE, LOAD := s, PV := 2); was := c.CV <= 0;",
            ("codesys", "iec"),
            "Trap 11 (`was`)",
        ),
        (
            "beside_an_idle_counter",
            "total, layer : CTU;",
            "total(CU := s, R := FALSE, PV := 100); layer(CU := s, R := FALSE, PV := 2); q := layer.Q OR total.Q;",
            ("iec", "logix"),
            "Trap 5 (`layer`)",
        ),
        (
            "counter_that_loads_another",
            "a : CTU; b : CTD;",
            "a(CU := s, R := FALSE, PV := 1); b(CD := FALSE, LD := a.Q, PV := 3); q := b.Q;",
            ("iec", "logix"),
            "Trap 5 (`a`)",
        ),
        (
            // Of the three counts, Logix would have one more if it counted what is TRUE at the start.
            "level_from_the_start",
            "c : CTU;",
            "c(CU := s, RESET := FALSE, PV := 3); q := c.Q;",
            ("cscape", "logix"),
            "Trap 1 (`c`)",
        ),
        (
            "edge_at_the_start",
            "c : CTU;",
            "c(CU := s, RESET := FALSE, PV := 1); q := c.Q;",
            ("cscape", "logix"),
            "Trap 5 (`c`)",
        ),
        (
            "negative_load",
            "c : CTD;",
            "c(CD := FALSE, LOAD := s, PV := -2); q := c.Q;",
            ("cscape", "logix"),
            "Trap 21 (`c`)",
        ),
        ("negative_load_of_a_block", "c : CTD;", "c(FALSE, s, -2); q := NOT c.Q;", ("iec", "cscape"), "Trap 21 (`c`)"),
        (
            "fall_and_counter",
            "c : CTD; e : F_TRIG;",
            "c(CD := s, LD := FALSE, PV := 4); e(CLK := NOT s); q := e.Q AND c.Q;",
            ("iec", "openplc"),
            "Trap 16 (`e`)",
        ),
    ] {
        let (from, to) = systems;
        let source = program(variables, body);
        let (code, text) = OWN.compare(name, &source, &["--from", from, "--to", to, "--vars", "q,n"]);
        assert!(code == Some(1) && text.contains(blamed), "{name}: {text}");
    }
}

/// What an event has parted is shown, where it is not compared, too.
#[test]
fn a_variable_that_is_not_compared_is_not_said_to_be_the_same() {
    let source = "PROGRAM p\nVAR_INPUT start, pulse : BOOL; END_VAR\nVAR_OUTPUT valve : BOOL; END_VAR\n\
                  VAR dose : CTD; e : R_TRIG; busy : BOOL; END_VAR\ne(CLK := start); IF e.Q THEN busy := TRUE; END_IF;\n\
                  dose(CD := pulse AND busy, LD := e.Q, PV := 2); IF dose.Q THEN busy := FALSE; END_IF; valve := busy;\nEND_PROGRAM\n";
    let (code, text) = OWN.compare("uncompared", source, &["--from", "openplc", "--to", "codesys", "--vars", "valve"]);
    let (_, after) = text.split_once("`busy` (retention").expect("it is listed");
    let said = after.lines().nth(1).unwrap_or_default();
    assert!(code == Some(1) && said.contains("reachable after 2 scans: trap 11"), "{text}");
}

/// With an input, and outputs that are compared.
fn program(variables: &str, body: &str) -> String {
    format!(
        "PROGRAM p VAR_INPUT s : BOOL; END_VAR VAR_OUTPUT q : BOOL; n : INT; END_VAR VAR {variables} END_VAR\n{body}\nEND_PROGRAM\n"
    )
}

/// What a COUNTER of Logix is given, and what RES takes from it, is not seen at pins.
#[test]
fn what_makes_a_count_of_logix_another_is_blamed() {
    let assumed = OWN.written("no_event.txt", NO_EVENT);
    for (name, variables, body, (from, to), blamed) in [
        // RES takes the edge from the input, which then counts: its own output may as well be what resets.
        (
            "reset_by_its_own_output",
            "c : CTU; later : BOOL;",
            "c(CU := s AND later, R := c.Q, PV := 2); later := TRUE; q := c.Q;",
            ("iec", "logix"),
            "Trap 6 (`c`)",
        ),
        // Q and DN part before the counts do: what differs in the end is the count.
        (
            "a_count_beside_an_output",
            "c : CTU; full : BOOL;",
            "c(CU := s, R := FALSE, PV := 0); full := c.Q; q := c.CV > 0;",
            ("openplc", "logix"),
            "Trap 15 (`c`)",
        ),
        (
            "a_count_as_a_preset",
            "c : CTU; d : CTD;",
            "d(CD := s, LD := FALSE, PV := 3); c(CU := s, R := FALSE, PV := d.CV); q := c.CV > 0;",
            ("siemens", "logix"),
            "Trap 5 (`c`)",
        ),
        // The load wins: what `d` does itself does not count.
        (
            "loaded_from_another",
            "up : CTU; d : CTD;",
            "up(CU := s, R := FALSE, PV := 3); d(CD := s, LD := s, PV := up.CV); q := d.CV > 0;",
            ("openplc", "logix"),
            "Trap 5 (`up`)",
        ),
        // RES makes the whole structure anew.
        (
            "read_before_it_is_called",
            "c, d : CTU; m : BOOL;",
            "d(CU := FALSE, R := TRUE, PV := 0); IF c.Q OR s THEN m := TRUE; END_IF; IF d.Q THEN m := FALSE; END_IF; \
             c(CU := s, R := FALSE, PV := 1); q := m;",
            ("iec", "logix"),
            "Trap 13 (`d`)",
        ),
        (
            "below_zero_after_a_load",
            "d : CTD;",
            "d(CD := NOT s, LOAD := s, PV := -2); q := d.CV < -2;",
            ("cscape", "logix"),
            "Trap 3 (`d`)",
        ),
        // It loads itself when it is empty: not before it was called once.
        (
            "read_before_the_first_call",
            "d : CTD;",
            "d(CD := s, LD := d.Q, PV := 2); q := d.Q;",
            ("iec", "logix"),
            "Trap 22 (`d`)",
        ),
        // The prescan has taken the input for one that was TRUE.
        (
            "called_later",
            "c : CTU; auto : BOOL;",
            "IF auto THEN c(CU := s, R := FALSE, PV := 1); END_IF; auto := TRUE; q := c.Q;",
            ("iec", "logix"),
            "Trap 5 (`c`)",
        ),
    ] {
        let options = ["--from", from, "--to", to, "--vars", "q,n", "--assume", &assumed];
        let (code, text) = OWN.compare(name, &program(variables, body), &options);
        assert!(code == Some(1) && text.contains(blamed), "{name}: {text}");
    }
}

/// `no run` is about the event, and does not make a variable `run` an input.
#[test]
fn an_event_that_does_not_happen_is_no_variable() {
    let source = "PROGRAM p\nVAR_INPUT start : BOOL; END_VAR\nVAR run : BOOL; c : CTU; v : INT; END_VAR\n\
                  c(CU := run AND c.CV < 2, R := FALSE, PV := 5); v := c.CV; run := start;\nEND_PROGRAM\n";
    let assumed = OWN.written("no_events.txt", NO_EVENT);
    let options = ["--from", "iec", "--to", "logix", "--vars", "v", "--assume", &assumed];
    let (code, text) = OWN.compare("event_and_variable", source, &options);
    assert!(code == Some(0), "{text}");
}
