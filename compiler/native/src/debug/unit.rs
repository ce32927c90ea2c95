//! All debug information of an object.

use super::entries::Entries;
use super::lines::{files, path_bytes, place, sequence};
use super::notes::{Compiled, CompiledRoutine, Notes};
use super::sections::{Section, put};
use crate::Error;
use cranelift_object::ObjectProduct;
use gimli::constants::{
    DW_AT_comp_dir, DW_AT_decl_file, DW_AT_decl_line, DW_AT_frame_base, DW_AT_high_pc, DW_AT_identifier_case,
    DW_AT_language, DW_AT_low_pc, DW_AT_producer, DW_AT_ranges, DW_AT_stmt_list, DW_ID_case_insensitive,
    DW_LANG_Pascal83, DW_TAG_subprogram,
};
use gimli::write::{
    Address, AttributeValue, Expression, FileId, FrameTable, LineProgram, LineString, Range, RangeList, Sections,
};
use gimli::{AArch64, LineEncoding, Register, RiscV, X86_64};
use staunch_ir::layout::Layout;
use staunch_ir::{Program, StructId, Type};
use target_lexicon::Architecture;

/// Relative paths are seen from where the debugger is started.
const FOLDER: &str = ".";
const PRODUCER: &str = concat!("staunch ", env!("CARGO_PKG_VERSION"));

/// Adds the debug information of a program to its object.
pub(crate) fn write(
    product: &mut ObjectProduct,
    program: &Program,
    notes: &Notes,
    machine: Architecture,
) -> Result<(), Error> {
    let mut symbols: Vec<_> = notes.functions.iter().map(|it| product.function_symbol(it.id)).collect();
    symbols.push(product.data_symbol(notes.state));
    let layout = Layout::new(program);
    let mut entries = Entries::new(program, &layout, symbol(notes.functions.len()));
    let files = begin(&mut entries);
    // A structure is after those that it contains, so that none leads to a long chain of others.
    for at in 0..program.structs.len() {
        entries.type_of(Type::Struct(StructId::next(at)));
    }
    // A PROGRAM's instance may have its name: a debugger takes the first of the two.
    entries.of_program();
    for (at, function) in notes.functions.iter().enumerate() {
        if let Some(routine) = &function.routine {
            subprogram(&mut entries, &files, function, (routine, symbol(at)), machine);
        }
        sequence(&mut entries, &files, function, symbol(at));
    }
    end(&mut entries);
    let mut sections = Sections::new(Section::new());
    let failed = |error: gimli::write::Error| Error::Output(error.to_string());
    entries.dwarf.write(&mut sections).map_err(failed)?;
    frames(notes).write_debug_frame(&mut sections.debug_frame).map_err(failed)?;
    put(&mut product.object, &sections, &symbols)
}

/// A symbol by its position in the list of all.
fn symbol(at: usize) -> Address {
    Address::Symbol { symbol: at, addend: 0 }
}

/// What is said of the program as a whole, and its sources.
fn begin(entries: &mut Entries<'_>) -> Vec<FileId> {
    let program = entries.program;
    let name = path_bytes(program.files.first().map_or("", |it| &it.path));
    let (folder, first) = (LineString::String(FOLDER.into()), LineString::String(name.clone()));
    let lines = LineProgram::new(Entries::encoding(), LineEncoding::default(), folder, None, first, None);
    entries.dwarf.unit.line_program = lines;
    let root = entries.root();
    entries.name(root, &String::from_utf8_lossy(&name));
    let text = |entries: &mut Entries<'_>, it: &str| AttributeValue::StringRef(entries.dwarf.strings.add(it));
    let (folder, producer) = (text(entries, FOLDER), text(entries, PRODUCER));
    entries.set(root, DW_AT_comp_dir, folder);
    entries.set(root, DW_AT_producer, producer);
    entries.set(root, DW_AT_language, AttributeValue::Language(DW_LANG_Pascal83));
    entries.set(root, DW_AT_identifier_case, AttributeValue::IdentifierCase(DW_ID_case_insensitive));
    entries.set(root, DW_AT_stmt_list, AttributeValue::LineProgramRef);
    files(entries, program)
}

/// Functions are in sections of their own, which a linker moves and drops.
fn end(entries: &mut Entries<'_>) {
    let ranges = RangeList(core::mem::take(&mut entries.ranges));
    let ranges = entries.dwarf.unit.ranges.add(ranges);
    let root = entries.root();
    entries.set(root, DW_AT_low_pc, AttributeValue::Address(Address::Constant(0)));
    entries.set(root, DW_AT_ranges, AttributeValue::RangeListRef(ranges));
}

fn subprogram(
    entries: &mut Entries<'_>,
    files: &[FileId],
    function: &Compiled,
    (routine, address): (&CompiledRoutine, Address),
    machine: Architecture,
) {
    let of = entries.program.routine(routine.id);
    let root = entries.root();
    let id = entries.add_named(root, DW_TAG_subprogram, &entries.program.title(of));
    if let Some((file, line)) = place(files, of.location) {
        entries.set(id, DW_AT_decl_file, AttributeValue::FileIndex(Some(file)));
        entries.set(id, DW_AT_decl_line, AttributeValue::Udata(line));
    }
    entries.set(id, DW_AT_low_pc, AttributeValue::Address(address));
    entries.set(id, DW_AT_high_pc, AttributeValue::Udata(u64::from(function.size)));
    let mut base = Expression::new();
    base.op_reg(frame_pointer(machine));
    entries.set(id, DW_AT_frame_base, AttributeValue::Exprloc(base));
    entries.of_routine(id, of, &routine.homes);
    let range = Range::StartLength { begin: address, length: u64::from(function.size) };
    entries.ranges.push(range);
}

fn frame_pointer(machine: Architecture) -> Register {
    match machine {
        Architecture::Aarch64(_) => AArch64::X29,
        Architecture::Riscv64(_) => RiscV::X8,
        _ => X86_64::RBP,
    }
}

/// How a debugger finds the caller of each function.
fn frames(notes: &Notes) -> FrameTable {
    let mut table = FrameTable::default();
    let Some(mut common) = notes.frames.clone() else { return table };
    common.fde_address_encoding = gimli::constants::DW_EH_PE_absptr;
    let common = table.add_cie(common);
    for (at, function) in notes.functions.iter().enumerate() {
        if let Some(unwind) = &function.unwind {
            table.add_fde(common, unwind.to_fde(symbol(at)));
        }
    }
    table
}
