//! `staunch test`: each TEST of the sources runs from a fresh state.

mod execute;
mod junit;
mod parallel;
mod report;

use crate::args;
use crate::session::Session;
use crate::{REJECTED, output};
use execute::Suite;
use staunch_frontend::Test;
use std::collections::HashSet;

/// How a test went.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Outcome {
    Passed,
    Failed {
        /// The number of the assertion, from 0.
        assertion: usize,
        actual: Option<String>,
        expected: Option<String>,
        message: Option<String>,
    },
    /// The test faulted: where, and why.
    Faulted(String),
}

pub fn test(session: &Session, args: &args::Test) -> Result<u8, String> {
    let Some(program) = session.program() else { return Ok(REJECTED) };
    if session.tests.is_empty() {
        return Err("the sources hold no TEST".to_owned());
    }
    let wanted = args.filter.as_deref().unwrap_or_default().to_lowercase();
    let chosen: Vec<(usize, &Test)> =
        session.tests.iter().enumerate().filter(|(_, it)| it.title.to_lowercase().contains(&wanted)).collect();
    if chosen.is_empty() {
        return Err(format!("no test has `{wanted}` in its title; there are {} tests", session.tests.len()));
    }
    let suite = Suite::new(session, args, program)?;
    let mut report = report::Report::new(session);
    let number = |piece: usize| chosen[piece].0;
    parallel::in_order(
        args.jobs.map_or_else(parallel::processors, usize::from),
        chosen.len(),
        |share| {
            let own: HashSet<usize> = (0..chosen.len()).filter(|it| share.has(*it)).map(number).collect();
            suite.executor(|instance| own.contains(&instance))
        },
        |executor, piece| executor.run(chosen[piece].0, chosen[piece].1),
        |piece, outcome| output::print(report.add(chosen[piece].1, outcome).as_bytes()),
    )?;
    output::print(report.end().as_bytes())?;
    if let Some(path) = &args.junit {
        output::write(path, junit::text(&report).as_bytes())?;
    }
    Ok(if report.failed() == 0 { 0 } else { REJECTED })
}
