//! Structured Text in the files of other systems: text in, and out a text that is made of pieces of it, in the
//! order of the language, with what of the file is no Structured Text.

mod assembly;
mod automation_studio;
mod device;
mod diagram;
mod exp;
mod json;
mod l5x;
mod listing;
mod neutral;
mod openplc;
mod plcopen;
mod scl;
mod twincat;
mod unit;
mod xml;

pub use assembly::{Assembly, Piece, Problem, Trouble};
pub use automation_studio::is_list as is_list_of_automation_studio;
pub use device::Device;
pub use l5x::{controller_service, ladder_instructions};
pub use listing::{Reference, definitions, listed, project_name, project_title, references};
pub use openplc::is_project as is_openplc_project;

use xml::Reader;

/// The Structured Text in a file of another system; `None` if it is not such a file.
pub fn read(text: &str) -> Option<Assembly> {
    if exp::is_export(text) {
        return Some(exp::read(text));
    }
    if scl::is_source(text) {
        return Some(scl::read(text));
    }
    if let Some(found) = neutral::read(text) {
        return Some(found);
    }
    let mut reader = Reader::new(text)?;
    let root = reader.root().ok()??;
    match root.name {
        "TcPlcObject" => Some(twincat::read(text, reader)),
        "RSLogix5000Content" => Some(l5x::read(text, reader)),
        "project" if plcopen::is_project(text, &root.place) => Some(plcopen::read(text, reader)),
        _ => None,
    }
}

/// The Structured Text in a file that is called as a source of SCL is, or as a file of OpenPLC Editor.
pub fn read_named(path: &str, text: &str) -> Option<Assembly> {
    let named = || (is_scl_name(path) && !text.contains('\0')).then(|| scl::read(text));
    let variables = || automation_studio::variables(path, text);
    openplc::read(path, text).or_else(variables).or_else(|| read(text)).or_else(named)
}

/// The parts of a TwinCAT 3 file that are Structured Text, each as it is.
pub fn texts_of_twincat(file: &str) -> Option<Vec<core::ops::Range<usize>>> {
    let mut reader = Reader::new(file)?;
    let root = reader.root().ok()??;
    (root.name == "TcPlcObject").then(|| twincat::texts(reader))?
}

/// Whether a file holds Structured Text in the form of a system's editor, and is not Structured Text itself.
pub fn is_of_other_editor(path: &str, text: &str) -> bool {
    !scl::is_source(text) && !is_scl_name(path) && read_named(path, text).is_some()
}

/// Whether a file with this name is a source of TIA Portal: of blocks, of a data type, of data blocks.
fn is_scl_name(path: &str) -> bool {
    let extension = path.rsplit_once('.').map_or("", |it| it.1);
    ["scl", "udt", "db"].iter().any(|it| it.eq_ignore_ascii_case(extension))
}

/// Whether a file with this name is a TwinCAT 3 file.
pub fn is_twincat_name(path: &str) -> bool {
    let extension = path.rsplit_once('.').map_or("", |it| it.1);
    ["TcPOU", "TcGVL", "TcDUT", "TcIO", "TcTLEO", "TcTTO"].iter().any(|it| it.eq_ignore_ascii_case(extension))
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test fails by panicking")]
mod tests;
