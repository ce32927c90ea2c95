//! What files declare, as an outline and by name.

use crate::project::Analysis;
use gen_lsp_types::{BaseSymbolInformation, DocumentSymbol, SymbolInformation, SymbolKind};
use rustc_hash::FxHashMap;
use staunch_frontend::{DefId, Definition, DefinitionKind};

#[allow(deprecated, reason = "the field is a part of the structure")]
fn symbol(analysis: &Analysis, id: DefId, definition: &Definition, parts: &Parts<'_>) -> DocumentSymbol {
    let children: Vec<_> = outline_of(analysis, Some(id), parts);
    let whole = analysis.range(definition.extent);
    let selection_range = analysis.range(definition.name);
    // A declaration that does not enclose its name is not its parent.
    let holds = |it: gen_lsp_types::Position| (whole.start.line, whole.start.character) <= (it.line, it.character);
    let is_around = holds(selection_range.start)
        && (selection_range.end.line, selection_range.end.character) <= (whole.end.line, whole.end.character);
    DocumentSymbol {
        name: analysis.text(definition.name).to_owned(),
        detail: definition.ty.map(|it| analysis.text(it).lines().next().unwrap_or_default().to_owned()),
        kind: kind(definition.kind),
        tags: None,
        deprecated: None,
        range: if is_around { whole } else { selection_range },
        selection_range,
        children: Some(children).filter(|it| !it.is_empty()),
    }
}

/// The declarations of a file, by what they are a part of.
type Parts<'a> = FxHashMap<Option<DefId>, Vec<(DefId, &'a Definition)>>;

/// The declarations of a file, those of a POU in it.
pub fn outline(analysis: &Analysis, file: u16) -> Vec<DocumentSymbol> {
    let mut parts = Parts::default();
    let own = analysis.index.ids().filter(|it| it.1.name.file == file && !analysis.text(it.1.name).is_empty());
    own.for_each(|it| parts.entry(it.1.owner).or_default().push(it));
    outline_of(analysis, None, &parts)
}

fn outline_of(analysis: &Analysis, owner: Option<DefId>, parts: &Parts<'_>) -> Vec<DocumentSymbol> {
    let own = parts.get(&owner).into_iter().flatten();
    own.map(|(id, it)| symbol(analysis, *id, it, parts)).collect()
}

/// The declarations of a project whose names hold the letters that are asked for, in their order.
pub fn workspace(analysis: &Analysis, query: &str) -> Vec<SymbolInformation> {
    let is_local = |it: &Definition| matches!(it.kind, DefinitionKind::Variable(_)) && it.owner.is_some();
    let all = analysis.index.ids().filter(|it| !is_local(it.1) && holds(analysis.text(it.1.name), query));
    let shown = all.filter_map(|(_, it)| {
        let container_name = it.owner.map(|it| analysis.name(it).to_owned());
        let name = analysis.text(it.name).to_owned();
        let base = BaseSymbolInformation { name, kind: kind(it.kind), tags: None, container_name };
        Some(SymbolInformation::new(None, analysis.location(it.name)?, base))
    });
    shown.take(500).collect()
}

/// Whether a name has letters in their order.
pub fn holds(name: &str, letters: &str) -> bool {
    let mut rest = name.chars().map(|it| it.to_ascii_lowercase());
    letters.chars().map(|it| it.to_ascii_lowercase()).all(|wanted| rest.any(|it| it == wanted))
}

pub const fn kind(kind: DefinitionKind) -> SymbolKind {
    match kind {
        DefinitionKind::Program | DefinitionKind::Configuration | DefinitionKind::Resource => SymbolKind::Module,
        DefinitionKind::FunctionBlock | DefinitionKind::Class => SymbolKind::Class,
        DefinitionKind::Interface => SymbolKind::Interface,
        DefinitionKind::Function | DefinitionKind::Test => SymbolKind::Function,
        DefinitionKind::Method | DefinitionKind::Action => SymbolKind::Method,
        DefinitionKind::Property => SymbolKind::Property,
        DefinitionKind::Type => SymbolKind::TypeParameter,
        DefinitionKind::Structure | DefinitionKind::Union => SymbolKind::Struct,
        DefinitionKind::Enumeration => SymbolKind::Enum,
        DefinitionKind::Enumerator => SymbolKind::EnumMember,
        DefinitionKind::Member => SymbolKind::Field,
        DefinitionKind::Constant => SymbolKind::Constant,
        DefinitionKind::Variable(_) | DefinitionKind::Instance => SymbolKind::Variable,
        DefinitionKind::Label | DefinitionKind::Step => SymbolKind::Key,
        DefinitionKind::Task => SymbolKind::Event,
    }
}
