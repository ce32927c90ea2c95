//! The names of the runtime that printed items use, for the imports at the top of the file.

use std::collections::BTreeSet;

use proc_macro2::TokenStream;
use quote::quote;

use crate::names::ident;

/// These names are kept from users' types.
const TYPES: [&str; 6] = ["Context", "Fault", "FaultKind", "Text", "Time", "WideText"];

const MODULES: [&str; 13] = [
    "exception",
    "firmware",
    "ops",
    "reference",
    "text",
    "time",
    "iec",
    "cscape",
    "codesys",
    "openplc",
    "openplc4",
    "s7",
    "logix",
];

/// The trait of `.at(…)`, which gives a fault its place.
const PLACE_OF_FAULT: &str = "OrFault";

#[derive(Debug, Default)]
pub struct Imports {
    types: BTreeSet<&'static str>,
    modules: BTreeSet<&'static str>,
}

impl Imports {
    /// Adds the names that a text uses, as the printer wrote it: its comments fill lines, and it has no characters in quotes.
    pub fn note(&mut self, printed: &str) {
        for line in printed.lines().filter(|it| !it.trim_start().starts_with("//")) {
            self.note_line(line);
        }
    }

    fn note_line(&mut self, line: &str) {
        let bytes = line.as_bytes();
        let mut at = 0;
        while let Some(byte) = bytes.get(at) {
            match byte {
                b'"' => at = end_of_string(bytes, at + 1),
                it if is_of_word(*it) => {
                    let length = bytes[at..].iter().take_while(|it| is_of_word(**it)).count();
                    self.note_word(&line[..at], &line[at..at + length], &line[at + length..]);
                    at += length;
                }
                _ => at += 1,
            }
        }
    }

    fn note_word(&mut self, before: &str, word: &str, after: &str) {
        if let Some(name) = TYPES.into_iter().find(|it| *it == word) {
            self.types.insert(name);
        } else if after.starts_with("::") && !before.ends_with("::") {
            self.modules.extend(MODULES.into_iter().find(|it| *it == word));
        } else if word == "st_strips" {
            self.modules.insert("strips");
        } else if word == "at" && before.ends_with('.') && after.starts_with('(') {
            self.types.insert(PLACE_OF_FAULT);
        }
    }

    /// The items that import them. Editions differ in whether types or modules come first: each has a group of its own.
    pub fn items(&self, runtime: &str) -> TokenStream {
        let runtime: syn::Path = syn::parse_str(runtime).expect("the runtime's path is a Rust path");
        let group = |names: &BTreeSet<&'static str>| {
            let names: Vec<_> = names.iter().map(|it| ident(it)).collect();
            match names.as_slice() {
                [] => None,
                [name] => Some(quote!(use #runtime::#name;)),
                names => Some(quote!(use #runtime::{#(#names),*};)),
            }
        };
        let (types, modules) = (group(&self.types), group(&self.modules));
        quote!(#types #modules)
    }
}

fn is_of_word(byte: u8) -> bool {
    byte.is_ascii_alphanumeric() || byte == b'_'
}

/// The place after the closing quotation mark of a string that begins at `start`; the line's end where it is not on it.
fn end_of_string(bytes: &[u8], start: usize) -> usize {
    let mut at = start;
    while let Some(byte) = bytes.get(at) {
        match byte {
            b'"' => return at + 1,
            b'\\' => at += 2,
            _ => at += 1,
        }
    }
    bytes.len()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_names_in_code_are_imported() {
        let mut imports = Imports::default();
        imports.note(
            "    // Text and time::now\n    /// exception::x\n    x.text = iec::s7::Fault(\"a \\\" ops::add\", time).at(1);\n    firmware::y.at;",
        );
        let items = imports.items("some::runtime").to_string();
        assert_eq!(items, "use some :: runtime :: { Fault , OrFault } ; use some :: runtime :: { firmware , iec } ;");
    }
}
