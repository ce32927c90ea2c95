//! The project of Beremiz, or of OpenPLC Editor before v4: a folder with one file of PLCopen XML. The programs that the editor
//! generates from it are in the same folder, and are not sources.

use std::path::{Path, PathBuf};

/// The name of the editors' project file, and the file by which they recognise its folder.
const NAMES: [&str; 2] = ["plc.xml", "beremiz.xml"];

pub fn is_project(path: &Path) -> bool {
    let [project, marker] = NAMES;
    path.file_name().is_some_and(|it| it == project) && path.is_file() && path.with_file_name(marker).is_file()
}

/// The project that a folder is.
pub fn project_in(folder: &Path) -> Option<PathBuf> {
    Some(folder.join(NAMES[0])).filter(|it| is_project(it))
}
