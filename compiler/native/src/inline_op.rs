//! The operations that are a few instructions: emitted in place, with the meaning of the
//! runtime's function. A test compares both over all edge values. An operation without a row here is a call.

use crate::function::Function;
use crate::operands::Operands;
use crate::signature::clif_type;
use crate::single_bit;
use cranelift_codegen::ir::condcodes::{FloatCC, IntCC};
use cranelift_codegen::ir::{InstBuilder, Value as Clif, types};
use staunch_ir::{Expr, FaultKind, Op, Program, Repr};

type Emit = fn(&mut Function<'_, '_>, &Operands) -> Clif;

const INLINE: &[(Op, Emit)] = &[
    (Op::Add, add),
    (Op::Sub, sub),
    (Op::Mul, mul),
    (Op::Div, div),
    (Op::Mod, modulo),
    (Op::Neg, neg),
    (Op::Abs, abs),
    (Op::Sqrt, |f, o| f.ins().sqrt(o.values[0])),
    (Op::And, |f, o| f.ins().band(o.values[0], o.values[1])),
    (Op::Or, |f, o| f.ins().bor(o.values[0], o.values[1])),
    (Op::Xor, |f, o| f.ins().bxor(o.values[0], o.values[1])),
    (Op::Not, not),
    (Op::Shl, shl),
    (Op::Shr, shr),
    // The instruction takes its count modulo the width as well.
    (Op::Rol, |f, o| f.ins().rotl(o.values[0], o.values[1])),
    (Op::Ror, |f, o| f.ins().rotr(o.values[0], o.values[1])),
    (Op::Advance, advance),
    (Op::Eq, |f, o| compare(f, o.repr, Order::Equal, o.values[0], o.values[1])),
    (Op::Ne, |f, o| compare(f, o.repr, Order::NotEqual, o.values[0], o.values[1])),
    (Op::Lt, |f, o| compare(f, o.repr, Order::Less, o.values[0], o.values[1])),
    (Op::Le, |f, o| compare(f, o.repr, Order::LessOrEqual, o.values[0], o.values[1])),
    (Op::Gt, |f, o| compare(f, o.repr, Order::Less, o.values[1], o.values[0])),
    (Op::Ge, |f, o| compare(f, o.repr, Order::LessOrEqual, o.values[1], o.values[0])),
    (Op::Max, max),
    (Op::Min, min),
    (Op::Limit, limit),
    (Op::Sel, |f, o| f.ins().select(o.values[0], o.values[2], o.values[1])),
    (Op::InRange, |f, o| within(f, o, FaultKind::SubrangeViolated)),
    (Op::CheckIndex, |f, o| within(f, o, FaultKind::IndexOutOfRange)),
];

/// What emits `op` in place.
pub(crate) fn find(op: Op) -> Option<Emit> {
    INLINE.iter().find(|(known, _)| *known == op).map(|(_, emit)| *emit)
}

/// The repr that the operation's row calls `T`.
pub(crate) fn repr(program: &Program, op: Op, operands: &[Expr]) -> Repr {
    let free = op.operands().iter().zip(operands).find(|(fixed, _)| fixed.is_none());
    let repr = free.and_then(|(_, operand)| program.repr(operand.ty));
    repr.expect("verified IR: operands have the operation's repr")
}

fn add(f: &mut Function<'_, '_>, o: &Operands) -> Clif {
    let (a, b) = (o.values[0], o.values[1]);
    if o.repr.is_float() { f.ins().fadd(a, b) } else { f.ins().iadd(a, b) }
}

fn sub(f: &mut Function<'_, '_>, o: &Operands) -> Clif {
    let (a, b) = (o.values[0], o.values[1]);
    if o.repr.is_float() {
        return f.ins().fsub(a, b);
    }
    // A constant is added, because Cranelift folds a chain of additions, as copies of a loop's body have them.
    let Some(constant) = o.constants[1].and_then(staunch_ir::Value::as_integer) else {
        return f.ins().isub(a, b);
    };
    let negated = f.integer(clif_type(o.repr), -constant);
    f.ins().iadd(a, negated)
}

fn mul(f: &mut Function<'_, '_>, o: &Operands) -> Clif {
    let (a, b) = (o.values[0], o.values[1]);
    if o.repr.is_float() { f.ins().fmul(a, b) } else { f.ins().imul(a, b) }
}

fn neg(f: &mut Function<'_, '_>, o: &Operands) -> Clif {
    let value = o.values[0];
    if o.repr.is_float() { f.ins().fneg(value) } else { f.ins().ineg(value) }
}

