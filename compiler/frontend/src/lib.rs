//! Structured Text in, typed intermediate representation out.
#![forbid(unsafe_code)]

mod absent;
mod added;
mod chart;
mod declared;
mod enabled;
mod index;
mod said_once;
mod testing;

mod automation_studio;
mod mutate;
mod pooled;
mod start;
mod start_up;
mod tasks;

mod allow;
mod dialect;
mod inherit;
mod locate;
mod log;
mod names;
mod options;
mod prelude;
mod types;

mod expr;

mod declare;

mod body;

mod library;

mod program;

mod lints;

pub use staunch_syntax::{ast, format, vendor};

pub use diagnostic::{
    Code, Diagnostic, Fix, Format, Label, Level, Levels, Missing, Severity, Style, Subject, excerpt, render,
};
pub use dialect::{Dialect, rules};
pub use index::{Asked, DefId, Definition, DefinitionKind, Index, Meaning, Offer, Stop, Use};
pub use mutate::{Mutant, mutants};
pub use names::functions::standard_functions;
pub use options::{AskedAt, OPEN_OPTIONS, OpenOption, Options, Question, Stops};
pub use parse::{parse, parse_file};
pub use prelude::{Declares, Unit as LibraryUnit, every_unit as library};
pub use source::{Source, Sources, Span};
pub use spelling::nearest;
pub use testing::{Assertion, Fixture, FixtureCase, Suite, Test};
pub use types::coverage::{Condition, CoverageKind, CoveragePoint, Decision, Formula};
pub use vendor::Reference;

use staunch_syntax::{diagnostic, foreign, lex, parse, source, spelling};

use index::recorder::Recorder;
use lex::{Declared, Known};
use log::Log;
use rustc_hash::FxHashSet;
use staunch_ir::{Program, in_threads};
use types::coverage::Coverage;
use types::declarations::Declarations;
use types::whole::Whole;
use vendor::{Problem, Trouble};

/// What came out of a compilation.
#[derive(Debug)]
pub struct Compilation {
    /// Verified, unless there was an error.
    pub program: Option<Program>,
    /// In the order of files and lines.
    pub diagnostics: Vec<Diagnostic>,
    /// The unit tests that the program's instances are.
    pub tests: Vec<Test>,
    /// Where execution is counted.
    pub coverage: Vec<CoveragePoint>,
    /// Where a move to another system changes a pin's name, and the new one, whether the lint is allowed or not.
    pub renamed: Vec<Fix>,
    /// Where such a move changes how an address is written.
    pub readdressed: Vec<Fix>,
}

impl Compilation {
    /// There is nothing but what was reported.
    pub fn rejected(diagnostics: Vec<Diagnostic>) -> Self {
        let (tests, coverage, renamed, readdressed) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        Self { program: None, diagnostics, tests, coverage, renamed, readdressed }
    }

    /// Leaves of what was reported what a user is to see, in the order of the files.
    fn settle(&mut self, sources: &Sources, allowances: &allow::Allowances) {
        library::of_own_sources(&mut self.diagnostics, sources);
        // SETUP is a part of each test.
        self.diagnostics.dedup_by(|a, b| a.span == b.span && a.repeats(b));
        let renamed = self.diagnostics.iter().filter(|it| it.code == Code::W0609);
        self.renamed = renamed.filter_map(|it| it.fix.clone()).collect();
        self.diagnostics.retain(|it| !allowances.cover(it));
        // A text of pieces is not in the order of its file, and may repeat a part of it: a contact on two wires.
        let place = |it: &Diagnostic| sources.get(it.span.file).in_file(it.span);
        let mut seen = FxHashSet::default();
        self.diagnostics.retain(|it| {
            let is_assembled = sources.get(it.span.file).is_assembled();
            !is_assembled || seen.insert((it.code, it.span.file, place(it), it.message.clone()))
        });
        self.diagnostics.sort_by_key(|it| (it.span.file, place(it).start));
    }

    pub fn has_errors(&self) -> bool {
        self.diagnostics.iter().any(|it| it.severity == Severity::Error)
    }

    /// Adds what else there is to say of the same sources.
    fn add(&mut self, diagnostics: Vec<Diagnostic>) {
        for it in diagnostics {
            let is_known = |known: &Diagnostic| known.span == it.span && known.repeats(&it);
            if !self.diagnostics.iter().any(is_known) {
                self.diagnostics.push(it);
            }
        }
        self.diagnostics.sort_by_key(|it| (it.span.file, it.span.start, it.span.end, it.code));
        if self.has_errors() {
            self.program = None;
        }
    }
}

