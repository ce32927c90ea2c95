//! FUNCTIONs with the same name, and METHODs of one class with the same name, as in Siemens AX: they differ in their
//! parameters.

use super::collect::declared_twice;
use crate::ast::PouKind;
use crate::names::Entry;
use crate::spelling::Key;
use crate::types::declarations::Declarations;

impl<'s> Declarations<'s> {
    /// Whether the FUNCTION in a slot is one more of a name that FUNCTIONs have.
    pub(super) fn overloads_another(&mut self, slot: usize) -> bool {
        let name = self.pous[slot].ast.name;
        if !self.may_be_overloaded(slot, PouKind::Function) || name.text.is_empty() {
            return false;
        }
        let known = self.names.own(self.names.space_of(name.span), name.text);
        let Some(Entry::Pou(first)) = known.and_then(|it| it.ty) else { return false };
        if !self.may_be_overloaded(first, PouKind::Function) {
            return false;
        }
        self.overloads.sets.entry(first).or_insert_with(|| vec![first]).push(slot);
        true
    }

    /// Whether the METHOD in a slot is one more of a name that METHODs of its POU have.
    pub(super) fn overloads_a_method(&mut self, owner: usize, slot: usize) -> bool {
        let is_method = |it: &usize| self.may_be_overloaded(*it, PouKind::Method);
        let name = self.pous[slot].ast.name;
        let known = self.pous[owner].routines.get(&Key(name.text)).and_then(|it| it.called).map(|it| it.0);
        let Some(first) = known.filter(|it| is_method(it) && is_method(&slot)) else { return false };
        self.overloads.sets.entry(first).or_insert_with(|| vec![first]).push(slot);
        true
    }

    fn may_be_overloaded(&self, slot: usize, kind: PouKind) -> bool {
        let pou = self.pous[slot].ast;
        pou.kind == kind && self.dialect(pou.name.span).has_overloads()
    }

    /// Reports those that do not differ from an earlier one.
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
}
