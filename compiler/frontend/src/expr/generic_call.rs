//! Calls of generic FUNCTIONs: arguments of ANY, ANY_NUM and the like are evaluated as they are written; when all
//! are known, they determine the types, and each is converted to its own.

use super::argument::{Parts, Role, Source};
use super::checker::Checker;
use super::operand::Operand;
use super::operator::beside;
use super::order::Held;
use super::overload::Takes;
use crate::types::signature::{Formal, Signature};
use crate::{Code, Diagnostic, Span, ast};
use staunch_ir::{ExprKind, LocalId, Place, Section, Type};
use staunch_runtime::Class;

/// The call of a FUNCTION: which, as the call names it, and what is expected of its result.
#[derive(Clone, Copy)]
pub(crate) struct Called<'s> {
    pub slot: usize,
    pub name: ast::Name<'s>,
    pub expected: Option<Type>,
    pub span: Span,
}

/// A part of a call whose type the call determines.
pub(crate) struct Open {
    part: usize,
    /// Which parameter it is given for.
    formal: usize,
    word: Class,
    /// What was evaluated for an input.
    operand: Option<Operand>,
    is_output: bool,
}

/// What an output is assigned from until its type is known.
fn unknown() -> Source {
    Source::Variable(Place::local(LocalId(0), Type::BOOL))
}

