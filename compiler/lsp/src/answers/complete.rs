//! Completion: a name is put where one is typed, and what the compiler could take for it is offered.

use super::describe::describe;
use crate::place::{Place, count};
use crate::project::{Analysis, Documents, Project};
use gen_lsp_types::{
    CompletionItem, CompletionItemKind, Documentation, InsertTextFormat, MarkupContent, MarkupKind, Position,
};
use staunch_frontend::{DefinitionKind, Meaning, Offer, Source, format};
use staunch_syntax::lex::{Kind, lex};
use std::path::Path;

/// What nobody calls anything.
const HERE: &str = "staunch__here";

pub fn complete(project: &mut Project, documents: &Documents, path: &Path, position: Position) -> Vec<CompletionItem> {
    let analysis = project.analysis(documents);
    let Some(file) = analysis.file(path) else { return Vec::new() };
    let source = analysis.source(file);
    let document = source.file().text.clone();
    let at = crate::place::offset(source.file(), position);
    let (start, typed) = word_before(&document, at);
    if is_aside(source, analysis.place(path, position)) {
        return Vec::new();
    }
    let is_member = document[..start].trim_end().ends_with('.');
    let offered = |text: &str, is_wanted: fn(&Offer) -> bool| -> Vec<_> {
        let found = project.offers(documents, file, text, count(start));
        let offers = found.index.offers.iter().filter(|it| it.name != HERE && is_wanted(it));
        offers.map(|it| item(&found, it)).collect()
    };
    let mut items = offered(&with_name(&document, start, at, ";"), |_| true);
    if may_be_label(&document, start) {
        let mut labels = offered(&with_name(&document, start, at, ": ;"), |it| it.is_expected);
        items.retain(|it| labels.iter().all(|label| label.label != it.label));
        items.append(&mut labels);
    }
    if !is_member && !document[..start].trim_end().ends_with(['#', '%']) {
        items.extend(words(typed));
    }
    items
}

/// The part of a name that is before a place, and where it begins.
fn word_before(text: &str, at: u32) -> (usize, &str) {
    let end = usize::try_from(at).unwrap_or(usize::MAX).min(text.len());
    let before = text.get(..end).unwrap_or_default();
    let is_of_name = |it: char| it.is_alphanumeric() || it == '_';
    let start =
        before.rfind(|it| !is_of_name(it)).map_or(0, |it| it + before[it..].chars().next().map_or(1, char::len_utf8));
    (start, &before[start..])
}

/// Whether a name that begins a line may be a label: the innermost block around it is a CASE.
fn may_be_label(text: &str, start: usize) -> bool {
    let begins_line = text[..start].rsplit('\n').next().is_some_and(|it| it.trim().is_empty());
    let around = || format::block_ranges(text).into_iter().filter(|it| it.start < start && start <= it.end);
    let innermost = || around().min_by_key(|it| it.end - it.start);
    let is_case = |start: usize| text.get(start..start + 4).is_some_and(|it| it.eq_ignore_ascii_case("CASE"));
    begins_line && innermost().is_some_and(|it| is_case(it.start))
}

/// The document with a name in place of the one that is being typed, followed by what its statement lacks, with its end.
fn with_name(text: &str, start: usize, at: u32, end_of_statement: &str) -> String {
    let end = usize::try_from(at).unwrap_or(usize::MAX).min(text.len());
    let rest = &text[end..];
    let tail = rest.find(|it: char| !(it.is_alphanumeric() || it == '_')).unwrap_or(rest.len());
    let rest = &rest[tail..];
    let line = rest.lines().next().unwrap_or_default();
    // Brackets that are open are closed; a statement that is a name alone ends with its line.
    let before = text[..start].rsplit(['\n', ';']).next().unwrap_or_default();
    let depth = before.matches('(').count().saturating_sub(before.matches(')').count());
    let close = if line.trim().is_empty() { ")".repeat(depth) + end_of_statement } else { String::new() };
    format!("{}{HERE}{close}{rest}", &text[..start])
}

/// Whether a place is in a comment or a text.
fn is_aside(source: &Source, place: Option<Place>) -> bool {
    let Some(place) = place else { return true };
    let tokens = lex(place.file, &source.text);
    let at = |it: u32| usize::try_from(it).unwrap_or(usize::MAX);
    // The end of its line is still in a `//` comment.
    let is_of_line = |start: u32| source.text.get(at(start)..).is_some_and(|it| it.starts_with("//"));
    let holds =
        |it: &(u32, u32)| it.0 < place.offset && (place.offset < it.1 || place.offset == it.1 && is_of_line(it.0));
    let line = source.text.get(..at(place.offset)).unwrap_or_default().rsplit('\n').next().unwrap_or_default();
    // A text ends with its line at the latest.
    let is_text = line.matches('\'').count() % 2 == 1;
    is_text || tokens.comments.iter().any(holds)
}

