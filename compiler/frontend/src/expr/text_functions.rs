//! The standard's functions on strings, as the dialect's library has them.

use super::checker::Checker;
use super::text_conversion::MAX_CAPACITY;
use crate::Span;
use crate::dialect::rules::Functions;
use staunch_ir::{Expr, ExprKind, Statement, StringType, TextOp, Type};

/// So many text functions may be nested in one expression of the program that is made.
const MAX_TEXT_DEPTH: usize = 32;

impl Checker<'_, '_> {
    pub(super) fn text_function(&mut self, op: TextOp, operands: Vec<Expr>, span: Span) -> Option<Expr> {
        if op == TextOp::Concat {
            return self.concat(operands, span);
        }
        let op = of_library(self.decl.dialect(span).rules().functions.choice, op);
        let mut ready = Vec::new();
        for (operand, repr) in operands.into_iter().zip(op.operands()) {
            ready.push(if repr.is_some() { self.count(operand)? } else { operand });
        }
        let ty = match op.result() {
            Some(_) => Type::INT,
            None => Type::String(made_by(op, &ready, self.longest(ready.get(..1)?, span))?),
        };
        let at = self.at(span);
        let range =
            self.decl.dialect(span).rules().empties_texts_out_of_range().then(|| positions(op, &ready)).flatten();
        let text = self.evaluated(Expr::new(ty, ExprKind::ApplyText(op, ready), at), span)?;
        match range {
            Some(range) => self.empty_outside(text, &range, span),
            None => Some(text),
        }
    }

    /// So many units has the result of a text function at most: in OpenPLC, as many as a STRING; from v4.1 on, as the
    /// longest of these operands, where a literal is a STRING.
    fn longest(&self, operands: &[Expr], span: Span) -> u16 {
        let rules = self.decl.dialect(span).rules();
        let usual = rules.default_string.choice.capacity();
        match rules.functions.choice {
            Functions::OfTheStandard => MAX_CAPACITY,
            Functions::OfMatiec => usual,
            Functions::OfStrucpp => operands.iter().map(|it| room(it, usual)).max().unwrap_or(usual),
        }
    }

    fn concat(&mut self, operands: Vec<Expr>, span: Span) -> Option<Expr> {
        let at = self.at(span);
        let mut operands = operands.into_iter();
        let mut result = operands.next()?;
        for operand in operands {
            let operands = vec![result, operand];
            let [a, b] = [operands[0].ty.string_type()?, operands[1].ty.string_type()?];
            let ty = Type::String(joined(a, b, self.longest(&operands, span)));
            let joined = Expr::new(ty, ExprKind::ApplyText(TextOp::Concat, operands), at);
            let joined = self.evaluated(joined, span)?;
            result = self.shallow(joined);
        }
        Some(result)
    }

    /// The text, kept in a variable where it is the result of many functions in one another: each is
    /// a type of its own to rustc, which takes no more than some hundred in one another.
    pub(crate) fn shallow(&mut self, text: Expr) -> Expr {
        if text_depth(&text) < MAX_TEXT_DEPTH {
            return text;
        }
        let at = text.at;
        let place = self.temporary("saved", text.ty);
        self.block.push(Statement::assign(place.clone(), text, at));
        Expr::load(place, at)
    }
}

/// The counts and positions of a function on a text, with the least values that S7 takes.
fn positions(op: TextOp, operands: &[Expr]) -> Option<Vec<(Expr, i64)>> {
    match (op, operands) {
        (TextOp::Replace, [_, _, count, position]) | (TextOp::Delete, [_, count, position]) => {
            Some(vec![(position.clone(), 1), (count.clone(), 0)])
        }
        (TextOp::Mid, [_, _, position]) => Some(vec![(position.clone(), 1)]),
        (TextOp::Insert, [_, _, position]) => Some(vec![(position.clone(), 0)]),
        _ => None,
    }
}

/// The function of the dialect's library in the place of the standard's, where they differ.
fn of_library(library: Functions, op: TextOp) -> TextOp {
    const OF_MATIEC: &[(TextOp, TextOp)] = &[
        (TextOp::Find, TextOp::FindOrEnd),
        (TextOp::Mid, TextOp::MidOrLength),
        (TextOp::Insert, TextOp::InsertFrom),
        (TextOp::Delete, TextOp::DeleteFrom),
        (TextOp::Replace, TextOp::ReplaceUpTo),
    ];
    const OF_STRUCPP: &[(TextOp, TextOp)] = &[
        (TextOp::Left, TextOp::LeftOrAll),
        (TextOp::Right, TextOp::RightOrAll),
        (TextOp::Mid, TextOp::MidWithin),
        (TextOp::Insert, TextOp::InsertBefore),
        (TextOp::Delete, TextOp::DeleteWithin),
        (TextOp::Replace, TextOp::ReplaceWithin),
    ];
    let others = match library {
        Functions::OfTheStandard => &[],
        Functions::OfMatiec => OF_MATIEC,
        Functions::OfStrucpp => OF_STRUCPP,
    };
    others.iter().find(|it| it.0 == op).map_or(op, |it| it.1)
}

/// How many text functions are nested in the expression.
fn text_depth(expr: &Expr) -> usize {
    match &expr.kind {
        ExprKind::ApplyText(_, operands) => 1 + operands.iter().map(text_depth).max().unwrap_or(0),
        ExprKind::Convert(_, inner) => text_depth(inner),
        ExprKind::Apply(_, operands) => operands.iter().map(text_depth).max().unwrap_or(0),
        ExprKind::Const(_)
        | ExprKind::Text(_)
        | ExprKind::Aggregate(_)
        | ExprKind::Load(_)
        | ExprKind::AddressOf(_) => 0,
    }
}

fn room(text: &Expr, of_literal: u16) -> u16 {
    match (&text.kind, text.ty.string_type()) {
        (ExprKind::Text(_), _) | (_, None) => of_literal,
        (_, Some(it)) => it.capacity,
    }
}

/// What holds both strings, one after the other.
fn joined(a: StringType, b: StringType, longest: u16) -> StringType {
    a.of_capacity(a.capacity.saturating_add(b.capacity).min(longest))
}

/// What holds the longest result: what is inserted adds to the text.
fn made_by(op: TextOp, operands: &[Expr], longest: u16) -> Option<StringType> {
    let own = operands.first()?.ty.string_type()?;
    Some(match op {
        TextOp::MidOrLength => own.of_capacity(own.capacity.saturating_add(1).min(longest)),
        TextOp::Insert
        | TextOp::InsertFrom
        | TextOp::InsertBefore
        | TextOp::Replace
        | TextOp::ReplaceUpTo
        | TextOp::ReplaceWithin => joined(own, operands.get(1)?.ty.string_type()?, longest),
        _ => own,
    })
}
