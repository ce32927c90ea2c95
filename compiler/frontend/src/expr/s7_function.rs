//! Functions that SIMATIC S7 has beyond the standard's: bits, decimal digits, and a MUX that has a value for every K.

use super::checker::Checker;
use super::operand::{Operand, computed};
use super::overload::Resolved;
use crate::names::functions::S7Function;
use crate::{Code, Diagnostic, ast};
use staunch_ir::{Arm, Conversion, Elementary, Expr, Op, Statement, StatementKind, Type, Value};

impl<'s> Checker<'_, 's> {
    pub(super) fn s7_function(
        &mut self,
        function: S7Function,
        resolved: Resolved,
        expected: Option<Type>,
        name: ast::Name<'s>,
    ) -> Option<Operand> {
        match function {
            S7Function::Swap => self.of_several_bits(resolved, name).and_then(|it| self.other_byte_order(it, name)),
            S7Function::Decode => self.decoded(resolved, expected, name),
            S7Function::Encode => self.encoded(resolved, name),
            S7Function::Fraction => self.operation(Op::Fraction, resolved, name.span),
            S7Function::MuxElse => self.mux_or_else(resolved, name),
            S7Function::OfDigits(count) => self.digits(Op::FromSignedBcd, count, resolved, name),
            S7Function::ToDigits(count) => self.digits(Op::ToSignedBcd, count, resolved, name),
        }
    }

    /// One bit, turned as far as IN says: a turn by the type's bits is none, as S7 takes IN modulo these.
    fn decoded(&mut self, resolved: Resolved, expected: Option<Type>, name: ast::Name<'s>) -> Option<Operand> {
        let has_bits = |it: &Elementary| it.is_bits() && *it != Elementary::Bool;
        let to = expected.and_then(Type::elementary).filter(has_bits).unwrap_or(Elementary::Dword);
        let [number] = <[Expr; 1]>::try_from(resolved.operands).ok()?;
        let one = Expr::constant(to, to.repr().integer(1)?, number.at);
        let number = self.convert(Conversion::Value, Type::LINT, number);
        let ty = Type::Elementary(to);
        Some(computed(self.apply(Op::Rol, ty, vec![one, number], ty, name.span)?, ty))
    }

    fn encoded(&mut self, resolved: Resolved, name: ast::Name<'s>) -> Option<Operand> {
        let Resolved { ty, operands, .. } = self.of_several_bits(resolved, name)?;
        Some(Operand::Typed(self.apply(Op::FirstBit, ty, operands, Type::INT, name.span)?))
    }

    /// A BYTE, WORD, DWORD or LWORD; a BOOL is reported.
    fn of_several_bits(&mut self, resolved: Resolved, name: ast::Name<'s>) -> Option<Resolved> {
        if resolved.own != Type::BOOL {
            return Some(resolved);
        }
        let message = format!("`{}` takes a BYTE, WORD, DWORD or LWORD, but this is BOOL", name.text);
        self.report(Diagnostic::new(Code::E0204, name.span, message).label("a BOOL has one bit"));
        None
    }

    /// Digits of four bits each as a number, or the other way round.
    fn digits(&mut self, op: Op, count: i64, resolved: Resolved, name: ast::Name<'s>) -> Option<Operand> {
        let to = match (op, count) {
            (Op::FromSignedBcd, 3) => Elementary::Int,
            (Op::FromSignedBcd, _) => Elementary::Dint,
            (_, 3) => Elementary::Word,
            _ => Elementary::Dword,
        };
        let [value] = <[Expr; 1]>::try_from(resolved.operands).ok()?;
        let count = Expr::constant(Elementary::Lint, Value::I64(count), value.at);
        let value = self.convert(Conversion::Value, Type::LINT, value);
        let number = self.apply(op, Type::LINT, vec![value, count], Type::LINT, name.span)?;
        Some(Operand::Typed(self.convert(Conversion::Value, Type::Elementary(to), number)))
    }

    /// `MUX(K := …, IN0 := …, IN1 := …, INELSE := …)`: INELSE where K numbers none of the inputs. All are evaluated.
    fn mux_or_else(&mut self, resolved: Resolved, name: ast::Name<'s>) -> Option<Operand> {
        let Resolved { ty, own, mut operands } = resolved;
        if self.choose_now(&operands) {
            let number = usize::try_from(operands.first()?.as_const()?.as_integer()?).ok();
            let chosen = number.and_then(|it| operands.get(it.checked_add(2)?)).or(operands.get(1))?;
            return Some(computed(Expr { ty, ..chosen.clone() }, own));
        }
        self.fault_in_order(operands.iter_mut());
        let at = self.at(name.span);
        let result = self.temporary("selected", ty);
        let give = |input: Expr| vec![Statement::assign(result.clone(), input, at)];
        let mut inputs = operands.into_iter();
        let (selector, otherwise) = (inputs.next()?, give(inputs.next()?));
        let arm = |(number, input): (i128, Expr)| Arm { labels: vec![(number, number)], body: give(input) };
        let arms = (0..).zip(inputs).map(arm).collect();
        self.push(StatementKind::Case { selector, arms, otherwise }, name.span);
        Some(computed(Expr::load(result, at), own))
    }
}
