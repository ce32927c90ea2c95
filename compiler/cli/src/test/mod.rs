//! `staunch test`: each TEST of the sources, and each table next to them, runs from a fresh state.

mod apart;
mod coverage;
mod execute;
mod fixture;
mod junit;
mod mutants;
mod outcome;
mod parallel;
mod report;
mod suite;
mod table;

use crate::args::{self, Backend};
use crate::session::Session;
use crate::{REJECTED, output};
use coverage::{Counts, Coverage};
use execute::Suite;
use report::Report;
use staunch_frontend::{Severity, Test};
use std::collections::HashSet;
use std::sync::Mutex;
use table::Table;

pub fn test(session: &Session, args: &args::Test) -> Result<u8, String> {
    let Some(program) = session.program() else { return Ok(REJECTED) };
    let tables = table::tables(session)?;
    if session.tests.is_empty() && tables.is_empty() {
        return Err("the sources have no TEST, and no table is next to them".to_owned());
    }
    let tests: Vec<(usize, &Test)> = session.tests.iter().enumerate().filter(|it| args.wants_of(it.1)).collect();
    let wanted: Vec<Table> = tables.iter().filter(|it| args.wants(&it.title)).cloned().collect();
    if tests.is_empty() && wanted.is_empty() {
        return Err(none_to_run(session, args, &tables));
    }
    let tables = wanted;
    let is_covered = !args.coverage.is_empty();
    if is_covered && args.backend == Backend::Rust {
        return Err("coverage is measured with --backend native or interpret".to_owned());
    }
    crate::apart::test(session, args)?;
    coverage::check(&args.coverage)?;
    args.junit.iter().try_for_each(|it| output::check(it))?;
    let counts = Mutex::new(Counts::of(program, &session.coverage));
    let mut run = Run {
        session,
        suite: Suite::new(session, args, program, is_covered.then_some(&counts))?,
        coverage: Coverage::default(),
        threads: args.jobs.map_or_else(parallel::processors, usize::from),
        report: Report::new(session),
    };
    run.tests(&tests, &|it| args.wants(it))?;
    run.tables(&tables)?;
    if run.report.results.is_empty() {
        return Err(none_to_run(session, args, &tables));
    }
    if is_covered {
        run.coverage.add(&session.coverage, &counts);
        let text = run.coverage.write(session, &args.coverage)?;
        output::print(text.as_bytes())?;
    }
    output::print(run.report.end().as_bytes())?;
    run.tell_minor_faults()?;
    if let Some(path) = &args.junit {
        output::write(path, junit::text(&run.report).as_bytes())?;
    }
    if run.report.failed() > 0 {
        if args.mutants.is_some() {
            session.say("Skipped", "the mutants: they are tried only if all tests pass");
        }
        return Ok(REJECTED);
    }
    if args.mutants.is_some() && mutants::run(session, args, &tables, run.threads)? > 0 {
        return Ok(REJECTED);
    }
    Ok(0)
}

/// Why no test runs, though the sources hold some, or what may hold some.
fn none_to_run(session: &Session, args: &args::Test, tables: &[Table]) -> String {
    let Some(wanted) = &args.filter else {
        return "no test to run: the suites and fixtures of the sources have none".to_owned();
    };
    let (groups, single): (Vec<_>, Vec<_>) =
        session.tests.iter().partition(|it| it.suite.is_some() || it.fixture.is_some());
    let count = |number: usize, what: &str| match number {
        0 => None,
        1 => Some(format!("1 {what}")),
        _ => Some(format!("{number} {what}s")),
    };
    let all = single.len() + tables.len();
    let parts: Vec<_> = [count(all, "test"), count(groups.len(), "suite")].into_iter().flatten().collect();
    let is = if all + groups.len() == 1 { "is" } else { "are" };
    format!("no test has `{wanted}` in its title; there {is} {}", parts.join(" and "))
}

struct Run<'s> {
    session: &'s Session,
    suite: Suite<'s>,
    threads: usize,
    report: Report<'s>,
    coverage: Coverage,
}

impl Run<'_> {
    /// Runs the tests that are instances of the program, by their numbers.
    fn tests(&mut self, tests: &[(usize, &Test)], wants: &(dyn Fn(&str) -> bool + Sync)) -> Result<(), String> {
        if tests.is_empty() {
            return Ok(());
        }
        let Self { suite, threads, report, .. } = self;
        parallel::in_order(
            *threads,
            tests.len(),
            |share| {
                let own = (0..tests.len()).filter(|it| share.has(*it)).map(|it| tests[it].0);
                let own: HashSet<usize> = own.collect();
                suite.executor(|instance| own.contains(&instance))
            },
            |executor, piece| executor.run(tests[piece].0, tests[piece].1, wants),
            |piece, cases| {
                let mut cases = cases.into_iter();
                cases.try_for_each(|it| output::print(report.add_test(tests[piece].1, it).as_bytes()))
            },
        )
    }

    /// A division by zero after which the program continues fails no test, but is reported.
    fn tell_minor_faults(&self) -> Result<(), String> {
        let Some((note, object)) = self.suite.minor_faults() else { return Ok(()) };
        if self.session.common.format() == args::MessageFormat::Json {
            return output::print(format!("{object}\n").as_bytes());
        }
        if !self.session.common.quiet {
            output::tell(note);
        }
        Ok(())
    }

    fn tables(&mut self, tables: &[Table]) -> Result<(), String> {
        if tables.is_empty() {
            return Ok(());
        }
        let Self { session, suite, threads, report, coverage } = self;
        let compilation = session.without_tests(suite.counts.is_some())?;
        let program = compilation.program.ok_or_else(|| {
            let error = compilation.diagnostics.iter().find(|it| it.severity == Severity::Error);
            let why = error.map_or_else(String::new, |it| format!(": {}", it.message));
            format!("the program without its tests is rejected{why}")
        })?;
        let counts = Mutex::new(Counts::of(&program, &compilation.coverage));
        let counted = suite.counts.map(|_| &counts);
        let work = |_: &mut (), piece: usize| Ok(table::run(session, suite, &program, &tables[piece], counted));
        let each = |piece: usize, outcome| output::print(report.add_table(&tables[piece], outcome).as_bytes());
        parallel::in_order(*threads, tables.len(), |_| Ok(()), work, each)?;
        coverage.add(&compilation.coverage, &counts);
        Ok(())
    }
}
