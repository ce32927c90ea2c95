//! Variables, and the names that a POU has for them.

use super::table::Resolved;
use crate::Span;
use crate::ast;
use crate::spelling::Key;
use rustc_hash::{FxHashMap, FxHashSet};
use staunch_ir::{Const, Place, Section};
use std::cell::Cell;
use std::rc::Rc;

/// A variable as a body knows it.
#[derive(Clone, Debug)]
pub(crate) struct Variable<'s> {
    pub name: ast::Name<'s>,
    /// Its declaration, if it has one of its own.
    pub declared: Option<&'s ast::VarDecl<'s>>,
    pub place: Place,
    pub resolved: Rc<Resolved>,
    pub section: Section,
    pub constant: bool,
    pub retain: bool,
    /// Set when a body reads or writes it; shared between the copies of one declaration.
    pub used: Rc<Cell<bool>>,
}

impl Variable<'_> {
    /// The value of a CONSTANT. A VAR_INPUT CONSTANT or VAR_IN_OUT CONSTANT has the caller's.
    pub fn constant_value(&self) -> Option<Const> {
        let is_given = matches!(self.section, Section::Input | Section::InOut);
        (self.constant && !is_given).then(|| self.resolved.initial.clone())
    }
}

/// The variables a POU can name without a qualifier.
#[derive(Clone, Debug, Default)]
pub(crate) struct Scope<'s> {
    pub variables: Vec<Rc<Variable<'s>>>,
    index: FxHashMap<Key<'s>, usize>,
    /// Names whose declarations were refused: what uses them is not reported again.
    refused: FxHashSet<Key<'s>>,
    /// The CONSTANTs of the POU, which size arrays wherever they are declared.
    pub constants: Option<Rc<Scope<'s>>>,
    /// Around the scope of a METHOD or ACTION: that of its POU.
    pub outer: Option<Rc<Scope<'s>>>,
}

impl<'s> Scope<'s> {
    /// Of a METHOD or ACTION, in the scope of its POU.
    pub fn within(outer: Rc<Self>) -> Self {
        Self { outer: Some(outer), ..Self::default() }
    }

    /// The scope without the variables that are declared in these places.
    pub fn without(&self, declared: &FxHashSet<Span>) -> Self {
        let mut scope = Self { refused: self.refused.clone(), ..Self::default() };
        for variable in self.variables.iter().filter(|it| !declared.contains(&it.name.span)) {
            scope.insert_over(Rc::clone(variable));
        }
        scope
    }

    pub fn get(&self, name: &str) -> Option<&Rc<Variable<'s>>> {
        let constant = || self.constants.as_ref()?.get(name);
        let outer = || self.outer.as_ref().filter(|_| !self.refused.contains(&Key(name)))?.get(name);
        self.own(name).or_else(constant).or_else(outer)
    }

    fn own(&self, name: &str) -> Option<&Rc<Variable<'s>>> {
        self.index.get(&Key(name)).map(|at| &self.variables[*at])
    }

    /// Whether a name is of the scope itself.
    pub fn is_own(&self, name: &str) -> bool {
        self.own(name).is_some()
    }

    pub fn refuse(&mut self, name: ast::Name<'s>) {
        self.refused.insert(Key(name.text));
    }

    pub fn is_refused(&self, name: &str) -> bool {
        let outer = || self.outer.as_ref().is_some_and(|it| it.is_refused(name));
        self.refused.contains(&Key(name)) || !self.is_own(name) && outer()
    }

    pub fn has_refused(&self) -> bool {
        !self.refused.is_empty()
    }

    /// Lists the variables by these positions, those of one position as they were.
    pub fn reorder(&mut self, position: impl Fn(&Variable<'s>) -> usize) {
        self.variables.sort_by_key(|it| position(it));
        self.index = self.variables.iter().enumerate().map(|(at, it)| (Key(it.name.text), at)).collect();
    }

    /// The earlier variable with that name, if any.
    pub fn insert(&mut self, variable: impl Into<Rc<Variable<'s>>>) -> Result<(), ast::Name<'s>> {
        let variable = variable.into();
        if let Some(at) = self.index.get(&Key(variable.name.text)) {
            return Err(self.variables[*at].name);
        }
        self.insert_over(variable);
        Ok(())
    }

    /// Lets another variable have a name; the one that has it keeps its storage.
    pub fn hide(&mut self, name: &'s str) {
        self.index.remove(&Key(name));
    }

    /// Enters a variable, which hides an earlier one with its name.
    pub fn insert_over(&mut self, variable: Rc<Variable<'s>>) {
        self.index.insert(Key(variable.name.text), self.variables.len());
        self.variables.push(variable);
    }
}
