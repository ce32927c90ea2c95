//! One program on its way into a module: what is declared, and the data that code refers to.

use crate::compiled::{LARGE, Queue, Waiting, plain};
use crate::count::{Marks, Numbered, is_marked, sizes};
use crate::debug::notes::Notes;
use crate::error::reason;
use crate::expectation::{Expectation, expectations};
use crate::folded::{Folded, Shared};
use crate::inline_routine::SmallRoutines;
use crate::measure::{Code, Made, Measures, measures};
use crate::signature::ROUTINES;
use crate::target::Aim;
use crate::tidy::tidy;
use crate::trimmed::Trimmed;
use crate::unused::drop_unused_loads;
use crate::{Error, signature};
use cranelift_codegen::ir::{
    AbiParam, ExtFuncData, ExternalName, FuncRef, Function, InstBuilder, MemFlagsData, Signature, UserExternalName,
    UserFuncName, Value, types,
};
use cranelift_codegen::isa::CallConv;
use cranelift_codegen::{CompiledCode, Context};
use cranelift_frontend::{FunctionBuilder, FunctionBuilderContext};
use cranelift_module::{DataDescription, DataId, FuncId, Linkage, Module, ModuleReloc};
use rustc_hash::{FxHashMap, FxHashSet};
use staunch_ir::effects::Effects;
use staunch_ir::layout::{Layout, usize_of};
use staunch_ir::reference::Targets;
use staunch_ir::{Program, Repr, Routine, RoutineId, RoutineKind, Type};
use staunch_runtime::reference::encode;
use std::collections::BTreeMap;
use std::fmt::Write;
use target_lexicon::Architecture;

/// The table of objects, and what code is made by that is known of them.
struct References {
    table: DataId,
    count: u32,
    /// The kinds and numbers of the types of those in no pool.
    types: FxHashSet<(u32, u32)>,
}

/// The types of the objects that are in no pool.
fn types_of_objects(words: &[u32]) -> FxHashSet<(u32, u32)> {
    let count = words.first().map_or(0, |it| usize_of(u64::from(*it)));
    let all = words.get(encode::HEAD..).unwrap_or_default().chunks_exact(encode::OBJECT).take(count);
    let nodes = all.filter(|it| it[3] == 0).map(|it| usize_of(u64::from(it[4])));
    nodes.map(|node| (words[node], words[node + 2])).collect()
}

pub(crate) struct ModuleEmitter<'p> {
    pub(crate) program: &'p Program,
    /// What the symbols of the entry points begin with.
    pub(crate) prefix: &'p str,
    pub(crate) layout: Layout,
    effects: Vec<Effects>,
    /// The body of the PROGRAM that runs alone: its function is `staunch_scan`.
    scanned: Option<RoutineId>,
    pub(crate) output: &'p mut dyn Module,
    pub(crate) aim: Aim,
    /// Of the routines, where they are declared.
    functions: Vec<Option<FuncId>>,
    folded: Folded,
    imports: FxHashMap<String, FuncId>,
    /// Read-only data, defined when all code is made.
    constants: FxHashMap<Vec<u8>, DataId>,
    /// A scan may continue after a fault.
    pub(crate) handles_faults: bool,
    /// Where something follows or makes a reference.
    references: Option<References>,
    /// Where they lead, and what code compares them with, by the types that are looked for.
    targets: Option<Targets<'p>>,
    expectations: FxHashMap<Type, Vec<Expectation>>,
    small: SmallRoutines,
    /// The functions that keep all registers, by those of the runtime that they call, and how many numbers they are given.
    pub(crate) quiet: BTreeMap<&'static str, (FuncId, usize)>,
    /// Whether the machine's operations have operands in memory.
    pub(crate) has_operands_in_memory: bool,
    /// The size of each constant, in the order in which they were asked for.
    sizes: Vec<(DataId, u64)>,
    /// The functions that wait for their code.
    waiting: Queue,
    /// The functions, in the order in which they are made: those of routines first.
    made: Vec<Made>,
    /// The routines without functions of their own.
    equal: Vec<(RoutineId, Made)>,
    /// The functions as text, where it is wanted.
    pub(crate) listing: Option<String>,
    /// Whether the instructions of functions are to be counted.
    pub(crate) counts: bool,
    /// What a debugger is to know, where code is made for one.
    pub(crate) notes: Option<Notes>,
}

