//! What the operations mean at the edges of each type.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use staunch_runtime::ops::*;
use staunch_runtime::time::{DAY, date};
use staunch_runtime::{Fault, FaultKind, Location, OrFault, Repr, Value};

macro_rules! for_integers {
    ($($T:ident)*; $test:ident) => { $($test::<$T>($T::MIN, $T::MAX, 0, 1);)* };
}

#[test]
fn integers_wrap_at_every_width() {
    fn test<T: Integer>(min: T, max: T, zero: T, one: T) {
        assert_eq!(add(max, one), min);
        assert_eq!(sub(min, one), max);
        assert_eq!(sub(zero, one), neg(one));
        assert_eq!(neg(min), min_negated(min, zero));
        assert_eq!(mul(max, add(one, one)), add(max, max));
    }
    fn min_negated<T: Integer>(min: T, zero: T) -> T {
        if min == zero { zero } else { min }
    }
    for_integers!(i8 i16 i32 i64 u8 u16 u32 u64; test);
    assert_eq!(neg(1_u8), 255);
    assert_eq!((abs(i32::MIN), abs(-5_i32), abs(200_u8)), (i32::MIN, 5, 200));
}

#[test]
fn integer_division_truncates_and_faults_at_zero() {
    fn test<T: Integer>(min: T, max: T, zero: T, one: T) {
        assert_eq!(div(max, zero), Err(FaultKind::DivideByZero));
        assert_eq!(modulo(min, zero), Err(FaultKind::DivideByZero));
        assert_eq!(div(min, one), Ok(min));
        assert_eq!(modulo(max, one), Ok(zero));
    }
    for_integers!(i8 i16 i32 i64 u8 u16 u32 u64; test);
    for (a, b, quotient, remainder) in [(7, 2, 3, 1), (-7, 2, -3, -1), (7, -2, -3, 1), (-7, -2, 3, -1)] {
        assert_eq!((div(a, b), modulo(a, b)), (Ok(quotient), Ok(remainder)));
    }
    assert_eq!((div(i64::MIN, -1), modulo(i64::MIN, -1)), (Ok(i64::MIN), Ok(0)));
    assert_eq!(div(u16::MAX, 2), Ok(32767));
}

#[test]
fn reals_are_ieee() {
    assert_eq!(div(-1.0_f64, 0.0), Ok(f64::NEG_INFINITY));
    assert!(div(0.0_f32, 0.0).unwrap().is_nan());
    assert_eq!(neg(0.0_f32).to_bits(), (-0.0_f32).to_bits());
    assert_eq!(abs(-0.0_f64).to_bits(), 0);
    assert_eq!(sqrt(2.0_f32), core::f32::consts::SQRT_2);
    assert!(sqrt(-1.0_f64).is_nan());
    assert_eq!(expt(-2.0_f64, 2.0), 4.0);
    assert_eq!((ln(1.0_f32), log(1000.0_f64), exp(0.0_f32)), (0.0, 3.0, 1.0));
    assert_eq!((sin(0.0_f32), cos(0.0_f64), tan(0.0_f32)), (0.0, 1.0, 0.0));
    assert_eq!((asin(1.0_f64), acos(1.0_f32)), (core::f64::consts::FRAC_PI_2, 0.0));
    assert_eq!(atan(1.0_f64), core::f64::consts::FRAC_PI_4);
}

#[test]
fn shifts_are_logical_and_rotations_take_any_count() {
    assert_eq!([-1, 0, 3, 7, 8, i64::MAX].map(|count| shl(0x0F_u8, count)), [0x0F, 0x0F, 0x78, 0x80, 0, 0]);
    assert_eq!([i64::MIN, 0, 3, 7, 8, 99].map(|count| shr(0xF0_u8, count)), [0xF0, 0xF0, 0x1E, 0x01, 0, 0]);
    assert_eq!([1, 15, 16].map(|count| shr(i16::MIN, count)), [0x4000, 1, 0]);
    assert_eq!((shl(1_i64, 63), shl(1_u64, 64)), (i64::MIN, 0));
    for count in [-17, -16, -9, -1, 0, 1, 8, 15, 16, 31, i64::MAX, i64::MIN] {
        let turned = count.rem_euclid(16) as u32;
        assert_eq!(rol(0x8001_u16, count), 0x8001_u16.rotate_left(turned));
        assert_eq!(ror(-3_i16, count), (-3_i16).rotate_right(turned));
    }
}

