//! FUNCTIONs that never say what their result is.

use crate::spelling::Key;
use crate::start::INITIAL;
use crate::types::declarations::Declarations;
use crate::{Code, Diagnostic, ast};

/// The FUNCTIONs whose bodies do not name their result. A refused statement may have assigned it.
pub(crate) fn unassigned(decl: &Declarations<'_>) -> Vec<Diagnostic> {
    let unassigned = (0..decl.pous.len())
        .filter(|slot| !decl.is_head(*slot) && decl.pous[*slot].dispatch.is_none())
        .map(|slot| &decl.pous[slot])
        // The system asks for no result.
        .filter(|it| !INITIAL.iter().any(|name| Key(name) == Key(it.ast.name.text)))
        .filter(|it| it.ast.result.is_some() && !it.names_itself && it.ast.modifiers.is_abstract.is_none())
        .filter(|it| it.ast.external.is_none() && !it.ast.is_stub)
        .map(|it| it.ast.name);
    let lint = |name: ast::Name<'_>| {
        Diagnostic::new(Code::W0516, name.span, format!("the result of `{}` is never assigned", name.text))
            .label("each call gives its type's initial value")
            .help(format!("assign it, `{} := …;`", name.text))
    };
    unassigned.map(lint).collect()
}
