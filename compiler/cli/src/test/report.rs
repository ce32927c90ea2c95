//! A line for each test, and what went wrong below it; or one JSON object a line.

use super::Outcome;
use super::table::Table;
use crate::args::MessageFormat;
use crate::session::Session;
use staunch_frontend::{Assertion, Span, Test};
use staunch_host::json_text;

pub struct Report<'s> {
    session: &'s Session,
    pub results: Vec<Result>,
    /// The file whose name was printed last.
    file: String,
}

pub struct Result {
    pub title: String,
    /// The file of the test.
    pub file: String,
    pub line: u32,
    /// What went wrong, a line each; empty where the test passed.
    pub problem: Vec<String>,
    pub faulted: bool,
}

impl<'s> Report<'s> {
    pub fn new(session: &'s Session) -> Self {
        Self { session, results: Vec::new(), file: String::new() }
    }

    pub fn failed(&self) -> usize {
        self.results.iter().filter(|it| !it.problem.is_empty()).count()
    }

    /// Notes a test's result; the text that it is shown by.
    pub fn add_test(&mut self, test: &Test, outcome: Outcome) -> String {
        let source = self.session.sources.get(test.span.file);
        let (title, file, line) = (test.title.clone(), source.path.clone(), source.line_column(test.span.start).0);
        let faulted = matches!(outcome, Outcome::Faulted(_));
        let problem = self.problem(&test.assertions, outcome);
        self.add(Result { title, file, line, problem, faulted })
    }

    pub fn add_table(&mut self, table: &Table, outcome: Outcome) -> String {
        let faulted = matches!(outcome, Outcome::Faulted(_));
        let problem = self.problem(&[], outcome);
        self.add(Result { title: table.title.clone(), file: table.file(), line: 1, problem, faulted })
    }

    fn add(&mut self, result: Result) -> String {
        let text = match self.session.common.format() {
            MessageFormat::Json => result.json(),
            MessageFormat::Human | MessageFormat::Short => self.text(&result),
        };
        self.results.push(result);
        text
    }

    /// A passed test is not named where only errors are asked for.
    fn text(&mut self, result: &Result) -> String {
        let passed = result.problem.is_empty();
        if passed && self.session.common.quiet {
            return String::new();
        }
        let mut text = String::new();
        if self.file != result.file {
            self.file.clone_from(&result.file);
            text += &format!("{}\n", result.file);
        }
        let word = if passed { "ok" } else { "FAILED" };
        text += &format!("  {word:<6}  {}\n", result.title);
        result.problem.iter().for_each(|it| text += &format!("          {it}\n"));
        text
    }

    pub fn end(&self) -> String {
        let (failed, all) = (self.failed(), self.results.len());
        match self.session.common.format() {
            MessageFormat::Json => {
                format!("{{\"reason\":\"tests\",\"passed\":{},\"failed\":{failed}}}\n", all - failed)
            }
            MessageFormat::Human | MessageFormat::Short => format!("\n{} passed, {failed} failed\n", all - failed),
        }
    }

    fn problem(&self, assertions: &[Assertion], outcome: Outcome) -> Vec<String> {
        match outcome {
            Outcome::Passed => Vec::new(),
            Outcome::Differs(lines) => lines,
            Outcome::Faulted(text) => {
                let source = self.source_line(&text).map(str::to_owned);
                text.lines().map(str::to_owned).chain(source).collect()
            }
            Outcome::Failed { assertion, actual, expected, message } => {
                let Assertion { span, wants, compares_texts, .. } = assertions[assertion];
                let shown = |it: String| if compares_texts { format!("'{it}'") } else { it };
                let wants = wants.replace("{}", &expected.map(shown).unwrap_or_default());
                let found = actual.map(|it| format!(", found {}", shown(it))).unwrap_or_default();
                let wants = format!("expected {wants}{found}");
                let first = format!("{}: {}", self.place(span), self.session.sources.text(span));
                [Some(first), Some(wants), message].into_iter().flatten().collect()
            }
        }
    }

    /// The line of the source that a fault's text begins with the place of.
    fn source_line(&self, text: &str) -> Option<&str> {
        self.session.sources.files().iter().find_map(|it| {
            let rest = text.strip_prefix(it.path.as_str())?.strip_prefix(':')?;
            let line = rest.split(':').next()?.parse().ok()?;
            let file = it.file();
            file.text.get(file.line_range(line)).map(str::trim)
        })
    }

    fn place(&self, span: Span) -> String {
        let source = self.session.sources.get(span.file);
        let (line, column) = source.line_column(span.start);
        format!("{}:{line}:{column}", source.path)
    }
}

impl Result {
    fn json(&self) -> String {
        let result = match (self.problem.is_empty(), self.faulted) {
            (true, _) => "passed",
            (false, false) => "failed",
            (false, true) => "faulted",
        };
        format!(
            "{{\"reason\":\"test\",\"title\":{},\"file\":{},\"line\":{},\"result\":\"{result}\",\"message\":{}}}\n",
            json_text(&self.title),
            json_text(&self.file),
            self.line,
            json_text(&self.problem.join("\n"))
        )
    }
}