#[test]
fn bits_of_booleans_are_logic() {
    assert!(and(true, true) && or(true, false) && xor(true, false) && !xor(true, true) && not(false));
    assert_eq!((and(6_u8, 3), or(6_u16, 3), xor(6_u32, 3), not(0_i8)), (2, 7, 5, -1));
}

#[test]
fn comparison_is_unsigned_where_the_type_is() {
    assert!(gt(0x8000_u16, 1) && lt(i16::MIN, 1) && lt(false, true));
    assert!(ne(f32::NAN, f32::NAN) && !eq(f32::NAN, f32::NAN));
    assert!(!lt(f64::NAN, 0.0) && !ge(f64::NAN, 0.0) && !le(0.0, f64::NAN) && !gt(0.0, f64::NAN));
    assert!(eq(-0.0_f64, 0.0));
}

#[test]
fn selection_says_what_it_does_with_nan_and_zeros() {
    assert!(max(f32::NAN, 1.0).is_nan() && min(f32::NAN, 1.0).is_nan());
    assert_eq!((max(1.0, f32::NAN), min(1.0, f32::NAN)), (1.0, 1.0));
    assert!(max(-0.0_f64, 0.0).is_sign_negative() && min(0.0_f64, -0.0).is_sign_positive());
    assert_eq!((max(3_u8, 200), min(-3_i8, 2)), (200, -3));
    assert_eq!([-1, 0, 2, 3, 4].map(|value| limit(0, value, 3)), [0, 0, 2, 3, 3]);
    assert!(limit(0.0, f64::NAN, 1.0).is_nan());
    assert_eq!((sel(false, 1, 2), sel(true, 1, 2)), (1, 2));
    assert_eq!((in_range(1, 1, 3), in_range(1, 4, 3)), (Ok(1), Err(FaultKind::SubrangeViolated)));
}

#[test]
fn an_index_counts_from_the_lower_bound() {
    assert_eq!((index(-3, -3, 3), index(3, -3, 3)), (Ok(0), Ok(6)));
    assert_eq!(index(-4, -3, 3), Err(FaultKind::IndexOutOfRange));
    assert_eq!(index(i64::MAX, i64::MIN, 0), Err(FaultKind::IndexOutOfRange));
}

#[test]
fn reals_round_to_even_and_saturate() {
    for (real, whole) in [(0.5, 0), (1.5, 2), (2.5, 2), (3.5, 4), (-2.5, -2), (-0.5, 0), (2.4999, 2)] {
        assert_eq!(convert::<f64, i32>(real), whole);
        assert_eq!(convert::<f32, i16>(real as f32), whole as i16);
    }
    assert_eq!(convert::<f32, i8>(127.5), 127);
    assert_eq!((convert::<f64, i64>(1e30), convert::<f64, i64>(-1e30)), (i64::MAX, i64::MIN));
    assert_eq!((convert::<f32, u16>(-1.0), convert::<f32, u16>(f32::INFINITY)), (0, u16::MAX));
    assert_eq!((convert::<f64, i32>(f64::NAN), trunc::<f64, u8>(f64::NAN)), (0, 0));
    assert_eq!((trunc::<f64, i32>(2.9), trunc::<f64, i32>(-2.9), trunc::<f32, u8>(300.0)), (2, -2, 255));
}

#[test]
fn other_conversions_keep_low_bits_or_round() {
    assert_eq!((convert::<i32, u8>(-1), convert::<u16, i8>(0x180), convert::<i8, u64>(-1)), (255, -128, u64::MAX));
    assert_eq!(
        (convert::<i64, f32>(16_777_217), convert::<u64, f64>(u64::MAX)),
        (16_777_216.0, 18_446_744_073_709_551_616.0)
    );
    assert_eq!((convert::<bool, f32>(true), convert::<bool, i8>(true)), (1.0, 1));
    assert!(convert::<i16, bool>(256) && !convert::<f32, bool>(-0.0) && convert::<f32, bool>(f32::NAN));
    assert_eq!(convert::<f64, f32>(1e300), f32::INFINITY);
}

