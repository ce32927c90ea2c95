//! The objects that references name: each variable whose address is taken somewhere, in each instance.

use super::addresses::addressable;
use crate::layout::Layout;
use crate::{FieldId, Program, StructId, Type};
use staunch_runtime::Repr;
use std::collections::{BTreeMap, BTreeSet};

/// A variable that references may name. Its number is its position among all, from 1.
#[derive(Clone, Debug)]
pub struct Object {
    /// Where it begins in the state, in bytes.
    pub offset: u64,
    pub size: u64,
    /// Whether all of it is numbers, and it is in no pool.
    pub is_plain: bool,
    /// That of the pool's place around it, or 0.
    pub mark: u32,
    /// The type of the outermost of the variables that are there.
    pub ty: Type,
}

/// The objects of a program, by their offsets, of one offset the largest first.
pub fn objects(program: &Program, layout: &Layout) -> Vec<Object> {
    let variables = addressable(program);
    if variables.is_empty() {
        return Vec::new();
    }
    let mut finder = Finder { program, layout, variables, found: BTreeMap::new() };
    for (_, offset, id) in roots(program, layout) {
        finder.search(offset, Type::Struct(id), 0);
    }
    finder.found.into_values().collect()
}

/// The structures that the state consists of, with their offsets: the globals, and each instance's.
pub(super) fn roots(program: &Program, layout: &Layout) -> Vec<(Option<usize>, u64, StructId)> {
    let instances = program.instances.iter().zip(&layout.machine.instances).enumerate();
    let instances = instances.map(|(at, (it, offset))| (Some(at), *offset, program.class(it.program).state));
    [(None, layout.machine.globals, program.globals)].into_iter().chain(instances).collect()
}

/// The repr of the numbers that a variable consists of, through all dimensions of an array.
pub(super) fn flat(program: &Program, ty: Type) -> Option<Repr> {
    match ty {
        Type::Array(id) => flat(program, program.array(id).element),
        Type::Elementary(it) => Some(it.repr()),
        Type::Subrange(..)
        | Type::Reference(_)
        | Type::String(_)
        | Type::Enum(_)
        | Type::Struct(_)
        | Type::Block(_) => None,
    }
}

pub(super) fn word(size: u64) -> u32 {
    u32::try_from(size).expect("sizes are below the limit of 1 GiB")
}

/// Where an object is among all: its offset, its size from the largest, whether it is plain, its mark.
type Order = (u64, core::cmp::Reverse<u64>, bool, u32);

struct Finder<'p> {
    program: &'p Program,
    layout: &'p Layout,
    variables: BTreeSet<(StructId, FieldId)>,
    found: BTreeMap<Order, Object>,
}

impl Finder<'_> {
    /// `mark` is that of the pool's place around, or 0.
    fn search(&mut self, offset: u64, ty: Type, mark: u32) {
        match ty {
            Type::Struct(id) => {
                let mark = if self.program.places.contains(&id) { word(offset) + 1 } else { mark };
                for (at, field) in self.program.structure(id).fields.iter().enumerate() {
                    let member = FieldId::next(at);
                    let start = offset + self.layout.field(id, member);
                    if self.variables.contains(&(id, member)) {
                        self.add(start, field.ty, mark);
                    }
                    self.search(start, field.ty, mark);
                }
            }
            Type::Array(id) if self.has_states(self.program.array(id).element) => {
                let array = self.program.array(id);
                for position in 0..array.len() {
                    self.search(offset + position * self.layout.stride(id), array.element, mark);
                }
            }
            Type::Array(_)
            | Type::Elementary(_)
            | Type::Subrange(..)
            | Type::Reference(_)
            | Type::String(_)
            | Type::Enum(_)
            | Type::Block(_) => {}
        }
    }

    fn add(&mut self, offset: u64, ty: Type, mark: u32) {
        // Compiled code looks at no mark, so it asks the runtime for what has one.
        let is_plain = mark == 0 && flat(self.program, ty).is_some_and(|it| it != Repr::Bool);
        let size = self.layout.size(ty);
        let order = (offset, core::cmp::Reverse(size), is_plain, mark);
        self.found.entry(order).or_insert(Object { offset, size, is_plain, mark, ty });
    }

    fn has_states(&self, ty: Type) -> bool {
        let is_state = |id| self.program.places.contains(&id) || self.program.class_of_state(id).is_some();
        self.program.instance_in(ty, &is_state).is_some()
    }
}
