//! Operators: the type at which two sides meet, and what is computed there.

use super::checker::{Checker, Context};
use super::coverage::JOINED;
use super::operand::{Operand, computed};
use crate::diagnostic::Subject;
use crate::dialect::Dialect;
use crate::dialect::rules::{Functions, Literals};
use crate::types::coercion::{Join, as_number, join, join_in};
use crate::{Code, Diagnostic, Span, ast};
use ast::BinaryOp;
use staunch_ir::narrow::is_narrow;
use staunch_ir::{Block, Conversion, Elementary, Expr, ExprKind, Op, Part, Statement, StatementKind, Type, Use, Value};
use staunch_runtime::Class;

const REAL: Type = Type::Elementary(Elementary::Real);

impl<'s> Checker<'_, 's> {
    pub(crate) fn binary(
        &mut self,
        [left, right]: &[ast::Expr<'s>; 2],
        op: BinaryOp,
        op_span: Span,
        expected: Option<Type>,
        span: Span,
    ) -> Option<Operand> {
        if matches!(op, BinaryOp::AndThen | BinaryOp::OrElse) {
            return self.short_circuit(left, op, right, span).map(Operand::Typed);
        }
        if op == BinaryOp::Power
            && self.decl.dialect(op_span).raises_before_signs()
            && self.begins_with_sign(left, op_span)
            && let Some((sign, base)) = leading_sign(left)
        {
            let power = ast::ExprKind::Binary(Box::new([base, right.clone()]), op, op_span);
            let power = Box::new(ast::Expr { kind: power, span });
            return self.operand(&ast::Expr { kind: ast::ExprKind::Unary(sign, power), span }, expected);
        }
        let hint = expected.filter(|_| !compares(op)).or_else(|| self.bits_beside(left, right, op));
        if matches!(op, BinaryOp::And | BinaryOp::Or)
            && self.context == Context::Body
            && self.decl.dialect(op_span).rules().skips_second_side()
        {
            return self.second_if_it_decides([left, right], op, (op_span, span), hint);
        }
        // Both sides are checked before giving up, so that one run reports every mistake.
        let a = self.operand(left, hint);
        let Some(mut a) = a else {
            self.operand(right, hint);
            return None;
        };
        let right_hint = beside(&a, hint).or_else(|| self.bits_of_side(a.ty(), right, op));
        let mark = self.block.len();
        let b = self.after(a.typed_mut().as_mut_slice(), |this| this.operand(right, right_hint))?;
        self.note_siblings(mark, b.typed());
        // A bare enumerator on the left listens to the right side.
        if let (Some(Type::Enum(x)), Some(Type::Enum(y))) = (a.ty(), b.ty())
            && x != y
            && let ast::ExprKind::Name(_) = left.kind
        {
            a = self.operand(left, Some(Type::Enum(y)))?;
        }
        if compares(op) && [left, right].iter().all(|it| is_text(it)) {
            self.note_use(Use::Part(Part::ComparedLiterals), op_span);
        }
        let sides = Sides { a, b, left: left.span, right: right.span, op, op_span, span, hint };
        self.combine(sides)
    }

    /// Whether a sign is written before the operator's left side: neither in parentheses, as an argument of EXPT is, nor in a literal,
    /// `REAL#-2.5`.
    fn begins_with_sign(&self, left: &ast::Expr<'s>, op_span: Span) -> bool {
        left.span.end <= op_span.start && self.decl.log.sources.text(left.span).starts_with(['-', '+'])
    }

    /// The bit string that a call or a number on the left listens to: that of the variable on the right.
    fn bits_beside(&mut self, left: &ast::Expr<'s>, right: &ast::Expr<'s>, op: BinaryOp) -> Option<Type> {
        if !matches!(right.bare().kind, ast::ExprKind::Name(_) | ast::ExprKind::Member(..)) {
            return None;
        }
        self.bits_of_side(Some(Type::Elementary(Elementary::Byte)), left, op)?;
        let found = self.tried(right.span, |this| this.operand(right, None))??.ty();
        self.bits_of_side(found, left, op)
    }

    /// NOT of a number without a type takes that of the bit string on the other side. MATIEC compares a bit string with a call of SEL, MUX
    /// and the like at its type, also where that is given numbers alone.
    fn bits_of_side(&self, ty: Option<Type>, side: &ast::Expr<'s>, op: BinaryOp) -> Option<Type> {
        let is_matiec = self.decl.dialect(side.span).rules().functions.choice == Functions::OfMatiec;
        let is_number = |it: &ast::Expr<'_>| matches!(it.bare().kind, ast::ExprKind::Literal(_));
        let listens = match &side.bare().kind {
            ast::ExprKind::Call(..) => is_matiec && compares(op),
            ast::ExprKind::Unary(ast::UnaryOp::Not, inner) => {
                matches!(op, BinaryOp::And | BinaryOp::Or | BinaryOp::Xor) && is_number(inner)
            }
            _ => false,
        };
        ty.filter(|it| listens && matches!(it, Type::Elementary(it) if it.is_bits() && *it != Elementary::Bool))
    }

    /// The operation on two sides that have been checked.
    pub(crate) fn combine(&mut self, mut sides: Sides) -> Option<Operand> {
        self.note_operator(sides.op.text(), &[&sides.a, &sides.b], sides.op_span);
        self.note_fraction(&sides.a, &sides.b, sides.op_span);
        if sides.a.is_reference() || sides.b.is_reference() {
            return self.reference_operation(sides);
        }
        if sides.a.typed().is_none() && sides.b.typed().is_none() {
            if let Some(folded) = self.fold_untyped(sides.op, &sides.a, &sides.b, sides.span) {
                return folded;
            }
            // Integers are divided as such, also by 0, whatever the quotient is stored in.
            let are_integers = matches!((&sides.a, &sides.b), (Operand::Integer(_), Operand::Integer(_)));
            let is_real = |it: &Type| matches!(it, Type::Elementary(it) if it.is_real());
            let hint = sides
                .hint
                .filter(|it| !(are_integers && matches!(sides.op, BinaryOp::Div | BinaryOp::Mod) && is_real(it)));
            sides.a = Operand::Typed(self.materialise(sides.a, hint, sides.left)?);
            if let (Operand::Integer(_), Some(ty)) = (&sides.b, sides.a.ty())
                && matches!(ty, Type::Elementary(it) if it.is_real())
            {
                sides.b = Operand::Typed(self.coerce(sides.b, ty, sides.right)?);
            }
        }
        self.operate(sides)
    }

    fn operate(&mut self, sides: Sides) -> Option<Operand> {
        match sides.op {
            BinaryOp::Lt | BinaryOp::Gt | BinaryOp::Le | BinaryOp::Ge | BinaryOp::Eq | BinaryOp::Ne => {
                self.compare(sides).map(Operand::Typed)
            }
            BinaryOp::And | BinaryOp::Or | BinaryOp::Xor => {
                let sides = self.counted(sides);
                self.bitwise(sides)
            }
            BinaryOp::Power => {
                let sides = self.counted(sides);
                self.power(sides)
            }
            BinaryOp::Add | BinaryOp::Sub | BinaryOp::Mul | BinaryOp::Div | BinaryOp::Mod => {
                let sides = self.counted(sides);
                self.arithmetic(sides)
            }
            BinaryOp::AndThen | BinaryOp::OrElse => None,
        }
    }

    /// The sides of what is computed with numbers, which enumerations may be.
    fn counted(&mut self, sides: Sides) -> Sides {
        let is_number = |this: &Self, side: &Operand| match side.ty() {
            Some(Type::Enum(id)) => this.counts_as_number(id, sides.span),
            Some(_) | None => true,
        };
        let all = is_number(self, &sides.a) && is_number(self, &sides.b);
        if all { self.enums_as_numbers(sides) } else { sides }
    }

    /// The one type of both sides, and the sides converted to it.
    pub(super) fn meet(&mut self, sides: Sides, allowed: fn(Elementary, bool) -> bool, wants: &str) -> Option<Meeting> {
        let dialect = self.decl.dialect(sides.span);
        let mixes = dialect.mixes_bits_and_integers();
        let own = match common(&sides, [sides.a.ty(), sides.b.ty()], mixes, dialect, join_in(dialect)) {
            Some(ty) if allowed(ty, mixes) => ty,
            _ => {
                self.report_operands(&sides, wants);
                return None;
            }
        };
        let rules = dialect.rules();
        let is_one_type = rules.keeps_one_type() && is_kept(&sides);
        let is_double = own == Elementary::Real && [&sides.a, &sides.b].into_iter().any(is_double);
        let ty = match rules.promotes_integers() && !is_one_type {
            _ if is_double && self.literals_are_doubles(sides.span) => Elementary::Lreal,
            true => promoted(&sides, own, dialect),
            false => own,
        };
        let a = self.side(sides.a, ty, sides.left)?;
        let b = self.side(sides.b, ty, sides.right)?;
        Some(Meeting { ty: Type::Elementary(ty), own: Type::Elementary(own), a, b })
    }

    pub(super) fn side(&mut self, operand: Operand, ty: Elementary, span: Span) -> Option<Expr> {
        match operand {
            // The meeting of a bit string and an integer is decided; the reprs agree in size or widen.
            Operand::Typed(expr) | Operand::Promoted(expr, _) => {
                self.note_conversion(expr.ty, Type::Elementary(ty), span);
                Some(self.convert(Conversion::Value, Type::Elementary(ty), expr))
            }
            Operand::Integer(value) if self.decl.dialect(span).rules().ranks_numbers() => {
                let value = immediate(value, ty).unwrap_or(value);
                self.coerce(Operand::Integer(value), Type::Elementary(ty), span)
            }
            literal => self.coerce(literal, Type::Elementary(ty), span),
        }
    }

    pub(super) fn report_operands(&mut self, sides: &Sides, wants: &str) {
        let name = |this: &Self, operand: &Operand| match operand.ty() {
            Some(ty) => this.type_name(ty),
            None => "a number".to_owned(),
        };
        let (a, b) = (name(self, &sides.a), name(self, &sides.b));
        if let Some(side) = [(&sides.a, sides.left), (&sides.b, sides.right)]
            .into_iter()
            .find(|(operand, _)| operand.ty().is_some_and(|ty| self.decl.instance_in(ty).is_some()))
            && let Some(expr) = side.0.typed()
        {
            let expr = expr.clone();
            let _ = self.coerce(Operand::Typed(expr), Type::BOOL, side.1);
            return;
        }
        let op = sides.op.text();
        let mut error = Diagnostic::new(Code::E0204, sides.op_span, format!("`{op}` does not take {a} and {b}"))
            .label(if long_with_real(sides).is_some() { "no type holds the values of both" } else { wants })
            .other(sides.left, format!("this is {a}"))
            .other(sides.right, format!("this is {b}"));
        if let Some(help) = self.help_for_sides(sides) {
            error = error.help(help);
        } else if let (Some(Type::Elementary(a)), Some(Type::Elementary(b))) = (sides.a.ty(), sides.b.ty()) {
            let bits = [a, b].into_iter().find(|it| it.is_bits() && *it != Elementary::Bool);
            error = match bits {
                Some(bits) => error.help(format!(
                    "convert the bit string to a number with `{}_TO_{}(…)`",
                    bits.name(),
                    as_number(bits).name()
                )),
                None if a == b => error,
                None => error.help("convert one side, so that both have one type"),
            };
        }
        if let (Some(Type::Elementary(a)), Some(Type::Elementary(b))) = (sides.a.ty(), sides.b.ty()) {
            error = error.about(Subject::Mismatch(a, b));
        }
        self.report(error);
    }

    /// What to write instead of an operator that a type does not have.
    fn help_for_sides(&self, sides: &Sides) -> Option<String> {
        let text = |span| self.decl.log.sources.text(span);
        let (a, b) = (text(sides.left), text(sides.right));
        match (sides.a.ty(), sides.b.ty()) {
            (Some(Type::String(_)), Some(Type::String(_))) if matches!(sides.op, BinaryOp::Add | BinaryOp::And) => {
                Some(format!("write `CONCAT({a}, {b})`"))
            }
            (Some(Type::String(it)), Some(Type::Elementary(other))) if sides.op == BinaryOp::Add => {
                Some(format!("write `CONCAT({a}, {}_TO_{}({b}))`", other.name(), it.word()))
            }
            (Some(Type::Elementary(other)), Some(Type::String(it))) if sides.op == BinaryOp::Add => {
                Some(format!("write `CONCAT({}_TO_{}({a}), {b})`", other.name(), it.word()))
            }
            (Some(Type::String(x)), Some(Type::String(y))) if x.wide != y.wide => {
                let narrow = if x.wide { b } else { a };
                Some(match narrow.strip_prefix('\'').and_then(|it| it.strip_suffix('\'')) {
                    Some(text) => {
                        format!("a WSTRING is written {}", self.decl.dialect(sides.left).wide_text("WSTRING", text))
                    }
                    None => format!("write `STRING_TO_WSTRING({narrow})`"),
                })
            }
            (Some(ty @ Type::Enum(_)), None) | (None, Some(ty @ Type::Enum(_))) => {
                Some(format!("name a member: {}", self.members(ty)?))
            }
            (Some(Type::Enum(_)), Some(Type::Elementary(it))) if it.is_integer() => {
                Some(format!("write `TO_{}({a})`", it.name()))
            }
            (Some(Type::Elementary(it)), Some(Type::Enum(_))) if it.is_integer() => {
                Some(format!("write `TO_{}({b})`", it.name()))
            }
            _ if let Some((ty, span)) = long_with_real(sides) => {
                Some(format!("an LREAL may round it: write `{}_TO_LREAL({})`", ty.name(), text(span)))
            }
            (Some(Type::Elementary(x)), Some(Type::Elementary(y))) if x.is_day() && y.is_duration() => Some(format!(
                "convert the day to its midnight first: `{}_TO_{}({a}) {} {b}`",
                x.name(),
                point(x),
                sides.op.text()
            )),
            (Some(Type::Elementary(x)), Some(Type::Elementary(y)))
                if x.is_duration() && y.is(Class::Date) && sides.op == BinaryOp::Add =>
            {
                Some(format!("write the TIME second: `{b} + {a}`"))
            }
            (Some(Type::Elementary(x)), Some(Type::Elementary(y))) if x.is_duration() && y.is_duration() => {
                let units = if x == Elementary::Time { "milliseconds" } else { "nanoseconds" };
                let number = Elementary::number(x.repr()).name();
                let (a, b) = (format!("{}_TO_{number}({a})", x.name()), format!("{}_TO_{number}({b})", y.name()));
                match sides.op {
                    _ if x != y => Some("convert both to one type: `TIME_TO_LTIME(…)`".to_owned()),
                    BinaryOp::Div => Some(format!("divide their {units}: `{a} / {b}`")),
                    BinaryOp::Mod => {
                        Some(format!("compute with their {units}: `{number}_TO_{}({a} MOD {b})`", x.name()))
                    }
                    _ => None,
                }
            }
            (Some(Type::BOOL), None) if is_junction(sides.op) => {
                Some(format!("each side of {0} is a separate comparison: `x = 1 {0} x = 2`", sides.op.text()))
            }
            (Some(Type::BOOL), None) if a.contains(['<', '>', '=']) => Some(match last_operand(a) {
                Some(middle) => format!("compare twice: `{a} AND {middle} {} {b}`", sides.op.text()),
                None => "join two comparisons: `low < x AND x < high`".to_owned(),
            }),
            (Some(Type::Elementary(it)), None) if it.is_bits() && it != Elementary::Bool && !is_junction(sides.op) => {
                Some(format!("write `{}`", converted(sides, it, as_number(it).name(), a, b)))
            }
            (Some(Type::Elementary(it)), None) if it.is_integer() && is_junction(sides.op) => {
                Some(format!("write `{}`", converted(sides, it, as_bits(it), a, b)))
            }
            (Some(Type::Elementary(x)), Some(Type::Elementary(y)))
                if x.is_integer() && x == y && is_junction(sides.op) =>
            {
                let op = sides.op.text();
                let (x, bits) = (x.name(), as_bits(x));
                Some(format!(
                    "for bits, convert both with `{x}_TO_{bits}(…)`; for conditions, compare: `{a} <> 0 {op} {b} <> 0`"
                ))
            }
            (Some(Type::Elementary(x)), _) if x.is_real() && sides.op == BinaryOp::Mod => {
                Some(format!("write `{a} - {b} * DINT_TO_{}(TRUNC({a} / {b}))`", x.name()))
            }
            (Some(Type::BOOL), Some(Type::Elementary(_)))
                if let (Some(middle), false) = (last_operand(a), is_junction(sides.op)) =>
            {
                Some(format!("compare twice: `{a} AND {middle} {} {b}`", sides.op.text()))
            }
            (Some(Type::Elementary(it)), None) if it.is_duration() => Some(format!("write the unit: `T#{b}ms`")),
            (None, Some(Type::Elementary(it))) if it.is_duration() => Some(format!("write the unit: `T#{a}ms`")),
            _ => None,
        }
    }

    fn compare(&mut self, sides: Sides) -> Option<Expr> {
        let op = comparison(sides.op);
        let op_span = sides.op_span;
        match (sides.a.ty(), sides.b.ty()) {
            (Some(Type::String(x)), Some(Type::String(y))) if x.wide == y.wide => {
                let (Operand::Typed(a), Operand::Typed(b)) = (sides.a, sides.b) else { return None };
                self.compare_texts(op, a, b, op_span)
            }
            (Some(Type::Elementary(it)), Some(ty @ Type::String(_))) if it.is_char() => {
                let a = self.coerce(sides.a, ty, sides.left)?;
                self.compare(Sides { a: Operand::Typed(a), ..sides })
            }
            (Some(ty @ Type::String(_)), Some(Type::Elementary(it))) if it.is_char() => {
                let b = self.coerce(sides.b, ty, sides.right)?;
                self.compare(Sides { b: Operand::Typed(b), ..sides })
            }
            (Some(Type::Enum(a)), Some(Type::Enum(b))) if a == b => {
                let (Operand::Typed(a), Operand::Typed(b)) = (sides.a, sides.b) else { return None };
                let ty = a.ty;
                self.apply(op, ty, vec![a, b], Type::BOOL, op_span)
            }
            (Some(Type::Enum(_)), _) | (_, Some(Type::Enum(_))) if self.compare_as_numbers(&sides) => {
                let sides = self.enums_as_numbers(sides);
                self.compare(sides)
            }
            _ => {
                let equality = matches!(op, Op::Eq | Op::Ne);
                self.always_the_same(&sides);
                let Meeting { ty, a, b, .. } =
                    self.meet(sides, |_, _| true, "both sides need one type that can be compared")?;
                let of = ty.elementary()?;
                // A real that was set to 0 is 0: what guards a division is right.
                let has_zero = [&a, &b].into_iter().any(|it| is_zero(it.as_const()));
                if of.is_real() && equality && !has_zero {
                    self.report(
                        Diagnostic::new(Code::W0503, op_span, "REAL values are compared for equality")
                            .label("rounding makes equal results differ")
                            .help("compare their difference with a tolerance: `ABS(a - b) < 0.001`"),
                    );
                }
                self.compared_with_zero(op, of, [&a, &b], op_span);
                self.apply(op, ty, vec![a, b], Type::BOOL, op_span)
            }
        }
    }

    /// Whether the enumerations among the sides are compared as numbers.
    fn compare_as_numbers(&self, sides: &Sides) -> bool {
        let is_number = |side: &Operand| match side.ty() {
            Some(Type::Enum(id)) => self.decl.table.named_values.contains(&id),
            Some(_) | None => true,
        };
        self.decl.dialect(sides.span).mixes_bits_and_integers() || is_number(&sides.a) && is_number(&sides.b)
    }

    fn enums_as_numbers(&mut self, mut sides: Sides) -> Sides {
        sides.a = self.enum_as_number(sides.a);
        sides.b = self.enum_as_number(sides.b);
        sides
    }

    fn enum_as_number(&mut self, operand: Operand) -> Operand {
        match operand {
            Operand::Typed(expr) => match expr.ty {
                Type::Enum(id) => {
                    let base = Type::Elementary(self.decl.program.enumeration(id).base);
                    Operand::Typed(self.convert(Conversion::Same, base, expr))
                }
                _ => Operand::Typed(expr),
            },
            other => other,
        }
    }

    /// `**`: a REAL or LREAL base gives its own type, whatever the exponent is. A REAL to the power of what REAL does not
    /// hold exactly goes through LREAL. Integers as a base are converted.
    fn power(&mut self, sides: Sides) -> Option<Operand> {
        let op_span = sides.op_span;
        let mixes = self.decl.dialect(sides.span).mixes_bits_and_integers();
        let is_number =
            |it: Elementary| it.is_real() || it.is_integer() || mixes && it.is_bits() && it != Elementary::Bool;
        let numeric = |operand: &Operand| match operand.ty() {
            Some(Type::Elementary(it)) => is_number(it),
            Some(_) => false,
            None => true,
        };
        if !numeric(&sides.a) || !numeric(&sides.b) {
            self.report_operands(&sides, "both sides need to be numbers");
            return None;
        }
        let is_long = |operand: &Operand| matches!(operand.ty(), Some(Type::Elementary(it)) if it == Elementary::Lreal || it.repr().size() > 2 && !it.is_real() && is_number(it));
        let as_c = self.decl.dialect(sides.span).rules().functions.choice.computes_at_lreal();
        let long = is_long(&sides.a) || is_long(&sides.b) || as_c;
        let keeps_base = self.decl.dialect(sides.span).powers_have_type_of_base();
        let is_real = match sides.a.ty() {
            Some(ty) => keeps_base && ty == REAL,
            // A literal is what it is asked to be.
            None => keeps_base && sides.hint == Some(REAL) && matches!(sides.a, Operand::Real { .. }),
        };
        let asks = sides.hint == Some(Type::LREAL);
        let ty = Type::Elementary(if is_real || !long && !asks { Elementary::Real } else { Elementary::Lreal });
        let computed = if long || asks && !is_real { Elementary::Lreal } else { Elementary::Real };
        let mut a = self.side(sides.a, if is_real { Elementary::Real } else { computed }, sides.left)?;
        if is_real {
            a = self.convert(Conversion::Value, Type::Elementary(computed), a);
        }
        let b = self.side(sides.b, computed, sides.right)?;
        let computed = Type::Elementary(computed);
        let power = self.apply(Op::Expt, computed, vec![a, b], computed, op_span)?;
        if as_c {
            return Some(super::operand::computed(power, ty));
        }
        Some(Operand::Typed(self.convert(Conversion::Value, ty, power)))
    }

    fn arithmetic(&mut self, sides: Sides) -> Option<Operand> {
        let of_class = |operand: &Operand, class| matches!(operand.ty(), Some(Type::Elementary(it)) if it.is(class));
        if of_class(&sides.a, Class::Date) || of_class(&sides.b, Class::Date) {
            return self.date_arithmetic(sides).map(Operand::Typed);
        }
        let time = |operand: &Operand| of_class(operand, Class::Duration);
        match (sides.op, time(&sides.a), time(&sides.b)) {
            (BinaryOp::Mul, true, false) | (BinaryOp::Div, true, false) => self.scale_time(sides).map(Operand::Typed),
            (BinaryOp::Mul, false, true) => {
                let swapped = Sides { a: sides.b, b: sides.a, left: sides.right, right: sides.left, ..sides };
                self.scale_time(swapped).map(Operand::Typed)
            }
            (BinaryOp::Add | BinaryOp::Sub, true, true) => self.add_times(sides).map(Operand::Typed),
            (_, true, _) | (_, _, true) => {
                self.report_operands(&sides, "a TIME is added to a TIME, and multiplied or divided by a number");
                None
            }
            _ => self.plain_arithmetic(sides),
        }
    }

    fn plain_arithmetic(&mut self, sides: Sides) -> Option<Operand> {
        let op = arithmetic_op(sides.op);
        let op_span = sides.op_span;
        let of_reals = self.decl.dialect(op_span).rules().has_modulo_of_reals();
        let allowed: fn(Elementary, bool) -> bool = match sides.op {
            BinaryOp::Mod if !of_reals => {
                |ty, mixes| ty.is_integer() || (mixes && ty.is_bits() && ty != Elementary::Bool)
            }
            _ => |ty, mixes| ty.is_integer() || ty.is_real() || (mixes && ty.is_bits() && ty != Elementary::Bool),
        };
        let wants = if sides.op == BinaryOp::Mod && !of_reals {
            "both sides need to be integers"
        } else {
            "both sides need to be numbers"
        };
        let Meeting { ty, own, a, b } = self.meet(sides, allowed, wants)?;
        let is_real = ty.elementary().is_some_and(Elementary::is_real);
        let value = match op {
            Op::Mod if is_real => self.remainder(ty, a, b, op_span)?,
            Op::Div | Op::Mod => self.divided(op, ty, (a, b), op_span)?,
            _ => self.apply(op, ty, vec![a, b], ty, op_span)?,
        };
        Some(computed(value, own))
    }

    /// `a - TRUNC(a / b) * b`: MOD of reals (1756-RM003N, p. 279).
    fn remainder(&mut self, ty: Type, mut a: Expr, mut b: Expr, span: Span) -> Option<Expr> {
        for (name, side) in [("dividend", &mut a), ("divisor", &mut b)] {
            if side.as_const().is_none() {
                self.save(name, side);
            }
        }
        let quotient = self.apply(Op::Div, ty, vec![a.clone(), b.clone()], ty, span)?;
        let whole = self.apply(Op::Whole, ty, vec![quotient], ty, span)?;
        let product = self.apply(Op::Mul, ty, vec![whole, b], ty, span)?;
        self.apply(Op::Sub, ty, vec![a, product], ty, span)
    }

    /// `a AND_THEN b`: `b` is evaluated only when it decides.
    fn short_circuit(&mut self, left: &ast::Expr<'s>, op: BinaryOp, right: &ast::Expr<'s>, span: Span) -> Option<Expr> {
        let a = self.condition(left);
        self.count_operand(a.as_ref());
        let mut b = None;
        let outer = self.may_not_run;
        self.may_not_run |= self.context != Context::Body && a.as_ref().is_some_and(|it| decides(op, it));
        let evaluate = self.nested(|this| {
            b = this.condition(right);
            this.count_operand(b.as_ref());
        });
        self.may_not_run = outer;
        let (a, b) = (a?, b?);
        if let Some(known) = self.decided(op, &a, &b) {
            return Some(known);
        }
        Some(self.decided_by(op, a, (evaluate, b), span))
    }

    /// What a short-circuit operator gives, of its first side and of the second with what that evaluates.
    fn decided_by(&mut self, op: BinaryOp, a: Expr, (evaluate, b): (Block, Expr), span: Span) -> Expr {
        let at = self.at(span);
        let result = self.temporary(JOINED, Type::BOOL);
        self.block.push(Statement::assign(result.clone(), a, at));
        let mut decide = evaluate;
        decide.push(Statement::assign(result.clone(), b, at));
        let condition = Expr::load(result.clone(), at);
        let is_and = matches!(op, BinaryOp::AndThen | BinaryOp::And);
        let (then, otherwise) = if is_and { (decide, Vec::new()) } else { (Vec::new(), decide) };
        self.push(StatementKind::If { condition, then, otherwise }, span);
        Expr::load(result, at)
    }

    /// AND and OR, which evaluate the second of two BOOLs only where it decides, as `&&` and `||` of C do.
    fn second_if_it_decides(
        &mut self,
        [left, right]: [&ast::Expr<'s>; 2],
        op: BinaryOp,
        (op_span, span): (Span, Span),
        hint: Option<Type>,
    ) -> Option<Operand> {
        let a = self.operand(left, hint);
        let is_bool = a.as_ref().and_then(Operand::ty) == Some(Type::BOOL);
        let beside = |it: &Operand| beside(it, hint).or_else(|| self.bits_of_side(it.ty(), right, op));
        let right_hint = a.as_ref().map_or(hint, beside);
        let mut b = None;
        let evaluate = self.nested(|this| b = this.operand(right, right_hint));
        let (mut a, mut b) = (a?, b?);
        let has_effects = !evaluate.is_empty() || b.typed().is_some_and(|it| self.can_fault(it));
        if !is_bool || b.ty() != Some(Type::BOOL) || !has_effects {
            self.after(a.typed_mut().as_mut_slice(), |this| {
                this.block.extend(evaluate);
                Some(())
            });
            let sides = Sides { a, b, left: left.span, right: right.span, op, op_span, span, hint };
            return self.combine(sides);
        }
        self.note_operator(op.text(), &[&a, &b], op_span);
        let (first, second) = (a.typed_mut()?.clone(), b.typed_mut()?.clone());
        Some(Operand::Typed(self.decided_by(op, first, (evaluate, second), span)))
    }

    /// A short-circuit operator of constants, where a constant is wanted: its value, even if the second would fault and
    /// is not evaluated.
    fn decided(&self, op: BinaryOp, a: &Expr, b: &Expr) -> Option<Expr> {
        let known = self.context != Context::Body && is_of_constants(b);
        (known && a.as_const().is_some()).then(|| if decides(op, a) { a.clone() } else { b.clone() })
    }
}

/// Whether nothing but constants is in the expression: also in one that would fault.
fn is_of_constants(expr: &Expr) -> bool {
    match &expr.kind {
        ExprKind::Const(_) | ExprKind::Text(_) | ExprKind::Aggregate(_) => true,
        ExprKind::Load(_) | ExprKind::AddressOf(_) => false,
        ExprKind::Apply(_, operands) | ExprKind::ApplyText(_, operands) => operands.iter().all(is_of_constants),
        ExprKind::Convert(_, operand) => is_of_constants(operand),
    }
}

/// Whether the first side of a short-circuit operator is a constant that leaves the second unevaluated.
fn decides(op: BinaryOp, first: &Expr) -> bool {
    first.as_const() == Some(Value::Bool(op != BinaryOp::AndThen))
}

/// The two sides of an operator, and where they are.
pub(crate) struct Sides {
    pub a: Operand,
    pub b: Operand,
    pub left: Span,
    pub right: Span,
    pub op: BinaryOp,
    pub op_span: Span,
    pub span: Span,
    pub hint: Option<Type>,
}

/// The expected type of the other operand next to `a`.
pub(crate) fn beside(a: &Operand, hint: Option<Type>) -> Option<Type> {
    match a.ty() {
        Some(ty @ Type::Enum(_)) => Some(ty),
        // A function of literals takes the type of the side it meets.
        Some(ty @ Type::Elementary(it)) if it.is_integer() || it.is_real() || it.is_char() => Some(ty),
        _ => hint,
    }
}

/// Two sides at the type that they are computed at, and the one that the result counts as.
pub(super) struct Meeting {
    pub ty: Type,
    pub own: Type,
    pub a: Expr,
    pub b: Expr,
}

/// The type in which sides of these types meet, where `None` is a literal's.
/// The side that is an integer of 64 bits, where the other one is a real.
fn long_with_real(sides: &Sides) -> Option<(Elementary, Span)> {
    [(&sides.a, sides.left, &sides.b), (&sides.b, sides.right, &sides.a)].into_iter().find_map(|(side, span, other)| {
        let Some(Type::Elementary(ty)) = side.ty() else { return None };
        (ty.is_integer() && ty.repr().size() == 8 && is_real(other)).then_some((ty, span))
    })
}

fn is_real(operand: &Operand) -> bool {
    match operand {
        Operand::Real { .. } => true,
        typed => matches!(typed.ty(), Some(Type::Elementary(it)) if it.is_real()),
    }
}

fn common(sides: &Sides, types: [Option<Type>; 2], mixes: bool, dialect: Dialect, join: Join) -> Option<Elementary> {
    let number = |ty: Elementary| if mixes { as_number(ty) } else { ty };
    let literal = |ty: Elementary, it: &Operand| literal_meets((number(ty), ty), it, dialect, sides.hint, join);
    match types {
        [Some(Type::Elementary(a)), Some(Type::Elementary(b))] => {
            if a == b {
                Some(a)
            } else {
                join(number(a), number(b)).or_else(|| mixed_signs(a, b, mixes))
            }
        }
        [Some(Type::Elementary(a)), None] => literal(a, &sides.b),
        [None, Some(Type::Elementary(b))] => literal(b, &sides.a),
        _ => None,
    }
}

/// The type at which sides are computed that give one of `own`, where integers are promoted.
fn promoted(sides: &Sides, own: Elementary, dialect: Dialect) -> Elementary {
    let (as_c, ranks) = (dialect.rules().promotes_as_c(), dialect.rules().ranks_numbers());
    let calculates = matches!(sides.op, BinaryOp::Add | BinaryOp::Sub | BinaryOp::Mul | BinaryOp::Div | BinaryOp::Mod)
        || as_c && is_junction(sides.op);
    // A promoted value may be negative: it is compared with a UDINT by what it is. C and Logix make a UDINT of it.
    let compared = compares(sides.op) && as_number(own) == Elementary::Udint && !as_c && !ranks;
    if as_c && (calculates || compares(sides.op)) && own.is_integer() && [&sides.a, &sides.b].into_iter().any(is_long) {
        return join(own, Elementary::Lint).unwrap_or(own);
    }
    if !is_narrow(own) && !compared {
        return own;
    }
    match common(sides, [sides.a.computed_at(), sides.b.computed_at()], true, dialect, join) {
        Some(ty) if calculates && is_narrow(ty) => Elementary::Dint,
        ty => ty.unwrap_or(own),
    }
}

/// Whether C++ has an operator for two of the type of both sides, which gives that type: it has none for AND, OR and XOR.
fn is_kept(sides: &Sides) -> bool {
    match (&sides.a, &sides.b) {
        (Operand::Typed(a), Operand::Typed(b)) => a.ty == b.ty && !is_junction(sides.op),
        _ => false,
    }
}

/// A REAL that is a double in C: it has no type, or was computed with one that has none.
fn is_double(side: &Operand) -> bool {
    matches!(side, Operand::Real { .. }) || side.computed_at() == Some(Type::LREAL)
}

/// What is a `long` in C, and counts as a shorter integer: `-2147483648`, whose sign is an operator, and what is
/// computed with that.
fn is_long(side: &Operand) -> bool {
    let is_least = matches!(side, Operand::Integer(value) if *value == i128::from(i32::MIN));
    is_least || side.computed_at() == Some(Type::LINT)
}

/// The types among which a number takes the first that holds it, where the other operand's type does not.
pub(super) fn literal_types(value: i128, beside: Elementary, dialect: Dialect) -> [Elementary; 4] {
    let has_no_sign = value >= 0 && as_number(beside).is_integer() && beside.repr().is_unsigned();
    match dialect.rules().literals.choice {
        Literals::Smallest if has_no_sign => {
            [Elementary::Usint, Elementary::Uint, Elementary::Udint, Elementary::Ulint]
        }
        Literals::OfTheirPlace | Literals::OfC | Literals::Immediate | Literals::Smallest => {
            [Elementary::Int, Elementary::Dint, Elementary::Lint, Elementary::Ulint]
        }
    }
}

/// The type at which a literal meets a typed operand: the operand's, if the literal fits it.
fn literal_meets(
    (number, ty): (Elementary, Elementary),
    literal: &Operand,
    dialect: Dialect,
    hint: Option<Type>,
    join: Join,
) -> Option<Elementary> {
    match literal {
        Operand::Integer(value) => {
            if ty.is_real() || ty.repr().integer(*value).is_some() {
                return Some(ty);
            }
            let own = literal_types(*value, ty, dialect).into_iter().find(|it| it.repr().integer(*value).is_some())?;
            join(number, own)
        }
        Operand::Real { .. } => {
            let real = if hint == Some(Type::LREAL) && !ty.is_real() { Elementary::Lreal } else { Elementary::Real };
            join(number, real)
        }
        Operand::Typed(_) | Operand::Promoted(..) => None,
    }
}

/// A negative DINT as an unsigned integer of 32 bits or more: its low bits, with its sign above.
fn immediate(value: i128, ty: Elementary) -> Option<i128> {
    let is_dint = Elementary::Dint.repr().integer(value).is_some();
    (is_dint && value < 0 && ty.repr().is_unsigned()).then(|| value + (1 << (ty.repr().size() * 8)))
}

/// CODESYS lets a signed and an unsigned 64-bit integer meet at the signed one.
pub(super) fn mixed_signs(a: Elementary, b: Elementary, mixes: bool) -> Option<Elementary> {
    let (a, b) = (as_number(a), as_number(b));
    (mixes && a.is_integer() && b.is_integer()).then_some(Elementary::Lint)
}

/// A literal of a text.
fn is_text(expr: &ast::Expr<'_>) -> bool {
    let ast::ExprKind::Literal(literal) = &expr.bare().kind else { return false };
    matches!(literal.value, ast::LiteralValue::String(_))
}

pub(crate) fn compares(op: BinaryOp) -> bool {
    matches!(op, BinaryOp::Lt | BinaryOp::Gt | BinaryOp::Le | BinaryOp::Ge | BinaryOp::Eq | BinaryOp::Ne)
}

pub(crate) fn comparison(op: BinaryOp) -> Op {
    match op {
        BinaryOp::Lt => Op::Lt,
        BinaryOp::Gt => Op::Gt,
        BinaryOp::Le => Op::Le,
        BinaryOp::Ge => Op::Ge,
        BinaryOp::Eq => Op::Eq,
        _ => Op::Ne,
    }
}

pub(super) fn arithmetic_op(op: BinaryOp) -> Op {
    match op {
        BinaryOp::Add => Op::Add,
        BinaryOp::Sub => Op::Sub,
        BinaryOp::Mul => Op::Mul,
        BinaryOp::Div => Op::Div,
        _ => Op::Mod,
    }
}

/// The bit string of as many bits as an integer.
fn as_bits(integer: Elementary) -> &'static str {
    let bits = ["BYTE", "WORD", "DWORD", "LWORD"];
    bits[usize::try_from(integer.repr().size().trailing_zeros()).unwrap_or(0)]
}

