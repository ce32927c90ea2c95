//! Sequential function charts, written out as statements: each step becomes an instance of a block of the library, and so does what
//! runs each action. In each scan transitions are tested first, then steps are left and entered, then the actions run.

mod matiec;
mod standard;
mod tree;

use crate::added::{ACTIONS, CLOCK, FIRED};
use crate::ast::{
    Chart, File, Item, Name, Pou, PouKind, Statement, StatementKind, Transition, TypeKind, VarBlock, VarKind,
};
use crate::diagnostic::Missing;
use crate::dialect::Dialect;
use crate::log::Log;
use crate::spelling::Key;
use crate::{Code, Diagnostic, Span, nearest};
use rustc_hash::{FxHashMap, FxHashSet};
use staunch_runtime::Elementary;

/// The blocks of the library that a chart is written out with.
struct Blocks {
    clock: &'static str,
    step: &'static str,
    action: &'static str,
}

const STANDARD: Blocks = Blocks { clock: "__Chart", step: "__Step", action: "__Action" };
const MATIEC: Blocks = Blocks { clock: "__MatiecChart", step: "__MatiecStep", action: "__MatiecAction" };

/// Gives a body of statements to each POU that is a chart.
pub(crate) fn expand(files: &mut [File<'_>], log: &mut Log<'_>) {
    let charts: FxHashSet<_> = pous(files).filter(|it| it.chart.is_some()).map(|it| Key(it.name.text)).collect();
    for pou in pous(files) {
        let Some(mut chart) = pou.chart.take() else { continue };
        if let Some(base) = pou.extends.filter(|it| charts.contains(&Key(it.text))) {
            log.report(
                Diagnostic::new(
                    Code::E0515,
                    chart.span,
                    format!("`{}` has a chart, and so does what it extends", pou.name.text),
                )
                .label("a second chart")
                .other(base.span, "this has a chart, too")
                .help("keep one of the two, and declare an instance of the other block"),
            );
            pou.routines.retain(|it| it.kind != PouKind::Action);
            continue;
        }
        let dialect = log.dialect(chart.span);
        if !dialect.has_charts() {
            log.report(not_in(dialect, chart.span));
        }
        leave_out_numbers(&mut chart, pou, log);
        note_actions(&chart, pou, log);
        match is_sound(&chart, pou, log) {
            true => write_out(&chart, pou, dialect),
            // Its steps are not known to them.
            false => pou.routines.retain(|it| it.kind != PouKind::Action),
        }
    }
}

/// Notes what steps name: an action that several have is written out once.
fn note_actions(chart: &Chart<'_>, pou: &Pou<'_>, log: &Log<'_>) {
    if log.index.is_none() {
        return;
    }
    let variables = pou.blocks.iter().flat_map(|it| &it.vars).flat_map(|it| &it.names);
    let actions = pou.routines.iter().filter(|it| it.kind == PouKind::Action).map(|it| &it.name);
    let declared: FxHashMap<_, _> = variables.chain(actions).map(|it| (Key(it.text), it.span)).collect();
    for name in chart.steps.iter().flat_map(|it| &it.associations).map(|it| it.action) {
        declared.get(&Key(name.text)).into_iter().for_each(|it| log.note_declared(name.span, *it));
    }
}

fn pous<'a, 's>(files: &'a mut [File<'s>]) -> impl Iterator<Item = &'a mut Pou<'s>> {
    files.iter_mut().flat_map(|it| &mut it.items).filter_map(|it| match it {
        Item::Pou(pou) => Some(pou),
        Item::Types(_) | Item::Globals(_) | Item::Configuration(_) | Item::Test(_) => None,
    })
}

fn not_in(dialect: Dialect, at: Span) -> Diagnostic {
    let it = Diagnostic::new(
        Code::E0902,
        at,
        format!("a sequential function chart (SFC) is not supported in `{}`", dialect.name()),
    );
    it.label("charts are available in `iec` and `openplc`").help("write it as a CASE over its steps: `CASE step OF …`")
}

