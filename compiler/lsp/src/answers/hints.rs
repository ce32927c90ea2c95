//! Names of parameters, where a call gives values by position; values of enumerators that have none written.

use super::signature::called;
use crate::calls::calls;
use crate::place::position;
use crate::project::Analysis;
use gen_lsp_types::{InlayHint, InlayHintKind, Label, Range};
use staunch_frontend::{Definition, DefinitionKind};

pub fn hints(analysis: &Analysis, file: u16, within: Range) -> Vec<InlayHint> {
    let source = analysis.source(file);
    let mut hints = Vec::new();
    for call in calls(file, &source.text) {
        let Some((_, meaning)) = analysis.index.at(file, call.name.start) else { continue };
        let all = called(analysis, analysis.text(call.name), &meaning);
        let [only] = all.as_slice() else { continue };
        // A call of one value needs no name for it.
        if only.parameters.len() < 2 {
            continue;
        }
        for (argument, parameter) in call.arguments.iter().zip(&only.parameters) {
            let is_empty = argument.span.start == argument.span.end;
            let says_it = analysis.text(argument.span).eq_ignore_ascii_case(&parameter.0);
            if argument.name.is_some() || is_empty || says_it {
                continue;
            }
            let at = position(source.file(), source.in_file(argument.span).start);
            if (within.start.line..=within.end.line).contains(&at.line) {
                hints.push(InlayHint {
                    position: at,
                    label: Label::String(format!("{}:", parameter.0)),
                    kind: Some(InlayHintKind::Parameter),
                    text_edits: None,
                    tooltip: None,
                    padding_left: None,
                    padding_right: Some(true),
                    data: None,
                });
            }
        }
    }
    hints.extend(values(analysis, file, within));
    hints
}

/// The values of the enumerators that are declared without one: each is the next after that before it.
fn values(analysis: &Analysis, file: u16, within: Range) -> Vec<InlayHint> {
    let source = analysis.source(file);
    let mut hints = Vec::new();
    let is_own = |it: &Definition| it.kind == DefinitionKind::Enumeration && it.name.file == file;
    for (id, _) in analysis.index.ids().filter(|it| is_own(it.1)) {
        let mut next = Some(0i64);
        for (_, it) in analysis.index.parts_of(id).filter(|it| it.1.kind == DefinitionKind::Enumerator) {
            if let Some(written) = written_value(analysis, it) {
                next = written.replace('_', "").parse::<i64>().ok().and_then(|it| it.checked_add(1));
                continue;
            }
            let Some(value) = next else { continue };
            next = value.checked_add(1);
            let at = position(source.file(), source.in_file(it.name).end);
            if (within.start.line..=within.end.line).contains(&at.line) {
                hints.push(InlayHint {
                    position: at,
                    label: Label::String(format!("= {value}")),
                    kind: None,
                    text_edits: None,
                    tooltip: None,
                    padding_left: Some(true),
                    padding_right: None,
                    data: None,
                });
            }
        }
    }
    hints
}

/// What is after an enumerator's `:=`.
fn written_value<'a>(analysis: &'a Analysis, it: &Definition) -> Option<&'a str> {
    let text = analysis.source(it.name.file).text.get(usize::try_from(it.name.end).ok()?..)?;
    let value = text.trim_start().strip_prefix(":=")?;
    value.split([',', ')', ';', '\n']).next().map(str::trim)
}
