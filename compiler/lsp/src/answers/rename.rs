//! Another name for a declaration, everywhere.

use super::navigate::{family, mentions};
use crate::place::Place;
use crate::project::{Analysis, Documents, Project};
use crate::uri;
use gen_lsp_types::{Range, TextEdit, WorkspaceEdit};
use staunch_frontend::{DefId, DefinitionKind, Severity, Span};
use staunch_syntax::lex::{Kind, lex};
use std::collections::{BTreeMap, HashMap};

/// What is renamed at a place, if it can be.
///
/// # Errors
/// Says why it cannot.
pub fn prepare(analysis: &Analysis, place: Place) -> Result<Range, String> {
    let (span, _) = analysis.at(place).ok_or("there is no name here")?;
    renamable(analysis, place).map(|_| analysis.range(span))
}

fn renamable(analysis: &Analysis, place: Place) -> Result<DefId, String> {
    let (span, _) = analysis.at(place).ok_or("there is no name here")?;
    let name = analysis.text(span);
    let id = analysis.definition_at(place).ok_or_else(|| format!("`{name}` is not declared in a source"))?;
    if OF_THE_SYSTEM.iter().any(|it| it.eq_ignore_ascii_case(name)) {
        return Err(format!("`{name}` has a fixed meaning and cannot be renamed"));
    }
    let definition = analysis.index.get(id);
    // The title of a TEST is a text, and its parts are words.
    if !is_name(name) || definition.kind == DefinitionKind::Test {
        return Err(format!("`{name}` is not a name that can be another"));
    }
    if analysis.source(definition.name.file).is_assembled() && is_of_the_file(definition.kind) {
        return Err(format!("`{name}` is the name of an object of its file, too: rename it in the original system"));
    }
    let all = overloads(analysis, id).into_iter().flat_map(|it| family(analysis, it));
    match all.into_iter().find(|it| !analysis.is_own(analysis.index.get(*it).name)) {
        Some(_) => Err(format!("`{name}` is declared in a library, or where the text is not a part of the file")),
        None => Ok(id),
    }
}

/// The changes that rename what is at a place.
///
/// # Errors
/// Says why it cannot have that name: it is none, or something else would be meant by it.
pub fn rename(
    project: &mut Project,
    analysis: &Analysis,
    documents: &Documents,
    place: Place,
    new: &str,
) -> Result<WorkspaceEdit, String> {
    let id = renamable(analysis, place)?;
    let old = analysis.name(id).to_owned();
    if !is_name(new) {
        return Err(format!("`{new}` is not a name"));
    }
    let mut places: Vec<_> = overloads(analysis, id).into_iter().flat_map(|it| mentions(analysis, it, true)).collect();
    places.sort_unstable_by_key(|it| (it.file, it.start));
    places.dedup();
    if places.iter().any(|it| !analysis.is_own(*it)) {
        return Err(format!("`{old}` is used where the text is not a part of the file"));
    }
    let mut files: BTreeMap<u16, Vec<Span>> = BTreeMap::new();
    places.iter().for_each(|it| files.entry(it.file).or_default().push(*it));
    let texts: Vec<_> = files.iter().map(|(file, spans)| (*file, replaced(analysis, *file, spans, new))).collect();
    let before = (errors(analysis), shape(analysis, |it| it));
    let changes = changes(analysis, &files, new);
    let moved = |it: Span| moved(it, &files, new);
    let expected = shape(analysis, moved);
    let after = project.changed(documents, &texts);
    if errors(&after) > before.0 {
        let first = after.index.diagnostics.iter().find(|it| it.severity == Severity::Error);
        let why = first.map_or_else(String::new, |it| format!(": {}", it.message));
        return Err(format!("`{old}` cannot be called `{new}`{why}"));
    }
    if shape(&after, |it| it) != expected {
        return Err(format!("`{new}` means something else at a place where `{old}` is used, or the other way round"));
    }
    Ok(WorkspaceEdit { changes: Some(changes), ..WorkspaceEdit::default() })
}

