//! The table of objects, as the runtime reads it.

use super::addressable;
use crate::layout::Layout;
use crate::{ArrayId, FieldId, Program, StructId, Type};
use staunch_runtime::Repr;
use staunch_runtime::reference::{View, Wanted, encode};
use std::collections::{BTreeMap, BTreeSet, HashMap};

/// How an access sees a value of the type: what it is a value of must be a scalar or string.
pub fn view(program: &Program, ty: Type) -> View {
    match ty {
        Type::Elementary(it) if it.repr() == Repr::Bool => View::Truth,
        Type::Elementary(it) => View::Number(it.repr().size()),
        Type::String(it) => View::Text { wide: it.wide },
        Type::Enum(_) | Type::Subrange(..) | Type::Reference(_) | Type::Array(_) | Type::Struct(_) | Type::Block(_) => {
            View::Exact(exact(program, ty))
        }
    }
}

/// As what a variable of the type is handed on whole.
pub fn wanted(program: &Program, ty: Type) -> Wanted {
    match ty {
        Type::Elementary(it) => Wanted::Repr(it.repr()),
        Type::String(it) => Wanted::Text(it),
        Type::Enum(_) | Type::Subrange(..) | Type::Reference(_) | Type::Array(_) | Type::Struct(_) | Type::Block(_) => {
            Wanted::Exact(exact(program, ty))
        }
    }
}

/// The number of a type that is viewed as nothing else.
fn exact(program: &Program, ty: Type) -> u32 {
    let (kind, number) = match ty {
        Type::Enum(id) => (0, id.0),
        Type::Subrange(base, id) => (1, id.0 * 16 + encode::repr(base.repr())),
        // What it points to is checked when it is followed.
        Type::Reference(_) => (2, 0),
        Type::Block(id) => (3, id.0),
        Type::Struct(id) => (4, id.0),
        Type::Array(id) => (5, program.arrays.iter().position(|it| *it == program.array(id)).map_or(id.0, position)),
        Type::Elementary(_) | Type::String(_) => unreachable!("numbers and strings have views of their own"),
    };
    number << 3 | kind
}

fn position(at: usize) -> u32 {
    u32::try_from(at).expect("tables stay below 2^32 entries")
}

/// The words of the program's table; empty where it has no references.
pub fn table(program: &Program, layout: &Layout) -> Vec<u32> {
    if program.references.is_empty() {
        return Vec::new();
    }
    let mut builder = Builder::new(program, layout);
    let root = builder.state();
    let types: Vec<_> = builder.objects.values().copied().collect();
    let of_objects: Vec<_> = types.into_iter().map(|it| builder.node(it)).collect();
    builder.words(root, &of_objects)
}

/// The objects that references may name, by their numbers from 1: their offsets in the state and their sizes.
pub fn objects(program: &Program, layout: &Layout) -> Vec<(u64, u64)> {
    let objects = Builder::new(program, layout).objects;
    objects.into_keys().map(|(offset, size, ..)| (offset, size.0)).collect()
}

struct Builder<'p> {
    program: &'p Program,
    layout: &'p Layout,
    /// Offset, and size from the largest; whether all of it is numbers; its mark. The type is that of the outermost of
    /// the variables that are there.
    objects: BTreeMap<(u64, core::cmp::Reverse<u64>, bool, u32), Type>,
    nodes: Vec<Vec<u32>>,
    known: HashMap<Type, usize>,
}

impl<'p> Builder<'p> {
    fn new(program: &'p Program, layout: &'p Layout) -> Self {
        let mut builder = Self { program, layout, objects: BTreeMap::new(), nodes: Vec::new(), known: HashMap::new() };
        let variables = addressable(program);
        if !variables.is_empty() {
            for (offset, id) in builder.roots() {
                builder.find_objects(offset, Type::Struct(id), 0, &variables);
            }
        }
        builder
    }

    /// The structures that the state consists of.
    fn roots(&self) -> Vec<(u64, StructId)> {
        let instances = self.program.instances.iter().zip(&self.layout.machine.instances);
        let instances = instances.map(|(it, offset)| (*offset, self.program.class(it.program).state));
        [(self.layout.machine.globals, self.program.globals)].into_iter().chain(instances).collect()
    }

