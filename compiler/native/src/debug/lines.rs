//! The table of lines: which statement an instruction belongs to.

use super::entries::Entries;
use super::notes::{Compiled, Row};
use gimli::write::{Address, FileId, LineString};
use staunch_ir::{Location, Program};

/// The paths of the sources, as the user has named them. Relative paths begin at the folder of the build.
pub(crate) fn files(entries: &mut Entries<'_>, program: &Program) -> Vec<FileId> {
    let lines = &mut entries.dwarf.unit.line_program;
    let folder = lines.default_directory();
    let mut add = |path: &str| lines.add_file(LineString::String(path_bytes(path)), folder, None);
    program.files.iter().map(|it| add(&it.path)).collect()
}

/// A path as DWARF takes it: not empty, and without a zero.
pub(crate) fn path_bytes(path: &str) -> Vec<u8> {
    let bytes: Vec<u8> = path.bytes().filter(|it| *it != 0).collect();
    if bytes.is_empty() { b"program.st".to_vec() } else { bytes }
}

/// The file of a place, and its line. What the compiler adds to a program has neither.
pub(crate) fn place(files: &[FileId], at: Location) -> Option<(FileId, u64)> {
    let file = files.get(usize::from(at.file)).copied()?;
    (at.line > 0).then_some((file, u64::from(at.line)))
}

/// The rows of a function.
pub(crate) fn sequence(entries: &mut Entries<'_>, files: &[FileId], function: &Compiled, address: Address) {
    let rows = function.routine.as_ref().map(|it| it.rows.as_slice()).unwrap_or_default();
    if !rows.iter().any(|it| place(files, it.at).is_some()) {
        return;
    }
    let lines = &mut entries.dwarf.unit.line_program;
    lines.begin_sequence(Some(address));
    for Row { offset, at, is_statement } in rows {
        let Some((file, line)) = place(files, *at) else { continue };
        let row = lines.row();
        row.address_offset = u64::from(*offset);
        (row.file, row.line, row.column) = (file, line, u64::from(at.column));
        row.is_statement = *is_statement;
        lines.generate_row();
    }
    lines.end_sequence(u64::from(function.size));
}
