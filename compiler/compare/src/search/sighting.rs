//! What a scan can show, and on what: the same counter, block or variable in every scan.

use crate::difference::pitfall::Pitfall;
use crate::pair::Matched;
use staunch_ir::Location;

/// What a pitfall was seen on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Subject {
    /// A counter, by its position among those of the pair.
    Counter(usize),
    /// Another block, by its position among those of the pair.
    Block(usize),
    /// A variable that an event parts, by its scalars.
    Variable(Matched),
    /// A variable that the two systems compute in other types, by its position among the candidates.
    Computed(usize),
    /// A variable that is accepted to differ, or that does for no known reason.
    Parted(Matched),
    /// An output that is accepted to follow from what is accepted.
    Output(Matched),
    /// A fault on one side, and where.
    Fault(usize, Location),
}

pub type Sighting = (Subject, Option<Pitfall>);