/// The right side of a comparison of names and numbers.
fn last_operand(text: &str) -> Option<&str> {
    let (_, last) = text.rsplit_once(['<', '>', '='])?;
    let last = last.trim();
    let is_simple = !last.is_empty() && last.chars().all(|it| it.is_ascii_alphanumeric() || "_.".contains(it));
    is_simple.then_some(last)
}

fn is_junction(op: BinaryOp) -> bool {
    matches!(op, BinaryOp::And | BinaryOp::Or | BinaryOp::Xor)
}

/// `INT_TO_WORD(a) AND 1`, and back where the place asks for the type of `a`.
fn converted(sides: &Sides, ty: Elementary, into: &str, a: &str, b: &str) -> String {
    let name = ty.name();
    let value = format!("{name}_TO_{into}({a}) {} {b}", sides.op.text());
    if sides.hint == Some(Type::Elementary(ty)) { format!("{into}_TO_{name}({value})") } else { value }
}

/// The type of points in time that has all days of this one.
fn point(day: Elementary) -> &'static str {
    if day == Elementary::Ldate { "LDT" } else { "DT" }
}

fn is_zero(value: Option<Value>) -> bool {
    match value {
        Some(Value::F32(it)) => it == 0.0,
        Some(Value::F64(it)) => it == 0.0,
        Some(_) | None => false,
    }
}

/// The sign that a power begins with, and the power without it: `-a ** b`.
fn leading_sign<'s>(power: &ast::Expr<'s>) -> Option<(ast::UnaryOp, ast::Expr<'s>)> {
    match &power.kind {
        ast::ExprKind::Unary(sign @ (ast::UnaryOp::Neg | ast::UnaryOp::Plus), base) => Some((*sign, (**base).clone())),
        ast::ExprKind::Binary(sides, BinaryOp::Power, at) => {
            let (sign, base) = leading_sign(&sides[0])?;
            let sides = Box::new([base, sides[1].clone()]);
            Some((sign, ast::Expr { kind: ast::ExprKind::Binary(sides, BinaryOp::Power, *at), span: power.span }))
        }
        _ => None,
    }
}
