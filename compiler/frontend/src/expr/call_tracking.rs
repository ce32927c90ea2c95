//! The instances that were called on the way to a statement.

use crate::Span;
use rustc_hash::FxHashMap;
use staunch_ir::{FieldId, Place, Projection, Root};

/// An instance that no index decides.
pub(crate) type Instance = (Root, Vec<FieldId>);

/// Where an instance is called, and what that gives for its inputs that count up and down.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Call {
    pub span: Span,
    pub counted: [Option<Span>; 2],
}

/// Each instance once, in order, with its first call.
#[derive(Debug, Default)]
pub(crate) struct Called {
    order: Vec<Instance>,
    first: FxHashMap<Instance, Call>,
    /// What the IFs around the statement ask: an instance as it is written, and its member.
    pub asked: Vec<(String, String)>,
    /// The timers whose input was taken back on the way to the statement: the next call starts them anew.
    pub taken_back: Vec<Instance>,
}

impl Called {
    pub fn len(&self) -> usize {
        self.order.len()
    }

    /// The first call of the same instance, or `None` when this is the first, or starts a timer anew.
    pub fn note(&mut self, place: &Place, call: Call) -> Option<Call> {
        let instance = instance(place)?;
        if let Some(at) = self.taken_back.iter().position(|it| *it == instance) {
            self.taken_back.swap_remove(at);
            if self.first.contains_key(&instance) {
                return None;
            }
        }
        let first = self.first.get(&instance).copied();
        if first.is_none() {
            self.insert(instance, call);
        }
        first
    }

    /// The first call of the instance so far.
    pub fn first(&self, place: &Place) -> Option<Call> {
        self.first.get(&instance(place)?).copied()
    }

    /// The input of a timer is taken back here.
    pub fn take_back(&mut self, place: &Place) {
        self.taken_back.extend(instance(place));
    }

    /// Forgets the instances after the first `len`, and returns them.
    pub fn split_off(&mut self, len: usize) -> Vec<(Instance, Call)> {
        let forgotten = self.order.split_off(len).into_iter();
        forgotten.filter_map(|it| self.first.remove(&it).map(|call| (it, call))).collect()
    }

    pub fn append(&mut self, calls: Vec<(Instance, Call)>) {
        for (instance, call) in calls {
            if !self.first.contains_key(&instance) {
                self.insert(instance, call);
            }
        }
    }

    fn insert(&mut self, instance: Instance, call: Call) {
        self.order.push(instance.clone());
        self.first.insert(instance, call);
    }
}

fn instance(place: &Place) -> Option<Instance> {
    let fields = place.projections.iter().map(|it| match it {
        Projection::Field(field) => Some(*field),
        Projection::Index { .. } | Projection::Deref { .. } => None,
    });
    Some((place.root, fields.collect::<Option<_>>()?))
}
