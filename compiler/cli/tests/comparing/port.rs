//! What is written for another system: COUNTER tags and instructions of Logix, pins by their names there.

use super::programs::{Folder, NO_EVENT, command, difference, printed, run, text, written};
use std::path::Path;
use std::process::Output;

const OWN: Folder = Folder("port");

/// No flag of Logix is Q of a CTD, which is TRUE while nothing is left: DN is TRUE while ACC >= PRE (1756-RM003, "CTD").
#[test]
fn the_port_of_a_ctd_asks_for_what_is_left() {
    let source = "PROGRAM p
VAR_INPUT s, ld : BOOL; END_VAR
VAR RETAIN k : CTD; e : R_TRIG; END_VAR
VAR_OUTPUT empty, some : BOOL; END_VAR
e(CLK := s); k(CD := e.Q, LD := ld, PV := 3, Q => empty);
some := NOT k.Q;
END_PROGRAM
";
    let file = OWN.path().join("port.st").display().to_string();
    let arguments = ["--from", "iec", "--to", "logix", "--vars", "empty,some", "--write", &file];
    let (_, text) = OWN.compare("ctd", source, &arguments);
    assert!(!text.contains("Trap 4"), "{text}");
    let port = std::fs::read_to_string(&file).expect("it is written");
    assert!(port.contains("empty := k.ACC <= 0") && port.contains("some := NOT (k.ACC <= 0);"), "{port}");
}

/// What is written for Logix says which of its lines are rungs in Studio 5000: CTU, CTD and RES are there in ladder only.
#[test]
fn what_is_written_says_what_is_ladder() {
    let source = "PROGRAM p
VAR_INPUT s, r : BOOL; END_VAR
VAR c : CTU; END_VAR
c(CU := s, R := r, PV := 3);
END_PROGRAM
";
    let path = OWN.written("ladder.st", source);
    let file = OWN.path().join("written.st").display().to_string();
    let arguments = ["--from", "iec", "--to", "logix", "--write", &file];
    let said = printed(&command().arg(&path).args(arguments).output().expect("it starts"));
    assert!(said.contains("Studio 5000 has CTU and RES only in ladder") && said.contains("(line 4)"), "{said}");
}

/// A counter that is inherited is rewritten for Logix where an heir calls it.
#[test]
fn an_inherited_counter_is_written_for_logix() {
    let source = "FUNCTION_BLOCK A
VAR c : CTU; END_VAR
VAR_INPUT x : BOOL; END_VAR
END_FUNCTION_BLOCK
FUNCTION_BLOCK B EXTENDS A
VAR_OUTPUT n : INT; END_VAR
c(CU := x, PV := 3);
n := WORD_TO_INT(c.CV);
END_FUNCTION_BLOCK
PROGRAM P
VAR_INPUT i : BOOL; END_VAR
VAR b : B; END_VAR
VAR_OUTPUT q : INT; END_VAR
b(x := i); q := b.n;
END_PROGRAM
";
    let (code, text) = OWN.compare("inherited", source, &["--from", "codesys", "--to", "logix"]);
    assert_eq!(code, Some(1), "{text}");
    assert!(text.contains("+ c.PRE := 3; CTU(c, x);") && text.contains("codesys and logix differ after"), "{text}");
}

/// Reset wins over the load on IEC, OPENPLC, CODESYS and S7; the port loads after CTUD, which has reset before it. A program that it
/// resets and loads may read the counter itself, as it was before the call.
#[test]
fn the_port_of_a_ctud_lets_reset_win_over_load() {
    let none = OWN.written("no_event.txt", NO_EVENT);
    let arguments = ["--to", "logix", "--vars", "o", "--assume", &none, "--from"];
    OWN.written("level/staunch.toml", "s7-ld = \"level\"\n");
    for from in ["iec", "openplc", "siemens", "codesys"] {
        for (name, load) in [("plain", "l"), ("both", "l OR r"), ("own", "c.CV = 0 AND l")] {
            let source = format!(
                "PROGRAM p
VAR_INPUT r, l : BOOL; END_VAR
VAR_OUTPUT o : BOOL; END_VAR
VAR c : CTUD; END_VAR
c(FALSE, FALSE, r, {load}, 3);
o := c.CV > 0;
END_PROGRAM
"
            );
            let (code, text) =
                OWN.compare(&format!("level/{name}_{from}"), &source, &[&arguments[..], &[from]].concat());
            assert_eq!(code, Some(0), "{from}: {text}");
        }
    }
}

