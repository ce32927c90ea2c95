//! The part of a C header for what a program calls and C implements: prototypes, and the structures that they name.

use staunch_ir::layout::Layout;
use staunch_ir::{External, Program, Repr, StructId, Type};
use std::collections::BTreeSet;
use std::fmt::Write;

/// Words that cannot be names in C or C++, but can be in Structured Text.
const WORDS: &[&str] = &[
    "alignas",
    "asm",
    "auto",
    "bool",
    "break",
    "catch",
    "char",
    "class",
    "const",
    "default",
    "delete",
    "double",
    "enum",
    "explicit",
    "export",
    "extern",
    "float",
    "friend",
    "goto",
    "inline",
    "int",
    "long",
    "namespace",
    "new",
    "operator",
    "private",
    "protected",
    "public",
    "register",
    "restrict",
    "short",
    "signed",
    "sizeof",
    "static",
    "struct",
    "switch",
    "template",
    "throw",
    "typedef",
    "typename",
    "union",
    "unsigned",
    "using",
    "virtual",
    "void",
    "volatile",
];

/// Nothing for a program that calls nothing outside.
pub fn prototypes(program: &Program, layout: &Layout) -> String {
    let externals = program.externals();
    if externals.is_empty() {
        return String::new();
    }
    let mut types = Types { program, layout, named: BTreeSet::new(), text: String::new() };
    types.text.push_str(
        "\n/* What the program calls: implement it, and link it with the program. A FUNCTION_BLOCK gets its instance and\n   \
         the context of the scan; what is no number is passed by a pointer, which is to no other parameter. Write values\n   \
         of the variables' types. */\n",
    );
    let all = |it: &External| {
        let params = it.params.iter().map(|it| it.ty).collect::<Vec<_>>();
        it.state.map(Type::Struct).into_iter().chain(params).chain(it.result).collect::<Vec<_>>()
    };
    externals.iter().flat_map(|it| all(it)).for_each(|it| types.define(it));
    let lines = externals.iter().map(|it| types.prototype(it)).collect::<String>();
    types.text + "\n" + &lines
}

/// Writes the structures, each after what it holds.
struct Types<'a> {
    program: &'a Program,
    layout: &'a Layout,
    named: BTreeSet<String>,
    text: String,
}

impl Types<'_> {
    fn define(&mut self, ty: Type) {
        match ty {
            Type::Array(id) => self.define(self.program.array(id).element),
            Type::String(it) => {
                let name = self.element(ty);
                if self.named.insert(name.clone()) {
                    let unit = if it.wide { "uint16_t" } else { "uint8_t" };
                    let _ = writeln!(self.text, "{name} {{ uint16_t length; {unit} units[{}]; }};", it.capacity);
                }
            }
            Type::Struct(id) => self.structure(id, ty),
            Type::Elementary(_) | Type::Subrange(..) | Type::Enum(_) | Type::Reference(_) | Type::Block(_) => {}
        }
    }

    fn structure(&mut self, id: StructId, ty: Type) {
        let structure = self.program.structure(id);
        structure.fields.iter().for_each(|it| self.define(it.ty));
        let name = self.element(ty);
        if !self.named.insert(name.clone()) {
            return;
        }
        let align = if structure.align > 1 { format!("_Alignas({}) ", structure.align) } else { String::new() };
        let fields = structure.fields.iter().map(|it| format!("    {};", self.declared(it.ty, &it.name)));
        let fields = fields.collect::<Vec<_>>().join("\n");
        let _ = writeln!(self.text, "{name} {{\n{}{fields}\n}};", align);
        let size = self.layout.size(ty);
        let _ = writeln!(
            self.text,
            "#ifndef __cplusplus\n_Static_assert(sizeof({name}) == {size}, \"the layout of {}\");\n#endif",
            structure.name
        );
    }

    /// `int16_t x[3][4]`: the outer bounds come first.
    fn declared(&self, ty: Type, name: &str) -> String {
        let mut text = variable(name);
        let mut element = ty;
        while let Type::Array(id) = element {
            let array = self.program.array(id);
            let _ = write!(text, "[{}]", array.len());
            element = array.element;
        }
        format!("{} {text}", self.element(ty))
    }

    /// A type, or that of an array's elements.
    fn element(&self, ty: Type) -> String {
        match ty {
            Type::Array(id) => self.element(self.program.array(id).element),
            Type::String(it) if it.wide => format!("struct staunch_wstring_{}", it.capacity),
            Type::String(it) => format!("struct staunch_string_{}", it.capacity),
            Type::Struct(id) => format!("struct {}", self.tag(id)),
            Type::Elementary(_) | Type::Subrange(..) | Type::Enum(_) | Type::Reference(_) => {
                self.program.repr(ty).map_or("void", c_type).to_owned()
            }
            Type::Block(id) => unreachable!("verified IR: {} is not passed outside", id.info().name),
        }
    }

    /// With its number, where another one has the same name in C: `A.B` and `A_B`.
    fn tag(&self, id: StructId) -> String {
        let name = plain(&self.program.structure(id).name);
        let others = &self.program.structs[..id.index()];
        if others.iter().any(|it| plain(&it.name) == name) { format!("{name}_{}", id.0) } else { name }
    }

    fn prototype(&self, it: &External) -> String {
        let mut params = Vec::new();
        if let Some(state) = it.state {
            params.push(format!("{} *block", self.element(Type::Struct(state))));
            params.push("const staunch_context *cx".to_owned());
        }
        for param in &it.params {
            let (ty, name) = (self.element(param.ty), parameter(&param.name));
            params.push(match (param.by_reference, self.program.repr(param.ty)) {
                (true, _) => format!("{ty} *{name}"),
                (false, Some(_)) => format!("{ty} {name}"),
                (false, None) => format!("const {ty} *{name}"),
            });
        }
        let result = it.result.map(|ty| (self.program.repr(ty), self.element(ty)));
        let returned = match result {
            Some((Some(_), ty)) => ty,
            Some((None, ty)) => {
                params.push(format!("{ty} *result"));
                "void".to_owned()
            }
            None => "void".to_owned(),
        };
        let params = if params.is_empty() { "void".to_owned() } else { params.join(", ") };
        let kind = if it.state.is_some() { "FUNCTION_BLOCK" } else { "FUNCTION" };
        format!("/* {kind} {} */\n{returned} {}({params});\n", it.name, it.symbol)
    }
}

/// A name in letters of C.
fn plain(name: &str) -> String {
    name.chars().map(|it| if it.is_ascii_alphanumeric() { it } else { '_' }).collect()
}

fn variable(name: &str) -> String {
    let mut name = plain(name);
    if WORDS.contains(&name.as_str()) {
        name.push('_');
    }
    name
}

/// The instance, the context and the result have names of their own.
fn parameter(name: &str) -> String {
    let name = variable(name);
    if ["block", "cx", "result"].contains(&name.as_str()) { format!("{name}_") } else { name }
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
