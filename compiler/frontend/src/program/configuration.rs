//! CONFIGURATION, RESOURCE and TASK: which programs run, and how often.

use crate::ast;
use crate::declare::run::{
    Listing, declaration_of, has_in_outs, is_false, is_task, listing, property, unlisted, within,
};
use crate::diagnostic::Missing;
use crate::dialect::Dialect;
use crate::dialect::rules::ProgramOrder;
use crate::expr::constant::constant;
use crate::names::{Entry, Found, Meaning, Sense};
use crate::spelling::{Key, nearest};
use crate::start_up::is_start_up;
use crate::types::address::is_input;
use crate::types::declarations::Declarations;
use crate::{Code, Diagnostic, Span};
use rustc_hash::{FxHashMap, FxHashSet};
use staunch_ir::{Class, Elementary, Instance, Section, Value};

pub(super) const LOWEST_PRIORITY: u32 = 65535;

/// Fills the program's instances: those of the configurations, or else one of each PROGRAM that no other calls.
pub(super) fn instances<'s>(declarations: &mut Declarations<'s>, files: &'s [ast::File<'s>]) {
    let items = files.iter().flat_map(|it| &it.items);
    let configurations: Vec<_> = items
        .filter_map(|it| match it {
            ast::Item::Configuration(it) => Some(it),
            ast::Item::Pou(_) | ast::Item::Types(_) | ast::Item::Globals(_) | ast::Item::Test(_) => None,
        })
        .collect();
    let bindings = configurations.iter().flat_map(|it| &it.bindings).chain(files.iter().flat_map(|it| &it.bindings));
    let bindings: Vec<_> = bindings.collect();
    declarations.check_configurations(&configurations, &bindings);
    let runs: FxHashMap<_, _> =
        declarations.pous.iter().enumerate().filter_map(|(at, it)| Some((it.run?, at))).collect();
    let (mut listed, mut tasks) = (Vec::new(), Vec::new());
    for resource in configurations.iter().flat_map(|it| &it.resources) {
        let timings = declarations.resource(resource, &runs, &mut listed);
        tasks.extend(resource.tasks.iter().map(|it| it.name.text).zip(timings));
    }
    declarations.set_task_info(&tasks);
    declarations.report_globals_of_several(&listed);
    if declarations.log.options.tests {
        return declarations.test_instances();
    }
    declarations.program.is_configured = !declarations.program.instances.is_empty();
    if declarations.program.is_configured {
        declarations.start_ups_first();
        return mark_listed(&mut declarations.program.instances, &declarations.program.classes);
    }
    let is_program = |at: &usize| declarations.pous[*at].ast.kind == ast::PouKind::Program;
    let is_shared =
        |at: usize| runs.get(&declarations.pous[at].ast.name.span).is_some_and(|it| declarations.is_run_of_shared(*it));
    let is_alone = |at: &usize| {
        is_program(at) && !declarations.is_of_library(*at) && (!declarations.is_named_program(*at) || is_shared(*at))
    };
    let mut programs: Vec<_> = (0..declarations.written_pous().len()).filter(is_alone).collect();
    programs.sort_by_key(|at| !is_start_up(declarations.pous[*at].ast));
    // What says that a PROGRAM runs at the start says that all run.
    declarations.program.is_configured = programs.iter().any(|at| is_start_up(declarations.pous[*at].ast));
    for at in programs {
        if declarations.report_not_connected(at) {
            continue;
        }
        let run = runs.get(&declarations.pous[at].ast.name.span).copied();
        let Some(program) = declarations.class_of_slot(run.unwrap_or(at)) else { continue };
        declarations.program.instances.push(Instance {
            name: declarations.pous[at].ast.name.text.to_owned(),
            program,
            task: None,
            interval: None,
            priority: LOWEST_PRIORITY,
        });
    }
    if declarations.program.is_configured {
        mark_listed(&mut declarations.program.instances, &declarations.program.classes);
    }
}

