//! VAR_IN_OUTs that METHODs of their FUNCTION_BLOCK use, which an instance keeps as a reference, and those that are given
//! instances of what extends their class. They are passed as references, whose numbers identify
//! the class; all others stay what they are. Which ones these are is known when all bodies are checked: then the
//! program is checked again with them. Routines with the same name have the same ones, since one may override the other.

use super::declarations::{Declarations, PouSlot};
use super::in_outs::{InOut, Polymorphic};
use crate::Span;
use crate::ast::{Name, VarBlock, VarKind};
use rustc_hash::FxHashSet;
use staunch_ir::{RefKind, RefType, Type};

fn key(pou: &PouSlot<'_>, name: &str) -> InOut {
    let routine = if pou.ast.kind.is_function() { pou.ast.name.text } else { "" };
    (routine.to_ascii_uppercase(), name.to_ascii_uppercase())
}

impl Declarations<'_> {
    /// The VAR_IN_OUTs that are to be references.
    pub fn polymorphic(&self) -> FxHashSet<InOut> {
        let Polymorphic { known, asked, passed } = &self.table.polymorphic;
        let mut asked = asked.clone();
        let named = |span: Span| {
            let slots = self.pous.iter();
            slots.filter_map(move |pou| {
                let mut names = pou.ast.blocks.iter().flat_map(|it| &it.vars).flat_map(|it| &it.names);
                Some(key(pou, names.find(|it| it.span == span)?.text))
            })
        };
        let mut found = known.clone();
        loop {
            found.extend(asked.drain().flat_map(named));
            let is_found = |span: Span| named(span).any(|it| found.contains(&it));
            asked.extend(passed.iter().filter(|it| is_found(it.0) && !is_found(it.1)).map(|it| it.1));
            if asked.is_empty() {
                return found;
            }
        }
    }

    /// Whether a VAR_IN_OUT of this POU may be a reference.
    pub fn may_be_polymorphic(&self, slot: usize, block: &VarBlock<'_>) -> bool {
        let kind = self.pous[slot].ast.kind;
        (kind.is_function() || kind.is_block()) && block.kind == VarKind::InOut && block.constant.is_none()
    }

    /// The type of a VAR_IN_OUT that is passed as a reference to an instance of this one's kin.
    pub fn polymorphic_type(&mut self, slot: usize, block: &VarBlock<'_>, name: Name<'_>, ty: Type) -> Option<Type> {
        if self.table.kept_in_outs.contains(&name.span) && self.can_be_kept(ty) {
            return Some(self.reference_type(RefKind::ReferenceTo, ty));
        }
        let Type::Struct(state) = ty else { return None };
        let class = self.slot_of_instance(state)?;
        if !self.may_be_polymorphic(slot, block) {
            return None;
        }
        let is_abstract = self.pous[class].ast.modifiers.is_abstract.is_some();
        let is_known = self.table.polymorphic.known.contains(&key(&self.pous[slot], name.text));
        (is_abstract || is_known && self.kin(class).len() > 1).then(|| self.reference_type(RefKind::ReferenceTo, ty))
    }

    /// Whether an instance can keep a reference to a variable of the type, under the variable's name.
    fn can_be_kept(&self, ty: Type) -> bool {
        let is_alias = |it: RefType| it.kind == RefKind::ReferenceTo;
        match ty {
            Type::Reference(id) => !is_alias(self.program.references[id.index()]),
            _ => !self.program.is_open(ty),
        }
    }

    /// What a VAR_IN_OUT is declared as, where it is passed as a reference.
    pub fn referred_type(&self, ty: Type) -> Option<Type> {
        let Type::Reference(id) = ty else { return None };
        Some(self.program.references[id.index()].target)
    }
}
