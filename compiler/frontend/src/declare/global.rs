//! Global variables, and the structure that holds them.

use super::specs::Within;
use crate::names::SpaceId;
use crate::types::declarations::{Declarations, GlobalSlot};
use crate::types::scope::{Scope, Variable};
use crate::types::table::{GLOBALS, Resolved};
use staunch_ir::{Field, Location, Place, Root, Struct, StructId, Type};
use std::rc::Rc;

impl<'s> Declarations<'s> {
    pub(super) fn global_variable(&mut self, at: usize) -> Option<Variable<'s>> {
        let GlobalSlot { name, block, decl, .. } = self.globals[at];
        let reported = self.log.diagnostics.len();
        let resolved = self.declared_type(decl, &Rc::new(Scope::default()), name.text, Within::Program)?;
        if block.constant.is_some() && self.log.has_errors_since(reported) {
            return None;
        }
        self.check_retain(block, resolved.ty, name);
        let place = match self.addresses.field_of_global(at) {
            Some(field) => {
                self.check_address_here(None, block, decl);
                self.register_address(None, block, decl, &resolved);
                let field = staunch_ir::FieldId::next(field);
                Place::root(Root::Globals, Type::Struct(GLOBALS)).field(field, resolved.ty)
            }
            None => self.located(None, block, decl, name, &resolved)??,
        };
        Some(self.variable(name, block, Some(decl), Rc::new(resolved), place))
    }

    /// Makes the globals' structure, so that places in bodies have their types.
    pub(super) fn declare_globals(&mut self) {
        let mut fields = self.global_fields();
        fields.iter_mut().for_each(|it| self.addresses.complete(it));
        let names: Vec<_> = fields.iter().map(|it| it.name.clone()).collect();
        self.settle_image(&mut fields);
        let mut aliases: Vec<_> = (0..self.globals.len()).filter_map(|at| self.alias(at)).collect();
        aliases.extend(self.views(&names));
        self.program.aliases = aliases;
        self.program.global_paths = (0..self.globals.len()).filter_map(|at| self.global_path(at)).collect();
        self.program.globals = StructId::next(self.program.structs.len());
        let location = Location::default();
        self.program.structs.push(Struct::new("Globals".to_owned(), None, location, fields));
    }

    /// What a global variable is called among the fields, and in full, where that says where it is.
    fn global_path(&self, at: usize) -> Option<(String, String)> {
        let GlobalSlot { name, space, .. } = &self.globals[at];
        (*space != SpaceId::ROOT).then(|| (self.global_field_name(at), self.names.in_full(*space, name.text)))
    }

    fn global_fields(&mut self) -> Vec<Field> {
        let fields: Vec<_> = (0..self.globals.len()).filter_map(|at| self.global_field(at)).collect();
        fields.into_iter().chain(self.synthetic.fields()).collect()
    }

    fn global_field(&mut self, at: usize) -> Option<Field> {
        self.addresses.field_of_global(at)?;
        // One that was refused keeps its place: the numbers of the others are by it.
        let refused = || Rc::new(Resolved::plain(Type::BOOL));
        let resolved = self.global(at).map_or_else(refused, |it| Rc::clone(&it.resolved));
        let GlobalSlot { name, block, decl, .. } = self.globals[at];
        let field = self.field(name, &resolved, block, decl);
        Some(Field { name: self.global_field_name(at), ..field })
    }

    /// The global in slot `at`, if it is another name of an earlier one's address.
    fn alias(&mut self, at: usize) -> Option<staunch_ir::Variable> {
        if self.addresses.field_of_global(at).is_some() {
            return None;
        }
        let variable = self.global(at)?;
        let (place, view) = self.image.stored(&variable.place);
        Some(staunch_ir::Variable { name: self.global_field_name(at), section: variable.section, place, view })
    }
}
