//! `fmt`: sources laid out in place, to standard output, or not at all.

use super::{Folder, has};

const UGLY: &str = "program Main\nvar a:int; bc:BOOL; end_var\nif bc then a:=a+1;\nend_if\nend_program\n";
const NEAT: &str = "PROGRAM Main\nVAR a : INT; bc : BOOL; END_VAR\nIF bc THEN\n    a := a + 1;\nEND_IF\nEND_PROGRAM\n";

#[test]
fn files_are_laid_out_in_place() {
    let folder = Folder::with("fmt_in_place", &[("a.st", UGLY), ("b.st", NEAT)]);
    let ran = folder.staunch("fmt .");
    assert_eq!(ran.code, 0, "{}", ran.err);
    has(&ran.err, &["Formatted a.st"]);
    assert!(!ran.err.contains("b.st"), "{}", ran.err);
    assert_eq!(folder.read("a.st"), NEAT);
    assert_eq!(folder.staunch("fmt a.st b.st").err, "");
}

#[test]
fn standard_input_goes_to_standard_output() {
    let folder = Folder::new("fmt_input");
    let ran = folder.with_input("fmt -", UGLY);
    assert_eq!((ran.code, &*ran.out), (0, NEAT));
}

#[test]
fn check_and_diff_write_nothing() {
    let folder = Folder::with("fmt_check", &[("a.st", UGLY), ("b.st", NEAT)]);
    let ran = folder.staunch("fmt --check a.st b.st");
    assert_eq!(ran.code, 1);
    assert_eq!(ran.err, "a.st: not laid out as `staunch fmt` does\n");
    assert_eq!(folder.staunch("fmt --check b.st").code, 0);
    let ran = folder.staunch("fmt --diff a.st b.st");
    assert_eq!(ran.code, 0);
    has(&ran.out, &["-if bc then a:=a+1;\n-end_if\n"]);
    has(&ran.out, &["+IF bc THEN\n+    a := a + 1;\n"]);
    assert_eq!(folder.staunch("fmt --check --diff a.st").code, 1);
    assert_eq!(folder.read("a.st"), UGLY);
}

#[test]
fn the_project_has_the_style() {
    let toml = "files = [\"a.st\"]\n[fmt]\nindent = \"tab\"\nkeywords = \"lower\"\nwidth = 80\nindent-pous = true\n";
    let folder = Folder::with("fmt_style", &[("staunch.toml", toml), ("a.st", UGLY)]);
    assert_eq!(folder.staunch("fmt").code, 0);
    has(&folder.read("a.st"), &["program Main\n\tvar a : int; bc : bool; end_var\n\tif bc then\n\t\ta := a + 1;\n"]);
    for (setting, message) in [
        ("indent = 0", "staunch.toml:1: `indent` must be a number of spaces, 1 to 16, or \"tab\""),
        ("width = 20", "`width` is 20: expected 40 to 400 columns"),
        ("keyword = \"upper\"", "`[fmt]` has no setting `keyword`; did you mean `keywords`?"),
    ] {
        folder.write("staunch.toml", format!("[fmt]\n{setting}\n"));
        let ran = folder.staunch("fmt a.st");
        assert_eq!(ran.code, 2);
        has(&ran.err, &[message]);
    }
}

#[test]
fn the_text_in_a_file_of_twincat_is_laid_out_and_the_rest_stays() {
    let file = |declaration: &str, body: &str| {
        format!(
            "\u{feff}<?xml version=\"1.0\"?>\r\n<TcPlcObject Version=\"1.1\">\r\n  <POU Name=\"Main\" Id=\"{{1}}\" SpecialFunc=\"None\">\r\n    \
             <Declaration><![CDATA[{declaration}]]></Declaration>\r\n    <Implementation>\r\n      <ST><![CDATA[{body}]]></ST>\r\n    \
             </Implementation>\r\n  </POU>\r\n</TcPlcObject>"
        )
    };
    let folder = Folder::new("fmt_twincat");
    folder.write(
        "Main.TcPOU",
        file("PROGRAM Main\r\nVAR\r\nn:INT;\r\nlonger:BOOL;\r\nEND_VAR\r\n", "if longer then\r\nn:=n+1;\r\nend_if"),
    );
    assert_eq!(folder.staunch("fmt Main.TcPOU").code, 0);
    let expected = file(
        "PROGRAM Main\r\nVAR\r\n    n      : INT;\r\n    longer : BOOL;\r\nEND_VAR\r\n",
        "IF longer THEN\r\n    n := n + 1;\r\nEND_IF",
    );
    assert_eq!(folder.read("Main.TcPOU"), expected);
    assert_eq!(folder.staunch("check Main.TcPOU").code, 0);
}

#[test]
fn the_encoding_stays() {
    let folder = Folder::new("fmt_encoding");
    // Windows-1252: `°` and `€` are one byte each.
    folder.write("a.st", b"x:=1; // 20 \xB0C, 5 \x80\n");
    assert_eq!(folder.staunch("fmt a.st").code, 0);
    assert_eq!(std::fs::read(folder.0.join("a.st")).unwrap(), b"x := 1; // 20 \xB0C, 5 \x80\n");
    let wide = |text: &str| -> Vec<u8> {
        [0xFEFF].into_iter().chain(text.encode_utf16()).flat_map(u16::to_be_bytes).collect()
    };
    folder.write("b.st", wide("x:=1; // °\n"));
    assert_eq!(folder.staunch("fmt b.st").code, 0);
    assert_eq!(std::fs::read(folder.0.join("b.st")).unwrap(), wide("x := 1; // °\n"));
}

#[test]
fn files_of_other_editors_are_refused_by_name_and_passed_over_in_folders() {
    let export = "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n<project xmlns=\"http://www.plcopen.org/xml/tc6_0201\"></project>\n";
    let folder = Folder::with("fmt_foreign", &[("p.st", export), ("a.st", NEAT)]);
    let ran = folder.staunch("fmt p.st");
    assert_eq!(ran.code, 1);
    has(&ran.err, &["p.st: this file of another system is not laid out"]);
    assert_eq!(folder.staunch("fmt .").code, 0);
    assert_eq!(folder.read("p.st"), export);
    assert_eq!(folder.staunch("fmt none.st").code, 2);
}

#[test]
fn a_file_with_mistakes_is_laid_out() {
    let folder = Folder::with("fmt_mistakes", &[("a.st", "PROGRAM Main\nx:=;\nIF a THEN\ny:=(1;\nEND_IF\n")]);
    assert_eq!(folder.staunch("fmt a.st").code, 0);
    assert_eq!(folder.read("a.st"), "PROGRAM Main\nx :=;\nIF a THEN\n    y := (1;\nEND_IF\n");
}
