//! Constant expressions.

use super::checker::{Checker, Context};
use super::unresolved::not_constant;
use crate::types::declarations::Declarations;
use crate::types::scope::Scope;
use crate::types::table::Resolved;
use crate::{Code, Diagnostic, ast};
use staunch_ir::{Elementary, Expr, Type};
use std::rc::Rc;

/// The constant `expr`, converted to `target` where there is one; other expressions are refused.
pub(crate) fn constant<'s>(
    decl: &mut Declarations<'s>,
    scope: &Rc<Scope<'s>>,
    expr: &ast::Expr<'s>,
    target: Option<&Resolved>,
) -> Option<Expr> {
    let context = if target.is_some() { Context::Initial } else { Context::Constant };
    let mut checker = Checker::new(decl, scope, context);
    let value = match target {
        Some(target) => checker.value(expr, target.ty)?,
        None => checker.typed(expr, None)?,
    };
    if !is_constant(&value) {
        checker.decl.report(not_constant(expr.span));
        return None;
    }
    Some(value)
}

/// Whether the value is known here.
pub(super) fn is_constant(expr: &Expr) -> bool {
    use staunch_ir::ExprKind;
    match &expr.kind {
        ExprKind::Const(_) | ExprKind::Text(_) | ExprKind::Aggregate(_) => true,
        ExprKind::Load(_)
        | ExprKind::AddressOf(_)
        | ExprKind::Apply(..)
        | ExprKind::ApplyText(..)
        | ExprKind::Convert(..) => false,
    }
}

impl<'s> Declarations<'s> {
    /// A constant whole number: an array bound, a string's length.
    pub fn constant_integer(&mut self, expr: &ast::Expr<'s>, scope: &Rc<Scope<'s>>) -> Option<i128> {
        let value = constant(self, scope, expr, None)?;
        self.whole_number(&value, expr)
    }

    /// The value of an enumerator: a constant that a variable of the enumeration's base type may start with.
    pub fn constant_of(&mut self, expr: &ast::Expr<'s>, base: Elementary, scope: &Rc<Scope<'s>>) -> Option<i128> {
        let value = constant(self, scope, expr, Some(&Resolved::plain(Type::Elementary(base))))?;
        self.whole_number(&value, expr)
    }

    fn whole_number(&mut self, value: &Expr, expr: &ast::Expr<'s>) -> Option<i128> {
        let number = value.as_const().and_then(staunch_ir::Value::as_integer);
        if number.is_none() || value.ty == Type::BOOL {
            self.report(
                Diagnostic::new(Code::E0201, expr.span, "a whole number is expected here")
                    .label(format!("this is {}", self.program.type_name(value.ty))),
            );
            return None;
        }
        number
    }
}