    /// `mark` is that of the pool's place around, or 0.
    fn find_objects(&mut self, offset: u64, ty: Type, mark: u32, variables: &BTreeSet<(StructId, FieldId)>) {
        match ty {
            Type::Struct(id) => {
                let mark = if self.program.places.contains(&id) { word(offset) + 1 } else { mark };
                for (at, field) in self.program.structure(id).fields.iter().enumerate() {
                    let member = FieldId::next(at);
                    let start = offset + self.layout.field(id, member);
                    if variables.contains(&(id, member)) {
                        // Compiled code looks at no mark, so it asks the runtime for what has one.
                        let plain = mark == 0 && self.flat(field.ty).is_some_and(|it| it != Repr::Bool);
                        let size = core::cmp::Reverse(self.layout.size(field.ty));
                        self.objects.entry((start, size, plain, mark)).or_insert(field.ty);
                    }
                    self.find_objects(start, field.ty, mark, variables);
                }
            }
            Type::Array(id) if self.has_states(self.program.array(id).element) => {
                let array = self.program.array(id);
                for position in 0..array.len() {
                    self.find_objects(offset + position * self.layout.stride(id), array.element, mark, variables);
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

    fn has_states(&self, ty: Type) -> bool {
        let is_state = |id| self.program.places.contains(&id) || self.program.class_of_state(id).is_some();
        self.program.instance_in(ty, &is_state).is_some()
    }

    /// The node of the whole state.
    fn state(&mut self) -> usize {
        let members: Vec<_> = self.roots().iter().map(|(offset, id)| (*offset, Type::Struct(*id))).collect();
        self.structure(self.layout.machine.size, u32::MAX, &members)
    }

    fn structure(&mut self, size: u64, id: u32, members: &[(u64, Type)]) -> usize {
        let mut words = vec![encode::STRUCTURE, word(size), id, position(members.len())];
        for (offset, ty) in members {
            let node = self.node(*ty);
            words.extend([word(*offset), position(node)]);
        }
        self.push(words)
    }

    fn push(&mut self, words: Vec<u32>) -> usize {
        self.nodes.push(words);
        self.nodes.len() - 1
    }

    fn node(&mut self, ty: Type) -> usize {
        if let Some(known) = self.known.get(&ty) {
            return *known;
        }
        let size = word(self.layout.size(ty));
        let node = match ty {
            Type::Elementary(it) => self.push(vec![numbers(it.repr()), size, encode::repr(it.repr()), 0]),
            Type::String(it) => self.push(vec![encode::TEXT, size, u32::from(it.capacity), u32::from(it.wide)]),
            Type::Enum(_) | Type::Subrange(..) | Type::Reference(_) | Type::Block(_) => {
                // Nothing trusts the number of an enumeration.
                let as_bytes = u32::from(matches!(ty, Type::Enum(_)));
                let id = exact(self.program, ty);
                self.push(vec![encode::EXACT, size, id, as_bytes])
            }
            Type::Array(id) => self.array(id, ty, size),
            Type::Struct(id) => {
                let fields = self.program.structure(id).fields.iter().enumerate();
                let members: Vec<_> =
                    fields.map(|(at, it)| (self.layout.field(id, FieldId::next(at)), it.ty)).collect();
                self.structure(self.layout.size(ty), exact(self.program, ty), &members)
            }
        };
        self.known.insert(ty, node);
        node
    }

    fn array(&mut self, id: ArrayId, ty: Type, size: u32) -> usize {
        let element = self.node(self.program.array(id).element);
        let (kind, repr) = self.flat(ty).map_or((u32::MAX, 0), |repr| (numbers(repr), encode::repr(repr)));
        let stride = word(self.layout.stride(id));
        self.push(vec![encode::ARRAY, size, exact(self.program, ty), stride, position(element), kind, repr])
    }

    /// The repr of the numbers that an array consists of, through all its dimensions.
    fn flat(&self, ty: Type) -> Option<Repr> {
        match ty {
            Type::Array(id) => self.flat(self.program.array(id).element),
            Type::Elementary(it) => Some(it.repr()),
            Type::Subrange(..)
            | Type::Reference(_)
            | Type::String(_)
            | Type::Enum(_)
            | Type::Struct(_)
            | Type::Block(_) => None,
        }
    }

    /// Nodes are named by the positions of their words.
    fn words(self, root: usize, of_objects: &[usize]) -> Vec<u32> {
        let start = encode::HEAD + self.objects.len() * encode::OBJECT;
        let mut positions = Vec::with_capacity(self.nodes.len());
        let mut end = start;
        for node in &self.nodes {
            positions.push(position(end));
            end += node.len();
        }
        let at = |node: u32| positions[usize::try_from(node).expect("a u32 fits a usize")];
        let mut words = vec![position(self.objects.len()), positions[root], position(end)];
        words.extend(self.objects.keys().zip(of_objects).flat_map(|((offset, size, plain, mark), node)| {
            let size = word(size.0);
            [word(*offset), size, if *plain { size } else { 0 }, *mark, positions[*node]]
        }));
        for mut node in self.nodes {
            match node[0] {
                encode::ARRAY => node[4] = at(node[4]),
                encode::STRUCTURE => node[4..].iter_mut().skip(1).step_by(2).for_each(|it| *it = at(*it)),
                _ => {}
            }
            words.extend(node);
        }
        words
    }
}

fn numbers(repr: Repr) -> u32 {
    if repr == Repr::Bool { encode::TRUTHS } else { encode::NUMBERS }
}

fn word(size: u64) -> u32 {
    u32::try_from(size).expect("sizes are below the limit of 1 GiB")
}
