//! `staunch bench`: the time of a scan, and the size of the code.

use crate::args::{Bench, BuildBackend, MessageFormat, Opt};
use crate::run::cycle;
use crate::rustc::{self, Kind};
use crate::session::Session;
use crate::{REJECTED, output};
use staunch_host::{BenchOptions, Error, Timing};
use staunch_ir::Program;
use staunch_ir::layout::Layout;
use staunch_machine::Native;
use staunch_native::Target;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// What was measured.
struct Figures {
    timing: Timing,
    /// Bytes of code that the program was compiled to.
    text: u64,
    /// Time of the back end.
    compile: Duration,
}

/// How a measurement ends that does not succeed: with an exit code, after its reason was printed.
enum Stop {
    Message(String),
    Code(u8),
}

impl From<String> for Stop {
    fn from(message: String) -> Self {
        Self::Message(message)
    }
}

pub fn bench(session: &Session, args: &Bench) -> Result<u8, String> {
    let Some(program) = session.program_to_run(args.program.as_deref())? else { return Ok(REJECTED) };
    let options = BenchOptions {
        // The program holds just the instances that run.
        program: None,
        scans: args.scans,
        cycle: cycle(session, args.cycle.as_deref())?,
        loop_budget: args.loop_budget.or(session.project.loop_budget),
        stimulus: args.stimulus.clone(),
    };
    let measured = match args.backend {
        BuildBackend::Native => native(&program, &options),
        BuildBackend::Rust => rust(&program, &options),
    };
    match measured {
        Ok(figures) => {
            output::print(text(session, args, &program, &figures).as_bytes())?;
            Ok(0)
        }
        Err(Stop::Code(code)) => Ok(code),
        Err(Stop::Message(message)) => Err(message),
    }
}

fn native(program: &Program, options: &BenchOptions) -> Result<Figures, Stop> {
    let start = Instant::now();
    let (mut machine, map) = Native::new(program)?;
    let compile = start.elapsed();
    let timing = staunch_host::bench(machine.compiled(), &map, options).map_err(stop)?;
    let target = Target::host().map_err(|it| it.to_string())?;
    let object = staunch_native::object(program, &target).map_err(|it| it.to_string())?;
    Ok(Figures { timing, text: text_bytes(&object), compile })
}

fn stop(error: Error) -> Stop {
    output::tell(format_args!("error: {error}"));
    Stop::Code(error.exit_code())
}

/// Builds an executable, which measures itself.
fn rust(program: &Program, options: &BenchOptions) -> Result<Figures, Stop> {
    let start = Instant::now();
    let executable = rustc::compile(program, Kind::Executable, None, Opt::Speed)?;
    let compile = start.elapsed();
    let object = rustc::compile(program, Kind::Object, None, Opt::Speed)?;
    let object = std::fs::read(&object).map_err(|error| format!("{}: {error}", object.display()))?;
    let mut command = Command::new(&executable);
    command.arg("--bench").stdout(Stdio::piped());
    options.scans.map(|it| command.arg("--scans").arg(it.to_string()));
    options.loop_budget.map(|it| command.arg("--loop-budget").arg(it.to_string()));
    options.cycle.map(|it| command.arg("--cycle").arg(format!("{it}ns")));
    options.stimulus.as_ref().map(|it| command.arg("--stimulus").arg(it));
    let ran = command.spawn().and_then(std::process::Child::wait_with_output);
    let ran = ran.map_err(|error| format!("cannot run {}: {error}", executable.display()))?;
    if !ran.status.success() {
        return Err(match ran.status.code().and_then(|it| u8::try_from(it).ok()) {
            Some(code) => Stop::Code(code),
            None => Stop::Message(format!("{} ended with {}", executable.display(), ran.status)),
        });
    }
    let line = String::from_utf8_lossy(&ran.stdout);
    let timing = line.parse().map_err(|()| format!("{} printed no figures: {line}", executable.display()))?;
    Ok(Figures { timing, text: text_bytes(&object), compile })
}

