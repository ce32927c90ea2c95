//! What a move between systems changes, as far as the text alone shows it. The lints bear the
//! numbers of the traps in `docs/compare.md`.

use super::Checker;
use super::unknown::other_dialects_pin;
use crate::dialect::family_name;
use crate::{Code, Diagnostic, Span, ast};
use ast::{ArgumentKind, BinaryOp, ExprKind as Ast, LiteralValue, StatementKind};
use staunch_ir::{BlockId, Elementary, Expr, Op, Type, Value};
use staunch_runtime::{Direction, Family};

/// A call of a counter that is a variable of its own.
struct CounterCall<'a, 's> {
    name: &'s str,
    span: Span,
    block: BlockId,
    arguments: &'a [ast::Argument<'s>],
}

impl<'a, 's> CounterCall<'a, 's> {
    /// The value given for an input, by its name or its position.
    fn input(&self, pin: &str) -> Option<(&'a ast::Expr<'s>, Span)> {
        let own = own_name(self.block, pin);
        let named = self.arguments.iter().find_map(|it| match &it.kind {
            ArgumentKind::Input(name, value) if own_name(self.block, name.text).eq_ignore_ascii_case(own) => {
                Some((value, it.span))
            }
            ArgumentKind::Input(..) | ArgumentKind::Positional(_) | ArgumentKind::Output { .. } => None,
        });
        let position = self.block.info().inputs().position(|it| it.name.eq_ignore_ascii_case(own))?;
        named.or_else(|| match self.arguments.get(position) {
            Some(ast::Argument { kind: ArgumentKind::Positional(value), span }) => Some((value, *span)),
            _ => None,
        })
    }

    /// The variable that `Q =>` sets.
    fn output(&self, pin: &str) -> Option<&'a ast::Expr<'s>> {
        self.arguments.iter().find_map(|it| match &it.kind {
            ArgumentKind::Output { name, target, negated: false } if name.text.eq_ignore_ascii_case(pin) => {
                target.as_ref()
            }
            ArgumentKind::Input(..) | ArgumentKind::Positional(_) | ArgumentKind::Output { .. } => None,
        })
    }
}

/// Whether a call does no more than reset or load a counter: it follows the one that counts.
pub(super) fn only_resets(arguments: &[ast::Argument<'_>]) -> bool {
    let resets = |it: &ast::Argument<'_>| match &it.kind {
        ArgumentKind::Input(name, _) => {
            ["R", "RESET", "LD", "LOAD"].iter().any(|pin| pin.eq_ignore_ascii_case(name.text))
        }
        ArgumentKind::Positional(_) | ArgumentKind::Output { .. } => false,
    };
    !arguments.is_empty() && arguments.iter().all(resets)
}

/// This block's name for a pin.
fn own_name(block: BlockId, pin: &str) -> &str {
    match block.info().pin(pin) {
        Some(_) => pin,
        None => other_dialects_pin(block, pin).unwrap_or(pin),
    }
}

