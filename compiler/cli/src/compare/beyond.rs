//! What a move can change beside counters: timers, one-shots and latches, what is computed in other types,
//! what an event keeps on one system alone, and faults.

use super::pair::{Matched, Pair};
use super::scalar::{Instance, Role};
use super::walked::{Name, Walked};
use staunch_host::Event;
use staunch_ir::{
    Block, Expr, ExprKind, FieldId, Location, Place, Program, Routine, RoutineId, Statement, StatementKind, StructId,
    visit,
};
use std::collections::{BTreeMap, HashSet};

/// What a finding is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Kind {
    Counter,
    Timer,
    OneShot,
    Latch,
    /// A variable that the two systems compute in other types.
    Width,
    /// A variable at an address whose bits others share on one of the two alone.
    Address,
    /// A variable that an event leaves as it is on one of the two.
    Retention,
    Fault,
    /// A variable that differs, and no trap or kind says why: the two programs are not the same.
    Variable,
}

impl Kind {
    pub const ALL: [Self; 9] = [
        Self::Counter,
        Self::Timer,
        Self::OneShot,
        Self::Latch,
        Self::Width,
        Self::Address,
        Self::Retention,
        Self::Fault,
        Self::Variable,
    ];

    /// In findings, and in the lines that accept them.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Counter => "counter",
            Self::Timer => "timer",
            Self::OneShot => "one-shot",
            Self::Latch => "latch",
            Self::Width => "width",
            Self::Address => "address",
            Self::Retention => "retention",
            Self::Fault => "fault",
            Self::Variable => "variable",
        }
    }

    /// Why it differs, where no trap says so.
    pub const fn reason(self) -> &'static str {
        match self {
            Self::Counter => "what it is given differs, or no trap explains it",
            Self::Timer | Self::OneShot | Self::Latch => {
                "both systems run the same block, and what it is given differs"
            }
            Self::Width => "the two systems compute or hold it in other types",
            Self::Address => "what is at its address shares bits on one of the two systems alone",
            Self::Retention => "one system keeps it",
            Self::Fault => "one system faults here, and the other goes on",
            Self::Variable => "no trap explains it: the two programs are not the same",
        }
    }

    /// Of a standard block that does not count.
    pub fn of(instance: &Instance) -> Self {
        let info = instance.block.info();
        if info.instructions.iter().any(|it| it.needs_context) {
            Self::Timer
        } else if info.pin("CLK").is_some() {
            Self::OneShot
        } else {
            Self::Latch
        }
    }
}

/// A variable that may come to differ, and where the text says so.
#[derive(Clone, Debug)]
pub struct Candidate {
    pub variable: Matched,
    pub kind: Kind,
    pub at: Location,
}

/// Variables by their declarations.
type Declared = (StructId, FieldId);

/// The variables that an event leaves as they are on one side alone, one of each declaration.
pub fn kept_by_one(pair: &Pair) -> Vec<Candidate> {
    let mut seen = HashSet::new();
    let mut found = Vec::new();
    let events = || Event::ALL.into_iter().filter(|it| !pair.never.contains(it));
    for [a, b] in pair.matched(|it| it.role == Role::Variable) {
        let scalars = [pair.scalar(0, a), pair.scalar(1, b)];
        let keeps = |side: usize, event| pair.sides[side].keeps(event, scalars[side].offset);
        let Some(declared) = scalars[0].field else { continue };
        if events().any(|it| keeps(0, it) != keeps(1, it)) && seen.insert(declared) {
            let at = location(&pair.sides[0].program, declared);
            found.push(Candidate { variable: [a, b], kind: Kind::Retention, at });
        }
    }
    found
}

pub fn location(program: &Program, (owner, field): Declared) -> Location {
    program.structure(owner).fields[field.index()].location
}

/// The variables that are assigned what the two systems compute in other types, or where a condition is.
pub fn computed_apart(pair: &Pair) -> Vec<Candidate> {
    let [ours, theirs] = pair.sides.each_ref().map(|it| &it.program);
    let mut targets: BTreeMap<Declared, Location> = BTreeMap::new();
    for (at, a) in ours.routines.iter().enumerate() {
        if let Some(b) = theirs.routines.iter().find(|it| it.name == a.name && it.kind == a.kind) {
            Walk { program: ours, routine: a, id: RoutineId::next(at), found: &mut targets }
                .blocks(&a.body, &b.body, None);
        }
    }
    let variables = pair.matched(|it| it.role == Role::Variable).into_iter();
    let of = |variable: Matched| {
        let declared = pair.scalar(0, variable[0]).field?;
        let at = *targets.get(&declared)?;
        // What is held in one type is stored alike, but for the bits around it.
        let reprs = [0, 1].map(|side| pair.sides[side].program.repr(pair.scalar(side, variable[side]).ty));
        let is_located = ours.structure(declared.0).fields[declared.1.index()].address.is_some();
        let kind = if is_located && reprs[0] == reprs[1] { Kind::Address } else { Kind::Width };
        Some(Candidate { variable, kind, at })
    };
    variables.filter_map(of).collect()
}

