//! `docs/dialects.md` shows the rules of values as the compiler has them, and `docs/ladder.md` the instructions of ladder.

use staunch_frontend::{Dialect, rules};
use std::fmt::Write;

const START: &str = "<!-- rules of values: written by `STAUNCH_WRITE_RULES=1 cargo test -p staunch-tests rules` -->\n";
const END: &str = "<!-- end of the rules of values -->\n";

/// The choices, a row for each rule; below, what shows those that are not the default dialect's.
fn table() -> String {
    let names: Vec<_> = Dialect::ALL.iter().map(|it| format!("`{}`", it.name())).collect();
    let mut text = format!("| | {} |\n|---|{}\n", names.join(" | "), "---|".repeat(names.len()));
    let rows = rules::table();
    for row in &rows {
        let choices: Vec<_> = row.followed.iter().map(|it| it.0).collect();
        writeln!(text, "| {} | {} |", row.rule, choices.join(" | ")).unwrap();
    }
    text.push_str("\n| rule | in | shown by |\n|---|---|---|\n");
    for row in &rows {
        let mut shown: Vec<(&str, Vec<&str>)> = Vec::new();
        for (name, (_, evidence)) in names.iter().zip(row.followed) {
            match shown.iter_mut().find(|it| it.0 == evidence) {
                Some((_, dialects)) => dialects.push(name),
                None => shown.push((evidence, vec![name])),
            }
        }
        for (at, (evidence, names)) in shown.iter().enumerate() {
            let rule = if at == 0 { row.rule } else { "" };
            writeln!(text, "| {rule} | {} | {} |", names.join(" "), evidence.replace('|', "\\|")).unwrap();
        }
    }
    text.push_str(
        "\nThese rules are known but not followed: a program that uses one of them may compute a different value on that system.\n",
    );
    text.push_str("\n| dialect | uses | there | shown by |\n|---|---|---|---|\n");
    for it in rules::NOT_FOLLOWED {
        let (dialect, uses) = (it.dialect.name(), it.uses.words());
        writeln!(text, "| `{dialect}` | {uses} | {} | {} |", it.what, it.evidence).unwrap();
    }
    text.push_str(
        "\nIf a vendor leaves a value open, or we found no page that documents it, Staunch makes a choice:\n",
    );
    text.push_str("\n| dialect | what | here | documented |\n|---|---|---|---|\n");
    for it in rules::EDGES {
        writeln!(text, "| `{}` | {} | {} | {} |", it.dialect.name(), it.what, it.here, it.documented).unwrap();
    }
    text
}

#[test]
fn rules_of_values_are_documented() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/dialects.md");
    let page = std::fs::read_to_string(path).unwrap();
    let (before, rest) = page.split_once(START).expect("docs/dialects.md has the place of the rules of values");
    let (written, after) = rest.split_once(END).expect("docs/dialects.md has the end of the rules of values");
    let table = table();
    if std::env::var_os("STAUNCH_WRITE_RULES").is_some() {
        std::fs::write(path, [before, START, &table, END, after].concat()).unwrap();
        return;
    }
    assert_eq!(written, table, "docs/dialects.md differs from compiler/frontend/src/dialect/rules.rs");
}

const LADDER: &str =
    "<!-- instructions of ladder: written by `STAUNCH_WRITE_RULES=1 cargo test -p staunch-tests ladder` -->\n";
const END_OF_LADDER: &str = "<!-- end of the instructions of ladder -->\n";

#[test]
fn instructions_of_ladder_are_documented() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/ladder.md");
    let page = std::fs::read_to_string(path).unwrap();
    let (before, rest) = page.split_once(LADDER).expect("docs/ladder.md has the place of the instructions");
    let (written, after) = rest.split_once(END_OF_LADDER).expect("docs/ladder.md has the end of the instructions");
    let mut table = "| instruction | operands | does |\n|---|---|---|\n".to_owned();
    for (names, operands, does) in staunch_frontend::vendor::ladder_instructions() {
        writeln!(table, "| {names} | {operands} | {does} |").unwrap();
    }
    if std::env::var_os("STAUNCH_WRITE_RULES").is_some() {
        std::fs::write(path, [before, LADDER, &table, END_OF_LADDER, after].concat()).unwrap();
        return;
    }
    assert_eq!(written, table, "docs/ladder.md differs from the table of the instructions");
}

#[test]
fn every_choice_has_its_evidence() {
    for row in rules::table() {
        for (words, evidence) in row.followed {
            assert!(!words.is_empty() && !evidence.is_empty(), "{}: {words}", row.rule);
        }
    }
}

#[test]
fn each_part_that_systems_run_otherwise_has_a_row() {
    for part in rules::Part::ALL {
        let found = rules::Use::Part(part);
        let is_open = || rules::EDGES.iter().any(|it| it.uses.contains(&found));
        assert!(rules::NOT_FOLLOWED.iter().any(|it| it.uses == found) || is_open(), "{part:?}");
    }
}
