//! Expressions: operands and results of the types that operations take and give.

use super::Verifier;
use super::statement::Body;
use crate::{Conversion, Expr, ExprKind, Location, Op, Repr, Root, TextOp, Type, Value};
use staunch_runtime::Kind;

impl Verifier<'_> {
    pub(super) fn expr(&mut self, body: &Body, expr: &Expr) {
        self.location(expr.at);
        match &expr.kind {
            ExprKind::Const(value) => self.const_expr(expr, *value),
            ExprKind::Text(text) => {
                let fits = expr.ty.string_type().is_some_and(|it| text.fits(it));
                self.require(fits, expr.at, "a string constant longer than its type");
            }
            ExprKind::Aggregate(value) => {
                let aggregate = matches!(expr.ty, Type::Array(_) | Type::Struct(_) | Type::Block(_));
                if self.require(aggregate, expr.at, "an aggregate of a simple type") {
                    self.declared(expr.ty, expr.at);
                    self.constant(expr.ty, value, expr.at);
                }
            }
            ExprKind::Load(place) => {
                self.place(body, place, expr.at);
                self.require(place.ty == expr.ty || place.ty.read() == expr.ty, expr.at, "a read of another type");
            }
            ExprKind::AddressOf(place) => {
                self.writable(body, place, expr.at);
                // What lives for one call has fixed storage where its address is taken.
                let lasts = !matches!(place.root, Root::Local(_)) || place.is_followed();
                self.require(lasts, expr.at, "the address of what lives for one call");
                let refers = matches!(expr.ty, Type::Reference(_));
                self.require(refers, expr.at, "an address that is not a reference");
            }
            ExprKind::Apply(op, operands) => {
                operands.iter().for_each(|operand| self.expr(body, operand));
                self.operation(*op, operands, expr.ty, expr.at);
            }
            ExprKind::ApplyText(op, operands) => {
                operands.iter().for_each(|operand| self.expr(body, operand));
                self.text_operation(*op, operands, expr.ty, expr.at);
            }
            ExprKind::Convert(how, operand) => {
                self.expr(body, operand);
                self.conversion(*how, operand.ty, expr.ty, expr.at);
            }
        }
    }

    /// An expression of exactly this type.
    pub(super) fn expr_of(&mut self, body: &Body, expr: &Expr, ty: Type) {
        self.expr(body, expr);
        let holds = expr.ty == ty;
        self.require(holds, expr.at, format_args!("expected {ty:?}, found {:?}", expr.ty));
    }

    fn const_expr(&mut self, expr: &Expr, value: Value) {
        let fits = self.scalar_fits(expr.ty, value);
        self.require(fits, expr.at, "a constant that is not of its type");
    }

    /// The repr of an elementary or enumeration type that exists.
    pub(super) fn repr(&self, ty: Type) -> Option<Repr> {
        let exists = !matches!(ty, Type::Enum(id) if id.index() >= self.program.enums.len());
        exists.then(|| self.program.repr(ty)).flatten()
    }

    fn operation(&mut self, op: Op, operands: &[Expr], result: Type, at: Location) {
        let name = op.source_name();
        if !self.require(operands.len() == op.arity(), at, format_args!("{name}: operand count")) {
            return;
        }
        let pairs = || op.operands().iter().zip(operands);
        for (fixed, operand) in pairs() {
            let holds = fixed.is_none() || Self::elementary_repr(operand.ty) == *fixed;
            self.require(holds, operand.at, format_args!("{name}: an operand of the wrong repr"));
        }
        let free: Vec<Type> = pairs().filter(|(fixed, _)| fixed.is_none()).map(|(_, operand)| operand.ty).collect();
        let Some(repr) = self.shared_repr(op, &free) else {
            return self.report(at, format_args!("{name}: operands of {free:?}"));
        };
        self.require(op.allows(repr), at, format_args!("{name} does not exist at {repr:?}"));
        let expected = op.result().unwrap_or(repr);
        let holds = Self::elementary_repr(result) == Some(expected) && self.is_checked(op, operands, result);
        self.require(holds, at, format_args!("{name}: a result of {result:?}"));
    }

    /// Only the check of its own limits makes a value of a subrange.
    fn is_checked(&self, op: Op, operands: &[Expr], result: Type) -> bool {
        let Some((low, high)) = self.program.range(result) else { return true };
        let limit = |at: usize| operands.get(at).and_then(Expr::as_const).and_then(Value::as_integer);
        matches!(op, Op::InRange | Op::CheckIndex) && limit(0) == Some(low) && limit(2) == Some(high)
    }

    /// The repr of operands that share one. Enumerations have a repr only in a comparison of
    /// two of one type.
    fn shared_repr(&self, op: Op, operands: &[Type]) -> Option<Repr> {
        let first = *operands.first()?;
        if let Type::Enum(_) = first {
            let equal = is_comparison(op) && operands.iter().all(|ty| *ty == first);
            return self.repr(first).filter(|_| equal);
        }
        let repr = Self::elementary_repr(first)?;
        operands.iter().all(|ty| Self::elementary_repr(*ty) == Some(repr)).then_some(repr)
    }

    fn text_operation(&mut self, op: TextOp, operands: &[Expr], result: Type, at: Location) {
        let name = op.source_name();
        let wanted = op.signature().parameters;
        let wide = op.is_wide(operands);
        self.require(operands.len() == wanted.len(), at, format_args!("{name}: operand count"));
        for (wanted, operand) in wanted.iter().zip(operands) {
            let holds = is_of_kind(operand.ty, wanted.kind, wide);
            self.require(holds, operand.at, format_args!("{name}: an operand of {:?}", operand.ty));
        }
        let holds = is_of_kind(result, op.signature().result, wide);
        self.require(holds, at, format_args!("{name}: a result of {result:?}"));
    }

    fn conversion(&mut self, how: Conversion, from: Type, to: Type, at: Location) {
        let elementary = (Self::elementary_repr(from), Self::elementary_repr(to));
        let holds = match (how, from, to) {
            (Conversion::Value, Type::String(from), Type::String(to)) => from.wide == to.wide,
            (Conversion::Value, _, _) => matches!(elementary, (Some(_), Some(_))),
            (Conversion::Truncate, _, _) => {
                matches!(elementary, (Some(from), Some(to)) if from.is_float() && to.is_integer())
            }
            (Conversion::Bits, _, _) => matches!(elementary, (Some(from), Some(to)) if have_the_same_bits(from, to)),
            (Conversion::Same, _, _) => self.repr(from).is_some() && self.repr(from) == self.repr(to),
        };
        let holds = holds && self.program.range(to).is_none();
        self.require(holds, at, format_args!("no conversion {how:?} from {from:?} to {to:?}"));
    }
}

/// Whether an operand or result of a text operation is as its row says; `wide` is what its strings are, where they are
/// of either kind.
fn is_of_kind(ty: Type, kind: Kind, wide: bool) -> bool {
    let is_string = |wide| ty.string_type().is_some_and(|it| it.wide == wide);
    match kind {
        Kind::AnyString => is_string(wide),
        Kind::String => is_string(false),
        Kind::Wstring => is_string(true),
        Kind::T | Kind::Any(_) | Kind::Is(_) => kind.repr().is_some_and(|it| Verifier::elementary_repr(ty) == Some(it)),
    }
}

fn have_the_same_bits(from: Repr, to: Repr) -> bool {
    let (real, number) = if from.is_float() { (from, to) } else { (to, from) };
    real.is_float() && number.is_unsigned() && real.size() == number.size()
}

fn is_comparison(op: Op) -> bool {
    matches!(op, Op::Eq | Op::Ne | Op::Lt | Op::Le | Op::Gt | Op::Ge)
}
