//! A routine without the variables of a call that nothing reads.

use staunch_ir::{Block, Expr, LocalId, Mode, Place, Root, Routine, StatementKind, visit};
use std::collections::HashMap;

/// The locals that nothing reads are left out, with what is assigned to them, and the others are numbered anew.
pub fn without_unread(routine: &Routine, mut body: Block) -> Routine {
    let always = kept(routine);
    loop {
        let mut read: Vec<bool> = (0..routine.locals.len()).map(|at| always.contains(&LocalId::next(at))).collect();
        visit::statements(&body, &mut |statement| {
            let target = match &statement.kind {
                StatementKind::Assign { target, .. } if target.projections.is_empty() => Some(target),
                _ => None,
            };
            visit::accesses(statement, &mut |place, _| {
                if let Root::Local(id) = place.root
                    && !target.is_some_and(|it| std::ptr::eq(it, place))
                {
                    read[id.index()] = true;
                }
            });
        });
        if !leave_out(&mut body, &read) {
            return numbered(routine, body, &read);
        }
    }
}

/// What a caller gives, and what it is given.
fn kept(routine: &Routine) -> Vec<LocalId> {
    let copied = |mode: Mode| match mode {
        Mode::Value(id) => Some(id),
        Mode::Reference => None,
    };
    let bounds = routine.params.iter().flat_map(|it| &it.bounds).flat_map(|it| [it.0, it.1]);
    routine.params.iter().filter_map(|it| copied(it.mode)).chain(bounds).chain(routine.result).collect()
}

/// Whether an assignment to what is not read was left out.
fn leave_out(block: &mut Block, read: &[bool]) -> bool {
    let before = block.len();
    block.retain(|it| match &it.kind {
        StatementKind::Assign { target: Place { root: Root::Local(id), .. }, .. } => read[id.index()],
        _ => true,
    });
    let mut found = block.len() != before;
    for statement in block {
        for inner in statement.kind.blocks_mut() {
            found |= leave_out(inner, read);
        }
    }
    found
}

fn numbered(routine: &Routine, mut body: Block, read: &[bool]) -> Routine {
    struct Numbers(HashMap<LocalId, LocalId>);
    impl visit::Rewrite for Numbers {
        fn expr(&mut self, _: &mut Expr) {}
        fn place(&mut self, place: &mut Place) {
            if let Root::Local(id) = &mut place.root {
                *id = self.0.get(id).copied().unwrap_or(*id);
            }
        }
    }
    let kept = (0..routine.locals.len()).filter(|at| read[*at]);
    let numbers = kept.clone().enumerate().map(|(new, old)| (LocalId::next(old), LocalId::next(new))).collect();
    let mut numbers = Numbers(numbers);
    visit::rewrite(&mut body, &mut numbers);
    let new = |it: LocalId| numbers.0.get(&it).copied().unwrap_or(it);
    let mut found = routine.clone();
    found.locals = kept.map(|at| routine.locals[at].clone()).collect();
    found.result = routine.result.map(new);
    for param in &mut found.params {
        if let Mode::Value(id) = &mut param.mode {
            *id = new(*id);
        }
        param.bounds.iter_mut().for_each(|it| *it = (new(it.0), new(it.1)));
    }
    found.body = body;
    found
}
