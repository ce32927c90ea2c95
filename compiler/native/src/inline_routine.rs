//! Calls of small routines have the callee's code in place of the call.
//!
//! ```text
//! v1 = iadd_imm v0, 16            v1 = iadd_imm v0, 16
//! call set_speed(v1, v2)          v3 = smax v2, 0
//!                                 store v3, v1
//! ```
//!
//! It applies to a routine whose code is a few instructions and which keeps nothing in a frame of its own and names no
//! data. What it stores, and
//! in which order, stays as it is, and so does the code of a fault: the callee's return becomes a jump to what follows the
//! call. It may not assume that the callee is still called elsewhere: its own function stays, and a linker drops it.

use cranelift_codegen::inline::{Inline, InlineCommand};
use cranelift_codegen::ir::{ExternalName, FuncRef, Function, Inst, Opcode, Value};
use cranelift_module::FuncId;
use std::borrow::Cow;
use std::collections::HashMap;

/// A routine of more instructions is called.
const SMALL: usize = 96;
/// By so many instructions a function may grow in all cases, and beyond that by a part of its own.
const GROWTH: usize = 512;
const PART: usize = 2;

/// The code of the small routines so far.
#[derive(Default)]
pub(crate) struct SmallRoutines(HashMap<FuncId, Function>);

impl SmallRoutines {
    /// Notes a routine's code before the code generator changes it, if it is small.
    pub(crate) fn note(&mut self, id: FuncId, function: &Function) {
        let needs_nothing = function.sized_stack_slots.is_empty() && function.global_values.is_empty();
        if function.dfg.num_insts() <= SMALL && needs_nothing {
            self.0.insert(id, function.clone());
        }
    }

    /// What puts them in place of their calls in a function of that size.
    pub(crate) fn inliner(&self, caller_size: usize) -> Inliner<'_> {
        Inliner { small: &self.0, left: GROWTH + caller_size / PART }
    }
}

pub(crate) struct Inliner<'a> {
    small: &'a HashMap<FuncId, Function>,
    /// By so many instructions the caller may still grow.
    left: usize,
}

impl Inline for Inliner<'_> {
    fn inline(&mut self, caller: &Function, _: Inst, _: Opcode, callee: FuncRef, _: &[Value]) -> InlineCommand<'_> {
        let found = called(caller, callee).and_then(|id| self.small.get(&id));
        let rest = found.and_then(|it| self.left.checked_sub(it.dfg.num_insts()));
        match (found, rest) {
            (Some(function), Some(rest)) => {
                self.left = rest;
                InlineCommand::Inline { callee: Cow::Borrowed(function), visit_callee: false }
            }
            _ => InlineCommand::KeepCall,
        }
    }
}

fn called(caller: &Function, callee: FuncRef) -> Option<FuncId> {
    match caller.dfg.ext_funcs[callee].name {
        ExternalName::User(name) => Some(FuncId::from_u32(caller.params.user_named_funcs()[name].index)),
        ExternalName::TestCase(_) | ExternalName::LibCall(_) | ExternalName::KnownSymbol(_) => None,
    }
}
