//! Sources that a project uses and that are not its own: their PROGRAMs do not run, and nothing is said of their
//! habits. A declaration there may be without a body, of what is not in Structured Text: it is checked as any other,
//! but a program that calls it cannot be built. So is a POU with code in C, wherever it is declared.

use crate::ast::{ExprKind, File, Item, Pou, PouKind, each_expr};
use crate::spelling::Key;
use crate::types::declarations::Declarations;
use crate::{Code, Diagnostic, Severity, Sources, Span, prelude};
use rustc_hash::{FxHashMap, FxHashSet};
use staunch_ir::{Location, Routine, RoutineId};

/// What a library declares without a body, and what has code in C: the places of the names.
#[derive(Debug, Default)]
pub(crate) struct Stubs {
    names: FxHashSet<Span>,
    /// The code in C that is in one.
    c_code: FxHashMap<Span, Span>,
    /// Code in C that is in nothing that is called.
    pub refused: Vec<Span>,
}

/// Takes out of libraries what only runs by itself, and gives what is without a body.
pub(crate) fn prepare(files: &mut [File<'_>], sources: &Sources) -> Stubs {
    let mut stubs = Stubs::default();
    let named = programs_named(files);
    for (file, source) in files.iter_mut().zip(sources.files()) {
        for code in std::mem::take(&mut file.c_code) {
            match with_c_code(&mut file.items, code) {
                Some(pou) => {
                    pou.is_stub = true;
                    stubs.names.insert(pou.name.span);
                    stubs.c_code.entry(pou.name.span).or_insert(code);
                }
                None => stubs.refused.push(code),
            }
        }
        if !source.is_of_library() && !source.only_declares() {
            // What Automation Studio declares of its libraries.
            let own = file.items.iter().filter_map(|it| match it {
                Item::Pou(pou) if pou.is_stub => Some(pou.name.span),
                Item::Pou(_) | Item::Types(_) | Item::Globals(_) | Item::Configuration(_) | Item::Test(_) => None,
            });
            stubs.names.extend(own);
            continue;
        }
        file.items.retain(|it| match it {
            Item::Pou(pou) => pou.kind != PouKind::Program || named.contains(&pou.name.text.to_ascii_lowercase()),
            Item::Configuration(_) | Item::Test(_) => false,
            Item::Types(_) | Item::Globals(_) => true,
        });
        for item in &mut file.items {
            if let Item::Pou(pou) = item
                && is_stub(pou)
            {
                pou.is_stub = true;
                // What starts an instance that has nothing to do has nothing to do.
                let asked =
                    |it: &&mut Pou<'_>| !crate::start::INITIAL.iter().any(|name| Key(name) == Key(it.name.text));
                pou.routines.iter_mut().filter(asked).for_each(|it| it.is_stub = !crate::start::is_after(it));
                stubs.names.insert(pou.name.span);
                stubs.names.extend(pou.routines.iter().map(|it| it.name.span));
            }
        }
    }
    stubs
}

/// The FUNCTION, FUNCTION_BLOCK or routine of one that code in C is in.
fn with_c_code<'a, 's>(items: &'a mut [Item<'s>], code: Span) -> Option<&'a mut Pou<'s>> {
    let has = |it: &Pou<'_>| it.extent.start <= code.start && code.end <= it.extent.end;
    let pous = items.iter_mut().filter_map(|it| match it {
        Item::Pou(pou) => Some(pou),
        Item::Types(_) | Item::Globals(_) | Item::Configuration(_) | Item::Test(_) => None,
    });
    let pou = pous.into_iter().find(|it| has(it))?;
    if let Some(at) = pou.routines.iter().position(has) {
        return pou.routines.get_mut(at);
    }
    matches!(pou.kind, PouKind::Function | PouKind::FunctionBlock).then_some(pou)
}

/// Code in C where it cannot be left out.
pub(crate) fn c_code(at: Span) -> Diagnostic {
    Diagnostic::new(Code::E0902, at, "code in C is not supported")
        .label("Staunch does not compile it")
        .help("write what it does in Structured Text, or call a FUNCTION that is `{external}`")
}

