//! FUNCTIONs of one name, as Siemens AX has them: they are told apart by their parameters.

use super::collect::declared_twice;
use crate::ast::{self, PouKind};
use crate::dialect::Dialect;
use crate::names::Entry;
use crate::types::declarations::Declarations;
use crate::types::signature::Formal;
use staunch_ir::Type;

impl<'s> Declarations<'s> {
    /// Whether the FUNCTION in a slot is one more of a name that FUNCTIONs have.
    pub(super) fn overloads_another(&mut self, slot: usize) -> bool {
        let name = self.pous[slot].ast.name;
        if !self.may_be_overloaded(slot) || name.text.is_empty() {
            return false;
        }
        let known = self.names.own(self.names.space_of(name.span), name.text);
        let Some(Entry::Pou(first)) = known.and_then(|it| it.ty) else { return false };
        if !self.may_be_overloaded(first) {
            return false;
        }
        self.overloads.sets.entry(first).or_insert_with(|| vec![first]).push(slot);
        true
    }

    fn may_be_overloaded(&self, slot: usize) -> bool {
        let ast::Pou { kind, name, .. } = self.pous[slot].ast;
        *kind == PouKind::Function && self.dialect(name.span) != Dialect::Codesys
    }

    /// Reports those that nothing tells apart from an earlier one.
    pub(super) fn check_overloads(&mut self) {
        let mut firsts: Vec<_> = self.overloads.sets.keys().copied().collect();
        firsts.sort_unstable();
        for first in firsts {
            let mut known: Vec<usize> = Vec::new();
            for slot in self.overloads.sets.remove(&first).unwrap_or_default() {
                match known.iter().find(|it| self.have_same_parameters(**it, slot)) {
                    Some(same) => {
                        let same = self.pous[*same].ast.name.span;
                        self.report(declared_twice(self.pous[slot].ast.name, same));
                    }
                    None => known.push(slot),
                }
            }
            if known.len() > 1 {
                self.overloads.sets.insert(first, known);
            }
        }
    }

    fn have_same_parameters(&mut self, a: usize, b: usize) -> bool {
        let (Some(a), Some(b)) = (self.signature(a), self.signature(b)) else { return false };
        a.formals.len() == b.formals.len() && a.formals.iter().zip(&b.formals).all(|(a, b)| is_same(a, b))
    }
}

/// Whether two parameters take the same arguments.
fn is_same(a: &Formal<'_>, b: &Formal<'_>) -> bool {
    let types = a.resolved.ty.read() == b.resolved.ty.read()
        || matches!((a.resolved.ty, b.resolved.ty), (Type::String(_), Type::String(_)));
    a.section == b.section && a.word == b.word && types
}
