//! Diagnostics.

use crate::project::Analysis;
use gen_lsp_types::{
    Code, CodeDescription, Diagnostic, DiagnosticRelatedInformation, DiagnosticSeverity, DiagnosticTag, Message,
};
use staunch_frontend::{Code as Lint, Severity};

const PAGES: &str = "https://github.com/staunch-lang/staunch/blob/main/docs/diagnostics.md";

/// What there is to say of a file.
pub fn of(analysis: &Analysis, file: u16) -> Vec<Diagnostic> {
    let all = analysis.index.diagnostics.iter().filter(|it| it.span.file == file);
    all.filter_map(|it| analysis.levels().apply(it.clone())).map(|it| shown(analysis, &it)).collect()
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
