//! Which names are variables as far as syntax shows: an initial value that reads one is assigned at each call, since
//! it means the variable's value at that time.

use crate::ast::{Expr, ExprKind, File, Item, Pou, PouKind, VarBlock, VarKind, each_part};
use crate::spelling::Key;
use rustc_hash::{FxHashMap, FxHashSet};

/// What is available everywhere: global variables, and POUs whose calls give values.
#[derive(Default)]
pub(super) struct Everywhere<'s> {
    variables: FxHashSet<Key<'s>>,
    pous: FxHashSet<Key<'s>>,
}

impl<'s> Everywhere<'s> {
    pub fn of(files: &[File<'s>]) -> Self {
        let mut found = Self::default();
        for item in files.iter().flat_map(|it| &it.items) {
            match item {
                Item::Pou(pou) => {
                    if matches!(pou.kind, PouKind::Function | PouKind::Program) {
                        found.pous.insert(Key(pou.name.text));
                    }
                }
                Item::Globals(block) => found.add(block),
                Item::Configuration(it) => {
                    it.globals
                        .iter()
                        .chain(it.resources.iter().flat_map(|it| &it.globals))
                        .for_each(|it| found.add(it));
                }
                Item::Types(_) | Item::Test(_) => {}
            }
        }
        found
    }

    fn add(&mut self, block: &VarBlock<'s>) {
        if !block.has_values() {
            self.variables.extend(names(block));
        }
    }
}

fn names<'a, 's>(block: &'a VarBlock<'s>) -> impl Iterator<Item = Key<'s>> + 'a {
    block.vars.iter().flat_map(|it| &it.names).map(|it| Key(it.text))
}

/// What the initial values of one POU see.
pub(super) struct Names<'a, 's> {
    everywhere: &'a Everywhere<'s>,
    /// Of the POU around.
    around: Option<&'a Names<'a, 's>>,
    /// Whether a name of the POU is a variable's that has its value before the POU's statements.
    own: FxHashMap<Key<'s>, bool>,
}

impl<'a, 's> Names<'a, 's> {
    pub fn everywhere(everywhere: &'a Everywhere<'s>) -> Self {
        Self { everywhere, around: None, own: FxHashMap::default() }
    }

    /// These and those of a POU. What starts anew at each call has its value where that was [given](Self::give).
    pub fn with<'b>(&'b self, pou: &Pou<'s>) -> Names<'b, 's> {
        let mut inner = Names { around: Some(self), ..Names::everywhere(self.everywhere) };
        for block in &pou.blocks {
            let lasts = match block.kind {
                VarKind::Input | VarKind::InOut | VarKind::Inst | VarKind::Stat | VarKind::External => true,
                VarKind::Var | VarKind::Output => !pou.kind.is_function(),
                VarKind::Temp | VarKind::Global => false,
            };
            inner.own.extend(names(block).map(|it| (it, lasts && !block.has_values())));
        }
        let called = pou.routines.iter().filter(|it| it.kind != PouKind::Setter);
        inner.own.extend(called.map(|it| (Key(it.name.text), true)));
        inner
    }

    /// The variables of one declaration have their values now.
    pub fn give(&mut self, names: &[crate::ast::Name<'s>]) {
        self.own.extend(names.iter().map(|it| (Key(it.text), true)));
    }

    /// Whether a value is known when its POU runs, and not before.
    pub fn vary(&self, value: &Expr<'s>) -> bool {
        let mut found = false;
        each_part(value, &mut |it| {
            found |= match &it.kind {
                ExprKind::Name(it) if ["THIS", "SUPER"].iter().any(|word| it.text.eq_ignore_ascii_case(word)) => true,
                ExprKind::Name(it) => self.is_variable(Key(it.text)),
                ExprKind::Member(_, it) => self.everywhere.variables.contains(&Key(it.text)),
                ExprKind::Address(_) => true,
                ExprKind::Literal(_)
                | ExprKind::Part(..)
                | ExprKind::Deref(_)
                | ExprKind::Unary(..)
                | ExprKind::Paren(_)
                | ExprKind::Index(..)
                | ExprKind::Error(_)
                | ExprKind::Call(..)
                | ExprKind::Binary(..)
                | ExprKind::Assign(..) => false,
            };
        });
        found
    }

    fn is_variable(&self, name: Key<'s>) -> bool {
        let is_everywhere = || self.everywhere.variables.contains(&name) || self.everywhere.pous.contains(&name);
        let is_around = || self.around.map_or_else(is_everywhere, |it| it.is_variable(name));
        self.own.get(&name).copied().unwrap_or_else(is_around)
    }
}
