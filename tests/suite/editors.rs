//! The extension for VS Code: its grammar has the lexer's keywords, its settings the dialects.

use serde_json::Value as Json;
use staunch_frontend::Dialect;
use staunch_syntax::lex::Kind;
use staunch_tests::project;
use std::path::PathBuf;

fn file(name: &str) -> PathBuf {
    project().join("editors/vscode").join(name)
}

fn text(name: &str) -> String {
    std::fs::read_to_string(file(name)).unwrap()
}

fn json(text: &str) -> Json {
    serde_json::from_str(text).unwrap()
}

/// The keywords of a colour, in the order of the grammar's patterns; the last pattern has all others.
fn colours() -> [&'static [Kind]; 3] {
    use Kind::{
        And, AndThen, By, Case, Catch, Continue, Do, Else, Elsif, EndCase, EndFor, EndIf, EndRepeat, EndTry, EndWhile,
        Exit, False, Finally, For, If, Mod, Not, Of, Or, OrElse, Repeat, Return, Then, To, True, Try, Until, While,
        Xor,
    };
    [
        &[
            If, Then, Elsif, Else, EndIf, Case, Of, EndCase, For, To, By, Do, EndFor, While, EndWhile, Repeat, Until,
            EndRepeat, Try, Catch, Finally, EndTry, Exit, Continue, Return,
        ],
        &[Not, And, AndThen, Or, OrElse, Xor, Mod],
        &[True, False],
    ]
}

/// The patterns of all keywords. A word after a point is a member, after `#` an enumerator.
fn patterns() -> [String; 4] {
    let mut words = [const { Vec::new() }; 4];
    for (word, kind) in Kind::keywords() {
        let colour = colours().iter().position(|it| it.contains(&kind));
        words[colour.unwrap_or(colours().len())].push(word);
    }
    words.map(|it| format!(r"(?i)(?<![\w.#%])(?:{})\b", it.join("|")))
}

#[test]
fn the_grammar_has_the_keywords_of_the_lexer() {
    let name = "syntaxes/iecst.tmLanguage.json";
    let mut grammar = text(name);
    let parsed = json(&grammar);
    let written = parsed["repository"]["keywords"]["patterns"].as_array().unwrap();
    let is_blessed = std::env::var_os("STAUNCH_WRITE_GRAMMAR").is_some();
    assert_eq!(written.len(), 4, "{name}");
    for (pattern, wanted) in written.iter().zip(patterns()) {
        if is_blessed {
            let line = |it: &str| format!("{}, \"match\": {} }}", pattern["name"], Json::from(it));
            grammar = grammar.replace(&line(pattern["match"].as_str().unwrap()), &line(&wanted));
        } else {
            assert_eq!(pattern["match"], wanted, "{name}: {}", pattern["name"]);
        }
    }
    if is_blessed {
        std::fs::write(file(name), grammar).unwrap();
    }
}

#[test]
fn the_grammar_knows_what_each_end_ends() {
    let grammar = text("syntaxes/iecst.tmLanguage.json");
    let has = |word: &str| grammar.split(|it: char| !it.is_alphanumeric() && it != '_').any(|it| it == word);
    for (word, _) in Kind::keywords() {
        if let Some(opener) = word.strip_prefix("END_") {
            assert!(has(opener), "{word} is coloured, and {opener} is not");
        }
    }
}

#[test]
fn the_extension_knows_each_dialect() {
    let package = json(&text("package.json"));
    let offered = package["contributes"]["configuration"]["properties"]["staunch.dialect"]["enum"].as_array().unwrap();
    for dialect in Dialect::ALL {
        assert!(offered.iter().any(|it| it == dialect.name()), "{} is not offered", dialect.name());
    }
    for name in offered.iter().filter_map(Json::as_str).filter(|it| !it.is_empty()) {
        assert!(Dialect::named(name).is_some(), "{name} is not a dialect");
    }
}

#[test]
fn the_extension_has_the_version_and_the_licences_of_the_command() {
    assert_eq!(json(&text("package.json"))["version"], env!("CARGO_PKG_VERSION"));
    for licence in ["LICENSE-APACHE", "LICENSE-MIT"] {
        assert_eq!(text(licence), std::fs::read_to_string(project().join(licence)).unwrap(), "{licence}");
    }
}

#[test]
fn all_files_that_are_json_can_be_read() {
    json(&text("language-configuration.json"));
    json(&text("package-lock.json"));
}
