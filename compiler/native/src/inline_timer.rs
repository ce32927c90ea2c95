//! The steps of the timers, emitted in place. A timer is idle, or has expired, in nearly all scans: so they branch, and such a
//! scan measures nothing.
//!
//! ```text
//! t(IN := a, PT := T#5s);       t.IN := a; t.PT := T#5s;
//!                               IF NOT a THEN t.Q := FALSE; t.ET := T#0s;
//!                               ELSE IF NOT t.in_before THEN t.start := now; END_IF
//!                                    IF NOT t.Q THEN t.ET := MIN(now - t.start, T#5s); t.Q := now - t.start >= T#5s; END_IF
//!                               END_IF
//!                               t.in_before := a;
//! ```
//!
//! It applies to every call. It may not assume that the members are as a call left them: a host may have written any.

use crate::address::Address;
use crate::function::Function;
use crate::members::Members;
use cranelift_codegen::ir::condcodes::IntCC;
use cranelift_codegen::ir::{self as clif, InstBuilder, InstructionData, MemFlagsData, Opcode, Value as Clif, types};
use staunch_runtime::{BlockInfo, Context};

pub(crate) fn ton(f: &mut Function<'_, '_>, info: &'static BlockInfo, at: Address, inputs: &[Clif]) {
    let &[input, delay] = inputs else { unreachable!("verified IR: every input has a value") };
    f.store_pins(info, at, inputs);
    let mut step = Members { f, info, at };
    let [on, off, rises, holds, runs, done] = step.blocks();
    step.f.ins().brif(input, on, &[], off, &[]);

    step.f.go_on_in(on);
    let before = step.load("in_before");
    step.store_bool("in_before", true);
    step.f.ins().brif(before, holds, &[], rises, &[]);
    step.start_in(rises, holds);
    step.f.go_on_in(holds);
    let q = step.load("q");
    step.f.ins().brif(q, done, &[], runs, &[]);
    step.f.go_on_in(runs);
    let run = step.measure(delay);
    step.store("et", run.elapsed);
    step.store("q", run.over);
    step.f.ins().jump(done, &[]);

    step.f.go_on_in(off);
    step.store_bool("in_before", false);
    step.store_bool("q", false);
    step.store_no_time();
    step.f.ins().jump(done, &[]);
    step.f.go_on_in(done);
}

pub(crate) fn tof(f: &mut Function<'_, '_>, info: &'static BlockInfo, at: Address, inputs: &[Clif]) {
    let &[input, delay] = inputs else { unreachable!("verified IR: every input has a value") };
    f.store_pins(info, at, inputs);
    let mut step = Members { f, info, at };
    let [on, off, falls, holds, runs, done] = step.blocks();
    step.f.ins().brif(input, on, &[], off, &[]);

    step.f.go_on_in(off);
    let before = step.load("in_before");
    step.store_bool("in_before", false);
    step.f.ins().brif(before, falls, &[], holds, &[]);
    step.start_in(falls, holds);
    step.f.go_on_in(holds);
    let q = step.load("q");
    step.f.ins().brif(q, runs, &[], done, &[]);
    step.f.go_on_in(runs);
    let run = step.measure(delay);
    step.store("et", run.elapsed);
    step.store_not("q", run.over);
    step.f.ins().jump(done, &[]);

    step.f.go_on_in(on);
    step.store_bool("in_before", true);
    step.store_bool("q", true);
    step.store_no_time();
    step.f.ins().jump(done, &[]);
    step.f.go_on_in(done);
}

pub(crate) fn tp(f: &mut Function<'_, '_>, info: &'static BlockInfo, at: Address, inputs: &[Clif]) {
    let &[input, delay] = inputs else { unreachable!("verified IR: every input has a value") };
    f.store_pins(info, at, inputs);
    let mut step = Members { f, info, at };
    let [idle, on, off, begins, runs, done] = step.blocks();
    let q = step.load("q");
    step.f.ins().brif(q, runs, &[], idle, &[]);

    step.f.go_on_in(idle);
    step.f.ins().brif(input, on, &[], off, &[]);
    step.f.go_on_in(on);
    let before = step.load("in_before");
    step.store_bool("in_before", true);
    step.f.ins().brif(before, done, &[], begins, &[]);
    step.start_in(begins, runs);
    step.f.go_on_in(runs);
    step.store("in_before", input);
    let run = step.measure(delay);
    let q = step.store_not("q", run.over);
    let is_on = step.f.ins().bor(input, q);
    let zero = step.f.ins().iconst(types::I64, 0);
    let et = step.f.ins().select(is_on, run.elapsed, zero);
    step.store("et", et);
    step.f.ins().jump(done, &[]);

    step.f.go_on_in(off);
    step.store_bool("in_before", false);
    step.store_no_time();
    step.f.ins().jump(done, &[]);
    step.f.go_on_in(done);
}

/// How far a delay has run.
struct Run {
    /// At most the delay.
    elapsed: Clif,
    over: Clif,
}

impl Members<'_, '_, '_> {
    fn blocks<const N: usize>(&mut self) -> [clif::Block; N] {
        core::array::from_fn(|_| self.f.builder.create_block())
    }

    /// A block that starts the timer, and leads to another.
    fn start_in(&mut self, block: clif::Block, then: clif::Block) {
        self.f.go_on_in(block);
        let now = self.now();
        self.store("start", now);
        self.f.ins().jump(then, &[]);
    }

    /// The time since it last started.
    fn measure(&mut self, delay: Clif) -> Run {
        let (now, start) = (self.now(), self.load("start"));
        let elapsed = self.f.ins().isub(now, start);
        let delay = self.not_negative(delay);
        let over = self.f.ins().icmp(IntCC::SignedGreaterThanOrEqual, elapsed, delay);
        let elapsed = self.f.ins().select(over, delay, elapsed);
        Run { elapsed, over }
    }

    /// The scan's time, which is a variable of the host's.
    fn now(&mut self) -> Clif {
        let context = self.f.start.context.expect("a function that calls timers gets the context");
        let offset = i32::try_from(Context::NOW_OFFSET).expect("a context is small");
        self.f.ins().load(types::I64, MemFlagsData::trusted(), context, offset)
    }

    fn not_negative(&mut self, delay: Clif) -> Clif {
        let dfg = &self.f.builder.func.dfg;
        let made_by = dfg.value_def(delay).inst().map(|it| &dfg.insts[it]);
        match made_by {
            Some(InstructionData::UnaryImm { opcode: Opcode::Iconst, imm }) if imm.bits() >= 0 => delay,
            _ => {
                let zero = self.f.ins().iconst(types::I64, 0);
                self.f.ins().smax(delay, zero)
            }
        }
    }

    fn store_bool(&mut self, field: &str, value: bool) {
        let value = self.f.ins().iconst(types::I8, i64::from(value));
        self.store(field, value);
    }

    fn store_not(&mut self, field: &str, value: Clif) -> Clif {
        let value = self.f.ins().bxor_imm_u(value, 1);
        self.store(field, value);
        value
    }

    fn store_no_time(&mut self) {
        let zero = self.f.ins().iconst(types::I64, 0);
        self.store("et", zero);
    }
}
