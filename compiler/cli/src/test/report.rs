//! A line for each test, and what went wrong below it; or one JSON object a line.

use super::Outcome;
use crate::args::MessageFormat;
use crate::session::Session;
use staunch_frontend::{Assertion, Span, Test};
use staunch_host::json_text;

pub struct Report<'s> {
    session: &'s Session,
    pub results: Vec<Result<'s>>,
}

pub struct Result<'s> {
    pub test: &'s Test,
    /// The source file of the test.
    pub file: &'s str,
    pub line: u32,
    /// What went wrong, a line each; empty where the test passed.
    pub problem: Vec<String>,
    pub faulted: bool,
}

impl<'s> Report<'s> {
    pub fn new(session: &'s Session) -> Self {
        Self { session, results: Vec::new() }
    }

    pub fn failed(&self) -> usize {
        self.results.iter().filter(|it| !it.problem.is_empty()).count()
    }

    /// Notes a result; the text that it is shown by.
    pub fn add(&mut self, test: &'s Test, outcome: Outcome) -> String {
        let source = self.session.sources.get(test.span.file);
        let faulted = matches!(outcome, Outcome::Faulted(_));
        let problem = self.problem(test, outcome);
        let line = source.line_column(test.span.start).0;
        let result = Result { test, file: &source.path, line, problem, faulted };
        let is_new_file = self.results.last().is_none_or(|it| it.file != result.file);
        let text = match self.session.common.format() {
            MessageFormat::Json => result.json(),
            MessageFormat::Human | MessageFormat::Short => result.text(is_new_file, self.session.common.quiet),
        };
        self.results.push(result);
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

    fn problem(&self, test: &Test, outcome: Outcome) -> Vec<String> {
        match outcome {
            Outcome::Passed => Vec::new(),
            Outcome::Faulted(text) => {
                let source = self.source_line(&text).map(str::to_owned);
                text.lines().map(str::to_owned).chain(source).collect()
            }
            Outcome::Failed { assertion, actual, expected, message } => {
                let Assertion { span, wants, compares_texts, .. } = test.assertions[assertion];
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

impl Result<'_> {
    fn text(&self, is_new_file: bool, quiet: bool) -> String {
        let passed = self.problem.is_empty();
        if passed && quiet {
            return String::new();
        }
        let mut text = if is_new_file { format!("{}\n", self.file) } else { String::new() };
        let word = if passed { "ok" } else { "FAILED" };
        text += &format!("  {word:<6}  {}\n", self.test.title);
        self.problem.iter().for_each(|it| text += &format!("          {it}\n"));
        text
    }

    fn json(&self) -> String {
        let result = match (self.problem.is_empty(), self.faulted) {
            (true, _) => "passed",
            (false, false) => "failed",
            (false, true) => "faulted",
        };
        format!(
            "{{\"reason\":\"test\",\"title\":{},\"file\":{},\"line\":{},\"result\":\"{result}\",\"message\":{}}}\n",
            json_text(&self.test.title),
            json_text(self.file),
            self.line,
            json_text(&self.problem.join("\n"))
        )
    }
}
