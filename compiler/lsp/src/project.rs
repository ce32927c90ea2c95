//! A program as it is in the editor: the files of a unit, with what is typed in place of what is on disk.

use crate::host::Unit;
use crate::place::{self, Place};
use crate::uri;
use gen_lsp_types::{Location, Position, Range};
use rustc_hash::FxHashMap;
use staunch_frontend::{DefId, Definition, Dialect, Index, Meaning, Source, Sources, Span, index};
use std::path::{Path, PathBuf};

/// The texts of open documents, by their paths.
pub type Documents = FxHashMap<PathBuf, String>;

#[derive(Debug)]
pub struct Project {
    pub unit: Unit,
    /// Of the texts as they are; nothing where they have changed since.
    analysis: Option<Analysis>,
}

/// What is known of a program.
#[derive(Debug)]
pub struct Analysis {
    /// Those of the unit, and then units of the library that they use.
    pub sources: Sources,
    pub index: Index,
    paths: Vec<PathBuf>,
    dialect: Dialect,
}

impl Project {
    pub fn new(unit: Unit) -> Self {
        Self { unit, analysis: None }
    }

    pub fn has(&self, path: &Path) -> bool {
        self.unit.paths.iter().any(|it| it == path)
    }

    /// A text of it has changed.
    pub fn forget(&mut self) {
        self.analysis = None;
    }

    pub fn analysis(&mut self, documents: &Documents) -> &Analysis {
        let unit = &self.unit;
        self.analysis.get_or_insert_with(|| Analysis::of(unit, typed(unit, documents), None))
    }

    /// What a name could be that begins at a place of one of the files, whose text is another one for that.
    pub fn offers(&self, documents: &Documents, file: u16, text: &str, at: u32) -> Analysis {
        let mut sources = typed(&self.unit, documents);
        sources.replace(file, text);
        let asked = sources.get(file).in_text(at).map(|it| (file, it));
        Analysis::of(&self.unit, sources, asked)
    }

    /// The program with other texts in some of its files.
    pub fn changed(&self, documents: &Documents, texts: &[(u16, String)]) -> Analysis {
        let mut sources = typed(&self.unit, documents);
        texts.iter().for_each(|(file, text)| sources.replace(*file, text));
        Analysis::of(&self.unit, sources, None)
    }
}

/// The sources as they are in the editor.
fn typed(unit: &Unit, documents: &Documents) -> Sources {
    let mut sources = unit.sources.clone();
    for (path, file) in unit.paths.iter().zip(0u16..) {
        if let Some(text) = documents.get(path) {
            sources.replace(file, text);
        }
    }
    sources
}

impl Analysis {
    fn of(unit: &Unit, sources: Sources, asked: Option<(u16, u32)>) -> Self {
        let (index, extended) = index(&sources, &unit.options, asked);
        let dialect = unit.options.dialect;
        Self { index, sources: extended.unwrap_or(sources), paths: unit.paths.clone(), dialect }
    }

    pub fn file(&self, path: &Path) -> Option<u16> {
        self.paths.iter().zip(0u16..).find(|it| it.0 == path).map(|it| it.1)
    }

    /// The byte of a text that is at a position of its document. In a file of another system's not all of it is text.
    pub fn place(&self, path: &Path, position: Position) -> Option<Place> {
        let file = self.file(path)?;
        let source = self.sources.get(file);
        let at = place::offset(source.file(), position);
        // The end of a piece is a place in it, too.
        let before = || source.in_text(at.checked_sub(1)?).map(|it| it + 1);
        Some(Place { file, offset: source.in_text(at).or_else(before)? })
    }

    pub fn source(&self, file: u16) -> &Source {
        self.sources.get(file)
    }

    pub fn range(&self, span: Span) -> Range {
        place::range(self.sources.get(span.file), span)
    }

    /// Where a part of a project's file is; nothing for the library.
    pub fn location(&self, span: Span) -> Option<Location> {
        let path = self.paths.get(usize::from(span.file))?;
        Some(Location { uri: uri::of(path), range: self.range(span) })
    }

    pub fn path(&self, file: u16) -> Option<&Path> {
        self.paths.get(usize::from(file)).map(PathBuf::as_path)
    }

    /// Whether a place is in the project's own text, and can be replaced there.
    pub fn is_own(&self, span: Span) -> bool {
        let source = self.sources.get(span.file);
        self.path(span.file).is_some() && !source.is_of_library() && source.is_verbatim(span)
    }

    pub fn text(&self, span: Span) -> &str {
        self.sources.text(span)
    }

    /// The dialect of the project; a file may say another one.
    pub fn dialect(&self) -> Dialect {
        self.dialect
    }

    pub fn name(&self, id: DefId) -> &str {
        self.text(self.index.get(id).name)
    }

    pub fn at(&self, place: Place) -> Option<(Span, Meaning)> {
        self.index.at(place.file, place.offset)
    }

    pub fn definition_at(&self, place: Place) -> Option<DefId> {
        match self.at(place)?.1 {
            Meaning::Definition(id) => Some(id),
            _ => None,
        }
    }

    /// What the type of a declaration is: of an array, that of its elements.
    pub fn type_of(&self, id: DefId) -> Option<Meaning> {
        let written = self.index.get(id).ty?;
        let last = self.index.uses_in(written).last()?;
        Some(last.meaning.clone())
    }

    /// What a class EXTENDS and IMPLEMENTS.
    pub fn bases(&self, id: DefId) -> Vec<DefId> {
        let named = |it: &Span| match self.index.at(it.file, it.start)?.1 {
            Meaning::Definition(base) => Some(base),
            _ => None,
        };
        self.index.get(id).bases.iter().filter_map(named).collect()
    }

    /// The classes that EXTEND or IMPLEMENT one.
    pub fn heirs(&self, id: DefId) -> Vec<DefId> {
        let all = self.index.ids().filter(|it| !it.1.bases.is_empty());
        all.map(|it| it.0).filter(|it| self.bases(*it).contains(&id)).collect()
    }

    /// What a class holds, and then what those hold that it extends.
    pub fn members(&self, id: DefId) -> Vec<(DefId, &Definition)> {
        let (mut classes, mut at) = (vec![id], 0);
        while at < classes.len() {
            let new: Vec<_> = self.bases(classes[at]).into_iter().filter(|it| !classes.contains(it)).collect();
            classes.extend(new);
            at += 1;
        }
        classes.into_iter().flat_map(|it| self.index.parts_of(it)).collect()
    }
}
