//! Loops. What decides whether there is a further turn stands in front of the loop and again at
//! its end, so that a turn costs one branch.

use crate::function::{Function, Goes, Turn};
use crate::place::Site;
use crate::signature::clif_type;
use cranelift_codegen::ir::{self as clif, InstBuilder, condcodes::IntCC, types};
use cranelift_frontend::Variable;
use staunch_ir::counted::{Counted, exit_condition, running};
use staunch_ir::{Block, Expr, ExprKind, Lane, Statement, Value};

/// Conditions of more operations than this stand once, and the loop's end jumps to them.
const SMALL: usize = 8;

/// What leads to a further turn.
enum Control<'p> {
    /// The counter, also in a register of 64 bits.
    Count(Counted<'p>, Variable),
    /// It leaves the loop.
    Unless(&'p Expr),
    Always,
}

impl<'p> Function<'_, 'p> {
    pub(crate) fn turns(&mut self, block: &'p [Statement], at: usize, body: &'p Block, continuing: &'p Block) -> Goes {
        if let Some(counted) = Counted::find(self.unit.program, self.pou, block, at) {
            let register = self.counter_register(&counted);
            self.counters.push(counted);
            self.registers.push(register);
            let goes = self.turns_under(&Control::Count(counted, register), counted.body, &[]);
            self.registers.pop();
            self.counters.pop();
            return goes;
        }
        match body.split_first() {
            Some((test, rest)) if let Some(leave) = exit_condition(test).filter(|it| is_small(it)) => {
                self.turns_under(&Control::Unless(leave), rest, continuing)
            }
            _ => self.turns_under(&Control::Always, body, continuing),
        }
    }

    fn turns_under(&mut self, control: &Control<'p>, body: &'p [Statement], continuing: &'p [Statement]) -> Goes {
        let [turn, next, after] = [(); 3].map(|()| self.builder.create_block());
        self.further_turn(control, turn, after);
        self.builder.switch_to_block(turn);
        let is_left = !matches!(control, Control::Always);
        self.loops.push(Turn { next, after, is_continued: false, is_left });
        if self.block(body) == Goes::On {
            self.continue_loop();
        }
        if self.turn().is_continued {
            self.go_on_in(next);
            if self.end_of_turn(control, continuing) == Goes::On {
                self.further_turn(control, turn, after);
            }
        }
        self.builder.seal_block(turn);
        let is_left = self.loops.pop().expect("pushed above").is_left;
        self.join(&[if is_left { Goes::On } else { Goes::Away }], after)
    }

    fn further_turn(&mut self, control: &Control<'p>, turn: clif::Block, after: clif::Block) {
        match control {
            Control::Count(counted, register) => {
                let last = self.last(counted);
                self.unless_past(counted, *register, last, turn, after);
            }
            Control::Unless(leave) => self.test(leave, after, turn),
            Control::Always => {
                self.ins().jump(turn, &[]);
            }
        }
    }

    fn end_of_turn(&mut self, control: &Control<'p>, continuing: &'p [Statement]) -> Goes {
        match control {
            Control::Count(counted, register) => {
                self.step(counted, *register);
                Goes::On
            }
            Control::Unless(_) | Control::Always => self.block(continuing),
        }
    }

    fn counter_register(&mut self, counted: &Counted<'p>) -> Variable {
        let value = self.load_place(counted.counter);
        let value = self.widened(counted.lane, value);
        let register = self.builder.declare_var(types::I64);
        self.builder.def_var(register, value);
        register
    }

    /// The counter's next value, in its register and in its storage.
    fn step(&mut self, counted: &Counted<'p>, register: Variable) {
        if let Some(end) = counted.end {
            let end = self.integer(types::I64, end);
            let step = self.builder.create_block();
            let after = self.turn_end();
            self.unless_past(counted, register, end, step, after);
            self.go_on_in(step);
        }
        let value = self.builder.use_var(register);
        let value = self.ins().iadd_imm_s(value, counted.step);
        self.builder.def_var(register, value);
        match self.site(counted.counter) {
            Site::Variable(variable) => {
                let value = self.narrowed(counted.lane, value);
                self.builder.def_var(variable, value);
            }
            Site::Memory(address) => self.store_low(counted.lane, value, address),
        }
    }

    fn last(&mut self, counted: &Counted<'p>) -> clif::Value {
        match counted.last.as_const().and_then(Value::as_integer) {
            Some(last) => self.integer(types::I64, last),
            None => {
                let last = self.scalar(counted.last);
                self.widened(counted.lane, last)
            }
        }
    }

    fn unless_past(
        &mut self,
        counted: &Counted<'p>,
        register: Variable,
        last: clif::Value,
        stay: clif::Block,
        past: clif::Block,
    ) {
        let counter = self.builder.use_var(register);
        let condition = match (counted.step > 0, counted.lane) {
            (true, Lane::U64) => IntCC::UnsignedLessThanOrEqual,
            (true, _) => IntCC::SignedLessThanOrEqual,
            (false, Lane::U64) => IntCC::UnsignedGreaterThanOrEqual,
            (false, _) => IntCC::SignedGreaterThanOrEqual,
        };
        let stays = self.ins().icmp(condition, counter, last);
        self.ins().brif(stays, stay, &[], past, &[]);
    }

    /// The counter of a loop that is running, at 64 bits, if `expr` is one.
    pub(crate) fn counter(&mut self, expr: &Expr) -> Option<clif::Value> {
        let ExprKind::Load(place) = &expr.kind else { return None };
        let register = self.registers[running(&self.counters, place)?];
        Some(self.builder.use_var(register))
    }

    fn widened(&mut self, lane: Lane, value: clif::Value) -> clif::Value {
        match (lane.size() == 8, lane.is_signed()) {
            (true, _) => value,
            (false, true) => self.ins().sextend(types::I64, value),
            (false, false) => self.ins().uextend(types::I64, value),
        }
    }

    pub(crate) fn narrowed(&mut self, lane: Lane, value: clif::Value) -> clif::Value {
        if lane.size() == 8 { value } else { self.ins().ireduce(clif_type(lane), value) }
    }

    fn turn(&mut self) -> &mut Turn {
        self.loops.last_mut().expect("verified IR: EXIT and CONTINUE stand in a loop")
    }

    pub(crate) fn leave_loop(&mut self) -> Goes {
        let after = self.turn_end();
        self.go(after)
    }

    /// Where the innermost loop goes on that is left.
    fn turn_end(&mut self) -> clif::Block {
        let turn = self.turn();
        turn.is_left = true;
        turn.after
    }

    pub(crate) fn continue_loop(&mut self) -> Goes {
        let turn = self.turn();
        turn.is_continued = true;
        let next = turn.next;
        self.go(next)
    }
}

fn is_small(condition: &Expr) -> bool {
    fn size(expr: &Expr) -> usize {
        match &expr.kind {
            ExprKind::Const(_) | ExprKind::Text(_) | ExprKind::Aggregate(_) => 0,
            ExprKind::Load(place) => 1 + place.projections.len(),
            ExprKind::Apply(_, operands) => 1 + operands.iter().map(size).sum::<usize>(),
            ExprKind::ApplyText(..) => SMALL,
            ExprKind::Convert(_, operand) => 1 + size(operand),
        }
    }
    size(condition) <= SMALL
}
