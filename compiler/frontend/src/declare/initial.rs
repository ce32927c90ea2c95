//! Initial values, folded to constants.

use super::specs::MAX_SIZE;
use crate::ast::{self, InitialKind};
use crate::expr::constant::constant;
use crate::expr::unresolved::not_constant;
use crate::lex::index;
use crate::names::{Entry, Found, Meaning, Sense, functions};
use crate::spelling::{Key, nearest};
use crate::types::declarations::Declarations;
use crate::types::scope::Scope;
use crate::types::table::{Resolved, scalar_initial};
use crate::{Code, Diagnostic, Span};
use staunch_ir::{
    Array, ArrayId, Const, Elementary, ExprKind, Field, Location, RefKind, Repr, Section, StructId, Type,
};
use staunch_runtime::{BlockInfo, Pin, PinRole};
use std::rc::Rc;

/// Elements of an array that have been given, in runs.
struct Runs {
    runs: Vec<(u64, Const)>,
    len: u64,
}

/// `(0)`; `0` as an element.
fn is_zero(expr: &ast::Expr<'_>) -> bool {
    matches!(&expr.bare().kind, ast::ExprKind::Literal(it) if matches!(it.value, ast::LiteralValue::Integer { value: 0, .. }))
}

impl<'s> Declarations<'s> {
    /// The constant that `initial` gives a variable declared as `target`.
    pub(super) fn initial(
        &mut self,
        initial: &'s ast::Initial<'s>,
        target: &Resolved,
        scope: &Rc<Scope<'s>>,
    ) -> Option<Const> {
        match (&initial.kind, target.ty) {
            (InitialKind::Fields(fields), _) if fields.is_empty() && !self.dialect(initial.span).has_empty_values() => {
                self.report(
                    Diagnostic::new(Code::E0206, initial.span, "this initial value is empty")
                        .label("expected `(member := value)`")
                        .help("delete the initial value: the variable starts with that of its type"),
                );
                None
            }
            (InitialKind::Value(expr), Type::Reference(id))
                if self.program.references[id.index()].kind == RefKind::ReferenceTo && names_variable(expr) =>
            {
                self.report_assigned_reference(expr);
                None
            }
            // `(x)` of a structure of one member is its value.
            (InitialKind::Value(ast::Expr { kind: ast::ExprKind::Paren(value), .. }), Type::Struct(id))
                if self.dialect(initial.span).has_values_by_position()
                    && self.program.structure(id).fields.len() == 1 =>
            {
                let field = &self.program.structure(id).fields[0];
                let target = Resolved { ty: field.ty, initial: field.initial.clone() };
                Some(collapse(vec![self.initial_value(value, &target, scope)?]))
            }
            // Automation Studio writes `(0)` for a structure or an instance in which everything is 0.
            (InitialKind::Value(expr), Type::Struct(_) | Type::Block(_))
                if target.initial == Const::Zero && is_zero(expr) && self.log.sources.is_of_automation_studio() =>
            {
                Some(Const::Zero)
            }
            (InitialKind::Value(expr), _) => self.initial_value(expr, target, scope),
            (InitialKind::Bind(expr), _) => {
                self.not_supported(expr.span, "an address as an initial value here");
                None
            }
            (InitialKind::Elements(elements), Type::Array(id)) => self.initial_array(elements, id, scope, initial.span),
            (InitialKind::Fields(fields), Type::Struct(id)) => self.initial_struct(fields, id, target, scope),
            (InitialKind::Fields(fields), Type::Block(id)) => self.initial_block(fields, id, target, scope),
            (InitialKind::Indexed(_) | InitialKind::Members(_), _)
                if !self.dialect(initial.span).has_values_by_position() =>
            {
                let (what, help) = match &initial.kind {
                    InitialKind::Members(_) => {
                        ("an initial value without the names of the members", "`(member := value, …)`")
                    }
                    _ => ("the initial value of one element", "the values of all elements: `[value, 3(value)]`"),
                };
                self.report(
                    Diagnostic::new(Code::E0902, initial.span, format!("{what} is not Structured Text"))
                        .help(format!("write {help}")),
                );
                None
            }
            (InitialKind::Indexed(elements), Type::Array(_)) => {
                let mut value = Some(target.initial.clone());
                for (indices, initial) in elements {
                    let whole = value.clone().unwrap_or_else(|| target.initial.clone());
                    let given = self.initial_of_element(whole, target.ty, indices, initial, scope);
                    value = value.and(given);
                }
                value
            }
            (InitialKind::Members(values), Type::Struct(id)) => {
                self.initial_members(values, id, target, initial.span, scope)
            }
            (
                InitialKind::Elements(_) | InitialKind::Fields(_) | InitialKind::Indexed(_) | InitialKind::Members(_),
                _,
            ) => {
                let is_array = matches!(initial.kind, InitialKind::Elements(_) | InitialKind::Indexed(_));
                let shape = if is_array { "an array" } else { "a structure" };
                let found = self.program.type_name(target.ty);
                let error =
                    Diagnostic::new(Code::E0201, initial.span, format!("{shape} value cannot initialise {found}"))
                        .label(format!("expected a value of type {found}"));
                let text = self.log.sources.text(initial.span);
                let halves = text.split_once(',').filter(|_| target.ty.elementary().is_some_and(Elementary::is_real));
                let is_number = |it: &str| !it.is_empty() && it.bytes().all(|it| it.is_ascii_digit());
                self.report(match halves.filter(|it| is_number(it.0) && is_number(it.1)) {
                    Some((whole, fraction)) => {
                        let meant = format!("{whole}.{fraction}");
                        error
                            .help(format!("the decimal separator is a point: write `{meant}`"))
                            .fix(initial.span, meant)
                    }
                    None => error,
                });
                None
            }
        }
    }

