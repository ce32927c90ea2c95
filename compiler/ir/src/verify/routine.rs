//! The declarations of routines, and the instances that run.

use super::Verifier;
use crate::layout::Layout;
use crate::loops::constant_position;
use crate::{Class, ClassKind, Location, Mode, Projection, Routine, RoutineId, RoutineKind, Type, Variable};
use std::collections::BTreeSet;

impl Verifier<'_> {
    pub(super) fn routines(&mut self) {
        let program = self.program;
        self.classes();
        for routine in &program.routines {
            self.within.clone_from(&routine.name);
            self.location(routine.location);
            self.state(routine);
            self.locals(routine);
            self.params(routine);
            self.result(routine);
        }
        self.instances();
        self.within = "machine".to_owned();
        if self.violations.is_empty()
            && let Err(error) = Layout::try_new(program)
        {
            self.report(error.at.unwrap_or_default(), "the program is larger than the limit");
        }
    }

    fn classes(&mut self) {
        let mut states = BTreeSet::from([self.program.globals]);
        for class in &self.program.classes {
            self.within.clone_from(&class.name);
            self.location(class.location);
            let at = class.location;
            if self.require(class.state.index() < self.program.structs.len(), at, "no such state") {
                self.require(states.insert(class.state), at, "its state belongs to another as well");
            }
            self.member(class, class.body, RoutineKind::Body);
            if let Some(prescan) = class.prescan {
                self.member(class, prescan, RoutineKind::Prescan);
            }
            if let Some(start) = class.start {
                self.member(class, start, RoutineKind::Method);
            }
        }
    }

    /// A routine of a class works on its state, in the way that the class says.
    fn member(&mut self, class: &Class, id: RoutineId, kind: RoutineKind) {
        let routine = self.program.routines.get(id.index());
        let fits = routine.is_some_and(|it| it.kind == kind && it.state == Some(class.state));
        self.require(fits, class.location, format_args!("its {kind:?} is none"));
        let none_allowed = class.kind == ClassKind::Program;
        let empty = routine.is_some_and(|it| it.params.is_empty());
        self.require(!none_allowed || empty, class.location, "a PROGRAM has no parameters");
    }

    fn state(&mut self, routine: &Routine) {
        let at = routine.location;
        let known = routine.state.is_some_and(|it| self.program.class_of_state(it).is_some());
        match routine.kind {
            RoutineKind::Function => self.require(routine.state.is_none(), at, "a FUNCTION has no state"),
            RoutineKind::Body | RoutineKind::Method => self.require(known, at, "no state"),
            RoutineKind::Prescan => {
                self.require(known, at, "no state");
                self.require(routine.params.is_empty(), at, "a prescan has no parameters")
            }
        };
    }

    fn locals(&mut self, routine: &Routine) {
        for local in &routine.locals {
            let before = self.violations.len();
            self.declared(local.ty, routine.location);
            if self.violations.len() == before {
                self.constant(local.ty, &local.initial, routine.location);
            }
        }
    }

    fn params(&mut self, routine: &Routine) {
        let at = routine.location;
        let mut copies = BTreeSet::new();
        for param in &routine.params {
            self.declared(param.ty, at);
            let Mode::Value(id) = param.mode else { continue };
            let by_value = matches!(routine.kind, RoutineKind::Function | RoutineKind::Method);
            self.require(by_value, at, format_args!("{} is passed by value to an instance", param.name));
            let ty = routine.locals.get(id.index()).map(|local| local.ty);
            let holds = ty == Some(param.ty) && copies.insert(id);
            self.require(holds, at, format_args!("{} has no local of its own of its type", param.name));
        }
    }

    fn result(&mut self, routine: &Routine) {
        let Some(id) = routine.result else { return };
        let may = matches!(routine.kind, RoutineKind::Function | RoutineKind::Method);
        let holds = may && id.index() < routine.locals.len();
        self.require(holds, routine.location, "a result that is not a local of a FUNCTION or METHOD");
    }

    fn instances(&mut self) {
        for instance in &self.program.instances {
            self.within = format!("instance {}", instance.name);
            let class = self.program.classes.get(instance.program.index());
            let runs = class.is_some_and(|class| class.kind == ClassKind::Program);
            self.require(runs, Location::default(), "not a PROGRAM");
            let interval = instance.interval.is_none_or(|nanoseconds| nanoseconds > 0);
            self.require(interval, Location::default(), "an interval that is not above 0");
        }
    }

    /// A declared variable is a root, or a part of one that is always the same.
    pub(super) fn variable(&mut self, routine: &Routine, variable: &Variable) {
        let at = routine.location;
        // Unlike in a body, the root may be a parameter that is passed by value.
        let mut ty = self.program.root_type(routine, variable.place.root);
        for projection in &variable.place.projections {
            ty = match (projection, ty) {
                (Projection::Field(id), Some(ty)) => self.program.member(ty, *id),
                (Projection::Index { index, .. }, Some(Type::Array(id))) => {
                    constant_position(self.program, index, id).map(|_| self.program.array(id).element)
                }
                (Projection::Field(_) | Projection::Index { .. } | Projection::Deref { .. }, _) => None,
            };
        }
        self.require(ty == Some(variable.place.ty), at, format_args!("{} is of another type", variable.name));
        if let (Some(view), Some(ty)) = (variable.view, ty) {
            let bits = self.bits_of(ty);
            let is_inside = bits.is_some_and(|bits| view.bit + u64::from(view.address.width) <= bits);
            self.require(is_inside, at, format_args!("{} is not part of what it is a view of", variable.name));
        }
    }

    /// How many bits the views of a type may show.
    fn bits_of(&self, ty: Type) -> Option<u64> {
        match ty {
            Type::Elementary(it) => it.repr().is_integer().then(|| u64::from(it.repr().size()) * 8),
            Type::Array(id) => Some(self.bits_of(self.program.array(id).element)? * self.program.array(id).len()),
            Type::Subrange(..)
            | Type::String(_)
            | Type::Enum(_)
            | Type::Struct(_)
            | Type::Block(_)
            | Type::Reference(_) => None,
        }
    }
}
