//! Which files are sources, and which list others: the projects and solutions of TwinCAT, and the projects of OpenPLC
//! Editor and Beremiz.

mod beremiz;
mod openplc;

use staunch_frontend::{Reference, Source};
use std::io::Read;
use std::path::{Path, PathBuf};
use std::slice::from_ref;

/// A solution names projects, these name PLC projects, and these sources.
const DEEPEST: usize = 4;
/// The maximum number of folders from a PLC project up to its solution.
const HIGHEST: usize = 8;

/// Whether a folder's file is a source by its name.
pub fn is_source(path: &Path) -> bool {
    has_extension(path, &["st", "iecst", "tcpou", "tcgvl", "tcdut", "tcio", "tctleo", "tctto", "l5x", "scl", "udt"])
        || has_extension(path, &["db", "var"]) && is_data_block(path)
        || has_extension(path, &["typ", "fun"]) && is_text_of_automation_studio(path)
}

/// Whether a file declares types or functions, as `.typ` and `.fun` of B&R's Automation Studio do.
fn is_text_of_automation_studio(path: &Path) -> bool {
    let text = std::fs::read(path).unwrap_or_default();
    ["END_TYPE", "END_FUNCTION"]
        .iter()
        .any(|it| text.windows(it.len()).any(|part| part.eq_ignore_ascii_case(it.as_bytes())))
}

/// Whether a file is a source of data blocks, or of variables; databases, and the pictures that Windows keeps, are called `.db` as well.
fn is_data_block(path: &Path) -> bool {
    let mut begins = Vec::new();
    let read = std::fs::File::open(path).map(|it| it.take(4096).read_to_end(&mut begins));
    // Its content decides; its name matters only for a list of variables.
    let name = if has_extension(path, &["var"]) { ".var" } else { "" };
    read.is_ok() && Source::decode(name, &begins).is_assembled()
}

/// Whether a file lists others.
pub fn is_list(path: &Path) -> bool {
    has_extension(path, &["plcproj", "sln", "tsproj", "tspproj", "xti"]) || openplc::is_project(path)
}

fn has_extension(path: &Path, all: &[&str]) -> bool {
    let extension = path.extension().map(|it| it.to_string_lossy().to_ascii_lowercase());
    extension.is_some_and(|it| all.contains(&it.as_str()))
}

/// The project that a folder is.
pub fn project_in(folder: &Path) -> Option<PathBuf> {
    openplc::project_in(folder).or_else(|| beremiz::project_in(folder))
}

/// The name of a library or a program: that of its file, project or folder. In OpenPLC Editor each project has a folder
/// that gives it its name.
pub fn name(path: &Path) -> String {
    let folder = path.parent().filter(|_| openplc::is_project(path));
    let name = match folder {
        Some(folder) => {
            Path::new(".").join(folder).canonicalize().ok().and_then(|it| it.file_name().map(ToOwned::to_owned))
        }
        None => if path.is_dir() { path.file_name() } else { path.file_stem() }.map(ToOwned::to_owned),
    };
    name.map_or_else(String::new, |it| it.to_string_lossy().into_owned())
}

/// The sources that a list refers to, directly or through other lists, and these lists.
pub fn sources(path: &Path) -> Result<(Vec<PathBuf>, Vec<PathBuf>), String> {
    if openplc::is_project(path) {
        return Ok((openplc::files(path)?, vec![path.to_owned()]));
    }
    if beremiz::is_project(path) {
        return Ok((vec![path.to_owned()], Vec::new()));
    }
    let mut lists = Vec::new();
    let projects = plc_projects(path, 0, &mut lists)?;
    let name = path.display();
    let [(project, files)] = projects.as_slice() else {
        if projects.is_empty() {
            return Err(format!("{name} does not list a PLC project"));
        }
        let all: Vec<_> = projects.iter().map(|it| it.0.display().to_string()).collect();
        return Err(format!("{name} has {} PLC projects; name one of them: {}", all.len(), all.join(", ")));
    };
    let sources: Vec<_> = files.iter().filter(|it| is_source(it)).cloned().collect();
    if sources.is_empty() {
        return Err(format!("{} does not list a source file", project.display()));
    }
    Ok((sources, lists))
}

/// The libraries of a program, each with what its sources call it by: those that are named, and the PLC projects to which projects
/// among the arguments refer, where no library is called so.
pub fn libraries(arguments: &[PathBuf], named: impl Iterator<Item = PathBuf>) -> Vec<(PathBuf, String)> {
    let lists: Vec<_> = arguments.iter().filter(|it| is_list(it)).filter_map(|it| Some(sources(it).ok()?.1)).collect();
    let references = references(&lists.concat());
    let mut all: Vec<_> = named.map(|it| (library_name(&it, &references), it)).map(|(name, it)| (it, name)).collect();
    for sibling in arguments.iter().flat_map(|it| siblings(it)) {
        if all.iter().all(|it| !it.1.eq_ignore_ascii_case(&sibling.1)) {
            all.push(sibling);
        }
    }
    all
}

/// The name by which sources refer to a library: the title of a PLC project if a reference uses it, otherwise its name.
fn library_name(path: &Path, references: &[Reference]) -> String {
    let is_wanted = |title: &String| references.iter().any(|it| it.library.eq_ignore_ascii_case(title));
    title(path).filter(is_wanted).unwrap_or_else(|| name(path))
}

fn title(path: &Path) -> Option<String> {
    if has_extension(path, &["plcproj"]) { Source::project_title(&std::fs::read(path).ok()?) } else { None }
}

