//! Direct addresses that share bits: one variable keeps them, and the others are views of it. Bytes are
//! counted from the lowest bits, as CODESYS has them on x86.

use rustc_hash::FxHashMap;
use staunch_ir::{FieldId, Place, Projection, Root, Type, View};

/// A variable that is some bits of another one.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Shared {
    /// The field of the globals that keeps the bits, and its type.
    pub storage: usize,
    pub ty: Type,
    pub view: View,
}

/// What the fields of the globals are, that declarations have counted.
#[derive(Debug, Default)]
pub(crate) struct Image {
    pub shared: FxHashMap<usize, Shared>,
    /// Where each field is in the end; nothing where all fields are kept.
    pub positions: Vec<usize>,
}

impl Image {
    /// Counts the fields that are kept, of `count`.
    pub fn settle(&mut self, count: usize) {
        if self.shared.is_empty() {
            return;
        }
        let kept = (0..count).scan(0, |next, field| {
            let position = *next;
            *next += usize::from(!self.shared.contains_key(&field));
            Some(position)
        });
        self.positions = kept.collect();
    }

    /// The storage of a declared variable, and which bits of it the variable is.
    pub fn stored(&self, place: &Place) -> (Place, Option<View>) {
        let (Root::Globals, Some(Projection::Field(field))) = (place.root, place.projections.first()) else {
            return (place.clone(), None);
        };
        let position = |field: usize| FieldId::next(self.positions.get(field).copied().unwrap_or(field));
        if let Some(shared) = self.shared.get(&field.index()) {
            let storage = Projection::Field(position(shared.storage));
            return (Place { root: Root::Globals, projections: vec![storage], ty: shared.ty }, Some(shared.view));
        }
        let mut place = place.clone();
        place.projections[0] = Projection::Field(position(field.index()));
        (place, None)
    }
}
