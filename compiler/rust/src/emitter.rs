//! What every part of the printer knows, and how types are written.

use std::collections::BTreeSet;

use proc_macro2::{Ident, TokenStream};
use quote::quote;
use staunch_ir::effects::{Effects, Rules, effects};
use staunch_ir::layout::Layout;
use staunch_ir::reference::Targets;
use staunch_ir::{FieldId, Location, Place, Program, Root, Routine, StructId, Type};

use crate::alias::{Origin, element};
use crate::literal::{number, rust_path};
use crate::look_up::{LookUp, look_ups};
use crate::names::{Names, ident};
use crate::text;

/// The constants of a program that are not part of its state: those that have one value in all instances.
pub type Constants = BTreeSet<(StructId, FieldId)>;

pub struct Emitter<'p> {
    pub program: &'p Program,
    pub origins: &'p [Origin],
    pub names: Names,
    pub effects: Vec<Effects>,
    pub layout: Layout,
    /// Where references lead.
    pub targets: Targets<'p>,
    /// The functions that look there, by the types that they look for.
    pub look_ups: Vec<LookUp>,
    /// Constants that are not part of the state.
    pub constants: Constants,
    /// The program has references: variables that several paths may reach are in cells, and each routine gets
    /// the whole machine.
    pub shared: bool,
    /// A scan may continue after a fault.
    pub handles_faults: bool,
}

impl<'p> Emitter<'p> {
    pub fn new(program: &'p Program, origins: &'p [Origin]) -> Self {
        let names = Names::new(program, origins);
        let effects = effects(program, &Rules { scans_take_all: true, ..Rules::PLAIN });
        let shared = !program.references.is_empty();
        let (constants, handles_faults) = (Constants::new(), program.handles_faults());
        let layout = Layout::new(program);
        let targets = Targets::new(program, &layout);
        let look_ups = look_ups(program, &names, &targets);
        Self { program, origins, names, effects, layout, targets, look_ups, constants, shared, handles_faults }
    }

    pub fn ty(&self, ty: Type) -> TokenStream {
        match ty {
            Type::Elementary(it) if it.is_time() && !it.repr().is_unsigned() => quote!(Time),
            Type::Elementary(it) | Type::Subrange(it, _) => {
                let repr = ident(it.repr().rust_name());
                quote!(#repr)
            }
            Type::String(it) => {
                let (head, capacity) = (text::head(ty), number(u64::from(it.capacity)));
                quote!(#head<#capacity>)
            }
            Type::Enum(id) => {
                let name = self.names.enumeration(id);
                quote!(#name)
            }
            Type::Array(id) => {
                let array = self.program.array(id);
                let (element, len) = (self.stored(array.element), number(array.len()));
                quote!([#element; #len])
            }
            Type::Struct(id) => {
                let name = self.names.structure(id);
                quote!(#name)
            }
            Type::Block(id) => rust_path(id.info().rust_path, false),
            Type::Reference(_) => quote!(u64),
        }
    }

    /// The type of a variable that holds a value of `ty`.
    pub fn stored(&self, ty: Type) -> TokenStream {
        let value = self.ty(ty);
        if self.is_in_cell(ty) { quote!(Cell<#value>) } else { value }
    }

    /// Whether a variable of the type is a cell: aggregates have cells inside.
    pub fn is_in_cell(&self, ty: Type) -> bool {
        self.shared
            && match ty {
                Type::Elementary(_)
                | Type::Reference(_)
                | Type::Subrange(..)
                | Type::String(_)
                | Type::Enum(_)
                | Type::Block(_) => true,
                Type::Array(_) | Type::Struct(_) => false,
            }
    }

    /// `.at(FILE, line, column)`, which gives a fault its place.
    pub fn at(&self, at: Location) -> TokenStream {
        let (file, line, column) = (self.names.file(at.file), number(at.line.into()), number(at.column.into()));
        quote!(.at(#file, #line, #column))
    }

    pub fn root_type(&self, routine: &Routine, root: Root) -> Type {
        match root {
            Root::Instance => Type::Struct(routine.state.expect("verified IR: an instance has a state")),
            Root::Globals => Type::Struct(self.program.globals),
            Root::Local(id) => routine.locals[id.index()].ty,
            Root::Param(id) => routine.params[id.index()].ty,
        }
    }

    /// The type before each projection of a place.
    pub fn types_along(&self, routine: &Routine, place: &Place) -> Vec<Type> {
        let mut ty = self.root_type(routine, place.root);
        let mut types = Vec::with_capacity(place.projections.len());
        for projection in &place.projections {
            types.push(ty);
            ty = element(self.program, ty, projection);
        }
        types
    }

    /// The name of a structure's field or a block's pin.
    pub fn field_name(&self, ty: Type, field: FieldId) -> Ident {
        match ty {
            Type::Struct(id) => self.names.field(id, field).clone(),
            Type::Block(id) => ident(id.info().pins[field.index()].field),
            Type::Elementary(_)
            | Type::Reference(_)
            | Type::Subrange(..)
            | Type::String(_)
            | Type::Enum(_)
            | Type::Array(_) => unreachable!("verified IR: only structures and blocks have fields"),
        }
    }

    /// `parking_garage.st:12`.
    pub fn source(&self, at: Location) -> String {
        format!("{}:{}", self.program.files[usize::from(at.file)].path, at.line)
    }
}
