//! Calls of functions: a user's own, and the standard's.

use super::Checker;
use super::call::{Given, Parameter};
use super::coerce::{as_number, join};
use super::conversion;
use super::operand::Operand;
use crate::declare::{Entry, Formal, Signature};
use crate::{Code, Diagnostic, Span, ast};
use staunch_ir::{
    Argument, Arm, Conversion, Elementary, Expr, ExprKind, FaultKind, Mode, Op, PouId, Section, Statement,
    StatementKind, TextOp, Type,
};
use std::rc::Rc;

/// Standard functions that are not rows of the operation tables.
const OTHERS: [&str; 3] = ["MUX", "MOVE", "TRUNC"];

/// Whether a standard function bears this name.
pub(crate) fn exists(name: &str) -> bool {
    Op::named(name).is_some_and(|op| !op.source_name().starts_with('_'))
        || TextOp::named(name).is_some_and(|op| !op.source_name().starts_with('_'))
        || OTHERS.iter().any(|it| it.eq_ignore_ascii_case(name))
        || of_times(name).is_some()
        || conversion::parse(name).is_some()
}

/// The names of the standard functions, for suggestions.
pub(super) fn names() -> impl Iterator<Item = &'static str> {
    let ops = Op::ALL.iter().map(|op| op.source_name());
    let texts = TextOp::ALL.iter().map(|op| op.source_name());
    ops.chain(texts).chain(OTHERS.iter().copied()).chain(TIMES.iter().map(|it| it.0)).filter(|it| !it.starts_with('_'))
}

/// The functions of durations, which mean an operator: `ADD_TIME(a, b)` is `a + b`.
const TIMES: [(&str, ast::BinaryOp, Elementary); 10] = [
    ("ADD_TIME", ast::BinaryOp::Add, Elementary::Time),
    ("SUB_TIME", ast::BinaryOp::Sub, Elementary::Time),
    ("MUL_TIME", ast::BinaryOp::Mul, Elementary::Time),
    ("DIV_TIME", ast::BinaryOp::Div, Elementary::Time),
    ("MULTIME", ast::BinaryOp::Mul, Elementary::Time),
    ("DIVTIME", ast::BinaryOp::Div, Elementary::Time),
    ("ADD_LTIME", ast::BinaryOp::Add, Elementary::Ltime),
    ("SUB_LTIME", ast::BinaryOp::Sub, Elementary::Ltime),
    ("MUL_LTIME", ast::BinaryOp::Mul, Elementary::Ltime),
    ("DIV_LTIME", ast::BinaryOp::Div, Elementary::Ltime),
];

fn of_times(name: &str) -> Option<(ast::BinaryOp, Elementary)> {
    TIMES.iter().find(|it| it.0.eq_ignore_ascii_case(name)).map(|it| (it.1, it.2))
}

/// So many text functions may be nested in one expression of the program that is made.
const MAX_TEXT_DEPTH: usize = 32;

/// How many operands a function takes, and whether more may follow.
struct Shape {
    names: Vec<String>,
    extensible: bool,
}

