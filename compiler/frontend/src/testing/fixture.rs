//! AxUnit, the unit tests of Siemens AX: a CLASS with `{TestFixture}` before it, whose METHODs with `{Test}` are tests,
//! or a FUNCTION with `{Test}`. Each fixture becomes a test that calls one of its tests in each scan: who runs it
//! says which.

use super::tree::{literal, named, statement};
use crate::ast::{
    Argument, Arm, Expr, ExprKind, File, Item, Label, LiteralValue, Name, Pou, PouKind, Statement, StatementKind,
    TestPragma, TypeKind, TypeSpec, VarBlock, VarDecl, VarKind,
};
use crate::{Code, Diagnostic, Sources, Span};
use rustc_hash::{FxHashMap, FxHashSet};

/// Of the test of a fixture: the instance, and what is to be done in a scan: the number of the test, from 1, and
/// whether it is the first and the last that runs.
const INSTANCE: &str = "__fixture";
const NUMBER: &str = "__test";
const FIRST: &str = "__first";
const LAST: &str = "__last";

/// A pragma that says what a CLASS or METHOD is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Mark {
    Fixture,
    Setup(Setup),
}

/// When a METHOD that is not a test is called.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Setup {
    First,
    Before,
    After,
    Last,
}

const MARKS: [(&str, Mark); 5] = [
    ("TestFixture", Mark::Fixture),
    ("FixtureSetup", Mark::Setup(Setup::First)),
    ("TestSetup", Mark::Setup(Setup::Before)),
    ("TestTearDown", Mark::Setup(Setup::After)),
    ("FixtureTearDown", Mark::Setup(Setup::Last)),
];

/// Pragmas of AxUnit before parameters.
const OF_CALLERS: [(&str, Caller); 2] = [("CallerLineNumber", Caller::Line), ("CallerFilePath", Caller::Path)];

/// What an input has where a call leaves it out: the place of the call.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Caller {
    Line,
    Path,
}

/// The tests of a fixture, in the order in which they run.
#[derive(Clone, Debug)]
pub struct Fixture {
    pub cases: Vec<FixtureCase>,
}

#[derive(Clone, Debug)]
pub struct FixtureCase {
    /// The METHOD and the arguments, `.Adds(a := 1)`; of a FUNCTION the arguments alone.
    pub title: String,
    pub span: Span,
}

impl Fixture {
    /// The variables that say what a scan does: the number of the test, whether it is the first and the last.
    pub const STEPS: [&'static str; 3] = [NUMBER, FIRST, LAST];
}

/// Whether a pragma is one of AxUnit's.
pub(crate) fn is_pragma(text: &str) -> bool {
    let mut words = MARKS.iter().map(|it| it.0).chain(OF_CALLERS.iter().map(|it| it.0)).chain(["Test"]);
    let word = text.trim().split(['(', ' ']).next().unwrap_or_default();
    words.any(|it| it.eq_ignore_ascii_case(word))
}

/// What is before each CLASS, FUNCTION and METHOD, by the place where these start.
#[derive(Default)]
struct Marks<'s> {
    marks: FxHashMap<Span, Vec<(Mark, Span)>>,
    tests: FxHashMap<Span, Vec<TestPragma<'s>>>,
}

