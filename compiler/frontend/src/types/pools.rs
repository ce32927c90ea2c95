//! The pools that `__NEW` takes objects from, and `__DELETE` gives them back to.

use staunch_ir::{FieldId, Location, Place, StructId, Type};

/// The most objects of a pool.
pub(crate) const MOST: u32 = 65535;

/// The places for the objects of one type: an array in the globals, from 1 on.
#[derive(Clone, Debug)]
pub(crate) struct Pool {
    pub places: Place,
    /// The structure that a place is.
    pub place: StructId,
    pub count: i64,
    pub object: Type,
}

impl Pool {
    /// Whether the place with a number is in use, and the object in it.
    pub fn at(&self, number: staunch_ir::Expr, at: Location) -> (Place, Place) {
        let place = self.places.clone().index(number, Type::Struct(self.place), at);
        (place.clone().field(FieldId(0), Type::BOOL), place.field(FieldId(1), self.object))
    }
}