impl<'s> Checker<'_, 's> {
    pub(super) fn user_function(
        &mut self,
        slot: usize,
        arguments: &[ast::Argument<'s>],
        span: Span,
    ) -> Option<Option<Expr>> {
        let signature = self.decl.signature(slot)?;
        let owner = self.decl.pous[slot].ast.name;
        let formals = &signature.formals;
        let arguments = &Self::accepted(&signature, arguments);
        let parameters: Vec<_> =
            formals.iter().map(|it| Parameter { name: it.name.text, section: it.section }).collect();
        let given =
            self.bind(owner.text, &parameters, arguments, |name| Self::unknown_formal(owner.text, formals, name))?;
        let mut passed: Vec<Argument> = Vec::new();
        let copies = self.copies_back.len();
        let mut outputs = Vec::new();
        let mut complete = true;
        for (at, (formal, given)) in formals.iter().zip(given).enumerate() {
            match self.function_argument(&signature, at, formal, owner, given, span, &mut passed, &mut outputs) {
                Some(argument) => passed.push(argument),
                None => complete = false,
            }
        }
        if !complete {
            return None;
        }
        let result = signature.result.as_ref().map(|(_, resolved)| self.temporary(owner.text, resolved.ty));
        self.push(
            StatementKind::Call {
                callee: PouId::next(slot),
                instance: None,
                arguments: passed,
                result: result.clone(),
            },
            span,
        );
        self.block.extend(self.copies_back.split_off(copies));
        for (source, target, negated) in outputs {
            self.connect_output(source, target, negated)?;
        }
        let at = self.at(span);
        Some(result.map(|place| Expr::load(place, at)))
    }

    #[expect(clippy::too_many_arguments, reason = "one step of a loop, named for its length")]
    fn function_argument<'a>(
        &mut self,
        signature: &Rc<Signature<'s>>,
        at: usize,
        formal: &Formal<'s>,
        owner: ast::Name<'s>,
        given: Given<'a, 's>,
        span: Span,
        passed: &mut [Argument],
        outputs: &mut Vec<(staunch_ir::Place, &'a ast::Expr<'s>, bool)>,
    ) -> Option<Argument> {
        let ty = formal.resolved.ty;
        match (signature.params[at].mode, formal.section) {
            (Mode::Value(_), _) => {
                let Given::Value(expr) = given else {
                    self.input_left_out(formal, owner, span)?;
                    return Some(Argument::Value(self.default_argument(formal, span)));
                };
                let mut done = expressions(passed);
                self.after(&mut done, |this| this.value(expr, ty)).map(Argument::Value)
            }
            (Mode::Reference, Section::Output) => {
                let place = self.temporary(formal.name.text, ty);
                if let Given::Output { target: Some(target), negated } = given {
                    outputs.push((place.clone(), target, negated));
                }
                Some(Argument::Reference(place))
            }
            (Mode::Reference, _) => {
                let mut place = None;
                let mut done = expressions(passed);
                self.after(&mut done, |this| {
                    place = this.in_out(formal, owner.text, given, span);
                    Some(())
                })?;
                place.map(Argument::Reference)
            }
        }
    }

    /// Reports an input without an initial value of its own that a call leaves out. CODESYS refuses it.
    fn input_left_out(&mut self, formal: &Formal<'s>, owner: ast::Name<'s>, span: Span) -> Option<()> {
        if self.has_initial(formal, owner) {
            return Some(());
        }
        let (name, refused) = (formal.name.text, self.decl.dialect(span).wants_all_inputs());
        let ty = self.type_name(formal.resolved.ty);
        let code = if refused { Code::E0303 } else { Code::W0304 };
        let message = format!("this call of `{}` leaves out the input `{name}`", owner.text);
        self.report(
            Diagnostic::new(code, span, message)
                .label(if refused {
                    "a FUNCTION keeps no value from its last call"
                } else {
                    "it is 0, FALSE or empty then"
                })
                .other(formal.name.span, "declared here, without an initial value")
                .help(format!("write `{name} := …` in the call, or declare a default: `{name} : {ty} := …;`")),
        );
        (!refused).then_some(())
    }

    /// Whether a formal's declaration, or its type's, gives it a value.
    fn has_initial(&self, formal: &Formal<'s>, owner: ast::Name<'s>) -> bool {
        let Some(Entry::Pou(slot)) = self.decl.names.get(&crate::names::Key(owner.text)) else { return true };
        let pou = self.decl.pous[*slot].ast;
        let declared = pou.blocks.iter().flat_map(|it| &it.vars);
        let given = declared
            .filter(|it| it.names.iter().any(|name| name.span == formal.name.span))
            .any(|it| it.initial.is_some());
        given || !matches!(formal.resolved.initial, staunch_ir::Const::Zero)
    }

    /// An omitted input has its declared initial value.
    fn default_argument(&mut self, formal: &Formal<'s>, span: Span) -> Expr {
        use staunch_ir::Const;
        let at = self.at(span);
        let ty = formal.resolved.ty;
        let kind = match (&formal.resolved.initial, self.decl.program.lane(ty), ty) {
            (Const::Scalar(value), _, _) => ExprKind::Const(*value),
            (Const::Zero, Some(lane), _) => ExprKind::Const(lane.zero()),
            (Const::Text(bytes), _, _) => ExprKind::Text(bytes.clone()),
            (Const::Zero, None, Type::String(_)) => ExprKind::Text(Vec::new()),
            (other, _, _) => ExprKind::Aggregate(other.clone()),
        };
        Expr::new(ty, kind, at)
    }

    pub(super) fn standard_function(
        &mut self,
        name: ast::Name<'s>,
        arguments: &[ast::Argument<'s>],
        expected: Option<Type>,
        span: Span,
    ) -> Option<Operand> {
        if let Some(op) = Op::named(name.text) {
            return self.operation(op, name, arguments, expected, span);
        }
        if let Some(op) = TextOp::named(name.text) {
            return self.text_function(op, name, arguments, span).map(Operand::Typed);
        }
        if let Some((operator, ty)) = of_times(name.text) {
            return self.time_function(operator, ty, name, arguments, span).map(Operand::Typed);
        }
        match name.text.to_ascii_uppercase().as_str() {
            "MUX" => self.mux(name, arguments, expected, span).map(Operand::Typed),
            "MOVE" => {
                let values = self.arguments(name, &shape(&["IN"]), arguments, span)?;
                self.operand(values[0], expected)
            }
            "TRUNC" => {
                let values = self.arguments(name, &shape(&["IN"]), arguments, span)?;
                self.trunc(values[0], expected, name).map(Operand::Typed)
            }
            _ => {
                let values = self.arguments(name, &shape(&["IN"]), arguments, span)?;
                let parsed = conversion::parse(name.text)?;
                self.conversion(parsed, values[0], name).map(Operand::Typed)
            }
        }
    }

    /// The argument expressions of a standard function, in the order of its parameters.
    fn arguments<'a>(
        &mut self,
        name: ast::Name<'s>,
        shape: &Shape,
        arguments: &'a [ast::Argument<'s>],
        span: Span,
    ) -> Option<Vec<&'a ast::Expr<'s>>> {
        let mut names = shape.names.clone();
        if shape.extensible {
            // IN1, IN2, … go on as long as arguments do.
            let (stem, first) = split_number(shape.names.last()?)?;
            for extra in names.len()..arguments.len() {
                names.push(format!("{stem}{}", first + extra + 1 - shape.names.len()));
            }
        }
        let parameters: Vec<_> = names.iter().map(|it| Parameter { name: it, section: Section::Input }).collect();
        let given = self.bind(name.text, &parameters, arguments, |argument| {
            let names: Vec<_> = names.iter().map(String::as_str).collect();
            Diagnostic::new(Code::E0301, argument.span, format!("`{}` has no parameter `{}`", name.text, argument.text))
                .label("unknown parameter")
                .help(format!("its parameters are {}", crate::diagnostic::wording::list(&names)))
        })?;
        let mut values = Vec::new();
        for given in &given {
            match given {
                Given::Value(expr) => values.push(*expr),
                Given::Nothing | Given::Output { .. } => {}
            }
        }
        if values.len() < names.len() {
            let count = names.len();
            let least = if shape.extensible { "at least " } else { "" };
            self.report(
                Diagnostic::new(
                    Code::E0302,
                    span,
                    format!("`{}` takes {}{}, {} given", name.text, least, super::call::plural(count), values.len()),
                )
                .label(format!("expected {}", names.join(", "))),
            );
            return None;
        }
        Some(values)
    }

    /// An operation of the table, called by its name.
    fn operation(
        &mut self,
        op: Op,
        name: ast::Name<'s>,
        arguments: &[ast::Argument<'s>],
        expected: Option<Type>,
        span: Span,
    ) -> Option<Operand> {
        let shape = op_shape(op);
        let values = self.arguments(name, &shape, arguments, span)?;
        if let Some(operator) = infix(op) {
            return self.chain(operator, &values, expected, name);
        }
        let expected = expected.filter(|_| op.result().is_none());
        match op {
            Op::Not => {
                let value = self.typed(values[0], expected)?;
                self.not(value, values[0].span).map(Operand::Typed)
            }
            Op::Shl | Op::Shr | Op::Rol | Op::Ror => self.shift(op, &values, expected, name).map(Operand::Typed),
            Op::Sel => self.select(&values, expected, name).map(Operand::Typed),
            Op::Max | Op::Min => {
                let (ty, operands) = self.same_type(&values, expected, name)?;
                self.fold(op, ty, operands, name.span).map(Operand::Typed)
            }
            Op::Atan2 => self.angle(&values, expected, name).map(Operand::Typed),
            Op::Limit => {
                let (ty, operands) = self.same_type(&values, expected, name)?;
                let limited = match ty {
                    Type::String(_) => self.limited_text(ty, operands, name.span),
                    _ => self.apply(op, ty, operands, ty, name.span),
                };
                limited.map(Operand::Typed)
            }
            _ => self.numeric(op, &values, expected, name).map(Operand::Typed),
        }
    }

    /// `ADD_TIME(IN1, IN2)` and its kin: the operator, for durations alone.
    fn time_function(
        &mut self,
        operator: ast::BinaryOp,
        ty: Elementary,
        name: ast::Name<'s>,
        arguments: &[ast::Argument<'s>],
        span: Span,
    ) -> Option<Expr> {
        let values = self.arguments(name, &shape(&["IN1", "IN2"]), arguments, span)?;
        let result = self.chain(operator, &values, Some(Type::Elementary(ty)), name)?;
        if result.ty() == Some(Type::Elementary(ty)) {
            return result.typed().cloned();
        }
        let found = result.ty().map_or_else(|| "a number".to_owned(), |it| self.type_name(it));
        let wants = crate::diagnostic::wording::article(ty.name());
        self.report(
            Diagnostic::new(Code::E0204, name.span, format!("`{}` makes {wants}, this is {found}", name.text))
                .label(format!("its first argument is {wants}")),
        );
        None
    }

    /// Operands of a function that takes them all at one type.
    fn same_type(
        &mut self,
        values: &[&ast::Expr<'s>],
        expected: Option<Type>,
        name: ast::Name<'s>,
    ) -> Option<(Type, Vec<Expr>)> {
        let operands = self.in_order(values, expected)?;
        let mut ty: Option<Type> = None;
        for (operand, value) in operands.iter().zip(values) {
            let Some(own) = operand.ty() else { continue };
            ty = Some(match ty {
                None => own,
                Some(so_far) => match self.join_types(so_far, own, value.span) {
                    Some(joined) => joined,
                    None => {
                        let (a, b) = (self.type_name(so_far), self.type_name(own));
                        self.report(
                            Diagnostic::new(
                                Code::E0204,
                                name.span,
                                format!("`{}` does not take {a} and {b}", name.text),
                            )
                            .label("its arguments need one type")
                            .other(value.span, format!("this is {b}")),
                        );
                        return None;
                    }
                },
            });
        }
        let ty = match ty {
            Some(ty) => self.widened_by_literals(ty, &operands),
            None => self.literals_type(&operands, expected),
        };
        let mut converted = Vec::new();
        for (operand, value) in operands.into_iter().zip(values) {
            converted.push(self.coerce(operand, ty, value.span)?);
        }
        if self.decl.program.lane(ty).is_none() && !matches!(ty, Type::String(_)) {
            let found = self.type_name(ty);
            self.error(Code::E0204, name.span, format!("`{}` does not take {found}", name.text));
            return None;
        }
        Some((ty, converted))
    }

    /// Checks operands left to right, saving earlier ones where a later one calls.
    fn in_order(&mut self, values: &[&ast::Expr<'s>], expected: Option<Type>) -> Option<Vec<Operand>> {
        let mut operands: Vec<Operand> = Vec::new();
        let mut complete = true;
        for value in values {
            let mut done: Vec<_> = operands.iter_mut().filter_map(Operand::typed_mut).collect();
            match self.after(&mut done, |this| this.operand(value, expected)) {
                Some(operand) => operands.push(operand),
                None => complete = false,
            }
        }
        complete.then_some(operands)
    }

    fn join_types(&self, a: Type, b: Type, span: Span) -> Option<Type> {
        match (a, b) {
            (Type::Elementary(x), Type::Elementary(y)) => {
                let mixes = self.decl.dialect(span).mixes_bits_and_integers();
                let joined = join(x, y).or_else(|| mixes.then(|| join(as_number(x), as_number(y))).flatten());
                joined.map(Type::Elementary)
            }
            (Type::String(x), Type::String(y)) => Some(Type::String(x.max(y))),
            _ => (a == b).then_some(a),
        }
    }

    fn widened_by_literals(&self, ty: Type, operands: &[Operand]) -> Type {
        let Type::Elementary(mut ty) = ty else { return ty };
        for operand in operands {
            let real = matches!(operand, Operand::Real { .. });
            if real && ty.is_integer() {
                ty = join(ty, Elementary::Real).unwrap_or(Elementary::Lreal);
            }
            if let Operand::Integer(value) = operand
                && ty.is_integer()
                && ty.lane().integer(*value).is_none()
            {
                let own = [Elementary::Int, Elementary::Dint, Elementary::Lint];
                let own = own.into_iter().find(|it| it.lane().integer(*value).is_some());
                ty = own.and_then(|own| join(ty, own)).unwrap_or(ty);
            }
        }
        Type::Elementary(ty)
    }

    fn literals_type(&self, operands: &[Operand], expected: Option<Type>) -> Type {
        let real = operands.iter().any(|it| matches!(it, Operand::Real { .. }));
        match expected {
            Some(ty @ Type::Elementary(it)) if it.is_real() || (!real && it.lane().is_integer() && !it.is_time()) => ty,
            _ if real => Type::LREAL,
            _ => {
                let fits = |ty: &Elementary| {
                    operands
                        .iter()
                        .all(|it| matches!(it, Operand::Integer(value) if ty.lane().integer(*value).is_some()))
                };
                let ty = [Elementary::Int, Elementary::Dint, Elementary::Lint].into_iter().find(fits);
                Type::Elementary(ty.unwrap_or(Elementary::Ulint))
            }
        }
    }

    /// An extensible function folds from the left.
    fn fold(&mut self, op: Op, ty: Type, operands: Vec<Expr>, span: Span) -> Option<Expr> {
        if let Type::String(_) = ty {
            return self.extreme_text(op, ty, operands, span);
        }
        let mut operands = operands.into_iter();
        let mut result = operands.next()?;
        for operand in operands {
            result = self.apply(op, ty, vec![result, operand], ty, span)?;
        }
        Some(result)
    }

    fn shift(
        &mut self,
        op: Op,
        values: &[&ast::Expr<'s>],
        expected: Option<Type>,
        name: ast::Name<'s>,
    ) -> Option<Expr> {
        let mut value = self.typed(values[0], expected)?;
        let ty = value.ty;
        let mixes = self.decl.dialect(name.span).mixes_bits_and_integers();
        let bits =
            matches!(ty, Type::Elementary(it) if it.lane().is_integer() && !it.is_time() && (it.is_bits() || mixes));
        if !bits {
            let found = self.type_name(ty);
            self.report(
                Diagnostic::new(
                    Code::E0204,
                    values[0].span,
                    format!("`{}` shifts a bit string, this is {found}", name.text),
                )
                .label(format!("this is {found}")),
            );
            return None;
        }
        let count = self.after(&mut [&mut value], |this| this.value(values[1], Type::LINT))?;
        self.apply(op, ty, vec![value, count], ty, name.span)
    }

    /// `SEL(G, IN0, IN1)`: both inputs are evaluated.
    fn select(&mut self, values: &[&ast::Expr<'s>], expected: Option<Type>, name: ast::Name<'s>) -> Option<Expr> {
        let mut selector = self.value(values[0], Type::BOOL)?;
        let mark = self.block.len();
        let (ty, mut inputs) = self.same_type(&values[1..], expected, name)?;
        if self.block.len() > mark {
            selector = self.save_before(selector, mark);
        }
        if self.decl.program.lane(ty).is_some() {
            inputs.insert(0, selector);
            return self.apply(Op::Sel, ty, inputs, ty, name.span);
        }
        let [first, second] = <[Expr; 2]>::try_from(inputs).ok()?;
        let result = self.temporary("selected", ty);
        let at = self.at(name.span);
        let then = vec![Statement::assign(result.clone(), second, at)];
        let otherwise = vec![Statement::assign(result.clone(), first, at)];
        self.push(StatementKind::If { condition: selector, then, otherwise }, name.span);
        Some(Expr::load(result, at))
    }

    /// Saves a value in front of statements that were hoisted after it was computed.
    fn save_before(&mut self, value: Expr, mark: usize) -> Expr {
        if value.as_const().is_some() {
            return value;
        }
        let at = value.at;
        let place = self.temporary("saved", value.ty);
        self.block.insert(mark, Statement::assign(place.clone(), value, at));
        Expr::load(place, at)
    }

    /// `MUX(K, IN0, …)`: all inputs are evaluated; a K outside of them faults.
    fn mux(
        &mut self,
        name: ast::Name<'s>,
        arguments: &[ast::Argument<'s>],
        expected: Option<Type>,
        span: Span,
    ) -> Option<Expr> {
        let shape = Shape { names: vec!["K".into(), "IN0".into(), "IN1".into()], extensible: true };
        let values = self.arguments(name, &shape, arguments, span)?;
        let mut selector = self.typed(values[0], None)?;
        let integer = matches!(selector.ty, Type::Elementary(it) if it.is_integer());
        if !integer {
            let found = self.type_name(selector.ty);
            self.error(Code::E0201, values[0].span, format!("K is an integer, this is {found}"));
            return None;
        }
        let mark = self.block.len();
        let (ty, inputs) = self.same_type(&values[1..], expected, name)?;
        if self.block.len() > mark {
            selector = self.save_before(selector, mark);
        }
        let at = self.at(name.span);
        let result = self.temporary("selected", ty);
        let mut arms = Vec::new();
        for (number, input) in (0i128..).zip(inputs) {
            // All inputs are evaluated, the selected one last: a fault in any of them counts.
            let input = if can_fault(&input) { self.save_before(input, self.block.len()) } else { input };
            let body = vec![Statement::assign(result.clone(), input, at)];
            arms.push(Arm { labels: vec![(number, number)], body });
        }
        let outside = vec![Statement::new(StatementKind::Fault(FaultKind::IndexOutOfRange), at)];
        self.push(StatementKind::Case { selector, arms, otherwise: outside }, name.span);
        Some(Expr::load(result, at))
    }

    /// Functions of one number (and EXPT).
    fn numeric(
        &mut self,
        op: Op,
        values: &[&ast::Expr<'s>],
        expected: Option<Type>,
        name: ast::Name<'s>,
    ) -> Option<Expr> {
        if op == Op::Expt {
            return self.chain(ast::BinaryOp::Power, values, expected, name)?.typed().cloned();
        }
        let value = self.typed(values[0], expected.filter(|it| is_number(*it)))?;
        let ty = value.ty;
        if op == Op::Abs {
            if !is_number(ty) {
                let found = self.type_name(ty);
                self.report(
                    Diagnostic::new(Code::E0204, values[0].span, format!("`ABS` takes a number, this is {found}"))
                        .label(format!("this is {found}")),
                );
                return None;
            }
            return self.apply(op, ty, vec![value], ty, name.span);
        }
        let ty = match ty {
            Type::Elementary(it) if it.is_real() => ty,
            Type::Elementary(it) if it.is_integer() => {
                Type::Elementary(join(it, Elementary::Real).unwrap_or(Elementary::Lreal))
            }
            other => {
                self.report_not_real(other, values[0].span, name);
                return None;
            }
        };
        let value = self.convert(Conversion::Value, ty, value);
        self.apply(op, ty, vec![value], ty, name.span)
    }

    /// `ATAN2(Y, X)`, at the wider type of the two.
    fn angle(&mut self, values: &[&ast::Expr<'s>], expected: Option<Type>, name: ast::Name<'s>) -> Option<Expr> {
        let expected = expected.filter(|it| matches!(it, Type::Elementary(it) if it.is_real()));
        let operands = self.in_order(values, expected)?;
        let mut wide: Option<Elementary> = None;
        for (operand, value) in operands.iter().zip(values) {
            match operand.ty() {
                None => {}
                Some(Type::Elementary(it)) if it.is_integer() || it.is_real() => {
                    let so_far = wide.unwrap_or(Elementary::Real);
                    wide = Some(join(so_far, it).unwrap_or(Elementary::Lreal));
                }
                Some(other) => {
                    self.report_not_real(other, value.span, name);
                    return None;
                }
            }
        }
        let ty = wide.map(Type::Elementary).or(expected).unwrap_or(Type::LREAL);
        let mut angle = Vec::new();
        for (operand, value) in operands.into_iter().zip(values) {
            angle.push(match operand {
                Operand::Typed(expr) => self.convert(Conversion::Value, ty, expr),
                literal => self.coerce(literal, ty, value.span)?,
            });
        }
        self.apply(Op::Atan2, ty, angle, ty, name.span)
    }

    fn report_not_real(&mut self, found: Type, span: Span, name: ast::Name<'s>) {
        let found = self.type_name(found);
        let message = format!("`{}` takes a REAL or LREAL, this is {found}", name.text);
        self.report(Diagnostic::new(Code::E0204, span, message).label(format!("this is {found}")));
    }

    fn text_function(
        &mut self,
        op: TextOp,
        name: ast::Name<'s>,
        arguments: &[ast::Argument<'s>],
        span: Span,
    ) -> Option<Expr> {
        let shape = text_shape(op);
        let values = self.arguments(name, &shape, arguments, span)?;
        let mut operands: Vec<Expr> = Vec::new();
        for (at, value) in values.iter().enumerate() {
            let lane = op.operands().get(at).copied().unwrap_or(None);
            let mut done: Vec<_> = operands.iter_mut().collect();
            let operand = self.after(&mut done, |this| match lane {
                Some(_) => this.value(value, Type::LINT),
                None => this.text(value, name).map(|it| this.shallow(it)),
            })?;
            operands.push(operand);
        }
        if op == TextOp::Concat {
            return self.concat(operands, name.span);
        }
        let ty = match op.result() {
            Some(_) => Type::INT,
            None => Type::String(text_capacity(op, &operands)),
        };
        let at = self.at(name.span);
        Some(Expr::new(ty, ExprKind::ApplyText(op, operands), at))
    }

    fn concat(&mut self, operands: Vec<Expr>, span: Span) -> Option<Expr> {
        let at = self.at(span);
        let mut operands = operands.into_iter();
        let mut result = operands.next()?;
        for operand in operands {
            let ty = Type::String(capacity(&result).saturating_add(capacity(&operand)).min(32767));
            let joined = Expr::new(ty, ExprKind::ApplyText(TextOp::Concat, vec![result, operand]), at);
            result = self.shallow(joined);
        }
        Some(result)
    }

    /// The text, kept in a variable where it is the result of many functions in one another: each is
    /// a type of its own to rustc, which takes no more than some hundred in one another.
    fn shallow(&mut self, text: Expr) -> Expr {
        if text_depth(&text) < MAX_TEXT_DEPTH {
            return text;
        }
        let mark = self.block.len();
        self.save_before(text, mark)
    }

    fn text(&mut self, value: &ast::Expr<'s>, name: ast::Name<'s>) -> Option<Expr> {
        let text = self.typed(value, None)?;
        if let Type::String(_) = text.ty {
            return Some(text);
        }
        let found = self.type_name(text.ty);
        self.report(
            Diagnostic::new(Code::E0201, value.span, format!("`{}` takes a STRING, this is {found}", name.text))
                .label("expected STRING"),
        );
        None
    }
}

/// How many text functions are nested in the expression.
fn text_depth(expr: &Expr) -> usize {
    match &expr.kind {
        ExprKind::ApplyText(_, operands) => 1 + operands.iter().map(text_depth).max().unwrap_or(0),
        ExprKind::Convert(_, inner) => text_depth(inner),
        ExprKind::Apply(_, operands) => operands.iter().map(text_depth).max().unwrap_or(0),
        ExprKind::Const(_) | ExprKind::Text(_) | ExprKind::Aggregate(_) | ExprKind::Load(_) => 0,
    }
}

fn capacity(expr: &Expr) -> u16 {
    match expr.ty {
        Type::String(capacity) => capacity,
        Type::Elementary(_)
        | Type::Subrange(..)
        | Type::Enum(_)
        | Type::Array(_)
        | Type::Struct(_)
        | Type::Block(_) => 0,
    }
}

/// The longest result: what is inserted adds to the text.
fn text_capacity(op: TextOp, operands: &[Expr]) -> u16 {
    let own = operands.first().map_or(0, capacity);
    match op {
        TextOp::Insert | TextOp::Replace => own.saturating_add(operands.get(1).map_or(0, capacity)).min(32767),
        _ => own,
    }
}

fn expressions(arguments: &mut [Argument]) -> Vec<&mut Expr> {
    let mut found = Vec::new();
    for argument in arguments {
        match argument {
            Argument::Value(expr) => found.push(expr),
            Argument::Reference(place) => {
                for projection in &mut place.projections {
                    if let staunch_ir::Projection::Index { index, .. } = projection {
                        found.push(index);
                    }
                }
            }
        }
    }
    found
}

fn can_fault(expr: &Expr) -> bool {
    let place_can = |place: &staunch_ir::Place| {
        place.projections.iter().any(|it| matches!(it, staunch_ir::Projection::Index { .. }))
    };
    match &expr.kind {
        ExprKind::Const(_) | ExprKind::Text(_) | ExprKind::Aggregate(_) => false,
        ExprKind::Load(place) => place_can(place),
        ExprKind::Apply(op, operands) => op.can_fault() || operands.iter().any(can_fault),
        ExprKind::ApplyText(_, operands) => operands.iter().any(can_fault),
        ExprKind::Convert(_, inner) => can_fault(inner),
    }
}

fn is_number(ty: Type) -> bool {
    matches!(ty, Type::Elementary(it) if it.is_integer() || it.is_real())
}

fn shape(names: &[&str]) -> Shape {
    Shape { names: names.iter().map(|it| (*it).to_owned()).collect(), extensible: false }
}

/// The standard's names of an operation's parameters.
fn op_shape(op: Op) -> Shape {
    let pair = |extensible| Shape { names: vec!["IN1".into(), "IN2".into()], extensible };
    match op {
        Op::Add | Op::Mul | Op::And | Op::Or | Op::Xor | Op::Max | Op::Min => pair(true),
        Op::Eq | Op::Lt | Op::Le | Op::Gt | Op::Ge => pair(true),
        Op::Sub | Op::Div | Op::Mod | Op::Ne | Op::Expt => pair(false),
        Op::Shl | Op::Shr | Op::Rol | Op::Ror => shape(&["IN", "N"]),
        Op::Limit | Op::InRange => shape(&["MN", "IN", "MX"]),
        Op::Sel => shape(&["G", "IN0", "IN1"]),
        Op::Atan2 => shape(&["Y", "X"]),
        Op::Neg
        | Op::Abs
        | Op::Sqrt
        | Op::Ln
        | Op::Log
        | Op::Exp
        | Op::Sin
        | Op::Cos
        | Op::Tan
        | Op::Asin
        | Op::Acos
        | Op::Atan
        | Op::Not => shape(&["IN"]),
    }
}

fn text_shape(op: TextOp) -> Shape {
    match op {
        TextOp::Compare | TextOp::Find => shape(&["IN1", "IN2"]),
        TextOp::Concat => Shape { names: vec!["IN1".into(), "IN2".into()], extensible: true },
        TextOp::Len => shape(&["IN"]),
        TextOp::Left | TextOp::Right => shape(&["IN", "L"]),
        TextOp::Mid | TextOp::Delete => shape(&["IN", "L", "P"]),
        TextOp::Insert => shape(&["IN1", "IN2", "P"]),
        TextOp::Replace => shape(&["IN1", "IN2", "L", "P"]),
    }
}

fn split_number(name: &str) -> Option<(&str, usize)> {
    let at = name.find(|it: char| it.is_ascii_digit())?;
    Some((&name[..at], name[at..].parse().ok()?))
}

/// The operator that means the same as the function.
fn infix(op: Op) -> Option<ast::BinaryOp> {
    use ast::BinaryOp;
    Some(match op {
        Op::Add => BinaryOp::Add,
        Op::Sub => BinaryOp::Sub,
        Op::Mul => BinaryOp::Mul,
        Op::Div => BinaryOp::Div,
        Op::Mod => BinaryOp::Mod,
        Op::And => BinaryOp::And,
        Op::Or => BinaryOp::Or,
        Op::Xor => BinaryOp::Xor,
        Op::Eq => BinaryOp::Eq,
        Op::Ne => BinaryOp::Ne,
        Op::Lt => BinaryOp::Lt,
        Op::Le => BinaryOp::Le,
        Op::Gt => BinaryOp::Gt,
        Op::Ge => BinaryOp::Ge,
        _ => return None,
    })
}
