//! The arguments of a built executable: those of `staunch run`.

use crate::attachments::{AtEnd, Connection};
use crate::bench::BenchOptions;
use crate::literal;
use crate::path::nearest;
use crate::realtime::{Overrun, Pacing};
use crate::run::{Moment, Options};
use staunch_runtime::Time;
use staunch_runtime::literal::duration;
use std::ffi::OsString;

/// The options of an executable.
#[derive(Clone, Debug)]
pub enum Wish {
    Run(Box<Options>),
    Bench(BenchOptions),
    Help(String),
    Version,
}

const FLAGS: [(&str, &str, &str); 27] = [
    ("--program", "NAME", "Run only this program"),
    ("--scans", "N", "End after N scans"),
    ("--cycle", "TIME", "Time between two scans, such as 10ms"),
    ("--loop-budget", "N", "Limit for the loop turns (iterations) in one scan, all loops together"),
    ("--stimulus", "FILE", "Inputs, from a CSV file"),
    ("--force", "NAME=VALUE", "Give a variable this value before and after each scan; may be repeated"),
    ("--trace", "FILE", "Write a row for each scan to a .csv, .vcd, .svg or .html file; - for standard output"),
    ("--from", "MOMENT", "Show scans from this one, or from this time: 120, 1s200ms"),
    ("--to", "MOMENT", "Show scans up to this one, or to this time"),
    ("--vars", "NAMES", "Variables to show, separated by commas"),
    ("--overlay", "NAMES", "Numeric variables that a .svg shows in one lane: a,b; may be repeated"),
    ("--retain", "FILE", "Keep retained variables in a file"),
    ("--retain-within", "TIME|scan", "In real time, the longest time until a change is on disk; default 1s"),
    ("--realtime", "", "Run in real time: wait until each scan is due"),
    ("--priority", "N", "In real time, run before other processes: SCHED_FIFO, 1 to 98, with all memory locked"),
    ("--cpu", "N", "In real time, run on this processor"),
    ("--overrun", "skip|catch-up|fault", "In real time, what to do after a scan that takes too long; default skip"),
    ("--watchdog", "TIME", "In real time, end the process if no scan has ended for this long"),
    ("--watchdog-device", "FILE", "In real time, reset this hardware watchdog as long as scans end: /dev/watchdog"),
    (
        "--io",
        "CONNECTION",
        "In real time, connect %I, %Q and %M: shm:NAME, modbus:ADDRESS:PORT or modbus-rtu:PORT; may be repeated",
    ),
    ("--io-stop", "zero|hold", "With --io, what outputs do at the end; default zero"),
    ("--table", "", "Print the last scans as a table"),
    ("--bench", "", "Measure the time of a scan instead"),
    ("--quiet", "", "Print nothing but errors and the trace"),
    ("--message-format", "human|json", "Print a fault and the totals as JSON"),
    ("--version", "", "Print the program and what compiled it"),
    ("--help", "", "Print this"),
];

