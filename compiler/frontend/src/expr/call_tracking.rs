//! The instances that were called on the way to a statement.

use crate::Span;
use rustc_hash::FxHashMap;
use staunch_ir::{FieldId, Place, Projection, Root};

/// An instance that no index decides.
pub(crate) type Instance = (Root, Vec<FieldId>);

/// Each instance once, in order, with its first call.
#[derive(Debug, Default)]
pub(crate) struct Called {
    order: Vec<Instance>,
    first: FxHashMap<Instance, Span>,
}

impl Called {
    pub fn len(&self) -> usize {
        self.order.len()
    }

    /// The first call of the same instance, or `None` when this is the first.
    pub fn note(&mut self, place: &Place, span: Span) -> Option<Span> {
        let instance = instance(place)?;
        let first = self.first.get(&instance).copied();
        if first.is_none() {
            self.insert(instance, span);
        }
        first
    }

    /// Forgets the instances behind the first `len`, and returns them.
    pub fn split_off(&mut self, len: usize) -> Vec<(Instance, Span)> {
        let forgotten = self.order.split_off(len).into_iter();
        forgotten.filter_map(|it| self.first.remove(&it).map(|span| (it, span))).collect()
    }

    pub fn append(&mut self, calls: Vec<(Instance, Span)>) {
        for (instance, span) in calls {
            if !self.first.contains_key(&instance) {
                self.insert(instance, span);
            }
        }
    }

    fn insert(&mut self, instance: Instance, span: Span) {
        self.order.push(instance.clone());
        self.first.insert(instance, span);
    }
}

fn instance(place: &Place) -> Option<Instance> {
    let fields = place.projections.iter().map(|it| match it {
        Projection::Field(field) => Some(*field),
        Projection::Index { .. } | Projection::Deref { .. } => None,
    });
    Some((place.root, fields.collect::<Option<_>>()?))
}
