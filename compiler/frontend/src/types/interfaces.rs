//! INTERFACEs and bases: which classes have them, and the numbers by which a reference to an instance identifies its class.

use super::declarations::{Declarations, Routines};
use crate::ast::PouKind;
use crate::names::{Entry, Found, Meaning, Sense};
use crate::spelling::Key;
use crate::{Code, Diagnostic, Span};
use rustc_hash::{FxHashMap, FxHashSet};
use staunch_ir::{Elementary, InterfaceId, RefKind, StructId, Type};
use std::rc::Rc;

/// So many classes can be distinguished by references; 0 is none.
const MAX_NUMBERS: u64 = (1 << (64 - staunch_runtime::reference::CLASS)) - 1;

impl Declarations<'_> {
    /// The type of the variables of the INTERFACE in a slot.
    pub fn interface_type(&mut self, slot: usize) -> Option<Type> {
        let at = self.table.interfaces.slots.binary_search(&slot).ok()?;
        Some(self.reference_type(RefKind::Interface(InterfaceId::next(at)), Type::Elementary(Elementary::Byte)))
    }

    /// The slot of the INTERFACE whose variables have the type.
    pub fn interface_of(&self, ty: Type) -> Option<usize> {
        let Type::Reference(id) = ty else { return None };
        match self.program.references[id.index()].kind {
            RefKind::Interface(id) => self.table.interfaces.slots.get(id.index()).copied(),
            RefKind::RefTo | RefKind::PointerTo | RefKind::ReferenceTo => None,
        }
    }

    /// Whether a slot is that of an INTERFACE, or of a head in one: there is nothing to run.
    pub fn is_head(&self, slot: usize) -> bool {
        let owner = self.pous[slot].owner.unwrap_or(slot);
        self.pous[owner].ast.kind == PouKind::Interface
    }

    /// The INTERFACEs that a class IMPLEMENTS, or an INTERFACE EXTENDS, by itself.
    pub fn own_interfaces(&self, slot: usize) -> Vec<usize> {
        let found = self.pous[slot].ast.bases.iter().filter_map(|path| match self.lookup(path, Sense::Type) {
            Found::One(Meaning::Declared(Entry::Pou(at))) => Some(at),
            Found::One(_) | Found::Nothing | Found::Several(_) => None,
        });
        found.filter(|it| self.pous[*it].ast.kind == PouKind::Interface).collect()
    }

    /// All INTERFACEs that a class has, by what it extends too; an INTERFACE has itself.
    pub fn interfaces_of(&mut self, slot: usize) -> Rc<FxHashSet<usize>> {
        let mut way = vec![slot];
        while let Some(base) = way.last().and_then(|it| self.base_of(*it))
            && !self.table.interfaces.closures.contains_key(&base)
        {
            way.push(base);
        }
        while let Some(at) = way.pop() {
            let base = self.base_of(at).and_then(|it| self.table.interfaces.closures.get(&it)).cloned();
            let mut asked = self.own_interfaces(at);
            if self.pous[at].ast.kind == PouKind::Interface {
                asked.push(at);
            }
            let mut all: FxHashSet<usize> = FxHashSet::default();
            while let Some(interface) = asked.pop() {
                if all.insert(interface) {
                    asked.extend(self.own_interfaces(interface));
                }
            }
            let closure = match base {
                Some(base) if all.is_subset(&base) => base,
                Some(base) => Rc::new(all.union(&base).copied().collect()),
                None => Rc::new(all),
            };
            self.table.interfaces.closures.insert(at, closure);
        }
        Rc::clone(&self.table.interfaces.closures[&slot])
    }

    /// The slot of what a class EXTENDS.
    pub fn base_of(&self, slot: usize) -> Option<usize> {
        self.class_named(self.pous[slot].ast.extends?)
    }

    /// Whether a class, or one that it extends, extends what is not known: that has been reported, and what the class
    /// would have of it is not known either.
    pub fn has_unknown_base(&self, class: usize) -> bool {
        let mut classes = std::iter::successors(Some(class), |it| self.base_of(*it));
        classes.any(|it| {
            let pou = self.pous[it].ast;
            pou.kind.is_block() && pou.extends.is_none() && pou.bases.len() > pou.implements.len()
        })
    }

    /// The same, also of what a class or INTERFACE has by its INTERFACEs.
    pub fn has_unknown_parts(&mut self, slot: usize) -> bool {
        let interfaces = self.interfaces_of(slot);
        let classes = std::iter::successors(Some(slot), |it| self.base_of(*it));
        let mut all = classes.chain(interfaces.iter().copied());
        all.any(|it| {
            !self.pous[it].ast.bases.iter().all(|path| matches!(self.lookup(path, Sense::Type), Found::One(_)))
        })
    }

    /// The classes whose instances a variable of the INTERFACE in a slot may refer to.
    pub fn implementers(&mut self, interface: usize) -> Rc<[usize]> {
        if let Some(known) = self.table.interfaces.implementers.get(&interface) {
            return Rc::clone(known);
        }
        let is_class = |pou: &crate::ast::Pou<'_>| pou.kind.is_block() && pou.modifiers.is_abstract.is_none();
        let classes: Vec<_> = (0..self.written_pous().len()).filter(|it| is_class(self.pous[*it].ast)).collect();
        let has = |this: &mut Self, it: &usize| this.interfaces_of(*it).contains(&interface);
        let mut found: Vec<usize> = classes.into_iter().filter(|it| has(self, it)).collect();
        if let Some(only) = &self.table.interfaces.only {
            found.retain(|it| only.contains(it));
        }
        let found: Rc<[usize]> = found.into();
        self.table.interfaces.implementers.insert(interface, Rc::clone(&found));
        found
    }

    /// A reference to an instance is made: only of such classes is what a variable of an INTERFACE refers to.
    pub fn note_referred(&mut self, ty: Type) {
        let first = self.first_instance(ty).and_then(|it| self.slot_of_instance(it));
        self.table.interfaces.referred.extend(first);
    }

    /// The instance at the start of a variable, of a class that references distinguish: itself, the first element
    /// of an array, the first member of a structure.
    pub fn first_instance(&mut self, mut ty: Type) -> Option<StructId> {
        loop {
            ty = match ty {
                Type::Array(id) => self.program.array(id).element,
                Type::Struct(state) if self.slot_of_instance(state).is_some_and(|it| self.is_told_apart(it)) => {
                    return Some(state);
                }
                Type::Struct(state) => self.program.structure(state).fields.first()?.ty,
                Type::Elementary(_)
                | Type::Reference(_)
                | Type::Subrange(..)
                | Type::String(_)
                | Type::Enum(_)
                | Type::Block(_) => return None,
            };
        }
    }

    /// The routines that a name means on an instance, or on a variable of an INTERFACE.
    pub fn routines_on(&self, ty: Type, name: &str) -> Option<Routines> {
        match (ty, self.interface_of(ty)) {
            (Type::Struct(state), _) => self.routines_of(state, name),
            (_, Some(interface)) => self.routines_of_interface(interface, name),
            (_, None) => None,
        }
    }

    fn routines_of_interface(&self, interface: usize, name: &str) -> Option<Routines> {
        self.all_routines_of_interface(interface, name).first().copied()
    }

    /// What an INTERFACE has by a name, and what those have that it extends: its own first.
    fn all_routines_of_interface(&self, interface: usize, name: &str) -> Vec<Routines> {
        let (mut asked, mut seen, mut all) = (vec![interface], FxHashSet::default(), Vec::new());
        while let Some(at) = asked.pop() {
            if seen.insert(at) {
                all.extend(self.pous[at].routines.get(&Key(name)));
                asked.extend(self.own_interfaces(at).into_iter().rev());
            }
        }
        all
    }

    /// The METHODs that a name may mean on an instance, or on a variable of an INTERFACE: no two with one head.
    pub fn methods_on(&self, ty: Type, name: &str) -> Vec<usize> {
        let routines = match self.interface_of(ty) {
            Some(interface) => self.all_routines_of_interface(interface, name),
            None => self.routines_on(ty, name).into_iter().collect(),
        };
        let mut all: Vec<usize> = Vec::new();
        for slot in routines.iter().filter_map(|it| it.called).flat_map(|it| self.all_of_a_name(it.0)) {
            if !all.iter().any(|it| self.have_same_parameters(*it, slot)) {
                all.push(slot);
            }
        }
        all
    }

    /// What a class has for a head of an INTERFACE, or for the body or a routine of its base.
    pub fn routine_for(&self, class: usize, slot: usize) -> Option<usize> {
        if self.pous[slot].owner.is_none() {
            return Some(class);
        }
        let head = self.pous[slot].ast;
        let routines = self.pous[class].routines.get(&Key(head.name.text))?;
        let found = match head.kind {
            PouKind::Getter => routines.getter,
            PouKind::Setter => routines.setter,
            PouKind::Method
            | PouKind::Action
            | PouKind::Program
            | PouKind::FunctionBlock
            | PouKind::Class
            | PouKind::Interface
            | PouKind::Function
            | PouKind::Test => routines.called,
        };
        let all = self.all_of_a_name(found?.0);
        match all.as_slice() {
            [one] => Some(*one),
            several => several.iter().copied().find(|it| self.have_same_parameters(*it, slot)),
        }
    }

    /// Whether the class of an instance may have to be found from its reference: others have the same INTERFACE or
    /// base.
    pub fn is_told_apart(&mut self, slot: usize) -> bool {
        let is_kin = self.base_of(slot).is_some() || self.heirs().contains_key(&slot);
        self.pous[slot].ast.kind.is_block() && (is_kin || !self.interfaces_of(slot).is_empty())
    }

    /// For the slots of bases, those of the classes that extend them directly.
    fn heirs(&mut self) -> Rc<FxHashMap<usize, Vec<usize>>> {
        if let Some(known) = &self.table.interfaces.heirs {
            return Rc::clone(known);
        }
        let mut heirs: FxHashMap<usize, Vec<usize>> = FxHashMap::default();
        for slot in 0..self.written_pous().len() {
            if let Some(base) = self.base_of(slot) {
                heirs.entry(base).or_default().push(slot);
            }
        }
        Rc::clone(self.table.interfaces.heirs.insert(Rc::new(heirs)))
    }

    /// The classes whose instances a reference to this one may lead to: itself, and what extends it.
    pub fn kin(&mut self, slot: usize) -> Vec<usize> {
        let heirs = self.heirs();
        let (mut asked, mut found) = (vec![slot], Vec::new());
        while let Some(at) = asked.pop() {
            asked.extend(heirs.get(&at).into_iter().flatten());
            found.extend(Some(at).filter(|it| self.pous[*it].ast.modifiers.is_abstract.is_none()));
        }
        found.sort_unstable();
        found
    }

    /// Whether instances of one type are of a class that extends, or is, the other's.
    pub fn extends(&self, heir: Type, base: Type) -> bool {
        let (Type::Struct(heir), Type::Struct(base)) = (heir, base) else { return false };
        let (mut at, base) = (self.slot_of_instance(heir), self.slot_of_instance(base));
        while at.is_some() && at != base {
            at = at.and_then(|it| self.base_of(it));
        }
        at.is_some()
    }

    /// Whether a structure begins with the members of another one, which it EXTENDS.
    pub fn extends_structure(&self, heir: Type, base: Type) -> bool {
        let (Type::Struct(heir), Type::Struct(base)) = (heir, base) else { return false };
        let mut at = self.table.bases.get(&heir);
        while at.is_some_and(|it| *it != base) {
            at = at.and_then(|it| self.table.bases.get(it));
        }
        at.is_some()
    }

    /// The number of a class in a reference to one of its instances.
    pub fn class_number(&mut self, state: StructId, span: Span) -> u64 {
        let next = u64::try_from(self.table.interfaces.numbers.len()).unwrap_or(u64::MAX) + 1;
        let number = *self.table.interfaces.numbers.entry(state).or_insert(next);
        if number > MAX_NUMBERS && !std::mem::replace(&mut self.table.interfaces.is_too_many, true) {
            self.report(
                Diagnostic::new(Code::E0901, span, format!("more than {MAX_NUMBERS} classes have INTERFACEs"))
                    .label("references cannot distinguish more than that"),
            );
        }
        number.min(MAX_NUMBERS)
    }

    /// Of each INTERFACE, the classes that have a number, and their states.
    pub fn numbered_implementers(&mut self) -> Vec<Vec<(u64, StructId)>> {
        self.table.interfaces.slots.clone().into_iter().map(|it| self.numbered(it)).collect()
    }

    fn numbered(&mut self, interface: usize) -> Vec<(u64, StructId)> {
        let mut all = Vec::new();
        for class in self.implementers(interface).iter() {
            let state = self.signature(*class).and_then(|it| it.state);
            all.extend(state.and_then(|it| Some((*self.table.interfaces.numbers.get(&it)?, it))));
        }
        all.sort_unstable();
        all
    }
}