/// Working memory of the code generator, kept from function to function.
pub(crate) struct Workspace {
    pub(crate) context: Context,
    pub(crate) builder: FunctionBuilderContext,
}

impl<'p> ModuleEmitter<'p> {
    pub(crate) fn new(
        program: &'p Program,
        effects: Vec<Effects>,
        scanned: Option<RoutineId>,
        output: &'p mut dyn Module,
    ) -> Self {
        Self {
            program,
            prefix: signature::PREFIX,
            aim: Aim::of(output.isa()),
            layout: Layout::new(program),
            handles_faults: program.handles_faults(),
            scanned,
            effects,
            functions: vec![None; program.routines.len()],
            folded: Folded::of(program, Aim::of(output.isa())),
            imports: FxHashMap::default(),
            constants: FxHashMap::default(),
            references: None,
            targets: None,
            expectations: FxHashMap::default(),
            small: SmallRoutines::default(),
            quiet: BTreeMap::new(),
            has_operands_in_memory: matches!(output.isa().triple().architecture, Architecture::X86_64),
            sizes: Vec::new(),
            waiting: Queue::default(),
            made: Vec::with_capacity(program.routines.len()),
            equal: Vec::new(),
            listing: None,
            counts: false,
            notes: None,
            output,
        }
    }

    pub(crate) fn signature(&self, id: RoutineId) -> Signature {
        let mut signature = self.output.make_signature();
        if self.is_scanned(id) {
            signature::of_scan(&mut signature);
            return signature;
        }
        signature::of_routine(self.program, self.program.routine(id), self.effects(id), &mut signature);
        signature
    }

    /// An entry point's name for linkers.
    pub(crate) fn symbol(&self, name: &str) -> String {
        format!("{}_{name}", self.prefix)
    }

    /// Whether a routine's function is `staunch_scan`.
    pub(crate) fn is_scanned(&self, id: RoutineId) -> bool {
        self.scanned == Some(id)
    }

    /// The function `staunch_scan`, if it is a routine's.
    pub(crate) fn scan(&self) -> Option<FuncId> {
        self.functions[self.scanned?.index()]
    }

    pub(crate) fn effects(&self, id: RoutineId) -> &Effects {
        &self.effects[id.index()]
    }

    /// What a routine is called by in a function's code: its number, for which [`Self::name`] puts the one of its function.
    pub(crate) fn routine_ref(&self, id: RoutineId, caller: &mut Function) -> FuncRef {
        let signature = caller.import_signature(self.signature(id));
        let name = caller.declare_imported_user_function(UserExternalName { namespace: ROUTINES, index: id.0 });
        let name = ExternalName::user(name);
        caller.import_function(ExtFuncData { name, signature, colocated: true, patchable: false })
    }

    /// The name of the function of what a function's code calls.
    fn named(&mut self, name: &UserExternalName) -> Result<UserExternalName, Error> {
        Ok(match name.namespace {
            ROUTINES => UserExternalName { namespace: 0, index: self.function(RoutineId(name.index))?.as_u32() },
            _ => name.clone(),
        })
    }

    /// The names that a function's code calls by.
    fn names(&mut self, function: &Function) -> Result<Vec<UserExternalName>, Error> {
        function.params.user_named_funcs().values().map(|it| self.named(it)).collect()
    }

    /// Calls of routines in a function's code become those of their functions.
    fn name(&mut self, function: &mut Function) -> Result<(), Error> {
        for (at, name) in function.params.user_named_funcs().clone() {
            function.params.reset_user_func_name(at, self.named(&name)?);
        }
        Ok(())
    }