/// A load on Logix comes after CTUD, which evaluates DN: QU is asked of the count.
#[test]
fn the_port_of_a_loaded_ctud_asks_for_the_count() {
    let none = OWN.written("no_event.txt", NO_EVENT);
    let loaded = "PROGRAM p
VAR_INPUT l : BOOL; END_VAR
VAR_OUTPUT o, q : BOOL; END_VAR
VAR c : CTUD; END_VAR
c(FALSE, FALSE, FALSE, l, 3, QU => q);
o := c.QU;
END_PROGRAM
";
    let arguments = ["--from", "iec", "--to", "logix", "--vars", "o,q", "--assume", &none];
    let (code, text) = OWN.compare("loaded", loaded, &arguments);
    assert_eq!(code, Some(0), "{text}");
    assert!(text.contains("o := (c.ACC >= c.PRE);") && text.contains("q := c.ACC >= c.PRE;"), "{text}");
    let (_, text) = OWN.compare("not_loaded", &loaded.replace(", l, 3", ", FALSE, 3"), &arguments);
    assert!(text.contains("o := c.DN;"), "{text}");
}

#[test]
fn initial_values_are_rewritten_for_logix() {
    let out = difference("initial.st --from iec --to logix");
    assert!(out.contains("c : COUNTER := (ACC := 32766, PRE := 3, DN := TRUE);"), "{out}");
    assert!(out.contains("d : COUNTER := (CD := FALSE, ACC := 2, PRE := 3);"), "{out}");
    assert!(out.contains("e : FBD_COUNTER := (ACC := 2, DN := FALSE, CUEnable := TRUE, Reset := TRUE);"), "{out}");
    assert!(out.contains("f : COUNTER;"), "{out}");
    assert!(out.contains("again := e.CUEnable;"), "{out}");
    assert!(out.contains(" differ after "), "{out}");
}

#[test]
fn a_rewritten_program_is_compared_with_the_first() {
    let out = difference("start_up.st --from iec --to logix");
    assert!(out.contains("LOGIX needs the program rewritten; compared as:"), "{out}");
    assert!(out.contains("  + parts.PRE := 3; CTU(parts, sensor);"), "{out}");
    assert!(difference("start_up.st --from iec --to logix --against rewritten.st").contains("Trap 5"));
}

#[test]
fn what_is_written_is_the_other_systems() {
    let folder = written(
        "write.st",
        "{dialect 'iec'}\nPROGRAM p VAR_INPUT s : BOOL; END_VAR VAR c : CTU; END_VAR c(s, FALSE, 3); END_PROGRAM\n",
    );
    let target = folder.with_file_name("write_logix.st");
    let _ = std::fs::remove_file(&target);
    run(&format!("{} --from iec --to logix --write {} --budget 2000", folder.display(), target.display()));
    let text_written = std::fs::read_to_string(&target).expect("it is written");
    assert!(text_written.starts_with("{dialect 'logix'}"), "{text_written}");
    let of_user = run(&format!("held.st --from iec --to cscape --against held.st --write {}", target.display()));
    assert_eq!(of_user.status.code(), Some(2), "{}", text(&of_user.stderr));
}

fn check(dialect: &str, path: &Path) -> Output {
    let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_staunch"));
    command.args(["check", "--dialect", dialect]).arg(path).output().expect("the command starts")
}

/// The program as it is written for another system; `None` where nothing is.
fn migrated(source: &Path, to: &str) -> Option<String> {
    let target = source.with_extension(format!("{to}.out"));
    let _ = std::fs::remove_file(&target);
    run(&format!("{} --from iec --to {to} --write {} --budget 2000", source.display(), target.display()));
    let found = std::fs::read_to_string(&target).ok()?;
    let checked = check(to, &target);
    assert_eq!(checked.status.code(), Some(0), "{to}: {found}{}", text(&checked.stderr));
    Some(found)
}

#[test]
fn pins_have_the_other_systems_names_in_what_is_written() {
    let source = written(
        "write_pins.st",
        "{dialect := 'iec'}\nFUNCTION_BLOCK F VAR_INPUT a : BOOL; END_VAR VAR c : ARRAY[1..2] OF CTU; d : CTD; END_VAR\n\
         c[1](CU := a, R := c[1].Q, PV := 3); c[2](CU := a, (* R := *) R := FALSE, PV := 4);\n\
         d(CD := a, LD := c[2].R, PV := 3);\nEND_FUNCTION_BLOCK\n\
         PROGRAM p VAR_INPUT a : BOOL; END_VAR VAR f, g : F; END_VAR f(a := a); g(a := NOT a); END_PROGRAM\n",
    );
    for (to, load) in [("cscape", "LOAD := c[2].RESET"), ("codesys", "LOAD := c[2].RESET"), ("openplc", "LD := c[2].R")]
    {
        let found = migrated(&source, to).expect("it is written");
        assert!(found.starts_with(&format!("{{dialect '{to}'}}")) && found.contains(load), "{found}");
        assert!(found.contains("(* R := *)"), "{found}");
    }
    assert_eq!(migrated(&source, "logix"), None, "a COUNTER has no reset to read");
    let by_count = written(
        "write_by_count.st",
        "PROGRAM p VAR_INPUT a : BOOL; END_VAR VAR c : ARRAY[0..1] OF CTU; END_VAR\n\
         c[c[0].CV MOD 2](CU := a, R := FALSE, PV := 3);\nEND_PROGRAM\n",
    );
    assert_eq!(migrated(&by_count, "logix"), None, "counting moves the index");
}

