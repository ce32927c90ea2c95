//! The index that an editor asks: each name of each case that is accepted has its meaning in it.

use staunch_frontend::{Asked, Meaning, Sources, Stop, index};
use staunch_syntax::lex::{Kind, lex};
use staunch_tests::case::{self, Case};
use staunch_tests::cases;

/// Words that are names elsewhere, and have a meaning of the language's where they are.
const WORDS: [&str; 66] = [
    "ABSTRACT",
    "ACTION",
    "ACTIONS",
    "ANY",
    "BIT",
    "CLASS",
    "COUNTER",
    "DATA",
    "END_ACTION",
    "END_STEP",
    "END_TRANSITION",
    "EXTENDS",
    "FINAL",
    "FROM",
    "F_EDGE",
    "GET",
    "IMPLEMENTS",
    "INITIAL_STEP",
    "INTERFACE",
    "INTERNAL",
    "INTERVAL",
    "JMP",
    "MESSAGE",
    "METHOD",
    "NAMESPACE",
    "NULL",
    "ON",
    "OVERLAP",
    "OVERRIDE",
    "PC",
    "PLC",
    "POINTER",
    "PRIORITY",
    "PRIVATE",
    "PROPERTY",
    "PROPERTY_GET",
    "PROPERTY_SET",
    "PROTECTED",
    "PUBLIC",
    "R",
    "READ_ONLY",
    "READ_WRITE",
    "REF",
    "REFERENCE",
    "REF_TO",
    "RESOURCE",
    "R_EDGE",
    "S",
    "SET",
    "SINGLE",
    "STEP",
    "STRING",
    "SUPER",
    "TASK",
    "TEST",
    "THIS",
    "TO",
    "TRANSITION",
    "UNION",
    "USING",
    "VAR_GENERIC",
    "WITH",
    "WSTRING",
    "__CATCH",
    "__TRY",
    "__VARINFO",
];

/// How many names of the cases have none: steps of charts, words of mocks, names that the compiler writes out. It may only fall.
const WITHOUT: usize = 134;

#[test]
fn each_name_of_an_accepted_case_has_a_meaning() {
    let (cases, _) = case::discover(&cases());
    let (mut count, mut missing) = (0, Vec::new());
    for case in &cases {
        let (sources, compilation) = case.compile();
        // `instance.ENO` becomes a variable of the compiler's own before names are resolved.
        let is_written_out = case.name.starts_with("blocks/openplc") && case.name.ends_with("_read");
        if !compilation.has_errors() && !is_written_out {
            count += check(case, &sources, &mut missing);
        }
    }
    assert!(count > 20_000, "{count} names");
    let shown = missing.join("\n");
    assert!(missing.len() <= WITHOUT, "{} of {count} names:\n{shown}", missing.len());
}

/// How many names there are; those without a meaning are added.
fn check(case: &Case, sources: &Sources, missing: &mut Vec<String>) -> usize {
    let (index, _) = index(sources, &case.settings().options, Asked::All, &Stop::default());
    let mut count = 0;
    for (source, file) in sources.files().iter().zip(0u16..) {
        // What conditions leave out is not a part of the program; what is assembled has words of the assembly's.
        if source.text.contains("{IF ") || source.is_assembled() {
            continue;
        }
        let tokens = lex(file, &source.text);
        let mut is_path = false;
        for (kind, (start, end)) in tokens.kinds.iter().zip(&tokens.places) {
            let text = &source.text[usize::try_from(*start).unwrap()..usize::try_from(*end).unwrap()];
            // The paths of VAR_CONFIG and VAR_ACCESS have none yet.
            if *kind == Kind::VarConfig || *kind == Kind::VarAccess {
                is_path = true;
            }
            if *kind == Kind::EndVar {
                is_path = false;
            }
            if is_path || *kind != Kind::Name || WORDS.contains(&text.to_ascii_uppercase().as_str()) {
                continue;
            }
            count += 1;
            let meaning = index.at(file, *start).map(|it| it.1);
            if let Some(Meaning::Definition(id)) = meaning {
                // A source's own name, or the name that a library gives to the same.
                let declared = index.get(id).name;
                let known = usize::from(declared.file) < sources.files().len();
                let is_same = known && sources.text(declared).eq_ignore_ascii_case(text);
                if known && !is_same {
                    missing.push(format!("{}:{}: `{text}` leads to another name", case.name, source.line(*start)));
                }
            }
            if meaning.is_none() {
                missing.push(format!("{}:{}: `{text}`", case.name, source.line(*start)));
            }
        }
    }
    count
}