fn abs(f: &mut Function<'_, '_>, o: &Operands) -> Clif {
    let value = o.values[0];
    if o.repr.is_float() {
        return f.ins().fabs(value);
    }
    if !o.repr.is_signed() {
        return value;
    }
    let negated = f.ins().ineg(value);
    let is_negative = f.ins().icmp_imm_s(IntCC::SignedLessThan, value, 0);
    f.ins().select(is_negative, negated, value)
}

fn not(f: &mut Function<'_, '_>, o: &Operands) -> Clif {
    let value = o.values[0];
    if o.repr == Repr::Bool { f.ins().bxor_imm_u(value, 1) } else { f.ins().bnot(value) }
}

fn div(f: &mut Function<'_, '_>, o: &Operands) -> Clif {
    if o.repr.is_float() {
        return f.ins().fdiv(o.values[0], o.values[1]);
    }
    let division = Division::new(f, o);
    let quotient = division.quotient(f);
    division.narrowed(f, quotient)
}

fn modulo(f: &mut Function<'_, '_>, o: &Operands) -> Clif {
    let division = Division::new(f, o);
    let remainder = division.remainder(f);
    division.narrowed(f, remainder)
}

/// An integer division that cannot trap: the instruction does for a zero divisor, and for
/// `MIN / -1`, which small integers avoid by being divided at 32 bits.
struct Division {
    repr: Repr,
    /// By its type, or by what is known of the operands.
    is_unsigned: bool,
    a: Clif,
    b: Clif,
    /// At run time the divisor may be -1, with a dividend of the same width.
    may_overflow: bool,
}

impl Division {
    fn new(f: &mut Function<'_, '_>, o: &Operands) -> Self {
        let divisor = o.constants[1].and_then(staunch_ir::Value::as_integer);
        if divisor.is_none_or(|divisor| divisor == 0) {
            let is_zero = f.ins().icmp_imm_u(IntCC::Equal, o.values[1], 0);
            f.fault_if(is_zero, FaultKind::DivideByZero, o.at);
        }
        let is_small = o.repr.size() < 4;
        let is_unsigned = !o.repr.is_signed() || o.are_positive;
        let may_overflow = !is_unsigned && !is_small && divisor.is_none_or(|divisor| divisor == -1);
        let mut wide = |value| if is_small { extend(f, o.repr, value) } else { value };
        Self { repr: o.repr, is_unsigned, a: wide(o.values[0]), b: wide(o.values[1]), may_overflow }
    }

    fn quotient(&self, f: &mut Function<'_, '_>) -> Clif {
        if self.is_unsigned {
            return f.ins().udiv(self.a, self.b);
        }
        if !self.may_overflow {
            return f.ins().sdiv(self.a, self.b);
        }
        let (is_minus_one, divisor) = self.safe_divisor(f);
        let quotient = f.ins().sdiv(self.a, divisor);
        let negated = f.ins().ineg(self.a);
        f.ins().select(is_minus_one, negated, quotient)
    }

    fn remainder(&self, f: &mut Function<'_, '_>) -> Clif {
        if self.is_unsigned {
            return f.ins().urem(self.a, self.b);
        }
        if !self.may_overflow {
            return f.ins().srem(self.a, self.b);
        }
        // The remainder by 1 is that by -1: zero.
        let (_, divisor) = self.safe_divisor(f);
        f.ins().srem(self.a, divisor)
    }

    fn safe_divisor(&self, f: &mut Function<'_, '_>) -> (Clif, Clif) {
        let is_minus_one = f.ins().icmp_imm_s(IntCC::Equal, self.b, -1);
        let one = f.integer(clif_type(self.repr), 1);
        (is_minus_one, f.ins().select(is_minus_one, one, self.b))
    }

    fn narrowed(&self, f: &mut Function<'_, '_>, value: Clif) -> Clif {
        if self.repr.size() < 4 { f.ins().ireduce(clif_type(self.repr), value) } else { value }
    }
}

/// A small integer at 32 bits.
fn extend(f: &mut Function<'_, '_>, repr: Repr, value: Clif) -> Clif {
    if repr.is_signed() { f.ins().sextend(types::I32, value) } else { f.ins().uextend(types::I32, value) }
}

fn shl(f: &mut Function<'_, '_>, o: &Operands) -> Clif {
    shift(f, o, |f, value, count| f.ins().ishl(value, count))
}

fn shr(f: &mut Function<'_, '_>, o: &Operands) -> Clif {
    shift(f, o, |f, value, count| f.ins().ushr(value, count))
}

