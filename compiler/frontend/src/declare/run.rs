//! What a CONFIGURATION does in addition to running a PROGRAM: it connects parameters, `Main(x := g)`, a TASK's SINGLE
//! waits for an edge, with an INTERVAL or without, and a VAR_CONFIG gives variables of instances their addresses and initial values. Such a run is
//! written as a PROGRAM of its own: it holds the other one as an instance, and calls it. Where nothing lists
//! PROGRAMs, a VAR_CONFIG finds the one run of each by its PROGRAM's name.
//!
//! A variable that VAR_CONFIG binds belongs to its instance; the run copies the value at the address into it before
//! the call, and back after it if it is not an input.
//!
//! A PROGRAM that has one instance among the globals, since tasks of TwinCAT's share it or bodies name it, has runs that
//! hold nothing and call it by its name.

use crate::spelling::Key;
use crate::tasks::{Tasks, prepend};
use crate::types::address::is_input;
use crate::types::synthetic::Binding;
use crate::{Sources, Span, ast};
use ast::{ExprKind, PouKind, StatementKind, VarKind};
use rustc_hash::{FxHashMap, FxHashSet};
use staunch_ir::HELD_PROGRAM;

// A keyword, which no declaration can take.
const TURN: &str = "CONFIGURATION";

/// A run that is more than its PROGRAM's body.
pub(crate) struct Run<'s> {
    pub pou: ast::Pou<'s>,
    pub body: Vec<ast::Statement<'s>>,
    /// What a VAR_CONFIG binds: the variable, in the run, and its address.
    pub bound: Vec<Binding<'s>>,
    /// What it only gives an initial value: the variable, in the run, with its type and value.
    pub valued: Vec<(ast::Expr<'s>, ast::VarDecl<'s>)>,
    /// The name in the CONFIGURATION.
    pub instance: Span,
}

type Listed<'a, 's> = (&'a ast::Resource<'s>, &'a ast::ProgramInstance<'s>);

pub(super) fn configurations<'a, 's>(files: &'a [ast::File<'s>]) -> impl Iterator<Item = &'a ast::Configuration<'s>> {
    files.iter().flat_map(|it| &it.items).filter_map(|it| match it {
        ast::Item::Configuration(it) => Some(it),
        ast::Item::Pou(_) | ast::Item::Types(_) | ast::Item::Globals(_) | ast::Item::Test(_) => None,
    })
}

/// The runs that CONFIGURATIONs list.
fn listed<'a, 's>(files: &'a [ast::File<'s>]) -> Vec<Listed<'a, 's>> {
    let resources = configurations(files).flat_map(|it| &it.resources);
    resources.flat_map(|resource| resource.programs.iter().map(move |it| (resource, it))).collect()
}

/// Whether what a RESOURCE lists are the calls of a task of TwinCAT's, which have no names of their own.
pub(crate) fn is_task(resource: &ast::Resource<'_>, sources: &Sources) -> bool {
    let is_of_it = |it: &ast::ProgramInstance<'_>| sources.get(it.name.span.file).is_assembled();
    resource.name.is_none() && resource.programs.iter().all(is_of_it)
}

/// How CONFIGURATIONs list a PROGRAM.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Listing {
    /// None lists any PROGRAM.
    Absent,
    /// They list others.
    Others,
    /// Each run is of the one instance: there is one run, or tasks of TwinCAT's call the PROGRAM.
    One,
    /// Each run has an instance of its own.
    Several,
}

