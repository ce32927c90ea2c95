//! The library that is written in Structured Text is a part of the programs that name it, and of no others.

use staunch_frontend::{
    Compilation, Declares, Diagnostic, Dialect, LibraryUnit, Options, Severity, Source, Sources, compile, library,
};

fn compiled(text: &str, dialect: Dialect) -> Compilation {
    let mut sources = Sources::default();
    sources.add(Source::new("main.st", text.to_owned()));
    compile(&sources, &Options { dialect, ..Options::default() })
}

/// Each unit alone, with what it needs, compiles without a word about the library, and is on its page.
#[test]
fn every_unit_compiles() {
    let page = include_str!("../../../docs/library.md");
    for unit in library().filter(|it| !it.is_declaration) {
        let name = unit.name;
        expect_compiles(name, &use_of(&unit, 0), &unit);
        assert!(page.contains(&format!("`{name}`")), "{name} is not on the page");
    }
}

/// Vendors' declarations compile, all of a library in one program; the page has constants and enumerators as a whole.
#[test]
fn vendors_declarations_compile() {
    let page = include_str!("../../../docs/library.md");
    let mut programs: std::collections::BTreeMap<&str, (String, LibraryUnit)> = std::collections::BTreeMap::new();
    for (unit, number) in library().filter(|it| it.is_declaration).zip(0..) {
        let (text, _) = programs.entry(unit.libraries[0]).or_insert_with(|| (String::new(), unit));
        text.push_str(&use_of(&unit, number));
        let is_listed = !unit.is_value() && !unit.name.starts_with("__");
        assert!(!is_listed || page.contains(&format!("`{}`", unit.name)), "{} is not on the page", unit.name);
    }
    assert!(programs.len() > 10);
    for (library, (text, unit)) in programs {
        expect_compiles(library, &text, &unit);
    }
}

/// A program, or a part of one, that names a unit.
fn use_of(unit: &LibraryUnit, number: usize) -> String {
    let name = unit.name;
    match unit.declares {
        Declares::Type => format!("VAR_GLOBAL it{number} : {name}; END_VAR\n"),
        // It is included where one of its functions is named.
        Declares::Space if name == "TcUnit.WRITE_PROTECTED" => format!("PROGRAM Main {name}_BOOL(); END_PROGRAM"),
        Declares::Space | Declares::Open => format!("USING {name};"),
        Declares::Function => format!("PROGRAM Main{number} {name}(); END_PROGRAM\n"),
        Declares::Global => format!("PROGRAM Main VAR it : BOOL; END_VAR it := {name}; END_PROGRAM"),
        Declares::Value => format!("VAR_GLOBAL it{number} : ARRAY[0..1] OF LREAL := [{name}]; END_VAR\n"),
    }
}

fn expect_compiles(what: &str, text: &str, unit: &LibraryUnit) {
    let dialect = unit.dialects.first().copied().unwrap_or_default();
    let reported = compiled(text, dialect).diagnostics;
    // A FUNCTION lacks its arguments, and a list is not a value.
    let is_missing =
        |it: &str| it.contains("is not declared") || it.contains("there is no ") || it.contains("the library's `");
    let wrong = reported.iter().filter(|it| it.severity == Severity::Error);
    // What is TcUnit's is named after it.
    let is_qualified = |it: &Option<String>| it.as_ref().is_some_and(|it| it.contains("USING TcUnit"));
    let is_wrong =
        |it: &&Diagnostic| it.span.file > 0 || is_missing(&it.message.to_string()) && !is_qualified(&it.help);
    let wrong: Vec<_> = wrong.filter(is_wrong).collect();
    assert!(wrong.is_empty(), "{what}: {wrong:?}");
}

#[test]
fn a_name_alone_brings_nothing() {
    let texts = [
        "PROGRAM Main VAR pid, blink : INT; END_VAR pid := blink; END_PROGRAM",
        "FUNCTION_BLOCK Mine METHOD PUBLIC PACK END_METHOD END_FUNCTION_BLOCK
PROGRAM Main VAR x : Mine; END_VAR x.PACK(); END_PROGRAM",
        "(* b : BLINK; *) PROGRAM Main END_PROGRAM",
        "TYPE x : INT; POINT : STRUCT a : INT; END_STRUCT; END_TYPE
PROGRAM Main VAR p : POINT; END_VAR p.a := 1; END_PROGRAM",
        "FUNCTION_BLOCK FINAL PID END_FUNCTION_BLOCK PROGRAM Main VAR p : PID; END_VAR p(); END_PROGRAM",
    ];
    for text in texts {
        let compilation = compiled(text, Dialect::Codesys);
        let files = compilation.program.map(|it| it.files.len());
        assert_eq!(files, Some(1), "{text}: {:?}", compilation.diagnostics);
    }
    let of_the_library = compiled("PROGRAM Main VAR p : PID; END_VAR p(); END_PROGRAM", Dialect::Codesys);
    assert!(of_the_library.program.is_some_and(|it| it.files.len() > 1));
}