#[test]
fn conversions_by_repr_are_the_same() {
    assert_eq!(convert_value(Value::F32(2.5), Repr::I16), Value::I16(2));
    assert_eq!(convert_value(Value::I16(-1), Repr::U8), Value::U8(255));
    assert_eq!(convert_value(Value::Bool(true), Repr::F64), Value::F64(1.0));
    assert_eq!(trunc_value(Value::F64(-2.9), Repr::I64), Value::I64(-2));
    for repr in Repr::ALL {
        assert_eq!(convert_value(Value::U8(1), repr).repr(), repr);
    }
}

#[test]
fn a_fault_survives_its_code() {
    for kind in FaultKind::ALL {
        let fault = Err::<(), _>(kind).at(0xABCD, 0x12_3456, 0x789A).unwrap_err();
        assert_eq!(Fault::from_code(fault.code()), Some(fault));
    }
    let far = Fault { kind: FaultKind::ZeroStep, at: Location { file: 0, column: 0, line: u32::MAX } };
    assert_eq!(Fault::from_code(far.code()).unwrap().at.line, 0xFF_FFFF);
    assert_eq!(Fault::from_code(0), None);
}

#[test]
fn an_arithmetic_shift_keeps_the_sign() {
    for value in i8::MIN..=i8::MAX {
        for count in [0, 1, 3, 7] {
            assert_eq!(sar(value, count), value >> count, "{value} by {count}");
        }
        assert_eq!([-1, 8, i64::MAX].map(|count| sar(value, count)), [value, value >> 7, value >> 7]);
        let bits = value as u8;
        assert_eq!(sar(bits, 3), bits >> 3);
    }
}

#[test]
fn a_step_of_a_reference_stays_in_its_object() {
    let parts = |value: u64| (value >> 32, value as u32);
    for position in [0, 1, 0x001F_FFFF, 0x0020_0000, 0x7FFF_FFFF, u32::MAX] {
        for distance in [-0x8000_0000, -1, 0, 1, 0x7FFF_FFFF_i64] {
            let value = (7 << 32) | u64::from(position);
            assert_eq!(parts(advance(value, distance)), (7, position.wrapping_add(distance as u32)));
        }
    }
}

#[test]
fn dates_at_the_ends_of_what_they_can_say() {
    assert_eq!([0, -3, 1, 2].map(|unit| whole_units(-5, unit)), [-5, -5, -5, -3]);
    const DAY: i64 = 86_400_000_000_000;
    let first = start_of_day(i64::MIN);
    assert_eq!((first.rem_euclid(DAY), first.checked_sub(DAY)), (0, None));
}

#[test]
fn a_value_at_a_bound_stays_what_it_is() {
    let bits = |min: f64, value, max| limit(min, value, max).to_bits();
    assert_eq!(bits(0.0, -0.0, 1.0), (-0.0_f64).to_bits());
    assert_eq!(bits(-0.0, 0.0, 1.0), 0.0_f64.to_bits());
    assert_eq!(bits(-1.0, 0.0, -0.0), 0.0_f64.to_bits());
    assert_eq!(bits(-1.0, -0.0, 0.0), (-0.0_f64).to_bits());
}

#[test]
fn a_counter_that_has_not_passed_the_last_value_may_not_leave_its_range() {
    assert_eq!((step(5_i16, 1, 6, (0, 5)), step(5_i16, 1, 5, (0, 5))), (Err(FaultKind::SubrangeViolated), Ok(None)));
    assert_eq!((step(0_i16, -1, -1, (0, 5)), step(0_i16, -1, 0, (0, 5))), (Err(FaultKind::SubrangeViolated), Ok(None)));
    assert_eq!(
        (step(5_u8, 1, 6, (0, 5)), step(255_u8, 1, 255, (0, 255))),
        (Err(FaultKind::SubrangeViolated), Ok(None))
    );
}

#[test]
fn dates_are_of_their_day() {
    for (y, m, d) in [(1970, 1, 1), (1969, 12, 31), (2000, 2, 29), (2024, 12, 1), (1678, 1, 1), (2262, 4, 10)] {
        let midnight = date(y, m, d);
        for time in [midnight, midnight + 1, midnight + DAY - 1] {
            assert_eq!((year(time), month(time), day(time)), (y, m, d));
        }
    }
    assert_eq!((whole_units(-1, 10), whole_units(19, 10), whole_units(7, 1)), (-1, 1, 7));
    assert_eq!((whole_units(7, 0), whole_units(7, -3), whole_units(9, 2)), (7, 7, 4));
}
