//! From a name to where it is declared, and back.

use super::describe::describe;
use crate::place::Place;
use crate::project::Analysis;
use gen_lsp_types::{Contents, DocumentHighlight, DocumentHighlightKind, Hover, Location, MarkupContent, MarkupKind};
use staunch_frontend::ast::VarKind;
use staunch_frontend::{DefId, DefinitionKind, Meaning, Span};

pub fn hover(analysis: &Analysis, place: Place) -> Option<Hover> {
    let (span, meaning) = analysis.at(place)?;
    let it = describe(analysis, analysis.text(span), &meaning)?;
    let value = format!("```iecst\n{}\n```\n\n{}", it.code, it.text).trim_end().to_owned();
    let contents = Contents::MarkupContent(MarkupContent { kind: MarkupKind::Markdown, value });
    Some(Hover { contents, range: Some(analysis.range(span)) })
}

pub fn definition(analysis: &Analysis, place: Place) -> Option<Location> {
    let id = analysis.definition_at(place)?;
    analysis.location(analysis.index.get(id).name)
}

/// Where the type of what is named is declared.
pub fn type_definition(analysis: &Analysis, place: Place) -> Option<Location> {
    let id = analysis.definition_at(place)?;
    match analysis.type_of(id)? {
        Meaning::Definition(ty) => analysis.location(analysis.index.get(ty).name),
        _ => None,
    }
}

/// The classes that have an INTERFACE, or what they have for a METHOD or PROPERTY.
pub fn implementations(analysis: &Analysis, place: Place) -> Vec<Location> {
    let Some(id) = analysis.definition_at(place) else { return Vec::new() };
    let definition = analysis.index.get(id);
    let classes = |of: DefId| {
        let (mut all, mut at) = (vec![of], 0);
        while at < all.len() {
            let new: Vec<_> = analysis.heirs(all[at]).into_iter().filter(|it| !all.contains(it)).collect();
            all.extend(new);
            at += 1;
        }
        all.split_off(1)
    };
    let is_routine = matches!(definition.kind, DefinitionKind::Method | DefinitionKind::Property);
    let found: Vec<_> = match definition.owner {
        Some(owner) if is_routine => {
            let own = |class: DefId| analysis.index.parts_of(class).filter(|it| is_same(analysis, it.0, id));
            classes(owner).into_iter().flat_map(own).map(|it| it.0).collect()
        }
        _ => classes(id),
    };
    found.into_iter().filter_map(|it| analysis.location(analysis.index.get(it).name)).collect()
}

/// Whether a routine of another class has the name of one.
pub fn is_same(analysis: &Analysis, one: DefId, other: DefId) -> bool {
    let is_routine =
        |id: DefId| matches!(analysis.index.get(id).kind, DefinitionKind::Method | DefinitionKind::Property);
    is_routine(one) && is_routine(other) && analysis.name(one).eq_ignore_ascii_case(analysis.name(other))
}

/// The declarations that have one name together: a METHOD with those that it overrides or that override it, and their
/// parameters; a global variable and each VAR_EXTERNAL of it.
pub fn family(analysis: &Analysis, id: DefId) -> Vec<DefId> {
    let definition = analysis.index.get(id);
    let declarations = analysis.index.declarations_of(id);
    if declarations.len() > 1 {
        return declarations;
    }
    let Some(owner) = definition.owner else { return vec![id] };
    let is_parameter =
        matches!(definition.kind, DefinitionKind::Variable(VarKind::Input | VarKind::Output | VarKind::InOut));
    if is_parameter && analysis.index.get(owner).kind == DefinitionKind::Method {
        let routines = routines(analysis, owner).into_iter();
        let parts = routines.flat_map(|it| analysis.index.parts_of(it)).filter(|it| it.0 != id);
        let alike = parts.filter(|it| analysis.name(it.0).eq_ignore_ascii_case(analysis.name(id)));
        return core::iter::once(id).chain(alike.map(|it| it.0)).collect();
    }
    routines(analysis, id)
}

/// A METHOD or PROPERTY, with those of other classes that are called where it is.
fn routines(analysis: &Analysis, id: DefId) -> Vec<DefId> {
    let Some(owner) = analysis.index.get(id).owner else { return vec![id] };
    let (mut classes, mut at) = (vec![owner], 0);
    while at < classes.len() {
        let near = analysis.bases(classes[at]).into_iter().chain(analysis.heirs(classes[at]));
        let new: Vec<_> = near.filter(|it| !classes.contains(it)).collect();
        classes.extend(new);
        at += 1;
    }
    let parts = classes.into_iter().flat_map(|it| analysis.index.parts_of(it)).map(|it| it.0);
    let mut all: Vec<_> = parts.filter(|it| *it != id && is_same(analysis, *it, id)).collect();
    all.insert(0, id);
    all
}

/// All places that name what a place names, its declaration among them.
pub fn mentions(analysis: &Analysis, id: DefId, with_declaration: bool) -> Vec<Span> {
    let mut all = Vec::new();
    for it in family(analysis, id) {
        if with_declaration {
            all.push(analysis.index.get(it).name);
        }
        all.extend(analysis.index.uses_of(it));
    }
    all.sort_unstable_by_key(|it| (it.file, it.start));
    all.dedup();
    all
}

pub fn references(analysis: &Analysis, place: Place, with_declaration: bool) -> Vec<Location> {
    let Some(id) = analysis.definition_at(place) else {
        // A standard block has uses and no declaration.
        let Some((_, meaning)) = analysis.at(place) else { return Vec::new() };
        let same = analysis.index.uses.iter().filter(|it| it.meaning == meaning && meaning != Meaning::Word);
        return same.filter_map(|it| analysis.location(it.span)).collect();
    };
    mentions(analysis, id, with_declaration).into_iter().filter_map(|it| analysis.location(it)).collect()
}

pub fn highlights(analysis: &Analysis, place: Place) -> Vec<DocumentHighlight> {
    let Some(id) = analysis.definition_at(place) else { return Vec::new() };
    let own = mentions(analysis, id, true).into_iter().filter(|it| it.file == place.file);
    own.map(|it| DocumentHighlight { range: analysis.range(it), kind: Some(DocumentHighlightKind::Text) }).collect()
}
