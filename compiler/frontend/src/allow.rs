//! Lints that a source allows itself: `{allow W0507}` before a statement or declaration, for all of it,
//! and `{allow_file W0507}` anywhere, for the file.

use crate::ast::{File, Item, Pou, Statement, TestUnit, TypeKind, TypeSpec, VarBlock, VarDecl, each_body};
use crate::diagnostic::{Code, Diagnostic, Severity, lint};
use crate::source::Span;

/// What a pragma allows, and where.
#[derive(Debug)]
struct Allowance {
    /// `None`: every lint.
    code: Option<Code>,
    file: u16,
    /// Bytes of the file; all of it without a range.
    range: Option<(u32, u32)>,
}

impl Allowance {
    fn covers(&self, diagnostic: &Diagnostic) -> bool {
        let span = diagnostic.span;
        self.code.is_none_or(|it| it == diagnostic.code)
            && self.file == span.file
            && self.range.is_none_or(|(start, end)| start <= span.start && span.start < end)
    }
}

/// All that the files allow.
#[derive(Debug, Default)]
pub(crate) struct Allowances {
    all: Vec<Allowance>,
}

impl Allowances {
    /// Reads the pragmas, and reports those that name no lint or precede nothing.
    pub fn read(files: &[File<'_>], diagnostics: &mut Vec<Diagnostic>) -> Self {
        let mut allowances = Self::default();
        files.iter().for_each(|it| allowances.add(it, diagnostics));
        allowances
    }

    fn add(&mut self, file: &File<'_>, diagnostics: &mut Vec<Diagnostic>) {
        let mut spans = None;
        for pragma in &file.pragmas {
            let Some((is_file, names)) = parts(pragma.text) else { continue };
            let range = match is_file {
                true => None,
                false => match next(spans.get_or_insert_with(|| Spans::of(file)), pragma.span.end) {
                    Some(range) => Some(range),
                    None => {
                        diagnostics.push(no_effect(pragma.span, "no statement or declaration follows `allow`".into()));
                        continue;
                    }
                },
            };
            if names.is_empty() {
                let help = "name a lint after it: `{allow W0501}`";
                diagnostics.push(no_effect(pragma.span, "`allow` does not name a lint".into()).help(help));
            }
            for name in names {
                match lint(name) {
                    Ok(code) => self.all.push(Allowance { code, file: pragma.span.file, range }),
                    Err(message) => diagnostics.push(no_effect(pragma.span, message)),
                }
            }
        }
    }

    /// Whether the diagnostic is a lint that is allowed where it is.
    pub fn cover(&self, diagnostic: &Diagnostic) -> bool {
        diagnostic.severity == Severity::Warning && self.all.iter().any(|it| it.covers(diagnostic))
    }
}

/// Whether the pragma is this module's.
pub(crate) fn is_allowance(pragma: &str) -> bool {
    parts(pragma).is_some()
}

/// Whether it is for the file, and the lints that it names.
fn parts(pragma: &str) -> Option<(bool, Vec<&str>)> {
    let mut words = pragma.split([' ', '\t', '\r', '\n', ',']).filter(|it| !it.is_empty());
    let is_file = match words.next()?.to_ascii_lowercase().as_str() {
        "allow" => false,
        "allow_file" => true,
        _ => return None,
    };
    Some((is_file, words.collect()))
}

fn no_effect(span: Span, message: String) -> Diagnostic {
    Diagnostic::new(Code::W0102, span, message).label("it has no effect")
}

/// The largest of the statements and declarations that begin first at or after `start`.
fn next(spans: &Spans, start: u32) -> Option<(u32, u32)> {
    let after = || spans.all.iter().filter(|it| it.0 >= start);
    let first = after().map(|it| it.0).min()?;
    after().filter(|it| it.0 == first).max().copied()
}

/// Where each statement and declaration of a file begins and ends.
#[derive(Debug, Default)]
struct Spans {
    all: Vec<(u32, u32)>,
}

impl Spans {
    fn of(file: &File<'_>) -> Self {
        let mut spans = Self::default();
        for item in &file.items {
            match item {
                Item::Pou(pou) | Item::Test(TestUnit { pou, .. }) => spans.pou(pou),
                Item::Types(types) => {
                    for it in types {
                        spans.add(it.name.span.to(it.ty.span));
                        spans.members(&it.ty);
                    }
                }
                Item::Globals(block) => spans.block(block),
                Item::Configuration(it) => {
                    it.globals.iter().for_each(|it| spans.block(it));
                    it.resources.iter().flat_map(|it| &it.globals).for_each(|it| spans.block(it));
                }
            }
        }
        spans
    }

    fn pou(&mut self, pou: &Pou<'_>) {
        let before = self.all.len();
        pou.blocks.iter().for_each(|it| self.block(it));
        self.statements(&pou.body);
        pou.routines.iter().for_each(|it| self.pou(it));
        // Its own span is its head.
        let end = self.all[before..].iter().map(|it| it.1).max();
        self.all.push((pou.span.start, end.unwrap_or_default().max(pou.span.end)));
    }

    fn add(&mut self, span: Span) {
        self.all.push((span.start, span.end));
    }

    fn block(&mut self, block: &VarBlock<'_>) {
        self.add(block.vars.last().map_or(block.span, |last| block.span.to(last.span)));
        block.vars.iter().for_each(|it| self.variable(it));
    }

    fn variable(&mut self, variable: &VarDecl<'_>) {
        self.add(variable.span);
        self.members(&variable.ty);
    }

    fn members(&mut self, ty: &TypeSpec<'_>) {
        if let TypeKind::Struct(members) | TypeKind::Union(members) = &ty.kind {
            members.iter().for_each(|it| self.variable(it));
        }
    }

    fn statements(&mut self, statements: &[Statement<'_>]) {
        for statement in statements {
            self.add(statement.span);
            each_body(statement, &mut |it| self.statements(it));
        }
    }
}
