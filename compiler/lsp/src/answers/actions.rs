//! What can be done about a diagnostic: its fix.

use super::problems::shown;
use crate::project::Analysis;
use crate::uri;
use gen_lsp_types::{CodeAction, CodeActionKind, Range, TextEdit, WorkspaceEdit};
use staunch_frontend::Severity;
use std::collections::HashMap;

pub fn actions(analysis: &Analysis, file: u16, within: Range) -> Vec<CodeAction> {
    let all = analysis.index.diagnostics.iter().filter(|it| it.span.file == file);
    let fixes = all.filter_map(|it| {
        let it = analysis.levels().apply(it.clone())?;
        let fix = it.fix.clone().filter(|fix| analysis.is_own(fix.span))?;
        let range = analysis.range(it.span);
        if range.end.line < within.start.line || within.end.line < range.start.line {
            return None;
        }
        let edit = TextEdit { range: analysis.range(fix.span), new_text: fix.replacement.clone() };
        let uri = uri::of(analysis.path(fix.span.file)?);
        let title = match fix.replacement.as_str() {
            "" => "Delete it".to_owned(),
            text if text.lines().count() == 1 => format!("Write `{}`", text.trim()),
            _ => it.help.clone().unwrap_or_else(|| "Apply the fix".to_owned()),
        };
        Some(CodeAction {
            title,
            kind: Some(CodeActionKind::QuickFix),
            diagnostics: Some(vec![shown(analysis, &it)]),
            is_preferred: Some(true),
            edit: Some(WorkspaceEdit { changes: Some(HashMap::from([(uri, vec![edit])])), ..WorkspaceEdit::default() }),
            ..CodeAction::default()
        })
    });
    fixes.collect()
}

/// Whether there are errors on the lines of a range.
pub fn has_errors(analysis: &Analysis, file: u16, within: Range) -> bool {
    let own = analysis.index.diagnostics.iter().filter(|it| it.span.file == file && it.severity == Severity::Error);
    own.map(|it| analysis.range(it.span)).any(|it| it.start.line <= within.end.line && within.start.line <= it.end.line)
}
