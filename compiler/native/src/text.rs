//! Strings: pointers to a length and the units after it. What makes a new string writes it to
//! the frame, so no result overlaps an operand.

use crate::address::Address;
use crate::function::Function;
use crate::runtime_call::by_pointer;
use cranelift_codegen::ir as clif;
use staunch_ir::{Chars, Const, Expr, ExprKind, Repr, StringType, TextOp, Type};

/// Up to this size a constant is kept as it is in memory, with the zeros after it.
const WHOLE: u32 = 258;

/// A string that can be read, and the type of the storage it is in.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Text {
    pub(crate) address: Address,
    ty: StringType,
}

impl Function<'_, '_> {
    pub(crate) fn text(&mut self, expr: &Expr) -> Text {
        match &expr.kind {
            ExprKind::Text(text) => self.text_constant(text),
            ExprKind::Load(place) if place.is_followed() => {
                let ty = string_type(place.ty);
                let reached = self.reached(place).expect("a string behind a reference");
                Text { address: self.load_reached_text(reached, ty), ty }
            }
            ExprKind::Load(place) => Text { address: self.address(place), ty: string_type(place.ty) },
            ExprKind::ApplyText(op, operands) => self.text_operation(*op, operands, expr.ty),
            ExprKind::Convert(_, operand) => self.text_cut(operand, expr.ty),
            ExprKind::Const(_) | ExprKind::AddressOf(_) | ExprKind::Apply(..) | ExprKind::Aggregate(_) => {
                unreachable!("verified IR: an expression of a string type")
            }
        }
    }

    /// A string for reading, where only its value counts.
    pub(crate) fn text_pointer(&mut self, expr: &Expr) -> clif::Value {
        let text = self.text(expr);
        self.pointer(text.address)
    }

    fn text_constant(&mut self, text: &Chars) -> Text {
        let capacity = u16::try_from(text.len()).expect("verified IR: a string fits its type");
        let ty = StringType { wide: text.is_wide(), capacity };
        let mut data = vec![0; staunch_ir::layout::usize_of(ty.size().into())];
        text.write(&mut data);
        Text { address: self.data(data), ty }
    }

    fn text_operation(&mut self, op: TextOp, operands: &[Expr], ty: Type) -> Text {
        let mut arguments = self.text_arguments(op, operands);
        let shape = self.module.layout.shape(ty);
        let ty = string_type(ty);
        let address = self.temporary(shape);
        let out = self.pointer(address);
        let limit = self.integer(clif::types::I16, i128::from(ty.capacity));
        arguments.push(by_pointer(out));
        arguments.push(self.by_repr(Repr::U16, limit));
        self.call_runtime(&symbol(op, operands), &arguments, None);
        Text { address, ty }
    }

    /// A string function with an elementary result.
    pub(crate) fn text_scalar(&mut self, op: TextOp, operands: &[Expr]) -> clif::Value {
        let arguments = self.text_arguments(op, operands);
        let repr = op.result().expect("verified IR: a text operation with an elementary result");
        let result = self.c_param(repr);
        let value = self.call_runtime(&symbol(op, operands), &arguments, Some(result));
        value.expect("a function with a result")
    }

    fn text_arguments(&mut self, op: TextOp, operands: &[Expr]) -> Vec<(clif::AbiParam, clif::Value)> {
        let argument = |(repr, operand): (&Option<Repr>, &Expr)| match repr {
            Some(repr) => {
                let value = self.scalar(operand);
                self.by_repr(*repr, value)
            }
            None => by_pointer(self.text_pointer(operand)),
        };
        op.operands().iter().zip(operands).map(argument).collect()
    }

    /// A conversion between capacities: only to a smaller one is there something to do.
    fn text_cut(&mut self, operand: &Expr, ty: Type) -> Text {
        let text = self.text(operand);
        let shape = self.module.layout.shape(ty);
        let ty = string_type(ty);
        if text.ty.capacity <= ty.capacity {
            return text;
        }
        let address = self.temporary(shape);
        let from = self.pointer(text.address);
        self.copy_text(from, address, ty);
        Text { address, ty }
    }

    pub(crate) fn assign_text(&mut self, value: &Expr, target: Address) {
        let ty = string_type(value.ty);
        if let ExprKind::Text(text) = &value.kind
            && ty.size() <= WHOLE
        {
            return self.store_const(value.ty, &Const::Text(text.clone()), target);
        }
        let text = self.text(value);
        if text.ty == ty {
            return self.copy(text.address, target, value.ty);
        }
        let from = self.pointer(text.address);
        self.copy_text(from, target, ty);
    }

    /// Copies a string out of storage of any capacity.
    pub(crate) fn copy_text(&mut self, from: clif::Value, to: Address, ty: StringType) {
        let out = self.pointer(to);
        let limit = self.integer(clif::types::I16, i128::from(ty.capacity));
        let arguments = [by_pointer(from), by_pointer(out), self.by_repr(Repr::U16, limit)];
        let symbol = if ty.wide { "staunch_wide_text_copy" } else { "staunch_text_copy" };
        self.call_runtime(symbol, &arguments, None);
    }
}

fn symbol(op: TextOp, operands: &[Expr]) -> String {
    let wide = if op.is_wide(operands) { "wide_" } else { "" };
    format!("staunch_{wide}text_{}", op.function())
}

fn string_type(ty: Type) -> StringType {
    ty.string_type().expect("verified IR: an expression of a string type")
}
