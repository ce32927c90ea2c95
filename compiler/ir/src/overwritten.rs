//! The variables that each scan gives a new value before anything reads them: what a host writes there is lost. Only those
//! that are certain to be.

use crate::effects::{Effects, Rules, Variables, effects};
use crate::layout::Layout;
use crate::visit::{self, Access};
use crate::{FieldId, Location, Place, Program, Projection, Root, Routine, Statement, StatementKind, StructId};

/// Bytes of the state, and the statement that overwrites them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Overwritten {
    pub offset: u64,
    pub size: u64,
    pub at: Location,
}

/// Those of the programs that run. In a program with references any variable may be read by one of them, so that nothing is
/// certain there.
pub fn overwritten(program: &Program) -> Vec<Overwritten> {
    if !program.references.is_empty() {
        return Vec::new();
    }
    let (layout, known) = (Layout::new(program), effects(program, &Rules::PLAIN));
    let mut all = Vec::new();
    for (number, instance) in program.instances.iter().enumerate() {
        let class = program.class(instance.program);
        let body = program.routine(class.body);
        let mut finder = Finder { known: &known, touched: Touched::default(), found: Vec::new() };
        for id in class.prescan.into_iter().chain(class.start) {
            finder.touched.all_of(&known[id.index()]);
        }
        finder.body(body);
        // What another program reads, it may read before this one runs.
        let is_private = |field| {
            let others = program.instances.iter().enumerate().filter(|(other, _)| *other != number);
            let mut bodies = others.map(|(_, it)| program.class(it.program).body);
            !bodies.any(|it| known[it.index()].names.has_global(field))
        };
        all.extend(finder.found.into_iter().filter_map(|(root, field, at)| {
            let (structure, start) = match root {
                Root::Instance => (class.state, layout.machine.instances[number]),
                Root::Globals if is_private(field) => (program.globals, layout.machine.globals),
                Root::Globals | Root::Local(_) | Root::Param(_) => return None,
            };
            Some(bytes(program, &layout, structure, (start, field), at))
        }));
    }
    all
}

fn bytes(
    program: &Program,
    layout: &Layout,
    structure: StructId,
    (start, field): (u64, FieldId),
    at: Location,
) -> Overwritten {
    let ty = program.structure(structure).fields[field.index()].ty;
    Overwritten { offset: start + layout.field(structure, field), size: layout.size(ty), at }
}

/// What may have been read or written so far.
#[derive(Default)]
struct Touched {
    places: Vec<(Root, Option<FieldId>)>,
    callees: Vec<Variables>,
}

impl Touched {
    fn has(&self, place: &Place) -> bool {
        let (root, field) = key(place);
        let is_it = |it: &(Root, Option<FieldId>)| it.0 == root && (it.1.is_none() || it.1 == field);
        self.places.iter().any(is_it) || self.callees.iter().any(|it| it.holds(place))
    }

    /// All that a routine of the same state uses.
    fn all_of(&mut self, effects: &Effects) {
        self.callees.push(effects.names.clone());
    }
}

fn key(place: &Place) -> (Root, Option<FieldId>) {
    match place.projections.first() {
        Some(Projection::Field(field)) => (place.root, Some(*field)),
        Some(Projection::Index { .. } | Projection::Deref { .. }) | None => (place.root, None),
    }
}

struct Finder<'p> {
    known: &'p [Effects],
    touched: Touched,
    found: Vec<(Root, FieldId, Location)>,
}

impl Finder<'_> {
    /// The statements that always run, up to the first that may leave the routine.
    fn body(&mut self, body: &Routine) {
        for statement in &body.body {
            if let StatementKind::Assign { target, value } = &statement.kind {
                visit::reads(value, &mut |it| self.touched.places.push(key(it)));
                if let (root, Some(field), true) = (target.root, key(target).1, target.projections.len() == 1)
                    && !self.touched.has(target)
                {
                    self.found.push((root, field, statement.at));
                }
            }
            let mut leaves = false;
            visit::statements(std::slice::from_ref(statement), &mut |it| {
                self.touch(it);
                leaves |= matches!(it.kind, StatementKind::Return | StatementKind::Fault(_));
            });
            if leaves {
                return;
            }
        }
    }

    fn touch(&mut self, statement: &Statement) {
        visit::accesses(statement, &mut |place, _: Access| self.touched.places.push(key(place)));
        if let StatementKind::Call { callee, .. } = &statement.kind {
            // The globals, and the state of an instance that is this one's own: that of another is among the accesses.
            self.touched.all_of(&self.known[callee.index()]);
        }
    }
}
