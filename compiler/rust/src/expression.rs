//! Expressions. Whatever is printed in Rust's own words means exactly what the runtime's function
//! with the same name does; everything else calls that function.

use proc_macro2::{Literal, TokenStream};
use quote::quote;
use staunch_ir::{Conversion, Expr, ExprKind, Op, Repr, Type, Value};

use crate::function::Function;
use crate::literal::{literal, plain};
use crate::names::ident;
use crate::precedence::{Code, Level};
use crate::text;
use staunch_ir::faults;

impl Function<'_> {
    /// An expression where its type is known from the surroundings.
    pub fn expr(&self, expr: &Expr) -> Code {
        match &expr.kind {
            ExprKind::Const(value) => self.scalar(expr.ty, *value, false),
            ExprKind::Text(text) => self.emitter.constant(expr.ty, &staunch_ir::Const::Text(text.clone())),
            ExprKind::Aggregate(value) => self.emitter.constant(expr.ty, value),
            ExprKind::Load(place) => self.load(place),
            ExprKind::AddressOf(place) => self.reference_to(place),
            ExprKind::Apply(op, operands) => self.apply(expr, *op, operands),
            ExprKind::ApplyText(op, operands) => self.apply_text(expr, *op, operands, false),
            ExprKind::Convert(how, value) => self.convert(*how, expr, value),
        }
    }

    /// An expression whose own text says its type.
    pub fn typed(&self, expr: &Expr) -> Code {
        match &expr.kind {
            ExprKind::Const(value) => self.scalar(expr.ty, *value, true),
            ExprKind::Text(_)
            | ExprKind::Aggregate(_)
            | ExprKind::Load(_)
            | ExprKind::AddressOf(_)
            | ExprKind::Apply(..)
            | ExprKind::ApplyText(..)
            | ExprKind::Convert(..) => self.expr(expr),
        }
    }

    fn scalar(&self, ty: Type, value: Value, suffixed: bool) -> Code {
        match ty {
            Type::Elementary(it) | Type::Subrange(it, _) => literal(it, value, suffixed),
            Type::Enum(id) => self.emitter.enum_value(id, value),
            Type::Reference(_) => literal(staunch_ir::Elementary::Lword, value, suffixed),
            Type::String(_) | Type::Array(_) | Type::Struct(_) | Type::Block(_) => {
                unreachable!("verified IR: a scalar has a scalar's type")
            }
        }
    }

    pub fn repr(&self, ty: Type) -> Repr {
        self.emitter.program.repr(ty).expect("verified IR: operands are scalars")
    }

    fn apply(&self, expr: &Expr, op: Op, operands: &[Expr]) -> Code {
        if let Some(equal) = self.equal_texts(op, operands) {
            return equal;
        }
        let repr = self.operation_repr(expr, op, operands);
        let float = repr.is_float();
        if repr == Repr::Bool && matches!(op, Op::And | Op::Or) {
            return self.logical(op, operands);
        }
        if op == Op::Not {
            return self.not(&operands[0]);
        }
        if op == Op::Neg && float {
            return self.prefix(quote!(-), operands);
        }
        if let Some(method) = wrapping(op).filter(|_| !float) {
            return self.method(method, operands);
        }
        // A division of integers faults, where Rust's own would panic.
        if operator(op).is_some() && (op != Op::Div || float) {
            return self.operator(op, operands);
        }
        self.shifted(op, repr, operands).unwrap_or_else(|| self.call_op(expr, op, operands))
    }

    /// `bits >> 1` by a constant, which says more to the optimiser than a call does that compares the count.
    fn shifted(&self, op: Op, repr: Repr, operands: &[Expr]) -> Option<Code> {
        let sign = match op {
            Op::Shl => quote!(<<),
            Op::Shr => quote!(>>),
            _ => return None,
        };
        let [bits, count] = operands else { return None };
        let count = count.as_const().and_then(Value::as_integer)?;
        let moves = (1..i128::from(8 * repr.size())).contains(&count);
        if !moves || !repr.is_unsigned() || repr == Repr::Bool || matches!(bits.ty, Type::Enum(_)) {
            return None;
        }
        let (bits, count) = (self.typed(bits).at_least(Level::Unary), Literal::i128_unsuffixed(count));
        Some(Code::new(quote!(#bits #sign #count), Level::Shift))
    }

    /// The repr of the row's `T`.
    fn operation_repr(&self, expr: &Expr, op: Op, operands: &[Expr]) -> Repr {
        let first = op.operands().iter().position(Option::is_none);
        self.repr(first.map_or(expr.ty, |at| operands[at].ty))
    }

    /// Operands for an operator or method: at least one says its type.
    fn operands(&self, op: Op, operands: &[Expr]) -> Vec<Code> {
        let generic = |at: usize| op.operands().get(at).is_none_or(Option::is_none);
        let untyped = |at: usize, it: &Expr| generic(at) && it.as_const().is_some();
        let all_untyped = operands.iter().enumerate().all(|(at, it)| !generic(at) || untyped(at, it));
        let mut suffix = all_untyped;
        let mut printed = Vec::with_capacity(operands.len());
        for (at, operand) in operands.iter().enumerate() {
            let typed = suffix && generic(at);
            printed.push(if typed { self.typed(operand) } else { self.expr(operand) });
            suffix &= !typed;
        }
        printed
    }

    fn operator(&self, op: Op, operands: &[Expr]) -> Code {
        let mut printed = self.operands(op, operands).into_iter();
        let mut next = || printed.next().expect("verified IR: an operator has two operands");
        let (a, b) = (next(), next());
        let (level, sign) = operator(op).expect("only what Rust has a sign for is printed as one");
        let sign = sign();
        let a = match level {
            Level::Compare => a.above(level),
            _ => apart(a, level),
        };
        let b = if b.level == level { b.above(level) } else { apart(b, level) };
        Code::new(quote!(#a #sign #b), level)
    }

    /// `a && b` where `b` cannot fault, so that it cannot be observed whether it was evaluated.
    fn logical(&self, op: Op, operands: &[Expr]) -> Code {
        if faults::expr_faults(self.emitter.program, &operands[1]) {
            return self.operator(op, operands);
        }
        let (a, b) = (self.expr(&operands[0]), self.expr(&operands[1]));
        if let Op::And = op {
            let (a, b) = (a.at_least(Level::LazyAnd), b.above(Level::LazyAnd));
            return Code::new(quote!(#a && #b), Level::LazyAnd);
        }
        // `a && b || c` is right without parentheses, and easier to read with them.
        let (a, b) = (clearly(a), clearly(b));
        Code::new(quote!(#a || #b), Level::LazyOr)
    }

    fn prefix(&self, sign: TokenStream, operands: &[Expr]) -> Code {
        let value = self.expr(&operands[0]).at_least(Level::Unary);
        Code::new(quote!(#sign #value), Level::Unary)
    }

    /// `!value`; a comparison turns around where that says the same.
    pub fn not(&self, value: &Expr) -> Code {
        if let ExprKind::Apply(op, operands) = &value.kind {
            let exact = operands.first().is_some_and(|it| !self.repr(it.ty).is_float());
            match op {
                Op::Not if self.repr(value.ty) == Repr::Bool => return self.expr(&operands[0]),
                Op::Eq => return self.operator(Op::Ne, operands),
                Op::Ne => return self.operator(Op::Eq, operands),
                Op::Lt if exact => return self.operator(Op::Ge, operands),
                Op::Le if exact => return self.operator(Op::Gt, operands),
                Op::Gt if exact => return self.operator(Op::Le, operands),
                Op::Ge if exact => return self.operator(Op::Lt, operands),
                _ => {}
            }
        }
        let value = self.expr(value).at_least(Level::Unary);
        Code::new(quote!(!#value), Level::Unary)
    }

    fn method(&self, name: &str, operands: &[Expr]) -> Code {
        let name = ident(name);
        let receiver = self.receiver(&operands[0]);
        let rest = operands[1..].iter().map(|it| self.expr(it).tokens);
        Code::postfix(quote!(#receiver.#name(#(#rest),*)))
    }

    /// What a method is called on; Rust follows a reference there by itself.
    fn receiver(&self, expr: &Expr) -> TokenStream {
        if let ExprKind::Load(place) = &expr.kind
            && !self.emitter.shared
        {
            return self.place(place);
        }
        self.typed(expr).at_least(Level::Postfix)
    }

    /// `ops::name(…)`; enumerations go in and out as their numbers.
    fn call_op(&self, expr: &Expr, op: Op, operands: &[Expr]) -> Code {
        let function = ident(op.function());
        let printed = self.operands(op, operands).into_iter().zip(operands);
        let arguments = printed.map(|(code, operand)| match operand.ty {
            Type::Enum(_) => {
                let code = code.at_least(Level::Postfix);
                quote!(#code.0)
            }
            Type::Elementary(_)
            | Type::Reference(_)
            | Type::Subrange(..)
            | Type::String(_)
            | Type::Array(_)
            | Type::Struct(_)
            | Type::Block(_) => code.tokens,
        });
        let call = quote!(ops::#function(#(#arguments),*));
        let call = if op.can_fault() {
            let at = self.emitter.at(expr.at);
            quote!(#call #at?)
        } else {
            call
        };
        match (expr.ty, op.result()) {
            (Type::Enum(id), None) => {
                let name = self.emitter.names.enumeration(id);
                Code::postfix(quote!(#name(#call)))
            }
            _ => Code::postfix(call),
        }
    }

    fn convert(&self, how: Conversion, expr: &Expr, value: &Expr) -> Code {
        let ty = expr.ty;
        match (ty, value.ty) {
            (Type::String(to), Type::String(from)) if to == from => self.expr(value),
            (Type::String(_), Type::String(_)) if !matches!(value.kind, ExprKind::Load(_)) => self.built(expr, false),
            (Type::String(_), Type::String(_)) => {
                let (head, value) = (text::head(ty), self.text_reference(value));
                Code::postfix(quote!(#head::from_text(#value)))
            }
            (Type::Enum(to), Type::Enum(from)) if to == from => self.expr(value),
            (Type::Enum(id), _) => {
                if let (Some(value), Conversion::Same) = (value.as_const(), how) {
                    return self.emitter.enum_value(id, value);
                }
                let base = Type::Elementary(self.emitter.program.enumeration(id).base);
                let name = self.emitter.names.enumeration(id);
                let number = self.convert_repr(how, self.repr(base), value).tokens;
                Code::postfix(quote!(#name(#number)))
            }
            _ => self.convert_repr(how, self.repr(ty), value),
        }
    }

    /// Between reprs; an enumeration gives its number.
    fn convert_repr(&self, how: Conversion, to: Repr, value: &Expr) -> Code {
        let from = self.repr(value.ty);
        let inner = |typed: bool| {
            let code = if typed { self.typed(value) } else { self.expr(value) };
            match value.ty {
                Type::Enum(_) => {
                    let code = code.at_least(Level::Postfix);
                    Code::postfix(quote!(#code.0))
                }
                Type::Elementary(_)
                | Type::Reference(_)
                | Type::Subrange(..)
                | Type::String(_)
                | Type::Array(_)
                | Type::Struct(_)
                | Type::Block(_) => code,
            }
        };
        let (to_name, from_name) = (ident(to.rust_name()), ident(from.rust_name()));
        match how {
            Conversion::Truncate => {
                let value = inner(false).tokens;
                Code::postfix(quote!(ops::trunc::<#from_name, #to_name>(#value)))
            }
            Conversion::Bits => {
                let value = inner(true);
                if from.is_float() {
                    let value = value.at_least(Level::Postfix);
                    return Code::postfix(quote!(#value.to_bits()));
                }
                let value = value.tokens;
                Code::postfix(quote!(#to_name::from_bits(#value)))
            }
            _ if from == to => inner(true),
            Conversion::Value | Conversion::Same if is_lossless(from, to) => {
                let value = inner(true).tokens;
                Code::postfix(quote!(#to_name::from(#value)))
            }
            Conversion::Value | Conversion::Same if to == Repr::Bool => {
                let value = inner(true).above(Level::Compare);
                let zero = literal(plain(from), from.zero(), false).tokens;
                Code::new(quote!(#value != #zero), Level::Compare)
            }
            Conversion::Value | Conversion::Same => {
                let value = inner(false).tokens;
                Code::postfix(quote!(ops::convert::<#from_name, #to_name>(#value)))
            }
        }
    }
}

/// An operand of a sign on bits, in parentheses if it has another such sign.
fn apart(code: Code, level: Level) -> TokenStream {
    let bits = matches!(code.level, Level::And | Level::Or | Level::Xor | Level::Shift);
    if bits && code.level != level { code.at_least(Level::Postfix) } else { code.at_least(level) }
}

/// An operand of `||`, in parentheses if it is an `&&`.
fn clearly(code: Code) -> TokenStream {
    if code.level == Level::LazyAnd { code.at_least(Level::Postfix) } else { code.at_least(Level::LazyOr) }
}

type Sign = fn() -> TokenStream;

/// What Rust has a sign for.
const SIGNS: &[(Op, Level, Sign)] = &[
    (Op::Add, Level::Sum, || quote!(+)),
    (Op::Sub, Level::Sum, || quote!(-)),
    (Op::Mul, Level::Product, || quote!(*)),
    (Op::Div, Level::Product, || quote!(/)),
    (Op::And, Level::And, || quote!(&)),
    (Op::Or, Level::Or, || quote!(|)),
    (Op::Xor, Level::Xor, || quote!(^)),
    (Op::Eq, Level::Compare, || quote!(==)),
    (Op::Ne, Level::Compare, || quote!(!=)),
    (Op::Lt, Level::Compare, || quote!(<)),
    (Op::Le, Level::Compare, || quote!(<=)),
    (Op::Gt, Level::Compare, || quote!(>)),
    (Op::Ge, Level::Compare, || quote!(>=)),
];

fn operator(op: Op) -> Option<(Level, Sign)> {
    SIGNS.iter().find(|(known, ..)| *known == op).map(|(_, level, sign)| (*level, *sign))
}

/// The integers' method for what wraps around.
const WRAPPING: &[(Op, &str)] =
    &[(Op::Add, "wrapping_add"), (Op::Sub, "wrapping_sub"), (Op::Mul, "wrapping_mul"), (Op::Neg, "wrapping_neg")];

fn wrapping(op: Op) -> Option<&'static str> {
    WRAPPING.iter().find(|(known, _)| *known == op).map(|(_, method)| *method)
}

/// Whether Rust has `From` between the reprs; it then means what `ops::convert` means.
fn is_lossless(from: Repr, to: Repr) -> bool {
    if from == Repr::Bool {
        return true;
    }
    if to.is_float() {
        // A mantissa holds the smaller integers exactly.
        return from.size() < to.size() && to != Repr::Bool;
    }
    let widens = from.size() < to.size();
    from.is_integer() && to.is_integer() && widens && (from.is_unsigned() || to.is_signed())
}
