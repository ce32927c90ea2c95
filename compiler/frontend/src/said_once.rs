//! A mistake that shows in many places is reported at the first of them, with the number of the others: what exists nowhere,
//! and what a POU does not declare.

use crate::{Code, Diagnostic, Sources, Span, ast};
use rustc_hash::FxHashMap;

/// Of what is refused by its name, what programs name in many places.
const NAMED_ONCE: [&str; 4] = [" of Tc2_Utilities ", " of Util ", " __VARINFO ", "`__CURRENTTASK`"];

/// What is there nowhere is one mistake, however often it is named: the first place is reported, with the number of
/// the others.
pub(crate) fn said_once(diagnostics: Vec<Diagnostic>, sources: &Sources, units: &[Span]) -> Vec<Diagnostic> {
    let mut first: FxHashMap<(Code, String, usize), (usize, usize)> = FxHashMap::default();
    let mut kept: Vec<Diagnostic> = Vec::with_capacity(diagnostics.len());
    for it in diagnostics {
        // `Severity.Info` of an enumeration, list or namespace that is not there.
        let is_owner = || {
            let after = sources.get(it.span.file).text.get(usize::try_from(it.span.end).unwrap_or(usize::MAX)..);
            is_undeclared(&it) && after.is_some_and(|it| it.starts_with('.'))
        };
        // What a POU lacks, another may have.
        let unit = match it.code {
            Code::E0101 if !is_owner() => {
                units.partition_point(|unit| (unit.file, unit.start) <= (it.span.file, it.span.start))
            }
            _ => 0,
        };
        let is_missing = match it.code {
            Code::E0102 | Code::E0307 => {
                let of_library = it.message.starts_with("the library `") && it.fix.is_none();
                of_library || it.message.starts_with("there is no ")
            }
            // Who takes a similar name's place corrects each use.
            Code::E0101 => is_owner() || is_undeclared(&it) && it.fix.is_none(),
            Code::E0902 => NAMED_ONCE.iter().any(|name| it.message.contains(name)),
            _ => false,
        };
        if !is_missing {
            kept.push(it);
            continue;
        }
        let place = kept.len();
        let (_, others) =
            first.entry((it.code, it.message.clone(), unit)).and_modify(|it| it.1 += 1).or_insert((place, 0));
        if *others == 0 {
            kept.push(it);
        }
    }
    for (place, others) in first.into_values().filter(|it| it.1 > 0) {
        let places = if others == 1 { "place" } else { "places" };
        kept[place].notes.push(format!("it is named in {others} more {places}"));
    }
    kept
}

fn is_undeclared(it: &Diagnostic) -> bool {
    it.message.ends_with(" is not declared")
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
