//! The initial value of an array of arrays: each element is an array with brackets of its own. The rows of one array of
//! several dimensions may also follow each other without any. (IEC 61131-3, table 11 and the grammar of
//! `array_init`; Beckhoff TF1000, *Compiler Error C0232*)

use crate::ast::{Element, Expr, Initial, InitialKind, Name, TypeDecl, TypeKind, TypeSpec};
use crate::names::{Entry, Found, Meaning, Sense};
use crate::types::declarations::Declarations;
use crate::{Code, Diagnostic};

/// How deep types that name one another are followed: as deep as an array has dimensions.
const MAX_DEPTH: usize = 64;

impl<'s> Declarations<'s> {
    /// Reports a list that gives an array of arrays the elements of its elements.
    pub(super) fn has_flat_rows(&mut self, spec: &TypeSpec<'s>, initial: &Initial<'s>) -> bool {
        let Some(found) = self.flat_row(spec, initial, MAX_DEPTH) else { return false };
        let text = self.log.sources.text(found.span);
        let error = Diagnostic::new(Code::E0206, found.span, "each element of this array is itself an array");
        let help = format!("put the values of each element in brackets: `[[{text}, …], […]]`");
        self.report(error.label("this is a value of an inner array").help(help));
        true
    }

    /// The first value where a list is expected.
    fn flat_row<'a>(&self, spec: &TypeSpec<'s>, initial: &'a Initial<'s>, depth: usize) -> Option<&'a Expr<'s>> {
        let depth = depth.checked_sub(1)?;
        match (&spec.kind, &initial.kind) {
            (TypeKind::Named(path), InitialKind::Elements(_) | InitialKind::Fields(_)) => {
                self.flat_row(&self.declared_as(path)?.ty, initial, depth)
            }
            (TypeKind::Array { bounds, element }, InitialKind::Elements(elements)) => {
                self.flat_element(bounds.len(), element, elements, depth)
            }
            (TypeKind::Struct(members), InitialKind::Fields(fields)) => fields.iter().find_map(|(name, value)| {
                let is_it = |it: &Name<'_>| it.text.eq_ignore_ascii_case(name.text);
                let member = members.iter().find(|it| it.names.iter().any(is_it))?;
                self.flat_row(&member.ty, value, depth)
            }),
            _ => None,
        }
    }

    /// The same of the list for an array of so many dimensions.
    fn flat_element<'a>(
        &self,
        dimensions: usize,
        element: &TypeSpec<'s>,
        elements: &'a [Element<'s>],
        depth: usize,
    ) -> Option<&'a Expr<'s>> {
        let mut values = elements.iter().flat_map(|it| &it.values);
        let rows: Vec<_> = values.clone().filter_map(rows_of).collect();
        if dimensions > 1 && !rows.is_empty() {
            return rows.into_iter().find_map(|it| self.flat_element(dimensions - 1, element, it, depth));
        }
        let is_array = self.is_array(element, depth);
        values.find_map(|value| match &value.kind {
            InitialKind::Value(expr) if is_array => Some(expr),
            _ => self.flat_row(element, value, depth),
        })
    }

    fn is_array(&self, spec: &TypeSpec<'s>, depth: usize) -> bool {
        match &spec.kind {
            TypeKind::Array { .. } => true,
            TypeKind::Named(path) if depth > 0 => {
                self.declared_as(path).is_some_and(|it| self.is_array(&it.ty, depth - 1))
            }
            _ => false,
        }
    }

    fn declared_as(&self, path: &[Name<'s>]) -> Option<&'s TypeDecl<'s>> {
        match self.lookup(path, Sense::Type) {
            Found::One(Meaning::Declared(Entry::Type(at))) => Some(self.types[at].decl),
            Found::One(_) | Found::Nothing | Found::Several(_) => None,
        }
    }
}

fn rows_of<'a, 's>(value: &'a Initial<'s>) -> Option<&'a [Element<'s>]> {
    match &value.kind {
        InitialKind::Elements(row) => Some(row),
        InitialKind::Value(_)
        | InitialKind::Fields(_)
        | InitialKind::Bind(_)
        | InitialKind::Indexed(_)
        | InitialKind::Members(_) => None,
    }
}
