//! AND, OR, XOR and NOT: of BOOLs and bit strings, of integers where those are bit strings, too, and of the bits of
//! integers where a dialect has no bit strings.

use super::checker::Checker;
use super::operand::{Operand, computed, pattern};
use super::operator::{Meeting, Sides};
use crate::{Code, Diagnostic, Span, ast};
use ast::BinaryOp;
use staunch_ir::narrow::is_narrow;
use staunch_ir::{Conversion, Elementary, Expr, ExprKind, Op, Type};

impl<'s> Checker<'_, 's> {
    pub(super) fn bitwise(&mut self, sides: Sides) -> Option<Operand> {
        let op = match sides.op {
            BinaryOp::And => Op::And,
            BinaryOp::Or => Op::Or,
            _ => Op::Xor,
        };
        let op_span = sides.op_span;
        if let Some(own) = self.own_of_integers(&sides) {
            let ty = computed_at(own);
            let a = self.bits_of(sides.a, ty, sides.left)?;
            let b = self.bits_of(sides.b, ty, sides.right)?;
            let value = self.apply(op, a.ty, vec![a, b], Type::Elementary(ty), op_span)?;
            return Some(computed(value, Type::Elementary(own)));
        }
        let allowed = |ty: Elementary, mixes: bool| ty.is_bits() || (mixes && ty.is_integer());
        let wants = match self.decl.dialect(op_span).has_bits_of_integers() {
            true => "both sides need to be BOOL, or integers",
            false => "both sides need to be BOOL, or bit strings",
        };
        let Meeting { ty, own, a, b } = self.meet(sides, allowed, wants)?;
        let value = self.apply(op, ty, vec![a, b], ty, op_span)?;
        Some(computed(value, own))
    }

    /// `NOT` of an operand as it is written.
    pub(super) fn complement(&mut self, operand: Operand, expected: Option<Type>, span: Span) -> Option<Operand> {
        match operand.ty() {
            None if let Some(value) = self.complement_of_immediate(&operand, span) => Some(Operand::Integer(value)),
            Some(Type::Elementary(own)) if own.is_integer() && self.decl.dialect(span).has_bits_of_integers() => {
                let value = self.bits_of(operand, computed_at(own), span)?;
                let ty = value.ty;
                let value = self.apply(Op::Not, ty, vec![value], ty, span)?;
                Some(computed(value, Type::Elementary(own)))
            }
            Some(own @ Type::Elementary(it)) if it.is_bits() && self.decl.dialect(span).rules().complements_as_c() => {
                let value = self.materialise(operand, expected, span)?;
                let value = self.promote(value, span);
                let ty = value.ty;
                let value = self.apply(Op::Not, ty, vec![value], ty, span)?;
                Some(computed(value, own))
            }
            _ => {
                let value = self.materialise(operand.cut(), expected, span)?;
                self.not(value, span).map(Operand::Typed)
            }
        }
    }

    /// Whether STruC++ writes C++'s `!` for NOT of this, which makes 1 of 0 and 0 of anything else: it does where it does not
    /// know the type or takes it for INT: right before a number without a type, SEL, MUX and LIMIT, and before a function whose
    /// first argument is one of those or has no known type; and NOT of that, in parentheses, is of a BOOL.
    pub(super) fn negates_as_bool(&self, inner: &ast::Expr<'s>) -> bool {
        self.has_functions_of_strucpp(inner.span)
            && match &inner.kind {
                ast::ExprKind::Call(..) => is_chosen(inner) || is_of_unknown(inner),
                ast::ExprKind::Unary(ast::UnaryOp::Not, it) => matches!(&it.bare().kind, ast::ExprKind::Binary(..)),
                ast::ExprKind::Paren(it) => match &it.kind {
                    ast::ExprKind::Unary(ast::UnaryOp::Not, inner) => self.negates_as_bool(inner),
                    _ => false,
                },
                _ => false,
            }
    }

    /// 1 where the bits are none, and 0 else.
    pub(super) fn is_zero(&mut self, operand: Operand, expected: Option<Type>, span: Span) -> Option<Operand> {
        let value = self.materialise(operand.cut(), expected, span)?;
        let ty = value.ty;
        if ty == Type::BOOL || !matches!(ty, Type::Elementary(it) if it.is_bits() || it.is_integer()) {
            return self.not(value, span).map(Operand::Typed);
        }
        let zero = Expr::new(ty, ExprKind::Const(self.decl.program.repr(ty)?.zero()), value.at);
        let is_zero = self.apply(Op::Eq, ty, vec![value, zero], Type::BOOL, span)?;
        Some(Operand::Typed(self.convert(Conversion::Value, ty, is_zero)))
    }

    /// An immediate value is a DINT (1756-RM006K, p. 545), or a LINT where a DINT does not hold it.
    fn complement_of_immediate(&self, operand: &Operand, span: Span) -> Option<i128> {
        let Operand::Integer(value) = operand else { return None };
        let of_integers = self.decl.dialect(span).has_bits_of_integers();
        let types = [Elementary::Dint, Elementary::Lint];
        types.into_iter().filter(|_| of_integers).find_map(|it| pattern(*value, it)).map(|it| !it)
    }

    pub(crate) fn not(&mut self, value: Expr, span: Span) -> Option<Expr> {
        let value = match value.ty {
            Type::Enum(id) if self.decl.table.named_values.contains(&id) => {
                let base = Type::Elementary(self.decl.program.enumeration(id).base);
                self.convert(Conversion::Same, base, value)
            }
            _ => value,
        };
        let ty = value.ty;
        let dialect = self.decl.dialect(span);
        let of_integers = dialect.mixes_bits_and_integers() || dialect.has_bits_of_integers();
        let bits = matches!(ty, Type::Elementary(it) if it.is_bits() || (of_integers && it.is_integer()));
        if !bits {
            let found = self.type_name(ty);
            let wanted = if dialect.has_bits_of_integers() { "an integer" } else { "a bit string" };
            let error =
                Diagnostic::new(Code::E0204, span, format!("NOT needs a BOOL or {wanted}, but this is {found}"))
                    .label(format!("this is {found}"));
            self.report(match self.comparison_from(span) {
                Some(comparison) => error
                    .note("NOT applies to the operand after it alone, before any comparison")
                    .help(format!("write `NOT ({})`", self.decl.log.sources.text(comparison)))
                    .fix(comparison, format!("({})", self.decl.log.sources.text(comparison))),
                None => error,
            });
            return None;
        }
        self.apply(Op::Not, ty, vec![value], ty, span)
    }

    /// `n = 5` from its first operand on, where a name or a number follows the sign.
    fn comparison_from(&self, first: Span) -> Option<Span> {
        let text = &self.decl.log.sources.get(first.file).text;
        let rest = text.get(usize::try_from(first.end).ok()?..)?;
        let after = rest.trim_start();
        let sign = after.find(|it| !"<>=".contains(it)).filter(|it| *it > 0)?;
        let operand = after[sign..].trim_start();
        let is_part = |it: char| it.is_ascii_alphanumeric() || "_.#".contains(it);
        let len = operand.find(|it| !is_part(it)).filter(|it| *it > 0)?;
        let end = rest.len() - operand.len() + len;
        Some(Span { end: first.end + u32::try_from(end).ok()?, ..first })
    }

    /// The type that bits of these sides count as, where both are integers of a dialect that has none but their bits: that of
    /// more bits, of as many the unsigned one (1756-RM006K, p. 541).
    fn own_of_integers(&self, sides: &Sides) -> Option<Elementary> {
        if !self.decl.dialect(sides.span).has_bits_of_integers() {
            return None;
        }
        let own = |side: &Operand| match (side, side.ty()) {
            (_, Some(Type::Elementary(it))) if it.is_integer() => Some(it),
            (Operand::Integer(value), None) => {
                let types = [Elementary::Sint, Elementary::Int, Elementary::Dint, Elementary::Lint];
                types.into_iter().find(|it| pattern(*value, *it).is_some())
            }
            _ => None,
        };
        let both = [own(&sides.a)?, own(&sides.b)?];
        both.into_iter().max_by_key(|it| (it.repr().size(), it.repr().is_unsigned()))
    }

    /// The bits of an integer in a type of as many or more: those that it has not are 0.
    fn bits_of(&mut self, operand: Operand, ty: Elementary, span: Span) -> Option<Expr> {
        let to = Type::Elementary(ty);
        if let Operand::Integer(value) = operand {
            let value = pattern(value, ty).unwrap_or(value);
            return self.coerce(Operand::Integer(zero_filled(value, ty)), to, span);
        }
        let value = self.materialise(operand, Some(to), span)?;
        let Type::Elementary(from) = value.ty else { return None };
        let unsigned = match from {
            Elementary::Sint => Elementary::Usint,
            Elementary::Int => Elementary::Uint,
            Elementary::Dint => Elementary::Udint,
            other => other,
        };
        let is_wider = from.repr().size() < ty.repr().size();
        let value = if is_wider { self.convert(Conversion::Value, Type::Elementary(unsigned), value) } else { value };
        Some(self.convert(Conversion::Value, to, value))
    }
}