/// Checks the sources as one program; the order of files does not matter.
pub fn compile(sources: &Sources, options: &Options) -> Compilation {
    with_library(sources, options, Bodies::Kept, None)
}

/// What [`compile`] has to say, in less memory: each body is dropped when it has been checked.
pub fn check(sources: &Sources, options: &Options) -> Vec<Diagnostic> {
    with_library(sources, options, Bodies::Dropped, None).diagnostics
}

/// What [`check`] has to say, and what the sources' names mean, or as much of that as is `asked`. Where they use the library, its
/// units are files after theirs: the sources are given back with these. Of what was stopped, the index is not whole.
pub fn index(sources: &Sources, options: &Options, asked: Asked, stop: &Stop) -> (Index, Option<Sources>) {
    let mut index = Index::asked(asked, stop.clone());
    let (diagnostics, extended) = match prelude::Extended::of(sources, options) {
        Some(extended) => {
            let found = run(&extended.sources, options, Bodies::Dropped, Some(&mut index)).diagnostics;
            (extended.of_the_user(found), Some(extended.sources))
        }
        None => (run(sources, options, Bodies::Dropped, Some(&mut index)).diagnostics, None),
    };
    index.diagnostics = diagnostics;
    (index, extended)
}

/// A source without what is written in its bodies: what it declares is all that others need of it.
pub fn without_bodies(sources: &Sources, file: u16) -> Source {
    let tree = parse_file(sources, file);
    let mut parts = Vec::new();
    for item in &tree.items {
        let pou = match item {
            ast::Item::Pou(pou) => pou,
            ast::Item::Test(it) => &it.pou,
            ast::Item::Types(_) | ast::Item::Globals(_) | ast::Item::Configuration(_) => continue,
        };
        let bodies = core::iter::once(pou).chain(&pou.routines).map(|it| &it.body);
        parts.extend(bodies.flatten().map(|it| it.span));
    }
    sources.get(file).blanked(parts.into_iter().filter(|it| it.file == file))
}

/// What some of the sources declare: nothing is checked for that.
pub fn outline(sources: &Sources, files: core::ops::Range<u16>) -> Index {
    let mut index = Index::default();
    let files: Vec<_> = files.map(|it| parse_file(sources, it)).collect();
    index.declare(&files);
    index
}

/// Whether the program that is made has the bodies of its POUs, or the calls in them alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Bodies {
    Kept,
    Dropped,
}

/// What the sources name of the library becomes a part of the program.
fn with_library(sources: &Sources, options: &Options, keep: Bodies, index: Option<&mut Index>) -> Compilation {
    let Some(extended) = prelude::Extended::of(sources, options) else { return run(sources, options, keep, index) };
    let compilation = run(&extended.sources, options, keep, index);
    Compilation { diagnostics: extended.of_the_user(compilation.diagnostics), ..compilation }
}

/// Checks the program until what holds of the whole of it is known: mostly once.
fn run(sources: &Sources, options: &Options, keep: Bodies, mut index: Option<&mut Index>) -> Compilation {
    let mut whole = Whole::default();
    loop {
        if let Some(compilation) = run_with(sources, options, keep, &mut whole, index.as_deref_mut()) {
            return compilation;
        }
    }
}

