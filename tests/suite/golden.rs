//! Every case below `cases/`, each a test of its own.

use staunch_frontend::{Code, Options, Source, Sources};
use staunch_ir::{Argument, Place, StatementKind, Type, visit};
use staunch_tests::case::{self, Case, Pin};
use staunch_tests::{cases, golden};
use std::collections::BTreeSet;

include!(concat!(env!("OUT_DIR"), "/golden_tests.rs"));

fn check(name: &str) {
    let (cases, _) = case::discover(&cases());
    let case = cases.iter().find(|it| it.name == name).unwrap();
    if let Err(difference) = golden::check(case) {
        panic!("{name}: {difference}");
    }
}

#[test]
fn nothing_lies_about() {
    let (cases, problems) = case::discover(&cases());
    assert!(problems.is_empty(), "{}", problems.join("\n"));
    assert!(cases.len() > 100, "only {} cases", cases.len());
}

/// Each kind of statement, and each way in which a call hands something over, is pinned as IR.
#[test]
fn every_form_of_statement_is_pinned_as_ir() {
    let (cases, _) = case::discover(&cases());
    let mut pinned = BTreeSet::new();
    for case in cases.iter().filter(|it| it.pins.contains(&Pin::Ir)) {
        let program = case.compile().1.program.unwrap();
        for routine in &program.routines {
            visit::statements(&routine.body, &mut |it| {
                pinned.insert(form(&it.kind));
                pinned.extend(handed_over(&it.kind));
            });
        }
    }
    let expected = [
        "assign",
        "if",
        "case",
        "loop",
        "for",
        "turn",
        "exit",
        "continue",
        "return",
        "call",
        "call an instance",
        "call a block",
        "prescan a block",
        "fault",
        "external",
        "hand over a value",
        "hand over a text",
        "hand over a variable",
        "hand over an element",
        "call an element",
    ];
    assert_eq!(pinned, BTreeSet::from(expected));
}

fn form(kind: &StatementKind) -> &'static str {
    match kind {
        StatementKind::Assign { .. } => "assign",
        StatementKind::If { .. } => "if",
        StatementKind::Case { .. } => "case",
        StatementKind::Loop { .. } => "loop",
        StatementKind::For(_) => "for",
        StatementKind::Try { .. } => "try",
        StatementKind::Finally { .. } => "finally",
        StatementKind::Turn => "turn",
        StatementKind::Exit => "exit",
        StatementKind::Continue => "continue",
        StatementKind::Return => "return",
        StatementKind::Call { instance: None, .. } => "call",
        StatementKind::Call { instance: Some(_), .. } => "call an instance",
        StatementKind::CallBlock { .. } => "call a block",
        StatementKind::PrescanBlock { .. } => "prescan a block",
        StatementKind::Stop(_) => "stop",
        StatementKind::Fault(_) => "fault",
        StatementKind::External(_) => "external",
    }
}

fn handed_over(kind: &StatementKind) -> BTreeSet<&'static str> {
    let StatementKind::Call { instance, arguments, .. } = kind else { return BTreeSet::new() };
    let is_element = |place: &Place| place.indices().next().is_some();
    let argument = |it: &Argument| match it {
        Argument::Value(value) if matches!(value.ty, Type::String(_)) => "hand over a text",
        Argument::Value(_) => "hand over a value",
        Argument::Reference(place) if is_element(place) => "hand over an element",
        Argument::Reference(_) => "hand over a variable",
    };
    let element = instance.iter().filter(|it| is_element(it)).map(|_| "call an element");
    arguments.iter().map(argument).chain(element).collect()
}

#[test]
fn every_diagnostic_has_a_case() {
    let (cases, _) = case::discover(&cases());
    let pinned: String = cases.iter().filter(|it| it.pins.contains(&Pin::Diagnostics)).map(errors).collect();
    let shown = |code: &Code| pinned.contains(&format!("[{}]", code.name()));
    let missing: Vec<_> =
        Code::ALL.iter().filter(|it| !shown(it) && !WITHOUT_CASE.contains(it)).map(|it| it.name()).collect();
    assert!(missing.is_empty(), "no case shows {}", missing.join(", "));
}

/// A test below shows the first; the second takes a file of 4 GiB, and the third a stimulus, which the contract of the command
/// line shows. The others are of programs that move to another system, which tests of `compare` show.
const WITHOUT_CASE: [Code; 5] = [Code::E0030, Code::E0031, Code::W0522, Code::W0617, Code::W0618];

#[test]
fn reading_stops_after_many_errors() {
    let mut sources = Sources::default();
    sources.add(Source::new(
        "many.st",
        format!("PROGRAM Main\nVAR x : INT; END_VAR\n{}END_PROGRAM\n", "x = 1;\n".repeat(500)),
    ));
    let compilation = staunch_frontend::compile(&sources, &Options::default());
    let codes: Vec<_> = compilation.diagnostics.iter().map(|it| it.code).collect();
    assert!(codes.contains(&Code::E0030) && codes.len() < 110, "{} diagnostics", codes.len());
}

/// Dropping the bodies that were checked changes no diagnostics.
#[test]
fn check_says_what_compile_says() {
    let (cases, _) = case::discover(&cases());
    let differs = |case: &&Case| !is_said_by_check(case);
    let different: Vec<_> = cases.iter().filter(differs).map(|it| &it.name).collect();
    assert!(different.is_empty(), "{different:?}");
}

fn is_said_by_check(case: &Case) -> bool {
    let (sources, compilation) = case.compile();
    let checked = staunch_frontend::check(&sources, &case.settings().options);
    // What a library declares without a body is enough to check by.
    let said: Vec<_> = compilation.diagnostics.iter().filter(|it| it.code != Code::E0318).collect();
    format!("{checked:?}") == format!("{said:?}")
}

fn errors(case: &Case) -> String {
    case.pinned(Pin::Diagnostics)
}
