//! What each function of the emitted text has to be handed, and whether it can fault.

use staunch_ir::{Argument, Block, Expr, Place, PouKind, Program, Root, Statement, StatementKind, Step};

use staunch_ir::visit;

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Needs {
    pub context: bool,
    pub globals: bool,
    pub faults: bool,
}

/// Of a POU's two functions.
#[derive(Clone, Copy, Debug, Default)]
pub struct PouNeeds {
    pub body: Needs,
    pub prescan: Needs,
}

/// For each POU; callees stand before callers.
pub fn needs(program: &Program) -> Vec<PouNeeds> {
    let mut known: Vec<PouNeeds> = Vec::with_capacity(program.pous.len());
    for pou in &program.pous {
        let mut body = of_block(program, &pou.body, &known);
        let prescan = of_block(program, &pou.prescan, &known);
        if let PouKind::Program = pou.kind
            && !pou.prescan.is_empty()
        {
            body.globals |= prescan.globals;
            body.context = true;
        }
        known.push(PouNeeds { body, prescan });
    }
    known
}

fn of_block(program: &Program, block: &Block, known: &[PouNeeds]) -> Needs {
    let mut needs = Needs::default();
    visit::statements(block, &mut |statement| {
        visit::accesses(statement, &mut |place, _| needs.globals |= place.root == Root::Globals);
        needs.faults |= faults(program, statement);
        let callee = match &statement.kind {
            StatementKind::Call { callee, instance: None, .. } => known[callee.index()].body,
            // The signature of a block's scan does not depend on its body.
            StatementKind::Call { callee, instance: Some(_), .. } => {
                Needs { context: true, faults: true, ..known[callee.index()].body }
            }
            StatementKind::PrescanInstance { callee, .. } => known[callee.index()].prescan,
            StatementKind::CallBlock { block, instruction, .. } => {
                Needs { context: needs_context(block, *instruction), ..Needs::default() }
            }
            StatementKind::Turn => Needs { context: true, faults: true, ..Needs::default() },
            StatementKind::Assign { .. }
            | StatementKind::If { .. }
            | StatementKind::Case { .. }
            | StatementKind::Loop { .. }
            | StatementKind::For(_)
            | StatementKind::Exit
            | StatementKind::Continue
            | StatementKind::Return
            | StatementKind::PrescanBlock { .. }
            | StatementKind::Fault(_) => Needs::default(),
        };
        needs.context |= callee.context;
        needs.globals |= callee.globals;
        needs.faults |= callee.faults;
    });
    needs
}

fn needs_context(block: &Place, instruction: usize) -> bool {
    let staunch_ir::Type::Block(id) = block.ty else { unreachable!("verified IR: a block is called") };
    id.info().instructions[instruction].needs_context
}

/// Whether the statement's own expressions and places can fault.
fn faults(program: &Program, statement: &Statement) -> bool {
    let expr = |it: &Expr| visit::expr_faults(program, it);
    let place = |it: &Place| visit::place_faults(program, it);
    match &statement.kind {
        StatementKind::Assign { target, value } => place(target) || expr(value),
        StatementKind::If { condition: value, .. } | StatementKind::Case { selector: value, .. } => expr(value),
        StatementKind::Call { instance, arguments, result, .. } => {
            let argument = |it: &Argument| match it {
                Argument::Value(value) => expr(value),
                Argument::Reference(it) => place(it),
            };
            instance.iter().chain(result).any(place) || arguments.iter().any(argument)
        }
        StatementKind::CallBlock { block, inputs, .. } => place(block) || inputs.iter().any(expr),
        StatementKind::PrescanBlock { block: it, .. } | StatementKind::PrescanInstance { instance: it, .. } => {
            place(it)
        }
        StatementKind::For(it) => {
            let step = match &it.step {
                Step::Constant(_) => false,
                Step::Variable(step) => expr(step),
            };
            let lane = program.lane(it.counter.ty);
            let stepping = it.step_may_fault(lane.and_then(|lane| lane.range()));
            place(&it.counter) || expr(&it.first) || expr(&it.last) || step || stepping
        }
        StatementKind::Fault(_) | StatementKind::Turn => true,
        StatementKind::Loop { .. } | StatementKind::Exit | StatementKind::Continue | StatementKind::Return => false,
    }
}
