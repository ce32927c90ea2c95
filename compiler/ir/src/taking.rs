//! When loops take their turns. A loop whose number of turns is known when it starts, and which nothing ends early, takes
//! them at once; where a loop without a loop in it has few, it takes none.

use crate::alias::Frame;
use crate::loops::privatise;
use crate::reference;
use crate::turns::linear;
use crate::{Block, Count, For, Location, Program, Statement, StatementKind, Taking, visit};

/// Settles it for all loops of a program, and to which variables references lead. What changes loops, and what takes
/// addresses, comes before it.
pub fn settle(program: &mut Program) {
    program.reached = Some(reference::reach(program));
    if !program.references.is_empty() {
        settle_counters(program);
    }
    let loopers = loopers(program);
    for at in 0..program.routines.len() {
        let mut body = std::mem::take(&mut program.routines[at].body);
        let settler = Settler { frame: Frame::of(program, &program.routines[at]), loopers: &loopers };
        settler.block(&mut body);
        program.routines[at].body = body;
    }
}

/// Counters to which no reference leads may be private after all.
fn settle_counters(program: &mut Program) {
    for at in 0..program.routines.len() {
        let mut body = std::mem::take(&mut program.routines[at].body);
        privatise(&Frame::of(program, &program.routines[at]), &mut body);
        leave_turns(&mut body);
        program.routines[at].body = body;
    }
}

/// Loops that are short, now that their counters are private, take no turns.
fn leave_turns(block: &mut [Statement]) {
    for statement in block {
        statement.kind.blocks_mut().into_iter().for_each(|it| leave_turns(it));
        if let StatementKind::For(it) = &mut statement.kind
            && it.takes_turns()
            && it.is_short()
        {
            it.body.remove(0);
        }
    }
}

/// Which routines have loops, themselves or by what they call.
pub(crate) fn loopers(program: &Program) -> Vec<bool> {
    let mut loopers = vec![false; program.routines.len()];
    loop {
        let before = loopers.clone();
        for (at, routine) in program.routines.iter().enumerate() {
            loopers[at] = loopers[at] || has_loops(&routine.body, &loopers);
        }
        if loopers == before {
            return loopers;
        }
    }
}

/// Whether a loop is in a block, or in what it calls.
pub(crate) fn has_loops(block: &[Statement], loopers: &[bool]) -> bool {
    let mut found = false;
    visit::statements(block, &mut |it| {
        found |= match &it.kind {
            StatementKind::Loop { .. } | StatementKind::For(_) => true,
            StatementKind::Call { callee, .. } => loopers.get(callee.index()) == Some(&true),
            _ => false,
        };
    });
    found
}

struct Settler<'p> {
    frame: Frame<'p>,
    loopers: &'p [bool],
}

impl Settler<'_> {
    fn block(&self, block: &mut Block) {
        for statement in block {
            statement.kind.blocks_mut().into_iter().for_each(|it| self.block(it));
            if let StatementKind::For(it) = &mut statement.kind {
                self.for_loop(it);
            } else if let StatementKind::Loop { body, continuing, count } = &mut statement.kind
                && continuing.is_empty()
            {
                *count = self.while_loop(body).map(Box::new);
            }
        }
    }

    fn for_loop(&self, it: &mut For) {
        let Some((turn, rest)) = it.body.split_first() else { return };
        if !it.is_private || !matches!(turn.kind, StatementKind::Turn) {
            return;
        }
        it.taking = self.taking(&[], rest, false, turn.at);
        if it.taking.is_ahead() {
            it.body.remove(0);
        }
    }

    fn while_loop(&self, body: &mut Block) -> Option<Count> {
        let it = linear(&self.frame, body)?;
        let (turn, rest) = it.rest.split_first().filter(|it| matches!(it.0.kind, StatementKind::Turn))?;
        let taking = self.taking(it.test, rest, it.has_others, turn.at);
        let count =
            Count { counter: it.counter.clone(), step: it.step, bound: it.bound.clone(), offset: it.offset, taking };
        let at = it.test.len();
        if taking.is_ahead() {
            body.remove(at);
        }
        (taking != Taking::Each).then_some(count)
    }

    fn taking(&self, test: &[Statement], rest: &[Statement], has_others: bool, at: Location) -> Taking {
        let is_innermost = ![test, rest].iter().any(|it| has_loops(it, self.loopers));
        match (has_others || ends_early(rest), is_innermost) {
            (false, false) => Taking::Ahead(at),
            (false, true) => Taking::AheadOfMany(at),
            (true, false) => Taking::Each,
            (true, true) => Taking::EachOfMany,
        }
    }
}

/// Whether an EXIT or a RETURN may end a loop with this body.
pub(crate) fn ends_early(body: &[Statement]) -> bool {
    let mut returns = false;
    visit::statements(body, &mut |it| returns |= matches!(it.kind, StatementKind::Return));
    returns || exits(body)
}

fn exits(block: &[Statement]) -> bool {
    block.iter().any(|statement| {
        let is_inner = matches!(statement.kind, StatementKind::Loop { .. } | StatementKind::For(_));
        let within = || statement.kind.blocks().into_iter().any(|it| exits(it));
        matches!(statement.kind, StatementKind::Exit) || !is_inner && within()
    })
}
