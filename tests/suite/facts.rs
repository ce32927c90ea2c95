//! What other compilers' programs computed, as tables of facts: the dialects that follow them compute the same.

use staunch_frontend::{Dialect, Format, Options, Source, Sources, Style, compile, render};
use staunch_ir::{Chars, Value};
use staunch_runtime::Context;
use staunch_tests::execute::Executor;
use staunch_tests::folder;
use staunch_tests::leaf::{Leaves, Read};
use std::fmt::Write;

/// Rows of one program.
const ROWS: usize = 250;

/// Native code is made of each so many programs.
const NATIVE: usize = 4;

const TYPES: [&str; 19] = [
    "BOOL", "SINT", "INT", "DINT", "LINT", "USINT", "UINT", "UDINT", "ULINT", "BYTE", "WORD", "DWORD", "LWORD", "REAL",
    "LREAL", "TIME", "DATE", "TOD", "DT",
];

#[test]
fn openplc_computes_as_matiec() {
    holds("matiec.tsv", Dialect::Openplc, 4000);
}

#[test]
fn openplc4_computes_as_strucpp() {
    holds("strucpp.tsv", Dialect::Openplc4, 6000);
}

struct Fact<'t> {
    expression: &'t str,
    ty: &'t str,
    value: &'t str,
}

fn holds(table: &str, dialect: Dialect, least: usize) {
    let text = std::fs::read_to_string(folder().join("facts").join(table)).unwrap();
    let facts: Vec<_> = text.lines().filter(|it| !it.starts_with('#')).map(fact).collect();
    assert!(facts.len() > least, "{table} has {} rows", facts.len());
    let mut wrong = Vec::new();
    for (number, facts) in facts.chunks(ROWS).enumerate() {
        wrong.extend(differences(facts, dialect, Executor::Interpreter));
        if number % NATIVE == 0 {
            wrong.extend(differences(facts, dialect, Executor::Native));
        }
    }
    assert!(wrong.is_empty(), "{} rows of {table} do not hold\n{}", wrong.len(), wrong.join("\n"));
}

fn fact(line: &str) -> Fact<'_> {
    let mut cells = line.split('\t');
    let mut next = || cells.next().expect("a row is an expression, a type and a value");
    Fact { expression: next(), ty: next(), value: next() }
}

fn differences(facts: &[Fact<'_>], dialect: Dialect, executor: Executor) -> Vec<String> {
    let mut sources = Sources::default();
    sources.add(Source::new("facts.st", program(facts)));
    let compiled = compile(&sources, &Options { dialect, ..Options::default() });
    let Some(program) = &compiled.program else {
        let shown = compiled.diagnostics.iter().map(|it| render(it, &sources, Format::Human, Style::default()));
        return shown.collect();
    };
    let mut machine = executor.machine(program, "facts").unwrap();
    let end = machine.scan(0, &Context::new(0, true));
    assert!(end.is_ok(), "{end:?}");
    let leaves = Leaves::new(program).values(machine.state());
    let mut wrong = Vec::new();
    for (number, fact) in facts.iter().enumerate() {
        let path = format!("Main.r{number}");
        let leaf = leaves.iter().find(|it| it.path == path).expect("the variable of the row");
        if !is_value(&leaf.value, fact.value) {
            let Fact { expression, ty, value } = fact;
            wrong.push(format!("{expression} as {ty} is {value}, here {:?} ({executor:?})", leaf.value));
        }
    }
    wrong
}

fn is_value(found: &Read, expected: &str) -> bool {
    match found {
        Read::Scalar(Value::Bool(it)) => expected == if *it { "TRUE" } else { "FALSE" },
        Read::Scalar(Value::F32(it)) => {
            expected.parse().is_ok_and(|other: f32| it.to_bits() == other.to_bits() || it.is_nan() && other.is_nan())
        }
        Read::Scalar(Value::F64(it)) => {
            expected.parse().is_ok_and(|other: f64| it.to_bits() == other.to_bits() || it.is_nan() && other.is_nan())
        }
        Read::Scalar(it) => it.as_integer().is_some_and(|it| it.to_string() == expected),
        Read::Text(Chars::Narrow(bytes)) => literal(bytes) == expected,
        Read::Text(Chars::Wide(_)) => false,
    }
}

/// A whole number with its type: what one without a type is, depends on the system.
fn typed(ty: &str, value: &str) -> String {
    let is_number = value.strip_prefix('-').unwrap_or(value).bytes().all(|it| it.is_ascii_digit());
    if is_number && ["INT", "WORD"].iter().any(|it| ty.ends_with(it)) {
        format!("{ty}#{value}")
    } else {
        value.to_owned()
    }
}

fn literal(bytes: &[u8]) -> String {
    let one = |it: &u8| match it {
        b'$' | b'\'' | 0..=31 | 127.. => format!("${it:02X}"),
        it => char::from(*it).to_string(),
    };
    format!("'{}'", bytes.iter().map(one).collect::<String>())
}

/// A program that assigns each expression to a variable.
fn program(facts: &[Fact<'_>]) -> String {
    let (mut variables, mut results, mut body) = (Vec::new(), String::new(), String::new());
    for (number, fact) in facts.iter().enumerate() {
        let expression = with_variables(fact.expression, &mut variables);
        writeln!(results, "r{number} : {};", fact.ty).unwrap();
        writeln!(body, "r{number} := {expression};").unwrap();
    }
    let declared: String = variables
        .iter()
        .enumerate()
        .map(|(at, (ty, value))| format!("v{at} : {ty} := {};\n", typed(ty, value)))
        .collect();
    format!("PROGRAM Main\nVAR\n{declared}{results}END_VAR\n{body}END_PROGRAM\n")
}

/// The expression with a variable for each literal that has a type.
fn with_variables(expression: &str, variables: &mut Vec<(String, String)>) -> String {
    let (mut text, mut rest) = (String::new(), expression);
    while !rest.is_empty() {
        let length = literal_length(rest);
        if length == 0 {
            let word =
                rest.find(|it: char| !it.is_ascii_alphanumeric() && it != '_' && it != '#').unwrap_or(rest.len());
            let (before, after) = rest.split_at(word.max(1));
            text.push_str(before);
            rest = after;
            continue;
        }
        let (written, after) = rest.split_at(length);
        let variable = match written.split_once('#') {
            Some((ty, _)) if matches!(ty, "TIME" | "DATE" | "TOD" | "DT") => (ty.to_owned(), written.to_owned()),
            Some((ty, value)) if TYPES.contains(&ty) => (ty.to_owned(), value.to_owned()),
            _ => ("STRING".to_owned(), written.to_owned()),
        };
        let at = variables.iter().position(|it| *it == variable).unwrap_or_else(|| {
            variables.push(variable);
            variables.len() - 1
        });
        write!(text, "v{at}").unwrap();
        rest = after;
    }
    text
}

/// How long the literal is that the text begins with, if it has a type.
fn literal_length(text: &str) -> usize {
    if let Some(inner) = text.strip_prefix('\'') {
        return inner.find('\'').map_or(0, |it| it + 2);
    }
    let Some((ty, value)) = text.split_once('#') else { return 0 };
    if !TYPES.contains(&ty) {
        return 0;
    }
    let end = value.find([' ', ',', '(', ')']).unwrap_or(value.len());
    ty.len() + 1 + end
}