/// What runs a program that is compiled takes several instances of the lowest priority and of their PROGRAMs' names for
/// ones that no CONFIGURATION lists.
fn mark_listed(instances: &mut [Instance], classes: &[Class]) {
    let is_plain = |it: &Instance| {
        let is_named = it.name == classes[it.program.index()].name;
        is_named && it.interval.is_none() && it.priority == LOWEST_PRIORITY
    };
    if instances.len() > 1 && instances.iter().all(is_plain) {
        instances.iter_mut().for_each(|it| it.priority = LOWEST_PRIORITY - 1);
    }
}

/// An address that the configuration of the devices gives, in the system that the program moves from.
fn address_of_devices(address: ast::Name<'_>, name: ast::Name<'_>, others: usize) -> Diagnostic {
    let message = format!("`{}` gets its address from the devices' configuration", name.text);
    let area = &address.text[..2];
    let lint =
        Diagnostic::new(Code::W0617, address.span, message).label("this system wants the address in the program");
    let lint = match others {
        0 => lint,
        1 => lint.note("so does 1 more variable"),
        _ => lint.note(format!("so do {others} more variables")),
    };
    lint.help(format!("write an address of its width: `{area}X0.0` for a BOOL, `{area}W2` for an INT"))
}

fn last_name<'s>(path: &ast::Expr<'s>) -> Option<ast::Name<'s>> {
    match &path.kind {
        ast::ExprKind::Member(_, name) | ast::ExprKind::Name(name) => Some(*name),
        ast::ExprKind::Index(base, _) => last_name(base),
        _ => None,
    }
}

/// How often the SINGLE of a TASK with this INTERVAL is looked at: a part of the INTERVAL of which there is a whole
/// number, at most 10 ms, in whole milliseconds where the INTERVAL is.
fn looked_at(interval: i64) -> i64 {
    const MILLISECOND: i64 = 1_000_000;
    let fewest = interval.div_euclid(10 * MILLISECOND) + i64::from(interval % (10 * MILLISECOND) != 0);
    let most = (interval / MILLISECOND).clamp(fewest, fewest + 100);
    let unit = if interval % MILLISECOND == 0 { MILLISECOND } else { 1 };
    let parts = (fewest..=most).find(|it| interval / unit % it == 0);
    parts.map_or(MILLISECOND.min(interval), |it| interval / it)
}

#[derive(Clone, Copy)]
pub(super) struct Timing {
    pub interval: Option<i64>,
    pub priority: u32,
}

impl<'s> Declarations<'s> {
    /// Adds the PROGRAMs that run once after each start, which no CONFIGURATION lists, before those that it does.
    fn start_ups_first(&mut self) {
        let is_listed = |this: &Self, at: usize| {
            let class = this.class_of_slot(at);
            this.program.instances.iter().any(|it| Some(it.program) == class)
        };
        let found = (0..self.written_pous().len()).filter(|at| is_start_up(self.pous[*at].ast));
        let found: Vec<_> = found.filter(|at| !self.is_of_library(*at) && !is_listed(self, *at)).collect();
        for (at, slot) in found.into_iter().enumerate() {
            let Some(program) = self.class_of_slot(slot) else { continue };
            let name = self.pous[slot].ast.name.text.to_owned();
            let start_up = Instance { name, program, task: None, interval: None, priority: 0 };
            self.program.instances.insert(at, start_up);
        }
    }

    /// One instance of each TEST, and nothing else.
    fn test_instances(&mut self) {
        let is_test = |at: &usize| self.pous[*at].ast.kind == ast::PouKind::Test;
        let tests: Vec<_> = (0..self.pous.len()).filter(is_test).collect();
        for at in tests {
            let Some(program) = self.class_of_slot(at) else { continue };
            let name = self.emitted_name(at);
            let (interval, priority) = (None, LOWEST_PRIORITY);
            self.program.instances.push(Instance { name, program, task: None, interval, priority });
        }
    }

