//! Text of values, and values of text: the functions of the runtime that do it, at each type.

use super::checker::Checker;
use crate::dialect::rules::Functions;
use crate::{Code, Diagnostic, Span, ast};
use staunch_ir::{
    Arm, Chars, Conversion, Elementary, EnumId, Expr, ExprKind, Op, Statement, StatementKind, StringType, TextOp, Type,
    Value,
};

/// Longest string, in units.
pub(crate) const MAX_CAPACITY: u16 = 32767;

impl<'s> Checker<'_, 's> {
    /// `x_TO_STRING`, `x_TO_WSTRING`.
    pub(super) fn text_of(&mut self, value: Expr, wide: bool, span: Span, name: ast::Name<'s>) -> Option<Expr> {
        let text = match value.ty {
            Type::String(_) => value,
            Type::Elementary(it) if it.is_char() => self.text_of_char(value, it, wide, name.span)?,
            _ => self.narrow_text_of(value, span, name)?,
        };
        self.of_kind(text, wide, name.span)
    }

    fn narrow_text_of(&mut self, value: Expr, span: Span, name: ast::Name<'s>) -> Option<Expr> {
        if let Type::Enum(id) = value.ty
            && self.decl.table.spelled.contains(&id)
            && (value.as_const().is_some() || self.signature.is_some())
        {
            return self.name_of(value, id, span, name);
        }
        let (value, ty) = self.as_elementary(value, span, name)?;
        self.note_conversion(value.ty, Type::string(0), name.span);
        let library = self.decl.dialect(name.span).rules().functions.choice;
        let (matiec, strucpp) = (library == Functions::OfMatiec, library == Functions::OfStrucpp);
        let value = if strucpp && ty.is_time() { self.stored_count(value, ty, name.span)? } else { value };
        let (op, operand) = match ty {
            Elementary::Bool => (TextOp::FromBool, Elementary::Bool),
            Elementary::Real | Elementary::Lreal if matiec => (TextOp::FromGeneral, Elementary::Lreal),
            Elementary::Real | Elementary::Lreal if strucpp => (TextOp::FromShort, Elementary::Lreal),
            Elementary::Real => (TextOp::FromReal, Elementary::Real),
            Elementary::Lreal => (TextOp::FromLreal, Elementary::Lreal),
            Elementary::Lword if matiec => (TextOp::FromBits, Elementary::Ulint),
            Elementary::Ulint | Elementary::Lword => (TextOp::FromUlint, Elementary::Ulint),
            _ if ty.is_time() && matiec => (TextOp::FromSeconds, Elementary::Lint),
            _ if ty.is_bits() && matiec => (TextOp::FromBits, Elementary::Ulint),
            _ if ty.is_time() && !strucpp => (TextOp::FromTime, Elementary::Lint),
            _ => (TextOp::FromLint, Elementary::Lint),
        };
        let mut operands = vec![self.convert(Conversion::Value, Type::Elementary(operand), value)];
        operands.extend(self.kind_of_time(op, ty, name.span));
        let number = operands.first().cloned()?;
        // STruC++'s are as long as any STRING.
        let longest = self.decl.dialect(name.span).rules().default_string.choice.capacity();
        let longest = if strucpp { longest } else { op.longest()? };
        let text = self.text_function_of(op, Type::string(longest), operands, name.span)?;
        let has_sign = ty.is_integer() && ty.repr().is_signed() && self.decl.dialect(name.span).rules().writes_plus();
        if has_sign { self.with_plus(text, number, name.span) } else { Some(text) }
    }

    /// `+` before the text of a number that is not below 0.
    fn with_plus(&mut self, text: Expr, number: Expr, span: Span) -> Option<Expr> {
        let at = self.at(span);
        let (ty, plus) = (number.ty, Type::string(1));
        let zero = self.decl.program.repr(ty)?.zero();
        let zero = Expr::new(ty, ExprKind::Const(zero), at);
        let is_positive = self.apply(Op::Ge, ty, vec![number, zero], Type::BOOL, span)?;
        let byte = self.convert(Conversion::Value, Type::Elementary(Elementary::Byte), is_positive);
        let length = self.convert(Conversion::Value, Type::LINT, byte);
        let sign = Expr::new(plus, ExprKind::Text(Chars::Narrow(vec![b'+'])), at);
        let sign = self.text_function_of(TextOp::Left, plus, vec![sign, length], span)?;
        let longest = text.ty.string_type()?.capacity + 1;
        self.text_function_of(TextOp::Concat, Type::string(longest), vec![sign, text], span)
    }

    /// A string of one character. CHARs of a WSTRING are those of the same numbers.
    pub(super) fn text_of_char(&mut self, value: Expr, ty: Elementary, wide: bool, span: Span) -> Option<Expr> {
        let is_wide = wide || ty == Elementary::Wchar;
        let string = Type::String(StringType { wide: is_wide, capacity: 1 });
        if is_wide {
            let value = self.convert(Conversion::Value, Type::Elementary(Elementary::Wchar), value);
            return self.text_function_of(TextOp::FromWchar, string, vec![value], span);
        }
        self.text_function_of(TextOp::FromChar, string, vec![value], span)
    }

    /// The text as a STRING or WSTRING that holds all of it.
    pub(super) fn of_kind(&mut self, text: Expr, wide: bool, span: Span) -> Option<Expr> {
        let ty = text.ty.string_type()?;
        let (op, capacity) = match (ty.wide, wide) {
            // A character has no more units than bytes.
            (false, true) => (TextOp::Widen, ty.capacity),
            // Three bytes hold every unit, or its half of a character.
            (true, false) => (TextOp::Narrow, ty.capacity.saturating_mul(3).min(MAX_CAPACITY)),
            (false, false) | (true, true) => return Some(text),
        };
        self.text_function_of(op, Type::String(StringType { wide, capacity }), vec![text], span)
    }

    /// The name of an enumeration's value; of one that has none, its number.
    fn name_of(&mut self, mut value: Expr, id: EnumId, span: Span, name: ast::Name<'s>) -> Option<Expr> {
        let at = self.at(name.span);
        let mut known = Vec::new();
        for it in &self.decl.program.enumeration(id).values {
            if let Some(number) = it.value.as_integer().filter(|it| known.iter().all(|(known, _)| known != it)) {
                known.push((number, it.name.clone().into_bytes()));
            }
        }
        let text = |bytes: &[u8]| {
            let ty = Type::String(StringType::narrow(u16::try_from(bytes.len()).unwrap_or(u16::MAX)));
            Expr::new(ty, ExprKind::Text(Chars::Narrow(bytes.to_vec())), at)
        };
        if let Some(number) = value.as_const().and_then(Value::as_integer) {
            let found = known.iter().find(|it| it.0 == number);
            return Some(text(&found.map_or_else(|| number.to_string().into_bytes(), |it| it.1.clone())));
        }
        // A number of 64 bits has 20 characters.
        let longest = known.iter().map(|it| it.1.len()).max().unwrap_or_default().max(20);
        let ty = Type::String(StringType::narrow(u16::try_from(longest).ok()?));
        self.save("value", &mut value);
        let spelled = self.temporary("name", ty);
        let (number, _) = self.as_elementary(value.clone(), span, name)?;
        let otherwise = self.nested(|this| {
            if let Some(number) = this.narrow_text_of(number, span, name) {
                let number = this.convert(Conversion::Value, ty, number);
                this.assign(spelled.clone(), number, name.span);
            }
        });
        let arm = |(number, it): &(i128, Vec<u8>)| {
            let value = Expr::convert(Conversion::Value, ty, text(it), at);
            Arm { labels: vec![(*number, *number)], body: vec![Statement::assign(spelled.clone(), value, at)] }
        };
        let arms = known.iter().map(arm).collect();
        self.push(StatementKind::Case { selector: value, arms, otherwise }, name.span);
        Some(Expr::load(spelled, at))
    }

    /// `STRING_TO_x`. An integer takes its low bits of the number that the text spells.
    pub(super) fn value_of_text(&mut self, text: Expr, to: Elementary, span: Span) -> Option<Expr> {
        self.note_conversion(text.ty, Type::Elementary(to), span);
        if to.is_char() {
            return self.first_character(text, to, span);
        }
        let is_fixed = self.decl.dialect(span).rules().reads_fixed_point();
        match self.decl.dialect(span).rules().functions.choice {
            Functions::OfTheStandard => {}
            Functions::OfMatiec => return self.value_of_text_in_matiec(text, to, span),
            Functions::OfStrucpp if to.is_integral() => return self.number_of_text_in_strucpp(text, to, span),
            Functions::OfStrucpp => {}
        }
        let (op, made) = match to {
            Elementary::Bool => (TextOp::ToBool, Elementary::Bool),
            Elementary::Real if is_fixed => (TextOp::ToFixedReal, Elementary::Real),
            Elementary::Lreal if is_fixed => (TextOp::ToFixedLreal, Elementary::Lreal),
            Elementary::Real => (TextOp::ToReal, Elementary::Real),
            Elementary::Lreal => (TextOp::ToLreal, Elementary::Lreal),
            Elementary::Ulint | Elementary::Lword => (TextOp::ToUlint, Elementary::Ulint),
            _ if to.is_time() => (TextOp::ToTime, Elementary::Lint),
            _ => (TextOp::ToLint, Elementary::Lint),
        };
        if to.is_integer() && self.decl.dialect(span).rules().writes_plus() {
            return self.integer_of_text(text, to, span);
        }
        let mut operands = vec![self.of_kind(text, false, span)?];
        operands.extend(self.kind_of_time(op, to, span));
        let value = self.text_function_of(op, Type::Elementary(made), operands, span)?;
        let value = self.convert(Conversion::Value, Type::Elementary(to), value);
        self.kept_duration(value, span)
    }

    /// The number that a text spells, 0 where the type does not hold it (S7-1200 manual, 11/2011, p. 247).
    fn integer_of_text(&mut self, text: Expr, to: Elementary, span: Span) -> Option<Expr> {
        let unsigned = to.repr().is_unsigned();
        let (op, made) = match unsigned {
            true => (TextOp::ToUlintOr0, Elementary::Ulint),
            false => (TextOp::ToLintOr0, Elementary::Lint),
        };
        let operands = vec![self.of_kind(text, false, span)?];
        let number = self.text_function_of(op, Type::Elementary(made), operands, span)?;
        let number = if unsigned { self.convert(Conversion::Value, Type::LINT, number) } else { number };
        let number = self.zero_outside(number, to, span)?;
        Some(self.convert(Conversion::Value, Type::Elementary(to), number))
    }

    /// A TIME is as many seconds as the number of the text has whole ones.
    fn value_of_text_in_matiec(&mut self, text: Expr, to: Elementary, span: Span) -> Option<Expr> {
        let (op, made) = match to {
            Elementary::Bool => (TextOp::ToBoolWord, Elementary::Bool),
            _ if to.is_real() || to.is_time() => (TextOp::ToLrealDot, Elementary::Lreal),
            _ => (TextOp::ToLintBack, Elementary::Lint),
        };
        let operands = vec![self.of_kind(text, false, span)?];
        let value = self.text_function_of(op, Type::Elementary(made), operands, span)?;
        if !to.is_time() {
            return Some(self.convert(Conversion::Value, Type::Elementary(to), value));
        }
        let whole = self.convert(Conversion::Truncate, Type::LINT, value);
        self.between(whole, Elementary::Lint, to, span)
    }

    /// A BOOL by the first letter; an integer by the digits at the start.
    fn number_of_text_in_strucpp(&mut self, text: Expr, to: Elementary, span: Span) -> Option<Expr> {
        let (op, made) = match to {
            Elementary::Bool => (TextOp::ToBoolLetter, Elementary::Bool),
            _ if to.repr().is_unsigned() => (TextOp::ToUlintFront, Elementary::Ulint),
            _ => (TextOp::ToLintFront, Elementary::Lint),
        };
        let operands = vec![self.of_kind(text, false, span)?];
        let value = self.text_function_of(op, Type::Elementary(made), operands, span)?;
        Some(self.convert(Conversion::Value, Type::Elementary(to), value))
    }

    /// What the text spells, or 0 where the type does not hold that.
    fn zero_outside(&mut self, number: Expr, to: Elementary, span: Span) -> Option<Expr> {
        let Some((least, most)) = to.repr().range().filter(|_| to.repr().size() < 8) else { return Some(number) };
        let at = self.at(span);
        let limit =
            |value: i128| Elementary::Lint.repr().integer(value).map(|it| Expr::constant(Elementary::Lint, it, at));
        let (least, most) = (limit(least)?, limit(most)?);
        let above = self.apply(Op::Ge, Type::LINT, vec![number.clone(), least], Type::BOOL, span)?;
        let below = self.apply(Op::Le, Type::LINT, vec![number.clone(), most], Type::BOOL, span)?;
        let holds = self.apply(Op::And, Type::BOOL, vec![above, below], Type::BOOL, span)?;
        self.zero_unless(holds, number, span)
    }

    /// The number where the condition holds, else 0.
    fn zero_unless(&mut self, holds: Expr, number: Expr, span: Span) -> Option<Expr> {
        let byte = self.convert(Conversion::Value, Type::Elementary(Elementary::Byte), holds);
        let holds = self.convert(Conversion::Value, Type::LINT, byte);
        self.apply(Op::Mul, Type::LINT, vec![number, holds], Type::LINT, span)
    }

    /// The text where none of these numbers is below its least value; else an empty one.
    pub(super) fn empty_outside(&mut self, text: Expr, range: &[(Expr, i64)], span: Span) -> Option<Expr> {
        let (ty, at) = (text.ty, self.at(span));
        let lint = |value| Expr::constant(Elementary::Lint, Value::I64(value), at);
        let mut holds: Option<Expr> = None;
        for (number, least) in range {
            let is_in = self.apply(Op::Ge, Type::LINT, vec![number.clone(), lint(*least)], Type::BOOL, span)?;
            holds = Some(match holds {
                Some(holds) => self.apply(Op::And, Type::BOOL, vec![holds, is_in], Type::BOOL, span)?,
                None => is_in,
            });
        }
        let Some(holds) = holds.filter(|it| it.as_const() != Some(Value::Bool(true))) else { return Some(text) };
        let length = self.zero_unless(holds, lint(MAX_CAPACITY.into()), span)?;
        self.text_function_of(TextOp::Left, ty, vec![text, length], span)
    }

    fn first_character(&mut self, text: Expr, to: Elementary, span: Span) -> Option<Expr> {
        let wide = text.ty.string_type()?.wide || to == Elementary::Wchar;
        let text = self.of_kind(text, wide, span)?;
        let (op, ty) = if wide { (TextOp::ToWchar, Elementary::Wchar) } else { (TextOp::ToChar, Elementary::Char) };
        let character = self.text_function_of(op, Type::Elementary(ty), vec![text], span)?;
        self.between_characters(character, ty, to, span)
    }

    /// CHAR and WCHAR, by their numbers; a CHAR for a WCHAR that is none is `?`.
    pub(super) fn between_characters(
        &mut self,
        value: Expr,
        from: Elementary,
        to: Elementary,
        span: Span,
    ) -> Option<Expr> {
        let ty = Type::Elementary(to);
        match (from, to) {
            (Elementary::Wchar, Elementary::Char) => self.text_function_of(TextOp::NarrowChar, ty, vec![value], span),
            _ => Some(self.convert(Conversion::Value, ty, value)),
        }
    }

    /// A CHAR and a number or bit string of its bits.
    pub(super) fn character_and_number(
        &mut self,
        value: Expr,
        from: Elementary,
        to: Elementary,
        span: Span,
    ) -> Option<Expr> {
        if from.is_char() && to.is_char() {
            return self.between_characters(value, from, to, span);
        }
        let counts = |it: Elementary| it.is_char() || it.is_integral() && it != Elementary::Bool;
        if counts(from) && counts(to) {
            return Some(self.convert(Conversion::Value, Type::Elementary(to), value));
        }
        let message = format!("there is no conversion from {} to {}", from.name(), to.name());
        self.report(
            Diagnostic::new(Code::E0204, span, message).label("a character converts to text, integers and bit strings"),
        );
        None
    }

    fn text_function_of(&mut self, op: TextOp, ty: Type, operands: Vec<Expr>, span: Span) -> Option<Expr> {
        let at = self.at(span);
        self.evaluated(Expr::new(ty, ExprKind::ApplyText(op, operands), at), span)
    }

    /// The number of a type among all, for the two functions that want it.
    fn kind_of_time(&mut self, op: TextOp, ty: Elementary, span: Span) -> Option<Expr> {
        if !matches!(op, TextOp::FromTime | TextOp::ToTime | TextOp::FromSeconds) {
            return None;
        }
        let number = Elementary::ALL.iter().position(|it| *it == ty)?;
        let number = Value::I64(i64::try_from(number).ok()?);
        Some(Expr::constant(Elementary::Lint, number, self.at(span)))
    }
}