    /// The function of a routine, which is its own if it has not been made yet.
    fn function(&mut self, id: RoutineId) -> Result<FuncId, Error> {
        if let Some(known) = self.functions[id.index()] {
            return Ok(known);
        }
        let new = self.declare(id)?;
        self.functions[id.index()] = Some(new);
        Ok(new)
    }

    fn declare(&mut self, id: RoutineId) -> Result<FuncId, Error> {
        let (name, linkage) = match self.is_scanned(id) {
            true => (self.symbol(signature::SCAN), Linkage::Export),
            false => (symbol(id, self.program.routine(id)), Linkage::Local),
        };
        let signature = self.signature(id);
        Ok(self.output.declare_function(&name, linkage, &signature)?)
    }

    /// The function of a routine with this code.
    fn shared(&mut self, id: RoutineId, code: &Function, marks: &Marks) -> Result<Shared, Error> {
        if self.functions[id.index()].is_some() || !self.folded.is_candidate(id) {
            return self.function(id).map(Shared::New);
        }
        let names = self.names(code)?;
        let at = self.program.routine(id).location;
        let mut folded = core::mem::take(&mut self.folded);
        let function = folded.function(at, (code, names, marks), || self.function(id));
        self.folded = folded;
        function
    }

    /// A function of the runtime.
    pub(crate) fn import(&mut self, symbol: &str, signature: &Signature) -> FuncId {
        if let Some(id) = self.imports.get(symbol) {
            return *id;
        }
        let id = self
            .output
            .declare_function(symbol, Linkage::Import, signature)
            .expect("a symbol of the runtime has one signature, and no other meaning");
        self.imports.insert(symbol.to_owned(), id);
        id
    }

    /// A function that keeps all registers, for an access by reference by one of the runtime.
    pub(crate) fn quiet(&mut self, symbol: &'static str, numbers: usize) -> FuncId {
        if let Some((id, _)) = self.quiet.get(symbol) {
            return *id;
        }
        let mut signature = Signature::new(CallConv::PreserveAll);
        // The state, the reference, the distance, and what is loaded or stored.
        signature.params.extend([signature::POINTER, types::I64, types::I64, signature::POINTER].map(AbiParam::new));
        let number = signature::c_value(self.output.isa().triple(), Repr::U32);
        signature.params.extend(std::iter::repeat_n(number, numbers));
        let name = format!("quiet_{symbol}");
        let id = self.output.declare_function(&name, Linkage::Local, &signature).expect("no other symbol begins so");
        self.quiet.insert(symbol, (id, numbers));
        id
    }

    /// Read-only bytes, aligned for any value; equal bytes are there once.
    pub(crate) fn constant(&mut self, bytes: Vec<u8>) -> DataId {
        if let Some(id) = self.constants.get(&bytes) {
            return *id;
        }
        let name = format!("staunch_constant_{}", self.constants.len());
        let id = self.output.declare_data(&name, Linkage::Local, false, false).expect("names of constants are counted");
        self.sizes.push((id, u64::try_from(bytes.len()).expect("a usize fits a u64")));
        self.constants.insert(bytes, id);
        id
    }

    /// What is known of the code, when all of it is made.
    pub(crate) fn measures(&mut self, entry_points: [FuncId; 2]) -> Measures {
        for (routine, made) in core::mem::take(&mut self.equal) {
            self.made.insert(routine.index(), made);
        }
        let outside = self.imports.iter().map(|(symbol, id)| (*id, symbol.clone())).collect();
        measures(&self.made, outside, &self.sizes, entry_points)
    }

    /// The words of the table by which accesses through references are checked.
    pub(crate) fn reference_table(&mut self) -> DataId {
        self.references().table
    }

    /// How many objects the table has.
    pub(crate) fn reference_objects(&mut self) -> u32 {
        self.references().count
    }

    /// Whether an object's outermost variable is of a type, and it is in no pool.
    pub(crate) fn has_object_of(&mut self, kind: u32, id: u32) -> bool {
        self.references().types.contains(&(kind, id))
    }

