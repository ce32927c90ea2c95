//! The folder in which compiled runtimes and programs are kept. Parallel runs share it: an entry
//! is made aside and appears under its name at once, by a rename. Its contents are executed, so it
//! belongs to its user alone; what has not been used for long goes.

use std::env;
use std::fs;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::{Duration, SystemTime};

/// Entries that have not been used for this long go.
const KEPT: Duration = Duration::from_secs(30 * 24 * 60 * 60);
/// When all entries together are larger, those that have not been used for longest go.
const LARGEST: u64 = 1 << 30;
/// Another process may be about to use what was used so recently.
const FRESH: Duration = Duration::from_secs(60 * 60);

/// `$STAUNCH_CACHE`, or `staunch` in the user's cache folder, or one below the temporary folder.
fn root() -> PathBuf {
    let set = |name: &str| env::var_os(name).filter(|it| !it.is_empty()).map(PathBuf::from);
    let of_user = if cfg!(windows) { "LOCALAPPDATA" } else { "XDG_CACHE_HOME" };
    set("STAUNCH_CACHE")
        .or_else(|| set(of_user).map(|it| it.join("staunch")))
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

/// Whether a name is one that [`key`] gives.
fn is_key(name: &str) -> bool {
    let hash = name.strip_prefix("runtime-").or_else(|| name.strip_prefix("program-"));
    hash.is_some_and(|it| it.len() == 32 && it.bytes().all(|byte| byte.is_ascii_hexdigit()))
}

/// The folder of the entry `key`, made by `make` if it is not there yet.
pub fn entry(key: &str, make: impl FnOnce(&Path) -> Result<(), String>) -> Result<PathBuf, String> {
    static COUNT: AtomicU32 = AtomicU32::new(0);
    let root = root();
    let fail = |error: io::Error| {
        format!("the cache folder {}: {error} (set STAUNCH_CACHE to a folder that you own)", root.display())
    };
    private::open(&root).map_err(fail)?;
    let folder = root.join(key);
    if is_whole(&folder) {
        touch(&folder);
        return Ok(folder);
    }
    let _turn = turn(&root, key);
    if is_whole(&folder) {
        return Ok(folder);
    }
    if folder.exists() {
        // What a power cut or a full disk left.
        fs::remove_dir_all(&folder).map_err(fail)?;
    }
    let number = COUNT.fetch_add(1, Ordering::Relaxed);
    let aside = root.join(format!(".{key}.{}.{number}", std::process::id()));
    fs::create_dir(&aside).map_err(fail)?;
    let made = make(&aside).and_then(|()| seal(&aside).map_err(fail));
    let moved = match made {
        Ok(()) => fs::rename(&aside, &folder).or_else(|error| if folder.is_dir() { Ok(()) } else { Err(fail(error)) }),
        Err(error) => Err(error),
    };
    if aside.exists() {
        let _ = fs::remove_dir_all(&aside);
    }
    prune(&root, key);
    moved.map(|()| folder)
}

/// The list of an entry's files with their lengths, which is written last.
const SEAL: &str = ".files";

/// Makes sure that the entry is on disk before it has its name.
fn seal(folder: &Path) -> io::Result<()> {
    let list = listed(folder)?;
    for path in fs::read_dir(folder)?.flatten().map(|it| it.path()).filter(|it| it.is_file()) {
        sync(&path)?;
    }
    let seal = folder.join(SEAL);
    fs::write(&seal, list)?;
    sync(&seal)
}

/// Windows syncs what is open for writing.
fn sync(file: &Path) -> io::Result<()> {
    fs::File::options().write(true).open(file)?.sync_all()
}

/// Whether the entry is as it was made: a power cut may leave files of a folder empty.
fn is_whole(folder: &Path) -> bool {
    fs::read_to_string(folder.join(SEAL)).is_ok_and(|seal| listed(folder).is_ok_and(|it| it == seal))
}

/// A line a file, sorted by name.
fn listed(folder: &Path) -> io::Result<String> {
    let mut lines = Vec::new();
    for entry in fs::read_dir(folder)? {
        let entry = entry?;
        let metadata = entry.metadata()?;
        if metadata.is_file() && entry.file_name() != SEAL {
            lines.push(format!("{}\t{}\n", metadata.len(), entry.file_name().to_string_lossy()));
        }
    }
    lines.sort();
    // Not even an entry without files has an empty list.
    Ok(format!("{} files\n{}", lines.len(), lines.concat()))
}

/// Waits for whoever makes the same entry: two would do the same work. Where files cannot be
/// locked, both do.
fn turn(root: &Path, key: &str) -> Option<fs::File> {
    let file = fs::File::create(root.join(format!(".{key}.lock"))).ok()?;
    file.lock().ok()?;
    Some(file)
}

/// Remembers a use. Where a folder's time cannot be set, its entry is made again in a month.
fn touch(folder: &Path) {
    let _ = fs::File::open(folder).and_then(|it| it.set_modified(SystemTime::now()));
}

/// What may go: entries, and what a process left that was ended.
struct Old {
    path: PathBuf,
    unused: Duration,
    size: u64,
}

/// Removes what has not been used for long, and the oldest of what is too much; never `made`, which
/// has just been made, nor a file of somebody else's.
fn prune(root: &Path, made: &str) {
    let mut all = old(root, made);
    all.sort_by_key(|it| it.unused);
    let mut total = 0;
    for old in all {
        total += old.size;
        if old.unused > KEPT || (total > LARGEST && old.unused > FRESH) {
            let _ = if old.path.is_dir() { fs::remove_dir_all(&old.path) } else { fs::remove_file(&old.path) };
        }
    }
}

fn old(root: &Path, made: &str) -> Vec<Old> {
    let entries = fs::read_dir(root).into_iter().flatten().flatten();
    let ours = entries.filter(|it| {
        let name = it.file_name().to_string_lossy().into_owned();
        let key = name.trim_start_matches('.').split('.').next().unwrap_or_default();
        is_key(key) && key != made
    });
    let old = |it: fs::DirEntry| {
        let used = it.metadata().ok()?.modified().ok()?;
        let unused = SystemTime::now().duration_since(used).unwrap_or_default();
        Some(Old { path: it.path(), unused, size: size(&it.path()) })
    };
    ours.filter_map(old).collect()
}

fn size(path: &Path) -> u64 {
    let Ok(metadata) = fs::symlink_metadata(path) else { return 0 };
    if !metadata.is_dir() {
        return metadata.len();
    }
    fs::read_dir(path).into_iter().flatten().flatten().map(|it| size(&it.path())).sum()
}

#[cfg(unix)]
mod private {
    use super::{fs, io};
    use std::os::unix::fs::{DirBuilderExt, MetadataExt, PermissionsExt};
    use std::path::Path;

    /// Makes the folder for its user alone, or makes sure that it is that: nobody else can have put
    /// anything into it.
    pub fn open(root: &Path) -> io::Result<()> {
        fs::DirBuilder::new().recursive(true).mode(0o700).create(root)?;
        let (folder, me) = (fs::metadata(root)?, me(root)?);
        // A link of another user's leads where that user wants.
        if folder.uid() != me || fs::symlink_metadata(root)?.uid() != me {
            return Err(io::Error::other("it belongs to another user"));
        }
        if folder.mode() & 0o022 != 0 {
            return Err(io::Error::other("other users can write to it: empty it and remove their permissions"));
        }
        match folder.mode() & 0o077 {
            0 => Ok(()),
            _ => fs::set_permissions(root, fs::Permissions::from_mode(0o700)),
        }
    }

    /// The user of this process, who owns what it makes.
    fn me(root: &Path) -> io::Result<u32> {
        let probe = root.join(format!(".me.{}.{:?}", std::process::id(), std::thread::current().id()));
        let made = fs::File::create_new(&probe)?.metadata();
        fs::remove_file(&probe)?;
        Ok(made?.uid())
    }
}

#[cfg(not(unix))]
mod private {
    use super::{fs, io};
    use std::path::Path;

    /// A user's folders are private there.
    pub fn open(root: &Path) -> io::Result<()> {
        fs::create_dir_all(root)
    }
}
