//! A chart as the C code runs it that MATIEC generates (`generate_c_sfc.cc`), which is what OpenPLC 3 and Beremiz do.

use super::{Action, Actions, fire, moved, tested, tree};
use crate::ast::{Association, BinaryOp, Chart, Expr, Name, Qualifier, Statement};

pub(super) fn write<'s>(chart: &Chart<'s>, actions: &Actions<'s>, body: &mut Vec<Statement<'s>>) {
    let passed = |at| vec![tree::input("passed", tree::member(tree::named(crate::added::CLOCK, at), "passed"))];
    body.extend(
        chart.steps.iter().map(|it| tree::call(tree::member(tree::name(it.name), "__scan"), passed(it.name.span))),
    );
    body.extend(actions.all.iter().map(|it| tree::call(tree::controls(*it, it.name.span), passed(it.name.span))));
    transitions(chart, body);
    for step in &chart.steps {
        for association in &step.associations {
            let Some(action) = actions.named(association.action) else { continue };
            associate(step.name, association, action, body);
        }
    }
    for action in &actions.all {
        body.push(tree::call(tree::control(*action, "__settle", action.name.span), Vec::new()));
    }
    for action in actions.variables() {
        let at = action.name.span;
        let branch = |asked, value| {
            (tree::control(*action, asked, at), vec![tree::assign(tree::name(action.name), tree::truth(value, at))])
        };
        body.push(tree::either(vec![branch("reset", false), branch("set", true)], None));
    }
}

/// All that may fire do; one that has a priority leaves its steps at once, so that those after it do not.
fn transitions<'s>(chart: &Chart<'s>, body: &mut Vec<Statement<'s>>) {
    for at in tested(&chart.transitions) {
        let transition = &chart.transitions[at];
        let span = transition.span;
        body.push(tree::assign(tree::fires(at, span), tree::truth(false, span)));
        let mut then = vec![tree::assign(tree::fires(at, span), tree::truth(true, span))];
        if transition.priority.is_some() {
            then.extend(moved(&transition.from, "__leave"));
        }
        let active = transition.from.iter().map(|it| tree::member(tree::name(*it), "X"));
        let Some(active) = tree::joined(active, BinaryOp::And) else { continue };
        body.push(tree::when(active, vec![tree::test(transition, then)]));
    }
    fire(chart, |it| it.priority.is_some(), body);
}

/// What a step says of an action in each scan.
fn associate<'s>(step: Name<'s>, association: &Association<'s>, action: Action<'s>, body: &mut Vec<Statement<'s>>) {
    let at = association.span;
    let of_step = |what| tree::member(tree::name(Name { text: step.text, span: at }), what);
    let active = || of_step("X");
    let entered = || tree::asked(of_step("__entered"));
    let left = || tree::asked(of_step("__left"));
    // A variable is written itself.
    let target = || match action.is_variable {
        true => tree::name(association.action),
        false => tree::control(action, "Q", at),
    };
    let runs = |value| vec![tree::assign(target(), tree::truth(value, at))];
    let control = |variable, value: Expr<'s>| tree::assign(tree::control(action, variable, at), value);
    let time = || association.time.clone().unwrap_or_else(|| tree::missing(at));
    let elapsed = |operator| tree::binary(active(), BinaryOp::And, tree::binary(of_step("T"), operator, time()));
    let Some(qualifier) = association.qualifier else {
        // It does nothing with a variable, and leaving the step does not end it.
        body.extend((!action.is_variable).then(|| tree::when(active(), runs(true))));
        return;
    };
    let last = match qualifier {
        Qualifier::While => {
            body.push(tree::when(active(), runs(true)));
            tree::when(left(), runs(false))
        }
        Qualifier::Set => tree::when(active(), vec![control("set", tree::truth(true, at))]),
        Qualifier::Reset => tree::when(active(), vec![control("reset", tree::truth(true, at))]),
        Qualifier::Limited => {
            let ends = tree::binary(left(), BinaryOp::Or, active());
            tree::either(vec![(elapsed(BinaryOp::Lt), runs(true)), (ends, runs(false))], None)
        }
        Qualifier::Delayed => tree::either(vec![(elapsed(BinaryOp::Ge), runs(true)), (left(), runs(false))], None),
        Qualifier::Entered => tree::either(vec![(entered(), runs(true))], Some(runs(false))),
        Qualifier::Left => tree::either(vec![(left(), runs(true))], Some(runs(false))),
        Qualifier::SetLimited => {
            tree::when(entered(), vec![control("set", tree::truth(true, at)), control("reset_in", time())])
        }
        Qualifier::SetDelayed => tree::when(entered(), vec![control("set_in", time())]),
        Qualifier::DelayedSet => {
            body.push(tree::when(entered(), vec![control("set_in", time())]));
            tree::when(left(), vec![tree::call(tree::control(action, "__cancel", at), Vec::new())])
        }
    };
    body.push(last);
}
