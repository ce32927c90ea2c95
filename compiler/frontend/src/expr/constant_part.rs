//! Members and elements where a constant is wanted: `limits.low`, `table[2]`. What the whole starts with says what they
//! are.

use super::checker::{Checker, Context};
use super::unresolved::not_constant;
use crate::ast::{self, ExprKind as Ast};
use staunch_ir::{Const, Expr, ExprKind, Type, Value};

impl<'s> Checker<'_, 's> {
    /// Whether `expr` names a member of a structure or an element of an array, and a constant is wanted.
    pub(super) fn is_part_of_constant(&self, expr: &ast::Expr<'s>) -> bool {
        if self.context == Context::Body {
            return false;
        }
        match &expr.kind {
            Ast::Member(base, name) => match self.static_type(base) {
                Some(Type::Struct(id)) => !self.decl.is_instance(id) && self.decl.field_named(id, name.text).is_some(),
                _ => false,
            },
            Ast::Index(base, indices) => {
                let mut ty = self.static_type(base);
                indices.iter().all(|_| match ty {
                    Some(Type::Array(id)) => {
                        let array = self.decl.program.array(id);
                        ty = Some(array.element);
                        !array.is_open()
                    }
                    _ => false,
                })
            }
            _ => false,
        }
    }

    pub(super) fn part_of_constant(&mut self, expr: &ast::Expr<'s>) -> Option<Expr> {
        let (Ast::Member(base, _) | Ast::Index(base, _)) = &expr.kind else { return None };
        let whole = self.typed(base, None)?;
        let (mut ty, ExprKind::Aggregate(mut value)) = (whole.ty, whole.kind) else {
            self.report(not_constant(base.span));
            return None;
        };
        match &expr.kind {
            Ast::Member(_, name) => {
                let Type::Struct(id) = ty else { return None };
                let field = self.decl.field_named(id, name.text)?;
                self.decl.note_member(*name, id);
                value = value.part(field.index());
                ty = self.decl.program.structure(id).fields[field.index()].ty;
            }
            Ast::Index(_, indices) => {
                for index in indices {
                    let Type::Array(id) = ty else { return None };
                    value = self.element_of_constant(&value, id, index)?;
                    ty = self.decl.program.array(id).element;
                }
            }
            _ => return None,
        }
        Some(self.constant_value(ty.read(), value, expr.span))
    }

    fn element_of_constant(&mut self, whole: &Const, id: staunch_ir::ArrayId, index: &ast::Expr<'s>) -> Option<Const> {
        let at = self.index_value(index, id)?;
        let Some(at) = at.as_const().and_then(Value::as_integer) else {
            self.report(not_constant(index.span));
            return None;
        };
        let low = i128::from(self.decl.program.array(id).low);
        Some(whole.part(usize::try_from(at - low).ok()?))
    }
}
