//! Expressions of elementary and enumeration types. Each arm is its own function: deep trees
//! recurse here, and small frames let them.

use crate::function::Function;
use crate::place::Site;
use crate::{inline_conversion, inline_op, shim};
use cranelift_codegen::ir as clif;
use staunch_ir::{Conversion, Expr, ExprKind, Lane, Location, Op, Place, Value};

/// The operands of an operation, evaluated.
#[derive(Debug)]
pub(crate) struct Operands {
    /// The lane that the operation's row calls `T`.
    pub(crate) lane: Lane,
    pub(crate) values: Vec<clif::Value>,
    /// Where an operand is constant, what it is.
    pub(crate) constants: Vec<Option<Value>>,
    pub(crate) at: Location,
}

impl Function<'_, '_> {
    pub(crate) fn scalar(&mut self, expr: &Expr) -> clif::Value {
        match &expr.kind {
            ExprKind::Const(value) => self.constant(*value),
            ExprKind::Load(place) => match self.counter(expr) {
                Some(counter) => self.narrowed(self.lane_of(expr), counter),
                None => self.load_place(place),
            },
            ExprKind::Apply(op, operands) => self.apply(*op, operands, expr.at),
            ExprKind::ApplyText(op, operands) => self.text_scalar(*op, operands),
            ExprKind::Convert(how, operand) => self.convert(*how, operand, expr),
            ExprKind::Text(_) | ExprKind::Aggregate(_) => {
                unreachable!("verified IR: an expression of an elementary type")
            }
        }
    }

    pub(crate) fn load_place(&mut self, place: &Place) -> clif::Value {
        match self.site(place) {
            Site::Variable(variable) => self.builder.use_var(variable),
            Site::Memory(address) => self.load(place.ty, address),
        }
    }

    fn apply(&mut self, op: Op, operands: &[Expr], at: Location) -> clif::Value {
        let lane = inline_op::lane(self.unit.program, op, operands);
        let values = operands.iter().map(|operand| self.scalar(operand)).collect();
        let constants = operands.iter().map(Expr::as_const).collect();
        let operands = Operands { lane, values, constants, at };
        match inline_op::find(op) {
            Some(emit) => emit(self, &operands),
            None => shim::operation(self, op, &operands),
        }
    }

    fn convert(&mut self, how: Conversion, operand: &Expr, expr: &Expr) -> clif::Value {
        if how == Conversion::Value
            && let Some(counter) = self.counter(operand)
            && self.lane_of(expr).is_integer()
            && self.lane_of(expr).size() == 8
        {
            return counter;
        }
        let value = self.scalar(operand);
        let (from, to) = (self.lane_of(operand), self.lane_of(expr));
        match how {
            Conversion::Same => value,
            Conversion::Value => inline_conversion::convert(self, value, from, to),
            Conversion::Truncate => inline_conversion::truncate(self, value, from, to),
        }
    }

    fn lane_of(&self, expr: &Expr) -> Lane {
        self.unit.program.lane(expr.ty).expect("verified IR: an expression of an elementary type")
    }
}
