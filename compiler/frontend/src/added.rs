//! The variables that passes over the tree add to POUs. They are nobody's: no trace shows them.

/// Whether the initial values that need code have been assigned since the last start: those of a POU, those of globals.
pub(crate) const STARTED: [&str; 2] = ["__started", "__globals_started"];
/// The same of what is RETAIN, in a variable that is RETAIN.
pub(crate) const KEPT: [&str; 2] = ["__kept", "__globals_kept"];
/// What `bInitRetains` is, where something asks for it.
pub(crate) const RETAINS: &str = "__init_retains";
/// Whether the addresses have been assigned that static variables and variables of instances begin with.
pub(crate) const ADDRESSED: [&str; 2] = ["__stat_addressed", "__inst_addressed"];

/// Of a chart: the time between scans, the controls of the actions, and which transitions fire.
pub(crate) const CLOCK: &str = "__chart";
pub(crate) const ACTIONS: &str = "__actions";
pub(crate) const FIRED: &str = "__fired";

/// Whether a start-up PROGRAM has run.
pub(crate) const STARTED_UP: &str = "__started_up";

/// The ENO of each instance whose ENO is read.
pub(crate) const ENOS: &str = "__enos";

/// What the calls of EDGEPOS and its like were given last.
pub(crate) const EDGES: &str = "__edges";

pub(crate) fn is_added(name: &str) -> bool {
    let pairs = [STARTED, KEPT, ADDRESSED];
    pairs.iter().flatten().chain(&[RETAINS, CLOCK, ACTIONS, FIRED, STARTED_UP, ENOS, EDGES]).any(|it| *it == name)
}
