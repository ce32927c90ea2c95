//! What is known of the machine code of each function: how large it is, how much of the stack it takes, and what it calls and
//! reads. The code generator says it when it has made the function, so it is of the code that runs.

use crate::count::{CodeOf, Counted, Gap, Numbered};
use crate::trimmed::Trimmed;
use cranelift_codegen::ir::Function;
use cranelift_codegen::{CompiledCode, binemit::CodeOffset};
use cranelift_module::{DataId, FuncId, ModuleReloc, ModuleRelocTarget, default_libcall_names};
use rustc_hash::FxHashMap;
use std::collections::BTreeSet;

/// Next to a frame are the caller's frame pointer and the address to return to.
const FRAME_ENDS: u64 = 16;

/// A program's code, function by function.
#[derive(Clone, Debug)]
pub struct Measures {
    /// First one for each routine, in their order; then those that do not belong to a routine.
    pub functions: Vec<Measure>,
    /// `staunch_scan`, which may be a routine's.
    pub scan: usize,
    pub init: usize,
    /// The bytes of each read-only constant.
    pub constants: Vec<u64>,
}

/// One function.
#[derive(Clone, Debug)]
pub struct Measure {
    /// As in the source, or a symbol.
    pub name: String,
    /// Bytes of code.
    pub text: u64,
    /// Bytes of the stack that a call takes, without those of the calls it makes.
    pub frame: u64,
    pub calls: BTreeSet<Callee>,
    /// Which constants it reads.
    pub constants: BTreeSet<usize>,
    /// Its blocks.
    pub(crate) counted: Result<Counted<Callee>, Gap>,
}

/// A function that is called.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Callee {
    /// One of [`Measures::functions`].
    Function(usize),
    /// By its symbol: the runtime's, the C library's, or one that is implemented outside.
    Outside(String),
}

/// What the code generator says of a function's code, and the code.
pub(crate) type Code<'a> = (&'a CompiledCode, &'a Trimmed);

/// A function that has just been made.
pub(crate) struct Made {
    id: FuncId,
    name: String,
    text: CodeOffset,
    frame: u64,
    targets: Vec<ModuleRelocTarget>,
    counted: Result<Counted<ModuleRelocTarget>, Gap>,
}

impl Made {
    /// Of the code of a function.
    pub(crate) fn of(code: Option<Code<'_>>, function: &Function, id: FuncId, name: &str) -> Self {
        let targets = code.map(|it| relocations(it, function, id)).unwrap_or_default();
        Self {
            id,
            name: name.to_owned(),
            text: code.map_or(0, |it| it.1.place(it.0.buffer.total_size())),
            frame: code.map_or(0, |it| frame(it.0)),
            targets: targets.into_iter().map(|it| it.1).collect(),
            counted: Err(Gap::All),
        }
    }

    /// Of a routine that has another's function.
    pub(crate) fn none(id: FuncId, name: &str) -> Self {
        Self { id, name: name.to_owned(), text: 0, frame: 0, targets: Vec::new(), counted: Err(Gap::All) }
    }

    /// The same, with the blocks of the code, which is of x86-64. Without marks of all loops, they are not known.
    pub(crate) fn counted(self, code: Option<Code<'_>>, function: &Function, marks: Option<&Numbered>) -> Self {
        let counted = match (code, marks) {
            (Some(code), Some(marks)) => Counted::of(&code_of(code, function, self.id), marks),
            (None, _) => Err(Gap::All),
            (_, None) => Err(Gap::Loop),
        };
        Self { counted, ..self }
    }
}

fn frame(code: &CompiledCode) -> u64 {
    code.buffer.frame_layout().map_or(0, |it| u64::from(it.frame_to_fp_offset) + FRAME_ENDS)
}

/// What the code refers to, and where.
fn relocations((code, trimmed): Code<'_>, function: &Function, id: FuncId) -> Vec<(CodeOffset, ModuleRelocTarget)> {
    let relocations = code.buffer.relocs().iter().map(|it| ModuleReloc::from_mach_reloc(it, function, id));
    relocations.map(|it| (trimmed.place(it.offset), it.name)).collect()
}

