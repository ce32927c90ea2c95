//! What can go wrong around a program.

use crate::json::quote;
use staunch_runtime::{Fault, Time};
use std::fmt;
use std::io;
use std::path::{Path, PathBuf};
use std::time::Duration;

#[derive(Debug)]
pub enum Error {
    /// The command line names something that does not exist, or contradicts itself.
    Usage(String),
    /// A place in a stimulus file: 1-based line, and column in characters.
    Stimulus { path: PathBuf, line: usize, column: usize, text: String },
    /// A file of retained variables that cannot be used.
    Retain { path: PathBuf, text: String },
    /// A file that cannot be read or written.
    File { path: PathBuf, doing: &'static str, error: io::Error },
    /// The reader of the output has closed it, which is not a mistake.
    ClosedPipe,
    /// The program's map cannot be read: program and host have different versions.
    Map { line: usize, text: String },
    /// The program faulted.
    Fault { fault: Fault, scan: u64, instance: String, path: String },
    /// A scan had not ended when the next one was due, in a run in real time that ends then. Times in nanoseconds.
    Overrun { scan: u64, instance: String, late: Time, took: Time, period: Time },
    /// A server of inputs and outputs does not answer, in a run in real time that ends then.
    Connection { name: String, trouble: String },
}

impl Error {
    pub(crate) fn file(path: &Path, doing: &'static str, error: io::Error) -> Self {
        match error.kind() {
            io::ErrorKind::BrokenPipe => Self::ClosedPipe,
            _ => Self::File { path: path.to_owned(), doing, error },
        }
    }

    /// The error as a JSON object.
    pub fn json(&self) -> String {
        let message = quote(&self.to_string());
        match self {
            Self::Fault { fault, scan, instance, path } => format!(
                "{{\"reason\":\"fault\",\"message\":{message},\"kind\":{},\"file\":{},\"line\":{},\"column\":{},\
                 \"scan\":{scan},\"program\":{}}}",
                quote(fault.kind.text()),
                quote(path),
                fault.at.line,
                fault.at.column,
                quote(instance)
            ),
            Self::Overrun { scan, instance, late, took, period } => format!(
                "{{\"reason\":\"fault\",\"message\":{message},\"kind\":\"overrun\",\"late_ns\":{late},\"took_ns\":{took},\"period_ns\":{period},\
                 \"scan\":{scan},\"program\":{}}}",
                quote(instance)
            ),
            Self::Connection { name, .. } => format!(
                "{{\"reason\":\"fault\",\"message\":{message},\"kind\":\"connection\",\"connection\":{}}}",
                quote(name)
            ),
            Self::Usage(_)
            | Self::Stimulus { .. }
            | Self::Retain { .. }
            | Self::File { .. }
            | Self::ClosedPipe
            | Self::Map { .. } => format!("{{\"reason\":\"error\",\"message\":{message}}}"),
        }
    }

    /// The exit code of a process that ends with this error.
    pub const fn exit_code(&self) -> u8 {
        match self {
            Self::ClosedPipe => 0,
            Self::Fault { .. } | Self::Overrun { .. } | Self::Connection { .. } => 3,
            Self::Map { .. } => 101,
            Self::Usage(_) | Self::Stimulus { .. } | Self::Retain { .. } | Self::File { .. } => 2,
        }
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Usage(text) => f.write_str(text),
            Self::Stimulus { path, line, column, text } => {
                write!(f, "{}:{line}:{column}: {text}", path.display())
            }
            Self::Retain { path, text } => write!(f, "{}: {text}", path.display()),
            Self::File { path, doing, error } => write!(f, "cannot {doing} {}: {error}", path.display()),
            Self::ClosedPipe => f.write_str("the output was closed"),
            Self::Map { line, text } => write!(f, "the program's map, line {line}: {text}"),
            Self::Overrun { scan, instance, late, took, period } => {
                f.write_str("overrun: a scan ")?;
                // Another program, or the machine, has kept it from its time.
                if took < period {
                    write!(f, "began {} late and ", rounded(*late))?;
                }
                let (took, period) = (rounded(*took), rounded(*period));
                write!(f, "took {took} of {period} (scan {scan}, program {instance}, --overrun fault)")
            }
            Self::Connection { name, trouble } => write!(f, "connection: {name}: {trouble}"),
            Self::Fault { fault, scan, instance, path } => {
                let (line, column) = (fault.at.line, fault.at.column);
                write!(f, "{path}:{line}:{column}: fault: {} (scan {scan}, program {instance})", fault.kind)
            }
        }
    }
}

fn rounded(time: Time) -> String {
    crate::spoken::rounded(Duration::from_nanos(u64::try_from(time).unwrap_or(0)))
}

impl std::error::Error for Error {}

/// Writes a line to standard error. If that is closed, nobody reads it, and the program continues.
pub(crate) fn tell(line: impl fmt::Display) {
    use io::Write as _;
    let _ = writeln!(io::stderr().lock(), "{line}");
}