impl<'s> Marks<'s> {
    fn of(files: &[File<'s>]) -> Self {
        let mut all = Self::default();
        for file in files {
            if !file.pragmas.iter().any(|it| is_pragma(it.text)) {
                continue;
            }
            let pous = file.items.iter().filter_map(|it| match it {
                Item::Pou(pou) => Some(pou),
                Item::Types(_) | Item::Globals(_) | Item::Configuration(_) | Item::Test(_) => None,
            });
            // What is inherited is in the file of the base.
            let own = pous.flat_map(|it| it.routines.iter().filter(|it| it.home.is_none()).chain([it]));
            let mut starts: Vec<Span> = own.map(|it| it.span).collect();
            starts.sort_by_key(|it| it.start);
            let after = |place: Span| starts.get(starts.partition_point(|it| it.start < place.end)).copied();
            for pragma in &file.pragmas {
                let mark = MARKS.iter().find(|it| it.0.eq_ignore_ascii_case(pragma.text.trim()));
                if let (Some((_, mark)), Some(pou)) = (mark, after(pragma.span)) {
                    all.marks.entry(pou).or_default().push((*mark, pragma.span));
                }
            }
            for pragma in &file.test_pragmas {
                if let Some(pou) = after(pragma.span) {
                    all.tests.entry(pou).or_default().push(pragma.clone());
                }
            }
        }
        all
    }

    fn is_empty(&self) -> bool {
        self.marks.is_empty() && self.tests.is_empty()
    }

    fn tests_of(&self, pou: &Pou<'s>) -> &[TestPragma<'s>] {
        self.tests.get(&pou.span).map_or(&[], Vec::as_slice)
    }

    fn is_fixture(&self, pou: &Pou<'s>) -> bool {
        let is_class = matches!(pou.kind, PouKind::Class | PouKind::FunctionBlock);
        let has_tests = pou.kind == PouKind::Function && !self.tests_of(pou).is_empty();
        let is_marked = self.marks.get(&pou.span).into_iter().flatten().any(|it| it.0 == Mark::Fixture);
        has_tests || is_class && is_marked && pou.modifiers.is_abstract.is_none()
    }

    /// Whether it is an ABSTRACT CLASS that is written for fixtures.
    fn is_base(&self, pou: &Pou<'s>) -> bool {
        let is_marked = |it: &Pou<'s>| self.marks.contains_key(&it.span) || self.tests.contains_key(&it.span);
        pou.modifiers.is_abstract.is_some() && (is_marked(pou) || pou.routines.iter().any(is_marked))
    }
}

/// The inputs that have the place of a call where it leaves them out, by their names' places.
pub(crate) fn callers(files: &[File<'_>]) -> FxHashMap<Span, Caller> {
    let mut found = FxHashMap::default();
    for file in files {
        let mut names: Vec<Span> = Vec::new();
        for pragma in &file.pragmas {
            let known = OF_CALLERS.iter().find(|it| it.0.eq_ignore_ascii_case(pragma.text.trim()));
            let Some((_, caller)) = known else { continue };
            if names.is_empty() {
                let pous = file.items.iter().filter_map(|it| match it {
                    Item::Pou(pou) => Some(pou),
                    Item::Types(_) | Item::Globals(_) | Item::Configuration(_) | Item::Test(_) => None,
                });
                let blocks = pous.flat_map(|it| it.routines.iter().chain([it])).flat_map(|it| &it.blocks);
                let inputs = blocks.filter(|it| it.kind == VarKind::Input).flat_map(|it| &it.vars);
                names.extend(inputs.flat_map(|it| &it.names).map(|it| it.span));
                names.sort_by_key(|it| it.start);
            }
            if let Some(name) = names.get(names.partition_point(|it| it.start < pragma.span.end)) {
                found.insert(*name, *caller);
            }
        }
    }
    found
}

/// Where the names of the fixtures are, and of the ABSTRACT CLASSes that these extend: they are not part of the program under test.
pub(crate) fn places(files: &[File<'_>]) -> FxHashSet<Span> {
    let marks = Marks::of(files);
    if marks.is_empty() {
        return FxHashSet::default();
    }
    let items = files.iter().flat_map(|it| &it.items);
    let fixtures = items.filter_map(|it| match it {
        Item::Pou(pou) if marks.is_fixture(pou) || marks.is_base(pou) => Some(pou.name.span),
        Item::Pou(_) | Item::Types(_) | Item::Globals(_) | Item::Configuration(_) | Item::Test(_) => None,
    });
    fixtures.collect()
}

/// The fixtures are left out.
pub(crate) fn leave_out(files: &mut [File<'_>]) {
    let marks = Marks::of(files);
    if !marks.is_empty() {
        for file in files {
            file.items.retain(|it| !matches!(it, Item::Pou(pou) if marks.is_fixture(pou)));
        }
    }
}

/// A test for each fixture; the fixtures, by their names' places.
pub(crate) fn expand(
    files: &mut [File<'_>],
    sources: &Sources,
    has_mocks: bool,
    diagnostics: &mut Vec<Diagnostic>,
) -> FxHashMap<Span, Fixture> {
    let marks = Marks::of(files);
    let mut fixtures = FxHashMap::default();
    if marks.is_empty() {
        return fixtures;
    }
    for file in files {
        let mut tests = Vec::new();
        for item in &file.items {
            let Item::Pou(pou) = item else { continue };
            if marks.is_fixture(pou) {
                let written = Written::of(pou, &marks, diagnostics);
                tests.push(Item::Pou(written.test(pou, has_mocks)));
                let case = |it: Test<'_, '_>| FixtureCase { title: it.title(sources), span: it.pragma.span };
                fixtures.insert(pou.name.span, Fixture { cases: written.tests.into_iter().map(case).collect() });
            } else {
                report_without_fixture(pou, &marks, diagnostics);
            }
        }
        file.items.extend(tests);
    }
    fixtures
}

/// `{Test}` in a CLASS that is not a fixture: it would never run.
fn report_without_fixture<'s>(pou: &Pou<'s>, marks: &Marks<'s>, diagnostics: &mut Vec<Diagnostic>) {
    let is_extended = pou.modifiers.is_abstract.is_some();
    let own = pou.routines.iter().filter(|it| it.home.is_none() && !is_extended);
    for test in own.filter_map(|it| marks.tests_of(it).first()) {
        let class = pou.name.text;
        diagnostics.push(
            Diagnostic::new(Code::W0102, test.span, format!("this test does not run: `{class}` is not a fixture"))
                .label("the METHOD that follows it is never called")
                .help(format!("write `{{TestFixture}}` before `CLASS {class}`")),
        );
    }
}

/// A fixture as it is written.
struct Written<'a, 's> {
    setups: Vec<(Setup, &'a Pou<'s>)>,
    tests: Vec<Test<'a, 's>>,
}

struct Test<'a, 's> {
    /// `None` where the fixture is itself the test, a FUNCTION.
    method: Option<&'a Pou<'s>>,
    pragma: &'a TestPragma<'s>,
}

impl Test<'_, '_> {
    fn title(&self, sources: &Sources) -> String {
        let method = self.method.map_or_else(String::new, |it| format!(".{}", it.name.text));
        let given = |it: &Argument<'_>| sources.text(it.span).split_whitespace().collect::<Vec<_>>().join(" ");
        let given: Vec<_> = self.pragma.arguments.iter().map(given).collect();
        if given.is_empty() { method } else { format!("{method}({})", given.join(", ")) }
    }
}

impl<'a, 's> Written<'a, 's> {
    fn of(pou: &'a Pou<'s>, marks: &'a Marks<'s>, diagnostics: &mut Vec<Diagnostic>) -> Self {
        let mut written = Self { setups: Vec::new(), tests: Vec::new() };
        written.tests.extend(marks.tests_of(pou).iter().map(|pragma| Test { method: None, pragma }));
        let is_class = pou.kind != PouKind::Function;
        let mut methods: Vec<_> = pou.routines.iter().filter(|it| is_class && !it.is_hidden).collect();
        // The order in which AxUnit runs them.
        methods.sort_by(|a, b| a.name.text.cmp(b.name.text));
        for method in methods {
            for (mark, place) in marks.marks.get(&method.span).into_iter().flatten() {
                let Mark::Setup(setup) = *mark else { continue };
                match written.setups.iter().find(|it| it.0 == setup) {
                    Some((_, first)) => diagnostics.push(
                        Diagnostic::new(Code::E0106, *place, "a fixture can have only one METHOD of this kind")
                            .label("a second one")
                            .other(first.name.span, "the first one"),
                    ),
                    None => written.setups.push((setup, method)),
                }
            }
            written.tests.extend(marks.tests_of(method).iter().map(|pragma| Test { method: Some(method), pragma }));
        }
        written
    }

    /// ```text
    /// IF __first THEN __fixture.Setup(); END_IF
    /// __fixture.Before();
    /// CASE __test OF 1: __fixture.Test1(); … END_CASE
    /// __fixture.After();
    /// AxUnit.Mocking.__exchange_back();
    /// IF __last THEN … END_IF
    /// ```
    fn test(&self, pou: &Pou<'s>, has_mocks: bool) -> Pou<'s> {
        let at = pou.name.span;
        let mut body = Vec::new();
        let when = |condition: &'static str, setup| {
            let calls = self.calls(setup);
            let branches = vec![(named(condition, at), calls)];
            statement(StatementKind::If { branches, otherwise: None }, at)
        };
        body.push(when(FIRST, Setup::First));
        body.extend(self.calls(Setup::Before));
        let arms = self.tests.iter().zip(1u32..).map(|(test, number)| {
            let low = literal(LiteralValue::Integer { value: u64::from(number), based: false }, at);
            let callee = match test.method {
                Some(method) => member(method.name, test.pragma.span),
                None => Expr { kind: ExprKind::Name(pou.name), span: test.pragma.span },
            };
            let body = vec![call(callee, test.pragma.arguments.clone())];
            Arm { labels: vec![Label { low, high: None }], body }
        });
        let arms: Vec<_> = arms.collect();
        if !arms.is_empty() {
            body.push(statement(StatementKind::Case { selector: named(NUMBER, at), arms, otherwise: None }, at));
        }
        body.extend(self.calls(Setup::After));
        body.extend(has_mocks.then(|| super::exchange::back(at)));
        body.push(when(LAST, Setup::Last));
        let variable = |name: &'static str, ty: Name<'s>| {
            let ty = TypeSpec { kind: TypeKind::Named(vec![ty]), span: at };
            VarDecl::new(vec![Name { text: name, span: at }], ty, at)
        };
        let of = |text: &'static str| Name { text, span: at };
        let mut vars = vec![variable(NUMBER, of("DINT")), variable(FIRST, of("BOOL")), variable(LAST, of("BOOL"))];
        if pou.kind != PouKind::Function {
            vars.push(variable(INSTANCE, pou.name));
        }
        let block = VarBlock { vars, ..VarBlock::new(VarKind::Var, at) };
        Pou { blocks: vec![block], body, ..Pou::new(PouKind::Test, pou.name, at) }
    }

    fn calls(&self, setup: Setup) -> Vec<Statement<'s>> {
        let of = self.setups.iter().filter(|it| it.0 == setup);
        of.map(|(_, method)| call(member(method.name, method.name.span), Vec::new())).collect()
    }
}

fn member<'s>(method: Name<'s>, span: Span) -> Expr<'s> {
    Expr { kind: ExprKind::Member(Box::new(named(INSTANCE, span)), method), span }
}

fn call<'s>(callee: Expr<'s>, arguments: Vec<Argument<'s>>) -> Statement<'s> {
    let span = callee.span;
    statement(StatementKind::Expr(Expr { kind: ExprKind::Call(Box::new(callee), arguments), span }), span)
}
