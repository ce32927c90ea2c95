//! One program on its way into a module: what is declared, and the data that code refers to.

use crate::facts::{self, Facts, PouFacts};
use crate::{Error, entry, function, signature, target};
use cranelift_codegen::Context;
use cranelift_codegen::control::ControlPlane;
use cranelift_codegen::ir::Signature;
use cranelift_frontend::FunctionBuilderContext;
use cranelift_module::{DataDescription, DataId, FuncId, Linkage, Module, ModuleReloc};
use staunch_ir::layout::Layout;
use staunch_ir::{Pou, PouId, Program};
use std::collections::HashMap;
use std::fmt::Write;

/// Functions of more instructions are not optimised: that takes time that grows faster than they do,
/// to minutes for a hundred thousand statements.
const LARGE: usize = 30_000;

pub(crate) struct Unit<'p> {
    pub(crate) program: &'p Program,
    pub(crate) layout: Layout,
    pub(crate) facts: Vec<PouFacts>,
    pub(crate) module: &'p mut dyn Module,
    functions: Vec<PouFunctions>,
    imports: HashMap<String, FuncId>,
    /// Read-only data, defined when all code is made.
    constants: HashMap<Vec<u8>, DataId>,
    /// The functions as text, where it is wanted.
    pub(crate) listing: Option<String>,
}

#[derive(Clone, Copy, Debug)]
struct PouFunctions {
    body: FuncId,
    /// There is none for an empty prescan.
    prescan: Option<FuncId>,
}

/// Working memory of the code generator, kept from function to function.
pub(crate) struct Workspace {
    pub(crate) context: Context,
    pub(crate) builder: FunctionBuilderContext,
}

/// Which of a POU's blocks a function runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Part {
    Body,
    Prescan,
}

/// The functions that a program consists of.
#[derive(Clone, Copy, Debug)]
pub(crate) struct EntryPoints {
    pub(crate) init: FuncId,
    pub(crate) scan: FuncId,
}

/// Puts a whole program into `module`; gives its entry points and, if wanted, a listing.
pub(crate) fn emit(
    program: &Program,
    module: &mut dyn Module,
    listing: Option<String>,
) -> Result<(EntryPoints, String), Error> {
    let mut unit = Unit {
        program,
        layout: Layout::new(program),
        facts: facts::of_program(program),
        module,
        functions: Vec::with_capacity(program.pous.len()),
        imports: HashMap::new(),
        constants: HashMap::new(),
        listing,
    };
    unit.declare()?;
    let mut workspace = Workspace { context: unit.module.make_context(), builder: FunctionBuilderContext::new() };
    for at in 0..program.pous.len() {
        let id = PouId::next(at);
        function::emit(&mut unit, &mut workspace, id, Part::Body)?;
        if !program.pou(id).prescan.is_empty() {
            function::emit(&mut unit, &mut workspace, id, Part::Prescan)?;
        }
    }
    let entry_points = entry::emit(&mut unit, &mut workspace)?;
    unit.define_constants()?;
    Ok((entry_points, unit.listing.unwrap_or_default()))
}

impl<'p> Unit<'p> {
    fn declare(&mut self) -> Result<(), Error> {
        let program = self.program;
        for (at, pou) in program.pous.iter().enumerate() {
            let id = PouId::next(at);
            let body = self.declare_pou(id, pou, Part::Body)?;
            let prescan = if pou.prescan.is_empty() { None } else { Some(self.declare_pou(id, pou, Part::Prescan)?) };
            self.functions.push(PouFunctions { body, prescan });
        }
        Ok(())
    }

    fn declare_pou(&mut self, id: PouId, pou: &Pou, part: Part) -> Result<FuncId, Error> {
        let signature = self.signature(id, part);
        let name = symbol(id, pou, part);
        Ok(self.module.declare_function(&name, Linkage::Local, &signature)?)
    }

    pub(crate) fn signature(&self, id: PouId, part: Part) -> Signature {
        let mut signature = self.module.make_signature();
        let pou = self.program.pou(id);
        let is_prescan = part == Part::Prescan;
        signature::of_pou(self.program, pou, self.facts(id, part), is_prescan, &mut signature);
        signature
    }

