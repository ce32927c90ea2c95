//! Files and names that fix their own system: they mean the same wherever the program moves, so a
//! comparison would be one with itself.

use staunch_frontend::ast::{File, Item, Name, TypeKind, TypeSpec, VarBlock};
use staunch_frontend::{Dialect, Sources, parse_file};
use staunch_runtime::Family;
use std::fmt::Write;

/// Fails where a file says that it is of another dialect, or, unless the other system's program is a
/// text of its own, where a type is qualified by its system.
pub fn check(sources: &Sources, dialect: Dialect, option: &str, qualified: bool) -> Result<(), String> {
    let mut text = String::new();
    for (source, number) in sources.files().iter().zip(0u16..) {
        let file = parse_file(sources, number);
        let line = |name: Name<'_>| source.line(name.span.start);
        for (pragma, named) in pragmas(&file).filter(|it| it.1 != dialect) {
            let _ = writeln!(
                text,
                "{}:{}: the dialect of the file is `{}`, but {option} says `{}`",
                source.path,
                line(pragma),
                named.name(),
                dialect.name()
            );
        }
        let mut names = Vec::new();
        each_type(&file, &mut |names_of_type| names.push(names_of_type));
        let fixed = names.iter().filter(|it| qualified && it.len() > 1 && Family::named(it[0].text).is_some());
        for name in fixed {
            let (family, block) = (name[0].text.to_ascii_uppercase(), name[1].text);
            let _ = writeln!(
                text,
                "{}:{}: `{family}.{block}` belongs to {family} on every system, so a move does not change it. Write `{block}`, \
                 or give the program for the other system with --against",
                source.path,
                line(name[0])
            );
        }
    }
    if text.is_empty() { Ok(()) } else { Err(text.trim_end().to_owned()) }
}

fn pragmas<'f>(file: &'f File<'f>) -> impl Iterator<Item = (Name<'f>, Dialect)> {
    file.pragmas.iter().filter_map(|it| {
        let (word, name) = it.text.trim().split_at_checked("dialect".len())?;
        let name = name.trim_start().trim_start_matches(":=").trim().trim_matches(['\'', '"']);
        word.eq_ignore_ascii_case("dialect").then(|| Dialect::named(name)).flatten().map(|dialect| (*it, dialect))
    })
}

fn each_type<'f>(file: &'f File<'f>, see: &mut dyn FnMut(&'f [Name<'f>])) {
    for item in &file.items {
        match item {
            Item::Types(decls) => decls.iter().for_each(|it| of_type(&it.ty, see)),
            Item::Pou(pou) => {
                let blocks = pou.routines.iter().flat_map(|it| &it.blocks);
                pou.blocks.iter().chain(blocks).for_each(|it| of_block(it, see));
            }
            Item::Globals(block) => of_block(block, see),
            Item::Configuration(_) | Item::Test(_) => {}
        }
    }
}

fn of_block<'f>(block: &'f VarBlock<'f>, see: &mut dyn FnMut(&'f [Name<'f>])) {
    block.vars.iter().for_each(|it| of_type(&it.ty, see));
}

fn of_type<'f>(ty: &'f TypeSpec<'f>, see: &mut dyn FnMut(&'f [Name<'f>])) {
    match &ty.kind {
        TypeKind::Named(names) => see(names),
        TypeKind::Array { element, .. } => of_type(element, see),
        TypeKind::Reference { target, .. } => of_type(target, see),
        TypeKind::Struct(fields) | TypeKind::Union(fields) => fields.iter().for_each(|it| of_type(&it.ty, see)),
        TypeKind::String { .. } | TypeKind::Subrange { .. } | TypeKind::Enum { .. } | TypeKind::Error => {}
    }
}
