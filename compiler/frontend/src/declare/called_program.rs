//! PROGRAMs that others name: such a one does not run by itself. It has one instance, which the globals
//! hold under its name.

use super::{Declarations, Entry, Variable, types};
use crate::names::Key;
use crate::{Code, Diagnostic, Span, ast};
use staunch_ir::{Field, Retain, Section};
use std::rc::Rc;

/// The instance of a PROGRAM that is named somewhere.
#[derive(Debug)]
pub(crate) struct Named<'s> {
    variable: Rc<Variable<'s>>,
    /// Where it is named first.
    first: Span,
    is_called: bool,
}

impl<'s> Declarations<'s> {
    /// Gives the PROGRAMs that bodies name their instances, before a body asks what the globals hold.
    pub fn find_named_programs(&mut self, statements: &[Vec<ast::Statement<'s>>]) {
        for (at, body) in statements.iter().enumerate() {
            if !self.dialect(self.pous[at].ast.name.span).calls_programs() {
                continue;
            }
            let Some(signature) = self.signature(at) else { continue };
            let mut found = Vec::new();
            ast::each_expr(body, &mut |it| {
                let (callee, is_called) = match &it.kind {
                    ast::ExprKind::Call(callee, _) => (callee.bare(), true),
                    _ => (it, false),
                };
                if let ast::ExprKind::Name(name) = &callee.kind
                    && let Some(Entry::Pou(slot)) = self.names.get(&Key(name.text))
                    && self.pous[*slot].ast.kind == ast::PouKind::Program
                    && signature.scope.get(name.text).is_none()
                {
                    found.push((*slot, name.span, is_called));
                }
            });
            for (slot, span, is_called) in found {
                self.name_program(slot, span, is_called);
            }
        }
    }

    fn name_program(&mut self, slot: usize, first: Span, is_called: bool) {
        if let Some(named) = self.named_programs.get_mut(&slot) {
            named.is_called |= is_called;
        } else if let Some(variable) = self.instance_of_program(slot) {
            self.named_programs.insert(slot, Named { variable: Rc::new(variable), first, is_called });
        }
    }

    fn instance_of_program(&mut self, slot: usize) -> Option<Variable<'s>> {
        let signature = self.signature(slot)?;
        let resolved = types::instance_of(&self.program, signature.state?);
        let pou: &'s ast::Pou<'s> = self.pous[slot].ast;
        let field = Field {
            name: pou.name.text.to_owned(),
            ty: resolved.ty,
            initial: resolved.initial.clone(),
            section: Section::Global,
            retain: Retain::Inherited,
            constant: false,
            address: None,
            doc: pou.doc.clone(),
            location: self.location(pou.name.span),
        };
        let at = self.add_hidden(field, Some(pou.name));
        Some(Variable {
            name: pou.name,
            place: self.hidden_place(at),
            resolved: Rc::new(resolved),
            section: Section::Global,
            constant: false,
            retain: false,
            used: Rc::default(),
        })
    }

    /// The instance that the name of the PROGRAM in a slot means.
    pub fn program_variable(&self, slot: usize) -> Option<Rc<Variable<'s>>> {
        self.named_programs.get(&slot).map(|it| Rc::clone(&it.variable))
    }

    /// Whether the PROGRAM in a slot has its instance among the globals.
    pub fn is_named_program(&self, slot: usize) -> bool {
        self.named_programs.contains_key(&slot)
    }

    /// Reports PROGRAMs whose variables are read, but which nobody calls: they run by themselves, and
    /// their variables belong to those runs.
    pub fn check_named_programs(&mut self) {
        let mut alone: Vec<_> = self.named_programs.iter().filter(|(_, it)| !it.is_called).collect();
        alone.sort_by_key(|(slot, _)| **slot);
        let alone: Vec<_> = alone.into_iter().map(|(_, it)| (it.variable.name, it.first)).collect();
        for (name, span) in alone {
            self.report(
                Diagnostic::new(Code::E0902, span, format!("reading `{}`, a PROGRAM that runs by itself", name.text))
                    .label("only those that are called by name can be read from outside yet")
                    .other(name.span, "nobody calls it")
                    .help(format!("call it here, `{}();`, or share the value in a VAR_GLOBAL", name.text)),
            );
        }
    }

    /// Reports a PROGRAM that a CONFIGURATION lists, and others call.
    pub fn report_called_and_listed(&mut self, slot: usize, listed: Span) -> bool {
        let Some(named) = self.named_programs.get(&slot) else { return false };
        let (name, first) = (named.variable.name.text, named.first);
        self.report(
            Diagnostic::new(Code::E0902, listed, format!("`{name}` both runs in a RESOURCE and is called by name"))
                .label("one of the two is supported, not both yet")
                .other(first, "named here")
                .help("delete it here, or call it nowhere"),
        );
        true
    }
}
