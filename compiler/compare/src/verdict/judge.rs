//! The search, and what follows from what it has found.

use super::{Verdict, WithoutRun, scope, stimulus};
use crate::difference::pitfall;
use crate::findings::finding::Findings;
use crate::findings::reason;
use crate::inputs::alphabet;
use crate::pair::{Matched, Pair, Step};
use crate::program::scalar::{Role, Scalar};
use crate::request::Request;
use crate::search::trace::Trace;
use crate::search::world::World;
use crate::search::{look, strategy};
use staunch_host::Event;

/// What the search, or a stimulus, shows.
pub fn judge(pair: &mut Pair, world: &World, request: &Request, findings: &mut Findings) -> Result<Verdict, String> {
    if request.stimulus.is_some() {
        return stimulus::follow(pair, request);
    }
    let outcome = strategy::search(pair, world, request.budget, findings.open());
    let exact = covers_all(pair, world, request);
    findings.note(pair, world, &outcome, exact);
    if let Some(trace) = outcome.found.clone() {
        // Of numbers that were sampled, others may make a difference sooner.
        let is_tried = outcome.more_values == 0 && outcome.all_inputs && world.alphabet.is_exact();
        let shortest = is_tried && outcome.depth + 1 >= trace.scans();
        return Ok(differs(pair, world, &trace, shortest, findings));
    }
    if outcome.complete && exact {
        findings.has_all_outputs = true;
        return Ok(Verdict::Equal(scope::every_state(pair, world, &outcome)));
    }
    Ok(scope::not_found(pair, world, &outcome))
}

/// Continues the search past what is accepted.
pub fn beyond_accepted(pair: &mut Pair, world: &World, request: &Request, findings: &mut Findings) -> Verdict {
    let outcome = strategy::search(pair, world, request.budget, 0);
    findings.note(pair, world, &outcome, false);
    if let Some(trace) = &outcome.found {
        let steps: Vec<Step> = trace.steps().cloned().collect();
        pair.init();
        for step in &steps {
            let faults = pair.scan(step);
            look::look(pair, world, step.event, faults);
        }
        let compared: Vec<Matched> =
            world.tolerance.iter().flat_map(|it| pair.remaining_compared(&it.passing)).collect();
        let outputs: Vec<Matched> =
            world.tolerance.iter().flat_map(|it| pair.following(&it.passing, &compared)).collect();
        pair.compared = compared;
        let outputs: Vec<Matched> = outputs.into_iter().filter(|it| pair.differs_now(*it)).collect();
        findings.outputs(pair, &outputs, trace);
        return differs(pair, world, trace, false, findings);
    }
    findings.has_all_outputs = true;
    let is_told_apart = world.tolerance.as_ref().is_none_or(|it| it.beside.is_empty());
    if outcome.complete && covers_all(pair, world, request) && is_told_apart {
        return Verdict::Equal(scope::every_state(pair, world, &outcome) + &scope::passed_over(pair, world));
    }
    scope::not_found(pair, world, &outcome)
}

/// The share of the budget that goes into the search past STOP -> RUN.
const WITHOUT_RUN: u64 = 4;

/// Where the difference needs STOP -> RUN: what differs without it.
pub fn without_run(
    pair: &mut Pair,
    world: &World,
    request: &Request,
    verdict: &Verdict,
    findings: &mut Findings,
) -> Option<WithoutRun> {
    let Verdict::Differs { trace: Some(trace), .. } = verdict else { return None };
    if !trace.steps().any(|it| it.event == Some(Event::Run)) {
        return None;
    }
    pair.never.push(Event::Run);
    pair.ended = None;
    let outcome = strategy::search(pair, world, request.budget / WITHOUT_RUN, 0);
    let found = match &outcome.found {
        Some(trace) => {
            let steps: Vec<Step> = trace.steps().cloned().collect();
            let rows = pair.replay(&steps);
            let differences = rows.last().map_or_else(Vec::new, |it| pair.differences(it));
            let cause = pitfall::cause(pair, &rows, &differences, &world.habits);
            findings.explain(pair, &rows, &cause, trace);
            let names: Vec<&str> = differences.iter().take(3).map(|it| pair.path(*it)).collect();
            let scans = if rows.len() == 1 { "1 scan".to_owned() } else { format!("{} scans", rows.len()) };
            let counting = cause.counting(pair);
            let of = cause.counter.as_ref().map_or_else(String::new, |it| format!(" (`{it}`)"));
            let trap = cause.pitfall.map_or_else(String::new, |it| {
                let advice = it.advice(request.from, request.to, counting);
                format!(
                    ". Trap {}{of}: {} What to do: {}",
                    it.number(),
                    it.sentence([request.from, request.to]),
                    advice.trim_end_matches('.')
                )
            });
            let place = match names.is_empty() {
                true => "where one faults and the other continues".to_owned(),
                false => format!("in {}", names.join(", ")),
            };
            let words = format!("the two differ after {scans}, {place}{trap}");
            WithoutRun { verdict: "different", words, scans: Some(rows.len()), pitfall: cause.pitfall }
        }
        None if outcome.complete && covers_all(pair, world, request) => WithoutRun {
            verdict: "equal",
            words: "the two are equal: every reachable state was seen".to_owned(),
            scans: None,
            pitfall: None,
        },
        None => WithoutRun {
            verdict: "not found",
            words: "no difference was found, but none is ruled out".to_owned(),
            scans: None,
            pitfall: None,
        },
    };
    pair.never.pop();
    Some(found)
}

/// Whether the search leaves nothing out that the inputs could do, and no output that one of the two alone has: where
/// addresses share bits on one system, what is written by another name is an output of its own on the other.
fn covers_all(pair: &Pair, world: &World, request: &Request) -> bool {
    let is_output = |it: &Scalar| it.at.is_output && it.field.is_some();
    let has_all = !request.vars.is_empty() || pair.only_one_has(is_output).is_empty();
    has_all
        && world.unfollowed.is_empty()
        && pair.ended.is_none()
        && world.alphabet.is_exact()
        && pair.whole
        && alphabet::untried(pair).is_empty()
        && alphabet::outputs_given(pair).is_empty()
        && pair.only_one_has(|it| it.role == Role::Input).is_empty()
}

fn differs(pair: &mut Pair, world: &World, trace: &Trace, shortest: bool, findings: &mut Findings) -> Verdict {
    let steps: Vec<Step> = trace.steps().cloned().collect();
    let rows = pair.replay(&steps);
    let differences = rows.last().map_or_else(Vec::new, |it| pair.differences(it));
    let cause = pitfall::cause(pair, &rows, &differences, &world.habits);
    findings.explain(pair, &rows, &cause, trace);
    if cause.pitfall.is_none()
        && reason::find(pair, &rows, &differences, findings).is_none()
        && let Some(last) = rows.last()
    {
        findings.unexplained(pair, last, &differences, trace);
    }
    Verdict::Differs { rows, trace: Some(trace.clone()), shortest }
}
