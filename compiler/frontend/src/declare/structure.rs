//! Structures.

use crate::ast;
use crate::types::declarations::Declarations;
use crate::types::scope::Scope;
use crate::types::table::{Resolved, struct_initial};
use crate::{Code, Diagnostic, Span};
use staunch_ir::{Field, Struct, StructId, Type};
use std::rc::Rc;

impl<'s> Declarations<'s> {
    /// The structure that another one EXTENDS.
    pub(super) fn base_structure(&mut self, path: &'s [ast::Name<'s>]) -> Option<StructId> {
        let name = path.last()?;
        let span = path.first()?.span.to(name.span);
        let ty = self.resolve_path(path, span)?.ty;
        match ty {
            Type::Struct(id) if !self.is_instance(id) => Some(id),
            Type::Elementary(_)
            | Type::Subrange(..)
            | Type::Reference(_)
            | Type::String(_)
            | Type::Enum(_)
            | Type::Array(_)
            | Type::Struct(_)
            | Type::Block(_) => {
                let label = format!("this is {}", self.program.type_name(ty));
                self.report(Diagnostic::new(Code::E0102, span, "a structure EXTENDS a structure").label(label));
                None
            }
        }
    }

    pub(super) fn report_no_structure(&mut self, base: &[ast::Name<'s>]) {
        if let Some(name) = base.last() {
            self.report(
                Diagnostic::new(Code::E0403, name.span, "only a structure EXTENDS another type")
                    .label("what is declared here is no structure"),
            );
        }
    }

    /// Members that a base has already are reported; those it has come first.
    fn inherited(&mut self, base: StructId, members: &'s [ast::VarDecl<'s>]) -> Vec<Field> {
        for member in members.iter().flat_map(|it| &it.names) {
            if self.field_named(base, member.text).is_some() {
                let base = self.program.structure(base).name.clone();
                self.report(
                    Diagnostic::new(Code::E0103, member.span, format!("`{}` is declared twice", member.text))
                        .label(format!("`{base}`, which this structure EXTENDS, has it already")),
                );
            }
        }
        self.program.structure(base).fields.clone()
    }

    pub(super) fn structure(
        &mut self,
        members: &'s [ast::VarDecl<'s>],
        base: Option<StructId>,
        scope: &Rc<Scope<'s>>,
        name: &str,
        doc: Option<String>,
        span: Span,
    ) -> Option<Resolved> {
        for address in members.iter().filter(|_| base.is_some()).filter_map(|it| it.address) {
            self.not_supported(address.span, "the location of a member in a structure that EXTENDS another");
        }
        let block = ast::VarBlock::new(ast::VarKind::Var, span);
        let mut seen = Scope::default();
        let mut fields = base.map_or_else(Vec::new, |it| self.inherited(it, members));
        let mut complete = true;
        for decl in members {
            let owner = decl.names.first().map_or(name, |it| it.text);
            let Some(resolved) = self.declared_type(decl, scope, owner).map(Rc::new) else {
                complete = false;
                continue;
            };
            for member in &decl.names {
                let place = staunch_ir::Place::root(staunch_ir::Root::Instance, resolved.ty);
                let variable = self.variable(*member, &block, Rc::clone(&resolved), place);
                fields.push(self.field(*member, &resolved, &block, decl));
                self.enter_variable(&mut seen, variable);
            }
        }
        if fields.is_empty() && complete {
            self.error(Code::E0408, span, "a structure has at least one member");
            return None;
        }
        // A member that was refused has no field.
        let has_all = complete && base.is_none();
        let extent = if has_all { self.relative_extent(members, &fields) } else { None };
        let initial = struct_initial(&fields);
        let location = self.location(span);
        let id = self.push_struct(Struct { name: name.to_owned(), doc, location, fields });
        self.table.relative.extend(extent.map(|it| (id, it)));
        complete.then_some(Resolved { ty: Type::Struct(id), initial })
    }
}
