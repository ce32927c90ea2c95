//! TcUnit's suites: a FUNCTION_BLOCK that extends `TcUnit.FB_TestSuite`, itself or by another. Each becomes a test that
//! calls it in scan after scan; which tests it has is known when it has run.

use super::tree::{assign, named, statement};
use crate::Span;
use crate::ast::{
    ArgumentKind, Construction, Expr, ExprKind, File, Item, Literal, LiteralValue, Name, Pou, PouKind, Statement,
    StatementKind, TypeKind, TypeSpec, UnaryOp, VarBlock, VarDecl, VarKind, each_expr,
};
use crate::spelling::Key;
use rustc_hash::{FxHashMap, FxHashSet};

/// The library's suite.
const BASE: &str = "FB_TestSuite";
pub(crate) const LIBRARY: &str = "TcUnit";
/// A variable of every suite: the test whose first failure is kept.
pub(crate) const WANTED: &str = "__wanted";
/// Notes a failure, and says whether what was compared is to be kept.
pub(crate) const FAILS: &str = "__FAILS";
/// Of the test of a suite: the suite, and whether all of its tests are finished.
pub(crate) const SUITE: &str = "__suite";
const OVER: &str = "__over";
const NEXT_CYCLE: &str = "__NEXT_CYCLE";
const FINISHED: &str = "AreAllTestsFinished";
/// What begins a test.
const BEGINNINGS: [&str; 2] = ["TEST", "TEST_ORDERED"];
/// What ends one by its name.
const END: &str = "TEST_FINISHED_NAMED";

/// A suite, as its source shows it.
#[derive(Clone, Debug)]
pub struct Suite {
    /// The titles that are written as texts, and where.
    pub titles: Vec<(String, Span)>,
    /// The same of those that are said to be finished by their names.
    pub finished: Vec<(String, Span)>,
    /// Other tests have titles that are known when they run.
    pub is_open: bool,
}

/// `EXTENDS FB_TestSuite`, where the library's is meant.
pub(crate) fn qualify(files: &mut [File<'_>]) {
    if pous(files).any(|it| is_library(it) && it.blocks.is_empty()) {
        return;
    }
    let pous = files.iter_mut().flat_map(|it| &mut it.items).filter_map(|it| match it {
        Item::Pou(pou) => Some(pou),
        Item::Types(_) | Item::Globals(_) | Item::Configuration(_) | Item::Test(_) => None,
    });
    for pou in pous {
        for path in &mut pou.bases {
            if let [name] = path[..]
                && Key(name.text) == Key(BASE)
            {
                *path = vec![Name { text: LIBRARY, span: name.span }, name];
            }
        }
    }
}

fn is_library(pou: &Pou<'_>) -> bool {
    Key(pou.name.text) == Key(BASE) && pou.extends.is_none()
}

fn pous<'a, 's>(files: &'a [File<'s>]) -> impl Iterator<Item = &'a Pou<'s>> {
    files.iter().flat_map(|it| &it.items).filter_map(|it| match it {
        Item::Pou(pou) => Some(pou),
        Item::Types(_) | Item::Globals(_) | Item::Configuration(_) | Item::Test(_) => None,
    })
}

/// The names of the FUNCTION_BLOCKs that are suites, as they are written.
pub(crate) fn names<'a>(files: &'a [File<'_>]) -> FxHashSet<Key<'a>> {
    let mut names = FxHashSet::from_iter([Key(BASE)]);
    // Each turn finds what extends the suites found before.
    loop {
        let before = names.len();
        for pou in pous(files) {
            if pou.extends.is_some_and(|it| names.contains(&Key(it.text))) {
                names.insert(Key(pou.name.text));
            }
        }
        if names.len() == before {
            return names;
        }
    }
}

/// `TcUnit.RUN();`: what runs the suites of a program, which are tests here.
pub(crate) fn runs_suites(statement: &Statement<'_>) -> bool {
    let StatementKind::Expr(Expr { kind: ExprKind::Call(callee, _), .. }) = &statement.kind else { return false };
    let path = callee.path();
    path.is_some_and(|it| matches!(&it[..], [library, _] if Key(library.text) == Key(LIBRARY)))
}

/// Whether a FUNCTION_BLOCK, with all that it inherits, is a suite.
pub(crate) fn is_suite(pou: &Pou<'_>) -> bool {
    pou.extends.is_some() && pou.routines.iter().any(|it| it.home.is_some() && it.name.text == FAILS)
}

/// A test for each suite that is not ABSTRACT. One that others extend runs where a variable is one of it.
pub(crate) fn expand<'s>(files: &mut [File<'s>]) -> FxHashMap<Span, Suite> {
    let mut suites = FxHashMap::default();
    let instances = instances(files);
    let extended: FxHashSet<Key<'s>> = pous(files).filter_map(|it| it.extends).map(|it| Key(it.text)).collect();
    for file in files {
        let runs = |it: &&Pou<'s>| {
            let key = Key(it.name.text);
            is_suite(it)
                && it.modifiers.is_abstract.is_none()
                && (!extended.contains(&key) || instances.contains_key(&key))
        };
        let of_file = file.items.iter().filter_map(|it| match it {
            Item::Pou(pou) => Some(pou),
            Item::Types(_) | Item::Globals(_) | Item::Configuration(_) | Item::Test(_) => None,
        });
        let mut tests = Vec::new();
        for pou in of_file.filter(runs) {
            suites.insert(pou.name.span, titles(pou));
            let construction = instances.get(&Key(pou.name.text)).cloned().flatten();
            tests.push(Item::Pou(test(pou, construction)));
        }
        file.items.extend(tests);
    }
    suites
}

