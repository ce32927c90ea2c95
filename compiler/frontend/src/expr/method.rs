//! Calls of METHODs and ACTIONs: on which instance, and who may make them.

use super::checker::Checker;
use super::generic_call::Called;
use super::place::{Access, Found};
use crate::names::{self, Entry, Meaning, Sense};
use crate::types::declarations::Slot;
use crate::{Code, Diagnostic, Span, ast};
use ast::{ExprKind as Ast, PouKind};
use staunch_ir::{Expr, FieldId, Place, RefKind, Root, Type};

impl<'s> Checker<'_, 's> {
    /// The METHOD or ACTION that a bare name means: one of the POU around.
    pub(crate) fn own_routine(&self, name: ast::Name<'s>) -> Option<usize> {
        self.decl.routine_of(self.signature.as_ref()?.state?, name.text)
    }

    /// The METHOD or ACTION that `instance.name` means.
    pub(crate) fn routine_of(&self, instance: &ast::Expr<'s>, name: ast::Name<'s>) -> Option<usize> {
        let Type::Struct(state) = self.static_type(instance)? else { return None };
        self.decl.routine_of(state, name.text)
    }

    pub(crate) fn routine_call(
        &mut self,
        slot: usize,
        callee: &ast::Expr<'s>,
        arguments: &[ast::Argument<'s>],
        span: Span,
    ) -> Option<Option<Expr>> {
        let found = if let Ast::Member(instance, name) = &callee.bare().kind {
            self.may_call(slot, *name)?;
            self.place(instance)?
        } else {
            self.this()?
        };
        match self.decl.pous[slot].ast.kind {
            PouKind::Method => {
                self.callable(&found, callee.span)?;
                let name = ast::Name { text: self.decl.pous[slot].ast.name.text, span: callee.span };
                let called = Called { slot, name, expected: None, span };
                self.user_function(called, Some((found.place, callee.span)), arguments)
            }
            PouKind::Action | PouKind::Program | PouKind::FunctionBlock | PouKind::Function | PouKind::Test => {
                self.user_block(found, slot, arguments, callee.span, span).map(|()| None)
            }
        }
    }

    /// The instance whose routine this is.
    pub(crate) fn this(&self) -> Option<Found<'s>> {
        let place = Place::root(Root::Instance, Type::Struct(self.signature.as_ref()?.state?));
        Some(Found { place, view: None, access: Access::Write })
    }

    /// Reports a call from outside of what is PRIVATE or PROTECTED.
    fn may_call(&mut self, slot: usize, name: ast::Name<'s>) -> Option<()> {
        let Some((access, span)) = self.decl.pous[slot].ast.modifiers.access else { return Some(()) };
        let own = self.signature.as_ref().and_then(|it| it.state).and_then(|it| self.decl.slot_of_instance(it));
        let is_inside = own.is_some() && own == self.decl.pous[slot].owner;
        let of_namespace = self.decl.names.is_inside(name.span, self.decl.names.space_of(span));
        let routines = "only the routines of its own FUNCTION_BLOCK call it";
        let (word, who) = match access {
            ast::Access::Public => return Some(()),
            // Outside of every NAMESPACE a program is one library.
            ast::Access::Internal if of_namespace || self.is_test() => return Some(()),
            ast::Access::Private | ast::Access::Protected if is_inside || self.is_test() => return Some(()),
            ast::Access::Internal => ("INTERNAL", "only what is in its own namespace calls it"),
            ast::Access::Private => ("PRIVATE", routines),
            ast::Access::Protected => ("PROTECTED", routines),
        };
        let title = self.decl.title(slot);
        self.report(
            Diagnostic::new(Code::E0109, name.span, format!("`{title}` is {word}"))
                .label(who)
                .other(span, "declared so here"),
        );
        None
    }

    /// The type of what a place holds, found without calling, reporting or noting anything; a REFERENCE TO is
    /// what it refers to.
    pub(crate) fn static_type(&self, expr: &ast::Expr<'s>) -> Option<Type> {
        let ty = match &expr.kind {
            Ast::Name(name) => self.type_of_name(*name)?,
            Ast::Paren(inner) => self.static_type(inner)?,
            Ast::Member(owner, name) => self.type_of_member(owner, *name)?,
            Ast::Index(base, indices) => {
                let mut ty = self.static_type(base)?;
                for _ in indices {
                    let Type::Array(id) = ty else { return None };
                    ty = self.decl.program.array(id).element;
                }
                ty
            }
            Ast::Deref(inner) if is_this(inner) => self.this()?.place.ty,
            Ast::Deref(inner) => {
                let Type::Reference(id) = self.static_type(inner)? else { return None };
                self.decl.program.target(id)
            }
            Ast::Literal(_)
            | Ast::Address(_)
            | Ast::Part(..)
            | Ast::Call(..)
            | Ast::Unary(..)
            | Ast::Binary(..)
            | Ast::Error(_) => return None,
        };
        match ty {
            Type::Reference(id) if self.decl.program.references[id.index()].kind == RefKind::ReferenceTo => {
                Some(self.decl.program.target(id))
            }
            other => Some(other),
        }
    }

    fn type_of_name(&self, name: ast::Name<'s>) -> Option<Type> {
        if let Some(variable) = self.scope.get(name.text) {
            return Some(variable.place.ty);
        }
        if is_word(name, "THIS") {
            return Some(self.this()?.place.ty);
        }
        match self.decl.lookup(&[name], Sense::Value) {
            names::Found::One(Meaning::Declared(Entry::Global(_))) => self.decl.type_of_global(name),
            names::Found::One(Meaning::Declared(Entry::Pou(slot))) if self.is_callable_program(slot, name) => {
                Some(self.decl.program_variable(slot)?.place.ty)
            }
            names::Found::One(_) | names::Found::Several(_) | names::Found::Nothing => None,
        }
    }

    fn type_of_member(&self, owner: &ast::Expr<'s>, name: ast::Name<'s>) -> Option<Type> {
        if let Some(mut path) = owner.path()
            && path.first().is_some_and(|it| self.scope.get(it.text).is_none())
            && let names::Found::One(Meaning::Declared(Entry::Global(at))) = {
                path.push(name);
                self.decl.lookup(&path, Sense::Value)
            }
        {
            let Slot::Done(variable) = &self.decl.globals[at].slot else { return None };
            return Some(variable.place.ty);
        }
        let ty = self.static_type(owner)?;
        let Type::Struct(id) = ty else { return None };
        let fields = &self.decl.program.structure(id).fields;
        let at = fields.iter().position(|it| it.name.eq_ignore_ascii_case(name.text))?;
        self.decl.program.member(ty, FieldId::next(at))
    }

    /// `THIS^`, and the standard's `THIS`; the inner `None` says that it was reported.
    pub(crate) fn this_of(&mut self, expr: &ast::Expr<'s>) -> Option<Option<Found<'s>>> {
        let word = if let Ast::Deref(inner) = &expr.kind { inner.bare() } else { expr };
        let Ast::Name(name) = &word.kind else { return None };
        if !is_word(*name, "THIS") {
            return None;
        }
        if self.scope.get(name.text).is_some() {
            return None;
        }
        let this = self.this().filter(|_| self.is_function_block());
        if this.is_none() {
            self.report(
                Diagnostic::new(Code::E0101, name.span, "THIS is the instance of a FUNCTION_BLOCK, which this is not")
                    .label("there is no instance here"),
            );
        }
        Some(this)
    }
}

/// Whether an expression is the word THIS.
fn is_this(expr: &ast::Expr<'_>) -> bool {
    matches!(&expr.bare().kind, Ast::Name(name) if is_word(*name, "THIS"))
}

fn is_word(name: ast::Name<'_>, word: &str) -> bool {
    name.text.eq_ignore_ascii_case(word)
}
