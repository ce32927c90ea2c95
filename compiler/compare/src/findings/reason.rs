//! Why variables differ, where no trap says so: the finding of what they come from, through assignments, conditions and
//! calls.

use super::finding::{Finding, Findings, Verdict};
use crate::difference::kind::Kind;
use crate::pair::{Matched, Pair, Row};
use crate::program::dependency::Dependencies;
use crate::program::scalar::Role;

/// A finding that says why a variable differs; which may be its own.
#[derive(Debug)]
pub struct Reason<'f> {
    pub finding: &'f Finding,
    /// The variable, or output of a block, that differs at the end.
    pub of: Matched,
}

/// Of the findings of variables that have differed in these rows, and decide what differs at their end, the one that came
/// first; one of what differs itself before one of what it is made of.
pub fn find<'f>(pair: &Pair, rows: &[Row], differences: &[Matched], findings: &'f Findings) -> Option<Reason<'f>> {
    let found = findings.all.iter().filter(|it| says(it, rows));
    let found: Vec<&Finding> = found.collect();
    let own = |it: &Matched| found.iter().find(|finding| finding.subject == pair.path(*it));
    if let Some((of, finding)) = differences.iter().find_map(|it| Some((*it, own(it)?))) {
        return Some(Reason { finding, of });
    }
    let dependencies = Dependencies::of(&pair.sides[0].program);
    let variables = pair.matched(|it| it.role == Role::Variable);
    let reason = |finding: &'f Finding| {
        let variable = variables.iter().find(|it| pair.path(**it) == finding.subject)?;
        let since = rows.iter().position(|row| !pair.same(*variable, row))?;
        let decided = dependencies.follow(pair.declared(0, *variable)?);
        let follows = |it: &&Matched| pair.declared(0, **it).is_some_and(|it| decided.contains(&it));
        Some((since, Reason { finding, of: *differences.iter().find(follows)? }))
    };
    found.into_iter().filter_map(reason).min_by_key(|it| it.0).map(|it| it.1)
}

/// Whether a finding may be the reason for what these rows show, and was seen.
fn says(finding: &Finding, rows: &[Row]) -> bool {
    let may_be = match finding.kind {
        Kind::Width | Kind::Address => true,
        Kind::Retention => rows.iter().any(|it| it.event.is_some()),
        Kind::Counter | Kind::Timer | Kind::OneShot | Kind::Latch | Kind::Fault | Kind::Variable | Kind::Output => {
            false
        }
    };
    may_be && matches!(finding.verdict, Verdict::Reachable(_))
}
