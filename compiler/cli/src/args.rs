//! The command line, as `docs/cli.md` promises it.

use clap::error::{ContextKind, ContextValue};
use clap::{ArgAction, Args, Parser, Subcommand, ValueEnum};
use staunch_build::Project;
use staunch_frontend::Dialect;
use staunch_host::{AtEnd, Connection, Moment, Overrun};
use std::ffi::OsString;
use std::path::PathBuf;

/// Ahead-of-time compiler for IEC 61131-3 Structured Text.
#[derive(Debug, Parser)]
#[command(name = "staunch", version = env!("STAUNCH_VERSION"), max_term_width = 100, arg_required_else_help = true)]
#[command(after_help = "A FILE may be a folder (every .st and .iecst below it) or - (standard input).\n\
    Exit codes: 0 done; 1 the program was rejected; 2 wrong usage; 3 the program faulted while it ran;\n\
    4 compare found no difference, but one is still possible; 101 an internal error.")]
pub struct Cli {
    #[command(subcommand)]
    pub command: Command,
    #[command(flatten)]
    pub common: Common,
}

#[derive(Debug, Subcommand)]
pub enum Command {
    /// Report mistakes; the same verdict as build
    Check(Files),
    /// Compile to Rust, an object, a library, an executable, a C header or a map of the variables
    Build(Build),
    /// Run scans on a virtual clock, with stimulus and trace
    Run(Run),
    /// Run the unit tests in the sources, and the tables next to them
    Test(Test),
    /// Measure the time of a scan
    Bench(Bench),
    /// Show what resources a program needs: bytes of variables, code and stack
    Report(Report),
    /// Show what changes when a program moves to another system
    Compare(Compare),
    /// Convert the files of any supported system to one file of Structured Text
    Convert(Convert),
    /// Format sources: indentation, spacing, aligned declarations, the case of keywords
    Fmt(Fmt),
    /// Run the language server for editors, on standard input and output
    Lsp(Lsp),
    /// Explain a diagnostic, or list all of them
    Explain(Explain),
    /// Print completions for a shell
    Completions(Completions),
    /// Print the manual page, or write one for each command into a folder
    Man(Man),
    /// Create a project that builds and runs
    New(New),
    /// Show which targets this machine can build for, and what to install for the others
    Doctor(Doctor),
}

/// What every verb takes.
#[derive(Clone, Debug, Args)]
pub struct Common {
    /// The system whose counters a bare name means, and whose extensions are allowed
    #[arg(long, global = true, value_parser = dialect, value_name = "iec|cscape|codesys|twincat|openplc|openplc4|logix|siemens")]
    pub dialect: Option<Dialect>,
    /// The form of diagnostics
    #[arg(long, global = true, value_enum)]
    pub message_format: Option<MessageFormat>,
    /// Colours in diagnostics
    #[arg(long, global = true, value_enum)]
    pub color: Option<Color>,
    /// Warn about a lint
    #[arg(short = 'W', long = "warn", global = true, value_name = "CODE", action = ArgAction::Append)]
    pub warn: Vec<String>,
    /// Reject a lint (`-D warnings` rejects all)
    #[arg(short = 'D', long = "deny", global = true, value_name = "CODE", action = ArgAction::Append)]
    pub deny: Vec<String>,
    /// Allow a lint
    #[arg(short = 'A', long = "allow", global = true, value_name = "CODE", action = ArgAction::Append)]
    pub allow: Vec<String>,
    /// Print nothing but errors
    #[arg(short, long, global = true)]
    pub quiet: bool,
    /// Print what is being done
    #[arg(short, long, global = true, action = ArgAction::Count)]
    pub verbose: u8,
}

impl Common {
    /// With what the project file says where the command line says nothing.
    #[must_use]
    pub fn with(&self, project: &Project) -> Self {
        Self {
            message_format: self.message_format.or(project.message_format.as_deref().and_then(named)),
            color: self.color.or(project.color.as_deref().and_then(named)),
            quiet: self.quiet || project.quiet && self.verbose == 0,
            verbose: self.verbose.max(u8::from(project.verbose)),
            ..self.clone()
        }
    }

    pub fn format(&self) -> MessageFormat {
        self.message_format.unwrap_or_default()
    }

