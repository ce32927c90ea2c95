//! Completion: a name is put where one is typed, and what the compiler could take for it is offered.

use super::describe::describe;
use super::symbols::holds;
use crate::place::{Place, count};
use crate::project::{Analysis, Documents, Project, place};
use gen_lsp_types::{
    CompletionItem, CompletionItemKind, Documentation, InsertTextFormat, MarkupContent, MarkupKind, Position,
};
use staunch_frontend::ast::VarKind;
use staunch_frontend::{Definition, DefinitionKind, Meaning, Offer, Source, format};
use staunch_runtime::Direction;
use staunch_syntax::lex::{Kind, lex};
use std::path::Path;

/// What nobody calls anything.
const HERE: &str = "staunch__here";

/// So many names are offered whatever is typed already.
const MANY: usize = 1000;

/// The same where it would be a label: a statement may follow.
const LABEL: &str = "staunch__here: ;";

pub fn complete(project: &mut Project, documents: &Documents, path: &Path, position: Position) -> Vec<CompletionItem> {
    let Some(file) = project.file(path) else { return Vec::new() };
    let sources = project.sources(documents);
    let source = sources.get(file);
    let document = source.file().text.as_str();
    let at = crate::place::offset(source.file(), position);
    let (start, typed) = word_before(document, at);
    if is_aside(source, place(&sources, file, position)) {
        return Vec::new();
    }
    let before = &document[..start];
    // A comment may end with a point.
    let last = || lex(file, before).kinds.into_iter().rev().find(|it| *it != Kind::End);
    let is_member = before.trim_end().ends_with('.') && last() == Some(Kind::Dot);
    let label = if may_be_label(document, start) { LABEL } else { "" };
    let text = with_name(document, start, at, label);
    let length = count(label.len()) + 1;
    let Some(found) = project.offers(documents, file, &text, (count(start), length)) else { return Vec::new() };
    let here = Here { file, at: count(start), is_member, is_connected: is_connected(document, start) };
    let offers = &found.index.offers;
    // An editor asks again where it would show more of them: where letters are deleted.
    let is_near = |it: &&Offer| offers.len() < MANY || is_meant(&it.name, typed);
    let offers = offers.iter().filter(|it| it.name != HERE && here.takes(&found, it)).filter(is_near);
    let mut items: Vec<_> = offers.map(|it| item(&found, it, &here)).collect();
    if !is_member && !document[..start].trim_end().ends_with(['#', '%']) {
        items.extend(words(typed));
    }
    items
}

/// Where a name is typed.
struct Here {
    file: u16,
    at: u32,
    /// It is after a point.
    is_member: bool,
    /// `:=` or `=>` is after it.
    is_connected: bool,
}

impl Here {
    /// Whether an offer is one of what is here: what could only be visible is not a member.
    fn takes(&self, analysis: &Analysis, offer: &Offer) -> bool {
        let is_visible_alone = match &offer.meaning {
            Meaning::Function => true,
            Meaning::Definition(id) => {
                let definition = analysis.index.get(*id);
                matches!(definition.kind, DefinitionKind::Variable(_)) && definition.owner.is_some()
            }
            _ => false,
        };
        offer.is_expected || !self.is_member || !is_visible_alone
    }

    fn is_in(&self, definition: &Definition) -> bool {
        let extent = definition.extent;
        extent.file == self.file && extent.start <= self.at && self.at <= extent.end
    }

    /// What connects a pin of a call that begins an argument here.
    fn connection(&self, analysis: &Analysis, offer: &Offer) -> Option<&'static str> {
        let by = |is_output: bool| Some(if is_output { "=>" } else { ":=" });
        if self.is_member || self.is_connected || !offer.is_expected {
            return None;
        }
        match &offer.meaning {
            Meaning::Pin(block, at) => by(block.info().pins[*at].direction == Direction::Output),
            Meaning::Parameter => by(false),
            Meaning::Definition(id) => {
                let definition = analysis.index.get(*id);
                let is_own = definition.owner.is_none_or(|it| self.is_in(analysis.index.get(it)));
                match definition.kind {
                    DefinitionKind::Variable(VarKind::Output) if !is_own => by(true),
                    DefinitionKind::Variable(VarKind::Input | VarKind::InOut) if !is_own => by(false),
                    _ => None,
                }
            }
            _ => None,
        }
    }
}

/// Whether an argument that begins at a place is written with its sign.
fn is_connected(text: &str, start: usize) -> bool {
    let rest = text[start..].trim_start_matches(|it: char| it.is_alphanumeric() || it == '_').trim_start();
    rest.starts_with(":=") || rest.starts_with("=>")
}

/// Whether what is typed may be short for a name: it begins a word of it, and the rest follows.
fn is_meant(name: &str, typed: &str) -> bool {
    let mut before = '_';
    name.char_indices().any(|(at, letter)| {
        let begins_word = !before.is_alphabetic() || before.is_lowercase() && letter.is_uppercase();
        before = letter;
        let first = typed.chars().next().is_none_or(|it| it.eq_ignore_ascii_case(&letter));
        begins_word && first && holds(&name[at..], typed)
    })
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

/// The document with a name in place of the one that is being typed, after a label perhaps, and before what its statement lacks.
fn with_name(text: &str, start: usize, at: u32, label: &str) -> String {
    let end = usize::try_from(at).unwrap_or(usize::MAX).min(text.len());
    let rest = &text[end..];
    let tail = rest.find(|it: char| !(it.is_alphanumeric() || it == '_')).unwrap_or(rest.len());
    let rest = &rest[tail..];
    let line = rest.lines().next().unwrap_or_default();
    // Brackets that are open are closed; a statement that is a name alone ends with its line.
    let before = text[..start].rsplit(['\n', ';']).next().unwrap_or_default();
    let depth = before.matches('(').count().saturating_sub(before.matches(')').count());
    let close = if line.trim().is_empty() { ")".repeat(depth) + ";" } else { String::new() };
    format!("{}{label}{HERE}{close}{rest}", &text[..start])
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

fn item(analysis: &Analysis, offer: &Offer, here: &Here) -> CompletionItem {
    let about = describe(analysis, &offer.name, &offer.meaning);
    let is_result = |it: &Definition| {
        let has_result = it.ty.is_some();
        has_result && matches!(it.kind, DefinitionKind::Function | DefinitionKind::Method) && here.is_in(it)
    };
    let kind = match &offer.meaning {
        // In its own body, its name is its result.
        Meaning::Definition(id) if is_result(analysis.index.get(*id)) => CompletionItemKind::Variable,
        meaning => kind(analysis, meaning),
    };
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
        insert_text: here.connection(analysis, offer).map(|it| format!("{} {it} ", offer.name)),
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

#[cfg(test)]
mod tests {
    use super::is_meant;

    #[test]
    fn words_of_a_name_are_typed_by_their_beginnings() {
        for typed in ["", "m", "MV", "maxV", "value", "V"] {
            assert!(is_meant("MaxValue", typed), "{typed}");
        }
        assert!(!is_meant("MaxValue", "alue"));
        assert!(is_meant("int_to_real", "tr") && !is_meant("int_to_real", "o"));
    }
}
