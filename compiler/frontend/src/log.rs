//! The sources, and what is reported of them.

use crate::dialect::Dialect;
use crate::index::recorder::{Named, Offered, Recorder};
use crate::options::Options;
use crate::{Code, Diagnostic, Fix, Severity, Sources, Span};
use rustc_hash::FxHashSet;
use staunch_ir::Location;

pub(crate) struct Log<'s> {
    pub sources: &'s Sources,
    pub options: &'s Options,
    /// A dialect for each file.
    pub dialects: Vec<Dialect>,
    pub diagnostics: Vec<Diagnostic>,
    /// Whether an error has named the setting that lets integers narrow.
    pub has_named_narrowing: bool,
    /// The attributes that conditions ask for: `{IF hasattribute(…)}`.
    pub asked_attributes: Vec<&'s str>,
    /// The targets of assignments that are undone as the controller starts.
    pub nonretentive: FxHashSet<Span>,
    /// How addresses are written on a system that the program moves to.
    pub readdressed: Vec<Fix>,
    /// What names mean, where an editor asks for it.
    pub index: Option<Recorder>,
    line_cache: LineCache,
}

/// The last line that was looked up: the next position is usually on it or just after.
#[derive(Default)]
struct LineCache {
    file: u16,
    line: u32,
    start: u32,
    end: u32,
    /// The last position that was looked up on the line, and the characters before it.
    counted_to: u32,
    count: usize,
}

impl<'s> Log<'s> {
    pub fn new(sources: &'s Sources, options: &'s Options) -> Self {
        let line_cache = LineCache::default();
        Self {
            sources,
            options,
            dialects: Vec::new(),
            diagnostics: Vec::new(),
            has_named_narrowing: false,
            asked_attributes: Vec::new(),
            nonretentive: FxHashSet::default(),
            readdressed: Vec::new(),
            index: None,
            line_cache,
        }
    }

    pub fn report(&mut self, diagnostic: Diagnostic) {
        self.diagnostics.push(diagnostic);
    }

    pub fn error(&mut self, code: Code, span: Span, message: impl Into<String>) {
        self.report(Diagnostic::new(code, span, message));
    }

    pub fn not_supported(&mut self, span: Span, what: &str) {
        self.report(Diagnostic::unsupported(span, what));
    }

    /// Notes what a name means, where that is asked for.
    pub fn note(&self, name: Span, target: impl FnOnce() -> Named) {
        if let Some(index) = &self.index {
            index.note(name, target());
        }
    }

    /// Notes the declaration that a name means.
    pub fn note_declared(&self, name: Span, declared: Span) {
        self.note(name, || Named::Definition(declared));
    }

    /// Whether an editor asks what a name could be that is here.
    pub fn is_asked(&self, name: Span) -> bool {
        self.index.as_ref().is_some_and(|it| it.is_asked(name))
    }

    /// A name that could be where an editor asks.
    pub fn offer(&self, name: impl Into<String>, means: Named) {
        if let Some(index) = &self.index {
            index.offer(Offered { name: name.into(), means, is_expected: false });
        }
    }

    /// The same for one of what its place asks for.
    pub fn offer_expected(&self, name: impl Into<String>, means: Named) {
        if let Some(index) = &self.index {
            index.offer(Offered { name: name.into(), means, is_expected: true });
        }
    }

    pub fn has_errors(&self) -> bool {
        self.has_errors_since(0)
    }

    /// Whether errors were reported since there were `reported` diagnostics.
    pub fn has_errors_since(&self, reported: usize) -> bool {
        self.diagnostics[reported..].iter().any(|it| it.severity == Severity::Error)
    }

    pub fn dialect(&self, span: Span) -> Dialect {
        self.dialects.get(usize::from(span.file)).copied().unwrap_or(self.options.dialect)
    }

    /// Whether the dialect of a place has a form, or the one from which the program moves: it keeps the form.
    pub fn has_form(&self, span: Span, has: fn(Dialect) -> bool) -> bool {
        has(self.dialect(span)) || self.options.moved_from.is_some_and(has)
    }

    /// How a program comes by what another dialect has, the owner.
    pub fn how_to_have(&self, owner: Dialect) -> String {
        match self.options.moved_from {
            None => owner.how_to_choose(),
            Some(_) => "leave it out for this comparison, or declare one with this name in the program: both systems then have it".to_owned(),
        }
    }

    /// Where `span` starts, for people.
    pub fn location(&mut self, span: Span) -> Location {
        let source = self.sources.get(span.file);
        if source.is_assembled() {
            return self.sources.location(span);
        }
        let cache = &self.line_cache;
        let cached = cache.file == span.file && (cache.start..cache.end).contains(&span.start);
        if !cached {
            let line = source.line(span.start);
            let (start, end) = source.line_bounds(line);
            self.line_cache = LineCache { file: span.file, line, start, end, counted_to: start, count: 0 };
        }
        let cache = &mut self.line_cache;
        if source.is_ascii() {
            let column = u16::try_from(span.start - cache.start + 1).unwrap_or(u16::MAX);
            return Location { file: span.file, line: cache.line, column };
        }
        // A line may be long: what was counted is not counted again.
        if span.start < cache.counted_to {
            (cache.counted_to, cache.count) = (cache.start, 0);
        }
        let between = Span { file: span.file, start: cache.counted_to, end: span.start };
        cache.count += self.sources.text(between).chars().count();
        cache.counted_to = span.start;
        let (line, column) = (cache.line, u16::try_from(cache.count + 1).unwrap_or(u16::MAX));
        Location { file: span.file, line, column }
    }

    /// The name that is at a location.
    pub fn name_at(&self, at: Location) -> Span {
        let source = self.sources.get(at.file);
        let file = source.file();
        let range = file.line_range(at.line);
        let (start, line) = (range.start, &file.text[range]);
        let before = usize::from(at.column).saturating_sub(1);
        let before: usize = line.chars().take(before).map(char::len_utf8).sum();
        let name = line[before..].chars().take_while(|it| it.is_ascii_alphanumeric() || *it == '_').count();
        let offset = |length: usize| u32::try_from(length).unwrap_or(u32::MAX);
        let start = source.in_text(offset(start + before)).unwrap_or(0);
        Span { file: at.file, start, end: start + offset(name) }
    }
}
