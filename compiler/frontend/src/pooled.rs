//! The setting `[pool] default`: a pool for each type that `__NEW` names and that declares none.

use crate::ast::{Argument, ArgumentKind, Expr, ExprKind, File, Item, Pool, Pou, Statement, TypeKind, each_expr};
use crate::spelling::Key;
use rustc_hash::FxHashSet;

/// Gives the types that `__NEW` names pools of so many objects.
pub(crate) fn expand(files: &mut [File<'_>], count: Option<u32>) {
    let Some(count) = count else { return };
    let made = made(files);
    for item in files.iter_mut().flat_map(|it| &mut it.items) {
        match item {
            Item::Pou(pou) if pou.kind.is_block() && pou.modifiers.is_abstract.is_none() => {
                let pool = Pool { count: Some(count), span: pou.name.span };
                pou.pool = pou.pool.take().or(made.contains(&Key(pou.name.text)).then_some(pool));
            }
            Item::Types(declared) => {
                for decl in declared.iter_mut().filter(|it| matches!(it.ty.kind, TypeKind::Struct(_))) {
                    let pool = Pool { count: Some(count), span: decl.name.span };
                    decl.pool = decl.pool.take().or(made.contains(&Key(decl.name.text)).then_some(pool));
                }
            }
            Item::Pou(_) | Item::Globals(_) | Item::Configuration(_) | Item::Test(_) => {}
        }
    }
}

/// The last names of the types that `__NEW` is given, without a count.
fn made<'s>(files: &[File<'s>]) -> FxHashSet<Key<'s>> {
    let mut found = FxHashSet::default();
    for item in files.iter().flat_map(|it| &it.items) {
        match item {
            Item::Pou(pou) => of_pou(pou, &mut found),
            Item::Test(_) | Item::Types(_) | Item::Globals(_) | Item::Configuration(_) => {}
        }
    }
    found
}

fn of_pou<'s>(pou: &Pou<'s>, found: &mut FxHashSet<Key<'s>>) {
    of_body(&pou.body, found);
    pou.routines.iter().for_each(|it| of_pou(it, found));
}

fn of_body<'s>(body: &[Statement<'s>], found: &mut FxHashSet<Key<'s>>) {
    each_expr(body, &mut |it| found.extend(object_made(it).map(Key)));
}

/// `B` of `__NEW(B)`, `__NEW(Lib.B)` and `__NEW(B(x := 1))`.
fn object_made<'s>(expr: &Expr<'s>) -> Option<&'s str> {
    let ExprKind::Call(callee, arguments) = &expr.kind else { return None };
    let ExprKind::Name(name) = &callee.kind else { return None };
    let [Argument { kind: ArgumentKind::Positional(named), .. }] = arguments.as_slice() else { return None };
    let named = match &named.kind {
        ExprKind::Call(named, _) => named,
        _ => named,
    };
    let last = match &named.kind {
        ExprKind::Name(last) | ExprKind::Member(_, last) => last,
        _ => return None,
    };
    name.text.eq_ignore_ascii_case("__NEW").then_some(last.text)
}
