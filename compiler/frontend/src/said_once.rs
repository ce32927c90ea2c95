//! A mistake that shows in many places is reported at the first of them, with the number of the others: what exists nowhere,
//! and what a POU does not declare.

use crate::diagnostic::{Missing, Subject};
use crate::{Diagnostic, Span, ast};
use rustc_hash::{FxHashMap, FxHashSet};

/// What was looked for, as far as another place where the name is missing may be the same mistake.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
enum Sought {
    /// What programs declare for all of their POUs, and instances that are called.
    Declared,
    /// A namespace, or a library.
    Namespace,
    /// What a namespace or a library has.
    Inside,
    /// What has members: any of these, or a variable.
    Owner,
    /// A variable, which another POU may have.
    Variable,
}

/// A name that is missing, in one case.
type Named = (Sought, String);

/// What is there nowhere is one mistake, however often it is named: the first place is reported, with the number of
/// the others.
pub(crate) fn said_once(diagnostics: Vec<Diagnostic>, units: &[Span]) -> Vec<Diagnostic> {
    let all: FxHashSet<Named> = diagnostics.iter().filter_map(named).collect();
    let mut first: FxHashMap<(Named, usize), (usize, usize)> = FxHashMap::default();
    let mut kept: Vec<Diagnostic> = Vec::with_capacity(diagnostics.len());
    for it in diagnostics {
        let Some(named) = named(&it).map(|it| meant(it, &all)) else {
            kept.push(it);
            continue;
        };
        let unit = match named.0 {
            Sought::Variable => units.partition_point(|unit| (unit.file, unit.start) <= (it.span.file, it.span.start)),
            Sought::Declared | Sought::Namespace | Sought::Inside | Sought::Owner => 0,
        };
        let place = kept.len();
        let (_, others) = first.entry((named, unit)).and_modify(|it| it.1 += 1).or_insert((place, 0));
        if *others == 0 {
            kept.push(it);
        }
    }
    for (place, others) in first.into_values().filter(|it| it.1 > 0) {
        let places = if others == 1 { "place" } else { "places" };
        kept[place].notes.push(format!("it is used in {others} more {places}"));
    }
    kept
}

/// What has members is what the name was to be elsewhere.
fn meant((sought, name): Named, all: &FxHashSet<Named>) -> Named {
    let others: &[Sought] = match sought {
        Sought::Owner => &[Sought::Declared, Sought::Namespace],
        Sought::Variable => &[Sought::Owner],
        Sought::Declared | Sought::Namespace | Sought::Inside => &[],
    };
    for other in others {
        let it = (*other, name.clone());
        if all.contains(&it) {
            return meant(it, all);
        }
    }
    (sought, name)
}

/// `None` for what is a mistake at each of its places.
fn named(it: &Diagnostic) -> Option<Named> {
    let (kind, name) = match it.subject.as_ref()? {
        Subject::Missing { kind, name } => (*kind, name),
        Subject::Unavailable { name } => return Some((Sought::Declared, name.to_ascii_uppercase())),
        Subject::Elsewhere { .. } | Subject::Beyond(_) | Subject::Mismatch(..) | Subject::Unclosed { .. } => {
            return None;
        }
    };
    let sought = match kind {
        // Who takes a similar name's place corrects each use.
        Missing::Variable | Missing::Inside if it.fix.is_some() => return None,
        Missing::Variable => Sought::Variable,
        Missing::Owner => Sought::Owner,
        Missing::Inside | Missing::InFull => Sought::Inside,
        Missing::Namespace | Missing::Used | Missing::Library => Sought::Namespace,
        Missing::Type | Missing::Enumeration | Missing::FunctionBlock | Missing::Interface | Missing::Callable => {
            Sought::Declared
        }
        Missing::GlobalVariable | Missing::Program | Missing::Task | Missing::Step => return None,
    };
    Some((sought, name.to_ascii_uppercase()))
}

/// Where the names of all POUs are, in the order of the files and of their lines.
pub(crate) fn units(files: &[ast::File<'_>]) -> Vec<Span> {
    let mut units = Vec::new();
    for item in files.iter().flat_map(|it| &it.items) {
        if let ast::Item::Pou(pou) = item {
            units.push(pou.name.span);
            units.extend(pou.routines.iter().map(|it| it.name.span));
        }
    }
    units.sort_by_key(|it| (it.file, it.start));
    units
}
