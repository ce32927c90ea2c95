//! Which files a build reads. Every file and every folder that was searched is reported to cargo.

use std::path::{Path, PathBuf};

use crate::cargo::Instructions;
use crate::{Failed, listing};

/// The files that `paths` name, in order; those of a folder in the order of their paths.
pub fn find(paths: &[PathBuf], cargo: &mut Instructions) -> Result<Vec<PathBuf>, Failed> {
    let mut found = Vec::new();
    for path in paths {
        if path.is_dir() {
            search(path, cargo, &mut found)?;
        } else if listing::is_list(path) {
            list(path, cargo, &mut found)?;
        } else {
            cargo.rerun_if_changed(path);
            found.push(path.clone());
        }
    }
    Ok(found)
}

/// The files that a list refers to.
fn list(path: &Path, cargo: &mut Instructions, found: &mut Vec<PathBuf>) -> Result<(), Failed> {
    let (sources, lists) = listing::sources(path).map_err(|error| {
        cargo.error(&error);
        Failed
    })?;
    lists.iter().chain(&sources).for_each(|it| cargo.rerun_if_changed(it));
    found.extend(sources);
    Ok(())
}

fn search(folder: &Path, cargo: &mut Instructions, found: &mut Vec<PathBuf>) -> Result<(), Failed> {
    cargo.rerun_if_changed(folder);
    if let Some(project) = listing::project_in(folder) {
        return list(&project, cargo, found);
    }
    let entries = std::fs::read_dir(folder).and_then(Iterator::collect::<Result<Vec<_>, _>>);
    let entries = entries.map_err(|error| cargo.failed("read", folder, &error))?;
    let mut paths: Vec<PathBuf> = entries.into_iter().map(|entry| entry.path()).collect();
    paths.sort();
    for path in paths {
        if path.is_dir() {
            search(&path, cargo, found)?;
        } else if listing::is_source(&path) {
            cargo.rerun_if_changed(&path);
            found.push(path);
        }
    }
    Ok(())
}
