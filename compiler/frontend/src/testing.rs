//! Unit tests in Structured Text. Each TEST becomes a POU of its own, with the variables and statements of
//! its file's SETUP before its own; a second scan runs TEARDOWN. The rest of a test is an ordinary body.

pub(crate) mod exchange;
pub(crate) mod fixture;
pub(crate) mod suite;
pub(crate) mod tree;

pub use fixture::{Fixture, FixtureCase};
pub use suite::Suite;

use crate::ast::{
    ArgumentKind, BinaryOp, Expr, ExprKind, File, Item, LiteralValue, Pou, PouKind, Statement, StatementKind, TestPart,
    UnaryOp, each_expr,
};
use crate::spelling::Key;
use crate::{Diagnostic, Sources, Span};
use rustc_hash::{FxHashMap, FxHashSet};
use std::sync::Arc;
use tree::{assign, is_named, literal, named, variables};

/// TRUE once SETUP has run, so that the next scan is for TEARDOWN.
const BEGUN: &str = "__begun";
/// The number of the assertion that failed, from 1.
pub(crate) const FAILED: &str = "__failed";
/// What ADVANCE_TIME calls.
pub(crate) const CLOCK: &str = "__clock";
/// Of a FUNCTION_BLOCK, where some test has a MOCK: its body does not run.
pub(crate) const MOCKED: &str = "__mocked";
/// How often a mocked instance was called.
pub(crate) const CALLS: &str = "__calls";

/// One TEST, as whoever runs it needs to know it.
#[derive(Clone, Debug)]
pub struct Test {
    pub title: String,
    pub span: Span,
    /// The instance of the program that is this test.
    pub instance: String,
    /// `failed` is the number of one of them, from 1, or 0.
    pub assertions: Arc<[Assertion]>,
    /// The variable that says which assertion failed.
    pub failed: String,
    /// A suite of TcUnit, which has tests of its own.
    pub suite: Option<Suite>,
    /// A fixture of AxUnit, which has tests of its own.
    pub fixture: Option<Fixture>,
}

/// The tests that have tests of their own, by their names' places.
#[derive(Default)]
pub(crate) struct Groups {
    pub suites: FxHashMap<Span, Suite>,
    pub fixtures: FxHashMap<Span, Fixture>,
    /// Where the names of fixtures are, and of the ABSTRACT CLASSes that are written for them.
    pub of_fixtures: FxHashSet<Span>,
    /// What AxUnit's mocks exchange.
    pub exchanged: exchange::Exchanged,
}

/// An assertion, and the variables that hold what it compared when it failed.
#[derive(Clone, Debug)]
pub struct Assertion {
    pub span: Span,
    /// What was expected, with `{}` where the value is, `to be greater than {}`, and `{tolerance}` where that is.
    pub wants: &'static str,
    /// Both values are texts.
    pub compares_texts: bool,
    pub actual: Option<String>,
    pub expected: Option<String>,
    pub tolerance: Option<String>,
    pub message: Option<String>,
}

impl Assertion {
    /// The variables that are looked at where it has failed.
    pub fn kept(&self) -> impl Iterator<Item = &String> {
        [&self.actual, &self.expected, &self.tolerance, &self.message].into_iter().flatten()
    }
}

/// The tests of the files become POUs, or, where they do not run, are left out.
pub(crate) fn expand<'s>(
    files: &mut [File<'s>],
    run: bool,
    sources: &'s Sources,
    diagnostics: &mut Vec<Diagnostic>,
) -> Groups {
    let is_test = |it: &Item<'_>| matches!(it, Item::Test(_));
    if !run {
        files.iter_mut().for_each(|it| it.items.retain(|it| !is_test(it)));
        let of_fixtures = fixture::places(files);
        fixture::leave_out(files);
        return Groups { of_fixtures, ..Groups::default() };
    }
    if files.iter().flat_map(|it| &it.items).any(mocks_an_instance) {
        let pous = files.iter_mut().flat_map(|it| &mut it.items).filter_map(|it| match it {
            Item::Pou(pou) if pou.kind == PouKind::FunctionBlock => Some(pou),
            Item::Pou(_) | Item::Types(_) | Item::Globals(_) | Item::Configuration(_) | Item::Test(_) => None,
        });
        pous.for_each(can_be_mocked);
    }
    let exchanged = exchange::expand(files, sources);
    for file in files.iter_mut() {
        // What a CONFIGURATION runs does not run together with the tests.
        let configurations = file.items.iter_mut().filter_map(|it| match it {
            Item::Configuration(it) => Some(it),
            Item::Pou(_) | Item::Types(_) | Item::Globals(_) | Item::Test(_) => None,
        });
        configurations.flat_map(|it| &mut it.resources).for_each(|it| it.programs.clear());
        let (tests, items): (Vec<_>, Vec<_>) = std::mem::take(&mut file.items).into_iter().partition(is_test);
        file.items = items;
        file.items.extend(whole_tests(tests).map(Item::Pou));
    }
    let of_fixtures = fixture::places(files);
    let fixtures = fixture::expand(files, sources, !exchanged.numbers.is_empty(), diagnostics);
    Groups { fixtures, suites: suite::expand(files), of_fixtures, exchanged }
}

