//! Loops. What decides whether there is a further turn is in front of the loop and again at
//! its end, so that a turn costs one branch.

use crate::function::{Few, Flow, Function, LoopFrame};
use crate::place::PlaceValue;
use crate::signature::clif_type;
use crate::turns::{Size, Way};
use cranelift_codegen::ir::{self as clif, InstBuilder, condcodes::IntCC, types};
use cranelift_frontend::Variable;
use staunch_ir::loops::{exit_condition, running};
use staunch_ir::{Block, Count, Expr, ExprKind, FaultKind, For, Location, Repr, Statement, Step, Taking, Value};

/// Conditions of more operations than this are there once, and the loop's end jumps to them.
const SMALL: usize = 8;

/// What leads to a further turn.
pub(crate) enum Control<'p> {
    Count(Running<'p>),
    /// It leaves the loop.
    Unless(&'p Expr),
    Always,
}

/// A FOR loop that is being emitted. Values are of 64 bits.
#[derive(Clone, Copy)]
pub(crate) struct Running<'p> {
    it: &'p For,
    repr: Repr,
    at: Location,
    /// The counter, beside its storage, where nothing but the loop writes it.
    register: Option<Variable>,
    /// What is not constant.
    last: Option<clif::Value>,
    step: Option<clif::Value>,
}

