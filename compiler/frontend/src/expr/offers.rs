//! What a name could be where an editor asks.

use super::checker::Checker;
use crate::ast;
use crate::index::recorder::Named;
use crate::names::Sense;
use staunch_ir::{BlockId, EnumId, StructId, Type};
use staunch_runtime::{Direction, Family};

impl<'s> Checker<'_, 's> {
    /// Offers what a name could be in an expression, or before a call's parentheses.
    pub(crate) fn offer_values(&self, name: ast::Name<'s>, sense: Sense) {
        if !self.decl.log.is_asked(name.span) {
            return;
        }
        let log = &self.decl.log;
        let scopes = std::iter::successors(Some(&self.scope), |it| it.outer.as_ref());
        for scope in scopes.flat_map(|it| [Some(it), it.constants.as_ref()]).flatten() {
            let own = scope.variables.iter().filter(|it| !it.name.text.starts_with("__"));
            own.for_each(|it| log.offer(it.name.text, Named::Definition(it.name.span)));
        }
        if let Some(slot) = self.slot {
            self.offer_routines(self.decl.home(slot));
            let pou = self.decl.pous[slot].ast;
            if pou.kind.is_function() {
                log.offer(pou.name.text, Named::Definition(pou.name.span));
            }
        }
        self.decl.offer_visible(name, sense);
        for (key, slots) in &self.decl.names.enumerators {
            let owners = slots.iter().filter_map(|it| self.decl.enumeration_of(*it));
            owners.for_each(|it| self.decl.offer_enumerator(key.0, it));
        }
        self.decl.offer_functions(name);
    }

    fn offer_routines(&self, class: usize) {
        for (key, routines) in &self.decl.pous[class].routines {
            let all = [routines.called, routines.getter, routines.setter];
            if let Some((slot, _)) = all.into_iter().flatten().next() {
                let declared = self.decl.pous[slot].ast.name;
                if !declared.text.starts_with("__") {
                    self.decl.log.offer(key.0, Named::Definition(declared.span));
                }
            }
        }
    }

    /// Offers what a name after a point could be.
    pub(crate) fn offer_members(&self, name: ast::Name<'s>, ty: Type) {
        if !self.decl.log.is_asked(name.span) {
            return;
        }
        match ty {
            Type::Struct(id) => self.offer_fields(id),
            Type::Block(id) => self.offer_pins(id),
            Type::Elementary(_)
            | Type::Reference(_)
            | Type::Subrange(..)
            | Type::String(_)
            | Type::Enum(_)
            | Type::Array(_) => {}
        }
        if let Some(class) = self.decl.class_of(ty).or_else(|| self.decl.interface_of(ty)) {
            let bases = std::iter::successors(Some(class), |it| self.decl.base_of(*it));
            bases.for_each(|it| self.offer_routines(it));
        }
    }

    fn offer_fields(&self, id: StructId) {
        let names: Vec<_> = self.decl.members_of(id).collect();
        for name in names {
            if let Some(declared) = self.decl.declaration_named(id, name) {
                self.decl.log.offer_expected(name, Named::Definition(declared));
            }
        }
    }

    fn offer_pins(&self, id: BlockId) {
        for (at, pin) in id.info().pins.iter().enumerate().filter(|it| it.1.direction != Direction::Memory) {
            self.decl.log.offer_expected(pin.name, Named::Pin(id, at));
        }
    }

    /// Offers the enumerators of what is expected at a place.
    pub(crate) fn offer_enumerators(&self, name: ast::Name<'s>, id: EnumId) {
        if self.decl.log.is_asked(name.span) {
            self.decl.offer_enumerators(id);
        }
    }
}

impl<'s> crate::types::declarations::Declarations<'s> {
    /// Offers what a name could be that stands for a type.
    pub(crate) fn offer_types(&self, name: ast::Name<'s>) {
        if !self.log.is_asked(name.span) {
            return;
        }
        self.offer_visible(name, Sense::Type);
        let rules = self.dialect(name.span).rules();
        for elementary in staunch_ir::Elementary::ALL {
            if let Some(known) = rules.named(elementary.name()) {
                self.log.offer(elementary.name(), Named::Elementary(known));
            }
        }
        let family = self.dialect(name.span).family();
        for (at, info) in staunch_runtime::BLOCKS.iter().enumerate() {
            let is_own = info.family == family || info.family == Family::Iec;
            let block = BlockId::next(at);
            if is_own && crate::dialect::bare_block(self.dialect(name.span), info.name) == Some(block) {
                self.log.offer(info.name, Named::Block(block));
            }
        }
    }
}