fn text(session: &Session, args: &Bench, program: &Program, figures: &Figures) -> String {
    let Figures { timing: Timing { scans, min, median, p99, overhead }, text, compile } = figures;
    let state = Layout::new(program).machine.size;
    let milliseconds = (session.compile_time + *compile).as_secs_f64() * 1e3;
    if session.common.format() == MessageFormat::Json {
        return format!(
            "{{\"reason\":\"bench\",\"scans\":{scans},\"ns_min\":{min:.2},\"ns_median\":{median:.2},\"ns_p99\":{p99:.2},\
             \"ns_overhead\":{overhead:.2},\"text_bytes\":{text},\"state_bytes\":{state},\"compile_ms\":{milliseconds:.3}}}\n"
        );
    }
    let names: Vec<&str> = program.instances.iter().map(|it| it.name.as_str()).collect();
    let backend = match args.backend {
        BuildBackend::Native => "native",
        BuildBackend::Rust => "Rust",
    };
    let rows = [
        ("minimum", format!("{} per scan", nanoseconds(*min))),
        ("median", format!("{} per scan", nanoseconds(*median))),
        ("99th percentile", format!("{} per scan", nanoseconds(*p99))),
        ("not counted", format!("{} per scan, of an empty program", nanoseconds(*overhead))),
        ("code", format!("{text} bytes")),
        ("state", format!("{state} bytes")),
        ("compiled in", format!("{milliseconds:.1} ms")),
    ];
    let mut out = format!("{}: {scans} scans, {backend} back end\n", names.join(", "));
    for (name, value) in rows {
        out += &format!("{name:>16}  {value}\n");
    }
    out
}

fn nanoseconds(value: f64) -> String {
    match value {
        0.0..1e3 => format!("{value:.1} ns"),
        0.0..1e6 => format!("{:.2} µs", value / 1e3),
        _ => format!("{:.2} ms", value / 1e6),
    }
}

/// Bytes of the executable sections of an object of ELF or Windows; 0 if it is none of 64 bits.
fn text_bytes(object: &[u8]) -> u64 {
    if object.starts_with(b"\x7fELF\x02\x01") {
        of_elf(object).unwrap_or(0)
    } else if object.starts_with(b"\x64\x86") {
        of_windows(object).unwrap_or(0)
    } else {
        0
    }
}

fn of_elf(object: &[u8]) -> Option<u64> {
    const EXECUTABLE: u64 = 4;
    let (table, size, count) = (number(object, 0x28, 8)?, number(object, 0x3A, 2)?, number(object, 0x3C, 2)?);
    let sections = (0..count).map(|it| table + it * size);
    let sizes = sections.filter_map(|at| Some((number(object, at + 8, 8)?, number(object, at + 0x20, 8)?)));
    Some(sizes.filter(|(flags, _)| flags & EXECUTABLE != 0).map(|(_, size)| size).sum())
}

fn of_windows(object: &[u8]) -> Option<u64> {
    const EXECUTABLE: u64 = 0x2000_0000;
    let (count, optional) = (number(object, 2, 2)?, number(object, 16, 2)?);
    let sections = (0..count).map(|it| 20 + optional + it * 40);
    let sizes = sections.filter_map(|at| Some((number(object, at + 36, 4)?, number(object, at + 16, 4)?)));
    Some(sizes.filter(|(flags, _)| flags & EXECUTABLE != 0).map(|(_, size)| size).sum())
}

/// A number of so many bytes, little endian.
fn number(object: &[u8], at: u64, size: usize) -> Option<u64> {
    let at = usize::try_from(at).ok()?;
    let bytes = object.get(at..at.checked_add(size)?)?;
    Some(bytes.iter().rev().fold(0, |sum, byte| sum << 8 | u64::from(*byte)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_code_counts() {
        let mut object = vec![0; 64 + 3 * 64];
        object[..6].copy_from_slice(b"\x7fELF\x02\x01");
        object[0x28] = 64;
        object[0x3A] = 64;
        object[0x3C] = 3;
        for (section, flags, size) in [(0, 6, 100), (1, 2, 50), (2, 4, 7)] {
            object[64 + section * 64 + 8] = flags;
            object[64 + section * 64 + 0x20] = size;
        }
        assert_eq!(text_bytes(&object), 107);
        assert_eq!(text_bytes(&object[..70]), 0);
        assert_eq!(text_bytes(b"MZ"), 0);
        let mut object = vec![0; 20 + 2 * 40];
        object[..4].copy_from_slice(&[0x64, 0x86, 2, 0]);
        for (section, flags, size) in [(0, 0x60, 30), (1, 0x40, 9)] {
            object[20 + section * 40 + 39] = flags;
            object[20 + section * 40 + 16] = size;
        }
        assert_eq!(text_bytes(&object), 30);
    }

    #[test]
    fn times_for_people() {
        assert_eq!(nanoseconds(12.34), "12.3 ns");
        assert_eq!(nanoseconds(12_345.0), "12.35 µs");
        assert_eq!(nanoseconds(2e6), "2.00 ms");
    }
}
