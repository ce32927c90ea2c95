//! Expressions of elementary and enumeration types. Each arm is its own function: deep trees
//! recurse here, and small frames let them.

use crate::function::Function;
use crate::operands::Operands;
use crate::place::PlaceValue;
use crate::{inline_conversion, inline_op, runtime_call};
use cranelift_codegen::ir::{self as clif, InstBuilder};
use staunch_ir::{Conversion, Expr, ExprKind, Location, Op, Place, Repr};

impl Function<'_, '_> {
    pub(crate) fn scalar(&mut self, expr: &Expr) -> clif::Value {
        match &expr.kind {
            ExprKind::Const(value) => self.constant(*value),
            ExprKind::Load(place) => match self.counter(expr) {
                Some(counter) => self.narrowed(self.repr_of(expr), counter),
                None => self.load_place(place),
            },
            ExprKind::AddressOf(place) => self.reference_to(place),
            ExprKind::Apply(op, operands) => self.apply(*op, operands, expr.at),
            ExprKind::ApplyText(op, operands) => self.text_scalar(*op, operands),
            ExprKind::Convert(how, operand) => self.convert(*how, operand, expr),
            ExprKind::Text(_) | ExprKind::Aggregate(_) => {
                unreachable!("verified IR: an expression of an elementary type")
            }
        }
    }

    pub(crate) fn load_place(&mut self, place: &Place) -> clif::Value {
        if let Some(reached) = self.reached(place) {
            return self.load_reached(reached);
        }
        match self.place_value(place) {
            PlaceValue::Variable(variable) => self.builder.use_var(variable),
            PlaceValue::Memory(address) => self.load(place.ty, address),
        }
    }

    fn apply(&mut self, op: Op, operands: &[Expr], at: Location) -> clif::Value {
        if op == Op::Advance && self.stays_within_its_half(operands) {
            let [reference, distance] = [&operands[0], &operands[1]].map(|it| self.scalar(it));
            return self.ins().iadd(reference, distance);
        }
        let repr = inline_op::repr(self.module.program, op, operands);
        let values = operands.iter().map(|operand| self.scalar(operand)).collect();
        let constants = operands.iter().map(Expr::as_const).collect();
        let are_positive = matches!(op, Op::Div | Op::Mod)
            && self.known(&|known| operands.iter().all(|it| known.range(it).is_some_and(|it| it.0 >= 0)));
        let operands = Operands { repr, values, constants, are_positive, at };
        match inline_op::find(op) {
            Some(emit) => emit(self, &operands),
            None => runtime_call::operation(self, op, &operands),
        }
    }

    fn convert(&mut self, how: Conversion, operand: &Expr, expr: &Expr) -> clif::Value {
        let (from, to) = (self.repr_of(operand), self.repr_of(expr));
        // A counter in a register is the number at 64 bits.
        if how == Conversion::Value
            && from != Repr::U64
            && to != Repr::Bool
            && let Some(counter) = self.counter(operand)
        {
            return inline_conversion::from_wide(self, counter, from, to);
        }
        let value = self.scalar(operand);
        match how {
            Conversion::Same => value,
            Conversion::Value => inline_conversion::convert(self, value, from, to),
            Conversion::Bits => inline_conversion::same_bits(self, value, to),
            Conversion::Truncate => inline_conversion::truncate(self, value, from, to),
        }
    }

    fn repr_of(&self, expr: &Expr) -> Repr {
        self.module.program.repr(expr.ty).expect("verified IR: an expression of an elementary type")
    }
}
