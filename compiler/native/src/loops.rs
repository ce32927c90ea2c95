//! Loops. What decides whether there is a further turn is in front of the loop and again at
//! its end, so that a turn costs one branch.

use crate::control::{Control, Known, Running};
use crate::function::{Flow, Function, LocalSlot, LoopFrame};
use crate::place::PlaceValue;
use crate::signature::clif_type;
use cranelift_codegen::ir::{self as clif, InstBuilder, condcodes::IntCC, types};
use cranelift_frontend::Variable;
use staunch_ir::loops::{exit_condition, running};
use staunch_ir::{Block, Count, Expr, ExprKind, FaultKind, For, Location, Place, Repr, Root, Statement, Step, Value};

/// Conditions of more operations than this are there once, and the loop's end jumps to them.
const SMALL: usize = 8;

impl<'p> Function<'_, 'p> {
    pub(crate) fn turns(
        &mut self,
        body: &'p Block,
        continuing: &'p Block,
        count: Option<&'p Count>,
        at: Location,
    ) -> Flow {
        let opens = self.open_turns(&[body, continuing]);
        self.turning.push(self.repeats_of_loop(body, continuing, at));
        let (control, body) = match body.split_first() {
            Some((test, rest)) if let Some(leave) = exit_condition(test).filter(|it| is_small(it)) => {
                (Control::Unless(leave), rest)
            }
            _ => (Control::Always, &**body),
        };
        let known = count.map_or(Known::Nothing, Known::While);
        let flow = self.loop_under(&control, known, body, continuing);
        self.turning.pop();
        self.close_turns(opens, flow)
    }

    pub(crate) fn for_loop(&mut self, it: &'p For, at: Location) -> Flow {
        let whole = self.copied(it, at).or_else(|| self.block_at_once(it, at));
        if let Some(flow) = whole.or_else(|| self.looked_up_by_table(it, at)) {
            return flow;
        }
        let opens = self.open_turns(&[&it.body]);
        self.turning.push(self.repeats_of_for(it, at));
        let running = self.start_for(it, at);
        if let Some(register) = running.register {
            self.counters.push(it);
            self.registers.push(register);
        }
        let run = &mut |this: &mut Self| match this.in_lanes(&running).map_or_else(|| Err(this.unrolling(it)), Ok) {
            Ok(flow) => flow,
            Err(Some(unrolling)) => this.turns_in_line(&running, unrolling),
            Err(None) => this.loop_under(&Control::Count(running), Known::For(running), &it.body, &[]),
        };
        let flow = match running.late {
            Some(_) if self.endings > 0 => self.before_faults_pass(run, &mut |this| this.set_late(&running)),
            Some(_) | None => run(self),
        };
        self.turning.pop();
        if running.register.is_some() {
            self.registers.pop();
            self.counters.pop();
            if flow == Flow::Continues {
                self.set_late(&running);
            }
        }
        self.close_turns(opens, flow)
    }

    /// Gives the counter's variable what its register has.
    pub(crate) fn set_late(&mut self, running: &Running<'p>) {
        if let (Some(late), Some(register)) = (running.late, running.register) {
            let counter = self.builder.use_var(register);
            let counter = self.narrowed(running.repr, counter);
            self.builder.def_var(late, counter);
        }
    }

    pub(crate) fn start_for(&mut self, it: &'p For, at: Location) -> Running<'p> {
        let repr = self.module.program.repr(it.counter.ty).expect("verified IR: an integer counter");
        self.seen.forget_variables();
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
        let mut running = Running { it, repr, at, register: None, late: None, last, step };
        if it.is_private {
            let value = self.counter_value(&running);
            let register = self.builder.declare_var(types::I64);
            self.builder.def_var(register, value);
            running.register = Some(register);
            running.late = self.late(&it.counter);
        }
        running
    }

    /// The variable of a counter that is in a register while the loop runs, if nobody reads it on ways that leave the
    /// loop and all around: RETURN reads the result, and what handles a fault reads any.
    fn late(&self, counter: &Place) -> Option<Variable> {
        let Root::Local(id) = counter.root else { return None };
        let is_read = self.module.handles_faults || self.routine.result == Some(id);
        match self.locals[id.index()] {
            LocalSlot::Variable(variable) if counter.projections.is_empty() && !is_read => Some(variable),
            LocalSlot::Variable(_) | LocalSlot::Slot(_) => None,
        }
    }

    pub(crate) fn wide_scalar(&mut self, repr: Repr, value: &Expr) -> clif::Value {
        let value = self.scalar(value);
        self.widened(repr, value)
    }

    pub(crate) fn counter_value(&mut self, running: &Running<'p>) -> clif::Value {
        match running.register {
            Some(register) => self.builder.use_var(register),
            None => {
                let value = self.load_place(&running.it.counter);
                self.widened(running.repr, value)
            }
        }
    }

    pub(crate) fn last(&mut self, running: &Running<'p>) -> clif::Value {
        match (running.last, running.it.last.as_const().and_then(Value::as_integer)) {
            (Some(last), _) => last,
            (None, Some(last)) => self.integer(types::I64, last),
            (None, None) => unreachable!("verified IR: an integer"),
        }
    }

    /// A loop from its first turn on, whose block is open. Whether control continues after it.
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
            self.note_turn(control);
            if self.end_of_turn(control, continuing) == Flow::Continues {
                let end = self.natural_end(control, frame.after);
                self.further_turn(control, turn, end);
                self.leads_back(1);
                self.close_end(control, end, frame.after);
            }
        }
        self.builder.seal_block(turn);
        self.loops.pop().expect("pushed above").is_left
    }

    /// What ends a turn belongs to the loop's head.
    fn note_turn(&mut self, control: &Control<'p>) {
        match control {
            Control::Count(running) => self.note_statement(running.at),
            Control::Unless(leave) => self.note_statement(leave.at),
            Control::Always => {}
        }
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

    /// Where a loop ends whose counter is past its last value: there it steps back if it has left its type, which a register of 64
    /// bits lets it do.
    pub(crate) fn natural_end(&mut self, control: &Control<'p>, after: clif::Block) -> clif::Block {
        match control {
            Control::Count(running) if running.oversteps() || running.end().is_some() => self.builder.create_block(),
            Control::Count(_) | Control::Unless(_) | Control::Always => after,
        }
    }

    pub(crate) fn close_end(&mut self, control: &Control<'p>, end: clif::Block, after: clif::Block) {
        let Control::Count(running) = control else { return };
        if end == after {
            return;
        }
        self.go_on_in(end);
        if let Some(value) = running.end() {
            self.set_end(running, value);
            self.ins().jump(after, &[]);
            return;
        }
        let counter = self.counter_value(running);
        let Step::Constant(step) = running.it.step else { unreachable!("only constant steps are undone") };
        let range = running.it.range;
        let edge = self.integer(types::I64, if step > 0 { range.1 } else { range.0 });
        let counter = match step {
            // No other operation needs the counter before the step, so that it shares its register.
            1 => self.ins().smin(counter, edge),
            -1 => self.ins().smax(counter, edge),
            _ => {
                let is_out = if step > 0 { IntCC::SignedGreaterThan } else { IntCC::SignedLessThan };
                let is_out = self.ins().icmp(is_out, counter, edge);
                let step = self.integer(types::I64, step);
                let back = self.ins().isub(counter, step);
                self.ins().select(is_out, back, counter)
            }
        };
        self.set_counter(running, counter, true);
        self.ins().jump(after, &[]);
    }

    /// Gives the counter the value that it is known to have at the loop's end, so that nobody needs its register any more. Memory has it
    /// already.
    pub(crate) fn set_end(&mut self, running: &Running<'p>, value: i128) {
        let is_variable = matches!(self.place_value(&running.it.counter), PlaceValue::Variable(_));
        let value = self.integer(types::I64, value);
        self.set_counter(running, value, is_variable);
    }

    /// The counter's next value, in its register and in its storage.
    fn step(&mut self, running: &Running<'p>) {
        let counter = self.counter_value(running);
        if running.it.may_leave_range() && !running.oversteps() {
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
        self.set_counter(running, value, true);
    }

    /// Gives the counter a value of 64 bits, in its register and, if that is wanted, in its storage.
    pub(crate) fn set_counter(&mut self, running: &Running<'p>, value: clif::Value, is_stored: bool) {
        self.forget(&running.it.counter);
        if let Some(register) = running.register {
            self.builder.def_var(register, value);
        }
        if running.late.is_some() || !is_stored {
            return;
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
