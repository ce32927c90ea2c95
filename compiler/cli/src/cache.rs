//! The folder in which compiled runtimes and programs are kept. Parallel runs share it: an entry
//! is made aside and appears under its name at once, by a rename.

use std::env;
use std::fs;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};

/// `$STAUNCH_CACHE`, or `staunch` in the user's cache folder, or one below the temporary folder.
fn root() -> PathBuf {
    let set = |name: &str| env::var_os(name).filter(|it| !it.is_empty()).map(PathBuf::from);
    set("STAUNCH_CACHE")
        .or_else(|| set("XDG_CACHE_HOME").map(|it| it.join("staunch")))
        .or_else(|| set("HOME").map(|it| it.join(".cache").join("staunch")))
        .unwrap_or_else(|| env::temp_dir().join("staunch"))
}

/// A name for what depends on nothing but `parts`.
pub fn key(kind: &str, parts: &[&[u8]]) -> String {
    let mut hasher = DefaultHasher::new();
    env!("CARGO_PKG_VERSION").hash(&mut hasher);
    parts.hash(&mut hasher);
    let first = hasher.finish();
    kind.hash(&mut hasher);
    format!("{kind}-{first:016x}{:016x}", hasher.finish())
}

/// The folder of the entry `key`, made by `make` if it is not there yet.
pub fn entry(key: &str, make: impl FnOnce(&Path) -> Result<(), String>) -> Result<PathBuf, String> {
    static COUNT: AtomicU32 = AtomicU32::new(0);
    let folder = root().join(key);
    if folder.is_dir() {
        return Ok(folder);
    }
    let _turn = turn(key);
    if folder.is_dir() {
        return Ok(folder);
    }
    let number = COUNT.fetch_add(1, Ordering::Relaxed);
    let aside = root().join(format!(".{key}.{}.{number}", std::process::id()));
    let fail = |error: std::io::Error| {
        let hint = "set STAUNCH_CACHE to a folder that can be written";
        format!("the cache folder {}: {error} ({hint})", root().display())
    };
    fs::create_dir_all(&aside).map_err(fail)?;
    let made = make(&aside);
    let moved = match made {
        Ok(()) => fs::rename(&aside, &folder).or_else(|error| if folder.is_dir() { Ok(()) } else { Err(fail(error)) }),
        Err(error) => Err(error),
    };
    if aside.exists() {
        let _ = fs::remove_dir_all(&aside);
    }
    moved.map(|()| folder)
}

/// Waits for whoever makes the same entry: two would do the same work. Where files cannot be
/// locked, both do.
fn turn(key: &str) -> Option<fs::File> {
    fs::create_dir_all(root()).ok()?;
    let file = fs::File::create(root().join(format!(".{key}.lock"))).ok()?;
    file.lock().ok()?;
    Some(file)
}
