//! Expressions: each becomes an operand, which may take the type that its place asks for.

use super::checker::{Checker, Context};
use super::method::is_this;
use super::operand::{Operand, computed};
use super::place::{Access, Found};
use crate::diagnostic::Missing;
use crate::types::scope::Variable;
use crate::types::window::Window;
use crate::{Code, Diagnostic, Span, ast};
use ast::{ExprKind as Ast, UnaryOp};
use staunch_ir::{Chars, Const, Conversion, Elementary, Expr, ExprKind, Op, RefKind, Root, Section, Type};
use staunch_runtime::Class;

impl<'s> Checker<'_, 's> {
    /// Types an expression. `expected` is what its place asks for; only literals, bare
    /// enumerators and overloaded functions listen to it.
    pub(crate) fn operand(&mut self, expr: &ast::Expr<'s>, expected: Option<Type>) -> Option<Operand> {
        let operand = match &expr.kind {
            Ast::Literal(literal) => self.literal(literal, expected, expr.span),
            Ast::Paren(inner) => self.operand(inner, expected),
            Ast::Name(name) => self.name(*name, expected).map(Operand::Typed),
            Ast::Member(..) | Ast::Index(..) if self.is_part_of_constant(expr) => {
                self.part_of_constant(expr).map(Operand::Typed)
            }
            Ast::Member(..) => self.member_value(expr).map(Operand::Typed),
            Ast::Address(_) | Ast::Index(..) => match (self.character_of(expr), self.data_of(expr)) {
                (Some((text, index)), _) => self.character_value(text, index).map(Operand::Typed),
                (None, Some((text, index))) => self.data_value(text, index).map(Operand::Typed),
                (None, None) => self.load(expr).map(Operand::Typed),
            },
            Ast::Part(base, part) => self.part(base, *part).map(Operand::Typed),
            Ast::Deref(_) => self.load(expr).map(Operand::Typed),
            Ast::Call(callee, arguments) => {
                let value = self.call_value(expr, callee, arguments, expected)?;
                self.referred_result(value, expected, expr.span)
            }
            Ast::Error(parts) => {
                parts.iter().for_each(|it| drop(self.operand(it, None)));
                None
            }
            Ast::Assign(sides, sign) => self.assigned_value(sides, *sign, expected, expr.span).map(Operand::Typed),
            Ast::Unary(op, inner) => self.unary(*op, inner, expected, expr.span),
            Ast::Binary(sides, op, op_span) => self.binary(sides, *op, *op_span, expected, expr.span),
        }?;
        self.note_written(expr, &operand);
        Some(operand.read())
    }

    /// A BOOL, for IF, WHILE, UNTIL.
    pub(crate) fn condition(&mut self, expr: &ast::Expr<'s>) -> Option<Expr> {
        let value = self.operand(expr, Some(Type::BOOL))?;
        if let Some(found) = value.ty()
            && found != Type::BOOL
        {
            let name = self.type_name(found);
            let text = self.decl.log.sources.text(expr.span).to_owned();
            if let Ast::Assign(sides, sign) = &expr.bare().kind {
                self.report_assignment(sides, *sign);
                return None;
            }
            let mut error =
                Diagnostic::new(Code::E0507, expr.span, format!("a condition must be a BOOL, but this is {name}"))
                    .label("expected BOOL");
            if matches!(found, Type::Elementary(it) if it.repr().is_integer()) && !text.contains(' ') {
                error = error.help(format!("compare it: `{text} <> 0`")).fix(expr.span, format!("{text} <> 0"));
            } else if let Type::Block(id) = found
                && id.info().pin("Q").is_some()
            {
                error = error.help(format!("use its output: `{text}.Q`")).fix(expr.span, format!("{text}.Q"));
            }
            self.report(error);
            return None;
        }
        if let Ast::Assign(sides, sign) = &expr.bare().kind {
            self.doubt_assignment(sides, *sign);
        }
        self.coerce(value, Type::BOOL, expr.span)
    }

    fn name(&mut self, name: ast::Name<'s>, expected: Option<Type>) -> Option<Expr> {
        if self.is_null(name) {
            return Some(self.null(expected, name.span));
        }
        let own = ast::Expr { kind: Ast::Name(name), span: name.span };
        if self.property(&own).is_some() {
            return self.load(&own);
        }
        if self.is_in_its_type(name)
            && let Some(value) = self.bare_enumerator(name, expected)
        {
            return value;
        }
        if let Some(found) = self.find_variable(name) {
            let variable = found?;
            return self.variable_value(&variable, name.span);
        }
        if let Some(value) = self.bare_enumerator(name, expected) {
            return value;
        }
        if is_this(&own) && self.decl.dialect(name.span).binds_by_assignment() && !self.is_this_of_program(&own) {
            return self.reference_to(&own, RefKind::PointerTo);
        }
        self.unknown_name(name, Missing::Variable);
        None
    }

    fn variable_value(&mut self, variable: &Variable<'s>, span: Span) -> Option<Expr> {
        if let Some(value) = variable.constant_value() {
            return self.constant_variable(variable, value, span);
        }
        let is_given = match variable.place.root {
            Root::Local(_) => variable.section == Section::Input,
            Root::Param(_) => true,
            Root::Instance | Root::Globals => false,
        };
        if self.context == Context::Initial && is_given {
            let error = super::unresolved::not_constant(span);
            let what = format!("each call gives `{}` its value", variable.name.text);
            self.report(error.other(variable.name.span, what).help("assign it at the start of the body"));
            return None;
        }
        if self.context == Context::Initial {
            let initial = variable.resolved.initial.clone();
            return self.constant_variable(variable, initial, span);
        }
        if self.signature.is_none() {
            self.report(
                super::unresolved::not_constant(span)
                    .other(variable.name.span, format!("`{}` is a variable", variable.name.text))
                    .help("declare it in VAR CONSTANT"),
            );
            return None;
        }
        let (place, view) = self.decl.image.stored(&variable.place);
        let view = view.map(Window::from);
        let found = self.referred(Found { place, view, access: Access::Write }, span)?;
        self.read(found.place, found.view, span)
    }

    /// Reads a CONSTANT: a scalar is its value, so that it can size an array or label a CASE.
    fn constant_variable(&mut self, variable: &Variable<'s>, value: Const, span: Span) -> Option<Expr> {
        let ty = variable.resolved.ty.read();
        Some(match value {
            Const::Zero | Const::Array(_) | Const::Struct(_)
                if self.context == Context::Body && self.decl.program.repr(ty).is_none() =>
            {
                let at = self.at(span);
                match ty {
                    Type::String(it) => Expr::new(ty, ExprKind::Text(Chars::empty(it)), at),
                    _ => Expr::new(ty, ExprKind::Load(self.decl.image.stored(&variable.place).0), at),
                }
            }
            value => self.constant_value(ty, value, span),
        })
    }

    /// A value that is known.
    pub(super) fn constant_value(&mut self, ty: Type, value: Const, span: Span) -> Expr {
        let kind = match (value, self.decl.program.repr(ty), ty) {
            (Const::Scalar(value), _, _) => ExprKind::Const(value),
            (Const::Zero, Some(repr), _) => ExprKind::Const(repr.zero()),
            (Const::Text(text), _, _) => ExprKind::Text(text),
            (Const::Zero, None, Type::String(it)) => ExprKind::Text(Chars::empty(it)),
            (whole @ (Const::Zero | Const::Array(_) | Const::Struct(_)), _, _) => ExprKind::Aggregate(whole),
        };
        Expr::new(ty, kind, self.at(span))
    }

    /// `a.b`, or the enumerator `Color.Red`.
    fn member_value(&mut self, expr: &ast::Expr<'s>) -> Option<Expr> {
        if let Some(path) = self.path_of_enumerator(expr) {
            return self.enumerator(&path);
        }
        if let Some(variable) = self.global_of_namespace(expr) {
            let variable = variable?;
            return self.variable_value(&variable, expr.span);
        }
        if let Some(constant) = self.constant_of_pou(expr) {
            let constant = constant?;
            return self.variable_value(&constant, expr.span);
        }
        match self.length_of(expr) {
            Some(text) => self.length_value(text, expr.span),
            None => self.load(expr),
        }
    }

    fn load(&mut self, expr: &ast::Expr<'s>) -> Option<Expr> {
        let found = self.place_or_view(expr)?;
        if self.signature.is_none() {
            self.report(self.not_constant_here(expr.span));
            return None;
        }
        self.read(found.place, found.view, expr.span)
    }

    /// `x.3`, `x.%X3`, `x.%B1`: a part of an integer or bit string.
    fn part(&mut self, base: &ast::Expr<'s>, part: ast::Name<'s>) -> Option<Expr> {
        let value = self.typed(base, None)?;
        let part = self.find_part(value.ty, part)?;
        self.bits(value, part.bits(), Type::Elementary(part.ty), base.span)
    }

    fn unary(&mut self, op: UnaryOp, inner: &ast::Expr<'s>, expected: Option<Type>, span: Span) -> Option<Operand> {
        // The sign of `INT#-5` is inside the literal: it is of the value that has to fit.
        if let (UnaryOp::Neg, Ast::Literal(literal)) = (op, &inner.kind)
            && inner.span == span
            && let Some(prefix) = &literal.prefix
        {
            return self.negative_literal(**prefix, &literal.value, span).map(Operand::Typed);
        }
        let operand = self.operand(inner, expected)?;
        match op {
            UnaryOp::Plus => {}
            UnaryOp::Neg => self.note_operator("NEG", &[&operand], span),
            UnaryOp::Not => self.note_operator("NOT", &[&operand], span),
        }
        match (op, operand) {
            (UnaryOp::Plus, operand) => Some(operand),
            (UnaryOp::Neg, operand) if operand.typed().is_some() => self.negate(operand, span),
            (UnaryOp::Neg, number) => Some(number.negated()),
            (UnaryOp::Not, Operand::Integer(number)) if self.has_functions_of_strucpp(inner.span) => {
                Some(Operand::Integer(i128::from(number == 0)))
            }
            (UnaryOp::Not, operand) if self.negates_as_bool(inner) => self.is_zero(operand, expected, inner.span),
            (UnaryOp::Not, operand) => self.complement(operand, expected, inner.span),
        }
    }

    fn negate(&mut self, operand: Operand, span: Span) -> Option<Operand> {
        let own = operand.ty()?;
        let value = self.materialise(operand, None, span)?;
        let value = self.promote(value, span);
        let value = if self.decl.dialect(span).mixes_bits_and_integers() { self.signed(value) } else { value };
        let ty = value.ty;
        let numeric = matches!(ty, Type::Elementary(it) if it.is(Class::Magnitude));
        if !numeric {
            let found = self.type_name(ty);
            self.report(
                Diagnostic::new(Code::E0204, span, format!("`-` needs a number or a TIME, but this is {found}"))
                    .label(format!("this is {found}")),
            );
            return None;
        }
        let value = match ty {
            Type::Elementary(it) if it.is_duration() => self.negative_duration(value, span)?,
            _ => self.apply(Op::Neg, ty, vec![value], ty, span)?,
        };
        Some(computed(value, own))
    }

    /// Where bit strings count as numbers, the negative of one needs a sign.
    fn signed(&mut self, value: Expr) -> Expr {
        let signed = match value.ty {
            Type::Elementary(Elementary::Dword | Elementary::Lword) => Type::LINT,
            _ => return value,
        };
        self.convert(Conversion::Value, signed, value)
    }
}
