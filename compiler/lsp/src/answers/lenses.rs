//! What can be run, above the line where it is declared: each TEST, and the comparison of a PROGRAM with itself as IEC has it.

use crate::project::Analysis;
use crate::results::{Outcome, Results, Task};
use gen_lsp_types::{CodeLens, Command, Uri};
use serde_json::{Value as Json, json};
use staunch_frontend::{Definition, DefinitionKind, Dialect};

/// The commands of lenses: a document, and a title or the name of a dialect.
pub const TEST: &str = "staunch.test";
pub const COMPARE: &str = "staunch.compare";

/// The lenses of a file, of which the analysis has the declarations.
pub fn lenses(analysis: &Analysis, file: u16, uri: &Uri, results: &Results) -> Vec<CodeLens> {
    let own = analysis.index.definitions.iter().filter(|it| it.name.file == file && analysis.is_own(it.name));
    own.filter_map(|it| {
        let task = task(analysis, it)?;
        let title = format!("{}{}", invitation(&task), outcome(results.get(&task)));
        let (command, argument) = match task {
            Task::Test(title) => (TEST, title),
            Task::Compare(dialect) => (COMPARE, dialect.name().to_owned()),
        };
        let arguments = Some(vec![json!(uri), Json::String(argument)]);
        let command = Command { title, tooltip: None, command: command.to_owned(), arguments };
        Some(CodeLens { range: analysis.range(it.name), command: Some(command), data: None })
    })
    .collect()
}

fn task(analysis: &Analysis, it: &Definition) -> Option<Task> {
    match it.kind {
        DefinitionKind::Test => Some(Task::Test(analysis.text(it.name).trim_matches(['\'', '"']).to_owned())),
        DefinitionKind::Program if analysis.dialect() != Dialect::Iec => Some(Task::Compare(Dialect::Iec)),
        _ => None,
    }
}

fn invitation(task: &Task) -> String {
    match task {
        Task::Test(_) => "Run test".to_owned(),
        Task::Compare(dialect) => format!("Compare with {}", dialect.name()),
    }
}

fn outcome(known: Option<&Outcome>) -> String {
    match known {
        None => String::new(),
        Some(Outcome::Runs) => " (running)".to_owned(),
        Some(Outcome::Ended(outcome)) => format!(" ({outcome})"),
    }
}
