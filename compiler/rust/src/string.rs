//! Expressions on character strings.

use proc_macro2::{Ident, TokenStream};
use quote::{ToTokens, quote};
use staunch_ir::alias::Frame;
use staunch_ir::pieces::{Piece, Start, in_place, most, pieces};
use staunch_ir::{Expr, ExprKind, Op, Place, Statement, TextOp, Type};

use crate::function::Function;
use crate::names::ident;
use crate::precedence::{Code, Level};
use crate::text::{as_units, head, typed_head, units};
use staunch_ir::faults;

impl Function<'_> {
    /// A string as `&Text`.
    pub fn text_reference(&self, value: &Expr) -> TokenStream {
        match &value.kind {
            ExprKind::Load(place) if self.emitter.shared => {
                let value = self.load(place).at_least(Level::Postfix);
                quote!(&#value)
            }
            ExprKind::Load(place) if self.is_whole_param(place) => self.place(place),
            ExprKind::Load(place) => {
                let place = self.place(place);
                quote!(&#place)
            }
            ExprKind::Const(_)
            | ExprKind::Text(_)
            | ExprKind::Aggregate(_)
            | ExprKind::AddressOf(_)
            | ExprKind::Apply(..)
            | ExprKind::ApplyText(..)
            | ExprKind::Convert(..) => {
                let value = self.typed_text(value).at_least(Level::Postfix);
                quote!(&#value)
            }
        }
    }

    /// A string whose own text says its capacity.
    fn typed_text(&self, value: &Expr) -> Code {
        let ty = typed_head(value.ty);
        match &value.kind {
            ExprKind::ApplyText(op, operands) => self.apply_text(value, *op, operands, true),
            ExprKind::Convert(_, inner) if inner.ty != value.ty => {
                if !matches!(inner.kind, ExprKind::Load(_)) {
                    return self.built(value, true);
                }
                let inner = self.text_reference(inner);
                Code::postfix(quote!(#ty::from_text(#inner)))
            }
            ExprKind::Text(text) => {
                let units = units(text);
                Code::postfix(quote!(#ty::new(#units)))
            }
            ExprKind::Const(_)
            | ExprKind::Aggregate(_)
            | ExprKind::Load(_)
            | ExprKind::AddressOf(_)
            | ExprKind::Apply(..)
            | ExprKind::Convert(..) => self.expr(value),
        }
    }

    /// A string as a slice of its units.
    fn units(&self, value: &Expr) -> TokenStream {
        let as_units = as_units(value.ty);
        match &value.kind {
            ExprKind::Text(text) => units(text),
            ExprKind::Load(place) if self.emitter.shared => {
                let value = self.load(place).at_least(Level::Postfix);
                quote!(#value.#as_units())
            }
            ExprKind::Load(place) => {
                let place = self.place(place);
                quote!(#place.#as_units())
            }
            ExprKind::Const(_)
            | ExprKind::Aggregate(_)
            | ExprKind::AddressOf(_)
            | ExprKind::Apply(..)
            | ExprKind::ApplyText(..)
            | ExprKind::Convert(..) => {
                let value = self.typed_text(value).at_least(Level::Postfix);
                quote!(#value.#as_units())
            }
        }
    }

    pub fn apply_text(&self, expr: &Expr, op: TextOp, operands: &[Expr], typed: bool) -> Code {
        if op.result().is_none() {
            return self.built(expr, typed);
        }
        let function = ident(op.function());
        let arguments = operands.iter().map(|it| self.argument_of_text(it));
        Code::postfix(quote!(text::#function(#(#arguments),*)))
    }

    /// A string of its pieces.
    pub fn built(&self, expr: &Expr, typed: bool) -> Code {
        let head = if typed { typed_head(no_longer_than(expr.ty, most(expr))) } else { head(expr.ty) };
        let Written { before, writes } = self.written(&pieces(expr));
        let build = match writes.as_slice() {
            [only] => quote!(#head::build(|out| #only)),
            writes => quote!(#head::build(|out| { #(#writes;)* })),
        };
        if before.is_empty() {
            return Code::postfix(build);
        }
        Code::new(quote!({ #(#before)* #build }), Level::Block)
    }

    /// Two strings that are compared for being equal: `None` where it is another operation.
    pub fn equal_texts(&self, op: Op, operands: &[Expr]) -> Option<Code> {
        let [Expr { kind: ExprKind::ApplyText(TextOp::Compare, texts), .. }, zero] = operands else { return None };
        let sign = match op {
            Op::Eq => quote!(==),
            Op::Ne => quote!(!=),
            _ => return None,
        };
        let is_zero = zero.as_const().and_then(|it| it.as_integer()) == Some(0);
        let [a, b] = texts.as_slice() else { return None };
        is_zero.then(|| {
            let (a, b) = (self.units(a), self.units(b));
            Code::new(quote!(#a #sign #b), Level::Compare)
        })
    }

    /// `target := value;` without a string in between; `None` where there must be one, or where there is none anyway.
    pub fn assign_text(&self, statement: &Statement, target: &Place, value: &Expr) -> Option<TokenStream> {
        let is_declared = self.plan.declares(statement, target).is_some();
        let is_copied = matches!(value.kind, ExprKind::Load(_));
        if self.emitter.shared || is_declared || is_copied || !matches!(value.ty, Type::String(_)) {
            return None;
        }
        let (start, pieces) = in_place(&Frame::of(self.emitter.program, self.routine), target, value)?;
        let Written { mut before, writes } = self.written(&pieces);
        // The target's subscripts come first, and the first fault wins.
        let place = if self.place_faults(target) && faults::expr_faults(self.emitter.program, value) {
            let mut subscripts = Vec::new();
            let place = self.fixed_place(target, &mut subscripts);
            before.splice(0..0, subscripts);
            place
        } else {
            self.written_place(target)
        };
        let written = match (pieces.as_slice(), start) {
            ([Piece::Text(text)], _) if before.is_empty() => {
                let (units, method) = (self.units(text), if start == Start::Anew { "assign" } else { "append" });
                let method = ident(method);
                quote!(#place.#method(#units);)
            }
            _ => {
                let end = ident(if start == Start::Anew { "destination" } else { "end" });
                match writes.as_slice() {
                    [Write::Made { function, arguments }] => {
                        quote!(text::#function(#(#arguments,)* &mut #place.#end());)
                    }
                    writes => quote!({ let out = &mut #place.#end(); #(#writes;)* }),
                }
            }
        };
        Some(if before.is_empty() { written } else { quote!({ #(#before)* #written }) })
    }

    /// What writes the pieces to `out`. What might fault is evaluated before: a closure cannot pass on a fault, and a
    /// fault leaves the target as it was.
    fn written(&self, pieces: &[Piece<'_>]) -> Written {
        let mut before = Vec::new();
        let writes = pieces.iter().map(|piece| {
            let arguments: Vec<_> = piece.operands().iter().map(|it| self.operand(it, &mut before)).collect();
            match piece {
                Piece::Text(_) => Write::Text { units: quote!(#(#arguments)*) },
                Piece::Made(op, _) => Write::Made { function: ident(op.function()), arguments },
            }
        });
        let writes = writes.collect();
        Written { before, writes }
    }

    /// An operand of a function on strings.
    fn operand(&self, operand: &Expr, before: &mut Vec<TokenStream>) -> TokenStream {
        // Each is printed once, or a long nest of them would be printed without end.
        if !faults::expr_faults(self.emitter.program, operand) {
            return self.argument_of_text(operand);
        }
        let name = self.made_up("operand", before.len());
        let as_units = as_units(operand.ty);
        let is_text = matches!(operand.ty, Type::String(_));
        let (value, argument) = match &operand.kind {
            // A made string must outlive its units.
            ExprKind::ApplyText(..) | ExprKind::Convert(..) if is_text => {
                (self.typed_text(operand).tokens, quote!(#name.#as_units()))
            }
            // The contents of a cell are copied out.
            ExprKind::Load(_) if self.emitter.shared && is_text => {
                (self.expr(operand).tokens, quote!(#name.#as_units()))
            }
            _ => (self.argument_of_text(operand), quote!(#name)),
        };
        before.push(quote!(let #name = #value;));
        argument
    }

    fn argument_of_text(&self, operand: &Expr) -> TokenStream {
        match operand.ty {
            Type::String(_) => self.units(operand),
            Type::Elementary(_)
            | Type::Reference(_)
            | Type::Subrange(..)
            | Type::Enum(_)
            | Type::Array(_)
            | Type::Struct(_)
            | Type::Block(_) => self.expr(operand).tokens,
        }
    }
}

/// The type of a string that is read at once and has no more than `most` characters.
fn no_longer_than(ty: Type, most: usize) -> Type {
    ty.string_type()
        .map_or(ty, |it| Type::String(it.of_capacity(it.capacity.min(u16::try_from(most).unwrap_or(u16::MAX)))))
}

/// Statements that write a string to `out`, after others.
struct Written {
    before: Vec<TokenStream>,
    writes: Vec<Write>,
}

/// What writes a piece to `out`.
enum Write {
    Text { units: TokenStream },
    Made { function: Ident, arguments: Vec<TokenStream> },
}

impl ToTokens for Write {
    fn to_tokens(&self, tokens: &mut TokenStream) {
        tokens.extend(match self {
            Self::Text { units } => quote!(out.write(#units)),
            Self::Made { function, arguments } => quote!(text::#function(#(#arguments,)* out)),
        });
    }
}
