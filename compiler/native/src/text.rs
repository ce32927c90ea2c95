//! Strings: pointers to a length and the bytes after it. What makes a new string writes it to
//! the frame, so no result overlaps an operand.

use crate::address::Address;
use crate::function::Function;
use crate::runtime_call::by_pointer;
use cranelift_codegen::ir as clif;
use staunch_ir::{Const, Expr, ExprKind, Repr, TextOp, Type};

/// Up to this capacity a constant is kept as it is in memory, with the zeros after it.
const WHOLE: u16 = 256;

/// A string that can be read, and the capacity of the storage it is in.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Text {
    pub(crate) address: Address,
    capacity: u16,
}

impl Function<'_, '_> {
    pub(crate) fn text(&mut self, expr: &Expr) -> Text {
        match &expr.kind {
            ExprKind::Text(bytes) => self.text_constant(bytes),
            ExprKind::Load(place) if place.is_followed() => {
                let capacity = capacity(place.ty);
                let reached = self.reached(place).expect("a string behind a reference");
                Text { address: self.load_reached_text(reached, capacity), capacity }
            }
            ExprKind::Load(place) => Text { address: self.address(place), capacity: capacity(place.ty) },
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

    fn text_constant(&mut self, bytes: &[u8]) -> Text {
        let capacity = u16::try_from(bytes.len()).expect("verified IR: a string fits its type");
        let mut data = vec![0; self.size_of_text(capacity)];
        let value = Const::Text(bytes.to_vec());
        let module = &self.module;
        module.layout.write_const(module.program, Type::String(capacity), &value, &mut data);
        Text { address: self.data(data), capacity }
    }

    fn size_of_text(&self, capacity: u16) -> usize {
        staunch_ir::layout::usize_of(self.module.layout.size(Type::String(capacity)))
    }

    fn text_operation(&mut self, op: TextOp, operands: &[Expr], ty: Type) -> Text {
        let mut arguments = self.text_arguments(op, operands);
        let capacity = capacity(ty);
        let shape = self.module.layout.shape(ty);
        let address = self.temporary(shape);
        let out = self.pointer(address);
        let limit = self.integer(clif::types::I16, i128::from(capacity));
        arguments.push(by_pointer(out));
        arguments.push(self.by_repr(Repr::U16, limit));
        self.call_runtime(&symbol(op), &arguments, None);
        Text { address, capacity }
    }

    /// A string function with an elementary result.
    pub(crate) fn text_scalar(&mut self, op: TextOp, operands: &[Expr]) -> clif::Value {
        let arguments = self.text_arguments(op, operands);
        let repr = op.result().expect("verified IR: a text operation with an elementary result");
        let result = self.c_param(repr);
        let value = self.call_runtime(&symbol(op), &arguments, Some(result));
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
        let capacity = capacity(ty);
        if text.capacity <= capacity {
            return text;
        }
        let shape = self.module.layout.shape(ty);
        let address = self.temporary(shape);
        let from = self.pointer(text.address);
        self.copy_text(from, address, capacity);
        Text { address, capacity }
    }

    pub(crate) fn assign_text(&mut self, value: &Expr, target: Address) {
        let ty = value.ty;
        if let ExprKind::Text(bytes) = &value.kind
            && capacity(ty) <= WHOLE
        {
            return self.store_const(ty, &Const::Text(bytes.clone()), target);
        }
        let text = self.text(value);
        if text.capacity == capacity(ty) {
            return self.copy(text.address, target, ty);
        }
        let from = self.pointer(text.address);
        self.copy_text(from, target, capacity(ty));
    }

    /// Copies a string out of storage of any capacity.
    pub(crate) fn copy_text(&mut self, from: clif::Value, to: Address, capacity: u16) {
        let out = self.pointer(to);
        let limit = self.integer(clif::types::I16, i128::from(capacity));
        let arguments = [by_pointer(from), by_pointer(out), self.by_repr(Repr::U16, limit)];
        self.call_runtime("staunch_text_copy", &arguments, None);
    }
}

fn symbol(op: TextOp) -> String {
    format!("staunch_text_{}", op.function())
}

fn capacity(ty: Type) -> u16 {
    match ty {
        Type::String(capacity) => capacity,
        Type::Elementary(_)
        | Type::Reference(_)
        | Type::Subrange(..)
        | Type::Enum(_)
        | Type::Array(_)
        | Type::Struct(_)
        | Type::Block(_) => {
            unreachable!("verified IR: an expression of a string type")
        }
    }
}
