//! What a VAR_CONFIG binds in a PROGRAM that others call by its name: the call copies the value at the address before the
//! body, and back after it if it is not an input, as the PROGRAM's own run would.

use super::checker::Checker;
use crate::ast::{self, ExprKind};
use crate::types::address::{self, is_input};
use staunch_ir::HELD_PROGRAM;
use staunch_ir::{Area, Expr, Place, Root, StructId};

/// A variable of the PROGRAM, and the storage at its address.
pub(super) struct Bound<'s> {
    variable: Place,
    located: Place,
    address: ast::Name<'s>,
}

impl<'s> Checker<'_, 's> {
    /// What is bound in the PROGRAM in a slot, if the instance that its name means is called.
    pub(super) fn bound_in_program(&mut self, instance: &Place, slot: usize, callee: &ast::Expr<'s>) -> Vec<Bound<'s>> {
        let named = self.decl.named_programs.get(&slot).filter(|_| instance.root == Root::Globals);
        let Some((run, bound)) = named.and_then(|it| it.run) else { return Vec::new() };
        let Some(signature) = self.decl.signature(run) else { return Vec::new() };
        // A VAR_CONFIG reaches any variable of an instance.
        let caller = self.slot.replace(run);
        let found = bound.iter().filter_map(|(target, address)| {
            let variable = self.place(&in_place_of_run(target, callee))?.place;
            let located = signature.scope.get(address.text)?.place.clone();
            Some(Bound { variable, located, address: *address })
        });
        let found = found.collect();
        self.slot = caller;
        found
    }

    pub(super) fn copy_in(&mut self, bound: &[Bound<'s>]) {
        for Bound { variable, located, address } in bound {
            self.note_bound(None, variable.clone(), *address);
            let value = Expr::load(located.clone(), self.at(address.span));
            self.assign(variable.clone(), value, address.span);
        }
    }

    /// Notes what is copied from an input, for those who set inputs; in instances of `state`, or in the globals.
    pub(crate) fn note_bound(&mut self, state: Option<StructId>, variable: Place, address: ast::Name<'s>) {
        let Some(address) = address::parse(address.text).filter(|it| it.area == Area::Input) else { return };
        self.decl.program.bound.push(staunch_ir::Bound { state, variable, address });
    }

    pub(super) fn copy_out(&mut self, bound: &[Bound<'s>]) {
        for Bound { variable, located, address } in bound.iter().filter(|it| !is_input(it.address)) {
            let value = Expr::load(variable.clone(), self.at(address.span));
            self.assign(located.clone(), value, address.span);
        }
    }
}

/// A path through what a run holds, as one through the PROGRAM that is called.
fn in_place_of_run<'s>(path: &ast::Expr<'s>, callee: &ast::Expr<'s>) -> ast::Expr<'s> {
    let inner = |base: &ast::Expr<'s>| Box::new(in_place_of_run(base, callee));
    let kind = match &path.kind {
        ExprKind::Name(name) if name.text == HELD_PROGRAM => return callee.clone(),
        ExprKind::Member(base, name) => ExprKind::Member(inner(base), *name),
        ExprKind::Index(base, indices) => ExprKind::Index(inner(base), indices.clone()),
        other => other.clone(),
    };
    ast::Expr { kind, span: path.span }
}
