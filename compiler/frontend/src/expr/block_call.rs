//! Calls of instances: standard blocks, a user's FUNCTION_BLOCKs, and Logix instructions.

use super::argument::{Parts, Role, Source, as_written};
use super::binding::{Given, Parameter};
use super::checker::Checker;
use super::operand::Operand;
use super::order::Held;
use super::place::{Access, Found};
use crate::diagnostic::wording::article;
use crate::dialect::Dialect;
use crate::index::recorder::Named;
use crate::types::signature::{Formal, Target, pin_place};
use crate::{Code, Diagnostic, Span, ast};
use staunch_ir::{Argument, BlockId, Conversion, Expr, FieldId, Place, Root, RoutineId, Section, StatementKind, Type};
use staunch_runtime::{Direction, Family};

/// What an ACTION of the POU itself has for an in-out that its call does not give.
enum OwnInOut {
    None,
    /// The body was given it, and passes it on.
    Passed(Place),
    /// It is in the instance.
    Kept,
}

impl<'s> Checker<'_, 's> {
    pub(crate) fn instance_call(
        &mut self,
        callee: &ast::Expr<'s>,
        arguments: &[ast::Argument<'s>],
        span: Span,
    ) -> Option<()> {
        let callee = self.counter_of_instruction(callee).unwrap_or(callee);
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
                if let Some((_, name, _)) = self.property(callee) {
                    self.report_property_called(name, arguments, callee.span, span);
                    return None;
                }
                let ty = self.type_name(other);
                let error =
                    Diagnostic::new(Code::E0305, callee.span, format!("a variable of type {ty} cannot be called"))
                        .label("this is not an instance of a block");
                self.report(match arguments {
                    [ast::Argument { kind: ast::ArgumentKind::Positional(value), .. }] => {
                        let text = [callee.span, value.span].map(|it| self.decl.log.sources.text(it));
                        error.help(format!("to assign, write `{} := {};`", text[0], text[1]))
                    }
                    _ => error,
                });
                None
            }
        }
    }

    /// `c` of `c.CTU(…)`, where `c` is a CTU of S7: a counter's data is called as what the instruction is. Where the program
    /// moves from there, what is called otherwise is a lint.
    fn counter_of_instruction<'a>(&mut self, callee: &'a ast::Expr<'s>) -> Option<&'a ast::Expr<'s>> {
        let ast::ExprKind::Member(counter, name) = &callee.kind else { return None };
        let Some(Type::Block(id)) = self.static_type(counter) else { return None };
        let info = id.info();
        let instruction = info.name.split('_').next().unwrap_or_default();
        if !info.is_counter() || !name.text.eq_ignore_ascii_case(instruction) {
            return None;
        }
        if info.family == Family::S7 {
            self.decl.log.note(name.span, || Named::Block(id));
            return Some(counter.as_ref());
        }
        (self.decl.log.options.moved_from? == Dialect::Siemens).then_some(())?;
        let (text, system) = (self.decl.log.sources.text(counter.span), info.family.name());
        let message = format!("`{text}.{}(…)` is `{text}(…)` in {system}", name.text);
        let member = Span { start: counter.span.end, ..name.span };
        let lint =
            Diagnostic::new(Code::W0609, name.span, message).label("S7 calls a counter's data by the instruction");
        self.report(lint.help("call the instance itself").fix(member, ""));
        Some(counter.as_ref())
    }

    /// `m.Val()`: a PROPERTY is read without parentheses.
    fn report_property_called(
        &mut self,
        name: ast::Name<'s>,
        arguments: &[ast::Argument<'s>],
        callee: Span,
        span: Span,
    ) {
        let error = Diagnostic::new(Code::E0305, callee, format!("`{}` is a PROPERTY and cannot be called", name.text))
            .label("it is read and written like a variable");
        let error = error.help(format!("write `{}` without `()`", name.text));
        let brackets = Span { start: callee.end, ..span };
        self.report(if arguments.is_empty() { error.fix(brackets, "") } else { error });
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
                Diagnostic::new(Code::E0305, callee, format!("{} cannot be called", article(info.name)))
                    .label(format!("it is the operand of {}", crate::diagnostic::wording::all_of(&names)))
                    .help(format!("write `{}({}, …)`", names[0], self.decl.log.sources.text(callee))),
            );
            return None;
        }
        let mut parameters: Vec<_> = info
            .pins
            .iter()
            .filter(|it| matches!(it.direction, Direction::Input | Direction::Output))
            .map(|it| Parameter::of_pin(id, it, section(it.direction)))
            .collect();
        if let Some(kept) = info.facts.kept {
            let at = info.inputs().count();
            parameters.insert(at, Parameter::of_library(kept.pin, Section::InOut));
        }
        let dialect = self.decl.dialect(span);
        let moved = self.arguments_by_own_names(id, arguments);
        let arguments = moved.as_deref().unwrap_or(arguments);
        let given =
            self.bind(info.name, &parameters, arguments, |name| super::unresolved::unknown_pin(dialect, id, name))?;
        if self.decl.dialect(span).wants_all_positions() {
            self.require_all(info.name, &parameters, &given, arguments, |_, _| false, span)?;
        }
        let mut parts = Parts { before: self.block.len(), ..Parts::default() };
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
                    self.pin_part(&mut parts, id, expr, ty, number)
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
    fn pin_part(
        &mut self,
        parts: &mut Parts,
        id: BlockId,
        expr: &ast::Expr<'s>,
        ty: Type,
        parameter: usize,
    ) -> Option<()> {
        let overload = id.info().facts.overload.filter(|_| self.decl.dialect(expr.span).overloads_timers());
        let value = self.after_parts(&mut parts.written, |this| match this.operand(expr, Some(ty))? {
            Operand::Typed(value) if overload.is_some_and(|it| value.ty == Type::Elementary(it)) => {
                Some(this.convert(Conversion::Value, ty, value))
            }
            operand => this.coerce(operand, ty, expr.span),
        })?;
        parts.push(Held::Value(value), Role::Passed(parameter), expr.span);
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
        // What is given for a VAR_IN_OUT CONSTANT is the caller's instance; its inputs are not assigned.
        if !(arguments.is_empty() && self.is_constant_in_out(&found)) {
            self.may_call_method(&found, callee)?;
        }
        self.check_has_body(slot, callee)?;
        let signature = self.decl.signature(slot)?;
        let formals = &signature.formals;
        let arguments = self.accepted(&signature, arguments)?;
        let given = self.bind_block(slot, formals, &arguments, span)?;
        let is_this = found.place.root == Root::Instance && found.place.projections.is_empty();
        let dispatch = self.dispatch(&found.place, slot, callee, span);
        if let Some(dispatch) = &dispatch {
            self.check_in_outs(dispatch, slot, callee)?;
        }
        let mut parts = Parts { before: self.block.len(), ..Parts::default() };
        parts.push(Held::Place(found.place), Role::Instance, callee);
        self.start_inputs(&mut parts, slot, &given, callee)?;
        let mut references = vec![None; formals.len()];
        let is_right = self.block_parts(&mut parts, formals, &given, &mut references)?;
        let own = self.own_in_outs(formals, is_this);
        let is_whole = self.check_in_outs_given(slot, formals, &given, &own, callee);
        if !is_right || !is_whole {
            return None;
        }
        let call = |parts: &Parts| {
            let argument = |at: usize| match (references[at], &own[at]) {
                (Some(part), _) => Some(parts.argument(part)),
                (None, OwnInOut::Passed(place)) => Some(Argument::Reference(place.clone())),
                (None, OwnInOut::Kept | OwnInOut::None) => None,
            };
            let params = (0..formals.len()).filter(|at| is_in_out_param(&formals[*at]));
            let arguments: Vec<_> = params.map(argument).collect::<Option<_>>()?;
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

    fn check_has_body(&mut self, slot: usize, callee: Span) -> Option<()> {
        if self.decl.pous[slot].ast.kind != ast::PouKind::Class {
            return Some(());
        }
        let name = self.decl.pous[slot].ast.name.text;
        self.report(
            Diagnostic::new(Code::E0305, callee, format!("`{name}` is a CLASS, which has no body"))
                .label("call one of its METHODs instead"),
        );
        None
    }

    /// What a call of a body gives for each parameter.
    fn bind_block<'a>(
        &mut self,
        slot: usize,
        formals: &[Formal<'s>],
        arguments: &'a [ast::Argument<'s>],
        span: Span,
    ) -> Option<Vec<Given<'a, 's>>> {
        let owner = self.decl.pous[slot].ast.name.text;
        let parameters: Vec<_> = formals.iter().map(Parameter::of_formal).collect();
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
        self.note_positions(&parameters, arguments, span);
        if self.decl.dialect(span).wants_all_positions() {
            let is_optional = |this: &Self, at: usize| this.has_initial(&formals[at], slot);
            self.require_all(owner, &parameters, &given, arguments, is_optional, span)?;
        }
        Some(given)
    }

    /// The inputs that start anew at each call, and are not given (CODESYS, `initialize_on_call`).
    fn start_inputs(&mut self, parts: &mut Parts, slot: usize, given: &[Given<'_, 's>], callee: Span) -> Option<()> {
        let mut classes = std::iter::successors(Some(slot), |it| self.decl.base_of(*it));
        let is_it = |it: &&str| it.eq_ignore_ascii_case(ast::AT_CALLS);
        if !classes.any(|it| self.decl.pous[it].ast.attributes.iter().any(&is_it)) {
            return Some(());
        }
        let signature = self.decl.signature(slot)?;
        let declared = self.decl.pous[slot].ast.blocks.iter().flat_map(|it| &it.vars);
        let marked = declared.filter(|it| it.starts_at_calls).flat_map(|it| &it.names).map(|it| it.span);
        let marked: Vec<_> = marked.collect();
        for (formal, given) in signature.formals.iter().zip(given) {
            let Target::Field(field) = formal.target else { continue };
            let is_missing = matches!(given, Given::Nothing) && formal.section == Section::Input;
            if is_missing && marked.contains(&formal.name.span) {
                let (state, ty) = (signature.state?, formal.resolved.ty);
                if self.starts_with_address(slot, formal.name) {
                    self.refuse_address_at_calls(formal.name, callee);
                    return None;
                }
                let initial = self.decl.program.structure(state).fields[field.index()].initial.clone();
                let value = self.constant_value(ty, initial, callee);
                parts.push(Held::Value(value), Role::Stored(field, ty), callee);
            }
        }
        Some(())
    }

    fn starts_with_address(&self, slot: usize, input: ast::Name<'s>) -> bool {
        let mut declared = self.decl.pous[slot].ast.blocks.iter().flat_map(|it| &it.vars);
        declared.any(|it| it.started.is_some() && it.names.iter().any(|name| name.span == input.span))
    }

    /// Which address it starts with is known when the instance starts, and not at a call.
    fn refuse_address_at_calls(&mut self, input: ast::Name<'s>, callee: Span) {
        let message = format!("this call would set `{}` to its initial address again", input.text);
        self.report(
            Diagnostic::new(Code::E0902, callee, message)
                .label("the call does not pass it")
                .other(input.span, "its initial value is an address, and it has `initialize_on_call`")
                .help(format!("pass it: `{} := …`", input.text)),
        );
    }

    /// Evaluates what a call of a body gives, in the order in which it is written; whether all of it is right.
    /// `references` has the parts that are passed.
    fn block_parts(
        &mut self,
        parts: &mut Parts,
        formals: &[Formal<'s>],
        given: &[Given<'_, 's>],
        references: &mut [Option<usize>],
    ) -> Option<bool> {
        let mut is_right = true;
        for at in as_written(given) {
            self.late_target_before(parts, &given[at]);
            let formal = &formals[at];
            let ty = formal.resolved.ty;
            let made = match (formal.target, given[at]) {
                (Target::Field(field), Given::Output { target: Some(target), negated }) => {
                    self.target_part(parts, target, negated, Source::Field(field, ty))
                }
                (Target::Field(field), Given::Value(expr)) if formal.section == Section::InOut => {
                    self.polymorphic_part(parts, formal, Role::Stored(field, ty), expr)
                }
                (Target::Field(field), Given::Value(expr)) => {
                    self.is_of_class(formal, expr)?;
                    self.value_part(parts, expr, ty, Role::Stored(field, ty))
                }
                (Target::Param(_), Given::Value(expr)) => {
                    references[at] = Some(parts.written.len());
                    self.in_out_part(parts, formal, at, expr)
                }
                (_, Given::Nothing | Given::Output { .. }) => Some(()),
            };
            is_right &= made.is_some();
        }
        Some(is_right)
    }

    /// What an ACTION of the POU itself works with: the in-outs that this was given.
    fn own_in_outs(&self, formals: &[Formal<'s>], is_this: bool) -> Vec<OwnInOut> {
        let own = |formal: &Formal<'s>| match self.passed_on(formal.name) {
            _ if !is_this => OwnInOut::None,
            Some(place) => OwnInOut::Passed(place),
            None if is_in_out_param(formal) => OwnInOut::None,
            None => OwnInOut::Kept,
        };
        formals.iter().map(own).collect()
    }

    /// Reports the in-outs that a call does not give, and nothing else does; whether there are none.
    fn check_in_outs_given(
        &mut self,
        slot: usize,
        formals: &[Formal<'s>],
        given: &[Given<'_, 's>],
        own: &[OwnInOut],
        callee: Span,
    ) -> bool {
        let owner = self.decl.pous[slot].ast.name.text;
        let is_missing = |at: &usize| {
            let is_given = !matches!((&given[*at], &own[*at]), (Given::Nothing, OwnInOut::None));
            formals[*at].section == Section::InOut && !is_given
        };
        let missing: Vec<_> = (0..formals.len()).filter(is_missing).collect();
        missing.iter().for_each(|at| self.report_no_variable(&formals[*at], owner, callee));
        missing.is_empty()
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

/// Whether it is a VAR_IN_OUT that a call passes; others are kept in the instance, as references.
fn is_in_out_param(formal: &Formal<'_>) -> bool {
    formal.section == Section::InOut && matches!(formal.target, Target::Param(_))
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
