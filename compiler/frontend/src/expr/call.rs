//! Calls: what is called, and which argument goes to which parameter.

use super::callee::Callee;
use super::checker::Checker;
use super::enable::Enable;
use super::generic_call::Called;
use super::logix_operands;
use super::operand::Operand;
use crate::diagnostic::wording::all_of;
use crate::dialect::{Dialect, missing};
use crate::index::recorder::Named;
use crate::names::functions;
use crate::spelling::nearest;
use crate::testing::suite::LIBRARY;
use crate::types::signature::Formal;
use crate::{Code, Diagnostic, Span, ast};
use ast::{ArgumentKind, ExprKind as Ast};
use staunch_ir::Type;

impl<'s> Checker<'_, 's> {
    pub(crate) fn call_value(
        &mut self,
        expr: &ast::Expr<'s>,
        callee: &ast::Expr<'s>,
        arguments: &[ast::Argument<'s>],
        expected: Option<Type>,
    ) -> Option<Operand> {
        let own = self.own_of_suite(callee);
        let callee = own.as_ref().unwrap_or(callee);
        if let Some(value) = self.known_value(callee, arguments, expr.span) {
            return value;
        }
        if self.logix_statement(callee, arguments, expr.span) {
            self.report_no_value(callee, expr.span);
            return None;
        }
        let what = self.checked_callee(callee, arguments, expected)?;
        if let Some((enable, rest)) = self.enable(&what, callee, arguments) {
            let value = self.call_if_enabled(what, enable, callee, &rest, expected, expr.span)?;
            if value.is_none() {
                self.report_no_value(callee, expr.span);
            }
            return value.map(Operand::Typed);
        }
        match what {
            Callee::Standard(name) => self.standard_function(name, arguments, expected, expr.span),
            other => {
                if self.signature.is_none() {
                    self.report(self.not_constant_here(expr.span));
                    return None;
                }
                let value = self.call(other, callee, arguments, expected, expr.span)?;
                if value.is_none() {
                    self.report_no_value(callee, expr.span);
                }
                value.map(Operand::Typed)
            }
        }
    }

    /// What a call of a name gives that is known here; the inner `None` says that it was reported.
    fn known_value(
        &mut self,
        callee: &ast::Expr<'s>,
        arguments: &[ast::Argument<'s>],
        span: Span,
    ) -> Option<Option<Operand>> {
        if self.calls_own_routine(callee) {
            return None;
        }
        let value = self
            .value_of_name(callee, arguments, span)
            .or_else(|| self.memory_function(callee, arguments, span))
            .or_else(|| self.query(callee, arguments, span))
            .or_else(|| self.new_object(callee, arguments, span));
        self.note_known(callee, value.is_some());
        value
    }

    /// Notes a name that the compiler knows as that of a function.
    fn note_known(&self, callee: &ast::Expr<'s>, is_known: bool) {
        if let (true, Ast::Name(name)) = (is_known, &callee.kind) {
            self.decl.log.note(name.span, || Named::Function);
        }
    }

    /// Whether a statement is a call of a name that is known here, and was checked.
    fn known_statement(&mut self, callee: &ast::Expr<'s>, arguments: &[ast::Argument<'s>], span: Span) -> bool {
        if self.calls_own_routine(callee) {
            return false;
        }
        if self.memory_function(callee, arguments, span).is_some()
            || self.query(callee, arguments, span).is_some()
            || self.pool_statement(callee, arguments, span).is_some()
            || self.logix_statement(callee, arguments, span)
        {
            self.note_known(callee, true);
            return true;
        }
        let Ast::Name(name) = &callee.kind else { return false };
        let value = self.value_of_name(callee, arguments, span);
        if matches!(value, Some(Some(_))) {
            self.report_unused(*name, span);
        }
        self.note_known(callee, value.is_some());
        value.is_some()
    }

    /// What is written as a call, and looks at what its argument names rather than at a value; the inner `None` says that
    /// it was reported.
    fn value_of_name(
        &mut self,
        callee: &ast::Expr<'s>,
        arguments: &[ast::Argument<'s>],
        span: Span,
    ) -> Option<Option<Operand>> {
        self.reference_function(callee, arguments, span)
            .or_else(|| self.pou_text(callee, arguments, span))
            .or_else(|| self.bound_function(callee, arguments, span))
    }

    fn report_unused(&mut self, name: ast::Name<'s>, span: Span) {
        let error = Diagnostic::new(Code::E0508, span, format!("the result of `{}` is not used", name.text))
            .label("this statement has no effect");
        let is_logix = self.decl.dialect(span) == Dialect::Logix;
        self.report(match logix_operands::computed_in_ladder(name.text).filter(|_| is_logix) {
            Some(sign) => error.help(format!(
                "in Structured Text, {} is written `destination := a {sign} b;`",
                name.text.to_ascii_uppercase()
            )),
            None => error.help(format!("assign it: `result := {}(…);`", name.text)),
        });
    }

    pub(crate) fn call_statement(
        &mut self,
        expr: &ast::Expr<'s>,
        callee: &ast::Expr<'s>,
        arguments: &[ast::Argument<'s>],
    ) {
        let own = self.own_of_suite(callee).or_else(|| self.called_as_instruction(callee));
        let callee = own.as_ref().unwrap_or(callee);
        if self.known_statement(callee, arguments, expr.span) {
            return;
        }
        let what = self.checked_callee(callee, arguments, None);
        if let Some(what) = &what
            && !matches!(what, Callee::Standard(_))
            && let Some((enable, rest)) = self.enable(what, callee, arguments)
        {
            self.call_if_enabled(*what, enable, callee, &rest, None, expr.span);
            return;
        }
        match what {
            Some(Callee::Standard(name)) => {
                let value = self.standard_function(name, arguments, None, expr.span);
                if value.is_none() || functions::is_statement(name.text) {
                    return;
                }
                self.report_unused(name, expr.span);
            }
            Some(other) => {
                self.call(other, callee, arguments, None, expr.span);
            }
            None => {}
        }
    }

    /// `TcUnit.TEST('…')`: a METHOD of the suite here, and a FUNCTION of the library there.
    fn own_of_suite(&self, callee: &ast::Expr<'s>) -> Option<ast::Expr<'s>> {
        let Ast::Member(owner, name) = &callee.kind else { return None };
        let is_library = matches!(&owner.kind, Ast::Name(it) if it.text.eq_ignore_ascii_case(LIBRARY));
        let is_own = is_library && self.is_suite() && self.own_routine(*name).is_some();
        is_own.then_some(ast::Expr { kind: Ast::Name(*name), span: callee.span })
    }

    /// `valve.delay.TON(…)` of a TON: SCL names the instruction after its data.
    fn called_as_instruction(&self, callee: &ast::Expr<'s>) -> Option<ast::Expr<'s>> {
        let Ast::Member(instance, name) = &callee.kind else { return None };
        let Some(Type::Block(id)) =
            self.static_type(instance).filter(|_| self.decl.dialect(name.span).names_instructions())
        else {
            return None;
        };
        let info = id.info();
        let is_counter = |of: &str| info.name.strip_prefix(of).is_some_and(|it| it.starts_with('_'));
        let is_it = info.is_named(name.text) || is_counter(&name.text.to_ascii_uppercase());
        (is_it && info.pin(name.text).is_none()).then(|| (**instance).clone())
    }

    /// A call with EN or ENO.
    fn call_if_enabled(
        &mut self,
        what: Callee<'s>,
        enable: Enable<'_, 's>,
        callee: &ast::Expr<'s>,
        arguments: &[ast::Argument<'s>],
        expected: Option<Type>,
        span: Span,
    ) -> Option<Option<staunch_ir::Expr>> {
        if self.signature.is_none() {
            self.report(self.not_constant_here(span));
            return None;
        }
        let initial = |this: &mut Self, ty| match what {
            Callee::Function(slot) | Callee::Routine(slot) => this.initial_result(slot, ty, span),
            Callee::Standard(_) | Callee::Instruction(_) | Callee::Instance => None,
        };
        self.enabled_call(enable, initial, span, |this| match what {
            Callee::Standard(name) => {
                let value = this.standard_function(name, arguments, expected, span)?;
                this.materialise(value.cut(), expected, span).map(Some)
            }
            Callee::Function(_) | Callee::Instruction(_) | Callee::Instance | Callee::Routine(_) => {
                this.call(what, callee, arguments, expected, span)
            }
        })
    }

    fn call(
        &mut self,
        what: Callee<'s>,
        callee: &ast::Expr<'s>,
        arguments: &[ast::Argument<'s>],
        expected: Option<Type>,
        span: Span,
    ) -> Option<Option<staunch_ir::Expr>> {
        match what {
            Callee::Function(slot) => {
                let name = ast::Name { text: self.decl.pous[slot].ast.name.text, span: callee.span };
                self.user_function(Called { slot, name, expected, span }, None, arguments)
            }
            Callee::Routine(slot) => self.routine_call(slot, callee, arguments, span),
            Callee::Instruction(name) => self.instruction(name, arguments, span).map(Some),
            Callee::Instance => self.instance_call(callee, arguments, span).map(|()| None),
            Callee::Standard(_) => None,
        }
    }

    fn report_no_value(&mut self, callee: &ast::Expr<'s>, span: Span) {
        if let Ast::Name(name) = &callee.kind
            && self.lacks_result_type(*name)
        {
            return;
        }
        let text = self.decl.log.sources.text(callee.span).to_owned();
        self.report(
            Diagnostic::new(Code::E0311, span, format!("a call of `{text}` has no value"))
                .label("this cannot be part of an expression")
                .help("call it in a statement of its own, then read its outputs"),
        );
    }

    /// What is called. Where that is not known, the arguments may hold mistakes of their own.
    fn checked_callee(
        &mut self,
        callee: &ast::Expr<'s>,
        arguments: &[ast::Argument<'s>],
        expected: Option<Type>,
    ) -> Option<Callee<'s>> {
        if self.has_logix_operands(callee, arguments) {
            return None;
        }
        let found = match self.callee(callee, arguments) {
            Some(Callee::Function(slot)) => {
                self.meant_function(slot, callee, arguments, expected).map(Callee::Function)
            }
            Some(Callee::Routine(slot)) => self.meant_routine(slot, callee, arguments, expected).map(Callee::Routine),
            other => other,
        };
        if found.is_none() {
            let reported = self.decl.log.diagnostics.len();
            self.check_arguments(arguments);
            if self.is_missing_operator(callee) {
                // What is refused by its name says nothing of what it is given.
                self.decl.log.diagnostics.truncate(reported);
            }
        }
        found
    }

    fn is_missing_operator(&self, callee: &ast::Expr<'s>) -> bool {
        let Ast::Name(name) = &callee.kind else { return false };
        let calls_a_routine = self.decl.dialect(name.span) == Dialect::Logix && name.text.eq_ignore_ascii_case("JSR");
        calls_a_routine || missing::is_operator(self.decl.dialect(name.span), name.text)
    }

    /// The FUNCTION that a call means. SIMATIC's SCALE_X has the type of its MIN and MAX, and that is its place's where these
    /// are numbers without a type; where the place has none, whether the result is rounded would go by chance.
    fn meant_function(
        &mut self,
        slot: usize,
        callee: &ast::Expr<'s>,
        arguments: &[ast::Argument<'s>],
        expected: Option<Type>,
    ) -> Option<usize> {
        let Some((first, second)) = self.untyped_scale(slot, arguments) else {
            return self.meant(slot, callee.span, arguments, expected);
        };
        let place = expected.and_then(Type::elementary);
        let all = self.decl.overloads.of(slot).unwrap_or_default();
        let mut gives = |slot: usize| self.decl.signature(slot)?.result.as_ref()?.1.ty.read().elementary();
        let of_place: Vec<_> = all.iter().copied().filter(|it| place.is_some() && gives(*it) == place).collect();
        if !of_place.is_empty() {
            return self.meant_of(&of_place, callee.span, arguments, expected);
        }
        let text = |it: Span| self.decl.log.sources.text(it).to_owned();
        let (low, high) = (text(first), text(second));
        self.report(
            Diagnostic::new(Code::E0203, first.to(second), "`SCALE_X` has the type of its MIN and MAX")
                .label("these numbers do not say which")
                .help(format!("write `{low}.0` and `{high}.0` for a REAL, `INT#{low}` and `INT#{high}` for an INT"))
                .other(callee.span, "it is called here"),
        );
        None
    }

    /// Where MIN and MAX of SCALE_X are, if both are whole numbers without a type.
    fn untyped_scale(&self, slot: usize, arguments: &[ast::Argument<'s>]) -> Option<(Span, Span)> {
        let name = self.decl.pous[slot].ast.name;
        if name.text != "SCALE_X" || !self.decl.log.sources.get(name.span.file).is_unit("library/scale_x.st") {
            return None;
        }
        let number = |(at, it): (usize, &ast::Argument<'s>)| match &it.kind {
            ArgumentKind::Positional(value) if at != 1 => whole_number(value),
            ArgumentKind::Input(name, value) if !name.text.eq_ignore_ascii_case("VALUE") => whole_number(value),
            ArgumentKind::Positional(_) | ArgumentKind::Input(..) | ArgumentKind::Output { .. } => None,
        };
        let numbers: Vec<_> = arguments.iter().enumerate().filter_map(number).collect();
        let [first, second] = numbers.as_slice() else { return None };
        Some((*first, *second))
    }

    /// Reports what is wrong inside the arguments of a call that is wrong itself.
    pub(crate) fn check_arguments(&mut self, arguments: &[ast::Argument<'s>]) {
        for argument in arguments {
            match &argument.kind {
                ArgumentKind::Positional(value) | ArgumentKind::Input(_, value) => drop(self.operand(value, None)),
                ArgumentKind::Output { target, .. } => {
                    if let Some(target) = target {
                        self.place(target);
                    }
                }
            }
        }
    }

    pub(crate) fn unknown_formal(owner: &str, formals: &[Formal<'s>], name: ast::Name<'s>) -> Diagnostic {
        let names: Vec<_> = formals.iter().map(|it| it.name.text).collect();
        let error = Diagnostic::new(Code::E0301, name.span, format!("`{owner}` has no parameter `{}`", name.text))
            .label("unknown parameter");
        match nearest(name.text, names.iter().copied()) {
            Some(near) => error.help(format!("did you mean `{near}`?")).fix(name.span, near),
            None if names.is_empty() => error,
            None if names.len() == 1 => error.help(format!("its parameter is {}", all_of(&names))),
            None => error.help(format!("its parameters are {}", all_of(&names))),
        }
    }
}

/// Where a whole number is that has no type.
fn whole_number(expr: &ast::Expr<'_>) -> Option<Span> {
    match &expr.kind {
        Ast::Literal(ast::Literal { prefix: None, value: ast::LiteralValue::Integer { .. }, .. }) => Some(expr.span),
        Ast::Unary(_, inner) | Ast::Paren(inner) => whole_number(inner).map(|_| expr.span),
        _ => None,
    }
}
