//! Where references lead, as far as it is known before a program runs: the variables of a type among the objects, so
//! that a back end can look at the few places where one will be, and the object that holds a place. Targets that are not found
//! here are left to the [table](super::table), which decides every access.

use super::objects::{Object, objects, roots};
use super::table::wanted;
use crate::layout::Layout;
use crate::{Expr, FieldId};
use crate::{Place, Program, Projection, Root, Routine, StructId, Type};
use staunch_runtime::reference::Wanted;
use std::collections::HashMap;

/// A variable of the type, or all of them in an array, in one object.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Target {
    /// The object's number.
    pub object: u32,
    /// Where the first of them begins in the state, in bytes.
    pub offset: u64,
    /// The instance that it is in, by its position; `None` for the globals.
    pub instance: Option<usize>,
    /// The way to it from there.
    pub way: Vec<Step>,
}

/// A step from a variable to a part of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Step {
    Field(FieldId),
    /// The element at a position, from 0.
    Element(u64),
    /// Each of an array's elements, of so many bytes.
    Each {
        stride: u64,
        len: u64,
    },
}

/// The objects of a program.
#[derive(Debug)]
pub struct Targets<'p> {
    program: &'p Program,
    layout: Layout,
    objects: Vec<Object>,
}

/// A look-up compares with each: where there are more, the table is asked at once.
const MOST: usize = 16;
/// More are not looked for.
const ENOUGH: usize = 64;
/// Of so many instances it is asked whether a variable is in one object.
const INSTANCES: usize = 64;

impl<'p> Targets<'p> {
    pub fn new(program: &'p Program, layout: &Layout) -> Self {
        let objects = if program.references.is_empty() { Vec::new() } else { objects(program, layout) };
        Self { program, layout: layout.clone(), objects }
    }

    /// The variables of exactly this type that references may lead to, by their objects: those that are objects, or
    /// elements of one, before those further inside. None in a pool, where each access must check whether the object exists.
    pub fn lead_to(&self, ty: Type) -> Vec<Target> {
        if self.layout.size(ty) == 0 {
            return Vec::new();
        }
        let mut search = Search {
            targets: self,
            wanted: wanted(self.program, ty),
            is_held: HashMap::new(),
            way: Vec::new(),
            found: Vec::new(),
        };
        for (at, object) in self.objects.iter().enumerate().filter(|(_, it)| it.mark == 0) {
            if search.found.len() > ENOUGH {
                break;
            }
            search.object(at, object);
        }
        let mut found = search.found;
        for depth in (0..=MOST).rev() {
            if found.len() > MOST {
                found.retain(|it| it.0 < depth);
            }
        }
        found.into_iter().map(|it| it.1).collect()
    }

    /// The objects that are nothing but numbers, which may be seen as any number: their numbers, offsets and sizes.
    pub fn plain(&self) -> impl Iterator<Item = (u32, u64, u64)> {
        let plain = self.objects.iter().zip(1..).filter(|(it, _)| it.is_plain);
        plain.map(|(it, number)| (number, it.offset, it.size))
    }

    /// The number of the object that the address of a place is in, where that is one in all instances and for all
    /// subscripts.
    pub fn object_of(&self, routine: &Routine, place: &Place) -> Option<u32> {
        let (inside, size, is_whole) = self.extent(routine, place)?;
        let starts = match (place.root, routine.state) {
            (Root::Globals, _) => vec![self.layout.machine.globals],
            (Root::Instance, Some(state)) => self.instances_of(state)?,
            (Root::Instance | Root::Local(_) | Root::Param(_), _) => return None,
        };
        let mut numbers = starts.into_iter().map(|it| self.holding(it + inside, size, is_whole));
        let first = numbers.next()??;
        numbers.all(|it| it == Some(first)).then_some(first)
    }

    /// Where a place begins in its root, and its size: of an array's, where the subscript is not constant.
    fn extent(&self, routine: &Routine, place: &Place) -> Option<(u64, u64, bool)> {
        let mut ty = self.program.root_type(routine, place.root)?;
        let mut offset = 0;
        for projection in &place.projections {
            match (projection, ty) {
                (Projection::Deref { .. }, _) => return None,
                (Projection::Field(field), _) => offset += self.layout.offset(ty, *field),
                (Projection::Index { index, .. }, Type::Array(id)) => match self.constant_position(index, ty) {
                    Some(position) => offset += position * self.layout.stride(id),
                    None => return Some((offset, self.layout.size(ty), false)),
                },
                (Projection::Index { .. }, _) => return None,
            }
            ty = self.program.part(ty, projection)?;
        }
        Some((offset, self.layout.size(ty), true))
    }

    fn constant_position(&self, index: &Expr, array: Type) -> Option<u64> {
        let Type::Array(id) = array else { return None };
        crate::loops::constant_position(self.program, index, id)
    }

    /// The smallest object that holds these bytes; where it is asked for all elements of an array, none of them may be
    /// in another.
    fn holding(&self, offset: u64, size: u64, is_whole: bool) -> Option<u32> {
        let end = offset + size;
        let after = self.objects.partition_point(|it| it.offset <= offset);
        let inner = |it: &&Object| it.offset < end && it.size < size;
        let mut from_here = self.objects.iter().skip(self.objects.partition_point(|it| it.offset < offset));
        if !is_whole && from_here.by_ref().take_while(|it| it.offset < end).any(|it| inner(&it)) {
            return None;
        }
        let holds = |it: &Object| end <= it.offset + it.size;
        let position = self.objects[..after].iter().rposition(holds)?;
        u32::try_from(position + 1).ok()
    }

