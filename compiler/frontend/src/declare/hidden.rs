//! PRIVATE variables of a base: an heir may have others of their names. Each class sees its own, and both are in the
//! heir's state.

use super::pou::Builder;
use crate::ast::{Access, Pou, VarBlock};
use crate::source::Span;
use crate::types::declarations::Declarations;
use crate::types::scope::Variable;
use staunch_ir::{Place, Projection};
use std::rc::Rc;

impl<'s> Declarations<'s> {
    /// Makes room for a variable where a PRIVATE one of a base has its name: that keeps its storage, which is called
    /// after its class.
    pub(super) fn hide_private(&mut self, variable: &Variable<'s>, builder: &mut Builder<'s>) {
        let name = variable.name;
        let Some(earlier) = builder.scope.get(name.text).filter(|_| builder.scope.is_own(name.text)).cloned() else {
            return;
        };
        let pou = self.pous[builder.slot].ast;
        let [Some(old), Some(new)] = [earlier.name.span, name.span].map(|it| block_of(pou, it)) else { return };
        let private = |it: usize| matches!(pou.blocks[it].access, Some((Access::Private, _)));
        let Some(owner) = self.class_of_block(builder.slot, old).filter(|_| private(old)) else { return };
        let is_plain = |it: &VarBlock<'_>| it.constant.is_none();
        let both = [old, new].iter().all(|it| is_plain(&pou.blocks[*it]));
        if !both || self.class_of_block(builder.slot, new) == Some(owner) {
            return;
        }
        if let Some(field) = field_of(&earlier.place) {
            let is_taken = |name: &str| builder.fields.iter().any(|it| it.name.eq_ignore_ascii_case(name));
            let mut own = format!("{}_{}", self.pous[owner].ast.name.text, name.text);
            while is_taken(&own) {
                own.push('_');
            }
            builder.fields[field].name = own;
        }
        let scope = Rc::get_mut(&mut builder.scope).expect("no one else holds the scope between declarations");
        scope.hide(name.text);
    }

    /// The class that declares a block of a class: itself, or one that it extends.
    pub(crate) fn class_of_block(&self, slot: usize, block: usize) -> Option<usize> {
        let classes = std::iter::successors(Some(slot), |it| self.base_of(*it));
        classes.take_while(|it| block < self.pous[*it].ast.blocks.len()).last()
    }
}

/// The block that declares what is at a place.
fn block_of(pou: &Pou<'_>, declared: Span) -> Option<usize> {
    let declares = |it: &VarBlock<'_>| it.vars.iter().flat_map(|it| &it.names).any(|it| it.span == declared);
    pou.blocks.iter().position(declares)
}

/// The field of the instance that a variable is.
fn field_of(place: &Place) -> Option<usize> {
    match place.projections.as_slice() {
        [Projection::Field(field)] if place.root == staunch_ir::Root::Instance => Some(field.index()),
        _ => None,
    }
}
