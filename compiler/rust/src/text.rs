//! The types of character strings, and their constants.

use proc_macro2::{Ident, Literal, TokenStream};
use quote::quote;
use staunch_ir::{Chars, StringType, Type};

use crate::literal::number;
use crate::names::ident;

/// `Text::<80>`.
pub fn typed_head(ty: Type) -> TokenStream {
    let (head, capacity) = (head(ty), number(u64::from(string_type(ty).capacity)));
    quote!(#head::<#capacity>)
}

/// `Text`, or `WideText`.
pub fn head(ty: Type) -> TokenStream {
    if string_type(ty).wide { quote!(WideText) } else { quote!(Text) }
}

/// The method of a string that shows its units.
pub fn as_units(ty: Type) -> Ident {
    let wide = ty.string_type().is_some_and(|it| it.wide);
    ident(if wide { "as_units" } else { "as_bytes" })
}

/// A constant as a slice: `b"abc"`, `&text::utf16!("abc")`.
pub fn units(text: &Chars) -> TokenStream {
    match text {
        Chars::Narrow(bytes) => {
            let bytes = Literal::byte_string(bytes);
            quote!(#bytes)
        }
        Chars::Wide(units) => match String::from_utf16(units) {
            // What turns the direction of writing is refused by rustc.
            Ok(text) if readable(&text) == text => quote!(&text::utf16!(#text)),
            Ok(_) | Err(_) => {
                let units = units.iter().map(|it| Literal::u16_unsuffixed(*it));
                quote!(&[#(#units),*])
            }
        },
    }
}

fn string_type(ty: Type) -> StringType {
    ty.string_type().expect("verified IR: a string has a string's type")
}

/// The text without what turns the direction of writing: rustc refuses it in comments.
pub fn readable(text: &str) -> String {
    text.replace(|it| matches!(it, '\u{202A}'..='\u{202E}' | '\u{2066}'..='\u{2069}'), "")
}
