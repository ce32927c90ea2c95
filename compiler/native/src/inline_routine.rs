//! Calls of small routines have the callee's code in place of the call.
//!
//! ```text
//! v1 = iadd_imm v0, 16            v1 = iadd_imm v0, 16
//! call set_speed(v1, v2)          v3 = smax v2, 0
//!                                 store v3, v1
//! ```
//!
//! It applies to a routine whose code is a few instructions, but for what is away from the common path, and which keeps little in
//! a frame of its own. Its stores and their order stay as they are, and so does the code of a fault: the callee's return
//! becomes a jump to what follows the call. It may not assume that the callee is still called elsewhere: its own function stays,
//! and a linker drops it.

use crate::count::{Mark, Marks};
use crate::signature::ROUTINES;
use cranelift_codegen::inline::{Inline, InlineCommand};
use cranelift_codegen::ir::{
    Block, ExternalName, FuncRef, Function, GlobalValueData, Inst, Opcode, UserExternalName, UserExternalNameRef, Value,
};
use rustc_hash::FxHashMap;
use staunch_ir::RoutineId;
use std::borrow::Cow;

/// A routine of more instructions is called.
const SMALL: usize = 96;
/// So is one of more than these, with those away from the common path.
const MOST: usize = 256;
/// Bytes of frames that a function gets in addition to its own: [`stack`](staunch_ir::stack) allows for so many.
const MOST_OF_FRAMES: u32 = 128;
/// By so many instructions a function may grow in all cases, and beyond that by a part of its own.
const GROWTH: usize = 512;
const PART: usize = 2;

/// The code of the small routines so far.
#[derive(Default)]
pub(crate) struct SmallRoutines(FxHashMap<RoutineId, Small>);

struct Small {
    function: Function,
    /// The marks of the instructions that end these blocks.
    marks: Vec<(Block, Mark)>,
}

impl SmallRoutines {
    /// Notes a routine's code before the code generator changes it, if it is small.
    pub(crate) fn note(&mut self, id: RoutineId, function: &Function, marks: &Marks) {
        let is_small = function.dfg.num_insts() <= MOST && common(function) <= SMALL;
        if is_small && frame(function) <= MOST_OF_FRAMES && function.global_values.values().all(is_data) {
            let of_end = |it: &(Inst, Mark)| {
                let block = function.layout.inst_block(it.0)?;
                (function.layout.last_inst(block) == Some(it.0)).then_some((block, it.1))
            };
            let marks = marks.iter().filter_map(of_end).collect();
            self.0.insert(id, Small { function: function.clone(), marks });
        }
    }

    /// The marks of the routines whose code is in a function now.
    pub(crate) fn marks(&self, placed: &[(u32, RoutineId)], function: &Function) -> Marks {
        let mut marks = Marks::new();
        for (first, id) in placed {
            for (block, mark) in self.0.get(id).map_or(&[][..], |it| &it.marks) {
                // The inliner's blocks are the callee's, in their order.
                let block = Block::from_u32(first + block.as_u32());
                marks.extend(function.layout.last_inst(block).map(|it| (it, *mark)));
            }
        }
        marks
    }

    /// What puts them in place of their calls in a function, which then names what they name.
    pub(crate) fn inliner(&self, caller: &mut Function) -> Inliner<'_> {
        let callees: Vec<_> = caller.dfg.ext_funcs.keys().filter_map(|it| self.0.get(&called(caller, it)?)).collect();
        for name in callees.into_iter().flat_map(|it| data(&it.function)) {
            caller.declare_imported_user_function(name.clone());
        }
        let left = GROWTH + caller.dfg.num_insts() / PART;
        Inliner { small: &self.0, left, left_of_frames: MOST_OF_FRAMES, placed: Vec::new() }
    }
}

pub(crate) struct Inliner<'a> {
    small: &'a FxHashMap<RoutineId, Small>,
    /// By so many instructions the caller may still grow.
    left: usize,
    left_of_frames: u32,
    /// The routines whose code is in place of a call, each with the number of the block that its first one is now.
    pub(crate) placed: Vec<(u32, RoutineId)>,
}

impl Inline for Inliner<'_> {
    fn inline(&mut self, caller: &Function, _: Inst, _: Opcode, callee: FuncRef, _: &[Value]) -> InlineCommand<'_> {
        let id = called(caller, callee);
        let found = id.and_then(|id| self.small.get(&id)).map(|it| &it.function);
        let rest = found.and_then(|it| self.left.checked_sub(it.dfg.num_insts()));
        let rest_of_frames = found.and_then(|it| self.left_of_frames.checked_sub(frame(it)));
        match (found, rest, rest_of_frames) {
            (Some(function), Some(rest), Some(rest_of_frames)) => {
                (self.left, self.left_of_frames) = (rest, rest_of_frames);
                let first = u32::try_from(caller.dfg.num_blocks()).expect("blocks have numbers");
                self.placed.extend(id.map(|id| (first, id)));
                InlineCommand::Inline { callee: renamed(function, caller), visit_callee: false }
            }
            _ => InlineCommand::KeepCall,
        }
    }
}

/// The instructions on the common path.
fn common(function: &Function) -> usize {
    let blocks = function.layout.blocks().filter(|it| !function.layout.is_cold(*it));
    blocks.map(|it| function.layout.block_insts(it).count()).sum()
}

/// The bytes of a function's variables in its frame.
fn frame(function: &Function) -> u32 {
    let sizes = function.sized_stack_slots.values().map(|it| it.size.next_multiple_of(8));
    sizes.fold(0, u32::saturating_add)
}

fn name_of(of: &GlobalValueData) -> Option<UserExternalNameRef> {
    match of {
        GlobalValueData::Symbol { name: ExternalName::User(name), .. } => Some(*name),
        GlobalValueData::Symbol { .. }
        | GlobalValueData::VMContext
        | GlobalValueData::Load { .. }
        | GlobalValueData::IAddImm { .. }
        | GlobalValueData::DynScaleTargetConst { .. } => None,
    }
}

fn is_data(it: &GlobalValueData) -> bool {
    name_of(it).is_some()
}

/// The names of the data that a function reads.
fn data(of: &Function) -> impl Iterator<Item = &UserExternalName> {
    of.global_values.values().filter_map(name_of).map(|it| &of.params.user_named_funcs()[it])
}

/// A routine whose data have the names of its caller: the inliner leaves them as they are.
fn renamed<'a>(function: &'a Function, caller: &Function) -> Cow<'a, Function> {
    if function.global_values.is_empty() {
        return Cow::Borrowed(function);
    }
    let mut renamed = function.clone();
    for value in renamed.global_values.values_mut() {
        let GlobalValueData::Symbol { name: ExternalName::User(name), .. } = value else { continue };
        let wanted = &function.params.user_named_funcs()[*name];
        let of_caller = caller.params.user_named_funcs().iter().find(|(_, it)| *it == wanted);
        *name = of_caller.expect("the caller names what its callees name").0;
    }
    Cow::Owned(renamed)
}

/// The routine that a function calls.
fn called(caller: &Function, callee: FuncRef) -> Option<RoutineId> {
    match caller.dfg.ext_funcs[callee].name {
        ExternalName::User(name) => match caller.params.user_named_funcs()[name] {
            UserExternalName { namespace: ROUTINES, index } => Some(RoutineId(index)),
            UserExternalName { .. } => None,
        },
        ExternalName::TestCase(_) | ExternalName::LibCall(_) | ExternalName::KnownSymbol(_) => None,
    }
}