/// Reports what is wrong with a chart as a whole. Whether it can be written out, so that what is in it is checked, too.
fn is_sound<'s>(chart: &Chart<'s>, pou: &Pou<'s>, log: &mut Log<'_>) -> bool {
    let is_one = |it: &&Statement<'_>| !matches!(it.kind, StatementKind::Empty | StatementKind::Error);
    if let Some(statement) = pou.body.iter().find(is_one) {
        log.report(
            Diagnostic::new(
                Code::E0515,
                statement.span,
                "statements outside of the sequential function chart of this POU",
            )
            .label("no step runs this")
            .other(chart.span, "the chart is the body")
            .help("move it into an ACTION"),
        );
    }
    let named = |name: &Name<'_>| chart.steps.iter().any(|it| Key(it.name.text) == Key(name.text));
    let mut is_sound = true;
    for name in chart.transitions.iter().flat_map(|it| it.from.iter().chain(&it.to)).filter(|it| !named(it)) {
        let it = Diagnostic::missing(Missing::Step, name.text, name.span).label("not a step of this chart");
        log.report(match nearest(name.text, chart.steps.iter().map(|it| it.name.text)) {
            Some(meant) => it.help(format!("did you mean `{meant}`?")).fix(name.span, meant),
            None => it.help("declare it: `STEP Name: END_STEP`"),
        });
        is_sound = false;
    }
    if !chart.steps.iter().any(|it| it.is_initial) {
        let at = chart.steps.first().map_or(chart.span, |it| it.name.span);
        log.report(
            Diagnostic::new(Code::E0515, at, "the chart has no INITIAL_STEP")
                .label("no step is ever active")
                .help("write INITIAL_STEP for the step that is active at the start"),
        );
        is_sound = false;
    }
    let variables = pou.blocks.iter().flat_map(|it| &it.vars).flat_map(|it| &it.names);
    let routines = pou.routines.iter().map(|it| &it.name);
    let mut declared: FxHashMap<_, _> = variables.chain(routines).map(|it| (Key(it.text), it.span)).collect();
    for step in &chart.steps {
        is_sound &= is_free(&mut declared, step.name, log);
    }
    let variables = pou.blocks.iter().flat_map(|it| &it.vars).flat_map(|it| &it.names);
    let mut declared: FxHashMap<_, _> = variables.map(|it| (Key(it.text), it.span)).collect();
    for routine in pou.routines.iter().filter(|it| it.kind == PouKind::Action) {
        is_sound &= is_free(&mut declared, routine.name, log);
    }
    is_sound
}

/// Reports what steps name that is declared as something else than a BOOL, and takes it out.
fn leave_out_numbers(chart: &mut Chart<'_>, pou: &Pou<'_>, log: &mut Log<'_>) {
    let mut declared = FxHashMap::default();
    for decl in pou.blocks.iter().flat_map(|it| &it.vars) {
        if let TypeKind::Named(path) = &decl.ty.kind
            && let [ty] = path.as_slice()
            && Elementary::named(ty.text).is_some_and(|it| it != Elementary::Bool)
        {
            declared.extend(decl.names.iter().map(|it| (Key(it.text), *ty)));
        }
    }
    for step in &mut chart.steps {
        step.associations.retain(|it| {
            let Some(ty) = declared.get(&Key(it.action.text)) else { return true };
            log.report(
                Diagnostic::new(
                    Code::E0515,
                    it.action.span,
                    format!("`{}` is not an action: it is {}", it.action.text, ty.text),
                )
                .label("expected an ACTION or a BOOL variable")
                .other(ty.span, "declared here")
                .help("write an ACTION that assigns to it"),
            );
            false
        });
    }
}

/// Whether nothing else has a name, which is reported if something has.
fn is_free<'s>(declared: &mut FxHashMap<Key<'s>, Span>, name: Name<'s>, log: &mut Log<'_>) -> bool {
    let Some(first) = declared.insert(Key(name.text), name.span) else { return true };
    log.report(
        Diagnostic::new(Code::E0103, name.span, format!("`{}` is declared twice", name.text))
            .label("declared again here")
            .other(first, "first declared here")
            .help("rename one of them: steps, ACTIONs and variables share their names"),
    );
    false
}

/// An action of a chart, and what controls it.
#[derive(Clone, Copy)]
struct Action<'s> {
    name: Name<'s>,
    /// Its number among the controls.
    number: usize,
    /// It is no ACTION, but a BOOL variable.
    is_variable: bool,
}

/// The actions that steps name, by their names, and the ACTIONs that none does.
struct Actions<'s> {
    all: Vec<Action<'s>>,
    by_name: FxHashMap<Key<'s>, usize>,
}

impl<'s> Actions<'s> {
    fn of(chart: &Chart<'s>, pou: &Pou<'s>) -> Self {
        let mut actions = Self { all: Vec::new(), by_name: FxHashMap::default() };
        for routine in pou.routines.iter().filter(|it| it.kind == PouKind::Action) {
            actions.add(routine.name, false);
        }
        for association in chart.steps.iter().flat_map(|it| &it.associations) {
            actions.add(association.action, true);
        }
        actions
    }

