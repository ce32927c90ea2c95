//! The command `staunch`: arguments, files, exit codes. Its contract is `docs/cli.md`.

mod apart;
mod args;

mod input;
mod other_dialects;
mod remotes;
mod session;

mod declared;

mod cache;
mod toolchain;

mod target;

mod report;

mod archive;
mod build;
mod fmt;
mod header;
mod link;
mod linker;
mod rustc;

mod bench;
mod compare;
mod convert;

mod debug;

mod lsp;
mod run;
mod test;

mod doctor;
mod explain;
mod manual;
mod new;

mod output;
mod overwritten;
mod scratch;
mod systemd;

use args::{Cli, Command, Emit};
use session::Session;
use std::process::ExitCode;

/// The program was rejected, or a test failed.
pub const REJECTED: u8 = 1;
/// The command was used wrongly, or a file or tool was missing.
pub const USAGE: u8 = 2;
/// `compare`: no difference was found, and none is ruled out.
pub const NOT_FOUND: u8 = 4;
/// The program faulted while it ran.
pub const FAULTED: u8 = 3;
/// A mistake of the compiler's own.
const INTERNAL: u8 = 101;

/// A compilation is very many small trees: the system's allocator takes as long as the checks themselves.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

/// Deep enough for expressions and statements at the parser's nesting limit, also unoptimised.
pub const STACK: usize = 256 << 20;

fn main() -> ExitCode {
    let cli = match args::parse(std::env::args_os()) {
        Ok(cli) => cli,
        Err(error) => {
            match args::file_without_verb(&error) {
                Some(text) => output::tell(format_args!("error: {text}")),
                None => _ = error.print(),
            }
            let code = if error.use_stderr() { USAGE } else { 0 };
            return ExitCode::from(code);
        }
    };
    std::panic::set_hook(Box::new(report_panic));
    let worker = std::thread::Builder::new().stack_size(STACK).spawn(move || dispatch(cli));
    let code = worker.map(std::thread::JoinHandle::join);
    match code {
        Ok(Ok(code)) => ExitCode::from(code),
        Ok(Err(_)) => ExitCode::from(INTERNAL),
        Err(error) => {
            output::tell(format_args!("error: cannot start a thread: {error}"));
            ExitCode::from(USAGE)
        }
    }
}

fn report_panic(panic: &std::panic::PanicHookInfo<'_>) {
    output::tell(format_args!("internal error: {panic}"));
    // Where RUST_BACKTRACE asks for it.
    let backtrace = std::backtrace::Backtrace::capture();
    if backtrace.status() == std::backtrace::BacktraceStatus::Captured {
        output::tell(format_args!("{backtrace}"));
    }
    output::tell(format_args!(
        "This is a bug in Staunch, not in your program. Please report it, with the source if you can,"
    ));
    output::tell(format_args!("at {}/issues (staunch {}).", env!("CARGO_PKG_REPOSITORY"), env!("CARGO_PKG_VERSION")));
}

fn dispatch(cli: Cli) -> u8 {
    let result = match &cli.command {
        Command::Explain(it) => explain::explain(it),
        Command::Completions(it) => manual::completions(it),
        Command::Man(it) => manual::pages(it),
        Command::Doctor(it) => doctor::doctor(it),
        Command::Report(it) => {
            Session::start_to_build(&cli.common, &it.files).and_then(|session| report::report(&session, it))
        }
        Command::Convert(it) => {
            Session::start_to_build(&cli.common, &it.files).and_then(|session| convert::convert(&session, it))
        }
        Command::Fmt(it) => fmt::fmt(&cli.common, it),
        Command::Lsp(_) => lsp::lsp(&cli.common),
        Command::New(it) => new::new(it, &cli.common),
        Command::Check(it) => Session::check(&cli.common, it),
        Command::Build(it) => {
            let start = if it.emit == Emit::Exe { Session::start } else { Session::start_to_build };
            start(&cli.common, &it.files).and_then(|session| build::build(&session, it))
        }
        Command::Run(it) => Session::start(&cli.common, &it.files).and_then(|session| run::run(&session, it)),
        Command::Test(it) => Session::start_tests(&cli.common, &it.files, !it.coverage.is_empty())
            .and_then(|session| test::test(&session, it)),
        Command::Compare(it) => compare::compare(&cli.common, it),
        Command::Bench(it) => Session::start(&cli.common, &it.files).and_then(|session| bench::bench(&session, it)),
    };
    match result {
        Ok(code) => code,
        Err(message) => {
            output::problem(cli.common.format(), &message);
            USAGE
        }
    }
}
