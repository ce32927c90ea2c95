//! Inputs of ANY and the like as CODESYS has them: the body gets no value, but the argument's class of type, its address
//! and its size, as a structure. So it is where a body asks for one of these, in FUNCTION_BLOCKs, and in METHODs
//! without a body; what has to have the same parameters as such a METHOD, or hands an input of its own on to
//! one, or to what takes an `__SYSTEM.AnyType`, has them, too. Other FUNCTIONs and METHODs are generic.

use crate::ast::{self, ExprKind as Ast, PouKind, VarKind};
use crate::spelling::Key;
use crate::types::declarations::Declarations;
use rustc_hash::FxHashSet;

const MEMBERS: [&str; 3] = ["TYPECLASS", "PVALUE", "DISIZE"];

/// A POU with such inputs, as far as it is known whether they are.
struct Candidate<'s> {
    slot: usize,
    name: Key<'s>,
    /// Of a METHOD: its class, and all that inherit from one another stand for one.
    family: Option<usize>,
    is_one: bool,
    /// What is called with one of the inputs.
    handed_to: FxHashSet<Key<'s>>,
}

impl<'s> Declarations<'s> {
    pub(super) fn note_any_inputs(&mut self, bodies: &[Vec<ast::Statement<'s>>]) {
        let mut all = self.types.iter();
        let is_it = |it: ast::Name<'_>| {
            it.text == "AnyType" && self.log.sources.get(it.span.file).is_unit("library/__system.st")
        };
        let Some(structure) = all.position(|it| is_it(it.decl.name)) else { return };
        self.table.any.structure = Some(structure);
        let mut candidates = self.candidates(bodies);
        let takers: Vec<_> =
            self.pous.iter().filter(|it| takes_structures(it.ast)).map(|it| Key(it.ast.name.text)).collect();
        loop {
            let known = candidates.iter().filter(|it| it.is_one);
            let known = known.flat_map(|it| [(it.name, None), (it.name, it.family)]);
            let known: FxHashSet<_> = known.chain(takers.iter().map(|it| (*it, None))).collect();
            let mut is_more = false;
            for it in candidates.iter_mut().filter(|it| !it.is_one) {
                let is_kin = it.family.is_some() && known.contains(&(it.name, it.family));
                it.is_one = is_kin || it.handed_to.iter().any(|it| known.contains(&(*it, None)));
                is_more |= it.is_one;
            }
            if !is_more {
                break;
            }
        }
        for it in candidates.into_iter().filter(|it| it.is_one) {
            for decl in any_inputs(self, self.pous[it.slot].ast) {
                let (Some(class), ast::TypeKind::Named(path)) = (self.word(&decl.ty), &decl.ty.kind) else { continue };
                self.table.any.classes.extend(decl.names.iter().map(|it| (it.span, class)));
                self.table.any.words.extend(path.iter().map(|it| it.span));
            }
        }
    }

    fn candidates(&mut self, bodies: &[Vec<ast::Statement<'s>>]) -> Vec<Candidate<'s>> {
        let families = self.families();
        let mut found = Vec::new();
        for slot in 0..self.pous.len() {
            let (pou, owner) = (self.pous[slot].ast, self.pous[slot].owner);
            let is_one_of = matches!(pou.kind, PouKind::Function | PouKind::Method) || pou.kind.is_block();
            if !is_one_of || !self.dialect(pou.name.span).hands_on_any() {
                continue;
            }
            let names: FxHashSet<_> =
                any_inputs(self, pou).iter().flat_map(|it| &it.names).map(|it| Key(it.text)).collect();
            if names.is_empty() {
                continue;
            }
            let is_head = pou.kind == PouKind::Method && (self.is_head(slot) || pou.modifiers.is_abstract.is_some());
            let (asks, handed_to) = uses(bodies.get(slot).map_or(&[], Vec::as_slice), &names);
            let family = owner.filter(|_| pou.kind == PouKind::Method).map(|it| families[it]);
            let is_one = asks || is_head || pou.kind.is_block();
            found.push(Candidate { slot, name: Key(pou.name.text), family, is_one, handed_to });
        }
        found
    }

    /// For each slot one of those that inherit from one another, or have one INTERFACE.
    fn families(&self) -> Vec<usize> {
        let mut parents: Vec<usize> = (0..self.pous.len()).collect();
        fn top(parents: &mut [usize], mut at: usize) -> usize {
            while parents[at] != at {
                parents[at] = parents[parents[at]];
                at = parents[at];
            }
            at
        }
        for slot in 0..self.pous.len() {
            for kin in self.base_of(slot).into_iter().chain(self.own_interfaces(slot)) {
                let (a, b) = (top(&mut parents, slot), top(&mut parents, kin));
                parents[a.max(b)] = a.min(b);
            }
        }
        (0..parents.len()).map(|it| top(&mut parents, it)).collect()
    }
}

/// Whether a POU has a parameter that is what is handed on for an ANY.
fn takes_structures(pou: &ast::Pou<'_>) -> bool {
    let parameters = pou.blocks.iter().filter(|it| matches!(it.kind, VarKind::Input | VarKind::InOut));
    let is_one = |it: &ast::Name<'_>| it.text.eq_ignore_ascii_case("AnyType");
    let mut variables = parameters.flat_map(|it| &it.vars);
    variables.any(|it| matches!(&it.ty.kind, ast::TypeKind::Named(path) if path.last().is_some_and(is_one)))
}

/// The inputs of a POU whose whole type is ANY or the like.
fn any_inputs<'s>(declarations: &Declarations<'s>, pou: &'s ast::Pou<'s>) -> Vec<&'s ast::VarDecl<'s>> {
    let inputs = pou.blocks.iter().filter(|it| it.kind == VarKind::Input).flat_map(|it| &it.vars);
    inputs.filter(|it| declarations.word(&it.ty).is_some()).collect()
}

/// Whether statements ask one of these variables for what CODESYS hands on, and what they call with one.
fn uses<'s>(body: &[ast::Statement<'s>], names: &FxHashSet<Key<'s>>) -> (bool, FxHashSet<Key<'s>>) {
    let is_own = |it: &ast::Expr<'s>| matches!(&it.kind, Ast::Name(name) if names.contains(&Key(name.text)));
    let (mut asks, mut handed_to) = (false, FxHashSet::default());
    ast::each_expr(body, &mut |it| match &it.kind {
        Ast::Member(owner, name) => {
            asks |= is_own(owner) && MEMBERS.iter().any(|it| name.text.eq_ignore_ascii_case(it));
        }
        Ast::Call(callee, arguments) => {
            let given = arguments.iter().any(|it| match &it.kind {
                ast::ArgumentKind::Positional(value) | ast::ArgumentKind::Input(_, value) => is_own(value),
                ast::ArgumentKind::Output { .. } => false,
            });
            match &callee.kind {
                Ast::Member(_, name) | Ast::Name(name) if given => drop(handed_to.insert(Key(name.text))),
                _ => {}
            }
        }
        _ => {}
    });
    (asks, handed_to)
}
