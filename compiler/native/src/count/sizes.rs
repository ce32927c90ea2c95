//! The sizes that calls are given as constants: how many bytes are copied, or how long a string may become.

use super::mark::{Mark, Marks};
use cranelift_codegen::ir::{ExternalName, Function, Inst, InstructionData, LibCall, Opcode, Value};

/// The marks of all calls that have one: of the C library's copies the last argument, and of others a last argument that is
/// constant.
pub(crate) fn sizes(function: &Function) -> Marks {
    let instructions = function.layout.blocks().flat_map(|it| function.layout.block_insts(it));
    instructions.filter_map(|it| Some((it, Mark::Size(size(function, it)?)))).collect()
}

fn size(function: &Function, inst: Inst) -> Option<u64> {
    let InstructionData::Call { opcode: Opcode::Call, func_ref, .. } = function.dfg.insts[inst] else { return None };
    match function.dfg.ext_funcs[func_ref].name {
        ExternalName::LibCall(LibCall::Memcpy | LibCall::Memmove | LibCall::Memset) | ExternalName::User(_) => {
            constant(function, *function.dfg.inst_args(inst).last()?)
        }
        ExternalName::LibCall(_) | ExternalName::TestCase(_) | ExternalName::KnownSymbol(_) => None,
    }
}

fn constant(function: &Function, value: Value) -> Option<u64> {
    let inst = function.dfg.value_def(function.dfg.resolve_aliases(value)).inst()?;
    match function.dfg.insts[inst] {
        InstructionData::UnaryImm { opcode: Opcode::Iconst, imm } => u64::try_from(imm.bits()).ok(),
        InstructionData::Unary { opcode: Opcode::Uextend, arg } => constant(function, arg),
        _ => None,
    }
}
