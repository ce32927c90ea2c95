//! A suite of TcUnit: it is called in scan after scan until its tests are finished, and says itself which there were.

use super::outcome::{Case, Outcome, Values, failed};
use crate::session::Session;
use crate::{args, run};
use staunch_frontend::{Suite, Test};
use staunch_host::format_time;

/// The scans of a suite.
#[derive(Clone, Copy, Debug)]
pub struct Pace {
    /// How many it may take.
    pub scans: u64,
    /// Between two of them, in nanoseconds.
    pub cycle: i64,
}

impl Pace {
    pub fn of(session: &Session, args: &args::Test) -> Result<Self, String> {
        let cycle = run::cycle(session, None)?.unwrap_or(10_000_000);
        Ok(Self { scans: args.scans.unwrap_or(10_000), cycle })
    }
}

/// A suite that has run: until it was finished, for all its scans, or up to a fault.
pub struct Ran<'v> {
    pub values: &'v Values<'v>,
    pub fault: Option<String>,
}

/// Looks at what has run.
pub type See<'s> = dyn FnMut(&Ran<'_>) -> Result<(), String> + 's;
/// Runs a suite such that what fails first in the test of a number is kept, or, for 0, in any.
pub type Runs<'r> = dyn FnMut(usize, &mut See<'_>) -> Result<(), String> + 'r;

/// What the suite says of each test.
const STATES: [&str; 5] = ["__titles", "__skipped", "__failed", "__repeated", "__done"];

/// The variable of a suite's test.
pub fn variable(test: &Test, name: &str) -> String {
    format!("{}.__suite.{name}", test.instance)
}

/// The variables that [`cases`] looks at, for so many tests.
pub fn variables(test: &Test, count: usize) -> Vec<String> {
    let of_tests = (1..=count).flat_map(|number| STATES.map(|it| variable(test, &format!("{it}[{number}]"))));
    ["__count", "__told"].map(|it| variable(test, it)).into_iter().chain(of_tests).collect()
}

/// What `variable` says for the test of a number.
fn is(ran: &Ran<'_>, test: &Test, name: &str, number: usize) -> Result<bool, String> {
    Ok((ran.values)(&variable(test, &format!("{name}[{number}]")))? == "TRUE")
}

/// The tests of a suite, as many as `wants` asks for.
pub fn cases(
    test: &Test,
    suite: &Suite,
    pace: Pace,
    wants: &dyn Fn(&str) -> bool,
    run: &mut Runs<'_>,
) -> Result<Vec<Case>, String> {
    let (mut cases, mut open) = (Vec::new(), Vec::new());
    run(0, &mut |ran| {
        let count = (ran.values)(&variable(test, "__count"))?.parse::<usize>().unwrap_or(0);
        let told = (ran.values)(&variable(test, "__told"))?.parse::<usize>().unwrap_or(0);
        for number in 1..=count {
            let title = (ran.values)(&variable(test, &format!("__titles[{number}]")))?;
            if wants(&in_full(test, &title)) {
                let outcome = outcome(ran, test, pace, number, told)?;
                open.extend(outcome.is_none().then_some((cases.len(), number)));
                cases.push(case(test, suite, title, outcome.unwrap_or(Outcome::Passed)));
            }
        }
        add_others(test, suite, wants, ran, &mut cases);
        Ok(())
    })?;
    for (at, number) in open {
        run(number, &mut |ran| {
            cases[at].outcome = failed(test, ran.values)?;
            Ok(())
        })?;
    }
    Ok(cases)
}

/// How the test of a number went; `None` where it failed, and another run keeps what has.
fn outcome(ran: &Ran<'_>, test: &Test, pace: Pace, number: usize, told: usize) -> Result<Option<Outcome>, String> {
    let is = |name: &str| is(ran, test, name, number);
    Ok(Some(if is("__skipped")? {
        Outcome::Skipped("it is disabled".to_owned())
    } else if is("__failed")? {
        if told != number {
            return Ok(None);
        }
        failed(test, ran.values)?
    } else if is("__repeated")? {
        Outcome::Differs(vec![
            "the suite begins a test with this title twice in one scan".to_owned(),
            "assertions after the second TEST do not count: give it another title".to_owned(),
        ])
    } else if is("__done")? {
        Outcome::Passed
    } else if let Some(fault) = &ran.fault {
        Outcome::Faulted(fault.clone())
    } else {
        let time = format_time(pace.cycle.saturating_mul(i64::try_from(pace.scans).unwrap_or(i64::MAX)));
        Outcome::Differs(vec![
            format!("not finished within {} scans ({time})", pace.scans),
            "a test ends with TEST_FINISHED()".to_owned(),
        ])
    }))
}

/// The tests that were never begun, and a fault outside of any.
fn add_others(test: &Test, suite: &Suite, wants: &dyn Fn(&str) -> bool, ran: &Ran<'_>, cases: &mut Vec<Case>) {
    for (title, _) in suite.titles.iter().filter(|it| wants(&in_full(test, &it.0))) {
        let name = in_full(test, title);
        if !cases.iter().any(|it| it.title == name) {
            let outcome = match &ran.fault {
                Some(fault) => Outcome::Faulted(fault.clone()),
                None => Outcome::Skipped("the suite never begins it".to_owned()),
            };
            cases.push(case(test, suite, title.clone(), outcome));
        }
    }
    for (title, span) in suite.finished.iter().filter(|it| ran.fault.is_none() && wants(&in_full(test, &it.0))) {
        let title = in_full(test, title);
        if !cases.iter().any(|it| it.title == title) {
            let why = "TEST_FINISHED_NAMED names it, but the suite never begins it";
            cases.push(Case { title, span: *span, outcome: Outcome::Skipped(why.to_owned()) });
        }
    }
    // A title that is computed is not known before the suite has begun the test.
    let is_wanted = || wants(&test.title) || suite.titles.iter().any(|it| wants(&in_full(test, &it.0)));
    if let Some(fault) = &ran.fault
        && is_wanted()
        && !cases.iter().any(|it| matches!(it.outcome, Outcome::Faulted(_)))
    {
        cases.push(Case { title: test.title.clone(), span: test.span, outcome: Outcome::Faulted(fault.clone()) });
    }
}

/// `Suite.Title`
pub fn in_full(test: &Test, title: &str) -> String {
    format!("{}.{title}", test.title)
}

fn case(test: &Test, suite: &Suite, title: String, outcome: Outcome) -> Case {
    let span = suite.titles.iter().find(|it| it.0 == title).map_or(test.span, |it| it.1);
    Case { title: in_full(test, &title), span, outcome }
}
