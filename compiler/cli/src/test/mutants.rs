//! `--mutants`: the tests run on changed programs. A change that no test notices is reported.

use super::coverage::Counts;
use super::execute::Suite;
use super::outcome::Outcome;
use super::parallel;
use super::suite::Pace;
use super::table::{self, Table};
use crate::args::{self, MessageFormat};
use crate::output;
use crate::session::Session;
use staunch_frontend::{Mutant, Sources};
use staunch_host::json_text;
use std::sync::Mutex;

/// Turns that the loops of one test on a changed program may take, where more are not asked for: a
/// change may make a loop endless.
const TURNS: u64 = 1_000_000;

/// Runs the tests on every changed program, or on `budget` of them; the number that no test notices.
pub fn run(session: &Session, args: &args::Test, tables: &[Table], threads: usize) -> Result<usize, String> {
    if !matches!(fate(session, args, tables, &session.sources)?, Fate::Survived) {
        return Err("the tests need more turns of loops than changed programs get: set a --loop-budget".to_owned());
    }
    let all = staunch_frontend::mutants(&session.sources);
    let chosen = spread(&all, args.mutants.flatten().unwrap_or(all.len()));
    let (mut killed, mut survived, mut refused) = (0, 0, 0);
    parallel::in_order(
        threads,
        chosen.len(),
        |_| Ok(()),
        |(), piece| fate(session, args, tables, &chosen[piece].apply(&session.sources)),
        |piece, fate| {
            match fate {
                Fate::Killed => killed += 1,
                Fate::Refused => refused += 1,
                Fate::Survived => {
                    survived += 1;
                    output::print(shown(session, chosen[piece]).as_bytes())?;
                }
            }
            Ok(())
        },
    )?;
    let text = match session.common.format() {
        MessageFormat::Json => format!(
            "{{\"reason\":\"mutants\",\"killed\":{killed},\"survived\":{survived},\"of\":{}}}\n",
            all.len() - refused
        ),
        MessageFormat::Human | MessageFormat::Short => {
            let tried = if chosen.len() < all.len() {
                format!(" ({} of {} changes were tried)", chosen.len(), all.len())
            } else {
                String::new()
            };
            format!("\n{killed} mutants killed, {survived} survived{tried}\n")
        }
    };
    output::print(text.as_bytes())?;
    Ok(survived)
}

/// At most `budget` of them, from all over the sources.
fn spread(all: &[Mutant], budget: usize) -> Vec<&Mutant> {
    let count = budget.min(all.len());
    (0..count).map(|it| &all[it * all.len() / count]).collect()
}

enum Fate {
    /// A test failed, or faulted.
    Killed,
    Survived,
    /// The change makes no program.
    Refused,
}

fn fate(session: &Session, args: &args::Test, tables: &[Table], sources: &Sources) -> Result<Fate, String> {
    let turns = args.loop_budget.or(session.project.loop_budget).unwrap_or(TURNS);
    let compilation = session.compile(sources, true)?;
    let Some(program) = compilation.program else { return Ok(Fate::Refused) };
    let suite = Suite::interpreted(&program, turns, Pace::of(session, args)?);
    let wanted: Vec<_> = compilation.tests.iter().enumerate().filter(|it| args.wants_of(it.1)).collect();
    // Without tests the program is empty.
    if !wanted.is_empty() {
        let mut executor = suite.executor(|_| true)?;
        for (instance, test) in wanted {
            let cases = executor.run(instance, test, &|it| args.wants(it))?;
            if cases.iter().any(|it| !it.outcome.is_fine()) {
                return Ok(Fate::Killed);
            }
        }
    }
    on_tables(session, &suite, tables, sources)
}

fn on_tables(session: &Session, suite: &Suite<'_>, tables: &[Table], sources: &Sources) -> Result<Fate, String> {
    if tables.is_empty() {
        return Ok(Fate::Survived);
    }
    let Some(program) = session.compile(sources, false)?.program else { return Ok(Fate::Refused) };
    let none: Option<&Mutex<Counts>> = None;
    let passes = |it: &Table| table::run(session, suite, &program, it, none) == Outcome::Passed;
    Ok(if tables.iter().all(passes) { Fate::Survived } else { Fate::Killed })
}

/// A change that no test notices: the line as it is, and as it would be.
fn shown(session: &Session, mutant: &Mutant) -> String {
    let source = session.sources.get(mutant.span.file);
    let (line, column) = source.line_column(mutant.span.start);
    let [before, after] = mutant.lines(&session.sources);
    match session.common.format() {
        MessageFormat::Json => format!(
            "{{\"reason\":\"mutant\",\"file\":{},\"line\":{line},\"column\":{column},\"before\":{},\"after\":{}}}\n",
            json_text(&source.path),
            json_text(&before),
            json_text(&after)
        ),
        MessageFormat::Human | MessageFormat::Short => {
            format!("{}:{line}:{column}: no test detects\n  - {before}\n  + {after}\n", source.path)
        }
    }
}
