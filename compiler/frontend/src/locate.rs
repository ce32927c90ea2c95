//! Addresses as OpenPLC Editor writes them: after the type, `x : BOOL AT %QX0.0`, and by the alias of a pin. What the
//! project knows of an address is added to what documents its variable.

use crate::ast::{File, Item, Name, Pou, VarBlock, VarDecl, VarKind};
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
        let items = std::mem::take(&mut file.items);
        file.items = items.into_iter().flat_map(|it| located_constants(it, log)).collect();
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
    log.has_form(span, Dialect::has_addresses_after_types)
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
    } else if let Some(problem) = Some(address_without_sign(span, text)).filter(|it| it.fix.is_some()) {
        problem
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
fn located_constants<'s>(mut item: Item<'s>, log: &Log<'s>) -> Vec<Item<'s>> {
    let split = |block: VarBlock<'s>| -> Vec<VarBlock<'s>> {
        let can_be = log.dialect(block.span).has_located_constants();
        if !can_be || block.constant.is_none() || block.vars.iter().all(|it| it.address.is_none()) {
            return vec![block];
        }
        let alone = |decl: &VarDecl<'s>| {
            let constant = block.constant.filter(|_| decl.address.is_none());
            VarBlock { constant, vars: vec![decl.clone()], ..block.clone() }
        };
        block.vars.iter().map(alone).collect()
    };
    let split_all = |blocks: &mut Vec<VarBlock<'s>>| {
        *blocks = std::mem::take(blocks).into_iter().flat_map(split).collect();
    };
    match &mut item {
        Item::Pou(it) => split_all(&mut it.blocks),
        Item::Configuration(it) => {
            split_all(&mut it.globals);
            it.resources.iter_mut().for_each(|it| split_all(&mut it.globals));
        }
        Item::Globals(block) => {
            let block = std::mem::replace(block, VarBlock::new(VarKind::Global, block.span));
            return split(block).into_iter().map(Item::Globals).collect();
        }
        Item::Test(_) | Item::Types(_) => {}
    }
    vec![item]
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
