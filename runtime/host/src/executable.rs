//! The behaviour of a built executable.

use crate::Error;
use crate::args::{Wish, parse_options};
use crate::bench::bench;
use crate::compiled::{Code, Compiled};
use crate::map::Map;
use crate::run::{Options, run, title};
use crate::signal;
use std::ffi::OsString;
use std::process::ExitCode;

/// The main function of a built executable: runs its program according to its arguments.
pub fn main(code: Code) -> ExitCode {
    ExitCode::from(main_with(code, std::env::args_os()))
}

/// [`main`] with the arguments given, the executable's name first. Returns the exit code, for a
/// C `main`.
pub fn main_with(code: Code, arguments: impl Iterator<Item = OsString>) -> u8 {
    signal::ignore_closed_pipes();
    let started = code.machine().and_then(|(map, machine)| {
        let wish = parse_options(arguments, map.is_connected()).map_err(Error::Usage)?;
        Ok(((map, machine), wish))
    });
    let ((map, mut machine), wish) = match started {
        Ok(started) => started,
        Err(error) => return failed(&Options::default(), &error),
    };
    match wish {
        Wish::Run(options) => start(&mut machine, &map, *options),
        Wish::Bench(options) => match bench(&mut machine, &map, &options) {
            Ok(timing) => print(&format!("{timing}\n")),
            Err(error) => failed(&Options::default(), &error),
        },
        Wish::Help(text) => print(&text),
        Wish::Version => print(&version(&map)),
    }
}

fn start(machine: &mut Compiled, map: &Map, mut options: Options) -> u8 {
    // On its own an executable is the controller itself.
    let alone =
        options.scans.is_none() && options.stimulus.is_none() && options.trace.is_none() && options.to.is_none();
    options.realtime |= alone && !options.table;
    options.table |= !alone;
    match run(machine, map, &options) {
        Ok(_) => 0,
        Err(error) => failed(&options, &error),
    }
}

fn failed(options: &Options, error: &Error) -> u8 {
    options.report(error);
    error.exit_code()
}

/// `Main (plant.st), compiled by Staunch 0.1.0`
pub(crate) fn version(map: &Map) -> String {
    let all: Vec<usize> = (0..map.instances.len()).collect();
    format!("{} ({}), compiled by Staunch {}\n", title(map, &all), map.files.join(", "), map.compiler)
}

/// A reader that has closed the output needs no help text.
fn print(text: &str) -> u8 {
    use std::io::Write;
    let _ = std::io::stdout().write_all(text.as_bytes());
    0
}
