//! `staunch build`: the program in the form that is asked for.

use crate::args::{Build, BuildBackend, Emit, Opt};
use crate::rustc::{self, Kind};
use crate::session::Session;
use crate::{REJECTED, apart, declared, header, link, linker, output, report, systemd, target};
use staunch_build::listing;
use staunch_ir::Program;
use staunch_ir::layout::Layout;
use staunch_native::{Aim, Target};
use staunch_rust::State;
use std::path::{Path, PathBuf};

pub fn build(session: &Session, args: &Build) -> Result<u8, String> {
    if args.names && args.emit != Emit::Rust {
        return Err("`--names` goes with `--emit rust`; `--emit map` gives the place of each variable".to_owned());
    }
    if args.opt.is_some() && !matches!(args.emit, Emit::Obj | Emit::Lib | Emit::Exe) {
        return Err("`--opt` is for compiled code: `--emit obj`, `lib` or `exe`".to_owned());
    }
    check_debug(args)?;
    check_prefix(args)?;
    let Some(program) = session.program() else { return Ok(REJECTED) };
    let target = args.target.as_deref().map(full_name);
    let target = target.as_deref();
    let out = out(session, args, target);
    apart::output(session, &out)?;
    match args.emit {
        Emit::Rust => {
            let options = staunch_rust::Options { state: State::Lean, names: args.names, ..Default::default() };
            let text = staunch_rust::emit(program, &options);
            output::write(&out, text.as_bytes())?;
        }
        Emit::Map => {
            let program = if program.instances.len() > 1 { &runnable(session, args)? } else { program };
            let text = staunch_ir::symbols::map_text(program, &Layout::new(program));
            output::write(&out, text.as_bytes())?;
        }
        Emit::Header => {
            let text = header::header(&runnable(session, args)?, args.prefix(), &out, &session.first);
            output::write(&out, text.as_bytes())?;
        }
        Emit::Systemd => {
            let unit = systemd::unit(&runnable(session, args)?, crate::run::cycle(session, None)?, &out);
            output::write(&out, unit.as_bytes())?;
        }
        Emit::Obj | Emit::Lib | Emit::Exe => {
            let program = runnable(session, args)?;
            if hold(session, &program, args, target)? == REJECTED {
                return Ok(REJECTED);
            }
            let program = if args.debug { declared::named(&session.sources, &program) } else { program };
            compile(&program, args, target, &out)?;
        }
    }
    if out != Path::new("-") {
        session.say("Wrote", out.display());
    }
    Ok(0)
}

fn runnable(session: &Session, args: &Build) -> Result<Program, String> {
    let program = session.program_to_run(args.program.as_deref())?;
    program.ok_or_else(|| "the program was rejected".to_owned())
}

/// Holds the budgets of the project file. They are those of code that is used, and not of code for a debugger.
fn hold(session: &Session, program: &Program, args: &Build, target: Option<&str>) -> Result<u8, String> {
    match args.backend {
        BuildBackend::Native if args.debug => Ok(0),
        BuildBackend::Native => report::hold(session, program, &machine(args, target)?),
        BuildBackend::Rust if report::has_budget(&session.project) => {
            let file = session.project.file();
            Err(format!(
                "{file}: `max-stack` and `max-scan-instructions` are budgets of native code: use `--backend native`"
            ))
        }
        BuildBackend::Rust => Ok(0),
    }
}

fn compile(program: &Program, args: &Build, target: Option<&str>, out: &Path) -> Result<(), String> {
    let opt = args.opt.unwrap_or_default();
    match args.backend {
        BuildBackend::Native => native(program, args, target, out),
        BuildBackend::Rust if !program.externals().is_empty() => Err(
            "`{external}` POUs are implemented by a crate around the emitted Rust: use `--emit rust`, or `--backend native` \
             and implement them in C"
                .to_owned(),
        ),
        BuildBackend::Rust => rust(program, args.emit, target, opt, out),
    }
}

fn check_debug(args: &Build) -> Result<(), String> {
    if !args.debug {
        return Ok(());
    }
    if !matches!(args.emit, Emit::Obj | Emit::Lib | Emit::Exe) {
        return Err("`--debug` is for compiled code: `--emit obj`, `lib` or `exe`".to_owned());
    }
    if args.backend == BuildBackend::Rust {
        return Err("`--debug` is for `--backend native`".to_owned());
    }
    if args.opt.is_some() {
        return Err("`--debug` makes code as it is written: it does not go with `--opt`".to_owned());
    }
    Ok(())
}

