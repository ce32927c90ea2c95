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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_set_holds_what_was_added_and_nothing_else() {
        let numbers = [0, 3, 63, 64, 130];
        let mut bits = Bits::default();
        assert!(bits.is_empty() && bits.iter().next().is_none());
        numbers.iter().for_each(|it| bits.add(*it));
        assert!(!bits.is_empty());
        assert_eq!(bits.iter().collect::<Vec<_>>(), numbers);
        assert!((0..300).all(|it| bits.holds(it) == numbers.contains(&it)));
        // A union is the same whichever is added to which.
        let mut few = Bits::default();
        few.add(5);
        let mut more = few.clone();
        more.add_all(&bits);
        bits.add_all(&few);
        assert_eq!(bits, more);
        assert_eq!(more.iter().collect::<Vec<_>>(), [0, 3, 5, 63, 64, 130]);
    }

    #[test]
    fn variables_are_kept_apart_by_their_roots() {
        let field = |root| Place::root(root, crate::Type::INT).field(FieldId(2), crate::Type::INT);
        let mut set = Variables::default();
        assert!(!set.any_own() && !set.any_global());
        set.add(&field(Root::Globals), 0);
        assert!(!set.any_own() && set.any_global() && set.has_global(FieldId(2)) && !set.has_global(FieldId(1)));
        assert!(set.holds(&field(Root::Globals)) && !set.holds(&field(Root::Instance)));
        set.add(&Place::root(Root::Instance, crate::Type::INT), 3);
        assert!((0..5).all(|it| set.has_own(FieldId(it)) == (it < 3)));
    }
}
