//! Projects of OpenPLC Editor 4 and Autonomy Edge: a folder with a `project.json` that holds data types, global variables,
//! tasks and instances, POUs in text files below `pous`, and what is known of the device below `devices`. Before v4.1 the
//! POUs were JSON, too.

mod data_type;
mod device;
mod drawn;
mod global;
mod object;
mod other_language;
mod pou;
mod task;
mod variable;

use super::assembly::{Assembly, Trouble};
use super::json::{self, Kind, Value};
use object::Object;

/// What the editors' files are, by their names and contents.
enum File {
    Project,
    Configuration,
    Pins,
    Remote,
    Pou,
    OtherLanguage(&'static str),
}

/// Whether a text is a project's `project.json`: it says so of itself.
pub fn is_project(text: &str) -> bool {
    text.trim_start().starts_with('{') && (text.contains("\"plc-project\"") || text.contains("\"plc-library\""))
}

/// The Structured Text in one of the editors' files; `None` where it is not one.
pub fn read(path: &str, text: &str) -> Option<Assembly> {
    let mut out = Assembly::default();
    match file(path, text)? {
        File::OtherLanguage(word) => other_language::read(text, word, &mut out),
        File::Pou => whole(text, &mut out, pou::read),
        File::Project => whole(text, &mut out, project),
        File::Configuration => whole(text, &mut out, device::configuration),
        File::Pins => whole(text, &mut out, device::pins),
        File::Remote => whole(text, &mut out, device::remote),
    }
    Some(out)
}

fn file(path: &str, text: &str) -> Option<File> {
    let path = path.replace('\\', "/");
    let mut parts = path.rsplit('/');
    let (name, folder, above) = (parts.next()?, parts.next().unwrap_or_default(), parts.next().unwrap_or_default());
    let is_json = text.trim_start().starts_with(['{', '[']);
    let has = |word: &str| text.contains(word);
    match (folder, name) {
        _ if is_project(text) => Some(File::Project),
        (_, "project.json") if !is_other(text) => Some(File::Project),
        ("devices", "configuration.json") => Some(File::Configuration),
        ("devices", "pin-mapping.json") => Some(File::Pins),
        ("remote", it) if above == "devices" && it.ends_with(".json") => Some(File::Remote),
        (_, it) if it.ends_with(".json") && has("\"body\"") && has("\"language\"") => Some(File::Pou),
        _ if is_json => None,
        _ => other_language::language(name, text).map(File::OtherLanguage),
    }
}

/// Whether a file has JSON of other tools: an object with neither of the two that a project has.
fn is_other(text: &str) -> bool {
    let Ok(Value { kind: Kind::Object(members), .. }) = json::parse(text) else { return false };
    !members.iter().any(|it| matches!(it.name.raw(text), "meta" | "data"))
}

/// Reads a file that is JSON: a file that is not has its first mistake reported.
fn whole(text: &str, out: &mut Assembly, read: fn(&str, &Value, &mut Assembly)) {
    match json::parse(text) {
        Ok(value) => read(text, &value, out),
        Err(broken) => {
            let message = format!("this file of OpenPLC Editor is not well-formed JSON: {}", broken.why);
            out.problem(Trouble::Broken, message, &broken.place);
        }
    }
}

/// `project.json`
fn project(file: &str, value: &Value, out: &mut Assembly) {
    out.device = Some(device::of_project(file, value));
    let Some(whole) = Object::required(file, value, "a project", out) else { return };
    let Some(data) = whole.needed("data", "a project", out) else { return };
    for it in data.list("dataTypes", out) {
        data_type::write(file, it, out);
    }
    for it in data.list("globalVariableLists", out) {
        global::list(file, it, out);
    }
    for it in data.list("pous", out) {
        pou::read(file, it, out);
    }
    // It had both names.
    let configuration = match data.get("configuration") {
        Some(_) => data.object("configuration", out),
        None => data.object("configurations", out),
    };
    if let Some(resource) = configuration.and_then(|it| it.object("resource", out)) {
        global::variables(file, &resource, out);
        task::configuration(file, &resource, out);
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test fails by panicking")]
mod tests;
