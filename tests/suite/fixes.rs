//! Every fix that a golden case shows is applied, alone, and the program is checked again.

use staunch_frontend::{Diagnostic, Fix, Severity, Source, Sources, Span};
use staunch_tests::case::{self, Case, Pin};
use staunch_tests::cases;

/// A fix takes a diagnostic away, and brings no error to its place.
#[test]
fn fixes_mend_what_they_are_for() {
    let (cases, _) = case::discover(&cases());
    let pinned = cases.iter().filter(|it| it.pins.contains(&Pin::Diagnostics));
    let problems: Vec<_> = pinned.flat_map(problems_of).collect();
    assert!(problems.is_empty(), "{} fixes are wrong:\n{}", problems.len(), problems.join("\n"));
}

fn problems_of(case: &Case) -> Vec<String> {
    let (sources, compilation) = case.compile();
    let fixed = |it: &Diagnostic| {
        let fix = it.fix.as_ref()?;
        if it.help.is_none() {
            // People would not see it.
            return Some(format!("{}.st: {}: the fix has no help", case.name, it.message));
        }
        let sources = applied(&sources, fix);
        let after = staunch_frontend::check(&sources, &case.settings().options);
        let what = problem(&compilation.diagnostics, &after, it, fix)?;
        let line = sources.get(fix.span.file).line_column(fix.span.start).0;
        Some(format!("{}.st:{line}: {}: `{}` {what}", case.name, it.message, fix.replacement))
    };
    compilation.diagnostics.iter().filter_map(fixed).collect()
}

fn applied(sources: &Sources, fix: &Fix) -> Sources {
    let mut fixed = Sources::default();
    for (number, file) in sources.files().iter().enumerate() {
        let mut text = file.text.clone();
        if number == usize::from(fix.span.file) {
            text.replace_range(index(fix.span.start)..index(fix.span.end), &fix.replacement);
        }
        fixed.add(Source::new(file.path.clone(), text));
    }
    fixed
}

fn problem(before: &[Diagnostic], after: &[Diagnostic], mended: &Diagnostic, fix: &Fix) -> Option<String> {
    let end = fix.span.start + u32::try_from(fix.replacement.len()).unwrap();
    let place = Span { end, ..fix.span };
    let is_new = |it: &&Diagnostic| !before.iter().any(|old| old.repeats(it));
    let mut errors = after.iter().filter(|it| it.severity == Severity::Error);
    if let Some(error) = errors.find(|it| is_new(it) && touches(it.span, place)) {
        return Some(format!("brings {}: {}", error.code.name(), error.message));
    }
    let same = |all: &[Diagnostic]| all.iter().filter(|it| it.repeats(mended)).count();
    if same(after) >= same(before) {
        return Some("leaves it".to_owned());
    }
    (after.len() >= before.len()).then(|| format!("leaves {} diagnostics of {}", after.len(), before.len()))
}

fn touches(a: Span, b: Span) -> bool {
    a.file == b.file && a.start <= b.end && b.start <= a.end
}

fn index(at: u32) -> usize {
    usize::try_from(at).unwrap()
}
