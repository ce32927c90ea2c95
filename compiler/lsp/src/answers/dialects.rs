//! Sources that are rejected in the dialect that nobody chose, and accepted in another one.

use crate::host::Choice;
use crate::uri;
use gen_lsp_types::{
    CodeAction, CodeActionKind, CreateFile, CreateFileOptions, Diagnostic, DiagnosticSeverity, DocumentChange, Edit,
    Message, OptionalVersionedTextDocumentIdentifier, Position, Range, TextDocumentEdit, TextDocumentIdentifier,
    TextEdit, WorkspaceEdit,
};
use staunch_frontend::Dialect;

/// What is said at the first error of a document.
pub fn hint(found: &[Diagnostic], dialects: &[Dialect]) -> Option<Diagnostic> {
    let first = found.iter().find(|it| it.severity == Some(DiagnosticSeverity::Error))?;
    let names: Vec<_> = dialects.iter().map(|it| format!("`{}`", it.name())).collect();
    let s = if names.len() == 1 { "" } else { "s" };
    Some(Diagnostic {
        range: first.range,
        severity: Some(DiagnosticSeverity::Information),
        source: Some("staunch".to_owned()),
        message: Message::String(format!("accepted with the dialect{s} {}", names.join(" or "))),
        ..Diagnostic::default()
    })
}

/// Writes a dialect into the settings of the project, which are made where they do not exist.
pub fn choose(choice: &Choice, dialect: Dialect) -> CodeAction {
    let settings = uri::of(&choice.settings);
    let start = Position { line: 0, character: 0 };
    let edit = TextEdit { range: Range { start, end: start }, new_text: format!("dialect = \"{}\"\n", dialect.name()) };
    let options = CreateFileOptions { overwrite: None, ignore_if_exists: Some(true) };
    let create = CreateFile::new(settings.clone(), Some(options), None);
    let write = TextDocumentEdit {
        text_document: OptionalVersionedTextDocumentIdentifier {
            version: None,
            text_document_identifier: TextDocumentIdentifier { uri: settings },
        },
        edits: vec![Edit::TextEdit(edit)],
    };
    let create = (!choice.has_settings).then_some(DocumentChange::CreateFile(create));
    CodeAction {
        title: format!("Use the dialect `{}`: write it into staunch.toml", dialect.name()),
        kind: Some(CodeActionKind::QuickFix),
        edit: Some(WorkspaceEdit {
            document_changes: Some(create.into_iter().chain([DocumentChange::TextDocumentEdit(write)]).collect()),
            ..WorkspaceEdit::default()
        }),
        ..CodeAction::default()
    }
}
