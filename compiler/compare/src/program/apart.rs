//! What the two systems compute differently: in other types, or because bits are shared on only one of them.

use super::walked::{Name, Walked};
use staunch_ir::{
    Expr, ExprKind, FieldId, Location, Place, Program, Projection, Root, Routine, RoutineId, Statement, StatementKind,
    StructId, Variable, visit,
};
use std::collections::{BTreeMap, HashSet};

/// Variables by their declarations.
pub type Declared = (StructId, FieldId);

/// Why a value is computed differently; the more important reason last.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Why {
    /// The bits that it is made of are shared on one of the two alone.
    Address,
    /// It is computed in other types.
    Width,
}

/// An assigned value that is computed differently, and its place in the first program.
#[derive(Clone, Copy, Debug)]
pub struct Found {
    pub why: Why,
    pub at: Location,
}

/// The variables of each program that are assigned values which the two compute differently, or under such a condition.
pub fn targets(programs: [&Program; 2]) -> [BTreeMap<Declared, Found>; 2] {
    let mut found = [BTreeMap::new(), BTreeMap::new()];
    let shared = programs.map(shared);
    for (at, a) in programs[0].routines.iter().enumerate() {
        let other = programs[1].routines.iter().position(|it| it.name == a.name && it.kind == a.kind);
        if let Some(other) = other {
            let routines = [(RoutineId::next(at), a), (RoutineId::next(other), &programs[1].routines[other])];
            let mut walk = Walk { programs, routines, shared: &shared, found: &mut found };
            walk.blocks([&a.body, &routines[1].1.body], None);
        }
    }
    found
}

/// The globals of which some bits are a variable.
fn shared(program: &Program) -> HashSet<FieldId> {
    let field = |it: &Variable| match (it.view, it.place.root, it.place.projections.first()) {
        (Some(_), Root::Globals, Some(Projection::Field(field))) => Some(*field),
        _ => None,
    };
    let of_programs = program.instances.iter().flat_map(|it| &program.class(it.program).variables);
    of_programs.chain(&program.aliases).filter_map(field).collect()
}

struct Walk<'p, 'f> {
    programs: [&'p Program; 2],
    routines: [(RoutineId, &'p Routine); 2],
    shared: &'f [HashSet<FieldId>; 2],
    found: &'f mut [BTreeMap<Declared, Found>; 2],
}

impl<'p> Walk<'p, '_> {
    /// `around`: where a condition around the statements is computed differently.
    fn blocks(&mut self, [a, b]: [&'p [Statement]; 2], around: Option<Found>) {
        for (a, b) in a.iter().zip(b).filter(|(a, b)| a.at == b.at) {
            self.statement([a, b], around);
        }
    }

    fn statement(&mut self, [a, b]: [&'p Statement; 2], around: Option<Found>) {
        let apart = self.values([a, b]).map(|why| Found { why, at: a.at }).or(around);
        if let (StatementKind::Assign { target, .. }, StatementKind::Assign { target: other, .. }, Some(found)) =
            (&a.kind, &b.kind, apart)
        {
            for (side, target) in [target, other].into_iter().enumerate() {
                if let Some(declared) = self.declared(side, target) {
                    self.found[side].entry(declared).or_insert(found);
                }
            }
        }
        for (a, b) in a.kind.blocks().into_iter().zip(b.kind.blocks()) {
            self.blocks([a, b], apart);
        }
    }

    /// The variable that a place is; what a reference leads to is not the one that holds it.
    fn declared(&self, side: usize, place: &Place) -> Option<Declared> {
        let (id, routine) = self.routines[side];
        match Walked::of(self.programs[side], (routine, id), place).variable()? {
            Name::Field(owner, field) => Some((owner, field)),
            Name::Local(..) | Name::Param(..) => None,
        }
    }

    /// Why the values of a statement are computed differently, if they are.
    fn values(&self, statements: [&'p Statement; 2]) -> Option<Why> {
        let [a, b] = statements.map(|it| {
            let mut found: Vec<&Expr> = Vec::new();
            visit::values(it, &mut |value| found.push(value));
            found
        });
        if a.len() != b.len() {
            return None;
        }
        let why = a.iter().zip(&b).filter_map(|(a, b)| self.why([*a, *b])).max()?;
        // What is put among the bits of others is computed of them.
        let is_shared = |side: usize| match &statements[side].kind {
            StatementKind::Assign { target, .. } => self.is_shared(side, target),
            _ => false,
        };
        Some(if is_shared(0) != is_shared(1) { Why::Address } else { why })
    }

    /// Why two values are computed differently; the layout of variables is checked at their declarations.
    fn why(&self, [a, b]: [&Expr; 2]) -> Option<Why> {
        let each = |a: &[Expr], b: &[Expr]| a.iter().zip(b).filter_map(|(a, b)| self.why([a, b])).max();
        let one_type = |a: &Expr, b: &Expr| a.ty.elementary() == b.ty.elementary();
        match (&a.kind, &b.kind) {
            (ExprKind::Load(_), ExprKind::Load(_)) => None,
            (ExprKind::Const(x), ExprKind::Const(y)) if x == y => None,
            (ExprKind::Const(x), ExprKind::Const(y))
                if x.as_integer().is_some() && x.as_integer() == y.as_integer() =>
            {
                None
            }
            (ExprKind::Apply(x, xs), ExprKind::Apply(y, ys)) if x == y && xs.len() == ys.len() && one_type(a, b) => {
                let wide = !xs.iter().zip(ys).all(|(a, b)| one_type(a, b));
                if wide { Some(Why::Width) } else { each(xs, ys) }
            }
            (ExprKind::ApplyText(x, xs), ExprKind::ApplyText(y, ys)) if x == y && xs.len() == ys.len() => each(xs, ys),
            (ExprKind::Convert(x, inner), ExprKind::Convert(y, other)) if x == y && one_type(a, b) => {
                self.why([inner, other])
            }
            (ExprKind::Text(x), ExprKind::Text(y)) if x == y => None,
            // Where variables are is each program's own.
            (ExprKind::Aggregate(_), ExprKind::Aggregate(_)) | (ExprKind::AddressOf(_), ExprKind::AddressOf(_)) => None,
            _ => Some(self.by_bits([a, b])),
        }
    }

    /// Of two values of other forms: whether it is where their bits are that makes them so.
    fn by_bits(&self, [a, b]: [&Expr; 2]) -> Why {
        let reads = |side: usize, value: &Expr| {
            let mut found = false;
            visit::reads(value, &mut |place| found |= self.is_shared(side, place));
            found
        };
        if a.ty.elementary() == b.ty.elementary() && reads(0, a) != reads(1, b) { Why::Address } else { Why::Width }
    }

    fn is_shared(&self, side: usize, place: &Place) -> bool {
        match (place.root, place.projections.first()) {
            (Root::Globals, Some(Projection::Field(field))) => self.shared[side].contains(field),
            _ => false,
        }
    }
}
