//! The function of a routine: what it starts and ends with.

use crate::Error;
use crate::address::Address;
use crate::count::{Marks, Repeats};
use crate::debug::noted::Noted;
use crate::module::{ModuleEmitter, Workspace};
use crate::scan::{Begun, start_of_scan};
use crate::seen::Seen;
use crate::signature::{POINTER, ROUTINES, clif_type, result_type};
use cranelift_codegen::ir::{self as clif, InstBuilder, StackSlot, UserFuncName};
use cranelift_frontend::{FuncInstBuilder, FunctionBuilder, Variable};
use cranelift_module::{DataId, FuncId};
use rustc_hash::FxHashMap;
use staunch_ir::effects::Effects;
use staunch_ir::{Const, For, LocalId, Mode, Program, Routine, RoutineId, Statement, Type};
use std::collections::BTreeMap;

/// More variables than this make the construction of SSA form slow; the rest live in the frame.
const MAX_VARIABLES: usize = 1000;

/// Emits a function, statement by statement.
pub(crate) struct Function<'a, 'p> {
    pub(crate) module: &'a mut ModuleEmitter<'p>,
    pub(crate) builder: FunctionBuilder<'a>,
    pub(crate) routine: &'p Routine,
    pub(crate) start: Start,
    pub(crate) locals: Vec<LocalSlot>,
    /// The innermost loop is the last.
    pub(crate) loops: Vec<LoopFrame>,
    /// What is known of how often these loops are repeated, each with its copies; the innermost is the last.
    pub(crate) turning: Vec<Repeats>,
    /// The instructions that say it.
    pub(crate) marks: Marks,
    /// The statements before the one that is being emitted, in its block.
    pub(crate) before: &'p [Statement],
    /// The turns that the scan has left, while a loop runs that takes some.
    pub(crate) turns: Option<Variable>,
    /// Where the copies of a body that are being emitted leave their loop, after so many turns.
    pub(crate) exits: Vec<(i64, clif::Block)>,
    /// The block in which no variable of a class was written since all stores were seen.
    pub(crate) known_in: Option<clif::Block>,
    /// The checks of indices that hold here.
    pub(crate) seen: Seen,
    /// Operations of copies so far.
    pub(crate) copied: usize,
    /// Operations of unrolled loops so far.
    pub(crate) unrolled: usize,
    /// The references that the statements follow and that have been looked up.
    pub(crate) looked_up: Vec<LookedUp>,
    /// The address that was made last.
    pub(crate) made: Option<MadeAddress>,
    /// The local variable that the statement before has given it to.
    pub(crate) fresh: Option<(LocalId, MadeAddress)>,
    /// Operations of statements that are there twice for that, so far.
    pub(crate) doubled: usize,
    /// How many [`Finally`](staunch_ir::StatementKind::Finally) are around: what they store after a fault reads locals.
    pub(crate) endings: usize,
    /// The FOR loops among them whose counters are in registers.
    pub(crate) counters: Vec<&'p For>,
    /// One for each of `counters`: its value, extended to 64 bits.
    pub(crate) registers: Vec<Variable>,
    /// The locals whose values are always within their subranges.
    pub(crate) checked: Vec<bool>,
    /// Where RETURN flow.
    pub(crate) exit: clif::Block,
    pub(crate) faults: Faults,
    pub(crate) temporaries: Temporaries,
    /// Where code is made for debugging.
    pub(crate) noted: Option<Noted>,
    functions: FxHashMap<FuncId, clif::FuncRef>,
    routines: FxHashMap<RoutineId, clif::FuncRef>,
    data: FxHashMap<DataId, clif::GlobalValue>,
    result: Option<(LocalId, Type)>,
}

/// What a function is given, where it needs it.
#[derive(Debug, Default)]
pub(crate) struct Start {
    pub(crate) context: Option<clif::Value>,
    pub(crate) globals: Option<clif::Value>,
    pub(crate) instance: Option<clif::Value>,
    /// One for each parameter.
    pub(crate) params: Vec<clif::Value>,
    /// Where a result flow that is not elementary.
    pub(crate) result: Option<clif::Value>,
}

/// Where a local lives.
#[derive(Clone, Copy, Debug)]
pub(crate) enum LocalSlot {
    Variable(Variable),
    Slot(StackSlot),
}

/// A loop that is being emitted.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LoopFrame {
    /// Runs `continuing`.
    pub(crate) next: clif::Block,
    pub(crate) after: clif::Block,
    pub(crate) is_continued: bool,
    pub(crate) is_left: bool,
    /// Whether it takes no turns.
    pub(crate) few: Few,
    /// In a copy of its body: the turns that were had and not taken yet.
    pub(crate) taken: Option<i64>,
}

/// Whether a loop's `Turn` takes none.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Few {
    No,
    Yes,
    /// What it takes, 0 or 1.
    Taken(clif::Value),
}

impl LoopFrame {
    /// Of a loop that continues there, and has no end of a turn yet.
    pub(crate) fn to(after: clif::Block) -> Self {
        Self { next: after, after, is_continued: false, is_left: false, few: Few::No, taken: None }
    }
}

