//! What a move between systems changes, as far as the text alone shows it. The lints bear the
//! numbers of the traps in `docs/compare.md`.

use super::checker::Checker;
use super::unresolved::{other_dialects_pin, pin_of_data};
use crate::dialect::block_in;
use crate::spelling::Key;
use crate::{Code, Diagnostic, Span, ast};
use ast::{ArgumentKind, BinaryOp, ExprKind as Ast, LiteralValue, StatementKind};
use rustc_hash::{FxHashMap, FxHashSet};
use staunch_ir::{BlockId, Const, Elementary, Expr, Op, Type, Value};
use staunch_runtime::{Direction, Family, PinRole};

/// A call of a counter that is a variable of its own.
struct CounterCall<'a, 's> {
    name: &'s str,
    span: Span,
    block: BlockId,
    arguments: &'a [ast::Argument<'s>],
}

impl<'a, 's> CounterCall<'a, 's> {
    /// The value given for an input, by its name or its position.
    fn input(&self, role: PinRole) -> Option<(&'a ast::Expr<'s>, Span)> {
        let named = self.arguments.iter().find_map(|it| match &it.kind {
            ArgumentKind::Input(name, value) if PinRole::named(name.text) == Some(role) => Some((value, it.span)),
            ArgumentKind::Input(..) | ArgumentKind::Positional(_) | ArgumentKind::Output { .. } => None,
        });
        let position = self.block.info().inputs().position(|it| it.role == Some(role))?;
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

/// Whether the type is a counter with a count to read.
fn counts(ty: Type) -> bool {
    match ty {
        Type::Block(block) => block.info().pin_for(PinRole::Count).is_some_and(|it| it.direction == Direction::Output),
        Type::Elementary(_)
        | Type::Reference(_)
        | Type::Subrange(..)
        | Type::String(_)
        | Type::Enum(_)
        | Type::Array(_)
        | Type::Struct(_) => false,
    }
}

impl<'s> Checker<'_, 's> {
    /// The name that this system has for a pin that some of its controllers call otherwise, or that another system does
    /// from which the program moves here.
    pub(crate) fn own_pin_name(&mut self, block: BlockId, name: ast::Name<'s>) -> ast::Name<'s> {
        let info = block.info();
        if let Some(other) = info.facts.other_pins.iter().find(|it| it.name.eq_ignore_ascii_case(name.text)) {
            return ast::Name { text: other.pin, span: name.span };
        }
        let Some(from) = self.decl.log.options.moved_from.filter(|_| info.pin(name.text).is_none()) else {
            return name;
        };
        let own = other_dialects_pin(block, name.text).or_else(|| pin_of_data(from, block, name.text));
        let Some(own) = own else { return name };
        // Several systems have the standard's blocks.
        let system = match info.family {
            Family::Iec => self.decl.dialect(name.span).name().to_ascii_uppercase(),
            Family::Codesys | Family::Cscape | Family::Logix | Family::Openplc | Family::Openplc4 | Family::S7 => {
                info.family.name().to_owned()
            }
        };
        let message = format!("the pin `{}` is called `{own}` in {system}", name.text);
        let lint = Diagnostic::new(Code::W0609, name.span, message).label("the move changes this name");
        let lint = lint.help(format!("write `{own}`, or give the inputs by position")).fix(name.span, own);
        self.report(lint);
        ast::Name { text: own, span: name.span }
    }

    /// The arguments by the names that this system has, where the program moves here.
    pub(crate) fn arguments_by_own_names(
        &mut self,
        block: BlockId,
        arguments: &[ast::Argument<'s>],
    ) -> Option<Vec<ast::Argument<'s>>> {
        if self.decl.log.options.moved_from.is_none() && block.info().facts.other_pins.is_empty() {
            return None;
        }
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
    pub(crate) fn compared_with_zero(&mut self, op: Op, ty: Elementary, sides: [&Expr; 2], span: Span) {
        let zero = |it: &Expr| it.as_const().and_then(Value::as_integer) == Some(0);
        let counts = ty.repr().is_integer() && ty != Elementary::Bool && !ty.is_duration();
        let unsigned = counts && !ty.repr().is_signed();
        let outcome = match (op, zero(sides[0]), zero(sides[1])) {
            (Op::Lt, false, true) | (Op::Gt, true, false) => "FALSE",
            (Op::Ge, false, true) | (Op::Le, true, false) => "TRUE",
            _ => return,
        };
        if unsigned {
            self.report(
                Diagnostic::new(
                    Code::W0608,
                    span,
                    format!("{} is never below zero", crate::diagnostic::wording::article(ty.name())),
                )
                .label(format!("this is always {outcome}"))
                .help("compare with `= 0`, or count in a signed type"),
            );
        }
    }

    /// Traps 2 and 12, which show in how a POU uses its counters.
    pub(crate) fn migration_lints(&mut self, body: &[ast::Statement<'s>]) {
        let is_counter = |ty| counts(ty) || self.counter_in(ty).is_some();
        if !self.scope.variables.iter().any(|it| is_counter(it.place.ty)) {
            return;
        }
        let mut calls = Vec::new();
        let mut comparisons = Vec::new();
        ast::each_expr(body, &mut |expr| match &expr.kind {
            Ast::Call(callee, arguments) => calls.extend(self.counter_call(callee, arguments)),
            Ast::Binary(sides, op @ (BinaryOp::Gt | BinaryOp::Ge), span) => {
                comparisons.push((&sides[0], &sides[1], *op == BinaryOp::Gt, *span));
            }
            Ast::Binary(sides, op @ (BinaryOp::Lt | BinaryOp::Le), span) => {
                comparisons.push((&sides[1], &sides[0], *op == BinaryOp::Lt, *span));
            }
            _ => {}
        });
        let mut calls_of: FxHashMap<_, Vec<_>> = FxHashMap::default();
        for call in &calls {
            calls_of.entry(Key(call.name)).or_default().push(call);
        }
        for (count, limit, is_above, span) in comparisons {
            let Some(counter) = member_of(count, "CV") else { continue };
            if let Some(calls) = calls_of.get(&Key(counter.text)) {
                self.beyond_preset(calls, counter, (limit, is_above), span);
            }
        }
        let mut read = FxHashSet::default();
        note_members_read(body, &mut read);
        for call in &calls {
            self.reset_by_itself(call, &read);
            self.counted_as_it_falls(call);
            self.loaded_while_it_moves(call);
        }
    }

    fn is_constant(&self, expr: &ast::Expr<'s>) -> bool {
        match &bare(expr).kind {
            Ast::Literal(_) => true,
            Ast::Unary(_, inner) => self.is_constant(inner),
            Ast::Name(name) => self.scope.get(name.text).is_some_and(|it| it.constant_value().is_some()),
            _ => false,
        }
    }

    /// The number that is always there.
    fn known(&self, expr: &ast::Expr<'s>) -> Option<i128> {
        match &bare(expr).kind {
            Ast::Unary(ast::UnaryOp::Neg, inner) => self.known(inner).map(|it| -it),
            Ast::Unary(ast::UnaryOp::Plus, inner) => self.known(inner),
            Ast::Name(name) => match self.scope.get(name.text)?.constant_value()? {
                Const::Scalar(value) => value.as_integer(),
                Const::Zero => Some(0),
                Const::Text(_) | Const::Array(_) | Const::Struct(_) => None,
            },
            _ => number(expr).map(i128::from),
        }
    }

    fn counter_call<'a>(
        &self,
        callee: &ast::Expr<'s>,
        arguments: &'a [ast::Argument<'s>],
    ) -> Option<CounterCall<'a, 's>> {
        let (name, block) = match &callee.kind {
            Ast::Name(name) => (*name, self.scope.get(name.text)?.place.ty),
            Ast::Member(base, method) => self.counter_of_data(base, *method)?,
            _ => return None,
        };
        let Type::Block(block) = block else { return None };
        counts(Type::Block(block)).then_some(CounterCall { name: name.text, span: callee.span, block, arguments })
    }

    /// `c.CTD(…)`, of the data of a counter of S7: the counter that this is a call of.
    fn counter_of_data(&self, base: &ast::Expr<'s>, method: ast::Name<'s>) -> Option<(ast::Name<'s>, Type)> {
        let Ast::Name(name) = base.kind else { return None };
        let data = self.counter_in(self.scope.get(name.text)?.place.ty)?;
        let numbers = data.info().name.strip_prefix("CTUD")?;
        let called = format!("{}{numbers}", method.text.to_ascii_uppercase());
        Some((name, Type::Block(block_in(Family::S7, &called)?)))
    }

    /// The counter up and down that the library's data of a counter of S7 holds.
    fn counter_in(&self, ty: Type) -> Option<BlockId> {
        let Type::Struct(id) = ty else { return None };
        let slot = self.decl.slot_of_instance(id)?;
        let is_bundled = self.decl.log.sources.get(self.decl.pous[slot].ast.name.span.file).is_bundled();
        let is_counter = |it: &BlockId| counts(Type::Block(*it)) && it.info().family == Family::S7;
        let blocks = self.decl.program.structure(id).fields.iter().filter_map(|it| match it.ty {
            Type::Block(block) => Some(block),
            _ => None,
        });
        blocks.filter(|_| is_bundled).find(is_counter)
    }

    /// `c.CV > PV`, or `c.CV >= 60` with a PV of 50, where `c` stops at PV; `calls` are those of `c`.
    fn beyond_preset(
        &mut self,
        calls: &[&CounterCall<'_, 's>],
        counter: ast::Name<'s>,
        (limit, is_above): (&ast::Expr<'s>, bool),
        span: Span,
    ) {
        let stops = |it: &CounterCall<'_, '_>| {
            let info = it.block.info();
            info.facts.stops && info.pin_for(PinRole::Up).is_some()
        };
        if calls.first().is_none_or(|it| !stops(it)) {
            return;
        }
        let own = member_of(limit, "PV").is_some_and(|it| it.text.eq_ignore_ascii_case(counter.text));
        let text = |expr: &ast::Expr<'s>| self.decl.log.sources.text(expr.span).to_ascii_uppercase();
        // A count starts at 0, above a preset that is negative.
        let is_preset = |given: &ast::Expr<'s>| match (self.known(given), self.known(limit)) {
            (Some(preset), Some(limit)) => preset == limit && limit >= 0,
            _ => text(given) == text(limit),
        };
        let is_beyond = |given: &ast::Expr<'s>| match (self.known(given), self.known(limit)) {
            (Some(preset), Some(limit)) => preset < limit && limit >= i128::from(!is_above),
            _ => false,
        };
        let negative = calls.iter().any(|it| it.input(PinRole::Preset).is_some_and(|it| self.known(it.0) < Some(0)));
        let presets = || calls.iter().map(|it| it.input(PinRole::Preset).map(|it| it.0));
        let reached = is_above && (own && !negative || presets().any(|it| it.is_some_and(is_preset)));
        let never = |it: Option<&ast::Expr<'s>>| it.is_some_and(|it| is_beyond(it) || is_above && is_preset(it));
        if is_above && own && !negative || presets().all(never) {
            self.report(
                Diagnostic::new(Code::W0602, span, format!("`{}.CV` never passes its preset", counter.text))
                    .label("the counter stops at PV, so this never holds")
                    .note("CV is above PV only where PV is negative or is lowered below the count")
                    .help(match reached {
                        true => "compare with `>=`, or use the output `Q`",
                        false => "the count never gets that high: compare with a value up to PV, or raise PV",
                    }),
            );
        }
    }

    /// `c(R := done); done := c.Q;`, where a count can arrive in the scan of the reset. It cannot where
    /// Q rises on an edge alone: the input is still TRUE then.
    fn reset_by_itself(&mut self, call: &CounterCall<'_, 's>, read: &MembersRead<'s>) {
        let info = call.block.info();
        let moves = call.input(PinRole::Preset).is_some_and(|(preset, _)| !self.is_constant(preset));
        let lost = if info.facts.counts_levels {
            "a call that would count in this scan does not"
        } else if info.pin_for(PinRole::Up).is_some() && info.pin_for(PinRole::Down).is_some() {
            "an edge of the other input that arrives in this scan is not counted"
        } else if moves {
            "an edge that arrives in this scan is not counted, if the preset has changed"
        } else {
            return;
        };
        let empty = info.pin_for(PinRole::Empty).map_or(PinRole::Done, |_| PinRole::Empty);
        for (input, output) in [(PinRole::Reset, PinRole::Done), (PinRole::Load, empty)] {
            let Some((given, at)) = call.input(input) else { continue };
            let (Some(pin), Some(output)) = (info.pin_for(input), info.pin_for(output)) else { continue };
            let (pin, output) = (pin.name, output.name);
            let is_output = |expr: &ast::Expr<'s>| {
                member_of(expr, output).is_some_and(|name| name.text.eq_ignore_ascii_case(call.name))
            };
            let set_by_call = |name: ast::Name<'s>| {
                let target = call.output(output);
                target.is_some_and(|it| matches!(&it.kind, Ast::Name(it) if it.text.eq_ignore_ascii_case(name.text)))
            };
            let reads_output = |name: ast::Name<'s>| read.contains(&[name.text, call.name, output].map(Key));
            let own = match &bare(given).kind {
                Ast::Name(name) => set_by_call(*name) || reads_output(*name),
                _ => is_output(bare(given)),
            };
            if own {
                let counter = call.name;
                let given = self.decl.log.sources.text(bare(given).span);
                self.report(
                    Diagnostic::new(Code::W0612, at, format!("`{counter}` feeds its own {pin}"))
                        .label(lost)
                        .other(call.span, "the counter")
                        .help(format!(
                            "pass `{pin} := FALSE` here, and after the statements that read `{counter}.{output}` write \
                             `IF {given} THEN {counter}({pin} := TRUE); END_IF`"
                        )),
                );
            }
        }
    }
}