/// A FUNCTION, with all that have the same name: the arguments of a call decide which one it means.
fn overloads(analysis: &Analysis, id: DefId) -> Vec<DefId> {
    let is_function = |id: DefId| analysis.index.get(id).kind == DefinitionKind::Function;
    if !is_function(id) {
        return vec![id];
    }
    let name = analysis.name(id);
    let alike = analysis.index.ids().map(|it| it.0).filter(|it| is_function(*it));
    alike.filter(|it| analysis.name(*it).eq_ignore_ascii_case(name)).collect()
}

/// Names by which a system calls a METHOD, or gives a value.
const OF_THE_SYSTEM: [&str; 7] = ["FB_init", "FB_exit", "FB_reinit", "bInitRetains", "bInCopyCode", "EN", "ENO"];

/// Whether a file of another system's has such a name outside of its texts.
const fn is_of_the_file(kind: DefinitionKind) -> bool {
    !matches!(
        kind,
        DefinitionKind::Variable(_)
            | DefinitionKind::Constant
            | DefinitionKind::Member
            | DefinitionKind::Enumerator
            | DefinitionKind::Label
    )
}

fn is_name(text: &str) -> bool {
    let tokens = lex(0, text);
    tokens.kinds.iter().filter(|it| **it != Kind::End).eq([&Kind::Name]) && tokens.diagnostics.is_empty()
}

fn errors(analysis: &Analysis) -> usize {
    analysis.index.diagnostics.iter().filter(|it| it.severity == Severity::Error).count()
}

/// Which name of the project's files means which declaration, by their places after `moved`.
fn shape(analysis: &Analysis, moved: impl Fn(Span) -> Span) -> Vec<(Span, Span)> {
    let declared = |it: &staunch_frontend::Use| match it.meaning {
        staunch_frontend::Meaning::Definition(id) => Some(analysis.index.get(id).name),
        _ => None,
    };
    let all = analysis.index.uses.iter().filter_map(|it| Some((it.span, declared(it)?)));
    let own =
        all.filter(|(span, declared)| analysis.path(span.file).is_some() && analysis.path(declared.file).is_some());
    let mut shape: Vec<_> = own.map(|(span, declared)| (moved(span), moved(declared))).collect();
    shape.sort_unstable_by_key(|it| (it.0.file, it.0.start, it.1.file, it.1.start));
    shape
}

/// A place of the text, where names before it have another length.
fn moved(span: Span, files: &BTreeMap<u16, Vec<Span>>, new: &str) -> Span {
    let length = crate::place::count(new.len());
    let before = files.get(&span.file).into_iter().flatten().take_while(|it| it.start < span.start);
    let at =
        |offset: u32, before: &[Span]| before.iter().fold(offset, |it, name| it + length - (name.end - name.start));
    let before: Vec<_> = before.copied().collect();
    let is_renamed = files.get(&span.file).is_some_and(|it| it.contains(&span));
    let start = at(span.start, &before);
    Span { start, end: if is_renamed { start + length } else { at(span.end, &before) }, ..span }
}

/// The document of a file with the new name.
fn replaced(analysis: &Analysis, file: u16, spans: &[Span], new: &str) -> String {
    let source = analysis.source(file);
    let document = source.file();
    let mut text = document.text.clone();
    // The pieces of a text may be in another order in the file.
    let mut places: Vec<_> = spans.iter().map(|it| source.in_file(*it)).collect();
    places.sort_unstable_by_key(|it| it.start);
    for span in places.into_iter().rev() {
        let at = |it: u32| usize::try_from(it).unwrap_or(usize::MAX);
        text.replace_range(at(span.start)..at(span.end), new);
    }
    text
}

fn changes(
    analysis: &Analysis,
    files: &BTreeMap<u16, Vec<Span>>,
    new: &str,
) -> HashMap<gen_lsp_types::Uri, Vec<TextEdit>> {
    let edit = |span: &Span| TextEdit { range: analysis.range(*span), new_text: new.to_owned() };
    let of_file = |(file, spans): (&u16, &Vec<Span>)| {
        let uri = uri::of(analysis.path(*file)?);
        Some((uri, spans.iter().map(edit).collect()))
    };
    files.iter().filter_map(of_file).collect()
}
