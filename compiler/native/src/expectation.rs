//! Where variables that references lead to are expected.

use staunch_ir::reference::{Step, Target, Targets};
use staunch_ir::{Repr, Type};

/// Where a variable is expected: in an object, from a byte of the state on.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Expectation {
    pub(crate) object: u32,
    pub(crate) offset: u32,
    pub(crate) which: Which,
}

#[derive(Clone, Copy, Debug)]
pub(crate) enum Which {
    /// One variable.
    One,
    /// Each of so many elements of this size.
    Elements { stride: u64, len: u64 },
    /// A number that begins at any byte up to this one.
    Anywhere { last: u64 },
}

/// Code compares with so many; where more are expected, it asks the table at once.
const MOST: usize = 4;

/// Where variables of a type are expected; nothing where they may be in many places.
pub(crate) fn expectations(targets: &Targets<'_>, ty: Type) -> Vec<Expectation> {
    let number = match ty {
        Type::Elementary(it) if it.repr() != Repr::Bool => Some(u64::from(it.repr().size())),
        _ => None,
    };
    let plain: Vec<_> = number.iter().flat_map(|_| targets.plain()).take(MOST + 1).collect();
    let is_plain = |it: &&Target| plain.iter().any(|(object, ..)| *object == it.object);
    let numbers = plain.iter().filter_map(|it| anywhere(*it, number?)).map(Some);
    let found: Option<Vec<_>> = match plain.len() {
        ..=MOST => numbers.chain(targets.lead_to(ty).iter().filter(|it| !is_plain(it)).map(expectation)).collect(),
        _ => None,
    };
    found.filter(|it| it.len() <= MOST).unwrap_or_default()
}

fn anywhere((object, offset, size): (u32, u64, u64), of_number: u64) -> Option<Expectation> {
    let which = Which::Anywhere { last: size.checked_sub(of_number)? };
    Some(Expectation { object, offset: u32::try_from(offset).ok()?, which })
}

/// `None` if there are gaps between the elements.
fn expectation(target: &Target) -> Option<Expectation> {
    let mut which = Which::One;
    for step in &target.way {
        which = match (which, step) {
            (_, Step::Field(_) | Step::Element(_)) => which,
            (Which::One, Step::Each { stride, len }) => Which::Elements { stride: *stride, len: *len },
            (Which::Elements { stride: outer, len: rows }, Step::Each { stride, len }) if outer == stride * len => {
                Which::Elements { stride: *stride, len: rows * len }
            }
            (Which::Elements { .. } | Which::Anywhere { .. }, Step::Each { .. }) => return None,
        };
    }
    Some(Expectation { object: target.object, offset: u32::try_from(target.offset).ok()?, which })
}
