//! What is known of each function when its code is made.

use super::noted::{Noted, Place};
use cranelift_codegen::ir::StackSlot;
use cranelift_codegen::isa::TargetIsa;
use cranelift_codegen::isa::unwind::UnwindInfo;
use cranelift_codegen::isa::unwind::systemv;
use cranelift_codegen::{CompiledCode, Context};
use cranelift_module::{DataId, FuncId};
use gimli::write::CommonInformationEntry;
use rustc_hash::FxHashSet;
use staunch_ir::{Location, RoutineId};

/// Of a whole program.
#[derive(Debug)]
pub(crate) struct Notes {
    /// The word that leads to the state.
    pub(crate) state: DataId,
    /// What the rules for all frames begin with.
    pub(crate) frames: Option<CommonInformationEntry>,
    /// What is noted of the function that is made next, if it is a routine's.
    pub(crate) noted: Option<Noted>,
    pub(crate) functions: Vec<Compiled>,
}

/// A function's code.
#[derive(Debug)]
pub(crate) struct Compiled {
    pub(crate) id: FuncId,
    /// Bytes of code.
    pub(crate) size: u32,
    pub(crate) unwind: Option<systemv::UnwindInfo>,
    pub(crate) routine: Option<CompiledRoutine>,
}

/// The code of a routine.
#[derive(Debug)]
pub(crate) struct CompiledRoutine {
    pub(crate) id: RoutineId,
    pub(crate) rows: Vec<Row>,
    pub(crate) homes: Homes,
}

/// From an instruction on.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Row {
    pub(crate) offset: u32,
    pub(crate) at: Location,
    pub(crate) is_statement: bool,
}

/// Where variables are, as distances from the frame pointer.
#[derive(Debug)]
pub(crate) struct Homes {
    pub(crate) instance: Option<i64>,
    pub(crate) params: Vec<Option<i64>>,
    pub(crate) locals: Vec<i64>,
}

impl Notes {
    pub(crate) fn new(state: DataId, isa: &dyn TargetIsa) -> Self {
        Self { state, frames: isa.create_systemv_cie(), noted: None, functions: Vec::new() }
    }

    /// Adds the function whose code is in `context`.
    pub(crate) fn add(&mut self, context: &Context, id: FuncId, isa: &dyn TargetIsa) {
        let noted = self.noted.take();
        let Some(code) = context.compiled_code() else { return };
        let unwind = match code.create_unwind_info(isa) {
            Ok(Some(UnwindInfo::SystemV(it))) => Some(it),
            Ok(_) | Err(_) => None,
        };
        let routine = noted.map(|it| CompiledRoutine {
            id: it.routine,
            rows: rows(code, &it.places),
            homes: Homes {
                instance: it.instance.map(|it| home(code, it)),
                params: it.params.iter().map(|it| it.map(|it| home(code, it))).collect(),
                locals: it.locals.iter().map(|it| home(code, *it)).collect(),
            },
        });
        self.functions.push(Compiled { id, size: code.buffer.total_size(), unwind, routine });
    }
}

fn home(code: &CompiledCode, slot: StackSlot) -> i64 {
    let layout = code.buffer.frame_layout().expect("a function with variables has a frame");
    i64::from(layout.stackslots[slot].offset) - i64::from(layout.frame_to_fp_offset)
}

/// Which place instructions belong to. A debugger stops where the code of a place begins, and not where it continues.
fn rows(code: &CompiledCode, places: &[Place]) -> Vec<Row> {
    let mut rows: Vec<Row> = Vec::new();
    let mut last = None;
    let mut begun = FxHashSet::default();
    // What is in front of all places sets up the frame.
    rows.extend(places.first().map(|it| Row { offset: 0, at: it.at, is_statement: true }));
    for range in code.buffer.get_srclocs_sorted() {
        let number = usize::try_from(range.loc.bits()).ok().filter(|_| !range.loc.is_default());
        let Some(place) = number.and_then(|it| places.get(it)) else { continue };
        if last == number {
            continue;
        }
        last = number;
        let is_statement = place.is_statement && begun.insert(number);
        let is_further = rows.last().is_some_and(|it| (it.at.file, it.at.line) == (place.at.file, place.at.line));
        if is_further && !is_statement {
            continue;
        }
        rows.push(Row { offset: range.start, at: place.at, is_statement });
    }
    rows
}
