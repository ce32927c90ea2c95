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
        let mut leaves = Vec::new();
        let machine = &self.layout.machine;
        self.read("Globals", Type::Struct(self.program.globals), &state[usize_of(machine.globals)..], &mut leaves);
        for (instance, offset) in self.program.instances.iter().zip(&machine.instances) {
            let ty = self.program.class(instance.program).state;
            self.read(&instance.name, Type::Struct(ty), &state[usize_of(*offset)..], &mut leaves);
        }
        leaves
    }

    fn read(&self, path: &str, ty: Type, bytes: &[u8], leaves: &mut Vec<(String, String)>) {
        match ty {
            Type::Elementary(_) | Type::Reference(_) | Type::Subrange(..) | Type::Enum(_) => {
                let repr = self.program.repr(ty).expect("an elementary type has a repr");
                leaves.push((path.to_owned(), scalar(Value::read(repr, bytes))));
            }
            Type::String(it) => {
                leaves.push((path.to_owned(), format!("{:?}", Chars::read(it, bytes).text())));
            }
            Type::Array(id) => {
                let (array, stride) = (self.program.array(id), usize_of(self.layout.stride(id)));
                for (at, number) in (array.low..=array.high).enumerate() {
                    self.read(&format!("{path}[{number}]"), array.element, &bytes[at * stride..], leaves);
                }
            }
            Type::Struct(id) => {
                for (at, field) in self.program.structure(id).fields.iter().enumerate() {
                    let offset = usize_of(self.layout.offset(ty, FieldId::next(at)));
                    self.read(&format!("{path}.{}", field.name), field.ty, &bytes[offset..], leaves);
                }
            }
            Type::Block(id) => {
                for (at, pin) in id.info().pins.iter().enumerate() {
                    let repr = self.program.repr(id.pin_type(FieldId::next(at)).expect("a pin of the block"));
                    let value = Value::read(repr.expect("a pin has a repr"), &bytes[pin.offset..]);
                    leaves.push((format!("{path}.{}", pin.name), scalar(value)));
                }
            }
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
