//! EN and ENO, which every call has: where EN is FALSE nothing of the call happens, and ENO is FALSE.

use super::argument::{Parts, Role, Source};
use super::binding::Given;
use super::callee::Callee;
use super::checker::Checker;
use super::late_target::{Finding, LateTarget};
use super::order::Held;
use super::place::Found;
use crate::dialect::rules::{Part, Use};
use crate::index::recorder::Named;
use crate::types::signature::{Formal, Signature, Target};
use crate::{Code, Diagnostic, Span, ast};
use ast::ArgumentKind;
use staunch_ir::{
    Block, Chars, Const, Expr, ExprKind, Location, ParamId, Place, Root, Section, Statement, StatementKind, Type, Value,
};

/// What a call gives for an EN and an ENO that its callee does not declare.
pub(crate) struct Enable<'a, 's> {
    en: Option<&'a ast::Expr<'s>>,
    eno: Option<Eno<'a, 's>>,
    /// An ENO that the callee declares, which sets it where it is called: where it is not, nothing else does.
    own_eno: Option<Eno<'a, 's>>,
    /// The call's other arguments.
    others: Vec<Span>,
}

/// What an ENO is connected with, and whether by NOT.
#[derive(Clone, Copy)]
struct Eno<'a, 's> {
    target: &'a ast::Expr<'s>,
    negated: bool,
}

/// The parameters of these names that a callee declares, of whatever type.
#[derive(Clone, Copy, Default)]
struct Owns {
    en: bool,
    eno: bool,
    /// Its ENO says whether the body has run.
    tells: bool,
}

