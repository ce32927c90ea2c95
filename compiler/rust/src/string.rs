//! Expressions on character strings.

use proc_macro2::TokenStream;
use quote::quote;
use staunch_ir::{Expr, ExprKind, TextOp, Type};

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
        let function = ident(op.function());
        let print = |it: &Expr| match it.ty {
            Type::String(_) => self.units(it),
            Type::Elementary(_)
            | Type::Reference(_)
            | Type::Subrange(..)
            | Type::Enum(_)
            | Type::Array(_)
            | Type::Struct(_)
            | Type::Block(_) => self.expr(it).tokens,
        };
        if op.result().is_some() {
            let arguments = operands.iter().map(print);
            return Code::postfix(quote!(text::#function(#(#arguments),*)));
        }
        // A closure cannot pass on a fault: what might fault is evaluated before it.
        let (mut before, mut arguments) = (Vec::new(), Vec::new());
        for operand in operands {
            // Each is printed once, or a long nest of them would be printed without end.
            if !faults::expr_faults(self.emitter.program, operand) {
                arguments.push(print(operand));
                continue;
            }
            let name = self.made_up("operand", before.len());
            let as_units = as_units(operand.ty);
            before.push(match &operand.kind {
                // A made string must outlive its units.
                ExprKind::ApplyText(..) | ExprKind::Convert(..) if matches!(operand.ty, Type::String(_)) => {
                    let value = self.typed_text(operand).tokens;
                    arguments.push(quote!(#name.#as_units()));
                    quote!(let #name = #value;)
                }
                // What lies in a cell is copied out.
                ExprKind::Load(_) if self.emitter.shared && matches!(operand.ty, Type::String(_)) => {
                    let value = self.expr(operand).tokens;
                    arguments.push(quote!(#name.#as_units()));
                    quote!(let #name = #value;)
                }
                _ => {
                    let value = print(operand);
                    arguments.push(quote!(#name));
                    quote!(let #name = #value;)
                }
            });
        }
        let head = if typed { typed_head(expr.ty) } else { head(expr.ty) };
        let build = quote!(#head::build(|out| text::#function(#(#arguments,)* out)));
        if before.is_empty() {
            return Code::postfix(build);
        }
        Code::new(quote!({ #(#before)* #build }), Level::Block)
    }
}
