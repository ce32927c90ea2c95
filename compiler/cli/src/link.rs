//! Executables and libraries from native objects: what is missing is only a linker.

use crate::args::Opt;
use crate::toolchain::{Library, run};
use crate::{archive, linker, output, rustc, scratch};
use std::fs;
use std::path::{Path, PathBuf};

/// The runtime's libraries for the machine that the command itself runs on.
static HOST_RUNTIME: &[u8] = include_bytes!(concat!(env!("OUT_DIR"), "/runtime/libstaunch_native.a"));
static HOST_PROGRAM: &[u8] = include_bytes!(concat!(env!("OUT_DIR"), "/runtime/libstaunch_program.a"));

/// What the standard library inside the runtime's library needs of the system.
const OF_LINUX: [&str; 5] = ["-lgcc_s", "-lpthread", "-ldl", "-lm", "-lc"];
const OF_WINDOWS: [&str; 6] = ["-lkernel32", "-lntdll", "-luserenv", "-lws2_32", "-ldbghelp", "-lgcc_eh"];

/// Links a program's object to an executable.
pub fn executable(object: &[u8], target: Option<&str>, out: &Path) -> Result<(), String> {
    let mut command = linker::find(target)?;
    let library = runtime_library(target, Library::Program)?;
    let folder = scratch::folder()?;
    let (ending, system): (&str, &[&str]) =
        if linker::is_windows(target) { (".exe", &OF_WINDOWS) } else { ("", &OF_LINUX) };
    let made = folder.path().join(format!("program{ending}"));
    command.arg(write(folder.path(), "program.o", object)?);
    command.arg(write(folder.path(), Library::Program.file(), &library)?);
    command.arg("-Wl,--gc-sections").args(system).arg("-o").arg(&made);
    run(command, &out.display().to_string())?;
    output::executable(out, &read(&made)?)
}

/// What a program's object defines for others, after its prefix.
const ENTRY_POINTS: [&str; 4] = ["init", "scan", "map", "map_len"];

/// Packs a program's object and the runtime into a static library, without a `main`.
pub fn static_library(object: &[u8], prefix: &str, target: Option<&str>, out: &Path) -> Result<(), String> {
    let runtime = runtime_library(target, Library::Runtime)?;
    let entry_points = ENTRY_POINTS.map(|it| format!("{prefix}_{it}"));
    let entry_points = entry_points.each_ref().map(String::as_str);
    let packed = archive::with_object(&runtime, "program.o", object, &entry_points);
    output::write(out, &packed.ok_or("rustc made a library that is not in GNU's form")?)
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
    if let Some(target) = target.filter(|it| !linker::is_host(it)) {
        let rustc = rustc::find(Some(target), Opt::Speed)?;
        let path = rustc::runtime(&rustc)?.join(library.file());
        return if path.is_file() { read(&path) } else { Err(linker::no_system(target)) };
    }
    Ok(match library {
        Library::Runtime => HOST_RUNTIME.to_owned(),
        Library::Program => HOST_PROGRAM.to_owned(),
    })
}
