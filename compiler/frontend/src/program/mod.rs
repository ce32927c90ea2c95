//! The whole program: its instances, its order of routines, what starts it, and whether it fits.

mod chains;
mod configuration;
mod escape;
mod instance_path;
mod order;
mod pins;
mod prescan;
mod task_info;
pub(crate) mod tests;

use crate::body::Checked;
use crate::spelling::Key;
use crate::types::declarations::{Declarations, empty_program};
use crate::types::image::Image;
use crate::types::scope::Variable;
use crate::types::signature::Signature;
use crate::{Code, Diagnostic, ast};
use rustc_hash::FxHashSet;
use staunch_ir::layout::{Layout, TooLarge};
use staunch_ir::reference::objects;
use staunch_ir::{
    Argument, Block, Class, ClassId, ClassKind, Location, Place, Program, Root, RoutineId, Statement, StatementKind,
    Type,
};
use staunch_runtime::reference::CLASS;
use std::rc::Rc;

/// Puts the parts together: the classes, the instances, the order of the routines. Unless this `is_last`, recursion by
/// references is reported: the program is checked once more, with what it refers to.
pub(crate) fn assemble<'s>(
    declarations: &mut Declarations<'s>,
    files: &'s [ast::File<'s>],
    checked: Checked,
    is_last: bool,
) -> Option<Program> {
    let mut stacks = checked.stacks;
    let (routines, mut uses): (_, Vec<_>) =
        checked.routines.into_iter().collect::<Option<Vec<_>>>()?.into_iter().unzip();
    declarations.program.routines = routines;
    let held = declarations.runs().iter().map(|it| Key(it.ast.name.text)).collect();
    let slots = 0..declarations.pous.len();
    declarations.program.classes = slots.filter_map(|slot| declarations.class(slot, &held)).collect();
    declarations.check_named_programs(files);
    declarations.program.implementers = declarations.numbered_implementers();
    configuration::instances(declarations, files);
    declarations.set_instance_paths();
    if is_last {
        chains::unroll(declarations, &mut uses, &mut stacks);
    }
    order::order(declarations, uses, stacks)?;
    declarations.check_pins()?;
    declarations.check_escapes()?;
    // What a mistake has left half declared is not put together.
    if declarations.log.has_errors() {
        return None;
    }
    let program = std::mem::replace(&mut declarations.program, empty_program(Vec::new()));
    let settled = staunch_ir::shapes::settle(program);
    let settled = settled.map_err(|at| declarations.report_too_many_shapes(at)).ok()?;
    declarations.program = staunch_ir::reference::fixed(settled);
    staunch_ir::taking::settle(&mut declarations.program);
    declarations.check_size()?;
    Some(std::mem::replace(&mut declarations.program, empty_program(Vec::new())))
}

