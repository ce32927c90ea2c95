//! Variables that the globals hold without being declared there: shared addresses, and VAR_STAT.

use super::scope::Variable;
use crate::Span;
use crate::ast;
use rustc_hash::{FxHashMap, FxHashSet};
use staunch_ir::{Field, Type};
use std::rc::Rc;

#[derive(Debug, Default)]
pub(crate) struct Synthetic<'s> {
    pub fields: Vec<Field>,
    /// The first declaration of each, if it has one.
    pub declared: Vec<Option<ast::Name<'s>>>,
    /// The names of all fields of the globals, in capitals: they are read off the declarations when the first is asked for.
    pub names: FxHashSet<String>,
    /// VAR_STAT by their declarations, which classes inherit.
    pub statics: FxHashMap<Span, usize>,
}

impl<'s> Synthetic<'s> {
    pub fn field_type(&self, at: usize) -> Type {
        self.fields[at].ty
    }

    pub fn declared(&self, at: usize) -> Option<ast::Name<'s>> {
        self.declared[at]
    }

    /// Gives the comment of the declaration that a field was added for.
    pub fn document(&mut self, at: usize, doc: Option<String>) {
        self.fields[at].doc = doc;
    }

    pub fn fields(&self) -> Vec<Field> {
        self.fields.clone()
    }
}

/// What a VAR_CONFIG binds: the variable, as a path from what the run holds, and its address.
pub(crate) type Binding<'s> = (ast::Expr<'s>, ast::Name<'s>);

/// The instance of a PROGRAM that is named somewhere.
#[derive(Debug)]
pub(crate) struct NamedProgram<'s> {
    pub variable: Rc<Variable<'s>>,
    /// Where it is named first.
    pub first: Span,
    pub is_called: bool,
    /// A call of its body is written somewhere.
    pub runs: bool,
    /// The run that holds it where a VAR_CONFIG binds something in it: the run's slot, and what is bound.
    pub run: Option<(usize, &'s [Binding<'s>])>,
    /// That runs have instances of their own has been reported.
    pub is_reported: bool,
}
