//! CASE: of labels that overlap, the first in the text that holds the value is chosen. The IR gets
//! labels that do not, cut to what is left of them.

use crate::expr::checker::{Checker, Context};
use crate::{Code, Diagnostic, Span, ast};
use staunch_ir::{Arm, Block, Conversion, Elementary, Expr, StatementKind, Type, Value};
use std::collections::{BTreeMap, HashMap};

/// The labels that have been seen.
#[derive(Default)]
struct Seen {
    /// As they are written.
    labels: HashMap<(i128, i128), Span>,
    /// What they hold, in ranges that do not overlap: by its lower end the upper one, and whose it is.
    held: BTreeMap<i128, (i128, Span)>,
}

impl Seen {
    /// The parts of a range that no label holds, and the first label that holds another part.
    fn rest(&self, (low, high): (i128, i128)) -> (Vec<(i128, i128)>, Option<Span>) {
        let (mut rest, mut from, mut first) = (Vec::new(), low, None);
        let start = self.held.range(..=low).next_back().map_or(low, |(start, _)| *start);
        for (start, (end, span)) in self.held.range(start..=high) {
            if *end < from {
                continue;
            }
            first.get_or_insert(*span);
            if from < *start {
                rest.push((from, *start - 1));
            }
            from = *end + 1;
        }
        if from <= high {
            rest.push((from, high));
        }
        (rest, first)
    }
}

