//! The order of routines: a callee before its callers. Recursion ends here.

use crate::expr::uses::Uses;
use crate::types::declarations::Declarations;
use crate::{Code, Diagnostic};
use rustc_hash::FxHashSet;
use staunch_ir::stack;
use staunch_ir::{Block, Routine, RoutineId, RoutineKind, Statement, StatementKind};

/// Bytes of the stack that one chain of calls may take.
const MAX_STACK: u64 = 1 << 20;

/// Sorts the program's POUs. `None` when there is recursion, which has been reported.
pub(super) fn order(declarations: &mut Declarations<'_>, uses: Vec<Uses>, stacks: Vec<u64>) -> Option<()> {
    let mut calls = all_callees(declarations);
    let mut order = sorted(declarations, &calls)?;
    if !declarations.log.has_errors() && super::prescan::add(declarations, uses, &order) {
        // A prescan calls those of contained instances.
        calls = all_callees(declarations);
        order = sorted(declarations, &calls)?;
    }
    let is_empty = |it: &Routine| it.kind == RoutineKind::Prescan && it.body.is_empty();
    // What starts nothing is called where a mistake has left its statements out.
    let called: FxHashSet<usize> = order.iter().flat_map(|it| &calls[*it]).copied().collect();
    let is_called = |at: usize| {
        let may_be_idle = || declarations.starts_nothing(at) || declarations.pous[at].dispatch.is_some();
        let is_idle = || may_be_idle() && !called.contains(&at);
        at >= declarations.pous.len()
            || !declarations.is_generic(at)
                && !declarations.is_head(at)
                && !declarations.is_run_of_named_program(at)
                && !is_idle()
    };
    order.retain(|at| !is_empty(&declarations.program.routines[*at]) && is_called(*at));
    check_stack(declarations, stacks, &calls, &order);
    renumber(declarations, &order);
    Some(())
}

pub(super) fn all_callees(declarations: &mut Declarations<'_>) -> Vec<Vec<usize>> {
    declarations.program.routines.iter_mut().map(callees).collect()
}

/// The slots of the POUs, a callee before its callers.
fn sorted(declarations: &mut Declarations<'_>, calls: &[Vec<usize>]) -> Option<Vec<usize>> {
    let (mut order, mut cycles) = (Vec::new(), Cycles::default());
    let mut marks = vec![Mark::New; calls.len()];
    for at in 0..calls.len() {
        visit(at, calls, &mut marks, &mut order, &mut cycles);
    }
    cycles.found.iter().for_each(|it| report_recursion(declarations, it));
    cycles.found.is_empty().then_some(order)
}