/// The instruction takes its count modulo the width; a count below zero or past the width is
/// decided around it.
fn shift(f: &mut Function<'_, '_>, o: &Operands, by: fn(&mut Function<'_, '_>, Clif, Clif) -> Clif) -> Clif {
    let (value, count) = (o.values[0], o.values[1]);
    let ty = clif_type(o.repr);
    let width = i64::from(ty.bits());
    if let Some(constant) = constant_count(f, o) {
        return match constant {
            ..=0 => value,
            it if it < i128::from(width) => by(f, value, count),
            _ => f.integer(ty, 0),
        };
    }
    let moved = by(f, value, count);
    let is_negative = f.ins().icmp_imm_s(IntCC::SignedLessThan, count, 0);
    let kept = f.ins().select(is_negative, value, moved);
    let is_past = f.ins().icmp_imm_s(IntCC::SignedGreaterThanOrEqual, count, width);
    let nothing = f.integer(ty, 0);
    f.ins().select(is_past, nothing, kept)
}

/// A count that is a constant, or the counter of a loop whose turns are there one by one.
fn constant_count(f: &Function<'_, '_>, o: &Operands) -> Option<i128> {
    let constant = o.constants[1].and_then(staunch_ir::Value::as_integer);
    constant.or_else(|| {
        let unused = 64 - f.builder.func.dfg.value_type(o.values[1]).bits().clamp(1, 64);
        let bits = f.known_bits(o.values[1])?;
        Some(i128::from((bits << unused).cast_signed() >> unused))
    })
}

/// The lower half advances by a distance, and wraps; the upper half stays.
fn advance(f: &mut Function<'_, '_>, o: &Operands) -> Clif {
    let (value, distance) = (o.values[0], o.values[1]);
    let ty = clif_type(o.repr);
    if ty == types::I64 {
        return f.advanced(value, distance);
    }
    let distance = f.ins().ireduce(ty, distance);
    let moved = f.ins().iadd(value, distance);
    let changed = f.ins().bxor(value, moved);
    let lower = f.integer(ty, (1 << (ty.bits() / 2)) - 1);
    let changed = f.ins().band(changed, lower);
    f.ins().bxor(value, changed)
}

#[derive(Clone, Copy, Debug)]
enum Order {
    Equal,
    NotEqual,
    Less,
    LessOrEqual,
}

/// A comparison in a repr's order; with a NaN only `NotEqual` holds.
fn compare(f: &mut Function<'_, '_>, repr: Repr, order: Order, a: Clif, b: Clif) -> Clif {
    if repr.is_float() {
        let condition = match order {
            Order::Equal => FloatCC::Equal,
            Order::NotEqual => FloatCC::NotEqual,
            Order::Less => FloatCC::LessThan,
            Order::LessOrEqual => FloatCC::LessThanOrEqual,
        };
        return f.ins().fcmp(condition, a, b);
    }
    let condition = match (order, repr.is_signed()) {
        (Order::Equal, _) => IntCC::Equal,
        (Order::NotEqual, _) => IntCC::NotEqual,
        (Order::Less, true) => IntCC::SignedLessThan,
        (Order::Less, false) => IntCC::UnsignedLessThan,
        (Order::LessOrEqual, true) => IntCC::SignedLessThanOrEqual,
        (Order::LessOrEqual, false) => IntCC::UnsignedLessThanOrEqual,
    };
    let bit = match order {
        Order::Equal | Order::NotEqual => single_bit::test(f, matches!(order, Order::Equal), a, b),
        Order::Less | Order::LessOrEqual => None,
    };
    bit.unwrap_or_else(|| f.ins().icmp(condition, a, b))
}

fn less(f: &mut Function<'_, '_>, repr: Repr, a: Clif, b: Clif) -> Clif {
    compare(f, repr, Order::Less, a, b)
}

// The instructions for the minimum and maximum of reals treat NaN and -0 otherwise.

fn max(f: &mut Function<'_, '_>, o: &Operands) -> Clif {
    let (a, b) = (o.values[0], o.values[1]);
    let is_less = less(f, o.repr, a, b);
    f.ins().select(is_less, b, a)
}

fn min(f: &mut Function<'_, '_>, o: &Operands) -> Clif {
    let (a, b) = (o.values[0], o.values[1]);
    let is_less = less(f, o.repr, b, a);
    f.ins().select(is_less, b, a)
}

fn limit(f: &mut Function<'_, '_>, o: &Operands) -> Clif {
    let (min, value, max) = (o.values[0], o.values[1], o.values[2]);
    let is_below = less(f, o.repr, value, min);
    let raised = f.ins().select(is_below, min, value);
    let is_above = less(f, o.repr, max, raised);
    f.ins().select(is_above, max, raised)
}

fn within(f: &mut Function<'_, '_>, o: &Operands, fault: FaultKind) -> Clif {
    let (min, value, max) = (o.values[0], o.values[1], o.values[2]);
    let is_below = less(f, o.repr, value, min);
    let is_above = less(f, o.repr, max, value);
    let is_outside = f.ins().bor(is_below, is_above);
    f.fault_if(is_outside, fault, o.at);
    value
}
