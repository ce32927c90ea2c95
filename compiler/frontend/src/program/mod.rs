//! The whole program: its instances, its order of routines, what starts it, and whether it fits.

mod configuration;
mod order;
mod prescan;

use crate::body::Checked;
use crate::types::declarations::{Declarations, empty_program};
use crate::types::scope::Variable;
use crate::{Code, Diagnostic, ast};
use staunch_ir::layout::{Layout, TooLarge};
use staunch_ir::{Class, ClassId, ClassKind, Program, RoutineId};
use std::rc::Rc;

/// Puts the parts together: the classes, the instances, the order of the routines.
pub(crate) fn assemble<'s>(
    declarations: &mut Declarations<'s>,
    files: &'s [ast::File<'s>],
    checked: Checked,
) -> Option<Program> {
    let stacks = checked.stacks;
    let (routines, uses) = checked.routines.into_iter().collect::<Option<Vec<_>>>()?.into_iter().unzip();
    declarations.program.routines = routines;
    declarations.program.classes = (0..declarations.pous.len()).filter_map(|slot| declarations.class(slot)).collect();
    declarations.check_named_programs();
    configuration::instances(declarations, files);
    order::order(declarations, uses, stacks)?;
    declarations.check_size()?;
    Some(std::mem::replace(&mut declarations.program, empty_program(Vec::new())))
}

impl Declarations<'_> {
    /// The PROGRAM or FUNCTION_BLOCK in a slot. Its body has the slot's number until routines are put in order.
    fn class(&mut self, slot: usize) -> Option<Class> {
        let pou = self.pous[slot].ast;
        let kind = match pou.kind {
            // Who is called has an instance, as a FUNCTION_BLOCK has.
            ast::PouKind::Program if self.is_named_program(slot) => ClassKind::FunctionBlock,
            ast::PouKind::Program => ClassKind::Program,
            ast::PouKind::FunctionBlock => ClassKind::FunctionBlock,
            ast::PouKind::Function => return None,
        };
        let signature = self.signature(slot)?;
        let variable = |it: &Rc<Variable<'_>>| staunch_ir::Variable {
            name: it.name.text.to_owned(),
            section: it.section,
            place: it.place.clone(),
        };
        Some(Class {
            kind,
            name: pou.name.text.to_owned(),
            doc: pou.doc.clone(),
            location: self.location(pou.name.span),
            state: signature.state?,
            variables: signature.scope.variables.iter().map(variable).collect(),
            body: RoutineId::next(slot),
            prescan: None,
        })
    }

    /// The class of the PROGRAM or FUNCTION_BLOCK in a slot, while bodies have their slots' numbers.
    fn class_of_slot(&self, slot: usize) -> Option<ClassId> {
        let body = RoutineId::next(slot);
        self.program.classes.iter().position(|it| it.body == body).map(ClassId::next)
    }

    /// Whether all variables together, and each type, fit into memory.
    fn check_size(&mut self) -> Option<()> {
        let Err(TooLarge { at, .. }) = Layout::try_new(&self.program) else { return Some(()) };
        let program = self.program.instances.last().map(|it| self.program.class(it.program).location);
        let span = self.log.name_at(at.or(program).unwrap_or_default());
        self.report(
            Diagnostic::new(Code::E0901, span, "the variables up to this one take more than 1 GiB")
                .label("too large together"),
        );
        None
    }
}
