//! The names of routines as the sources have them: in a program, those of copies have a class or a number with them.

use staunch_frontend::Sources;
use staunch_ir::{Location, Program, Routine, RoutineKind};

/// A routine's name as it is declared.
pub fn name(sources: &Sources, routine: &Routine) -> String {
    let Location { file, line, column } = routine.location;
    // The library is not among the sources.
    if usize::from(file) >= sources.files().len() {
        return routine.name.clone();
    }
    let source = sources.file(file);
    let line = source.text.get(source.line_range(line)).unwrap_or_default();
    let before = usize::from(column.saturating_sub(1));
    let name: String = line.chars().skip(before).take_while(|it| it.is_alphanumeric() || *it == '_').collect();
    if name.is_empty() { routine.name.clone() } else { name }
}

/// The program with these names, for a debugger.
pub fn named(sources: &Sources, program: &Program) -> Program {
    let mut program = program.clone();
    for routine in &mut program.routines {
        if matches!(routine.kind, RoutineKind::Function | RoutineKind::Method) {
            routine.name = name(sources, routine);
        }
    }
    program
}
