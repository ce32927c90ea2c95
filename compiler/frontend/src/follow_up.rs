//! Errors that follow from a construct that is refused by its name: what the base of a structure would declare is
//! not known, and that is said once, where the construct is.

use crate::diagnostic::{Code, Diagnostic};
use crate::source::{Sources, Span};

/// Takes out what follows from the constructs that are refused.
pub(crate) fn remove(sources: &Sources, diagnostics: &mut Vec<Diagnostic>) {
    let refused = diagnostics.iter().filter(|it| matches!(it.code, Code::E0090));
    let mut unknown = Unknown::default();
    refused.for_each(|it| unknown.add(sources, it.span));
    diagnostics.retain(|it| !unknown.explains(it));
}

/// What is not known, since what declares it was refused.
#[derive(Default)]
struct Unknown {
    /// POUs with a base: what they inherit may be named in them, and of their instances.
    heirs: Vec<Span>,
}

impl Unknown {
    fn add(&mut self, sources: &Sources, span: Span) {
        let word = sources.text(span).to_ascii_uppercase();
        let text = &sources.get(span.file).text;
        let start = usize::try_from(span.end).unwrap_or(usize::MAX).min(text.len());
        let rest = &text[start..];
        if word == "EXTENDS" || word == "IMPLEMENTS" {
            let length = rest.to_ascii_uppercase().find("END_FUNCTION_BLOCK").unwrap_or(rest.len());
            let end = u32::try_from(start + length).unwrap_or(u32::MAX);
            self.heirs.push(Span { end, ..span });
        }
    }

    fn explains(&self, diagnostic: &Diagnostic) -> bool {
        let span = diagnostic.span;
        let is_inside = |it: &Span| it.file == span.file && it.start <= span.start && span.end <= it.end;
        let is_of_a_member = matches!(diagnostic.code, Code::E0107 | Code::E0301);
        let is_of_a_name = is_of_a_member
            || matches!(
                diagnostic.code,
                Code::E0101 | Code::E0102 | Code::E0305 | Code::E0307 | Code::E0309 | Code::E0902
            );
        is_of_a_name && (self.heirs.iter().any(is_inside) || is_of_a_member && !self.heirs.is_empty())
    }
}
