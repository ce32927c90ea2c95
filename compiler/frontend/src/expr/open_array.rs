//! `ARRAY[*]`: its bounds, and the arrays that a call gives for it.

use super::argument::{Part, Parts, Role, Source};
use super::checker::Checker;
use super::operand::Operand;
use super::order::Held;
use crate::diagnostic::wording::article;
use crate::names::Sense;
use crate::types::signature::Formal;
use crate::types::table::Resolved;
use crate::{Code, Diagnostic, Span, ast};
use ast::{ArgumentKind, ExprKind as Ast};
use staunch_ir::{Array, Const, Elementary, Expr, LocalId, Place, Root, Type, Value, shapes};

/// An end of an array's bounds.
#[derive(Clone, Copy)]
enum End {
    Lower,
    Upper,
}

fn end(name: &str) -> Option<End> {
    let functions = [("LOWER_BOUND", End::Lower), ("UPPER_BOUND", End::Upper)];
    functions.into_iter().find(|(it, _)| it.eq_ignore_ascii_case(name)).map(|(_, it)| it)
}

impl<'s> Checker<'_, 's> {
    /// `LOWER_BOUND(a, 1)`, a DINT; `None` where `callee` is something else.
    pub(crate) fn bound_function(
        &mut self,
        callee: &ast::Expr<'s>,
        arguments: &[ast::Argument<'s>],
        span: Span,
    ) -> Option<Option<Operand>> {
        let Ast::Name(name) = &callee.kind else { return None };
        let end = end(name.text)?;
        if self.means_anything(&[*name], Sense::Callee) {
            return None;
        }
        let value = |at: usize, parameter: &str| match &arguments.get(at)?.kind {
            ArgumentKind::Positional(it) => Some(it),
            ArgumentKind::Input(name, it) => name.text.eq_ignore_ascii_case(parameter).then_some(it),
            ArgumentKind::Output { .. } => None,
        };
        let (Some(array), Some(dimension), 2) = (value(0, "ARR"), value(1, "DIM"), arguments.len()) else {
            self.report(
                Diagnostic::new(Code::E0302, span, format!("`{}` takes 2 arguments", name.text))
                    .label("expected an array, and the number of one of its dimensions")
                    .note("they are ARR, DIM"),
            );
            return Some(None);
        };
        Some(self.bound(end, array, dimension, span).map(Operand::Typed))
    }

    fn bound(&mut self, end: End, array: &ast::Expr<'s>, dimension: &ast::Expr<'s>, span: Span) -> Option<Expr> {
        let found = self.place(array)?.place;
        let Type::Array(id) = found.ty else {
            let ty = self.type_name(found.ty);
            let message = format!("expected an array, but this is {ty}");
            self.report(Diagnostic::new(Code::E0201, array.span, message).label("expected an array"));
            return None;
        };
        let at = self.at(span);
        let number = self.dimension(found.ty, dimension)?;
        if self.decl.program.array(id).is_open() {
            // A part of such an array has the dimensions that are left.
            let (low, high) = *self.bounds_of(found.root).get(found.projections.len() + number)?;
            let local = match end {
                End::Lower => low,
                End::Upper => high,
            };
            return Some(Expr::load(Place::local(local, Type::DINT), at));
        }
        let array = self.dimensions(found.ty)[number];
        let bound = match end {
            End::Lower => array.low,
            End::Upper => array.high,
        };
        let Ok(value) = i32::try_from(bound) else {
            self.error(Code::E0202, span, format!("the bound {bound} does not fit DINT"));
            return None;
        };
        Some(Expr::constant(Elementary::Dint, Value::I32(value), at))
    }

    /// The position of a dimension, from 0.
    fn dimension(&mut self, array: Type, expr: &ast::Expr<'s>) -> Option<usize> {
        let count = self.dimensions(array).len();
        let value = self.typed(expr, Some(Type::DINT))?;
        let Some(number) = value.as_const().and_then(Value::as_integer) else {
            self.decl.not_supported(expr.span, "a dimension that is not a constant");
            return None;
        };
        let position = usize::try_from(number - 1).ok().filter(|it| *it < count);
        if position.is_none() {
            let dimensions = if count == 1 { "1 dimension".to_owned() } else { format!("{count} dimensions") };
            self.report(
                Diagnostic::new(Code::E0208, expr.span, format!("the array has no dimension {number}"))
                    .label(format!("it has {dimensions}, the first is 1")),
            );
        }
        position
    }

    fn dimensions(&self, mut ty: Type) -> Vec<Array> {
        let mut dimensions = Vec::new();
        while let Type::Array(id) = ty {
            dimensions.push(self.decl.program.array(id));
            ty = self.decl.program.array(id).element;
        }
        dimensions
    }

    /// The locals for the bounds of a parameter that is an `ARRAY[*]`.
    pub(crate) fn bounds_of(&self, root: Root) -> Vec<(LocalId, LocalId)> {
        let (Root::Param(id), Some(signature)) = (root, &self.signature) else { return Vec::new() };
        signature.params[id.index()].bounds.clone()
    }

    /// Whether `given` may be passed for `formal`: an `ARRAY[*]` takes arrays of its elements.
    pub(crate) fn takes(&mut self, formal: &Formal<'s>, given: Type, span: Span) -> Option<()> {
        if !shapes::fits(&self.decl.program, formal.resolved.ty, given) {
            self.report_other_array(formal, given, span);
            return None;
        }
        let is_dint = |it: i64| i32::try_from(it).is_ok();
        let wide = self.dimensions(given).into_iter().find(|it| !(it.is_open() || is_dint(it.low) && is_dint(it.high)));
        if let Some(wide) = wide {
            let message = format!("the bounds {}..{} do not fit DINT", wide.low, wide.high);
            self.error(Code::E0202, span, message);
            return None;
        }
        Some(())
    }

    fn report_other_array(&mut self, formal: &Formal<'s>, given: Type, span: Span) {
        let (wants, has) = (self.type_name(formal.resolved.ty), self.type_name(given));
        let message = format!("`{}` is {}, found {has}", formal.name.text, article(&wants));
        self.report(
            Diagnostic::new(Code::E0201, span, message)
                .label("it takes an array with the same element type and number of dimensions")
                .other(formal.name.span, "declared here"),
        );
    }

    /// Evaluates the next part, what is given for an input that is an `ARRAY[*]`: it is copied.
    pub(crate) fn open_input_part(
        &mut self,
        parts: &mut Parts,
        formal: &Formal<'s>,
        parameter: usize,
        expr: &ast::Expr<'s>,
    ) -> Option<()> {
        let given = self.after_parts(&mut parts.written, |this| {
            let value = this.typed(expr, None)?;
            this.takes(formal, value.ty, expr.span)?;
            let copy = this.temporary(formal.name.text, value.ty);
            this.assign(copy.clone(), value, expr.span);
            Some(copy)
        })?;
        parts.push(Held::Place(given), Role::Passed(parameter), expr.span);
        Some(())
    }

    /// Evaluates the next part, what an output that is an `ARRAY[*]` is connected with; and the storage that
    /// the FUNCTION gets for it, with its elements at their initial values.
    pub(crate) fn open_output_part(
        &mut self,
        parts: &mut Parts,
        formal: &Formal<'s>,
        target: &ast::Expr<'s>,
        negated: bool,
    ) -> Option<Place> {
        let unknown = Source::Variable(Place::root(Root::Globals, formal.resolved.ty));
        self.target_part(parts, target, negated, unknown)?;
        let ty = parts.written.last()?.place()?.ty;
        self.takes(formal, ty, target.span)?;
        if self.decl.program.is_open(ty) {
            self.decl.not_supported(target.span, "an ARRAY[*] for an output");
            return None;
        }
        let storage = self.temporary(formal.name.text, ty);
        if let Some(Part { role: Role::Target(source, ..), .. }) = parts.parts.last_mut() {
            *source = Source::Variable(storage.clone());
        }
        let initial = self.initial_value(&Resolved { ty, initial: self.initial_elements(ty) }, target.span);
        self.assign(storage.clone(), initial, target.span);
        Some(storage)
    }

    fn initial_elements(&self, ty: Type) -> Const {
        let Type::Array(id) = ty else { return Const::Zero };
        let (count, element) = (self.decl.program.array(id).len(), &self.decl.table.elements[id.index()]);
        match &element.initial {
            Const::Zero => Const::Zero,
            other => Const::Array(vec![(count, other.clone())]),
        }
    }
}
