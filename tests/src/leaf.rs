//! A program's state as the values of its variables: what executors must agree on. Padding, and
//! the bytes of a string after its length, are nobody's.

use staunch_ir::layout::{Layout, usize_of};
use staunch_ir::{Chars, FieldId, Program, Type, Value};

/// The bytes of every value in the state, in order of the layout.
#[derive(Debug)]
pub struct Leaves<'p> {
    program: &'p Program,
    layout: Layout,
}

impl<'p> Leaves<'p> {
    pub fn new(program: &'p Program) -> Self {
        Self { program, layout: Layout::new(program) }
    }

    pub fn layout(&self) -> &Layout {
        &self.layout
    }

    /// Path and value of each variable.
    pub fn of(&self, state: &[u8]) -> Vec<(String, String)> {
        self.values(state).into_iter().map(|it| (it.path, it.value.shown())).collect()
    }

    /// The variables as they are in the state, in order of the layout.
    pub fn values(&self, state: &[u8]) -> Vec<Leaf> {
        let mut leaves = Vec::new();
        let machine = &self.layout.machine;
        let mut read = |path: &str, ty, offset| self.read(path, ty, state, usize_of(offset), &mut leaves);
        read("Globals", Type::Struct(self.program.globals), machine.globals);
        for (instance, offset) in self.program.instances.iter().zip(&machine.instances) {
            read(&instance.name, Type::Struct(self.program.class(instance.program).state), *offset);
        }
        leaves
    }

    fn read(&self, path: &str, ty: Type, state: &[u8], start: usize, leaves: &mut Vec<Leaf>) {
        let bytes = &state[start..];
        match ty {
            Type::Elementary(_) | Type::Reference(_) | Type::Subrange(..) | Type::Enum(_) => {
                let repr = self.program.repr(ty).expect("an elementary type has a repr");
                leaves.push(Leaf::new(path, start, Read::Scalar(Value::read(repr, bytes))));
            }
            Type::String(it) => leaves.push(Leaf::new(path, start, Read::Text(Chars::read(it, bytes)))),
            Type::Array(id) => {
                let (array, stride) = (self.program.array(id), usize_of(self.layout.stride(id)));
                for (at, number) in (array.low..=array.high).enumerate() {
                    self.read(&format!("{path}[{number}]"), array.element, state, start + at * stride, leaves);
                }
            }
            Type::Struct(id) => {
                for (at, field) in self.program.structure(id).fields.iter().enumerate() {
                    let offset = start + usize_of(self.layout.offset(ty, FieldId::next(at)));
                    self.read(&format!("{path}.{}", field.name), field.ty, state, offset, leaves);
                }
            }
            Type::Block(id) => {
                for (at, pin) in id.info().pins.iter().enumerate() {
                    let repr = self.program.repr(id.pin_type(FieldId::next(at)).expect("a pin of the block"));
                    let value = Value::read(repr.expect("a pin has a repr"), &bytes[pin.offset..]);
                    leaves.push(Leaf::new(&format!("{path}.{}", pin.name), start + pin.offset, Read::Scalar(value)));
                }
            }
        }
    }
}

/// A variable, and where in the state it begins.
#[derive(Debug)]
pub struct Leaf {
    pub path: String,
    pub offset: usize,
    pub value: Read,
}

impl Leaf {
    fn new(path: &str, offset: usize, value: Read) -> Self {
        Self { path: path.to_owned(), offset, value }
    }
}

/// What a variable holds.
#[derive(Debug)]
pub enum Read {
    Scalar(Value),
    Text(Chars),
}

impl Read {
    fn shown(&self) -> String {
        match self {
            Self::Scalar(it) => scalar(*it),
            Self::Text(it) => format!("{:?}", it.text()),
        }
    }
}

/// A value as its bits, but for a NaN: which one it is, processors decide.
pub fn scalar(value: Value) -> String {
    match value {
        Value::F32(it) if it.is_nan() => "NaN".to_owned(),
        Value::F64(it) if it.is_nan() => "NaN".to_owned(),
        other => format!("{other:?}"),
    }
}