fn code_of<'a>((code, trimmed): Code<'a>, function: &Function, id: FuncId) -> CodeOf<'a> {
    let number = |it: CodeOffset| usize::try_from(it).expect("code is in memory");
    let place = |it: CodeOffset| number(trimmed.place(it));
    let is_function = |it: &ModuleRelocTarget| match it {
        ModuleRelocTarget::User { namespace, .. } => *namespace == FUNCTIONS,
        ModuleRelocTarget::LibCall(_) | ModuleRelocTarget::KnownSymbol(_) => true,
        ModuleRelocTarget::FunctionOffset(..) => false,
    };
    let mut functions: Vec<_> =
        relocations((code, trimmed), function, id).into_iter().map(|(at, target)| (number(at), target)).collect();
    functions.retain(|it| is_function(&it.1));
    functions.sort_by_key(|it| it.0);
    CodeOf {
        bytes: &trimmed.bytes,
        starts: code.bb_starts.iter().map(|it| place(*it)).collect(),
        places: code.buffer.get_srclocs_sorted().iter().map(|it| (place(it.start), place(it.end), it.loc)).collect(),
        functions,
        frame: frame(code),
    }
}

/// What the functions' numbers mean, when all are made.
pub(crate) struct Names {
    functions: FxHashMap<FuncId, usize>,
    /// The symbols that are not the program's own.
    outside: FxHashMap<FuncId, String>,
    constants: FxHashMap<DataId, usize>,
}

impl Names {
    fn callee(&self, target: &ModuleRelocTarget) -> Option<Callee> {
        match target {
            ModuleRelocTarget::User { namespace: FUNCTIONS, index } => {
                let id = FuncId::from_u32(*index);
                let own = self.functions.get(&id).copied().map(Callee::Function);
                own.or_else(|| self.outside.get(&id).cloned().map(Callee::Outside))
            }
            ModuleRelocTarget::LibCall(call) => Some(Callee::Outside(default_libcall_names()(*call))),
            ModuleRelocTarget::KnownSymbol(symbol) => Some(Callee::Outside(symbol.to_string())),
            ModuleRelocTarget::User { .. } | ModuleRelocTarget::FunctionOffset(..) => None,
        }
    }

    fn constant(&self, target: &ModuleRelocTarget) -> Option<usize> {
        match target {
            ModuleRelocTarget::User { namespace: DATA, index } => {
                self.constants.get(&DataId::from_u32(*index)).copied()
            }
            ModuleRelocTarget::User { .. }
            | ModuleRelocTarget::LibCall(_)
            | ModuleRelocTarget::KnownSymbol(_)
            | ModuleRelocTarget::FunctionOffset(..) => None,
        }
    }
}

/// How Cranelift's modules distinguish functions from data.
const FUNCTIONS: u32 = 0;
const DATA: u32 = 1;

/// Of all functions, with those that others implement, and the sizes of constants.
pub(crate) fn measures(
    made: &[Made],
    outside: FxHashMap<FuncId, String>,
    sizes: &[(DataId, u64)],
    [init, scan]: [FuncId; 2],
) -> Measures {
    let names = Names {
        // Of equal ones the first has the function.
        functions: made.iter().enumerate().rev().map(|(at, it)| (it.id, at)).collect(),
        outside,
        constants: sizes.iter().enumerate().map(|(at, it)| (it.0, at)).collect(),
    };
    let measure = |it: &Made| Measure {
        name: it.name.clone(),
        text: it.text.into(),
        frame: it.frame,
        calls: it.targets.iter().filter_map(|it| names.callee(it)).collect(),
        constants: it.targets.iter().filter_map(|it| names.constant(it)).collect(),
        counted: it.counted.as_ref().map_err(|it| *it).and_then(|it| it.renamed(&|it| names.callee(it))),
    };
    Measures {
        functions: made.iter().map(measure).collect(),
        scan: names.functions[&scan],
        init: names.functions[&init],
        constants: sizes.iter().map(|it| it.1).collect(),
    }
}
