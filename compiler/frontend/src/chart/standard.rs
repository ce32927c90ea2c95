//! A chart as the standard describes it (IEC 61131-3, 6.7.4 and 6.7.5): one action control for each action, and of the transitions
//! from a step the first that may fire.

use super::{Action, Actions, fire, tested, tree};
use crate::ast::{BinaryOp, Chart, Expr, Qualifier, Statement};
use crate::spelling::Key;

pub(super) fn write<'s>(chart: &Chart<'s>, actions: &Actions<'s>, body: &mut Vec<Statement<'s>>) {
    for step in &chart.steps {
        let passed = tree::member(tree::named(crate::added::CLOCK, step.name.span), "passed");
        body.push(tree::call(tree::member(tree::name(step.name), "__scan"), vec![tree::input("passed", passed)]));
    }
    transitions(chart, body);
    for action in &actions.all {
        run(chart, *action, body);
    }
    for action in actions.variables() {
        body.push(tree::assign(tree::name(action.name), tree::control(*action, "Q", action.name.span)));
    }
}

fn transitions<'s>(chart: &Chart<'s>, body: &mut Vec<Statement<'s>>) {
    let order = tested(&chart.transitions);
    for (place, at) in order.iter().enumerate() {
        let transition = &chart.transitions[*at];
        let span = transition.span;
        let shares = |other: &&usize| {
            let other = &chart.transitions[**other];
            other.from.iter().any(|it| transition.from.iter().any(|own| Key(own.text) == Key(it.text)))
        };
        let active = transition.from.iter().map(|it| tree::member(tree::name(*it), "X"));
        let others = order[..place].iter().filter(shares).map(|it| tree::not(tree::fires(*it, span)));
        let Some(enabled) = tree::joined(active.chain(others), BinaryOp::And) else { continue };
        let then = vec![tree::assign(tree::fires(*at, span), tree::truth(true, span))];
        body.push(tree::assign(tree::fires(*at, span), tree::truth(false, span)));
        body.push(tree::when(enabled, vec![tree::test(transition, then)]));
    }
    fire(chart, |_| false, body);
}

/// Calls the control of an action with what the steps say of it.
fn run<'s>(chart: &Chart<'s>, action: Action<'s>, body: &mut Vec<Statement<'s>>) {
    let mut inputs: Vec<(&'static str, Expr<'s>)> = Vec::new();
    for step in &chart.steps {
        for association in step.associations.iter().filter(|it| Key(it.action.text) == Key(action.name.text)) {
            let active = || tree::member(tree::name(step.name), "X");
            if let Some(time) = &association.time {
                let of_action = tree::control(action, "T", association.span);
                body.push(tree::when(active(), vec![tree::assign(of_action, time.clone())]));
            }
            let input = input(association.qualifier.unwrap_or(Qualifier::While));
            match inputs.iter_mut().find(|it| it.0 == input) {
                Some((_, value)) => *value = tree::binary(value.clone(), BinaryOp::Or, active()),
                None => inputs.push((input, active())),
            }
        }
    }
    let arguments = inputs.into_iter().map(|(input, value)| tree::input(input, value)).collect();
    body.push(tree::call(tree::controls(action, action.name.span), arguments));
}

/// The input of the control.
const fn input(qualifier: Qualifier) -> &'static str {
    match qualifier {
        Qualifier::While => "N",
        Qualifier::Reset => "R",
        Qualifier::Set => "S",
        Qualifier::Limited => "L",
        Qualifier::Delayed => "D",
        Qualifier::Entered => "P",
        Qualifier::Left => "P0",
        Qualifier::SetDelayed => "SD",
        Qualifier::DelayedSet => "DS",
        Qualifier::SetLimited => "SL",
    }
}
