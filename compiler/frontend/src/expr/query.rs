//! `__QUERYINTERFACE` and `__QUERYPOINTER`: whether the instance that a variable of an INTERFACE refers to is of a class that
//! has another INTERFACE, or is of a pointer's class.

use super::checker::Checker;
use super::dispatch::class_of;
use super::operand::Operand;
use crate::{Code, Diagnostic, Span, ast};
use ast::{ArgumentKind, ExprKind as Ast};
use staunch_ir::{Arm, Conversion, Expr, Place, RefKind, Statement, StatementKind, StructId, Type};

fn is_query(name: &str) -> bool {
    ["__QUERYINTERFACE", "__QUERYPOINTER"].iter().any(|it| it.eq_ignore_ascii_case(name))
}

impl<'s> Checker<'_, 's> {
    /// A query, where `callee` names one; the inner `None` says that it was reported.
    pub(crate) fn query(
        &mut self,
        callee: &ast::Expr<'s>,
        arguments: &[ast::Argument<'s>],
        span: Span,
    ) -> Option<Option<Operand>> {
        let Ast::Name(name) = &callee.kind else { return None };
        if !is_query(name.text) || self.signature.is_none() {
            return None;
        }
        let [
            ast::Argument { kind: ArgumentKind::Positional(from), .. },
            ast::Argument { kind: ArgumentKind::Positional(to), .. },
        ] = arguments
        else {
            self.report(
                Diagnostic::new(Code::E0302, span, format!("`{}` takes 2 arguments", name.text))
                    .label("an instance or a variable of an INTERFACE, and the variable that will refer to it"),
            );
            return Some(None);
        };
        Some(self.query_of(*name, from, to, span))
    }

    fn query_of(
        &mut self,
        name: ast::Name<'s>,
        from: &ast::Expr<'s>,
        to: &ast::Expr<'s>,
        span: Span,
    ) -> Option<Operand> {
        let source = self.queried(from)?;
        let pointer = self.temporary("instance", source.ty);
        self.assign(pointer.clone(), source, from.span);
        let found = self.place_of_reference(to)?;
        if !self.writable(&found, to.span) {
            return None;
        }
        let wants_pointer = name.text.eq_ignore_ascii_case("__QUERYPOINTER");
        let classes = self.answering(found.place.ty, wants_pointer, to.span)?;
        let numbers: Vec<_> = classes.into_iter().map(|it| self.decl.class_number(it, span)).collect();
        Some(Operand::Typed(self.answer(&pointer, found.place, &numbers, span)))
    }

    /// `r ?= x` where it depends on the instance that `x` is or refers to: a variable of an INTERFACE, or a reference to a
    /// class, refers to it from now on where its class fits, else to nothing. `None` where that is known already.
    pub(crate) fn attempt_of_instance(
        &mut self,
        target: &ast::Expr<'s>,
        value: &ast::Expr<'s>,
        span: Span,
    ) -> Option<Option<()>> {
        let (to, from) = (self.static_type(target)?, self.static_type(value)?);
        let is_interface = self.decl.interface_of(to).is_some();
        if !is_interface && self.class_behind(to).is_none() || self.is_known_to_fit(from, to) {
            return None;
        }
        let from_interface = self.decl.interface_of(from).is_some();
        let is_instance = matches!(from, Type::Struct(state) if self.decl.is_instance(state));
        if !from_interface && !is_instance && self.class_behind(from).is_none() {
            return None;
        }
        Some(self.attempt_known(target, value, is_instance, !is_interface, span))
    }

    fn attempt_known(
        &mut self,
        target: &ast::Expr<'s>,
        value: &ast::Expr<'s>,
        is_instance: bool,
        wants_pointer: bool,
        span: Span,
    ) -> Option<()> {
        let source = if is_instance { self.reference_to(value, RefKind::RefTo)? } else { self.typed(value, None)? };
        let pointer = self.temporary("instance", source.ty);
        self.assign(pointer.clone(), source, value.span);
        let found = self.place_of_reference(target)?;
        if !self.writable(&found, target.span) {
            return None;
        }
        let classes = self.answering(found.place.ty, wants_pointer, target.span)?;
        let numbers: Vec<_> = classes.into_iter().map(|it| self.decl.class_number(it, span)).collect();
        self.answer(&pointer, found.place, &numbers, span);
        Some(())
    }

    /// The class that a type refers to the instances of.
    fn class_behind(&self, ty: Type) -> Option<usize> {
        let Type::Reference(id) = ty else { return None };
        let Type::Struct(state) = self.decl.program.target(id) else { return None };
        self.decl.slot_of_instance(state).filter(|_| self.decl.interface_of(ty).is_none())
    }

    /// Whether all that a variable of one type refers to, or is, fits the other.
    fn is_known_to_fit(&mut self, from: Type, to: Type) -> bool {
        let own = match from {
            Type::Struct(state) => self.decl.slot_of_instance(state),
            _ => self.class_behind(from).or_else(|| self.decl.interface_of(from)),
        };
        let Some(own) = own else { return true };
        match (self.decl.interface_of(to), to) {
            (Some(interface), _) => own == interface || self.decl.interfaces_of(own).contains(&interface),
            (None, Type::Reference(id)) => {
                let state = self.decl.signature(own).and_then(|it| it.state).map(Type::Struct);
                let wanted = self.decl.program.target(id);
                state.is_some_and(|it| self.decl.extends(it, wanted))
            }
            (None, _) => true,
        }
    }

    /// The reference that is asked: a variable of an INTERFACE, or an instance.
    fn queried(&mut self, from: &ast::Expr<'s>) -> Option<Expr> {
        match self.static_type(from) {
            Some(Type::Struct(state)) if self.decl.is_instance(state) => self.reference_to(from, RefKind::RefTo),
            Some(ty) if self.decl.interface_of(ty).is_some() => self.typed(from, None),
            Some(_) | None => {
                let value = self.typed(from, None)?;
                let ty = self.type_name(value.ty);
                self.report(
                    Diagnostic::new(Code::E0211, from.span, format!("a query needs an instance, but this is {ty}"))
                        .label("expected an instance, or a variable of an INTERFACE"),
                );
                None
            }
        }
    }

    /// The states of the classes whose instances the variable may refer to.
    fn answering(&mut self, ty: Type, wants_pointer: bool, span: Span) -> Option<Vec<StructId>> {
        let classes = match (self.decl.interface_of(ty), ty) {
            (Some(interface), _) if !wants_pointer => self.decl.implementers(interface).to_vec(),
            (None, Type::Reference(id)) if wants_pointer => {
                let target = self.decl.program.target(id);
                let Type::Struct(state) = target else { return self.report_answer(ty, wants_pointer, span) };
                let slot = self.decl.slot_of_instance(state);
                slot.map_or_else(Vec::new, |it| self.decl.kin(it))
            }
            _ => return self.report_answer(ty, wants_pointer, span),
        };
        Some(classes.into_iter().filter_map(|it| self.decl.signature(it)?.state).collect())
    }

    fn report_answer(&mut self, ty: Type, wants_pointer: bool, span: Span) -> Option<Vec<StructId>> {
        let wanted = if wants_pointer { "POINTER TO a FUNCTION_BLOCK" } else { "variable of an INTERFACE" };
        let found = self.type_name(ty);
        self.report(
            Diagnostic::new(Code::E0211, span, format!("expected a {wanted}, but this is {found}"))
                .label("it will refer to the instance, or be null"),
        );
        None
    }

    /// Whether the instance is of one of these classes: then the target refers to it, else to nothing.
    fn answer(&mut self, pointer: &Place, target: Place, numbers: &[u64], span: Span) -> Expr {
        let at = self.at(span);
        let result = self.temporary("found", Type::BOOL);
        let same = self.convert(Conversion::Same, target.ty, Expr::load(pointer.clone(), at));
        let null = self.null(Some(target.ty), span);
        let set = |value, found| {
            vec![
                Statement::assign(target.clone(), value, at),
                Statement::assign(result.clone(), Expr::bool(found, at), at),
            ]
        };
        let (labels, nothing) = (numbers.iter().map(|it| (i128::from(*it), i128::from(*it))), set(null, false));
        let labels: Vec<_> = labels.collect();
        if labels.is_empty() {
            self.block.extend(nothing);
        } else {
            let arms = vec![Arm { labels, body: set(same, true) }];
            self.push(StatementKind::Case { selector: class_of(pointer, at), arms, otherwise: nothing }, span);
        }
        Expr::load(result, at)
    }
}
