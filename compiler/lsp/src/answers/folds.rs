//! What can be folded: from a word that opens a block to the one that ends it, and comments of several lines.

use crate::place::count;
use gen_lsp_types::{FoldingRange, FoldingRangeKind};
use staunch_frontend::{Source, format};
use staunch_syntax::lex::lex;

pub fn folds(source: &Source, file: u16) -> Vec<FoldingRange> {
    let line = |offset: u32| source.line(offset).saturating_sub(1);
    let mut folds = Vec::new();
    for block in format::block_ranges(&source.text) {
        // The line of the last word stays.
        let (from, to) = (line(count(block.start)), line(count(block.end)).saturating_sub(1));
        if from < to {
            folds.push(fold(from, to, None));
        }
    }
    let tokens = lex(file, &source.text);
    for (start, end) in tokens.comments.iter().copied() {
        let (from, to) = (line(start), line(end.saturating_sub(1)));
        if from < to {
            folds.push(fold(from, to, Some(FoldingRangeKind::Comment)));
        }
    }
    folds.sort_unstable_by_key(|it| (it.start_line, it.end_line));
    folds
}

fn fold(start_line: u32, end_line: u32, kind: Option<FoldingRangeKind>) -> FoldingRange {
    FoldingRange { start_line, end_line, kind, ..FoldingRange::default() }
}
