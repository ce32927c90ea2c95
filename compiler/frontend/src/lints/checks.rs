//! FUNCTIONs that CODESYS calls by itself, which nothing calls here.

use crate::ast::PouKind;
use crate::dialect::Dialect;
use crate::names::SpaceId;
use crate::types::declarations::Declarations;
use crate::{Code, Diagnostic};

/// A name, where CODESYS calls it, and what happens there instead. (CODESYS help, "POUs for implicit checks")
const CHECKS: &[(&str, &str, &str)] = &[
    ("CheckBounds", "before each access to an element", "an index out of range is a fault"),
    ("CheckDivInt", "before each division of an INT", "a division by 0 is a fault"),
    ("CheckDivLint", "before each division of a LINT", "a division by 0 is a fault"),
    ("CheckDivReal", "before each division of a REAL", "a division by 0 gives an infinity or NaN"),
    ("CheckDivLReal", "before each division of an LREAL", "a division by 0 gives an infinity or NaN"),
    ("CheckRangeSigned", "where a subrange is assigned", "a value out of range is a fault"),
    ("CheckRangeUnsigned", "where a subrange is assigned", "a value out of range is a fault"),
    ("CheckLRangeSigned", "where a subrange is assigned", "a value out of range is a fault"),
    ("CheckLRangeUnsigned", "where a subrange is assigned", "a value out of range is a fault"),
    ("CheckPointer", "before each access by a pointer", "an access to no variable is a fault"),
];

/// Reports those that are declared in CODESYS.
pub(crate) fn report(decl: &mut Declarations<'_>) {
    for slot in 0..decl.pous.len() {
        let pou = &decl.pous[slot];
        let name = pou.ast.name;
        let is_written = pou.owner.is_none() && pou.is_written() && pou.ast.kind == PouKind::Function;
        if !is_written || decl.dialect(name.span) != Dialect::Codesys || decl.names.space_of(name.span) != SpaceId::ROOT
        {
            continue;
        }
        let Some((_, place, instead)) = CHECKS.iter().find(|it| it.0.eq_ignore_ascii_case(name.text)) else { continue };
        decl.report(
            Diagnostic::new(
                Code::W0527,
                name.span,
                format!("CODESYS calls `{}` implicitly {place}; Staunch does not", name.text),
            )
            .label(format!("{instead}, whatever this returns"))
            .help("write the check where it is needed: `IF divisor <> 0 THEN …`"),
        );
    }
}
