//! Indices, at 64 bits.

use crate::function::Function;
use cranelift_codegen::ir::{self as clif, InstBuilder, InstructionData, Opcode};
use staunch_ir::loops::Known;
use staunch_ir::{Conversion, Expr, ExprKind, LocalId, Op};

impl Function<'_, '_> {
    /// The value of an index. A sum that does not leave its narrower type is made at 64 bits at once, of the counters as they
    /// are in registers.
    pub(crate) fn index(&mut self, expr: &Expr) -> clif::Value {
        match self.exact_index(expr) {
            Some(value) => value,
            None => self.scalar(expr),
        }
    }

    /// The exact value of an expression, if it is made of counters and constants.
    fn exact_index(&mut self, expr: &Expr) -> Option<clif::Value> {
        match &expr.kind {
            ExprKind::Const(value) => {
                let value = value.as_integer()?;
                Some(self.integer(clif::types::I64, value))
            }
            ExprKind::Load(_) => self.counter(expr),
            ExprKind::Convert(Conversion::Value, operand) if self.keeps_value(operand, expr) => {
                self.exact_index(operand)
            }
            ExprKind::Apply(op @ (Op::Add | Op::Sub), operands) if self.is_exact(expr) => {
                let (a, b) = (self.exact_index(&operands[0])?, self.exact_index(&operands[1])?);
                Some(match op {
                    Op::Add => self.ins().iadd(a, b),
                    _ => self.ins().isub(a, b),
                })
            }
            ExprKind::Convert(..)
            | ExprKind::Apply(..)
            | ExprKind::Text(_)
            | ExprKind::AddressOf(_)
            | ExprKind::ApplyText(..)
            | ExprKind::Aggregate(_) => None,
        }
    }

    /// Whether the conversion of an integer has its value, whatever that is.
    pub(crate) fn keeps_value(&self, operand: &Expr, expr: &Expr) -> bool {
        let range = |it: &Expr| self.module.program.repr(it.ty).and_then(|it| it.range());
        range(operand).zip(range(expr)).is_some_and(|(from, to)| to.0 <= from.0 && from.1 <= to.1)
    }

    fn is_exact(&self, expr: &Expr) -> bool {
        self.known(&|known| known.is_exact(expr))
    }

    /// What is known of counters and locals here.
    pub(crate) fn known<T>(&self, question: &dyn Fn(Known<'_>) -> T) -> T {
        let checked = |id: LocalId| self.checked[id.index()];
        let seen = self.seen.ranges(self.builder.current_block());
        question(Known { program: self.module.program, loops: &self.counters, checked: &checked, seen })
    }

    /// An index that is within its bounds as a value plus a constant, which is at most so many, or as a constant
    /// alone.
    pub(crate) fn sum(&self, index: clif::Value, most: u64) -> (Option<clif::Value>, i64) {
        let (mut start, mut further) = (index, 0_i64);
        loop {
            let (next, constant) = match self.instruction(start) {
                Some(InstructionData::UnaryImm { opcode: Opcode::Iconst, imm }) => (None, imm.bits()),
                Some(InstructionData::Binary { opcode: Opcode::Iadd, args: [next, constant] }) => {
                    match self.instruction(*constant) {
                        Some(InstructionData::UnaryImm { opcode: Opcode::Iconst, imm }) => (Some(*next), imm.bits()),
                        _ => return (Some(start), further),
                    }
                }
                _ => return (Some(start), further),
            };
            let sum = further.checked_add(constant);
            match (next, sum) {
                (None, Some(sum)) => return (None, sum),
                (Some(next), Some(sum)) if u64::try_from(sum).is_ok_and(|it| it <= most) => {
                    (start, further) = (next, sum)
                }
                _ => return (Some(start), further),
            }
        }
    }

    /// What makes a value.
    pub(crate) fn instruction(&self, value: clif::Value) -> Option<&InstructionData> {
        let dfg = &self.builder.func.dfg;
        Some(&dfg.insts[dfg.value_def(value).inst()?])
    }
}
