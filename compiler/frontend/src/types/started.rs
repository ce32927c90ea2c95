//! What has a start, and which METHODs CODESYS calls by itself.

use super::declarations::Declarations;
use crate::ast::Pou;
use crate::dialect::Dialect;
use crate::spelling::Key;
use crate::start::{ADDRESSES, INIT, START, is_after};
use staunch_ir::{StructId, Type};

impl Declarations<'_> {
    /// The METHODs FB_init of the class in a slot, in the order in which they run: its first base's first.
    pub fn initial_methods(&self, class: usize) -> Vec<usize> {
        self.system_methods(class, INIT)
    }

    /// The METHODs of a name that CODESYS calls by itself, from those of the first base on.
    pub fn system_methods(&self, class: usize, name: &str) -> Vec<usize> {
        let mut homes = vec![class];
        let mut at = class;
        while let Some(base) = self.pous[at].ast.extends.and_then(|it| self.class_named(it)) {
            homes.push(base);
            at = base;
        }
        homes.into_iter().rev().filter_map(|home| self.system_method_of(class, home, name)).collect()
    }

    /// Such a METHOD as a class wrote it, in the class that has it from there.
    fn system_method_of(&self, class: usize, home: usize, name: &str) -> Option<usize> {
        let is_written = |it: &&Pou<'_>| Key(it.name.text) == Key(name) && it.home.is_none();
        let written = self.pous[home].ast.routines.iter().find(is_written)?.name.span;
        let own = &self.pous[class];
        let routines = own.hidden.get(&written).or_else(|| own.routines.get(&Key(name)))?;
        let (slot, span) = routines.called?;
        (span == written && self.dialect(span) == Dialect::Codesys).then_some(slot)
    }

    /// The METHODs with `call_after_init` of the class in a slot.
    pub fn methods_after(&self, class: usize) -> Vec<usize> {
        let is_own = |it: &usize| self.pous[*it].owner == Some(class);
        let is_called = |it: &usize| {
            let pou = self.pous[*it].ast;
            is_after(pou) && !pou.is_hidden && self.dialect(pou.name.span) == Dialect::Codesys
        };
        (class + 1..self.pous.len()).take_while(is_own).filter(is_called).collect()
    }

    /// Whether the start of a variable of this type does anything.
    pub fn is_started(&mut self, ty: Type) -> bool {
        match ty {
            Type::Struct(id) => self.is_structure_started(id),
            Type::Array(id) => self.is_started(self.program.array(id).element),
            Type::Elementary(_)
            | Type::Subrange(..)
            | Type::String(_)
            | Type::Enum(_)
            | Type::Reference(_)
            | Type::Block(_) => false,
        }
    }

    fn is_structure_started(&mut self, id: StructId) -> bool {
        if !self.starts.is_any {
            return false;
        }
        if let Some(known) = self.starts.known.get(&id) {
            return *known;
        }
        let class = self.slot_of_instance(id);
        let own = class.is_some_and(|it| !self.initial_methods(it).is_empty() || !self.methods_after(it).is_empty());
        let found = own || self.has_started_parts(id);
        self.starts.known.insert(id, found);
        found
    }

    /// Whether members of a structure have addresses as their initial values.
    fn has_addresses(&self, id: StructId) -> bool {
        let fields = self.program.structure(id).fields.iter();
        fields.filter_map(|it| self.declaration_of(it)).any(|(_, it)| it.started.is_some())
    }

    /// Whether a variable of the type has such members, but for those of instances.
    pub fn holds_addresses(&self, ty: Type) -> bool {
        match ty {
            Type::Struct(id) if self.is_instance(id) => false,
            Type::Struct(id) => {
                self.has_addresses(id) || self.program.structure(id).fields.iter().any(|it| self.holds_addresses(it.ty))
            }
            Type::Array(id) => self.holds_addresses(self.program.array(id).element),
            Type::Elementary(_)
            | Type::Subrange(..)
            | Type::String(_)
            | Type::Enum(_)
            | Type::Reference(_)
            | Type::Block(_) => false,
        }
    }

    /// Whether the start of a class's instances assigns initial values.
    pub fn assigns_at_start(&self, class: usize) -> bool {
        let start = self.pous[class].routines.get(&Key(START)).and_then(|it| it.called);
        start.is_some_and(|(slot, _)| self.pous[slot].ast.attributes.contains(&ADDRESSES))
    }

    /// Whether something in a structure has a start, or an address as its initial value.
    pub fn has_started_parts(&mut self, id: StructId) -> bool {
        if self.slot_of_instance(id).is_some_and(|it| self.assigns_at_start(it)) {
            return true;
        }
        if self.has_addresses(id) {
            return true;
        }
        let types: Vec<_> = self.program.structure(id).fields.iter().map(|it| it.ty).collect();
        types.into_iter().any(|it| self.is_started(it))
    }
}
