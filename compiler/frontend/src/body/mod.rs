//! Bodies: statements, and the routines that they become.

mod assertion;
mod case;
mod loops;
mod statement;

use crate::expr::checker::Checker;
use crate::expr::uses::Uses;
use crate::types::declarations::Declarations;
use crate::{Bodies, Span, ast};
use staunch_ir::reference::escape::moves_references;
use staunch_ir::stack;
use staunch_ir::{Block, Program, Routine, RoutineKind, StatementKind};

/// What checking all bodies gave.
pub(crate) struct Checked {
    /// In the order of the POUs' slots; `None` where there was an error.
    pub routines: Vec<Option<(Routine, Uses)>>,
    /// The stack that a call of each takes, but for results that nobody wants.
    pub stacks: Vec<u64>,
    /// The first statement that makes nothing, because something in it was refused.
    pub left_out: Option<Span>,
}

/// Checks the bodies of all POUs, in the order of their slots. A body that is not kept is let go.
pub(crate) fn check<'s>(decl: &mut Declarations<'s>, bodies: &mut [Vec<ast::Statement<'s>>], keep: Bodies) -> Checked {
    let mut checked = Checked { routines: Vec::new(), stacks: Vec::new(), left_out: None };
    for (slot, body) in bodies.iter_mut().enumerate() {
        let mut made = check_body(decl, slot, body, &mut checked.left_out);
        let stack = made.as_ref().map_or(0, |(routine, _)| stack::of_body(routine, &|ty| decl.size_at_most(ty)));
        checked.stacks.push(stack);
        if keep == Bodies::Dropped {
            body.clear();
            made.iter_mut()
                .for_each(|(routine, _)| routine.body = rest(&decl.program, std::mem::take(&mut routine.body)));
        }
        checked.routines.push(made);
    }
    checked
}

/// What later checks ask of a body: its calls, and the assignments of references.
fn rest(program: &Program, block: Block) -> Block {
    let mut kept = Block::new();
    move_rest(program, block, &mut kept);
    kept
}

fn move_rest(program: &Program, block: Block, kept: &mut Block) {
    for mut statement in block {
        let inner: Vec<_> = statement.kind.blocks_mut().into_iter().map(std::mem::take).collect();
        inner.into_iter().for_each(|it| move_rest(program, it, kept));
        let is_call = matches!(statement.kind, StatementKind::Call { .. });
        if is_call || !program.references.is_empty() && moves_references(program, &statement.kind) {
            kept.push(statement);
        }
    }
}

/// Checks a body of the POU in a slot. Nothing in the declarations changes by that, so a body may be checked
/// more than once.
fn check_body<'s>(
    decl: &mut Declarations<'s>,
    slot: usize,
    statements: &[ast::Statement<'s>],
    left_out: &mut Option<Span>,
) -> Option<(Routine, Uses)> {
    let pou = decl.pous[slot].ast;
    let signature = decl.signature(slot)?;
    let mut checker = Checker::of_body(decl, &signature);
    checker.initial_outputs(&signature);
    if pou.kind != ast::PouKind::Action {
        checker.own_enable(&signature, pou.name.span);
    }
    checker.edge_inputs(&signature, pou.name.span);
    checker.mocked_result(slot, pou.name.span);
    let mut body = checker.block_of(statements);
    checker.migration_lints(statements);
    let mut whole = std::mem::take(&mut checker.block);
    whole.append(&mut body);
    let uses = checker.finish_uses();
    *left_out = left_out.or(checker.left_out);
    let locals = std::mem::take(&mut checker.locals);
    let location = decl.location(pou.name.span);
    let kind = match pou.kind {
        ast::PouKind::Function => RoutineKind::Function,
        ast::PouKind::Action | ast::PouKind::Method => RoutineKind::Method,
        ast::PouKind::Program | ast::PouKind::FunctionBlock | ast::PouKind::Test => RoutineKind::Body,
    };
    let body = Routine {
        kind,
        name: decl.emitted_name(slot),
        doc: pou.doc.clone(),
        location,
        state: signature.state,
        params: signature.params.clone(),
        locals,
        result: signature.result.as_ref().map(|(id, _)| *id),
        body: whole,
    };
    Some((body, uses))
}
