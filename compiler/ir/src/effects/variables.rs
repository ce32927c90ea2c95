//! Sets of variables, as a routine knows them: the fields of the globals and of its own state, and
//! its parameters. A part of a variable counts as the whole, so that sets stay small in programs of
//! any size.

use crate::{FieldId, ParamId, Place, Projection, Root};

#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Variables {
    globals: Bits,
    state: Bits,
    params: Bits,
}

impl Variables {
    /// Whether `place` is one of them, a part of one, or has one in it. A local is nobody else's, and never held.
    pub fn holds(&self, place: &Place) -> bool {
        match (place.root, first_field(place)) {
            (Root::Globals, Some(field)) => self.has_global(field),
            (Root::Instance, Some(field)) => self.has_own(field),
            (Root::Globals, None) => self.any_global(),
            (Root::Instance, None) => self.any_own(),
            (Root::Param(id), _) => self.has_param(id),
            (Root::Local(_), _) => false,
        }
    }

    pub fn has_global(&self, field: FieldId) -> bool {
        self.globals.holds(field.index())
    }

    pub fn has_own(&self, field: FieldId) -> bool {
        self.state.holds(field.index())
    }

    pub fn has_param(&self, id: ParamId) -> bool {
        self.params.holds(id.index())
    }

    /// The fields of the globals among them, in order.
    pub fn globals(&self) -> impl Iterator<Item = FieldId> {
        self.globals.iter().map(FieldId::next)
    }

    /// Whether there are any in the globals.
    pub fn any_global(&self) -> bool {
        !self.globals.is_empty()
    }

    /// Whether there are any in the state of the routine's own instance.
    pub fn any_own(&self) -> bool {
        !self.state.is_empty()
    }

    /// Adds the variable that `place` is a part of, where its root has `fields` of them.
    pub(super) fn add(&mut self, place: &Place, fields: usize) {
        let of_root = match place.root {
            Root::Globals => &mut self.globals,
            Root::Instance => &mut self.state,
            Root::Param(id) => return self.params.add(id.index()),
            Root::Local(_) => return,
        };
        match first_field(place) {
            Some(field) => of_root.add(field.index()),
            None => (0..fields).for_each(|it| of_root.add(it)),
        }
    }

    pub(super) fn add_globals(&mut self, of: &Self) {
        self.globals.add_all(&of.globals);
    }
}

fn first_field(place: &Place) -> Option<FieldId> {
    match place.projections.first() {
        Some(Projection::Field(field)) => Some(*field),
        Some(Projection::Index { .. } | Projection::Deref { .. }) | None => None,
    }
}

/// A set of small numbers.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
struct Bits(Vec<u64>);

impl Bits {
    const WORD: usize = 64;

    fn add(&mut self, number: usize) {
        let word = number / Self::WORD;
        if self.0.len() <= word {
            self.0.resize(word + 1, 0);
        }
        self.0[word] |= 1 << (number % Self::WORD);
    }

    fn add_all(&mut self, other: &Self) {
        if self.0.len() < other.0.len() {
            self.0.resize(other.0.len(), 0);
        }
        self.0.iter_mut().zip(&other.0).for_each(|(own, other)| *own |= other);
    }

    fn holds(&self, number: usize) -> bool {
        self.0.get(number / Self::WORD).is_some_and(|word| word >> (number % Self::WORD) & 1 == 1)
    }

    fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    fn iter(&self) -> impl Iterator<Item = usize> {
        (0..self.0.len() * Self::WORD).filter(|it| self.holds(*it))
    }
}
