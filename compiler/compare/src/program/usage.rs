//! How a program uses its counters: presets that are constants, counters that their own outputs
//! reset or feed.

use super::walked::{Name, Walked};
use staunch_ir::{
    BlockId, Expr, ExprKind, FieldId, Place, Program, Routine, RoutineId, Statement, StatementKind, Type, Value,
    reference, visit,
};
use staunch_runtime::PinRole;
use std::collections::{HashMap, HashSet};

/// What the statements say of the instances of one declaration.
#[derive(Clone, Debug, Default)]
pub struct Usage {
    /// Something calls it, writes it, or may by a reference.
    pub is_used: bool,
    /// The presets that it is given; `None` among them is one that is computed.
    pub presets: HashSet<Option<i128>>,
    /// Something other than FALSE resets or loads it.
    pub resets: bool,
    /// An output of its own, or a variable that is given just that, resets or loads it.
    pub feeds_itself: bool,
    /// What resets or loads it depends on its own outputs in some way.
    pub reset_depends: bool,
    /// What it counts depends on its own outputs in some way.
    pub count_depends: bool,
    /// The inputs that calls give, and those that calls leave as they were.
    pub given: HashSet<PinRole>,
    pub left_out: HashSet<PinRole>,
    /// Something reads what says that it is done, or may by a reference.
    pub reads_done: bool,
}

/// By the declarations of the instances.
pub fn of(program: &Program) -> HashMap<Name, Usage> {
    let mut walk = Walk { program, links: HashMap::new(), copies: HashMap::new(), found: HashMap::new() };
    walk.each_statement(Walk::link);
    walk.close();
    walk.each_statement(Walk::note);
    let lent = reference::reached(program).into_iter().map(|(owner, field)| Name::Field(owner, field));
    lent.for_each(|it| {
        let usage = walk.found.entry(it).or_default();
        (usage.is_used, usage.reads_done) = (true, true);
    });
    walk.found
}

/// A variable's value, or a pin of an instance.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum Source {
    Variable(Name),
    Pin(Name, PinRole),
}

struct Walk<'p> {
    program: &'p Program,
    /// What a variable's values may depend on.
    links: HashMap<Name, HashSet<Source>>,
    /// What a variable is given as it is.
    copies: HashMap<Name, HashSet<Source>>,
    found: HashMap<Name, Usage>,
}

type At<'p> = (&'p Routine, RoutineId);

impl<'p> Walk<'p> {
    fn each_statement(&mut self, see: fn(&mut Self, At<'p>, &'p Statement)) {
        for (at, routine) in self.program.routines.iter().enumerate() {
            let mut found = Vec::new();
            visit::statements(&routine.body, &mut |it| found.push(it));
            found.into_iter().for_each(|it| see(self, (routine, RoutineId::next(at)), it));
        }
    }

    /// The variable that a place is a part of, and the pin of an instance where it is one.
    fn source(&self, at: At<'p>, place: &Place) -> Option<Source> {
        let walked = Walked::of(self.program, at, place);
        match walked.pin {
            Some((block, pin)) => Some(Source::Pin(*walked.names.last()?, role(block, pin)?)),
            None => walked.variable().map(Source::Variable),
        }
    }

    fn sources(&self, at: At<'p>, expr: &Expr) -> HashSet<Source> {
        let mut found = HashSet::new();
        visit::reads(expr, &mut |place| found.extend(self.source(at, place)));
        found
    }

    /// The place that an expression reads and no more.
    fn copied(&self, at: At<'p>, expr: &Expr) -> Option<Source> {
        match &expr.kind {
            ExprKind::Load(place) => self.source(at, place),
            _ => None,
        }
    }

    fn link(&mut self, at: At<'p>, statement: &'p Statement) {
        let StatementKind::Assign { target, value } = &statement.kind else { return };
        let Some(Source::Variable(target)) = self.source(at, target) else { return };
        let sources = self.sources(at, value);
        let copied = self.copied(at, value);
        self.links.entry(target).or_default().extend(sources);
        self.copies.entry(target).or_default().extend(copied);
    }