/// How the PROGRAM of a name is listed. One that is connected to variables, or waits for a SINGLE, has its own instance.
pub(crate) fn listing(files: &[ast::File<'_>], sources: &Sources, program: Key<'_>) -> Listing {
    let all = listed(files);
    if all.is_empty() {
        return Listing::Absent;
    }
    let its: Vec<_> = all.into_iter().filter(|it| Key(it.1.program.text) == program).collect();
    let is_plain = |(resource, it): &Listed<'_, '_>| it.connections.is_empty() && trigger(resource, it).is_none();
    match its.as_slice() {
        [] => Listing::Others,
        [one] if is_plain(one) => Listing::One,
        several if several.iter().all(|it| is_task(it.0, sources)) => Listing::One,
        _ => Listing::Several,
    }
}

/// The runs of all configurations that take a PROGRAM of their own. Where one run of a PROGRAM does, its
/// other ones do as well. Unit tests run no PROGRAM by itself. Those with their names in `shared` have one instance.
pub(crate) fn runs<'a, 's>(
    files: &'a [ast::File<'s>],
    tests: bool,
    sources: &Sources,
    shared: &FxHashSet<Span>,
) -> Vec<Run<'s>> {
    let items = || files.iter().flat_map(|it| &it.items);
    let listed = listed(files);
    let in_files = files.iter().flat_map(|it| &it.bindings);
    let bindings: Vec<_> = configurations(files).flat_map(|it| &it.bindings).chain(in_files).collect();
    let pous: FxHashMap<_, _> = items().filter_map(pou).map(|it| (Key(it.name.text), it)).collect();
    let bound_in = |resource: &ast::Resource<'s>, it: &ast::ProgramInstance<'s>| {
        let bound = |binding: &&'a ast::Binding<'s>| {
            let target = within(&binding.target, resource, it)?;
            let decl = declaration_of(&target, it, &pous).and_then(|it| it.1);
            // What has an address of its own is reported where the CONFIGURATION is checked.
            let is_open = binding.located.address.is_none() || decl.is_none_or(|it| it.known_address().is_none());
            is_open.then_some((target, &binding.located))
        };
        bindings.iter().filter_map(bound).collect::<Vec<_>>()
    };
    let cycles = Tasks::of(files, tests);
    if listed.is_empty() && !tests {
        let resource = ast::Resource::default();
        // What nothing connects is reported where the instances are.
        let programs = items().filter_map(program).enumerate().filter(|(_, it)| !has_in_outs(it));
        let own = |(at, it): (usize, &ast::Pou<'s>)| {
            let begin = || cycles.map(|tasks| tasks.begin(files, None, at + 1, it.name.span));
            match by_name(it, &bindings) {
                Some(it) => Some(run(&it, None, bound_in(&resource, &it), begin())),
                None => shared.contains(&it.name.span).then(|| call(&unlisted(it, it.name.span), begin())),
            }
        };
        return programs.filter_map(own).collect();
    }
    let programs: FxHashMap<_, _> = items().filter_map(program).map(|it| (Key(it.name.text), it)).collect();
    let has_paths = items().filter_map(pou).any(has_instance_path);
    let asks = |(resource, it): &&(&ast::Resource<'s>, &ast::ProgramInstance<'s>)| {
        let takes = programs.get(&Key(it.program.text)).is_some_and(|it| has_in_outs(it));
        let is_bound = bindings.iter().any(|binding| within(&binding.target, resource, it).is_some());
        let is_same = |other: &&(_, &ast::ProgramInstance<'s>)| Key(other.1.program.text) == Key(it.program.text);
        // Instances with other paths have other initial values.
        let has_path = has_paths && !is_task(resource, sources) && listed.iter().filter(is_same).count() > 1;
        // Each of several notes whose cycle it is.
        let is_one_of_several =
            cycles.is_some() && !is_task(resource, sources) && listed.iter().filter(is_same).count() > 1;
        takes
            || has_path
            || is_one_of_several
            || is_bound
            || !it.connections.is_empty()
            || trigger(resource, it).is_some()
    };
    let wrapped: FxHashSet<_> = listed.iter().filter(asks).map(|(_, it)| Key(it.program.text)).collect();
    let is_shared = |resource: &ast::Resource<'s>, program: &ast::Pou<'s>| {
        let is_same = |it: &&Listed<'_, 's>| Key(it.1.program.text) == Key(program.name.text);
        let is_called_twice = || is_task(resource, sources) && listed.iter().filter(is_same).count() > 1;
        !tests && (shared.contains(&program.name.span) || is_called_twice())
    };
    let own = |(at, (resource, it)): (usize, &Listed<'_, 's>)| {
        let key = Key(it.program.text);
        let program = programs.get(&key)?;
        let begin = || cycles.map(|tasks| tasks.begin(files, Some((resource, it)), at + 1, it.program.span));
        match wrapped.contains(&key) {
            true => Some(run(it, trigger(resource, it), bound_in(resource, it), begin())),
            false => is_shared(resource, program).then(|| call(it, begin())),
        }
    };
    listed.iter().enumerate().filter_map(own).collect()
}