/// A reference that has been looked up for the statements that are being emitted.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LookedUp {
    pub(crate) pointer: LocalId,
    /// What it was looked up as.
    pub(crate) ty: Type,
    pub(crate) leads: Leads,
}

/// A reference to a variable, and where that is in the state.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MadeAddress {
    pub(crate) reference: clif::Value,
    pub(crate) offset: clif::Value,
    pub(crate) ty: Type,
}

/// Where a reference leads.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Leads {
    /// To this offset in the state.
    To(clif::Value),
    /// Not to where it is expected.
    Elsewhere,
}

/// The blocks that return faults, filled when the function is complete.
#[derive(Debug, Default)]
pub(crate) struct Faults {
    /// By code.
    pub(crate) known: BTreeMap<u64, clif::Block>,
    /// Each returns the code that it is given.
    pub(crate) passing: Vec<clif::Block>,
    /// How many give one to the last of them.
    pub(crate) passing_to_last: usize,
}

/// A part of the frame whose bytes are taken for a statement, one after the other, and again in the next.
#[derive(Debug, Default)]
pub(crate) struct Temporaries {
    pub(crate) slot: Option<StackSlot>,
    pub(crate) taken: u64,
    /// The most that a statement takes.
    pub(crate) most: u64,
}

pub(crate) fn emit(module: &mut ModuleEmitter<'_>, workspace: &mut Workspace, id: RoutineId) -> Result<(), Error> {
    let routine = module.program.routine(id);
    let context = &mut workspace.context;
    context.func.signature = module.signature(id);
    // Its own number in the listing; the one of its function follows.
    context.func.name = UserFuncName::user(ROUTINES, id.0);
    let builder = FunctionBuilder::new(&mut context.func, &mut workspace.builder);
    let mut effects = module.effects(id).clone();
    // A scan returns a code also where nothing can fault.
    effects.faults |= module.is_scanned(id);
    let mut open = Function::open(module, builder, id, &effects);
    let flow = open.block(&routine.body);
    let marks = open.close(flow, &effects);
    module.define_routine(context, id, marks)
}

impl<'a, 'p> Function<'a, 'p> {
    fn open(
        module: &'a mut ModuleEmitter<'p>,
        mut builder: FunctionBuilder<'a>,
        id: RoutineId,
        effects: &Effects,
    ) -> Self {
        let routine = module.program.routine(id);
        let entry = builder.create_block();
        builder.append_block_params_for_function_params(entry);
        builder.switch_to_block(entry);
        builder.seal_block(entry);
        let start = match module.is_scanned(id) {
            true => Start::of_scan(start_of_scan(module, &mut builder)),
            false => Start::new(builder.block_params(entry), module.program, routine, effects),
        };
        let exit = builder.create_block();
        let noted = module.notes.is_some().then(|| Noted::new(id));
        let mut function = Self {
            module,
            builder,
            routine,
            start,
            locals: Vec::with_capacity(routine.locals.len()),
            loops: Vec::new(),
            turning: Vec::new(),
            marks: Marks::new(),
            before: &[],
            turns: None,
            exits: Vec::new(),
            known_in: None,
            seen: Seen::default(),
            copied: 0,
            unrolled: 0,
            looked_up: Vec::new(),
            made: None,
            fresh: None,
            doubled: 0,
            endings: 0,
            counters: Vec::new(),
            registers: Vec::new(),
            checked: effects.checked.clone(),
            exit,
            faults: Faults::default(),
            temporaries: Temporaries::default(),
            noted,
            functions: FxHashMap::default(),
            routines: FxHashMap::default(),
            data: FxHashMap::default(),
            result: routine.result.zip(result_type(routine)),
        };
        function.place_locals(effects);
        function.note_start();
        function.start_locals();
        function
    }

    fn place_locals(&mut self, effects: &Effects) {
        let mut variables = 0;
        // A debugger finds all of them in the frame.
        let is_seen = self.noted.is_some();
        for (local, is_referred) in self.routine.locals.iter().zip(&effects.borrowed) {
            let repr = self.module.program.repr(local.ty).filter(|_| !is_referred && !is_seen);
            let home = match repr {
                Some(repr) if variables < MAX_VARIABLES => {
                    variables += 1;
                    LocalSlot::Variable(self.builder.declare_var(clif_type(repr)))
                }
                Some(_) | None => {
                    let shape = self.module.layout.shape(local.ty);
                    LocalSlot::Slot(self.slot(shape))
                }
            };
            self.locals.push(home);
        }
    }

    /// Every call starts with arguments and initial values.
    fn start_locals(&mut self) {
        let routine = self.routine;
        let mut arguments = vec![None; routine.locals.len()];
        for (param, value) in routine.params.iter().zip(&self.start.params) {
            if let Mode::Value(local) = param.mode {
                arguments[local.index()] = Some(*value);
            }
        }
        for (at, argument) in arguments.into_iter().enumerate() {
            let (home, local) = (self.locals[at], &routine.locals[at]);
            match argument {
                Some(value) => self.start_with_argument(home, local.ty, value),
                None => self.start_with_constant(home, local.ty, &local.initial),
            }
        }
    }

