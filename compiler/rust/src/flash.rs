//! CONSTANT variables as `const` items: their tables are in a small machine's flash, and not in its memory.

use proc_macro2::{Ident, TokenStream};
use quote::quote;
use staunch_ir::{Const, ExprKind, FieldId, Program, Projection, StructId, Type, visit};

use crate::emitter::{Constants, Emitter};
use crate::names::{Scope, screaming};

/// The constants of POUs and of the globals, but for those to which some initial value of an instance gives
/// another value.
pub fn constants(emitter: &Emitter<'_>) -> Constants {
    let program = emitter.program;
    let states = program.routines.iter().filter_map(|it| it.state).chain([program.globals]);
    let mut found: Constants = states
        .flat_map(|id| {
            let fields = program.structure(id).fields.iter().enumerate();
            fields.filter(|(_, field)| field.constant).map(move |(at, _)| (id, FieldId::next(at)))
        })
        .collect();
    values(program, &mut |ty, value| without_others(emitter, ty, value, &mut found));
    found
}

/// Each initial value and aggregate of the program.
fn values(program: &Program, see: &mut dyn FnMut(Type, &Const)) {
    program.structs.iter().flat_map(|it| &it.fields).for_each(|it| see(it.ty, &it.initial));
    for routine in &program.routines {
        routine.locals.iter().for_each(|it| see(it.ty, &it.initial));
        visit::statements(&routine.body, &mut |statement| {
            visit::values(statement, &mut |expr| {
                if let ExprKind::Aggregate(value) = &expr.kind {
                    see(expr.ty, value);
                }
            });
        });
    }
}

/// Takes out the constants that `value` gives another value than their own.
fn without_others(emitter: &Emitter<'_>, ty: Type, value: &Const, constants: &mut Constants) {
    match (ty, value) {
        (Type::Struct(id), _) => {
            for (at, field) in emitter.program.structure(id).fields.iter().enumerate() {
                let member = match value {
                    Const::Struct(values) => &values[at],
                    Const::Zero | Const::Scalar(_) | Const::Text(_) | Const::Array(_) => &Const::Zero,
                };
                if field.constant && !emitter.same(field.ty, member, &field.initial) {
                    constants.remove(&(id, FieldId::next(at)));
                }
                without_others(emitter, field.ty, member, constants);
            }
        }
        (Type::Array(id), Const::Array(runs)) => {
            let element = emitter.program.array(id).element;
            runs.iter().for_each(|(_, it)| without_others(emitter, element, it, constants));
        }
        (Type::Array(id), Const::Zero) => {
            without_others(emitter, emitter.program.array(id).element, &Const::Zero, constants);
        }
        (
            Type::Array(_)
            | Type::Elementary(_)
            | Type::Reference(_)
            | Type::Subrange(..)
            | Type::String(_)
            | Type::Enum(_)
            | Type::Block(_),
            _,
        ) => {}
    }
}

impl Emitter<'_> {
    /// The items of a structure's constants.
    pub fn constant_items(&self, id: StructId) -> TokenStream {
        let fields = self.program.structure(id).fields.iter().enumerate();
        fields
            .filter_map(|(at, field)| {
                let (name, ty) = (self.constant_name(id, FieldId::next(at))?, self.ty(field.ty));
                let (docs, value) = (self.field_docs(id, field), self.constant(field.ty, &field.initial).tokens);
                Some(match is_by_reference(field.ty) {
                    true => quote!(#docs pub const #name: &'static #ty = &#value;),
                    false => quote!(#docs pub const #name: #ty = #value;),
                })
            })
            .collect()
    }

    /// `LIMIT`, if the field is a constant and no part of the state.
    pub fn constant_name(&self, id: StructId, field: FieldId) -> Option<Ident> {
        if !self.constants.contains(&(id, field)) {
            return None;
        }
        let mut scope = Scope::default();
        let fields = &self.program.structure(id).fields[..=field.index()];
        let constants = fields.iter().enumerate().filter(|(at, _)| self.constants.contains(&(id, FieldId::next(*at))));
        constants.map(|(_, it)| scope.claim(&screaming(&it.name))).last()
    }

    /// Whether a place of a type, with this last projection, is a reference to a constant.
    pub fn is_constant_reference(&self, ty: Type, last: &Projection) -> bool {
        match (ty, last) {
            (Type::Struct(id), Projection::Field(field)) => {
                self.constants.contains(&(id, *field))
                    && is_by_reference(self.program.structure(id).fields[field.index()].ty)
            }
            _ => false,
        }
    }
}

/// A constant that is used by its value is copied with it: that of a table is its place.
fn is_by_reference(ty: Type) -> bool {
    match ty {
        Type::Array(_) | Type::Struct(_) | Type::Block(_) => true,
        Type::Elementary(_) | Type::Reference(_) | Type::Subrange(..) | Type::String(_) | Type::Enum(_) => false,
    }
}