/// The pipeline, in the order of the modules above. Nothing, where the bodies show more of the whole than they were
/// checked with.
fn run_with(
    sources: &Sources,
    options: &Options,
    keep: Bodies,
    whole: &mut Whole,
    mut index: Option<&mut Index>,
) -> Option<Compilation> {
    let mut log = Log::new(sources, options);
    log.index = index.as_ref().map(|it| Recorder::new(it.asked, it.stop.clone()));
    let (files, is_whole) = parse_all(sources, options, &mut log.diagnostics);
    // An editor is answered from the other files.
    let said = (!is_whole).then(|| std::mem::take(&mut log.diagnostics));
    let said = match said {
        Some(said) if index.is_none() => return Some(Compilation::rejected(said)),
        said => said,
    };
    if let Some(index) = &mut index {
        index.declare(&files);
    }
    if let (Some(recorder), Some(index)) = (&mut log.index, &index) {
        recorder.around = index.around();
    }
    let Trees { mut files, groups, stubs, allowances, has_tests } = write_out(files, &mut log);
    let mut runs = declare::run::runs(&files, options.tests, sources, &whole.shared);
    declare::run::begin_cycles(&mut files, &runs, options.tests);
    let mut bodies: Vec<_> = files.iter_mut().flat_map(ast::File::take_bodies).collect();
    bodies.extend(runs.iter_mut().map(|it| std::mem::take(&mut it.body)));
    let mut declarations = declare::declare(log, whole, &files, &runs, &bodies);
    declarations.coverage = options.coverage.map(|files| Coverage { files, ..Coverage::default() });
    declarations.tests.exchanged.clone_from(&groups.exchanged);
    declarations.tests.fixtures.clone_from(&groups.of_fixtures);
    declarations.tests.callers = testing::fixture::callers(&files);
    let checked = body::check(&mut declarations, &mut bodies, keep);
    if let Some(index) = index.as_deref_mut().filter(|it| it.around().is_some() || it.stop.is_set()) {
        return Some(partial(declarations, has_tests && !options.tests, index));
    }
    let shared = declarations.shared_programs(&files);
    if whole.grow(Whole { shared, ..declarations.whole() }) {
        return None;
    }
    let unassigned = lints::result::unassigned(&declarations);
    lints::hides::report(&mut declarations);
    lints::checks::report(&mut declarations);
    let routines: Vec<_> = checked.routines.iter().map(|it| it.as_ref().map(|it| &it.0)).collect();
    lints::siblings::note(&mut declarations);
    lints::otherwise::report(&mut declarations);
    lints::unused::report(&mut declarations);
    stubs.report_called(&mut declarations, &routines, keep == Bodies::Kept);
    if keep == Bodies::Kept {
        declarations.report_not_there(&routines);
    }
    let left_out = checked.left_out;
    let is_last = whole.referred.is_some() || declarations.table.interfaces.slots.is_empty();
    let program = program::assemble(&mut declarations, &files, checked, is_last);
    let is_recursive = declarations.log.diagnostics.iter().any(|it| it.code == Code::E0310);
    if is_recursive && !is_last {
        // Perhaps only by a class to whose instances nothing refers.
        whole.referred = Some(declarations.table.interfaces.referred.clone());
        return None;
    }
    let tests = program::tests::tests(&mut declarations, groups);
    if let (Some(index), Some(found)) = (&mut index, declarations.log.index.take()) {
        index.add(found, sources);
    }
    let readdressed = std::mem::take(&mut declarations.log.readdressed);
    let coverage = declarations.coverage.take().map(|it| it.points).unwrap_or_default();
    let program = program.filter(|_| keep == Bodies::Kept);
    let compilation = finish(program, declarations.log, &said_once::units(&files), unassigned, left_out);
    let mut compilation = Compilation { tests, coverage, readdressed, ..compilation };
    if let Some(said) = said {
        compilation = Compilation::rejected(said);
    }
    if has_tests && !options.tests {
        // Unit tests that do not run are still checked.
        let mut found = run(sources, &Options { tests: true, ..options.clone() }, Bodies::Dropped, index).diagnostics;
        if keep == Bodies::Kept {
            // The instances of a test may make recursion that the program has not.
            found.retain(|it| it.code != Code::E0310);
        }
        compilation.add(found);
    }
    compilation.settle(sources, &allowances);
    Some(compilation)
}

/// Ends the pipeline where no more than the names around a place are asked for, or nothing any more.
fn partial(mut declarations: Declarations<'_>, is_in_tests: bool, index: &mut Index) -> Compilation {
    let (sources, options) = (declarations.log.sources, declarations.log.options);
    if let Some(found) = declarations.log.index.take() {
        index.add(found, sources);
    }
    if is_in_tests && !index.stop.is_set() {
        run(sources, &Options { tests: true, ..options.clone() }, Bodies::Dropped, Some(index));
    }
    Compilation::rejected(Vec::new())
}

/// The trees of a program, with all written out that is short for something else: tests, what a class inherits, what
/// starts the instances.
struct Trees<'s> {
    files: Vec<ast::File<'s>>,
    groups: testing::Groups,
    stubs: library::Stubs,
    allowances: allow::Allowances,
    has_tests: bool,
}