/// Where the program asks for its tasks, the other runs note whose cycle it is in the bodies of their PROGRAMs.
pub(crate) fn begin_cycles<'s>(files: &mut [ast::File<'s>], runs: &[Run<'s>], tests: bool) {
    let Some(tasks) = Tasks::of(files, tests).filter(|_| !tests) else { return };
    let has_run = |instance: Span| runs.iter().any(|it| it.instance == instance);
    let mut begins: FxHashMap<Key<'s>, ast::Statement<'s>> = FxHashMap::default();
    let all = listed(files);
    for (number, run) in (1..).zip(&all).filter(|(_, it)| !has_run(it.1.name.span)) {
        let program = run.1.program;
        begins.insert(Key(program.text), tasks.begin(files, Some(*run), number, program.span));
    }
    let programs = files.iter().flat_map(|it| &it.items).filter_map(program).map(|it| it.name);
    for (number, name) in (1..).zip(programs).filter(|(_, it)| all.is_empty() && !has_run(it.span)) {
        begins.insert(Key(name.text), tasks.begin(files, None, number, name.span));
    }
    for item in files.iter_mut().flat_map(|it| &mut it.items) {
        if let ast::Item::Pou(pou) = item
            && pou.kind == PouKind::Program
            && let Some(begin) = begins.remove(&Key(pou.name.text))
        {
            prepend(pou, begin);
        }
    }
}

/// The run of a PROGRAM with one instance, which is among the globals.
fn call<'s>(instance: &ast::ProgramInstance<'s>, begin: Option<ast::Statement<'s>>) -> Run<'s> {
    let span = instance.program.span;
    let expr = |kind| ast::Expr { kind, span };
    let (first, rest) = match instance.namespace.split_first() {
        Some((first, rest)) => (*first, [rest, &[instance.program]].concat()),
        None => (instance.program, Vec::new()),
    };
    let member = |base, name| expr(ExprKind::Member(Box::new(base), name));
    let callee = rest.into_iter().fold(expr(ExprKind::Name(first)), member);
    let kind = StatementKind::Expr(expr(ExprKind::Call(Box::new(callee), Vec::new())));
    let pou = ast::Pou::new(PouKind::Program, instance.program, span);
    let body = begin.into_iter().chain([ast::Statement { kind, span }]).collect();
    Run { pou, body, bound: Vec::new(), valued: Vec::new(), instance: instance.name.span }
}

fn has_instance_path(pou: &ast::Pou<'_>) -> bool {
    pou.blocks.iter().flat_map(|it| &it.vars).any(|it| it.instance_path.is_some())
}

/// The run of a PROGRAM that nothing lists, by its own name, if something of it is bound.
fn by_name<'s>(program: &ast::Pou<'s>, bindings: &[&ast::Binding<'s>]) -> Option<ast::ProgramInstance<'s>> {
    let first =
        bindings.iter().find_map(|it| it.target.first_name().filter(|it| Key(it.text) == Key(program.name.text)));
    Some(unlisted(program, first?.span))
}

/// The run of a PROGRAM by its own name, which is named at `span`.
pub(crate) fn unlisted<'s>(program: &ast::Pou<'s>, span: Span) -> ast::ProgramInstance<'s> {
    let (name, namespace) = (program.name, Vec::new());
    ast::ProgramInstance { name, task: None, namespace, program: ast::Name { span, ..name }, connections: Vec::new() }
}