    /// Where the instances of a state are; `None` if there are many.
    fn instances_of(&self, state: StructId) -> Option<Vec<u64>> {
        let mut found = Vec::new();
        for (_, offset, id) in roots(self.program, &self.layout) {
            self.find_instances(Type::Struct(id), offset, state, &mut found)?;
        }
        Some(found)
    }

    fn find_instances(&self, ty: Type, offset: u64, state: StructId, found: &mut Vec<u64>) -> Option<()> {
        match ty {
            Type::Struct(id) if id == state => {
                found.push(offset);
                return (found.len() < INSTANCES).then_some(());
            }
            Type::Struct(id) if self.program.holds(ty, |it| it == Type::Struct(state)) => {
                for (at, field) in self.program.structure(id).fields.iter().enumerate() {
                    let start = offset + self.layout.field(id, FieldId::next(at));
                    self.find_instances(field.ty, start, state, found)?;
                }
            }
            Type::Array(id) if self.program.holds(ty, |it| it == Type::Struct(state)) => {
                let array = self.program.array(id);
                for position in 0..array.len() {
                    self.find_instances(array.element, offset + position * self.layout.stride(id), state, found)?;
                }
            }
            Type::Struct(_)
            | Type::Array(_)
            | Type::Elementary(_)
            | Type::Subrange(..)
            | Type::Reference(_)
            | Type::String(_)
            | Type::Enum(_)
            | Type::Block(_) => {}
        }
        Some(())
    }

    /// The instance that an object is in, and the way to it from there.
    fn way_to(&self, object: &Object) -> Option<(Option<usize>, Vec<Step>)> {
        let within = |start: u64, ty: Type| start <= object.offset && object.offset < start + self.layout.size(ty);
        let (instance, mut start, root) =
            roots(self.program, &self.layout).into_iter().find(|it| within(it.1, Type::Struct(it.2)))?;
        let (mut ty, mut way) = (Type::Struct(root), Vec::new());
        while !(start == object.offset && ty == object.ty && !way.is_empty()) {
            match ty {
                Type::Struct(id) => {
                    let fields = self.program.structure(id).fields.iter().enumerate();
                    let mut fields = fields.map(|(at, it)| (FieldId::next(at), it.ty));
                    let (field, of_field) = fields.find(|(at, it)| within(start + self.layout.field(id, *at), *it))?;
                    way.push(Step::Field(field));
                    start += self.layout.field(id, field);
                    ty = of_field;
                }
                Type::Array(id) => {
                    let position = (object.offset - start) / self.layout.stride(id);
                    way.push(Step::Element(position));
                    start += position * self.layout.stride(id);
                    ty = self.program.array(id).element;
                }
                Type::Elementary(_)
                | Type::Subrange(..)
                | Type::Reference(_)
                | Type::String(_)
                | Type::Enum(_)
                | Type::Block(_) => return None,
            }
        }
        Some((instance, way))
    }
}

struct Search<'t, 'p> {
    targets: &'t Targets<'p>,
    wanted: Wanted,
    is_held: HashMap<Type, bool>,
    /// The way from the object to what is looked at.
    way: Vec<Step>,
    found: Vec<(usize, Target)>,
}

impl Search<'_, '_> {
    fn object(&mut self, position: usize, object: &Object) {
        if !self.holds(object.ty) {
            return;
        }
        let Some((instance, before)) = self.targets.way_to(object) else { return };
        let Ok(number) = u32::try_from(position + 1) else { return };
        let mut inside = Vec::new();
        self.within(object.ty, object.offset, &mut inside);
        for (offset, way) in inside {
            let depth = way.iter().filter(|it| matches!(it, Step::Field(_))).count();
            let way = before.iter().copied().chain(way).collect();
            self.found.push((depth, Target { object: number, offset, instance, way }));
        }
    }

    fn within(&mut self, ty: Type, offset: u64, found: &mut Vec<(u64, Vec<Step>)>) {
        let Targets { program, layout, .. } = self.targets;
        if found.len() >= MOST || !self.holds(ty) {
            return;
        }
        if wanted(program, ty) == self.wanted {
            return found.push((offset, self.way.clone()));
        }
        match ty {
            Type::Struct(id) => {
                for (at, field) in program.structure(id).fields.iter().enumerate() {
                    let member = FieldId::next(at);
                    self.way.push(Step::Field(member));
                    self.within(field.ty, offset + layout.field(id, member), found);
                    self.way.pop();
                }
            }
            Type::Array(id) => {
                let array = program.array(id);
                self.way.push(Step::Each { stride: layout.stride(id), len: array.len() });
                self.within(array.element, offset, found);
                self.way.pop();
            }
            Type::Elementary(_)
            | Type::Subrange(..)
            | Type::Reference(_)
            | Type::String(_)
            | Type::Enum(_)
            | Type::Block(_) => {}
        }
    }

    fn holds(&mut self, ty: Type) -> bool {
        if let Some(known) = self.is_held.get(&ty) {
            return *known;
        }
        let program = self.targets.program;
        let found = wanted(program, ty) == self.wanted
            || match ty {
                Type::Struct(id) => program.structure(id).fields.iter().any(|it| self.holds(it.ty)),
                Type::Array(id) => self.holds(program.array(id).element),
                Type::Elementary(_)
                | Type::Subrange(..)
                | Type::Reference(_)
                | Type::String(_)
                | Type::Enum(_)
                | Type::Block(_) => false,
            };
        self.is_held.insert(ty, found);
        found
    }
}