    fn check_configurations(
        &mut self,
        configurations: &[&'s ast::Configuration<'s>],
        bindings: &[&'s ast::Binding<'s>],
    ) {
        // Each task of TwinCAT's is in a file of its own, and its CONFIGURATION and RESOURCE are not written there.
        let is_of_task = |it: &&&ast::Configuration<'_>| {
            let source = self.log.sources.get(it.span.file);
            source.is_assembled() && it.resources.iter().all(|it| it.name.is_none())
        };
        // Those that only declare global variables add to the one that runs PROGRAMs.
        let runs = |it: &ast::Resource<'_>| it.name.is_some() || !it.tasks.is_empty() || !it.programs.is_empty();
        let alone = configurations.iter().filter(|it| !is_of_task(it) && it.resources.iter().any(runs));
        let alone: Vec<_> = alone.collect();
        let tasks = configurations.iter().find(is_of_task).filter(|_| !alone.is_empty());
        if let [first, second, ..] = alone.into_iter().chain(tasks).collect::<Vec<_>>().as_slice() {
            self.report(
                Diagnostic::new(Code::E0902, second.name.span, "a second CONFIGURATION is not supported yet")
                    .label("a program can have one, with one or more RESOURCEs")
                    .other(first.name.span, "the first one"),
            );
        }
        for configuration in configurations {
            self.names_once(configuration.resources.iter().filter_map(|it| it.name));
        }
        let resources = configurations.iter().flat_map(|it| &it.resources);
        for resource in resources.clone() {
            self.names_once(resource.tasks.iter().map(|it| it.name));
        }
        let (called, declared): (Vec<_>, Vec<_>) = resources.partition(|it| is_task(it, self.log.sources));
        self.names_once(declared.into_iter().flat_map(|it| &it.programs).map(|it| it.name));
        let is_held = |it: &&ast::ProgramInstance<'s>| !self.is_shared_run(it);
        let held: Vec<_> = called.into_iter().flat_map(|it| &it.programs).filter(is_held).map(|it| it.name).collect();
        self.called_once(held.into_iter());
        // Unit tests run none of its instances.
        if !self.log.options.tests {
            self.check_bindings(configurations, bindings);
        }
        self.check_unbound(bindings);
    }

    /// Reports a binding of a VAR_CONFIG that is not to a variable of an instance, and an output of two variables.
    fn check_bindings(&mut self, configurations: &[&'s ast::Configuration<'s>], bindings: &[&'s ast::Binding<'s>]) {
        let mut written: FxHashMap<Key<'s>, Span> = FxHashMap::default();
        let mut bound: FxHashMap<Key<'s>, Span> = FxHashMap::default();
        let pous = self.written_pous().iter().map(|it| (Key(it.ast.name.text), it.ast)).collect();
        let direct = ast::Resource::default();
        let default = self.unlisted_programs(configurations);
        let listed = configurations.iter().flat_map(|it| &it.resources);
        let listed = listed.flat_map(|it| it.programs.iter().map(move |run| (it, run)));
        let instances: Vec<_> = listed.chain(default.iter().map(|it| (&direct, it))).collect();
        for ast::Binding { target, located } in bindings {
            let found = instances.iter().find_map(|(it, run)| Some((within(target, it, run)?, it, run)));
            if let Some((path, resource, run)) = &found {
                self.note_bound(target, path, resource, run, &pous);
                if self.report_called_and_bound(run, target) || self.lacks_address_and_value(target, located) {
                    continue;
                }
                let decl = declaration_of(path, run, &pous).and_then(|it| it.1);
                if !self.may_be_bound(target, decl, located) {
                    continue;
                }
                if let Some(first) = bound.insert(Key(self.log.sources.text(target.span)), target.span) {
                    self.report(
                        Diagnostic::new(Code::E0409, target.span, "this variable appears twice in VAR_CONFIG")
                            .label("bound again here")
                            .other(first, "first bound here")
                            .help("write address and value together: `run.x AT %MW0 : INT := 5;`"),
                    );
                }
            } else {
                let instances: Vec<_> = instances.iter().map(|it| it.1.name.text).collect();
                let from = if default.is_empty() { "an instance of the CONFIGURATION" } else { "a PROGRAM" };
                let error = Diagnostic::new(Code::E0101, target.span, "this is not a variable of an instance")
                    .label(format!("expected a path that starts with {from}"));
                self.report(match instances.first() {
                    Some(_) => error.help(format!("expected {}", crate::diagnostic::wording::any_of(&instances))),
                    None => error.help("run a PROGRAM in it: `PROGRAM run : Main;`"),
                });
                continue;
            }
            let Some(address) = located.address else { continue };
            if is_input(address) {
                continue;
            }
            if let Some(first) = written.insert(Key(address.text), address.span) {
                self.report(
                    Diagnostic::new(
                        Code::E0409,
                        address.span,
                        format!("two variables are bound to `{}`", address.text),
                    )
                    .label("it is not known which of them is written there")
                    .other(first, "the other one")
                    .help("bind one of them, and read it where the other is needed"),
                );
            }
        }
    }

    /// Notes what the names of a VAR_CONFIG's path mean: a RESOURCE, an instance, and then variables.
    fn note_bound(
        &self,
        target: &ast::Expr<'s>,
        path: &ast::Expr<'s>,
        resource: &ast::Resource<'s>,
        run: &ast::ProgramInstance<'s>,
        pous: &FxHashMap<Key<'s>, &ast::Pou<'s>>,
    ) {
        if self.log.index.is_none() {
            return;
        }
        let mut part = path;
        while let ast::ExprKind::Member(base, _) | ast::ExprKind::Index(base, _) = &part.kind {
            if let ast::ExprKind::Member(_, name) = &part.kind
                && let Some((_, Some(decl))) = declaration_of(part, run, pous)
                && let Some(declared) = decl.names.iter().find(|it| Key(it.text) == Key(name.text))
            {
                self.log.note_declared(name.span, declared.span);
            }
            part = base;
        }
        // What stands for the instance in the path is written with the RESOURCE in the target.
        let mut written = target;
        while let ast::ExprKind::Member(base, _) | ast::ExprKind::Index(base, _) = &written.kind
            && written.span != part.span
        {
            written = base;
        }
        let declared = [Some(run.name), resource.name].into_iter().flatten();
        for (name, declared) in written.path().unwrap_or_default().iter().rev().zip(declared) {
            self.log.note_declared(name.span, declared.span);
        }
    }

    /// The run of each PROGRAM by its name, where no CONFIGURATION lists any.
    fn unlisted_programs(&self, configurations: &[&'s ast::Configuration<'s>]) -> Vec<ast::ProgramInstance<'s>> {
        if configurations.iter().flat_map(|it| &it.resources).any(|it| !it.programs.is_empty()) {
            return Vec::new();
        }
        let is_program = |at: &usize| self.pous[*at].ast.kind == ast::PouKind::Program && !self.is_of_library(*at);
        let programs = (0..self.written_pous().len()).filter(is_program).map(|at| self.pous[at].ast);
        programs.map(|it| unlisted(it, it.name.span)).collect()
    }

    /// Reports a VAR_CONFIG of a PROGRAM that others call by its name.
    fn report_called_and_bound(&mut self, run: &ast::ProgramInstance<'s>, target: &ast::Expr<'s>) -> bool {
        let called = self.named_programs.iter().find(|(at, _)| self.pous[**at].ast.name.span == run.name.span);
        let Some((slot, named)) = called else { return false };
        let (slot, first, runs) = (*slot, named.first, named.runs);
        let has_run = self.run_of_program(slot).is_some();
        let label = match () {
            () if has_in_outs(self.pous[slot].ast) => {
                "a VAR_CONFIG does not reach into a called PROGRAM with a VAR_IN_OUT yet"
            }
            () if !has_run => "a CONFIGURATION lists PROGRAMs, but not this one",
            () if !runs => "bound variables are copied before and after its body, which is never called",
            () => return false,
        };
        self.report(
            Diagnostic::new(Code::E0902, target.span, format!("`{}` is called by name", run.name.text))
                .label(label)
                .other(first, "named here")
                .help(
                    "give the variable its address or value where it is declared, or do not call the PROGRAM by name",
                ),
        );
        true
    }

    fn lacks_address_and_value(&mut self, target: &ast::Expr<'s>, located: &ast::VarDecl<'s>) -> bool {
        let lacks = located.address.is_none() && located.initial.is_none();
        if lacks {
            let (name, ty) = (self.log.sources.text(target.span), self.log.sources.text(located.ty.span));
            let help = format!("write `{name} AT %…0 : {ty};`, or `{name} : {ty} := …;`");
            self.report(
                Diagnostic::new(Code::E0409, target.span, "expected an address or an initial value")
                    .label("this has neither")
                    .help(help),
            );
        }
        lacks
    }

    /// Whether a variable may be at the address that a VAR_CONFIG gives it; reports if not.
    fn may_be_bound(
        &mut self,
        target: &ast::Expr<'s>,
        decl: Option<&ast::VarDecl<'s>>,
        located: &ast::VarDecl<'s>,
    ) -> bool {
        let (Some(declared), Some(address)) = (decl.and_then(|it| it.address), located.address) else { return true };
        let area = |it: ast::Name<'s>| it.text.get(1..2).map(str::to_ascii_uppercase);
        let error = if decl.is_some_and(|it| it.known_address().is_some()) {
            Diagnostic::new(Code::E0409, target.span, format!("this variable is at `{}`", declared.text))
                .label("VAR_CONFIG can only complete `%I*`, `%Q*` or `%M*`")
        } else if area(declared) == area(address) {
            return true;
        } else {
            Diagnostic::new(Code::E0409, address.span, format!("this variable is declared at `{}`", declared.text))
                .label("this address is in another area")
        };
        self.report(error.other(declared.span, "declared here"));
        false
    }

    /// Reports `AT %I*` where no VAR_CONFIG gives the address. CODESYS and TwinCAT keep that in the device's tree.
    fn check_unbound(&mut self, bindings: &[&'s ast::Binding<'s>]) {
        let located = bindings.iter().filter(|it| it.located.address.is_some());
        let bound: FxHashSet<_> = located.filter_map(|it| last_name(&it.target)).map(|it| Key(it.text)).collect();
        let pous = self.pous.iter().map(|it| it.ast).filter(|it| !it.kind.is_function());
        let declared = pous.flat_map(|it| &it.blocks).flat_map(|it| &it.vars);
        let globals = self.globals.iter().map(|it| it.decl);
        let open = declared.chain(globals).filter(|it| it.known_address().is_none());
        let open: Vec<_> = open.filter_map(|it| Some((it.address?, it.names.first()?))).collect();
        let is_open = |it: &(ast::Name<'s>, &ast::Name<'s>)| {
            !self.dialect(it.0.span).leaves_addresses_open() && !bound.contains(&Key(it.1.text))
        };
        let open: Vec<_> = open.into_iter().filter(is_open).collect();
        if self.log.options.moved_from.is_some_and(Dialect::leaves_addresses_open) {
            if let Some((address, name)) = open.first() {
                self.report(address_of_devices(*address, **name, open.len() - 1));
            }
            return;
        }
        for (address, _) in open {
            self.report(crate::types::address::wrong(address));
        }
    }

    /// Reports a PROGRAM that tasks of TwinCAT's call twice: they have no names of their own for what runs.
    fn called_once(&mut self, called: impl Iterator<Item = ast::Name<'s>>) {
        let mut seen: FxHashMap<Key<'s>, Span> = FxHashMap::default();
        for name in called {
            let Some(first) = seen.insert(Key(name.text), name.span) else { continue };
            let message = format!("the PROGRAM `{}` is called twice, which is not supported yet", name.text);
            self.report(
                Diagnostic::new(Code::E0902, name.span, message)
                    .label("a task calls it again here")
                    .other(first, "first called here")
                    .help(format!(
                        "give each task its own PROGRAM with the body `{0}();`: both then call the one `{0}`",
                        name.text
                    )),
            );
        }
    }

    /// Reports a name that is twice among `names`.
    fn names_once(&mut self, names: impl Iterator<Item = ast::Name<'s>>) {
        let mut seen: FxHashMap<Key<'s>, Span> = FxHashMap::default();
        for name in names {
            let Some(first) = seen.insert(Key(name.text), name.span) else { continue };
            self.report(
                Diagnostic::new(Code::E0103, name.span, format!("`{}` is declared twice", name.text))
                    .label("declared again here")
                    .other(first, "first declared here"),
            );
        }
    }

    /// Reports a PROGRAM with a VAR_IN_OUT that nothing runs in a way which could connect it.
    fn report_not_connected(&mut self, slot: usize) -> bool {
        let Some(signature) = self.signature(slot) else { return false };
        let mut in_outs = signature.formals.iter().filter(|it| it.section == Section::InOut).map(|it| it.name);
        let Some(first) = in_outs.next() else { return false };
        let name = self.pous[slot].ast.name.text;
        let connected: Vec<_> =
            [first].into_iter().chain(in_outs).map(|it| format!("{} := variable", it.text)).collect();
        self.report(
            Diagnostic::new(
                Code::E0303,
                first.span,
                format!("the PROGRAM `{name}` has no variable connected to `{}`", first.text),
            )
            .label("a VAR_IN_OUT of a PROGRAM must be connected to a global variable")
            .help(format!(
                "connect it in a CONFIGURATION: `PROGRAM run WITH task : {name}({});`",
                connected.join(", ")
            )),
        );
        true
    }

    /// Reports a second run of a PROGRAM that declares global variables: each would have its own.
    fn report_globals_of_several(&mut self, listed: &[(usize, Span)]) {
        let mut first: FxHashMap<usize, Span> = FxHashMap::default();
        for (slot, span) in listed.iter().copied() {
            let pou = self.pous[slot].ast;
            let Some(globals) = pou.blocks.iter().find(|it| it.kind == ast::VarKind::Global) else { continue };
            let Some(other) = first.insert(slot, span).filter(|_| self.has_globals(pou)) else { continue };
            self.report(
                Diagnostic::new(
                    Code::E0403,
                    span,
                    format!("the PROGRAM `{}` has VAR_GLOBAL, so it can run only once", pou.name.text),
                )
                .label("this runs it a second time")
                .other(other, "the first one")
                .help(format!("move its {} to the file, or declare it in VAR", self.log.sources.text(globals.span))),
            );
        }
    }

    fn resource(
        &mut self,
        resource: &'s ast::Resource<'s>,
        runs: &FxHashMap<Span, usize>,
        listed: &mut Vec<(usize, Span)>,
    ) -> Vec<Timing> {
        let tasks: Vec<_> = resource.tasks.iter().map(|task| (task.name, self.task(task))).collect();
        for instance in &resource.programs {
            let mut timing = Timing { interval: None, priority: LOWEST_PRIORITY };
            if let Some(name) = instance.task {
                let found = tasks.iter().find(|(it, _)| it.text.eq_ignore_ascii_case(name.text));
                match found {
                    Some((declared, it)) => {
                        self.log.note_declared(name.span, declared.span);
                        timing = *it;
                    }
                    None => self.unknown_task(name, &tasks),
                }
            }
            let slot = self.instance(instance, timing, runs);
            listed.extend(slot.map(|it| (it, instance.name.span)));
        }
        tasks.into_iter().map(|it| it.1).collect()
    }

    fn unknown_task(&mut self, name: ast::Name<'s>, tasks: &[(ast::Name<'s>, Timing)]) {
        let near = nearest(name.text, tasks.iter().map(|(it, _)| it.text));
        let mut error = Diagnostic::missing(Missing::Task, name.text, name.span);
        if let Some(near) = near {
            error = error.help(format!("did you mean `{near}`?")).fix(name.span, near);
        }
        self.report(error);
    }

    /// Adds a run to the program's instances; gives the slot of the PROGRAM that it is of.
    fn instance(
        &mut self,
        instance: &'s ast::ProgramInstance<'s>,
        timing: Timing,
        runs: &FxHashMap<Span, usize>,
    ) -> Option<usize> {
        let path = [instance.namespace.as_slice(), &[instance.program]].concat();
        let meant = self.lookup(&path, Sense::Value);
        self.note_path(&path, &meant);
        let found = match meant {
            Found::One(Meaning::Declared(entry)) => Some(entry),
            Found::One(_) | Found::Nothing | Found::Several(_) => None,
        };
        let program = match found {
            Some(Entry::Pou(at)) if self.pous[at].ast.kind == ast::PouKind::Program => at,
            _ => {
                if let Some(Entry::Pou(at)) = found {
                    self.not_a_program(instance.program, at);
                    return None;
                }
                let programs = self.pous.iter().filter(|it| it.ast.kind == ast::PouKind::Program);
                let names: Vec<_> = programs.map(|it| it.ast.name).collect();
                let near = nearest(instance.program.text, names.iter().map(|it| it.text));
                // One in a namespace may have the very name.
                let near = near.and_then(|near| names.iter().find(|it| it.text == near));
                let near = near.map(|it| self.names.in_full(self.names.space_of(it.span), it.text));
                let mut error = Diagnostic::missing(Missing::Program, instance.program.text, instance.program.span);
                if let Some(near) = near {
                    error = error.help(format!("did you mean `{near}`?")).fix(instance.program.span, near.as_str());
                } else if let [only] = names.as_slice() {
                    let only = self.names.in_full(self.names.space_of(only.span), only.text);
                    error = error.label("unknown PROGRAM").help(format!("the only PROGRAM is `{only}`"));
                }
                self.report(error);
                return None;
            }
        };
        let run = runs.get(&instance.name.span).copied();
        let is_shared = run.is_some_and(|it| self.is_run_of_shared(it));
        if !is_shared && self.report_called_and_listed(program, instance.program.span) {
            return None;
        }
        let class = self.class_of_slot(run.unwrap_or(program))?;
        self.program.instances.push(Instance {
            name: self.name_of_run(instance),
            program: class,
            task: instance.task.map(|it| it.text.to_owned()),
            interval: timing.interval,
            priority: self.priority_used(timing, instance.program.span),
        });
        Some(program)
    }

    /// MATIEC's C runs the PROGRAMs of a RESOURCE in the order of its text.
    fn priority_used(&self, timing: Timing, at: Span) -> u32 {
        match self.dialect(at).rules().program_order.choice {
            ProgramOrder::ByPriority => timing.priority,
            ProgramOrder::OfText => LOWEST_PRIORITY,
        }
    }

    fn is_shared_run(&self, instance: &ast::ProgramInstance<'s>) -> bool {
        (0..self.pous.len()).any(|it| self.pous[it].run == Some(instance.name.span) && self.is_run_of_shared(it))
    }

    /// The name of a run; that of a PROGRAM that several tasks of TwinCAT's call has the task before it, from the second on.
    fn name_of_run(&self, instance: &ast::ProgramInstance<'s>) -> String {
        let name = instance.name.text;
        let is_known = |name: &str| self.program.instances.iter().any(|it| it.name.eq_ignore_ascii_case(name));
        match instance.task {
            Some(task) if self.is_shared_run(instance) && is_known(name) => format!("{}_{name}", task.text),
            _ => name.to_owned(),
        }
    }

    fn not_a_program(&mut self, name: ast::Name<'s>, at: usize) {
        let pou = self.pous[at].ast;
        let kind = pou.kind.word();
        self.report(
            Diagnostic::new(Code::E0102, name.span, format!("`{}` is a {kind}, not a PROGRAM", name.text))
                .label("a PROGRAM is expected here")
                .other(pou.name.span, "declared here"),
        );
    }

    fn task(&mut self, task: &'s ast::Task<'s>) -> Timing {
        let mut timing = Timing { interval: None, priority: LOWEST_PRIORITY };
        self.names_once(task.properties.iter().map(|(name, _)| *name));
        if !task.properties.iter().any(|(name, _)| name.text.eq_ignore_ascii_case("PRIORITY")) {
            self.report(
                Diagnostic::new(Code::W0412, task.name.span, format!("the TASK `{}` has no PRIORITY", task.name.text))
                    .label("it runs after all tasks that have one")
                    .help("give it one, 0 is the most urgent: `PRIORITY := 1`"),
            );
        }
        let is_single = property(task, "SINGLE").is_some_and(|it| !is_false(it));
        for (name, expr) in &task.properties {
            // What a run says of its TASK's INTERVAL is said.
            let is_reported = |this: &Self| this.log.diagnostics.iter().any(|it| it.span == expr.span);
            if name.text.eq_ignore_ascii_case("SINGLE") || is_single && is_reported(self) {
                continue;
            }
            let scope = std::rc::Rc::default();
            let value = constant(self, &scope, expr, None);
            let is_time = value.as_ref().is_none_or(|it| it.ty.elementary().is_some_and(Elementary::is_duration));
            let value = value.and_then(|it| it.as_const());
            let interval = value.and_then(Value::as_integer).and_then(|it| i64::try_from(it).ok());
            match (name.text.to_ascii_uppercase().as_str(), value) {
                ("INTERVAL", Some(_)) if is_time && interval.is_some_and(|it| it > 0) => {
                    timing.interval = interval.map(|it| if is_single { looked_at(it) } else { it });
                }
                // Its run takes a TIME, and says so.
                ("INTERVAL", Some(_)) if is_single && !is_time => {}
                // A value that is not a constant has been reported.
                ("INTERVAL", None) => {}
                ("INTERVAL", Some(_)) => self.report(
                    Diagnostic::new(Code::E0201, expr.span, "INTERVAL must be a TIME above zero")
                        .help("write `T#10ms`"),
                ),
                ("PRIORITY", Some(value)) => match value.as_integer().and_then(|it| u32::try_from(it).ok()) {
                    Some(priority) => timing.priority = priority,
                    None => self.error(Code::E0201, expr.span, "PRIORITY must be a whole number, 0 or more"),
                },
                ("PRIORITY", None) => {}
                _ => self.report(
                    Diagnostic::new(Code::E0107, name.span, format!("a TASK has no `{}`", name.text))
                        .help("it has INTERVAL, PRIORITY and SINGLE"),
                ),
            }
        }
        timing
    }

    /// Reports PROGRAMs whose variables are read, and which have no run that could be of what is read. Where a CONFIGURATION
    /// lists others, they have their initial values.
    pub(super) fn check_named_programs(&mut self, files: &[ast::File<'s>]) {
        let sources = self.log.sources;
        let is_idle = |it: ast::Name<'s>| listing(files, sources, Key(it.text)) == Listing::Others;
        let alone = self.named_programs.iter().filter(|(at, it)| !it.is_called && !self.is_of_library(**at));
        let alone: Vec<_> = alone.map(|(_, it)| (it.variable.name, it.first)).collect();
        for (name, span) in alone {
            if !self.log.options.tests && is_idle(name) {
                continue;
            }
            self.report(
                Diagnostic::new(Code::E0902, span, format!("reading `{}`, a PROGRAM that is never called", name.text))
                    .label("it has no instance to read from")
                    .other(name.span, "declared here")
                    .help(format!("call it: `{}();`", name.text)),
            );
        }
    }

    /// Reports a PROGRAM that others name, and that a CONFIGURATION lists so that a run has an instance of its own.
    pub fn report_called_and_listed(&mut self, slot: usize, listed: Span) -> bool {
        let Some(named) = self.named_programs.get_mut(&slot) else { return false };
        let (name, first) = (named.variable.name.text, named.first);
        // Each of its runs says the same.
        if !std::mem::replace(&mut named.is_reported, true) {
            let message = format!("`{name}` is used by name, but also runs with its own instance");
            self.report(
                Diagnostic::new(Code::E0902, listed, message)
                    .label("this is one of several instances, or it has connections, a SINGLE or a VAR_CONFIG")
                    .other(first, "the name means the only instance of the PROGRAM")
                    .help("list it once without connections, or do not use its name"),
            );
        }
        true
    }
}
