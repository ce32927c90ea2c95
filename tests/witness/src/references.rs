//! References: a cell that holds the place it leads to. Where it leads nowhere, the fault is at the access and not
//! where the place is found: `p^ := f()` calls `f` first.

use crate::classes::{is_super, is_this};
use crate::machine::{Frame, Machine, Outcome, unknown};
use crate::statements::Flow;
use crate::storage::{Cell, Place, Value};
use crate::types::{RefKind, Reference, Type};
use staunch_frontend::Span;
use staunch_frontend::ast::{Argument, ArgumentKind, BinaryOp, Expr, ExprKind, Literal, LiteralValue};
use staunch_runtime::FaultKind;

impl<'a> Machine<'a> {
    /// Where a reference leads; a place that faults when it is used, if that is nowhere.
    pub(crate) fn followed(&mut self, cell: Cell<'a>, reference: Reference<'a>, span: Span) -> Outcome<Place<'a>> {
        match cell {
            Cell::Reference(Some(mut place)) => {
                if let (RefKind::Pointer | RefKind::Alias, Some(target)) = (reference.kind, reference.target) {
                    let declared = self.declared.type_of(target)?;
                    if !declared.looks_like(&place.ty) {
                        return unknown("a reference to what has another type");
                    }
                    place.declared = declared.class();
                }
                let seen = self.memory.get(place.at..place.at + place.ty.size()).unwrap_or_default();
                if seen.iter().any(|it| matches!(it, Cell::Text(text) if text.contains(&0))) {
                    // A reference sees a text up to its first zero, which its name does not.
                    return unknown("a text with a zero in it, by a reference");
                }
                if self.is_deleted(&place) {
                    place.nowhere = Some((span, FaultKind::Deleted));
                }
                Ok(*place)
            }
            _ => match reference.target {
                Some(target) => {
                    let ty = match reference.kind {
                        RefKind::Interface => self.declared.implementer(target)?,
                        RefKind::Pointer | RefKind::Alias => self.declared.type_of(target)?,
                    };
                    Ok(Place {
                        at: 0,
                        ty,
                        nowhere: Some((span, FaultKind::NullReference)),
                        declared: None,
                        window: None,
                        character: None,
                    })
                }
                None => unknown("a reference to nothing"),
            },
        }
    }

    /// The place, if it is somewhere.
    pub(crate) fn checked(&self, place: Place<'a>) -> Outcome<Place<'a>> {
        match place.nowhere {
            Some((span, kind)) => Err(self.fault(kind, span)),
            None => Ok(place),
        }
    }

    /// `p^`
    pub(crate) fn dereferenced(&mut self, frame: &Frame<'a>, inner: &'a Expr<'a>, span: Span) -> Outcome<Place<'a>> {
        let value = self.value(frame, inner, None)?;
        match &value.ty {
            Type::Reference(it) => {
                let cell = value.cells[0].clone();
                self.followed(cell, *it, span)
            }
            _ => unknown("^ after something other than a reference"),
        }
    }

    /// The value for a variable that is a reference.
    pub(crate) fn reference_value(
        &mut self,
        frame: &Frame<'a>,
        expr: &'a Expr<'a>,
        to: &Type<'a>,
    ) -> Outcome<Value<'a>> {
        let cell = match &expr.kind {
            ExprKind::Paren(inner) => return self.reference_value(frame, inner, to),
            _ if is_null(expr) => Cell::Reference(None),
            _ => match self.named_place(frame, expr)? {
                Some(place) => match place.ty {
                    Type::Reference(_) => {
                        let place = self.checked(place)?;
                        self.memory[place.at].clone()
                    }
                    // `i := p^` goes where `p` leads, and is not an access.
                    _ => Cell::Reference(Some(Box::new(place)).filter(|it| it.nowhere.is_none())),
                },
                None => {
                    let value = self.value(frame, expr, None)?;
                    match &value.ty {
                        Type::Reference(_) => value.cells[0].clone(),
                        _ => return unknown("this value of a reference"),
                    }
                }
            },
        };
        Ok(Value { ty: to.clone(), cells: vec![cell] })
    }

    /// The variable that an expression is, a reference itself and not what it leads to.
    fn named_place(&mut self, frame: &Frame<'a>, expr: &'a Expr<'a>) -> Outcome<Option<Place<'a>>> {
        if self.is_variable(frame, expr)? { self.unfollowed(frame, expr).map(Some) } else { Ok(None) }
    }

    /// Whether an expression is a variable, or a part of one.
    pub(crate) fn is_variable(&mut self, frame: &Frame<'a>, expr: &'a Expr<'a>) -> Outcome<bool> {
        let is_place = match &expr.kind {
            ExprKind::Name(name) => self.variable(frame, name).is_some(),
            ExprKind::Deref(inner) => is_this(inner) || !is_super(inner),
            ExprKind::Member(..) | ExprKind::Index(..) => true,
            _ => false,
        };
        Ok(is_place && self.property(frame, expr)?.is_none())
    }

    /// `r REF= x`
    pub(crate) fn bind(&mut self, frame: &Frame<'a>, target: &'a Expr<'a>, value: &'a Expr<'a>) -> Outcome<Flow<'a>> {
        let target = self.unfollowed(frame, target)?;
        let value = self.reference_value(frame, value, &target.ty)?;
        let target = self.checked(target)?;
        self.write(&target, &value);
        Ok(Flow::Next)
    }

    /// `a ?= b`: `b`, where it leads to what `a` may refer to; else nothing.
    pub(crate) fn attempt(
        &mut self,
        frame: &Frame<'a>,
        target: &'a Expr<'a>,
        value: &'a Expr<'a>,
    ) -> Outcome<Flow<'a>> {
        let target = self.unfollowed(frame, target)?;
        let Type::Reference(reference) = target.ty else { return unknown("?= to something other than a reference") };
        let value = self.reference_value(frame, value, &target.ty)?;
        let target = self.checked(target)?;
        let cell = self.attempted(&value, reference)?;
        self.memory[target.at] = cell;
        Ok(Flow::Next)
    }

    fn attempted(&self, value: &Value<'a>, reference: Reference<'a>) -> Outcome<Cell<'a>> {
        let target = reference.target.and_then(|it| self.declared.pou_named(crate::declarations::path_of(it)));
        let Some(target) = target else { return unknown("?= to a type without a name") };
        let Cell::Reference(to) = &value.cells[0] else { return unknown("?= of something other than a reference") };
        let fits = |it: &Place<'a>| it.ty.class().is_some_and(|it| self.declared.is_a(it, target));
        Ok(Cell::Reference(to.clone().filter(|it| fits(it))))
    }

    /// REF, ADR and the tests of references; `None` for another function.
    pub(crate) fn reference_function(
        &mut self,
        frame: &Frame<'a>,
        name: &str,
        arguments: &'a [Argument<'a>],
        span: Span,
    ) -> Outcome<Option<Value<'a>>> {
        let positional = |at: usize| match arguments.get(at).map(|it| &it.kind) {
            Some(ArgumentKind::Positional(it)) => Ok(it),
            _ => unknown("an argument of a reference's function"),
        };
        match name {
            "REF" | "ADR" => {
                let place = self.place(frame, positional(0)?)?;
                let ty = Type::Reference(Reference { kind: RefKind::Pointer, target: None });
                Ok(Some(Value { ty, cells: vec![Cell::Reference(Some(Box::new(place)))] }))
            }
            "__NEW" if arguments.len() == 1 => self.make(frame, positional(0)?).map(Some),
            "__DELETE" => self.delete(frame, positional(0)?, span).map(|()| Some(Value::bool(true))),
            "__ISVALIDREF" => {
                let place = self.unfollowed(frame, positional(0)?)?;
                let place = self.checked(place)?;
                if !matches!(place.ty, Type::Reference(_)) {
                    // An in-out is always there.
                    return Ok(Some(Value::bool(true)));
                }
                Ok(Some(Value::bool(matches!(self.memory[place.at], Cell::Reference(Some(_))))))
            }
            "__QUERYINTERFACE" => {
                let any = Type::Reference(Reference { kind: RefKind::Interface, target: None });
                let value = self.reference_value(frame, positional(0)?, &any)?;
                let target = self.unfollowed(frame, positional(1)?)?;
                let Type::Reference(reference) = target.ty else { return unknown("this __QUERYINTERFACE") };
                let target = self.checked(target)?;
                let cell = self.attempted(&value, reference)?;
                let found = matches!(cell, Cell::Reference(Some(_)));
                self.memory[target.at] = cell;
                Ok(Some(Value::bool(found)))
            }
            _ => Ok(None),
        }
    }

    /// `p = q`: whether they lead to the same place.
    pub(crate) fn same_place(&self, op: BinaryOp, a: &Value<'a>, b: &Value<'a>) -> Outcome<Value<'a>> {
        // Two instances may begin at one place, of which one is in the other; addresses are the same then.
        let of_interface = |it: &Value<'a>| matches!(&it.ty, Type::Reference(it) if it.kind == RefKind::Interface);
        let are_instances = of_interface(a) && of_interface(b);
        let at = |it: &Value<'a>| match &it.cells[0] {
            Cell::Reference(to) => Ok(to.as_ref().map(|it| (it.at, it.ty.class().filter(|_| are_instances)))),
            _ => unknown("a reference with an operand that is not a reference"),
        };
        match op {
            BinaryOp::Eq => Ok(Value::bool(at(a)? == at(b)?)),
            BinaryOp::Ne => Ok(Value::bool(at(a)? != at(b)?)),
            _ => unknown("this operator on references"),
        }
    }
}

/// A reference to nothing.
pub(crate) fn null<'a>() -> Value<'a> {
    let ty = Type::Reference(Reference { kind: RefKind::Pointer, target: None });
    Value { ty, cells: vec![Cell::Reference(None)] }
}

pub(crate) fn is_null(expr: &Expr<'_>) -> bool {
    match &expr.kind {
        ExprKind::Literal(Literal { prefix: None, value: LiteralValue::Integer { value, .. } }) => *value == 0,
        ExprKind::Name(name) => name.text.eq_ignore_ascii_case("NULL"),
        _ => false,
    }
}
