//! A program with counter blocks as it would be written for Logix: a COUNTER for each instance, an
//! instruction for each of its inputs.

mod edit;

mod counter;
mod instructions;
mod shape;

mod writer;

use edit::{Edit, bounds, origin};
use shape::Shapes;
use staunch_frontend::ast::{File, Item, VarBlock};
use staunch_frontend::{Dialect, Sources, Span, parse_file};
use std::collections::HashSet;
use writer::Writer;

#[derive(Debug)]
pub struct Rewritten {
    pub sources: Sources,
    /// Lines before and after.
    pub notes: Vec<(String, String)>,
    /// For each file, what was replaced, in order; no replacement is inside another.
    edits: Vec<Vec<Edit>>,
}

impl Rewritten {
    /// A text of the user's own.
    pub fn by_user(sources: Sources) -> Self {
        Self { sources, notes: Vec::new(), edits: Vec::new() }
    }

    /// Where what is written here comes from: the place in the user's text, as a whole where it was
    /// replaced.
    pub fn origin(&self, span: Span) -> Span {
        let Some(edits) = self.edits.get(usize::from(span.file)) else { return span };
        let (start, end) = bounds(span);
        let number = |it: usize| u32::try_from(it).unwrap_or(u32::MAX);
        Span { file: span.file, start: number(origin(edits, start, false)), end: number(origin(edits, end, true)) }
    }
}

/// `None` where there is nothing to rewrite.
///
/// # Errors
///
/// Where the program declares what an instruction is called that it needs.
pub fn rewrite(sources: &Sources, from: Dialect) -> Result<Option<Rewritten>, String> {
    let numbers = 0..u16::try_from(sources.files().len()).unwrap_or(u16::MAX);
    let files: Vec<File<'_>> = numbers.map(|it| parse_file(sources, it)).collect();
    let mut shapes = Shapes::of(&files, from);
    globals(&files).for_each(|it| it.vars.iter().for_each(|it| shapes.declare(it)));
    let (mut notes, mut all, mut texts) = (Vec::new(), Vec::new(), Vec::new());
    let mut loaded = HashSet::new();
    for (source, file) in sources.files().iter().zip(&files) {
        // What a counter is read as depends on its calls, wherever they are.
        let mut first = Writer::new(&source.text, shapes, loaded);
        first.file(file);
        (shapes, loaded) = (first.shapes, first.loaded);
    }
    for (source, file) in sources.files().iter().zip(&files) {
        let mut writer = Writer::new(&source.text, shapes, loaded.clone());
        writer.file(file);
        notes.extend(writer.notes());
        texts.push(writer.apply(0, source.text.len()));
        writer.edits.sort_by_key(|it| it.start);
        all.push(writer.edits);
        shapes = writer.shapes;
    }
    if let Some(name) = pous(&files).find(|it| is_called(it, &notes)) {
        return Err(format!(
            "the program's own `{name}` has the name of the instruction of Logix that its counters need there: rename it"
        ));
    }
    Ok((!notes.is_empty()).then(|| Rewritten { sources: sources.with_texts(texts), notes, edits: all }))
}

/// The names of POUs that are those of instructions which the rewriting calls.
fn pous<'f>(files: &'f [File<'f>]) -> impl Iterator<Item = &'f str> {
    let names = files.iter().flat_map(|it| &it.items).filter_map(|it| match it {
        Item::Pou(pou) => Some(pou.name.text),
        Item::Types(_) | Item::Globals(_) | Item::Configuration(_) | Item::Test(_) => None,
    });
    names.filter(|name| ["CTU", "CTD", "CTUD", "RES"].iter().any(|it| it.eq_ignore_ascii_case(name)))
}

fn is_called(name: &str, notes: &[(String, String)]) -> bool {
    let call = format!("{}(", name.to_ascii_uppercase());
    notes.iter().any(|(before, after)| after.contains(&call) && !before.to_ascii_uppercase().contains(&call))
}

fn globals<'f>(files: &'f [File<'f>]) -> impl Iterator<Item = &'f VarBlock<'f>> {
    files.iter().flat_map(|it| &it.items).flat_map(|it| match it {
        Item::Globals(block) => std::slice::from_ref(block),
        Item::Configuration(it) => it.globals.as_slice(),
        Item::Types(_) | Item::Pou(_) | Item::Test(_) => &[],
    })
}
