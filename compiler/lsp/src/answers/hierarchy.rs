//! Who calls what, and which class extends which.

use super::symbols::kind;
use crate::calls::calls;
use crate::place::Place;
use crate::project::Analysis;
use gen_lsp_types::{
    CallHierarchyIncomingCall, CallHierarchyItem, CallHierarchyOutgoingCall, Range, SymbolKind, TypeHierarchyItem, Uri,
};
use staunch_frontend::{DefId, DefinitionKind, Meaning, Span};

/// One call: who calls, what, and where.
struct Call {
    caller: DefId,
    callee: DefId,
    at: Span,
}

/// A POU with what an editor shows of it.
struct Item {
    name: String,
    kind: SymbolKind,
    uri: Uri,
    range: Range,
    selection_range: Range,
}

fn item(analysis: &Analysis, id: DefId) -> Option<Item> {
    let definition = analysis.index.get(id);
    let name = match definition.owner.filter(|_| !is_class(analysis, id)) {
        Some(owner) => format!("{}.{}", analysis.name(owner), analysis.name(id)),
        None => analysis.name(id).to_owned(),
    };
    Some(Item {
        name,
        kind: kind(definition.kind),
        uri: analysis.location(definition.name)?.uri,
        range: analysis.range(definition.extent),
        selection_range: analysis.range(definition.name),
    })
}

fn call_item(analysis: &Analysis, id: DefId) -> Option<CallHierarchyItem> {
    let Item { name, kind, uri, range, selection_range } = item(analysis, id)?;
    Some(CallHierarchyItem { name, kind, tags: None, detail: None, uri, range, selection_range, data: None })
}

fn type_item(analysis: &Analysis, id: DefId) -> Option<TypeHierarchyItem> {
    let Item { name, kind, uri, range, selection_range } = item(analysis, id)?;
    Some(TypeHierarchyItem { name, kind, tags: None, detail: None, uri, range, selection_range, data: None })
}

fn is_class(analysis: &Analysis, id: DefId) -> bool {
    matches!(
        analysis.index.get(id).kind,
        DefinitionKind::FunctionBlock | DefinitionKind::Class | DefinitionKind::Interface | DefinitionKind::Structure
    )
}

/// Whether it has a body, and can be called.
fn is_called(analysis: &Analysis, id: DefId) -> bool {
    matches!(
        analysis.index.get(id).kind,
        DefinitionKind::Program
            | DefinitionKind::FunctionBlock
            | DefinitionKind::Function
            | DefinitionKind::Method
            | DefinitionKind::Action
            | DefinitionKind::Test
    )
}

/// The POU that a name stands for where it is called: of an instance, its block.
fn target(analysis: &Analysis, id: DefId) -> Option<DefId> {
    if is_called(analysis, id) {
        return Some(id);
    }
    match analysis.type_of(id)? {
        Meaning::Definition(ty) if is_called(analysis, ty) => Some(ty),
        _ => None,
    }
}

/// The innermost POU around a place.
fn around(analysis: &Analysis, at: Span) -> Option<DefId> {
    let holds = |it: Span| it.file == at.file && it.start <= at.start && at.end <= it.end;
    let all = analysis.index.ids().filter(|(id, it)| is_called(analysis, *id) && holds(it.extent));
    all.min_by_key(|(_, it)| it.extent.end - it.extent.start).map(|it| it.0)
}

/// What `SUPER^()` calls in a POU: the body of the block that its own one extends.
fn base(analysis: &Analysis, caller: DefId) -> Option<DefId> {
    let class = analysis.index.get(caller).owner.unwrap_or(caller);
    analysis.bases(class).into_iter().find(|it| is_called(analysis, *it))
}

fn all(analysis: &Analysis) -> Vec<Call> {
    let mut found = Vec::new();
    for (source, file) in analysis.sources.files().iter().zip(0u16..) {
        for call in calls(file, &source.text) {
            let Some(caller) = around(analysis, call.name) else { continue };
            let callee = match analysis.index.at(file, call.name.start) {
                Some((_, Meaning::Definition(id))) => target(analysis, id),
                _ if analysis.sources.text(call.name).eq_ignore_ascii_case("SUPER") => base(analysis, caller),
                _ => None,
            };
            if let Some(callee) = callee {
                // A POU's own name before its bracket is its head.
                if analysis.index.get(callee).name != call.name {
                    found.push(Call { caller, callee, at: call.name });
                }
            }
        }
    }
    found
}

pub fn prepare_calls(analysis: &Analysis, place: Place) -> Option<CallHierarchyItem> {
    let id = analysis.definition_at(place)?;
    call_item(analysis, target(analysis, id)?)
}

pub fn incoming(analysis: &Analysis, of: Place) -> Vec<CallHierarchyIncomingCall> {
    let others = others(analysis, of, |it| (it.callee, it.caller)).into_iter();
    others.map(|(from, from_ranges)| CallHierarchyIncomingCall { from, from_ranges }).collect()
}

pub fn outgoing(analysis: &Analysis, of: Place) -> Vec<CallHierarchyOutgoingCall> {
    let others = others(analysis, of, |it| (it.caller, it.callee)).into_iter();
    others.map(|(to, from_ranges)| CallHierarchyOutgoingCall { to, from_ranges }).collect()
}

/// What is at the other end of the calls of a POU, with the places of the calls. `ends` gives this end first.
fn others(
    analysis: &Analysis,
    of: Place,
    ends: impl Fn(&Call) -> (DefId, DefId),
) -> Vec<(CallHierarchyItem, Vec<Range>)> {
    let Some(of) = analysis.definition_at(of) else { return Vec::new() };
    let own = all(analysis).into_iter().filter(|it| ends(it).0 == of);
    let grouped = grouped(own.map(|it| (ends(&it).1, it.at)));
    let shown = grouped.into_iter().filter_map(|(id, places)| {
        Some((call_item(analysis, id)?, places.into_iter().map(|it| analysis.range(it)).collect()))
    });
    shown.collect()
}

fn grouped(calls: impl Iterator<Item = (DefId, Span)>) -> Vec<(DefId, Vec<Span>)> {
    let mut groups: Vec<(DefId, Vec<Span>)> = Vec::new();
    for (id, at) in calls {
        match groups.iter_mut().find(|it| it.0 == id) {
            Some(group) => group.1.push(at),
            None => groups.push((id, vec![at])),
        }
    }
    groups
}

pub fn prepare_types(analysis: &Analysis, place: Place) -> Option<TypeHierarchyItem> {
    let id = analysis.definition_at(place)?;
    let class = match analysis.type_of(id) {
        _ if is_class(analysis, id) => id,
        Some(Meaning::Definition(ty)) if is_class(analysis, ty) => ty,
        _ => return None,
    };
    type_item(analysis, class)
}

pub fn supertypes(analysis: &Analysis, of: Place) -> Vec<TypeHierarchyItem> {
    let Some(of) = analysis.definition_at(of) else { return Vec::new() };
    analysis.bases(of).into_iter().filter_map(|it| type_item(analysis, it)).collect()
}

pub fn subtypes(analysis: &Analysis, of: Place) -> Vec<TypeHierarchyItem> {
    let Some(of) = analysis.definition_at(of) else { return Vec::new() };
    analysis.heirs(of).into_iter().filter_map(|it| type_item(analysis, it)).collect()
}
