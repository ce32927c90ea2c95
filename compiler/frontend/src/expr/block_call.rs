//! Calls of instances: standard blocks, a user's FUNCTION_BLOCKs, and Logix instructions.

use super::argument::{Parts, Role, Source, as_written};
use super::binding::{Given, Parameter};
use super::checker::Checker;
use super::operand::Operand;
use super::order::Held;
use super::place::{Access, Found};
use crate::diagnostic::wording::article;
use crate::types::signature::{Target, pin_place};
use crate::{Code, Diagnostic, Span, ast};
use staunch_ir::{Argument, BlockId, Conversion, Expr, FieldId, Place, Root, RoutineId, Section, StatementKind, Type};
use staunch_runtime::Direction;

impl<'s> Checker<'_, 's> {
    pub(crate) fn instance_call(
        &mut self,
        callee: &ast::Expr<'s>,
        arguments: &[ast::Argument<'s>],
        span: Span,
    ) -> Option<()> {
        let found = self.place(callee)?;
        self.note_called(&found.place, arguments, callee);
        match found.place.ty {
            Type::Block(id) => self.standard_block(found, id, arguments, callee.span, span),
            Type::Struct(id) if self.decl.is_instance(id) => {
                let slot = self.decl.slot_of_instance(id)?;
                let bound = self.bound_in_program(&found.place, slot, callee);
                self.copy_in(&bound);
                self.user_block(found, slot, arguments, callee.span, span)?;
                self.copy_out(&bound);
                Some(())
            }
            Type::Array(_) => {
                self.report_array_called(callee, arguments);
                None
            }
            other => {
                let ty = self.type_name(other);
                self.report(
                    Diagnostic::new(Code::E0305, callee.span, format!("a variable of type {ty} cannot be called"))
                        .label("this is not an instance of a block"),
                );
                None
            }
        }
    }

    pub(crate) fn callable(&mut self, found: &Found<'s>, span: Span) -> Option<()> {
        match found.access {
            // What a reference leads to is called, not the reference.
            Access::Constant(_) | Access::Result if self.decl.interface_of(found.place.ty).is_some() => Some(()),
            Access::Constant(name) => {
                self.error(Code::E0501, span, format!("`{}` is a CONSTANT and cannot be called", name.text));
                None
            }
            Access::Inner(_) => self.may_be_given_away(found, span).then_some(()),
            Access::Write | Access::OwnInput(_) | Access::Output(_) => Some(()),
            Access::Result => self.may_be_given_away(found, span).then_some(()),
        }
    }

    fn standard_block(
        &mut self,
        found: Found<'s>,
        id: BlockId,
        arguments: &[ast::Argument<'s>],
        callee: Span,
        span: Span,
    ) -> Option<()> {
        self.may_call_method(&found, callee)?;
        let info = id.info();
        if info.instructions.iter().any(|it| !it.name.is_empty()) {
            let names: Vec<_> = info.instructions.iter().map(|it| it.name).collect();
            self.report(
                Diagnostic::new(Code::E0305, callee, format!("{} is not called itself", article(info.name)))
                    .label(format!("it is worked on by {}", crate::diagnostic::wording::list(&names)))
                    .help(format!("write `{}({}, …)`", names[0], self.decl.log.sources.text(callee))),
            );
            return None;
        }
        let mut parameters: Vec<_> = info
            .pins
            .iter()
            .filter(|it| matches!(it.direction, Direction::Input | Direction::Output))
            .map(|it| Parameter { name: it.name, section: section(it.direction) })
            .collect();
        if let Some(kept) = info.facts.kept {
            let at = info.inputs().count();
            parameters.insert(at, Parameter { name: kept.pin, section: Section::InOut });
        }
        let moved = self.arguments_by_own_names(id, arguments);
        let arguments = moved.as_deref().unwrap_or(arguments);
        let given = self.bind(info.name, &parameters, arguments, |name| super::unresolved::unknown_pin(id, name))?;
        if self.decl.dialect(span).wants_all_positions() {
            self.require_all(info.name, &parameters, &given, arguments, |_, _| false, span)?;
        }
        let mut parts = Parts::default();
        let place = found.place;
        parts.push(Held::Place(place.clone()), Role::Instance, callee);
        let mut complete = true;
        let mut inputs = vec![None; info.inputs().count()];
        for at in as_written(&given) {
            self.late_target_before(&mut parts, &given[at]);
            let parameter = &parameters[at];
            let made = match given[at] {
                Given::Value(expr) if parameter.section == Section::InOut => {
                    self.count_part(&mut parts, &place, id, expr)
                }
                Given::Value(expr) => {
                    let number = info.inputs().position(|it| it.name == parameter.name)?;
                    inputs[number] = Some(parts.written.len());
                    let (_, ty) = pin(id, parameter.name)?;
                    self.pin_part(&mut parts, id, expr, ty, 1 + number)
                }
                Given::Output { target: Some(target), negated } => {
                    let (field, ty) = pin(id, parameter.name)?;
                    self.target_part(&mut parts, target, negated, Source::Field(field, ty))
                }
                Given::Nothing | Given::Output { target: None, .. } => Some(()),
            };
            complete &= made.is_some();
        }
        if info.facts.kept.is_some() && !parameters.iter().zip(&given).any(|(it, given)| is_given(it, given)) {
            self.report_no_count(callee);
            return None;
        }
        if !complete {
            return None;
        }
        let at = self.at(span);
        // What is left out holds what it was given last.
        let kept = |place: &Place, pin: usize| {
            let name = info.inputs().nth(pin).map(|it| it.name)?;
            Some(Expr::load(pin_place(place.clone(), id, name), at))
        };
        let call = |parts: &Parts| {
            let block = parts.instance()?.clone();
            let value = |(pin, part): (usize, &Option<usize>)| match part {
                Some(at) => parts.written[*at].value().cloned(),
                None => kept(&block, pin),
            };
            let inputs = inputs.iter().enumerate().map(value).collect::<Option<_>>()?;
            Some(StatementKind::CallBlock { block, instruction: 0, inputs })
        };
        self.perform(parts, &call, span).map(drop)
    }

    /// Evaluates the next part, what is given for an input of a standard block.
    fn pin_part(&mut self, parts: &mut Parts, id: BlockId, expr: &ast::Expr<'s>, ty: Type, turn: usize) -> Option<()> {
        let overload = id.info().facts.overload.filter(|_| self.decl.dialect(expr.span).overloads_timers());
        let value = self.after_parts(&mut parts.written, |this| match this.operand(expr, Some(ty))? {
            Operand::Typed(value) if overload.is_some_and(|it| value.ty == Type::Elementary(it)) => {
                Some(this.convert(Conversion::Value, ty, value))
            }
            operand => this.coerce(operand, ty, expr.span),
        })?;
        parts.push(Held::Value(value), Role::Passed(turn), expr.span);
        Some(())
    }

    /// Evaluates the next part, the variable that keeps a counter's count.
    fn count_part(&mut self, parts: &mut Parts, counter: &Place, id: BlockId, expr: &ast::Expr<'s>) -> Option<()> {
        let kept = self.after_parts(&mut parts.written, |this| this.retained_count(counter, expr))?;
        let (field, ty) = pin(id, "CV")?;
        parts.push(Held::Place(kept), Role::Count(field, ty), expr.span);
        Some(())
    }

    /// A call of an instance, or of an ACTION of it: `slot` is that of its FUNCTION_BLOCK or of the ACTION.
    pub(crate) fn user_block(
        &mut self,
        found: Found<'s>,
        slot: usize,
        arguments: &[ast::Argument<'s>],
        callee: Span,
        span: Span,
    ) -> Option<()> {
        self.may_call_method(&found, callee)?;
        if self.decl.pous[slot].ast.kind == ast::PouKind::Class {
            let name = self.decl.pous[slot].ast.name.text;
            self.report(
                Diagnostic::new(Code::E0305, callee, format!("`{name}` is a CLASS, which has no body"))
                    .label("its METHODs are called"),
            );
            return None;
        }
        let signature = self.decl.signature(slot)?;
        let owner = self.decl.pous[slot].ast.name.text;
        let formals = &signature.formals;
        let arguments = &self.accepted(&signature, arguments)?;
        let parameters: Vec<_> =
            formals.iter().map(|it| Parameter { name: it.name.text, section: it.section }).collect();
        let is_known = |it: &ast::Argument<'s>| match &it.kind {
            ast::ArgumentKind::Input(name, _) | ast::ArgumentKind::Output { name, .. } => {
                formals.iter().any(|it| it.name.text.eq_ignore_ascii_case(name.text))
            }
            ast::ArgumentKind::Positional(_) => true,
        };
        if self.decl.has_unknown_base(slot) && !arguments.iter().all(is_known) {
            self.check_arguments(arguments);
            return None;
        }
        let given = self.bind(owner, &parameters, arguments, |name| Self::unknown_formal(owner, formals, name))?;
        if self.decl.dialect(span).wants_all_positions() {
            let is_optional = |this: &Self, at: usize| this.has_initial(&formals[at], slot);
            self.require_all(owner, &parameters, &given, arguments, is_optional, span)?;
        }
        let mut parts = Parts::default();
        let is_this = found.place.root == Root::Instance && found.place.projections.is_empty();
        let dispatch = self.dispatch(&found.place, slot, callee, span);
        if let Some(dispatch) = &dispatch {
            self.check_in_outs(dispatch, slot, callee)?;
        }
        parts.push(Held::Place(found.place), Role::Instance, callee);
        let mut references = vec![None; formals.len()];
        let mut complete = true;
        for at in as_written(&given) {
            self.late_target_before(&mut parts, &given[at]);
            let formal = &formals[at];
            let ty = formal.resolved.ty;
            let made = match (formal.target, given[at]) {
                (Target::Field(field), Given::Output { target: Some(target), negated }) => {
                    self.target_part(&mut parts, target, negated, Source::Field(field, ty))
                }
                (Target::Field(field), Given::Value(expr)) if formal.section == Section::InOut => {
                    self.polymorphic_part(&mut parts, formal, Role::Stored(field, ty), expr)
                }
                (Target::Field(field), Given::Value(expr)) => {
                    self.is_of_class(formal, expr)?;
                    self.value_part(&mut parts, expr, ty, Role::Stored(field, ty))
                }
                (Target::Param(_), Given::Value(expr)) => {
                    references[at] = Some(parts.written.len());
                    self.in_out_part(&mut parts, formal, 1 + at, expr)
                }
                (_, Given::Nothing | Given::Output { .. }) => Some(()),
            };
            complete &= made.is_some();
        }
        let in_outs = || (0..formals.len()).filter(|it| formals[*it].section == Section::InOut);
        // An ACTION of the POU itself works with what that was given.
        let own: Vec<_> = formals.iter().map(|it| self.passed_on(it.name).filter(|_| is_this)).collect();
        let is_param = |it: &usize| matches!(formals[*it].target, Target::Param(_));
        // What an ACTION of the POU itself works with is in the instance, or passed on.
        let is_there = |it: usize| own[it].is_some() || is_this && !is_param(&it);
        for at in in_outs().filter(|it| matches!(given[*it], Given::Nothing) && !is_there(*it)) {
            self.report_no_variable(&formals[at], owner, callee);
            complete = false;
        }
        if !complete {
            return None;
        }
        let call = |parts: &Parts| {
            let argument = |at: usize| match references[at] {
                Some(part) => Some(parts.argument(part)),
                None => own[at].clone().map(Argument::Reference),
            };
            let arguments: Vec<_> = in_outs().filter(is_param).map(argument).collect::<Option<_>>()?;
            let call = |callee, instance| {
                let arguments = Vec::clone(&arguments);
                StatementKind::Call { callee, instance: Some(instance), arguments, result: None }
            };
            let instance = parts.instance()?.clone();
            Some(match &dispatch {
                Some(dispatch) => dispatch.statement(&instance, &call),
                None => call(RoutineId::next(slot), instance),
            })
        };
        self.perform(parts, &call, span).map(drop)
    }

    /// The arguments but those for parameters whose declarations were refused; `None` where it is not
    /// known which those are.
    pub(crate) fn accepted<'a>(
        &mut self,
        signature: &crate::types::signature::Signature<'s>,
        arguments: &'a [ast::Argument<'s>],
    ) -> Option<std::borrow::Cow<'a, [ast::Argument<'s>]>> {
        let positional = |it: &ast::Argument<'s>| matches!(it.kind, ast::ArgumentKind::Positional(_));
        if signature.scope.has_refused() && arguments.iter().any(positional) {
            self.check_arguments(arguments);
            return None;
        }
        let refused = |it: &ast::Argument<'s>| match &it.kind {
            ast::ArgumentKind::Positional(_) => false,
            ast::ArgumentKind::Input(name, _) | ast::ArgumentKind::Output { name, .. } => {
                signature.scope.is_refused(name.text)
            }
        };
        if arguments.iter().any(refused) {
            Some(arguments.iter().filter(|it| !refused(it)).cloned().collect::<Vec<_>>().into())
        } else {
            Some(arguments.into())
        }
    }

    /// The statements that feed the triggers of R_EDGE and F_EDGE inputs.
    pub(crate) fn edge_inputs(&mut self, signature: &crate::types::signature::Signature<'s>, span: Span) {
        for edge in &signature.edges {
            let at = self.at(span);
            let inputs = vec![Expr::load(edge.input.clone(), at)];
            self.push(StatementKind::CallBlock { block: edge.trigger.clone(), instruction: 0, inputs }, span);
        }
    }
}

fn section(direction: Direction) -> Section {
    match direction {
        Direction::Input => Section::Input,
        Direction::Output => Section::Output,
        Direction::Memory | Direction::Member => Section::Internal,
    }
}

/// A pin of a standard block.
fn pin(id: BlockId, name: &str) -> Option<(FieldId, Type)> {
    let field = FieldId::next(id.info().pins.iter().position(|it| it.name == name)?);
    Some((field, id.pin_type(field)?))
}

/// Whether a call gives the variable for a count.
fn is_given(parameter: &Parameter<'_>, given: &Given<'_, '_>) -> bool {
    parameter.section == Section::InOut && matches!(given, Given::Value(_))
}
