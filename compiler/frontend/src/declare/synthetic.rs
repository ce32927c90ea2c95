//! Variables that the globals hold without being declared there: shared addresses, and VAR_STAT.

use super::Declarations;
use crate::ast;
use staunch_ir::{Field, FieldId, Place, Root, Section, Type};

#[derive(Debug, Default)]
pub(crate) struct Hidden<'s> {
    fields: Vec<Field>,
    /// The first declaration of each, if it has one.
    declared: Vec<Option<ast::Name<'s>>>,
}

impl<'s> Hidden<'s> {
    pub fn field_type(&self, at: usize) -> Type {
        self.fields[at].ty
    }

    pub fn declared(&self, at: usize) -> Option<ast::Name<'s>> {
        self.declared[at]
    }

    pub fn address_of(&self, at: usize) -> Option<staunch_ir::Address> {
        self.fields.get(at).and_then(|it| it.address)
    }

    pub fn fields(&self) -> Vec<Field> {
        self.fields.clone()
    }
}

impl<'s> Declarations<'s> {
    /// Adds a field to the globals, under `field.name` or, where that is taken, one like it.
    pub fn add_hidden(&mut self, mut field: Field, declared: Option<ast::Name<'s>>) -> usize {
        while self.is_global_name(&field.name) {
            field.name.push('_');
        }
        field.section = Section::Global;
        self.hidden.fields.push(field);
        self.hidden.declared.push(declared);
        self.hidden.fields.len() - 1
    }

    /// Whether a field of the globals has the name.
    pub fn is_global_name(&self, name: &str) -> bool {
        self.hidden.fields.iter().any(|it| it.name.eq_ignore_ascii_case(name))
            || self.globals.iter().any(|it| super::address::field_name(it.name.text).eq_ignore_ascii_case(name))
    }

    pub fn hidden_place(&self, at: usize) -> Place {
        let id = FieldId::next(self.addresses.own_fields().len() + at);
        Place::root(Root::Globals, Type::Struct(super::GLOBALS)).field(id, self.hidden.fields[at].ty)
    }
}
