//! The files of an OpenPLC Editor project: its folder determines which they are, not its `project.json`.

use staunch_frontend::Source;
use std::collections::HashSet;
use std::path::{Path, PathBuf};

/// The name of the editor's project file.
const NAME: &str = "project.json";
/// Folders of POUs, each with a file for each POU.
const POUS: [&str; 3] = ["pous/functions", "pous/function-blocks", "pous/programs"];
/// The extensions of these files; editors before v4.1 write `.json`.
const LANGUAGES: [&str; 8] = ["st", "il", "ld", "fbd", "sfc", "py", "cpp", "json"];

/// Whether a file is such a project: it has the project's name, and either its contents show it or its folder has POUs. Other
/// tools have JSON files with this name.
pub fn is_project(path: &Path) -> bool {
    path.file_name().is_some_and(|it| it == NAME)
        && path.is_file()
        && (path.with_file_name("pous").is_dir() || std::fs::read(path).is_ok_and(|it| Source::is_openplc_project(&it)))
}

/// The project that a folder is.
pub fn project_in(folder: &Path) -> Option<PathBuf> {
    Some(folder.join(NAME)).filter(|it| is_project(it))
}

/// The files of the project, its types, its POUs and its device, as far as they exist.
pub fn files(project: &Path) -> Result<Vec<PathBuf>, String> {
    let folder = project.parent().unwrap_or(Path::new(""));
    let mut files = vec![project.to_owned()];
    let devices = ["devices/configuration.json", "devices/pin-mapping.json"].map(|it| folder.join(it));
    files.extend(devices.into_iter().filter(|it| it.is_file()));
    search(&folder.join("devices/remote"), &["json"], &mut HashSet::new(), &mut files)?;
    search(&folder.join("datatypes"), &["dt"], &mut HashSet::new(), &mut files)?;
    let mut pous = Vec::new();
    for it in POUS {
        search(&folder.join(it), &LANGUAGES, &mut HashSet::new(), &mut pous)?;
    }
    files.extend(pous.iter().filter(|it| !is_replaced(it, &pous)).cloned());
    Ok(files)
}

/// A POU in a file of its language replaces one with the same name in JSON, as in the editor.
fn is_replaced(path: &Path, all: &[PathBuf]) -> bool {
    let is_json = |it: &Path| it.extension().is_some_and(|it| it == "json");
    is_json(path) && all.iter().any(|it| !is_json(it) && it.file_stem() == path.file_stem())
}

/// The files below a folder that have one of these endings, in the order of their paths; each folder once, since links may
/// lead back to it.
fn search(
    folder: &Path,
    endings: &[&str],
    seen: &mut HashSet<PathBuf>,
    found: &mut Vec<PathBuf>,
) -> Result<(), String> {
    if !folder.is_dir() || !seen.insert(folder.canonicalize().unwrap_or_else(|_| folder.to_owned())) {
        return Ok(());
    }
    let fail = |it: std::io::Error| format!("{}: {it}", folder.display());
    let entries = std::fs::read_dir(folder).and_then(Iterator::collect::<Result<Vec<_>, _>>).map_err(fail)?;
    let mut paths: Vec<PathBuf> = entries.into_iter().map(|it| it.path()).collect();
    paths.sort();
    for path in paths {
        let ending = path.extension().map(|it| it.to_string_lossy().into_owned());
        if path.is_dir() {
            search(&path, endings, seen, found)?;
        } else if ending.is_some_and(|it| endings.contains(&it.as_str())) {
            found.push(path);
        }
    }
    Ok(())
}
