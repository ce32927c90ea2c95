//! Whose addresses a program takes.

use crate::reached::Reached;
use crate::{
    Argument, ExprKind, FieldId, LocalId, ParamId, Place, Program, Projection, Root, Routine, RoutineId, StatementKind,
    StructId, Type, visit,
};
use std::collections::BTreeSet;

/// The variables whose addresses are taken: fields of the globals and of states.
pub fn addressable(program: &Program) -> BTreeSet<(StructId, FieldId)> {
    let found = Finder::search(program);
    found.variables
}

/// The variables that references may lead to.
pub fn reach(program: &Program) -> Reached {
    let found = Finder::search(program);
    Reached::by(program, found.variables, &|it| found.states.contains(&it))
}

/// The variables that references may lead into: those that they may lead to, and those that hold an instance with one.
pub fn reached(program: &Program) -> BTreeSet<(StructId, FieldId)> {
    reach(program).with_holders(program)
}

/// For each routine, the locals whose addresses are taken, by it or by what it passes them to.
pub(crate) fn addressed_locals(program: &Program) -> Vec<BTreeSet<LocalId>> {
    Finder::search(program).locals
}

struct Finder<'p> {
    program: &'p Program,
    states: BTreeSet<StructId>,
    variables: BTreeSet<(StructId, FieldId)>,
    locals: Vec<BTreeSet<LocalId>>,
    /// The by-reference parameters whose addresses are taken.
    params: BTreeSet<(RoutineId, ParamId)>,
    /// The states of instances whose own routines take their addresses.
    whole: BTreeSet<StructId>,
}

impl<'p> Finder<'p> {
    /// A callee is before its callers, so that one walk finds what is passed down.
    fn search(program: &'p Program) -> Self {
        let states = program.classes.iter().map(|it| it.state).chain([program.globals]);
        let states = states.chain(program.places.iter().copied()).collect();
        let locals = vec![BTreeSet::new(); program.routines.len()];
        let mut finder = Self {
            program,
            states,
            variables: BTreeSet::new(),
            locals,
            params: BTreeSet::new(),
            whole: BTreeSet::new(),
        };
        if !program.references.is_empty() {
            for id in 0..program.routines.len() {
                finder.routine(RoutineId::next(id));
            }
            finder.instances();
        }
        finder
    }

    /// The variables that hold instances whose routines take addresses: of the instance, or of what it has.
    fn instances(&mut self) {
        for state in self.states.clone() {
            let fields = &self.program.structure(state).fields;
            let holders = (0..fields.len()).filter(|at| self.holds_whole(fields[*at].ty));
            let holders: Vec<_> = holders.map(|at| (state, FieldId::next(at))).collect();
            self.variables.extend(holders);
        }
        let asked: BTreeSet<_> = self.whole.iter().copied().chain(self.variables.iter().map(|it| it.0)).collect();
        for (routine, found) in self.program.routines.iter().zip(&mut self.locals) {
            let holders = (0..routine.locals.len()).filter(|at| holds(self.program, routine.locals[*at].ty, &asked));
            found.extend(holders.map(LocalId::next));
        }
    }

    /// Whether a variable, but for the variables of instances in it, holds an instance whose address is taken.
    fn holds_whole(&self, ty: Type) -> bool {
        match ty {
            Type::Struct(id) if self.states.contains(&id) => self.whole.contains(&id),
            Type::Struct(id) => self.program.structure(id).fields.iter().any(|it| self.holds_whole(it.ty)),
            Type::Array(id) => self.holds_whole(self.program.array(id).element),
            Type::Elementary(_)
            | Type::Subrange(..)
            | Type::String(_)
            | Type::Enum(_)
            | Type::Block(_)
            | Type::Reference(_) => false,
        }
    }

    fn routine(&mut self, id: RoutineId) {
        let routine = self.program.routine(id);
        visit::statements(&routine.body, &mut |statement| {
            visit::all_exprs(statement, &mut |expr| {
                if let ExprKind::AddressOf(place) = &expr.kind {
                    self.place(id, routine, place);
                }
            });
            if let StatementKind::Call { callee, arguments, .. } = &statement.kind {
                for (at, argument) in arguments.iter().enumerate() {
                    match argument {
                        Argument::Reference(place) if self.params.contains(&(*callee, ParamId::next(at))) => {
                            self.place(id, routine, place);
                        }
                        Argument::Reference(_) | Argument::Value(_) => {}
                    }
                }
            }
        });
    }

    /// The innermost variable that holds the place. The target of a reference is known already.
    fn place(&mut self, id: RoutineId, routine: &Routine, place: &Place) {
        let Some(mut ty) = self.program.root_type(routine, place.root) else { return };
        let mut variable = None;
        for projection in &place.projections {
            match (projection, ty) {
                (Projection::Deref { .. }, _) => return,
                (Projection::Field(field), Type::Struct(owner)) if self.states.contains(&owner) => {
                    variable = Some((owner, *field));
                }
                (Projection::Field(_) | Projection::Index { .. }, _) => {}
            }
            match self.program.part(ty, projection) {
                Some(part) => ty = part,
                None => return,
            }
        }
        match (variable, place.root) {
            (Some(variable), _) => {
                self.variables.insert(variable);
            }
            (None, Root::Local(local)) => {
                self.locals[id.index()].insert(local);
            }
            (None, Root::Param(param)) => {
                self.params.insert((id, param));
            }
            (None, Root::Instance) => self.whole.extend(routine.state),
            (None, Root::Globals) => {}
        }
    }
}

/// Whether a variable of the type is, or holds, one of these structures.
fn holds(program: &Program, ty: Type, wanted: &BTreeSet<StructId>) -> bool {
    program.holds(ty, |it| matches!(it, Type::Struct(id) if wanted.contains(&id)))
}