/// A path through an instance of the CONFIGURATION, `Run.valve.open` or `Resource.Run.valve.open`, as it is in the run.
pub(crate) fn within<'s>(
    path: &ast::Expr<'s>,
    resource: &ast::Resource<'_>,
    instance: &ast::ProgramInstance<'_>,
) -> Option<ast::Expr<'s>> {
    let is = |name: &ast::Name<'_>, wanted: &ast::Name<'_>| Key(name.text) == Key(wanted.text);
    let inner = |base: &ast::Expr<'s>| match &base.kind {
        ExprKind::Name(name) if is(name, &instance.name) => Some(held(base.span)),
        ExprKind::Member(outer, name) if is(name, &instance.name) => match &outer.kind {
            ExprKind::Name(first) if resource.name.is_some_and(|it| is(first, &it)) => Some(held(base.span)),
            _ => within(base, resource, instance),
        },
        _ => within(base, resource, instance),
    };
    let kind = match &path.kind {
        ExprKind::Member(base, name) => ExprKind::Member(Box::new(inner(base)?), *name),
        ExprKind::Index(base, indices) => ExprKind::Index(Box::new(inner(base)?), indices.clone()),
        _ => return None,
    };
    Some(ast::Expr { kind, span: path.span })
}

/// The POU of which the end of a path is an instance, if it is one, and the declaration of that variable.
pub(crate) fn declaration_of<'a, 's>(
    path: &ast::Expr<'s>,
    instance: &ast::ProgramInstance<'s>,
    pous: &FxHashMap<Key<'s>, &'a ast::Pou<'s>>,
) -> Option<(Option<&'a ast::Pou<'s>>, Option<&'a ast::VarDecl<'s>>)> {
    match &path.kind {
        ExprKind::Name(_) => Some((pous.get(&Key(instance.program.text)).copied(), None)),
        ExprKind::Index(base, _) => declaration_of(base, instance, pous),
        ExprKind::Member(base, name) => {
            let owner = declaration_of(base, instance, pous)?.0?;
            let declares = |it: &&ast::VarDecl<'s>| it.names.iter().any(|it| Key(it.text) == Key(name.text));
            let decl = owner.blocks.iter().flat_map(|it| &it.vars).find(declares)?;
            let mut ty = &decl.ty.kind;
            while let ast::TypeKind::Array { element, .. } = ty {
                ty = &element.kind;
            }
            let inner = match ty {
                ast::TypeKind::Named(path) => path.last().and_then(|it| pous.get(&Key(it.text)).copied()),
                _ => None,
            };
            Some((inner, Some(decl)))
        }
        _ => None,
    }
}

/// The PROGRAM that a run holds.
fn held<'s>(span: Span) -> ast::Expr<'s> {
    ast::Expr { kind: ExprKind::Name(ast::Name { text: HELD_PROGRAM, span }), span }
}

fn pou<'a, 's>(item: &'a ast::Item<'s>) -> Option<&'a ast::Pou<'s>> {
    match item {
        ast::Item::Pou(pou) => Some(pou),
        ast::Item::Types(_) | ast::Item::Globals(_) | ast::Item::Configuration(_) | ast::Item::Test(_) => None,
    }
}

fn program<'a, 's>(item: &'a ast::Item<'s>) -> Option<&'a ast::Pou<'s>> {
    pou(item).filter(|it| it.kind == PouKind::Program)
}

pub(crate) fn has_in_outs(pou: &ast::Pou<'_>) -> bool {
    pou.blocks.iter().any(|it| it.kind == VarKind::InOut)
}

/// What says when a TASK with SINGLE runs.
struct Trigger<'a, 's> {
    single: &'a ast::Expr<'s>,
    interval: Option<&'a ast::Expr<'s>>,
}

