//! A whole program into a module: its routines, its entry points, and the data that code refers to.

use crate::debug::notes::Notes;
use crate::entry::EntryPoints;
use crate::measure::Measures;
use crate::module::{ModuleEmitter, Workspace};
use crate::signature::PREFIX;
use crate::target::Aim;
use crate::{Error, entry, function, inline_block, inline_op, quiet, scan};
use cranelift_frontend::FunctionBuilderContext;
use cranelift_module::Module;
use staunch_ir::effects::{Rules, effects};
use staunch_ir::faults::code_faults;
use staunch_ir::promote::{Gain, promoted};
use staunch_ir::{Expr, ExprKind, Program, RoutineId, Statement, StatementKind, Type, visit};
use target_lexicon::Architecture;

/// What the code for blocks and operations needs.
const RULES: Rules = Rules {
    block_takes_context: |block, instruction| {
        let is_called = inline_block::find(block, instruction, Aim::Speed).is_none();
        is_called || inline_block::block_info(block).instructions[instruction].needs_context
    },
    operation_faults: code_faults,
    drops_checks: true,
    scans_take_all: false,
};

/// The same, where every block is called.
const RULES_OF_SIZE: Rules = Rules { block_takes_context: |_, _| true, ..RULES };

/// What is known of a program's code when it is made.
pub(crate) struct Emitted {
    pub(crate) entry_points: EntryPoints,
    /// Empty if none was wanted.
    pub(crate) listing: String,
    pub(crate) measures: Measures,
    /// Where code is made for debugging.
    pub(crate) notes: Option<Notes>,
}

/// What else is wanted than the code.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Also {
    Nothing,
    Listing,
    /// The blocks of the code, where they can be had for the machine.
    Counts,
}

/// Puts a whole program into `output`.
pub(crate) fn emit(program: &Program, output: &mut dyn Module, also: Also) -> Result<Emitted, Error> {
    emit_named(program, output, also, PREFIX)
}

/// The same, with entry points whose symbols begin otherwise.
pub(crate) fn emit_named(
    program: &Program,
    output: &mut dyn Module,
    also: Also,
    prefix: &str,
) -> Result<Emitted, Error> {
    let aim = Aim::of(output.isa());
    let is_of_x86 = matches!(output.isa().triple().architecture, Architecture::X86_64);
    let rules = match aim {
        Aim::Speed => &RULES,
        Aim::Size | Aim::Debugging => &RULES_OF_SIZE,
    };
    let suits = |it: &Statement| is_in_line(it, aim);
    let gain = Gain { suits: &suits, of_reads: false, of_scalars: true, of_repeats: false, of_ends: aim == Aim::Speed };
    // A debugger finds each variable where it is declared.
    let program = if aim == Aim::Debugging { program } else { &promoted(program, gain) };
    let mut workspace = Workspace { context: output.make_context(), builder: FunctionBuilderContext::new() };
    let effects = effects(program, rules);
    let scanned = scan::scanned(program, &effects);
    let mut module = ModuleEmitter::new(program, effects, scanned, output);
    module.prefix = prefix;
    module.listing = (also == Also::Listing).then(String::new);
    module.counts = also == Also::Counts && is_of_x86;
    if aim == Aim::Debugging {
        module.declare_notes()?;
    }
    for at in 0..program.routines.len() {
        function::emit(&mut module, &mut workspace, RoutineId::next(at))?;
    }
    quiet::emit(&mut module, &mut workspace)?;
    let entry_points = entry::emit(&mut module, &mut workspace)?;
    module.define_waiting()?;
    let measures = module.measures([entry_points.init, entry_points.scan]);
    module.define_constants()?;
    Ok(Emitted { entry_points, listing: module.listing.unwrap_or_default(), measures, notes: module.notes })
}

/// Whether the code for a statement calls nothing of the runtime's, which would find what is in registers in the frame. What a
/// loop only reads is an operand in memory.
fn is_in_line(statement: &Statement, aim: Aim) -> bool {
    let mut is_called = match &statement.kind {
        StatementKind::CallBlock { block, instruction, .. } => inline_block::find(block, *instruction, aim).is_none(),
        _ => false,
    };
    visit::all_exprs(statement, &mut |it: &Expr| {
        is_called |= match &it.kind {
            ExprKind::Apply(op, _) => inline_op::find(*op).is_none(),
            ExprKind::ApplyText(..) => true,
            ExprKind::Load(_) | ExprKind::Convert(..) => matches!(it.ty, Type::String(_)),
            ExprKind::Const(_) | ExprKind::Text(_) | ExprKind::Aggregate(_) | ExprKind::AddressOf(_) => false,
        };
    });
    !is_called
}
