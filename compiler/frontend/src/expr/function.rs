//! Calls of a user's own functions, and of methods.

use super::argument::{Parts, Role, Source, as_written};
use super::binding::{Given, Parameter};
use super::checker::Checker;
use super::dispatch::Dispatch;
use super::generic_call::{Called, Open};
use super::order::Held;
use crate::start::is_initial;
use crate::testing::fixture::Caller;
use crate::types::signature::{Formal, Signature, Target};
use crate::types::table::Resolved;
use crate::{Code, Diagnostic, Span, ast};
use staunch_ir::{
    Argument, Chars, Expr, ExprKind, Mode, ParamId, Place, Root, RoutineId, Section, StatementKind, Type,
};
use std::rc::Rc;

/// What is passed for one parameter.
enum Passed {
    /// What the call writes for it.
    Part(usize),
    /// The initial value of an input that is left out.
    Default(Expr),
    /// Storage for an output; the FUNCTION gives it its initial value.
    Output(Place),
}

impl Passed {
    fn argument(&self, parts: &Parts) -> Argument {
        match self {
            Self::Part(at) => parts.argument(*at),
            Self::Default(value) => Argument::Value(value.clone()),
            Self::Output(place) => Argument::Reference(place.clone()),
        }
    }
}

/// What a call gives, as far as it is evaluated.
#[derive(Default)]
struct Written {
    parts: Parts,
    /// What is given for parameters of a generic type.
    open: Vec<Open>,
    /// For each parameter.
    passed: Vec<Option<Passed>>,
}

