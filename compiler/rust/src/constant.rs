//! Constants: initial values of any type.

use proc_macro2::TokenStream;
use quote::quote;
use staunch_ir::{ArrayId, BlockId, Chars, Const, Elementary, EnumId, FieldId, StructId, Type, Value};

use crate::emitter::Emitter;
use crate::literal::{literal, number, rust_path};
use crate::names;
use crate::precedence::Code;
use crate::text;

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
    let (head, units) = (text::head(ty), text::units(text));
    quote!(#head::new(#units))
}
