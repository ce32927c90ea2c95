//! Literals, members of enumerations, and what is computed of literals that have no type yet.

use super::checker::Checker;
use super::operand::Operand;
use super::real::Real;
use crate::diagnostic::Missing;
use crate::dialect::rules::Functions;
use crate::lex::DECIMAL;
use crate::names::functions::Converted;
use crate::names::{Found, Meaning, Sense};
use crate::spelling::Key;
use crate::{Code, Diagnostic, Span, ast};
use ast::LiteralValue;
use staunch_ir::{Chars, Elementary, Expr, ExprKind, Op, StringType, Type, Value};
use staunch_runtime::literal::lower_overflow;

impl<'s> Checker<'_, 's> {
    pub(crate) fn literal(
        &mut self,
        literal: &ast::Literal<'s>,
        expected: Option<Type>,
        span: Span,
    ) -> Option<Operand> {
        match (&literal.prefix, &literal.value) {
            (Some(prefix), LiteralValue::Enumerator(name)) => self.enumerator(&[**prefix, **name]).map(Operand::Typed),
            (Some(prefix), value) => self.typed_literal(**prefix, value, false, span).map(Operand::Typed),
            (None, LiteralValue::String(chars)) if chars.len() == 1 => Some(self.one_character(chars, expected, span)),
            (None, value) => self.plain_literal(value, span),
        }
    }

    fn plain_literal(&mut self, value: &LiteralValue<'s>, span: Span) -> Option<Operand> {
        let at = self.at(span);
        let typed = |ty, value| Some(Operand::Typed(Expr::constant(ty, value, at)));
        match value {
            LiteralValue::Bool(it) => typed(Elementary::Bool, Value::Bool(*it)),
            LiteralValue::Integer { value, .. } => {
                self.refuse_decimal_base(span)?;
                Some(Operand::Integer(self.rounded_as_double(*value, span)))
            }
            LiteralValue::Real(digits) => Some(Operand::Real { number: Real::Literal(digits.to_string()) }),
            LiteralValue::Time { ty, nanoseconds } => {
                if !ty.is_duration() {
                    return typed(*ty, Value::I64(*nanoseconds));
                }
                let (kept, value) = self.duration_literal(*ty, *nanoseconds, span)?;
                self.lower_units(*ty, *nanoseconds, span)?;
                typed(kept, value)
            }
            LiteralValue::String(chars) => Some(self.string_literal(chars, span)),
            LiteralValue::Error => None,
            LiteralValue::Enumerator(name) => {
                self.error(Code::E0101, name.span, format!("no enumeration here has a value `{}`", name.text));
                None
            }
        }
    }

    /// STruC++ keeps a decimal number without a type as a double, and writes it with the fewest digits that name that. An
    /// initial value it writes as it is.
    fn rounded_as_double(&self, value: u64, span: Span) -> i128 {
        let text = self.decl.log.sources.text(span);
        let is_rounded = self.decl.dialect(span).rules().functions.choice == Functions::OfStrucpp;
        if !is_rounded || self.signature.is_none() || value < 1 << 53 || text.contains('#') {
            return i128::from(value);
        }
        let double: Option<f64> = text.replace('_', "").parse().ok();
        double
            .and_then(|it| it.to_string().parse::<i128>().ok())
            .map_or(i128::from(value), |it| it & i128::from(u64::MAX))
    }

    /// Reports `T#5m68s`: only the first unit may overflow.
    fn lower_units(&mut self, ty: Elementary, nanoseconds: i64, span: Span) -> Option<()> {
        let units = self.decl.log.sources.text(span).split_once('#')?.1;
        let Some(unit) = lower_overflow(units).map(|(start, end)| units[start..end].to_owned()) else {
            return Some(());
        };
        let mut meant = String::new();
        staunch_runtime::format::time(&mut meant, ty, nanoseconds).ok()?;
        let is_taken = self.decl.dialect(span).takes_lower_units_that_overflow();
        let code = if is_taken { Code::W0525 } else { Code::E0214 };
        let message = format!("`{unit}` overflows into the next longer unit");
        self.report(
            Diagnostic::new(code, span, message)
                .label("only the first unit of a TIME may overflow")
                .help(format!("write `{meant}`"))
                .fix(span, meant),
        );
        is_taken.then_some(())
    }

    /// Reports `10#15` in dialects that have no numbers of this base.
    fn refuse_decimal_base(&mut self, span: Span) -> Option<()> {
        let text = self.decl.log.sources.text(span);
        let number = text.find(DECIMAL).filter(|at| !text[..*at].ends_with(|it: char| it.is_ascii_digit()));
        let Some(number) = number.filter(|_| !self.decl.dialect(span).has_decimal_bases()) else { return Some(()) };
        let digits = text[number + DECIMAL.len()..].to_owned();
        let meant = format!("{}{digits}", &text[..number]);
        self.report(
            Diagnostic::new(Code::E0005, span, "a number's base is 2, 8 or 16, not 10")
                .label("only CODESYS and TwinCAT also allow base 10")
                .help(format!("write `{meant}`"))
                .fix(span, meant),
        );
        None
    }

    fn string_literal(&mut self, chars: &Chars, span: Span) -> Operand {
        let capacity = u16::try_from(chars.len().max(1)).unwrap_or(u16::MAX);
        let ty = Type::String(StringType { wide: chars.is_wide(), capacity });
        Operand::Typed(Expr::new(ty, ExprKind::Text(chars.clone()), self.at(span)))
    }

    /// `INT#-5`, `REAL#-1.5`.
    pub(crate) fn negative_literal(
        &mut self,
        prefix: ast::Name<'s>,
        value: &LiteralValue<'s>,
        span: Span,
    ) -> Option<Expr> {
        self.typed_literal(prefix, value, true, span)
    }

    /// `INT#5`, `BOOL#1`, `REAL#1.5`.
    fn typed_literal(
        &mut self,
        prefix: ast::Name<'s>,
        value: &LiteralValue<'s>,
        is_negative: bool,
        span: Span,
    ) -> Option<Expr> {
        let named = self.literal_type(prefix, value)?;
        if self.has_other_quotes(prefix, value, span) {
            return None;
        }
        let ty = match named {
            Converted::Elementary(ty) => ty,
            Converted::Text { wide } => return self.string_of_kind(value, wide, span),
        };
        if let (LiteralValue::Integer { value, .. }, false) = (value, is_negative)
            && let Some(character) = self.numbered_character(ty, *value, span)
        {
            return Some(character);
        }
        let operand = self.plain_literal(value, span)?;
        match operand {
            Operand::Typed(value) if is_negative => {
                let found = self.type_name(value.ty);
                self.error(Code::E0204, span, format!("`-` needs a number, but this is {found}"));
                None
            }
            Operand::Typed(_) | Operand::Promoted(..) => self.coerce(operand, Type::Elementary(ty), span),
            number if is_negative => self.literal_as(&number.negated(), ty, span),
            number => self.literal_as(&number, ty, span),
        }
    }

    /// Reports `WSTRING#'abc'` where a dialect has only `WSTRING#"abc"`; whether it is that.
    fn has_other_quotes(&mut self, prefix: ast::Name<'s>, value: &LiteralValue<'s>, span: Span) -> bool {
        let is_single = self.decl.log.sources.text(span).ends_with('\'');
        let LiteralValue::String(chars) = value else { return false };
        if !(chars.is_wide() && is_single) || self.decl.dialect(span).has_wide_texts_in_single_quotes() {
            return false;
        }
        let ty = prefix.text.to_ascii_uppercase();
        let text = self.decl.log.sources.text(span);
        let inner = text.split_once('\'').and_then(|it| it.1.strip_suffix('\''));
        let error = Diagnostic::new(Code::E0201, span, format!("a string in single quotes is not a {ty}"))
            .label(format!("a {ty} is written in double quotes"));
        self.report(match inner.filter(|it| !it.contains('"')) {
            Some(inner) => {
                let meant = format!("{}#\"{inner}\"", prefix.text);
                error.help(format!("write `{meant}`")).fix(span, meant)
            }
            None => error,
        });
        true
    }

    /// `CHAR#16#80`, in dialects that have it.
    fn numbered_character(&mut self, ty: Elementary, number: u64, span: Span) -> Option<Expr> {
        if !ty.is_char() || !self.decl.dialect(span).has_numbered_characters() {
            return None;
        }
        let value = match ty == Elementary::Char {
            true => Value::U8(u8::try_from(number).ok()?),
            false => Value::U16(u16::try_from(number).ok()?),
        };
        Some(Expr::constant(ty, value, self.at(span)))
    }

    /// `'A'`: a CHAR where one is expected.
    fn one_character(&mut self, chars: &Chars, expected: Option<Type>, span: Span) -> Operand {
        let of_kind = if chars.is_wide() { Elementary::Wchar } else { Elementary::Char };
        match (chars, expected) {
            (Chars::Narrow(bytes), Some(Type::Elementary(ty))) if ty == of_kind => {
                Operand::Typed(Expr::constant(ty, Value::U8(bytes[0]), self.at(span)))
            }
            (Chars::Wide(units), Some(Type::Elementary(ty))) if ty == of_kind => {
                Operand::Typed(Expr::constant(ty, Value::U16(units[0]), self.at(span)))
            }
            _ => self.string_literal(chars, span),
        }
    }

    /// `STRING#'abc'`, `WSTRING#"abc"`.
    fn string_of_kind(&mut self, value: &LiteralValue<'s>, wide: bool, span: Span) -> Option<Expr> {
        let text = self.plain_literal(value, span)?.typed().cloned()?;
        match text.ty {
            Type::String(it) if it.wide != wide => {
                self.report_other_string(&text, it.of_kind(wide), span);
                None
            }
            _ => Some(text),
        }
    }

    /// What a literal's prefix names.
    fn literal_type(&mut self, prefix: ast::Name<'s>, value: &LiteralValue<'s>) -> Option<Converted> {
        let is_text = matches!(value, LiteralValue::String(_));
        match Converted::named(&prefix.text.to_ascii_uppercase()) {
            Some(Converted::Text { .. }) if !is_text => {}
            Some(named) => return Some(named),
            None => {}
        }
        if let Found::One(Meaning::Declared(_)) = self.decl.lookup(&[prefix], Sense::Type) {
            self.report(
                Diagnostic::new(Code::E0102, prefix.span, format!("`{}` has no literals", prefix.text))
                    .label("a literal is of an elementary type, or an enumerator"),
            );
            return None;
        }
        let near = crate::spelling::nearest(prefix.text, Elementary::ALL.iter().map(|it| it.name()));
        let mut error = Diagnostic::missing(Missing::Type, prefix.text, prefix.span).label("the type of a literal");
        if let Some(near) = near {
            error = error.help(format!("did you mean `{near}`?")).fix(prefix.span, near);
        }
        self.report(error);
        None
    }

    /// `Color#Red` or `Color.Red`.
    pub(crate) fn enumerator(&mut self, path: &[ast::Name<'s>]) -> Option<Expr> {
        let [.., ty, name] = *path else { return None };
        let found = self.decl.lookup(path, Sense::Value);
        self.decl.note_path(path, &found);
        let Found::One(Meaning::Enumerator(slot)) = found else {
            self.report(Diagnostic::missing(Missing::Enumeration, ty.text, ty.span));
            return None;
        };
        self.enumerator_of(slot, ty, name)
    }

    /// A value of the type in a slot, if that is an enumeration.
    fn enumerator_of(&mut self, slot: usize, ty: ast::Name<'s>, name: ast::Name<'s>) -> Option<Expr> {
        let resolved = self.decl.named_type(slot)?;
        let Type::Enum(id) = resolved.ty else {
            self.error(Code::E0102, ty.span, format!("`{}` is not an enumeration", ty.text));
            return None;
        };
        self.offer_enumerators(name, id);
        let Some(value) = self.decl.enumerator_named(id, name.text) else {
            let values = &self.decl.program.enumeration(id).values;
            let near = crate::spelling::nearest(name.text, values.iter().map(|it| it.name.as_str())).map(str::to_owned);
            self.decl.unknown_member(name, resolved.ty, near.as_deref());
            return None;
        };
        self.decl.note_enumerator(name, id);
        let at = self.at(name.span);
        Some(Expr::new(resolved.ty, ExprKind::Const(value), at))
    }

    /// A bare enumerator: of the expected enumeration, or the only one with this name.
    pub(crate) fn bare_enumerator(&mut self, name: ast::Name<'s>, expected: Option<Type>) -> Option<Option<Expr>> {
        let at = self.at(name.span);
        if let Some(Type::Enum(id)) = expected {
            self.offer_enumerators(name, id);
        }
        if let Some(Type::Enum(id)) = expected
            && (!self.decl.table.qualified.contains(&id) || self.is_in_its_type(name))
            && let Some(value) = self.decl.enumerator_named(id, name.text)
        {
            self.decl.note_enumerator(name, id);
            return Some(Some(Expr::new(Type::Enum(id), ExprKind::Const(value), at)));
        }
        let slots = self.decl.enumerations_with(name);
        match slots.as_slice() {
            [] => {
                let (ty, value) = self.decl.names.anonymous_enumerators.get(&Key(name.text)).copied()?;
                if let Type::Enum(id) = ty {
                    self.decl.note_enumerator(name, id);
                }
                Some(Some(Expr::new(ty, ExprKind::Const(value), at)))
            }
            [slot] => {
                let ty = self.decl.types[*slot].decl.name;
                let space = self.decl.names.space_of(ty.span);
                if self.decl.names.is_of_library(space) {
                    return Some(self.enumerator_of(*slot, ty, name));
                }
                if let Found::One(Meaning::Enumerator(_)) = self.decl.lookup(&[ty, name], Sense::Value) {
                    return Some(self.enumerator(&[ty, name]));
                }
                let meant = format!("{}#{}", self.decl.name_in_full(ty), name.text);
                self.report(
                    Diagnostic::missing(Missing::Variable, name.text, name.span)
                        .label("unknown name")
                        .help(format!("it is a value of an enumeration that is not visible here: write `{meant}`")),
                );
                Some(None)
            }
            several => {
                let names: Vec<_> = several
                    .iter()
                    .map(|slot| format!("{}#{}", self.decl.name_in_full(self.decl.types[*slot].decl.name), name.text))
                    .collect();
                let names: Vec<_> = names.iter().map(String::as_str).collect();
                self.report(
                    Diagnostic::new(
                        Code::E0108,
                        name.span,
                        format!("several enumerations have a value `{}`", name.text),
                    )
                    .label("which one is meant?")
                    .help(format!("write {}", crate::diagnostic::wording::any_of(&names))),
                );
                Some(None)
            }
        }
    }

    /// Whether a value of an enumeration is named in the declaration of that, where it needs no name before it.
    pub(super) fn is_in_its_type(&self, name: ast::Name<'s>) -> bool {
        let slots = self.decl.names.qualified_enumerators.get(&Key(name.text));
        let is_in = |span: Span| span.file == name.span.file && (span.start..span.end).contains(&name.span.start);
        slots.into_iter().flatten().any(|it| {
            let decl = self.decl.types[*it].decl;
            is_in(decl.ty.span) || decl.initial.as_ref().is_some_and(|it| is_in(it.span))
        })
    }

    /// Arithmetic on integers without a type is exact; with a fraction it waits for its type. The inner `None` says that
    /// it was reported.
    pub(crate) fn fold_untyped(
        &mut self,
        op: ast::BinaryOp,
        a: &Operand,
        b: &Operand,
        span: Span,
    ) -> Option<Option<Operand>> {
        if let (Operand::Integer(a), Operand::Integer(b)) = (a, b) {
            let folded = self.fold_integers(op, *a, *b, span);
            let as_c = self.decl.dialect(span).rules().has_literals_of_c();
            return if as_c { folded.map(|it| self.wrapped_as_c(it, [*a, *b], span)) } else { folded };
        }
        let op = match op {
            ast::BinaryOp::Add => Op::Add,
            ast::BinaryOp::Sub => Op::Sub,
            ast::BinaryOp::Mul => Op::Mul,
            ast::BinaryOp::Div => Op::Div,
            _ => return None,
        };
        Some(Some(Operand::Real { number: Real::Apply(op, vec![number(a)?, number(b)?]) }))
    }

    /// An integer without a type is an `int` in C, or a `long` where an `int` does not hold it; of both sides the longer
    /// one counts. One with a base may be an `unsigned` as well.
    fn wrapped_as_c(&self, folded: Option<Operand>, sides: [i128; 2], span: Span) -> Option<Operand> {
        let Some(Operand::Integer(value)) = folded else { return folded };
        let low = |bits: u32| {
            let low = value & ((1 << bits) - 1);
            if low >> (bits - 1) == 0 { low } else { low - (1 << bits) }
        };
        let has_base = self.decl.log.sources.text(span).contains('#');
        let [int, unsigned, long] = [
            sides.iter().all(|it| it.unsigned_abs() < 1 << 31),
            has_base && sides.iter().all(|it| u32::try_from(*it).is_ok()),
            sides.iter().all(|it| i64::try_from(*it).is_ok()),
        ];
        Some(Operand::Integer(match (int, unsigned, long) {
            (true, _, _) => low(32),
            (false, true, _) => value & 0xFFFF_FFFF,
            (false, false, true) => low(64),
            (false, false, false) => value,
        }))
    }

    fn fold_integers(&mut self, op: ast::BinaryOp, a: i128, b: i128, span: Span) -> Option<Option<Operand>> {
        let value = match op {
            ast::BinaryOp::Add => a.checked_add(b),
            ast::BinaryOp::Sub => a.checked_sub(b),
            ast::BinaryOp::Mul => a.checked_mul(b),
            ast::BinaryOp::Div if b != 0 => a.checked_div(b),
            ast::BinaryOp::Mod if b != 0 => a.checked_rem(b),
            ast::BinaryOp::And if a >= 0 && b >= 0 => Some(a & b),
            ast::BinaryOp::Or if a >= 0 && b >= 0 => Some(a | b),
            ast::BinaryOp::Xor if a >= 0 && b >= 0 => Some(a ^ b),
            _ => return None,
        };
        // Beyond every IEC type; a further operation could overflow here.
        let value = value.filter(|it| it.unsigned_abs() <= 1 << 100);
        if value.is_none() {
            self.error(Code::E0202, span, "no type can hold the value of this expression");
        }
        Some(value.map(|it| Operand::Integer(self.as_immediate([a, b], it, span))))
    }

    /// What two immediate values give: where they are DINTs, the low bits of one, in Logix (1756-RM006K, p. 545).
    fn as_immediate(&mut self, sides: [i128; 2], value: i128, span: Span) -> i128 {
        let repr = Elementary::Dint.repr();
        let are_dints = sides.iter().all(|it| repr.integer(*it).is_some());
        if !are_dints || repr.integer(value).is_some() || !self.decl.dialect(span).rules().has_immediates() {
            return value;
        }
        // The low 32 bits, with their sign.
        let low = (value + (1 << 31)).rem_euclid(1 << 32) - (1 << 31);
        self.report(
            Diagnostic::new(Code::W0524, span, format!("{value} is more than a DINT holds"))
                .label(format!("immediate values are DINTs in Logix: this is {low}"))
                .help(format!("write the number: `{value}`")),
        );
        low
    }
}

fn number(operand: &Operand) -> Option<Real> {
    match operand {
        Operand::Typed(_) | Operand::Promoted(..) => None,
        Operand::Integer(value) => Some(Real::Literal(value.to_string())),
        Operand::Real { number } => Some(number.clone()),
    }
}