    fn add(&mut self, name: Name<'s>, is_variable: bool) {
        let number = self.all.len();
        self.by_name.entry(Key(name.text)).or_insert_with(|| {
            self.all.push(Action { name, number, is_variable });
            number
        });
    }

    fn named(&self, name: Name<'s>) -> Option<Action<'s>> {
        self.by_name.get(&Key(name.text)).map(|it| self.all[*it])
    }

    fn variables(&self) -> impl Iterator<Item = &Action<'s>> {
        self.all.iter().filter(|it| it.is_variable)
    }
}

fn write_out<'s>(chart: &Chart<'s>, pou: &mut Pou<'s>, dialect: Dialect) {
    let is_matiec = match dialect {
        Dialect::Openplc => true,
        Dialect::Iec | Dialect::Cscape | Dialect::Codesys | Dialect::Openplc4 | Dialect::Logix | Dialect::Siemens => {
            false
        }
    };
    let actions = Actions::of(chart, pou);
    pou.blocks.push(variables(chart, &actions, if is_matiec { &MATIEC } else { &STANDARD }));
    if !chart.transitions.is_empty() {
        pou.blocks.push(fired(chart));
    }
    let mut body = vec![tree::call(tree::named(CLOCK, chart.span), Vec::new())];
    match is_matiec {
        true => matiec::write(chart, &actions, &mut body),
        false => standard::write(chart, &actions, &mut body),
    }
    let is_action = |it: &Pou<'s>| it.kind == PouKind::Action;
    for routine in pou.routines.iter_mut().filter(|it| is_action(it)) {
        let Some(action) = actions.named(routine.name) else { continue };
        // A RETURN of MATIEC's leaves the chart.
        let runs = match is_matiec {
            true => std::mem::take(&mut routine.body),
            false => vec![tree::call(tree::name(routine.name), Vec::new())],
        };
        body.push(tree::when(tree::control(action, "Q", routine.name.span), runs));
    }
    if is_matiec {
        pou.routines.retain(|it| !is_action(it));
    }
    pou.body = body;
}

/// The steps, and what the chart needs besides.
fn variables<'s>(chart: &Chart<'s>, actions: &Actions<'s>, blocks: &Blocks) -> VarBlock<'s> {
    let mut vars = vec![tree::variable(Name { text: CLOCK, span: chart.span }, blocks.clock)];
    for step in &chart.steps {
        let mut variable = tree::variable(step.name, blocks.step);
        variable.initial = step.is_initial.then(|| tree::initially("X", step.name.span));
        vars.push(variable);
    }
    if !actions.all.is_empty() {
        vars.push(tree::array(ACTIONS, actions.all.len(), blocks.action, chart.span));
    }
    VarBlock { vars, ..VarBlock::new(VarKind::Var, chart.span) }
}

fn fired<'s>(chart: &Chart<'s>) -> VarBlock<'s> {
    let vars = vec![tree::array(FIRED, chart.transitions.len(), "BOOL", chart.span)];
    VarBlock { vars, ..VarBlock::new(VarKind::Temp, chart.span) }
}

/// The numbers of the transitions in the order in which they are tested: those with a priority among the others as MATIEC inserts
/// them, the lowest first.
fn tested(transitions: &[Transition<'_>]) -> Vec<usize> {
    let mut order: Vec<usize> = Vec::new();
    let priority = |at: usize| transitions[at].priority.unwrap_or(0);
    for (at, transition) in transitions.iter().enumerate() {
        let place = match transition.priority {
            Some(own) => order.iter().position(|it| priority(*it) > own).unwrap_or(order.len()),
            None => order.len(),
        };
        order.insert(place, at);
    }
    order
}

/// The statements that leave the steps of the transitions that fire, and enter those after them. Some have left theirs.
fn fire<'s>(chart: &Chart<'s>, has_left: impl Fn(&Transition<'_>) -> bool, body: &mut Vec<Statement<'s>>) {
    for (at, transition) in chart.transitions.iter().enumerate().filter(|it| !has_left(it.1)) {
        body.push(tree::when(tree::fires(at, transition.span), moved(&transition.from, "__leave")));
    }
    for (at, transition) in chart.transitions.iter().enumerate() {
        body.push(tree::when(tree::fires(at, transition.span), moved(&transition.to, "__enter")));
    }
}

/// Leaves or enters steps.
fn moved<'s>(steps: &[Name<'s>], method: &'static str) -> Vec<Statement<'s>> {
    steps.iter().map(|it| tree::call(tree::member(tree::name(*it), method), Vec::new())).collect()
}
