//! `{attribute 'pack_mode' := '1'}`: structures are aligned as without it, which is said where it makes a difference.

use crate::types::declarations::Declarations;
use crate::types::table::Resolved;
use crate::{Code, Diagnostic};
use staunch_ir::Type;

impl Declarations<'_> {
    pub(super) fn warn_of_packing(&mut self) {
        for at in 0..self.types.len() {
            let decl = self.types[at].decl;
            let Some((most, span)) = decl.pack else { continue };
            let Some(Resolved { ty: Type::Struct(id), .. }) = self.named_type(at) else { continue };
            let (is, asked) = (self.sizeof(Type::Struct(id)), self.packed_size(id, most));
            if is == asked {
                continue;
            }
            self.report(
                Diagnostic::new(
                    Code::W0514,
                    span,
                    format!("`{}` is not packed: it takes {is} bytes, and not {asked}", decl.name.text),
                )
                .label("members are aligned to their sizes")
                .other(decl.name.span, "declared here")
                .help("order the members by size, or copy them one by one to an ARRAY OF BYTE"),
            );
        }
    }
}
