//! Diagnostics as text: for people, one line each, or one JSON object each.

use core::{fmt::Write, ops::Range};
use std::borrow::Cow;

use annotate_snippets::{Annotation, AnnotationKind, Group, Level, Origin, Patch, Renderer, Snippet};

use super::{Diagnostic, Severity};
use crate::source::{Source, Sources, Span};
use staunch_runtime::json::Quoted;

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Format {
    #[default]
    Human,
    /// `path:line:col: error[E0203]: text`
    Short,
    /// One object a line.
    Json,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Style {
    pub color: bool,
}

/// The diagnostic as `format` writes it, with a line break at the end.
pub fn render(diagnostic: &Diagnostic, sources: &Sources, format: Format, style: Style) -> String {
    let diagnostic = &in_files(diagnostic, sources);
    let mut text = match format {
        Format::Human => human(diagnostic, sources, style),
        Format::Short => short(diagnostic, sources),
        Format::Json => json(diagnostic, sources),
    };
    text.push('\n');
    text
}

/// A place of a file as diagnostics show it, below a sentence that is neither an error nor a warning. The span is one of the
/// [file](Sources::file), and the text ends with a line break.
pub fn excerpt(message: &str, span: Span, sources: &Sources, style: Style) -> String {
    let mark = Mark { span, line: sources.file(span.file).line_column(span.start).0, primary: true, label: None };
    let excerpt = Excerpt::new(sources, mark);
    let cut = excerpt.cut;
    let group = excerpt.add_to(Group::with_title(Level::NOTE.with_name("stopped").primary_title(message)));
    let renderer = if style.color { Renderer::styled() } else { Renderer::plain() };
    let text = renderer.render(&[group]);
    let text = if cut { without_bare_marks(&text) } else { text };
    text + "\n"
}

/// The diagnostic with its places in the files, where texts are made of pieces of them.
fn in_files<'d>(diagnostic: &'d Diagnostic, sources: &Sources) -> Cow<'d, Diagnostic> {
    let is_assembled = |span: Span| sources.get(span.file).is_assembled();
    if !is_assembled(diagnostic.span) && !diagnostic.others.iter().any(|it| is_assembled(it.span)) {
        return Cow::Borrowed(diagnostic);
    }
    let mut placed = diagnostic.clone();
    let place = |span: &mut Span| *span = sources.get(span.file).in_file(*span);
    placed.fix = placed.fix.filter(|it| sources.get(it.span.file).is_verbatim(it.span));
    place(&mut placed.span);
    placed.others.iter_mut().for_each(|it| place(&mut it.span));
    if let Some(fix) = &mut placed.fix {
        place(&mut fix.span);
    }
    Cow::Owned(placed)
}

const fn severity_name(severity: Severity) -> &'static str {
    match severity {
        Severity::Error => "error",
        Severity::Warning => "warning",
    }
}

fn short(diagnostic: &Diagnostic, sources: &Sources) -> String {
    let source = sources.file(diagnostic.span.file);
    let (line, column) = source.line_column(diagnostic.span.start);
    let severity = severity_name(diagnostic.severity);
    let code = diagnostic.code.name();
    format!("{}:{line}:{column}: {severity}[{code}]: {}", source.path, diagnostic.message)
}

/// Lines that a snippet may show between two marks; with more lines between them, each mark has its own snippet.
const NEAR: u32 = 8;
/// Bytes of a line that are shown as they are; of a longer one, what is around the mark.
const WIDE: usize = 400;

fn human(diagnostic: &Diagnostic, sources: &Sources, style: Style) -> String {
    let level = match diagnostic.severity {
        Severity::Error => Level::ERROR,
        Severity::Warning => Level::WARNING,
    };
    let title = level.primary_title(diagnostic.message.as_str()).id(diagnostic.code.name());
    let mut group = Group::with_title(title);
    let excerpts = snippets(diagnostic, sources);
    let cut = excerpts.iter().any(|it| it.cut);
    for excerpt in excerpts {
        group = excerpt.add_to(group);
    }
    for note in &diagnostic.notes {
        group = group.element(Level::NOTE.message(note.as_str()));
    }
    let patch = patch(diagnostic, sources);
    if let (Some(help), None) = (&diagnostic.help, &patch) {
        group = group.element(Level::HELP.message(help.as_str()));
    }
    let mut report = vec![group];
    report.extend(patch);
    let renderer = if style.color { Renderer::styled() } else { Renderer::plain() };
    let text = renderer.render(&report);
    if cut { without_bare_marks(&text) } else { text }
}

