//! Constants: literals, and initial values of any type.

use proc_macro2::{Literal, TokenStream};
use quote::quote;
use staunch_ir::{ArrayId, BlockId, Chars, Const, Elementary, EnumId, FieldId, Repr, StructId, Type, Value};

use staunch_runtime::calendar::Day;

use crate::emitter::Emitter;
use crate::names;
use crate::precedence::{Code, Level};
use crate::string;

/// Arrays up to this length are written out where their elements differ.
const SHORT_ARRAY: u64 = 64;

impl Emitter<'_> {
    /// A constant where its type is known from the surroundings.
    pub fn constant(&self, ty: Type, value: &Const) -> Code {
        match (ty, value) {
            (Type::Elementary(it) | Type::Subrange(it, _), Const::Zero) => literal(it, it.repr().zero(), false),
            (Type::Elementary(it) | Type::Subrange(it, _), Const::Scalar(value)) => literal(it, *value, false),
            (Type::Enum(id), Const::Zero) => self.enum_value(id, self.program.enumeration(id).base.repr().zero()),
            (Type::Enum(id), Const::Scalar(value)) => self.enum_value(id, *value),
            (Type::String(_), Const::Text(text)) => Code::postfix(text_new(ty, text)),
            (Type::String(it), Const::Zero) => Code::postfix(text_new(ty, &Chars::empty(it))),
            (Type::Reference(_), Const::Scalar(value)) => literal(Elementary::Lword, *value, false),
            (Type::Reference(_), _) => literal(Elementary::Lword, Value::U64(0), false),
            (Type::Array(id), _) => self.array(id, value),
            (Type::Struct(id), _) => self.aggregate(id, value),
            (Type::Block(id), _) => Code::postfix(block(id, value)),
            (Type::Elementary(_) | Type::Subrange(..) | Type::Enum(_) | Type::String(_), _) => {
                unreachable!("verified IR: constants match their types")
            }
        }
    }

    /// A constant as what a variable of the type starts with.
    pub fn stored_constant(&self, ty: Type, value: &Const) -> TokenStream {
        let value = self.constant(ty, value).tokens;
        if self.is_in_cell(ty) { quote!(Cell::new(#value)) } else { value }
    }

    /// `Color::RED`, or `Color(7)` where no name has the value.
    pub fn enum_value(&self, id: EnumId, value: Value) -> Code {
        let name = self.names.enumeration(id);
        let values = &self.program.enumeration(id).values;
        match values.iter().position(|it| it.value == value) {
            Some(position) => {
                let constant = self.names.enumerator(id, position);
                Code::postfix(quote!(#name::#constant))
            }
            None => {
                let number = literal(self.program.enumeration(id).base, value, false).tokens;
                Code::postfix(quote!(#name(#number)))
            }
        }
    }

    fn array(&self, id: ArrayId, value: &Const) -> Code {
        let array = self.program.array(id);
        let runs = match value {
            Const::Array(runs) => merged(runs),
            Const::Zero => vec![(array.len(), &Const::Zero)],
            Const::Scalar(_) | Const::Text(_) | Const::Struct(_) => {
                unreachable!("verified IR: constants match their types")
            }
        };
        let element = |value: &Const| self.stored_constant(array.element, value);
        if let [(count, value)] = runs[..] {
            let (count, value) = (number(count), element(value));
            // What has cells inside is not copied.
            let value = if self.shared { quote!(const { #value }) } else { value };
            return Code::postfix(quote!([#value; #count]));
        }
        let runs_len = u64::try_from(runs.len()).unwrap_or(u64::MAX);
        if array.len() <= SHORT_ARRAY.max(runs_len.saturating_mul(2)) {
            let all = runs.iter().flat_map(|(count, value)| (0..*count).map(move |_| element(value)));
            return Code::postfix(quote!([#(#all),*]));
        }
        let longest = runs.iter().max_by_key(|(count, _)| *count).expect("an array has an element");
        let (len, filler) = (number(array.len()), element(longest.1));
        let filler = if self.shared { quote!(const { #filler }) } else { filler };
        let mut at = 0;
        let mut fills = Vec::new();
        for (count, value) in &runs {
            if *value != longest.1 {
                fills.push(fill(at, *count, &element(value)));
            }
            at += count;
        }
        Code::postfix(quote!(const { let mut array = [#filler; #len]; #(#fills)* array }))
    }

    fn aggregate(&self, id: StructId, value: &Const) -> Code {
        let name = self.names.structure(id);
        let fields = &self.program.structure(id).fields;
        let member = |at: usize| match value {
            Const::Struct(values) => &values[at],
            Const::Zero | Const::Scalar(_) | Const::Text(_) | Const::Array(_) => &Const::Zero,
        };
        let differs = |at: &usize| !self.same(fields[*at].ty, member(*at), &fields[*at].initial);
        let is_part = |at: &usize| !self.constants.contains(&(id, FieldId::next(*at)));
        let different: Vec<usize> = (0..fields.len()).filter(is_part).filter(differs).collect();
        let set = different.iter().map(|at| {
            let field = self.names.field(id, FieldId::next(*at));
            let value = self.stored_constant(fields[*at].ty, member(*at));
            quote!(#field: #value)
        });
        Code::postfix(if different.is_empty() {
            quote!(#name::new())
        } else if different.len() == (0..fields.len()).filter(is_part).count() {
            quote!(#name { #(#set),* })
        } else {
            quote!(#name { #(#set,)* ..#name::new() })
        })
    }

    /// Whether two constants of one type are the same value.
    pub fn same(&self, ty: Type, a: &Const, b: &Const) -> bool {
        match (ty, a, b) {
            (_, Const::Zero, Const::Zero) => true,
            (_, Const::Zero, other) | (_, other, Const::Zero) => is_zero(other),
            (_, Const::Scalar(a), Const::Scalar(b)) => same_bits(*a, *b),
            (_, Const::Text(a), Const::Text(b)) => a == b,
            (Type::Array(id), Const::Array(a), Const::Array(b)) => {
                let element = self.program.array(id).element;
                let (a, b) = (merged(a), merged(b));
                a.len() == b.len() && a.iter().zip(&b).all(|(a, b)| a.0 == b.0 && self.same(element, a.1, b.1))
            }
            (_, Const::Struct(a), Const::Struct(b)) => a.iter().zip(b).enumerate().all(|(at, (a, b))| {
                let member = self.program.member(ty, FieldId::next(at));
                member.is_some_and(|ty| self.same(ty, a, b))
            }),
            (_, Const::Scalar(_) | Const::Text(_) | Const::Array(_) | Const::Struct(_), _) => false,
        }
    }
}

/// Neighbouring runs of one value become one; empty runs go.
fn merged(runs: &[(u64, Const)]) -> Vec<(u64, &Const)> {
    let mut merged: Vec<(u64, &Const)> = Vec::new();
    for (count, value) in runs.iter().filter(|(count, _)| *count > 0) {
        match merged.last_mut() {
            Some((before, same)) if *same == value => *before += count,
            Some(_) | None => merged.push((*count, value)),
        }
    }
    merged
}

fn fill(start: u64, count: u64, value: &TokenStream) -> TokenStream {
    let (first, end) = (number(start), number(start + count));
    if count == 1 {
        return quote!(array[#first] = #value;);
    }
    quote! {
        let mut at = #first;
        while at < #end {
            array[at] = #value;
            at += 1;
        }
    }
}

/// The all-zero start state of a block, with the pins that are not zero.
fn block(id: BlockId, value: &Const) -> TokenStream {
    let info = id.info();
    let start = block_new(info.rust_path);
    let Const::Struct(values) = value else { return start };
    let pins = values.iter().zip(info.pins).enumerate().filter(|(_, (value, _))| !is_zero(value));
    let set: Vec<TokenStream> = pins
        .map(|(at, (value, pin))| {
            let field = names::ident(pin.field);
            let (Some(Type::Elementary(ty)), Const::Scalar(value)) = (id.pin_type(FieldId::next(at)), value) else {
                unreachable!("verified IR: pins are elementary");
            };
            let value = literal(ty, *value, false).tokens;
            quote!(#field: #value)
        })
        .collect();
    if set.is_empty() {
        return start;
    }
    let ty = rust_path(info.rust_path, false);
    // A path in an expression has its generic arguments after `::`; here they follow from `start`.
    let ty = ty.into_iter().take_while(|it| it.to_string() != "<").collect::<TokenStream>();
    quote!(#ty { #(#set,)* ..#start })
}

fn block_new(path: &str) -> TokenStream {
    let path = rust_path(path, true);
    quote!(#path::new())
}

/// The path of a block's type, for a type or for an expression.
pub fn rust_path(path: &str, expression: bool) -> TokenStream {
    let path = if expression { path.replacen('<', "::<", 1) } else { path.to_owned() };
    path.parse().expect("the runtime's table holds Rust paths")
}

fn is_zero(value: &Const) -> bool {
    match value {
        Const::Zero => true,
        Const::Scalar(value) => same_bits(*value, value.repr().zero()),
        Const::Text(text) => text.is_empty(),
        Const::Array(runs) => runs.iter().all(|(_, value)| is_zero(value)),
        Const::Struct(values) => values.iter().all(is_zero),
    }
}

/// `-0.0` and `0.0` are different constants.
fn same_bits(a: Value, b: Value) -> bool {
    match (a, b) {
        (Value::F32(a), Value::F32(b)) => a.to_bits() == b.to_bits(),
        (Value::F64(a), Value::F64(b)) => a.to_bits() == b.to_bits(),
        (a, b) => a == b,
    }
}

fn text_new(ty: Type, text: &Chars) -> TokenStream {
    let (head, units) = (string::head(ty), string::units(text));
    quote!(#head::new(#units))
}

/// A literal as a person writes it; with its type's suffix where nothing else tells the type.
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
