//! References that are kept where they outlive what they refer to: variables of a FUNCTION, and VAR_TEMP, live
//! for one call. A reference to one may be handed down, and copied among variables of the same call.
//!
//! What a variable may hold is a set of sources, without regard to the order of statements; what a routine does
//! with what it is passed is found before its callers ask.

use crate::{
    Argument, Expr, ExprKind, LocalId, Location, Mode, ParamId, Place, Program, Projection, Root, Routine, RoutineId,
    Statement, StatementKind, Type, visit,
};
use std::collections::BTreeSet;

/// A reference that outlives its target.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Escape {
    pub routine: RoutineId,
    /// What lives for one call.
    pub target: LocalId,
    /// The statement that keeps the reference, or passes it to who does.
    pub at: Location,
    pub how: How,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum How {
    /// It is stored outside of the call.
    Stored,
    /// It is the result.
    Returned,
    /// A callee keeps it.
    KeptBy(RoutineId),
}

/// All of them, in the order of routines. Bodies need to have no more than their calls and what
/// [moves references](moves_references).
pub fn escapes(program: &Program) -> Vec<Escape> {
    let mut summaries: Vec<Summary> = Vec::with_capacity(program.routines.len());
    let mut found = Vec::new();
    if program.references.is_empty() {
        return found;
    }
    for at in 0..program.routines.len() {
        let mut finder = Finder::new(program, RoutineId::next(at), &summaries);
        finder.search();
        found.append(&mut finder.found);
        let summary = finder.summary;
        summaries.push(summary);
    }
    found
}

/// Whether a statement is an assignment of a reference, or of something that holds one.
pub fn moves_references(program: &Program, statement: &StatementKind) -> bool {
    match statement {
        StatementKind::Assign { value, .. } => holds_reference(program, value.ty),
        StatementKind::If { .. }
        | StatementKind::Case { .. }
        | StatementKind::Loop { .. }
        | StatementKind::For(_)
        | StatementKind::Try { .. }
        | StatementKind::Finally { .. }
        | StatementKind::Turn
        | StatementKind::Exit
        | StatementKind::Continue
        | StatementKind::Return
        | StatementKind::Call { .. }
        | StatementKind::External(_)
        | StatementKind::CallBlock { .. }
        | StatementKind::PrescanBlock { .. }
        | StatementKind::Stop(_)
        | StatementKind::Fault(_) => false,
    }
}

fn holds_reference(program: &Program, ty: Type) -> bool {
    program.holds(ty, |it| matches!(it, Type::Reference(_)))
}

/// Where a reference may come from that does not live for ever.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Source {
    /// It refers to a variable of this call.
    Own(LocalId),
    /// It is, or comes with, what a caller passes.
    Param(ParamId),
    /// It refers to the instance that the routine works on, or to a part of it.
    Instance,
}

type Sources = BTreeSet<Source>;

/// What a routine does with what it is passed, and with its instance.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
struct Summary {
    /// Stored where it outlives the call.
    kept: Sources,
    /// What the result may hold.
    result: Sources,
    /// What it stores into which of its in-outs.
    into: BTreeSet<(Source, ParamId)>,
}

struct Finder<'p> {
    program: &'p Program,
    id: RoutineId,
    routine: &'p Routine,
    summaries: &'p [Summary],
    /// For each local, what it may hold.
    held: Vec<Sources>,
    summary: Summary,
    found: Vec<Escape>,
}

impl<'p> Finder<'p> {
    fn new(program: &'p Program, id: RoutineId, summaries: &'p [Summary]) -> Self {
        let routine = program.routine(id);
        let mut held = vec![Sources::new(); routine.locals.len()];
        for (at, param) in routine.params.iter().enumerate() {
            match param.mode {
                Mode::Value(local) if holds_reference(program, param.ty) => {
                    held[local.index()].insert(Source::Param(ParamId::next(at)));
                }
                Mode::Value(_) | Mode::Reference => {}
            }
        }
        Self { program, id, routine, summaries, held, summary: Summary::default(), found: Vec::new() }
    }

    /// Until nothing is added: a later statement may give what an earlier one, in a loop, hands on.
    fn search(&mut self) {
        loop {
            let before = (self.held.clone(), self.summary.clone());
            let routine = self.routine;
            visit::statements(&routine.body, &mut |it| self.statement(it));
            if before == (self.held.clone(), self.summary.clone()) {
                return;
            }
        }
    }

    fn statement(&mut self, statement: &'p Statement) {
        match &statement.kind {
            kind @ StatementKind::Assign { target, value } if moves_references(self.program, kind) => {
                let sources = self.sources(value);
                self.store(target, &sources, statement.at);
            }
            StatementKind::Call { callee, instance, arguments, result } => {
                self.call(*callee, (instance.as_ref(), arguments), result.as_ref(), statement.at);
            }
            StatementKind::Assign { .. }
            | StatementKind::If { .. }
            | StatementKind::Case { .. }
            | StatementKind::Loop { .. }
            | StatementKind::For(_)
        | StatementKind::Try { .. }
        | StatementKind::Finally { .. }
            | StatementKind::Turn
            | StatementKind::Exit
            | StatementKind::Continue
            | StatementKind::Return
            // No reference is passed to what is outside.
            | StatementKind::External(_)
            | StatementKind::CallBlock { .. }
            | StatementKind::PrescanBlock { .. }
            | StatementKind::Stop(_)
            | StatementKind::Fault(_) => {}
        }
    }

