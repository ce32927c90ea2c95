//! What is noted of a routine while its code is made.

use cranelift_codegen::ir::StackSlot;
use staunch_ir::{Location, RoutineId};

/// What is noted of a routine's function.
#[derive(Clone, Debug)]
pub(crate) struct Noted {
    pub(crate) routine: RoutineId,
    /// What instructions belong to: their places in the code generator's input are positions here.
    pub(crate) places: Vec<Place>,
    /// Where the pointer to the instance is.
    pub(crate) instance: Option<StackSlot>,
    /// Where the pointers to what is passed by reference are, for each parameter.
    pub(crate) params: Vec<Option<StackSlot>>,
    pub(crate) locals: Vec<StackSlot>,
    /// Where jumps store, which need an instruction that is theirs alone.
    pub(crate) jumps: Option<StackSlot>,
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct Place {
    pub(crate) at: Location,
    /// Whether a debugger may stop there.
    pub(crate) is_statement: bool,
}

impl Noted {
    pub(crate) fn new(routine: RoutineId) -> Self {
        Self { routine, places: Vec::new(), instance: None, params: Vec::new(), locals: Vec::new(), jumps: None }
    }
}
