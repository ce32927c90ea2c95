//! Names that could be at a place, of those that are declared.

use super::declarations::Declarations;
use crate::ast::Name;
use crate::index::recorder::Named;
use crate::names::{Sense, Visible, functions};
use staunch_ir::{EnumId, Type};

impl<'s> Declarations<'s> {
    /// Offers what files declare that a bare name could mean.
    pub fn offer_visible(&self, name: Name<'s>, sense: Sense) {
        let site = self.site(name.span);
        self.names.each_visible(site, sense, &mut |text, it| self.offer_one(text, it));
    }

    /// Offers what a namespace, a list or an enumeration holds that a path leads to.
    pub fn offer_in(&self, path: &[Name<'s>], name: Name<'s>, sense: Sense) {
        if !self.log.is_asked(name.span) {
            return;
        }
        let site = self.site(name.span);
        if let Some(space) = self.names.space_at(site, path) {
            self.names.each_in(site, space, sense, &mut |text, it| self.offer_one(text, it));
        }
    }

    fn offer_one(&self, text: &str, it: Visible) {
        // What the compiler declares has names of its own.
        if text.starts_with("__") {
            return;
        }
        match it {
            Visible::Declared(entry) => self.log.offer(text, Named::Definition(self.span_of(entry))),
            Visible::Space(space) => self.log.offer(text, Named::Namespace(self.names.name_of(space).to_owned())),
        }
    }

    pub fn enumeration_of(&self, slot: usize) -> Option<EnumId> {
        match self.type_of_slot(slot)? {
            Type::Enum(id) => Some(id),
            _ => None,
        }
    }

    pub fn offer_enumerators(&self, id: EnumId) {
        for it in &self.program.enumeration(id).values {
            if let Some(declared) = self.log.index.as_ref().and_then(|index| index.enumerator(id, &it.name)) {
                self.log.offer_expected(&it.name, Named::Definition(declared));
            }
        }
    }

    pub fn offer_enumerator(&self, name: &str, id: EnumId) {
        if let Some(declared) = self.log.index.as_ref().and_then(|it| it.enumerator(id, name)) {
            self.log.offer(name, Named::Definition(declared));
        }
    }

    /// Offers the standard functions of the dialect.
    pub fn offer_functions(&self, name: Name<'s>) {
        for it in functions::standard_functions(self.dialect(name.span)).filter(|it| !it.name.starts_with('_')) {
            self.log.offer(it.name, Named::Function);
        }
    }
}