    pub fn color(&self) -> Color {
        self.color.unwrap_or_default()
    }
}

/// A word of the project file, which has been checked.
fn named<T: ValueEnum>(word: &str) -> Option<T> {
    T::from_str(word, false).ok()
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum MessageFormat {
    #[default]
    Human,
    Short,
    Json,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Color {
    #[default]
    Auto,
    Always,
    Never,
}

#[derive(Clone, Debug, Args)]
pub struct Files {
    /// Source files, folders, or projects (.plcproj of TwinCAT, project.json of OpenPLC Editor); without one, the files of staunch.toml
    #[arg(value_name = "FILE")]
    pub files: Vec<PathBuf>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Emit {
    Rust,
    Obj,
    Lib,
    Exe,
    Header,
    Map,
    Systemd,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum BuildBackend {
    Rust,
    Native,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Backend {
    Native,
    Rust,
    Interpret,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Opt {
    /// As few instructions in a scan as possible
    #[default]
    Speed,
    /// As few bytes of code as possible
    Size,
}

#[derive(Clone, Debug, Args)]
pub struct Build {
    #[command(flatten)]
    pub files: Files,
    /// The kind of output
    #[arg(long, value_enum, default_value_t = Emit::Exe)]
    pub emit: Emit,
    /// Where to write it; - is standard output
    #[arg(short, long, value_name = "OUT")]
    pub output: Option<PathBuf>,
    /// The machine to compile for
    #[arg(long, value_name = "TRIPLE")]
    pub target: Option<String>,
    /// The back end that compiles the program
    #[arg(long, value_enum, default_value_t = BuildBackend::Native)]
    pub backend: BuildBackend,
    /// What to optimise compiled code for [default: speed]
    #[arg(long, value_enum)]
    pub opt: Option<Opt>,
    /// Debug information for gdb, and code that it can follow line by line; with `--emit obj`, `lib` or `exe`
    #[arg(short = 'g', long)]
    pub debug: bool,
    /// With `--emit rust`: make the variables readable by name at run time, with a table and a function
    #[arg(long)]
    pub names: bool,
    /// With `--emit obj`, `lib` or `header`: what symbols, macros and structures begin with, instead of `staunch`, so that several
    /// programs can be linked together
    #[arg(long, value_name = "NAME")]
    pub prefix: Option<String>,
    /// The PROGRAM to run, if the sources have several
    #[arg(long, value_name = "NAME")]
    pub program: Option<String>,
}

impl Build {
    /// What the entry points' symbols begin with.
    pub fn prefix(&self) -> &str {
        self.prefix.as_deref().unwrap_or(crate::header::PREFIX)
    }
}

#[derive(Clone, Debug, Args)]
pub struct Run {
    #[command(flatten)]
    pub files: Files,
    /// The PROGRAM to run, if the sources have several
    #[arg(long, value_name = "NAME")]
    pub program: Option<String>,
    /// Number of scans
    #[arg(long, value_name = "N")]
    pub scans: Option<u64>,
    /// Time from scan to scan: 10ms, T#1s
    #[arg(long, value_name = "TIME")]
    pub cycle: Option<String>,
    /// Limit for the loop turns (iterations) in one scan, all loops together [default: 10000000]
    #[arg(long, value_name = "N")]
    pub loop_budget: Option<u64>,
    /// Inputs over time
    #[arg(long, value_name = "IN.csv")]
    pub stimulus: Option<PathBuf>,
    /// Give a variable this value before and after each scan, whatever writes to it: level=50; may be repeated
    #[arg(long, value_name = "NAME=VALUE")]
    pub force: Vec<String>,
    /// Where to write the variables after each scan: .csv, .vcd, .svg, .html, or - for standard output
    #[arg(long, value_name = "OUT")]
    pub trace: Option<PathBuf>,
    /// Show scans from this one, or from this time: 120, 1s200ms
    #[arg(long, value_name = "MOMENT", value_parser = staunch_host::parse_moment)]
    pub from: Option<Moment>,
    /// Show scans up to this one, or to this time; without --scans the run ends there
    #[arg(long, value_name = "MOMENT", value_parser = staunch_host::parse_moment)]
    pub to: Option<Moment>,
    // In a doc comment `[1,2]` would be a link.
    #[arg(long, value_name = "NAMES", help = "The variables to show, in order: a,b.CV,m[1,2]")]
    pub vars: Option<String>,
    /// Two or three numeric variables that a picture (`--trace OUT.svg`) shows in one lane: a,b; may be repeated
    #[arg(long, value_name = "NAMES", requires = "trace")]
    pub overlay: Vec<String>,
    /// The back end that runs the program [default: native; interpret with --break]
    #[arg(long, value_enum)]
    pub backend: Option<Backend>,
    #[command(flatten)]
    pub debug: Debug,
    /// Keep retained variables in this file
    #[arg(long, value_name = "FILE")]
    pub retain: Option<PathBuf>,
    /// With --realtime, the longest time until a change of retained variables is on disk: 500ms, or `scan` for after every
    /// scan [default: 1s]
    #[arg(long, value_name = "TIME", requires = "retain", value_parser = staunch_host::parse_within)]
    pub retain_within: Option<i64>,
    /// Run in real time: wait until each scan is due
    #[arg(long)]
    pub realtime: bool,
    #[command(flatten)]
    pub pacing: Pacing,
    /// With --realtime, connect the variables at addresses: shm:NAME is a process image in /dev/shm, modbus:ADDRESS:PORT a
    /// Modbus TCP server, modbus-rtu:PORT a Modbus RTU server; may be repeated
    #[arg(long, value_name = "CONNECTION", requires = "realtime", value_parser = Connection::parse)]
    pub io: Vec<Connection>,
    /// With --io, or with Modbus servers in staunch.toml, what outputs do at the end and after a fault [default: zero]
    #[arg(long, value_name = "zero|hold", requires = "realtime", value_parser = AtEnd::parse)]
    pub io_stop: Option<AtEnd>,
}

/// Where a run stops, so that its variables can be seen.
#[derive(Clone, Debug, Args)]
pub struct Debug {
    /// Stop before the statement at this line, and show the variables; may be repeated
    #[arg(long = "break", value_name = "[FILE:]LINE", value_parser = Breakpoint::parse, conflicts_with = "realtime")]
    pub breakpoints: Vec<Breakpoint>,
    /// With --break, stop only when this BOOL is TRUE: any expression that could be written at that line
    #[arg(long, value_name = "EXPR", requires = "breakpoints")]
    pub when: Option<String>,
    /// With --break, print this many stops without asking for commands, and end the run after the last of them; 0 for all
    /// stops [default: 1, unless commands can be read from a terminal]
    #[arg(long, value_name = "N", requires = "breakpoints")]
    pub stops: Option<u64>,
    /// With --break, read the commands from this file, or from standard input for -
    #[arg(long, value_name = "FILE", requires = "breakpoints", conflicts_with = "stops")]
    pub commands: Option<PathBuf>,
}

/// A line of a source.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Breakpoint {
    /// The path, or the end of it; `None` for the only source.
    pub file: Option<String>,
    /// From 1.
    pub line: u32,
}

impl Breakpoint {
    fn parse(text: &str) -> Result<Self, String> {
        let (file, line) = match text.rsplit_once(':') {
            Some((file, line)) => (Some(file.to_owned()), line),
            None => (None, text),
        };
        let line = line.parse().ok().filter(|it| *it > 0).filter(|_| file.as_deref() != Some(""));
        let line = line.ok_or("write a line, 12, or a file and a line, motor.st:12")?;
        Ok(Self { file, line })
    }
}

impl std::fmt::Display for Breakpoint {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match &self.file {
            Some(file) => write!(f, "{file}:{}", self.line),
            None => write!(f, "{}", self.line),
        }
    }
}

/// How a run in real time keeps its time.
#[derive(Clone, Debug, Args)]
pub struct Pacing {
    /// With --realtime, run before all processes of lower priority: SCHED_FIFO, 1 to 98, with all memory locked
    #[arg(long, value_name = "N", requires = "realtime", value_parser = staunch_host::parse_priority)]
    pub priority: Option<u8>,
    /// With --realtime, run on this processor
    #[arg(long, value_name = "N", requires = "realtime")]
    pub cpu: Option<usize>,
    /// With --realtime, what to do after a scan that takes too long [default: skip]
    #[arg(long, value_name = "skip|catch-up|fault", requires = "realtime", value_parser = Overrun::parse)]
    pub overrun: Option<Overrun>,
    /// With --realtime, end the process if no scan has ended for this long: 500ms
    #[arg(long, value_name = "TIME", requires = "realtime", value_parser = staunch_host::parse_duration)]
    pub watchdog: Option<i64>,
    /// With --realtime, reset this hardware watchdog as long as scans end: /dev/watchdog
    #[arg(long, value_name = "FILE", requires = "realtime")]
    pub watchdog_device: Option<PathBuf>,
}

#[derive(Clone, Debug, Args)]
pub struct Test {
    #[command(flatten)]
    pub files: Files,
    /// Run only tests whose title contains this text, in upper or lower case
    #[arg(long, value_name = "TEXT")]
    pub filter: Option<String>,
    /// Write the results in JUnit's format, for CI
    #[arg(long, value_name = "OUT.xml")]
    pub junit: Option<PathBuf>,
    /// Limit for the loop turns (iterations) of one test in a scan, all loops together [default: 1000000000; interpreted 10000000]
    #[arg(long, value_name = "N")]
    pub loop_budget: Option<u64>,
    /// Limit for the scans of a TcUnit suite until its tests are finished [default: 10000]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    pub scans: Option<u64>,
    /// The back end that runs the tests
    #[arg(long, value_enum, default_value_t = Backend::Native)]
    pub backend: Backend,
    /// Measure what the tests execute: `table` prints it; OUT.info is for lcov, OUT.html and OUT.txt are the
    /// annotated sources
    #[arg(long, value_name = "table|OUT", action = ArgAction::Append)]
    pub coverage: Vec<PathBuf>,
    /// Run the tests on changed programs, all or N of them, and list the changes that no test detects
    #[arg(long, value_name = "N", num_args = 0..=1, require_equals = true)]
    pub mutants: Option<Option<usize>>,
    /// Number of threads that run tests [default: one for each processor]
    #[arg(short, long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    pub jobs: Option<u16>,
}

impl Test {
    /// Whether a test of this title runs.
    pub fn wants(&self, title: &str) -> bool {
        self.filter.as_ref().is_none_or(|it| title.to_lowercase().contains(&it.to_lowercase()))
    }

    /// Whether a test runs, or one of a suite's may.
    pub fn wants_of(&self, test: &staunch_frontend::Test) -> bool {
        if let Some(fixture) = &test.fixture {
            return fixture.cases.iter().any(|it| self.wants(&format!("{}{}", test.title, it.title)));
        }
        let Some(suite) = &test.suite else { return self.wants(&test.title) };
        self.filter.is_none()
            || suite.is_open
            || suite.titles.iter().any(|it| self.wants(&format!("{}.{}", test.title, it.0)))
    }
}

#[derive(Clone, Debug, Args)]
pub struct Bench {
    #[command(flatten)]
    pub files: Files,
    /// The PROGRAM to measure, if the sources have several
    #[arg(long, value_name = "NAME")]
    pub program: Option<String>,
    /// Number of scans
    #[arg(long, value_name = "N")]
    pub scans: Option<u64>,
    /// A stimulus, which is repeated; without it every BOOL input toggles in each scan
    #[arg(long, value_name = "IN.csv")]
    pub stimulus: Option<PathBuf>,
    /// Time between two scans on the program's clock
    #[arg(long, value_name = "TIME")]
    pub cycle: Option<String>,
    /// Limit for the loop turns (iterations) in one scan, all loops together [default: 10000000]
    #[arg(long, value_name = "N")]
    pub loop_budget: Option<u64>,
    /// The back end that runs the program
    #[arg(long, value_enum, default_value_t = BuildBackend::Native)]
    pub backend: BuildBackend,
}

#[derive(Clone, Debug, Args)]
pub struct Fmt {
    #[command(flatten)]
    pub files: Files,
    /// Write nothing; exit code 1 if a file would change
    #[arg(long)]
    pub check: bool,
    /// Write nothing; show what would change
    #[arg(long)]
    pub diff: bool,
}

#[derive(Clone, Debug, Args)]
pub struct Convert {
    #[command(flatten)]
    pub files: Files,
    /// The file to write; - for standard output
    #[arg(short, long, value_name = "OUT.st")]
    pub output: PathBuf,
}

#[derive(Clone, Debug, Args)]
pub struct Report {
    #[command(flatten)]
    pub files: Files,
    /// The machine to compile for
    #[arg(long, value_name = "TRIPLE")]
    pub target: Option<String>,
    /// The PROGRAM to report on, if the sources have several
    #[arg(long, value_name = "NAME")]
    pub program: Option<String>,
    /// What to optimise compiled code for [default: speed]
    #[arg(long, value_enum)]
    pub opt: Option<Opt>,
}

#[derive(Clone, Debug, Args)]
pub struct Compare {
    #[command(flatten)]
    pub files: Files,
    /// The dialect that the program is written in
    #[arg(long, value_parser = named_dialect, value_name = "DIALECT")]
    pub from: Named,
    /// The dialect that it moves to
    #[arg(long, value_parser = named_dialect, value_name = "DIALECT")]
    pub to: Named,
    /// The program rewritten for the other system, if it needs changes
    #[arg(long, value_name = "FILE")]
    pub against: Option<PathBuf>,
    /// The PROGRAM to run, if the sources have several
    #[arg(long, value_name = "NAME")]
    pub program: Option<String>,
    /// Inputs over time; without them the command searches for inputs that show a difference
    #[arg(long, value_name = "IN.csv")]
    pub stimulus: Option<PathBuf>,
    /// Number of scans with a stimulus
    #[arg(long, value_name = "N", requires = "stimulus")]
    pub scans: Option<u64>,
    /// Time between two scans: 10ms, T#1s
    #[arg(long, value_name = "TIME")]
    pub cycle: Option<String>,
    /// Compare only these variables: a,b.CV
    #[arg(long, value_name = "NAMES")]
    pub vars: Option<String>,
    /// Try every sequence of inputs over at most this many scans; without it as many as the budget allows
    #[arg(long, value_name = "N")]
    pub depth: Option<usize>,
    /// Limit for the total number of scans of the search
    #[arg(long, value_name = "N", default_value_t = 8_000_000)]
    pub budget: u64,
    /// Accepted findings, one per line: a counter, the trap and the reason, such as `parts 2: nobody reads the
    /// count past 50`. An output that differs because of one needs its own line: `motor output: not wired`
    #[arg(long, value_name = "FILE", conflicts_with = "stimulus")]
    pub accept: Option<PathBuf>,
    /// Assumptions about the inputs, one per line: `Target 1..500`, `not (Start and Stop)`, `Part for at least 3 scans`, `no run`. The
    /// verdict is valid only if they hold
    #[arg(long, value_name = "FILE")]
    pub assume: Option<PathBuf>,
    /// Write the inputs that show a difference as a stimulus file
    #[arg(long, value_name = "OUT.csv")]
    pub save_stimulus: Option<PathBuf>,
    /// Write the program in the form that the other system accepts, as one file, with that system's dialect and pin names, and for Logix with its counters
    #[arg(long, value_name = "OUT.st", conflicts_with = "against")]
    pub write: Option<PathBuf>,
    /// Show every scan, not only those in which something happens; with a file, draw both systems there
    #[arg(long, value_name = "OUT.svg", num_args = 0..=1)]
    pub trace: Option<Option<PathBuf>>,
    /// Show all inputs, not only those that change
    #[arg(long)]
    pub all_inputs: bool,
}

impl Compare {
    /// What follows `--trace` is a source, unless it is a picture. Other forms of a trace are one system's.
    pub fn settled(&self) -> Result<Self, String> {
        let mut settled = self.clone();
        let form = self.picture().and_then(|it| it.extension()?.to_str()).map(str::to_ascii_lowercase);
        if let Some(form) = form.filter(|it| matches!(it.as_str(), "html" | "csv" | "vcd")) {
            return Err(format!(
                "--trace of compare draws both systems as .svg, not as .{form}: \
                 write the inputs with --save-stimulus OUT.csv, and run them under each with \
                 `staunch run --dialect … --stimulus OUT.csv --trace OUT.{form}`"
            ));
        }
        let is_picture = |it: &PathBuf| it.extension().is_some_and(|it| it.eq_ignore_ascii_case("svg"));
        if let Some(Some(file)) = settled.trace.take_if(|it| it.as_ref().is_some_and(|it| !is_picture(it))) {
            if !file.exists() {
                return Err(format!("--trace {}: compare draws both systems as .svg", file.display()));
            }
            settled.files.files.push(file);
            settled.trace = Some(None);
        }
        settled.is_of_two_sides()?;
        Ok(settled)
    }

    /// One text under one system would be compared with itself.
    fn is_of_two_sides(&self) -> Result<(), String> {
        if self.from.dialect != self.to.dialect {
            return Ok(());
        }
        let systems = match self.from.name == self.to.name {
            true => format!("--from and --to are both `{}`", self.from.name),
            false => format!("`{}` and `{}` are the same system", self.from.name, self.to.name),
        };
        let same = |a: &PathBuf, b: &PathBuf| a.canonicalize().is_ok_and(|a| b.canonicalize().is_ok_and(|b| a == b));
        match (&self.against, self.files.files.as_slice()) {
            (None, _) => Err(format!(
                "{systems}: the program would be compared with itself. Name the system that it moves to, or give another \
                 program with --against FILE"
            )),
            (Some(against), [one]) if same(against, one) => {
                Err(format!("{systems}, and --against is the program itself: it would be compared with itself"))
            }
            (Some(_), _) => Ok(()),
        }
    }

    pub fn shows_every_scan(&self) -> bool {
        self.trace == Some(None)
    }

    /// Where the trace is drawn.
    pub fn picture(&self) -> Option<&PathBuf> {
        self.trace.as_ref().and_then(Option::as_ref)
    }
}

#[derive(Clone, Debug, Args)]
pub struct Lsp {
    /// What editors add when they start a server: it always speaks on standard input and output
    #[arg(long, hide = true)]
    pub stdio: bool,
}

#[derive(Clone, Debug, Args)]
pub struct Explain {
    /// A diagnostic's code, such as E0101; without one all are listed
    pub code: Option<String>,
}

#[derive(Clone, Debug, Args)]
pub struct Completions {
    /// The shell that they are for
    #[arg(value_enum)]
    pub shell: clap_complete::Shell,
}

#[derive(Clone, Debug, Args)]
pub struct Man {
    /// The folder to write pages into: staunch.1, staunch-run.1 and so on
    pub dir: Option<PathBuf>,
}

#[derive(Clone, Debug, Args)]
pub struct New {
    /// The folder to make
    pub dir: PathBuf,
}

#[derive(Clone, Debug, Args)]
pub struct Doctor {
    /// Only this target, such as aarch64 or aarch64-unknown-linux-gnu; may be repeated
    #[arg(long, value_name = "TRIPLE")]
    pub target: Vec<String>,
}

/// A dialect, by the name that it was asked for by.
#[derive(Clone, Copy, Debug)]
pub struct Named {
    pub dialect: Dialect,
    pub name: &'static str,
}

fn named_dialect(name: &str) -> Result<Named, String> {
    let dialect = dialect(name)?;
    let asked = Dialect::names().map(|it| it.0).find(|it| it.eq_ignore_ascii_case(name));
    Ok(Named { dialect, name: asked.unwrap_or(dialect.name()) })
}

fn dialect(name: &str) -> Result<Dialect, String> {
    Dialect::asked_for(name)
}

/// The arguments of this process.
pub fn parse(arguments: impl Iterator<Item = OsString>) -> Result<Cli, clap::Error> {
    Cli::try_parse_from(arguments)
}

/// What to type where a file is in the verb's place.
pub fn file_without_verb(error: &clap::Error) -> Option<String> {
    let Some(ContextValue::String(file)) = error.get(ContextKind::InvalidSubcommand) else { return None };
    std::path::Path::new(file).exists().then(|| {
        format!("`{file}` is a file; `staunch run {file}` runs it, `staunch check {file}` only checks it (--help lists more)")
    })
}
