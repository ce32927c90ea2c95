//! CASE: its selector, and labels that are constants and cover each value once.

use std::collections::BTreeMap;

use super::Checker;
use crate::{Code, Diagnostic, Span, ast};
use staunch_ir::{Arm, StatementKind, Type, Value};

/// The labels so far, by their lowest value, with their highest: none of them overlap.
#[derive(Default)]
struct Seen(BTreeMap<i128, (i128, Span)>);

impl Seen {
    /// The label with the lowest values that shares one with `low..=high`.
    fn overlapping(&self, low: i128, high: i128) -> Option<Span> {
        let below = self.0.range(..=low).next_back().filter(|(_, (to, _))| low <= *to);
        below.or_else(|| self.0.range(low..=high).next()).map(|(_, (_, span))| *span)
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
        let value = self.typed(selector, None);
        let value = value.and_then(|value| {
            let allowed = match value.ty {
                Type::Elementary(it) | Type::Subrange(it, _) => it.lane().is_integer() && !it.is_time(),
                Type::Enum(_) => true,
                Type::String(_) | Type::Array(_) | Type::Struct(_) | Type::Block(_) => false,
            };
            if !allowed {
                let found = self.type_name(value.ty);
                self.report(
                    Diagnostic::new(
                        Code::E0201,
                        selector.span,
                        format!("CASE selects by an integer or enumeration, this is {found}"),
                    )
                    .label("expected an integer, a bit string or an enumeration"),
                );
            }
            allowed.then_some(value)
        });
        let ty = value.as_ref().map(|it| it.ty);
        let mut seen = Seen::default();
        let mut built = Vec::new();
        let mut called = Vec::new();
        for arm in arms {
            let labels: Vec<_> = match ty {
                Some(ty) => arm.labels.iter().filter_map(|it| self.label(it, ty, &mut seen)).collect(),
                None => Vec::new(),
            };
            let before = self.called.len();
            let body = self.block_of(&arm.body);
            called.extend(self.leave_branch(before, &arm.body));
            if !labels.is_empty() {
                built.push(Arm { labels, body });
            }
        }
        let otherwise = otherwise.map(|it| self.block_of(it)).unwrap_or_default();
        self.called.append(called);
        self.push(StatementKind::Case { selector: value?, arms: built, otherwise }, span);
        Some(())
    }

    fn label(&mut self, label: &ast::Label<'s>, ty: Type, seen: &mut Seen) -> Option<(i128, i128)> {
        let low = self.label_value(&label.low, ty)?;
        let (high, span) = match &label.high {
            Some(high) => (self.label_value(high, ty)?, label.low.span.to(high.span)),
            None => (low, label.low.span),
        };
        if low > high {
            self.report(
                Diagnostic::new(Code::E0510, span, "this range of labels is empty")
                    .label(format!("{low} is above {high}"))
                    .help(format!("write `{high}..{low}`"))
                    .fix(span, format!("{high}..{low}")),
            );
            return None;
        }
        if let Some(first) = seen.overlapping(low, high) {
            self.report(
                Diagnostic::new(Code::E0506, span, "this CASE label stands twice")
                    .label("never chosen: the first one is")
                    .other(first, "first here"),
            );
            return None;
        }
        seen.0.insert(low, (high, span));
        Some((low, high))
    }

    fn label_value(&mut self, expr: &ast::Expr<'s>, ty: Type) -> Option<i128> {
        let value = self.value(expr, ty)?;
        let number = value.as_const().and_then(Value::as_integer);
        if number.is_none() {
            self.report(super::not_constant(expr.span));
        }
        number
    }
}
