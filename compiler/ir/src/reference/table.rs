//! The table of objects, as the runtime reads it.

use super::objects::{Object, flat, objects, roots, word};
use crate::layout::Layout;
use crate::{ArrayId, FieldId, Program, Type};
use staunch_runtime::Repr;
use staunch_runtime::reference::{View, Wanted, encode};
use std::collections::HashMap;

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
    let objects = objects(program, layout);
    let mut builder = Builder::new(program, layout);
    let root = builder.state();
    let nodes: Vec<_> = objects.iter().map(|it| builder.node(it.ty)).collect();
    builder.words(root, &objects, &nodes)
}

struct Builder<'p> {
    program: &'p Program,
    layout: &'p Layout,
    nodes: Vec<Vec<u32>>,
    known: HashMap<Type, usize>,
}

impl<'p> Builder<'p> {
    fn new(program: &'p Program, layout: &'p Layout) -> Self {
        Self { program, layout, nodes: Vec::new(), known: HashMap::new() }
    }

    /// The node of the whole state.
    fn state(&mut self) -> usize {
        let members: Vec<_> =
            roots(self.program, self.layout).into_iter().map(|(_, offset, id)| (offset, Type::Struct(id))).collect();
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
        let (kind, repr) = flat(self.program, ty).map_or((u32::MAX, 0), |repr| (numbers(repr), encode::repr(repr)));
        let stride = word(self.layout.stride(id));
        self.push(vec![encode::ARRAY, size, exact(self.program, ty), stride, position(element), kind, repr])
    }

    /// Nodes are named by the positions of their words.
    fn words(self, root: usize, objects: &[Object], of_objects: &[usize]) -> Vec<u32> {
        let start = encode::HEAD + objects.len() * encode::OBJECT;
        let mut positions = Vec::with_capacity(self.nodes.len());
        let mut end = start;
        for node in &self.nodes {
            positions.push(position(end));
            end += node.len();
        }
        let at = |node: u32| positions[usize::try_from(node).expect("a u32 fits a usize")];
        let mut words = vec![position(objects.len()), positions[root], position(end)];
        words.extend(objects.iter().zip(of_objects).flat_map(|(it, node)| {
            let size = word(it.size);
            [word(it.offset), size, if it.is_plain { size } else { 0 }, it.mark, positions[*node]]
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
