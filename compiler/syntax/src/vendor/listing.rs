//! What TwinCAT's projects list: a solution (`.sln`) its projects, such a project (`.tsproj`, with parts of it in
//! `.xti`) its PLC projects, and a PLC project (`.plcproj`) its sources.

use super::xml::{Broken, Part, Reader};

/// The files that one of them lists, as it writes them.
pub fn listed(text: &str) -> Result<Vec<String>, String> {
    if text.trim_start().starts_with("Microsoft Visual Studio Solution File") {
        return Ok(projects_of_a_solution(text));
    }
    let no_project = || "this is not a TwinCAT project".to_owned();
    let broken = |it: Broken| format!("the project is not well-formed XML: {}", it.why);
    let mut reader = Reader::new(text).ok_or_else(no_project)?;
    let root = reader.root().map_err(broken)?.ok_or_else(no_project)?;
    let files = match root.name {
        "Project" => sources(text, &mut reader),
        "TcSmProject" | "TcSmItem" => plc_projects(text, &mut reader),
        _ => return Err(no_project()),
    };
    files.map_err(broken)
}

/// `Project("{…}") = "Plant", "Plant\Plant.tsproj", "{…}"`: those of other kinds are passed over.
fn projects_of_a_solution(text: &str) -> Vec<String> {
    let lines = text.lines().filter(|it| it.trim_start().starts_with("Project("));
    let paths = lines.filter_map(|it| it.split('"').nth(5));
    let is_ours =
        |it: &&str| [".tsproj", ".tspproj", ".plcproj"].iter().any(|end| it.to_ascii_lowercase().ends_with(end));
    paths.filter(is_ours).map(str::to_owned).collect()
}

/// Of elements `Project`, what they name. One that is in a file of its own is in a folder of its own, too.
fn plc_projects<'t>(text: &'t str, reader: &mut Reader<'t>) -> Result<Vec<String>, Broken> {
    let mut files = Vec::new();
    while let Some(part) = reader.part()? {
        if let Part::Open(element) = part
            && element.name == "Project"
        {
            files.extend(element.attribute(text, "PrjFilePath").map(str::to_owned));
            files.extend(element.attribute(text, "File").map(|it| format!("_Config\\PLC\\{it}")));
        }
    }
    Ok(files)
}

/// A library as a PLC project refers to it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Reference {
    pub library: String,
    /// What the project's sources call it by.
    pub namespace: String,
}

/// The libraries that a PLC project refers to: `Include="TcUnit"`, or `"TcUnit,1.2,www.tcunit.org"`.
pub fn references(text: &str) -> Vec<Reference> {
    let Some(mut reader) = Reader::new(text) else { return Vec::new() };
    let (mut found, mut is_namespace) = (Vec::<Reference>::new(), false);
    // What is not well-formed is said by who reads the list.
    while let Ok(Some(part)) = reader.part() {
        match part {
            Part::Open(element) if matches!(element.name, "PlaceholderReference" | "LibraryReference") => {
                let named = element.attribute(text, "Include").unwrap_or_default();
                let library = named.split(',').next().unwrap_or_default();
                let library = library.trim().trim_matches(['[', ']']).to_owned();
                found.push(Reference { namespace: library.clone(), library });
            }
            Part::Open(element) => is_namespace = element.name == "Namespace",
            Part::Text(chunk) if is_namespace => {
                if let Some(last) = found.last_mut() {
                    text[chunk.place].trim().clone_into(&mut last.namespace);
                }
            }
            Part::Text(_) => {}
            Part::Close => is_namespace = false,
        }
    }
    found
}

/// What a PLC project is called in its first `Name`.
pub fn project_name(text: &str) -> Option<String> {
    first(text, "Name")
}

/// What a PLC project is called when it is a library: by its `Title`.
pub fn project_title(text: &str) -> Option<String> {
    first(text, "Title").filter(|it| !it.is_empty())
}

fn first(text: &str, wanted: &str) -> Option<String> {
    let (mut reader, mut is_it) = (Reader::new(text)?, false);
    while let Ok(Some(part)) = reader.part() {
        match part {
            Part::Open(element) => is_it = element.name == wanted,
            Part::Text(chunk) if is_it => return Some(text[chunk.place].trim().to_owned()),
            Part::Text(_) => {}
            Part::Close => is_it = false,
        }
    }
    None
}