/// The variables that the two systems hold in strings of other lengths, one of each declaration.
pub fn held_apart(pair: &Pair) -> Vec<Candidate> {
    let mut seen = HashSet::new();
    let capacity = |side: usize, at: usize| pair.scalar(side, at).ty.string_type();
    let apart =
        pair.matched(|it| it.role == Role::Variable).into_iter().filter(|[a, b]| capacity(0, *a) != capacity(1, *b));
    let of = |variable: Matched| {
        let declared = pair.scalar(0, variable[0]).field?;
        let at = || location(&pair.sides[0].program, declared);
        seen.insert(declared).then(|| Candidate { variable, kind: Kind::Width, at: at() })
    };
    apart.filter_map(of).collect()
}

struct Walk<'p, 'f> {
    program: &'p Program,
    routine: &'p Routine,
    id: RoutineId,
    found: &'f mut BTreeMap<Declared, Location>,
}

impl Walk<'_, '_> {
    /// `apart`: where a condition around the statements is computed in other types.
    fn blocks(&mut self, a: &Block, b: &Block, apart: Option<Location>) {
        for (a, b) in a.iter().zip(b).filter(|(a, b)| a.at == b.at) {
            self.statement(a, b, apart);
        }
    }

    fn statement(&mut self, a: &Statement, b: &Statement, apart: Option<Location>) {
        let apart = if values_differ(a, b) { Some(a.at) } else { apart };
        if let (StatementKind::Assign { target, .. }, Some(at)) = (&a.kind, apart)
            && let Some(declared) = self.declared(target)
        {
            self.found.entry(declared).or_insert(at);
        }
        for (a, b) in a.kind.blocks().into_iter().zip(b.kind.blocks()) {
            self.blocks(a, b, apart);
        }
    }

    /// The variable that a place is; what a reference leads to is not the one that holds it.
    fn declared(&self, place: &Place) -> Option<Declared> {
        match Walked::of(self.program, (self.routine, self.id), place).variable()? {
            Name::Field(owner, field) => Some((owner, field)),
            Name::Local(..) | Name::Param(..) => None,
        }
    }
}

fn values_differ(a: &Statement, b: &Statement) -> bool {
    let values = |it| {
        let mut found: Vec<&Expr> = Vec::new();
        visit::values(it, &mut |value| found.push(value));
        found
    };
    let (a, b) = (values(a), values(b));
    a.len() == b.len() && a.iter().zip(&b).any(|(a, b)| !is_alike(a, b))
}

/// Whether both compute the same in the same types; what variables are made of is their declarations' matter.
fn is_alike(a: &Expr, b: &Expr) -> bool {
    match (&a.kind, &b.kind) {
        (ExprKind::Load(_), ExprKind::Load(_)) => true,
        (ExprKind::Const(x), ExprKind::Const(y)) => {
            x.as_integer() == y.as_integer() && (x.as_integer().is_some() || x == y)
        }
        (ExprKind::Apply(x, a_operands), ExprKind::Apply(y, b_operands)) => {
            let operands = a_operands.len() == b_operands.len()
                && a_operands
                    .iter()
                    .zip(b_operands)
                    .all(|(a, b)| is_alike(a, b) && a.ty.elementary() == b.ty.elementary());
            x == y && operands && a.ty.elementary() == b.ty.elementary()
        }
        (ExprKind::ApplyText(x, a), ExprKind::ApplyText(y, b)) => {
            x == y && a.len() == b.len() && a.iter().zip(b).all(|(a, b)| is_alike(a, b))
        }
        (ExprKind::Convert(x, a_inner), ExprKind::Convert(y, b_inner)) => {
            x == y && a.ty.elementary() == b.ty.elementary() && is_alike(a_inner, b_inner)
        }
        (ExprKind::Text(x), ExprKind::Text(y)) => x == y,
        // Where variables are is each program's own.
        (ExprKind::Aggregate(_), ExprKind::Aggregate(_)) | (ExprKind::AddressOf(_), ExprKind::AddressOf(_)) => true,
        _ => false,
    }
}
