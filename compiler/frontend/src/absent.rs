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

/// Where a file has a USING of a namespace that does not exist, unknown names of the file may be in it: they are reported with it, once.
pub(crate) fn of_used_namespaces(diagnostics: Vec<Diagnostic>) -> Vec<Diagnostic> {
    let used: Vec<(u16, String)> = diagnostics.iter().filter_map(used_namespace).collect();
    if used.is_empty() {
        return diagnostics;
    }
    // Several in a file: any of them may have the name.
    let space = |file: u16| used.iter().find(|it| it.0 == file).map(|it| it.1.as_str());
    let mut names: Vec<(&str, Vec<String>)> = Vec::new();
    let mut kept = Vec::with_capacity(diagnostics.len());
    for it in diagnostics {
        let Some((space, name)) = space(it.span.file).zip(may_be_used(&it)) else {
            kept.push(it);
            continue;
        };
        let at = names.iter().position(|it| it.0 == space).unwrap_or_else(|| {
            names.push((space, Vec::new()));
            names.len() - 1
        });
        if !names[at].1.iter().any(|it| it.eq_ignore_ascii_case(name)) {
            names[at].1.push(name.to_owned());
        }
    }
    for (space, names) in names {
        let first = kept.iter_mut().find(|it| used_namespace(it).is_some_and(|it| it.1 == space));
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        if let Some(first) = first {
            first.notes.push(format!("unknown names that may be in it: {}", listed(&names)));
            let help =
                "add the sources of its package, or declarations of what it holds, to staunch.toml: `libraries = […]`";
            first.help = first.help.take().or_else(|| Some(help.to_owned()));
        }
    }
    kept
}

/// The namespace of a USING that is not there, with its file.
fn used_namespace(it: &Diagnostic) -> Option<(u16, String)> {
    let Some(Subject::Missing { kind: Missing::Used, name }) = &it.subject else { return None };
    Some((it.span.file, name.clone()))
}

/// The unknown name, if a namespace could have it.
fn may_be_used(it: &Diagnostic) -> Option<&str> {
    use Missing::{Callable, FunctionBlock, Interface, Owner, Type};
    match it.subject.as_ref().filter(|_| it.fix.is_none())? {
        // Where help says what is meant, that is a mistake of its own.
        Subject::Missing { kind: Owner | Type | FunctionBlock | Interface | Callable, name } if it.help.is_none() => {
            Some(name)
        }
        Subject::Elsewhere { name } => Some(name),
        Subject::Missing { .. }
        | Subject::Unavailable { .. }
        | Subject::Beyond(_)
        | Subject::Mismatch(..)
        | Subject::Unclosed { .. } => None,
    }
}

fn listed(names: &[&str]) -> String {
    let quoted: Vec<_> = names.iter().take(SHOWN).map(|it| format!("`{it}`")).collect();
    let more = match names.len().saturating_sub(SHOWN) {
        0 => String::new(),
        more => format!(", and {more} more"),
    };
    format!("{}{more}", quoted.join(", "))
}

fn named_once(first: &Diagnostic, absent: &[&str], names: &[&str]) -> Diagnostic {
    let (what, their) = match absent {
        [_] => ("a library that is", "its source"),
        _ => ("libraries that are", "their sources"),
    };
    let shown = listed(names);
    let libraries: Vec<_> = absent.iter().map(|it| format!("`{it}`")).collect();
    let paths: Vec<_> = absent.iter().map(|it| format!("\"…/{it}.plcproj\"")).collect();
    Diagnostic::new(
        Code::E0102,
        first.span,
        format!("the project refers to {what} not available: {}", libraries.join(", ")),
    )
    .label("the first unknown name")
    .note(format!("unknown: {shown}"))
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
        | Missing::Used
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
