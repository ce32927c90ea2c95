//! WHILE, REPEAT and FOR, as the one loop of the IR.

use super::Checker;
use super::operand::Operand;
use crate::{Code, Diagnostic, Span, ast};
use staunch_ir::{Block, Elementary, Expr, FaultKind, Location, Op, Place, Statement, StatementKind, Type, Value};

/// A FOR loop's step.
enum Step {
    /// Known now, and not 0.
    Constant(i128),
    /// In a temporary, tested for 0 before the loop.
    Variable(Expr),
}

/// A FOR loop's head.
struct Range {
    place: Place,
    running: Running,
    ty: Elementary,
    step: Step,
    stay: Expr,
    leave: Option<Expr>,
}

/// What a FOR loop counts in.
struct Running {
    place: Place,
    /// What the counter becomes at the start of a turn, where it is not what runs.
    enter: Option<Expr>,
}

impl<'s> Checker<'_, 's> {
    pub(super) fn while_loop(&mut self, condition: &ast::Expr<'s>, body: &[ast::Statement<'s>], span: Span) {
        let mut holds = None;
        let mut block = self.nested(|this| holds = this.condition(condition));
        let mut inside = self.loop_body(body);
        let Some(holds) = holds else { return };
        if holds.as_const() == Some(Value::Bool(true)) {
            self.refuse_to_end(body, condition.span);
        }
        let Some(leave) = self.exit_unless(holds, condition.span) else { return };
        block.push(leave);
        block.append(&mut inside);
        self.push(StatementKind::Loop { body: block, continuing: Vec::new() }, span);
    }

    pub(super) fn repeat_loop(&mut self, body: &[ast::Statement<'s>], until: &ast::Expr<'s>, span: Span) {
        let statements = body;
        let body = self.loop_body(body);
        let mut done = None;
        let mut continuing = self.nested(|this| done = this.condition(until));
        let Some(done) = done else { return };
        if done.as_const() == Some(Value::Bool(false)) {
            self.refuse_to_end(statements, until.span);
        }
        let at = self.at(until.span);
        continuing.push(exit_if(done, at));
        self.push(StatementKind::Loop { body, continuing }, span);
    }

    /// A loop whose condition never ends it needs a way out.
    fn refuse_to_end(&mut self, body: &[ast::Statement<'s>], span: Span) {
        if !has_way_out(body, true) {
            self.report(
                Diagnostic::new(Code::W0508, span, "this loop never ends")
                    .label("the condition is constant, and nothing leaves the loop")
                    .help("a scan has to come to its end: leave the loop with EXIT"),
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
        let Some(Range { place, running, ty, step, stay, leave }) = self.range(counter, from, to, by, span) else {
            // The body may hold mistakes of its own.
            self.loop_body(body);
            return None;
        };
        self.counters.push(place.clone());
        let mut inside = self.loop_body(body);
        self.counters.pop();
        let at = self.at(counter.span);
        let mut block = vec![self.exit_unless(stay, span)?];
        block.extend(running.enter.map(|value| Statement::assign(place, value, at)));
        block.append(&mut inside);
        let next = self.next_value(&running.place, ty, &step, span)?;
        let at = self.at(span);
        let mut continuing: Vec<_> = leave.map(|leave| exit_if(leave, at)).into_iter().collect();
        continuing.push(Statement::assign(running.place, next, at));
        self.push(StatementKind::Loop { body: block, continuing }, span);
        Some(())
    }

    /// Checks a FOR loop's head, and makes the statements before the loop.
    fn range(
        &mut self,
        counter: &ast::Expr<'s>,
        from: &ast::Expr<'s>,
        to: &ast::Expr<'s>,
        by: Option<&ast::Expr<'s>>,
        span: Span,
    ) -> Option<Range> {
        let found = self.place(counter);
        let Some(found) = found.filter(|it| self.writable(it, counter.span)) else {
            for part in [from, to].into_iter().chain(by) {
                self.operand(part, None);
            }
            return None;
        };
        let place = found.place;
        let ty = match place.ty.read() {
            Type::Elementary(it) if it.is_integer() || self.counts(it, counter.span) => it,
            other => {
                let name = self.type_name(other);
                self.report(
                    Diagnostic::new(
                        Code::E0201,
                        counter.span,
                        format!("the counter of a FOR loop is an integer, this is {name}"),
                    )
                    .label("expected an integer"),
                );
                return None;
            }
        };
        self.note_assigned(&place, counter.span);
        // Each part is checked, whatever is wrong with another.
        let first = self.value(from, place.ty);
        if let Some(first) = &first {
            self.assign(place.clone(), first.clone(), from.span);
        }
        let last = self.bound(to, ty);
        let step = self.step(by, ty, span);
        let (_, last, step) = (first?, last?, step?);
        let running = self.running(&place, counter.span)?;
        let (stay, leave) = self.loop_tests(&running.place, ty, &last, &step, span)?;
        Some(Range { place, running, ty, step, stay, leave })
    }

    /// A counter of a subrange cannot take the value that ends the loop, so another one runs.
    fn running(&mut self, place: &Place, span: Span) -> Option<Running> {
        if place.ty == place.ty.read() {
            return Some(Running { place: place.clone(), enter: None });
        }
        let at = self.at(span);
        let running = self.temporary("running", place.ty.read());
        self.assign(running.clone(), Expr::load(place.clone(), at).read(), span);
        let enter = self.coerce(Operand::Typed(Expr::load(running.clone(), at)), place.ty, span)?;
        Some(Running { place: running, enter: Some(enter) })
    }

    fn counts(&self, ty: Elementary, span: Span) -> bool {
        ty.is_bits() && ty != Elementary::Bool && self.decl.dialect(span).mixes_bits_and_integers()
    }

    /// A bound is evaluated once, before the loop.
    fn bound(&mut self, expr: &ast::Expr<'s>, ty: Elementary) -> Option<Expr> {
        let value = self.value(expr, Type::Elementary(ty))?;
        Some(self.once("last", value, expr.span))
    }

    fn once(&mut self, name: &str, value: Expr, span: Span) -> Expr {
        if value.as_const().is_some() {
            return value;
        }
        let at = value.at;
        let place = self.temporary(name, value.ty);
        self.assign(place.clone(), value, span);
        Expr::load(place, at)
    }

    fn step(&mut self, by: Option<&ast::Expr<'s>>, ty: Elementary, span: Span) -> Option<Step> {
        let Some(by) = by else { return Some(Step::Constant(1)) };
        // A negative constant steps down, also for an unsigned counter.
        let operand = self.operand(by, Some(Type::Elementary(ty)))?;
        let constant = match &operand {
            Operand::Integer(value) => Some(*value),
            Operand::Typed(expr) => expr.as_const().and_then(Value::as_integer),
            Operand::Real { .. } => None,
        };
        let (_, most) = ty.lane().range()?;
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
                let value = self.coerce(operand, Type::Elementary(ty), by.span)?;
                let step = self.once("step", value, by.span);
                let zero = self.number(0, ty, by.span)?;
                let at = self.at(by.span);
                let is_zero = self.apply(Op::Eq, step.ty, vec![step.clone(), zero], Type::BOOL, span)?;
                let fault = Statement::new(StatementKind::Fault(FaultKind::ZeroStep), at);
                self.push(StatementKind::If { condition: is_zero, then: vec![fault], otherwise: Vec::new() }, by.span);
                Some(Step::Variable(step))
            }
        }
    }

    fn number(&mut self, value: i128, ty: Elementary, span: Span) -> Option<Expr> {
        let at = self.at(span);
        Some(Expr::constant(ty, ty.lane().integer(value)?, at))
    }

    /// Whether to go on, and whether the next step would leave the counter's type.
    fn loop_tests(
        &mut self,
        place: &Place,
        ty: Elementary,
        last: &Expr,
        step: &Step,
        span: Span,
    ) -> Option<(Expr, Option<Expr>)> {
        let at = self.at(span);
        let counter = Expr::load(place.clone(), at);
        let (least, most) = ty.lane().range()?;
        let whole = Type::Elementary(ty);
        let test = |this: &mut Self, op, a: Expr, b: Expr| this.apply(op, whole, vec![a, b], Type::BOOL, span);
        match step {
            Step::Constant(step) if *step > 0 => {
                let stay = test(self, Op::Le, counter.clone(), last.clone())?;
                let never = last.as_const().and_then(Value::as_integer).is_some_and(|last| last + step <= most);
                let highest = self.number(most - step, ty, span)?;
                let leave = if never { None } else { Some(test(self, Op::Gt, counter, highest)?) };
                Some((stay, leave))
            }
            Step::Constant(step) => {
                let stay = test(self, Op::Ge, counter.clone(), last.clone())?;
                let never = last.as_const().and_then(Value::as_integer).is_some_and(|last| last + step >= least);
                let lowest = self.number(least - step, ty, span)?;
                let leave = if never { None } else { Some(test(self, Op::Lt, counter, lowest)?) };
                Some((stay, leave))
            }
            Step::Variable(step) => {
                let zero = self.number(0, ty, span)?;
                let (most, least) = (self.number(most, ty, span)?, self.number(least, ty, span)?);
                let up = test(self, Op::Gt, step.clone(), zero)?;
                let below = test(self, Op::Le, counter.clone(), last.clone())?;
                let above = test(self, Op::Ge, counter.clone(), last.clone())?;
                let stay = self.pick(&up, below, above, span)?;
                let highest = self.apply(Op::Sub, whole, vec![most, step.clone()], whole, span)?;
                let lowest = self.apply(Op::Sub, whole, vec![least, step.clone()], whole, span)?;
                let over = test(self, Op::Gt, counter.clone(), highest)?;
                let under = test(self, Op::Lt, counter, lowest)?;
                let leave = self.pick(&up, over, under, span)?;
                Some((stay, Some(leave)))
            }
        }
    }

    /// `up ? when_up : when_down`
    fn pick(&mut self, up: &Expr, when_up: Expr, when_down: Expr, span: Span) -> Option<Expr> {
        self.apply(Op::Sel, Type::BOOL, vec![up.clone(), when_down, when_up], Type::BOOL, span)
    }

    fn next_value(&mut self, place: &Place, ty: Elementary, step: &Step, span: Span) -> Option<Expr> {
        let at = self.at(span);
        let counter = Expr::load(place.clone(), at);
        let whole = Type::Elementary(ty);
        match step {
            Step::Constant(step) => {
                let op = if *step > 0 { Op::Add } else { Op::Sub };
                let distance = self.number(step.abs(), ty, span)?;
                self.apply(op, whole, vec![counter, distance], whole, span)
            }
            Step::Variable(step) => self.apply(Op::Add, whole, vec![counter, step.clone()], whole, span),
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
        Ast::Return => true,
        Ast::Exit => own,
        Ast::If { branches, otherwise } => {
            branches.iter().any(|(_, body)| within(body)) || otherwise.as_deref().is_some_and(within)
        }
        Ast::Case { arms, otherwise, .. } => {
            arms.iter().any(|arm| within(&arm.body)) || otherwise.as_deref().is_some_and(within)
        }
        Ast::For { body, .. } | Ast::While { body, .. } | Ast::Repeat { body, .. } => has_way_out(body, false),
        Ast::Empty | Ast::Assign { .. } | Ast::SetReset { .. } | Ast::Expr(_) | Ast::Continue | Ast::Error => false,
    })
}