impl<'s> Checker<'_, 's> {
    /// The name that this system has for a pin, where the program moves here from another.
    pub(super) fn own_pin_name(&mut self, block: BlockId, name: ast::Name<'s>) -> ast::Name<'s> {
        let info = block.info();
        if self.decl.options.moved_from.is_none() || info.pin(name.text).is_some() {
            return name;
        }
        let Some(own) = other_dialects_pin(block, name.text) else { return name };
        let system = family_name(info.family);
        let message = format!("the pin `{}` is called `{own}` in {system}", name.text);
        let lint = Diagnostic::new(Code::W0609, name.span, message).label("a name that the move changes");
        let lint = lint.help(format!("write `{own}`, or give the inputs by position")).fix(name.span, own);
        self.report(lint);
        ast::Name { text: own, span: name.span }
    }

    /// The arguments by the names that this system has, where the program moves here.
    pub(super) fn arguments_by_own_names(
        &mut self,
        block: BlockId,
        arguments: &[ast::Argument<'s>],
    ) -> Option<Vec<ast::Argument<'s>>> {
        self.decl.options.moved_from?;
        let mut arguments = arguments.to_vec();
        for argument in &mut arguments {
            match &mut argument.kind {
                ArgumentKind::Positional(_) => {}
                ArgumentKind::Input(name, _) | ArgumentKind::Output { name, .. } => {
                    *name = self.own_pin_name(block, *name);
                }
            }
        }
        Some(arguments)
    }

    /// Trap 8: an unsigned value against zero, where the outcome is always the same.
    pub(super) fn compared_with_zero(&mut self, op: Op, ty: Elementary, sides: [&Expr; 2], span: Span) {
        let zero = |it: &Expr| it.as_const().and_then(Value::as_integer) == Some(0);
        let unsigned = ty.lane().is_integer() && !ty.lane().is_signed() && ty != Elementary::Bool;
        let outcome = match (op, zero(sides[0]), zero(sides[1])) {
            (Op::Lt, false, true) | (Op::Gt, true, false) => "FALSE",
            (Op::Ge, false, true) | (Op::Le, true, false) => "TRUE",
            _ => return,
        };
        if unsigned {
            self.report(
                Diagnostic::new(Code::W0608, span, format!("{} is never below zero", crate::key::article(ty.name())))
                    .label(format!("this is always {outcome}"))
                    .help("compare with `= 0`, or count in a signed type"),
            );
        }
    }

    /// Traps 2 and 12, which show in how a POU uses its counters.
    pub(super) fn migration_lints(&mut self, pou: &ast::Pou<'s>) {
        let mut calls = Vec::new();
        let mut comparisons = Vec::new();
        ast::each_expr(&pou.body, &mut |expr| match &expr.kind {
            Ast::Call(callee, arguments) => calls.extend(self.counter_call(callee, arguments)),
            Ast::Binary(left, BinaryOp::Gt, span, right) => comparisons.push((&**left, &**right, *span)),
            Ast::Binary(left, BinaryOp::Lt, span, right) => comparisons.push((&**right, &**left, *span)),
            _ => {}
        });
        for (count, limit, span) in comparisons {
            self.beyond_preset(&calls, count, limit, span);
        }
        for call in &calls {
            self.reset_by_itself(call, &pou.body);
        }
    }

    fn counter_call<'a>(
        &self,
        callee: &ast::Expr<'s>,
        arguments: &'a [ast::Argument<'s>],
    ) -> Option<CounterCall<'a, 's>> {
        let Ast::Name(name) = callee.kind else { return None };
        let Type::Block(block) = self.scope.get(name.text)?.place.ty else { return None };
        let info = block.info();
        let counts = info.pin("CV").is_some_and(|it| it.direction == Direction::Output);
        counts.then_some(CounterCall { name: name.text, span: callee.span, block, arguments })
    }

    /// `c.CV > PV`, where `c` stops at PV.
    fn beyond_preset(
        &mut self,
        calls: &[CounterCall<'_, 's>],
        count: &ast::Expr<'s>,
        limit: &ast::Expr<'s>,
        span: Span,
    ) {
        let Some(counter) = member_of(count, "CV") else { return };
        let of = |it: &&CounterCall<'_, '_>| it.name.eq_ignore_ascii_case(counter.text);
        let stops = |it: &CounterCall<'_, '_>| {
            let info = it.block.info();
            info.family == Family::Cscape && info.pin("CU").is_some() || info.name.ends_with("CTU_STOP_AT_PV")
        };
        let mut calls = calls.iter().filter(of).peekable();
        if calls.peek().is_none_or(|it| !stops(it)) {
            return;
        }
        let own = member_of(limit, "PV").is_some_and(|it| it.text.eq_ignore_ascii_case(counter.text));
        let text = |expr: &ast::Expr<'s>| self.decl.sources.text(expr.span).to_ascii_uppercase();
        let at_most = |given: &ast::Expr<'s>| match (number(given), number(limit)) {
            (Some(preset), Some(limit)) => preset <= limit,
            _ => text(given) == text(limit),
        };
        if own || calls.all(|it| it.input("PV").is_some_and(|(given, _)| at_most(given))) {
            self.report(
                Diagnostic::new(Code::W0602, span, format!("`{}.CV` does not pass its preset", counter.text))
                    .label("the counter stops at PV, so this never holds")
                    .note("only where PV is lowered under the count can CV lie above it")
                    .help("compare with `>=`, or use the output `Q`"),
            );
        }
    }

    /// `c(R := done); done := c.Q;`
    fn reset_by_itself(&mut self, call: &CounterCall<'_, 's>, body: &[ast::Statement<'s>]) {
        let family = call.block.info().family;
        if !matches!(family, Family::Iec | Family::Codesys) {
            return;
        }
        for (pin, outputs) in [("R", ["Q", "QU"]), ("LD", ["Q", "QD"])] {
            let Some((given, at)) = call.input(pin) else { continue };
            let is_output = |expr: &ast::Expr<'s>| {
                outputs
                    .iter()
                    .any(|it| member_of(expr, it).is_some_and(|name| name.text.eq_ignore_ascii_case(call.name)))
            };
            let set_by_call = |name: ast::Name<'s>| {
                let mut targets = outputs.iter().filter_map(|it| call.output(it));
                targets.any(|it| matches!(&it.kind, Ast::Name(it) if it.text.eq_ignore_ascii_case(name.text)))
            };
            let own = match &bare(given).kind {
                Ast::Name(name) => set_by_call(*name) || assigned(body, name.text, &mut |value| is_output(bare(value))),
                _ => is_output(bare(given)),
            };
            if own {
                let (counter, pin) = (call.name, own_name(call.block, pin));
                self.report(
                    Diagnostic::new(Code::W0612, at, format!("`{counter}` feeds its own {pin}"))
                        .label("an edge that arrives in this scan is not counted")
                        .other(call.span, "the counter")
                        .help(format!(
                            "after the call, write `IF {counter}.{} THEN {counter}({pin} := TRUE); END_IF`",
                            {
                                let has = |it: &&&str| call.block.info().pin(it).is_some();
                                outputs.iter().find(has).unwrap_or(&"Q")
                            }
                        )),
                );
            }
        }
    }
}

