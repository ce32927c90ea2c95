//! Implicit conversions: they only widen. What needs a function, the message names.

use super::checker::{Checker, Context};
use super::operand::Operand;
use crate::diagnostic::Subject;
use crate::spelling::Key;
use crate::types::coercion::{as_number, widens};
use crate::{Code, Diagnostic, Span, ast};
use staunch_ir::narrow::stored;
use staunch_ir::{BoundsId, Chars, Conversion, Elementary, EnumId, Expr, ExprKind, Op, StringType, Type, Value};
use staunch_runtime::Family;

impl<'s> Checker<'_, 's> {
    /// The value of `expr`, to be stored where `ty` is declared.
    pub(crate) fn value(&mut self, expr: &ast::Expr<'s>, ty: Type) -> Option<Expr> {
        if let Some(bound) = self.bound_value(expr, ty) {
            return bound;
        }
        let operand = self.operand(expr, Some(ty.read()))?;
        self.coerce(operand, ty, expr.span)
    }

    /// A value of `made_of` as one of its subrange with these limits; a constant is checked now.
    fn in_range(&mut self, value: Expr, made_of: Elementary, id: BoundsId, span: Span) -> Option<Expr> {
        let (low, high) = self.decl.program.bounds(id);
        let to = Type::Subrange(made_of, id);
        if let Some(number) = value.as_const().and_then(Value::as_integer) {
            if (low..=high).contains(&number) {
                return Some(Expr { ty: to, ..value });
            }
            self.report(
                Diagnostic::new(Code::E0202, span, format!("{number} is outside the subrange {low}..{high}"))
                    .label("the variable cannot hold it"),
            );
            return None;
        }
        let at = self.at(span);
        let limit = |number| Some(Expr::constant(made_of, made_of.repr().integer(number)?, at));
        let operands = vec![limit(low)?, value, limit(high)?];
        Some(Expr::apply(Op::InRange, to, operands, at))
    }

    /// Converts implicitly to `to`, or says why that is not done.
    pub(crate) fn coerce(&mut self, operand: Operand, to: Type, span: Span) -> Option<Expr> {
        match (operand, to) {
            (operand, Type::Subrange(made_of, id)) => {
                let value = self.coerce(operand, Type::Elementary(made_of), span)?;
                self.in_range(value, made_of, id, span)
            }
            (Operand::Promoted(expr, from), Type::Elementary(into)) if self.becomes_as_cpp(from, into, span) => {
                self.as_cpp(expr, into, span)
            }
            (Operand::Promoted(expr, from), Type::Elementary(into)) => {
                self.may_become(from, into, span).then(|| stored(expr, into))
            }
            (operand @ Operand::Promoted(..), _) => self.coerce(operand.cut(), to, span),
            (Operand::Typed(expr), _) => self.coerce_typed(expr.read(), to, span),
            // In Logix a real is rounded where an integer is wanted, an immediate value too (1756-RM006K, p. 544).
            (literal @ Operand::Real { .. }, Type::Elementary(ty))
                if ty.is_integer()
                    && self.context == Context::Body
                    && self.decl.dialect(span).has_bits_of_integers() =>
            {
                let real = self.literal_as(&literal, Elementary::Real, span)?;
                self.coerce_typed(real, to, span)
            }
            (literal, Type::Elementary(ty)) => self.literal_as(&literal, ty, span),
            (Operand::Integer(0), Type::Reference(_)) => Some(self.null(Some(to), span)),
            (Operand::Integer(number), Type::Enum(id)) if self.is_strict_value(id, number, span) => {
                let value = self.decl.program.enumeration(id).base.repr().integer(number)?;
                Some(Expr::new(to, ExprKind::Const(value), self.at(span)))
            }
            (literal, Type::Enum(id)) if self.counts_as_number(id, span) => {
                let base = self.decl.program.enumeration(id).base;
                let value = self.literal_as(&literal, base, span)?;
                Some(self.convert(Conversion::Same, to, value))
            }
            (
                _,
                Type::String(_)
                | Type::Enum(_)
                | Type::Array(_)
                | Type::Struct(_)
                | Type::Block(_)
                | Type::Reference(_),
            ) => {
                let expected = self.type_name(to);
                let error = Diagnostic::new(Code::E0201, span, format!("expected {expected}, found a number"))
                    .label(format!("expected {expected}"));
                self.report(match self.members(to) {
                    Some(members) => error.help(format!("name a member: {members}")),
                    None => error,
                });
                None
            }
        }
    }

    /// Whether an enumeration takes and gives numbers here: in CODESYS, unless it is strict; and where it names values
    /// of a type.
    pub(crate) fn counts_as_number(&self, id: EnumId, span: Span) -> bool {
        self.decl.dialect(span).mixes_bits_and_integers() && !self.decl.table.strict.contains(&id)
            || self.decl.table.named_values.contains(&id)
    }

    /// Whether an enumeration's value is a number where one is stored.
    pub(crate) fn gives_number(&self, id: EnumId, span: Span) -> bool {
        self.decl.dialect(span).mixes_bits_and_integers() || self.decl.table.named_values.contains(&id)
    }

    /// Whether an enumeration chooses an element, or counts in a FOR.
    pub(crate) fn is_counted_by(&self, id: EnumId, span: Span) -> bool {
        self.decl.dialect(span).counts_by_enumerations() || self.decl.table.named_values.contains(&id)
    }

    /// Whether a number is one of the values of a strict enumeration, which CODESYS takes for that.
    fn is_strict_value(&self, id: EnumId, number: i128, span: Span) -> bool {
        let mut values = self.decl.program.enumeration(id).values.iter();
        self.decl.dialect(span).mixes_bits_and_integers()
            && self.decl.table.strict.contains(&id)
            && values.any(|it| it.value.as_integer() == Some(number))
    }

    /// Whether it is a constant, of another enumeration, whose number is a value of this strict one.
    fn is_strict_constant(&self, id: EnumId, value: &Expr, span: Span) -> bool {
        let number = value.as_const().and_then(Value::as_integer);
        number.is_some_and(|it| self.is_strict_value(id, it, span))
    }

    fn coerce_typed(&mut self, expr: Expr, to: Type, span: Span) -> Option<Expr> {
        if self.decl.program.is_open(expr.ty) || self.decl.program.is_open(to) {
            return self.open_is_no_value(expr.ty, span);
        }
        if expr.ty == to {
            return match self.decl.held_not_copied(to, span) {
                Some(message) => self.instance_is_no_value(&expr, message, span),
                None => Some(expr),
            };
        }
        match (expr.ty, to) {
            (_, Type::Reference(id)) => self.coerce_reference(expr, id, span),
            (Type::Reference(_), Type::Elementary(into)) => self.address_as(expr, into, span),
            (Type::Elementary(Elementary::Ultime), Type::Elementary(Elementary::Ltime)) => {
                self.signed_duration(expr, span)
            }
            (Type::Elementary(from), Type::Elementary(into)) if self.becomes_as_cpp(from, into, span) => {
                self.as_cpp(expr, into, span)
            }
            (Type::Elementary(from), Type::Elementary(into)) => {
                self.may_become(from, into, span).then(|| self.number_as(expr, into, span))?
            }
            (Type::String(from), Type::String(into)) if from.wide == into.wide => {
                self.warn_of_cut(&expr, into, span);
                Some(self.convert(Conversion::Value, to, expr))
            }
            (Type::String(_), Type::String(into)) => {
                self.report_other_string(&expr, into, span);
                None
            }
            (Type::Elementary(from), Type::String(into))
                if from.is_char() && (from == Elementary::Wchar) == into.wide =>
            {
                let text = self.text_of_char(expr, from, into.wide, span)?;
                Some(self.convert(Conversion::Value, to, text))
            }
            (Type::String(_), Type::Elementary(into)) if into.is_char() => self.as_character(&expr, into, span),
            (Type::Enum(id), Type::Elementary(into)) if self.gives_number(id, span) && as_number(into).is_integer() => {
                if let Some(number) = expr.as_const().and_then(Value::as_integer) {
                    return self.coerce(Operand::Integer(number), to, span);
                }
                let base = self.decl.program.enumeration(id).base;
                let number = self.convert(Conversion::Same, Type::Elementary(base), expr);
                self.may_become(base, into, span).then(|| self.convert(Conversion::Value, to, number))
            }
            (Type::Enum(_), Type::Enum(into)) if self.is_strict_constant(into, &expr, span) => {
                let number = expr.as_const().and_then(Value::as_integer)?;
                self.coerce(Operand::Integer(number), to, span)
            }
            (Type::Enum(from), Type::Enum(into))
                if self.counts_as_number(into, span) && self.gives_number(from, span) =>
            {
                if let Some(number) = expr.as_const().and_then(Value::as_integer) {
                    return self.coerce(Operand::Integer(number), to, span);
                }
                let [from, into] = [from, into].map(|it| self.decl.program.enumeration(it).base);
                let number = self.convert(Conversion::Same, Type::Elementary(from), expr);
                self.may_become(from, into, span).then(|| {
                    let number = self.convert(Conversion::Value, Type::Elementary(into), number);
                    self.convert(Conversion::Same, to, number)
                })
            }
            (Type::Elementary(from), Type::Enum(id))
                if self.counts_as_number(id, span) && as_number(from).is_integer() =>
            {
                let base = self.decl.program.enumeration(id).base;
                if !self.may_become(from, base, span) {
                    return None;
                }
                let number = self.convert(Conversion::Value, Type::Elementary(base), expr);
                Some(self.convert(Conversion::Same, to, number))
            }
            _ => {
                if let Some(message) = self.decl.held_instance(expr.ty) {
                    return self.instance_is_no_value(&expr, message, span);
                }
                let (expected, found) = (self.type_name(to), self.type_name(expr.ty));
                let error = Diagnostic::new(Code::E0201, span, format!("expected {expected}, found {found}"))
                    .label(format!("this is {found}"));
                self.report(match (expr.ty, to, self.members(to), self.short_text(span)) {
                    (Type::Enum(_), Type::Elementary(it), _, Some(text)) if it.is_integer() => {
                        let meant = format!("TO_{}({text})", it.name());
                        error.help(format!("write `{meant}`")).fix(span, meant)
                    }
                    (_, _, Some(members), _) => error.help(format!("name a member: {members}")),
                    (Type::Elementary(it), Type::String(into), None, Some(text)) => {
                        let meant = format!("{}_TO_{}({text})", it.name(), into.word());
                        error.help(format!("write `{meant}`")).fix(span, meant)
                    }
                    (Type::String(_), Type::BOOL, None, Some(text)) => {
                        match text.trim_matches('\'').to_ascii_uppercase() {
                            word if ["TRUE", "FALSE"].contains(&word.as_str()) => {
                                error.help(format!("write `{word}`")).fix(span, word)
                            }
                            _ => error,
                        }
                    }
                    _ => error,
                });
                None
            }
        }
    }

    /// What is written there, where a help can repeat it.
    pub(super) fn short_text(&self, span: Span) -> Option<String> {
        let text = self.decl.log.sources.text(span);
        ((1..60).contains(&text.len()) && !text.contains('\n')).then(|| text.to_owned())
    }

    /// Reports an `ARRAY[*]` that is assigned, or read, as a whole.
    fn open_is_no_value(&mut self, ty: Type, span: Span) -> Option<Expr> {
        let ty = self.type_name(ty);
        self.report(
            Diagnostic::new(Code::E0201, span, "an ARRAY[*] cannot be assigned as a whole")
                .label(format!("this is {ty}"))
                .help("assign its elements, from LOWER_BOUND to UPPER_BOUND"),
        );
        None
    }

    /// The first members of an enumeration, for a message.
    pub(crate) fn members(&self, ty: Type) -> Option<String> {
        let Type::Enum(id) = ty else { return None };
        let enumeration = self.decl.program.enumeration(id);
        let is_qualified = |name: &str| self.decl.names.qualified_enumerators.contains_key(&Key(name));
        let name = |name: &str| match is_qualified(name) {
            true => format!("{}.{name}", enumeration.name),
            false => name.to_owned(),
        };
        let names: Vec<_> = enumeration.values.iter().take(4).map(|it| name(&it.name)).collect();
        let list = crate::diagnostic::wording::any_of(&names.iter().map(String::as_str).collect::<Vec<_>>());
        Some(if enumeration.values.len() > names.len() { format!("{list}, …") } else { list })
    }

    pub(crate) fn instance_is_no_value(&mut self, expr: &Expr, message: String, span: Span) -> Option<Expr> {
        let outputs: Vec<String> = match expr.ty {
            Type::Block(id) => id.info().outputs().map(|it| it.name.to_owned()).collect(),
            Type::Struct(id) if self.decl.is_instance(id) => {
                let fields = &self.decl.program.structure(id).fields;
                let outputs = fields.iter().filter(|it| it.section == staunch_ir::Section::Output);
                outputs.map(|it| it.name.clone()).collect()
            }
            Type::Elementary(_)
            | Type::Reference(_)
            | Type::Subrange(..)
            | Type::String(_)
            | Type::Enum(_)
            | Type::Array(_)
            | Type::Struct(_) => Vec::new(),
        };
        let text = self.decl.log.sources.text(span);
        let whole =
            matches!(expr.ty, Type::Block(_)) || matches!(expr.ty, Type::Struct(id) if self.decl.is_instance(id));
        let label = if whole { "this is the block itself" } else { "this would copy the block itself" };
        let mut error = Diagnostic::new(Code::E0210, span, message).label(label);
        if !outputs.is_empty() && !text.contains(char::is_whitespace) {
            let names: Vec<_> = outputs.iter().map(|it| format!("{text}.{it}")).collect();
            let names: Vec<_> = names.iter().map(String::as_str).collect();
            error = error.help(format!("read one of its outputs: {}", crate::diagnostic::wording::any_of(&names)));
        }
        self.report(error);
        None
    }

    /// Whether a value of `from` converts to `to` by itself; else says what to write.
    fn may_become(&mut self, from: Elementary, to: Elementary, span: Span) -> bool {
        let may = widens(from, to) || self.dialect_allows(from, to, span);
        if !may {
            self.report_narrowing(from, to, span);
        }
        may
    }

    /// What CODESYS converts without being asked.
    fn dialect_allows(&mut self, from: Elementary, to: Elementary, span: Span) -> bool {
        if self.decl.dialect(span).converts_numbers() {
            return self.becomes_number(from, to, span);
        }
        if !self.decl.dialect(span).mixes_bits_and_integers() {
            return false;
        }
        let (low, high) = (from.repr().range(), to.repr().range());
        let (Some(from_range), Some(to_range)) = (low, high) else {
            return widens(as_number(from), to) || self.loses_precision(from, to, span);
        };
        if is_no_number(from) || is_no_number(to) {
            return false;
        }
        if from_range.0 >= to_range.0 && from_range.1 <= to_range.1 {
            return true;
        }
        let sign_only = !keeps_low_bits(from, to);
        // As wide as an address and a size are where CODESYS has 64 bits: what code of 32 bits keeps in fewer.
        let is_address = matches!(from, Elementary::Ulint | Elementary::Lword) && to.repr().is_unsigned();
        if !sign_only && (is_address || self.decl.log.options.implicit_narrowing) {
            self.report_cut(from, to, span);
            return true;
        }
        if sign_only {
            self.report_sign(from, to, span);
        }
        sign_only
    }

    pub(super) fn report_cut(&mut self, from: Elementary, to: Elementary, span: Span) {
        let message = format!("{} becomes {}: high bits are cut", from.name(), to.name());
        self.report_implicit(Code::W0513, message, from, to, span);
    }

    pub(super) fn report_sign(&mut self, from: Elementary, to: Elementary, span: Span) {
        let message = format!("{} becomes {}: the sign may change", from.name(), to.name());
        self.report_implicit(Code::W0506, message, from, to, span);
    }

    pub(super) fn report_implicit(
        &mut self,
        code: Code,
        message: String,
        from: Elementary,
        to: Elementary,
        span: Span,
    ) {
        self.report(Diagnostic::new(code, span, message).label("implicit conversion").help(format!(
            "convert it explicitly: `{}_TO_{}(…)`",
            from.name(),
            to.name()
        )));
    }

    /// Logix stores each number in a tag of any type of numbers (1756-RM003, "Data Conversions"): a real is rounded, ties
    /// to even, and an integer keeps its low bits. A BOOL is not a number.
    fn becomes_number(&mut self, from: Elementary, to: Elementary, span: Span) -> bool {
        match (from.is_real(), to.is_real()) {
            _ if !(from.is_real() || from.is_integer()) || !(to.is_real() || to.is_integer()) => return false,
            (_, true) => return self.loses_precision(from, to, span),
            (true, false) => {
                let message = format!("{} becomes {}: it is rounded", from.name(), to.name());
                self.report_implicit(Code::W0511, message, from, to, span);
            }
            (false, false) if keeps_low_bits(from, to) => self.report_cut(from, to, span),
            (false, false) => self.report_sign(from, to, span),
        }
        true
    }

    /// CODESYS makes a real of any integer, and a REAL of an LREAL, with a warning where that has more digits (C0197).
    pub(super) fn loses_precision(&mut self, from: Elementary, to: Elementary, span: Span) -> bool {
        let from = as_number(from);
        let lost = match from {
            Elementary::Lreal => "about 7 of 15 digits are kept",
            _ => "large values are rounded",
        };
        if !(from.is_integer() || from.is_real()) || !to.is_real() {
            return false;
        }
        let message = format!("{} becomes {}: {lost}", from.name(), to.name());
        self.report_implicit(Code::W0511, message, from, to, span);
        true
    }

    fn report_narrowing(&mut self, from: Elementary, to: Elementary, span: Span) {
        let function = format!("{}_TO_{}", from.name(), to.name());
        let mut error = Diagnostic::new(Code::E0203, span, format!("expected {}, found {}", to.name(), from.name()))
            .about(Subject::Mismatch(to, from))
            .label(format!("{} is not converted to {} implicitly", from.name(), to.name()));
        // Timers of Logix count milliseconds in DINTs, and its conversions of a TIME microseconds.
        let is_milliseconds = self.decl.dialect(span).family() == Family::Logix && from.is_duration();
        error = match self.short_text(span) {
            _ if is_milliseconds => {
                error.help("PRE and ACC of a timer count milliseconds: write their number, 500 for `T#500ms`")
            }
            Some(text) => error.help(format!("write `{function}({text})`")).fix(span, format!("{function}({text})")),
            None => error.help(format!("convert it with `{function}(…)`")),
        };
        let may_be_set = self.decl.dialect(span).mixes_bits_and_integers() && keeps_low_bits(from, to);
        if may_be_set && !std::mem::replace(&mut self.decl.log.has_named_narrowing, true) {
            error = error.note("`implicit-narrowing = true` in staunch.toml lets it keep its low bits, as ruSTy does and CODESYS does not");
        }
        self.report(error);
    }

    /// A literal of one character where a CHAR or WCHAR is wanted.
    fn as_character(&mut self, value: &Expr, ty: Elementary, span: Span) -> Option<Expr> {
        let found = match &value.kind {
            ExprKind::Text(Chars::Narrow(bytes)) if ty == Elementary::Char => {
                <[u8; 1]>::try_from(bytes.as_slice()).ok().map(|it| Value::U8(it[0]))
            }
            ExprKind::Text(Chars::Wide(units)) if ty == Elementary::Wchar => {
                <[u16; 1]>::try_from(units.as_slice()).ok().map(|it| Value::U16(it[0]))
            }
            _ => None,
        };
        if let Some(found) = found {
            return Some(Expr::new(Type::Elementary(ty), ExprKind::Const(found), value.at));
        }
        let (name, string) = (ty.name(), self.type_name(value.ty));
        let error = Diagnostic::new(Code::E0201, span, format!("expected {name}, found {string}"));
        self.report(match &value.kind {
            ExprKind::Text(text) if text.is_wide() == (ty == Elementary::Wchar) => {
                let units = if text.is_wide() { "UTF-16 code units" } else { "bytes" };
                error.label(format!("this has {} {units}, and a {name} is one", text.len()))
            }
            ExprKind::Text(_) if ty == Elementary::Wchar => {
                error.label(format!("a WCHAR is written {}", self.decl.dialect(span).wide_text("WCHAR", "A")))
            }
            ExprKind::Text(_) => error.label("a CHAR is written in single quotes: `'A'`"),
            _ => {
                let text = self.decl.log.sources.text(span).to_owned();
                let from = value.ty.string_type().map_or("STRING", StringType::word);
                error
                    .label(format!("this is {string}"))
                    .help(format!("take its first character: `{from}_TO_{name}({text})`"))
            }
        });
        None
    }

    /// A STRING where a WSTRING is wanted, or the other way round: the standard has no implicit conversion.
    pub(crate) fn report_other_string(&mut self, value: &Expr, to: StringType, span: Span) {
        let from = value.ty.string_type().map_or("STRING", StringType::word);
        let found = self.type_name(value.ty);
        let text = self.decl.log.sources.text(span).to_owned();
        let error = Diagnostic::new(Code::E0201, span, format!("expected {to}, found {found}"));
        self.report(match value.kind {
            ExprKind::Text(_) if to.wide => {
                error.label(format!("a WSTRING is written {}", self.decl.dialect(span).wide_text("WSTRING", "…")))
            }
            ExprKind::Text(_) => {
                let error = error.label("a STRING is written in single quotes: `'…'`");
                match text.strip_prefix('"').and_then(|it| it.strip_suffix('"')) {
                    Some(inner) if !inner.contains(['\'', '$']) => {
                        error.help(format!("write `'{inner}'`")).fix(span, format!("'{inner}'"))
                    }
                    Some(_) | None => error,
                }
            }
            _ => error.label(format!("this is {found}")).help(format!("write `{from}_TO_{}({text})`", to.word())),
        });
    }

    fn warn_of_cut(&mut self, value: &Expr, ty: StringType, span: Span) {
        let ExprKind::Text(text) = &value.kind else { return };
        if !text.fits(ty) {
            let message = format!("this text has {} characters, but {ty} holds {}", text.len(), ty.capacity);
            self.report(Diagnostic::new(Code::W0202, span, message).label("the rest is cut off"));
        }
    }
}

fn is_no_number(ty: Elementary) -> bool {
    ty == Elementary::Bool || ty.is_time()
}

/// Whether a conversion of integers and bit strings cuts high bits.
fn keeps_low_bits(from: Elementary, to: Elementary) -> bool {
    let are_numbers = [from, to].iter().all(|it| !is_no_number(*it) && it.repr().range().is_some());
    are_numbers && from.repr().size() > to.repr().size()
}