    fn start_with_argument(&mut self, home: LocalSlot, ty: Type, value: clif::Value) {
        match home {
            LocalSlot::Variable(variable) => self.builder.def_var(variable, value),
            LocalSlot::Slot(slot) => {
                let target = self.slot_address(slot);
                match ty {
                    Type::Elementary(_) | Type::Reference(_) | Type::Subrange(..) | Type::Enum(_) => {
                        self.store(value, target)
                    }
                    Type::String(it) => {
                        self.store_const(ty, &Const::Zero, target);
                        self.copy_text(value, target, it);
                    }
                    Type::Array(_) | Type::Struct(_) | Type::Block(_) => {
                        self.copy(Address::at(value), target, ty);
                    }
                }
            }
        }
    }

    fn start_with_constant(&mut self, home: LocalSlot, ty: Type, initial: &Const) {
        match home {
            LocalSlot::Variable(variable) => {
                let repr = self.module.program.repr(ty).expect("a variable is elementary");
                let initial = match initial {
                    Const::Scalar(value) => *value,
                    Const::Zero | Const::Text(_) | Const::Array(_) | Const::Struct(_) => repr.zero(),
                };
                let value = self.constant(initial);
                self.builder.def_var(variable, value);
            }
            LocalSlot::Slot(slot) => {
                let target = self.slot_address(slot);
                self.store_const(ty, initial, target);
            }
        }
    }

    fn close(mut self, flow: Flow, effects: &Effects) -> Marks {
        if flow == Flow::Continues {
            let exit = self.exit;
            self.ins().jump(exit, &[]);
        }
        self.builder.switch_to_block(self.exit);
        self.builder.seal_block(self.exit);
        self.note_end();
        let result = self.result();
        let mut values = Vec::new();
        if effects.faults {
            values.push(self.code(0));
        }
        values.extend(result);
        self.ins().return_(&values);
        self.close_faults();
        self.close_temporaries();
        self.builder.finalize(self.module.output.target_config());
        if let Some(notes) = &mut self.module.notes {
            notes.noted = self.noted;
        }
        self.marks
    }

    /// Stores a result that flow to memory; gives one that is returned.
    fn result(&mut self) -> Option<clif::Value> {
        let (local, ty) = self.result?;
        match (self.locals[local.index()], self.start.result) {
            (LocalSlot::Variable(variable), _) => Some(self.builder.use_var(variable)),
            (LocalSlot::Slot(slot), None) => {
                let from = self.slot_address(slot);
                Some(self.load(ty, from))
            }
            (LocalSlot::Slot(slot), Some(target)) => {
                let from = self.slot_address(slot);
                self.copy(from, Address::at(target), ty);
                None
            }
        }
    }

    /// What is returned with a fault's code.
    pub(crate) fn no_result(&mut self) -> Option<clif::Value> {
        let (_, ty) = self.result?;
        let repr = self.module.program.repr(ty)?;
        Some(self.constant(repr.zero()))
    }

    pub(crate) fn ins(&mut self) -> FuncInstBuilder<'_, 'a> {
        self.builder.ins()
    }

    pub(crate) fn function_ref(&mut self, id: FuncId) -> clif::FuncRef {
        if let Some(known) = self.functions.get(&id) {
            return *known;
        }
        let new = self.module.output.declare_func_in_func(id, self.builder.func);
        self.functions.insert(id, new);
        new
    }

    pub(crate) fn routine_ref(&mut self, id: RoutineId) -> clif::FuncRef {
        let (module, caller) = (&*self.module, &mut *self.builder.func);
        *self.routines.entry(id).or_insert_with(|| module.routine_ref(id, caller))
    }

    /// A pointer to a constant of the module.
    pub(crate) fn data_pointer(&mut self, id: DataId) -> clif::Value {
        let known = self.data.get(&id).copied();
        let data = known.unwrap_or_else(|| {
            let new = self.module.output.declare_data_in_func(id, self.builder.func);
            self.data.insert(id, new);
            new
        });
        self.ins().symbol_value(POINTER, data)
    }
}

/// Whether control reaches the end of a statement.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Flow {
    Continues,
    Leaves,
}

impl Start {
    fn of_scan(it: Begun) -> Self {
        Self { context: Some(it.context), globals: Some(it.globals), instance: Some(it.instance), ..Self::default() }
    }

    fn new(values: &[clif::Value], program: &Program, routine: &Routine, effects: &Effects) -> Self {
        let mut values = values.iter().copied();
        let mut next_if = |needed: bool| if needed { values.next() } else { None };
        let context = next_if(effects.context);
        let globals = next_if(effects.uses_globals());
        let instance = next_if(routine.state.is_some());
        let params = values.by_ref().take(routine.params.len()).collect();
        let by_pointer = result_type(routine).is_some_and(|ty| program.repr(ty).is_none());
        let result = values.next().filter(|_| by_pointer);
        Self { context, globals, instance, params, result }
    }
}
