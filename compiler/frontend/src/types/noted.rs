//! What names are noted to mean, for an editor.

use super::declarations::Declarations;
use crate::Span;
use crate::ast::Name;
use crate::index::recorder::Named;
use crate::names::{Found, Meaning, Sense};
use staunch_ir::{BlockId, EnumId, StructId, Type};

impl<'s> Declarations<'s> {
    /// Notes what a path means that was looked up: its last name, and the names before it.
    pub fn note_path(&self, path: &[Name<'s>], found: &Found) {
        let Some((last, around)) = path.split_last().filter(|_| self.log.index.is_some()) else { return };
        (1..=around.len()).for_each(|end| self.note_prefix(&path[..end]));
        match found {
            Found::One(Meaning::Declared(entry)) => self.log.note_declared(last.span, self.span_of(*entry)),
            Found::One(Meaning::Enumerator(slot)) => {
                if let Some(Type::Enum(id)) = self.type_of_slot(*slot) {
                    self.note_enumerator(*last, id);
                }
            }
            Found::One(Meaning::Block(block)) => self.log.note(last.span, || Named::Block(*block)),
            Found::One(Meaning::Instruction) => self.log.note(last.span, || Named::Instruction),
            Found::One(Meaning::Function) => self.log.note(last.span, || Named::Function),
            Found::Nothing | Found::Several(_) => {}
        }
    }

    /// Notes a path that is all of namespaces.
    pub fn note_space(&self, path: &[Name<'s>]) {
        if self.log.index.is_some() {
            (1..=path.len()).for_each(|end| self.note_prefix(&path[..end]));
        }
    }

    /// Notes what leads to a name: a namespace, a list, an enumeration, or a word that stands for a library.
    fn note_prefix(&self, path: &[Name<'s>]) {
        let Some(last) = path.last() else { return };
        let site = self.site(last.span);
        if let Some(space) = self.names.space_at(site, path) {
            let name = self.names.name_of(space).to_owned();
            return self.log.note(last.span, || Named::Namespace(name));
        }
        match self.lookup(path, Sense::Type) {
            found @ Found::One(Meaning::Declared(_)) => self.note_path(&path[path.len() - 1..], &found),
            Found::One(_) | Found::Nothing | Found::Several(_) => self.log.note(last.span, || Named::Word),
        }
    }

    pub(super) fn type_of_slot(&self, slot: usize) -> Option<Type> {
        match &self.types[slot].slot {
            super::declarations::Slot::Done(resolved) => Some(resolved.ty),
            super::declarations::Slot::Open | super::declarations::Slot::Failed => None,
        }
    }

    pub fn note_enumerator(&self, name: Name<'s>, id: EnumId) {
        if let Some(declared) = self.log.index.as_ref().and_then(|it| it.enumerator(id, name.text)) {
            self.log.note_declared(name.span, declared);
        }
    }

    /// Notes a member of a structure, or a variable of an instance.
    pub fn note_member(&self, name: Name<'s>, id: StructId) {
        if self.log.index.is_none() {
            return;
        }
        if let Some(declared) = self.declaration_named(id, name.text) {
            self.log.note_declared(name.span, declared);
        }
    }

    /// Where a member of a structure, or a variable of an instance, is declared.
    pub fn declaration_named(&self, id: StructId, name: &str) -> Option<Span> {
        let structure = self.program.structure(id);
        if let Some(field) = self.field_named(id, name).map(|it| &structure.fields[it.index()]) {
            let declared = self.declaration_of(field).map(|(name, _)| name.span);
            return Some(declared.unwrap_or_else(|| self.log.name_at(field.location)));
        }
        let shared = structure.overlays.iter().find(|it| it.name.eq_ignore_ascii_case(name))?;
        Some(self.log.name_at(shared.location))
    }

    pub fn note_pin(&self, name: Name<'s>, block: BlockId) {
        let pins = block.info().pins;
        if let Some(at) = pins.iter().position(|it| it.name.eq_ignore_ascii_case(name.text)) {
            self.log.note(name.span, || Named::Pin(block, at));
        }
    }

    /// Notes the POU or routine in a slot.
    pub fn note_pou(&self, name: Name<'s>, slot: usize) {
        self.log.note_declared(name.span, self.pous[slot].ast.name.span);
    }
}
