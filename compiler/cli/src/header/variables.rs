//! A macro for each elementary variable of the state, and the place of each other one.

use super::constants::is_constant;
use super::names::Names;
use super::types::c_type;
use staunch_ir::layout::Layout;
use staunch_ir::{FieldId, Program, Projection, Repr, StructId, Type};
use std::fmt::Write;

pub fn variables(program: &Program, layout: &Layout, names: &mut Names) -> String {
    let mut macros = Macros { program, layout, names, text: String::new() };
    macros.instances();
    macros.text
}

/// Writes the macros of instances and variables.
struct Macros<'a> {
    program: &'a Program,
    layout: &'a Layout,
    names: &'a mut Names,
    text: String,
}

impl Macros<'_> {
    /// For each elementary variable, a pointer to it in the state.
    fn instances(&mut self) {
        let (program, layout) = (self.program, self.layout);
        for (number, instance) in program.instances.iter().enumerate() {
            let class = program.class(instance.program);
            let _ = write!(self.text, "\n/* Instance {number}: {} of PROGRAM {} */\n", instance.name, class.name);
            let name = self.names.claim(&[&instance.name]);
            let _ = writeln!(self.text, "#define {name} {number}u");
            self.structure(class.state, layout.machine.instances[number], &instance.name);
        }
        if !program.structure(program.globals).fields.is_empty() {
            self.text.push_str("\n/* Global variables */\n");
            self.structure(program.globals, layout.machine.globals, "Globals");
        }
        program.aliases.iter().for_each(|it| self.view(it));
    }

    /// A variable that shares its bits with another one: it may be at any byte.
    fn view(&mut self, variable: &staunch_ir::Variable) {
        let (Some(view), Some(Projection::Field(field))) = (variable.view, variable.place.projections.first()) else {
            return;
        };
        let start = self.layout.machine.globals + self.layout.field(self.program.globals, *field);
        let name = self.names.claim(&["OFFSET", "Globals", &variable.name]);
        let (ty, offset) = (self.program.type_name(view.ty), start + view.bit / 8);
        let _ = match view.address.width {
            1 => writeln!(self.text, "#define {name} {offset}u /* {ty}, bit {} */", view.bit % 8),
            _ => writeln!(self.text, "#define {name} {offset}u /* {ty} */"),
        };
    }

    /// Variables come before the pins of blocks: a declared name is kept where the two meet.
    fn structure(&mut self, id: StructId, base: u64, owner: &str) {
        let (program, layout) = (self.program, self.layout);
        let fields = &program.structure(id).fields;
        let names: Vec<_> = fields
            .iter()
            .map(|field| match field.ty {
                _ if is_constant(program, field) => String::new(),
                Type::Block(_) => String::new(),
                Type::Elementary(_) | Type::Reference(_) | Type::Subrange(..) | Type::Enum(_) => {
                    self.names.claim(&[owner, &field.name])
                }
                Type::String(_) | Type::Array(_) | Type::Struct(_) => self.names.claim(&["OFFSET", owner, &field.name]),
            })
            .collect();
        for (at, (field, name)) in fields.iter().zip(names).enumerate() {
            let offset = base + layout.field(id, FieldId::next(at));
            match field.ty {
                _ if is_constant(program, field) => {}
                Type::Block(block) => {
                    for (at, pin) in block.info().pins.iter().enumerate() {
                        let place = offset + layout.offset(field.ty, FieldId::next(at));
                        let name = self.names.claim(&[owner, &field.name, pin.name]);
                        variable(&name, pin.repr(), place, &mut self.text);
                    }
                }
                Type::Elementary(_) | Type::Reference(_) | Type::Subrange(..) | Type::Enum(_) => {
                    if let Some(repr) = program.repr(field.ty) {
                        variable(&name, repr, offset, &mut self.text);
                    }
                }
                Type::String(_) | Type::Array(_) | Type::Struct(_) => {
                    let ty = program.type_name(field.ty);
                    let _ = writeln!(self.text, "#define {name} {offset}u /* {ty} */");
                }
            }
        }
    }
}

fn variable(name: &str, repr: Repr, offset: u64, text: &mut String) {
    let ty = c_type(repr);
    let _ = writeln!(text, "#define {name}(state) (*({ty} *)((state) + {offset}))");
}
