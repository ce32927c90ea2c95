//! A constant expression has the value that the same expression of variables gives at run time:
//! random expressions, in a dialect that computes at the operands' type and in one that promotes.

use staunch_frontend::{Dialect, Options, Source, Sources, compile};
use staunch_runtime::Context;
use staunch_tests::execute::Executor;
use staunch_tests::leaf::Leaves;
use staunch_witness::random::Random;

const EXPRESSIONS: u64 = 3000;

/// Types and the literals of their values.
const VALUES: [(&str, &[&str]); 14] = [
    ("SINT", &["-128", "-1", "0", "3", "127"]),
    ("INT", &["-32768", "-1", "0", "7", "32767"]),
    ("DINT", &["-2147483648", "-1", "0", "5", "2147483647"]),
    ("LINT", &["-9223372036854775807", "-1", "0", "9", "9223372036854775807"]),
    ("USINT", &["0", "1", "200", "255"]),
    ("UINT", &["0", "1", "40000", "65535"]),
    ("UDINT", &["0", "1", "3000000000", "4294967295"]),
    ("ULINT", &["0", "1", "18446744073709551615"]),
    ("BYTE", &["0", "1", "200", "255"]),
    ("WORD", &["0", "1", "40000", "65535"]),
    ("DWORD", &["0", "1", "3000000000", "4294967295"]),
    ("LWORD", &["0", "1", "18446744073709551615"]),
    ("REAL", &["-1.5", "0.0", "0.1", "16777217.0", "3.0E38"]),
    ("LREAL", &["-2.5", "0.0", "0.1", "9007199254740993.0", "1.0E300"]),
];

#[test]
fn constants_are_computed_as_at_run_time() {
    for dialect in [Dialect::Iec, Dialect::Codesys] {
        let compared = (0..EXPRESSIONS).filter(|seed| is_same(*seed, dialect)).count();
        assert!(compared > 600, "{compared} were compared in {}", dialect.name());
    }
}

/// Whether the expression was compared: `check` refuses those of types that do not meet, and faults.
fn is_same(seed: u64, dialect: Dialect) -> bool {
    let text = program(&mut Random::new(seed));
    let mut sources = Sources::default();
    sources.add(Source::new("program.st", text.clone()));
    let Some(program) = compile(&sources, &Options { dialect, ..Options::default() }).program else { return false };
    let leaves = Leaves::new(&program);
    let mut machine = Executor::Interpreter.machine(&program, "constants").unwrap();
    let end = machine.scan(0, &Context::new(0, true));
    assert!(end.is_ok(), "seed {seed}: {end:?}\n{text}");
    let values = leaves.of(machine.state());
    let of = |name: &str| values.iter().find(|it| it.0 == format!("Main.{name}")).unwrap().1.clone();
    assert_eq!(of("folded"), of("computed"), "seed {seed} in {}\n{text}", dialect.name());
    true
}

fn program(random: &mut Random) -> String {
    let (mut constants, mut variables) = (String::new(), String::new());
    for name in 0..4 {
        let (ty, values) = random.one_of(&VALUES);
        let value = random.one_of(values);
        constants += &format!("c{name} : {ty} := {value}; ");
        variables += &format!("v{name} : {ty} := {value}; ");
    }
    let expression = expression(random, 3);
    // What is stored depends on the type of the expression, what is converted on its value.
    let (ty, value) = match random.below(3) {
        0 => ("LREAL", format!("TO_LREAL({expression})")),
        1 => ("LINT", format!("TO_LINT({expression})")),
        _ => (random.one_of(&VALUES).0, expression),
    };
    format!(
        "PROGRAM Main\nVAR CONSTANT {constants}END_VAR\nVAR {variables}folded, computed : {ty}; END_VAR\n\
         folded := {};\ncomputed := {};\nEND_PROGRAM\n",
        value.replace('$', "c"),
        value.replace('$', "v"),
    )
}

/// With `$` before the number of each operand.
fn expression(random: &mut Random, depth: usize) -> String {
    if depth == 0 || random.below(5) == 0 {
        return match random.below(4) {
            0 => (*random.one_of(&["0", "1", "2", "100"])).to_owned(),
            _ => format!("${}", random.below(4)),
        };
    }
    let mut operand = || expression(random, depth - 1);
    let (a, b) = (operand(), operand());
    match random.below(12) {
        0 => format!("(-{a})"),
        1 => format!("ABS({a})"),
        2 => format!("MAX({a}, {b})"),
        3 => format!("SEL({a} < {b}, {b}, {a})"),
        4 => format!("({a} AND {b})"),
        5 => format!("(NOT {a})"),
        6 => format!("({a} / {b})"),
        7 => format!("({a} MOD {b})"),
        8 | 9 => format!("({a} * {b})"),
        10 => format!("({a} - {b})"),
        _ => format!("({a} + {b})"),
    }
}
