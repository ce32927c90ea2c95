//! Declarations: names, types, signatures and storage, all that holds before a body is read.
//!
//! They may be in any order and in any file, and are resolved in the order of their needs.

mod address;
mod any_input;
mod binding;
mod collect;
mod columns;
mod constant_address;
mod external;
mod generic;
mod global;
mod heads;
mod hidden;
mod image;
mod initial;
mod list;
mod mock;
mod named_program;
mod needs;
mod overload;
mod own_variable;
mod packing;
mod pools;
mod pou;
mod pragma;
mod relative;
mod rows;
pub(crate) mod run;
mod specs;
pub(crate) mod starts;
mod structure;
mod variable;

use crate::Dialect;
use crate::ast::{self, PouKind, VarKind};
use crate::log::Log;
use crate::names::Entry;
use crate::spelling::Key;
use crate::testing;
use crate::types::declarations::{Declarations, PouSlot, Slot};
use crate::types::in_outs::Polymorphic;
use crate::types::scope::Scope;
use crate::types::whole::Whole;
use run::Run;
use rustc_hash::FxHashSet;
use std::rc::Rc;

/// Declares what the files do; `bodies` are those of their POUs, and then of the runs, in order.
pub(crate) fn declare<'s>(
    log: Log<'s>,
    whole: &Whole,
    files: &'s [ast::File<'s>],
    runs: &'s [Run<'s>],
    bodies: &[Vec<ast::Statement<'s>>],
) -> Declarations<'s> {
    let mut declarations = Declarations::new(log, Declarations::build_instance);
    declarations.table.polymorphic = Polymorphic { known: whole.in_outs.clone(), ..Polymorphic::default() };
    declarations.program.reach = whole.reach;
    declarations.table.interfaces.only.clone_from(&whole.referred);
    for (file, dialect) in declarations.program.files.iter_mut().zip(&declarations.log.dialects) {
        file.system = dialect.family();
    }
    declarations.program.milliseconds = milliseconds_of_all(&declarations.log.dialects);
    let log = &declarations.log;
    declarations.names.add_libraries(log.sources, |it| log.dialects.get(it).is_some_and(|it| it.has_own_libraries()));
    declarations.collect_namespaces(files);
    for file in files {
        declarations.collect(file);
    }
    declarations.name_overloads();
    declarations.check_bases();
    for Run { pou, instance, .. } in runs {
        declarations.pous.push(PouSlot { run: Some(*instance), ..PouSlot::open(pou) });
    }
    declarations.note_starts();
    declarations.note_tasks(files);
    declarations.check_columns();
    declarations.note_results(bodies);
    declarations.note_kept_in_outs(bodies);
    declarations.note_any_inputs(bodies);
    declarations.note_generics();
    declarations.collect_addresses(bodies);
    declarations.resolve_all();
    declarations.check_overloads();
    declarations.start_values(runs);
    declarations.find_named_programs(bodies, runs);
    declarations.find_addresses_of_constants(bodies);
    declarations.declare_mocks(&testing::mocked_functions(bodies));
    declarations.start_bindings(runs);
    declarations.warn_of_packing();
    declarations.declare_pools();
    declarations.declare_globals();
    declarations.program.reach.references |= !declarations.program.references.is_empty();
    declarations
}

