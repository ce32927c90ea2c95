//! What a program declares is what its name means, whatever the compiler knows by that name: each word in the compiler's
//! sources that could be a name is declared by programs, in each dialect, in each way.

use staunch_frontend::{Dialect, Options, Severity, Source, Sources, compile};
use staunch_runtime::Context;
use staunch_tests::execute::Executor;
use staunch_tests::leaf::Leaves;
use staunch_tests::project;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// How many names a program declares.
const PART: usize = 50;

/// A way to declare a name: `$` is the name, and `#` its number.
struct Way {
    what: &'static str,
    /// A line for each name, before the PROGRAM; around these lines.
    declared: [&'static str; 3],
    /// A line for each name among the PROGRAM's variables.
    variable: &'static str,
    /// A line for each name in its body.
    used: &'static str,
    result: &'static str,
}

/// Words of the language that are read as what they mean in it, and reported where they are used.
const OF_THE_LANGUAGE: [&str; 4] = ["STRING", "SUPER", "THIS", "WSTRING"];

const BLOCK: &str = "FUNCTION_BLOCK Own_Block VAR_INPUT v_in : INT; END_VAR VAR_OUTPUT v_out : INT; END_VAR \
    v_out := v_out + v_in; END_FUNCTION_BLOCK";

const WAYS: [Way; 6] = [
    Way {
        what: "a FUNCTION",
        declared: ["", "FUNCTION $ : INT VAR_INPUT v_in : INT; END_VAR $ := v_in + 7; END_FUNCTION", ""],
        variable: "",
        used: "r_# := $(3); r_# := r_# + $(v_in := 4);",
        result: "21",
    },
    Way {
        what: "a FUNCTION_BLOCK",
        declared: [
            "",
            "FUNCTION_BLOCK $ VAR_INPUT v_in : INT; END_VAR VAR_OUTPUT v_out : INT; END_VAR v_out := v_in + 7; END_FUNCTION_BLOCK",
            "",
        ],
        variable: "i_# : $;",
        used: "i_#(v_in := 3); r_# := i_#.v_out;",
        result: "10",
    },
    Way {
        what: "a variable",
        declared: ["", "", ""],
        variable: "$ : INT := 8;",
        used: "r_# := $ + 1; $ := r_# + 1; r_# := $;",
        result: "10",
    },
    Way {
        what: "an instance",
        declared: [BLOCK, "", ""],
        variable: "$ : Own_Block;",
        used: "$(v_in := 3); $(); r_# := $.v_out;",
        result: "6",
    },
    Way {
        what: "a METHOD",
        declared: [
            "FUNCTION_BLOCK Own_Block",
            "METHOD PUBLIC $ : INT VAR_INPUT v_in : INT; END_VAR $ := v_in + 7; END_METHOD",
            "END_FUNCTION_BLOCK",
        ],
        variable: "i_# : Own_Block;",
        used: "r_# := i_#.$(3); r_# := r_# + i_#.$(v_in := 4);",
        result: "21",
    },
    Way {
        what: "a member",
        declared: ["TYPE Own_Type : STRUCT", "$ : INT;", "END_STRUCT; END_TYPE"],
        variable: "i_# : Own_Type;",
        used: "i_#.$ := 4; r_# := i_#.$ + 1;",
        result: "5",
    },
];

#[test]
fn what_a_program_declares_is_what_its_name_means() {
    let words: Vec<_> = words().into_values().collect();
    assert!(words.len() > 1000, "{} words", words.len());
    let mut wrong = Vec::new();
    for dialect in Dialect::ALL {
        for way in &WAYS {
            let declared: usize = words.chunks(PART).map(|part| try_all(dialect, way, part, &mut wrong)).sum();
            let of = format!("{}: {declared} of {} words are {}", dialect.name(), words.len(), way.what);
            assert!(declared * 10 > words.len() * 9, "{of}");
        }
    }
    assert!(wrong.is_empty(), "{} are not what the program declares:\n{}", wrong.len(), wrong.join("\n"));
}

/// The words between the quotes of the syntax's, the front end's and the runtime's sources, each in one spelling.
fn words() -> BTreeMap<String, String> {
    let mut found = BTreeMap::new();
    for folder in ["compiler/syntax/src", "compiler/frontend/src", "runtime/core/src"] {
        read(&project().join(folder), &mut found);
    }
    found
}

fn read(path: &Path, found: &mut BTreeMap<String, String>) {
    if path.is_dir() {
        return std::fs::read_dir(path).unwrap().for_each(|it| read(&it.unwrap().path(), found));
    }
    if path.extension().is_some_and(|it| it == "rs") {
        let text = std::fs::read_to_string(path).unwrap();
        let words = text.split('"').filter(|it| is_name(it));
        found.extend(words.map(|it| (it.to_ascii_uppercase(), it.to_owned())));
    }
}

fn is_name(word: &str) -> bool {
    let is_ours = ["own_", "v_in", "v_out", "main"].iter().any(|it| word.to_ascii_lowercase().starts_with(it));
    let is_one = word.starts_with(|it: char| it.is_ascii_alphabetic()) && !word.ends_with('_') && !word.contains("__");
    let is_kept = OF_THE_LANGUAGE.iter().any(|it| it.eq_ignore_ascii_case(word));
    is_one && !is_ours && !is_kept && word.chars().all(|it| it.is_ascii_alphanumeric() || it == '_') && word.len() > 1
}

/// How many of the words are declared; what is not as the program declares it is added to `wrong`.
fn try_all(dialect: Dialect, way: &Way, words: &[String], wrong: &mut Vec<String>) -> usize {
    let (text, declared) = program(way, words);
    let mut sources = Sources::default();
    sources.add(Source::new("own.st", text));
    let compilation = compile(&sources, &Options { dialect, ..Options::default() });
    if let Some(program) = compilation.program {
        check_values(dialect, way, words, &program, wrong);
        return words.len();
    }
    let errors = || compilation.diagnostics.iter().filter(|it| it.severity == Severity::Error);
    let lines = errors().map(|it| sources.get(it.span.file).line(it.span.start));
    // Words of the language, or that the dialect keeps for itself: the others are read without them.
    let refused: BTreeSet<_> = lines.filter_map(|it| declared.get(&it)).collect();
    if !refused.is_empty() {
        let rest: Vec<_> = words.iter().filter(|it| !refused.contains(it)).cloned().collect();
        return try_all(dialect, way, &rest, wrong);
    }
    if let [word] = words {
        let messages: Vec<_> = errors().map(|it| it.message.to_string()).collect();
        wrong.push(format!("{}: `{word}` as {}: {}", dialect.name(), way.what, messages.join("; ")));
        return 0;
    }
    let (first, second) = words.split_at(words.len() / 2);
    try_all(dialect, way, first, wrong) + try_all(dialect, way, second, wrong)
}

/// The text, and what its lines declare.
fn program(way: &Way, words: &[String]) -> (String, BTreeMap<u32, String>) {
    let mut text = format!("{}\n", way.declared[0]);
    let mut declared = BTreeMap::new();
    let mut line = 2;
    let mut lines = |text: &mut String, form: &str, declares: bool| {
        for (number, word) in words.iter().enumerate() {
            *text += &format!("{}\n", form.replace('$', word).replace('#', &number.to_string()));
            declared.extend(declares.then(|| (line, word.clone())));
            line += 1;
        }
        line += 1;
    };
    lines(&mut text, way.declared[1], true);
    text += &format!("{} PROGRAM Main VAR\n", way.declared[2]);
    lines(&mut text, way.variable, way.declared[1].is_empty());
    text += "END_VAR VAR\n";
    lines(&mut text, "r_# : INT;", false);
    text += "END_VAR\n";
    lines(&mut text, way.used, false);
    (text + "END_PROGRAM\n", declared)
}

fn check_values(dialect: Dialect, way: &Way, words: &[String], program: &staunch_ir::Program, wrong: &mut Vec<String>) {
    let leaves = Leaves::new(program);
    let mut machine = Executor::Interpreter.machine(program, "own").unwrap();
    let end = machine.scan(0, &Context::new(0, true));
    assert!(end.is_ok(), "{} in {}: {end:?}", way.what, dialect.name());
    let values: BTreeMap<_, _> = leaves.of(machine.state()).into_iter().collect();
    for (number, word) in words.iter().enumerate() {
        let value = &values[&format!("Main.r_{number}")];
        if *value != format!("I16({})", way.result) {
            wrong.push(format!("{}: `{word}` as {}: {value} is not {}", dialect.name(), way.what, way.result));
        }
    }
}
