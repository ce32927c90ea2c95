//! Which whole numbers a variable may hold, where that is less than its type: what it starts with, and what the statements
//! assign to it. A preset that a CASE chooses from a recipe is one of a few.
//!
//! What else writes a variable, or may by a reference, leaves it with all that its type holds.

use super::walked::{Name, Walked};
use staunch_ir::visit::{self, Access};
use staunch_ir::{Conversion, Expr, ExprKind, Program, Repr, Routine, RoutineId, StatementKind, Type, reference};
use std::collections::{HashMap, HashSet};

/// The least and the greatest.
pub type Range = (i128, i128);

#[derive(Debug)]
pub struct Ranges<'p> {
    program: &'p Program,
    known: HashMap<Name, Range>,
}

type At<'p> = (&'p Routine, RoutineId);

impl<'p> Ranges<'p> {
    /// Of the variables that start with values in these ranges, and that the program alone writes.
    pub fn of(program: &'p Program, starts: &HashMap<Name, Range>) -> Self {
        let mut found = Self { program, known: HashMap::new() };
        // A value that is handed on is known once where it comes from is.
        for _ in 0..3 {
            let mut written = starts.clone();
            let mut open = found.reached();
            for (at, routine) in program.routines.iter().enumerate() {
                visit::statements(&routine.body, &mut |it| {
                    found.statement((routine, RoutineId::next(at)), it, &mut written, &mut open);
                });
            }
            written.retain(|name, _| !open.contains(name));
            found.known = written;
        }
        found
    }

    /// What references may lead to.
    fn reached(&self) -> HashSet<Name> {
        let mut open = HashSet::new();
        for (owner, field) in reference::reached(self.program) {
            open.insert(Name::Field(owner, field));
            self.open_in(self.program.structure(owner).fields[field.index()].ty, &mut open);
        }
        open
    }

    fn statement(
        &self,
        at: At<'_>,
        statement: &staunch_ir::Statement,
        written: &mut HashMap<Name, Range>,
        open: &mut HashSet<Name>,
    ) {
        let assigned = match &statement.kind {
            StatementKind::Assign { target, value } => Some((target, value)),
            _ => None,
        };
        // The routine's own statements are walked for themselves.
        let called = match &statement.kind {
            StatementKind::Call { instance, .. } => instance.as_ref(),
            _ => None,
        };
        visit::accesses(statement, &mut |place, access| {
            if access == Access::Read || called.is_some_and(|it| std::ptr::eq(it, place)) {
                return;
            }
            let walked = Walked::of(self.program, at, place);
            let value = assigned.filter(|it| std::ptr::eq(it.0, place)).map(|it| it.1);
            match (value, walked.variable()) {
                (Some(value), Some(name)) if self.whole(place.ty).is_some() => {
                    let (least, greatest) = self.of_value(at, value);
                    if let Some(known) = written.get_mut(&name) {
                        *known = (known.0.min(least), known.1.max(greatest));
                    }
                }
                _ => {
                    open.extend(walked.names);
                    self.open_in(place.ty, open);
                }
            }
        });
    }

    /// All that is a part of a type.
    fn open_in(&self, ty: Type, open: &mut HashSet<Name>) {
        match ty {
            Type::Array(id) => self.open_in(self.program.array(id).element, open),
            Type::Struct(id) => {
                for (at, field) in self.program.structure(id).fields.iter().enumerate() {
                    if open.insert(Name::Field(id, staunch_ir::FieldId::next(at))) {
                        self.open_in(field.ty, open);
                    }
                }
            }
            Type::Block(_)
            | Type::Elementary(_)
            | Type::Reference(_)
            | Type::Subrange(..)
            | Type::String(_)
            | Type::Enum(_) => {}
        }
    }

    /// The values that an expression may have.
    pub fn of_value(&self, at: At<'_>, value: &Expr) -> Range {
        let whole = |ty: Type| self.whole(ty).unwrap_or((i128::MIN, i128::MAX));
        match &value.kind {
            ExprKind::Const(it) => it.as_integer().map_or_else(|| whole(value.ty), |it| (it, it)),
            ExprKind::Load(place) => {
                let name = Walked::of(self.program, at, place).variable();
                let known = name.and_then(|it| self.known.get(&it)).copied();
                known.or_else(|| self.program.range(place.ty)).unwrap_or_else(|| whole(place.ty))
            }
            ExprKind::Convert(Conversion::Same | Conversion::Value, inner) => {
                let (inner, all) = (self.of_value(at, inner), whole(value.ty));
                if all.0 <= inner.0 && inner.1 <= all.1 { inner } else { all }
            }
            ExprKind::Convert(..)
            | ExprKind::Text(_)
            | ExprKind::Aggregate(_)
            | ExprKind::AddressOf(_)
            | ExprKind::Apply(..)
            | ExprKind::ApplyText(..) => whole(value.ty),
        }
    }

    pub fn whole(&self, ty: Type) -> Option<Range> {
        self.program.repr(ty).filter(|it| it.is_integer()).and_then(Repr::range)
    }
}
