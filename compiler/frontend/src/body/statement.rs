//! Statements of a body, and what they assign.

use super::exception::is_raise;
use crate::expr::call_tracking::{Call, Instance};
use crate::expr::checker::Checker;
use crate::expr::start::is_start_of_members;
use crate::start::is_once;
use crate::testing::suite::runs_suites;
use crate::{Code, Diagnostic, Span, ast};
use ast::{ExprKind as Ast, StatementKind as Ast_};
use staunch_ir::{Block, Expr, Root, StatementKind, Type};

impl<'s> Checker<'_, 's> {
    /// The statements of a body, or of a branch of one.
    pub(super) fn block_of(&mut self, statements: &[ast::Statement<'s>]) -> Block {
        self.nested(|this| {
            this.block.reserve_exact(statements.len());
            this.statements(statements);
        })
    }

    fn statements(&mut self, statements: &[ast::Statement<'s>]) {
        if statements.iter().any(|it| matches!(it.kind, Ast_::Label(_))) {
            return self.statements_with_labels(statements);
        }
        let taken_back = self.called.taken_back.clone();
        let mut left: Option<Span> = None;
        for statement in statements {
            if let Some(span) = left.take() {
                let empty = matches!(statement.kind, Ast_::Empty);
                if !empty {
                    self.report(
                        Diagnostic::new(Code::W0502, statement.span, "this is never reached")
                            .label("no path leads here")
                            .other(span, "no statement after this one is executed"),
                    );
                }
            }
            self.statement(statement);
            if matches!(statement.kind, Ast_::Exit | Ast_::Continue | Ast_::Return | Ast_::Jump(_)) {
                left = Some(statement.span);
            }
        }
        self.called.taken_back = taken_back;
    }

    fn statement(&mut self, statement: &ast::Statement<'s>) {
        let span = statement.span;
        // Nobody wrote it.
        let covered = self.is_covered;
        let is_own = matches!(statement.kind, Ast_::If { .. }) || span.start < span.end;
        let is_own = is_own && !is_once(statement) && !runs_suites(statement);
        self.is_covered &= is_own;
        if !matches!(statement.kind, Ast_::Empty | Ast_::Label(_) | Ast_::Error) {
            self.count_statement(span);
            if self.has_stops && is_own {
                self.stop_before(span);
            }
        }
        self.statement_from = self.is_reordered.then_some(self.block.len());
        let made = match &statement.kind {
            Ast_::Assign { target, value } => self.assignment(target, value, span),
            Ast_::AssignAll { targets, value } => self.assign_all(targets, value, span),
            Ast_::SetReset { target, value, set } => self.set_reset(&[(target, *set)], value, span),
            Ast_::SetResetAll { targets, value } => self.set_reset_all(targets, value, span),
            Ast_::Bind { target, value } => self.bind_reference(target, value, span),
            Ast_::Attempt { target, value } => self.attempt(target, value, span),
            Ast_::ReturnIf(condition) => self.return_if(condition, span),
            Ast_::Case { selector, arms, otherwise } => self.case(selector, arms, otherwise.as_deref(), span),
            Ast_::For { counter, from, to, by, body } => self.for_loop(counter, from, to, by.as_deref(), body, span),
            Ast_::Empty
            | Ast_::Error
            | Ast_::Expr(_)
            | Ast_::If { .. }
            | Ast_::While { .. }
            | Ast_::Repeat { .. }
            | Ast_::Try(_)
            | Ast_::Label(_)
            | Ast_::Jump(_)
            | Ast_::Exit
            | Ast_::Continue
            | Ast_::Return => {
                self.flow(&statement.kind, span);
                Some(())
            }
        };
        if matches!(statement.kind, Ast_::For { .. } | Ast_::While { .. } | Ast_::Repeat { .. }) {
            self.pass_jumps(span);
        }
        self.is_covered = covered;
        if made.is_none() {
            self.left_out.get_or_insert(span);
        }
    }

    /// Calls and control flow.
    fn flow(&mut self, kind: &Ast_<'s>, span: Span) {
        match kind {
            Ast_::Empty
            | Ast_::Error
            | Ast_::Label(_)
            | Ast_::Assign { .. }
            | Ast_::AssignAll { .. }
            | Ast_::SetReset { .. }
            | Ast_::SetResetAll { .. }
            | Ast_::Bind { .. }
            | Ast_::Attempt { .. }
            | Ast_::ReturnIf(_)
            | Ast_::Case { .. }
            | Ast_::For { .. } => {}
            Ast_::Expr(expr) => self.lone_expression(expr),
            Ast_::If { branches, otherwise } => self.branches(branches, otherwise.as_deref()),
            Ast_::While { condition, body } => self.while_loop(condition, body, span),
            Ast_::Repeat { body, until } => self.repeat_loop(body, until, span),
            Ast_::Try(it) => self.try_statement(it, span),
            Ast_::Jump(name) => self.jump(*name, span),
            Ast_::Exit => self.leave_loop("EXIT", StatementKind::Exit, span),
            Ast_::Continue => self.leave_loop("CONTINUE", StatementKind::Continue, span),
            Ast_::Return => self.push(StatementKind::Return, span),
        }
    }

    /// `RETURN(condition)`
    fn return_if(&mut self, condition: &ast::Expr<'s>, span: Span) -> Option<()> {
        if !self.decl.dialect(span).returns_on_conditions() {
            let text = self.decl.log.sources.text(condition.bare().span);
            let help = format!("write `IF {text} THEN RETURN; END_IF`, or assign a result to the function's own name");
            self.report(
                Diagnostic::new(Code::E0019, span, "RETURN takes no value")
                    .label("a condition in parentheses is an extension of CODESYS")
                    .help(help),
            );
            return None;
        }
        let leave = ast::Statement { kind: Ast_::Return, span };
        self.branches(&[(condition.clone(), vec![leave])], None);
        Some(())
    }

    pub(super) fn leave_loop(&mut self, word: &str, kind: StatementKind, span: Span) {
        if self.loops == 0 {
            self.report(
                Diagnostic::new(Code::E0505, span, format!("{word} is outside of a loop"))
                    .label("there is no FOR, WHILE or REPEAT around it")
                    .help("to leave the whole POU, write RETURN"),
            );
            return;
        }
        if self.is_in_labels() {
            return self.leave_labels(&kind, span);
        }
        self.take_counter(span);
        self.push(kind, span);
    }

    fn lone_expression(&mut self, expr: &ast::Expr<'s>) {
        match &expr.kind {
            Ast::Call(callee, arguments) => {
                if is_start_of_members(callee) {
                    self.start_members(expr.span);
                } else if is_raise(callee) {
                    self.raise(arguments, expr.span);
                } else if self.test_statement(callee, arguments, expr.span).is_none()
                    && self.suite_statement(callee, arguments, expr.span).is_none()
                    && self.axunit_statement(callee, arguments, expr.span).is_none()
                {
                    self.call_statement(expr, callee, arguments);
                }
            }
            Ast::Paren(inner) => self.lone_expression(inner),
            Ast::Error(_) => drop(self.operand(expr, None)),
            Ast::Name(_) | Ast::Member(..) if self.is_action_by_name(expr) || self.is_program_by_name(expr) => {
                self.call_statement(expr, expr, &[]);
            }
            Ast::Name(_) | Ast::Member(..) | Ast::Index(..) => self.report_missing_call(expr),
            Ast::Assign(..) => drop(self.operand(expr, None)),
            Ast::Literal(_) | Ast::Address(_) | Ast::Part(..) | Ast::Deref(_) | Ast::Unary(..) | Ast::Binary(..) => {
                self.report(
                    Diagnostic::new(Code::E0508, expr.span, "this statement has no effect")
                        .label("its value is not used"),
                );
            }
        }
    }

    fn report_missing_call(&mut self, expr: &ast::Expr<'s>) {
        let Some(found) = self.place(expr) else { return };
        if self.decl.dialect(expr.span).reads_properties_alone() && self.property(expr).is_some() {
            return;
        }
        let text = self.decl.log.sources.text(expr.span).to_owned();
        let instance = match found.place.ty {
            Type::Block(_) => true,
            Type::Struct(id) => self.decl.is_instance(id),
            Type::Elementary(_)
            | Type::Reference(_)
            | Type::Subrange(..)
            | Type::String(_)
            | Type::Enum(_)
            | Type::Array(_) => false,
        };
        let code =
            if !instance && self.decl.dialect(expr.span).takes_values_alone() { Code::W0518 } else { Code::E0508 };
        let error = Diagnostic::new(code, expr.span, "this statement has no effect");
        self.report(if instance {
            error
                .label("the instance is named, but not called")
                .help(format!("write `{text}();`"))
                .fix(expr.span, format!("{text}()"))
        } else {
            error.label("a variable alone does nothing").help(format!("to assign to it, write `{text} := …;`"))
        });
    }

    fn assignment(&mut self, target: &ast::Expr<'s>, value: &ast::Expr<'s>, span: Span) -> Option<()> {
        if let Some((text, index)) = self.character_of(target) {
            return self.assign_character(text, index, value, span);
        }
        if let Some(bound) = self.address_for_reference(target, value, span) {
            return bound;
        }
        self.refuse_address_assigned(target, value)?;
        if self.is_run() {
            self.check_binding(target, value)?;
            self.note_binding(target, value);
        }
        self.assigned(std::slice::from_ref(target), value, span, false).map(drop)?;
        if self.decl.log.nonretentive.contains(&target.span) {
            self.reset_at_start(target)?;
        }
        Some(())
    }

    /// A variable that a VAR_CONFIG binds has the type given there. A run copies it in first, and back if it is not an input.
    fn check_binding(&mut self, target: &ast::Expr<'s>, value: &ast::Expr<'s>) -> Option<()> {
        let (Some(to), Some(from)) = (self.static_type(target), self.static_type(value)) else { return Some(()) };
        if to == from {
            return Some(());
        }
        if let Ast::Name(address) = &value.kind {
            let (to, from) = (self.type_name(to), self.type_name(from));
            self.report(
                Diagnostic::new(Code::E0409, target.span, format!("this variable is {to}"))
                    .label(format!("the variable at `{}` is {from}", address.text))
                    .help(format!("write `{to}` here, or change the variable")),
            );
        }
        None
    }

    fn note_binding(&mut self, target: &ast::Expr<'s>, value: &ast::Expr<'s>) {
        let ast::ExprKind::Name(address) = value.kind else { return };
        let state = self.signature.as_ref().and_then(|it| it.state);
        if let Some(found) = self.place(target)
            && found.place.root == Root::Instance
        {
            self.note_bound(state, found.place, address);
        }
    }

    /// `r ?= x`: which instance a reference is given is known only at run time. Whether it is an instance at all is known when it is
    /// compiled, so that an attempt that cannot succeed is refused.
    fn attempt(&mut self, target: &ast::Expr<'s>, value: &ast::Expr<'s>, span: Span) -> Option<()> {
        if let Some(made) = self.attempt_of_instance(target, value, span) {
            return made;
        }
        let ty = self.place(target).map(|it| it.place.ty);
        if let Some(ty) = ty.filter(|it| !matches!(it, Type::Reference(_))) {
            let ty = self.type_name(ty);
            self.report(
                Diagnostic::new(Code::E0211, target.span, format!("`?=` sets a reference, but this is {ty}"))
                    .label("expected a REF_TO")
                    .help("assign it with `:=`"),
            );
            self.operand(value, None);
            return None;
        }
        self.assignment(target, value, span)
    }

    /// `a := b := c`: each target gets what the one to its right was given.
    fn assign_all(&mut self, targets: &[ast::Expr<'s>], value: &ast::Expr<'s>, span: Span) -> Option<()> {
        if !self.decl.dialect(span).assigns_in_a_row() {
            let message = "an assignment has no value, and only one variable on its left";
            self.report(
                Diagnostic::new(Code::E0512, span, message)
                    .label("several assignments in a row are an extension of CODESYS and SIMATIC")
                    .help("write one statement for each variable"),
            );
            targets.iter().for_each(|it| drop(self.place(it)));
            self.operand(value, None);
            return None;
        }
        self.assigned(targets, value, span, false).map(drop)
    }

    /// `s[i] := value;` assigns the string with another character.
    fn assign_character(
        &mut self,
        text: &ast::Expr<'s>,
        index: &ast::Expr<'s>,
        value: &ast::Expr<'s>,
        span: Span,
    ) -> Option<()> {
        let found = self.place(text);
        let Some(found) = found.filter(|it| self.writable(it, text.span)) else {
            self.operand(value, None);
            return None;
        };
        let ty = found.place.ty.string_type()?;
        let of = self.character_type(ty, index.span);
        let mut place = found.place;
        let (position, value) = self.after_place(&mut place, |this| {
            let Some(mut position) = this.character_index(index, ty) else {
                this.operand(value, None);
                return None;
            };
            let value = this.after(&mut [&mut position], |this| this.value(value, of))?;
            Some((position, value))
        })?;
        let whole = Expr::load(place.clone(), self.at(span));
        let changed = self.with_character(whole, position, value, span)?;
        self.write(place, None, changed, span)
    }

    /// `a S= b R= c`: each target is set or reset while the last operand is TRUE.
    fn set_reset_all(&mut self, targets: &[(ast::Expr<'s>, bool)], value: &ast::Expr<'s>, span: Span) -> Option<()> {
        if !self.decl.dialect(span).assigns_in_a_row() {
            self.report(
                Diagnostic::new(Code::E0512, span, "`S=` and `R=` have no value, and only one variable on their left")
                    .label("several in a row are an extension of CODESYS")
                    .help("write one statement for each variable"),
            );
            targets.iter().for_each(|it| drop(self.place(&it.0)));
            self.operand(value, None);
            return None;
        }
        let targets: Vec<_> = targets.iter().map(|(target, set)| (target, *set)).collect();
        self.set_reset(&targets, value, span)
    }

    /// What a branch called, taken away so that the next branch, which excludes it, may call it
    /// too; nothing where the branch does not come back.
    pub(super) fn leave_branch(&mut self, before: usize, body: &[ast::Statement<'s>]) -> Vec<(Instance, Call)> {
        let called = self.called.split_off(before);
        let leaves =
            |it: &ast::Statement<'s>| matches!(it.kind, Ast_::Exit | Ast_::Continue | Ast_::Return | Ast_::Jump(_));
        if body.last().is_some_and(leaves) { Vec::new() } else { called }
    }

    fn branches(
        &mut self,
        branches: &[(ast::Expr<'s>, Vec<ast::Statement<'s>>)],
        otherwise: Option<&[ast::Statement<'s>]>,
    ) {
        let [(condition, body), rest @ ..] = branches else {
            if let Some(otherwise) = otherwise {
                self.statements(otherwise);
            }
            return;
        };
        let at = condition.span;
        let value = self.condition(condition);
        self.count_condition(condition, value.as_ref());
        let (before, asked) = (self.called.len(), self.called.asked.len());
        self.note_asked(condition);
        let then = self.block_of(body);
        let called = self.leave_branch(before, body);
        // An ELSIF's condition, with the calls in it, is evaluated only when the ones before fail.
        let otherwise = self.nested(|this| this.branches(rest, otherwise));
        self.called.asked.truncate(asked);
        self.called.append(called);
        if let Some(condition) = value {
            self.push(StatementKind::If { condition, then, otherwise }, at);
        }
    }
}
