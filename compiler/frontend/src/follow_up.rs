//! Errors that follow from a construct that is refused by its name: what a PROPERTY or base class
//! would declare is not known, and that is said once, where the construct is.

use crate::diagnostic::{Code, Diagnostic};
use crate::source::{Sources, Span};
use rustc_hash::FxHashSet;

/// Constructs that declare names, with what ends them.
const DECLARING: [(&str, &str); 3] =
    [("PROPERTY", "END_PROPERTY"), ("INTERFACE", "END_INTERFACE"), ("CLASS", "END_CLASS")];

/// Takes out what follows from the constructs that are refused.
pub(crate) fn remove(sources: &Sources, diagnostics: &mut Vec<Diagnostic>) {
    let refused = diagnostics.iter().filter(|it| matches!(it.code, Code::E0090));
    let mut unknown = Unknown::default();
    refused.for_each(|it| unknown.add(sources, it.span));
    diagnostics.retain(|it| !unknown.explains(sources, it));
}

/// What is not known, since what declares it was refused.
#[derive(Default)]
struct Unknown {
    /// In capitals.
    names: FxHashSet<String>,
    /// POUs with a base: what they inherit may be named in them, and of their instances.
    heirs: Vec<Span>,
}

impl Unknown {
    fn add(&mut self, sources: &Sources, span: Span) {
        let word = sources.text(span).to_ascii_uppercase();
        let text = &sources.get(span.file).text;
        let start = usize::try_from(span.end).unwrap_or(usize::MAX).min(text.len());
        let rest = &text[start..];
        if let Some((_, end)) = DECLARING.iter().find(|(it, _)| word == *it) {
            let length = rest.to_ascii_uppercase().find(end).unwrap_or(rest.len());
            self.names.extend(words(&rest[..length]).map(str::to_ascii_uppercase));
        } else if word == "EXTENDS" || word == "IMPLEMENTS" {
            let length = rest.to_ascii_uppercase().find("END_FUNCTION_BLOCK").unwrap_or(rest.len());
            let end = u32::try_from(start + length).unwrap_or(u32::MAX);
            self.heirs.push(Span { end, ..span });
        }
    }

    fn explains(&self, sources: &Sources, diagnostic: &Diagnostic) -> bool {
        let span = diagnostic.span;
        let is_inside = |it: &Span| it.file == span.file && it.start <= span.start && span.end <= it.end;
        let is_of_a_member = matches!(diagnostic.code, Code::E0107 | Code::E0301);
        let is_of_a_name = is_of_a_member
            || matches!(
                diagnostic.code,
                Code::E0101 | Code::E0102 | Code::E0305 | Code::E0307 | Code::E0309 | Code::E0902
            );
        let name = words(sources.text(span)).next().unwrap_or_default().to_ascii_uppercase();
        is_of_a_name
            && (self.names.contains(&name)
                || self.heirs.iter().any(is_inside)
                || is_of_a_member && !self.heirs.is_empty())
    }
}

fn words(text: &str) -> impl Iterator<Item = &str> {
    text.split(|it: char| !it.is_alphanumeric() && it != '_').filter(|it| it.starts_with(|it: char| !it.is_numeric()))
}
