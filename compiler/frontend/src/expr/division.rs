//! Division by zero where a dialect lets the program continue.

use super::checker::{Checker, Context};
use crate::dialect::rules::ByZero;
use crate::{Code, Diagnostic, Span, dialect};
use staunch_ir::{Elementary, Expr, Op, Place, Statement, StatementKind, Type, Value};

impl Checker<'_, '_> {
    /// `a / b` or `a MOD b`, as the dialect's rule says it of a divisor that is 0.
    pub(super) fn divided(&mut self, op: Op, ty: Type, (a, b): (Expr, Expr), span: Span) -> Option<Expr> {
        let rules = self.decl.dialect(span).rules();
        let rule = if op == Op::Div { rules.division_by_zero } else { rules.modulo_by_zero };
        let is_integer = ty.elementary().is_some_and(Elementary::is_integer);
        let zero = match b.as_const() {
            Some(Value::F32(it)) => it == 0.0,
            Some(Value::F64(it)) => it == 0.0,
            it => it.and_then(Value::as_integer) == Some(0),
        };
        match rule.choice {
            ByZero::GivesZero if is_integer => {
                self.warn_of_zero(zero, "the result is 0", span);
                let op = if op == Op::Div { Op::DivOrZero } else { Op::ModOrZero };
                self.apply(op, ty, vec![a, b], ty, span)
            }
            ByZero::Reported if self.context == Context::Body && (zero || b.as_const().is_none()) => {
                let result = if is_integer { "the dividend" } else { "infinite or not a number" };
                self.warn_of_zero(zero, &format!("each division is a minor fault, and its result is {result}"), span);
                self.reported_quotient(op, ty, (a, b), zero, span)
            }
            ByZero::Faults | ByZero::GivesZero | ByZero::Reported => self.apply(op, ty, vec![a, b], ty, span),
        }
    }

    fn warn_of_zero(&mut self, is_zero: bool, result: &str, span: Span) {
        if is_zero && self.context == Context::Body {
            self.report(
                Diagnostic::new(Code::W0523, span, "division by the constant 0")
                    .label(format!("the program continues: {result}"))
                    .help("divide by another number, or delete the division"),
            );
        }
    }

    /// A division that is reported where its divisor is 0. The result of integers is then the dividend (Logix,
    /// 1756-RM003N, pp. 277 and 281), that of reals is infinite or not a number.
    fn reported_quotient(
        &mut self,
        op: Op,
        ty: Type,
        (mut a, mut b): (Expr, Expr),
        is_zero: bool,
        span: Span,
    ) -> Option<Expr> {
        let at = self.at(span);
        for (name, side) in [("dividend", &mut a), ("divisor", &mut b)] {
            if side.as_const().is_none() {
                self.save(name, side);
            }
        }
        let is_integer = ty.elementary().is_some_and(Elementary::is_integer);
        let report = self.minor_fault(span)?;
        if is_zero {
            self.block.push(report);
            return if is_integer { Some(a) } else { self.apply(op, ty, vec![a, b], ty, span) };
        }
        let zero = Expr::new(ty, staunch_ir::ExprKind::Const(self.decl.program.repr(ty)?.zero()), at);
        let condition = self.apply(Op::Eq, ty, vec![b.clone(), zero], Type::BOOL, span)?;
        let then = vec![report];
        if !is_integer {
            self.push(StatementKind::If { condition, then, otherwise: Vec::new() }, span);
            return self.apply(op, ty, vec![a, b], ty, span);
        }
        let result = self.temporary("quotient", ty);
        self.assign(result.clone(), a.clone(), span);
        let quotient = self.apply(op, ty, vec![a, b], ty, span)?;
        let otherwise = vec![Statement::assign(result.clone(), quotient, at)];
        self.push(StatementKind::If { condition, then, otherwise }, span);
        Some(Expr::load(result, at))
    }

    /// The statement that notes a minor fault at this place.
    fn minor_fault(&mut self, span: Span) -> Option<Statement> {
        let id = dialect::minor_fault()?;
        let at = self.at(span);
        let block: Place = self.temporary("minor_fault", Type::Block(id));
        let number = |ty: Elementary, value: Value| Expr::constant(ty, value, at);
        let inputs = vec![
            number(Elementary::Uint, Value::U16(at.file)),
            number(Elementary::Uint, Value::U16(at.column)),
            number(Elementary::Udint, Value::U32(at.line)),
        ];
        Some(Statement::new(StatementKind::CallBlock { block, instruction: 0, inputs }, at))
    }
}
