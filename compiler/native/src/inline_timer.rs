//! The steps of the timers, emitted in place and without branches, as those of the [counters](crate::inline_block).

use crate::address::Address;
use crate::function::Function;
use crate::members::Members;
use cranelift_codegen::ir::condcodes::IntCC;
use cranelift_codegen::ir::{InstBuilder, InstructionData, MemFlagsData, Opcode, Value as Clif, types};
use staunch_runtime::{BlockInfo, Context};

pub(crate) fn ton(f: &mut Function<'_, '_>, info: &'static BlockInfo, at: Address, inputs: &[Clif]) {
    let &[input, delay] = inputs else { unreachable!("verified IR: every input has a value") };
    f.store_pins(info, at, inputs);
    let mut step = Members { f, info, at };
    let rises = step.edge("in", input);
    let run = step.measure(rises, delay);
    let (q, et) = (step.load("q"), step.load("et"));
    let held = step.f.ins().band(input, q);
    let et = step.f.ins().select(held, et, run.elapsed);
    step.store_time_if(input, et);
    let ends = step.f.ins().bor(held, run.over);
    let q = step.f.ins().band(input, ends);
    step.store("q", q);
}

pub(crate) fn tof(f: &mut Function<'_, '_>, info: &'static BlockInfo, at: Address, inputs: &[Clif]) {
    let &[input, delay] = inputs else { unreachable!("verified IR: every input has a value") };
    f.store_pins(info, at, inputs);
    let mut step = Members { f, info, at };
    let before = step.load("in_before");
    let falls = step.f.ins().band_not(before, input);
    step.store("in_before", input);
    let run = step.measure(falls, delay);
    let (q, et) = (step.load("q"), step.load("et"));
    let et = step.f.ins().select(q, run.elapsed, et);
    let is_off = step.f.ins().bxor_imm_u(input, 1);
    step.store_time_if(is_off, et);
    let kept = step.f.ins().band_not(q, run.over);
    let q = step.f.ins().bor(input, kept);
    step.store("q", q);
}

pub(crate) fn tp(f: &mut Function<'_, '_>, info: &'static BlockInfo, at: Address, inputs: &[Clif]) {
    let &[input, delay] = inputs else { unreachable!("verified IR: every input has a value") };
    f.store_pins(info, at, inputs);
    let mut step = Members { f, info, at };
    let rises = step.edge("in", input);
    let (q, et) = (step.load("q"), step.load("et"));
    let begins = step.f.ins().band_not(rises, q);
    let run = step.measure(begins, delay);
    let pulse = step.f.ins().bor(rises, q);
    let et = step.f.ins().select(pulse, run.elapsed, et);
    let q = step.f.ins().band_not(pulse, run.over);
    step.store("q", q);
    let is_on = step.f.ins().bor(input, q);
    step.store_time_if(is_on, et);
}

/// How far a delay has run.
struct Run {
    /// At most the delay.
    elapsed: Clif,
    over: Clif,
}

impl Members<'_, '_, '_> {
    /// The time since it last started, which is now if `starts`.
    fn measure(&mut self, starts: Clif, delay: Clif) -> Run {
        let now = self.now();
        let start = self.load("start");
        let start = self.f.ins().select(starts, now, start);
        self.store("start", start);
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

    /// What has elapsed, or nothing.
    fn store_time_if(&mut self, condition: Clif, elapsed: Clif) {
        let zero = self.f.ins().iconst(types::I64, 0);
        let et = self.f.ins().select(condition, elapsed, zero);
        self.store("et", et);
    }
}
