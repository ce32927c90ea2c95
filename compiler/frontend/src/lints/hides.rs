//! FUNCTIONs and FUNCTION_BLOCKs that have a name of the standard's, which loses to them.

use crate::ast::PouKind;
use crate::dialect::{Dialect, bare_block};
use crate::names::{SpaceId, functions};
use crate::types::declarations::Declarations;
use crate::{Code, Diagnostic, prelude};

/// Reports those of the program's own: what is in a NAMESPACE is named by its path.
pub(crate) fn report(decl: &mut Declarations<'_>) {
    for slot in 0..decl.pous.len() {
        let pou = &decl.pous[slot];
        let name = pou.ast.name;
        let is_named = matches!(pou.ast.kind, PouKind::Function | PouKind::FunctionBlock);
        let is_written = pou.owner.is_none() && pou.is_written();
        if !is_named || !is_written || pou.ast.external.is_some() || decl.names.space_of(name.span) != SpaceId::ROOT {
            continue;
        }
        let Some(what) = standard(decl.dialect(name.span), pou.ast.kind, name.text) else { continue };
        decl.report(
            Diagnostic::new(Code::W0517, name.span, format!("`{}` is also {what}", name.text))
                .label("in this program the name means this declaration")
                .help("give it another name, unless it is meant to replace that one"),
        );
    }
}

/// What of the same kind has the name: a function is called, and a block is a type.
fn standard(dialect: Dialect, kind: PouKind, name: &str) -> Option<&'static str> {
    let is_function = kind == PouKind::Function;
    if is_function && functions::exists_in(name, dialect) {
        Some("a standard function")
    } else if !is_function && bare_block(dialect, name).is_some() {
        Some("a standard function block")
    } else {
        let unit = prelude::unit(name, dialect).filter(|it| it.is_function() == is_function && !it.is_declaration);
        unit.map(|_| "in the library that is bundled with Staunch")
    }
}
