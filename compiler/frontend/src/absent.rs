//! A project that refers to libraries which are not available: they are named once, in place of each unknown name.

use crate::diagnostic::{Missing, Subject};
use crate::dialect::library;
use crate::{Code, Diagnostic, Dialect, Sources};

/// How many of the unknown names are shown.
const SHOWN: usize = 8;

/// Leaves one diagnostic of all unknown names, at the place of the first one, where the project refers to libraries that are
/// not available. A name that is like a known one is a mistake of its own.
pub(crate) fn deduplicate_missing(diagnostics: Vec<Diagnostic>, sources: &Sources) -> Vec<Diagnostic> {
    let absent = absent_libraries(sources);
    if absent.is_empty() || diagnostics.iter().filter_map(unknown).nth(1).is_none() {
        return diagnostics;
    }
    let (missing, mut kept): (Vec<_>, Vec<_>) = diagnostics.into_iter().partition(|it| unknown(it).is_some());
    let mut names: Vec<&str> = Vec::new();
    for name in missing.iter().filter_map(unknown) {
        if !library::is_one_of(&names, name) {
            names.push(name);
        }
    }
    if let Some(first) = missing.first() {
        kept.push(named_once(first, &absent, &names));
    }
    kept.sort_by_key(|it| (it.span.file, it.span.start, it.span.end, it.code));
    kept
}

fn named_once(first: &Diagnostic, absent: &[&str], names: &[&str]) -> Diagnostic {
    let quoted = |names: &[&str]| names.iter().map(|it| format!("`{it}`")).collect::<Vec<_>>().join(", ");
    let (what, their) = match absent {
        [_] => ("a library that is", "its source"),
        _ => ("libraries that are", "their sources"),
    };
    let shown = quoted(&names[..names.len().min(SHOWN)]);
    let more = match names.len().saturating_sub(SHOWN) {
        0 => String::new(),
        more => format!(", and {more} more"),
    };
    let paths: Vec<_> = absent.iter().map(|it| format!("\"…/{it}.plcproj\"")).collect();
    Diagnostic::new(Code::E0102, first.span, format!("the project refers to {what} not available: {}", quoted(absent)))
        .label("the first unknown name")
        .note(format!("unknown: {shown}{more}"))
        .help(format!("add {their} to staunch.toml: `libraries = [{}]`", paths.join(", ")))
}

/// The libraries of the references that are neither bundled nor among the sources.
fn absent_libraries(sources: &Sources) -> Vec<&str> {
    let mut absent: Vec<&str> = Vec::new();
    for it in sources.references() {
        let name = it.library.as_str();
        let is_there = library::is_library(Dialect::Codesys, name)
            || NAMELESS.iter().any(|start| name.get(..start.len()).is_some_and(|it| it.eq_ignore_ascii_case(start)))
            || sources.files().iter().any(|it| it.library().is_some_and(|it| it.eq_ignore_ascii_case(name)));
        if !is_there && !library::is_one_of(&absent, name) {
            absent.push(name);
        }
    }
    absent
}

/// What the names of those libraries begin with that programs name nothing of, or that are a part of the compiler.
const NAMELESS: [&str; 7] =
    ["System_Visu", "Visu", "Breakpoint", "TcUnit", "IBaseLibrary", "Base Interfaces", "Tc3_Interfaces"];

/// The name that a diagnostic reports as unknown, if a library could have it.
fn unknown(it: &Diagnostic) -> Option<&str> {
    let Some(Subject::Missing { kind, name }) = it.subject.as_ref().filter(|_| it.fix.is_none()) else { return None };
    let may_be_of_library = match kind {
        Missing::Variable
        | Missing::Owner
        | Missing::Type
        | Missing::FunctionBlock
        | Missing::Interface
        | Missing::Namespace
        | Missing::Callable => true,
        Missing::Enumeration
        | Missing::Library
        | Missing::InFull
        | Missing::Inside
        | Missing::GlobalVariable
        | Missing::Program
        | Missing::Task
        | Missing::Step => false,
    };
    may_be_of_library.then_some(name)
}