    pub(crate) fn facts(&self, id: PouId, part: Part) -> &Facts {
        let facts = &self.facts[id.index()];
        match part {
            Part::Body => &facts.body,
            Part::Prescan => &facts.prescan,
        }
    }

    /// The function of a POU's part; `None` for an empty prescan.
    pub(crate) fn function(&self, id: PouId, part: Part) -> Option<FuncId> {
        let functions = self.functions[id.index()];
        match part {
            Part::Body => Some(functions.body),
            Part::Prescan => functions.prescan,
        }
    }

    /// A function of the runtime.
    pub(crate) fn import(&mut self, symbol: &str, signature: &Signature) -> FuncId {
        if let Some(id) = self.imports.get(symbol) {
            return *id;
        }
        let id = self
            .module
            .declare_function(symbol, Linkage::Import, signature)
            .expect("a symbol of the runtime has one signature, and no other meaning");
        self.imports.insert(symbol.to_owned(), id);
        id
    }

    /// Read-only bytes, aligned for any value; equal bytes are there once.
    pub(crate) fn constant(&mut self, bytes: Vec<u8>) -> DataId {
        if let Some(id) = self.constants.get(&bytes) {
            return *id;
        }
        let name = format!("staunch_constant_{}", self.constants.len());
        let id = self.module.declare_data(&name, Linkage::Local, false, false).expect("names of constants are counted");
        self.constants.insert(bytes, id);
        id
    }

    fn define_constants(&mut self) -> Result<(), Error> {
        let mut constants: Vec<_> = core::mem::take(&mut self.constants).into_iter().collect();
        constants.sort_unstable_by_key(|(_, id)| *id);
        for (bytes, id) in constants {
            define_data(self.module, id, bytes)?;
        }
        Ok(())
    }

    /// Makes the code of the function in `context`.
    pub(crate) fn define(&mut self, context: &mut Context, id: FuncId, name: &str) -> Result<(), Error> {
        if let Some(listing) = &mut self.listing {
            let text = context.func.display();
            writeln!(listing, "; {name}\n{text}").expect("writing to a String does not fail");
        }
        let defined = if context.func.dfg.num_insts() > LARGE {
            self.define_plainly(context, id)
        } else {
            self.module.define_function(id, context).map_err(|error| reason(&error))
        };
        self.module.clear_context(context);
        defined.map_err(|reason| Error::Code { function: name.to_owned(), reason })
    }

    fn define_plainly(&mut self, context: &mut Context, id: FuncId) -> Result<(), String> {
        let isa = target::plain_isa(self.module.isa());
        let code = context.compile(&*isa, &mut ControlPlane::default()).map_err(|error| reason(&error.inner))?;
        let (align, bytes) = (u64::from(code.buffer.alignment), code.code_buffer().to_vec());
        let relocations = code.buffer.relocs().to_vec();
        let relocations: Vec<_> =
            relocations.iter().map(|it| ModuleReloc::from_mach_reloc(it, &context.func, id)).collect();
        self.module.define_function_bytes(id, align, &bytes, &relocations).map_err(|error| reason(&error))
    }
}

/// Data that is aligned for any value.
pub(crate) fn define_data(module: &mut dyn Module, id: DataId, bytes: Vec<u8>) -> Result<(), Error> {
    let mut data = DataDescription::new();
    data.set_align(8);
    data.define(bytes.into_boxed_slice());
    Ok(module.define_data(id, &data)?)
}

/// The whole chain of causes: Cranelift's own message is only the last of them.
fn reason(error: &dyn core::error::Error) -> String {
    let mut text = error.to_string();
    let mut cause = error.source();
    while let Some(error) = cause {
        write!(text, ": {error}").expect("writing to a String does not fail");
        cause = error.source();
    }
    text
}

/// A local symbol, for debuggers and disassemblers; the number keeps names apart.
fn symbol(id: PouId, pou: &Pou, part: Part) -> String {
    let name = pou.name.replace(|c: char| !c.is_ascii_alphanumeric(), "_");
    match part {
        Part::Body => format!("st{}_{name}", id.0),
        Part::Prescan => format!("st{}_{name}_prescan", id.0),
    }
}
