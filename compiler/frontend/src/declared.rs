//! What the trees of a program declare, as far as `{IF …}` asks for it.

use crate::ast::{File, Item, Pou, PouKind, TypeDecl, VarBlock};
use crate::diagnostic::{Code, Diagnostic};
use crate::lex::{Declaration, Declared, Scope};
use crate::parse::attribute;
use crate::source::{Sources, Span};
use rustc_hash::FxHashMap;

/// What all files declare.
pub(crate) fn of<'s>(files: &[File<'s>], sources: &'s Sources) -> Declared<'s> {
    let mut declared = Declared::default();
    for (file, number) in files.iter().zip(0u16..) {
        read(file, number, sources, &mut declared);
    }
    declared
}

fn read<'s>(file: &File<'s>, number: u16, sources: &'s Sources, declared: &mut Declared<'s>) {
    let text = sources.get(number).text.as_str();
    let reading = Reading { text, attributes: attributes(file, text) };
    for item in &file.items {
        reading.item(item, declared);
    }
}

/// Where conditions that ask for declarations have decided some of the file, as it was read before they were decided
/// and after it. `read_one` reads it with one of them decided.
pub(crate) fn changed<'s>(
    [before, after]: [&File<'s>; 2],
    sources: &'s Sources,
    number: u16,
    read_one: impl Fn(Span) -> File<'s>,
) -> Vec<Diagnostic> {
    let of = |file: &File<'s>| {
        let mut declared = Declared::default();
        read(file, number, sources, &mut declared);
        declared
    };
    let before_all = of(before);
    if is_same(&before_all, &of(after)) {
        return Vec::new();
    }
    let mut deciding: Vec<Span> = before.undecided.clone();
    deciding.retain(|it| !is_same(&before_all, &of(&read_one(*it))));
    if deciding.is_empty() {
        // It takes several.
        deciding.clone_from(&before.undecided);
    }
    let refused = deciding.into_iter().map(|span| {
        Diagnostic::new(Code::E0902, span, "a condition on declarations cannot contain declarations")
            .label("all declarations must be known before it is evaluated")
            .help("where the condition holds, define a name with `{define NAME}` or in the project, and test that")
    });
    refused.collect()
}

fn is_same(a: &Declared<'_>, b: &Declared<'_>) -> bool {
    a.types == b.types && a.pous == b.pous && a.tasks == b.tasks && a.globals == b.globals && a.scopes == b.scopes
}

/// What conditions ask for by `hasattribute(pou: P, 'a')`.
pub(crate) fn asked_attributes<'s>(files: &[File<'s>], sources: &'s Sources) -> Vec<&'s str> {
    let conditions = files.iter().flat_map(|it| &it.undecided).map(|it| sources.text(*it));
    let asked = conditions.flat_map(|it| it.match_indices('\'').map(move |(at, _)| &it[at + 1..]));
    asked.filter_map(|it| it.split_once('\'')).map(|it| it.0).collect()
}

/// The attributes before each token that has some, by its first byte.
fn attributes<'s>(file: &File<'s>, text: &str) -> FxHashMap<u32, Vec<&'s str>> {
    let mut found: FxHashMap<u32, Vec<&'s str>> = FxHashMap::default();
    for pragma in &file.pragmas {
        let next = next_token(text, pragma.span.end);
        if let (Some(name), Some(next)) = (attribute(pragma.text), next) {
            found.entry(next).or_default().push(name);
        }
    }
    found
}

/// The first byte after a pragma that is of no space, comment or other pragma.
fn next_token(text: &str, end_of_pragma: u32) -> Option<u32> {
    let mut rest = text.get(usize::try_from(end_of_pragma).ok()?..)?.trim_start_matches('}').trim_start();
    loop {
        let end = match () {
            () if rest.starts_with('{') => "}",
            () if rest.starts_with("//") => "\n",
            () if rest.starts_with("(*") => "*)",
            () if rest.starts_with("/*") => "*/",
            () => return u32::try_from(text.len() - rest.len()).ok(),
        };
        rest = rest.split_once(end)?.1.trim_start();
    }
}

/// One file's items.
struct Reading<'s> {
    text: &'s str,
    attributes: FxHashMap<u32, Vec<&'s str>>,
}

impl<'s> Reading<'s> {
    fn item(&self, item: &Item<'s>, declared: &mut Declared<'s>) {
        match item {
            Item::Pou(pou) => self.pou(pou, declared),
            Item::Types(types) => declared.types.extend(types.iter().map(|it| self.named(it))),
            Item::Globals(block) => self.variables(block, &mut declared.globals),
            Item::Configuration(it) => {
                it.globals.iter().for_each(|block| self.variables(block, &mut declared.globals));
                for resource in &it.resources {
                    resource.globals.iter().for_each(|block| self.variables(block, &mut declared.globals));
                    declared.tasks.extend(resource.tasks.iter().map(|it| it.name.text));
                }
            }
            Item::Test(_) => {}
        }
    }

    fn pou(&self, pou: &Pou<'s>, declared: &mut Declared<'s>) {
        let base = pou.extends.or_else(|| pou.bases.first().and_then(|it| it.last().copied()));
        let is_class = matches!(pou.kind, PouKind::FunctionBlock | PouKind::Class);
        declared.pous.push(routine(pou, pou.name.text.to_owned()));
        self.scope(pou, base.filter(|_| is_class).map(|it| it.text), declared);
        for it in &pou.routines {
            declared.pous.push(routine(it, format!("{}.{}", pou.name.text, it.name.text)));
            // What a METHOD does not have itself is its class's.
            self.scope(it, Some(pou.name.text), declared);
        }
    }

    fn scope(&self, pou: &Pou<'s>, base: Option<&'s str>, declared: &mut Declared<'s>) {
        let mut variables = Vec::new();
        pou.blocks.iter().for_each(|block| self.variables(block, &mut variables));
        declared.scopes.push(Scope { span: pou.extent, name: pou.name.text, base, variables });
    }

    fn named(&self, it: &TypeDecl<'s>) -> Declaration<'s> {
        let ty = self.first_word(it.ty.span);
        Declaration { name: it.name.text.to_owned(), attributes: it.attributes.clone(), ty, value: None }
    }

    fn variables(&self, block: &VarBlock<'s>, all: &mut Vec<Declaration<'s>>) {
        for variable in &block.vars {
            let ty = self.first_word(variable.ty.span);
            let value = variable.initial.as_ref().filter(|_| block.has_values());
            let value = value.and_then(|it| self.text(it.span));
            let before = variable.names.first().and_then(|it| self.attributes.get(&it.span.start));
            let attributes = before.cloned().unwrap_or_default();
            let named = |name: &str| Declaration { name: name.to_owned(), attributes: attributes.clone(), ty, value };
            all.extend(variable.names.iter().map(|it| named(it.text)));
        }
    }

    fn first_word(&self, span: Span) -> &'s str {
        let text = self.text(span).unwrap_or_default();
        let end = text.find(|it: char| !it.is_alphanumeric() && it != '_').unwrap_or(text.len());
        &text[..end]
    }

    fn text(&self, span: Span) -> Option<&'s str> {
        let place = |it| usize::try_from(it).ok();
        self.text.get(place(span.start)?..place(span.end)?)
    }
}

fn routine<'s>(pou: &Pou<'s>, name: String) -> Declaration<'s> {
    Declaration { name, attributes: pou.attributes.clone(), ty: "", value: None }
}