    fn call(
        &mut self,
        callee: RoutineId,
        (instance, arguments): (Option<&Place>, &[Argument]),
        result: Option<&Place>,
        at: Location,
    ) {
        let summaries = self.summaries;
        let Some(summary) = summaries.get(callee.index()) else { return };
        let passed = |this: &Self, source: Source| match source {
            Source::Param(id) => match arguments.get(id.index()) {
                Some(Argument::Value(value)) => this.sources(value),
                Some(Argument::Reference(place)) => this.address(place),
                None => Sources::new(),
            },
            Source::Instance => instance.map_or_else(Sources::new, |it| this.address(it)),
            Source::Own(_) => Sources::new(),
        };
        for source in &summary.kept {
            let sources = passed(self, *source);
            self.keep(&sources, at, How::KeptBy(callee));
        }
        for (from, into) in &summary.into {
            let sources = passed(self, *from);
            if let Some(Argument::Reference(place)) = arguments.get(into.index()) {
                self.store(place, &sources, at);
            }
        }
        if let Some(target) = result {
            let sources = summary.result.iter().flat_map(|it| passed(self, *it)).collect();
            self.store(target, &sources, at);
        }
    }

    /// What a value may hold.
    fn sources(&self, value: &Expr) -> Sources {
        match &value.kind {
            ExprKind::Load(place) => self.contents(place),
            ExprKind::AddressOf(place) => self.address(place),
            ExprKind::Apply(_, operands) => operands.iter().flat_map(|it| self.sources(it)).collect(),
            ExprKind::Convert(_, operand) => self.sources(operand),
            ExprKind::Const(_) | ExprKind::Text(_) | ExprKind::ApplyText(..) | ExprKind::Aggregate(_) => Sources::new(),
        }
    }

    /// The sources of a place's contents. The target of a reference may be what that refers to, or what comes with it.
    fn contents(&self, place: &Place) -> Sources {
        match place.root {
            Root::Local(id) => self.held[id.index()].clone(),
            Root::Param(id) => Sources::from([Source::Param(id)]),
            // What it holds outlives it, or is a part of it.
            Root::Instance | Root::Globals => Sources::new(),
        }
    }

    /// What a reference to a place refers to, and the contents there.
    fn address(&self, place: &Place) -> Sources {
        let mut sources = self.contents(place);
        match (place.root, place.is_followed()) {
            (Root::Local(id), false) => drop(sources.insert(Source::Own(id))),
            (Root::Instance, false) => drop(sources.insert(Source::Instance)),
            (Root::Local(_) | Root::Instance, true) | (Root::Param(_) | Root::Globals, _) => {}
        }
        sources
    }

    fn store(&mut self, target: &Place, sources: &Sources, at: Location) {
        let followed = target.projections.iter().any(|it| matches!(it, Projection::Deref { .. }));
        match target.root {
            Root::Local(id) if !followed => {
                if self.routine.result == Some(id) {
                    self.give(sources, at);
                }
                self.held[id.index()].extend(sources);
            }
            Root::Param(into) if !followed => self.hand_back(sources, into, at),
            // A reference to itself lives as long as it does.
            Root::Instance if !followed => {
                let others = sources.iter().copied().filter(|it| *it != Source::Instance).collect();
                self.keep(&others, at, How::Stored);
            }
            Root::Local(_) | Root::Param(_) | Root::Instance | Root::Globals => {
                self.keep(sources, at, How::Stored);
            }
        }
    }

    fn keep(&mut self, sources: &Sources, at: Location, how: How) {
        for source in sources {
            match source {
                Source::Own(target) => self.report(*target, at, how),
                Source::Param(_) | Source::Instance => {
                    self.summary.kept.insert(*source);
                }
            }
        }
    }

    fn give(&mut self, sources: &Sources, at: Location) {
        for source in sources {
            match source {
                Source::Own(target) => self.report(*target, at, How::Returned),
                Source::Param(_) | Source::Instance => {
                    self.summary.result.insert(*source);
                }
            }
        }
    }

    fn hand_back(&mut self, sources: &Sources, into: ParamId, at: Location) {
        for source in sources {
            match source {
                Source::Own(target) => self.report(*target, at, How::Stored),
                Source::Param(_) | Source::Instance => {
                    self.summary.into.insert((*source, into));
                }
            }
        }
    }

    fn report(&mut self, target: LocalId, at: Location, how: How) {
        let escape = Escape { routine: self.id, target, at, how };
        if !self.found.contains(&escape) {
            self.found.push(escape);
        }
    }
}
