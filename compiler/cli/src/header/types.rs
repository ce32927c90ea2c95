//! The structures of a header, each after what it holds, with assertions of its layout.

use super::names::{Names, plain, variable};
use staunch_ir::layout::Layout;
use staunch_ir::{BlockId, FieldId, Program, Repr, StructId, Type};
use std::collections::HashSet;
use std::fmt::Write;

pub struct Types<'a> {
    pub program: &'a Program,
    layout: &'a Layout,
    names: &'a Names,
    /// What is defined.
    named: HashSet<String>,
    /// The macros that say so of what several headers may define, without `STAUNCH_`.
    pub guards: Vec<String>,
    pub text: String,
}

/// A member that has bytes.
struct Member {
    declared: String,
    name: String,
    offset: u64,
    /// Its type in Structured Text.
    ty: String,
}

impl<'a> Types<'a> {
    pub fn new(program: &'a Program, layout: &'a Layout, names: &'a Names) -> Self {
        Self { program, layout, names, named: HashSet::new(), guards: Vec::new(), text: String::new() }
    }

    /// The whole state: the global variables, and each instance by its name.
    pub fn state(&mut self) {
        let machine = &self.layout.machine;
        let instances = self.program.instances.iter().zip(&machine.instances);
        let instances = instances.map(|(it, offset)| (it.name.as_str(), self.program.class(it.program).state, *offset));
        let parts: Vec<_> =
            std::iter::once(("globals", self.program.globals, machine.globals)).chain(instances).collect();
        parts.iter().for_each(|it| self.define(Type::Struct(it.1)));
        let members = self.members(parts.iter().map(|it| (it.0, Type::Struct(it.1), it.2)));
        let note = format!("The whole state. `{}` takes a pointer to it as `uint8_t *`.", self.names.symbol("init"));
        let tag = self.names.symbol("state");
        self.structure(&note, &tag, machine.align, machine.size, &members);
    }

    /// Defines the structures that a type needs.
    pub fn define(&mut self, ty: Type) {
        match ty {
            Type::Array(id) => self.define(self.program.array(id).element),
            Type::String(it) => {
                let unit = if it.wide { "uint16_t" } else { "uint8_t" };
                let body = format!("{{ uint16_t length; {unit} units[{}]; }};", it.capacity);
                self.shared(ty, |_, name| format!("{name} {body}\n"));
            }
            Type::Struct(id) => self.declared_structure(id),
            Type::Block(id) => self.block(id),
            Type::Elementary(_) | Type::Subrange(..) | Type::Enum(_) | Type::Reference(_) => {}
        }
    }

    /// A type that the headers of other programs may have, too.
    fn shared(&mut self, ty: Type, define: impl FnOnce(&mut Self, &str) -> String) {
        let name = self.element(ty);
        if self.named.insert(name.clone()) {
            let text = define(self, &name);
            let guard = name.trim_start_matches("struct staunch_").to_ascii_uppercase();
            let _ = write!(self.text, "\n#ifndef STAUNCH_{guard}\n#define STAUNCH_{guard}\n{text}#endif\n");
            self.guards.push(guard);
        }
    }

    /// A standard block, with its memory.
    fn block(&mut self, id: BlockId) {
        let ty = Type::Block(id);
        self.shared(ty, |this, name| {
            let pins = id.info().pins.iter().enumerate().map(|(at, pin)| {
                let name = variable(pin.name);
                let declared = format!("{} {name}", c_type(pin.repr()));
                let of = pin.ty.name().to_owned();
                Member { declared, name, offset: this.layout.offset(ty, FieldId::next(at)), ty: of }
            });
            let pins: Vec<_> = pins.collect();
            body(name.trim_start_matches("struct "), 1, this.layout.size(ty), &pins)
        });
    }

    fn declared_structure(&mut self, id: StructId) {
        let structure = self.program.structure(id);
        structure.fields.iter().for_each(|it| self.define(it.ty));
        let tag = self.tag(id);
        if !self.named.insert(tag.clone()) {
            return;
        }
        let fields = structure.fields.iter().enumerate();
        let fields = fields.map(|(at, it)| (it.name.as_str(), it.ty, self.layout.field(id, FieldId::next(at))));
        let members = self.members(fields);
        let (align, size) = (structure.align, self.layout.size(Type::Struct(id)));
        let name = structure.name.clone();
        self.structure(&name, &tag, align, size, &members);
    }

