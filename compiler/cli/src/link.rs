//! Executables and libraries from native objects: what is missing is only a linker.

use crate::toolchain::{Library, Rustc, run};
use crate::{archive, output};
use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The runtime's libraries for the machine that the command itself runs on.
static HOST_RUNTIME: &[u8] = include_bytes!(concat!(env!("OUT_DIR"), "/runtime/libstaunch_native.a"));
static HOST_PROGRAM: &[u8] = include_bytes!(concat!(env!("OUT_DIR"), "/runtime/libstaunch_program.a"));

/// What the standard library inside the runtime's library needs of the system.
const SYSTEM_LIBRARIES: [&str; 5] = ["-lgcc_s", "-lpthread", "-ldl", "-lm", "-lc"];

/// Links a program's object to an executable.
pub fn executable(object: &[u8], target: Option<&str>, out: &Path) -> Result<(), String> {
    let mut command = linker(target)?;
    let library = runtime_library(target, Library::Program)?;
    in_scratch(|folder| {
        let made = folder.join("program");
        command.arg(write(folder, "program.o", object)?).arg(write(folder, Library::Program.file(), &library)?);
        command.arg("-Wl,--gc-sections").args(SYSTEM_LIBRARIES).arg("-o").arg(&made);
        run(command, &out.display().to_string())?;
        output::executable(out, &read(&made)?)
    })
}

/// What a program's object defines for others.
const ENTRY_POINTS: [&str; 4] = ["staunch_init", "staunch_scan", "staunch_map", "staunch_map_len"];

/// Packs a program's object and the runtime into a static library, without a `main`.
pub fn static_library(object: &[u8], target: Option<&str>, out: &Path) -> Result<(), String> {
    let runtime = runtime_library(target, Library::Runtime)?;
    let packed = archive::with_object(&runtime, "program.o", object, &ENTRY_POINTS);
    output::write(out, &packed.ok_or("rustc made a library that is not in GNU's form")?)
}

/// Works in a new folder, which is gone afterwards.
fn in_scratch(work: impl FnOnce(&Path) -> Result<(), String>) -> Result<(), String> {
    let folder = scratch()?;
    let result = work(&folder);
    let _ = fs::remove_dir_all(&folder);
    result
}

/// What is there already is somebody else's.
fn scratch() -> Result<PathBuf, String> {
    let mut number = 0_u32;
    loop {
        let folder = std::env::temp_dir().join(format!("staunch-{}-{number}", std::process::id()));
        match fs::create_dir(&folder) {
            Ok(()) => return Ok(folder),
            Err(error) if error.kind() == std::io::ErrorKind::AlreadyExists && number < 1000 => number += 1,
            Err(error) => return Err(format!("{}: {error}", folder.display())),
        }
    }
}

fn write(folder: &Path, name: &str, bytes: &[u8]) -> Result<PathBuf, String> {
    let path = folder.join(name);
    fs::write(&path, bytes).map_err(|it| format!("{}: {it}", path.display()))?;
    Ok(path)
}

fn read(path: &Path) -> Result<Vec<u8>, String> {
    fs::read(path).map_err(|it| format!("{}: {it}", path.display()))
}

/// The carried library for the host, else one that rustc makes.
fn runtime_library(target: Option<&str>, library: Library) -> Result<Vec<u8>, String> {
    if let Some(target) = target.filter(|it| !is_host(it)) {
        let rustc = crate::rustc::find(Some(target))?;
        let path = crate::rustc::runtime(&rustc)?.join(library.file());
        return if path.is_file() { read(&path) } else { Err(no_system(target)) };
    }
    Ok(match library {
        Library::Runtime => HOST_RUNTIME.to_owned(),
        Library::Program => HOST_PROGRAM.to_owned(),
    })
}

/// Why there is no executable for a machine without an operating system.
pub fn no_system(target: &str) -> String {
    format!("{target} has no operating system to run an executable on; write --emit lib and link it into your firmware")
}

pub fn is_host(target: &str) -> bool {
    target == env!("STAUNCH_TARGET")
}

/// The C compiler as a linker. For the host `$CC` or a usual name; for another target `$CC_` and
/// its name with underscores, or a cross compiler by its usual name.
fn linker(target: Option<&str>) -> Result<Command, String> {
    let foreign = target.filter(|it| !is_host(it));
    let variable = foreign.map_or("CC".to_owned(), |it| format!("CC_{}", it.replace('-', "_")));
    if let Some(command) = std::env::var(&variable).ok().and_then(|it| words(&it)) {
        return Ok(command);
    }
    let names: Vec<String> = match foreign {
        Some(target) => vec![format!("{}gcc", prefix(target))],
        None => ["cc", "gcc", "clang"].map(str::to_owned).to_vec(),
    };
    names.iter().find(|name| exists(name)).map(Command::new).ok_or_else(|| {
        let package = foreign.map_or("gcc".to_owned(), |it| format!("gcc-{}", prefix(it).trim_end_matches('-')));
        format!(
            "no linker was found: looked for {} (install a C compiler, for Debian `apt install {package}`, or set {variable})",
            names.join(", ")
        )
    })
}

/// A command with arguments, as in `CC='ccache gcc'`.
fn words(text: &str) -> Option<Command> {
    let mut words = text.split_whitespace();
    let mut command = Command::new(words.next()?);
    command.args(words);
    Some(command)
}

/// The linker that rustc is to call for a target, where it needs one by name.
pub fn linker_of_rustc(target: Option<&str>) -> Result<Option<OsString>, String> {
    let Some(target) = target.filter(|it| !is_host(it)) else { return Ok(None) };
    let name = format!("{}gcc", prefix(target));
    match exists(&name) {
        true => Ok(Some(OsString::from(name))),
        // A target of another C library or system may come with all it needs.
        false if target.contains("linux-gnu") => linker(Some(target)).map(|it| Some(it.get_program().to_owned())),
        false => Ok(None),
    }
}

/// Debian's prefix of a target's tools: `aarch64-linux-gnu-`.
fn prefix(target: &str) -> String {
    let parts: Vec<_> = target.split('-').collect();
    let arch = match parts.first() {
        Some(arch) if arch.starts_with("riscv64") => "riscv64",
        Some(arch) if arch.starts_with("armv7") => "arm",
        Some(arch) => arch,
        None => "",
    };
    let system = if target.contains("linux") { "linux" } else { "none" };
    let abi = parts.last().copied().filter(|it| *it != "linux").unwrap_or("gnu");
    format!("{arch}-{system}-{abi}-")
}

fn exists(program: &str) -> bool {
    let Some(path) = std::env::var_os("PATH") else { return false };
    std::env::split_paths(&path).any(|folder| folder.join(program).is_file())
}

/// Shows that a rustc can be asked for, in messages.
pub fn describe(rustc: &Rustc) -> String {
    rustc.target.clone().unwrap_or_else(|| env!("STAUNCH_TARGET").to_owned())
}