/// Reads the arguments, of which the first is the executable's name. `is_connected` says that a project connects inputs and outputs.
pub fn parse_options(mut arguments: impl Iterator<Item = OsString>, is_connected: bool) -> Result<Wish, String> {
    let name = arguments.next().unwrap_or_default();
    let (mut options, mut bench, mut at_end) = (Options::default(), false, None);
    while let Some(argument) = arguments.next() {
        let text = argument.to_string_lossy().into_owned();
        let (flag, attached) = match text.split_once('=') {
            Some((flag, value)) => (flag, Some(OsString::from(value))),
            None => (text.as_str(), None),
        };
        let mut value = || match attached.clone().or_else(|| arguments.next()) {
            Some(value) => Ok(value),
            None => Err(format!("{flag} needs a value")),
        };
        match flag {
            "--program" => options.program = Some(utf8(value()?)?),
            "--scans" => options.scans = Some(count(&utf8(value()?)?)?),
            "--cycle" => options.cycle = Some(parse_duration(&utf8(value()?)?)?),
            "--loop-budget" => options.loop_budget = Some(count(&utf8(value()?)?)?),
            "--stimulus" => options.stimulus = Some(value()?.into()),
            "--force" => options.forces.push(utf8(value()?)?),
            "--trace" => options.trace = Some(value()?.into()),
            "--vars" => options.vars = Some(utf8(value()?)?),
            "--overlay" => options.overlay.push(utf8(value()?)?),
            "--from" => options.from = Some(parse_moment(&utf8(value()?)?)?),
            "--to" => options.to = Some(parse_moment(&utf8(value()?)?)?),
            "--message-format" => options.json = is_json(&utf8(value()?)?)?,
            "--retain" => options.retain = Some(value()?.into()),
            "--retain-within" => options.retain_within = Some(parse_within(&utf8(value()?)?)?),
            "--table" => options.table = true,
            "--realtime" => options.realtime = true,
            "--priority" => options.pacing.priority = Some(parse_priority(&utf8(value()?)?)?),
            "--cpu" => options.pacing.cpu = Some(parse_cpu(&utf8(value()?)?)?),
            "--overrun" => options.pacing.overrun = Overrun::parse(&utf8(value()?)?)?,
            "--watchdog" => options.pacing.watchdog = Some(parse_duration(&utf8(value()?)?)?),
            "--watchdog-device" => options.pacing.watchdog_device = Some(value()?.into()),
            "--io" => options.io.connections.push(Connection::parse(&utf8(value()?)?)?),
            "--io-stop" => at_end = Some(AtEnd::parse(&utf8(value()?)?)?),
            "--bench" => bench = true,
            "--quiet" | "-q" => options.quiet = true,
            "--version" | "-V" => return Ok(Wish::Version),
            "--help" | "-h" => return Ok(Wish::Help(help(&name.to_string_lossy()))),
            other => {
                let near = nearest(other, FLAGS.iter().map(|it| it.0));
                return Err(format!("unknown argument `{other}`{near} (--help lists them)"));
            }
        }
    }
    if options.retain_within.is_some() && options.retain.is_none() {
        return Err("--retain-within needs --retain, the file to keep them in".to_owned());
    }
    if at_end.is_some() && options.io.connections.is_empty() && !is_connected {
        return Err("--io-stop needs --io, what the outputs are connected with".to_owned());
    }
    options.io.at_end = at_end.unwrap_or_default();
    let Options { program, scans, cycle, loop_budget, stimulus, .. } = options;
    Ok(match bench {
        true => Wish::Bench(BenchOptions { program, scans, cycle, loop_budget, stimulus }),
        false => Wish::Run(Box::new(Options { program, scans, cycle, loop_budget, stimulus, ..options })),
    })
}

fn utf8(text: OsString) -> Result<String, String> {
    text.into_string().map_err(|text| format!("`{}` is not UTF-8", text.to_string_lossy()))
}

fn count(text: &str) -> Result<u64, String> {
    text.replace('_', "").parse().map_err(|_| format!("`{text}` is not a number of scans"))
}

/// Nanoseconds of `10ms`, `1s500ms` or `T#10ms`, above zero.
pub fn parse_duration(text: &str) -> Result<Time, String> {
    let time = match text.contains('#') {
        true => literal::time(text).ok(),
        false => duration(text).ok(),
    };
    time.filter(|it| *it > 0).ok_or_else(|| format!("`{text}` is not a time above zero: write `10ms`"))
}

/// A priority of SCHED_FIFO that leaves room for a watchdog's.
pub fn parse_priority(text: &str) -> Result<u8, String> {
    let highest = Pacing::HIGHEST_PRIORITY;
    let number = text.parse().ok().filter(|it| (1..=highest).contains(it));
    number.ok_or_else(|| format!("`{text}` is not a priority: write a number from 1 to {highest}"))
}

fn parse_cpu(text: &str) -> Result<usize, String> {
    text.parse().map_err(|_| format!("`{text}` is not the number of a processor"))
}

