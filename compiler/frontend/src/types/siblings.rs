//! Calls within one expression, and what bodies touch: which of these calls depend on their order is known when all bodies are.

use staunch_ir::visit::{self, Access};
use staunch_ir::{Location, Place, Root, RoutineId, Statement, StatementKind};
use std::collections::HashMap;

/// The calls of one operand, and those of another that is evaluated after it.
#[derive(Clone, Debug)]
pub(crate) struct Siblings {
    pub first: Vec<RoutineId>,
    pub second: Vec<RoutineId>,
    /// What the second operand reads besides: of what the first calls are given, and of what all can reach.
    pub reads: [bool; 2],
    /// Some of both are given one variable or instance.
    pub share: bool,
    pub at: Location,
}

/// What a routine touches, itself or by what it calls.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Touched {
    /// Its instance, and what it is given by reference.
    pub given: Uses,
    /// What all can reach.
    pub shared: Uses,
}

#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Uses {
    reads: bool,
    writes: bool,
}

impl Touched {
    pub fn reading([given, shared]: [bool; 2]) -> Self {
        let reads = |reads| Uses { reads, writes: false };
        Self { given: reads(given), shared: reads(shared) }
    }
}

impl Uses {
    const ALL: Self = Self { reads: true, writes: true };

    fn add(&mut self, other: Self) {
        self.reads |= other.reads;
        self.writes |= other.writes;
    }

    /// Whether the order of two that touch the same decides.
    pub fn meets(self, other: Self) -> bool {
        self.writes && (other.reads || other.writes) || self.reads && other.writes
    }
}

/// What a body touches, and which routines it calls.
#[derive(Clone, Debug, Default)]
pub(crate) struct Own {
    touched: Touched,
    calls: Vec<Called>,
}

#[derive(Clone, Copy, Debug)]
struct Called {
    callee: RoutineId,
    /// It is given what the caller was given, or its instance; and what all can reach.
    gets: [bool; 2],
}

impl Own {
    pub fn of(body: &[Statement]) -> Self {
        let mut own = Self::default();
        visit::statements(body, &mut |statement| own.statement(statement));
        own
    }

    fn statement(&mut self, statement: &Statement) {
        let mut borrowed = Touched::default();
        visit::accesses(statement, &mut |place, access| match access {
            Access::Read => self.touched.access(place, Uses { reads: true, writes: false }),
            Access::Write => self.touched.access(place, Uses { reads: false, writes: true }),
            Access::Borrow => borrowed.access(place, Uses::ALL),
        });
        match &statement.kind {
            StatementKind::Call { callee, .. } => {
                let gets = [borrowed.given.writes, borrowed.shared.writes];
                self.calls.push(Called { callee: *callee, gets });
            }
            StatementKind::External(_) => self.touched.add(Touched { given: borrowed.given, shared: Uses::ALL }),
            _ => self.touched.add(borrowed),
        }
    }
}

impl Touched {
    pub fn add(&mut self, other: Self) {
        self.given.add(other.given);
        self.shared.add(other.shared);
    }

    fn access(&mut self, place: &Place, uses: Uses) {
        match place.root {
            _ if place.is_followed() => self.add(Self { given: uses, shared: uses }),
            Root::Local(_) => {}
            Root::Instance | Root::Param(_) => self.given.add(uses),
            Root::Globals => self.shared.add(uses),
        }
    }
}

/// What a routine touches, itself or by what it calls.
pub(crate) fn touched(bodies: &Bodies, id: RoutineId, known: &mut HashMap<RoutineId, Touched>) -> Touched {
    if let Some(it) = known.get(&id) {
        return *it;
    }
    // What calls itself is refused.
    known.insert(id, Touched::default());
    let Some(own) = bodies.get(&id) else { return Touched::default() };
    let mut all = own.touched;
    for Called { callee, gets: [given, shared] } in &own.calls {
        let callee = touched(bodies, *callee, known);
        all.shared.add(callee.shared);
        if *given {
            all.given.add(callee.given);
        }
        if *shared {
            all.shared.add(callee.given);
        }
    }
    known.insert(id, all);
    all
}

/// By their routines.
pub(crate) type Bodies = HashMap<RoutineId, Own>;
