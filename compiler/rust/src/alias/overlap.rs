//! Which places Rust takes for overlapping: one is a part of the other, where any two elements
//! of an array count as the same one.

use staunch_ir::alias::{borrows_meet, common_fields};
use staunch_ir::{Place, Program, Projection, Root, Type};

use super::key::{SharedRoot, element};

/// A reference that a call hands over; number 0 is the instance.
pub struct Slot<'a> {
    pub number: usize,
    pub place: &'a Place,
}

/// A place that contains several references. Its prefix has no subscripts.
#[derive(Debug)]
pub struct Ancestor {
    pub root: Root,
    pub prefix: Vec<Projection>,
    pub slots: Vec<usize>,
}

pub fn overlap(a: &Place, b: &Place) -> bool {
    a.root == b.root && borrows_meet(&a.projections, &b.projections)
}

/// For each set of references that overlap, what they share.
pub fn ancestors(references: &[Slot<'_>]) -> Vec<Ancestor> {
    let mut groups: Vec<Ancestor> = Vec::new();
    for slot in references {
        let mut group =
            Ancestor { root: slot.place.root, prefix: slot.place.projections.clone(), slots: vec![slot.number] };
        // A merged group is wider, so it may meet groups that its parts did not.
        while let Some(at) = groups.iter().position(|it| meets(it, &group)) {
            let other = groups.remove(at);
            group.prefix.truncate(common_fields(&other.prefix, &group.prefix));
            group.slots = [other.slots, group.slots].concat();
        }
        groups.push(group);
    }
    groups.retain(|group| group.slots.len() > 1);
    groups
}

fn meets(a: &Ancestor, b: &Ancestor) -> bool {
    a.root == b.root && borrows_meet(&a.prefix, &b.prefix)
}

impl Ancestor {
    /// How the callee reaches it without a parameter, if it does.
    pub fn shared_root(&self, references: &[Slot<'_>]) -> Option<SharedRoot> {
        let is_instance = |slot: &&Slot<'_>| slot.number == 0 && slot.place.projections.len() == self.prefix.len();
        let held = references.iter().filter(|slot| self.slots.contains(&slot.number));
        held.into_iter().find(is_instance).map(|_| SharedRoot::Instance)
    }

    pub fn place(&self, program: &Program, root: Type) -> Place {
        let ty = self.prefix.iter().fold(root, |ty, it| element(program, ty, it));
        Place { root: self.root, projections: self.prefix.clone(), ty }
    }
}
