//! Where a function declares its locals: at their first assignment where Rust's scopes allow,
//! else at the top with their initial value.

use std::collections::HashMap;

use staunch_ir::{Block, LocalId, Place, Root, Routine, Statement, StatementKind};

use crate::names::by_value_param;
use staunch_ir::visit::{self, Access};

/// How a local is declared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Declaration {
    /// Nothing mentions it.
    Absent,
    /// It is a parameter.
    Param,
    /// At the top, with its initial value.
    Top,
    /// By the statement that first assigns it.
    AtAssignment,
}

/// The declarations of a POU's locals.
#[derive(Debug)]
pub struct Plan {
    pub locals: Vec<Declared>,
}

#[derive(Clone, Copy, Debug)]
pub struct Declared {
    pub how: Declaration,
    /// `let mut`.
    pub mutable: bool,
    /// How often it is mentioned.
    pub mentions: usize,
    /// The statement that declares it.
    first: *const Statement,
}

impl Plan {
    /// The local that `statement` declares when it assigns `target`.
    pub fn declares(&self, statement: &Statement, target: &Place) -> Option<LocalId> {
        let Root::Local(id) = target.root else { return None };
        let declared = self.locals[id.index()];
        let here = declared.how == Declaration::AtAssignment && core::ptr::eq(declared.first, statement);
        here.then_some(id)
    }
}

/// Position of a statement: statement, block in it, statement in that, and so on.
type Path = Vec<usize>;

#[derive(Debug)]
struct Mentions {
    first: Path,
    first_statement: *const Statement,
    first_is_write: bool,
    /// The block that holds all mentions.
    common: Path,
    changes: usize,
    count: usize,
}

pub fn plan(routine: &Routine, body: &Block) -> Plan {
    let mut found = HashMap::new();
    note_block(body, &mut Vec::new(), &mut found);
    let mut returns = false;
    visit::statements(body, &mut |it| returns |= matches!(it.kind, StatementKind::Return));
    let locals = (0..routine.locals.len()).map(|at| declare(routine, LocalId::next(at), &found, returns)).collect();
    Plan { locals }
}

fn declare(routine: &Routine, id: LocalId, found: &HashMap<LocalId, Mentions>, returns: bool) -> Declared {
    let none = Declared { how: Declaration::Absent, mutable: false, mentions: 0, first: core::ptr::null() };
    let mentions = found.get(&id);
    let changes = mentions.map_or(0, |it| it.changes);
    let count = mentions.map_or(0, |it| it.count);
    if by_value_param(routine, id).is_some() {
        return Declared { how: Declaration::Param, mutable: changes > 0, mentions: count, ..none };
    }
    // A result is read where the function ends.
    let is_result = routine.result == Some(id);
    let Some(mentions) = mentions else {
        let how = if is_result { Declaration::Top } else { Declaration::Absent };
        return Declared { how, ..none };
    };
    let direct = mentions.first_is_write && mentions.first.len() == mentions.common.len() + 1;
    // A RETURN reads the result, too.
    let outermost = mentions.common.is_empty() && !returns;
    if direct && (!is_result || outermost) {
        let first = mentions.first_statement;
        return Declared { how: Declaration::AtAssignment, mutable: changes > 1, mentions: count, first };
    }
    Declared { how: Declaration::Top, mutable: changes > 0, mentions: count, ..none }
}

fn note_block(block: &Block, path: &mut Path, found: &mut HashMap<LocalId, Mentions>) {
    for (at, statement) in block.iter().enumerate() {
        path.push(at);
        visit::accesses(statement, &mut |place, access| {
            // The target of a reference is not the variable that holds it.
            if let Root::Local(id) = place.root
                && !place.is_followed()
            {
                let whole = access == Access::Write && place.projections.is_empty();
                note(found, id, path, statement, access, whole);
            }
        });
        for (number, inner) in statement.kind.blocks().into_iter().enumerate() {
            path.push(number);
            note_block(inner, path, found);
            path.pop();
        }
        path.pop();
    }
}

fn note(
    found: &mut HashMap<LocalId, Mentions>,
    id: LocalId,
    path: &Path,
    statement: &Statement,
    access: Access,
    whole: bool,
) {
    let mentions = found.entry(id).or_insert_with(|| Mentions {
        first: path.clone(),
        first_statement: statement,
        first_is_write: whole,
        common: path[..path.len() - 1].to_vec(),
        changes: 0,
        count: 0,
    });
    let shared = mentions.common.iter().zip(path).take_while(|(a, b)| a == b).count();
    // A block's path has a statement and a block number for each level.
    mentions.common.truncate(shared.min(path.len() - 1) / 2 * 2);
    mentions.changes += usize::from(access != Access::Read);
    mentions.count += 1;
}
