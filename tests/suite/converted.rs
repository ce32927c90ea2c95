//! The files of a case as one file of Structured Text are the same program.

use staunch_ir::print_without_places;
use staunch_tests::case::{self, Case};
use staunch_tests::cases;

/// Cases whose files say more than their text.
const MORE_THAN_TEXT: [&str; 8] = [
    // Its file ends where its body does.
    "codesys/object_without_its_end",
    // An assertion knows its file.
    "library/axunit",
    "testing/fixture",
    // Each file has its dialect.
    "startup/declaring_file_decides",
    "program/charts_of_two_systems",
    // A task of TwinCAT's is a file.
    "vendor/twincat_program_of_two_tasks",
    "vendor/twincat_task_info",
    "vendor/twincat_tasks",
];

#[test]
fn a_case_as_one_file_is_the_same_program() {
    let (cases, _) = case::discover(&cases());
    let (mut same, mut others) = (0, Vec::new());
    for case in &cases {
        match is_same(case) {
            Some(Ok(())) => same += 1,
            Some(Err(why)) if !MORE_THAN_TEXT.contains(&case.name.as_str()) => {
                others.push(format!("{}: {why}", case.name))
            }
            Some(Err(_)) | None => {}
        }
    }
    assert!(others.is_empty(), "{} are others:\n{}", others.len(), others.join("\n"));
    assert!(same > 800, "{same}");
}

/// `None` if the case has no program.
fn is_same(case: &Case) -> Option<Result<(), String>> {
    let (sources, compilation) = case.compile();
    let program = compilation.program?;
    let converted = staunch_frontend::compile(&sources.as_one_file("all.st", None), &case.settings().options);
    let Some(other) = converted.program else {
        let first = converted.diagnostics.iter().find(|it| it.severity == staunch_frontend::Severity::Error);
        return Some(Err(first.map_or_else(String::new, |it| it.message.to_string())));
    };
    let (program, other) = (print_without_places(&program), print_without_places(&other));
    let differ = || program.lines().zip(other.lines()).find(|(a, b)| a != b);
    Some(if program == other { Ok(()) } else { Err(format!("{:?}", differ())) })
}
