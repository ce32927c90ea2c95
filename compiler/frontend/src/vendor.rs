//! Structured Text in the files of other systems: text in, and out a text that is made of pieces of it, in the
//! order of the language, with what of the file is no Structured Text.

mod assembly;
mod exp;
mod plcopen;
mod twincat;
mod unit;
mod xml;

pub use assembly::{Assembly, Piece, Problem, Trouble};

use xml::{Part, Reader};

/// The Structured Text in a file of another system's; `None` where it is no such file.
pub fn read(text: &str) -> Option<Assembly> {
    if exp::is_export(text) {
        return Some(exp::read(text));
    }
    let mut reader = Reader::new(text)?;
    let root = reader.root().ok()??;
    match root.name {
        "TcPlcObject" => Some(twincat::read(text, reader)),
        "project" if text[root.place].contains("www.plcopen.org") => Some(plcopen::read(text, reader)),
        _ => None,
    }
}

/// The files that a project of TwinCAT's (`.plcproj`) compiles, as it writes them.
pub fn listed(text: &str) -> Result<Vec<String>, String> {
    let no_project = || "this is no project of TwinCAT's".to_owned();
    let mut reader = Reader::new(text).ok_or_else(no_project)?;
    let mut files = Vec::new();
    let broken = |it: xml::Broken| format!("the project is not well-formed XML: {}", it.why);
    reader.root().map_err(broken)?.filter(|it| it.name == "Project").ok_or_else(no_project)?;
    // Of an element of the list, whether something in it takes it out again.
    let mut excludes = false;
    while let Some(part) = reader.part().map_err(broken)? {
        match part {
            Part::Open(element) if element.name == "Compile" => {
                files.extend(element.attribute(text, "Include").map(str::to_owned));
            }
            Part::Open(element) => excludes = element.name == "ExcludeFromBuild",
            Part::Text(chunk) if excludes && text[chunk.place.clone()].trim().eq_ignore_ascii_case("true") => {
                files.pop();
            }
            Part::Text(_) => {}
            Part::Close => excludes = false,
        }
    }
    Ok(files)
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test fails by panicking")]
mod tests;
