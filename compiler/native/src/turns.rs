//! The turns that the loops of a scan take. While a loop runs, what is left of them is a variable; the
//! context gets it back where others may look: at the loop's end, at RETURN, and around calls that take turns.
//! A loop whose bounds say how many it has takes them all before the first one.

use crate::function::{Flow, Function, LoopFrame};
use crate::prepaid::{Counter, Prepaid};
use cranelift_codegen::ir as clif;
use cranelift_codegen::ir::{InstBuilder, MemFlagsData, condcodes::IntCC, types};
use staunch_ir::alias::Frame;
use staunch_ir::loops::Known;
use staunch_ir::turns::{self, Ahead, Linear};
use staunch_ir::{Block, FaultKind, For, LocalId, Location, Repr, RoutineId, Statement, Step};
use staunch_runtime::Context;

impl<'p> Function<'_, 'p> {
    /// Before a loop, whose blocks may take turns. Returns whether it is the outermost that does.
    pub(crate) fn open_turns(&mut self, blocks: &[&Block]) -> bool {
        let opens = self.turns.is_none() && blocks.iter().any(|it| turns::takes_turns(it, &|_| false));
        if opens {
            let variable = self.builder.declare_var(types::I64);
            self.turns = Some(variable);
            self.reload_turns();
        }
        opens
    }

    pub(crate) fn close_turns(&mut self, opened: bool, flow: Flow) -> Flow {
        if opened {
            if flow == Flow::Continues {
                self.spill_turns();
            }
            self.turns = None;
        }
        flow
    }

    /// Tells the context how many turns are left.
    pub(crate) fn spill_turns(&mut self) {
        let Some(variable) = self.turns else { return };
        let (context, offset) = self.turns_place();
        let left = self.builder.use_var(variable);
        self.ins().store(MemFlagsData::trusted(), left, context, offset);
    }

    pub(crate) fn reload_turns(&mut self) {
        let Some(variable) = self.turns else { return };
        let (context, offset) = self.turns_place();
        let left = self.ins().load(types::I64, MemFlagsData::trusted(), context, offset);
        self.builder.def_var(variable, left);
    }

    fn turns_place(&self) -> (clif::Value, i32) {
        let context = self.start.context.expect("a function that takes turns gets the context");
        (context, i32::try_from(Context::TURNS_OFFSET).expect("a context is small"))
    }

    /// Takes one of the scan's turns.
    pub(crate) fn take_turn(&mut self, at: Location) {
        if let Some(taken) = self.loops.last_mut().and_then(|it| it.taken.as_mut()) {
            *taken += 1;
            return;
        }
        let variable = self.turns.expect("verified IR: a turn is a loop's");
        let left = self.builder.use_var(variable);
        // The rest is what is tested, so that it is found here, and not in a block of its own at the turn's end.
        let rest = self.ins().iadd_imm_s(left, -1);
        let was_none = self.ins().icmp_imm_s(IntCC::Equal, rest, -1);
        self.fault_if(was_none, FaultKind::LoopBudget, at);
        self.builder.def_var(variable, rest);
    }

    /// A FOR loop that takes its turns before the first one, and its step, which is constant.
    pub(crate) fn ahead(&self, it: &'p For) -> Option<(Ahead<'p>, i128)> {
        let takes_turns = |callee: RoutineId| self.module.effects(callee).turns;
        let Step::Constant(step) = it.step else { return None };
        Some((turns::ahead(it, &takes_turns)?, step))
    }

    pub(crate) fn linear(&self, body: &'p [Statement]) -> Option<Linear<'p>> {
        let program = self.module.program;
        let checked = |id: LocalId| self.checked[id.index()];
        let known = Known { program, loops: &self.counters, checked: &checked };
        let takes_turns = |callee: RoutineId| self.module.effects(callee).turns;
        turns::linear(&known, &Frame::of(program, self.routine), body, &takes_turns)
    }

    /// A WHILE loop that takes its turns before the first one.
    pub(crate) fn linear_loop(&mut self, it: &Linear<'p>) -> Flow {
        let [pay, turn, next, after] = [(); 4].map(|()| self.builder.create_block());
        self.release_temporaries();
        self.test(it.leave, after, pay);
        self.go_on_in(pay);
        let (prepaid, last) = self.pay_linear(it);
        self.ins().jump(turn, &[]);
        self.builder.switch_to_block(turn);
        self.loops.push(LoopFrame { next, is_left: true, prepaid: Some(prepaid), ..LoopFrame::to(after) });
        let (to_step, rest) = it.body.split_at(it.steps + 1);
        let mut flow = self.block(to_step);
        let prepaid = Prepaid { is_stepped: true, ..prepaid };
        self.innermost().prepaid = Some(prepaid);
        if flow == Flow::Continues {
            flow = self.block(rest);
        }
        if flow == Flow::Continues {
            self.release_temporaries();
            let end = self.builder.create_block();
            let stays = self.linear_holds(it, &prepaid);
            self.ins().brif(stays, turn, &[], end, &[]);
            self.go_on_in(end);
            self.end_linear(it, &prepaid, last);
            self.ins().jump(after, &[]);
        }
        self.builder.seal_block(turn);
        self.loops.pop();
        self.join(&[Flow::Continues], after)
    }

    fn pay_linear(&mut self, it: &Linear<'p>) -> (Prepaid<'p>, clif::Value) {
        let limit = self.builder.declare_var(types::I64);
        let repr = self.module.program.repr(it.counter.ty).expect("verified IR: an integer counter");
        let bound = self.wide_scalar(repr, it.bound);
        let offset = self.integer(types::I64, it.offset);
        let last = self.ins().iadd(bound, offset);
        let prepaid = Prepaid { counter: Counter::Variable(it.counter), limit, step: it.step, is_stepped: false };
        self.take_turns(&prepaid, last, it.at);
        (prepaid, last)
    }

    /// Whether there is a further turn, up to the limit.
    fn linear_holds(&mut self, it: &Linear<'p>, prepaid: &Prepaid<'p>) -> clif::Value {
        let repr = self.module.program.repr(it.counter.ty).expect("verified IR: an integer counter");
        let counter = self.prepaid_counter(prepaid);
        let limit = self.builder.use_var(prepaid.limit);
        let within = match (it.step > 0, repr == Repr::U64) {
            (true, true) => IntCC::UnsignedLessThanOrEqual,
            (true, false) => IntCC::SignedLessThanOrEqual,
            (false, true) => IntCC::UnsignedGreaterThanOrEqual,
            (false, false) => IntCC::SignedGreaterThanOrEqual,
        };
        let mut holds = self.ins().icmp(within, counter, limit);
        for other in &it.others {
            let other = self.scalar(other);
            holds = self.ins().band(holds, other);
        }
        holds
    }

    /// Where the turns did not suffice, the limit is before the last value.
    fn end_linear(&mut self, it: &Linear<'p>, prepaid: &Prepaid<'p>, last: clif::Value) {
        let [short, fault, end] = [(); 3].map(|()| self.builder.create_block());
        self.builder.set_cold_block(short);
        let limit = self.builder.use_var(prepaid.limit);
        let is_short = self.ins().icmp(IntCC::NotEqual, limit, last);
        self.ins().brif(is_short, short, &[], end, &[]);
        self.go_on_in(short);
        self.test(it.leave, end, fault);
        self.go_on_in(fault);
        self.fault(FaultKind::LoopBudget, it.at);
        self.go_on_in(end);
        if !it.others.is_empty() {
            self.give_back(Some(*prepaid));
        }
    }

    fn prepaid_counter(&mut self, prepaid: &Prepaid<'p>) -> clif::Value {
        match prepaid.counter {
            Counter::Register(register) => self.builder.use_var(register),
            Counter::Variable(place) => {
                let value = self.load_place(place);
                let repr = self.module.program.repr(place.ty).expect("verified IR: an integer counter");
                self.widened(repr, value)
            }
        }
    }

    /// Takes the turns from the counter, which is not past `last`, to `last`, or as many as there are.
    pub(crate) fn take_turns(&mut self, prepaid: &Prepaid<'p>, last: clif::Value, at: Location) {
        let turns = self.turns.expect("verified IR: a turn is a loop's");
        let left = self.builder.use_var(turns);
        let further = self.turns_to(prepaid, last);
        let suffice = self.ins().icmp(IntCC::UnsignedLessThan, further, left);
        let [all, some, go] = [(); 3].map(|()| self.builder.create_block());
        self.builder.set_cold_block(some);
        self.ins().brif(suffice, all, &[], some, &[]);

        self.go_on_in(all);
        let rest = self.ins().isub(left, further);
        let rest = self.ins().iadd_imm_s(rest, -1);
        self.builder.def_var(turns, rest);
        self.builder.def_var(prepaid.limit, last);
        self.ins().jump(go, &[]);

        self.go_on_in(some);
        let is_none = self.ins().icmp_imm_u(IntCC::Equal, left, 0);
        self.fault_if(is_none, FaultKind::LoopBudget, at);
        let further = self.ins().iadd_imm_s(left, -1);
        let step = self.integer(types::I64, prepaid.step);
        let way = self.ins().imul(further, step);
        let counter = self.prepaid_counter(prepaid);
        let limit = self.ins().iadd(counter, way);
        let none = self.integer(types::I64, 0);
        self.builder.def_var(turns, none);
        self.builder.def_var(prepaid.limit, limit);
        self.ins().jump(go, &[]);
        self.go_on_in(go);
    }

    /// How many turns come after the present one, up to `last`.
    fn turns_to(&mut self, prepaid: &Prepaid<'p>, last: clif::Value) -> clif::Value {
        let counter = self.prepaid_counter(prepaid);
        let way = if prepaid.step > 0 { self.ins().isub(last, counter) } else { self.ins().isub(counter, last) };
        match i128::try_from(prepaid.step.unsigned_abs()) {
            Ok(1) => way,
            Ok(size) => {
                let size = self.integer(types::I64, size);
                self.ins().udiv(way, size)
            }
            Err(_) => unreachable!("verified IR: a step is of the counter's type"),
        }
    }

    /// A loop that is left takes back the turns that it will not have.
    pub(crate) fn give_back(&mut self, prepaid: Option<Prepaid<'p>>) {
        let (Some(prepaid), Some(turns)) = (prepaid, self.turns) else { return };
        let limit = self.builder.use_var(prepaid.limit);
        let limit = if prepaid.is_stepped {
            let step = self.integer(types::I64, prepaid.step);
            self.ins().iadd(limit, step)
        } else {
            limit
        };
        let unused = self.turns_to(&prepaid, limit);
        let left = self.builder.use_var(turns);
        let left = self.ins().iadd(left, unused);
        self.builder.def_var(turns, left);
    }

    /// RETURN leaves all loops; one of them at most has taken its turns before.
    pub(crate) fn return_from_loops(&mut self) -> Flow {
        let prepaid = self.loops.iter().find_map(|it| it.prepaid);
        self.give_back(prepaid);
        let taken = self.loops.iter().filter_map(|it| it.taken).sum();
        self.subtract_turns(taken);
        self.spill_turns();
        self.go(self.exit)
    }
}
