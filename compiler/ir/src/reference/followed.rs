//! How places lead through references.

use super::table::wanted;
use crate::{BlockId, FieldId, Location, Place, Program, Projection, Type, visit};

/// A place reached through a reference, in its parts.
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
    /// How many steps of the way lead to an element of an array that is pointed to: the element is looked up as
    /// what it is, since the array is most often declared larger than the variable.
    pub fn subscripts(&self) -> usize {
        let is_subscript = |it: &&Projection| matches!(it, Projection::Index { .. });
        self.way.iter().take_while(is_subscript).count()
    }

    /// The type of that element.
    pub fn looked_up(&self, program: &Program) -> Option<Type> {
        self.way[..self.subscripts()].iter().try_fold(self.target, |ty, it| program.part(ty, it))
    }
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
