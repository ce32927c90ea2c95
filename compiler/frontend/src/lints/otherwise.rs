//! What the system of the dialect does otherwise than it is done here.

use crate::dialect::rules::NOT_FOLLOWED;
use crate::types::declarations::Declarations;
use crate::{Code, Diagnostic};

pub(crate) fn report(declarations: &mut Declarations<'_>) {
    for rule in NOT_FOLLOWED.iter().filter(|it| it.is_told) {
        let Some(at) = declarations.program.uses.first(rule.uses) else { continue };
        let span = declarations.log.name_at(at);
        if declarations.dialect(span) != rule.dialect {
            continue;
        }
        let system = rule.dialect.name().to_ascii_uppercase();
        let message = format!("{system} has a different rule for {}: {}", rule.uses.words(), rule.what);
        declarations.report(
            Diagnostic::new(Code::W0529, span, message)
                .label("Staunch follows `iec` here")
                .help(format!("rewrite it if the difference matters (source: {})", rule.evidence)),
        );
    }
}
