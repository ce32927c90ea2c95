//! One compilation: sources and settings in, diagnostics out, and the program where there is one.

use crate::args::{Color, Common, Files, MessageFormat};
use crate::other_dialects::{Advice, advice};
use crate::{REJECTED, input, output, remotes};
use staunch_build::{Project, listing};
use staunch_frontend::{
    AskedAt, Compilation, CoveragePoint, Diagnostic, Dialect, Fix, Format, Level, Levels, Options, Severity, Source,
    Sources, Span, Stops, Style, Test,
};
use staunch_ir::{Location, Program};
use std::fmt::Display;
use std::io::{IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// An expression that is asked before a statement.
#[derive(Clone, Copy, Debug)]
pub struct Asked<'a> {
    /// Of the statement.
    pub at: Location,
    /// What diagnostics call the expression's source.
    pub name: &'a str,
    pub text: &'a str,
    /// It is a condition; else any value.
    pub is_condition: bool,
}

#[derive(Debug)]
pub struct Session {
    pub common: Common,
    pub project: Project,
    /// The project that lists the sources, or the first of them: outputs are named after it.
    pub first: PathBuf,
    pub sources: Sources,
    /// `None` when the program was rejected.
    program: Option<Program>,
    /// The unit tests that the program's instances are.
    pub tests: Vec<Test>,
    /// Where execution is counted.
    pub coverage: Vec<CoveragePoint>,
    /// Where a move to another system changes a pin's name, and the new one.
    pub renamed: Vec<Fix>,
    /// Where such a move changes how an address is written.
    pub readdressed: Vec<Fix>,
    /// At their levels.
    pub diagnostics: Vec<Diagnostic>,
    pub compile_time: Duration,
}

impl Session {
    /// Reads and compiles the sources, and prints what there is to say about them.
    pub fn start(common: &Common, files: &Files) -> Result<Self, String> {
        Self::begin(common, files, "--dialect", staunch_frontend::compile).and_then(|it| it.0.connected())
    }

    /// As [`start`](Self::start), for a program that moves from this system.
    pub fn start_to_move(common: &Common, files: &Files) -> Result<Self, String> {
        Self::begin(common, files, "--from", staunch_frontend::compile).map(|(session, _)| session)
    }

    /// As [`start`](Self::start), for a program that others finish: what is `{external}` is theirs.
    pub fn start_to_build(common: &Common, files: &Files) -> Result<Self, String> {
        let compile = |sources: &Sources, options: &Options| {
            staunch_frontend::compile(sources, &Options { is_run: false, ..options.clone() })
        };
        Self::begin(common, files, "--dialect", compile).and_then(|it| it.0.connected())
    }

    /// With the servers of the project.
    fn connected(mut self) -> Result<Self, String> {
        let connected = self.program.as_mut().map(|it| remotes::connect(&self.project, it));
        connected.unwrap_or(Ok(())).map(|()| self)
    }

    /// As [`start`](Self::start), for the unit tests in the sources.
    pub fn start_tests(common: &Common, files: &Files, is_covered: bool) -> Result<Self, String> {
        let compile = |sources: &Sources, options: &Options| {
            let coverage = covered(sources, is_covered);
            staunch_frontend::compile(sources, &Options { tests: true, coverage, ..options.clone() })
        };
        Self::begin(common, files, "--dialect", compile).map(|(session, _)| session)
    }

    /// Changed sources, as tests or as what `run` would run.
    pub fn compile(&self, sources: &Sources, tests: bool) -> Result<Compilation, String> {
        let options = Options { tests, is_tested: true, ..options(&self.common, &self.project)? };
        Ok(staunch_frontend::compile(sources, &options))
    }

    /// Other sources, for a program that others finish.
    pub fn compile_to_build(&self, sources: &Sources) -> Result<Compilation, String> {
        let options = Options { is_run: false, ..options(&self.common, &self.project)? };
        Ok(staunch_frontend::compile(sources, &options))
    }