impl<'s> Checker<'_, 's> {
    pub(super) fn case(
        &mut self,
        selector: &ast::Expr<'s>,
        arms: &[ast::Arm<'s>],
        otherwise: Option<&[ast::Statement<'s>]>,
        span: Span,
    ) -> Option<()> {
        let has_texts = self.decl.dialect(span).selects_by_texts();
        let value = match self.decl.dialect(span).rules().cuts_selectors() {
            true => self.operand(selector, None).and_then(|it| self.materialise(it.cut(), None, selector.span)),
            false => self.typed(selector, None),
        };
        if let Some(text) = value.as_ref().filter(|it| has_texts && matches!(it.ty, Type::String(_))) {
            return self.case_of_text(text.clone(), arms, otherwise, span);
        }
        value.iter().for_each(|it| self.note_selected(it));
        let value = value.and_then(|value| {
            let allowed = match value.ty {
                Type::Elementary(it) if it.is_char() => has_texts,
                Type::Elementary(it) | Type::Subrange(it, _) => it.repr().is_integer() && it.is_integral(),
                Type::Enum(_) => true,
                Type::String(_) | Type::Array(_) | Type::Struct(_) | Type::Block(_) | Type::Reference(_) => false,
            };
            if !allowed {
                let not_one = self.not_a_selector(selector, arms, value.ty);
                self.report(not_one);
            }
            allowed.then_some(value)
        });
        let ty = value.as_ref().map(|it| it.ty);
        let mut seen = Seen::default();
        let mut built = Vec::new();
        let mut called = Vec::new();
        for arm in arms {
            let labels: Vec<_> = match ty {
                Some(ty) => arm.labels.iter().flat_map(|it| self.label(it, ty, &mut seen)).collect(),
                None => Vec::new(),
            };
            let before = self.called.len();
            let label = arm.labels.first().map(|it| it.low.span);
            let body = self.arm_of(&arm.body, label, span);
            called.extend(self.leave_branch(before, &arm.body));
            if !labels.is_empty() {
                built.push(Arm { labels, body });
            }
        }
        let otherwise = self.arm_of(otherwise.unwrap_or_default(), None, span);
        self.called.append(called);
        let selector = self.code_of_character(value?);
        self.push(StatementKind::Case { selector, arms: built, otherwise }, span);
        Some(())
    }

    /// A CASE selects by none of this type; of a text, an IF does.
    fn not_a_selector(&self, selector: &ast::Expr<'s>, arms: &[ast::Arm<'s>], ty: Type) -> Diagnostic {
        let message = format!("CASE needs an integer or an enumeration, but this is {}", self.type_name(ty));
        let error = Diagnostic::new(Code::E0201, selector.span, message)
            .label("expected an integer, a bit string or an enumeration");
        let is_text = matches!(ty, Type::String(_)) || ty.elementary().is_some_and(Elementary::is_char);
        let text = |span| self.decl.log.sources.text(span);
        match arms.first().and_then(|it| it.labels.first()).filter(|_| is_text) {
            Some(first) => {
                let (value, first) = (text(selector.span), text(first.low.span));
                error.help(format!("write `IF {value} = {first} THEN … ELSIF {value} = … THEN … END_IF`"))
            }
            None => error,
        }
    }

    /// A character selects by its code.
    fn code_of_character(&mut self, value: Expr) -> Expr {
        match value.ty {
            Type::Elementary(Elementary::Char) => {
                self.convert(Conversion::Same, Type::Elementary(Elementary::Usint), value)
            }
            Type::Elementary(Elementary::Wchar) => {
                self.convert(Conversion::Same, Type::Elementary(Elementary::Uint), value)
            }
            _ => value,
        }
    }

    pub(super) fn arm_of(&mut self, statements: &[ast::Statement<'s>], label: Option<Span>, case: Span) -> Block {
        self.nested(|this| {
            this.count_arm(label, case);
            let mut block = this.block_of(statements);
            this.block.append(&mut block);
        })
    }

    /// What a label holds of the values that the ones before it leave.
    fn label(&mut self, label: &ast::Label<'s>, ty: Type, seen: &mut Seen) -> Vec<(i128, i128)> {
        let span = label.high.as_ref().map_or(label.low.span, |high| label.low.span.to(high.span));
        let Some(range) = self.label_range(label, ty, span) else { return Vec::new() };
        if let Some(first) = seen.labels.insert(range, span) {
            self.report(
                Diagnostic::new(Code::E0506, span, "this CASE label is written twice")
                    .label("never chosen: the first label has precedence")
                    .other(first, "first here"),
            );
            return Vec::new();
        }
        let (rest, first) = seen.rest(range);
        if let Some(first) = first {
            self.report_overlap(rest.is_empty(), first, span);
        }
        seen.held.extend(rest.iter().map(|(low, high)| (*low, (*high, span))));
        rest
    }

    fn report_overlap(&mut self, never: bool, first: Span, span: Span) {
        let lint = if never {
            Diagnostic::new(Code::W0512, span, "this CASE label is never chosen")
                .label("earlier labels cover all of its values")
        } else {
            Diagnostic::new(Code::W0512, span, "this CASE label overlaps another")
                .label("if both include the value, the first label is chosen")
        };
        self.report(lint.other(first, "first here"));
    }

    fn label_range(&mut self, label: &ast::Label<'s>, ty: Type, span: Span) -> Option<(i128, i128)> {
        let low = self.label_value(&label.low, ty)?;
        self.warn_of_difference(&label.low);
        let high = label.high.as_ref().map_or(Some(low), |high| self.label_value(high, ty))?;
        if low > high {
            self.report(
                Diagnostic::new(Code::E0510, span, "this range of labels is empty")
                    .label(format!("{low} is above {high}"))
                    .help(format!("write `{high}..{low}`"))
                    .fix(span, format!("{high}..{low}")),
            );
            return None;
        }
        Some((low, high))
    }

    /// Reports `1-5`, which is -4.
    fn warn_of_difference(&mut self, label: &ast::Expr<'s>) {
        let ast::ExprKind::Binary(sides, ast::BinaryOp::Sub, _) = &label.kind else { return };
        let [from, to] = &**sides;
        let is_number = |it: &ast::Expr<'s>| matches!(it.kind, ast::ExprKind::Literal(_));
        if is_number(from) && is_number(to) {
            let sources = &self.decl.log.sources;
            let (from, to) = (sources.text(from.span), sources.text(to.span));
            let lint = Diagnostic::new(Code::W0533, label.span, "this label is the difference of two numbers")
                .label("one value, not a range")
                .help(format!("write `{from}..{to}` for all values from {from} to {to}"))
                .fix(label.span, format!("{from}..{to}"));
            self.report(lint);
        }
    }

    /// A label is not converted by a call, as other values are.
    pub(super) fn label_of_another_type(&mut self, reported: usize, ty: Type) {
        let wanted = self.type_name(ty);
        for it in self.decl.log.diagnostics[reported..].iter_mut() {
            let names_members = it.help.is_some() && it.fix.is_none();
            if matches!(it.code, Code::E0201 | Code::E0203) && !names_members {
                it.fix = None;
                it.help = Some(format!("a label is a constant of the selector's type, {wanted}"));
            }
        }
    }

    /// In `codesys` a member of an enumeration may be a label though the selector's type does not hold it: it is never
    /// chosen, which a lint says in place of the error.
    fn is_beyond_the_selector(&mut self, label: &ast::Expr<'s>, reported: usize) -> bool {
        let is_named = label.path().is_some() && self.decl.dialect(label.span).mixes_bits_and_integers();
        let [error] = &self.decl.log.diagnostics[reported..] else { return false };
        if !is_named || error.code != Code::E0202 {
            return false;
        }
        let why = error.message.to_string();
        self.decl.log.diagnostics.truncate(reported);
        self.report(Diagnostic::new(Code::W0512, label.span, "this CASE label is never chosen").label(why));
        true
    }

    fn label_value(&mut self, expr: &ast::Expr<'s>, ty: Type) -> Option<i128> {
        let reported = self.decl.log.diagnostics.len();
        let around = std::mem::replace(&mut self.context, Context::Constant);
        let value = self.value(expr, ty);
        self.context = around;
        let Some(value) = value else {
            if !self.is_beyond_the_selector(expr, reported) {
                self.label_of_another_type(reported, ty);
            }
            return None;
        };
        let number = value.as_const().and_then(Value::as_integer);
        if number.is_none() {
            self.report(crate::expr::unresolved::not_constant(expr.span));
        }
        number
    }
}