/// The PROGRAMs that some body may name, in small letters: those of a library are called then, or their METHODs are.
fn programs_named(files: &[File<'_>]) -> FxHashSet<String> {
    let pous = || files.iter().flat_map(|it| &it.items).filter_map(pou);
    let programs = pous().filter(|it| it.kind == PouKind::Program);
    let mut left: FxHashSet<_> = programs.map(|it| Key(it.name.text)).collect();
    let mut named = FxHashSet::default();
    if left.is_empty() {
        return named;
    }
    for pou in pous().flat_map(|it| std::iter::once(it).chain(&it.routines)) {
        each_expr(&pou.body, &mut |it| {
            if let ExprKind::Name(name) | ExprKind::Member(_, name) = &it.kind {
                named.extend(left.take(&Key(name.text)).map(|it| it.0.to_ascii_lowercase()));
            }
        });
    }
    named
}

fn pou<'a, 's>(item: &'a Item<'s>) -> Option<&'a Pou<'s>> {
    match item {
        Item::Pou(pou) => Some(pou),
        Item::Types(_) | Item::Globals(_) | Item::Configuration(_) | Item::Test(_) => None,
    }
}

/// Whether `{external}` before it is accepted.
fn can_be_external(pou: &Pou<'_>) -> bool {
    let has_own = pou.routines.iter().any(|it| it.name.text != crate::start::START);
    match pou.kind {
        PouKind::Function => true,
        PouKind::FunctionBlock => !has_own && pou.extends.is_none() && pou.implements.is_empty(),
        PouKind::Program
        | PouKind::Class
        | PouKind::Interface
        | PouKind::Test
        | PouKind::Action
        | PouKind::Method
        | PouKind::Getter
        | PouKind::Setter => false,
    }
}

/// Whether nothing of it says what it does. What only inherits does what its base does.
fn is_stub(pou: &Pou<'_>) -> bool {
    let is_empty = pou.body.is_empty() && pou.routines.iter().all(|it| it.body.is_empty());
    let has_own = pou.extends.is_none() || !pou.routines.is_empty();
    pou.kind != PouKind::Interface && pou.external.is_none() && is_empty && has_own
}

impl Stubs {
    /// Reports what is called and has code in C, and, of a program that `is_built`, what is called of the library and has no body,
    /// each once; `routines` are those of the POUs' slots. In a unit test a mock may replace it; otherwise it faults, as it does
    /// in a test by a table.
    pub fn report_called(&self, declarations: &mut Declarations<'_>, routines: &[Option<&Routine>], is_built: bool) {
        if self.names.is_empty() || declarations.log.options.tests || declarations.log.options.is_tested {
            return;
        }
        let sources = declarations.log.sources;
        let is_own = |slot: &usize| {
            let pou = declarations.pous[*slot].ast;
            let source = sources.get(pou.span.file);
            !source.is_of_library() && !source.only_declares() && !self.names.contains(&pou.name.span)
        };
        let mut missing = called((0..routines.len()).filter(is_own).collect(), routines);
        missing.retain(|(slot, _)| {
            // What starts the globals is made where an FB_init is.
            let name = declarations.pous[*slot].ast.name;
            self.names.contains(&name.span) && !name.text.starts_with(crate::start::START)
        });
        // What several classes inherit is declared once.
        let mut said = FxHashSet::default();
        missing.retain(|(slot, _)| said.insert(declarations.reported_as(*slot)));
        for (slot, at) in missing {
            match self.c_code.get(&declarations.pous[slot].ast.name.span) {
                Some(code) => declarations.report_c_code(slot, at, *code),
                None if is_built => declarations.report_without_body(slot, at),
                None => {}
            }
        }
    }
}

impl Declarations<'_> {
    fn report_c_code(&mut self, slot: usize, at: Location, code: Span) {
        let title = self.title(slot);
        let error = Diagnostic::new(Code::E0902, self.log.name_at(at), format!("`{title}` has code in C"))
            .label("called here")
            .other(code, "Staunch does not compile this")
            .help("write what it does in Structured Text, or call a FUNCTION that is `{external}`");
        self.report(error);
    }

    /// The place of the name that a missing body is reported by: a block of a bundled library is reported once, whichever of its
    /// METHODs are called.
    fn reported_as(&self, slot: usize) -> Span {
        let span = self.pous[slot].ast.name.span;
        let is_declared = self.log.sources.get(span.file).only_declares();
        let owner = self.pous[slot].owner.filter(|_| is_declared);
        owner.map_or(span, |it| self.pous[it].ast.name.span)
    }

    fn report_without_body(&mut self, slot: usize, at: Location) {
        let pou = self.pous[slot].ast;
        if self.log.sources.get(pou.name.span.file).only_declares() {
            return self.report_needs_machine(slot, at);
        }
        let (title, file) = (self.title(slot), &self.log.sources.get(pou.name.span.file).path);
        let error = Diagnostic::new(Code::E0318, self.log.name_at(at), format!("`{title}` has no implementation"))
            .label("called here")
            .other(pou.name.span, "declared here, without a body")
            .help(match can_be_external(pou) {
                true => format!(
                    "write its body in {file} (`RETURN;` to do nothing), or `{{external}}` before it, and implement it \
                     in Rust or C"
                ),
                false => format!(
                    "write its body in {file} (`RETURN;` to do nothing); it may call a FUNCTION that is `{{external}}`"
                ),
            });
        self.report(error);
    }
}