/// The renderer announces a snippet without a path by a line that holds `:::` alone.
fn without_bare_marks(text: &str) -> String {
    let bare = |line: &str| {
        // Colours are `ESC [ … m`; nothing else may be next to the mark.
        let visible = line
            .split('\u{1b}')
            .map(|it| it.strip_prefix('[').and_then(|it| it.split_once('m')).map_or(it, |(_, rest)| rest));
        visible.collect::<String>().trim() == ":::"
    };
    text.lines().filter(|line| !bare(line)).collect::<Vec<_>>().join("\n")
}

/// The help and the line as it looks with the replacement made.
fn patch<'a>(diagnostic: &'a Diagnostic, sources: &'a Sources) -> Option<Group<'a>> {
    let (help, fix) = (diagnostic.help.as_ref()?, diagnostic.fix.as_ref()?);
    let source = sources.file(fix.span.file);
    let (line, _) = source.line_column(fix.span.start);
    let shown = source.line_range(line);
    let range = bytes(source, fix.span);
    if shown.len() > WIDE || range.start < shown.start || range.end > shown.end {
        return None;
    }
    let text = source.text.get(shown.clone())?;
    let patch = Patch::new(range.start - shown.start..range.end - shown.start, fix.replacement.as_str());
    let snippet = Snippet::source(text).line_start(wide(line)).path(source.path.as_str());
    Some(Level::HELP.secondary_title(help.as_str()).element(snippet.patch(patch)))
}

struct Mark<'a> {
    span: Span,
    line: u32,
    primary: bool,
    label: Option<&'a str>,
}

/// Some lines of one file and the marks on them.
struct Excerpt<'a> {
    source: &'a Source,
    line: u32,
    shown: Range<usize>,
    cut: bool,
    marks: Vec<Mark<'a>>,
}

fn snippets<'a>(diagnostic: &'a Diagnostic, sources: &'a Sources) -> Vec<Excerpt<'a>> {
    let mark = |span: Span, primary, label| {
        let (line, _) = sources.file(span.file).line_column(span.start);
        Mark { span, line, primary, label }
    };
    let mut excerpts = vec![Excerpt::new(sources, mark(diagnostic.span, true, diagnostic.label.as_deref()))];
    for other in &diagnostic.others {
        let mark = mark(other.span, false, Some(other.text.as_str()));
        match excerpts.iter_mut().find(|it| it.is_near(&mark)) {
            Some(excerpt) => excerpt.add(mark),
            None => excerpts.push(Excerpt::new(sources, mark)),
        }
    }
    excerpts
}

impl<'a> Excerpt<'a> {
    fn new(sources: &'a Sources, mark: Mark<'a>) -> Self {
        let source = sources.file(mark.span.file);
        let line = source.line_range(mark.line);
        let cut = line.len() > WIDE;
        let shown = if cut { window(source, &line, mark.span) } else { line };
        Self { source, line: mark.line, shown, cut, marks: vec![mark] }
    }

    fn is_near(&self, mark: &Mark<'_>) -> bool {
        let first = &self.marks[0];
        !self.cut
            && first.span.file == mark.span.file
            && first.line.abs_diff(mark.line) <= NEAR
            && self.source.line_range(mark.line).len() <= WIDE
    }

    fn add(&mut self, mark: Mark<'a>) {
        let line = self.source.line_range(mark.line);
        self.line = self.line.min(mark.line);
        self.shown = self.shown.start.min(line.start)..self.shown.end.max(line.end);
        self.marks.push(mark);
    }

