//! Literals, as a person writes them, and paths of the runtime.

use proc_macro2::{Literal, TokenStream};
use quote::quote;
use staunch_ir::{Elementary, Repr, Value};
use staunch_runtime::calendar::Day;

use crate::names;
use crate::precedence::{Code, Level};

/// A literal as a person writes it; with its type's suffix where nothing else determines the type.
pub fn literal(ty: Elementary, value: Value, suffixed: bool) -> Code {
    let suffix = if suffixed { ty.repr().rust_name() } else { "" };
    match value {
        Value::Bool(it) => Code::postfix(quote!(#it)),
        Value::U8(it) if ty == Elementary::Char && it.is_ascii() => {
            let it = Literal::byte_character(it);
            Code::postfix(quote!(#it))
        }
        Value::I64(it) if ty.is_day() && Day::at(it).start() == Some(it) => date(it),
        Value::I64(it) if ty.is_time() => time(it, suffix),
        Value::F32(it) => float(f64::from(it), format!("{it:?}"), u64::from(it.to_bits()), "f32", suffix),
        Value::F64(it) => float(it, format!("{it:?}"), it.to_bits(), "f64", suffix),
        Value::I8(_)
        | Value::I16(_)
        | Value::I32(_)
        | Value::I64(_)
        | Value::U8(_)
        | Value::U16(_)
        | Value::U32(_)
        | Value::U64(_) => integer(ty, value, suffix),
    }
}

fn integer(ty: Elementary, value: Value, suffix: &str) -> Code {
    let number = value.as_integer().expect("an integer repr");
    if ty.is_bits() && number > 9 {
        return unsigned(&format!("{number:#X}").replace("0X", "0x"), suffix);
    }
    if ty.repr().range().is_some_and(|(least, _)| number == least && number < 0) {
        let repr = names::ident(ty.repr().rust_name());
        return Code::postfix(quote!(#repr::MIN));
    }
    signed(number, suffix)
}

/// A number whose type the context knows.
pub fn signed(number: i128, suffix: &str) -> Code {
    let digits = grouped(number.unsigned_abs());
    let magnitude = unsigned(&digits, suffix).tokens;
    if number < 0 { Code::new(quote!(-#magnitude), Level::Unary) } else { Code::postfix(magnitude) }
}

/// `1_000_000`; four digits are alone.
fn grouped(number: u128) -> String {
    let digits = number.to_string();
    if digits.len() < 5 {
        return digits;
    }
    let mut grouped = String::new();
    for (at, digit) in digits.chars().enumerate() {
        if at > 0 && (digits.len() - at).is_multiple_of(3) {
            grouped.push('_');
        }
        grouped.push(digit);
    }
    grouped
}

fn unsigned(digits: &str, suffix: &str) -> Code {
    let text = if suffix.is_empty() { digits.to_owned() } else { format!("{digits}_{suffix}") };
    let literal: Literal = text.parse().expect("digits are a literal");
    Code::postfix(quote!(#literal))
}

fn time(nanoseconds: i64, suffix: &str) -> Code {
    if nanoseconds == 0 || nanoseconds % staunch_runtime::time::MILLISECOND != 0 {
        return integer(Elementary::Lint, Value::I64(nanoseconds), suffix);
    }
    let count = signed(i128::from(nanoseconds / staunch_runtime::time::MILLISECOND), "").tokens;
    Code::postfix(quote!(time::ms(#count)))
}

fn date(midnight: i64) -> Code {
    let Day { year, month, day } = Day::at(midnight);
    let [year, month, day] = [year, month, day].map(Literal::i64_unsuffixed);
    Code::postfix(quote!(time::date(#year, #month, #day)))
}

fn float(value: f64, text: String, bits: u64, repr: &str, suffix: &str) -> Code {
    let repr_name = names::ident(repr);
    if value.is_nan() {
        let bits = Literal::u64_unsuffixed(bits);
        return Code::postfix(quote!(#repr_name::from_bits(#bits)));
    }
    if value.is_infinite() {
        let name = names::ident(if value > 0.0 { "INFINITY" } else { "NEG_INFINITY" });
        return Code::postfix(quote!(#repr_name::#name));
    }
    let magnitude = unsigned(text.trim_start_matches('-'), suffix).tokens;
    if text.starts_with('-') { Code::new(quote!(-#magnitude), Level::Unary) } else { Code::postfix(magnitude) }
}

/// The type whose literals are plain numbers in `repr`.
pub fn plain(repr: Repr) -> Elementary {
    match repr {
        Repr::Bool => Elementary::Bool,
        Repr::I8 => Elementary::Sint,
        Repr::I16 => Elementary::Int,
        Repr::I32 => Elementary::Dint,
        Repr::I64 => Elementary::Lint,
        Repr::U8 => Elementary::Usint,
        Repr::U16 => Elementary::Uint,
        Repr::U32 => Elementary::Udint,
        Repr::U64 => Elementary::Ulint,
        Repr::F32 => Elementary::Real,
        Repr::F64 => Elementary::Lreal,
    }
}

/// A count or position, unsuffixed.
pub fn number(value: u64) -> Literal {
    Literal::u64_unsuffixed(value)
}

/// The path of a block's type, for a type or for an expression.
pub fn rust_path(path: &str, expression: bool) -> TokenStream {
    let path = if expression { path.replacen('<', "::<", 1) } else { path.to_owned() };
    path.parse().expect("the runtime's table holds Rust paths")
}
