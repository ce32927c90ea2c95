//! A program as it is in the editor: the files of a unit, with what is typed in place of what is on disk.

use crate::host::Unit;
use crate::place::{self, Place};
use crate::results::Results;
use crate::uri;
use gen_lsp_types::{Location, Position};
use rustc_hash::FxHashMap;
use staunch_frontend::{
    Asked, DefId, Definition, Dialect, Index, Levels, Meaning, Source, Sources, Span, Stop, index, outline,
    without_bodies,
};
use std::ops::Range;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The texts of open documents, by their paths.
pub type Documents = FxHashMap<PathBuf, String>;

/// What is known of it is of the texts as they are, and forgotten where one changes.
#[derive(Debug)]
pub struct Project {
    pub unit: Arc<Unit>,
    sources: Option<Arc<Sources>>,
    /// For each file, without its bodies.
    heads: Vec<Option<Source>>,
    whole: Option<Arc<Analysis>>,
    near: Option<(Place, Arc<Analysis>)>,
    /// The check that runs.
    check: Option<(CheckId, Stop)>,
    /// Whether other dialects are to be asked where there are errors, since it was opened or saved.
    asks_dialects: bool,
    /// Those that accept it as it was then.
    pub dialects: Vec<Dialect>,
    pub results: Results,
}

/// Each check has another number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CheckId(pub u64);

/// What is known of a program.
#[derive(Debug)]
pub struct Analysis {
    /// Those of the unit, and then units of the library that they use.
    pub sources: Arc<Sources>,
    pub index: Index,
    unit: Arc<Unit>,
}

impl Project {
    pub fn new(unit: Unit) -> Self {
        let heads = (0u16..).take(unit.paths.len()).map(|it| Some(without_bodies(&unit.sources, it))).collect();
        Self {
            unit: Arc::new(unit),
            sources: None,
            heads,
            whole: None,
            near: None,
            check: None,
            asks_dialects: true,
            dialects: Vec::new(),
            results: Results::default(),
        }
    }

    pub fn has(&self, path: &Path) -> bool {
        self.unit.paths.iter().any(|it| it == path)
    }

    pub fn file(&self, path: &Path) -> Option<u16> {
        self.unit.file(path)
    }

    /// The text of a file has changed.
    pub fn has_changed(&mut self, path: &Path) {
        if let Some(head) = self.file(path).and_then(|it| self.heads.get_mut(usize::from(it))) {
            *head = None;
        }
        self.results.forget();
        self.forget();
    }

    /// Nothing is known any more.
    pub fn forget(&mut self) {
        (self.sources, self.whole, self.near) = (None, None, None);
        if let Some((_, stop)) = self.check.take() {
            stop.set();
        }
    }

    /// The sources as they are in the editor.
    pub fn sources(&mut self, documents: &Documents) -> Arc<Sources> {
        let unit = &self.unit;
        Arc::clone(self.sources.get_or_insert_with(|| {
            let mut sources = unit.sources.clone();
            for (path, file) in unit.paths.iter().zip(0u16..) {
                if let Some(text) = documents.get(path) {
                    sources.replace(file, text);
                }
            }
            Arc::new(sources)
        }))
    }

    /// All that is known, where it has been found out.
    pub fn known(&self) -> Option<&Arc<Analysis>> {
        self.whole.as_ref()
    }

    /// The check that runs.
    pub fn check(&self) -> Option<CheckId> {
        self.check.as_ref().map(|it| it.0)
    }

    /// What finds out all that there is to know, for a thread of its own.
    pub fn begin_check(&mut self, documents: &Documents, id: CheckId) -> impl FnOnce() -> Arc<Analysis> + use<> {
        let (unit, sources, stop) = (Arc::clone(&self.unit), self.sources(documents), Stop::default());
        self.check = Some((id, stop.clone()));
        move || {
            let analysis = || Analysis::of(&unit, Arc::clone(&sources), Asked::All, &stop);
            // A mistake of the compiler's own must not end the server.
            let found = catch_unwind(AssertUnwindSafe(analysis));
            Arc::new(found.unwrap_or_else(|_| Analysis { index: Index::default(), sources, unit }))
        }
    }

    /// Takes what the check has found out that runs.
    pub fn checked(&mut self, analysis: Arc<Analysis>) {
        (self.whole, self.check) = (Some(analysis), None);
    }

    /// It was saved: other dialects may accept it now.
    pub fn saved(&mut self) {
        self.asks_dialects = true;
    }

    /// What asks other dialects about a program with errors, once, for a thread of its own.
    pub fn ask_dialects(&mut self) -> Option<impl FnOnce() -> Vec<Dialect> + use<>> {
        let whole = Arc::clone(self.whole.as_ref()?);
        if !std::mem::take(&mut self.asks_dialects) {
            return None;
        }
        self.dialects.clear();
        let accepting = self.unit.choice.as_ref()?.accepting;
        let sources = self.sources.clone()?;
        Some(move || accepting(&sources, &whole.unit.options, &whole.index.diagnostics))
    }

