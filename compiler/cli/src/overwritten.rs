//! W0522: a column of a stimulus for a variable that the program overwrites before it reads it.

use crate::session::Session;
use staunch_frontend::{Code, Diagnostic};
use staunch_host::{Map, Place, csv_cells, place_of, same_name};
use staunch_ir::Program;
use staunch_ir::overwritten::{Overwritten, overwritten};
use std::fs::File;
use std::io::{BufRead, BufReader, Read};
use std::path::Path;

/// Reports the columns. What cannot be read is left to the host, which says why.
pub fn lint(session: &Session, program: &Program, stimulus: &Path) -> Result<bool, String> {
    let columns = columns(stimulus);
    let found = if columns.is_empty() { Vec::new() } else { overwritten(program) };
    if found.is_empty() {
        return Ok(true);
    }
    let map = staunch_machine::map(program)?;
    let running: Vec<usize> = (0..map.instances.len()).collect();
    // Of a trace, only the inputs are written.
    let is_trace = columns.get(1).is_some_and(|it| same_name(it, "time_ms"));
    let lints = columns.iter().filter_map(|name| {
        let place = place_of(&map, &running, name).ok().filter(|it| it.input || !is_trace)?;
        let it = found.iter().find(|it| holds(it, &place, &map))?;
        let message = format!("the stimulus gives `{name}` values that the program never reads");
        Some(
            Diagnostic::new(Code::W0522, session.statement_at(it.at), message)
                .label("each scan assigns it here before anything reads it")
                .note(format!("the column `{name}` is in {}", stimulus.display()))
                .help(format!("delete the column; expected values of `{name}` are to the right of a column `|`")),
        )
    });
    session.report(lints.collect())
}

/// A longer header is not looked at.
const LONGEST: u64 = 1 << 20;

/// The names in the header, up to the expected values.
fn columns(stimulus: &Path) -> Vec<String> {
    let header = header(stimulus).unwrap_or_default();
    let header = String::from_utf8_lossy(&header);
    let header = header.trim_start_matches('\u{feff}').trim_end_matches(['\r', '\n']);
    let cells = csv_cells(header).and_then(|it| it.into_iter().next()).unwrap_or_default();
    cells.into_iter().take_while(|it| it != "|").collect()
}

/// The first line of a file. A pipe is left to the host, which reads it once.
fn header(stimulus: &Path) -> std::io::Result<Vec<u8>> {
    let mut header = Vec::new();
    if std::fs::metadata(stimulus)?.is_file() {
        BufReader::new(File::open(stimulus)?).take(LONGEST).read_until(b'\n', &mut header)?;
    }
    Ok(header)
}

fn holds(overwritten: &Overwritten, place: &Place, map: &Map) -> bool {
    let (start, end) = (overwritten.offset, overwritten.offset + overwritten.size);
    let (Ok(offset), Ok(size)) = (u64::try_from(place.offset), u64::try_from(map.size_of(place.ty))) else {
        return false;
    };
    start <= offset && offset + size <= end
}
