//! Whether two places name the same storage, and what follows from it: the one answer to the
//! questions "may this write change what that reads" and "is this the same variable".
//!
//! Roots of one body are separate, except for these: a by-reference parameter may stand for a global, for
//! a part of the instance that its callers can name, and for what another parameter stands for; and
//! the instance may itself be in a global. Types decide those: what can be a part of what.

use crate::shapes;
use crate::visit::{self, Access};
use crate::{
    Expr, Param, Place, Program, Projection, Root, Routine, Section, Statement, StatementKind, StructId, Type,
};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Alias {
    /// They share no byte, whatever the indices and parameters are.
    No,
    /// It depends on an index or on what a parameter stands for.
    May,
    /// One is the other or a part of it, whatever the indices are.
    Must,
}

/// What a body's places are places of.
#[derive(Clone, Copy, Debug)]
pub struct Frame<'p> {
    pub program: &'p Program,
    pub state: Option<StructId>,
    pub params: &'p [Param],
}

impl<'p> Frame<'p> {
    pub fn of(program: &'p Program, routine: &'p Routine) -> Self {
        Self { program, state: routine.state, params: &routine.params }
    }

    /// The type of a root that other roots' storage may be a part of, or hold.
    pub fn root_type(&self, root: Root) -> Option<Type> {
        match root {
            Root::Instance => self.state.map(Type::Struct),
            Root::Globals => Some(Type::Struct(self.program.globals)),
            Root::Param(id) => self.params.get(id.index()).map(|it| it.ty),
            // A local is not part of anything else.
            Root::Local(_) => None,
        }
    }

    /// Whether only this body, and what it passes the place to, can write it: no POU calls itself, and
    /// nobody comes back to the instance by another of its routines.
    pub fn is_private(&self, place: &Place) -> bool {
        let is_reentered = self.state.is_some_and(|it| self.program.reentered.contains(&it));
        self.is_own(place) && (matches!(place.root, Root::Local(_)) || !is_reentered)
    }

    /// Whether only the routines of the class, and what they pass the place to, can write it.
    /// Only the variable itself says so: a member of a structure that is an input is not private.
    pub fn is_own(&self, place: &Place) -> bool {
        match (place.root, place.projections.first()) {
            (Root::Local(_), _) => true,
            (Root::Instance, Some(Projection::Field(id))) => self.state.is_some_and(|state| {
                let field = &self.program.structure(state).fields[id.index()];
                let is_own = field.section == Section::Internal && field.address.is_none();
                is_own && !self.program.reach.copies && !self.is_reached(place)
            }),
            (Root::Instance | Root::Globals | Root::Param(_), _) => false,
        }
    }

    /// Whether a reference may lead to the place, to a part of it, or to what it is a part of.
    pub fn is_reached(&self, place: &Place) -> bool {
        let is_in = |it: &crate::reached::Reached| it.holds(self.program, self.state, place);
        self.program.reach.references && self.program.reached.as_ref().is_none_or(is_in)
    }

    fn globals(&self) -> Place {
        Place::root(Root::Globals, Type::Struct(self.program.globals))
    }
}

/// How the storage of two places of one body relates. A reference may lead to any variable that does not
/// live for one call; those whose addresses are taken have [fixed storage](crate::reference::fixed).
pub fn alias(frame: &Frame<'_>, a: &Place, b: &Place) -> Alias {
    if a.is_followed() || b.is_followed() {
        let is_apart = |it: &Place| !it.is_followed() && (is_local(it) || !frame.is_reached(it));
        return if is_apart(a) || is_apart(b) { Alias::No } else { Alias::May };
    }
    if a.root == b.root {
        return paths(&a.projections, &b.projections);
    }
    let meet = match (frame.is_private(a), frame.is_private(b)) {
        // No one else names a part of it.
        (true, _) => lies_in(frame, a, b),
        (_, true) => lies_in(frame, b, a),
        (false, false) => lies_in(frame, a, b) || lies_in(frame, b, a),
    };
    if meet { Alias::May } else { Alias::No }
}

fn is_local(place: &Place) -> bool {
    matches!(place.root, Root::Local(_))
}

/// Whether the root of `a` may be an object on the way to `b`, or a part of it, so that they meet.
fn lies_in(frame: &Frame<'_>, a: &Place, b: &Place) -> bool {
    let (Some(root), Some(mut ty)) = (frame.root_type(a.root), frame.root_type(b.root)) else { return false };
    for (at, projection) in b.projections.iter().enumerate() {
        if is_same(frame.program, ty, root) && paths(&a.projections, &b.projections[at..]) != Alias::No {
            return true;
        }
        match frame.program.part(ty, projection) {
            Some(part) => ty = part,
            None => return false,
        }
    }
    holds(frame.program, ty, root)
}