impl<'s> Declarations<'s> {
    /// Which FUNCTIONs and METHODs say what their result is.
    fn note_results(&mut self, bodies: &[Vec<ast::Statement<'s>>]) {
        for (pou, body) in self.pous.iter_mut().zip(bodies) {
            let name = Key(pou.ast.name.text);
            let mut variables = pou.ast.blocks.iter().flat_map(|it| &it.vars).flat_map(|it| &it.names);
            let is_meant = pou.ast.kind.is_function() && !variables.any(|it| Key(it.text) == name);
            pou.names_itself = is_meant && mentions(body, name.0);
        }
    }

    /// Which VAR_IN_OUTs of FUNCTION_BLOCKs their METHODs use, in dialects that let them.
    fn note_kept_in_outs(&mut self, bodies: &[Vec<ast::Statement<'s>>]) {
        let is_method = |kind| matches!(kind, PouKind::Method | PouKind::Getter | PouKind::Setter);
        for (pou, body) in self.pous.iter().zip(bodies).filter(|it| is_method(it.0.ast.kind)) {
            let Some(owner) = pou.owner.map(|it| self.pous[it].ast).filter(|it| it.kind.is_block()) else { continue };
            let is_kept = |it: &&ast::VarBlock<'s>| it.kind == VarKind::InOut && it.constant.is_none();
            let mut in_outs = owner.blocks.iter().filter(is_kept).flat_map(|it| &it.vars).flat_map(|it| &it.names);
            if in_outs.clone().next().is_none() || !self.log.dialect(owner.name.span).keeps_in_outs() {
                continue;
            }
            let own: FxHashSet<_> =
                pou.ast.blocks.iter().flat_map(|it| &it.vars).flat_map(|it| &it.names).map(|it| Key(it.text)).collect();
            let used = named(body, &own);
            self.table
                .kept_in_outs
                .extend(in_outs.by_ref().filter(|it| used.contains(&Key(it.text))).map(|it| it.span));
        }
    }

    fn resolve_all(&mut self) {
        for step in needs::order(self) {
            let entry = match step {
                needs::Step::Declaration(entry) => entry,
                needs::Step::Constants(at) => {
                    let constants = self.early_constants(self.pous[at].ast, Scope::default());
                    self.constants.insert(at, Rc::new(constants));
                    continue;
                }
            };
            match entry {
                Entry::Type(at) => self.types[at].slot = self.resolve_type_slot(at).map_or(Slot::Failed, Slot::Done),
                Entry::Global(at) => {
                    let variable = self.global_variable(at).map(Rc::new);
                    self.globals[at].slot = variable.map_or(Slot::Failed, Slot::Done);
                }
                Entry::Pou(at) => {
                    let signature = self.build_signature(at).map(Rc::new);
                    self.pous[at].slot = signature.map_or(Slot::Failed, Slot::Done);
                }
            }
        }
        self.declare_late_externals();
        self.settle_references();
        self.check_heads();
        self.declare_used_addresses();
        let uses = std::mem::take(&mut self.addresses.uses);
        address::report_second_names(self, &uses);
        self.find_image(uses);
    }
}

/// The least and the greatest TIME in milliseconds, where that is what it is in all files.
fn milliseconds_of_all(files: &[Dialect]) -> Option<(i64, i64)> {
    let limits = |it: &Dialect| {
        it.rules().time_count().filter(|it| it.unit == staunch_runtime::time::MILLISECOND)?.ty.repr().range()
    };
    let (first, rest) = files.split_first()?;
    let (least, greatest) = limits(first).filter(|all| rest.iter().all(|it| limits(it) == Some(*all)))?;
    Some((i64::try_from(least).ok()?, i64::try_from(greatest).ok()?))
}

/// The names in statements but for those of `own` variables, and what is after THIS.
fn named<'s>(body: &[ast::Statement<'s>], own: &FxHashSet<Key<'s>>) -> FxHashSet<Key<'s>> {
    let is_this = |it: &ast::Expr<'_>| match &it.kind {
        ast::ExprKind::Deref(inner) => matches!(&inner.kind, ast::ExprKind::Name(it) if Key(it.text) == Key("THIS")),
        ast::ExprKind::Name(it) => Key(it.text) == Key("THIS"),
        _ => false,
    };
    let mut found = FxHashSet::default();
    ast::each_expr(body, &mut |it| match &it.kind {
        ast::ExprKind::Name(it) if !own.contains(&Key(it.text)) => drop(found.insert(Key(it.text))),
        ast::ExprKind::Member(owner, it) if is_this(owner) => drop(found.insert(Key(it.text))),
        _ => {}
    });
    found
}

/// Whether the statements name something `name`.
fn mentions(body: &[ast::Statement<'_>], name: &str) -> bool {
    let mut found = false;
    ast::each_expr(body, &mut |it| {
        found |= matches!(&it.kind, ast::ExprKind::Name(it) if it.text.eq_ignore_ascii_case(name));
    });
    found
}
