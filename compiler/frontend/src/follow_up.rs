//! Errors that follow from a construct that is refused by its name: what the base of a structure would declare is
//! not known, and that is said once, where the construct is.

use crate::diagnostic::{Code, Diagnostic};
use crate::source::Sources;

/// Takes out what follows from the constructs that are refused.
pub(crate) fn remove(sources: &Sources, diagnostics: &mut Vec<Diagnostic>) {
    let is_base = |it: &Diagnostic| it.code == Code::E0090 && sources.text(it.span).eq_ignore_ascii_case("EXTENDS");
    if diagnostics.iter().any(is_base) {
        diagnostics.retain(|it| !matches!(it.code, Code::E0107 | Code::E0301));
    }
}
