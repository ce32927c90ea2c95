//! Which files a build reads. Cargo hears of every file and every folder that was searched.

use std::path::{Path, PathBuf};

use crate::Failed;
use crate::cargo::Instructions;

/// The files that `paths` name, in order; a folder's in the order of their paths.
pub fn find(paths: &[PathBuf], cargo: &mut Instructions) -> Result<Vec<PathBuf>, Failed> {
    let mut found = Vec::new();
    for path in paths {
        if path.is_dir() {
            search(path, cargo, &mut found)?;
        } else {
            cargo.rerun_if_changed(path);
            found.push(path.clone());
        }
    }
    Ok(found)
}

fn search(folder: &Path, cargo: &mut Instructions, found: &mut Vec<PathBuf>) -> Result<(), Failed> {
    cargo.rerun_if_changed(folder);
    let entries = std::fs::read_dir(folder).and_then(Iterator::collect::<Result<Vec<_>, _>>);
    let entries = entries.map_err(|error| cargo.failed("read", folder, &error))?;
    let mut paths: Vec<PathBuf> = entries.into_iter().map(|entry| entry.path()).collect();
    paths.sort();
    for path in paths {
        if path.is_dir() {
            search(&path, cargo, found)?;
        } else if is_source(&path) {
            cargo.rerun_if_changed(&path);
            found.push(path);
        }
    }
    Ok(())
}

fn is_source(path: &Path) -> bool {
    let extension = path.extension().map(|it| it.to_string_lossy().to_ascii_lowercase());
    extension.is_some_and(|it| ["st", "iecst", "tcpou", "tcgvl", "tcdut", "tcio"].contains(&it.as_str()))
}
