//! What unit tests add to a program: variables that keep what assertions compared, and mocks.

use crate::Span;
use crate::testing::Assertion;
use crate::testing::exchange::Exchanged;
use crate::testing::fixture::Caller;
use rustc_hash::{FxHashMap, FxHashSet};
use staunch_ir::{Place, Variable};

/// By the slots of POUs.
#[derive(Debug, Default)]
pub(crate) struct Tests {
    /// The variables that a TEST's assertions have added.
    pub kept: FxHashMap<usize, Vec<Variable>>,
    /// The assertions of a TEST, in order: the first is number 1.
    pub assertions: FxHashMap<usize, Vec<Assertion>>,
    /// The assertions of TcUnit's suites and AxUnit's fixtures, in order.
    pub shared: Vec<Assertion>,
    /// The global that is the number of the first of these that failed.
    pub broken: Option<(String, Place)>,
    /// Where the names of AxUnit's fixtures are, those that are ABSTRACT too.
    pub fixtures: FxHashSet<Span>,
    /// The inputs that have the place of a call, by their names' places.
    pub callers: FxHashMap<Span, Caller>,
    /// The FUNCTIONs that some test replaces.
    pub mocks: FxHashMap<usize, FunctionMock>,
    /// What AxUnit's mocks exchange.
    pub exchanged: Exchanged,
}

/// Globals: whether a FUNCTION is replaced, the value that it then has, and how often it was called since.
#[derive(Clone, Debug)]
pub(crate) struct FunctionMock {
    pub active: Place,
    pub value: Place,
    pub calls: Place,
}
