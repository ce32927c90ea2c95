//! Strings in their order: comparisons, and the functions that choose the first or the last.

use super::checker::Checker;
use crate::Span;
use crate::dialect::rules::Functions;
use staunch_ir::{Elementary, Expr, ExprKind, Op, Place, Statement, StatementKind, TextOp, Type, Value};

impl Checker<'_, '_> {
    /// `a < b` and its kin, byte by byte.
    pub(crate) fn compare_texts(&mut self, op: Op, a: Expr, b: Expr, span: Span) -> Option<Expr> {
        let at = self.at(span);
        let starts = self.decl.dialect(span).rules().functions.choice == Functions::OfMatiec;
        let compare = if starts { TextOp::CompareStart } else { TextOp::Compare };
        let order = Expr::new(Type::INT, ExprKind::ApplyText(compare, vec![a, b]), at);
        let order = self.evaluated(order, span)?;
        let zero = Expr::constant(Elementary::Int, Value::I16(0), at);
        self.apply(op, Type::INT, vec![order, zero], Type::BOOL, span)
    }

    /// `MAX` and `MIN` of strings: the first of those that are greatest, or least.
    pub(crate) fn extreme_text(&mut self, op: Op, ty: Type, texts: Vec<Expr>, span: Span) -> Option<Expr> {
        let beats = if op == Op::Max { Op::Gt } else { Op::Lt };
        if self.choose_now(&texts) {
            let mut chosen = None;
            for text in texts {
                chosen = match chosen {
                    Some(first) if !self.is_so(beats, &text, &first, span) => Some(first),
                    Some(_) | None => Some(text),
                };
            }
            return chosen.map(|it| Expr { ty, ..it });
        }
        let mut texts = self.texts_in_variables(ty, texts, span).into_iter();
        let chosen = self.chosen_text(ty, texts.next()?, span);
        for text in texts {
            self.choose(&chosen, beats, text, span)?;
        }
        Some(Expr::load(chosen, self.at(span)))
    }

    /// `LIMIT` of strings: `MIN(MAX(IN, MN), MX)`.
    pub(crate) fn limited_text(&mut self, ty: Type, texts: Vec<Expr>, span: Span) -> Option<Expr> {
        if self.choose_now(&texts) {
            let [min, value, max] = <[Expr; 3]>::try_from(texts).ok()?;
            let raised = if self.is_so(Op::Lt, &value, &min, span) { min } else { value };
            let above = self.is_so(Op::Gt, &raised, &max, span);
            return Some(Expr { ty, ..if above { max } else { raised } });
        }
        let [min, value, max] = <[Expr; 3]>::try_from(self.texts_in_variables(ty, texts, span)).ok()?;
        let chosen = self.chosen_text(ty, value, span);
        self.choose(&chosen, Op::Gt, min, span)?;
        self.choose(&chosen, Op::Lt, max, span)?;
        Some(Expr::load(chosen, self.at(span)))
    }

    /// `LIMIT` of strings in MATIEC: MN for what is not above it, MX for what is not below that.
    pub(crate) fn limited_text_low(&mut self, ty: Type, texts: Vec<Expr>, span: Span) -> Option<Expr> {
        if self.choose_now(&texts) {
            let [min, value, max] = <[Expr; 3]>::try_from(texts).ok()?;
            let limited = if self.is_so(Op::Lt, &value, &max, span) { value.clone() } else { max };
            let chosen = if self.is_so(Op::Gt, &value, &min, span) { limited } else { min };
            return Some(Expr { ty, ..chosen });
        }
        let at = self.at(span);
        let [min, value, max] = <[Expr; 3]>::try_from(self.texts_in_variables(ty, texts, span)).ok()?;
        let condition = self.compare_texts(Op::Gt, value.clone(), min.clone(), span)?;
        let below = self.compare_texts(Op::Lt, value.clone(), max.clone(), span)?;
        let chosen = self.chosen_text(ty, min, span);
        let limited = vec![Statement::assign(chosen.clone(), value, at)];
        let raised = vec![Statement::assign(chosen.clone(), max, at)];
        let then = vec![Statement::new(StatementKind::If { condition: below, then: limited, otherwise: raised }, at)];
        self.push(StatementKind::If { condition, then, otherwise: Vec::new() }, span);
        Some(Expr::load(chosen, at))
    }

    /// A comparison of constants.
    fn is_so(&mut self, op: Op, a: &Expr, b: &Expr, span: Span) -> bool {
        let compared = self.compare_texts(op, a.clone(), b.clone(), span);
        compared.is_some_and(|it| it.as_const() == Some(Value::Bool(true)))
    }

    /// Each text is evaluated once, from left to right.
    fn texts_in_variables(&mut self, ty: Type, texts: Vec<Expr>, span: Span) -> Vec<Expr> {
        let at = self.at(span);
        let saved = |text: Expr| {
            let place = self.temporary("text", ty);
            self.assign(place.clone(), text, span);
            Expr::load(place, at)
        };
        texts.into_iter().map(saved).collect()
    }

    fn chosen_text(&mut self, ty: Type, first: Expr, span: Span) -> Place {
        let chosen = self.temporary("chosen", ty);
        self.assign(chosen.clone(), first, span);
        chosen
    }

    fn choose(&mut self, chosen: &Place, beats: Op, text: Expr, span: Span) -> Option<()> {
        let at = self.at(span);
        let condition = self.compare_texts(beats, text.clone(), Expr::load(chosen.clone(), at), span)?;
        let then = vec![Statement::assign(chosen.clone(), text, at)];
        self.push(StatementKind::If { condition, then, otherwise: Vec::new() }, span);
        Some(())
    }
}
