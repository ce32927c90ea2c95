//! Which global variables the instances of a program use, themselves or through what they call: those
//! that a trace shows.

use crate::{FieldId, Place, Program, Projection, Root, RoutineId, Section, Statement, StatementKind, visit};
use std::collections::BTreeSet;

/// The fields of the globals that a routine which runs reads, writes or hands on.
pub fn used_globals(program: &Program) -> BTreeSet<FieldId> {
    let mut finder = Finder { program, seen: vec![false; program.routines.len()], used: BTreeSet::new() };
    for instance in &program.instances {
        let class = program.class(instance.program);
        finder.routine(class.body);
        class.prescan.into_iter().chain(class.start).for_each(|it| finder.routine(it));
    }
    finder.used
}

struct Finder<'a> {
    program: &'a Program,
    seen: Vec<bool>,
    used: BTreeSet<FieldId>,
}

impl Finder<'_> {
    fn routine(&mut self, id: RoutineId) {
        if !std::mem::replace(&mut self.seen[id.index()], true) {
            visit::statements(&self.program.routine(id).body, &mut |it| self.statement(it));
        }
    }

    fn statement(&mut self, statement: &Statement) {
        visit::accesses(statement, &mut |place, _| self.place(place));
        if let StatementKind::Call { callee, .. } = &statement.kind {
            self.routine(*callee);
        }
    }

    fn place(&mut self, place: &Place) {
        if let (Root::Globals, Some(Projection::Field(id))) = (place.root, place.projections.first())
            // What lives for one call is nobody's to look at, also where it has fixed storage.
            && self.program.structure(self.program.globals).fields[id.index()].section != Section::Temp
        {
            self.used.insert(*id);
        }
    }
}