/// The names in a PLC project's `CompilerDefines`, each with its value after `=` where it has one: `Line=3`.
pub fn definitions(text: &str) -> Vec<String> {
    let Some(mut reader) = Reader::new(text) else { return Vec::new() };
    let (mut found, mut is_it) = (Vec::new(), false);
    while let Ok(Some(part)) = reader.part() {
        match part {
            Part::Open(element) => is_it = element.name == "CompilerDefines",
            Part::Text(chunk) if is_it => {
                let definitions = text[chunk.place].split([',', ';']).map(definition);
                found.extend(definitions.filter(|it| !it.is_empty()));
            }
            Part::Text(_) => {}
            Part::Close => is_it = false,
        }
    }
    found
}

/// `Line=3` of `Line := '3'`.
fn definition(text: &str) -> String {
    let Some((name, value)) = text.split_once('=') else { return text.trim().to_owned() };
    let name = name.trim_end().trim_end_matches(':').trim();
    let value = value.replace("&apos;", "'");
    format!("{name}={}", value.trim().trim_matches('\''))
}

/// What is being read of a PLC project's list of files.
#[derive(Default)]
struct Listing {
    files: Vec<String>,
    /// Folders that are excluded, with all that is below them.
    folders: Vec<String>,
    entry: Option<Entry>,
    /// Whether what is read says if the entry is excluded.
    asks: bool,
}

/// An element of the list: `<Compile Include="A.TcPOU">`, `<Folder Include="Old">`.
struct Entry {
    path: String,
    is_folder: bool,
    is_excluded: bool,
}

impl Listing {
    fn finish_entry(&mut self) {
        match self.entry.take() {
            Some(Entry { path, is_folder: true, is_excluded: true }) => self.folders.push(path),
            Some(Entry { path, is_folder: false, is_excluded: false }) => self.files.push(path),
            Some(_) | None => {}
        }
    }

    /// The files that are not below an excluded folder.
    fn included(self) -> Vec<String> {
        let parts = |path: &str| -> Vec<String> {
            path.split(['\\', '/']).filter(|it| !it.is_empty()).map(str::to_ascii_lowercase).collect()
        };
        let folders: Vec<_> = self.folders.iter().map(|it| parts(it)).collect();
        let is_below = |it: &String| folders.iter().any(|folder| parts(it).starts_with(folder));
        self.files.into_iter().filter(|it| !is_below(it)).collect()
    }
}

/// A path as MSBuild writes it: some characters are `%` and two hexadecimal digits.
fn unescaped(path: &str) -> String {
    let mut parts = path.split('%');
    let mut whole = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let code = part.get(..2).filter(|it| it.bytes().all(|it| it.is_ascii_hexdigit()));
        match code.and_then(|it| u8::from_str_radix(it, 16).ok()).filter(u8::is_ascii_graphic) {
            Some(character) => {
                whole.push(char::from(character));
                whole += &part[2..];
            }
            None => {
                whole.push('%');
                whole += part;
            }
        }
    }
    whole
}

fn sources<'t>(text: &'t str, reader: &mut Reader<'t>) -> Result<Vec<String>, Broken> {
    let mut list = Listing::default();
    while let Some(part) = reader.part()? {
        match part {
            Part::Open(element) if matches!(element.name, "Compile" | "Folder") => {
                list.finish_entry();
                list.entry = element.attribute(text, "Include").map(|path| Entry {
                    path: unescaped(path),
                    is_folder: element.name == "Folder",
                    is_excluded: false,
                });
            }
            Part::Open(element) => list.asks = element.name == "ExcludeFromBuild",
            Part::Text(chunk) if list.asks && text[chunk.place.clone()].trim().eq_ignore_ascii_case("true") => {
                if let Some(entry) = &mut list.entry {
                    entry.is_excluded = true;
                }
            }
            Part::Text(_) => {}
            Part::Close => list.asks = false,
        }
    }
    list.finish_entry();
    Ok(list.included())
}