fn write_out<'s>(mut files: Vec<ast::File<'s>>, log: &mut Log<'s>) -> Trees<'s> {
    let sources = log.sources;
    let dialect = log.options.dialect;
    automation_studio::expand(&mut files, sources, &|it| names::functions::is_in_the_library(it, dialect));
    files.iter_mut().flat_map(|it| std::mem::take(&mut it.apart)).for_each(|it| log.report(it.1));
    let stubs = library::prepare(&mut files, sources);
    stubs.refused.iter().for_each(|it| log.report(library::c_code(*it)));
    let has_tests = testing::has_tests(&files);
    testing::suite::qualify(&mut files);
    log.asked_attributes = declared::asked_attributes(&files, sources);
    files.iter().for_each(|it| log.read_pragmas(it));
    files.iter().filter_map(|it| it.reserved).for_each(|it| report_reserved(it, log));
    chart::expand(&mut files, log);
    enabled::expand(&mut files, log);
    files.iter_mut().flat_map(|it| std::mem::take(&mut it.unclosed)).for_each(|it| report_unclosed(it, log));
    files.iter_mut().flat_map(|it| std::mem::take(&mut it.combined)).for_each(|it| report_combined(it, log));
    locate::resolve(&mut files, log);
    files.iter_mut().flat_map(|it| std::mem::take(&mut it.nonretentive)).for_each(|it| note_nonretentive(it, log));
    inherit::expand(&mut files, log);
    let groups = testing::expand(&mut files, log.options.tests, sources, &mut log.diagnostics);
    start_up::expand(&mut files);
    pooled::expand(&mut files, log.options.default_pool);
    // What starts the instances answers an editor only where it asks about an initial value.
    let around = log.index.as_ref().and_then(|it| it.around);
    if around.is_none_or(|place| files.iter().any(|it| it.is_in_declaration(place))) {
        start::expand(&mut files, &|it| log.dialect(it).binds_by_assignment());
    }
    tasks::expand(&mut files, log.options.tests);
    let allowances = allow::Allowances::read(&files, &mut log.diagnostics);
    Trees { files, groups, stubs, allowances, has_tests }
}

/// Notes `a [:=] b`, and reports it where the dialect does not have it.
fn note_nonretentive(target: Span, log: &mut Log<'_>) {
    if log.dialect(target).resets_assignments() {
        log.nonretentive.insert(target);
        return;
    }
    log.report(
        Diagnostic::new(Code::E0321, target, "`[:=]` is the non-retentive assignment of Logix")
            .label("Logix sets this to 0 when the controller enters Run mode")
            .help("write `:=`; the variable has its initial value after a start, unless it is RETAIN"),
    );
}

/// Reports `a += b` where the dialect does not have it.
fn report_combined(problem: Diagnostic, log: &mut Log<'_>) {
    if !log.dialect(problem.span).combines_assignments() {
        log.report(problem);
    }
}

/// Reports a unit without its end. CODESYS's editors show none, and so do the texts of single objects that are copied from there.
fn report_unclosed(problem: Diagnostic, log: &mut Log<'_>) {
    if log.dialect(problem.span).exports_objects_without_ends() {
        let opened = problem.others.first().map_or(problem.span, |it| it.span);
        let end = problem.span;
        return log.report(
            Diagnostic::new(Code::W0531, opened, "this unit ends with its file, as an object of CODESYS does")
                .label("its end is not written")
                .other(end, "if the original file continues, a part is missing here")
                .help(problem.help.unwrap_or_default()),
        );
    }
    log.report(problem);
}

/// Reports a name that is a word of the standard's, in dialects that keep it for that.
fn report_reserved(span: Span, log: &mut Log<'_>) {
    if !log.dialect(span).has_configurations_as_names() {
        let own = log.sources.text(span);
        log.report(parse::reserved(span, &own.to_ascii_uppercase(), own));
    }
}

/// From so many bytes on, files are parsed on several threads.
const MANY_BYTES: usize = 128 << 10;

/// What parsing a file gave: its tree, and what is reported of it.
type Parsed<'s> = (ast::File<'s>, Vec<Diagnostic>);

