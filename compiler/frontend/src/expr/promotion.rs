//! Promotion: where a dialect computes integers of fewer than 32 bits at 32, a value is a DINT until
//! it is stored. Until then it has the type that its operands give it in addition to the one it is computed at.

use super::checker::Checker;
use crate::Span;
use crate::dialect::Dialect;
use staunch_ir::narrow::is_narrow;
use staunch_ir::{Conversion, Elementary, Expr, Type};

impl Checker<'_, '_> {
    pub(crate) fn promotes(&self, ty: Elementary, span: Span) -> bool {
        is_narrow(ty) && self.decl.dialect(span).rules().promotes_integers()
    }

    /// Whether a number with a fraction and without a type has the precision of an LREAL.
    pub(crate) fn literals_are_doubles(&self, span: Span) -> bool {
        let dialect = self.decl.dialect(span);
        let is_chosen = dialect == Dialect::Codesys && self.decl.log.options.codesys_lreal_literals;
        is_chosen || dialect.rules().has_literals_of_c()
    }

    /// Whether functions, too, compute values of this type at DINT.
    pub(crate) fn promotes_in_functions(&self, ty: Elementary, span: Span) -> bool {
        self.promotes(ty, span) && !self.decl.dialect(span).rules().promotes_as_c()
    }

    /// The value at DINT, where the dialect computes those of its type there.
    pub(crate) fn promote(&mut self, value: Expr, span: Span) -> Expr {
        match value.ty {
            Type::Elementary(it) if self.promotes(it, span) => self.convert(Conversion::Value, Type::DINT, value),
            _ => value,
        }
    }
}
