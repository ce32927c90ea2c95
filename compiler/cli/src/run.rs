//! `staunch run`: in this process, or, for the Rust back end, as an executable of its own.

use crate::args::{self, Backend, MessageFormat, Opt, Run};
use crate::rustc::{self, Kind};
use crate::session::Session;
use crate::{REJECTED, apart, debug, overwritten};
use staunch_host::{AtEnd, Io, Machine, Map, Moment, Options, Overrun, Pacing};
use staunch_ir::Program;
use staunch_machine::{Interpreted, Native};
use std::ffi::OsString;
use std::path::PathBuf;
use std::process::Command;

pub fn run(session: &Session, args: &Run) -> Result<u8, String> {
    let Some(program) = session.program_to_run(args.program.as_deref())? else { return Ok(REJECTED) };
    apart::run(session, args)?;
    if let Some(stimulus) = &args.stimulus
        && !overwritten::lint(session, &program, stimulus)?
    {
        return Ok(REJECTED);
    }
    if !args.debug.breakpoints.is_empty() {
        return match args.backend {
            None | Some(Backend::Interpret) => debug::run(session, args, options(session, args)?),
            Some(Backend::Native | Backend::Rust) => {
                Err("--break is for --backend interpret: compiled code does not stop".to_owned())
            }
        };
    }
    match args.backend.unwrap_or(Backend::Native) {
        Backend::Native => {
            let (mut machine, map) = Native::new(&program)?;
            scans(session, args, &map, &mut machine)
        }
        Backend::Interpret => {
            let (mut machine, map) = Interpreted::new(&program)?;
            scans(session, args, &map, &mut machine)
        }
        Backend::Rust => execute(session, args, &program),
    }
}

fn scans(session: &Session, args: &Run, map: &Map, machine: &mut dyn Machine) -> Result<u8, String> {
    let options = options(session, args)?;
    match staunch_host::run(machine, map, &options) {
        Ok(_) => Ok(0),
        Err(error) => {
            options.report(&error);
            Ok(error.exit_code())
        }
    }
}

/// The cycle of the command line, or of the project file.
pub fn cycle(session: &Session, asked: Option<&str>) -> Result<Option<i64>, String> {
    let of_project = || session.project.cycle.as_deref().map(|it| (it, format!("{}: `cycle`", session.project.file())));
    let given = asked.map(|it| (it, "--cycle".to_owned())).or_else(of_project);
    given.map(|(it, whose)| staunch_host::parse_duration(it).map_err(|error| format!("{whose}: {error}"))).transpose()
}

fn options(session: &Session, args: &Run) -> Result<Options, String> {
    if args.io_stop.is_some() && args.io.is_empty() && session.project.modbus.is_empty() {
        return Err("--io-stop needs --io, what the outputs are connected with".to_owned());
    }
    Ok(Options {
        // The program holds just the instances that run.
        program: None,
        scans: args.scans,
        cycle: cycle(session, args.cycle.as_deref())?,
        loop_budget: args.loop_budget.or(session.project.loop_budget),
        stimulus: args.stimulus.clone(),
        forces: args.force.clone(),
        trace: args.trace.clone(),
        vars: args.vars.clone(),
        overlay: args.overlay.clone(),
        from: args.from,
        to: args.to,
        json: session.common.format() == MessageFormat::Json,
        retain: args.retain.clone(),
        retain_within: args.retain_within,
        realtime: args.realtime,
        pacing: pacing(&args.pacing),
        io: Io { connections: args.io.clone(), at_end: args.io_stop.unwrap_or_default() },
        table: true,
        debugged: false,
        quiet: session.common.quiet,
    })
}

/// Builds an executable in the cache and runs it with the same arguments.
fn execute(session: &Session, args: &Run, program: &Program) -> Result<u8, String> {
    let executable = rustc::compile(program, Kind::Executable, None, Opt::Speed)?;
    let mut command = Command::new(&executable);
    command.arg("--table");
    let texts = [
        ("--scans", args.scans.map(|it| it.to_string())),
        ("--cycle", cycle(session, args.cycle.as_deref())?.map(|it| format!("{it}ns"))),
        ("--loop-budget", args.loop_budget.or(session.project.loop_budget).map(|it| it.to_string())),
        ("--retain-within", args.retain_within.map(within)),
        ("--vars", args.vars.clone()),
        ("--from", args.from.map(moment)),
        ("--to", args.to.map(moment)),
        ("--message-format", (session.common.format() == MessageFormat::Json).then(|| "json".to_owned())),
    ];
    for (flag, value) in texts {
        value.map(|it| command.arg(flag).arg(it));
    }
    args.overlay.iter().for_each(|it| _ = command.arg("--overlay").arg(it));
    args.force.iter().for_each(|it| _ = command.arg("--force").arg(it));
    let paths = [("--stimulus", &args.stimulus), ("--trace", &args.trace), ("--retain", &args.retain)];
    for (flag, path) in paths {
        path.as_ref().map(|it| command.arg(flag).arg(it));
    }
    if args.realtime {
        command.arg("--realtime").args(pacing_arguments(&args.pacing));
        args.io.iter().for_each(|it| _ = command.arg("--io").arg(it.to_string()));
        let at_end = args.io_stop.and_then(|wanted| AtEnd::ALL.into_iter().find(|it| it.1 == wanted));
        at_end.map(|it| command.arg("--io-stop").arg(it.0));
    }
    if session.common.quiet {
        command.arg("--quiet");
    }
    become_process(command).map_err(|error| format!("cannot run {}: {error}", executable.display()))
}

fn pacing(args: &args::Pacing) -> Pacing {
    let args::Pacing { priority, cpu, overrun, watchdog, watchdog_device } = args;
    let (overrun, watchdog_device) = (overrun.unwrap_or_default(), watchdog_device.clone());
    Pacing { priority: *priority, cpu: *cpu, overrun, watchdog: *watchdog, watchdog_device }
}

fn pacing_arguments(args: &args::Pacing) -> Vec<OsString> {
    let overrun = args.overrun.and_then(|wanted| Overrun::ALL.into_iter().find(|it| it.1 == wanted));
    let texts = [
        ("--priority", args.priority.map(|it| it.to_string().into())),
        ("--cpu", args.cpu.map(|it| it.to_string().into())),
        ("--overrun", overrun.map(|it| it.0.into())),
        ("--watchdog", args.watchdog.map(|it| format!("{it}ns").into())),
        ("--watchdog-device", args.watchdog_device.clone().map(PathBuf::into_os_string)),
    ];
    texts.into_iter().flat_map(|(flag, value)| value.map(|it| [flag.into(), it])).flatten().collect()
}

fn within(time: i64) -> String {
    if time == 0 { "scan".to_owned() } else { format!("{time}ns") }
}

fn moment(moment: Moment) -> String {
    match moment {
        Moment::Scan(scan) => scan.to_string(),
        Moment::Time(time) => format!("{time}ns"),
    }
}

/// The executable takes this process over, so that signals reach it and nothing else.
#[cfg(unix)]
fn become_process(mut command: Command) -> std::io::Result<u8> {
    use std::os::unix::process::CommandExt;
    Err(command.exec())
}

#[cfg(not(unix))]
fn become_process(mut command: Command) -> std::io::Result<u8> {
    let status = command.status()?;
    Ok(status.code().and_then(|it| u8::try_from(it).ok()).unwrap_or(crate::FAULTED))
}
