//! Calls of the standard's functions: the table of all, and what is more than an operation on
//! operands of one type.

use super::bitwise::is_number;
use super::checker::{Checker, Context};
use super::constant::is_constant;
use super::operand::{Operand, computed};
use super::overload::{Resolved, parameter_names};
use crate::dialect::rules::{Functions, LimitCrossed};
use crate::names::functions::{self, Meaning, named};
use crate::types::signature::pin_place;
use crate::{Code, Diagnostic, Span, ast, dialect};
use ast::BinaryOp;
use staunch_ir::{
    Arm, Block, Chars, Conversion, Elementary, Expr, ExprKind, FaultKind, Location, Op, Part, Statement, StatementKind,
    Type, Use, Value,
};
use staunch_runtime::{Class, Kind, Repr, Signature, signature};

/// The signature of every conversion, `INT_TO_REAL` and the like.
const CONVERSION: Signature = signature!("_TO_" (IN: T) -> T [ANY]);

impl<'s> Checker<'_, 's> {
    pub(crate) fn standard_function(
        &mut self,
        name: ast::Name<'s>,
        arguments: &[ast::Argument<'s>],
        expected: Option<Type>,
        span: Span,
    ) -> Option<Operand> {
        let Some((signature, meaning)) = self.form(name, arguments) else {
            if let Some((signature, meaning, ty)) = functions::typed(name.text) {
                let (values, rules) =
                    (self.arguments(signature, name, arguments, span)?, self.decl.dialect(span).rules());
                self.note_use(Use::Function(signature.name), name.span);
                return self.typed_function(signature, meaning, Type::Elementary(rules.own(ty)), &values, name);
            }
            let parsed = functions::conversion(name.text)?;
            let values = self.arguments(&CONVERSION, name, arguments, span)?;
            return self.conversion(parsed, values[0], name).map(Operand::Typed);
        };
        let values = self.arguments(signature, name, arguments, span)?;
        self.note_use(Use::Function(signature.name), name.span);
        match meaning {
            Meaning::Operator(operator) => self.operator_function(signature, operator, &values, expected, name),
            Meaning::Move => self.operand(values[0], expected),
            Meaning::Round(how) => self.round_as_asked(values[0], how, expected, name).map(Operand::Typed),
            Meaning::Operation(Op::Sel) | Meaning::Mux if self.chooses_inputs(name.span) => {
                let (resolved, before) = self.resolve_choice(signature, &values, expected, name)?;
                match meaning {
                    Meaning::Mux => self.mux(resolved, before, name.span),
                    _ => self.chosen(resolved, before, name.span),
                }
            }
            Meaning::Operation(op) => {
                let is_turned = matches!(op, Op::Rol | Op::Ror);
                if matches!(op, Op::Shl | Op::Shr) && is_number(values[0]) {
                    self.note_use(Use::Part(Part::ShiftOfConstant), name.span);
                }
                let expected = self.least_bits(values[0]).filter(|_| is_turned).or(expected);
                let resolved = self.resolve(signature, &values, expected, name)?;
                match op {
                    Op::SwapBytes => self.other_byte_order(resolved, name),
                    _ => self.operation(op, resolved, name.span),
                }
            }
            Meaning::Text(op) => {
                let resolved = self.resolve(signature, &values, expected, name)?;
                self.text_function(op, resolved.operands, name.span).map(Operand::Typed)
            }
            Meaning::LittleEndian => {
                let resolved = self.resolve(signature, &values, expected, name)?;
                self.own_byte_order(resolved, name)
            }
            Meaning::S7(function) => {
                let resolved = self.resolve(signature, &values, expected, name)?;
                self.s7_function(function, resolved, expected, name)
            }
            Meaning::Assert => {
                let condition = self.resolve(signature, &values, None, name)?.operands.pop()?;
                Some(Operand::Typed(self.assured(condition, span)))
            }
            Meaning::Clock(ty) => self.scan_time(ty, span).map(Operand::Typed),
            Meaning::Date(function) => {
                let operands = self.resolve(signature, &values, expected, name)?.operands;
                let to = match signature.result {
                    Kind::Is(ty) => ty,
                    _ => expected.and_then(Type::elementary).filter(|it| it.is_integer()).unwrap_or(Elementary::Int),
                };
                self.date_function(function, to, operands, name.span).map(Operand::Typed)
            }
            Meaning::Mux => {
                let resolved = self.resolve(signature, &values, expected, name)?;
                let before = vec![Block::new(); resolved.operands.len()];
                self.mux(resolved, before, name.span)
            }
        }
    }

    /// The form of a function that has all parameters that the arguments name; the standard's, where
    /// none has.
    fn form(&self, name: ast::Name<'s>, arguments: &[ast::Argument<'s>]) -> Option<(&'static Signature, Meaning)> {
        let dialect = self.decl.dialect(name.span);
        let has = |signature: &Signature, argument: &ast::Argument<'s>| match &argument.kind {
            ast::ArgumentKind::Positional(_) => true,
            ast::ArgumentKind::Input(name, _) | ast::ArgumentKind::Output { name, .. } => {
                parameter_names(signature, arguments.len()).iter().any(|it| it.eq_ignore_ascii_case(name.text))
            }
        };
        let forms = || named(name.text).iter().filter(|it| it.0.is_none_or(|it| it == dialect));
        let fitting = forms().find(|(_, signature, _)| arguments.iter().all(|it| has(signature, it)));
        fitting.or_else(|| forms().next()).map(|(_, signature, meaning)| (*signature, *meaning))
    }

    /// The operator at its operands' types; for a function of one type's own, on operands of that.
    fn operator_function(
        &mut self,
        signature: &Signature,
        operator: BinaryOp,
        values: &[&ast::Expr<'s>],
        expected: Option<Type>,
        name: ast::Name<'s>,
    ) -> Option<Operand> {
        if signature.parameters.iter().any(|it| it.kind == Kind::T) {
            return self.chain(operator, values, expected, name);
        }
        let [a, b] = <[Expr; 2]>::try_from(self.resolve(signature, values, expected, name)?.operands).ok()?;
        let side = |expr: Expr, at: usize| (Operand::Typed(expr), values[at].span);
        self.joined(operator, name.span, None, side(a, 0), side(b, 1))
    }

    /// The scan's time: a block of the runtime reads it, as all that needs it.
    fn scan_time(&mut self, ty: Elementary, span: Span) -> Option<Expr> {
        let id = dialect::clock()?;
        let (block, at) = (self.temporary("clock", Type::Block(id)), self.at(span));
        self.push(StatementKind::CallBlock { block: block.clone(), instruction: 0, inputs: Vec::new() }, span);
        let now = Expr::load(pin_place(block, id, "NOW"), at);
        let now = self.retyped(now, Type::Elementary(self.decl.dialect(span).rules().own(ty)));
        self.kept_duration(now, span)
    }

    /// The smallest bit string that holds a literal, where the dialect turns so many bits of it.
    fn least_bits(&self, value: &ast::Expr<'s>) -> Option<Type> {
        let ast::ExprKind::Literal(ast::Literal { prefix: None, value: ast::LiteralValue::Integer { value: it, .. } }) =
            &value.bare().kind
        else {
            return None;
        };
        let types = [Elementary::Byte, Elementary::Word, Elementary::Dword, Elementary::Lword];
        let is_asked = self.decl.dialect(value.span).rules().rotates_constants_at_least_bits();
        let holds = |ty: &Elementary| is_asked && ty.repr().integer(i128::from(*it)).is_some();
        types.into_iter().find(holds).map(Type::Elementary)
    }

    /// An operation of the table on operands of its type.
    pub(super) fn operation(
        &mut self,
        op: Op,
        Resolved { mut ty, own, mut operands }: Resolved,
        span: Span,
    ) -> Option<Operand> {
        if op == Op::Abs && own.elementary().is_some_and(|it| self.promotes_in_functions(it, span)) {
            operands = operands.into_iter().map(|it| self.promote(it, span)).collect();
            ty = operands.first()?.ty;
        }
        if op == Op::Sqrt && self.decl.dialect(span).rules().takes_root_of_magnitude() {
            operands =
                operands.into_iter().map(|it| self.apply(Op::Abs, ty, vec![it], ty, span)).collect::<Option<_>>()?;
        }
        let library = self.decl.dialect(span).rules().functions.choice;
        let value = match (op, ty) {
            (Op::Limit, Type::Elementary(_)) => self.limited(ty, operands, span),
            (Op::Limit, Type::String(_)) if library == Functions::OfMatiec => self.limited_text_low(ty, operands, span),
            (Op::Abs, _) if library == Functions::OfMatiec => self.apply(Op::AbsIfBelow, ty, operands, ty, span),
            (_, Type::Elementary(Elementary::Real)) if library.computes_at_lreal() && is_of_math(op) => {
                let operands =
                    operands.into_iter().map(|it| self.convert(Conversion::Value, Type::LREAL, it)).collect();
                let value = self.apply(op, Type::LREAL, operands, Type::LREAL, span)?;
                Some(self.convert(Conversion::Value, ty, value))
            }
            (Op::Max | Op::Min, Type::String(_)) => self.extreme_text(op, ty, operands, span),
            (Op::Max | Op::Min, _) if library == Functions::OfStrucpp => self.last_of_equals(op, ty, operands, span),
            (Op::Max | Op::Min, _) => self.fold(op, ty, operands, span),
            (Op::Limit, Type::String(_)) => self.limited_text(ty, operands, span),
            (Op::Sel, _) if self.decl.program.repr(ty).is_none() || matches!(ty, Type::Reference(_)) => {
                self.select(ty, operands, span)
            }
            (Op::Shl | Op::Shr | Op::Rol | Op::Ror, _) => {
                let (count, value) = (operands.pop()?, operands.pop()?);
                self.shift(op, ty, value, count, span)
            }
            _ => self.apply(op, ty, operands, ty, span),
        };
        Some(computed(value?, own))
    }

    /// LIMIT, as the dialect has it where the bounds are crossed.
    fn limited(&mut self, ty: Type, operands: Vec<Expr>, span: Span) -> Option<Expr> {
        let op = match self.decl.dialect(span).rules().limit_crossed.choice {
            LimitCrossed::Maximum => Op::Limit,
            LimitCrossed::Value => Op::LimitInOrder,
            LimitCrossed::Minimum => Op::LimitLow,
            LimitCrossed::MinimumFirst => Op::LimitFirst,
        };
        self.apply(op, ty, operands, ty, span)
    }

    /// A fault where the condition does not hold.
    fn assured(&mut self, condition: Expr, span: Span) -> Expr {
        let at = self.at(span);
        let fails = Expr::apply(Op::Not, Type::BOOL, vec![condition], at);
        let then = vec![Statement::new(StatementKind::Fault(FaultKind::AssertionFailed), at)];
        self.push(StatementKind::If { condition: fails, then, otherwise: Vec::new() }, span);
        Expr::constant(Elementary::Bool, Value::Bool(true), at)
    }

    /// MAX and MIN that give the second of two where neither is beyond the other, as with NaN: ours give the first.
    fn last_of_equals(&mut self, op: Op, ty: Type, mut operands: Vec<Expr>, span: Span) -> Option<Expr> {
        self.fault_in_order(operands.iter_mut());
        let mut operands = operands.into_iter();
        let mut result = operands.next()?;
        for operand in operands {
            result = self.apply(op, ty, vec![operand, result], ty, span)?;
        }
        Some(result)
    }

    /// An extensible function folds from the left.
    fn fold(&mut self, op: Op, ty: Type, operands: Vec<Expr>, span: Span) -> Option<Expr> {
        let mut operands = operands.into_iter();
        let mut result = operands.next()?;
        for operand in operands {
            result = self.apply(op, ty, vec![result, operand], ty, span)?;
        }
        Some(result)
    }

    fn shift(&mut self, op: Op, ty: Type, value: Expr, count: Expr, span: Span) -> Option<Expr> {
        if ty == Type::BOOL {
            return self.shift_one_bit(op, value, count, span);
        }
        self.undefined_shift(op, ty, &count, span);
        let count = match op {
            // The low bits of a count turn as far as all of it: every width divides 2^64.
            Op::Rol | Op::Ror => self.convert(Conversion::Value, Type::LINT, count),
            _ => self.count(count)?,
        };
        let signed = ty.elementary().is_some_and(|it| it.is(Class::Signed));
        let keeps_sign = op == Op::Shr && signed && self.decl.dialect(span).rules().keeps_sign();
        let op = if keeps_sign { Op::Sar } else { op };
        self.apply(op, ty, vec![value, count], ty, span)
    }

    /// A BOOL has one bit: turning leaves it, and a shift by more than 0 makes it FALSE.
    fn shift_one_bit(&mut self, op: Op, mut value: Expr, mut count: Expr, span: Span) -> Option<Expr> {
        if matches!(op, Op::Rol | Op::Ror) {
            self.fault_in_order([&mut value, &mut count].into_iter());
            return Some(value);
        }
        let byte = Type::Elementary(Elementary::Byte);
        let bits = self.convert(Conversion::Value, byte, value);
        // To the right, so that what leaves the one bit is gone.
        let shifted = self.shift(Op::Shr, byte, bits, count, span)?;
        Some(self.convert(Conversion::Value, Type::BOOL, shifted))
    }

    /// A count or position as a LINT; what is more than a LINT holds is its greatest value.
    pub(super) fn count(&mut self, value: Expr) -> Option<Expr> {
        let most = Elementary::Ulint.repr().integer(i128::from(i64::MAX)).filter(|_| is_wide(value.ty));
        let value = match most {
            Some(most) => {
                let (ty, at) = (value.ty, value.at);
                let most = Expr::new(ty, ExprKind::Const(most), at);
                Expr::apply(Op::Min, ty, vec![value, most], at)
            }
            None => value,
        };
        Some(self.convert(Conversion::Value, Type::LINT, value))
    }

    /// `SEL(G, IN0, IN1)` of what no repr carries; both inputs are evaluated.
    fn select(&mut self, ty: Type, mut operands: Vec<Expr>, span: Span) -> Option<Expr> {
        if self.choose_now(&operands) {
            let [selector, first, second] = <[Expr; 3]>::try_from(operands).ok()?;
            let chosen = if selector.as_const()? == Value::Bool(true) { second } else { first };
            return Some(Expr { ty, ..chosen });
        }
        self.fault_in_order(operands.iter_mut());
        let [selector, first, second] = <[Expr; 3]>::try_from(operands).ok()?;
        let result = self.temporary("selected", ty);
        let at = self.at(span);
        let then = vec![Statement::assign(result.clone(), second, at)];
        let otherwise = vec![Statement::assign(result.clone(), first, at)];
        self.push(StatementKind::If { condition: selector, then, otherwise }, span);
        Some(Expr::load(result, at))
    }

    /// Whether SEL and MUX evaluate only the input that is chosen. A constant has no statements to choose by.
    fn chooses_inputs(&self, span: Span) -> bool {
        self.context == Context::Body && self.decl.dialect(span).chooses_inputs()
    }

    /// Whether what is chosen of constants is one: where a constant is wanted. A body has statements to choose by.
    pub(super) fn choose_now(&self, operands: &[Expr]) -> bool {
        self.context != Context::Body && operands.iter().all(is_constant)
    }

    /// `SEL(G, IN0, IN1)`, of which one is evaluated: `before` is what each does before its value is known.
    fn chosen(&mut self, resolved: Resolved, mut before: Vec<Block>, span: Span) -> Option<Operand> {
        let inputs = resolved.operands.get(1..)?;
        if before.iter().all(Vec::is_empty) && !inputs.iter().any(|it| self.can_fault(it)) {
            // It is not known.
            return self.operation(Op::Sel, resolved, span);
        }
        let Resolved { ty, own, operands } = resolved;
        let [selector, first, second] = <[Expr; 3]>::try_from(operands).ok()?;
        let result = self.temporary("selected", ty);
        let at = self.at(span);
        let mut arm = |number: usize, input: Expr| {
            let mut block = std::mem::take(&mut before[number]);
            block.push(Statement::assign(result.clone(), input, at));
            block
        };
        let (otherwise, then) = (arm(1, first), arm(2, second));
        self.push(StatementKind::If { condition: selector, then, otherwise }, span);
        Some(computed(Expr::load(result, at), own))
    }

    /// `MUX(K, IN0, …)`: a K below 0 faults, and one above where the dialect does not take the last input then.
    /// What is not in `before` of an input is evaluated, chosen or not.
    pub(super) fn mux(
        &mut self,
        Resolved { ty, own, mut operands }: Resolved,
        before: Vec<Block>,
        span: Span,
    ) -> Option<Operand> {
        if self.choose_now(&operands) {
            return Some(computed(self.constant_mux(ty, operands, span)?, own));
        }
        let chooses = self.chooses_inputs(span);
        if !chooses {
            self.fault_in_order(operands.iter_mut());
        }
        let mut inputs = operands.into_iter().zip(before);
        let (selector, _) = inputs.next()?;
        let selector = self.selector(selector, span);
        let at = self.at(span);
        let result = self.temporary("selected", ty);
        let arm = |(number, (input, mut body)): (i128, (Expr, Block))| {
            body.push(Statement::assign(result.clone(), input, at));
            Arm { labels: vec![(number, number)], body }
        };
        let mut arms: Vec<_> = (0..).zip(inputs).map(arm).collect();
        let mut outside = match (self.decl.dialect(span).rules().functions.choice, self.nothing_of(ty, span)) {
            (Functions::OfMatiec, Some(nothing)) => vec![Statement::assign(result.clone(), nothing, at)],
            (Functions::OfStrucpp, _) => arms.pop()?.body,
            (Functions::OfTheStandard | Functions::OfMatiec, _) => {
                vec![Statement::new(StatementKind::Fault(FaultKind::IndexOutOfRange), at)]
            }
        };
        if chooses {
            let (least, most) = self.decl.program.repr(selector.ty).and_then(Repr::range)?;
            let last = arms.last_mut()?;
            if least < 0 {
                last.labels[0].1 = most;
            } else {
                outside = arms.pop()?.body;
            }
        }
        self.push(StatementKind::Case { selector, arms, otherwise: outside }, span);
        Some(computed(Expr::load(result, at), own))
    }

    /// K, which is an INT to STruC++.
    fn selector(&mut self, selector: Expr, span: Span) -> Expr {
        match self.decl.dialect(span).rules().functions.choice {
            Functions::OfStrucpp => self.convert(Conversion::Value, Type::INT, selector),
            Functions::OfTheStandard | Functions::OfMatiec => selector,
        }
    }

    /// 0, FALSE or the empty text: what MATIEC's MUX gives past its inputs.
    fn nothing_of(&mut self, ty: Type, span: Span) -> Option<Expr> {
        let at = self.at(span);
        match ty {
            Type::String(_) => Some(empty_text(ty, at)),
            _ => Some(Expr::new(ty, ExprKind::Const(self.decl.program.repr(ty)?.zero()), at)),
        }
    }

    /// MUX of constants, with the same inputs for a K beyond them.
    fn constant_mux(&mut self, ty: Type, operands: Vec<Expr>, span: Span) -> Option<Expr> {
        let mut inputs = operands.into_iter();
        let selector = inputs.next()?;
        let selector = self.selector(selector, span);
        let number = selector.as_const().and_then(Value::as_integer)?;
        let last = inputs.as_slice().last().cloned();
        let is_beyond = usize::try_from(number).map_or(number > 0, |it| it >= inputs.len());
        let chosen = match usize::try_from(number) {
            _ if is_beyond && self.decl.dialect(span).chooses_inputs() => inputs.next_back(),
            Ok(number) => inputs.nth(number),
            Err(_) => None,
        };
        let chosen = match (chosen, self.decl.dialect(span).rules().functions.choice) {
            (None, Functions::OfMatiec) => self.nothing_of(ty, span),
            (None, Functions::OfStrucpp) => last,
            (chosen, _) => chosen,
        };
        if chosen.is_none() {
            let fault = FaultKind::IndexOutOfRange;
            self.report(
                Diagnostic::new(Code::E0207, span, format!("{fault} in a constant expression"))
                    .label(format!("K is {number}, and the inputs are counted from 0")),
            );
        }
        chosen.map(|it| Expr { ty, ..it })
    }
}

fn empty_text(ty: Type, at: Location) -> Expr {
    Expr::convert(Conversion::Value, ty, Expr::new(Type::string(0), ExprKind::Text(Chars::Narrow(Vec::new())), at), at)
}

/// The functions of `math.h`, which compute at LREAL.
fn is_of_math(op: Op) -> bool {
    const OF_MATH: [Op; 10] =
        [Op::Sqrt, Op::Ln, Op::Log, Op::Exp, Op::Sin, Op::Cos, Op::Tan, Op::Asin, Op::Acos, Op::Atan];
    OF_MATH.contains(&op)
}

fn is_wide(ty: Type) -> bool {
    matches!(ty, Type::Elementary(Elementary::Ulint | Elementary::Lword))
}