/// Parses each file that is to be; `None` for the others.
fn parse_each<'s>(sources: &'s Sources, options: &Options) -> Vec<Option<Parsed<'s>>> {
    let files = sources.files();
    let parse = |at: usize| {
        let (source, number) = (&files[at], u16::try_from(at).unwrap_or(u16::MAX));
        let is_parsed = !source.is_expression() && !is_incomplete(source);
        is_parsed.then(|| {
            let mut found = Vec::new();
            let habits = options.habits(sources, source);
            let file = parse::parse_with(number, &source.text, habits, Known::Later, &mut found);
            (file, found)
        })
    };
    match files.iter().map(|it| it.text.len()).sum::<usize>() < MANY_BYTES {
        true => (0..files.len()).map(parse).collect(),
        false => in_threads::each((0..files.len()).collect(), parse),
    }
}

/// Where a file ends too early, what was read says little of the rest.
fn is_incomplete(source: &Source) -> bool {
    source.problems().iter().any(|it| matches!(it.trouble, Trouble::Broken | Trouble::Absent))
}

/// The files' trees, and whether they are the program: where a file is no Structured Text, that alone is said, and its tree is empty.
fn parse_all<'s>(
    sources: &'s Sources,
    options: &Options,
    diagnostics: &mut Vec<Diagnostic>,
) -> (Vec<ast::File<'s>>, bool) {
    let mut foreign = Vec::new();
    let mut files = Vec::new();
    let mut is_broken = false;
    // No file there is of another system, whatever its comments look like.
    let is_of_studio = sources.is_of_automation_studio();
    for ((source, number), parsed) in sources.files().iter().zip(0u16..).zip(parse_each(sources, options)) {
        if source.is_expression() {
            files.push(ast::File::default());
            continue;
        }
        let before = diagnostics.len();
        diagnostics.extend(source.problems().iter().map(|it| problem(number, it)));
        let Some((file, found)) = parsed else {
            is_broken = true;
            files.push(ast::File::default());
            continue;
        };
        files.push(file);
        diagnostics.extend(found);
        diagnostics[before..].iter_mut().for_each(|it| at_the_end_of_a_body(it, source));
        // Only what does not parse is looked at again, and JSON, which is one pragma.
        let unclosed = files.last_mut().map(|it| it.unclosed.as_mut_slice()).unwrap_or_default();
        unclosed.iter_mut().for_each(|it| at_the_end_of_a_body(it, source));
        let is_wrong = !unclosed.is_empty() || diagnostics[before..].iter().any(|it| it.severity == Severity::Error);
        if !source.is_assembled() && !is_of_studio && (is_wrong || foreign::is_json(source)) {
            foreign.extend(foreign::recognise(number, source));
        }
    }
    if !foreign.is_empty() {
        diagnostics.retain(|it| it.code == Code::E0033);
        diagnostics.extend(foreign);
        return (files, false);
    }
    if is_broken {
        // What a part of such a file is good for is not known.
        let is_undecided = |number| files.iter().any(|it| it.undecided.iter().any(|it| it.file == number));
        diagnostics.retain(|it| it.code == Code::E0033 || !is_undecided(it.span.file));
        return (files, false);
    }
    decide_later(&mut files, sources, options, diagnostics);
    (files, true)
}

/// Reads the files once more whose conditions ask for what is declared.
fn decide_later<'s>(
    files: &mut [ast::File<'s>],
    sources: &'s Sources,
    options: &Options,
    diagnostics: &mut Vec<Diagnostic>,
) {
    if files.iter().all(|it| it.undecided.is_empty()) {
        return;
    }
    let known = Declared { library: Some(library_has), ..declared::of(files, sources) };
    for (file, number) in files.iter_mut().zip(0u16..).filter(|(it, _)| !it.undecided.is_empty()) {
        let source = sources.get(number);
        let read = |known, diagnostics: &mut Vec<Diagnostic>| {
            parse::parse_with(number, &source.text, options.habits(sources, source), known, diagnostics)
        };
        let mut found = Vec::new();
        let first = std::mem::replace(file, read(Known::All(&known), &mut found));
        if !found.iter().any(|it| it.severity == Severity::Error) {
            // What is missing is not declared either way.
            let read_one = |at| read(Known::One(&known, at), &mut Vec::new());
            found.extend(declared::changed([&first, file], sources, number, read_one));
        }
        found.iter_mut().for_each(|it| at_the_end_of_a_body(it, source));
        file.undecided = first.undecided;
        diagnostics.retain(|it| it.span.file != number);
        diagnostics.extend(source.problems().iter().map(|it| problem(number, it)));
        diagnostics.append(&mut found);
    }
}

