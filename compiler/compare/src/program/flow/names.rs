//! What variables may hold, whatever the statement.

use crate::program::walked::{Name, Walked};
use staunch_ir::interval::Range;
use staunch_ir::{FieldId, Place, Program, Repr, RoutineId, Type, reference};
use std::collections::{BTreeSet, HashMap, HashSet};

/// What variables may hold at any time.
#[derive(Debug)]
pub struct Names<'p> {
    pub program: &'p Program,
    pub known: HashMap<Name, Range>,
}

/// What statements give variables.
#[derive(Debug, Default)]
pub struct Written {
    pub found: HashMap<Name, Range>,
    /// Anything.
    pub open: HashSet<Name>,
}

impl Names<'_> {
    /// The numbers of a type.
    pub fn whole(&self, ty: Type) -> Option<Range> {
        let is_reference = matches!(ty, Type::Reference(_));
        self.program.repr(ty).filter(|it| it.is_integer() && !is_reference).and_then(Repr::range)
    }

    /// What a variable may hold, where that is less than its type.
    pub fn of_place(&self, routine: RoutineId, place: &Place) -> Option<Range> {
        let name = Walked::of(self.program, (self.program.routine(routine), routine), place).variable();
        name.and_then(|it| self.known.get(&it)).copied().or_else(|| self.program.range(place.ty))
    }

    /// What references may lead to.
    pub fn reached(&self) -> HashSet<Name> {
        let mut written = Written::default();
        for (owner, field) in reference::reached(self.program) {
            let ty = self.program.structure(owner).fields[field.index()].ty;
            written.opens(self.program, &[Name::Field(owner, field)], ty);
        }
        written.open
    }

    /// Adds what is written to what is known: where that is more, up to the next limit, or else to all of the type. Whether it
    /// was more.
    pub fn grow(&mut self, written: &Written, limits: &BTreeSet<i128>, is_careful: bool) -> bool {
        let before = self.known.len();
        self.known.retain(|name, _| !written.open.contains(name));
        let mut grows = self.known.len() < before;
        for (name, (least, greatest)) in &written.found {
            let Some(own) = self.known.get_mut(name) else { continue };
            if own.0 <= *least && *greatest <= own.1 {
                continue;
            }
            grows = true;
            let below = limits.range(..=*least).next_back().copied();
            let above = limits.range(*greatest..).next().copied();
            let low = if *least < own.0 { below } else { Some(own.0) };
            let high = if *greatest > own.1 { above } else { Some(own.1) };
            match low.zip(high).filter(|_| is_careful) {
                Some(wider) => *own = wider,
                None => _ = self.known.remove(name),
            }
        }
        grows
    }
}

impl Written {
    pub fn gives(&mut self, name: Name, range: Range) {
        let own = self.found.entry(name).or_insert(range);
        *own = (own.0.min(range.0), own.1.max(range.1));
    }

    /// Variables, and all that is a part of a type, may hold anything.
    pub fn opens(&mut self, program: &Program, names: &[Name], ty: Type) {
        self.open.extend(names);
        self.opens_in(program, ty);
    }

    fn opens_in(&mut self, program: &Program, ty: Type) {
        match ty {
            Type::Array(id) => self.opens_in(program, program.array(id).element),
            Type::Struct(id) => {
                for (at, field) in program.structure(id).fields.iter().enumerate() {
                    if self.open.insert(Name::Field(id, FieldId::next(at))) {
                        self.opens_in(program, field.ty);
                    }
                }
            }
            Type::Block(_)
            | Type::Elementary(_)
            | Type::Reference(_)
            | Type::Subrange(..)
            | Type::String(_)
            | Type::Enum(_) => {}
        }
    }
}