    /// `r : REFERENCE TO INT := i`
    fn report_assigned_reference(&mut self, expr: &ast::Expr<'s>) {
        let text = self.log.sources.text(expr.span);
        let error = Diagnostic::new(Code::E0211, expr.span, "a REFERENCE TO is set by `REF=`")
            .label("this is the variable to refer to")
            .help(format!("write `REF= {text}`"));
        let before = &self.log.sources.get(expr.span.file).text[..index(expr.span.start)];
        let sign = before.trim_end().strip_suffix(":=").and_then(|it| u32::try_from(it.len()).ok());
        let sign = sign.map(|start| Span { start, end: expr.span.start, ..expr.span });
        self.report(match sign {
            Some(sign) => error.fix(sign, "REF= "),
            None => error,
        });
    }

    fn initial_value(&mut self, expr: &'s ast::Expr<'s>, target: &Resolved, scope: &Rc<Scope<'s>>) -> Option<Const> {
        let value = constant(self, scope, expr, Some(target))?;
        match value.kind {
            ExprKind::Const(it) => Some(scalar_initial(it)),
            ExprKind::Text(bytes) if bytes.is_empty() => Some(Const::Zero),
            ExprKind::Text(bytes) => Some(Const::Text(bytes)),
            ExprKind::Aggregate(it) => Some(it),
            ExprKind::Load(_)
            | ExprKind::AddressOf(_)
            | ExprKind::Apply(..)
            | ExprKind::ApplyText(..)
            | ExprKind::Convert(..) => {
                self.report(not_constant(expr.span));
                None
            }
        }
    }