/// Two programs that are linked together need symbols of their own.
fn check_prefix(args: &Build) -> Result<(), String> {
    let Some(prefix) = &args.prefix else { return Ok(()) };
    if !header::is_prefix(prefix) {
        return Err(format!(
            "`--prefix {prefix}`: a symbol of C begins with a letter, and has letters, digits and `_`"
        ));
    }
    match (args.emit, args.backend) {
        (Emit::Obj | Emit::Lib, BuildBackend::Native) | (Emit::Header, _) => Ok(()),
        (Emit::Obj | Emit::Lib, BuildBackend::Rust) => {
            Err("`--prefix` is for `--backend native`; of emitted Rust, each program is a module of its own".to_owned())
        }
        (Emit::Rust | Emit::Exe | Emit::Map | Emit::Systemd, _) => {
            Err("`--prefix` is for what is linked with others: `--emit obj`, `lib` or `header`".to_owned())
        }
    }
}

/// The machine that native code is made for, and what for.
fn machine(args: &Build, target: Option<&str>) -> Result<Target, String> {
    let target = target::of(target, args.opt.unwrap_or_default())?;
    Ok(if args.debug { target.aiming_at(Aim::Debugging) } else { target })
}

fn native(program: &Program, args: &Build, target: Option<&str>, out: &Path) -> Result<(), String> {
    let machine = machine(args, target)?;
    let object = staunch_native::object_named(program, &machine, args.prefix()).map_err(|it| it.to_string())?;
    match args.emit {
        Emit::Lib => link::static_library(&object, args.prefix(), target, out),
        Emit::Exe => link::executable(&object, target, out),
        Emit::Obj | Emit::Rust | Emit::Header | Emit::Map | Emit::Systemd => output::write(out, &object),
    }
}

fn rust(program: &Program, emit: Emit, target: Option<&str>, opt: Opt, out: &Path) -> Result<(), String> {
    let kind = match emit {
        Emit::Lib => Kind::StaticLibrary,
        Emit::Exe => Kind::Executable,
        Emit::Obj | Emit::Rust | Emit::Header | Emit::Map | Emit::Systemd => Kind::Object,
    };
    let made = rustc::compile(program, kind, target, opt)?;
    let bytes = std::fs::read(&made).map_err(|it| format!("{}: {it}", made.display()))?;
    if kind == Kind::Executable { output::executable(out, &bytes) } else { output::write(out, &bytes) }
}

/// rustc's name of a target that is given by its architecture alone.
pub fn full_name(target: &str) -> String {
    match target {
        "aarch64" => "aarch64-unknown-linux-gnu".to_owned(),
        "riscv64" | "riscv64gc" => "riscv64gc-unknown-linux-gnu".to_owned(),
        "x86_64" => "x86_64-unknown-linux-gnu".to_owned(),
        other => other.to_owned(),
    }
}

/// Where to write. Windows does not run a file whose name has no ending.
fn out(session: &Session, args: &Build, target: Option<&str>) -> PathBuf {
    let is_run = args.emit == Emit::Exe && linker::is_windows(target);
    match args.output.clone() {
        Some(out) if is_run && out.extension().is_none() && out != Path::new("-") => out.with_extension("exe"),
        Some(out) => out,
        None if is_run => default_name(session, args).with_added_extension("exe"),
        None => default_name(session, args),
    }
}

/// In the current folder, after the first source.
fn default_name(session: &Session, args: &Build) -> PathBuf {
    let stem = Some(listing::name(&session.first)).filter(|it| !it.is_empty() && !it.starts_with('<'));
    let stem = stem.unwrap_or_else(|| "program".to_owned());
    PathBuf::from(match args.emit {
        Emit::Rust => format!("{stem}.rs"),
        Emit::Obj => format!("{stem}.o"),
        Emit::Lib => format!("lib{stem}.a"),
        Emit::Exe => stem,
        Emit::Header => format!("{stem}.h"),
        Emit::Map => format!("{stem}.map"),
        Emit::Systemd => format!("{stem}.service"),
    })
}
