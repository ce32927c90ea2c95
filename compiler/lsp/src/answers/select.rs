//! Selections that grow: from a name to its expression, statement, block and POU.

use crate::place::Place;
use crate::project::Analysis;
use gen_lsp_types::SelectionRange;
use staunch_frontend::{Span, ast, parse_file};
use staunch_syntax::lex::{Kind, lex};

/// Of an outline of the file.
pub fn around(analysis: &Analysis, place: Place) -> Option<SelectionRange> {
    let file = parse_file(&analysis.sources, place.file);
    let mut spans: Vec<Span> = Vec::new();
    let mut add = |it: Span| {
        if it.file == place.file && it.start <= place.offset && place.offset <= it.end {
            spans.push(it);
        }
    };
    let tokens = lex(place.file, &analysis.source(place.file).text);
    let words = tokens.kinds.iter().zip(&tokens.places).filter(|it| *it.0 == Kind::Name);
    words.for_each(|(_, (start, end))| add(Span { file: place.file, start: *start, end: *end }));
    for item in &file.items {
        let ast::Item::Pou(pou) = item else { continue };
        for pou in core::iter::once(pou).chain(&pou.routines) {
            add(pou.extent);
            pou.blocks.iter().flat_map(|it| &it.vars).for_each(|it| add(it.span));
            ast::each_statement(&pou.body, &mut |it| add(it.span));
            ast::each_expr(&pou.body, &mut |it| add(it.span));
        }
    }
    analysis.index.definitions.iter().for_each(|it| add(it.extent));
    let text = &analysis.source(place.file).text;
    add(Span { file: place.file, start: 0, end: crate::place::count(text.len()) });
    spans.sort_unstable_by_key(|it| std::cmp::Reverse(it.end - it.start));
    spans.dedup();
    let nested = spans.into_iter().fold(None::<(Span, SelectionRange)>, |outer, it| match outer {
        // Each is in the one before it.
        Some((around, _)) if it.start < around.start || around.end < it.end || it == around => outer,
        _ => {
            let parent = outer.map(|it| Box::new(it.1));
            Some((it, SelectionRange { range: analysis.range(it), parent }))
        }
    });
    nested.map(|it| it.1)
}