    fn add_to(self, group: Group<'a>) -> Group<'a> {
        let text = self.source.text.get(self.shown.clone()).unwrap_or_default();
        let mut snippet = Snippet::source(text).line_start(wide(self.line));
        snippet = snippet.annotations(self.marks.iter().map(|it| self.annotation(it)));
        if !self.cut {
            return group.element(snippet.path(self.source.path.as_str()));
        }
        // Only a part of the line is shown, so the column is counted here.
        let (line, column) = self.source.line_column(self.marks[0].span.start);
        let origin = Origin::path(self.source.path.as_str()).line(wide(line)).char_column(wide(column));
        group.element(origin).element(snippet)
    }

    /// A mark never leaves what is shown: of several lines it marks the first.
    fn annotation(&self, mark: &Mark<'a>) -> Annotation<'a> {
        let end_of_line = self.source.line_range(mark.line).end.min(self.shown.end);
        let range = bytes(self.source, mark.span);
        let start = range.start.clamp(self.shown.start, self.shown.end);
        let end = range.end.min(end_of_line).max(start);
        let kind = if mark.primary { AnnotationKind::Primary } else { AnnotationKind::Context };
        kind.span(start - self.shown.start..end - self.shown.start).label(mark.label)
    }
}

/// The part of a long line around a span.
fn window(source: &Source, line: &Range<usize>, span: Span) -> Range<usize> {
    let at = bytes(source, span).start.clamp(line.start, line.end);
    let start = at.saturating_sub(60).max(line.start);
    let end = (at + 100).min(line.end);
    let boundary = |mut at: usize| {
        while !source.text.is_char_boundary(at) {
            at -= 1;
        }
        at
    };
    boundary(start)..boundary(end)
}

/// A span as a range of whole characters of the text.
fn bytes(source: &Source, span: Span) -> Range<usize> {
    let boundary = |at: u32| {
        let mut at = wide(at).min(source.text.len());
        while !source.text.is_char_boundary(at) {
            at -= 1;
        }
        at
    };
    let start = boundary(span.start);
    start..boundary(span.end).max(start)
}

fn wide(value: u32) -> usize {
    usize::try_from(value).unwrap_or(usize::MAX)
}

fn json(diagnostic: &Diagnostic, sources: &Sources) -> String {
    let mut out = String::from("{\"reason\":\"diagnostic\"");
    field(&mut out, "code", diagnostic.code.name());
    field(&mut out, "severity", severity_name(diagnostic.severity));
    field(&mut out, "message", diagnostic.message.as_str());
    out.push_str(",\"spans\":[");
    json_span(&mut out, sources, diagnostic.span, true, diagnostic.label.as_deref());
    for other in &diagnostic.others {
        out.push(',');
        json_span(&mut out, sources, other.span, false, Some(&other.text));
    }
    out.push_str("],\"notes\":[");
    for (number, note) in diagnostic.notes.iter().enumerate() {
        out.push_str(if number == 0 { "" } else { "," });
        let _ = write!(out, "{}", Quoted(note));
    }
    out.push(']');
    optional(&mut out, "help", diagnostic.help.as_deref());
    out.push_str(",\"fix\":");
    match &diagnostic.fix {
        Some(fix) => {
            json_place(&mut out, sources.file(fix.span.file), fix.span);
            field(&mut out, "replacement", &fix.replacement);
            out.push('}');
        }
        None => out.push_str("null"),
    }
    field(&mut out, "rendered", &(human(diagnostic, sources, Style::default()) + "\n"));
    out.push('}');
    out
}

/// Bytes of the file, for an editor that applies a fix to it.
fn json_place(out: &mut String, source: &Source, span: Span) {
    out.push_str("{\"file\":");
    let _ = write!(out, "{}", Quoted(&source.path));
    number(out, "byte_start", source.file_offset(span.start));
    number(out, "byte_end", source.file_offset(span.end));
}

fn json_span(out: &mut String, sources: &Sources, span: Span, primary: bool, label: Option<&str>) {
    let source = sources.file(span.file);
    json_place(out, source, span);
    let (line, column) = source.line_column(span.start);
    number(out, "line_start", line);
    number(out, "column_start", column);
    let (line, column) = source.line_column(span.end);
    number(out, "line_end", line);
    number(out, "column_end", column);
    out.push_str(if primary { ",\"is_primary\":true" } else { ",\"is_primary\":false" });
    optional(out, "label", label);
    out.push('}');
}

fn number(out: &mut String, key: &str, value: u32) {
    // Writing to a String cannot fail.
    let _ = write!(out, ",\"{key}\":{value}");
}

fn field(out: &mut String, key: &str, value: &str) {
    let _ = write!(out, ",\"{key}\":");
    let _ = write!(out, "{}", Quoted(value));
}

fn optional(out: &mut String, key: &str, value: Option<&str>) {
    match value {
        Some(value) => field(out, key, value),
        None => {
            let _ = write!(out, ",\"{key}\":null");
        }
    }
}

#[cfg(test)]
mod tests;
