//! From printed tokens to a file that reads well: source marks become comments, items get air.

use std::collections::BTreeSet;

use proc_macro2::{Delimiter, TokenStream, TokenTree};

/// A statement that stands for a comment: the printer of syntax trees has none.
const MARK: &str = "st_mark!(\"";

/// Formats items.
///
/// # Panics
/// If they are not Rust, which would be a bug in this crate.
pub fn format(items: TokenStream) -> String {
    let file = syn::parse2(items).expect("the emitted items are Rust");
    space(&comment(&prettyplease::unparse(&file)))
}

/// Puts each mark after the line that follows it.
fn comment(text: &str) -> String {
    let mut commented = String::with_capacity(text.len());
    let mut pending = None;
    for line in text.lines() {
        if let Some(mark) = line.trim_start().strip_prefix(MARK) {
            pending = Some(mark.trim_end_matches("\");"));
            continue;
        }
        commented.push_str(line);
        if let Some(mark) = pending.take() {
            commented.push_str(" // ");
            commented.push_str(mark);
        }
        commented.push('\n');
    }
    commented
}

/// Puts an empty line before each item and method that follows another.
fn space(text: &str) -> String {
    let mut spaced = String::with_capacity(text.len());
    let mut ended = false;
    for line in text.lines() {
        let content = line.trim_start();
        let depth = (line.len() - content.len()) / 4;
        let opens = content.starts_with("pub ")
            || content.starts_with("///")
            || content.starts_with("#[")
            || content.starts_with("fn ")
            || content.starts_with("impl ");
        if ended && opens && depth < 2 {
            spaced.push('\n');
        }
        spaced.push_str(line);
        spaced.push('\n');
        let is_comment = content.starts_with("//");
        ended = depth < 2 && !is_comment && (content == "}" || depth == 0 && content.ends_with([';', '}']));
    }
    spaced
}

/// What of the runtime the tokens name, in order.
pub fn imports(tokens: &TokenStream) -> Vec<String> {
    let mut found = BTreeSet::new();
    collect(tokens.clone(), &mut found);
    let (modules, types): (Vec<_>, Vec<_>) =
        found.into_iter().partition(|name| name.starts_with(|it: char| it.is_lowercase()));
    // rustfmt's order.
    types.into_iter().chain(modules).collect()
}

fn collect(tokens: TokenStream, found: &mut BTreeSet<String>) {
    let tokens: Vec<TokenTree> = tokens.into_iter().collect();
    for (at, token) in tokens.iter().enumerate() {
        match token {
            TokenTree::Group(group) => collect(group.stream(), found),
            TokenTree::Ident(ident) => {
                let name = ident.to_string();
                if is_type(&name) || is_module(&name) && path_starts(&tokens, at) {
                    found.insert(name);
                } else if name == "at" && is_method(&tokens, at) {
                    found.insert("OrFault".to_owned());
                }
            }
            TokenTree::Punct(_) | TokenTree::Literal(_) => {}
        }
    }
}

/// These names are kept from users' types.
fn is_type(name: &str) -> bool {
    matches!(name, "Context" | "Fault" | "FaultKind" | "Text" | "Time")
}

fn is_module(name: &str) -> bool {
    matches!(
        name,
        "firmware" | "ops" | "reference" | "text" | "time" | "iec" | "cscape" | "codesys" | "openplc" | "logix"
    )
}

fn is_method(tokens: &[TokenTree], at: usize) -> bool {
    let called = is_arguments(tokens.get(at + 1));
    called && at.checked_sub(1).and_then(|it| punct(tokens.get(it))) == Some('.')
}

/// Whether the identifier at `at` is the first of a path with several parts.
fn path_starts(tokens: &[TokenTree], at: usize) -> bool {
    let colons = |from: usize| (from..from + 2).all(|it| punct(tokens.get(it)) == Some(':'));
    colons(at + 1) && !at.checked_sub(2).is_some_and(colons)
}

fn punct(token: Option<&TokenTree>) -> Option<char> {
    match token {
        Some(TokenTree::Punct(punct)) => Some(punct.as_char()),
        Some(TokenTree::Group(_) | TokenTree::Ident(_) | TokenTree::Literal(_)) | None => None,
    }
}

fn is_arguments(token: Option<&TokenTree>) -> bool {
    matches!(token, Some(TokenTree::Group(group)) if group.delimiter() == Delimiter::Parenthesis)
}
