//! Chains of instances: METHODs that come back to a METHOD of their class by a reference, as those of decorators and trees
//! do. The instances of a program are known, so such a chain is no longer than these are many: each of its levels has a
//! copy of the routines, and recursion, the stack and the back ends know of no such thing. A chain that comes back to a
//! METHOD of an instance before that has ended would have no end; the copies do, by a fault.

use super::order::all_callees;
use crate::expr::uses::Uses;
use crate::types::declarations::{Declarations, PouSlot, Slot};
use rustc_hash::{FxHashMap, FxHashSet};
use staunch_ir::{Block, FaultKind, Program, Routine, RoutineId, RoutineKind, Statement, StatementKind, Type};

/// Copies of all routines together: more are reported as recursion.
const MAX_COPIES: u64 = 500;

/// Routines that call one another in circles, and how many levels of them there may be.
struct Group {
    routines: Vec<usize>,
    levels: u64,
}

/// Replaces recursion that goes by references through the instances of a program.
pub(super) fn unroll(declarations: &mut Declarations<'_>, uses: &mut Vec<Uses>, stacks: &mut Vec<u64>) {
    let calls = all_callees(declarations);
    let circles = circles(&calls);
    if circles.is_empty() {
        return;
    }
    let counts = instances(&declarations.program);
    for routines in circles {
        let Some(group) = bounded(&declarations.program, routines, &counts) else { continue };
        copy(declarations, &group);
        for _ in 1..group.levels {
            uses.extend(group.routines.iter().map(|_| Uses::default()));
            let own: Vec<_> = group.routines.iter().map(|at| stacks[*at]).collect();
            stacks.extend(own);
        }
    }
}

/// The sets of routines of which each calls all others, directly or through others.
fn circles(calls: &[Vec<usize>]) -> Vec<Vec<usize>> {
    let mut callers = vec![Vec::new(); calls.len()];
    for (at, callees) in calls.iter().enumerate() {
        callees.iter().for_each(|callee| callers[*callee].push(at));
    }
    let mut seen = vec![false; calls.len()];
    let mut finished = Vec::new();
    for start in 0..calls.len() {
        reach(start, calls, &mut seen, &mut finished);
    }
    let mut seen = vec![false; calls.len()];
    let mut found = Vec::new();
    for start in finished.into_iter().rev() {
        let mut circle = Vec::new();
        reach(start, &callers, &mut seen, &mut circle);
        if circle.len() > 1 || circle.iter().any(|at| calls[*at].contains(at)) {
            circle.sort_unstable();
            found.push(circle);
        }
    }
    found
}

/// Adds what is reached and was not seen before, each after what it reaches.
fn reach(start: usize, edges: &[Vec<usize>], seen: &mut [bool], finished: &mut Vec<usize>) {
    if std::mem::replace(&mut seen[start], true) {
        return;
    }
    let mut stack = vec![(start, 0)];
    while let Some((at, next)) = stack.last_mut() {
        let Some(to) = edges[*at].get(*next).copied() else {
            finished.push(*at);
            stack.pop();
            continue;
        };
        *next += 1;
        if !std::mem::replace(&mut seen[to], true) {
            stack.push((to, 0));
        }
    }
}

/// How many instances of each structure the program has.
fn instances(program: &Program) -> Vec<u64> {
    let mut counts = vec![0_u64; program.structs.len()];
    counts[program.globals.index()] = 1;
    for it in &program.instances {
        counts[program.class(it.program).state.index()] += 1;
    }
    with_parts(program, program.routines.iter(), counts)
}

/// `counts` with the locals of these routines, and with all that the structures contain.
fn with_parts<'p>(program: &Program, routines: impl Iterator<Item = &'p Routine>, mut counts: Vec<u64>) -> Vec<u64> {
    let locals = routines.flat_map(|it| &it.locals).map(|it| it.ty);
    locals.for_each(|ty| add(program, ty, 1, &mut counts));
    // A structure is after those that it contains.
    for at in (0..counts.len()).rev() {
        for field in &program.structs[at].fields {
            add(program, field.ty, counts[at], &mut counts);
        }
    }
    counts
}

fn add(program: &Program, ty: Type, times: u64, counts: &mut [u64]) {
    match ty {
        Type::Struct(id) => counts[id.index()] = counts[id.index()].saturating_add(times),
        Type::Array(id) => {
            let array = program.array(id);
            let length = array.high.abs_diff(array.low).saturating_add(1);
            add(program, array.element, times.saturating_mul(length), counts);
        }
        Type::Elementary(_)
        | Type::Subrange(..)
        | Type::Reference(_)
        | Type::String(_)
        | Type::Enum(_)
        | Type::Block(_) => {}
    }
}

