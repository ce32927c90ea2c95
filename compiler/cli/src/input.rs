//! Source files from the command line: named ones, folders, standard input.

use staunch_build::listing;
use staunch_frontend::{Source, Sources};
use std::collections::HashSet;
use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};

/// Files that may not be larger: positions in a file are 32-bit.
const MAX_BYTES: u64 = 1 << 31;
/// Folders that lie deeper than this are taken for a loop of links.
const MAX_DEPTH: usize = 64;

/// Reads every file that the arguments name, each once, folders in sorted order; and then those of the libraries.
pub fn read(arguments: &[PathBuf], libraries: &[PathBuf]) -> Result<Sources, String> {
    let mut all: Vec<_> = found(arguments)?.into_iter().map(|it| (it, None)).collect();
    if all.is_empty() {
        return Err("no source file was found".to_owned());
    }
    for (library, name) in listing::libraries(arguments, libraries.iter().cloned()) {
        all.extend(found(&[library])?.into_iter().map(|it| (it, Some(name.clone()))));
    }
    if all.len() > usize::from(u16::MAX) {
        return Err(format!("{} files are more than a program may have", all.len()));
    }
    let mut seen = HashSet::new();
    let mut sources = Sources::default();
    for (path, library) in all {
        let identity = path.canonicalize().unwrap_or_else(|_| path.clone());
        if seen.insert(identity) {
            let is_named = arguments.contains(&path) || libraries.contains(&path);
            let source = if is_named || path.exists() { source(&path)? } else { Source::absent(shown(&path)) };
            sources.add(match library {
                Some(name) => source.of_library(&name),
                None => source,
            });
        }
    }
    for list in arguments.iter().filter(|it| listing::is_list(it) && !it.is_dir()) {
        let lists = listing::sources(Path::new(&shown(list)))?.1;
        sources.refer(listing::references(&lists));
        sources.define(listing::definitions(&lists));
        sources.name_project(listing::project_name(&lists));
    }
    Ok(sources)
}

/// The files that the arguments name, each once, folders in sorted order.
pub fn found(arguments: &[PathBuf]) -> Result<Vec<PathBuf>, String> {
    let (mut paths, mut folders) = (Vec::new(), HashSet::new());
    for argument in arguments {
        collect(argument, 0, (&mut paths, &mut folders))?;
    }
    Ok(paths)
}

/// Each folder once: links may lead back to it.
fn collect(
    path: &Path,
    depth: usize,
    (paths, folders): (&mut Vec<PathBuf>, &mut HashSet<PathBuf>),
) -> Result<(), String> {
    if path != Path::new("-") && listing::is_list(path) && !path.is_dir() {
        paths.extend(listing::sources(Path::new(&shown(path)))?.0);
        return Ok(());
    }
    if let Some(project) = listing::project_in(path) {
        paths.extend(listing::sources(Path::new(&shown(&project)))?.0);
        return Ok(());
    }
    if path == Path::new("-") || !path.is_dir() {
        paths.push(path.to_owned());
        return Ok(());
    }
    if depth > MAX_DEPTH {
        return Err(format!("{}: folders are nested too deeply", path.display()));
    }
    if !folders.insert(path.canonicalize().unwrap_or_else(|_| path.to_owned())) {
        return Ok(());
    }
    let entries = fs::read_dir(path).map_err(|it| format!("{}: {it}", path.display()))?;
    let mut inside =
        entries.map(|it| it.map(|it| it.path())).collect::<Result<Vec<_>, _>>().map_err(|it| it.to_string())?;
    inside.sort();
    for entry in inside {
        let hidden = entry.file_name().is_some_and(|it| it.to_string_lossy().starts_with('.'));
        if !hidden && (entry.is_dir() || listing::is_source(&entry)) {
            let metadata = fs::metadata(&entry).map_err(|it| format!("{}: {it}", shown(&entry)))?;
            if !metadata.is_file() && !metadata.is_dir() {
                // A pipe that nobody writes would be waited for; one that is named is.
                return Err(format!("{}: this is not a file, but a pipe or a device", shown(&entry)));
            }
            collect(&entry, depth + 1, (paths, folders))?;
        }
    }
    Ok(())
}

fn source(path: &Path) -> Result<Source, String> {
    let (name, bytes) = bytes(path)?;
    Ok(Source::decode(name, &bytes))
}

/// A file as messages name it, and what is in it.
pub fn bytes(path: &Path) -> Result<(String, Vec<u8>), String> {
    let mut bytes = Vec::new();
    let name = if path == Path::new("-") { "<stdin>".to_owned() } else { shown(path) };
    let read = if path == Path::new("-") {
        std::io::stdin()
            .lock()
            .take(MAX_BYTES + 1)
            .read_to_end(&mut bytes)
            .map_err(|it| format!("standard input: {it}"))
    } else {
        let file = staunch_host::open_to_read(path).map_err(|it| format!("{name}: {it}"))?;
        file.take(MAX_BYTES + 1).read_to_end(&mut bytes).map_err(|it| format!("{name}: {it}"))
    };
    read?;
    if u64::try_from(bytes.len()).unwrap_or(u64::MAX) > MAX_BYTES {
        return Err(format!("{name}: a source file may have at most 2 GiB"));
    }
    Ok((name, bytes))
}

/// As messages and outputs have it: seen from the current folder, with the strokes of every system.
pub fn shown(path: &Path) -> String {
    let here = std::env::current_dir().ok();
    let below = here.as_deref().and_then(|it| path.strip_prefix(it).ok());
    let parts = below.unwrap_or(path).components().filter(|it| *it != std::path::Component::CurDir);
    parts.collect::<PathBuf>().display().to_string().replace(std::path::MAIN_SEPARATOR, "/")
}

/// The text of a file that is not a source; a pipe is waited for.
pub fn text(path: &Path) -> Result<String, String> {
    let mut text = String::new();
    let read = staunch_host::open_to_read(path).and_then(|mut it| it.read_to_string(&mut text));
    read.map(|_| text).map_err(|it| format!("cannot read {}: {it}", path.display()))
}