    /// The same program with stops before its statements, and what is asked there. The sources are those of the diagnostics,
    /// which are about what is asked; without them it has the program.
    pub fn with_stops(&self, asked: &[Asked<'_>]) -> Result<(Option<Program>, Vec<String>), String> {
        let own = self.sources.files().iter().filter(|it| !it.is_of_library()).count();
        let mut sources = self.sources.clone();
        let mut stops = Stops { files: u16::try_from(own).unwrap_or(u16::MAX), asked: Vec::new() };
        for it in asked {
            let expression = u16::try_from(sources.files().len()).map_err(|_| "too many sources".to_owned())?;
            sources.add(Source::expression(it.name, it.text.to_owned()));
            stops.asked.push(AskedAt { at: it.at, expression, is_condition: it.is_condition });
        }
        let options = Options { stops: Some(stops), ..options(&self.common, &self.project)? };
        let compilation = staunch_frontend::compile(&sources, &options);
        let mut errors: Vec<_> = compilation.diagnostics.iter().filter(|it| it.severity == Severity::Error).collect();
        // The same expression is asked at several places.
        errors.dedup_by(|a, b| a.span.start == b.span.start && a.repeats(b));
        let (format, style) = (self.format(), Style { color: self.color() });
        let rendered = errors.into_iter().map(|it| staunch_frontend::render(it, &sources, format, style)).collect();
        Ok((compilation.program, rendered))
    }

    /// The program that is not tests alone: what `run` would run. There is nothing more to say of it.
    pub fn without_tests(&self, is_covered: bool) -> Result<Compilation, String> {
        let coverage = covered(&self.sources, is_covered);
        let options = Options { coverage, is_tested: true, ..options(&self.common, &self.project)? };
        Ok(staunch_frontend::compile(&self.sources, &options))
    }

    /// As [`start`](Self::start), but without a program at the end: the verdict alone.
    pub fn check(common: &Common, files: &Files) -> Result<u8, String> {
        let check = |sources: &Sources, options: &Options| {
            let diagnostics = staunch_frontend::check(sources, &Options { is_run: false, ..Options::clone(options) });
            Compilation::rejected(diagnostics)
        };
        let (session, errors) = Self::begin(common, files, "--dialect", check)?;
        if errors > 0 {
            return Ok(REJECTED);
        }
        if session.project.is_connected() {
            let program = session.compile_to_build(&session.sources)?.program;
            program.map_or(Ok(()), |mut it| remotes::connect(&session.project, &mut it))?;
        }
        let others = session.sources.files().len() - 1;
        match others > 0 && !listing::is_list(&session.first) {
            true => session.say("Checked", format_args!("{} and {others} more", session.first.display())),
            false => session.say("Checked", session.first.display()),
        }
        Ok(0)
    }

    /// With the number of errors. `flag` is what names the dialect on the command line.
    fn begin(
        common: &Common,
        files: &Files,
        flag: &str,
        compile: impl FnOnce(&Sources, &Options) -> Compilation,
    ) -> Result<(Self, usize), String> {
        let (mut project, named) = named(files)?;
        if let Some(table) = named.iter().find(|it| it.extension().is_some_and(|it| it.eq_ignore_ascii_case("csv"))) {
            let source = table.with_extension("st");
            let text = format!("{} is a table, not a source: name the source next to it", table.display());
            return Err(if source.is_file() { format!("{text}, {}", source.display()) } else { text });
        }
        if let Some(cycle) = &project.cycle {
            let place = || project.place("cycle", None);
            staunch_host::parse_duration(cycle).map_err(|it| format!("{}: `cycle`: {it}", place()))?;
        }
        let levels = levels(common, &project)?;
        let sources = input::read(&named, &seen(&project, "libraries", &project.libraries)?)?;
        project.dialect = project.dialect.take().or_else(|| sources.dialect().map(str::to_owned));
        let start = Instant::now();
        let options = options(common, &project)?;
        let compilation = compile(&sources, &options);
        let compile_time = start.elapsed();
        let first = match named.first().filter(|it| listing::is_list(it) && !it.is_dir()) {
            Some(project) => input::shown(project),
            None => sources.files()[0].path.clone(),
        };
        let mut session = Self::new(common.with(&project), project, PathBuf::from(first), sources, compile_time);
        session.say_what_was_read();
        let advice = session.advice(&compilation, &options);
        if let Some(fewer @ Advice::Fewer { .. }) = &advice {
            output::tell(format_args!("{}\n", fewer.text(flag)));
        }
        let errors = session.accept(compilation, &levels, &[])?;
        if let Some(accepted @ Advice::Accepted(_)) = &advice {
            output::tell(accepted.text(flag));
        }
        Ok((session, errors))
    }

    /// Of sources that nothing has been said of yet.
    fn new(common: Common, project: Project, first: PathBuf, sources: Sources, compile_time: Duration) -> Self {
        let (program, tests, coverage) = (None, Vec::new(), Vec::new());
        let (renamed, readdressed, diagnostics) = (Vec::new(), Vec::new(), Vec::new());
        Self {
            common,
            project,
            first,
            sources,
            program,
            tests,
            coverage,
            renamed,
            readdressed,
            diagnostics,
            compile_time,
        }
    }

    /// Which dialects take the sources that this one rejects, for people.
    fn advice(&self, compilation: &Compilation, options: &Options) -> Option<Advice> {
        let is_for_people = self.common.format() == MessageFormat::Human && !self.common.quiet;
        if is_for_people { advice(&self.sources, options, &compilation.diagnostics) } else { None }
    }

    /// With `-v`: the project file and the sources.
    fn say_what_was_read(&self) {
        if self.common.verbose == 0 {
            return;
        }
        if self.project.folder != Path::new("") {
            self.say("Settings", self.project.folder.join("staunch.toml").display());
        }
        self.sources.files().iter().for_each(|it| self.say("Read", &it.path));
    }

    /// The same program, or `sources` in its place, as it moves to another dialect. Diagnostics that have been
    /// reported are not reported again.
    pub fn moved(&self, to: Dialect, sources: Option<Sources>) -> Result<Self, String> {
        let known: &[Diagnostic] = if sources.is_none() { &self.diagnostics } else { &[] };
        let sources = sources.unwrap_or_else(|| self.sources.clone());
        let (compilation, compile_time) = self.compile_moved(to, &sources)?;
        self.beside(sources, compilation, compile_time, known)
    }

    /// The same program in other words, as it moves to another dialect. What there is to say of it is
    /// said of the user's own text, which `origin` leads back to.
    pub fn rewritten(&self, to: Dialect, sources: &Sources, origin: impl Fn(Span) -> Span) -> Result<Self, String> {
        let (mut compilation, compile_time) = self.compile_moved(to, sources)?;
        for diagnostic in &mut compilation.diagnostics {
            diagnostic.span = origin(diagnostic.span);
            diagnostic.others.iter_mut().for_each(|it| it.span = origin(it.span));
            // What would be pasted fits the other text.
            diagnostic.fix = None;
        }
        self.beside(self.sources.clone(), compilation, compile_time, &self.diagnostics)
    }

    /// The program of these sources with some options set, of which nothing is said: for this system, or as it moves to
    /// another.
    pub fn with_options(
        &self,
        sources: &Sources,
        to: Option<Dialect>,
        set: impl Fn(Options) -> Options,
    ) -> Result<Option<Program>, String> {
        let from = set(options(&self.common, &self.project)?);
        let options = match to {
            Some(to) => Options { dialect: to, moved_from: Some(from.dialect), ..from },
            None => from,
        };
        Ok(staunch_frontend::compile(sources, &options).program)
    }

    /// The dialect of sources that name none.
    pub fn dialect(&self) -> Result<Dialect, String> {
        Ok(options(&self.common, &self.project)?.dialect)
    }

    /// How the project file answers a question that a vendor leaves open.
    pub fn answer(&self, question: staunch_frontend::Question) -> Result<bool, String> {
        Ok(options(&self.common, &self.project)?.answer(question))
    }

    /// What a text of the other system's is rejected for: without what a move excuses.
    pub fn errors_of(&self, to: Dialect, sources: &Sources) -> Result<Vec<Diagnostic>, String> {
        let options = Options { dialect: to, ..options(&self.common, &self.project)? };
        let mut found = staunch_frontend::check(sources, &options);
        found.retain(|it| it.severity == Severity::Error);
        Ok(found)
    }

    fn compile_moved(&self, to: Dialect, sources: &Sources) -> Result<(Compilation, Duration), String> {
        let from = options(&self.common, &self.project)?;
        let options = Options { dialect: to, moved_from: Some(from.dialect), ..from };
        let start = Instant::now();
        Ok((staunch_frontend::compile(sources, &options), start.elapsed()))
    }

    /// A session of the same settings.
    fn beside(
        &self,
        sources: Sources,
        compilation: Compilation,
        compile_time: Duration,
        known: &[Diagnostic],
    ) -> Result<Self, String> {
        let (common, project, first) = (self.common.clone(), self.project.clone(), self.first.clone());
        let mut session = Self::new(common, project, first, sources, compile_time);
        session.accept(compilation, &levels(&self.common, &self.project)?, known)?;
        Ok(session)
    }

    /// Prints what was found after the sources were compiled; whether none of it is an error.
    pub fn report(&self, found: Vec<Diagnostic>) -> Result<bool, String> {
        let levels = levels(&self.common, &self.project)?;
        let found = staunch_frontend::allowed(&self.sources, found);
        let found: Vec<_> = found.into_iter().filter_map(|it| levels.apply(it)).collect();
        let errors = found.iter().filter(|it| it.severity == Severity::Error).count();
        if !found.is_empty() {
            self.print(&found, errors)?;
        }
        Ok(errors == 0)
    }

    /// The statement at a place, as far as it is on its first line.
    pub fn statement_at(&self, at: Location) -> Span {
        let source = self.sources.get(at.file);
        let first = self.sources.file(at.file).statement_at(at);
        let offset = |it: u32| source.in_text(it).unwrap_or(it);
        Span { file: at.file, start: offset(first.start), end: offset(first.end) }
    }

    /// Prints what is not `known`, and counts the errors.
    fn accept(&mut self, compilation: Compilation, levels: &Levels, known: &[Diagnostic]) -> Result<usize, String> {
        let diagnostics: Vec<_> = compilation.diagnostics.into_iter().filter_map(|it| levels.apply(it)).collect();
        let is_error = |it: &Diagnostic| it.severity == Severity::Error;
        let is_new =
            |it: &&Diagnostic| is_error(it) || !known.iter().any(|old| old.code == it.code && old.span == it.span);
        let new: Vec<_> = diagnostics.iter().filter(is_new).cloned().collect();
        let errors = new.iter().filter(|it| is_error(it)).count();
        self.print(&new, errors)?;
        self.program = compilation.program.filter(|_| errors == 0);
        self.tests = compilation.tests;
        self.coverage = compilation.coverage;
        self.renamed = compilation.renamed;
        self.readdressed = compilation.readdressed;
        self.diagnostics = diagnostics;
        Ok(errors)
    }

    fn format(&self) -> Format {
        match self.common.format() {
            MessageFormat::Human => Format::Human,
            MessageFormat::Short => Format::Short,
            MessageFormat::Json => Format::Json,
        }
    }

    fn print(&self, diagnostics: &[Diagnostic], errors: usize) -> Result<(), String> {
        let format = self.format();
        let style = Style { color: self.color() };
        let shown = diagnostics.iter().filter(|it| !self.common.quiet || it.severity == Severity::Error);
        let mut text = String::new();
        for diagnostic in shown {
            text += &staunch_frontend::render(diagnostic, &self.sources, format, style);
            if format == Format::Human {
                text.push('\n');
            }
        }
        if format == Format::Json {
            return output::print(text.as_bytes());
        }
        if format == Format::Human && !diagnostics.is_empty() && (errors > 0 || !self.common.quiet) {
            text += &summary(errors, diagnostics.len() - errors);
        }
        // If standard error is closed, nobody reads it.
        let _ = std::io::stderr().lock().write_all(text.as_bytes());
        Ok(())
    }

    pub fn color(&self) -> bool {
        match self.common.color() {
            Color::Always => {
                shows_colors();
                true
            }
            Color::Never => false,
            Color::Auto => {
                let wanted = std::env::var_os("NO_COLOR").is_none_or(|it| it.is_empty());
                wanted && std::io::stderr().is_terminal() && shows_colors()
            }
        }
    }

    /// The program, or `None` when it was rejected, which has been said.
    pub fn program(&self) -> Option<&Program> {
        self.program.as_ref()
    }

    /// The program with the instances that are to run: those of its CONFIGURATION, its only
    /// PROGRAM, or the one that is asked for by its own or its instance's name.
    pub fn program_to_run(&self, asked: Option<&str>) -> Result<Option<Program>, String> {
        self.program.as_ref().map(|it| self.choose(it, asked)).transpose()
    }

    /// As [`program_to_run`](Self::program_to_run), of a program of these sources.
    pub fn choose(&self, program: &Program, asked: Option<&str>) -> Result<Program, String> {
        let mut program = program.clone();
        let asked = asked.or(self.project.program.as_deref());
        let names: Vec<_> = program.instances.iter().map(|it| it.name.clone()).collect();
        match asked {
            Some(asked) => {
                let of = |it: &staunch_ir::Instance| program.class(it.program).name.eq_ignore_ascii_case(asked);
                let wanted: Vec<_> = program
                    .instances
                    .iter()
                    .filter(|it| it.name.eq_ignore_ascii_case(asked) || of(it))
                    .cloned()
                    .collect();
                let idle = program
                    .classes
                    .iter()
                    .find(|it| it.kind == staunch_ir::ClassKind::Program && it.name.eq_ignore_ascii_case(asked));
                if wanted.is_empty()
                    && let Some(idle) = idle
                {
                    let name = &idle.name;
                    return Err(format!("no task or CONFIGURATION runs the PROGRAM `{name}`; there {}", are(&names)));
                }
                if wanted.is_empty() {
                    return Err(format!("there is no PROGRAM `{asked}`; there {}", are(&names)));
                }
                program.instances = wanted;
            }
            None if program.instances.is_empty() => {
                return Err("nothing to run: the sources have no PROGRAM".to_owned());
            }
            None if program.instances.len() > 1 && !program.is_configured => {
                return Err(format!(
                    "the sources have several programs; choose one with --program: {}",
                    names.join(", ")
                ));
            }
            None => {}
        }
        Ok(program)
    }

    /// A line for people on standard error, as cargo prints them.
    pub fn say(&self, verb: &str, what: impl Display) {
        let silent = self.common.quiet || self.common.format() != MessageFormat::Human;
        if !silent {
            let _ = writeln!(std::io::stderr(), "{verb:>12} {what}");
        }
    }
}

/// A console of Windows shows colours when it is asked to, and else their codes.
#[cfg(windows)]
fn shows_colors() -> bool {
    anstyle_query::windows::enable_ansi_colors().unwrap_or(true)
}

#[cfg(not(windows))]
fn shows_colors() -> bool {
    true
}

/// The sources whose execution is counted: the program's own, which come first.
fn covered(sources: &Sources, is_covered: bool) -> Option<u16> {
    let own = sources.files().iter().filter(|it| !it.is_of_library()).count();
    is_covered.then(|| u16::try_from(own).unwrap_or(u16::MAX))
}

/// The project that files are of, and what is named on the command line or in it.
pub fn named(files: &Files) -> Result<(Project, Vec<PathBuf>), String> {
    let near = files.files.first().filter(|it| it.as_path() != Path::new("-"));
    let folder = near.map_or(Path::new("."), |it| if it.is_dir() { it } else { parent(it) });
    let project = Project::find(folder)?.unwrap_or_default();
    let named = if files.files.is_empty() { seen(&project, "files", &project.files)? } else { files.files.clone() };
    match named.is_empty() {
        true => Err("name a source file or folder, or list `files` in staunch.toml".to_owned()),
        false => Ok((project, named)),
    }
}

/// Paths of the project file, as seen from the current folder.
pub fn seen(project: &Project, key: &str, paths: &[PathBuf]) -> Result<Vec<PathBuf>, String> {
    if paths.is_empty() {
        return Ok(Vec::new());
    }
    let here = std::env::current_dir().and_then(|it| it.canonicalize());
    let here = here.map_err(|it| format!("the current folder: {it}"))?;
    if let Some(lacking) = paths.iter().find(|it| !project.folder.join(it).exists()) {
        let name = lacking.display().to_string();
        return Err(format!("{}: there is no file or folder `{name}`", project.place(key, Some(&name))));
    }
    Ok(paths.iter().map(|it| project.seen_from(&here, it)).collect())
}

fn parent(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if folder != Path::new("") => folder,
        _ => Path::new("."),
    }
}

