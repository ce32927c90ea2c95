//! What a run does at a stop: what a person or a file says, or what the command line has said before.

use crate::args::Debug;
use std::fs::File;
use std::io::{self, BufRead, BufReader, IsTerminal, Write};
use std::path::Path;

/// One command.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Command {
    Continue,
    Step,
    Next,
    Out,
    Print(String),
    Quit,
    Help,
    Unknown(String),
}

pub(super) const HELP: &str = "c continue to the next breakpoint   s step, into calls   n next statement, over calls\n\
    o out of this call                 p EXPR print a value  q end the run          (an empty line repeats)";

impl Command {
    fn parse(line: &str) -> Self {
        let (word, rest) = line.split_once(char::is_whitespace).unwrap_or((line, ""));
        match (word, rest.trim()) {
            ("c" | "continue", "") => Self::Continue,
            ("s" | "step", "") => Self::Step,
            ("n" | "next", "") => Self::Next,
            ("o" | "out", "") => Self::Out,
            ("q" | "quit", "") => Self::Quit,
            ("h" | "help" | "?", "") => Self::Help,
            ("p" | "print", expression) if !expression.is_empty() => Self::Print(expression.to_owned()),
            _ => Self::Unknown(line.to_owned()),
        }
    }
}

/// Where commands come from.
pub(super) enum Commands {
    /// Stops are only printed; `None` for all of them.
    Printed { left: Option<u64> },
    /// A line each. At the end of the lines the run ends.
    Read { lines: Box<dyn BufRead>, is_asked_for: bool, last: Option<Command> },
}

impl Commands {
    pub fn of(args: &Debug) -> Result<Self, String> {
        if let Some(path) = &args.commands {
            let file = || File::open(path).map_err(|error| format!("--commands {}: {error}", path.display()));
            let lines: Box<dyn BufRead> = match path.as_path() == Path::new("-") {
                true => Box::new(BufReader::new(io::stdin())),
                false => Box::new(BufReader::new(file()?)),
            };
            return Ok(Self::Read { lines, is_asked_for: false, last: None });
        }
        let is_watched = io::stdin().is_terminal() && io::stderr().is_terminal();
        if args.stops.is_none() && is_watched {
            return Ok(Self::Read { lines: Box::new(BufReader::new(io::stdin())), is_asked_for: true, last: None });
        }
        let stops = args.stops.unwrap_or(1);
        Ok(Self::Printed { left: (stops > 0).then_some(stops) })
    }

    /// The next command of a file or person.
    pub fn next(&mut self) -> Command {
        let Self::Read { lines, is_asked_for, last } = self else { return Command::Continue };
        if *is_asked_for {
            let mut out = io::stderr().lock();
            // If standard error is closed, nobody reads it.
            let _ = write!(out, "(staunch) ").and_then(|()| out.flush());
        }
        let mut line = String::new();
        let command = match lines.read_line(&mut line) {
            Ok(0) | Err(_) => return Command::Quit,
            Ok(_) => match line.trim() {
                "" => last.clone().unwrap_or(Command::Help),
                line => Command::parse(line),
            },
        };
        *last = Some(command.clone());
        command
    }
}

impl std::fmt::Debug for Commands {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Commands").finish_non_exhaustive()
    }
}