impl Declarations<'_> {
    /// That a vendor's block, or FUNCTION, does something on the vendor's machine alone.
    fn report_needs_machine(&mut self, slot: usize, at: Location) {
        let owner = self.pous[slot].owner.unwrap_or(slot);
        let name = self.pous[owner].ast.name.text;
        let name = name.strip_prefix(prelude::RENAMED).unwrap_or(name);
        let unit = prelude::unit(name, self.dialect(self.pous[owner].ast.name.span));
        let library = unit.and_then(|it| it.libraries.first().copied()).unwrap_or("the library");
        let error = Diagnostic::new(
            Code::E0318,
            self.log.name_at(at),
            format!("`{name}` of {library} has no implementation here"),
        )
        .label("called here")
        .note("the library that is bundled with Staunch declares it: it needs the vendor's system")
        .help(format!(
            "declare your own `{name}` with a body: it is used in place of this one. `MOCK` replaces it in a test"
        ));
        self.report(error);
    }
}

impl Declarations<'_> {
    /// Where the program is to run as it is: reports what the PROGRAMs call that is implemented outside. A unit test may
    /// have a mock in its place, and else faults.
    pub(crate) fn report_not_there(&mut self, routines: &[Option<&Routine>]) {
        if !self.log.options.is_run || self.log.options.tests || self.log.options.is_tested {
            return;
        }
        let is_program = |slot: &usize| self.pous[*slot].ast.kind == PouKind::Program;
        let mut outside = called((0..routines.len()).filter(is_program).collect(), routines);
        outside.retain(|(slot, _)| self.pous[*slot].ast.external.is_some());
        for (slot, at) in outside {
            let name = self.pous[slot].ast.name;
            let error = Diagnostic::new(
                Code::E0318,
                self.log.name_at(at),
                format!("`{}` has no implementation here", self.title(slot)),
            )
            .label("called here")
            .other(name.span, "declared `{external}` here: it is implemented in Rust or C")
            .help(
                "build the program with `--emit rust`, `obj` or `lib`, and link the implementation, or test it with `MOCK_FUNCTION` \
                 or `MOCK` instead",
            );
            self.report(error);
        }
    }
}

/// What routines call, each once, with a place, in the order of the source.
fn called(mut reached: Vec<usize>, routines: &[Option<&Routine>]) -> Vec<(usize, Location)> {
    let mut seen: FxHashSet<_> = reached.iter().copied().collect();
    let mut found = Vec::new();
    while let Some(slot) = reached.pop() {
        let Some(routine) = routines[slot] else { continue };
        each_call(routine, &mut |callee, at| {
            if seen.insert(callee.index()) {
                reached.push(callee.index());
                found.push((callee.index(), at));
            }
        });
    }
    found.sort_unstable_by_key(|(_, at)| (at.file, at.line, at.column));
    found
}

fn each_call(routine: &Routine, see: &mut dyn FnMut(RoutineId, Location)) {
    staunch_ir::visit::statements(&routine.body, &mut |statement| {
        if let staunch_ir::StatementKind::Call { callee, .. } = &statement.kind {
            see(*callee, statement.at);
        }
    });
}

/// Leaves out what is said of the habits of libraries.
pub(crate) fn of_own_sources(diagnostics: &mut Vec<Diagnostic>, sources: &Sources) {
    diagnostics.retain(|it| it.severity == Severity::Error || !sources.get(it.span.file).is_of_library());
}
