//! WHILE and REPEAT, which are one loop in the IR, and FOR.

use super::each_turn::Calls;
use crate::dialect::rules::{Part, Use, is_followed};
use crate::expr::checker::Checker;
use crate::expr::operand::{Operand, stored};
use crate::types::counter::{Counter, Shown};
use crate::{Code, Diagnostic, Span, ast};
use staunch_ir::{
    Block, Conversion, Elementary, Expr, For, Location, Op, Place, Statement, StatementKind, Step, Taking, Type, Value,
    alias, loops, turns,
};

impl<'s> Checker<'_, 's> {
    pub(super) fn while_loop(&mut self, condition: &ast::Expr<'s>, body: &[ast::Statement<'s>], span: Span) {
        let mut holds = None;
        let mut block = self.nested(|this| {
            holds = this.condition(condition);
            this.count_condition(condition, holds.as_ref());
        });
        let mut inside = self.loop_body(body);
        let Some(holds) = holds else { return };
        if holds.as_const() == Some(Value::Bool(true)) {
            self.refuse_to_end(body, condition.span);
        }
        let Some(leave) = self.exit_unless(holds, condition.span) else { return };
        block.push(leave);
        let turn = block.len();
        block.append(&mut inside);
        if !turns::divides(&self.frame(), &block, &[]) {
            block.insert(turn, Statement::new(StatementKind::Turn, self.at(span)));
        }
        self.push(StatementKind::Loop { body: block, continuing: Vec::new(), count: None }, span);
    }

    pub(super) fn repeat_loop(&mut self, body: &[ast::Statement<'s>], until: &ast::Expr<'s>, span: Span) {
        let statements = body;
        let mut body = self.loop_body(body);
        let mut done = None;
        let mut continuing = self.nested(|this| {
            done = this.condition(until);
            this.count_condition(until, done.as_ref());
        });
        let Some(done) = done else { return };
        if done.as_const() == Some(Value::Bool(false)) {
            self.refuse_to_end(statements, until.span);
        }
        let at = self.at(until.span);
        continuing.push(exit_if(done, at));
        if !turns::divides(&self.frame(), &body, &continuing) {
            body.insert(0, Statement::new(StatementKind::Turn, self.at(span)));
        }
        self.push(StatementKind::Loop { body, continuing, count: None }, span);
    }

    /// A loop whose condition never ends it needs a way out.
    fn refuse_to_end(&mut self, body: &[ast::Statement<'s>], span: Span) {
        if !has_way_out(body, true) {
            self.report(
                Diagnostic::new(Code::W0508, span, "this loop never ends")
                    .label("the condition is constant, and nothing leaves the loop")
                    .help("a scan must end: leave the loop with EXIT"),
            );
        }
    }

    fn loop_body(&mut self, body: &[ast::Statement<'s>]) -> Block {
        self.loops += 1;
        let block = self.block_of(body);
        self.loops -= 1;
        block
    }

    fn exit_unless(&mut self, condition: Expr, span: Span) -> Option<Statement> {
        let at = self.at(span);
        let not = self.apply(Op::Not, Type::BOOL, vec![condition], Type::BOOL, span)?;
        Some(exit_if(not, at))
    }

    pub(super) fn for_loop(
        &mut self,
        counter: &ast::Expr<'s>,
        from: &ast::Expr<'s>,
        to: &ast::Expr<'s>,
        by: Option<&ast::Expr<'s>>,
        body: &[ast::Statement<'s>],
        span: Span,
    ) -> Option<()> {
        let Some((mut head, shown, calls)) = self.for_head(counter, from, to, by) else {
            // The body may hold mistakes of its own.
            self.loop_body(body);
            return None;
        };
        // As far as it is known before the body: a dialect may let that write the counter.
        head.is_private = self.frame().is_private(&head.counter) && !self.decl.dialect(counter.span).assigns_counters();
        self.counters.push(Counter { head: head.clone(), shown: shown.clone(), depth: self.loops + 1 });
        head.body = self.for_body(shown.as_ref(), &head.counter, body, counter.span);
        self.counters.pop();
        if shown.is_none() && self.looks_in_each_turn(&head, &calls, by, span) {
            return self.loop_by_turns(head, calls, by, span);
        }
        head.is_private = loops::is_private(&self.frame(), &head.counter, &head.body);
        // What the body gives the counter may be beyond every limit.
        if shown.is_none() && alias::writes(&self.frame(), &head.body, &head.counter) {
            self.note_use(Use::Part(Part::LimitOfType), to.span);
        }
        let local = head.counter.clone();
        let wide_step = self.step_beyond_counter(&head, &calls).cloned();
        self.loop_to(head, calls.wide_limit, wide_step.as_ref(), span)?;
        if let Some(shown) = &shown {
            self.show_counter(shown, &local, counter.span);
        }
        Some(())
    }

    fn for_body(&mut self, shown: Option<&Shown>, local: &Place, body: &[ast::Statement<'s>], counter: Span) -> Block {
        let Some(shown) = shown else { return self.loop_body(body) };
        self.loops += 1;
        let block = self.nested(|this| {
            this.show_counter(shown, local, counter);
            let mut turn = this.block_of(body);
            this.block.append(&mut turn);
            this.take_counter(counter);
        });
        self.loops -= 1;
        block
    }

    /// Checks a FOR loop's head; the loop has no body yet.
    fn for_head(
        &mut self,
        counter: &ast::Expr<'s>,
        from: &ast::Expr<'s>,
        to: &ast::Expr<'s>,
        by: Option<&ast::Expr<'s>>,
    ) -> Option<(For, Option<Shown>, Calls)> {
        let found = self.place_or_view(counter);
        let Some(found) = found.filter(|it| self.writable(it, counter.span)) else {
            for part in [from, to].into_iter().chain(by) {
                self.operand(part, None);
            }
            return None;
        };
        let ty = self.counter_type(self.type_of(&found).read(), counter.span)?;
        self.note_assigned(&found.place, counter.span);
        let (mut place, view) = (found.place, found.view);
        // The loop goes by one variable: what its indices are made of may change in the body.
        self.fix(&mut place);
        let shown = (view.is_some() || place.is_followed()).then(|| {
            let local = self.temporary("counter", view.map_or(place.ty, |it| it.ty));
            Shown { place: std::mem::replace(&mut place, local), view }
        });
        // Each part is checked, whatever is wrong with another.
        let mut first = self.value(from, place.ty);
        if let Some(shown) = &shown
            && let Some(value) = first.take()
        {
            self.assign(place.clone(), value, from.span);
            self.show_counter(shown, &place, counter.span);
            first = Some(Expr::load(place.clone(), self.at(from.span)));
        }
        let mark = self.block.len();
        let (mut last, wide_limit) = self.value_and_wide(to, place.ty.read());
        let after_limit = self.block.len();
        let is_each_turn = shown.is_none() && self.calls_in_each_turn(to.span);
        let (mut calls, mut wide_step) = (Calls { wide_limit, ..Calls::default() }, None);
        let step = match is_each_turn {
            true => self.step(by, ty, &mut wide_step),
            false => {
                let limits = &mut last.iter_mut().chain(&mut calls.wide_limit).collect::<Vec<_>>();
                self.after(limits, |this| this.step(by, ty, &mut wide_step))
            }
        };
        if is_each_turn {
            calls.step = self.block.split_off(after_limit);
            calls.limit = self.block.split_off(mark);
        }
        calls.wide_step = wide_step;
        let (mut first, last, step) = (first?, last?, step?);
        let last = match place.ty {
            Type::Enum(_) => self.convert(Conversion::Same, Type::Elementary(ty), last),
            Type::Elementary(_)
            | Type::Subrange(..)
            | Type::Reference(_)
            | Type::String(_)
            | Type::Array(_)
            | Type::Struct(_)
            | Type::Block(_) => last,
        };
        if self.block.len() > mark {
            // The counter has its first value when the calls in the other parts are made.
            let at = first.at;
            let start = Statement::assign(place.clone(), first, at);
            self.block.insert(mark, start);
            first = Expr::load(place.clone(), at);
        }
        let range = self.decl.program.range(place.ty).or(ty.repr().range())?;
        let step_at = self.at(by.unwrap_or(counter).span);
        self.note_endless(&step, calls.wide_limit.as_ref().unwrap_or(&last), range, (to, ty));
        self.note_never(&first, &last, &step, [from.span, to.span]);
        let (body, taking) = (Block::new(), Taking::Each);
        let head = For { counter: place, first, last, step, range, is_private: false, body, taking, step_at };
        Some((head, shown, calls))
    }

    fn counter_type(&mut self, ty: Type, span: Span) -> Option<Elementary> {
        match ty {
            Type::Elementary(it) if it.is_integer() || self.counts(it, span) => Some(it),
            Type::Enum(id) if self.is_counted_by(id, span) => Some(self.decl.program.enumeration(id).base),
            other => {
                let name = self.type_name(other);
                self.report(
                    Diagnostic::new(
                        Code::E0201,
                        span,
                        format!("the counter of a FOR loop must be an integer, but this is {name}"),
                    )
                    .label("expected an integer"),
                );
                None
            }
        }
    }

    /// Reports a FOR between constants that takes no turn.
    fn note_never(&mut self, first: &Expr, last: &Expr, step: &Step, [start, end]: [Span; 2]) {
        let constant = |it: &Expr| it.as_const().and_then(Value::as_integer);
        let (Some(from), Some(to), Step::Constant(step)) = (constant(first), constant(last), step) else { return };
        let is_up = *step > 0;
        if is_up && from <= to || !is_up && from >= to {
            return;
        }
        let lint = Diagnostic::new(Code::W0532, start.to(end), "this loop takes no turn")
            .label(format!("from {from} to {to} in steps of {step}"));
        let text = |it: Span| self.decl.log.sources.text(it);
        let is_number = |it: Span| !text(it).contains(|it: char| it.is_ascii_alphabetic());
        // A named constant may have another value one day, and the other direction is not meant.
        self.report(match (is_up, is_number(start) && is_number(end)) {
            (_, false) => lint,
            (true, true) => lint.help(format!("to count down, write `{from} TO {to} BY -{step}`")),
            (false, true) => lint.help(format!("to count up, write `{from} TO {to} BY {}`", -step)),
        });
    }

    /// Notes a FOR whose counter may have no value beyond its limit: it ends here, and not where it wraps. Of one that has
    /// none for certain, a lint says so.
    fn note_endless(&mut self, step: &Step, limit: &Expr, range: (i128, i128), (to, ty): (&ast::Expr<'s>, Elementary)) {
        let known = self.known_range(limit);
        let steps = match step {
            Step::Constant(step) => (*step, *step),
            Step::Variable(step) => self.known_range(step),
        };
        let may_pass_most = steps.1 > 0 && known.1.saturating_add(steps.1) > range.1;
        let may_pass_least = steps.0 < 0 && known.0.saturating_add(steps.0) < range.0;
        if !may_pass_most && !may_pass_least {
            return;
        }
        let dialect = self.decl.dialect(to.span);
        self.note_use(Use::Part(Part::LimitOfType), to.span);
        let is_certain = limit.as_const().is_some() && matches!(step, Step::Constant(_));
        if is_certain && !is_followed(dialect, Part::LimitOfType) {
            let system = dialect.name().to_ascii_uppercase();
            let message =
                format!("on {system} this loop does not end: its counter cannot pass the limit of {}", ty.name());
            let lint =
                Diagnostic::new(Code::W0614, to.span, message).label("in Staunch, the loop ends after this value");
            self.report(lint.help("count in a wider type, or leave the loop with EXIT after its last turn"));
        }
    }

    /// A value of a type; and as it is computed, where that is a number which the type may not hold.
    fn value_and_wide(&mut self, expr: &ast::Expr<'s>, ty: Type) -> (Option<Expr>, Option<Expr>) {
        let Some(operand) = self.operand(expr, Some(ty)) else { return (None, None) };
        let wide = match &operand {
            Operand::Promoted(value, _) if value.as_const().is_none() => Some(value.clone()),
            Operand::Promoted(..) | Operand::Typed(_) | Operand::Integer(_) | Operand::Real { .. } => None,
        };
        (self.coerce(operand, ty, expr.span), wide)
    }

    /// A FOR whose limit or step is computed at more bits than its counter has: the number nearest to the limit is the limit. Where
    /// even the least value of the counter is beyond it, no turn runs.
    fn loop_to(&mut self, mut head: For, limit: Option<Expr>, step: Option<&Expr>, span: Span) -> Option<()> {
        let whole = head.last.ty.elementary().and_then(|it| it.repr().range());
        let wide = limit.zip(whole).filter(|(limit, (least, most))| {
            let known = self.known_range(limit);
            known.0 < *least || *most < known.1
        });
        let Some((wide, (least, most))) = wide else { return self.loop_by(head, step, span) };
        let known = self.known_range(&wide);
        let mut nearest = wide.clone();
        let beyond = [(Op::Max, known.0 < least, least), (Op::Min, known.1 > most, most)];
        for (op, _, end) in beyond.into_iter().filter(|it| it.1) {
            let end = self.coerce(Operand::Integer(end), wide.ty, span)?;
            nearest = self.apply(op, wide.ty, vec![nearest, end], wide.ty, span)?;
        }
        head.last = stored(nearest, head.last.ty.elementary()?);
        let first = self.known_range(&head.first);
        let [below, above] = [known.0 < first.0.max(least) && first.0 == least, known.1 > most && first.1 == most];
        let may_be_beyond = match head.step {
            Step::Constant(step) if step > 0 => below,
            Step::Constant(_) => above,
            Step::Variable(_) => below || above,
        };
        if !may_be_beyond {
            return self.loop_by(head, step, span);
        }
        let condition = self.may_turn(&head, &wide, step, span)?;
        let otherwise = vec![Statement::assign(head.counter.clone(), head.first.clone(), self.at(span))];
        let mut looped = None;
        let then = self.nested(|this| looped = this.loop_by(head, step, span));
        looped?;
        self.push(StatementKind::If { condition, then, otherwise }, span);
        Some(())
    }

    /// Whether the first value is not beyond the limit; or the step is 0, which is a fault.
    fn may_turn(&mut self, head: &For, limit: &Expr, wide: Option<&Expr>, span: Span) -> Option<Expr> {
        let step = match &head.step {
            Step::Constant(step) => {
                let op = if *step > 0 { Op::Le } else { Op::Ge };
                return self.is_before(op, head, limit, span);
            }
            Step::Variable(step) => wide.unwrap_or(step).clone(),
        };
        let zero = self.coerce(Operand::Integer(0), step.ty, span)?;
        let mut holds = None;
        // Above 0 and up to the limit, below 0 and down to it, or 0.
        for (sign, side) in [(Op::Gt, Some(Op::Le)), (Op::Lt, Some(Op::Ge)), (Op::Eq, None)] {
            let mut part = self.apply(sign, step.ty, vec![step.clone(), zero.clone()], Type::BOOL, span)?;
            if let Some(op) = side {
                let before = self.is_before(op, head, limit, span)?;
                part = self.apply(Op::And, Type::BOOL, vec![part, before], Type::BOOL, span)?;
            }
            holds = Some(match holds {
                None => part,
                Some(before) => self.apply(Op::Or, Type::BOOL, vec![before, part], Type::BOOL, span)?,
            });
        }
        holds
    }

    fn loop_by(&mut self, head: For, step: Option<&Expr>, span: Span) -> Option<()> {
        match step {
            Some(step) => self.loop_by_wide_step(head, step, span),
            None => {
                let at = self.at(span);
                self.push(head.statement(at).kind, span);
                Some(())
            }
        }
    }

    fn counts(&self, ty: Elementary, span: Span) -> bool {
        ty.is_bits() && ty != Elementary::Bool && self.decl.dialect(span).mixes_bits_and_integers()
    }

    /// `wide` becomes the step as it is computed, where that is at more bits.
    fn step(&mut self, by: Option<&ast::Expr<'s>>, ty: Elementary, wide: &mut Option<Expr>) -> Option<Step> {
        let Some(by) = by else { return Some(Step::Constant(1)) };
        // A negative constant steps down, also for an unsigned counter.
        let operand = self.operand(by, Some(Type::Elementary(ty)))?;
        let constant = match &operand {
            Operand::Integer(value) => Some(*value),
            Operand::Typed(expr) | Operand::Promoted(expr, _) => expr.as_const().and_then(Value::as_integer),
            Operand::Real { .. } => None,
        };
        let (_, most) = ty.repr().range()?;
        match constant {
            Some(0) => {
                self.report(
                    Diagnostic::new(Code::E0509, by.span, "the step of a FOR loop is 0")
                        .label("the loop would never end"),
                );
                None
            }
            Some(step) if step.abs() <= most => Some(Step::Constant(step)),
            Some(_) | None => {
                if let Operand::Promoted(value, _) = &operand {
                    *wide = Some(value.clone());
                }
                self.coerce(operand, Type::Elementary(ty), by.span).map(Step::Variable)
            }
        }
    }
}

fn exit_if(condition: Expr, at: Location) -> Statement {
    let then = vec![Statement::new(StatementKind::Exit, at)];
    Statement::new(StatementKind::If { condition, then, otherwise: Vec::new() }, at)
}

/// Whether the statements hold an EXIT of this loop, or a RETURN.
fn has_way_out(statements: &[ast::Statement<'_>], own: bool) -> bool {
    use ast::StatementKind as Ast;
    let within = |body: &[ast::Statement<'_>]| has_way_out(body, own);
    statements.iter().any(|statement| match &statement.kind {
        Ast::Return | Ast::ReturnIf(_) | Ast::Jump(_) => true,
        Ast::Exit => own,
        Ast::If { branches, otherwise } => {
            branches.iter().any(|(_, body)| within(body)) || otherwise.as_deref().is_some_and(within)
        }
        Ast::Case { arms, otherwise, .. } => {
            arms.iter().any(|arm| within(&arm.body)) || otherwise.as_deref().is_some_and(within)
        }
        Ast::For { body, .. } | Ast::While { body, .. } | Ast::Repeat { body, .. } => has_way_out(body, false),
        Ast::Try(it) => {
            within(&it.body) || within(&it.handler) || it.finally.as_ref().is_some_and(|it| within(&it.body))
        }
        Ast::Empty
        | Ast::Assign { .. }
        | Ast::AssignAll { .. }
        | Ast::SetReset { .. }
        | Ast::SetResetAll { .. }
        | Ast::Bind { .. }
        | Ast::Attempt { .. }
        | Ast::Expr(_)
        | Ast::Continue
        | Ast::Label(_)
        | Ast::Error => false,
    })
}