/// Whether the sources hold unit tests.
pub(crate) fn has_tests(files: &[File<'_>]) -> bool {
    files.iter().flat_map(|it| &it.items).any(|it| matches!(it, Item::Test(_))) || !fixture::places(files).is_empty()
}

fn whole_tests<'s>(items: Vec<Item<'s>>) -> impl Iterator<Item = Pou<'s>> {
    let (mut blocks, mut setup, mut teardown, mut tests) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    for item in items {
        let Item::Test(unit) = item else { continue };
        match unit.part {
            TestPart::Test => tests.push(unit.pou),
            TestPart::Setup => {
                blocks.extend(unit.pou.blocks);
                setup.extend(unit.pou.body);
            }
            TestPart::Teardown => {
                blocks.extend(unit.pou.blocks);
                teardown.extend(unit.pou.body);
            }
        }
    }
    tests.into_iter().map(move |test| {
        let at = test.name.span;
        let hidden = [(BEGUN, &["BOOL"][..]), (FAILED, &["DINT"]), (CLOCK, &["IEC", "__ADVANCE_TIME"])];
        let mut all = vec![variables(&hidden, at)];
        all.extend(blocks.iter().cloned());
        all.extend(test.blocks);
        let mut first = vec![assign(BEGUN, literal(LiteralValue::Bool(true), at))];
        first.extend(setup.iter().cloned());
        first.extend(test.body);
        let begun = Expr { kind: ExprKind::Unary(UnaryOp::Not, Box::new(named(BEGUN, at))), span: at };
        let kind = StatementKind::If { branches: vec![(begun, first)], otherwise: Some(teardown.clone()) };
        Pou { blocks: all, body: vec![Statement { kind, span: at }], ..test }
    })
}

fn mocks_an_instance(item: &Item<'_>) -> bool {
    let Item::Test(unit) = item else { return false };
    let mut found = false;
    each_expr(&unit.pou.body, &mut |it| {
        found |= matches!(&it.kind, ExprKind::Call(callee, _) if is_named(callee, "MOCK"));
    });
    found
}

/// `IF __mocked THEN __calls := __calls + 1; RETURN; END_IF` before the body. METHODs run, but for those without a body.
fn can_be_mocked(pou: &mut Pou<'_>) {
    let at = pou.name.span;
    // What an heir inherits sees it, too.
    pou.blocks.insert(0, variables(&[(MOCKED, &["BOOL"]), (CALLS, &["DINT"])], at));
    pou.inherited += usize::from(pou.extends.is_some());
    let one = literal(LiteralValue::Integer { value: 1, based: false }, at);
    let sides = Box::new([named(CALLS, at), one]);
    let more = Expr { kind: ExprKind::Binary(sides, BinaryOp::Add, at), span: at };
    let counted = vec![assign(CALLS, more), Statement { kind: StatementKind::Return, span: at }];
    let kind = StatementKind::If { branches: vec![(named(MOCKED, at), counted)], otherwise: None };
    pou.body.insert(0, Statement { kind, span: at });
    for routine in pou.routines.iter_mut().filter(|it| it.is_stub) {
        let span = routine.name.span;
        let given_up = vec![Statement { kind: StatementKind::Return, span }];
        let kind = StatementKind::If { branches: vec![(named(MOCKED, span), given_up)], otherwise: None };
        routine.body.insert(0, Statement { kind, span });
    }
}

/// The last names of the FUNCTIONs that some test replaces, by the bodies of all POUs.
pub(crate) fn mocked_functions<'s>(bodies: &[Vec<Statement<'s>>]) -> FxHashSet<Key<'s>> {
    let mut names = FxHashSet::default();
    for body in bodies {
        each_expr(body, &mut |it| {
            let ExprKind::Call(callee, arguments) = &it.kind else { return };
            if let [function, _] = &arguments[..]
                && is_named(callee, "MOCK_FUNCTION")
                && let ArgumentKind::Positional(function) = &function.kind
                && let ExprKind::Name(name) | ExprKind::Member(_, name) = &function.kind
            {
                names.insert(Key(name.text));
            }
        });
    }
    names
}