    /// What a variable depends on through others.
    fn close(&mut self) {
        let mut changed = true;
        while changed {
            changed = false;
            for (name, sources) in self.links.clone() {
                let through = sources.iter().filter_map(|it| match it {
                    Source::Variable(other) => self.links.get(other),
                    Source::Pin(..) => None,
                });
                let more: HashSet<Source> = through.flatten().copied().collect();
                let own = self.links.entry(name).or_default();
                let before = own.len();
                own.extend(more);
                changed |= own.len() > before;
            }
        }
    }

    /// What a statement calls or writes is used, with all that it is in.
    fn used(&mut self, at: At<'p>, statement: &'p Statement) {
        let (mut names, mut read) = (Vec::new(), Vec::new());
        visit::accesses(statement, &mut |place, access| match (access, self.source(at, place)) {
            (visit::Access::Read, Some(Source::Pin(name, PinRole::Done))) => read.push(name),
            // A copy of all of it, or of what it is in.
            (visit::Access::Read, _) if !matches!(place.ty, Type::Elementary(_)) => {
                read.extend(Walked::of(self.program, at, place).names);
            }
            (visit::Access::Read, _) => {}
            _ => names.extend(Walked::of(self.program, at, place).names),
        });
        read.into_iter().for_each(|it| self.found.entry(it).or_default().reads_done = true);
        names.into_iter().for_each(|it| self.found.entry(it).or_default().is_used = true);
    }

    fn note(&mut self, at: At<'p>, statement: &'p Statement) {
        self.used(at, statement);
        match &statement.kind {
            StatementKind::Assign { target, value } => {
                if let Some(Source::Pin(name, role)) = self.source(at, target) {
                    self.given(at, name, role, value);
                }
            }
            StatementKind::CallBlock { block, instruction, inputs } => {
                let (Some(Source::Variable(name)), Type::Block(id)) = (self.source(at, block), block.ty) else {
                    return;
                };
                let info = id.info();
                let rung = info.instructions.get(*instruction).filter(|it| it.takes_rung);
                match rung {
                    Some(instruction) => {
                        let role = if instruction.name == "RES" { PinRole::Reset } else { PinRole::Up };
                        inputs.iter().for_each(|it| self.given(at, name, role, it));
                    }
                    None => {
                        for (pin, value) in info.inputs().zip(inputs) {
                            pin.role.into_iter().for_each(|it| self.given(at, name, it, value));
                        }
                    }
                }
            }
            _ => {}
        }
    }

    /// An input of an instance is given a value.
    fn given(&mut self, at: At<'p>, name: Name, role: PinRole, value: &Expr) {
        let own = |it: &Source| matches!(it, Source::Pin(owner, role) if *owner == name && *role != PinRole::Preset);
        let copies = |it: &Source| match it {
            Source::Variable(other) => self.copies.get(other).is_some_and(|it| it.iter().any(own)),
            Source::Pin(..) => own(it),
        };
        let direct = self.copied(at, value).is_some_and(|it| copies(&it));
        let sources = self.sources(at, value);
        let depends = sources.iter().any(|it| match it {
            Source::Variable(other) => self.links.get(other).is_some_and(|it| it.iter().any(own)),
            Source::Pin(..) => own(it),
        });
        let keeps = self.copied(at, value) == Some(Source::Pin(name, role));
        let usage = self.found.entry(name).or_default();
        if keeps { &mut usage.left_out } else { &mut usage.given }.insert(role);
        match role {
            PinRole::Preset if !keeps => {
                usage.presets.insert(value.as_const().and_then(Value::as_integer));
            }
            PinRole::Reset | PinRole::Load if !keeps => {
                usage.resets |= value.as_const() != Some(Value::Bool(false));
                usage.feeds_itself |= direct;
                usage.reset_depends |= depends;
            }
            PinRole::Up | PinRole::Down if !keeps => usage.count_depends |= depends,
            _ => {}
        }
    }
}

fn role(block: BlockId, pin: FieldId) -> Option<PinRole> {
    block.info().pins.get(pin.index())?.role
}
