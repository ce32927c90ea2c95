//! Bodies: statements, and the routines that they become.

mod assertion;
mod axunit;
mod case;
mod case_text;
mod each_turn;
mod exception;
mod external;
mod jump;
mod loops;
mod near;
mod statement;
mod suite;
mod whole;
mod wide_step;

use crate::expr::checker::Checker;
use crate::expr::uses::Uses;
use crate::types::declarations::Declarations;
use crate::{Bodies, Code, Span, ast};
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

/// Checks the bodies of all POUs, in the order of their slots, and then those of what
/// they ask for: instances of generic FUNCTIONs, and routines that choose by a class. A body that is not kept is dropped.
pub(crate) fn check<'s>(decl: &mut Declarations<'s>, bodies: &mut [Vec<ast::Statement<'s>>], keep: Bodies) -> Checked {
    let mut checked = Checked { routines: Vec::new(), stacks: Vec::new(), left_out: None };
    for (slot, body) in bodies.iter_mut().enumerate() {
        if !is_asked_for(decl, slot, body) {
            checked.push(None, 0);
            continue;
        }
        if decl.is_head(slot) {
            decl.check_has_no_body(
                body,
                "a METHOD of an INTERFACE has no body",
                "the classes that implement it have one: delete this",
            );
        } else if decl.is_abstract_routine(slot) {
            decl.check_has_no_body(
                body,
                "an ABSTRACT METHOD has no body",
                "those that override it have one: delete this body, or ABSTRACT",
            );
        }
        if decl.is_generic(slot) || decl.is_head(slot) {
            checked.push(Some((not_called(decl, slot), Uses::default())), 0);
            continue;
        }
        checked.check(decl, slot, body, keep);
        if keep == Bodies::Dropped {
            body.clear();
        }
    }
    let mut slot = bodies.len();
    while slot < decl.pous.len() {
        checked.check_asked_for(decl, slot, bodies, keep);
        slot += 1;
    }
    let is_uncalled = |it: &usize| decl.is_generic(*it) && !decl.has_instances(*it);
    let uncalled: Vec<_> =
        (0..bodies.len()).filter(|it| is_uncalled(it) && is_asked_for(decl, *it, &bodies[*it])).collect();
    uncalled.into_iter().for_each(|it| check_uncalled(decl, it, bodies));
    if let Some(index) = &decl.log.index {
        index.mute(false);
    }
    checked
}

/// Whether an editor needs a body: it asks about a place in it, or about all of the program. It needs none whose answer it does not
/// wait for any more.
fn is_asked_for(decl: &Declarations<'_>, slot: usize, body: &[ast::Statement<'_>]) -> bool {
    let Some(index) = &decl.log.index else { return true };
    if index.stop.is_set() {
        return false;
    }
    let Some((file, at)) = index.around else { return true };
    let holds = |it: Span| it.file == file && it.start <= at && at <= it.end;
    let pou = decl.pous[slot].ast;
    if pou.name.text.starts_with("__") {
        // It is written out, of initial values perhaps.
        return true;
    }
    // The parts of a test are written elsewhere, as are those of a PROGRAM of Automation Studio.
    let mut variables = pou.blocks.iter().flat_map(|it| &it.vars);
    holds(pou.extent) || body.iter().any(|it| holds(it.span)) || variables.any(|it| holds(it.span))
}

impl Checked {
    fn check<'s>(&mut self, decl: &mut Declarations<'s>, slot: usize, body: &[ast::Statement<'s>], keep: Bodies) {
        let mut made = check_body(decl, slot, body, &mut self.left_out);
        let stack = made.as_ref().map_or(0, |(routine, _)| stack::of_body(routine, &|ty| decl.size_at_most(ty)));
        if let Some((routine, _)) = &made {
            decl.keep_touched(slot, routine);
        }
        if keep == Bodies::Dropped {
            made.iter_mut()
                .for_each(|(routine, _)| routine.body = rest(&decl.program, std::mem::take(&mut routine.body)));
        }
        self.push(made, stack);
    }

    /// An instance of a generic FUNCTION, or what chooses by a class, which is made already.
    fn check_asked_for<'s>(
        &mut self,
        decl: &mut Declarations<'s>,
        slot: usize,
        bodies: &[Vec<ast::Statement<'s>>],
        keep: Bodies,
    ) {
        if let Some(routine) = decl.pous[slot].dispatch.as_deref().cloned() {
            let stack = stack::of_body(&routine, &|ty| decl.size_at_most(ty));
            decl.keep_touched(slot, &routine);
            return self.push(Some((routine, Uses::default())), stack);
        }
        let reported = decl.log.diagnostics.len();
        if let Some(of) = decl.pous[slot].instance.as_ref().map(|it| it.of) {
            self.check(decl, slot, &bodies[of], keep);
            decl.say_of_instance(slot, reported);
        }
    }