/// Whether the library has a type or a POU with this name, in some dialect. `None` if it may be either.
fn library_has(subject: lex::Subject, name: &str) -> Option<bool> {
    let is_text = name.eq_ignore_ascii_case("STRING") || name.eq_ignore_ascii_case("WSTRING");
    let is_type = is_text || staunch_ir::Elementary::named(name).is_some();
    let is_block = |it: &staunch_runtime::BlockInfo| it.name.eq_ignore_ascii_case(name);
    let is_pou = names::functions::exists(name)
        || staunch_runtime::BLOCKS.iter().any(is_block)
        || prelude::units(name).any(|it| it.is_function());
    match subject {
        lex::Subject::Type if is_type => Some(true),
        lex::Subject::Pou if is_pou => Some(true),
        lex::Subject::Type | lex::Subject::Pou if prelude::units(name).next().is_some() => None,
        lex::Subject::Type | lex::Subject::Pou | lex::Subject::Variable | lex::Subject::Task => Some(false),
    }
}

/// The files of systems that keep bodies separately have no word that ends a body, so the diagnostic does not show one.
fn at_the_end_of_a_body(it: &mut Diagnostic, source: &Source) {
    if !source.is_verbatim(it.span) {
        it.end_with_the_body();
    }
}

/// Of lints that were found outside of the front end, those that no `{allow …}` in the sources covers.
pub fn allowed(sources: &Sources, mut found: Vec<Diagnostic>) -> Vec<Diagnostic> {
    if !found.is_empty() {
        let numbers = (0..).take(sources.files().len());
        let files: Vec<_> = numbers.map(|it| parse_file(sources, it)).collect();
        let allowances = allow::Allowances::read(&files, &mut Vec::new());
        found.retain(|it| !allowances.cover(it));
    }
    found
}

/// What reading a file of another system's has found.
fn problem(file: u16, problem: &Problem) -> Diagnostic {
    let span = Span { file, start: problem.at, end: problem.at + 1 };
    let (code, help) = match problem.trouble {
        Trouble::Broken => (Code::E0033, "export the file again from the original system"),
        Trouble::Absent => (Code::E0033, "add the file, or remove it from the project"),
        Trouble::SecondBody => (Code::E0902, "merge its worksheets into one in the original system"),
        Trouble::Odd => (Code::E0033, "correct it in the original system, and export the file again"),
        Trouble::NotSupported => (Code::E0902, "write what it does in Structured Text"),
        Trouble::Open => (Code::E0003, "close it where it ends"),
        Trouble::SecondEnd => (Code::E0015, "delete it: the file itself ends the unit"),
        Trouble::OtherOrder => (
            Code::W0528,
            "OpenPLC Editor before its Python 3 version, and Beremiz before April 2023, execute from top to bottom: check which order is \
             meant, and draw the elements in that order (blocks and variables, but not coils, can have an execution order)",
        ),
        Trouble::OtherLanguage => (Code::E0902, "write it in Structured Text, or convert it in the original system"),
    };
    Diagnostic::new(code, span, problem.message.clone()).help(problem.help.as_deref().unwrap_or(help))
}

/// Sorts what was reported, and holds what a program promises that was accepted.
fn finish(
    program: Option<Program>,
    log: Log<'_>,
    units: &[Span],
    unassigned: Vec<Diagnostic>,
    left_out: Option<Span>,
) -> Compilation {
    let Log { sources, mut diagnostics, .. } = log;
    let rejected = diagnostics.iter().any(|it| it.severity == Severity::Error);
    if rejected {
        // What is unused or unreachable is not known before everything is understood.
        diagnostics.retain(|it| it.severity == Severity::Error || !it.code.is_of_the_flow());
    } else {
        diagnostics.extend(unassigned);
    }
    diagnostics.sort_by_key(|it| (it.span.file, it.span.start, it.span.end, it.code));
    let diagnostics =
        said_once::said_once(absent::of_used_namespaces(absent::deduplicate_missing(diagnostics, sources)), units);
    if let (Some(span), false) = (left_out, rejected) {
        unreachable!("checked program: `{}` was left out without a word", sources.text(span));
    }
    let program = program.filter(|_| !rejected);
    if cfg!(debug_assertions)
        && let Some(program) = &program
        && let Err(violations) = staunch_ir::verify::verify(program)
    {
        unreachable!("the front end made IR that does not verify: {violations:?}");
    }
    Compilation { program, ..Compilation::rejected(diagnostics) }
}
