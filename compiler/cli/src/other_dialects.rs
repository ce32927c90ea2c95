//! What other dialects make of sources that are rejected in one: whose program it is decides more errors than its text.

use staunch_frontend::{Diagnostic, Dialect, Options, Severity, Sources};

/// Larger sources are not checked again, in bytes.
const LARGEST: usize = 1 << 20;
/// More dialects than these are not named.
const MOST_NAMED: usize = 3;

/// Those that are asked first are those of most programs.
const ORDER: [Dialect; Dialect::ALL.len()] = [
    Dialect::Codesys,
    Dialect::Siemens,
    Dialect::Logix,
    Dialect::Openplc4,
    Dialect::Openplc,
    Dialect::Cscape,
    Dialect::Iec,
];

#[derive(Debug, PartialEq, Eq)]
pub enum Advice {
    /// These accept the sources as they are.
    Accepted(Vec<Dialect>),
    /// None does, and this one has far fewer errors.
    Fewer { dialect: Dialect, errors: usize, fewer: usize },
}

/// The better dialects for sources that have these diagnostics in that of `options`. None is better where one of their
/// errors is a mistake that another dialect only does not see.
pub fn advice(sources: &Sources, options: &Options, found: &[Diagnostic]) -> Option<Advice> {
    let size: usize = sources.files().iter().map(|it| it.text.len()).sum();
    let errors = count(found);
    if errors == 0 || size > LARGEST || found.iter().any(|it| it.in_this_dialect) {
        return None;
    }
    let others = ORDER.into_iter().filter(|it| *it != options.dialect);
    let counted = others.map(|dialect| (errors_of(sources, &Options { dialect, ..options.clone() }), dialect));
    let counted: Vec<(usize, Dialect)> = counted.collect();
    let accepted: Vec<Dialect> = counted.iter().filter(|it| it.0 == 0).map(|it| it.1).take(MOST_NAMED).collect();
    if !accepted.is_empty() {
        return Some(Advice::Accepted(accepted));
    }
    let (fewer, dialect) = counted.into_iter().min_by_key(|it| it.0)?;
    (2 * fewer < errors).then_some(Advice::Fewer { dialect, errors, fewer })
}

/// The dialects that accept sources which have these diagnostics.
pub fn accepting(sources: &Sources, options: &Options, found: &[Diagnostic]) -> Vec<Dialect> {
    match advice(sources, options, found) {
        Some(Advice::Accepted(dialects)) => dialects,
        Some(Advice::Fewer { .. }) | None => Vec::new(),
    }
}

fn errors_of(sources: &Sources, options: &Options) -> usize {
    count(&staunch_frontend::check(sources, options))
}

fn count(found: &[Diagnostic]) -> usize {
    found.iter().filter(|it| it.severity == Severity::Error).count()
}

impl Advice {
    /// The line for people; `flag` is what names the dialect on the command line.
    pub fn text(&self, flag: &str) -> String {
        match self {
            Self::Accepted(dialects) => {
                let flags: Vec<String> = dialects.iter().map(|it| format!("`{flag} {}`", it.name())).collect();
                format!("help: accepted with {}", flags.join(" or "))
            }
            Self::Fewer { dialect, errors, fewer } => {
                let s = if *fewer == 1 { "" } else { "s" };
                let name = dialect.name();
                format!("note: the sources have {errors} errors; with `{flag} {name}` they have {fewer} error{s}")
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use staunch_frontend::Source;

    fn found(text: &str, dialect: Dialect) -> Option<String> {
        let mut sources = Sources::default();
        sources.add(Source::new("main.st", text.to_owned()));
        let options = Options { dialect, ..Options::default() };
        let errors = staunch_frontend::check(&sources, &options);
        advice(&sources, &options, &errors).map(|it| it.text("--dialect"))
    }

    #[test]
    fn another_dialect_accepts_the_sources_or_most_of_them() {
        let codesys = "PROGRAM Main VAR c : CTU; w : WORD; END_VAR c(RESET := FALSE); w := c.CV; END_PROGRAM";
        assert_eq!(found(codesys, Dialect::Iec).as_deref(), Some("help: accepted with `--dialect codesys`"));
        assert_eq!(found(codesys, Dialect::Codesys), None);
        let wrong = codesys.replace("w := c.CV", "w := c.CV; w := missing");
        let fewer = "note: the sources have 3 errors; with `--dialect codesys` they have 1 error";
        assert_eq!(found(&wrong, Dialect::Iec).as_deref(), Some(fewer));
        assert_eq!(found("PROGRAM Main VAR i : INT; END_VAR i := missing; END_PROGRAM", Dialect::Iec), None);
    }

    /// OpenPLC takes the bit for another byte's, and where FB_init is a METHOD like any other, it does not run.
    #[test]
    fn no_dialect_makes_a_mistake_right() {
        let beyond = "PROGRAM Main VAR x AT %IX0.8 : BOOL; y : BOOL; END_VAR y := x; END_PROGRAM";
        assert_eq!(found(beyond, Dialect::Codesys), None);
        let init = "FUNCTION_BLOCK fb VAR n : INT; END_VAR METHOD FB_init : BOOL VAR_INPUT bInitRetains : BOOL; bInCopyCode : BOOL; \
            start : INT; END_VAR n := start; END_METHOD END_FUNCTION_BLOCK PROGRAM Main VAR f : fb; END_VAR f(); END_PROGRAM";
        assert_eq!(found(init, Dialect::Codesys), None);
    }
}