impl Declarations<'_> {
    fn report_too_many_shapes(&mut self, at: Location) {
        let name = self.log.name_at(at);
        self.report(
            Diagnostic::new(Code::E0901, name, "calls give too many shapes of arrays to `ARRAY[*]` parameters")
                .label("this is one of the routines that are made once for each shape"),
        );
    }

    /// The PROGRAM or FUNCTION_BLOCK in a slot. Its body has the slot's number until routines are put in order.
    /// Those that runs of a CONFIGURATION hold have the names in `held`.
    fn class(&mut self, slot: usize, held: &FxHashSet<Key<'_>>) -> Option<Class> {
        if self.is_run_of_named_program(slot) || self.pous[slot].dispatch.is_some() {
            return None;
        }
        let pou = self.pous[slot].ast;
        let is_held = self.pous[slot].run.is_none() && held.contains(&Key(pou.name.text));
        let kind = match pou.kind {
            // Who is called has an instance, as a FUNCTION_BLOCK has.
            ast::PouKind::Program if self.is_named_program(slot) || is_held || self.is_of_library(slot) => {
                ClassKind::FunctionBlock
            }
            // A test holds it, as it holds a FUNCTION_BLOCK.
            ast::PouKind::Program if self.log.options.tests => ClassKind::FunctionBlock,
            ast::PouKind::Program | ast::PouKind::Test => ClassKind::Program,
            ast::PouKind::FunctionBlock | ast::PouKind::Class => ClassKind::FunctionBlock,
            ast::PouKind::Function
            | ast::PouKind::Interface
            | ast::PouKind::Action
            | ast::PouKind::Method
            | ast::PouKind::Getter
            | ast::PouKind::Setter => return None,
        };
        let signature = self.signature(slot)?;
        let variables = match self.pous[slot].run {
            Some(_) if self.is_run_of_shared(slot) => self.variables_of_shared(slot).unwrap_or_default(),
            Some(_) => self.variables_of_run(slot, &signature)?,
            None => variables(&self.image, &signature),
        };
        let kept = self.tests.kept.remove(&slot).unwrap_or_default();
        Some(Class {
            kind,
            name: self.emitted_name(slot),
            doc: pou.doc.clone(),
            location: self.location(pou.name.span),
            state: signature.state?,
            variables: variables.into_iter().chain(kept).collect(),
            body: RoutineId::next(slot),
            prescan: None,
            start: None,
        })
    }

    /// The variables of the PROGRAM that a run holds: an in-out is what the run connects it with.
    fn variables_of_run(&mut self, slot: usize, run: &Signature<'_>) -> Option<Vec<staunch_ir::Variable>> {
        let held = &run.scope.variables.first()?.place;
        let Type::Struct(state) = held.ty else { return None };
        let inner = self.slot_of_instance(state)?;
        let signature = self.signature(inner)?;
        let arguments = arguments_of(&self.program.routines[slot].body, RoutineId::next(inner)).unwrap_or_default();
        let mut variables = variables(&self.image, &signature);
        // A VAR_TEMP exists only while the PROGRAM itself runs.
        variables.retain(|it| !matches!(it.place.root, Root::Local(_)));
        for Place { root, projections, .. } in variables.iter_mut().map(|it| &mut it.place) {
            match *root {
                Root::Instance => drop(projections.splice(0..0, held.projections.iter().cloned())),
                Root::Param(id) => {
                    if let Some(Argument::Reference(place)) = arguments.get(id.index()) {
                        (*root, *projections) = (place.root, place.projections.clone());
                    }
                }
                Root::Globals | Root::Local(_) => {}
            }
        }
        Some(variables)
    }

    /// The variables of the one instance that a run calls. The first run of a PROGRAM has them.
    fn variables_of_shared(&mut self, slot: usize) -> Option<Vec<staunch_ir::Variable>> {
        let call = |slot: usize| self.program.routines[slot].body.iter().find_map(call_of_instance);
        let (callee, Place { root: held, projections: way, .. }) = call(slot).map(|it| (it.0, it.1.clone()))?;
        let mut before = self.written_pous().len()..slot;
        if before.any(|it| self.is_run_of_shared(it) && call(it).is_some_and(|it| it.0 == callee)) {
            return None;
        }
        let signature = self.signature(callee.index())?;
        let mut variables = variables(&self.image, &signature);
        variables.retain(|it| !matches!(it.place.root, Root::Local(_)));
        for Place { root, projections, .. } in variables.iter_mut().map(|it| &mut it.place) {
            if *root == Root::Instance {
                *root = held;
                projections.splice(0..0, way.iter().cloned());
            }
        }
        Some(variables)
    }

    /// The class of the PROGRAM or FUNCTION_BLOCK in a slot, while bodies have their slots' numbers.
    fn class_of_slot(&self, slot: usize) -> Option<ClassId> {
        let body = RoutineId::next(slot);
        self.program.classes.binary_search_by_key(&body, |it| it.body).ok().map(ClassId::next)
    }

    /// Whether all variables together, and each type, fit into memory.
    fn check_size(&mut self) -> Option<()> {
        let at = match Layout::try_new(&self.program) {
            Ok(layout) => return self.check_objects(&layout),
            Err(TooLarge { at, .. }) => at,
        };
        let program = self.program.instances.last().map(|it| self.program.class(it.program).location);
        let span = self.log.name_at(at.or(program).unwrap_or_default());
        self.report(
            Diagnostic::new(Code::E0901, span, "the variables up to this one take more than 1 GiB")
                .label("too large together"),
        );
        None
    }
}

impl Declarations<'_> {
    /// Whether references can distinguish all variables whose addresses are taken.
    fn check_objects(&mut self, layout: &Layout) -> Option<()> {
        let most = (1 << (CLASS - 32)) - 1;
        let is_too_many = !self.program.references.is_empty() && objects(&self.program, layout).len() > most;
        if is_too_many {
            let program = self.program.instances.last().map(|it| self.program.class(it.program).location);
            let span = self.log.name_at(program.unwrap_or_default());
            self.report(
                Diagnostic::new(Code::E0901, span, format!("the addresses of more than {most} variables are taken"))
                    .label("each element of an array of instances counts"),
            );
        }
        (!is_too_many).then_some(())
    }
}

fn variables(image: &Image, signature: &Signature<'_>) -> Vec<staunch_ir::Variable> {
    let variable = |it: &Rc<Variable<'_>>| {
        let (place, view) = image.stored(&it.place);
        staunch_ir::Variable { name: it.name.text.to_owned(), section: it.section, place, view }
    };
    signature.scope.variables.iter().filter(|it| !crate::added::is_added(it.name.text)).map(variable).collect()
}

fn call_of_instance(statement: &Statement) -> Option<(RoutineId, &Place)> {
    match &statement.kind {
        StatementKind::Call { callee, instance, .. } => instance.as_ref().map(|it| (*callee, it)),
        _ => None,
    }
}

/// What the call of a routine in the block passes.
fn arguments_of(block: &Block, routine: RoutineId) -> Option<&[Argument]> {
    block.iter().find_map(|it| match &it.kind {
        StatementKind::Call { callee, arguments, .. } if *callee == routine => Some(arguments.as_slice()),
        kind => kind.blocks().into_iter().find_map(|it| arguments_of(it, routine)),
    })
}