/// The routines as a group, if each circle of them goes by a reference and the levels are not too many.
fn bounded(program: &Program, routines: Vec<usize>, counts: &[u64]) -> Option<Group> {
    let members: FxHashSet<usize> = routines.iter().copied().collect();
    let mut direct = vec![Vec::new(); program.routines.len()];
    let mut targets = FxHashSet::default();
    for at in &routines {
        each_call(&program.routines[*at].body, &mut |callee, by_reference| {
            if by_reference && members.contains(&callee) {
                targets.insert(callee);
            } else if members.contains(&callee) {
                direct[*at].push(callee);
            }
        });
    }
    if !circles(&direct).is_empty() {
        return None;
    }
    // Each level has locals of its own: the instances among them are as many as there are levels.
    let own = with_parts(program, routines.iter().map(|at| &program.routines[*at]), vec![0; counts.len()]);
    let state = |at: &usize| program.routines[*at].state.map(|it| it.index());
    if targets.iter().filter_map(state).any(|it| own[it] > 0) {
        return None;
    }
    let of = |at: &usize| state(at).map_or(0, |it| counts[it]);
    // A chain may begin with what no reference leads to.
    let first = u64::from(targets.len() < routines.len());
    let levels = targets.iter().map(of).fold(first, u64::saturating_add).max(1);
    let copies = levels.saturating_mul(u64::try_from(routines.len()).ok()?);
    (copies <= MAX_COPIES).then_some(Group { routines, levels })
}

/// Adds the copies, and lets each level call the next by its references.
fn copy(declarations: &mut Declarations<'_>, group: &Group) {
    let originals: Vec<Routine> = group.routines.iter().map(|at| declarations.program.routines[*at].clone()).collect();
    let slots = group.routines.iter().copied();
    let mut level: FxHashMap<usize, usize> = slots.clone().map(|at| (at, at)).collect();
    for number in 1..=group.levels {
        let first = declarations.pous.len();
        let next = (number < group.levels).then(|| slots.clone().zip(first..).collect::<FxHashMap<_, _>>());
        for (at, original) in slots.clone().zip(&originals) {
            let mut body = original.body.clone();
            lead(&mut body, &level, next.as_ref());
            declarations.program.routines[level[&at]].body = body;
        }
        let Some(next) = next else { return };
        for (at, original) in slots.clone().zip(&originals) {
            let name = declarations.own_name(format!("{}_{}", original.name, number + 1));
            // What an instance's body is, is called as one of its ACTIONs.
            let kind = match original.kind {
                RoutineKind::Body => RoutineKind::Method,
                kind @ (RoutineKind::Function | RoutineKind::Prescan | RoutineKind::Method) => kind,
            };
            let made = Routine { kind, name, body: Block::new(), ..original.clone() };
            let slot = PouSlot::open(declarations.pous[at].ast);
            declarations.pous.push(PouSlot { dispatch: Some(Box::new(made.clone())), slot: Slot::Failed, ..slot });
            declarations.program.routines.push(made);
        }
        level = next;
    }
}

/// Calls of the routines go to those of this level, by a reference to those of the next.
fn lead(block: &mut Block, level: &FxHashMap<usize, usize>, next: Option<&FxHashMap<usize, usize>>) {
    for statement in block.iter_mut() {
        if let StatementKind::Call { callee, instance, .. } = &mut statement.kind
            && let Some(same) = level.get(&callee.index())
        {
            let by_reference = instance.as_ref().is_some_and(|it| it.is_followed());
            match (by_reference, next) {
                (false, _) => *callee = RoutineId::next(*same),
                (true, Some(next)) => *callee = RoutineId::next(next[&callee.index()]),
                (true, None) => statement.kind = StatementKind::Fault(FaultKind::Recursion),
            }
        }
        statement.kind.blocks_mut().into_iter().for_each(|inner| lead(inner, level, next));
    }
    // Nothing is reached after the end of a chain.
    let is_end = |it: &Statement| matches!(it.kind, StatementKind::Fault(FaultKind::Recursion));
    if let Some(end) = block.iter().position(is_end) {
        block.truncate(end + 1);
    }
}

/// Calls `see` with each routine that the block calls, and whether a reference leads to the instance.
fn each_call(block: &Block, see: &mut dyn FnMut(usize, bool)) {
    for statement in block {
        if let StatementKind::Call { callee, instance, .. } = &statement.kind {
            see(callee.index(), instance.as_ref().is_some_and(|it| it.is_followed()));
        }
        statement.kind.blocks().into_iter().for_each(|inner| each_call(inner, see));
    }
}
