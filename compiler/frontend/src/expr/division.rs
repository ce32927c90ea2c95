//! Division by zero where a dialect lets the program continue.

use super::checker::{Checker, Context};
use crate::{Span, dialect};
use staunch_ir::{Elementary, Expr, Op, Statement, StatementKind, Type, Value};

impl Checker<'_, '_> {
    /// `a / b` or `a MOD b`. In Logix a divisor of 0 gives the dividend, and is reported (1756-RM003N, pp. 277 and 281).
    pub(super) fn divided(&mut self, op: Op, ty: Type, (mut a, mut b): (Expr, Expr), span: Span) -> Option<Expr> {
        let continues = self.context == Context::Body
            && ty.elementary().is_some_and(Elementary::is_integer)
            && b.as_const().is_none()
            && self.decl.dialect(span).rules().divides_by_zero();
        let Some(id) = dialect::minor_fault().filter(|_| continues) else {
            return self.apply(op, ty, vec![a, b], ty, span);
        };
        let at = self.at(span);
        for (name, side) in [("dividend", &mut a), ("divisor", &mut b)] {
            if side.as_const().is_none() {
                self.save(name, side);
            }
        }
        let (result, block) = (self.temporary("quotient", ty), self.temporary("minor_fault", Type::Block(id)));
        self.assign(result.clone(), a.clone(), span);
        let number = |ty: Elementary, value: Value| Expr::constant(ty, value, at);
        let inputs = vec![
            number(Elementary::Uint, Value::U16(at.file)),
            number(Elementary::Uint, Value::U16(at.column)),
            number(Elementary::Udint, Value::U32(at.line)),
        ];
        let then = vec![Statement::new(StatementKind::CallBlock { block, instruction: 0, inputs }, at)];
        let zero = Expr::new(ty, staunch_ir::ExprKind::Const(self.decl.program.repr(ty)?.zero()), at);
        let condition = self.apply(Op::Eq, ty, vec![b.clone(), zero], Type::BOOL, span)?;
        let quotient = self.apply(op, ty, vec![a, b], ty, span)?;
        let otherwise = vec![Statement::assign(result.clone(), quotient, at)];
        self.push(StatementKind::If { condition, then, otherwise }, span);
        Some(Expr::load(result, at))
    }
}