/// An immediate value is a DINT, and with a 64-bit operand it has zeros above, as every operand of an instruction on bits
/// (1756-RM006K, pp. 541 and 545).
fn zero_filled(value: i128, ty: Elementary) -> i128 {
    let is_dint = Elementary::Dint.repr().integer(value).is_some();
    let wide = ty.repr().size() == 8;
    let value = if wide && is_dint && value < 0 { value + (1 << 32) } else { value };
    let is_negative = value < 0 && ty.repr().is_unsigned();
    if is_negative { value + (1 << (ty.repr().size() * 8)) } else { value }
}

/// At how many bits those of an integer are computed: 32 at least.
fn computed_at(own: Elementary) -> Elementary {
    if is_narrow(own) { Elementary::Dint } else { own }
}

/// Whether a call's first argument combines bits, or is such a call.
fn is_of_unknown(call: &ast::Expr<'_>) -> bool {
    const OF_BITS: [&str; 9] = ["MAX", "MIN", "SHL", "SHR", "ROL", "ROR", "AND", "OR", "XOR"];
    let ast::ExprKind::Call(callee, arguments) = &call.kind else { return false };
    let is_one = callee.first_name().is_some_and(|it| OF_BITS.iter().any(|own| own.eq_ignore_ascii_case(it.text)));
    let first = arguments.first().map(|it| match &it.kind {
        ast::ArgumentKind::Positional(value) | ast::ArgumentKind::Input(_, value) => value,
        ast::ArgumentKind::Output { .. } => call,
    });
    let combines = |it: &ast::Expr<'_>| match &it.bare().kind {
        ast::ExprKind::Binary(_, op, _) => matches!(op, BinaryOp::And | BinaryOp::Or | BinaryOp::Xor),
        ast::ExprKind::Call(..) => is_chosen(it.bare()) || is_of_unknown(it.bare()),
        _ => is_number(it),
    };
    is_one && first.is_some_and(combines)
}

/// Whether it is a call of a function whose result has no type that STruC++ knows.
fn is_chosen(call: &ast::Expr<'_>) -> bool {
    let ast::ExprKind::Call(callee, _) = &call.kind else { return false };
    let ast::ExprKind::Name(name) = &callee.kind else { return false };
    ["SEL", "MUX", "LIMIT"].iter().any(|it| it.eq_ignore_ascii_case(name.text))
}

/// A number without a type.
pub(super) fn is_number(expr: &ast::Expr<'_>) -> bool {
    matches!(&expr.bare().kind, ast::ExprKind::Literal(it) if it.prefix.is_none())
}