    fn push(&mut self, made: Option<(Routine, Uses)>, stack: u64) {
        self.routines.push(made);
        self.stacks.push(stack);
    }
}

/// Takes the place of what is not called itself: a generic FUNCTION as it is written, whose instances are, and
/// what is in an INTERFACE.
fn not_called(decl: &mut Declarations<'_>, slot: usize) -> Routine {
    let pou = decl.pous[slot].ast;
    Routine {
        kind: RoutineKind::Function,
        name: decl.emitted_name(slot),
        doc: None,
        location: decl.location(pou.name.span),
        state: None,
        params: Vec::new(),
        locals: Vec::new(),
        result: None,
        body: Block::new(),
    }
}

/// A generic FUNCTION that nothing calls: its names have to mean something, whatever its types are.
fn check_uncalled<'s>(decl: &mut Declarations<'s>, slot: usize, bodies: &[Vec<ast::Statement<'s>>]) {
    let (reported, known) = (decl.log.diagnostics.len(), decl.pous.len());
    check_body(decl, slot, &bodies[slot], &mut None);
    let mut at = known;
    while at < decl.pous.len() {
        if let Some(of) = decl.pous[at].instance.as_ref().map(|it| it.of) {
            check_body(decl, at, &bodies[of], &mut None);
        }
        at += 1;
    }
    decl.forget_instances(known);
    let is_unsure = decl.log.has_errors_since(reported);
    if let (true, Some(signature)) = (is_unsure, decl.signature(slot)) {
        signature.scope.variables.iter().for_each(|it| it.used.set(true));
    }
    decl.say_of_generic(reported, |it| is_about_names(it.code));
}

/// Whether an error is one with all types.
fn is_about_names(code: Code) -> bool {
    matches!(code, Code::E0101 | Code::E0108 | Code::E0301 | Code::E0304 | Code::E0305 | Code::E0307 | Code::E0310)
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
    let is_generic = decl.is_generic(slot) || decl.pous[slot].instance.is_some();
    if let Some(index) = &decl.log.index {
        // The copy of an inherited routine means what the base's own does.
        let class = decl.pous[slot].owner.map(|it| decl.pous[it].ast.name.span);
        index.mute(pou.home.is_some_and(|it| Some(it.span) != class));
    }
    let mut checker = Checker::of_body(decl, slot, &signature);
    checker.instance = is_generic.then_some(slot);
    checker.is_covered = checker.decl.is_covered(slot) && !checker.is_suite();
    checker.has_stops = checker.decl.has_stops(slot);
    checker.initial_outputs(&signature);
    if pou.kind != ast::PouKind::Action {
        checker.own_enable(&signature, (pou.kind, pou.name.span), statements);
    }
    checker.edge_inputs(&signature, pou.name.span);
    checker.mocked_result(slot, pou.name.span);
    checker.start_locals(&signature);
    checker.reset_always(slot, statements);
    let mut body = match pou.external {
        Some(_) => {
            checker.external_body(slot, &signature, statements);
            Block::new()
        }
        None => checker.block_of(statements),
    };
    let options = checker.decl.log.options;
    if pou.is_stub && (options.tests || options.is_tested) {
        body.append(&mut checker.not_there(pou.name.span));
    }
    checker.migration_lints(statements);
    let mut whole = std::mem::take(&mut checker.block);
    if whole.is_empty() {
        whole = body;
    } else {
        whole.append(&mut body);
    }
    let uses = checker.finish_uses();
    *left_out = left_out.or(checker.left_out);
    let locals = std::mem::take(&mut checker.locals);
    let location = decl.location(pou.name.span);
    let kind = match pou.kind {
        ast::PouKind::Function => RoutineKind::Function,
        ast::PouKind::Action | ast::PouKind::Method | ast::PouKind::Getter | ast::PouKind::Setter => {
            RoutineKind::Method
        }
        ast::PouKind::Program
        | ast::PouKind::FunctionBlock
        | ast::PouKind::Class
        | ast::PouKind::Interface
        | ast::PouKind::Test => RoutineKind::Body,
    };
    let body = Routine {
        kind,
        name: decl.emitted_name(slot),
        doc: decl.doc_of(slot),
        location,
        state: signature.state,
        params: signature.params.clone(),
        locals,
        result: signature.result.as_ref().map(|(id, _)| *id),
        body: whole,
    };
    Some((body, uses))
}