impl<'s> Checker<'_, 's> {
    /// Evaluates the next part, what is given for an input or an in-out of a generic type.
    pub(crate) fn open_part(
        &mut self,
        parts: &mut Parts,
        open: &mut Vec<Open>,
        formals: &[Formal<'s>],
        (at, word): (usize, Class),
        expr: &ast::Expr<'s>,
        called: Called<'s>,
    ) -> Option<()> {
        let (part, formal) = (parts.written.len(), &formals[at]);
        if formal.section == Section::InOut {
            let place =
                self.after_parts(&mut parts.written, |this| this.variable_argument(expr, formal.name.text))?.place;
            parts.push(Held::Place(place), Role::Passed(at), expr.span);
            open.push(Open { part, formal: at, word, operand: None, is_output: false });
            return Some(());
        }
        let side = open.iter().rev().filter(|it| it.word == word).find_map(|it| beside(it.operand.as_ref()?, None));
        let hint = self.expected_of(word, called).or(side);
        let mark = self.block.len();
        let operand = self.after_parts(&mut parts.written, |this| {
            this.taken(Takes::Common(hint), expr, formal.name.text, called.name)
        })?;
        self.note_siblings(mark, operand.typed());
        let location = self.at(expr.span);
        // A number that has no type yet is one that nothing changes.
        let value = operand.typed().cloned().unwrap_or_else(|| staunch_ir::Expr::bool(false, location));
        parts.push(Held::Value(value), Role::Passed(at), expr.span);
        open.push(Open { part, formal: at, word, operand: Some(operand), is_output: false });
        Some(())
    }

    /// Evaluates the next part, what an output of a generic type is connected with.
    pub(crate) fn open_target(
        &mut self,
        parts: &mut Parts,
        open: &mut Vec<Open>,
        (at, word): (usize, Class),
        target: &ast::Expr<'s>,
        negated: bool,
    ) -> Option<()> {
        let part = parts.written.len();
        self.target_part(parts, target, negated, unknown())?;
        open.push(Open { part, formal: at, word, operand: None, is_output: true });
        Some(())
    }

    /// What is expected of a result of this word's type.
    fn expected_of(&self, word: Class, called: Called<'s>) -> Option<Type> {
        let result = self.decl.pous[called.slot].ast.result.as_ref()?;
        let expected = called.expected.filter(|_| self.decl.word(result) == Some(word));
        expected.filter(|it| self.admits(word, *it, called.span))
    }

    /// The slot of the FUNCTION with the types of its open parts.
    pub(crate) fn told_instance(&mut self, parts: &Parts, open: &[Open], called: Called<'s>) -> Option<usize> {
        let words = self.decl.pous[called.slot].words.clone();
        let types = words.into_iter().map(|word| self.told_type(parts, open, word, called)).collect::<Option<_>>()?;
        self.decl.instance_of_generic(called.slot, types, called.span, self.instance)
    }

    /// The type of a word in this call: that of the variables which are given for it, else what the values have in
    /// common.
    fn told_type(&mut self, parts: &Parts, open: &[Open], word: Class, called: Called<'s>) -> Option<Type> {
        let own = || open.iter().filter(|it| it.word == word && !it.is_output);
        let variable = own().find(|it| it.operand.is_none());
        if let Some(variable) = variable {
            let ty = parts.written[variable.part].place()?.ty;
            let span = parts.parts[variable.part].span;
            self.is_one_type(ty, span)?;
            if !self.admits(word, ty.read(), span) {
                self.report_class(word, ty, span, called.name);
                return None;
            }
            return Some(ty);
        }
        let operands: Vec<_> = own().filter_map(|it| Some((it.operand.as_ref()?, parts.parts[it.part].span))).collect();
        if operands.is_empty() {
            let message =
                format!("nothing determines which type `{}` is in this call of `{}`", word.name(), called.name.text);
            self.report(
                Diagnostic::new(Code::E0303, called.span, message).label("an argument of this type is missing"),
            );
            return None;
        }
        let ty = self.common_type(word, &operands, self.expected_of(word, called), called.name)?.read();
        self.is_one_type(ty, operands[0].1)?;
        if let Some(message) = self.decl.held_not_copied(ty, operands[0].1) {
            let error = Diagnostic::new(Code::E0210, operands[0].1, message).label("a call would copy it");
            self.report(error.help("declare the parameter in VAR_IN_OUT"));
            return None;
        }
        Some(match ty {
            Type::String(it) => {
                let written = self.literal_capacity(&operands, called.span);
                Type::String(it.of_capacity(it.capacity.max(written)))
            }
            other => other,
        })
    }

    /// Reports an array whose bounds are known in each call alone.
    fn is_one_type(&mut self, ty: Type, span: Span) -> Option<()> {
        if !self.decl.program.is_open(ty) {
            return Some(());
        }
        let message = format!("a generic parameter cannot be {}", self.type_name(ty));
        self.report(Diagnostic::new(Code::E0411, span, message).label("its bounds differ from call to call"));
        None
    }

    /// What a variable would be declared with for a text that is written: one type for texts of many lengths.
    fn literal_capacity(&self, operands: &[(&Operand, Span)], span: Span) -> u16 {
        let is_text = |it: &(&Operand, Span)| it.0.typed().is_some_and(|it| matches!(it.kind, ExprKind::Text(_)));
        if operands.iter().any(is_text) { self.decl.dialect(span).rules().default_string.choice.capacity() } else { 0 }
    }

    /// Brings the open parts to the types that the call has told; gives the storage of outputs, by their formals.
    pub(crate) fn close(
        &mut self,
        parts: &mut Parts,
        open: Vec<Open>,
        signature: &Signature<'s>,
    ) -> Option<Vec<(usize, Place)>> {
        let mut outputs = Vec::new();
        let mut complete = true;
        for Open { part, formal: at, operand, is_output, .. } in open {
            let (formal, span) = (&signature.formals[at], parts.parts[part].span);
            let ty = formal.resolved.ty;
            if is_output {
                let place = self.temporary(formal.name.text, ty);
                if let Role::Target(source, ..) = &mut parts.parts[part].role {
                    *source = Source::Variable(place.clone());
                }
                outputs.push((at, place));
            } else if let Some(operand) = operand {
                // It may have been saved since.
                let operand = match (operand, parts.written[part].value()) {
                    (Operand::Typed(_), Some(value)) => Operand::Typed(value.clone()),
                    (Operand::Promoted(_, own), Some(value)) => Operand::Promoted(value.clone(), own),
                    (literal, _) => literal,
                };
                match self.at_type(operand, ty, span) {
                    Some(value) => parts.written[part].held = Held::Value(value),
                    None => complete = false,
                }
            } else {
                let place = parts.written[part].place()?.clone();
                match self.in_out_role(formal, &place, at, span) {
                    Some(role) => parts.parts[part].role = role,
                    None => complete = false,
                }
            }
        }
        complete.then_some(outputs)
    }
}