    fn initial_array(
        &mut self,
        elements: &'s [ast::Element<'s>],
        id: ArrayId,
        scope: &Rc<Scope<'s>>,
        span: Span,
    ) -> Option<Const> {
        let array = self.program.array(id);
        // A flat list fills a nested array row by row.
        let (leaf, total) = self.flat(elements, array, id);
        let mut runs = Runs { runs: Vec::new(), len: 0 };
        for element in elements {
            self.initial_element(element, &leaf, scope, &mut runs)?;
        }
        if runs.len > total {
            self.report(
                Diagnostic::new(Code::E0206, span, "there are more initial values than elements")
                    .label(format!("{} values for {total} elements", runs.len))
                    .help(format!("remove {}, or declare a longer array", runs.len - total)),
            );
            return None;
        }
        runs.push(total - runs.len, leaf.initial.clone());
        if runs.runs.iter().all(|(_, it)| *it == Const::Zero) {
            return Some(Const::Zero);
        }
        Some(self.nest(runs, array, &leaf))
    }

    /// What one value of the list initialises, and how many of these there are.
    fn flat(&self, elements: &[ast::Element<'s>], array: Array, id: ArrayId) -> (Resolved, u64) {
        let mut leaf = self.table.elements[id.index()].clone();
        let mut total = array.len();
        let nested = |it: &ast::Initial<'_>| matches!(it.kind, InitialKind::Elements(_));
        if elements.iter().flat_map(|it| &it.values).any(nested) {
            return (leaf, total);
        }
        while let Type::Array(inner) = leaf.ty {
            total = total.saturating_mul(self.program.array(inner).len());
            leaf = self.table.elements[inner.index()].clone();
        }
        (leaf, total)
    }

    fn initial_element(
        &mut self,
        element: &'s ast::Element<'s>,
        leaf: &Resolved,
        scope: &Rc<Scope<'s>>,
        runs: &mut Runs,
    ) -> Option<()> {
        if let Some((count, values)) = named_repeat(element)
            && !self.is_function(count)
        {
            let times = self.repeat_count(count, scope)?;
            let mut given = Vec::new();
            for value in values {
                given.push(self.initial_value(value, leaf, scope)?);
            }
            return self.push_repeated(times, given, count.span, leaf, runs);
        }
        let count = match &element.count {
            None => 1,
            Some(expr) => self.repeat_count(expr, scope)?,
        };
        let mut values = Vec::new();
        for value in &element.values {
            values.push(self.initial(value, leaf, scope)?);
        }
        let span = element.values.first().map_or_else(Span::default, |it| it.span);
        self.push_repeated(count, values, span, leaf, runs)
    }

    /// Whether a name before `(` is that of a FUNCTION, so that this is a call and no repeat.
    fn is_function(&self, callee: &ast::Expr<'s>) -> bool {
        let ast::ExprKind::Name(name) = callee.kind else { return false };
        matches!(self.lookup(&[name], Sense::Function), Found::One(Meaning::Declared(Entry::Pou(_))))
    }

    fn repeat_count(&mut self, expr: &ast::Expr<'s>, scope: &Rc<Scope<'s>>) -> Option<u64> {
        let count = self.constant_integer(expr, scope)?;
        let fits = u64::try_from(count).ok().filter(|it| *it <= MAX_SIZE);
        if fits.is_none() {
            self.error(Code::E0206, expr.span, format!("a value cannot be repeated {count} times"));
        }
        fits
    }

    /// The values, all of them `count` times over.
    fn push_repeated(
        &mut self,
        count: u64,
        values: Vec<Const>,
        span: Span,
        leaf: &Resolved,
        runs: &mut Runs,
    ) -> Option<()> {
        match values.as_slice() {
            [] => runs.push(count, leaf.initial.clone()),
            [one] => runs.push(count, one.clone()),
            several => {
                let given = u64::try_from(several.len()).unwrap_or(u64::MAX).saturating_mul(count);
                if given > MAX_SIZE / 64 {
                    self.error(Code::E0206, span, format!("{given} initial values are too many to list"));
                    return None;
                }
                for _ in 0..count {
                    several.iter().for_each(|it| runs.push(1, it.clone()));
                }
            }
        }
        Some(())
    }

    /// Cuts flat runs into the rows of a nested array.
    fn nest(&self, runs: Runs, array: Array, leaf: &Resolved) -> Const {
        if array.element == leaf.ty {
            return Const::Array(runs.runs);
        }
        let Type::Array(inner) = array.element else { return Const::Array(runs.runs) };
        let inner = self.program.array(inner);
        let mut row_len = inner.len();
        let mut deeper = inner.element;
        while deeper != leaf.ty
            && let Type::Array(id) = deeper
        {
            row_len = row_len.saturating_mul(self.program.array(id).len());
            deeper = self.program.array(id).element;
        }
        let mut rows = Runs { runs: Vec::new(), len: 0 };
        let mut rest = runs.runs.into_iter();
        let mut current = rest.next();
        for _ in 0..array.len() {
            let mut row = Runs { runs: Vec::new(), len: 0 };
            while row.len < row_len
                && let Some((count, value)) = &mut current
            {
                let taken = (*count).min(row_len - row.len);
                row.push(taken, value.clone());
                *count -= taken;
                if *count == 0 {
                    current = rest.next();
                }
            }
            rows.push(1, self.nest(row, inner, leaf));
        }
        Const::Array(rows.runs)
    }

    fn initial_struct(
        &mut self,
        given: &'s [(ast::Name<'s>, ast::Initial<'s>)],
        id: StructId,
        target: &Resolved,
        scope: &Rc<Scope<'s>>,
    ) -> Option<Const> {
        let fields = self.program.structure(id).fields.clone();
        let mut values = parts(&target.initial, fields.len());
        let mut seen = Vec::new();
        for (name, initial) in given {
            if seen.contains(&Key(name.text)) {
                self.given_twice(*name);
                continue;
            }
            seen.push(Key(name.text));
            let overlay = self.program.structure(id).overlays.iter().find(|it| Key(&it.name) == Key(name.text));
            if let Some(overlay) = overlay.cloned() {
                self.note_member(*name, id);
                let value = self.initial(initial, &Resolved::plain(overlay.ty), scope)?;
                let field = overlay.field.index();
                values[field] = self.with_overlay(fields[field].ty, &values[field], &overlay, &value);
                continue;
            }
            let Some(at) = self.field_named(id, name.text).map(staunch_ir::FieldId::index) else {
                let near = nearest(name.text, self.members_of(id)).map(str::to_owned);
                self.unknown_member(*name, target.ty, near.as_deref());
                return None;
            };
            self.note_member(*name, id);
            let field = &fields[at];
            if field.constant && field.section != Section::Input {
                self.refuse_constant_of_instance(*name, field);
                continue;
            }
            let resolved = Resolved { ty: field.ty, initial: field.initial.clone() };
            values[at] = self.initial(initial, &resolved, scope)?;
        }
        Some(collapse(values))
    }

    /// `whole` with a value for one of its elements, by the indices that are left.
    fn initial_of_element(
        &mut self,
        whole: Const,
        ty: Type,
        indices: &'s [ast::Expr<'s>],
        initial: &'s ast::Initial<'s>,
        scope: &Rc<Scope<'s>>,
    ) -> Option<Const> {
        let Some((index, rest)) = indices.split_first() else {
            return self.initial(initial, &Resolved { ty, initial: whole }, scope);
        };
        let Type::Array(id) = ty else {
            let found = self.program.type_name(ty);
            self.report(
                Diagnostic::new(Code::E0201, index.span, format!("{found} has no elements"))
                    .label("this index is one too many"),
            );
            return None;
        };
        let array = self.program.array(id);
        let number = self.constant_integer(index, scope)?;
        let position = u64::try_from(number.saturating_sub(i128::from(array.low))).ok().filter(|it| *it < array.len());
        let Some(position) = position else {
            self.report(
                Diagnostic::new(Code::E0206, index.span, format!("the array has no element {number}"))
                    .label(format!("expected {} to {}", array.low, array.high)),
            );
            return None;
        };
        let runs = match whole {
            Const::Array(runs) => runs,
            Const::Zero | Const::Scalar(_) | Const::Text(_) | Const::Struct(_) => vec![(array.len(), Const::Zero)],
        };
        let (mut given, mut at) = (Runs { runs: Vec::new(), len: 0 }, 0);
        for (count, value) in runs {
            if (at..at + count).contains(&position) {
                let before = position - at;
                given.push(before, value.clone());
                let element = self.initial_of_element(value.clone(), array.element, rest, initial, scope)?;
                given.push(1, element);
                given.push(count - before - 1, value);
            } else {
                given.push(count, value);
            }
            at += count;
        }
        Some(if given.runs.iter().all(|it| it.1 == Const::Zero) { Const::Zero } else { Const::Array(given.runs) })
    }

    /// `(x, y)`: the values of the first members, in the order in which they are declared.
    fn initial_members(
        &mut self,
        given: &'s [ast::Initial<'s>],
        id: StructId,
        target: &Resolved,
        span: Span,
        scope: &Rc<Scope<'s>>,
    ) -> Option<Const> {
        let fields = self.program.structure(id).fields.clone();
        if given.len() > fields.len() {
            let found = self.program.type_name(target.ty);
            self.report(
                Diagnostic::new(Code::E0206, span, "there are more initial values than members").label(format!(
                    "{} values for the {} members of {found}",
                    given.len(),
                    fields.len()
                )),
            );
            return None;
        }
        let mut values = parts(&target.initial, fields.len());
        for (at, initial) in given.iter().enumerate() {
            let resolved = Resolved { ty: fields[at].ty, initial: values[at].clone() };
            values[at] = self.initial(initial, &resolved, scope)?;
        }
        Some(collapse(values))
    }

    /// A CONSTANT is its value, in all instances.
    fn refuse_constant_of_instance(&mut self, name: ast::Name<'s>, field: &Field) {
        let mut error = Diagnostic::new(Code::E0501, name.span, format!("`{}` is a CONSTANT", name.text))
            .label("it has the value of its declaration in every instance")
            .help("declare it in VAR_INPUT CONSTANT, or in VAR, where each instance has its own");
        if field.location != Location::default() {
            error = error.other(self.log.name_at(field.location), "declared here");
        }
        self.report(error);
    }

    fn initial_block(
        &mut self,
        given: &'s [(ast::Name<'s>, ast::Initial<'s>)],
        id: staunch_ir::BlockId,
        target: &Resolved,
        scope: &Rc<Scope<'s>>,
    ) -> Option<Const> {
        let pins = id.info().pins;
        let mut values = parts(&target.initial, pins.len());
        let mut seen = vec![false; pins.len()];
        for (name, initial) in given {
            let Some(at) = pins.iter().position(|it| it.name.eq_ignore_ascii_case(name.text)) else {
                self.unknown_member(*name, target.ty, nearest(name.text, pins.iter().map(|it| it.name)));
                return None;
            };
            self.note_pin(*name, id);
            if !once(&mut seen, at) {
                self.given_twice(*name);
                continue;
            }
            let value = self.initial(initial, &Resolved::plain(id.pin_type(staunch_ir::FieldId::next(at))?), scope)?;
            if id.info().retention.restarts(&pins[at]) && value != Const::Zero {
                self.starts_anew(id.info(), &pins[at], initial.span);
            } else {
                values[at] = value;
            }
        }
        Some(collapse(values))
    }

    /// What every start of a Cscape counter sets anew has no initial value.
    fn starts_anew(&mut self, block: &BlockInfo, pin: &Pin, span: Span) {
        let owner = format!("{}.{}", block.family.name(), block.name);
        let start = if pin.repr() == Repr::Bool { "FALSE" } else { "0" };
        let message = format!("`{}` of a {owner} starts at {start}, whatever its initial value", pin.name);
        let warning = Diagnostic::new(Code::W0305, span, message).label("this value is not used");
        self.report(match (block.facts.kept, block.pin_for(PinRole::Load)) {
            (Some(kept), _) => warning
                .help(format!("give it to the variable for `{}` instead, and declare that in VAR RETAIN", kept.pin)),
            (None, Some(load)) => warning.help(format!("load it: call the counter once with `{} := TRUE`", load.name)),
            (None, None) => warning.help("leave it out, and add it where the count is read"),
        });
    }

    fn given_twice(&mut self, name: ast::Name<'s>) {
        self.report(
            Diagnostic::new(Code::E0304, name.span, format!("`{}` is given twice", name.text))
                .label("it already has a value"),
        );
    }
}

