//! Object files, for a linker to join with the runtime and a host.

use crate::program::{self, Also};
use crate::signature::PREFIX;
use crate::{Error, Target, debug, entry};
use cranelift_module::default_libcall_names;
use cranelift_object::object::SectionKind;
use cranelift_object::{ObjectBuilder, ObjectModule};
use staunch_ir::Program;
use staunch_ir::layout::Layout;
use staunch_ir::symbols::map_text;

/// A relocatable object with the entry points of a verified program: position independent where the target is ELF,
/// without unwind tables. It needs the symbols of `staunch-runtime-abi`, `memcpy`, `memmove` and
/// `memset`.
///
/// # Errors
/// If a function is too large for the code generator.
pub fn object(program: &Program, target: &Target) -> Result<Vec<u8>, Error> {
    object_named(program, target, PREFIX)
}

/// The same, with symbols that begin with `prefix` instead of `staunch`, so that several programs can be linked together.
///
/// # Errors
/// If a function is too large for the code generator.
pub fn object_named(program: &Program, target: &Target, prefix: &str) -> Result<Vec<u8>, Error> {
    if target.is_for_debugging() && !target.is_elf() {
        return Err(Error::Target(format!("`--debug` makes DWARF for Linux, and not for {}", target.name())));
    }
    let mut module = module(target)?;
    let emitted = program::emit_named(program, &mut module, Also::Nothing, prefix)?;
    entry::map(&mut module, prefix, &map_text(program, &Layout::new(program)))?;
    let mut product = module.finish();
    if target.is_elf() {
        // Without this section a linker takes the stack to be executable.
        let name = b".note.GNU-stack".to_vec();
        product.object.add_section(Vec::new(), name, SectionKind::Other);
    }
    if let Some(notes) = emitted.notes {
        debug::write(&mut product, program, &notes, target.architecture())?;
    }
    product.emit().map_err(|error| Error::Output(error.to_string()))
}

pub(crate) fn module(target: &Target) -> Result<ObjectModule, Error> {
    let isa = target.isa()?;
    let mut builder = ObjectBuilder::new(isa, "program.st", default_libcall_names())?;
    // A linker can then drop functions that nothing calls.
    builder.per_function_section(true);
    Ok(ObjectModule::new(builder))
}