/// The PLC projects of the same solution to which one refers as libraries, by their titles or names, and those to which these
/// refer; each with what it is called.
fn siblings(project: &Path) -> Vec<(PathBuf, String)> {
    let (mut found, mut waiting) = (Vec::<(PathBuf, String)>::new(), vec![project.to_owned()]);
    let others = if has_extension(project, &["plcproj"]) { in_its_solution(project) } else { Vec::new() };
    while let Some(it) = waiting.pop() {
        for wanted in references(from_ref(&it)) {
            let is_new = |other: &&PathBuf| found.iter().all(|it| it.0 != **other);
            let is_it = |other: &&PathBuf| library_name(other, from_ref(&wanted)).eq_ignore_ascii_case(&wanted.library);
            if let Some(sibling) = others.iter().filter(is_new).find(is_it) {
                found.push((sibling.clone(), wanted.library));
                waiting.push(sibling.clone());
            }
        }
    }
    found
}

/// The other PLC projects of the nearest solution that lists a project.
fn in_its_solution(project: &Path) -> Vec<PathBuf> {
    let Ok(own) = project.canonicalize() else { return Vec::new() };
    let is_own = |it: &PathBuf| it.canonicalize().is_ok_and(|it| it == own);
    for folder in own.ancestors().skip(1).take(HIGHEST) {
        let Ok(entries) = std::fs::read_dir(folder) else { return Vec::new() };
        let mut solutions: Vec<_> = entries.filter_map(|it| Some(it.ok()?.path())).collect();
        solutions.retain(|it| has_extension(it, &["sln"]));
        solutions.sort();
        for solution in solutions {
            let mut projects = listed_by(&solution);
            if projects.iter().any(is_own) {
                projects.retain(|it| !is_own(it) && sources(it).is_ok());
                return projects;
            }
        }
    }
    Vec::new()
}

/// The PLC projects of a solution, except those that cannot be read.
fn listed_by(solution: &Path) -> Vec<PathBuf> {
    let Ok(listed) = std::fs::read(solution).map_err(|it| it.to_string()).and_then(|it| Source::listed(&it)) else {
        return Vec::new();
    };
    let folder = solution.parent().unwrap_or(Path::new(""));
    let files = listed.iter().map(|it| resolved(folder, it)).filter(|it| is_list(it));
    let projects = files.filter_map(|it| plc_projects(&it, 1, &mut Vec::new()).ok());
    projects.flatten().map(|it| it.0).collect()
}

/// The libraries to which the PLC projects among lists refer.
pub fn references(lists: &[PathBuf]) -> Vec<Reference> {
    let projects = lists.iter().filter(|it| has_extension(it, &["plcproj"]));
    projects.filter_map(|it| std::fs::read(it).ok()).flat_map(|it| Source::references(&it)).collect()
}

/// The name of the first PLC project among lists.
pub fn project_name(lists: &[PathBuf]) -> Option<String> {
    let mut projects = lists.iter().filter(|it| has_extension(it, &["plcproj"]));
    projects.find_map(|it| Source::project_name(&std::fs::read(it).ok()?))
}

/// What the PLC projects among lists define for conditional compilation.
pub fn definitions(lists: &[PathBuf]) -> Vec<String> {
    let projects = lists.iter().filter(|it| has_extension(it, &["plcproj"]));
    projects.filter_map(|it| std::fs::read(it).ok()).flat_map(|it| Source::definitions(&it)).collect()
}

/// The PLC projects that a list refers to, each with its own list.
fn plc_projects(path: &Path, depth: usize, lists: &mut Vec<PathBuf>) -> Result<Vec<(PathBuf, Vec<PathBuf>)>, String> {
    let fail = |it: &dyn std::fmt::Display| format!("{}: {it}", path.display());
    if depth > DEEPEST {
        return Err(fail(&"projects list each other"));
    }
    lists.push(path.to_owned());
    let bytes = std::fs::read(path).map_err(|it| fail(&it))?;
    let folder = path.parent().unwrap_or(Path::new(""));
    let listed = Source::listed(&bytes).map_err(|it| fail(&it))?;
    let files = listed.iter().map(|it| resolved(folder, it));
    if has_extension(path, &["plcproj"]) {
        return Ok(vec![(path.to_owned(), files.collect())]);
    }
    let mut projects = Vec::new();
    for it in files.filter(|it| is_list(it)) {
        projects.extend(plc_projects(&it, depth + 1, lists)?);
    }
    Ok(projects)
}

/// A Windows path, relative to a folder; its `..` are resolved.
fn resolved(folder: &Path, path: &str) -> PathBuf {
    let mut whole = folder.to_owned();
    for part in path.split(['\\', '/']) {
        match part {
            "" | "." => {}
            ".." if whole.file_name().is_some() => {
                whole.pop();
            }
            part => whole.push(part),
        }
    }
    if whole.exists() { whole } else { in_any_case(&whole).unwrap_or(whole) }
}

/// The file that a path means if upper and lower case are not distinguished, as on Windows.
fn in_any_case(path: &Path) -> Option<PathBuf> {
    let mut found = PathBuf::new();
    for part in path.components() {
        let next = found.join(part);
        if next.exists() {
            found = next;
            continue;
        }
        let folder = if found.as_os_str().is_empty() { Path::new(".") } else { found.as_path() };
        let mut names = std::fs::read_dir(folder).ok()?.filter_map(|it| Some(it.ok()?.file_name()));
        found.push(names.find(|it| it.eq_ignore_ascii_case(part.as_os_str()))?);
    }
    Some(found)
}