impl<'p> Function<'_, 'p> {
    pub(crate) fn turns(&mut self, body: &'p Block, continuing: &'p Block, count: Option<&'p Count>) -> Flow {
        let opens = self.open_turns(&[body, continuing]);
        let (control, body) = match body.split_first() {
            Some((test, rest)) if let Some(leave) = exit_condition(test).filter(|it| is_small(it)) => {
                (Control::Unless(leave), rest)
            }
            _ => (Control::Always, &**body),
        };
        let is_tested = matches!(control, Control::Unless(_));
        let way = |this: &mut Self| count.map(|it| (it.taking, this.way_of_count(it, is_tested)));
        let flow = self.turns_under(&control, way, body, continuing);
        self.close_turns(opens, flow)
    }

    pub(crate) fn for_loop(&mut self, it: &'p For, at: Location) -> Flow {
        let opens = self.open_turns(&[&it.body]);
        let running = self.start_for(it, at);
        if let Some(register) = running.register {
            self.counters.push(it);
            self.registers.push(register);
        }
        let way = |this: &mut Self| (it.taking != Taking::Each).then(|| (it.taking, this.way_of_for(&running)));
        let flow = self.turns_under(&Control::Count(running), way, &it.body, &[]);
        if running.register.is_some() {
            self.registers.pop();
            self.counters.pop();
        }
        self.close_turns(opens, flow)
    }

    fn way_of_for(&mut self, running: &Running<'p>) -> Way {
        let (first, last) = (self.counter_value(running), self.last(running));
        let step = match (&running.it.step, running.step) {
            (_, Some(step)) => Size::Variable(step),
            (Step::Constant(step), None) => Size::Constant(*step),
            (Step::Variable(_), None) => unreachable!("a variable step is evaluated before the loop"),
        };
        Way { first, last, repr: running.repr, step, is_before: false, is_tested: true }
    }

    fn start_for(&mut self, it: &'p For, at: Location) -> Running<'p> {
        let repr = self.module.program.repr(it.counter.ty).expect("verified IR: an integer counter");
        self.assign(&it.counter, &it.first);
        let last = it.last.as_const().is_none().then(|| self.wide_scalar(repr, &it.last));
        let step = match &it.step {
            Step::Constant(_) => None,
            Step::Variable(step) => Some(self.wide_scalar(repr, step)),
        };
        if let Some(step) = step {
            let is_zero = self.ins().icmp_imm_u(IntCC::Equal, step, 0);
            self.fault_if(is_zero, FaultKind::ZeroStep, it.step_at);
        }
        let mut running = Running { it, repr, at, register: None, last, step };
        if it.is_private {
            let value = self.counter_value(&running);
            let register = self.builder.declare_var(types::I64);
            self.builder.def_var(register, value);
            running.register = Some(register);
        }
        running
    }

    pub(crate) fn wide_scalar(&mut self, repr: Repr, value: &Expr) -> clif::Value {
        let value = self.scalar(value);
        self.widened(repr, value)
    }

    fn counter_value(&mut self, running: &Running<'p>) -> clif::Value {
        match running.register {
            Some(register) => self.builder.use_var(register),
            None => {
                let value = self.load_place(&running.it.counter);
                self.widened(running.repr, value)
            }
        }
    }

    fn last(&mut self, running: &Running<'p>) -> clif::Value {
        match (running.last, running.it.last.as_const().and_then(Value::as_integer)) {
            (Some(last), _) => last,
            (None, Some(last)) => self.integer(types::I64, last),
            (None, None) => unreachable!("verified IR: an integer"),
        }
    }

    /// A loop, and what it takes before its first turn.
    fn turns_under(
        &mut self,
        control: &Control<'p>,
        way: impl FnOnce(&mut Self) -> Option<(Taking, Way)>,
        body: &'p [Statement],
        continuing: &'p [Statement],
    ) -> Flow {
        let [start, after] = [(); 2].map(|()| self.builder.create_block());
        self.further_turn(control, start, after);
        self.builder.switch_to_block(start);
        let is_left = match way(self) {
            None => self.first_turn_on(control, start, after, body, continuing),
            Some((Taking::EachOfMany, way)) => {
                self.builder.seal_block(start);
                let few = self.is_few(&way);
                self.each_of_many(control, few, after, body, continuing)
            }
            Some((taking, way)) => {
                self.builder.seal_block(start);
                if let Taking::Ahead(at) | Taking::AheadOfMany(at) = taking {
                    self.take_ahead(&way, taking.is_of_many(), at);
                }
                let turn = self.builder.create_block();
                self.ins().jump(turn, &[]);
                self.builder.switch_to_block(turn);
                self.first_turn_on(control, turn, after, body, continuing)
            }
        };
        self.join(&[if is_left { Flow::Continues } else { Flow::Leaves }], after)
    }

    /// Where `few` is true, a loop without turns; else one that takes them. A large body is there once.
    fn each_of_many(
        &mut self,
        control: &Control<'p>,
        few: clif::Value,
        after: clif::Block,
        body: &'p [Statement],
        continuing: &'p [Statement],
    ) -> bool {
        let [counted, free] = [(); 2].map(|()| self.builder.create_block());
        if !self.may_copy(body, continuing) {
            let [none, one] = [0, 1].map(|it| self.integer(types::I64, it));
            let taken = self.ins().select(few, none, one);
            self.ins().jump(counted, &[]);
            self.builder.switch_to_block(counted);
            let frame = LoopFrame { next: self.builder.create_block(), few: Few::Taken(taken), ..LoopFrame::to(after) };
            return self.one_by_one(control, frame, counted, body, continuing);
        }
        self.ins().brif(few, free, &[], counted, &[]);
        self.builder.switch_to_block(free);
        let frame = LoopFrame { next: self.builder.create_block(), few: Few::Yes, ..LoopFrame::to(after) };
        let is_left = self.one_by_one(control, frame, free, body, continuing);
        self.builder.switch_to_block(counted);
        self.first_turn_on(control, counted, after, body, continuing) || is_left
    }

    /// A loop from its first turn on, whose block is open and not sealed. Whether control goes on after it.
    fn first_turn_on(
        &mut self,
        control: &Control<'p>,
        turn: clif::Block,
        after: clif::Block,
        body: &'p [Statement],
        continuing: &'p [Statement],
    ) -> bool {
        if let Some(copies) = self.copies(body, continuing) {
            return self.turns_at_once(control, copies, [turn, after], body, continuing);
        }
        let frame = LoopFrame { next: self.builder.create_block(), ..LoopFrame::to(after) };
        self.one_by_one(control, frame, turn, body, continuing)
    }

    /// A loop from its first turn on, whose block is open. Whether control goes on after it.
    pub(crate) fn one_by_one(
        &mut self,
        control: &Control<'p>,
        frame: LoopFrame,
        turn: clif::Block,
        body: &'p [Statement],
        continuing: &'p [Statement],
    ) -> bool {
        self.loops.push(LoopFrame { is_left: !matches!(control, Control::Always), ..frame });
        if self.block(body) == Flow::Continues {
            self.continue_loop();
        }
        if self.innermost().is_continued {
            self.go_on_in(frame.next);
            if self.end_of_turn(control, continuing) == Flow::Continues {
                self.further_turn(control, turn, frame.after);
            }
        }
        self.builder.seal_block(turn);
        self.loops.pop().expect("pushed above").is_left
    }

    pub(crate) fn further_turn(&mut self, control: &Control<'p>, turn: clif::Block, after: clif::Block) {
        self.release_temporaries();
        match control {
            Control::Count(running) => {
                let (counter, last) = (self.counter_value(running), self.last(running));
                let past = self.is_past(running, running.repr == Repr::U64, counter, last);
                self.ins().brif(past, after, &[], turn, &[]);
            }
            Control::Unless(leave) => self.test(leave, after, turn),
            Control::Always => {
                self.ins().jump(turn, &[]);
            }
        }
    }

    pub(crate) fn end_of_turn(&mut self, control: &Control<'p>, continuing: &'p [Statement]) -> Flow {
        match control {
            Control::Count(running) => {
                self.step(running);
                Flow::Continues
            }
            Control::Unless(_) | Control::Always => self.block(continuing),
        }
    }

    /// Whether `value` is on the other side of `last`, in the direction of the step.
    fn is_past(&mut self, running: &Running<'p>, unsigned: bool, value: clif::Value, last: clif::Value) -> clif::Value {
        let (above, below) = if unsigned {
            (IntCC::UnsignedGreaterThan, IntCC::UnsignedLessThan)
        } else {
            (IntCC::SignedGreaterThan, IntCC::SignedLessThan)
        };
        match (&running.it.step, running.step) {
            (Step::Constant(step), _) => self.ins().icmp(if *step > 0 { above } else { below }, value, last),
            (Step::Variable(_), None) => unreachable!("a variable step is evaluated before the loop"),
            // An unsigned step leads up.
            (Step::Variable(_), Some(_)) if !running.repr.is_signed() => self.ins().icmp(above, value, last),
            (Step::Variable(_), Some(step)) => {
                let down = self.ins().icmp_imm_s(IntCC::SignedLessThan, step, 0);
                let (is_above, is_below) = (self.ins().icmp(above, value, last), self.ins().icmp(below, value, last));
                self.ins().select(down, is_below, is_above)
            }
        }
    }

    /// The counter's next value, in its register and in its storage.
    fn step(&mut self, running: &Running<'p>) {
        let counter = self.counter_value(running);
        if running.it.may_leave_range() {
            self.unless_out_of_range(running, counter);
        }
        let value = match (&running.it.step, running.step) {
            (_, Some(step)) => self.ins().iadd(counter, step),
            (Step::Constant(step), None) => {
                let step = self.integer(types::I64, *step);
                self.ins().iadd(counter, step)
            }
            (Step::Variable(_), None) => unreachable!("a variable step is evaluated before the loop"),
        };
        if let Some(register) = running.register {
            self.builder.def_var(register, value);
        }
        match self.place_value(&running.it.counter) {
            PlaceValue::Variable(variable) => {
                let value = self.narrowed(running.repr, value);
                self.builder.def_var(variable, value);
            }
            PlaceValue::Memory(address) => self.store_low(running.repr, value, address),
        }
    }

    /// Ends the loop, or faults, where the step would lead out of the counter's range; else flow on.
    fn unless_out_of_range(&mut self, running: &Running<'p>, counter: clif::Value) {
        let (it, repr) = (running.it, running.repr);
        let is_out = match &it.step {
            // From some value on, the step leads out; where that is not one of the range, always.
            Step::Constant(step) => {
                let edge = if *step > 0 { it.range.1 - step } else { it.range.0 - step };
                if (it.range.0..=it.range.1).contains(&edge) {
                    let edge = self.integer(types::I64, edge);
                    self.is_past(running, repr == Repr::U64, counter, edge)
                } else {
                    self.integer(types::I8, 1)
                }
            }
            Step::Variable(_) => {
                let next = self.exact_next(running, counter);
                let (least, most) = (self.exact(it.range.0), self.exact(it.range.1));
                let below = self.ins().icmp(IntCC::SignedLessThan, next, least);
                let above = self.ins().icmp(IntCC::SignedGreaterThan, next, most);
                self.ins().bor(below, above)
            }
        };
        let (out, stay) = (self.builder.create_block(), self.builder.create_block());
        let after = self.turn_end();
        if repr.range() == Some(it.range) {
            self.ins().brif(is_out, after, &[], stay, &[]);
        } else {
            self.ins().brif(is_out, out, &[], stay, &[]);
            self.go_on_in(out);
            let (next, last) = (self.exact_next(running, counter), self.last(running));
            let last = self.exactly(repr, last);
            let past = self.is_past(running, false, next, last);
            let fault = self.builder.create_block();
            self.ins().brif(past, after, &[], fault, &[]);
            self.go_on_in(fault);
            self.fault(FaultKind::SubrangeViolated, running.at);
        }
        self.go_on_in(stay);
    }

    /// The counter after the step, wide enough for any.
    fn exact_next(&mut self, running: &Running<'p>, counter: clif::Value) -> clif::Value {
        let counter = self.exactly(running.repr, counter);
        let step = match (&running.it.step, running.step) {
            (_, Some(step)) => self.exactly(running.repr, step),
            (Step::Constant(step), None) => self.exact(*step),
            (Step::Variable(_), None) => unreachable!("a variable step is evaluated before the loop"),
        };
        self.ins().iadd(counter, step)
    }

    fn exact(&mut self, value: i128) -> clif::Value {
        // What reaches beyond 64 bits is an unsigned number.
        match i64::try_from(value) {
            Ok(value) => {
                let value = self.ins().iconst(types::I64, value);
                self.ins().sextend(types::I128, value)
            }
            Err(_) => {
                let value = self.integer(types::I64, value);
                self.ins().uextend(types::I128, value)
            }
        }
    }

    fn exactly(&mut self, repr: Repr, value: clif::Value) -> clif::Value {
        if repr == Repr::U64 { self.ins().uextend(types::I128, value) } else { self.ins().sextend(types::I128, value) }
    }

    /// The counter of a loop that is running, at 64 bits, if `expr` is one.
    pub(crate) fn counter(&mut self, expr: &Expr) -> Option<clif::Value> {
        let ExprKind::Load(place) = &expr.kind else { return None };
        let register = self.registers[running(&self.counters, place)?];
        Some(self.builder.use_var(register))
    }

    pub(crate) fn widened(&mut self, repr: Repr, value: clif::Value) -> clif::Value {
        match (repr.size() == 8, repr.is_signed()) {
            (true, _) => value,
            (false, true) => self.ins().sextend(types::I64, value),
            (false, false) => self.ins().uextend(types::I64, value),
        }
    }

    pub(crate) fn narrowed(&mut self, repr: Repr, value: clif::Value) -> clif::Value {
        if repr.size() == 8 { value } else { self.ins().ireduce(clif_type(repr), value) }
    }

    pub(crate) fn innermost(&mut self) -> &mut LoopFrame {
        self.loops.last_mut().expect("verified IR: EXIT and CONTINUE are in a loop")
    }

    pub(crate) fn leave_loop(&mut self) -> Flow {
        let after = self.turn_end();
        self.go(after)
    }

    /// Where the innermost loop flow on that is left.
    pub(crate) fn turn_end(&mut self) -> clif::Block {
        let frame = self.innermost();
        frame.is_left = true;
        let (taken, after) = (frame.taken, frame.after);
        taken.map_or(after, |it| self.exit_after(it, after))
    }

    pub(crate) fn continue_loop(&mut self) -> Flow {
        let frame = self.innermost();
        frame.is_continued = true;
        let next = frame.next;
        self.go(next)
    }
}

fn is_small(condition: &Expr) -> bool {
    fn size(expr: &Expr) -> usize {
        match &expr.kind {
            ExprKind::Const(_) | ExprKind::Text(_) | ExprKind::Aggregate(_) => 0,
            // The call of the runtime for it is not repeated.
            ExprKind::Load(place) if place.is_followed() => SMALL,
            ExprKind::Load(place) => 1 + place.projections.len(),
            ExprKind::AddressOf(_) => SMALL,
            ExprKind::Apply(_, operands) => 1 + operands.iter().map(size).sum::<usize>(),
            ExprKind::ApplyText(..) => SMALL,
            ExprKind::Convert(_, operand) => 1 + size(operand),
        }
    }
    size(condition) <= SMALL
}
