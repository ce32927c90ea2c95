//! VAR_EXTERNAL: a POU's names for global variables.
//!
//! A global may be an instance of the very block that names it, so the names are declared when all declarations are
//! resolved. A CONSTANT is known before, as it may size what the POU declares.

use crate::ast::{self, VarKind};
use crate::diagnostic::Missing;
use crate::names::{Entry, Found, Meaning, Sense};
use crate::spelling::nearest;
use crate::types::declarations::{Declarations, GlobalSlot, Slot};
use crate::types::scope::{Scope, Variable};
use crate::types::signature::Signature;
use crate::{Code, Diagnostic, Span};
use rustc_hash::FxHashMap;
use staunch_ir::Section;
use std::rc::Rc;

impl<'s> Declarations<'s> {
    /// Whether a declaration of a VAR_EXTERNAL names a CONSTANT.
    pub(super) fn is_early_external(&self, decl: &ast::VarDecl<'s>) -> bool {
        decl.names.iter().any(|name| match self.declared(*name) {
            Some(Entry::Global(at)) => self.globals[at].block.constant.is_some(),
            Some(Entry::Type(_) | Entry::Pou(_)) | None => false,
        })
    }

    /// Gives all POUs their names for global variables, when those are resolved.
    pub(super) fn declare_late_externals(&mut self) {
        for slot in 0..self.pous.len() {
            if let Slot::Done(signature) = &self.pous[slot].slot {
                let signature = Rc::clone(signature);
                self.pous[slot].slot = Slot::Done(self.with_externals(slot, signature));
            }
        }
    }

    /// A signature with the names for global variables of its POU, and of the one around it.
    pub(super) fn with_externals(&mut self, slot: usize, signature: Rc<Signature<'s>>) -> Rc<Signature<'s>> {
        let pou = self.pous[slot].ast;
        let declared = pou.blocks.iter().filter(|it| it.kind == VarKind::External);
        let late: Vec<_> = declared
            .flat_map(|block| block.vars.iter().map(move |decl| (block, decl)))
            .filter(|(_, decl)| !self.is_early_external(decl))
            .collect();
        let around = self.pous[slot].owner.filter(|it| names_globals(self.pous[*it].ast));
        let outer = around.and_then(|it| self.signature(it)).map(|it| self.scope_around(slot, &it));
        if late.is_empty() && outer.is_none() {
            return signature;
        }
        let mut scope = Scope::clone(&signature.scope);
        scope.outer = outer.or(scope.outer);
        for (block, decl) in late {
            self.declare_externals(block, decl, &mut scope);
        }
        let declared: FxHashMap<_, _> =
            pou.blocks.iter().flat_map(|it| &it.vars).flat_map(|it| &it.names).map(|it| it.span).zip(1..).collect();
        scope.reorder(|it| declared.get(&it.name.span).copied().unwrap_or(0));
        Rc::new(Signature { scope: Rc::new(scope), ..Signature::clone(&signature) })
    }

    /// Names in a POU's scope what a VAR_EXTERNAL says.
    pub(super) fn declare_externals(
        &mut self,
        block: &ast::VarBlock<'s>,
        decl: &'s ast::VarDecl<'s>,
        scope: &mut Scope<'s>,
    ) {
        let wanted = self.resolve_spec(&decl.ty, &Rc::new(Scope::default()), "external");
        for name in &decl.names {
            let Some(global) = self.external(*name) else {
                scope.refuse(*name);
                continue;
            };
            if let Some(wanted) = &wanted
                && wanted.ty != global.resolved.ty
            {
                let (found, ours) = (self.program.type_name(global.resolved.ty), self.program.type_name(wanted.ty));
                self.report(
                    Diagnostic::new(
                        Code::E0405,
                        decl.ty.span,
                        format!("the global `{}` is of type {found}", name.text),
                    )
                    .label(format!("declared as {ours} here"))
                    .other(global.name.span, "the global variable")
                    .help(format!("write `{} : {found}` here, or change the global variable", name.text)),
                );
                // Which of the two types is meant is not known: no use of it is judged.
                scope.refuse(*name);
                continue;
            }
            self.check_external(block, decl, &global);
            if let Some(index) = &self.log.index {
                index.note_external(name.span, global.name.span);
            }
            let variable = Variable { name: *name, section: Section::External, ..Variable::clone(&global) };
            self.enter_variable(scope, variable);
        }
    }

    /// Reports what only the declaration of a global may say: its value, and that it is not a constant.
    fn check_external(&mut self, block: &ast::VarBlock<'s>, decl: &ast::VarDecl<'s>, global: &Variable<'s>) {
        if let Some(initial) = &decl.initial {
            let whole = Span { start: decl.ty.span.end, ..initial.span };
            self.report(
                Diagnostic::new(Code::E0405, initial.span, "a VAR_EXTERNAL has no initial value")
                    .label("the value belongs to the global variable")
                    .other(global.name.span, "the global variable")
                    .help("delete it here")
                    .fix(whole, ""),
            );
        }
        let is_located = self.is_located_constant(global.name);
        if let (Some(constant), false, false) = (block.constant, global.constant, is_located) {
            let message = format!("the global `{}` is not CONSTANT", global.name.text);
            self.report(
                Diagnostic::new(Code::E0405, constant, message)
                    .label("here it is declared CONSTANT")
                    .other(global.name.span, "the global variable")
                    .help("delete CONSTANT here, or declare it in VAR_GLOBAL CONSTANT"),
            );
        }
    }

    /// A CONSTANT with an address is a variable there.
    fn is_located_constant(&self, global: ast::Name<'s>) -> bool {
        let can_be = self.dialect(global.span).has_located_constants();
        let is_it = |it: &GlobalSlot<'s>| it.name.span == global.span && it.decl.address.is_some();
        can_be && self.globals.iter().any(is_it)
    }

    fn external(&mut self, name: ast::Name<'s>) -> Option<Rc<Variable<'s>>> {
        let found = self.lookup(&[name], Sense::Value);
        if let Found::Several(meanings) = &found {
            self.report_ambiguous(name, meanings);
            return None;
        }
        let Found::One(Meaning::Declared(Entry::Global(at))) = found else {
            let near = nearest(name.text, self.globals.iter().map(|it: &GlobalSlot<'s>| it.name.text));
            let mut error = Diagnostic::missing(Missing::GlobalVariable, name.text, name.span)
                .label("VAR_EXTERNAL names a variable of a VAR_GLOBAL");
            if let Some(near) = near {
                error = error.help(format!("did you mean `{near}`?")).fix(name.span, near);
            }
            self.report(error);
            return None;
        };
        self.global(at)
    }
}

fn names_globals(pou: &ast::Pou<'_>) -> bool {
    pou.blocks.iter().any(|it| it.kind == VarKind::External)
}