/// `N(0)` with a named count reads as a call.
fn named_repeat<'a, 's>(element: &'a ast::Element<'s>) -> Option<(&'a ast::Expr<'s>, Vec<&'a ast::Expr<'s>>)> {
    let (None, [value]) = (&element.count, element.values.as_slice()) else { return None };
    let InitialKind::Value(ast::Expr { kind: ast::ExprKind::Call(callee, arguments), .. }) = &value.kind else {
        return None;
    };
    let ast::ExprKind::Name(name) = &callee.kind else { return None };
    if functions::exists(name.text) {
        return None;
    }
    let positional = |it: &'a ast::Argument<'s>| match &it.kind {
        ast::ArgumentKind::Positional(value) => Some(value),
        ast::ArgumentKind::Input(..) | ast::ArgumentKind::Output { .. } => None,
    };
    let values: Option<Vec<_>> = arguments.iter().map(positional).collect();
    Some((callee, values?))
}

impl Runs {
    fn push(&mut self, count: u64, value: Const) {
        if count == 0 {
            return;
        }
        self.len += count;
        match self.runs.last_mut() {
            Some((run, last)) if *last == value => *run += count,
            _ => self.runs.push((count, value)),
        }
    }
}

/// Notes a member; false if it was there before.
fn once(seen: &mut [bool], at: usize) -> bool {
    !std::mem::replace(&mut seen[at], true)
}

/// The members of a structure constant.
fn parts(whole: &Const, len: usize) -> Vec<Const> {
    match whole {
        Const::Struct(values) => values.clone(),
        Const::Zero | Const::Scalar(_) | Const::Text(_) | Const::Array(_) => vec![Const::Zero; len],
    }
}

fn collapse(values: Vec<Const>) -> Const {
    if values.iter().all(|it| *it == Const::Zero) { Const::Zero } else { Const::Struct(values) }
}

fn names_variable(expr: &ast::Expr<'_>) -> bool {
    match &expr.bare().kind {
        ast::ExprKind::Name(name) => !name.text.eq_ignore_ascii_case("NULL"),
        ast::ExprKind::Member(..) | ast::ExprKind::Index(..) | ast::ExprKind::Deref(_) => true,
        ast::ExprKind::Literal(_)
        | ast::ExprKind::Address(_)
        | ast::ExprKind::Part(..)
        | ast::ExprKind::Call(..)
        | ast::ExprKind::Unary(..)
        | ast::ExprKind::Binary(..)
        | ast::ExprKind::Assign(..)
        | ast::ExprKind::Paren(_)
        | ast::ExprKind::Error(_) => false,
    }
}
