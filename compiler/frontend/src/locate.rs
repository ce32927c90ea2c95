//! Addresses as OpenPLC Editor writes them: after the type, `x : BOOL AT %QX0.0`, and by the alias of a pin. What the
//! project knows of an address is added to what documents its variable.

use crate::ast::{File, Item, Name, Pou, VarBlock, VarDecl};
use crate::dialect::Dialect;
use crate::log::Log;
use crate::parse::address_without_sign;
use crate::{Code, Diagnostic, Fix, Span};

/// Puts addresses in place of aliases.
pub(crate) fn resolve<'s>(files: &mut [File<'s>], log: &mut Log<'s>) {
    for file in files {
        for (address, problem) in std::mem::take(&mut file.late_addresses) {
            late(address, problem, log);
        }
        file.items.iter_mut().for_each(|it| item(it, &mut |it| resolve_one(it, log)));
        file.items.iter_mut().for_each(|it| located_constants(it, log));
    }
}

/// Reports an address after the type, or notes how it is written elsewhere.
fn late(written: Name<'_>, problem: Diagnostic, log: &mut Log<'_>) {
    let address = log.sources.device().and_then(|it| it.address(written.text));
    if !has_late_addresses(problem.span, log) {
        // What is neither an address nor an alias is reported as that.
        if address.is_some() || written.text.starts_with('%') {
            log.report(problem);
        }
        return;
    }
    let Some(mut fix) = problem.fix.filter(|_| log.options.moved_from.is_some()) else { return };
    if let Some(address) = address {
        fix.replacement = fix.replacement.replacen(written.text, address, 1);
    }
    log.readdressed.push(fix);
}

/// A program that moves to another system keeps the form.
fn has_late_addresses(span: Span, log: &Log<'_>) -> bool {
    log.dialect(span).has_addresses_after_types()
        || log.options.moved_from.is_some_and(Dialect::has_addresses_after_types)
}

fn resolve_one<'s>(decl: &mut VarDecl<'s>, log: &mut Log<'s>) {
    let Some(written) = decl.address else { return };
    let device = log.sources.device();
    let mut address = Some(written);
    if !written.text.starts_with('%') {
        let found = device.and_then(|it| it.address(written.text));
        address = found.map(|text| Name { text, ..written });
        let is_before = decl.ty.span.start > written.span.start;
        if let (Some(text), true, Some(_)) = (found, is_before, log.options.moved_from) {
            log.readdressed.push(Fix { span: written.span, replacement: text.to_owned() });
        }
        if found.is_none() {
            report_alias(written, log);
        }
    }
    if let Some(label) = address.and_then(|it| device?.label(it.text)) {
        decl.doc = Some(decl.doc.take().map_or(label.clone(), |it| format!("{it}: {label}")));
    }
    decl.address = address;
}

/// Reports an alias that stands for no address.
fn report_alias(alias: Name<'_>, log: &mut Log<'_>) {
    let Name { text, span } = alias;
    let problem = if log.sources.device().is_some() {
        Diagnostic::new(Code::W0413, span, format!("`{text}` is not the alias of a pin of this project"))
            .label("the variable has no address")
            .help(format!("give a pin the alias `{text}` in the editor, or write the address: `AT %IX0.0`"))
    } else if has_late_addresses(span, log) {
        Diagnostic::new(Code::E0409, span, format!("`{text}` is not a direct address"))
            .label("an alias of OpenPLC Editor is known only in its project")
            .help("name the project's folder instead of the file, or write the address: `AT %IX0.0`")
    } else {
        address_without_sign(span, text)
    };
    log.report(problem);
}

/// The declarations of variables in an item.
/// What has an address is no CONSTANT in OpenPLC, whatever its section says: it begins with its value, and the address has what the
/// machine writes there.
fn located_constants<'s>(item: &mut Item<'s>, log: &Log<'s>) {
    let split = |blocks: &mut Vec<VarBlock<'s>>| {
        let is_mixed = |it: &VarBlock<'s>| {
            let can_be = log.dialect(it.span).has_located_constants();
            can_be && it.constant.is_some() && it.vars.iter().any(|it| it.address.is_some())
        };
        if !blocks.iter().any(is_mixed) {
            return;
        }
        for block in std::mem::take(blocks) {
            if !is_mixed(&block) {
                blocks.push(block);
                continue;
            }
            for decl in &block.vars {
                let constant = block.constant.filter(|_| decl.address.is_none());
                blocks.push(VarBlock { constant, vars: vec![decl.clone()], ..block.clone() });
            }
        }
    };
    match item {
        Item::Pou(it) => split(&mut it.blocks),
        Item::Configuration(it) => {
            split(&mut it.globals);
            it.resources.iter_mut().for_each(|it| split(&mut it.globals));
        }
        Item::Test(_) | Item::Globals(_) | Item::Types(_) => {}
    }
}

fn item<'s>(item: &mut Item<'s>, change: &mut impl FnMut(&mut VarDecl<'s>)) {
    match item {
        Item::Pou(it) => pou(it, change),
        Item::Test(it) => pou(&mut it.pou, change),
        Item::Globals(it) => blocks(std::slice::from_mut(it), change),
        Item::Configuration(it) => {
            blocks(&mut it.globals, change);
            it.resources.iter_mut().for_each(|it| blocks(&mut it.globals, change));
        }
        // A place in a structure is not an address.
        Item::Types(_) => {}
    }
}

fn pou<'s>(pou: &mut Pou<'s>, change: &mut impl FnMut(&mut VarDecl<'s>)) {
    blocks(&mut pou.blocks, change);
    pou.routines.iter_mut().for_each(|it| self::pou(it, change));
}

fn blocks<'s>(blocks: &mut [VarBlock<'s>], change: &mut impl FnMut(&mut VarDecl<'s>)) {
    blocks.iter_mut().flat_map(|it| &mut it.vars).for_each(change);
}