fn item(analysis: &Analysis, offer: &Offer) -> CompletionItem {
    let about = describe(analysis, &offer.name, &offer.meaning);
    let kind = kind(analysis, &offer.meaning);
    let detail = about.as_ref().map(|it| it.code.lines().next().unwrap_or_default().to_owned());
    let documentation = about
        .filter(|it| !it.text.is_empty())
        .map(|it| Documentation::MarkupContent(MarkupContent { kind: MarkupKind::Markdown, value: it.text }));
    let near = match &offer.meaning {
        _ if offer.is_expected => '0',
        Meaning::Definition(id) if analysis.index.get(*id).owner.is_some() => '1',
        Meaning::Definition(id) if analysis.path(analysis.index.get(*id).name.file).is_some() => '2',
        _ => '3',
    };
    CompletionItem {
        label: offer.name.clone(),
        kind: Some(kind),
        detail,
        documentation,
        sort_text: Some(format!("{near}{}", offer.name)),
        ..CompletionItem::default()
    }
}

fn kind(analysis: &Analysis, meaning: &Meaning) -> CompletionItemKind {
    match meaning {
        Meaning::Definition(id) => match analysis.index.get(*id).kind {
            DefinitionKind::Program | DefinitionKind::Configuration | DefinitionKind::Resource => {
                CompletionItemKind::Module
            }
            DefinitionKind::FunctionBlock | DefinitionKind::Class => CompletionItemKind::Class,
            DefinitionKind::Interface => CompletionItemKind::Interface,
            DefinitionKind::Function | DefinitionKind::Test => CompletionItemKind::Function,
            DefinitionKind::Method | DefinitionKind::Action => CompletionItemKind::Method,
            DefinitionKind::Property => CompletionItemKind::Property,
            DefinitionKind::Type | DefinitionKind::Structure | DefinitionKind::Union => CompletionItemKind::Struct,
            DefinitionKind::Enumeration => CompletionItemKind::Enum,
            DefinitionKind::Enumerator => CompletionItemKind::EnumMember,
            DefinitionKind::Member => CompletionItemKind::Field,
            DefinitionKind::Constant => CompletionItemKind::Constant,
            DefinitionKind::Variable(_) | DefinitionKind::Instance => CompletionItemKind::Variable,
            DefinitionKind::Label | DefinitionKind::Step => CompletionItemKind::Reference,
            DefinitionKind::Task => CompletionItemKind::Event,
        },
        Meaning::Namespace(_) => CompletionItemKind::Module,
        Meaning::Elementary(_) => CompletionItemKind::Struct,
        Meaning::Block(_) => CompletionItemKind::Class,
        Meaning::Pin(..) | Meaning::Parameter => CompletionItemKind::Property,
        Meaning::Function | Meaning::Instruction => CompletionItemKind::Function,
        Meaning::Word => CompletionItemKind::Keyword,
    }
}

/// Blocks of statements and declarations, by the words that open them.
const SNIPPETS: [(&str, &str); 12] = [
    ("IF", "IF ${1:condition} THEN\n\t$0\nEND_IF"),
    ("CASE", "CASE ${1:selector} OF\n\t${2:0}: $0\nEND_CASE"),
    ("FOR", "FOR ${1:i} := ${2:0} TO ${3:9} DO\n\t$0\nEND_FOR"),
    ("WHILE", "WHILE ${1:condition} DO\n\t$0\nEND_WHILE"),
    ("REPEAT", "REPEAT\n\t$0\nUNTIL ${1:condition}\nEND_REPEAT"),
    ("VAR", "VAR\n\t${1:name} : ${2:BOOL};$0\nEND_VAR"),
    ("VAR_INPUT", "VAR_INPUT\n\t${1:name} : ${2:BOOL};$0\nEND_VAR"),
    ("VAR_OUTPUT", "VAR_OUTPUT\n\t${1:name} : ${2:BOOL};$0\nEND_VAR"),
    ("PROGRAM", "PROGRAM ${1:Main}\nVAR\n\t$2\nEND_VAR\n$0\nEND_PROGRAM"),
    ("FUNCTION", "FUNCTION ${1:Name} : ${2:BOOL}\nVAR_INPUT\n\t$3\nEND_VAR\n$0\nEND_FUNCTION"),
    ("FUNCTION_BLOCK", "FUNCTION_BLOCK ${1:Name}\nVAR_INPUT\n\t$2\nEND_VAR\n$0\nEND_FUNCTION_BLOCK"),
    ("STRUCT", "STRUCT\n\t${1:name} : ${2:BOOL};$0\nEND_STRUCT"),
];

/// Keywords; nothing where letters are typed that none of them has.
fn words(typed: &str) -> Vec<CompletionItem> {
    let begins = |it: &str| it.get(..typed.len()).is_some_and(|it| it.eq_ignore_ascii_case(typed));
    let snippets = SNIPPETS.iter().filter(|it| begins(it.0)).map(|(word, text)| CompletionItem {
        label: (*word).to_owned(),
        kind: Some(CompletionItemKind::Snippet),
        insert_text: Some((*text).to_owned()),
        insert_text_format: Some(InsertTextFormat::Snippet),
        sort_text: Some(format!("4{word}")),
        ..CompletionItem::default()
    });
    let plain = Kind::keywords().map(|it| it.0).filter(|it| begins(it) && !SNIPPETS.iter().any(|known| known.0 == *it));
    let plain = plain.map(|word| CompletionItem {
        label: word.to_owned(),
        kind: Some(CompletionItemKind::Keyword),
        sort_text: Some(format!("5{word}")),
        ..CompletionItem::default()
    });
    snippets.chain(plain).collect()
}
