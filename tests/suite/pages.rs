//! The pages of the diagnostics: the text before has the diagnostic, the text after has none.

use crate::documents::wrapped;
use staunch_frontend::{Code, Dialect, Options, Severity, Source, Sources};

/// What no program alone shows: of a file of 4 GiB, the page has the commands, and of a stimulus, the table.
const WITHOUT_A_TEXT: [Code; 2] = [Code::E0031, Code::W0522];

#[test]
fn pages_show_what_they_say() {
    let problems: Vec<_> = Code::ALL.iter().flat_map(|it| problems_of(*it)).collect();
    assert!(problems.is_empty(), "{}", problems.join("\n"));
}

fn problems_of(code: Code) -> Vec<String> {
    let page = code.page();
    let is_wide = page.lines().any(|it| it.chars().count() > 120);
    let wide = is_wide.then(|| format!("{}: a line has more than 120 characters", code.name()));
    let examples = ["Before", "After"].map(|it| Example::all(page, it));
    let wrong = match &examples {
        _ if WITHOUT_A_TEXT.contains(&code) => None,
        [before, after] if before.len() == after.len() && !before.is_empty() => {
            before.iter().zip(after).find_map(|(before, after)| problem_of(code, before, after))
        }
        [before, after] => Some(format!("{}: {} of Before, {} of After", code.name(), before.len(), after.len())),
    };
    wide.into_iter().chain(wrong).collect()
}

/// A pair of which one text does not show what it says.
fn problem_of(code: Code, before: &Example, after: &Example) -> Option<String> {
    let expected = [vec![code], Vec::new()];
    let mut found = [before.codes(), after.codes()];
    if code.severity() == Severity::Error {
        // Lints of what is refused do not count.
        found[0].retain(|it| it.severity() == Severity::Error);
    }
    if code == Code::E0030 {
        // It follows those that are too many.
        found[0].retain(|it| *it == code);
    }
    (found != expected)
        .then(|| format!("{}: {} before, {} after\n{}", code.name(), list(&found[0]), list(&found[1]), before.text))
}

fn list(codes: &[Code]) -> String {
    format!("[{}]", codes.iter().map(|it| it.name()).collect::<Vec<_>>().join(" "))
}

/// A line, as often as it says: `x := ;  (* and 100 more like this *)`.
fn repeated(line: &str) -> String {
    let said =
        line.split_once("(* and ").and_then(|(code, rest)| Some((code, rest.strip_suffix(" more like this *)")?)));
    let Some((code, more)) = said else { return format!("{line}\n") };
    let more: usize = more.parse().expect("a number of lines");
    format!("{code}\n").repeat(1 + more)
}

/// What is indented after `Before:`, `Before, in codesys:` or `Before, from iec to codesys:`. A heading may end with the
/// name of a setting.
struct Example {
    text: String,
    options: Options,
}

impl Example {
    /// Those of a page whose headings begin with a word: a page may have a pair for each of its sections.
    fn all(page: &str, title: &str) -> Vec<Self> {
        let is_heading = |line: &str| line.starts_with(title) && line.ends_with(':');
        let starts = page.lines().enumerate().filter(|(_, line)| is_heading(line)).map(|(at, _)| at);
        starts.map(|it| Self::at(page, it)).collect()
    }

    /// The one with the heading in a line.
    fn at(page: &str, line: usize) -> Self {
        let mut lines = page.lines().skip(line);
        let heading = lines.next().unwrap_or_default().trim_end_matches(':');
        let lines = lines.take_while(|it| it.is_empty() || it.starts_with("    "));
        let text: String = lines.map(|it| repeated(it.strip_prefix("    ").unwrap_or(it))).collect();
        let dialect = |word: &str| {
            let name = heading.split_once(&format!(" {word} "))?.1.split(' ').next()?;
            Some(Dialect::named(name).unwrap_or_else(|| panic!("`{name}` is not a dialect")))
        };
        let moved_from = dialect("from");
        let dialect = dialect("in").or_else(|| dialect("to")).unwrap_or_default();
        let implicit_narrowing = heading.ends_with(" with implicit-narrowing");
        Self { text, options: Options { dialect, moved_from, implicit_narrowing, ..Options::default() } }
    }

    /// The text's files: each begins with its path in a comment, unless there is one alone.
    fn files(&self) -> Vec<(&str, String)> {
        let mut files = vec![("page.st", String::new())];
        for line in self.text.lines() {
            match line.strip_prefix("// ").filter(|it| it.ends_with(".st")) {
                Some(path) => files.push((path, String::new())),
                None => files.last_mut().expect("it begins with one").1 += &format!("{line}\n"),
            }
        }
        files.retain(|(_, text)| !text.trim().is_empty());
        files
    }

    /// The diagnostics of the text when it is built, each once.
    fn codes(&self) -> Vec<Code> {
        let mut sources = Sources::default();
        for (path, text) in self.files() {
            // The file of another system is read as it is.
            let is_whole = text.trim_start().starts_with('<') || Source::is_openplc_project(text.as_bytes());
            let text = if is_whole { text } else { wrapped(&text) };
            let source = Source::decode(path, text.as_bytes());
            sources.add(if path.starts_with("lib/") { source.of_library("lib") } else { source });
        }
        let mut codes: Vec<_> =
            staunch_frontend::compile(&sources, &self.options).diagnostics.iter().map(|it| it.code).collect();
        codes.dedup();
        codes
    }
}
