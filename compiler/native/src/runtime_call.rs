//! Calls of the runtime's C symbols.

use crate::function::Function;
use crate::operands::Operands;
use crate::signature::{POINTER, c_value};
use cranelift_codegen::ir::{self as clif, AbiParam, InstBuilder, types};
use staunch_ir::layout::Shape;
use staunch_ir::{Op, Repr};

impl Function<'_, '_> {
    /// Calls a symbol of the runtime; gives its result if it has one.
    pub(crate) fn call_runtime(
        &mut self,
        symbol: &str,
        arguments: &[(AbiParam, clif::Value)],
        result: Option<AbiParam>,
    ) -> Option<clif::Value> {
        let mut signature = self.module.output.make_signature();
        signature.params.extend(arguments.iter().map(|(param, _)| *param));
        signature.returns.extend(result);
        let id = self.module.import(symbol, &signature);
        let function = self.function_ref(id);
        let values: Vec<_> = arguments.iter().map(|(_, value)| *value).collect();
        let call = self.ins().call(function, &values);
        self.builder.inst_results(call).first().copied()
    }

    /// An argument by value. A narrow number is extended here, and not by the call, so that a constant is one of 32 bits.
    pub(crate) fn by_repr(&mut self, repr: Repr, value: clif::Value) -> (AbiParam, clif::Value) {
        match repr {
            Repr::Bool | Repr::U8 | Repr::U16 => (self.c_param(Repr::U32), self.ins().uextend(types::I32, value)),
            Repr::I8 | Repr::I16 => (self.c_param(Repr::I32), self.ins().sextend(types::I32, value)),
            Repr::I32 | Repr::U32 | Repr::I64 | Repr::U64 | Repr::F32 | Repr::F64 => (self.c_param(repr), value),
        }
    }

    pub(crate) fn c_param(&self, repr: Repr) -> AbiParam {
        c_value(self.module.output.isa().triple(), repr)
    }
}

/// An argument that is a pointer.
pub(crate) fn by_pointer(value: clif::Value) -> (AbiParam, clif::Value) {
    (AbiParam::new(POINTER), value)
}

/// An operation by its symbol.
pub(crate) fn operation(f: &mut Function<'_, '_>, op: Op, operands: &Operands) -> clif::Value {
    let repr = operands.repr;
    let symbol = format!("staunch_{}_{}", op.function(), repr.rust_name());
    let reprs = op.operands().iter().map(|fixed| fixed.unwrap_or(repr));
    let mut arguments: Vec<_> = reprs.zip(&operands.values).map(|(repr, value)| f.by_repr(repr, *value)).collect();
    let result = op.result().unwrap_or(repr);
    if !op.can_fault() {
        let result = f.c_param(result);
        let value = f.call_runtime(&symbol, &arguments, Some(result));
        return value.expect("a total operation returns its result");
    }
    let size = u64::from(result.size());
    let out = f.temporary(Shape { size, align: size });
    let pointer = f.pointer(out);
    arguments.push(by_pointer(pointer));
    let kind = f.call_runtime(&symbol, &arguments, Some(AbiParam::new(types::I8).uext()));
    f.fault_of_kind(kind.expect("an operation that may fault returns its code"), operands.at);
    f.load_as(crate::signature::clif_type(result), out)
}
