//! Semantic tokens: each name coloured by what it means.

use crate::place::position;
use crate::project::Analysis;
use gen_lsp_types::SemanticToken;
use staunch_frontend::ast::VarKind;
use staunch_frontend::{DefinitionKind, Meaning, Span};

pub const TYPES: [&str; 14] = [
    "namespace",
    "type",
    "class",
    "enum",
    "interface",
    "struct",
    "parameter",
    "variable",
    "property",
    "enumMember",
    "function",
    "method",
    "event",
    "label",
];

pub const MODIFIERS: [&str; 3] = ["declaration", "readonly", "defaultLibrary"];

const DECLARATION: u32 = 1;
const READONLY: u32 = 1 << 1;
const LIBRARY: u32 = 1 << 2;

pub fn tokens(analysis: &Analysis, file: u16) -> Vec<SemanticToken> {
    let used = analysis.index.uses.iter().filter(|it| it.span.file == file);
    let used = used.filter_map(|it| Some((it.span, look(analysis, &it.meaning)?, 0)));
    let declared = analysis.index.definitions.iter().filter(|it| it.name.file == file);
    let declared = declared.map(|it| (it.name, of_kind(it.kind), DECLARATION));
    let mut all: Vec<_> = used.chain(declared).filter(|it| it.0.start < it.0.end).collect();
    all.sort_unstable_by_key(|it| it.0.start);
    all.dedup_by_key(|it| it.0);
    encoded(analysis, all.into_iter().map(|(span, (ty, modifiers), more)| (span, ty, modifiers | more)))
}

fn encoded(analysis: &Analysis, all: impl Iterator<Item = (Span, &'static str, u32)>) -> Vec<SemanticToken> {
    let (mut line, mut start) = (0, 0);
    let mut tokens = Vec::new();
    let mut placed: Vec<_> = all
        .filter_map(|(span, ty, modifiers)| {
            let source = analysis.source(span.file);
            let at = source.is_verbatim(span).then(|| position(source.file(), source.in_file(span).start))?;
            Some((at, analysis.text(span), ty, modifiers))
        })
        .collect();
    placed.sort_by_key(|it| (it.0.line, it.0.character));
    for (at, text, ty, token_modifiers_bitset) in placed {
        let Some(token_type) = (0..).zip(TYPES).find(|it| it.1 == ty).map(|it| it.0) else { continue };
        let delta_line = at.line - line;
        let delta_start = if delta_line == 0 { at.character.saturating_sub(start) } else { at.character };
        (line, start) = (at.line, at.character);
        let length = crate::place::count(text.encode_utf16().count());
        tokens.push(SemanticToken { delta_line, delta_start, length, token_type, token_modifiers_bitset });
    }
    tokens
}

fn look(analysis: &Analysis, meaning: &Meaning) -> Option<(&'static str, u32)> {
    Some(match meaning {
        Meaning::Definition(id) => {
            let definition = analysis.index.get(*id);
            let (ty, modifiers) = of_kind(definition.kind);
            let is_ours = analysis.path(definition.name.file).is_none();
            (ty, modifiers | if is_ours { LIBRARY } else { 0 })
        }
        Meaning::Namespace(_) => ("namespace", 0),
        Meaning::Elementary(_) => ("type", LIBRARY),
        Meaning::Block(_) => ("class", LIBRARY),
        Meaning::Pin(..) | Meaning::Parameter => ("property", LIBRARY),
        Meaning::Function | Meaning::Instruction => ("function", LIBRARY),
        Meaning::Word => return None,
    })
}

const fn of_kind(kind: DefinitionKind) -> (&'static str, u32) {
    match kind {
        DefinitionKind::Program | DefinitionKind::FunctionBlock | DefinitionKind::Class => ("class", 0),
        DefinitionKind::Interface => ("interface", 0),
        DefinitionKind::Function | DefinitionKind::Test => ("function", 0),
        DefinitionKind::Method | DefinitionKind::Action => ("method", 0),
        DefinitionKind::Property | DefinitionKind::Member => ("property", 0),
        DefinitionKind::Type => ("type", 0),
        DefinitionKind::Structure | DefinitionKind::Union => ("struct", 0),
        DefinitionKind::Enumeration => ("enum", 0),
        DefinitionKind::Enumerator => ("enumMember", READONLY),
        DefinitionKind::Variable(VarKind::Input | VarKind::Output | VarKind::InOut) => ("parameter", 0),
        DefinitionKind::Variable(_) | DefinitionKind::Instance => ("variable", 0),
        DefinitionKind::Constant => ("variable", READONLY),
        DefinitionKind::Label | DefinitionKind::Step => ("label", 0),
        DefinitionKind::Configuration | DefinitionKind::Resource => ("namespace", 0),
        DefinitionKind::Task => ("event", 0),
    }
}
