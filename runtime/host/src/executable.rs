//! What an executable made of compiled code does.

use crate::Error;
use crate::args::{Wish, parse_options};
use crate::bench::bench;
use crate::compiled::{Code, Compiled};
use crate::map::Map;
use crate::run::{Options, run, title};
use std::ffi::OsString;
use std::process::ExitCode;

/// What a built executable does: runs its program as its arguments say.
pub fn main(code: Code) -> ExitCode {
    ExitCode::from(main_with(code, std::env::args_os()))
}

/// [`main`] with the arguments given, the executable's name first. Returns the exit code, for a
/// C `main`.
pub fn main_with(code: Code, arguments: impl Iterator<Item = OsString>) -> u8 {
    let started = Map::parse(code.map).and_then(|map| Ok((map, parse_options(arguments).map_err(Error::Usage)?)));
    let (map, wish) = match started {
        Ok(started) => started,
        Err(error) => return failed(&Options::default(), &error),
    };
    // SAFETY: `Code::new` was promised that the entry points belong to the map.
    let mut machine = unsafe { Compiled::new(&map, code.init, code.scan) };
    match wish {
        Wish::Run(options) => start(&mut machine, &map, options),
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
fn version(map: &Map) -> String {
    let all: Vec<usize> = (0..map.instances.len()).collect();
    format!("{} ({}), compiled by Staunch {}\n", title(map, &all), map.files.join(", "), map.compiler)
}

/// A reader that has gone away wants no help.
fn print(text: &str) -> u8 {
    use std::io::Write;
    let _ = std::io::stdout().write_all(text.as_bytes());
    0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture::{MAP, map};
    use staunch_runtime::Context;

    unsafe extern "C" fn init(state: *mut u8) {
        // SAFETY: the tests below give it the state of the fixture's map.
        unsafe { state.write_bytes(0, 128) }
    }

    unsafe extern "C" fn scan(state: *mut u8, cx: *const Context, instance: u32) -> u64 {
        // SAFETY: as above; the offset is below the map's size.
        unsafe {
            *state.add(36) = instance as u8 + 7;
            if (*cx).now() >= 20_000_000 { 1 | 5 << 24 | 9 << 40 } else { 0 }
        }
    }

    fn arguments(text: &str) -> impl Iterator<Item = OsString> {
        std::iter::once("garage").chain(text.split_whitespace()).map(OsString::from).collect::<Vec<_>>().into_iter()
    }

    #[test]
    #[cfg_attr(miri, ignore = "it measures time")]
    fn an_executable_reports_as_the_command_does() {
        // SAFETY: as above.
        let code = unsafe { Code::new(MAP, init, scan) };
        assert_eq!(main_with(code, arguments("--scans 2 -q")), 0);
        assert_eq!(main_with(code, arguments("--bench --scans 2 --cycle 1us")), 3);
        assert_eq!(main_with(code, arguments("--scans 9 -q")), 3);
        assert_eq!(main_with(code, arguments("--scan 9")), 2);
        assert_eq!(main_with(code, arguments("--scans 1 --vars nothing")), 2);
        assert_eq!(main_with(code, arguments("--version")), 0);
        assert_eq!(version(&map()), "Garage (garage.st), compiled by Staunch 1.2.3\n");
    }
}
