//! CASE of a STRING or WSTRING: which label it is equal to is found first, and selects then by its number.

use crate::expr::checker::Checker;
use crate::{Code, Diagnostic, Span, ast};
use staunch_ir::{Arm, Chars, Elementary, Expr, ExprKind, Op, Place, Statement, StatementKind, Type, Value};

/// A label of a text's CASE.
struct Label {
    text: Expr,
    /// From 1.
    number: i32,
    span: Span,
}

impl<'s> Checker<'_, 's> {
    pub(super) fn case_of_text(
        &mut self,
        selector: Expr,
        arms: &[ast::Arm<'s>],
        otherwise: Option<&[ast::Statement<'s>]>,
        span: Span,
    ) -> Option<()> {
        let (mut labels, mut built, mut called) = (Vec::new(), Vec::new(), Vec::new());
        let mut bodies = Vec::new();
        for arm in arms {
            let first = labels.len();
            for label in &arm.labels {
                self.label_of_text(label, selector.ty, &mut labels);
            }
            let numbers: Vec<_> = labels[first..].iter().map(|it| (it.number.into(), it.number.into())).collect();
            let before = self.called.len();
            let body = self.arm_of(&arm.body, arm.labels.first().map(|it| it.low.span), span);
            called.extend(self.leave_branch(before, &arm.body));
            bodies.push((numbers, body));
        }
        built.extend(bodies.into_iter().filter(|it| !it.0.is_empty()).map(|(labels, body)| Arm { labels, body }));
        let otherwise = self.arm_of(otherwise.unwrap_or_default(), None, span);
        self.called.append(called);
        let selector = self.number_of_label(selector, labels, span)?;
        self.push(StatementKind::Case { selector, arms: built, otherwise }, span);
        Some(())
    }

    fn label_of_text(&mut self, label: &ast::Label<'s>, ty: Type, labels: &mut Vec<Label>) -> Option<()> {
        let span = label.low.span;
        if let Some(high) = &label.high {
            self.report(
                Diagnostic::new(Code::E0201, span.to(high.span), "a range of strings is not allowed as a CASE label")
                    .label("expected one string, or several separated by `,`"),
            );
            return None;
        }
        let reported = self.decl.log.diagnostics.len();
        let text = self.typed(&label.low, Some(ty))?;
        let ExprKind::Text(chars) = &text.kind else {
            match text.ty {
                Type::String(_) => self.report(crate::expr::unresolved::not_constant(span)),
                _ => drop(self.value(&label.low, ty)),
            }
            self.label_of_another_type(reported, ty);
            return None;
        };
        if chars.is_wide() != ty.string_type()?.wide {
            self.value(&label.low, ty);
            return None;
        }
        if let Some(first) = labels.iter().find(|it| text_of(it) == Some(chars)) {
            self.report(
                Diagnostic::new(Code::E0506, span, "this CASE label is written twice")
                    .label("never chosen: the first label has precedence")
                    .other(first.span, "first here"),
            );
            return None;
        }
        labels.push(Label { number: i32::try_from(labels.len()).ok()? + 1, text, span });
        Some(())
    }

    /// The number of the label that a text is equal to, 0 for none.
    fn number_of_label(&mut self, mut selector: Expr, labels: Vec<Label>, span: Span) -> Option<Expr> {
        let at = self.at(span);
        let number = |it: i32| Expr::constant(Elementary::Dint, Value::I32(it), at);
        self.save("text", &mut selector);
        let chosen: Place = self.temporary("label", Type::DINT);
        self.block.push(Statement::assign(chosen.clone(), number(0), at));
        for label in labels {
            let condition = self.compare_texts(Op::Eq, selector.clone(), label.text, label.span)?;
            let then = vec![Statement::assign(chosen.clone(), number(label.number), at)];
            self.push(StatementKind::If { condition, then, otherwise: Vec::new() }, label.span);
        }
        Some(Expr::load(chosen, at))
    }
}

fn text_of(label: &Label) -> Option<&Chars> {
    match &label.text.kind {
        ExprKind::Text(chars) => Some(chars),
        _ => None,
    }
}
