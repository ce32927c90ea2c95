//! How values pass between functions: those of routines, of the runtime, and the entry points.
//!
//! A routine's function takes the context and the globals if it uses them, its instance, its
//! parameters in order (elementary values by value, all else and references as pointers), and a
//! pointer for a result that is not elementary. It returns a fault's code (0 for none) if it may
//! fault, and then an elementary result.

use cranelift_codegen::ir::{AbiParam, Signature, Type as Clif, types};
use staunch_ir::effects::Effects;
use staunch_ir::{Mode, Program, Repr, Routine, Type};
use target_lexicon::{Architecture, Triple};

/// In names of the code generator's: what follows is the number of a routine. A module's own functions are 0, its data 1.
pub(crate) const ROUTINES: u32 = 2;

/// All targets are 64-bit.
pub(crate) const POINTER: Clif = types::I64;
/// What entry points' symbols begin with, where nothing else is asked for.
pub(crate) const PREFIX: &str = "staunch";
/// The symbol of the scan, after the prefix.
pub(crate) const SCAN: &str = "scan";
/// A fault's code.
pub(crate) const CODE: Clif = types::I64;

/// The type of a repr's values. A BOOL is 0 or 1.
pub(crate) fn clif_type(repr: Repr) -> Clif {
    match repr {
        Repr::Bool | Repr::I8 | Repr::U8 => types::I8,
        Repr::I16 | Repr::U16 => types::I16,
        Repr::I32 | Repr::U32 => types::I32,
        Repr::I64 | Repr::U64 => types::I64,
        Repr::F32 => types::F32,
        Repr::F64 => types::F64,
    }
}

/// Fills the signature of a routine's function.
pub(crate) fn of_routine(program: &Program, routine: &Routine, effects: &Effects, signature: &mut Signature) {
    let pointers = [effects.context, effects.uses_globals(), routine.state.is_some()];
    for _ in pointers.into_iter().filter(|needed| *needed) {
        signature.params.push(AbiParam::new(POINTER));
    }
    if effects.faults {
        signature.returns.push(AbiParam::new(CODE));
    }
    for param in &routine.params {
        signature.params.push(AbiParam::new(param_type(program, param.ty, param.mode)));
    }
    match result_type(routine).map(|ty| program.repr(ty)) {
        Some(Some(repr)) => signature.returns.push(AbiParam::new(clif_type(repr))),
        Some(None) => signature.params.push(AbiParam::new(POINTER)),
        None => {}
    }
}

/// Fills the signature of `staunch_scan`.
pub(crate) fn of_scan(signature: &mut Signature) {
    signature.params.extend([POINTER, POINTER, types::I32].map(AbiParam::new));
    signature.returns.push(AbiParam::new(CODE));
}

pub(crate) fn param_type(program: &Program, ty: Type, mode: Mode) -> Clif {
    match (mode, program.repr(ty)) {
        (Mode::Value(_), Some(repr)) => clif_type(repr),
        (Mode::Value(_), None) | (Mode::Reference, _) => POINTER,
    }
}

/// The type of a FUNCTION's result.
pub(crate) fn result_type(routine: &Routine) -> Option<Type> {
    routine.result.map(|id| routine.locals[id.index()].ty)
}

/// How a C function of the target takes and returns a repr: small integers are extended by who
/// passes them, and RISC-V extends the sign of every 32-bit integer, also of unsigned ones.
pub(crate) fn c_value(triple: &Triple, repr: Repr) -> AbiParam {
    let value = AbiParam::new(clif_type(repr));
    let is_riscv = matches!(triple.architecture, Architecture::Riscv64(_));
    match repr {
        Repr::Bool | Repr::U8 | Repr::U16 => value.uext(),
        Repr::I8 | Repr::I16 => value.sext(),
        Repr::I32 | Repr::U32 if is_riscv => value.sext(),
        Repr::I32 | Repr::U32 | Repr::I64 | Repr::U64 | Repr::F32 | Repr::F64 => value,
    }
}