/// The types of the variables, each with what the first variable of it hands to its start.
type Instances<'s> = FxHashMap<Key<'s>, Option<Box<Construction<'s>>>>;

fn instances<'s>(files: &[File<'s>]) -> Instances<'s> {
    let of_pous = pous(files).flat_map(|it| &it.blocks);
    let globals = files.iter().flat_map(|it| &it.items).filter_map(|it| match it {
        Item::Globals(block) => Some(block),
        Item::Pou(_) | Item::Types(_) | Item::Configuration(_) | Item::Test(_) => None,
    });
    let mut found = Instances::default();
    for var in of_pous.chain(globals).flat_map(|it| &it.vars) {
        if let TypeKind::Named(path) = &var.ty.kind
            && let Some(name) = path.last()
        {
            found.entry(Key(name.text)).or_insert_with(|| var.construction.clone());
        }
    }
    found
}

/// `__suite.__NEXT_CYCLE(); __suite(); __over := …`, until all tests are finished.
fn test<'s>(suite: &Pou<'s>, construction: Option<Box<Construction<'s>>>) -> Pou<'s> {
    let at = suite.name.span;
    let variable = |name: &'static str, ty: Vec<Name<'s>>| {
        let ty = TypeSpec { kind: TypeKind::Named(ty), span: at };
        VarDecl::new(vec![Name { text: name, span: at }], ty, at)
    };
    let instance = VarDecl { construction, ..variable(SUITE, vec![suite.name]) };
    let vars = vec![instance, variable(OVER, vec![Name { text: "BOOL", span: at }])];
    let block = VarBlock { vars, ..VarBlock::new(VarKind::Var, at) };
    let expr = |kind| Expr { kind, span: at };
    let member = |name: &'static str| expr(ExprKind::Member(Box::new(named(SUITE, at)), Name { text: name, span: at }));
    let call = |callee| expr(ExprKind::Call(Box::new(callee), Vec::new()));
    let cycle = vec![
        statement(StatementKind::Expr(call(member(NEXT_CYCLE))), at),
        statement(StatementKind::Expr(call(named(SUITE, at))), at),
        assign(OVER, call(member(FINISHED))),
    ];
    let goes_on = expr(ExprKind::Unary(UnaryOp::Not, Box::new(named(OVER, at))));
    let body = vec![statement(StatementKind::If { branches: vec![(goes_on, cycle)], otherwise: None }, at)];
    Pou { blocks: vec![block], body, ..Pou::new(PouKind::Test, suite.name, at) }
}

/// The titles in the bodies of a suite, those that it inherits too.
fn titles(suite: &Pou<'_>) -> Suite {
    let mut found = Suite { titles: Vec::new(), finished: Vec::new(), is_open: false };
    let own = suite.routines.iter().filter(|it| !it.name.text.starts_with("__"));
    for body in [&suite.body].into_iter().chain(own.map(|it| &it.body)) {
        each_expr(body, &mut |it| {
            let ExprKind::Call(callee, arguments) = &it.kind else { return };
            let name = match &callee.kind {
                ExprKind::Name(name) | ExprKind::Member(_, name) => name,
                _ => return,
            };
            let is_end = Key(END) == Key(name.text);
            if !is_end && !BEGINNINGS.iter().any(|it| Key(it) == Key(name.text)) {
                return;
            }
            let value = arguments.first().map(|it| &it.kind);
            let (Some(ArgumentKind::Positional(title)) | Some(ArgumentKind::Input(_, title))) = value else { return };
            match &title.bare().kind {
                ExprKind::Literal(Literal { value: LiteralValue::String(text), .. }) => {
                    let written = shown(&text.text());
                    let known = if is_end { &mut found.finished } else { &mut found.titles };
                    if !known.iter().any(|it| it.0 == written) {
                        known.push((written, title.span));
                    }
                }
                _ => found.is_open |= !is_end,
            }
        });
    }
    found
}

/// A title without blanks around it, and without what disables its test.
fn shown(title: &str) -> String {
    const DISABLED: &str = "disabled_";
    let title = title.trim_matches(' ');
    match title.split_at_checked(DISABLED.len()) {
        Some((before, after)) if before.eq_ignore_ascii_case(DISABLED) => after.to_owned(),
        Some(_) | None => title.to_owned(),
    }
}
