//! Any system's files as one file of Structured Text.

use crate::args::Convert;
use crate::session::Session;
use crate::{REJECTED, apart, input, output};
use staunch_frontend::{Compilation, Dialect, Severity, Sources};
use staunch_ir::{Program, print_without_places};
use std::collections::HashSet;

/// Writes the text of all files, if it is the program that they are.
pub fn convert(session: &Session, args: &Convert) -> Result<u8, String> {
    let Some(program) = session.program() else { return Ok(REJECTED) };
    let path = &args.output;
    apart::output(session, path)?;
    output::check(path)?;
    let dialect = session.dialect()?;
    let named = (dialect != Dialect::default()).then_some(dialect.name());
    let converted = session.sources.as_one_file(&input::shown(path), named);
    let compilation = session.compile_to_build(&converted)?;
    let is_same = compilation.program.as_ref().is_some_and(|it| is_same(it, program));
    if !is_same {
        output::tell(refusal(&compilation, &converted));
        return Ok(REJECTED);
    }
    output::write(path, converted.files()[0].text.as_bytes())?;
    session.say("Converted", format_args!("{} to {}", session.first.display(), path.display()));
    Ok(0)
}

/// Whether both do the same, by the same systems' rules, wherever their text is.
fn is_same(a: &Program, b: &Program) -> bool {
    let systems = |it: &Program| it.files.iter().map(|it| it.system).collect::<HashSet<_>>();
    systems(a) == systems(b) && print_without_places(a) == print_without_places(b)
}

fn refusal(compilation: &Compilation, converted: &Sources) -> String {
    let mut text =
        "error: as one file of ST the program would be another: part of it is in these files, but not in their text"
            .to_owned();
    let first = compilation.diagnostics.iter().find(|it| it.severity == Severity::Error);
    if let Some(it) = first {
        let line = converted.get(it.span.file).line(it.span.start);
        text += &format!("\n  in line {line} of that text: {}", it.message);
    }
    text + "\n  nothing was written"
}