#[test]
fn counters_in_arrays_and_structures_are_written_for_logix() {
    let source = written(
        "write_parts.st",
        "TYPE Cell : STRUCT k : CTU := (PV := 2); v : INT; END_STRUCT Pairs : ARRAY[0..1] OF CTU; END_TYPE\n\
         FUNCTION_BLOCK F VAR_OUTPUT c : CTD; END_VAR c(CD := TRUE, LD := FALSE, PV := 1); END_FUNCTION_BLOCK\n\
         PROGRAM p VAR_INPUT a, b : BOOL; END_VAR\n\
         VAR n : ARRAY[0..1] OF CTU := [(PV := 5), (PV := 6, CU := FALSE)]; m : Pairs; s : Cell; t : ARRAY[1..2, 0..1] OF Cell;\n\
         f : F; i, x : INT; full : BOOL; END_VAR\n\
         FOR i := 0 TO 1 DO n[i](CU := a, R := b); m[i](CU := a, R := FALSE, PV := 3, CV => x); END_FOR\n\
         s.k(CU := a, R := t[1, 0].k.Q); t[2, x MOD 2].k(CU := m[s.k.CV MOD 2].Q, R := b, PV := 4);\n\
         f(); full := n[0].Q AND f.c.Q AND s.k.CV = n[1].CV;\nEND_PROGRAM\n",
    );
    let found = migrated(&source, "logix").expect("it is written");
    for line in [
        "STRUCT k : COUNTER := (PRE := 2);",
        "Pairs : ARRAY[0..1] OF COUNTER;",
        "n : ARRAY[0..1] OF COUNTER := [(PRE := 5), (PRE := 6, CU := FALSE)]; m : Pairs; s : Cell;",
        "CTU(n[i], a); RES(n[i], b); m[i].PRE := 3;",
        "RES(s.k, t[1, 0].k.DN)",
        "CTU(t[2, x MOD 2].k, m[DINT_TO_INT(s.k.ACC) MOD 2].DN)",
        "full := n[0].DN AND (f.c.ACC <= 0) AND s.k.ACC = n[1].ACC;",
    ] {
        assert!(found.contains(line), "{line}\n{found}");
    }
}

#[test]
fn what_cannot_be_rewritten_is_refused_with_a_way_that_is_accepted() {
    let wide = |name: &str, ty: &str| {
        written(
            name,
            &format!(
                "PROGRAM p VAR_INPUT a : BOOL; END_VAR VAR c : {ty}; END_VAR c(CU := a, R := FALSE, PV := 3); END_PROGRAM\n"
            ),
        )
    };
    let source = wide("write_wide.st", "CTU_ULINT");
    let refused = run(&format!("{} --from iec --to logix", source.display()));
    let help = "in a program for `logix`, which `--against` compares with this one, name the family: `IEC.CTU_ULINT`";
    assert!(text(&refused.stderr).contains(help), "{}", text(&refused.stderr));
    let named = wide("write_named.st", "IEC.CTU_ULINT");
    let equal = run(&format!(
        "{} --from iec --to logix --against {} --vars c.CV --budget 2000",
        source.display(),
        named.display()
    ));
    assert_ne!(equal.status.code(), Some(2), "{}", text(&equal.stderr));
    let fixed = run(&format!("{} --from iec --to logix", named.display()));
    assert_eq!(fixed.status.code(), Some(2), "{}", text(&fixed.stderr));
}

/// A count is a WORD in CODESYS, and a DINT in Logix, as a preset is.
#[test]
fn a_count_may_be_a_preset() {
    let source = "PROGRAM p\nVAR_INPUT a, b : BOOL; END_VAR\nVAR c, d : CTU; END_VAR\nVAR_OUTPUT full : BOOL; END_VAR\n\
                  c(CU := a, RESET := b, PV := 10); d(CU := b, RESET := FALSE, PV := c.CV); full := d.Q;\nEND_PROGRAM\n";
    let options = ["--from", "codesys", "--to", "logix", "--vars", "full"];
    let (code, text) = OWN.compare("count_as_preset", source, &options);
    assert!(code == Some(1) && text.contains("d.PRE := c.ACC;"), "{text}");
}
