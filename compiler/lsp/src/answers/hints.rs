//! Names of parameters, where a call gives values by position.

use super::signature::called;
use crate::calls::calls;
use crate::place::position;
use crate::project::Analysis;
use gen_lsp_types::{InlayHint, InlayHintKind, Label, Range};

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
    hints
}
