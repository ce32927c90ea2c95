//! VAR_IN_OUTs that are given instances of what extends their class. They are passed as references, whose numbers tell
//! the class; all others stay what they are. Which ones these are is known when all bodies are checked: then the
//! program is checked again with them. Routines of one name have them alike, since one may override the other.

use super::declarations::{Declarations, PouSlot};
use super::in_outs::{InOut, Polymorphic};
use crate::Span;
use crate::ast::{VarBlock, VarKind};
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
    pub fn polymorphic_type(&mut self, slot: usize, block: &VarBlock<'_>, name: &str, ty: Type) -> Option<Type> {
        let Type::Struct(state) = ty else { return None };
        let class = self.slot_of_instance(state)?;
        if !self.may_be_polymorphic(slot, block) {
            return None;
        }
        let is_abstract = self.pous[class].ast.modifiers.is_abstract.is_some();
        let is_known = self.table.polymorphic.known.contains(&key(&self.pous[slot], name));
        (is_abstract || is_known && self.kin(class).len() > 1).then(|| self.reference_type(RefKind::ReferenceTo, ty))
    }

    /// The class that a VAR_IN_OUT is declared of, where it is passed as a reference.
    pub fn referred_class(&self, ty: Type) -> Option<Type> {
        let Type::Reference(id) = ty else { return None };
        let RefType { target, .. } = self.program.references[id.index()];
        matches!(target, Type::Struct(_)).then_some(target)
    }
}
