//! Minor faults in words: divisions by zero after which a program continues.

use crate::json::quote;
use crate::map::Map;
use staunch_runtime::MinorFaults;

/// The note about them, if there were any.
pub fn minor_faults_note(faults: MinorFaults, map: &Map) -> Option<String> {
    let at = faults.first?;
    let divisions = if faults.count == 1 { "1 division".to_owned() } else { format!("{} divisions", faults.count) };
    Some(format!(
        "note: {divisions} by zero, the first at {}:{}:{}: a minor fault (type 4, code 4), and the program continues",
        map.file(at.file),
        at.line,
        at.column
    ))
}

/// The same as an object of JSON.
pub fn minor_faults_json(faults: MinorFaults, map: &Map) -> Option<String> {
    let at = faults.first?;
    let place = format!("\"file\":{},\"line\":{},\"column\":{}", quote(map.file(at.file)), at.line, at.column);
    Some(format!("{{\"reason\":\"minor-faults\",\"count\":{},{place}}}", faults.count))
}
