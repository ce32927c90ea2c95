//! Diagnostics.

use crate::project::Analysis;
use gen_lsp_types::{
    Code, CodeDescription, Diagnostic, DiagnosticRelatedInformation, DiagnosticSeverity, DiagnosticTag, Message,
};
use staunch_frontend::{Code as Lint, Severity};

const PAGES: &str = "https://github.com/staunch-lang/staunch/blob/main/docs/diagnostics.md";

/// What there is to say of a file, and which others of its project cannot be read.
pub fn of(analysis: &Analysis, file: u16) -> Vec<Diagnostic> {
    let all = &analysis.index.diagnostics;
    let unread = all.iter().filter(|it| it.code == Lint::E0033 && it.span.file != file);
    let unread = unread.map(|it| of_project(format!("{}: {}", analysis.source(it.span.file).path, it.message)));
    let own = all.iter().filter(|it| it.span.file == file);
    let own = own.filter_map(|it| analysis.levels().apply(it.clone())).map(|it| shown(analysis, &it));
    unread.chain(own).collect()
}

/// What is wrong with a project, at the beginning of each of its files.
pub fn of_project(why: String) -> Diagnostic {
    Diagnostic {
        severity: Some(DiagnosticSeverity::Error),
        source: Some("staunch".to_owned()),
        message: Message::String(why),
        ..Diagnostic::default()
    }
}

pub fn shown(analysis: &Analysis, it: &staunch_frontend::Diagnostic) -> Diagnostic {
    let others = it.others.iter().filter_map(|it| {
        let location = analysis.location(it.span)?;
        Some(DiagnosticRelatedInformation { location, message: it.text.clone() })
    });
    let others: Vec<_> = others.collect();
    let lines = [Some(it.message.to_string()), it.label.clone()].into_iter().flatten();
    let notes = it.notes.iter().map(|it| format!("note: {it}")).chain(it.help.as_ref().map(|it| format!("help: {it}")));
    let text: Vec<_> = lines.chain(notes).collect();
    // An editor fades what could be deleted.
    let is_unused = matches!(it.code, Lint::W0501 | Lint::W0502);
    Diagnostic {
        range: analysis.range(it.span),
        severity: Some(match it.severity {
            Severity::Error => DiagnosticSeverity::Error,
            Severity::Warning => DiagnosticSeverity::Warning,
        }),
        code: Some(Code::String(it.code.name().to_owned())),
        code_description: Some(CodeDescription { href: PAGES.into() }),
        source: Some("staunch".to_owned()),
        message: Message::String(text.join("\n")),
        tags: is_unused.then(|| vec![DiagnosticTag::Unnecessary]),
        related_information: Some(others).filter(|it| !it.is_empty()),
        ..Diagnostic::default()
    }
}
