//! The declarations of POUs, and the instances that run.

use super::Verifier;
use crate::layout::Layout;
use crate::{Location, Mode, Pou, PouKind, Projection, StructId, Variable};
use std::collections::BTreeSet;

impl Verifier<'_> {
    pub(super) fn pous(&mut self) {
        let program = self.program;
        let mut states = BTreeSet::from([program.globals]);
        for pou in &program.pous {
            self.within.clone_from(&pou.name);
            self.location(pou.location);
            self.state(pou, &mut states);
            self.locals(pou);
            self.params(pou);
            self.result(pou);
        }
        self.instances();
        self.within = "machine".to_owned();
        if self.violations.is_empty()
            && let Err(error) = Layout::try_new(program)
        {
            self.report(error.at.unwrap_or_default(), "the program is larger than the limit");
        }
    }

    fn state(&mut self, pou: &Pou, states: &mut BTreeSet<StructId>) {
        let at = pou.location;
        match (pou.kind, pou.state) {
            (PouKind::Program | PouKind::FunctionBlock, Some(id)) => {
                if self.require(id.index() < self.program.structs.len(), at, "no such state") {
                    self.require(states.insert(id), at, "its state belongs to another as well");
                }
            }
            (PouKind::Program | PouKind::FunctionBlock, None) => self.report(at, "no state"),
            (PouKind::Function, Some(_)) => self.report(at, "a FUNCTION has no state"),
            (PouKind::Function, None) => {
                self.require(pou.prescan.is_empty(), at, "a FUNCTION has no prescan");
            }
        }
    }

    fn locals(&mut self, pou: &Pou) {
        for local in &pou.locals {
            let before = self.violations.len();
            self.declared(local.ty, pou.location);
            if self.violations.len() == before {
                self.constant(local.ty, &local.initial, pou.location);
            }
        }
    }

    fn params(&mut self, pou: &Pou) {
        let at = pou.location;
        let none_allowed = pou.kind == PouKind::Program;
        self.require(!none_allowed || pou.params.is_empty(), at, "a PROGRAM has no parameters");
        let mut copies = BTreeSet::new();
        for param in &pou.params {
            self.declared(param.ty, at);
            let Mode::Value(id) = param.mode else { continue };
            let by_value = pou.kind == PouKind::Function;
            self.require(by_value, at, format_args!("{} is passed by value to an instance", param.name));
            let ty = pou.locals.get(id.index()).map(|local| local.ty);
            let holds = ty == Some(param.ty) && copies.insert(id);
            self.require(holds, at, format_args!("{} has no local of its own of its type", param.name));
        }
    }

    fn result(&mut self, pou: &Pou) {
        let Some(id) = pou.result else { return };
        let holds = pou.kind == PouKind::Function && id.index() < pou.locals.len();
        self.require(holds, pou.location, "a result that is not a local of a FUNCTION");
    }

    fn instances(&mut self) {
        for instance in &self.program.instances {
            self.within = format!("instance {}", instance.name);
            let pou = self.program.pous.get(instance.program.index());
            let runs = pou.is_some_and(|pou| pou.kind == PouKind::Program);
            self.require(runs, Location::default(), "not a PROGRAM");
            let interval = instance.interval.is_none_or(|nanoseconds| nanoseconds > 0);
            self.require(interval, Location::default(), "an interval that is not above 0");
        }
    }

    /// A declared variable is a root, or a member of one.
    pub(super) fn variable(&mut self, pou: &Pou, variable: &Variable) {
        let at = pou.location;
        let direct = variable.place.projections.iter().all(|it| matches!(it, Projection::Field(_)));
        if !self.require(direct, at, format_args!("{} is not a field", variable.name)) {
            return;
        }
        // Unlike in a body, the root may be a parameter that is passed by value.
        let mut ty = self.program.root_type(pou, variable.place.root);
        for projection in &variable.place.projections {
            let Projection::Field(id) = projection else { continue };
            ty = ty.and_then(|ty| self.program.member(ty, *id));
        }
        self.require(ty == Some(variable.place.ty), at, format_args!("{} is of another type", variable.name));
    }
}
