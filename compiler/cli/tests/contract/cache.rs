//! The folder of compiled programs: its user's alone, and no larger than it has to be.

use super::{COUNTER, Folder, Ran, has};
use std::fs;
use std::os::unix::fs::{MetadataExt, PermissionsExt};
use std::path::{Path, PathBuf};
use std::sync::OnceLock;
use std::time::{Duration, SystemTime};

const DAY: Duration = Duration::from_secs(24 * 60 * 60);

fn run(folder: &Folder) -> Ran {
    let mut command = folder.command("run main.st --scans 1 --quiet --backend rust");
    Ran::of(command.env("STAUNCH_CACHE", folder.0.join("cache")).output().unwrap())
}

/// Puts a compiled runtime into a cache: compiling it takes half a minute, which is spent once.
fn seed(cache: &Path) {
    static SEED: OnceLock<PathBuf> = OnceLock::new();
    let seed = SEED.get_or_init(|| {
        let folder = Folder::with("cache_seeded", &[("main.st", COUNTER)]);
        let seed = folder.0.with_file_name("cache_seed");
        let mut command = folder.command("run main.st --scans 1 --quiet --backend rust");
        Ran::of(command.env("STAUNCH_CACHE", &seed).output().unwrap()).out(0);
        seed
    });
    // Of several, the one that was just used: an older command's may be there.
    let entries = fs::read_dir(seed).unwrap().map(|it| it.unwrap());
    let runtimes = entries.filter(|it| it.file_name().to_string_lossy().starts_with("runtime-"));
    let newest = runtimes.max_by_key(|it| it.metadata().unwrap().modified().unwrap()).unwrap();
    copy(&newest.path(), &cache.join(newest.file_name()));
}

fn copy(from: &Path, to: &Path) {
    fs::create_dir(to).unwrap();
    for entry in fs::read_dir(from).unwrap().map(|it| it.unwrap()) {
        let to = to.join(entry.file_name());
        match entry.path().is_dir() {
            true => copy(&entry.path(), &to),
            false => _ = fs::copy(entry.path(), to).unwrap(),
        }
    }
}

fn make(cache: &Path, mode: u32) {
    let _ = fs::remove_dir_all(cache);
    fs::create_dir(cache).unwrap();
    fs::set_permissions(cache, fs::Permissions::from_mode(mode)).unwrap();
}

#[test]
fn a_folder_that_others_may_write_is_refused() {
    let folder = Folder::with("cache_shared", &[("main.st", COUNTER)]);
    let cache = folder.0.join("cache");
    for mode in [0o777, 0o770, 0o707, 0o1777, 0o722] {
        make(&cache, mode);
        has(&run(&folder).err(2), &["cache: other users can write to it", "set STAUNCH_CACHE"]);
        assert_eq!(fs::read_dir(&cache).unwrap().count(), 0, "{mode:o}");
    }
    make(&cache, 0o700);
    // Only the system's administrator can give a folder away, to show this.
    if std::os::unix::fs::chown(&cache, Some(54321), None).is_ok() {
        has(&run(&folder).err(2), &["it belongs to another user"]);
    }
}

/// An entry of so many bytes that was last used so long ago.
fn entry(cache: &Path, name: &str, size: u64, unused: Duration) {
    let folder = cache.join(name);
    fs::create_dir(&folder).unwrap();
    fs::File::create(folder.join("program")).unwrap().set_len(size).unwrap();
    fs::File::open(&folder).unwrap().set_modified(SystemTime::now() - unused).unwrap();
}

#[test]
fn it_is_private_and_what_is_old_goes() {
    let folder = Folder::with("cache_old", &[("main.st", COUNTER)]);
    let cache = folder.0.join("cache");
    make(&cache, 0o755);
    seed(&cache);
    let name = |kind: &str, digit: &str| format!("{kind}-{}", digit.repeat(32));
    entry(&cache, &name("program", "a"), 1, 31 * DAY);
    entry(&cache, &format!(".{}.77.0", name("program", "b")), 1, 31 * DAY);
    entry(&cache, &name("program", "c"), 1, 29 * DAY);
    entry(&cache, &name("program", "d"), 3 << 30, 2 * DAY);
    entry(&cache, &name("program", "e"), 1 << 29, DAY);
    entry(&cache, "program-of-mine", 3 << 30, 31 * DAY);
    run(&folder).out(0);
    assert_eq!(fs::metadata(&cache).unwrap().mode() & 0o777, 0o700);
    let is_there = |name: &str| cache.join(name).is_dir();
    assert!(!is_there(&name("program", "a")) && !is_there(&format!(".{}.77.0", name("program", "b"))));
    // Too large together: what was used last stays.
    assert!(is_there(&name("program", "e")) && !is_there(&name("program", "d")) && !is_there(&name("program", "c")));
    assert!(is_there("program-of-mine"), "it is none of ours");
    let of_kind = |kind: &str| {
        let names = fs::read_dir(&cache).unwrap().map(|it| it.unwrap().file_name().into_string().unwrap());
        names.filter(|it| it.starts_with(kind)).count()
    };
    assert_eq!((of_kind("runtime-"), of_kind("program-")), (1, 3));
    run(&folder).out(0);
}

/// What a power cut leaves of a file whose name was on disk before its bytes were.
#[test]
fn an_entry_that_is_not_whole_is_made_again() {
    let folder = Folder::with("cache_torn", &[("main.st", COUNTER)]);
    let cache = folder.0.join("cache");
    make(&cache, 0o700);
    seed(&cache);
    let traced = || {
        let mut command = folder.command("run main.st --scans 1 --backend rust --trace - --vars full");
        Ran::of(command.env("STAUNCH_CACHE", &cache).output().unwrap()).out(0)
    };
    let expected = "scan,time_ms,full\n1,0,FALSE\n";
    assert_eq!(traced(), expected);
    let entries = || fs::read_dir(&cache).unwrap().map(|it| it.unwrap().path()).filter(|it| it.is_dir());
    for file in ["program", ".files"] {
        let torn: Vec<_> = entries().map(|it| it.join(file)).filter(|it| it.exists()).collect();
        assert!(!torn.is_empty());
        torn.iter().for_each(|it| fs::write(it, "").unwrap());
        assert_eq!(traced(), expected, "{file}");
    }
}
