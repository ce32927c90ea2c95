//! A line for each test, and what went wrong below it; or one JSON object a line.

use super::outcome::{Case, Outcome};
use super::table::Table;
use crate::args::MessageFormat;
use crate::session::Session;
use staunch_frontend::{Assertion, Span, Test};
use staunch_host::json_text;
use staunch_runtime::FaultKind;

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
    /// Why it did not run.
    pub skipped: Option<String>,
}

impl<'s> Report<'s> {
    pub fn new(session: &'s Session) -> Self {
        Self { session, results: Vec::new(), file: String::new() }
    }

    pub fn failed(&self) -> usize {
        self.results.iter().filter(|it| !it.problem.is_empty()).count()
    }

    pub fn skipped(&self) -> usize {
        self.results.iter().filter(|it| it.skipped.is_some()).count()
    }

    /// Notes a test's result; the text that it is shown by.
    pub fn add_test(&mut self, test: &Test, case: Case) -> String {
        let source = self.session.sources.get(case.span.file);
        let (file, line) = (source.path.clone(), source.line_column(case.span.start).0);
        self.add_outcome(case.title, file, line, Some(&test.assertions), case.outcome)
    }

    pub fn add_table(&mut self, table: &Table, outcome: Outcome) -> String {
        self.add_outcome(table.title.clone(), table.file(), 1, None, outcome)
    }

    fn add_outcome(
        &mut self,
        title: String,
        file: String,
        line: u32,
        // A table has none.
        assertions: Option<&[Assertion]>,
        outcome: Outcome,
    ) -> String {
        let faulted = matches!(outcome, Outcome::Faulted(_));
        let skipped = match &outcome {
            Outcome::Skipped(why) => Some(why.clone()),
            Outcome::Passed | Outcome::Differs(_) | Outcome::Faulted(_) | Outcome::Failed { .. } => None,
        };
        let problem = self.problem(assertions, outcome);
        self.add(Result { title, file, line, problem, faulted, skipped })
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
        if let Some(why) = &result.skipped {
            return text + &format!("  skipped {}: {why}\n", result.title);
        }
        let word = if passed { "ok" } else { "FAILED" };
        text += &format!("  {word:<6}  {}\n", result.title);
        result.problem.iter().for_each(|it| text += &format!("          {it}\n"));
        text
    }

    pub fn end(&self) -> String {
        let (failed, skipped) = (self.failed(), self.skipped());
        let passed = self.results.len() - failed - skipped;
        let (as_json, as_text) = match skipped {
            0 => (String::new(), String::new()),
            _ => (format!(",\"skipped\":{skipped}"), format!(", {skipped} skipped")),
        };
        match self.session.common.format() {
            MessageFormat::Json => {
                format!("{{\"reason\":\"tests\",\"passed\":{passed},\"failed\":{failed}{as_json}}}\n")
            }
            MessageFormat::Human | MessageFormat::Short => format!("\n{passed} passed, {failed} failed{as_text}\n"),
        }
    }

    fn problem(&self, assertions: Option<&[Assertion]>, outcome: Outcome) -> Vec<String> {
        match outcome {
            Outcome::Passed | Outcome::Skipped(_) => Vec::new(),
            Outcome::Differs(lines) => lines,
            Outcome::Faulted(text) => {
                let source = self.source_line(&text).map(str::to_owned);
                let is_budget = text.ends_with(&FaultKind::LoopBudget.to_string());
                let help = is_budget.then(|| "`--loop-budget N` gives a test more turns".to_owned());
                let help = help.or_else(|| self.help_on_missing(&text, assertions.is_none()));
                text.lines().map(str::to_owned).chain(source).chain(help).collect()
            }
            Outcome::Failed { assertion, actual, expected, tolerance, message } => {
                let Assertion { span, wants, compares_texts, .. } = assertions.unwrap_or_default()[assertion];
                let shown = |it: String| if compares_texts { format!("'{it}'") } else { it };
                let wants = wants.replace("{tolerance}", &tolerance.unwrap_or_default());
                let wants = wants.replace("{}", &expected.map(shown).unwrap_or_default());
                let found = actual.map(|it| format!(", found {}", shown(it))).unwrap_or_default();
                let wants = format!("expected {wants}{found}");
                let first = format!("{}: {}", self.place(span), self.session.sources.text(span));
                let message = message.filter(|it| !it.is_empty());
                [Some(first), Some(wants), message].into_iter().flatten().collect()
            }
        }
    }

    /// What to do about a call of what has no body: the fault's place is its declaration.
    fn help_on_missing(&self, text: &str, is_table: bool) -> Option<String> {
        // A run says the scan, too.
        let fault = text.split(" (scan ").next()?.strip_suffix(&FaultKind::NotImplemented.to_string())?;
        let place = fault.strip_suffix("fault: ").unwrap_or(fault).strip_suffix(": ")?;
        let column: usize = place.rsplit(':').next()?.parse().ok()?;
        let line = self.whole_line(text)?;
        let rest: String = line.chars().skip(column.checked_sub(1)?).collect();
        let name: String = rest.chars().take_while(|it| it.is_alphanumeric() || *it == '_').collect();
        let is_function = line.to_ascii_uppercase().trim_start().starts_with("FUNCTION ");
        let mock =
            if is_function { format!("`MOCK_FUNCTION {name} RETURNS value;`") } else { "`MOCK instance;`".to_owned() };
        let help = match is_table {
            true => format!("the program calls `{name}`, which has no body here: a TEST can replace it, with {mock}"),
            false => format!("the test calls `{name}`, which has no body here: replace it first, with {mock}"),
        };
        (!name.is_empty()).then_some(help)
    }

    /// The line of the source that a fault's text begins with the place of.
    fn source_line(&self, text: &str) -> Option<&str> {
        self.whole_line(text).map(str::trim)
    }

    fn whole_line(&self, text: &str) -> Option<&str> {
        self.session.sources.files().iter().find_map(|it| {
            let rest = text.strip_prefix(it.path.as_str())?.strip_prefix(':')?;
            let line = rest.split(':').next()?.parse().ok()?;
            let file = it.file();
            file.text.get(file.line_range(line))
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
            _ if self.skipped.is_some() => "skipped",
            (true, _) => "passed",
            (false, false) => "failed",
            (false, true) => "faulted",
        };
        let message = self.skipped.clone().unwrap_or_else(|| self.problem.join("\n"));
        format!(
            "{{\"reason\":\"test\",\"title\":{},\"file\":{},\"line\":{},\"result\":\"{result}\",\"message\":{}}}\n",
            json_text(&self.title),
            json_text(&self.file),
            self.line,
            json_text(&message)
        )
    }
}