/// That of the instance's TASK, unless its SINGLE is FALSE.
fn trigger<'a, 's>(resource: &'a ast::Resource<'s>, instance: &ast::ProgramInstance<'s>) -> Option<Trigger<'a, 's>> {
    let name = instance.task?;
    let task = resource.tasks.iter().find(|it| it.name.text.eq_ignore_ascii_case(name.text))?;
    let single = property(task, "SINGLE").filter(|it| !is_false(it))?;
    Some(Trigger { single, interval: property(task, "INTERVAL") })
}

pub(crate) fn property<'a, 's>(task: &'a ast::Task<'s>, name: &str) -> Option<&'a ast::Expr<'s>> {
    task.properties.iter().find(|(it, _)| it.text.eq_ignore_ascii_case(name)).map(|(_, expr)| expr)
}

/// SINGLE := FALSE: the TASK goes by its INTERVAL.
pub(crate) fn is_false(expr: &ast::Expr<'_>) -> bool {
    matches!(&expr.kind, ExprKind::Literal(it) if it.value == ast::LiteralValue::Bool(false))
}

fn run<'s>(
    instance: &ast::ProgramInstance<'s>,
    trigger: Option<Trigger<'_, 's>>,
    bindings: Vec<(ast::Expr<'s>, &ast::VarDecl<'s>)>,
    begin: Option<ast::Statement<'s>>,
) -> Run<'s> {
    let span = instance.program.span;
    let name = |text: &'static str| ast::Name { text, span };
    let variable = |text, path| {
        let ty = ast::TypeSpec { kind: ast::TypeKind::Named(path), span };
        ast::VarDecl::new(vec![name(text)], ty, span)
    };
    let expr = |kind| ast::Expr { kind, span };
    let named = |text| expr(ExprKind::Name(name(text)));
    let statement = |kind| ast::Statement { kind, span };
    let call = |text, arguments| statement(StatementKind::Expr(expr(ExprKind::Call(Box::new(named(text)), arguments))));
    let mut vars = vec![variable(HELD_PROGRAM, [instance.namespace.as_slice(), &[instance.program]].concat())];
    let mut body = vec![call(HELD_PROGRAM, instance.connections.clone())];
    let mut declared = FxHashSet::default();
    let (mut bound, mut valued) = (Vec::new(), Vec::new());
    for (target, located) in bindings {
        let Some(address) = located.address else {
            valued.push((target, located.clone()));
            continue;
        };
        let at = ast::Expr { kind: ExprKind::Name(address), span: address.span };
        let copy = |to: &ast::Expr<'s>, from: &ast::Expr<'s>| ast::Statement {
            kind: StatementKind::Assign { target: to.clone(), value: from.clone() },
            span: target.span,
        };
        body.insert(0, copy(&target, &at));
        if !is_input(address) {
            body.push(copy(&at, &target));
        }
        if declared.insert(Key(address.text)) {
            vars.push(located.clone());
        }
        bound.push((target, address));
    }
    body.splice(0..0, begin);
    if let Some(trigger) = trigger {
        let Trigger { single, interval } = trigger;
        let (block, inputs) = match interval {
            None => ("R_TRIG", vec![("CLK", single)]),
            Some(interval) => ("__TASK", vec![("SINGLE", single), ("INTERVAL", interval)]),
        };
        vars.push(variable(TURN, vec![name("IEC"), name(block)]));
        let input = |(pin, value): (&'static str, &ast::Expr<'s>)| ast::Argument {
            kind: ast::ArgumentKind::Input(name(pin), value.clone()),
            span: value.span,
        };
        let is_due = expr(ExprKind::Member(Box::new(named(TURN)), name("Q")));
        body = vec![
            call(TURN, inputs.into_iter().map(input).collect()),
            statement(StatementKind::If { branches: vec![(is_due, body)], otherwise: None }),
        ];
    }
    let blocks = vec![ast::VarBlock { vars, ..ast::VarBlock::new(VarKind::Var, span) }];
    let pou = ast::Pou { blocks, ..ast::Pou::new(PouKind::Program, instance.program, span) };
    Run { pou, body, bound, valued, instance: instance.name.span }
}