    /// All that there is to know, which is found out now where it is not known.
    pub fn whole(&mut self, documents: &Documents) -> Arc<Analysis> {
        if let Some(known) = &self.whole {
            return Arc::clone(known);
        }
        let sources = self.sources(documents);
        let analysis = Arc::new(Analysis::of(&self.unit, sources, Asked::All, &Stop::default()));
        self.whole = Some(Arc::clone(&analysis));
        analysis
    }

    /// What is known of the names around a place: no other body is checked for that.
    pub fn near(&mut self, documents: &Documents, place: Place) -> Arc<Analysis> {
        if let Some(whole) = &self.whole {
            return Arc::clone(whole);
        }
        if let Some((_, known)) = self.near.as_ref().filter(|it| it.0 == place) {
            return Arc::clone(known);
        }
        let sources = Arc::new(self.around(documents, place.file));
        let asked = Asked::Around(place.file, place.offset);
        let analysis = Arc::new(Analysis::of(&self.unit, sources, asked, &Stop::default()));
        self.near = Some((place, Arc::clone(&analysis)));
        analysis
    }

    /// What a name could be that begins at a place of one of the files, or `length` bytes after it, where the file's text is another
    /// one for that.
    pub fn offers(
        &mut self,
        documents: &Documents,
        file: u16,
        text: &str,
        (at, length): (u32, u32),
    ) -> Option<Analysis> {
        let mut sources = self.around(documents, file);
        sources.replace(file, text);
        let asked = Asked::Names(file, sources.get(file).in_text(at)?, length);
        Some(Analysis::of(&self.unit, Arc::new(sources), asked, &Stop::default()))
    }

    /// What is known of the names around a place, where the file has another text.
    pub fn around_in(&mut self, documents: &Documents, place: Place, text: &str) -> Analysis {
        let mut sources = self.around(documents, place.file);
        sources.replace(place.file, text);
        Analysis::of(&self.unit, Arc::new(sources), Asked::Around(place.file, place.offset), &Stop::default())
    }

    /// A file as it is, and what the others declare.
    fn around(&mut self, documents: &Documents, file: u16) -> Sources {
        let typed = self.sources(documents);
        let mut sources = (*typed).clone();
        for (head, number) in self.heads.iter_mut().zip(0u16..).filter(|it| it.1 != file) {
            sources.put(number, head.get_or_insert_with(|| without_bodies(&typed, number)).clone());
        }
        sources
    }

    /// The program with other texts in some of its files.
    pub fn changed(&mut self, documents: &Documents, texts: &[(u16, String)]) -> Analysis {
        let mut sources = (*self.sources(documents)).clone();
        texts.iter().for_each(|(file, text)| sources.replace(*file, text));
        Analysis::of(&self.unit, Arc::new(sources), Asked::All, &Stop::default())
    }
}

impl Drop for Project {
    fn drop(&mut self) {
        self.forget();
    }
}

/// The byte of a text that is at a position of its document. In a file of another system's not all of it is text.
pub fn place(sources: &Sources, file: u16, position: Position) -> Option<Place> {
    let source = sources.get(file);
    let at = place::offset(source.file(), position);
    // The end of a piece is a place in it, too.
    let before = || source.in_text(at.checked_sub(1)?).map(|it| it + 1);
    Some(Place { file, offset: source.in_text(at).or_else(before)? })
}

impl Analysis {
    fn of(unit: &Arc<Unit>, sources: Arc<Sources>, asked: Asked, stop: &Stop) -> Self {
        let (index, extended) = index(&sources, &unit.options, asked, stop);
        Self { index, sources: extended.map_or(sources, Arc::new), unit: Arc::clone(unit) }
    }

    /// What files declare, without what is written in their bodies.
    pub fn outline(unit: &Arc<Unit>, sources: Arc<Sources>, files: Range<u16>) -> Self {
        Self { index: outline(&sources, files), sources, unit: Arc::clone(unit) }
    }

    pub fn source(&self, file: u16) -> &Source {
        self.sources.get(file)
    }

    pub fn range(&self, span: Span) -> gen_lsp_types::Range {
        place::range(self.sources.get(span.file), span)
    }

    /// Where a part of a project's file is; nothing for the library.
    pub fn location(&self, span: Span) -> Option<Location> {
        let path = self.unit.paths.get(usize::from(span.file))?;
        Some(Location { uri: uri::of(path), range: self.range(span) })
    }

    pub fn path(&self, file: u16) -> Option<&Path> {
        self.unit.paths.get(usize::from(file)).map(PathBuf::as_path)
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
        self.unit.options.dialect
    }

    pub fn levels(&self) -> &Levels {
        &self.unit.levels
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
