//! `.LEN` and `.DATA[i]` of Logix's strings, to be read. A string here has nothing beyond its length, so what a
//! program writes there, to lengthen the string afterwards, has no place: writing is refused.

use super::checker::Checker;
use crate::dialect::Dialect;
use crate::{Code, Diagnostic, Span, ast};
use ast::ExprKind as Ast;
use staunch_ir::{Conversion, Elementary, Expr, ExprKind, Op, TextOp, Type, Value};

impl<'s> Checker<'_, 's> {
    /// The string of which an expression is the member.
    fn text_with<'a>(&self, expr: &'a ast::Expr<'s>, member: &str) -> Option<&'a ast::Expr<'s>> {
        let Ast::Member(text, name) = &expr.kind else { return None };
        let is_it = self.decl.dialect(name.span) == Dialect::Logix && name.text.eq_ignore_ascii_case(member);
        (is_it && matches!(self.static_type(text), Some(Type::String(_)))).then_some(text)
    }

    /// The string whose length an expression is.
    pub(super) fn length_of<'a>(&self, expr: &'a ast::Expr<'s>) -> Option<&'a ast::Expr<'s>> {
        self.text_with(expr, "LEN")
    }

    /// The string and the index of which an expression is a byte.
    pub(super) fn data_of<'a>(&self, expr: &'a ast::Expr<'s>) -> Option<(&'a ast::Expr<'s>, &'a ast::Expr<'s>)> {
        let Ast::Index(data, indices) = &expr.kind else { return None };
        let [index] = indices.as_slice() else { return None };
        Some((self.text_with(data, "DATA")?, index))
    }

    pub(super) fn length_value(&mut self, text: &ast::Expr<'s>, span: Span) -> Option<Expr> {
        let whole = self.typed(text, None)?;
        let at = self.at(span);
        let length = Expr::new(Type::INT, ExprKind::ApplyText(TextOp::Len, vec![whole]), at);
        let length = self.evaluated(length, span)?;
        Some(self.convert(Conversion::Value, Type::DINT, length))
    }

    /// A byte by its distance from the first; beyond the length it is 0, beyond the capacity a fault.
    pub(super) fn data_value(&mut self, text: &ast::Expr<'s>, index: &ast::Expr<'s>) -> Option<Expr> {
        let mut whole = self.typed(text, None)?;
        let last = i64::from(whole.ty.string_type()?.capacity) - 1;
        let position = self.after(&mut [&mut whole], |this| {
            let value = this.integer_index(index)?;
            if let Some(number) = value.as_const().and_then(Value::as_integer)
                && !(0..=i128::from(last)).contains(&number)
            {
                this.report(
                    Diagnostic::new(Code::E0208, index.span, format!("the index {number} is out of range"))
                        .label(format!("the bytes are numbered from 0 to {last}")),
                );
                return None;
            }
            let at = this.at(index.span);
            let value = this.as_lint(value, index.span)?;
            let bound = |it: i64| Expr::constant(Elementary::Lint, Value::I64(it), at);
            this.apply(Op::CheckIndex, Type::LINT, vec![bound(0), value, bound(last)], Type::LINT, index.span)
        })?;
        let at = self.at(index.span);
        let byte = ExprKind::ApplyText(TextOp::CharAt, vec![whole, position]);
        let byte = self.evaluated(Expr::new(Type::Elementary(Elementary::Char), byte, at), index.span)?;
        Some(self.convert(Conversion::Value, Type::Elementary(Elementary::Sint), byte))
    }

    /// What to write for a member of a string that is not a value.
    pub(super) fn help_on_text_member(&self, name: ast::Name<'s>) -> Option<&'static str> {
        let is = |it: &str| name.text.eq_ignore_ascii_case(it);
        match self.decl.dialect(name.span) {
            Dialect::Logix if is("LEN") => {
                Some("`.LEN` is only read here: write `s := LEFT(s, n);`, or assign the text")
            }
            Dialect::Logix if is("DATA") => {
                Some("`.DATA[i]` is only read here: write `s := REPLACE(s, 'x', 1, i + 1);`, or assign the text")
            }
            _ => None,
        }
    }

    /// `s.Length`, as other languages have it: the function that gives it.
    pub(super) fn function_for_length(&self, base: &ast::Expr<'s>, name: ast::Name<'s>, ty: Type) -> Option<String> {
        let text = self.decl.log.sources.text(base.span);
        let is_length = ["Length", "Len", "Size", "Count"].iter().any(|it| name.text.eq_ignore_ascii_case(it));
        match ty {
            _ if !is_length => None,
            Type::String(_) => Some(format!("LEN({text})")),
            Type::Array(_) => Some(format!("UPPER_BOUND({text}, 1)")),
            Type::Elementary(_)
            | Type::Reference(_)
            | Type::Subrange(..)
            | Type::Struct(_)
            | Type::Enum(_)
            | Type::Block(_) => None,
        }
    }
}
