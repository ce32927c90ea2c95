//! From a function to its machine code. Functions wait until there are many, which several threads work on; their code is put into the
//! module in the order in which they were given.

use crate::count::Numbered;
use crate::error::reason;
use crate::schedule::{merge, schedule};
use crate::target;
use crate::trimmed::Trimmed;
use cranelift_codegen::control::ControlPlane;
use cranelift_codegen::isa::TargetIsa;
use cranelift_codegen::{CompiledCode, Context};
use cranelift_module::FuncId;
use staunch_ir::in_threads;

/// Functions of more instructions are not optimised: that takes time that grows faster than they do,
/// to minutes for a hundred thousand statements.
pub(crate) const LARGE: usize = 30_000;
/// From so many instructions on, more threads than one are worth their start.
const MANY: usize = 4_000;
/// So many wait at most: they take memory.
const MOST: usize = 60_000;

/// A function without its code.
pub(crate) struct Waiting {
    pub context: Context,
    pub id: FuncId,
    pub name: String,
    /// Of those whose instructions are counted.
    pub marks: Option<Numbered>,
}

/// Its code, or why there is none.
pub(crate) type Compiled = Result<(CompiledCode, Trimmed), String>;

#[derive(Default)]
pub(crate) struct Queue {
    functions: Vec<Waiting>,
    instructions: usize,
}

impl Queue {
    /// Whether enough wait.
    pub fn add(&mut self, function: Waiting) -> bool {
        self.instructions += function.context.func.dfg.num_insts();
        self.functions.push(function);
        self.instructions > MOST
    }

    /// Makes the code of those that wait.
    pub fn compiled(&mut self, isa: &dyn TargetIsa, has_operands_in_memory: bool) -> Vec<(Waiting, Compiled)> {
        let (functions, instructions) = (std::mem::take(&mut self.functions), std::mem::take(&mut self.instructions));
        let work = |mut it: Waiting| {
            let code = compiled(&mut it.context, isa, has_operands_in_memory);
            (it, code)
        };
        match instructions < MANY {
            true => functions.into_iter().map(work).collect(),
            false => in_threads::each(functions, work),
        }
    }
}

fn compiled(context: &mut Context, isa: &dyn TargetIsa, has_operands_in_memory: bool) -> Compiled {
    if context.func.dfg.num_insts() > LARGE {
        return plain(context, isa);
    }
    let code = scheduled(context, isa, has_operands_in_memory)?;
    let trimmed = match has_operands_in_memory {
        true => Trimmed::of(&code, &context.func),
        false => Trimmed::none(&code),
    };
    Ok((code, trimmed))
}

/// Gives the function another order between the code generator's steps.
fn scheduled(context: &mut Context, isa: &dyn TargetIsa, has_operands_in_memory: bool) -> Result<CompiledCode, String> {
    let control = &mut ControlPlane::default();
    merge(&mut context.func);
    context.optimize(isa, control).map_err(|error| reason(&error))?;
    schedule(&mut context.func, has_operands_in_memory);
    context.compute_cfg();
    context.compute_domtree();
    context.verify_if(isa).map_err(|error| reason(&error))?;
    let (function, domtree) = (&context.func, &context.domtree);
    let code = isa.compile_function(function, domtree, &mut Default::default(), false, control);
    Ok(code.map_err(|error| reason(&error))?.apply_params(&function.params))
}

/// Code of a function that is too large to be optimised.
pub(crate) fn plain(context: &mut Context, isa: &dyn TargetIsa) -> Compiled {
    let isa = target::plain_isa(isa);
    let code = context.compile(&*isa, &mut ControlPlane::default()).map_err(|error| reason(&error.inner))?.clone();
    let trimmed = Trimmed::none(&code);
    Ok((code, trimmed))
}
