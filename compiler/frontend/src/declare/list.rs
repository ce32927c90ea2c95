//! Lists of global variables: whose name is before a variable's, `GVL.x`. A file that holds nothing but
//! VAR_GLOBAL is one, by the name of the file; a pragma `{gvl 'Name'}` names the blocks that follow it.

use crate::dialect::Dialect;
use crate::spelling::Key;
use crate::types::declarations::Declarations;
use crate::{Code, Diagnostic, Fix, Span, added, ast, start};

/// The names of a file's lists.
pub(super) struct Lists<'s> {
    file: Option<&'s str>,
    /// Where each is named, in order.
    named: Vec<(u32, &'s str)>,
    /// Where the declaration before each of these names ends, as far as the tree says.
    heads: Vec<u32>,
    /// Where an attribute says that a list's names are used after the list's alone.
    qualified: Vec<u32>,
    /// Where the last unit that is not a list ends.
    end: u32,
}

impl<'s> Lists<'s> {
    pub fn of(declarations: &mut Declarations<'s>, file: &'s ast::File<'s>) -> Self {
        let mut lists = Self { file: None, named: Vec::new(), heads: Vec::new(), qualified: Vec::new(), end: 0 };
        let attributes = file.pragmas.iter().filter(|it| is_qualified_only(it.text));
        lists.qualified.extend(attributes.map(|it| it.span.start));
        for pragma in file.pragmas.iter().filter(|it| is_list_pragma(it.text)) {
            if !declarations.log.has_form(pragma.span, Dialect::names_lists) {
                declarations.names.nameless_lists.extend(quoted(pragma.text).map(Key));
                declarations.report(
                    Diagnostic::new(Code::W0102, pragma.span, "a list of global variables has a name only in codesys")
                        .label("it has no effect")
                        .help("start the file with `{dialect 'codesys'}`"),
                );
            } else if let Some(name) = quoted(pragma.text) {
                declarations.loses_name(name, pragma.span);
                declarations.leaves_out_pragma(pragma.span);
                let before = file.items.partition_point(|it| place(it).start < pragma.span.start);
                lists.heads.push(before.checked_sub(1).map_or(0, |at| place(&file.items[at]).end));
                lists.named.push((pragma.span.start, name));
            } else {
                declarations.report(
                    Diagnostic::new(Code::W0102, pragma.span, "this pragma names a list of global variables")
                        .label("it has no effect")
                        .help("write the list's name in quotes: `{gvl 'Name'}`"),
                );
            }
        }
        let globals = |it: &ast::Item<'s>| match it {
            ast::Item::Globals(block) => Some(block.span),
            ast::Item::Pou(_) | ast::Item::Types(_) | ast::Item::Configuration(_) | ast::Item::Test(_) => None,
        };
        let spans: Option<Vec<_>> = file.items.iter().filter(|it| !is_added(it)).map(globals).collect();
        if let Some([first, ..]) = spans.as_deref()
            && file.regions.len() <= 1
        {
            let path = declarations.log.sources.get(first.file).path.as_str();
            let name = stem(path).filter(|it| is_name(it));
            match declarations.log.has_form(*first, Dialect::names_lists) {
                true => lists.file = name,
                false => declarations.names.nameless_lists.extend(name.map(Key)),
            }
        }
        lists
    }

    /// A pragma before this unit names no block after it.
    pub fn end(&mut self, unit: Span) {
        self.end = unit.start;
    }

    /// Whether the list that a block is in is named before each of its variables: an attribute before the list's
    /// name or its first block says so of the whole list.
    pub fn is_qualified(&self, block: Span) -> bool {
        let named = self.named.partition_point(|it| it.0 < block.start);
        let start = named.checked_sub(1).map_or(0, |it| self.heads[it]).max(self.end);
        self.qualified.iter().any(|it| (start..block.start).contains(it))
    }

    /// The list that a block of variables is in.
    pub fn around(&self, block: Span) -> Option<&'s str> {
        let before = self.named.iter().rev().find(|(start, _)| *start < block.start);
        before.filter(|(start, _)| *start >= self.end).map(|(_, name)| *name).or(self.file)
    }
}

impl Declarations<'_> {
    /// Says that the system to which the program moves has no names of lists.
    fn loses_name(&mut self, name: &str, span: Span) {
        let dialect = self.dialect(span);
        if !dialect.names_lists() {
            let system = dialect.name().to_ascii_uppercase();
            let message = format!("the list `{name}` has no name in {system}");
            self.report(
                Diagnostic::new(Code::W0618, span, message)
                    .label("the move removes the name")
                    .help(format!("write its variables without `{name}.`; each needs a name that nothing else has")),
            );
        }
    }

    /// The pragma of a list, with its braces, is not in the program that moves.
    fn leaves_out_pragma(&mut self, pragma: Span) {
        if !self.dialect(pragma).names_lists() {
            let span = Span { start: pragma.start - 1, end: pragma.end + 1, ..pragma };
            self.log.readdressed.push(Fix { span, replacement: String::new() });
        }
    }
}

/// Whether the source has nothing of it: it starts what is global.
fn is_added(item: &ast::Item<'_>) -> bool {
    match item {
        ast::Item::Globals(block) => block.vars.iter().flat_map(|it| &it.names).all(|it| added::is_added(it.text)),
        ast::Item::Pou(pou) => pou.name.text == start::GLOBALS,
        ast::Item::Types(_) | ast::Item::Configuration(_) | ast::Item::Test(_) => false,
    }
}

/// Where the text of a declaration begins and ends; END_… may follow it.
fn place(item: &ast::Item<'_>) -> Span {
    let between = |first: Span, last: Option<Span>| last.map_or(first, |it| first.to(it));
    match item {
        ast::Item::Pou(pou) => pou.span,
        ast::Item::Globals(block) => between(block.span, block.vars.last().map(|it| it.span)),
        ast::Item::Types(decls) => {
            let last = decls.last().map(|it| it.name.span);
            decls.first().map_or(Span::default(), |it| between(it.name.span, last))
        }
        ast::Item::Configuration(it) => it.name.span,
        ast::Item::Test(it) => it.pou.span,
    }
}

/// `attribute 'qualified_only'`
fn is_qualified_only(text: &str) -> bool {
    let mut words = text.split_whitespace();
    let is_attribute = words.next().is_some_and(|it| it.eq_ignore_ascii_case("attribute"));
    is_attribute && words.next().is_some_and(|it| it.eq_ignore_ascii_case("'qualified_only'"))
}

pub(super) fn is_list_pragma(text: &str) -> bool {
    let word = text.trim().split(|it: char| !it.is_ascii_alphanumeric() && it != '_').next();
    word.is_some_and(|it| it.eq_ignore_ascii_case("gvl"))
}

fn quoted(text: &str) -> Option<&str> {
    let rest = text.trim().get("gvl".len()..)?.trim_start().trim_start_matches(":=").trim();
    rest.strip_prefix('\'')?.strip_suffix('\'').filter(|it| is_name(it))
}

/// The name of a file without its folder and ending.
fn stem(path: &str) -> Option<&str> {
    let file = path.rsplit(['/', '\\']).next()?;
    file.rsplit_once('.').map(|(stem, _)| stem)
}

fn is_name(text: &str) -> bool {
    let starts = text.starts_with(|it: char| it.is_ascii_alphabetic() || it == '_');
    starts && text.chars().all(|it| it.is_ascii_alphanumeric() || it == '_')
}
