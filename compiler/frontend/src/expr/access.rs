//! From where what a class declares may be named: one rule for its variables, METHODs, ACTIONs and PROPERTYs. PRIVATE is
//! for what the class itself declares, PROTECTED for that and what its heirs declare, INTERNAL for the namespace, by
//! where the code is written. Unit tests see everything.

use super::checker::Checker;
use crate::ast::{self, VarBlock, VarKind};
use crate::types::scope::Variable;
use crate::{Code, Diagnostic, Span};
use staunch_ir::StructId;

/// What says from where something may be named.
#[derive(Clone, Copy)]
pub(crate) struct Declared {
    access: ast::Access,
    /// The word, or the declaration where it has none.
    span: Span,
    /// The class that declares it.
    class: usize,
}

impl<'s> Checker<'_, 's> {
    /// Reports a call of a routine from where it may not be named.
    pub(crate) fn may_call(&mut self, slot: usize, name: ast::Name<'s>) -> Option<()> {
        let Some((access, span)) = self.decl.pous[slot].ast.modifiers.access else { return Some(()) };
        // What overrides a PROTECTED routine is called by the base, too.
        let overridden = |it: &usize| self.decl.routine_for(*it, slot).is_some();
        let classes = std::iter::successors(Some(self.decl.home(slot)), |it| self.decl.base_of(*it));
        let class = classes.take_while(overridden).last().unwrap_or_else(|| self.decl.home(slot));
        let declared = Declared { access, span, class };
        let title = self.decl.title(slot);
        self.may_name(declared, &title, name)
    }

    /// Reports a variable of a base that may not be named in an heir, or outside of its namespace.
    pub(crate) fn may_use(&mut self, variable: &Variable<'s>, name: ast::Name<'s>) -> bool {
        let state = self.signature.as_ref().and_then(|it| it.state);
        let Some(slot) = state.and_then(|it| self.decl.slot_of_instance(it)) else { return true };
        let inherited = self.decl.pous[slot].ast.inherited;
        let Some(at) = block_of(&self.decl.pous[slot].ast.blocks[..inherited], variable.name.span) else { return true };
        let Some(declared) = self.declared_in(slot, at) else { return true };
        let title = format!("{}.{}", self.decl.pous[declared.class].ast.name.text, variable.name.text);
        self.may_name(declared, &title, name).is_some()
    }

    /// Reports a variable of an instance that may not be named here.
    pub(crate) fn may_reach(&mut self, declared: Declared, name: ast::Name<'s>) -> Option<()> {
        let title = format!("{}.{}", self.decl.pous[declared.class].ast.name.text, name.text);
        self.may_name(declared, &title, name)
    }

    /// What says from where a variable of an instance may be named. One in VAR without a word is PROTECTED for what its
    /// class and the heirs declare, and for others what the dialect makes of it.
    pub(crate) fn declared_member(&self, id: StructId, name: ast::Name<'s>) -> Option<Declared> {
        let slot = self.decl.slot_of_instance(id)?;
        let pou = self.decl.pous[slot].ast;
        let at = pou.blocks.iter().rposition(|it| names(it).any(|it| it.text.eq_ignore_ascii_case(name.text)))?;
        let own = || {
            let class = self.decl.class_of_block(slot, at)?;
            let is_plain = pou.blocks[at].kind == VarKind::Var && pou.kind.is_block();
            let declared = Declared { access: ast::Access::Protected, span: pou.blocks[at].span, class };
            Some(declared).filter(|it| is_plain && self.is_open(*it, name))
        };
        self.declared_in(slot, at).or_else(own)
    }

    fn declared_in(&self, slot: usize, block: usize) -> Option<Declared> {
        let (access, span) = self.decl.pous[slot].ast.blocks[block].access?;
        Some(Declared { access, span, class: self.decl.class_of_block(slot, block)? })
    }

    fn may_name(&mut self, declared: Declared, title: &str, name: ast::Name<'s>) -> Option<()> {
        if self.sees_all() || self.is_open(declared, name) {
            return Some(());
        }
        let who = match declared.access {
            ast::Access::Public => "everyone can use it",
            ast::Access::Internal => "only its own namespace can use it",
            ast::Access::Private => "only the routines of its own FUNCTION_BLOCK can use it",
            ast::Access::Protected => {
                "only the routines of its FUNCTION_BLOCK, and of those that extend it, can use it"
            }
        };
        self.report(
            Diagnostic::new(Code::E0109, name.span, format!("`{title}` is {}", declared.access.word()))
                .label(who)
                .other(declared.span, "declared as such here"),
        );
        None
    }

    fn is_open(&self, declared: Declared, name: ast::Name<'s>) -> bool {
        let home = self.slot.map(|it| self.decl.home(it));
        match declared.access {
            ast::Access::Public => true,
            // Outside of every NAMESPACE a program is one library.
            ast::Access::Internal => self.decl.names.is_inside(name.span, self.decl.names.space_of(declared.span)),
            ast::Access::Private => home == Some(declared.class),
            ast::Access::Protected => {
                std::iter::successors(home, |it| self.decl.base_of(*it)).any(|it| it == declared.class)
            }
        }
    }

    /// A unit test looks into everything; a VAR_CONFIG gives an address to any variable of an instance.
    pub(crate) fn sees_all(&self) -> bool {
        self.is_test() || self.is_run() || self.is_suite()
    }
}

fn names<'b, 's>(block: &'b VarBlock<'s>) -> impl Iterator<Item = &'b ast::Name<'s>> {
    block.vars.iter().flat_map(|it| &it.names)
}

/// The block that declares what is at a place.
fn block_of(blocks: &[VarBlock<'_>], declared: Span) -> Option<usize> {
    blocks.iter().position(|it| it.access.is_some() && names(it).any(|it| it.span == declared))
}