/// Cycles of calls. Of those that share a routine, one says enough.
#[derive(Default)]
struct Cycles {
    found: Vec<Vec<usize>>,
    routines: FxHashSet<usize>,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Mark {
    New,
    Open,
    Closed,
}

/// Depth-first with its own stack: a chain of calls may be long. The cycles are those that close on the way.
fn visit(start: usize, calls: &[Vec<usize>], marks: &mut [Mark], order: &mut Vec<usize>, cycles: &mut Cycles) {
    if marks[start] != Mark::New {
        return;
    }
    marks[start] = Mark::Open;
    let mut stack = vec![(start, 0)];
    while let Some((at, next)) = stack.last_mut() {
        let Some(callee) = calls[*at].get(*next).copied() else {
            marks[*at] = Mark::Closed;
            order.push(*at);
            stack.pop();
            continue;
        };
        let at = *at;
        *next += 1;
        match marks[callee] {
            Mark::Closed => {}
            Mark::New => {
                marks[callee] = Mark::Open;
                stack.push((callee, 0));
            }
            // Seen at once: a long cycle that many routines close is not gone through for each.
            Mark::Open if cycles.routines.contains(&at) || cycles.routines.contains(&callee) => {}
            Mark::Open => {
                let first = stack.iter().position(|(at, _)| *at == callee).unwrap_or(0);
                let cycle: Vec<usize> = stack[first..].iter().map(|(at, _)| *at).collect();
                if cycle.iter().all(|it| !cycles.routines.contains(it)) {
                    cycles.routines.extend(&cycle);
                    cycles.found.push(cycle);
                }
            }
        }
    }
}

fn report_recursion(declarations: &mut Declarations<'_>, cycle: &[usize]) {
    // A routine that chooses by class is not in the source: the chain of calls continues in it.
    let slots = cycle.iter().map(|at| slot(declarations, *at));
    let slots: Vec<_> = slots.filter(|it| declarations.pous[*it].dispatch.is_none()).collect();
    let first = declarations.pous[slots[0]].ast.name;
    let way: Vec<_> = slots.iter().chain(&slots[..1]).map(|it| declarations.title(*it)).collect();
    declarations.report(
        Diagnostic::new(Code::E0310, first.span, format!("`{}` calls itself", way[0]))
            .label("recursion could need an unlimited amount of stack")
            .note(format!("the chain of calls is {}", way.join(" -> ")))
            .help("write it as a loop"),
    );
}

/// Variables that live for one call are on the stack, and the strings that it makes; a long chain of large
/// ones is refused.
fn check_stack(declarations: &mut Declarations<'_>, mut stacks: Vec<u64>, calls: &[Vec<usize>], order: &[usize]) {
    let mut depth = vec![0u64; calls.len()];
    let prescans = declarations.program.routines.iter().skip(stacks.len());
    let prescans: Vec<u64> = prescans.map(|it| stack::of_body(it, &|ty| declarations.size_at_most(ty))).collect();
    stacks.extend(prescans);
    for at in order.iter().copied() {
        let program = &declarations.program;
        let (routine, size) = (&program.routines[at], |ty| declarations.size_at_most(ty));
        let own = stacks[at].saturating_add(stack::of_ignored_results(program, routine, &size));
        let below = calls[at].iter().map(|callee| depth[*callee]).max().unwrap_or(0);
        depth[at] = own.saturating_add(below);
        if depth[at] > MAX_STACK && below <= MAX_STACK {
            let name = declarations.pous[slot(declarations, at)].ast.name;
            declarations.report(
                Diagnostic::new(
                    Code::E0903,
                    name.span,
                    format!("a call of `{}` takes {own} bytes of the stack", name.text),
                )
                .label("for temporary variables and strings; at most 1 MiB is allowed, including the calls that it makes")
                .help("move large arrays to VAR of a FUNCTION_BLOCK or PROGRAM, or to VAR_GLOBAL; split expressions of long strings"),
            );
        }
    }
}

/// The slot of a routine: a body has its number, a prescan follows after all bodies.
fn slot(declarations: &Declarations<'_>, routine: usize) -> usize {
    routine % declarations.pous.len()
}

fn renumber(declarations: &mut Declarations<'_>, order: &[usize]) {
    let slots = declarations.pous.len();
    let bodies = declarations.program.classes.iter().map(|it| it.body.index());
    let starts: Vec<_> = bodies.map(|it| declarations.start_of_program(it)).collect();
    let program = &mut declarations.program;
    let mut new = vec![None; program.routines.len()];
    for (position, at) in order.iter().enumerate() {
        new[*at] = Some(RoutineId::next(position));
    }
    let mut routines: Vec<_> = std::mem::take(&mut program.routines).into_iter().map(Some).collect();
    program.routines = order.iter().filter_map(|at| routines[*at].take()).collect();
    let renamed = |id: RoutineId| new[id.index()].expect("what is called is not empty");
    for routine in &mut program.routines {
        each_call(&mut routine.body, &mut |id| *id = renamed(*id));
    }
    for (class, start) in program.classes.iter_mut().zip(starts) {
        class.start = start.and_then(|it| new[it]);
        class.prescan = new.get(slots + class.body.index()).copied().flatten();
        class.body = renamed(class.body);
    }
}

fn callees(routine: &mut Routine) -> Vec<usize> {
    let mut found = Vec::new();
    each_call(&mut routine.body, &mut |id| found.push(id.index()));
    found.sort_unstable();
    found.dedup();
    found
}

/// Calls `visit` with the id of every routine that the block calls.
fn each_call(block: &mut Block, visit: &mut dyn FnMut(&mut RoutineId)) {
    for Statement { kind, .. } in block {
        if let StatementKind::Call { callee, .. } = kind {
            visit(callee);
        }
        kind.blocks_mut().into_iter().for_each(|inner| each_call(inner, visit));
    }
}