    fn members<'n>(&self, fields: impl Iterator<Item = (&'n str, Type, u64)>) -> Vec<Member> {
        let mut taken = HashSet::new();
        let with_bytes = fields.filter(|it| self.layout.size(it.1) > 0);
        let member = |(name, ty, offset): (&str, Type, u64)| {
            let mut name = variable(name);
            while !taken.insert(name.clone()) {
                name.push('_');
            }
            Member { declared: self.declared(ty, &name), name, offset, ty: self.program.type_name(ty) }
        };
        with_bytes.map(member).collect()
    }

    fn structure(&mut self, note: &str, tag: &str, align: u64, size: u64, members: &[Member]) {
        let _ = write!(self.text, "\n/* {} */\n{}", note.replace("*/", "* /"), body(tag, align, size, members));
    }

    /// `int16_t x[3][4]`: the outer bounds come first.
    fn declared(&self, ty: Type, name: &str) -> String {
        let mut text = name.to_owned();
        let mut element = ty;
        while let Type::Array(id) = element {
            let array = self.program.array(id);
            let _ = write!(text, "[{}]", array.len());
            element = array.element;
        }
        format!("{} {text}", self.element(ty))
    }

    /// A type, or that of an array's elements.
    pub fn element(&self, ty: Type) -> String {
        match ty {
            Type::Array(id) => self.element(self.program.array(id).element),
            Type::String(it) if it.wide => format!("struct staunch_wstring_{}", it.capacity),
            Type::String(it) => format!("struct staunch_string_{}", it.capacity),
            Type::Struct(id) => format!("struct {}", self.tag(id)),
            Type::Elementary(_) | Type::Subrange(..) | Type::Enum(_) | Type::Reference(_) => {
                self.program.repr(ty).map_or("void", c_type).to_owned()
            }
            Type::Block(id) => {
                let name = format!("{}_{}", id.info().family.name(), id.info().name);
                format!("struct staunch_{}", plain(&name).to_ascii_lowercase())
            }
        }
    }

    /// With its number, where another one has the same name in C: `A.B` and `A_B`.
    fn tag(&self, id: StructId) -> String {
        let name = plain(&self.program.structure(id).name);
        let others = &self.program.structs[..id.index()];
        let is_taken = others.iter().any(|it| plain(&it.name) == name);
        self.names.tag(&if is_taken { format!("{name}_{}", id.0) } else { name })
    }
}

/// C has no structure without members.
fn body(tag: &str, align: u64, size: u64, members: &[Member]) -> String {
    if members.is_empty() {
        return format!("struct {tag};\n");
    }
    let mut text = format!("struct {tag} {{\n");
    for (at, member) in members.iter().enumerate() {
        let aligned = if at == 0 && align > 1 { format!("STAUNCH_ALIGNED({align}) ") } else { String::new() };
        let _ = writeln!(text, "    {aligned}{}; /* {} */", member.declared, member.ty);
    }
    let _ = writeln!(text, "}};\nSTAUNCH_ASSERT(sizeof(struct {tag}) == {size});");
    for Member { name, offset, .. } in members {
        let _ = writeln!(text, "STAUNCH_ASSERT(offsetof(struct {tag}, {name}) == {offset});");
    }
    text
}

/// The type of C that has a repr's values.
pub fn c_type(repr: Repr) -> &'static str {
    match repr {
        Repr::Bool => "bool",
        Repr::I8 => "int8_t",
        Repr::I16 => "int16_t",
        Repr::I32 => "int32_t",
        Repr::I64 => "int64_t",
        Repr::U8 => "uint8_t",
        Repr::U16 => "uint16_t",
        Repr::U32 => "uint32_t",
        Repr::U64 => "uint64_t",
        Repr::F32 => "float",
        Repr::F64 => "double",
    }
}