/// How soon a change of retained variables is on disk, in nanoseconds: `500ms`; `scan`, which is 0, for
/// after every scan.
pub fn parse_within(text: &str) -> Result<Time, String> {
    match text {
        "scan" => Ok(0),
        _ => parse_duration(text).map_err(|error| format!("{error}, or `scan` for every scan")),
    }
}

/// A scan's number, or a time of the program's clock.
pub fn parse_moment(text: &str) -> Result<Moment, String> {
    if let Ok(scan) = text.replace('_', "").parse() {
        return Ok(Moment::Scan(scan));
    }
    let time = if text.contains('#') { literal::time(text).ok() } else { duration(text).ok() };
    let time = time.filter(|it| *it >= 0).map(Moment::Time);
    time.ok_or_else(|| format!("`{text}` is neither the number of a scan nor a time: write `120` or `1s200ms`"))
}

fn is_json(text: &str) -> Result<bool, String> {
    match text {
        "human" => Ok(false),
        "json" => Ok(true),
        _ => Err(format!("`{text}` is not a format: expected human or json")),
    }
}

fn help(name: &str) -> String {
    let name = name.rsplit(['/', '\\']).next().unwrap_or(name);
    let mut text = format!(
        "Runs a compiled IEC 61131-3 program.\n\n\
         With --scans, --stimulus, --trace or --table it runs on a virtual clock that does not\n\
         wait; without them, in real time until it is interrupted.\n\nUsage: {name} [OPTIONS]\n\nOptions:\n"
    );
    for (flag, value, meaning) in FLAGS {
        text += &format!("  {:<27} {meaning}\n", format!("{flag} {value}"));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(text: &str) -> Result<Wish, String> {
        parse_options(
            std::iter::once("x").chain(text.split_whitespace()).map(OsString::from).collect::<Vec<_>>().into_iter(),
            false,
        )
    }

    #[test]
    fn every_flag_is_read() {
        let text = "--program P --scans=5 --force=a=1 --force b=2 --cycle 1ms --stimulus a.csv --trace - --vars a,b --retain r --retain-within scan --realtime --table -q --from 3 --to T#1s --message-format=json";
        let Wish::Run(options) = parse(text).unwrap() else { panic!() };
        assert_eq!(options.program.as_deref(), Some("P"));
        assert_eq!((options.scans, options.cycle), (Some(5), Some(1_000_000)));
        assert_eq!(options.trace, Some("-".into()));
        assert!(options.stimulus.is_some() && options.vars.is_some() && options.retain.is_some());
        assert!(options.realtime && options.table && options.quiet && options.json);
        assert_eq!((options.from, options.to), (Some(Moment::Scan(3)), Some(Moment::Time(1_000_000_000))));
        assert_eq!(options.retain_within, Some(0));
        assert_eq!(options.forces, ["a=1", "b=2"]);
        let Wish::Bench(bench) = parse("--bench --scans 7").unwrap() else { panic!() };
        assert_eq!(bench.scans, Some(7));
        let Wish::Help(help) = parse("--help").unwrap() else { panic!() };
        assert!(FLAGS.iter().all(|it| help.contains(it.0)));
    }

    #[test]
    fn mistakes_are_errors() {
        assert_eq!(
            parse("--scan 1").unwrap_err(),
            "unknown argument `--scan`; did you mean `--scans`? (--help lists them)"
        );
        assert_eq!(parse("--scans").unwrap_err(), "--scans needs a value");
        assert_eq!(
            parse("--to soon").unwrap_err(),
            "`soon` is neither the number of a scan nor a time: write `120` or `1s200ms`"
        );
        assert_eq!(
            parse("--retain-within 1s").unwrap_err(),
            "--retain-within needs --retain, the file to keep them in"
        );
        assert_eq!(
            parse("--retain r --retain-within 0s").unwrap_err(),
            "`0s` is not a time above zero: write `10ms`, or `scan` for every scan"
        );
        assert_eq!(parse("--cycle 0s").unwrap_err(), "`0s` is not a time above zero: write `10ms`");
    }
}