impl<'s> Checker<'_, 's> {
    /// A call of the FUNCTION in a slot, or of the METHOD on an instance.
    pub(crate) fn user_function(
        &mut self,
        called: Called<'s>,
        instance: Option<(Place, Span)>,
        arguments: &[ast::Argument<'s>],
    ) -> Option<Option<Expr>> {
        let Called { slot, span, .. } = called;
        let signature = self.decl.signature(slot)?;
        let arguments = &self.accepted(&signature, arguments)?;
        let (given, enough) = self.bind_formals(&signature, called, arguments)?;
        let mut written = Written::default();
        let dispatch = match instance {
            Some((place, callee)) => {
                let place = self.receiver(place, callee)?;
                let dispatch = self.dispatched(&place, slot, callee, called.span)?;
                written.parts.push(Held::Place(place), Role::Instance, callee);
                Some(dispatch)
            }
            None => None,
        };
        let is_written = self.write_parts(&mut written, &signature, &given, called);
        let lacks_in_out =
            |at: usize| matches!(given[at], Given::Nothing) && signature.formals[at].section == Section::InOut;
        let complete = enough && is_written;
        let (slot, signature) = if self.decl.is_generic(slot) && complete && !(0..given.len()).any(lacks_in_out) {
            let slot = self.told_instance(&written.parts, &written.open, called)?;
            (slot, self.decl.signature(slot)?)
        } else {
            (slot, Rc::clone(&signature))
        };
        if !enough {
            return None;
        }
        self.write_left_out(&mut written, &signature, &given, slot, span);
        if !complete {
            return None;
        }
        let Written { mut parts, open, mut passed } = written;
        for (at, place) in self.close(&mut parts, open, &signature)? {
            passed[at] = Some(Passed::Output(place));
        }
        let owner = self.decl.pous[called.slot].ast.name.text;
        let result = signature.result.as_ref().map(|(_, resolved)| self.temporary(owner, resolved.ty));
        let call = |parts: &Parts| {
            let arguments: Vec<_> =
                passed.iter().map(|it| Some(it.as_ref()?.argument(parts))).collect::<Option<_>>()?;
            let call = |callee, instance| {
                let (arguments, result) = (Vec::clone(&arguments), result.clone());
                StatementKind::Call { callee, instance, arguments, result }
            };
            let direct = RoutineId::next(slot);
            Some(match &dispatch {
                Some(Some(dispatch)) => dispatch.statement(parts.instance()?, &|to, at| call(to, Some(at))),
                Some(None) => call(direct, parts.instance().cloned()),
                None => call(direct, None),
            })
        };
        self.perform(parts, &call, span)?;
        let at = self.at(span);
        Some(result.map(|place| Expr::load(place, at)))
    }

    /// What a call gives for each parameter, and whether that is enough.
    fn bind_formals<'a>(
        &mut self,
        signature: &Signature<'s>,
        called: Called<'s>,
        arguments: &'a [ast::Argument<'s>],
    ) -> Option<(Vec<Given<'a, 's>>, bool)> {
        let (owner, formals) = (self.decl.pous[called.slot].ast.name.text, &signature.formals);
        let parameters: Vec<_> = formals.iter().map(Parameter::of_formal).collect();
        let given = self.bind(owner, &parameters, arguments, |name| Self::unknown_formal(owner, formals, name))?;
        let is_optional = |this: &Self, at: usize| this.has_initial(&formals[at], called.slot);
        if self.decl.pous[called.slot].ast.kind == ast::PouKind::Method {
            self.note_named_order(&parameters, arguments);
        }
        let enough = self.require_all(owner, &parameters, &given, arguments, is_optional, called.span).is_some();
        Some((given, enough))
    }

    /// What a call of a METHOD on an instance depends on; the inner `None` is a direct call.
    fn dispatched(&mut self, place: &Place, slot: usize, callee: Span, span: Span) -> Option<Option<Dispatch>> {
        let dispatch = self.dispatch(place, slot, callee, span);
        if dispatch.as_ref().is_some_and(|it| it.calls(|slot| self.decl.is_generic(slot))) {
            let what = "a call of a METHOD with generic parameters, through a reference to several classes,";
            self.decl.not_supported(callee, what);
            return None;
        }
        Some(dispatch)
    }

    /// Evaluates what a call gives, in the order in which it is written; whether all of it is right.
    fn write_parts(
        &mut self,
        written: &mut Written,
        signature: &Signature<'s>,
        given: &[Given<'_, 's>],
        called: Called<'s>,
    ) -> bool {
        let formals = &signature.formals;
        let Written { parts, open, passed } = written;
        passed.resize_with(formals.len(), || None);
        let mut complete = true;
        for at in as_written(given) {
            self.late_target_before(parts, &given[at]);
            let (number, formal) = (parts.written.len(), &formals[at]);
            let made = match (given[at], formal.word) {
                (Given::Value(expr), None) => self.given_part(parts, signature, at, expr),
                (Given::Value(expr), Some(word)) => self.open_part(parts, open, formals, (at, word), expr, called),
                (Given::Output { target: Some(target), negated }, Some(word)) => {
                    self.open_target(parts, open, (at, word), target, negated)
                }
                (Given::Output { target: Some(target), negated }, None)
                    if self.decl.program.is_open(formal.resolved.ty) =>
                {
                    let storage = self.open_output_part(parts, formal, target, negated);
                    passed[at] = storage.map(Passed::Output);
                    passed[at].is_some().then_some(())
                }
                (Given::Output { target: Some(target), negated }, None) => {
                    let place = self.temporary(formal.name.text, formal.resolved.ty);
                    passed[at] = Some(Passed::Output(place.clone()));
                    self.target_part(parts, target, negated, Source::Variable(place))
                }
                (Given::Nothing | Given::Output { target: None, .. }, _) => None,
            };
            complete &= made.is_some();
            passed[at].get_or_insert(Passed::Part(number));
        }
        complete
    }

    /// Passes what a call does not name. What may not be left out is not passed, so that the call is not made.
    fn write_left_out(
        &mut self,
        written: &mut Written,
        signature: &Signature<'s>,
        given: &[Given<'_, 's>],
        slot: usize,
        span: Span,
    ) {
        for (at, given) in given.iter().enumerate() {
            if let Given::Nothing | Given::Output { target: None, .. } = given {
                written.passed[at] = self.left_out(signature, at, slot, span);
            }
        }
    }

    /// The statements that give a FUNCTION's outputs their initial values: it keeps none from its last call.
    pub(crate) fn initial_outputs(&mut self, signature: &Signature<'s>) {
        let is_output = |it: &&Formal<'s>| it.section == Section::Output && !self.decl.program.is_open(it.resolved.ty);
        for formal in signature.formals.iter().filter(is_output).collect::<Vec<_>>() {
            if let Target::Param(at) = formal.target {
                let target = Place::root(Root::Param(ParamId::next(at)), formal.resolved.ty);
                let value = self.initial_value(&formal.resolved, formal.name.span);
                self.assign(target, value, formal.name.span);
            }
        }
    }

    /// Evaluates the next part, what is given for an input or a VAR_IN_OUT.
    pub(crate) fn given_part(
        &mut self,
        parts: &mut Parts,
        signature: &Signature<'s>,
        at: usize,
        expr: &ast::Expr<'s>,
    ) -> Option<()> {
        let formal = &signature.formals[at];
        self.is_of_class(formal, expr)?;
        match signature.params[at].mode {
            Mode::Value(_) if formal.section == Section::InOut => {
                self.polymorphic_part(parts, formal, Role::Passed(at), expr)
            }
            Mode::Value(_) => self.value_part(parts, expr, formal.resolved.ty, Role::Passed(at)),
            Mode::Reference if formal.section == Section::Input => self.open_input_part(parts, formal, at, expr),
            Mode::Reference => self.in_out_part(parts, formal, at, expr),
        }
    }

    /// What is passed for a parameter that a call does not name.
    fn left_out(&mut self, signature: &Signature<'s>, at: usize, slot: usize, span: Span) -> Option<Passed> {
        let formal = &signature.formals[at];
        match (signature.params[at].mode, formal.section) {
            (Mode::Value(_), Section::InOut) => {
                self.report_no_variable(formal, self.decl.pous[slot].ast.name.text, span);
                None
            }
            (Mode::Value(_), Section::Input) if self.decl.tests.callers.contains_key(&formal.name.span) => {
                Some(Passed::Default(self.place_of_call(formal, span)))
            }
            (Mode::Value(_), _) => {
                self.input_left_out(formal, slot, span)?;
                Some(Passed::Default(self.initial_value(&formal.resolved, span)))
            }
            (Mode::Reference, Section::Output) if !self.decl.program.is_open(formal.resolved.ty) => {
                Some(Passed::Output(self.temporary(formal.name.text, formal.resolved.ty)))
            }
            (Mode::Reference, _) => {
                self.report_no_variable(formal, self.decl.pous[slot].ast.name.text, span);
                None
            }
        }
    }

    /// For an input that AxUnit's pragma gives the line or the file of the call.
    fn place_of_call(&mut self, formal: &Formal<'s>, span: Span) -> Expr {
        let (at, ty) = (self.at(span), formal.resolved.ty);
        let source = self.decl.log.sources.get(span.file);
        let line = source.line_column(span.start).0;
        match (self.decl.tests.callers.get(&formal.name.span), ty) {
            (Some(Caller::Path), Type::String(it)) => {
                let chars = if it.wide {
                    Chars::Wide(source.path.encode_utf16().take(usize::from(it.capacity)).collect())
                } else {
                    Chars::Narrow(source.path.bytes().take(usize::from(it.capacity)).collect())
                };
                Expr::new(ty, ExprKind::Text(chars), at)
            }
            (Some(Caller::Line), Type::Elementary(it)) => match it.repr().integer(i128::from(line)) {
                Some(value) => Expr::constant(it, value, at),
                None => self.initial_value(&formal.resolved, span),
            },
            (Some(Caller::Line | Caller::Path) | None, _) => self.initial_value(&formal.resolved, span),
        }
    }

    /// Reports an input without an initial value of its own that a call leaves out. CODESYS refuses it.
    fn input_left_out(&mut self, formal: &Formal<'s>, slot: usize, span: Span) -> Option<()> {
        if self.has_initial(formal, slot) {
            return Some(());
        }
        let owner = self.decl.pous[slot].ast.name;
        let (name, refused) = (formal.name.text, self.decl.dialect(span).wants_all_inputs());
        let ty = formal.word.map_or_else(|| self.type_name(formal.resolved.ty), |it| it.name().to_owned());
        let code = if refused { Code::E0303 } else { Code::W0304 };
        if is_initial(owner) {
            let message = format!("no argument is given for `{name}` of FB_init");
            self.report(
                Diagnostic::new(Code::E0303, span, message)
                    .label("FB_init runs at the start")
                    .in_this_dialect()
                    .other(formal.name.span, "declared here, without an initial value")
                    .help(format!("write it after the type of the instance: `: Type({name} := …)`")),
            );
            return None;
        }
        let message = format!("this call of `{}` leaves out the input `{name}`", owner.text);
        self.report(
            Diagnostic::new(code, span, message)
                .label(if refused {
                    "a FUNCTION keeps no value from its last call"
                } else {
                    "it is 0, FALSE or empty then"
                })
                .other(formal.name.span, "declared here, without an initial value")
                .help(format!("write `{name} := …` in the call, or declare a default: `{name} : {ty} := …;`")),
        );
        (!refused).then_some(())
    }

    /// Whether a formal's declaration, or its type's, gives it a value.
    pub(crate) fn has_initial(&self, formal: &Formal<'s>, slot: usize) -> bool {
        let pou = self.decl.pous[slot].ast;
        let declared = pou.blocks.iter().flat_map(|it| &it.vars);
        let given = declared
            .filter(|it| it.names.iter().any(|name| name.span == formal.name.span))
            .any(|it| it.initial.is_some());
        given
            || self.decl.tests.callers.contains_key(&formal.name.span)
            || !matches!(formal.resolved.initial, staunch_ir::Const::Zero)
    }

    /// What a FUNCTION's result starts with.
    pub(crate) fn initial_result(&mut self, slot: usize, ty: Type, span: Span) -> Option<Expr> {
        if self.decl.is_generic(slot) {
            let initial = self.decl.start_of(ty);
            return Some(self.initial_value(&Resolved { ty, initial }, span));
        }
        let signature = self.decl.signature(slot)?;
        let (_, resolved) = signature.result.as_ref()?;
        Some(self.initial_value(resolved, span))
    }

    /// What a variable starts with.
    pub(crate) fn initial_value(&mut self, resolved: &Resolved, span: Span) -> Expr {
        use staunch_ir::Const;
        let at = self.at(span);
        let ty = resolved.ty;
        let kind = match (&resolved.initial, self.decl.program.repr(ty), ty) {
            (Const::Scalar(value), _, _) => ExprKind::Const(*value),
            (Const::Zero, Some(repr), _) => ExprKind::Const(repr.zero()),
            (Const::Text(bytes), _, _) => ExprKind::Text(bytes.clone()),
            (Const::Zero, None, Type::String(it)) => ExprKind::Text(Chars::empty(it)),
            (other, _, _) => ExprKind::Aggregate(other.clone()),
        };
        Expr::new(ty, kind, at)
    }
}
