//! How values pass between functions: those of POUs, of the runtime, and the entry points.
//!
//! A POU's function takes the context and the globals if it uses them, its instance, its
//! parameters in order (elementary values by value, all else and references as pointers), and a
//! pointer for a result that is not elementary. It returns a fault's code (0 for none) if it may
//! fault, and then an elementary result.

use crate::facts::Facts;
use cranelift_codegen::ir::{AbiParam, Signature, Type as Clif, types};
use staunch_ir::{Lane, Mode, Pou, Program, Type};
use target_lexicon::{Architecture, Triple};

/// All targets are 64-bit.
pub(crate) const POINTER: Clif = types::I64;
/// A fault's code.
pub(crate) const CODE: Clif = types::I64;

/// The type of a lane's values. A BOOL is 0 or 1.
pub(crate) fn clif_type(lane: Lane) -> Clif {
    match lane {
        Lane::Bool | Lane::I8 | Lane::U8 => types::I8,
        Lane::I16 | Lane::U16 => types::I16,
        Lane::I32 | Lane::U32 => types::I32,
        Lane::I64 | Lane::U64 => types::I64,
        Lane::F32 => types::F32,
        Lane::F64 => types::F64,
    }
}

/// Fills the signature of a POU's function.
pub(crate) fn of_pou(program: &Program, pou: &Pou, facts: &Facts, is_prescan: bool, signature: &mut Signature) {
    let pointers = [facts.uses_context, facts.uses_globals, pou.state.is_some()];
    for _ in pointers.into_iter().filter(|needed| *needed) {
        signature.params.push(AbiParam::new(POINTER));
    }
    if facts.may_fault {
        signature.returns.push(AbiParam::new(CODE));
    }
    // A prescan has none of the parameters, and no result.
    if is_prescan {
        return;
    }
    for param in &pou.params {
        signature.params.push(AbiParam::new(param_type(program, param.ty, param.mode)));
    }
    match result_type(pou).map(|ty| program.lane(ty)) {
        Some(Some(lane)) => signature.returns.push(AbiParam::new(clif_type(lane))),
        Some(None) => signature.params.push(AbiParam::new(POINTER)),
        None => {}
    }
}

pub(crate) fn param_type(program: &Program, ty: Type, mode: Mode) -> Clif {
    match (mode, program.lane(ty)) {
        (Mode::Value(_), Some(lane)) => clif_type(lane),
        (Mode::Value(_), None) | (Mode::Reference, _) => POINTER,
    }
}

/// The type of a FUNCTION's result.
pub(crate) fn result_type(pou: &Pou) -> Option<Type> {
    pou.result.map(|id| pou.locals[id.index()].ty)
}

/// How a C function of the target takes and returns a lane: small integers are extended by who
/// passes them, and RISC-V extends the sign of every 32-bit integer, also of unsigned ones.
pub(crate) fn c_value(triple: &Triple, lane: Lane) -> AbiParam {
    let value = AbiParam::new(clif_type(lane));
    let is_riscv = matches!(triple.architecture, Architecture::Riscv64(_));
    match lane {
        Lane::Bool | Lane::U8 | Lane::U16 => value.uext(),
        Lane::I8 | Lane::I16 => value.sext(),
        Lane::I32 | Lane::U32 if is_riscv => value.sext(),
        Lane::I32 | Lane::U32 | Lane::I64 | Lane::U64 | Lane::F32 | Lane::F64 => value,
    }
}