impl<'s> Checker<'_, 's> {
    /// Trap 17: `c(CD := pulse)` counts when the pulse ends. Who gives `NOT pulse` knows.
    fn counted_as_it_falls(&mut self, call: &CounterCall<'_, 's>) {
        if !call.block.info().facts.counts_falls {
            return;
        }
        let Some((given, at)) = call.input(PinRole::Down) else { return };
        if matches!(bare(given).kind, Ast::Unary(ast::UnaryOp::Not, _) | Ast::Literal(_)) {
            return;
        }
        let text = self.decl.log.sources.text(bare(given).span);
        let negated = if matches!(bare(given).kind, Ast::Binary(..)) { format!("({text})") } else { text.to_owned() };
        let both = match call.block.info().pin_for(PinRole::Up) {
            Some(_) => {
                "; if both inputs count in one call, a CTUD counts up, then down: `staunch compare` shows what to write"
            }
            None => "",
        };
        self.report(
            Diagnostic::new(Code::W0616, at, format!("`{}` counts down when CD falls", call.name))
                .label("counted when this becomes FALSE")
                .note("OpenPLC from v4.1 uses an F_TRIG here, at least up to Editor 4.2.11; before v4.1 it counted the rising edge")
                .help(format!(
                    "pass `NOT {negated}` to count when it rises; if your Editor counts the rising edge, set \
                     `openplc4-cd-edge = \"rising\"` in staunch.toml{both}"
                )),
        );
    }
}

