//! The steps of the most used standard blocks, emitted in place, all but timers without branches: a call and
//! its return cost as much as the step. Counts are computed at twice their bits where there are
//! such. A test drives each row here against the runtime's own step.

use crate::address::Address;
use crate::function::Function;
use crate::inline_timer::{tof, ton, tp};
use crate::members::Members;
use crate::target::Aim;
use cranelift_codegen::ir::condcodes::IntCC;
use cranelift_codegen::ir::{InstBuilder, Type, Value as Clif, types};
use staunch_ir::{Place, Repr};
use staunch_runtime::BlockInfo;

/// Stores the inputs and does the step.
type Emit = fn(&mut Function<'_, '_>, &'static BlockInfo, Address, &[Clif]);

/// By the instruction's symbol.
const INLINE: &[(&str, Emit)] = &[
    ("staunch_iec_ctu", ctu),
    ("staunch_iec_ctd", ctd),
    ("staunch_iec_ctud", ctud),
    ("staunch_iec_ctu_int", ctu),
    ("staunch_iec_ctd_int", ctd),
    ("staunch_iec_ctud_int", ctud),
    ("staunch_iec_ctu_dint", ctu),
    ("staunch_iec_ctd_dint", ctd),
    ("staunch_iec_ctud_dint", ctud),
    ("staunch_iec_ctu_lint", ctu),
    ("staunch_iec_ctd_lint", ctd),
    ("staunch_iec_ctud_lint", ctud),
    ("staunch_iec_ctu_udint", ctu),
    ("staunch_iec_ctd_udint", ctd),
    ("staunch_iec_ctud_udint", ctud),
    ("staunch_iec_ctu_ulint", ctu),
    ("staunch_iec_ctd_ulint", ctd),
    ("staunch_iec_ctud_ulint", ctud),
    ("staunch_codesys_ctu", ctu),
    ("staunch_codesys_ctd", ctd),
    ("staunch_codesys_ctud", ctud),
    ("staunch_codesys_lctu", ctu),
    ("staunch_codesys_lctd", ctd),
    ("staunch_codesys_lctud", ctud),
    ("staunch_openplc_ctu", ctu_that_stops),
    ("staunch_openplc_ctd", ctd_that_stops),
    ("staunch_openplc_ctud", ctud_that_stops),
    ("staunch_openplc_ctu_int", ctu_that_stops),
    ("staunch_openplc_ctd_int", ctd_that_stops),
    ("staunch_openplc_ctud_int", ctud_that_stops),
    ("staunch_openplc_ctu_dint", ctu_that_stops),
    ("staunch_openplc_ctd_dint", ctd_that_stops),
    ("staunch_openplc_ctud_dint", ctud_that_stops),
    ("staunch_openplc_ctu_lint", ctu_that_stops),
    ("staunch_openplc_ctd_lint", ctd_that_stops),
    ("staunch_openplc_ctud_lint", ctud_that_stops),
    ("staunch_openplc_ctu_udint", ctu_that_stops),
    ("staunch_openplc_ctd_udint", ctd_that_stops),
    ("staunch_openplc_ctud_udint", ctud_that_stops),
    ("staunch_openplc_ctu_ulint", ctu_that_stops),
    ("staunch_openplc_ctd_ulint", ctd_that_stops),
    ("staunch_openplc_ctud_ulint", ctud_that_stops),
    ("staunch_codesys_ctu_stop_at_pv", ctu_that_stops),
    ("staunch_codesys_lctu_stop_at_pv", ctu_that_stops),
    ("staunch_iec_ton", ton),
    ("staunch_iec_tof", tof),
    ("staunch_iec_tp", tp),
    ("staunch_iec_lton", ton),
    ("staunch_iec_ltof", tof),
    ("staunch_iec_ltp", tp),
    ("staunch_iec_r_trig", r_trig),
    ("staunch_iec_f_trig", f_trig),
    ("staunch_iec_sr", sr),
    ("staunch_iec_rs", rs),
    ("staunch_codesys_sr", sr),
    ("staunch_codesys_rs", rs),
];

/// What emits an instruction of the block at `place`.
pub(crate) fn find(place: &Place, instruction: usize, aim: Aim) -> Option<Emit> {
    if aim != Aim::Speed {
        return None;
    }
    let symbol = block_info(place).instructions[instruction].symbol;
    INLINE.iter().find(|(known, _)| *known == symbol).map(|(_, emit)| *emit)
}

fn ctu(f: &mut Function<'_, '_>, info: &'static BlockInfo, at: Address, inputs: &[Clif]) {
    f.store_pins(info, at, inputs);
    let mut step = Members { f, info, at };
    let up = step.edge("cu", inputs[0]);
    let cv = step.load_count("cv");
    let counted = step.count_up(cv, up);
    let cv = step.or_zero(inputs[1], counted);
    step.store_count("cv", cv);
    let pv = step.widen(inputs[2]);
    step.store_at_least("q", cv, pv);
}

fn ctd(f: &mut Function<'_, '_>, info: &'static BlockInfo, at: Address, inputs: &[Clif]) {
    f.store_pins(info, at, inputs);
    let mut step = Members { f, info, at };
    let down = step.edge("cd", inputs[0]);
    let cv = step.load_count("cv");
    let counted = step.count_down(cv, down);
    let pv = step.widen(inputs[2]);
    let cv = step.f.ins().select(inputs[1], pv, counted);
    step.store_count("cv", cv);
    step.store_not_positive("q", cv);
}

fn ctud(f: &mut Function<'_, '_>, info: &'static BlockInfo, at: Address, inputs: &[Clif]) {
    let &[_, _, r, ld, pv] = inputs else { unreachable!("verified IR: every input has a value") };
    f.store_pins(info, at, inputs);
    let mut step = Members { f, info, at };
    let up = step.edge("cu", inputs[0]);
    let down = step.edge("cd", inputs[1]);
    let cv = step.load_count("cv");
    let counted = step.count(cv, up, down);
    let pv = step.widen(pv);
    let loaded = step.f.ins().select(ld, pv, counted);
    let cv = step.or_zero(r, loaded);
    step.store_count("cv", cv);
    step.store_at_least("qu", cv, pv);
    step.store_not_positive("qd", cv);
}

fn ctu_that_stops(f: &mut Function<'_, '_>, info: &'static BlockInfo, at: Address, inputs: &[Clif]) {
    f.store_pins(info, at, inputs);
    let mut step = Members { f, info, at };
    let up = step.edge("cu", inputs[0]);
    let cv = step.load_count("cv");
    let pv = step.widen(inputs[2]);
    let counted = step.count_up_below(pv, cv, up);
    let cv = step.or_zero(inputs[1], counted);
    step.store_count("cv", cv);
    step.store_at_least("q", cv, pv);
}

fn ctd_that_stops(f: &mut Function<'_, '_>, info: &'static BlockInfo, at: Address, inputs: &[Clif]) {
    f.store_pins(info, at, inputs);
    let mut step = Members { f, info, at };
    let down = step.edge("cd", inputs[0]);
    let cv = step.load_count("cv");
    let counted = step.count_down_above_zero(cv, down);
    let pv = step.widen(inputs[2]);
    let cv = step.f.ins().select(inputs[1], pv, counted);
    step.store_count("cv", cv);
    step.store_not_positive("q", cv);
}

fn ctud_that_stops(f: &mut Function<'_, '_>, info: &'static BlockInfo, at: Address, inputs: &[Clif]) {
    let &[_, _, r, ld, pv] = inputs else { unreachable!("verified IR: every input has a value") };
    f.store_pins(info, at, inputs);
    let mut step = Members { f, info, at };
    let up = step.edge("cu", inputs[0]);
    let down = step.edge("cd", inputs[1]);
    let only_up = step.f.ins().band_not(up, down);
    let only_down = step.f.ins().band_not(down, up);
    let cv = step.load_count("cv");
    let pv = step.widen(pv);
    let raised = step.count_up_below(pv, cv, only_up);
    let counted = step.count_down_above_zero(raised, only_down);
    let loaded = step.f.ins().select(ld, pv, counted);
    let cv = step.or_zero(r, loaded);
    step.store_count("cv", cv);
    step.store_at_least("qu", cv, pv);
    step.store_not_positive("qd", cv);
}

fn r_trig(f: &mut Function<'_, '_>, info: &'static BlockInfo, at: Address, inputs: &[Clif]) {
    f.store_pins(info, at, inputs);
    let mut step = Members { f, info, at };
    let q = step.edge("clk", inputs[0]);
    step.store("q", q);
}

fn f_trig(f: &mut Function<'_, '_>, info: &'static BlockInfo, at: Address, inputs: &[Clif]) {
    f.store_pins(info, at, inputs);
    let mut step = Members { f, info, at };
    let before = step.load("clk_before");
    let q = step.f.ins().band_not(before, inputs[0]);
    step.store("clk_before", inputs[0]);
    step.store("q", q);
}

fn sr(f: &mut Function<'_, '_>, info: &'static BlockInfo, at: Address, inputs: &[Clif]) {
    f.store_pins(info, at, inputs);
    let mut step = Members { f, info, at };
    let q = step.load("q1");
    let kept = step.f.ins().band_not(q, inputs[1]);
    let q = step.f.ins().bor(inputs[0], kept);
    step.store("q1", q);
}

fn rs(f: &mut Function<'_, '_>, info: &'static BlockInfo, at: Address, inputs: &[Clif]) {
    f.store_pins(info, at, inputs);
    let mut step = Members { f, info, at };
    let q = step.load("q1");
    let set = step.f.ins().bor(inputs[0], q);
    let q = step.f.ins().band_not(set, inputs[1]);
    step.store("q1", q);
}

impl Members<'_, '_, '_> {
    fn repr(&self) -> Repr {
        self.pin("cv").repr()
    }

    /// Whether counts are computed at more bits than they have, where a step cannot overflow.
    fn has_room(&self) -> bool {
        self.repr().size() < 8
    }

    /// The type that counts are computed in.
    fn wide(&self) -> Type {
        if self.repr().size() < 4 { types::I32 } else { types::I64 }
    }

    fn widen(&mut self, value: Clif) -> Clif {
        let wide = self.wide();
        match (self.has_room(), self.repr().is_signed()) {
            (false, _) => value,
            (true, true) => self.f.ins().sextend(wide, value),
            (true, false) => self.f.ins().uextend(wide, value),
        }
    }

    fn load_count(&mut self, field: &str) -> Clif {
        let from = self.member(field);
        let (flags, base, displacement) = (self.f.reading(from), from.base, from.displacement());
        match (self.repr().size(), self.repr().is_signed()) {
            (2, true) => self.f.ins().sload16(types::I32, flags, base, displacement),
            (2, false) => self.f.ins().uload16(types::I32, flags, base, displacement),
            (4, true) => self.f.ins().sload32(flags, base, displacement),
            (4, false) => self.f.ins().uload32(flags, base, displacement),
            _ => self.load(field),
        }
    }

    fn store_count(&mut self, field: &str, value: Clif) {
        let to = self.member(field);
        self.f.store_low(self.repr(), value, to);
    }

    fn limits(&self) -> (i128, i128) {
        self.repr().range().expect("counts are integers")
    }

    /// `cv` and one more if `edge`, unless it is at its maximum.
    fn count_up(&mut self, cv: Clif, edge: Clif) -> Clif {
        let (_, max) = self.limits();
        if !self.has_room() {
            let step = self.unless_at(max, cv, edge);
            return self.f.ins().iadd(cv, step);
        }
        let step = self.number(edge);
        let next = self.f.ins().iadd(cv, step);
        self.at_most(max, next)
    }

    /// `cv` and one less if `edge`, unless it is at its minimum.
    fn count_down(&mut self, cv: Clif, edge: Clif) -> Clif {
        let (min, _) = self.limits();
        if !self.has_room() {
            let step = self.unless_at(min, cv, edge);
            return self.f.ins().isub(cv, step);
        }
        let step = self.number(edge);
        let next = self.f.ins().isub(cv, step);
        self.at_least(min, next)
    }

    /// `cv` and one more if `edge`, while it is less than `pv`.
    fn count_up_below(&mut self, pv: Clif, cv: Clif, edge: Clif) -> Clif {
        let step = self.step_while(IntCC::SignedLessThan, cv, pv, edge);
        self.f.ins().iadd(cv, step)
    }

    /// `cv` and one less if `edge`, while it is more than 0.
    fn count_down_above_zero(&mut self, cv: Clif, edge: Clif) -> Clif {
        let wide = self.wide();
        let zero = self.f.integer(wide, 0);
        let step = self.step_while(IntCC::SignedGreaterThan, cv, zero, edge);
        self.f.ins().isub(cv, step)
    }

    /// 1 for an edge while the condition holds, which is that of signed counts.
    fn step_while(&mut self, condition: IntCC, cv: Clif, limit: Clif, edge: Clif) -> Clif {
        let condition = if self.repr().is_signed() { condition } else { condition.unsigned() };
        let may_count = self.f.ins().icmp(condition, cv, limit);
        let counts = self.f.ins().band(edge, may_count);
        self.number(counts)
    }

    /// Both edges together leave the count alone, also at a limit.
    fn count(&mut self, cv: Clif, up: Clif, down: Clif) -> Clif {
        if !self.has_room() {
            let only_up = self.f.ins().band_not(up, down);
            let only_down = self.f.ins().band_not(down, up);
            let raised = self.count_up(cv, only_up);
            return self.count_down(raised, only_down);
        }
        let (min, max) = self.limits();
        let (up, down) = (self.number(up), self.number(down));
        let raised = self.f.ins().iadd(cv, up);
        let next = self.f.ins().isub(raised, down);
        let next = self.at_most(max, next);
        self.at_least(min, next)
    }

    fn number(&mut self, edge: Clif) -> Clif {
        let wide = self.wide();
        self.f.ins().uextend(wide, edge)
    }

    /// Counts with room for a step are in order as signed numbers, also those of an unsigned type.
    fn at_most(&mut self, max: i128, count: Clif) -> Clif {
        let wide = self.wide();
        let max = self.f.integer(wide, max);
        self.f.ins().smin(count, max)
    }

    fn at_least(&mut self, min: i128, count: Clif) -> Clif {
        let wide = self.wide();
        let min = self.f.integer(wide, min);
        self.f.ins().smax(count, min)
    }

    fn unless_at(&mut self, limit: i128, cv: Clif, edge: Clif) -> Clif {
        let wide = self.wide();
        let limit = self.f.integer(wide, limit);
        let may_count = self.f.ins().icmp(IntCC::NotEqual, cv, limit);
        let counts = self.f.ins().band(edge, may_count);
        self.f.ins().uextend(wide, counts)
    }

    fn or_zero(&mut self, condition: Clif, value: Clif) -> Clif {
        let wide = self.wide();
        let zero = self.f.integer(wide, 0);
        self.f.ins().select(condition, zero, value)
    }

    fn store_at_least(&mut self, field: &str, cv: Clif, pv: Clif) {
        let signed = self.repr().is_signed();
        let condition = if signed { IntCC::SignedGreaterThanOrEqual } else { IntCC::UnsignedGreaterThanOrEqual };
        let holds = self.f.ins().icmp(condition, cv, pv);
        self.store(field, holds);
    }

    fn store_not_positive(&mut self, field: &str, cv: Clif) {
        let signed = self.repr().is_signed();
        let condition = if signed { IntCC::SignedLessThanOrEqual } else { IntCC::UnsignedLessThanOrEqual };
        let wide = self.wide();
        let zero = self.f.integer(wide, 0);
        let holds = self.f.ins().icmp(condition, cv, zero);
        self.store(field, holds);
    }
}

pub(crate) fn block_info(place: &Place) -> &'static BlockInfo {
    match place.ty {
        staunch_ir::Type::Block(id) => id.info(),
        staunch_ir::Type::Elementary(_)
        | staunch_ir::Type::Reference(_)
        | staunch_ir::Type::Subrange(..)
        | staunch_ir::Type::String(_)
        | staunch_ir::Type::Enum(_)
        | staunch_ir::Type::Array(_)
        | staunch_ir::Type::Struct(_) => {
            unreachable!("verified IR: an instance of a standard block")
        }
    }
}
