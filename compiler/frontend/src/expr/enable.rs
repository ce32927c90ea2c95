//! EN and ENO, which every call has: where EN is FALSE nothing of the call happens, and ENO is FALSE.

use super::argument::{Parts, Source};
use super::callee::Callee;
use super::checker::Checker;
use crate::types::signature::{Formal, Signature, Target};
use crate::{Span, ast};
use ast::ArgumentKind;
use staunch_ir::{
    Chars, Const, Expr, ExprKind, Location, ParamId, Place, Root, Section, Statement, StatementKind, Type, Value,
};

/// What a call gives for an EN and an ENO that its callee does not declare.
#[derive(Clone, Copy)]
pub(crate) struct Enable<'a, 's> {
    en: Option<&'a ast::Expr<'s>>,
    eno: Option<(&'a ast::Expr<'s>, bool)>,
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
        let owns = self.own_parameters(what, callee);
        let mut enable = Enable { en: None, eno: None };
        let mut rest = Vec::new();
        for argument in arguments {
            match &argument.kind {
                ArgumentKind::Input(_, value) if is_en(argument) && !owns.0 && enable.en.is_none() => {
                    enable.en = Some(value);
                }
                ArgumentKind::Output { target: Some(target), negated, .. }
                    if is_en(argument) && !owns.1 && enable.eno.is_none() =>
                {
                    enable.eno = Some((target, *negated));
                }
                ArgumentKind::Output { target: None, .. } if is_en(argument) && !owns.1 => {}
                ArgumentKind::Input(..) | ArgumentKind::Output { .. } | ArgumentKind::Positional(_) => {
                    rest.push(argument.clone());
                }
            }
        }
        Some((enable, rest))
    }

    /// Whether the callee has an EN and an ENO of its own.
    fn own_parameters(&mut self, what: &Callee<'s>, callee: &ast::Expr<'s>) -> (bool, bool) {
        let slot = match what {
            Callee::Function(slot) | Callee::Routine(slot) => Some(*slot),
            Callee::Instruction(_) | Callee::Standard(_) => None,
            Callee::Instance => match self.static_type(callee) {
                Some(Type::Block(id)) => return (id.info().pin("EN").is_some(), id.info().pin("ENO").is_some()),
                Some(Type::Struct(id)) => self.decl.slot_of_instance(id),
                _ => None,
            },
        };
        let signature = slot.and_then(|slot| self.decl.signature(slot));
        signature.map_or((false, false), |it| (own(&it, "EN").is_some(), own(&it, "ENO").is_some()))
    }

    /// A call with EN or ENO. EN, and what ENO is connected with, are evaluated first; where EN is
    /// FALSE, nothing else of the call is, and its value is the one that its result starts with.
    pub(crate) fn enabled_call(
        &mut self,
        enable: Enable<'_, 's>,
        initial: impl FnOnce(&mut Self, Type) -> Option<Expr>,
        span: Span,
        call: impl FnOnce(&mut Self) -> Option<Option<Expr>>,
    ) -> Option<Option<Expr>> {
        let at = self.at(span);
        let enabled = self.temporary("enabled", Type::BOOL);
        let mut parts = Parts::default();
        let en_first = match (enable.en, enable.eno) {
            (Some(en), Some((eno, _))) => en.span.start < eno.span.start,
            (_, None) | (None, _) => true,
        };
        let mut may_be_false = false;
        if en_first {
            may_be_false = self.keep_en(enable.en, &mut parts, &enabled, span)?;
        }
        if let Some((target, negated)) = enable.eno {
            self.target_part(&mut parts, target, negated, Source::Variable(enabled.clone()))?;
        }
        if !en_first {
            may_be_false = self.keep_en(enable.en, &mut parts, &enabled, span)?;
        }
        let mut made = None;
        let mut result = None;
        let outer = self.may_not_run;
        self.may_not_run |= may_be_false;
        let then = self.nested(|this| {
            made = call(this);
            if let Some(Some(value)) = made.take_if(|it| it.is_some()) {
                let place = this.temporary("result", value.ty);
                this.assign(place.clone(), value, span);
                result = Some(place);
            }
        });
        self.may_not_run = outer;
        if made.is_none() && result.is_none() {
            return None;
        }
        if let Some(place) = &result {
            let initial = initial(self, place.ty).filter(|it| it.ty == place.ty);
            let initial = initial.unwrap_or_else(|| self.zero(place.ty, at));
            self.assign(place.clone(), initial, span);
        }
        let condition = Expr::load(enabled, at);
        let call = |_: &Parts| {
            Some(StatementKind::If { condition: condition.clone(), then: then.clone(), otherwise: Vec::new() })
        };
        self.perform(parts, &call, span)?;
        Some(result.map(|place| Expr::load(place, at)))
    }

    /// Evaluates EN, where a call gives one, and says whether it may be FALSE.
    fn keep_en(&mut self, en: Option<&ast::Expr<'s>>, parts: &mut Parts, enabled: &Place, span: Span) -> Option<bool> {
        let at = self.at(span);
        let value = match en {
            Some(en) => self.after_parts(&mut parts.written, |this| this.value(en, Type::BOOL))?,
            None => Expr::bool(true, at),
        };
        let faults = self.can_fault(&value);
        parts.written.iter_mut().for_each(|it| self.hold(&mut it.held, &[], faults));
        let may_be_false = value.as_const() != Some(Value::Bool(true));
        self.assign(enabled.clone(), value, en.map_or(span, |it| it.span));
        Some(may_be_false)
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
    /// ENO says so unless the body says otherwise.
    pub(crate) fn own_enable(&mut self, signature: &Signature<'s>, span: Span) {
        if self.decl.dialect(span).declares_plain_enable() {
            return;
        }
        let at = self.at(span);
        let eno = own(signature, "ENO").filter(|it| it.section == Section::Output).map(place_of);
        let told = |value: bool| eno.clone().map(|eno| Statement::assign(eno, Expr::bool(value, at), at));
        if let Some(en) = own(signature, "EN").filter(|it| it.section == Section::Input) {
            let Some(place) = self.scope.get(en.name.text).map(|it| it.place.clone()) else { return };
            let mut then: Vec<_> = told(false).into_iter().collect();
            then.push(Statement::new(StatementKind::Return, at));
            let Some(condition) = self.not(Expr::load(place, at), span) else { return };
            self.push(StatementKind::If { condition, then, otherwise: Vec::new() }, span);
        }
        self.block.extend(told(true));
    }
}

/// A POU's own parameter of this name, if it is a BOOL.
fn own<'a, 's>(signature: &'a Signature<'s>, name: &str) -> Option<&'a Formal<'s>> {
    signature.formals.iter().find(|it| it.name.text.eq_ignore_ascii_case(name) && it.resolved.ty == Type::BOOL)
}

/// Where the POU itself finds an output.
fn place_of(formal: &Formal<'_>) -> Place {
    match formal.target {
        Target::Field(field) => Place::root(Root::Instance, Type::BOOL).field(field, Type::BOOL),
        Target::Param(at) => Place::root(Root::Param(ParamId::next(at)), Type::BOOL),
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