    /// Where references lead.
    pub(crate) fn targets(&mut self) -> &Targets<'p> {
        self.targets.get_or_insert_with(|| Targets::new(self.program, &self.layout))
    }

    /// Where variables of a type are expected, by what is looked for.
    pub(crate) fn expectations(&mut self, ty: Type) -> Vec<Expectation> {
        if let Some(known) = self.expectations.get(&ty) {
            return known.clone();
        }
        let found = expectations(self.targets(), ty);
        self.expectations.insert(ty, found.clone());
        found
    }

    fn references(&mut self) -> &References {
        if self.references.is_none() {
            let words = staunch_ir::reference::table(self.program, &self.layout);
            let (count, types) = (words.first().copied().unwrap_or_default(), types_of_objects(&words));
            let table = self.constant(words.into_iter().flat_map(u32::to_le_bytes).collect());
            self.references = Some(References { table, count, types });
        }
        self.references.as_ref().expect("they were made")
    }

    pub(crate) fn define_constants(&mut self) -> Result<(), Error> {
        let mut constants: Vec<_> = core::mem::take(&mut self.constants).into_iter().collect();
        constants.sort_unstable_by_key(|(_, id)| *id);
        for (bytes, id) in constants {
            define_data(self.output, id, bytes)?;
        }
        Ok(())
    }

    /// Declares the word that leads a debugger to the state.
    pub(crate) fn declare_notes(&mut self) -> Result<(), Error> {
        let name = self.symbol("debug_state");
        let state = self.output.declare_data(&name, Linkage::Local, true, false)?;
        let mut data = DataDescription::new();
        data.set_align(8);
        data.define_zeroinit(8);
        self.output.define_data(state, &data)?;
        self.notes = Some(Notes::new(state, self.output.isa()));
        Ok(())
    }

    /// Stores where the state is, at the start of an entry point.
    pub(crate) fn note_state(&mut self, builder: &mut FunctionBuilder<'_>, state: Value) {
        let Some(notes) = &self.notes else { return };
        let word = self.output.declare_data_in_func(notes.state, builder.func);
        let word = builder.ins().symbol_value(signature::POINTER, word);
        builder.ins().store(MemFlagsData::trusted(), state, word, 0);
    }

    /// Makes the code of the routine in `context`, with that of small ones in place of their calls, unless another one's is equal.
    /// Routines come in their order.
    pub(crate) fn define_routine(
        &mut self,
        context: &mut Context,
        routine: RoutineId,
        mut marks: Marks,
    ) -> Result<(), Error> {
        let name = &self.program.title(self.program.routine(routine));
        self.list(context, name);
        let mut inliner = self.small.inliner(&mut context.func);
        let inlined = context.inline(&mut inliner);
        let placed = inliner.placed;
        inlined.map_err(|error| Error::Code { function: name.to_owned(), reason: reason(&error) })?;
        marks.extend(self.small.marks(&placed, &context.func));
        if !placed.is_empty() {
            tidy(&mut context.func);
        }
        if self.aim == Aim::Speed {
            self.small.note(routine, &context.func, &marks);
        }
        let id = match self.shared(routine, &context.func, &marks)? {
            Shared::New(id) => id,
            Shared::Known(id) => {
                self.functions[routine.index()] = Some(id);
                self.equal.push((routine, Made::none(id, name)));
                self.output.clear_context(context);
                return Ok(());
            }
        };
        context.func.name = UserFuncName::user(0, id.as_u32());
        self.define(context, id, name, marks)
    }

    /// Makes the code of the entry point in `context`. It calls what it runs, so that each function is of a routine.
    pub(crate) fn define_entry(&mut self, context: &mut Context, id: FuncId, name: &str) -> Result<(), Error> {
        self.list(context, name);
        self.define(context, id, name, Marks::new())
    }

    fn list(&mut self, context: &Context, name: &str) {
        if let Some(listing) = &mut self.listing {
            let text = context.func.display();
            writeln!(listing, "; {name}\n{text}").expect("writing to a String does not fail");
        }
    }

    fn define(&mut self, context: &mut Context, id: FuncId, name: &str, mut marks: Marks) -> Result<(), Error> {
        self.name(&mut context.func)?;
        drop_unused_loads(&mut context.func);
        let is_marked = self.counts && is_marked(&context.func, &marks);
        if is_marked {
            marks.extend(sizes(&context.func));
        }
        let marks = Numbered::set(&mut context.func, &marks);
        let marks = Some(marks).filter(|_| is_marked);
        if self.aim != Aim::Speed {
            return self.define_at_once(context, id, name, marks);
        }
        let context = std::mem::replace(context, self.output.make_context());
        let is_much = self.waiting.add(Waiting { context, id, name: name.to_owned(), marks });
        if is_much { self.define_waiting() } else { Ok(()) }
    }

    /// Makes the code of all functions that wait for it.
    pub(crate) fn define_waiting(&mut self) -> Result<(), Error> {
        for (function, code) in self.waiting.compiled(self.output.isa(), self.has_operands_in_memory) {
            let Waiting { context, id, name, marks } = function;
            let defined = code.and_then(|(code, trimmed)| {
                self.define_bytes(&code, &trimmed, &context.func, id)?;
                self.note_made(Some((&code, &trimmed)), &context.func, id, &name, marks.as_ref());
                Ok(())
            });
            defined.map_err(|reason| Error::Code { function: name, reason })?;
        }
        Ok(())
    }

    fn define_at_once(
        &mut self,
        context: &mut Context,
        id: FuncId,
        name: &str,
        marks: Option<Numbered>,
    ) -> Result<(), Error> {
        let defined = if context.func.dfg.num_insts() > LARGE {
            let code = plain(context, self.output.isa());
            code.and_then(|(code, trimmed)| self.define_bytes(&code, &trimmed, &context.func, id))
        } else {
            self.output.define_function(id, context).map_err(|error| reason(&error))
        };
        let code = context.compiled_code().map(|it| (it, Trimmed::none(it)));
        let code = code.as_ref().map(|(code, trimmed)| (*code, trimmed));
        self.note_made(code, &context.func, id, name, marks.as_ref());
        if let Some(notes) = &mut self.notes {
            notes.add(context, id, self.output.isa());
        }
        self.output.clear_context(context);
        defined.map_err(|reason| Error::Code { function: name.to_owned(), reason })
    }

    fn note_made(
        &mut self,
        code: Option<Code<'_>>,
        function: &Function,
        id: FuncId,
        name: &str,
        marks: Option<&Numbered>,
    ) {
        let made = Made::of(code, function, id, name);
        self.made.push(if self.counts { made.counted(code, function, marks) } else { made });
    }

    fn define_bytes(
        &mut self,
        code: &CompiledCode,
        trimmed: &Trimmed,
        function: &Function,
        id: FuncId,
    ) -> Result<(), String> {
        let relocations = code.buffer.relocs().iter().map(|it| {
            let relocation = ModuleReloc::from_mach_reloc(it, function, id);
            ModuleReloc { offset: trimmed.place(relocation.offset), ..relocation }
        });
        let relocations: Vec<_> = relocations.collect();
        let defined = self.output.define_function_bytes(id, code.buffer.alignment.into(), &trimmed.bytes, &relocations);
        defined.map_err(|error| reason(&error))
    }
}

/// Data that is aligned for any value.
pub(crate) fn define_data(module: &mut dyn Module, id: DataId, bytes: Vec<u8>) -> Result<(), Error> {
    let mut data = DataDescription::new();
    data.set_align(8);
    data.define(bytes.into_boxed_slice());
    Ok(module.define_data(id, &data)?)
}

/// A local symbol, for debuggers and disassemblers; the number makes names unique.
fn symbol(id: RoutineId, routine: &Routine) -> String {
    let name = routine.name.replace(|c: char| !c.is_ascii_alphanumeric(), "_");
    match routine.kind {
        RoutineKind::Function | RoutineKind::Body | RoutineKind::Method => format!("st{}_{name}", id.0),
        RoutineKind::Prescan => format!("st{}_{name}_prescan", id.0),
    }
}
