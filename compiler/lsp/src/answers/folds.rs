//! What can be folded: from a word that opens a block to the one that ends it, and comments of several lines.

use crate::project::Analysis;
use gen_lsp_types::{FoldingRange, FoldingRangeKind};
use staunch_syntax::lex::lex;

pub fn folds(analysis: &Analysis, file: u16) -> Vec<FoldingRange> {
    let source = analysis.source(file);
    let tokens = lex(file, &source.text);
    let line = |offset: u32| source.line(offset).saturating_sub(1);
    let mut folds = Vec::new();
    let mut open: Vec<(String, u32)> = Vec::new();
    for (start, end) in tokens.places.iter().copied() {
        let text = source.text.get(index(start)..index(end)).unwrap_or_default().to_ascii_uppercase();
        if let Some(opened) = text.strip_prefix("END_") {
            let is_it = |it: &(String, u32)| it.0 == opened || opened == "VAR" && it.0.starts_with("VAR");
            if let Some(at) = open.iter().rposition(is_it) {
                let from = open[at].1;
                open.truncate(at);
                // The line of the END stays.
                let to = line(start).saturating_sub(1);
                if line(from) < to {
                    folds.push(fold(line(from), to, None));
                }
            }
        } else if OPENERS.contains(&text.as_str()) {
            open.push((text, start));
        }
    }
    for (start, end) in tokens.comments.iter().copied() {
        let (from, to) = (line(start), line(end.saturating_sub(1)));
        if from < to {
            folds.push(fold(from, to, Some(FoldingRangeKind::Comment)));
        }
    }
    folds.sort_unstable_by_key(|it| (it.start_line, it.end_line));
    folds
}

const OPENERS: [&str; 28] = [
    "PROGRAM",
    "FUNCTION",
    "FUNCTION_BLOCK",
    "CLASS",
    "INTERFACE",
    "METHOD",
    "PROPERTY",
    "GET",
    "SET",
    "ACTION",
    "TEST",
    "TYPE",
    "STRUCT",
    "UNION",
    "VAR",
    "VAR_INPUT",
    "VAR_OUTPUT",
    "VAR_IN_OUT",
    "VAR_TEMP",
    "VAR_GLOBAL",
    "VAR_EXTERNAL",
    "IF",
    "CASE",
    "FOR",
    "WHILE",
    "REPEAT",
    "NAMESPACE",
    "CONFIGURATION",
];

fn fold(start_line: u32, end_line: u32, kind: Option<FoldingRangeKind>) -> FoldingRange {
    FoldingRange { start_line, end_line, kind, ..FoldingRange::default() }
}

fn index(offset: u32) -> usize {
    usize::try_from(offset).unwrap_or(usize::MAX)
}
