//! References: which variables' addresses a program takes, how a place leads through a reference, and the
//! table of objects by which every access is checked.

pub mod escape;
mod fixed;
mod objects;
mod table;
mod targets;

pub use fixed::fixed;
pub use objects::objects;
pub use table::{table, view, wanted};
pub use targets::{Step, Target, Targets};

use crate::reached::Reached;
use crate::{
    Argument, BlockId, Expr, ExprKind, FieldId, Location, ParamId, Place, Program, Projection, Root, Routine,
    RoutineId, StatementKind, StructId, Type, visit,
};
use std::collections::BTreeSet;

/// A place behind a reference, taken apart.
#[derive(Clone, Debug)]
pub struct Followed<'a> {
    /// The variable that holds the reference.
    pub pointer: Place,
    /// The type that it is declared to point to.
    pub target: Type,
    /// The way from there to what is looked at.
    pub way: &'a [Projection],
    /// The type of that.
    pub ty: Type,
    /// The pin that is meant, where a standard block is looked at.
    pub pin: Option<(BlockId, FieldId)>,
    /// Where the reference is followed.
    pub at: Location,
}

/// How a place leads through its last reference; `None` where it leads through none.
pub fn followed<'a>(program: &Program, place: &'a Place) -> Option<Followed<'a>> {
    let position = place.projections.iter().rposition(|it| matches!(it, Projection::Deref { .. }))?;
    let Projection::Deref { reference, target, at } = place.projections[position] else { return None };
    let pointer = place.before(position, reference);
    let way = &place.projections[position + 1..];
    let mut ty = target;
    for (length, projection) in way.iter().enumerate() {
        if let (Type::Block(block), Projection::Field(pin)) = (ty, projection) {
            return Some(Followed { pointer, target, way: &way[..length], ty, pin: Some((block, *pin)), at });
        }
        ty = program.part(ty, projection)?;
    }
    Some(Followed { pointer, target, way, ty: place.ty, pin: None, at })
}

impl Followed<'_> {
    /// How many steps of the way lead to an element of an array that is pointed to: what is there is looked up as
    /// what it is, since the array is most often declared larger than the variable.
    pub fn subscripts(&self) -> usize {
        let is_subscript = |it: &&Projection| matches!(it, Projection::Index { .. });
        self.way.iter().take_while(is_subscript).count()
    }

    /// The type of what is there.
    pub fn looked_up(&self, program: &Program) -> Option<Type> {
        self.way[..self.subscripts()].iter().try_fold(self.target, |ty, it| program.part(ty, it))
    }
}

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

/// The types of what references are followed to, each once.
pub fn looked_up(program: &Program) -> Vec<Type> {
    let mut found: Vec<Type> = Vec::new();
    let mut see = |place: &Place| {
        let mut pointer = None;
        while let Some(it) = followed(program, pointer.as_ref().unwrap_or(place)) {
            let is_known = |ty: &Type| found.iter().any(|it| wanted(program, *it) == wanted(program, *ty));
            found.extend(it.looked_up(program).filter(|it| !is_known(it)));
            let next = it.pointer;
            pointer = Some(next);
        }
    };
    for routine in &program.routines {
        visit::statements(&routine.body, &mut |statement| visit::accesses(statement, &mut |place, _| see(place)));
    }
    found
}

/// For each routine, the locals whose addresses are taken, by it or by what it passes them to.
pub(crate) fn addressed_locals(program: &Program) -> Vec<BTreeSet<crate::LocalId>> {
    Finder::search(program).locals
}

struct Finder<'p> {
    program: &'p Program,
    states: BTreeSet<StructId>,
    variables: BTreeSet<(StructId, FieldId)>,
    locals: Vec<BTreeSet<crate::LocalId>>,
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
            found.extend(holders.map(crate::LocalId::next));
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

    /// The innermost variable that holds the place. What lies behind a reference is known already.
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

/// Whether the expression is null, as a constant.
pub fn is_null(expr: &Expr) -> bool {
    matches!((&expr.kind, expr.ty), (ExprKind::Const(crate::Value::U64(0)), Type::Reference(_)))
}
