//! Conversions between reprs, with the meaning of the runtime's `convert` and `trunc`.

use crate::function::Function;
use crate::signature::clif_type;
use crate::single_bit;
use cranelift_codegen::ir::condcodes::{FloatCC, IntCC};
use cranelift_codegen::ir::{InstBuilder, MemFlagsData, Type, Value as Clif, types};
use staunch_ir::Repr;

/// `ops::convert`.
pub(crate) fn convert(f: &mut Function<'_, '_>, value: Clif, from: Repr, to: Repr) -> Clif {
    match (from.is_float(), to.is_float()) {
        _ if from == to => value,
        _ if to == Repr::Bool => is_not_zero(f, value, from),
        (false, false) => resize(f, value, from, clif_type(to)),
        (false, true) => to_real(f, value, from, clif_type(to)),
        (true, false) => {
            let nearest = f.ins().nearest(value);
            saturate(f, nearest, to)
        }
        (true, true) if to == Repr::F64 => f.ins().fpromote(types::F64, value),
        (true, true) => f.ins().fdemote(types::F32, value),
    }
}

/// As [`convert`], for an integer of at most 64 bits with a sign that has been extended to so many.
pub(crate) fn from_wide(f: &mut Function<'_, '_>, value: Clif, from: Repr, to: Repr) -> Clif {
    let narrow = if from.size() < 4 { Repr::I32 } else { Repr::I64 };
    if to.is_float() && narrow == Repr::I32 {
        let value = f.ins().ireduce(types::I32, value);
        return convert(f, value, narrow, to);
    }
    convert(f, value, Repr::I64, to)
}

/// `ops::trunc`.
pub(crate) fn truncate(f: &mut Function<'_, '_>, value: Clif, from: Repr, to: Repr) -> Clif {
    if from.is_float() && to.is_integer() { saturate(f, value, to) } else { convert(f, value, from, to) }
}

/// `ops::same_bits`.
pub(crate) fn same_bits(f: &mut Function<'_, '_>, value: Clif, to: Repr) -> Clif {
    f.ins().bitcast(clif_type(to), MemFlagsData::new(), value)
}

/// NaN is not zero.
fn is_not_zero(f: &mut Function<'_, '_>, value: Clif, from: Repr) -> Clif {
    if from.is_float() {
        let zero = f.constant(from.zero());
        f.ins().fcmp(FloatCC::NotEqual, value, zero)
    } else {
        let zero = f.integer(clif_type(from), 0);
        single_bit::test(f, false, value, zero).unwrap_or_else(|| f.ins().icmp(IntCC::NotEqual, value, zero))
    }
}

/// The low bits, or the same number in more of them.
fn resize(f: &mut Function<'_, '_>, value: Clif, from: Repr, to: Type) -> Clif {
    match clif_type(from).bits().cmp(&to.bits()) {
        core::cmp::Ordering::Greater => f.ins().ireduce(to, value),
        core::cmp::Ordering::Equal => value,
        core::cmp::Ordering::Less if from.is_signed() => f.ins().sextend(to, value),
        core::cmp::Ordering::Less => f.ins().uextend(to, value),
    }
}

/// Of what fits a signed integer of 64 bits, one conversion gives the nearest.
fn to_real(f: &mut Function<'_, '_>, value: Clif, from: Repr, to: Type) -> Clif {
    if from == Repr::U64 {
        return f.ins().fcvt_from_uint(to, value);
    }
    let wide = if from == Repr::U32 || from == Repr::I64 { types::I64 } else { types::I32 };
    let value = resize(f, value, from, wide);
    f.ins().fcvt_from_sint(to, value)
}

/// The integer part, within the range of `to`; 0 for NaN.
fn saturate(f: &mut Function<'_, '_>, value: Clif, to: Repr) -> Clif {
    let ty = clif_type(to);
    if to.size() >= 4 {
        return if to.is_signed() { f.ins().fcvt_to_sint_sat(ty, value) } else { f.ins().fcvt_to_uint_sat(ty, value) };
    }
    // Small integers have no such instruction: the range is narrowed at 32 bits.
    let (low, high) = to.range().expect("an integer repr");
    let wide = f.ins().fcvt_to_sint_sat(types::I32, value);
    let low = f.integer(types::I32, low);
    let high = f.integer(types::I32, high);
    let is_below = f.ins().icmp(IntCC::SignedLessThan, wide, low);
    let raised = f.ins().select(is_below, low, wide);
    let is_above = f.ins().icmp(IntCC::SignedGreaterThan, raised, high);
    let narrow = f.ins().select(is_above, high, raised);
    f.ins().ireduce(ty, narrow)
}
