//! The emitted text's own check that Rust lays its structures out as the compiler says.

use std::fmt::Write;

use staunch_ir::{FieldId, StructId, Type};

use crate::emitter::Emitter;

/// `const` assertions on every structure's size and its fields' offsets.
pub fn layout(emitter: &Emitter<'_>) -> String {
    // Constants that are not part of the state make its layout differ from the one that hosts know.
    if !emitter.constants.is_empty() {
        return String::new();
    }
    let structs = (0..emitter.program.structs.len()).map(StructId::next);
    let lines: Vec<String> = structs.map(|id| line(emitter, id)).collect();
    if lines.is_empty() {
        return String::new();
    }
    format!("{HEAD}{}{TAIL}", lines.concat())
}

const HEAD: &str = "
// Debuggers, hosts and native code rely on this layout.
const _: () = {
    macro_rules! layout {
        ($($name:ident $size:literal { $($field:ident $offset:literal)* })*) => {
            $(
                assert!(size_of::<$name>() == $size);
                $(assert!(core::mem::offset_of!($name, $field) == $offset);)*
            )*
        };
    }
    layout! {
";

const TAIL: &str = "    }
};
";

fn line(emitter: &Emitter<'_>, id: StructId) -> String {
    let size = emitter.layout.size(Type::Struct(id));
    let mut line = format!("        {} {size} {{", emitter.names.structure(id));
    for at in 0..emitter.program.structure(id).fields.len() {
        let field = FieldId::next(at);
        let (name, offset) = (emitter.names.field(id, field), emitter.layout.field(id, field));
        write!(line, " {name} {offset}").expect("writing to a String does not fail");
    }
    line.push_str(" }\n");
    line
}