fn are(names: &[String]) -> String {
    match names {
        [] => "is none".to_owned(),
        [one] => format!("is {one}"),
        several => format!("are {}", several.join(", ")),
    }
}

pub fn options(common: &Common, project: &Project) -> Result<Options, String> {
    let dialect = match common.dialect {
        Some(dialect) => dialect,
        None => project.dialect()?.unwrap_or_default(),
    };
    Ok(Options {
        dialect,
        ctu_stop_at_pv: project.ctu_stop_at_pv,
        openplc4_cd_rises: project.openplc4_cd_rises,
        s7_ld_edge: project.s7_ld_edge,
        f_trig_before_2024_12: project.f_trig_before_2024_12,
        codesys_lreal_literals: project.codesys_lreal_literals,
        implicit_narrowing: project.implicit_narrowing,
        default_pool: project.default_pool,
        moved_from: None,
        tests: false,
        is_run: true,
        is_tested: false,
        coverage: None,
        stops: None,
    })
}

fn summary(errors: usize, warnings: usize) -> String {
    let count = |number: usize, what: &str| format!("{number} {what}{}", if number == 1 { "" } else { "s" });
    match (errors, warnings) {
        (0, warnings) => format!("warning: {}\n", count(warnings, "warning")),
        (errors, 0) => format!("error: rejected with {}\n", count(errors, "error")),
        (errors, warnings) => {
            format!("error: rejected with {} and {}\n", count(errors, "error"), count(warnings, "warning"))
        }
    }
}

/// What the project file and `-W`, `-D`, `-A` say of lints; the command line comes later.
pub fn levels(common: &Common, project: &Project) -> Result<Levels, String> {
    let mut levels = project.levels()?;
    for (level, names) in [(Level::Warn, &common.warn), (Level::Deny, &common.deny), (Level::Allow, &common.allow)] {
        levels.add(level, names.iter().map(String::as_str))?;
    }
    Ok(levels)
}