impl<'s> Checker<'_, 's> {
    /// The EN and ENO of a call, and its other arguments; `None` where it has neither, or where they
    /// are the callee's own.
    pub(crate) fn enable<'a>(
        &mut self,
        what: &Callee<'s>,
        callee: &ast::Expr<'s>,
        arguments: &'a [ast::Argument<'s>],
    ) -> Option<(Enable<'a, 's>, Vec<ast::Argument<'s>>)> {
        if !arguments.iter().any(is_en) {
            return None;
        }
        self.note_use(Use::Part(Part::Enable), callee.span);
        let owns = self.own_parameters(what, callee);
        let mut enable = Enable { en: None, eno: None, own_eno: None, others: Vec::new() };
        let tells = !owns.en && owns.tells && !self.decl.dialect(callee.span).declares_plain_enable();
        let mut rest = Vec::new();
        for argument in arguments {
            if let (true, ArgumentKind::Input(name, _) | ArgumentKind::Output { name, .. }) =
                (is_en(argument), &argument.kind)
            {
                self.decl.log.note(name.span, || Named::Parameter);
            }
            match &argument.kind {
                ArgumentKind::Input(_, value) if is_en(argument) && !owns.en && enable.en.is_none() => {
                    enable.en = Some(value);
                }
                ArgumentKind::Output { target: Some(target), negated, .. }
                    if is_en(argument) && !owns.eno && enable.eno.is_none() =>
                {
                    enable.eno = Some(Eno { target, negated: *negated });
                }
                ArgumentKind::Output { target: None, .. } if is_en(argument) && !owns.eno => {}
                ArgumentKind::Input(..) | ArgumentKind::Output { .. } | ArgumentKind::Positional(_) => {
                    if let ArgumentKind::Output { target: Some(target), negated, .. } = &argument.kind
                        && tells
                        && is_en(argument)
                    {
                        enable.own_eno = Some(Eno { target, negated: *negated });
                    }
                    enable.others.extend(value_of(argument).map(|it| it.span));
                    rest.push(argument.clone());
                }
            }
        }
        Some((enable, rest))
    }

    fn own_parameters(&mut self, what: &Callee<'s>, callee: &ast::Expr<'s>) -> Owns {
        let slot = match what {
            Callee::Function(slot) | Callee::Routine(slot) => Some(*slot),
            Callee::Instruction(_) | Callee::Standard(_) => None,
            Callee::Instance => match self.static_type(callee) {
                Some(Type::Block(id)) => {
                    let [en, eno] = ["EN", "ENO"].map(|name| id.info().pin(name).is_some());
                    return Owns { en, eno, tells: eno };
                }
                Some(Type::Struct(id)) => self.decl.slot_of_instance(id),
                _ => None,
            },
        };
        let signature = slot.and_then(|slot| self.decl.signature(slot));
        signature.map_or(Owns::default(), |it| {
            let [en, eno] = ["EN", "ENO"].map(|name| formal(&it, name).is_some());
            Owns { en, eno, tells: own(&it, "ENO").is_some() }
        })
    }

    /// A call with EN or ENO. EN is evaluated first, since all else depends on it; where it is FALSE, nothing else of the
    /// call is, but where ENO leads, and the call's value is the one that its result starts with.
    pub(crate) fn enabled_call(
        &mut self,
        enable: Enable<'_, 's>,
        initial: impl FnOnce(&mut Self, Type) -> Option<Expr>,
        span: Span,
        call: impl FnOnce(&mut Self) -> Option<Option<Expr>>,
    ) -> Option<Option<Expr>> {
        let at = self.at(span);
        let enabled = self.temporary("enabled", Type::BOOL);
        let may_be_false = self.keep_en(enable.en, &enabled, span)?;
        let (late, fixed) = match enable.eno {
            Some(eno) if !self.is_fixed(eno.target) => (Some(eno), None),
            eno => (None, eno),
        };
        let mut parts = Parts::default();
        if let Some(eno) = fixed {
            self.target_part(&mut parts, eno.target, eno.negated, Source::Variable(enabled.clone()))?;
        }
        let around = std::mem::replace(
            &mut self.late,
            late.map(|it| LateTarget::new(it.target.clone(), it.negated, span, enable.others)),
        );
        let outer = self.may_not_run;
        self.may_not_run |= may_be_false;
        let mut result = None;
        let then = self.nested(|this| result = this.enabled_part(&enabled, span, call));
        self.may_not_run = outer;
        self.late = around;
        let result = result?;
        let otherwise = match late.or(enable.own_eno).filter(|_| may_be_false) {
            Some(eno) => self.told_alone(eno, &enabled)?,
            None => Block::new(),
        };
        if let Some(place) = &result {
            let initial = initial(self, place.ty).filter(|it| it.ty == place.ty);
            let initial = initial.unwrap_or_else(|| self.zero(place.ty, at));
            self.assign(place.clone(), initial, span);
        }
        let condition = Expr::load(enabled, at);
        let call = |_: &Parts| {
            let (condition, then, otherwise) = (condition.clone(), then.clone(), otherwise.clone());
            Some(StatementKind::If { condition, then, otherwise })
        };
        self.perform(parts, &call, span)?;
        Some(result.map(|place| Expr::load(place, at)))
    }

    /// What happens where EN is TRUE; the inner place has the call's value.
    fn enabled_part(
        &mut self,
        enabled: &Place,
        span: Span,
        call: impl FnOnce(&mut Self) -> Option<Option<Expr>>,
    ) -> Option<Option<Place>> {
        let result = call(self)?.map(|value| {
            let place = self.temporary("result", value.ty);
            self.assign(place.clone(), value, span);
            place
        });
        // What evaluates no argument finds it here.
        self.late_target_if(|_| true)?;
        if let Some(LateTarget { finding: Finding::Found(place, view), target, negated, .. }) = self.late.take() {
            let mut parts = Parts::default();
            let role = Role::Target(Source::Variable(enabled.clone()), negated, view);
            parts.push(Held::Place(place), role, target.span);
            self.connect(&parts, 0)?;
        }
        Some(result)
    }

    /// Where EN is FALSE, ENO says so.
    fn told_alone(&mut self, eno: Eno<'_, 's>, enabled: &Place) -> Option<Block> {
        let mut made = None;
        let block = self.nested(|this| {
            let mut parts = Parts::default();
            let found = this.target_part(&mut parts, eno.target, eno.negated, Source::Variable(enabled.clone()));
            made = found.and_then(|()| this.connect(&parts, 0));
        });
        made.map(|()| block)
    }

    /// Evaluates EN, where a call gives one, and says whether it may be FALSE.
    fn keep_en(&mut self, en: Option<&ast::Expr<'s>>, enabled: &Place, span: Span) -> Option<bool> {
        let at = self.at(span);
        let value = match en {
            Some(en) => self.value(en, Type::BOOL)?,
            None => Expr::bool(true, at),
        };
        let may_be_false = value.as_const() != Some(Value::Bool(true));
        self.assign(enabled.clone(), value, en.map_or(span, |it| it.span));
        Some(may_be_false)
    }

    /// Whether it does not matter when a target is found: nothing is evaluated for it.
    fn is_fixed(&mut self, target: &ast::Expr<'s>) -> bool {
        let found = self.tried(target.span, |this| {
            let mut found = None;
            let hoisted = this.nested(|this| found = this.place_or_view(target));
            let place = found?.place;
            Some(hoisted.is_empty() && !place.is_followed() && place.indices().all(|it| it.as_const().is_some()))
        });
        // What is wrong with it is said where it is found, whenever that is.
        found.flatten().unwrap_or(true)
    }

    /// Finds where the ENO of a call leads, if that is written before this argument of it.
    pub(super) fn late_target_before(&mut self, parts: &mut Parts, given: &Given<'_, 's>) {
        if let Given::Value(expr) | Given::Output { target: Some(expr), .. } = given {
            self.after_parts(&mut parts.written, |this| this.late_target_if(|it| it.is_before(expr.span)));
        }
    }

    /// Finds where the ENO of a call leads, if that is written after all arguments.
    pub(super) fn late_target_of(&mut self, parts: &mut Parts, call: Span) -> Option<()> {
        self.after_parts(&mut parts.written, |this| this.late_target_if(|it| it.call == call))
    }

    /// Finds where the innermost ENO leads, once; `None` where that is nowhere, which has been reported.
    pub(super) fn late_target_if(&mut self, is_it: impl Fn(&LateTarget<'s>) -> bool) -> Option<()> {
        let Some(mut late) = self.late.take_if(|it| is_it(it)) else { return Some(()) };
        if matches!(late.finding, Finding::Open) {
            let found = self.place_or_view(&late.target).filter(|it| self.writable(it, late.target.span));
            late.finding = found.map_or(Finding::Refused, |found| self.settled(found, late.target.span));
        }
        let is_refused = matches!(late.finding, Finding::Refused);
        self.late = Some(late);
        (!is_refused).then_some(())
    }

    fn settled(&mut self, mut found: Found<'s>, span: Span) -> Finding {
        self.note_assigned(&found.place, span);
        self.fix(&mut found.place);
        Finding::Found(found.place, found.view)
    }

    /// The value that a result starts with.
    fn zero(&self, ty: Type, at: Location) -> Expr {
        let kind = match (self.decl.program.repr(ty), ty) {
            (Some(repr), _) => ExprKind::Const(repr.zero()),
            (None, Type::String(it)) => ExprKind::Text(Chars::empty(it)),
            (None, _) => ExprKind::Aggregate(Const::Zero),
        };
        Expr::new(ty, kind, at)
    }

    /// An EN and an ENO that a POU declares as the standard does: the body runs while EN is TRUE, and
    /// ENO says so unless the body says otherwise. An EN alone is an ordinary input of a PROGRAM.
    pub(crate) fn own_enable(
        &mut self,
        signature: &Signature<'s>,
        (kind, span): (ast::PouKind, Span),
        statements: &[ast::Statement<'s>],
    ) {
        let dialect = self.decl.dialect(span);
        let has_eno = own(signature, "ENO").is_some_and(|it| it.section == Section::Output);
        let is_plain = !has_eno && (kind == ast::PouKind::Program || !dialect.runs_while_enabled());
        if is_plain || dialect.declares_plain_enable() {
            return;
        }
        let at = self.at(span);
        let eno = own(signature, "ENO").filter(|it| it.section == Section::Output).map(place_of);
        let told = |value: bool| eno.clone().map(|eno| Statement::assign(eno, Expr::bool(value, at), at));
        if let Some(en) = own(signature, "EN").filter(|it| it.section == Section::Input) {
            let Some(place) = self.scope.get(en.name.text).map(|it| it.place.clone()) else { return };
            let mut then: Vec<_> = told(false).into_iter().collect();
            then.push(Statement::new(StatementKind::Return, at));
            self.report_read_enable(statements);
            let Some(condition) = self.not(Expr::load(place, at), span) else { return };
            self.push(StatementKind::If { condition, then, otherwise: Vec::new() }, span);
        }
        self.block.extend(told(true));
    }

    /// Reports a body that reads its own EN, which is TRUE wherever the body runs.
    fn report_read_enable(&mut self, statements: &[ast::Statement<'s>]) {
        let mut first = None;
        ast::each_expr(statements, &mut |it| match &it.kind {
            ast::ExprKind::Name(name) if name.text.eq_ignore_ascii_case("EN") => {
                first.get_or_insert(*name);
            }
            _ => {}
        });
        let Some(name) = first else { return };
        let message = format!("`{}` is always TRUE here: the body runs only while it is TRUE", name.text);
        self.report(
            Diagnostic::new(Code::W0526, name.span, message)
                .label("a call with FALSE skips the whole body")
                .help("give the input another name if the body is to run in each call"),
        );
    }
}

fn formal<'a, 's>(signature: &'a Signature<'s>, name: &str) -> Option<&'a Formal<'s>> {
    signature.formals.iter().find(|it| it.name.text.eq_ignore_ascii_case(name))
}

/// A POU's own parameter with this name, if it is a BOOL: one of another type is a parameter like any other.
fn own<'a, 's>(signature: &'a Signature<'s>, name: &str) -> Option<&'a Formal<'s>> {
    formal(signature, name).filter(|it| it.resolved.ty == Type::BOOL)
}

/// Where the POU itself finds an output.
fn place_of(formal: &Formal<'_>) -> Place {
    match formal.target {
        Target::Field(field) => Place::root(Root::Instance, Type::BOOL).field(field, Type::BOOL),
        Target::Param(at) => Place::root(Root::Param(ParamId::next(at)), Type::BOOL),
    }
}

/// What is evaluated for an argument.
fn value_of<'a, 's>(argument: &'a ast::Argument<'s>) -> Option<&'a ast::Expr<'s>> {
    match &argument.kind {
        ArgumentKind::Positional(value) | ArgumentKind::Input(_, value) => Some(value),
        ArgumentKind::Output { target, .. } => target.as_ref(),
    }
}

/// Whether a call names EN or ENO.
pub(crate) fn is_en(argument: &ast::Argument<'_>) -> bool {
    match &argument.kind {
        ArgumentKind::Input(name, _) => name.text.eq_ignore_ascii_case("EN"),
        ArgumentKind::Output { name, .. } => name.text.eq_ignore_ascii_case("ENO"),
        ArgumentKind::Positional(_) => false,
    }
}