fn bare<'a, 's>(expr: &'a ast::Expr<'s>) -> &'a ast::Expr<'s> {
    match &expr.kind {
        Ast::Paren(inner) => bare(inner),
        _ => expr,
    }
}

/// `c` of `c.CV`.
fn member_of<'s>(expr: &ast::Expr<'s>, member: &str) -> Option<ast::Name<'s>> {
    match &bare(expr).kind {
        Ast::Member(base, name) if name.text.eq_ignore_ascii_case(member) => match base.kind {
            Ast::Name(owner) => Some(owner),
            _ => None,
        },
        _ => None,
    }
}

fn number(expr: &ast::Expr<'_>) -> Option<u64> {
    match &bare(expr).kind {
        Ast::Literal(ast::Literal { value: LiteralValue::Integer { value, .. }, .. }) => Some(*value),
        _ => None,
    }
}

/// Whether the statements assign to `name` a value that `wanted` accepts.
fn assigned<'s>(body: &[ast::Statement<'s>], name: &str, wanted: &mut dyn FnMut(&ast::Expr<'s>) -> bool) -> bool {
    body.iter().any(|statement| match &statement.kind {
        StatementKind::Assign { target, value } => {
            matches!(&target.kind, Ast::Name(it) if it.text.eq_ignore_ascii_case(name)) && wanted(value)
        }
        StatementKind::If { branches, otherwise } => {
            branches.iter().any(|(_, body)| assigned(body, name, wanted))
                || otherwise.as_ref().is_some_and(|it| assigned(it, name, wanted))
        }
        StatementKind::Case { arms, otherwise, .. } => {
            arms.iter().any(|it| assigned(&it.body, name, wanted))
                || otherwise.as_ref().is_some_and(|it| assigned(it, name, wanted))
        }
        StatementKind::For { body, .. } | StatementKind::While { body, .. } | StatementKind::Repeat { body, .. } => {
            assigned(body, name, wanted)
        }
        StatementKind::Empty
        | StatementKind::SetReset { .. }
        | StatementKind::Expr(_)
        | StatementKind::Exit
        | StatementKind::Continue
        | StatementKind::Return
        | StatementKind::Error => false,
    })
}