impl<'s> Checker<'_, 's> {
    /// Trap 20: `c(LD := fill, PV := target)` of S7, where `target` may move while `fill` is TRUE. An R_TRIG's Q is TRUE in
    /// one call, where both readings are one.
    fn loaded_while_it_moves(&mut self, call: &CounterCall<'_, 's>) {
        let info = call.block.info();
        if info.family != Family::S7 || info.facts.loads_on_edges {
            return;
        }
        let Some(((load, at), (preset, _))) = call.input(PinRole::Load).zip(call.input(PinRole::Preset)) else {
            return;
        };
        if matches!(bare(load).kind, Ast::Literal(_)) || member_of(load, "Q").is_some() || self.is_constant(preset) {
            return;
        }
        let text = |it: Span| self.decl.log.sources.text(it);
        let ([given, value], callee) = ([load, preset].map(|it| text(bare(it).span)), text(call.span));
        self.report(
            Diagnostic::new(Code::W0613, at, format!("`{}` may be loaded again while LD is TRUE", call.name))
                .label(format!("here CV follows `{value}` for as long as this is TRUE"))
                .note("Siemens' pages say that PV is loaded while LD is 1, and that it is loaded when LD changes to 1")
                .help(format!(
                    "load it in one call, as both say: `edge(CLK := {given}); {callee}(LD := edge.Q, …)`, with `edge : R_TRIG`"
                )),
        );
    }
}

pub(super) fn bare<'a, 's>(expr: &'a ast::Expr<'s>) -> &'a ast::Expr<'s> {
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

/// Each `a := b.c` of a body, as these three names: a body may have thousands of them and of counters.
type MembersRead<'s> = FxHashSet<[Key<'s>; 3]>;

fn note_members_read<'s>(body: &[ast::Statement<'s>], read: &mut MembersRead<'s>) {
    for statement in body {
        if let StatementKind::Assign { target, value } = &statement.kind {
            read.extend(member_read(target, value));
        }
        ast::each_body(statement, &mut |body| note_members_read(body, read));
    }
}

fn member_read<'s>(target: &ast::Expr<'s>, value: &ast::Expr<'s>) -> Option<[Key<'s>; 3]> {
    match (&target.kind, &bare(value).kind) {
        (Ast::Name(target), Ast::Member(base, member)) => match &base.kind {
            Ast::Name(owner) => Some([target.text, owner.text, member.text].map(Key)),
            _ => None,
        },
        _ => None,
    }
}