/// Two ways from one root, through no reference.
fn paths(a: &[Projection], b: &[Projection]) -> Alias {
    let mut found = Alias::Must;
    for pair in a.iter().zip(b) {
        match pair {
            (Projection::Field(a), Projection::Field(b)) if a == b => {}
            (Projection::Index { index: a, .. }, Projection::Index { index: b, .. }) => {
                match (a.as_const(), b.as_const()) {
                    (Some(a), Some(b)) if a == b => {}
                    (Some(_), Some(_)) => return Alias::No,
                    (Some(_) | None, None) | (None, Some(_)) => found = Alias::May,
                }
            }
            (Projection::Field(_), Projection::Field(_) | Projection::Index { .. })
            | (Projection::Index { .. }, Projection::Field(_)) => return Alias::No,
            (Projection::Deref { .. }, _) | (_, Projection::Deref { .. }) => return Alias::May,
        }
    }
    found
}

/// Whether `part` is, or by an index may be, `whole` or a part of it, by their names alone: of one root.
pub fn may_hold(whole: &Place, part: &Place) -> bool {
    whole.root == part.root
        && whole.projections.len() <= part.projections.len()
        && paths(&whole.projections, &part.projections) != Alias::No
}

/// How many fields two ways from one root begin with together.
pub fn common_fields(a: &[Projection], b: &[Projection]) -> usize {
    let same = |(a, b): &(&Projection, &Projection)| match (a, b) {
        (Projection::Field(a), Projection::Field(b)) => a == b,
        (Projection::Index { .. } | Projection::Deref { .. }, _)
        | (_, Projection::Index { .. } | Projection::Deref { .. }) => false,
    };
    a.iter().zip(b).take_while(same).count()
}

/// Whether one way from a root leads to a part of where the other leads, for who takes any two
/// elements of an array for one, as Rust's rules on `&mut` do: a narrower question than [`alias`],
/// and a coarser answer.
pub fn borrows_meet(a: &[Projection], b: &[Projection]) -> bool {
    a.iter().zip(b).all(|pair| match pair {
        (Projection::Field(a), Projection::Field(b)) => a == b,
        (Projection::Index { .. }, Projection::Index { .. }) => true,
        (Projection::Field(_), Projection::Index { .. }) | (Projection::Index { .. }, Projection::Field(_)) => false,
        (Projection::Deref { .. }, _) | (_, Projection::Deref { .. }) => true,
    })
}

/// Whether storage of one type is storage of the other. A pin's type may be said as another of its repr.
fn is_same(program: &Program, a: Type, b: Type) -> bool {
    let fits = shapes::fits(program, a, b) || shapes::fits(program, b, a);
    fits || program.repr(a).is_some_and(|repr| program.repr(b) == Some(repr))
}

/// Whether storage of a type is, or has in it, storage of another.
fn holds(program: &Program, whole: Type, part: Type) -> bool {
    let repr = program.repr(part);
    let is_pin = |it: &staunch_runtime::Pin| Some(it.ty.repr()) == repr;
    program.holds(whole, |it| match it {
        Type::Block(id) => id.info().pins.iter().any(is_pin) || is_same(program, it, part),
        _ => is_same(program, it, part),
    })
}

/// Whether the value of `expr` may depend on the contents of `place`.
pub fn reads(frame: &Frame<'_>, expr: &Expr, place: &Place) -> bool {
    let mut found = false;
    visit::reads(expr, &mut |it| found |= alias(frame, it, place) != Alias::No);
    found
}

/// Whether the value of `expr` may depend on what a callee writes that is passed nothing.
fn reads_shared(frame: &Frame<'_>, expr: &Expr) -> bool {
    let globals = frame.globals();
    let mut found = false;
    if frame.program.reach.references {
        // As long as it is not known which, a callee may reach any variable, also a local whose address it is passed.
        let is_known = frame.program.reached.is_some();
        visit::reads(expr, &mut |it| found |= !is_known || frame.is_reached(it));
    }
    visit::reads(expr, &mut |it| found |= !frame.is_private(it) && alias(frame, it, &globals) != Alias::No);
    found
}

/// Whether statements write `place` themselves, or hand on what may be a part of it or hold it.
pub fn writes(frame: &Frame<'_>, block: &[Statement], place: &Place) -> bool {
    let mut found = false;
    visit::statements(block, &mut |statement| {
        visit::accesses(statement, &mut |it, access| {
            found |= access != Access::Read && alias(frame, it, place) != Alias::No;
        });
    });
    found
}

/// Whether running `block` may change the value of `expr`. A callee may write what it is passed and
/// all that is global: bodies are checked in the order of the source, so that what a callee does is
/// not known where this is asked.
pub fn changes(frame: &Frame<'_>, block: &[Statement], expr: &Expr) -> bool {
    let mut found = false;
    visit::statements(block, &mut |statement| {
        let calls = matches!(statement.kind, StatementKind::Call { .. });
        found |= calls && reads_shared(frame, expr);
        visit::accesses(statement, &mut |place, access| found |= access != Access::Read && reads(frame, expr, place));
    });
    found
}

#[cfg(test)]
mod tests;
